"""Which way up a head is and where it looks, guessed from its mesh: symmetry, neck, the round skull."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from studies.heads.ears import find_ears, measure
from studies.heads.samples import Array, Samples

AXES = ("+X", "-X", "+Y", "-Y", "+Z", "-Z")
#: What a file format says, or what its programs agree on: up, facing. None: the format says nothing.
OF_FORMAT: dict[str, tuple[str, str] | None] = {
    ".glb": ("+Y", "+Z"),
    ".gltf": ("+Y", "+Z"),
    ".obj": ("+Y", "+Z"),
    ".ply": None,
    ".stl": None,
}
#: A guess is sure where its score is that much above the next one's, and two ears are as they are on a head.
SURE = 0.12
#: Ways whose score is that far below the best one's are not asked for their ears.
CLOSE = 2.0
#: An ear stands out by less, in widths of the head: seen from above or below, half a skull does.
STANDS_OUT = 0.3
#: How far it stands out goes with the way backward by such a correlation, 0.4 to 0.9 on heads that were measured.
BACKWARD = 0.5
#: What is less like its mirror image than that is no whole head; nor is a shell, whose normals have that mean or more:
#: a face without the back of the head. Guesses of both are never sure.
ASYMMETRIC, SHELL = 0.4, 0.3
#: A body is that much higher than deep. Within the last part of its height there is a head near the middle, in parts of
#: its height too, or there are feet, which stand apart.
BODY, END, MIDDLE = 2.5, 0.06, 0.02
#: What has such a short side for its longest is a person from head to foot, or a mask: no guess is sure either. Of a
#: person's head so many points are needed.
SHORT_SIDE, LEAST_POINTS = 0.28, 500


@dataclass(frozen=True)
class Orientation:
    """Two axes of the file, as "+Y"."""

    up: str
    facing: str

    def rotation(self) -> Array:
        """(3, 3): brings the file's up to +Z and its facing to -Y."""
        up, facing = axis_of(self.up), axis_of(self.facing)
        return np.stack([np.cross(up, facing), -facing, up])


@dataclass(frozen=True)
class Guess:
    orientation: Orientation
    margin: float  #: of its score above that of the next way up or way round

    @property
    def is_sure(self) -> bool:
        return self.margin >= SURE


def axis_of(name: str) -> Array:
    """ "Y" and "+Y" as (0, 1, 0)."""
    axis = np.zeros(3)
    axis["XYZ".index(name[-1])] = -1.0 if name[0] == "-" else 1.0
    return axis


def normalized(name: str) -> str:
    """An axis as typed, "y" or "-z", as "+Y" or "-Z"; ValueError if it is none."""
    letters = name.strip().upper()
    letters = letters if letters[:1] in ("+", "-") else "+" + letters
    if letters not in AXES:
        raise ValueError(f"{name!r} is no axis; allowed: {', '.join(AXES)}, or X, Y, Z")
    return letters


def guess(samples: Samples, up: str | None = None, facing: str | None = None) -> Guess:
    """Of all 24 ways, or those that are left by what is given, the one that looks most like a head that stands up."""
    sides = np.ptp(samples.points, axis=0)
    if sides.min() > SHORT_SIDE * sides.max():
        return _guess(samples, up, facing)
    best = _guess(samples, up or _up_of_body(samples, facing), facing)
    # The face tells where a body looks.
    rotation = best.orientation.rotation()
    turned = samples.turned(rotation)
    size = measure(turned)
    head = samples.where(turned.points[:, 2] > size.bottom, turned.border[:, 2] > size.bottom)
    if len(head.points) > LEAST_POINTS:
        best = _guess(head, best.orientation.up, facing)
    return Guess(best.orientation, 0.0)


def _up_of_body(s: Samples, facing: str | None) -> str | None:
    """The end with the head on it: feet stand apart, a head is in the middle. None of what is no body."""
    middle = s.points.mean(axis=0)
    size = np.ptp(s.points, axis=0)
    left = {0, 1, 2} - {int(np.argmin([_asymmetry((s.points - middle) / size.max() * 4.0, axis) for axis in range(3)]))}
    up, deep = sorted(left, key=lambda axis: -size[axis])
    (sideways,) = {0, 1, 2} - left
    if size[up] < BODY * size[deep] or (facing and "XYZ"[up] == facing[1]):
        return None
    low, high = s.points[:, up].min(), s.points[:, up].max()
    inner = np.abs(s.points[:, sideways] - 0.5 * (s.points[:, sideways].min() + s.points[:, sideways].max()))
    in_middle = [
        _mean((inner[end] < MIDDLE * size[up]).astype(float))
        for end in (s.points[:, up] < low + END * size[up], s.points[:, up] > high - END * size[up])
    ]
    if max(in_middle) < 2.0 * min(in_middle):
        return None
    return "-+"[int(in_middle[1] > in_middle[0])] + "XYZ"[up]


def _guess(samples: Samples, up: str | None, facing: str | None) -> Guess:
    middle = samples.points.mean(axis=0)
    size = float(np.sqrt(((samples.points - middle) ** 2).sum(axis=1).mean()))
    unit = Samples((samples.points - middle) / size, samples.normals, (samples.border - middle) / size)
    unit = _outside(unit)
    asymmetry = [_asymmetry(unit.points, axis) for axis in range(3)]
    outward = np.sign((unit.points * unit.normals).sum()) * unit.normals.mean(axis=0)
    is_shell = bool(np.linalg.norm(outward) > SHELL)
    found: list[tuple[float, Orientation]] = []
    for above, front in product([up] if up else AXES, [facing] if facing else AXES):
        if above[1] == front[1]:
            continue
        sideways = ({0, 1, 2} - {"XYZ".index(above[1]), "XYZ".index(front[1])}).pop()
        orientation = Orientation(above, front)
        turned = unit.turned(orientation.rotation())
        symmetry = min(asymmetry) / max(asymmetry[sideways], 1e-9)
        open_behind = 6.0 * float(outward @ axis_of(front)) if is_shell else 0.0
        found.append((_looks_like_a_head(turned) + 1.5 * symmetry + open_behind, orientation))
    best = max(score for score, _ in found)
    close = [(score, way, _ears(samples.turned(way.rotation()))) for score, way in found if score > best - CLOSE]
    close.sort(key=lambda each: -each[0] - each[2])
    is_whole = not is_shell and min(asymmetry) < ASYMMETRIC and close[0][2] > 0.0
    margin = close[0][0] + close[0][2] - close[1][0] - close[1][2] if len(close) > 1 else CLOSE
    return Guess(close[0][1], margin if is_whole and len(found) > 1 else 0.0)


def _ears(s: Samples) -> float:
    """1 where two ears stand out as they do on a head that looks to -Y, -1 where it looks the other way."""
    size = measure(s)
    ears = find_ears(s, size)
    if len(ears) < 2 or max(ear.stands_out for ear in ears) > STANDS_OUT * size.width:
        return 0.0
    return float(np.mean([np.clip(ear.backward / BACKWARD, -1.0, 1.0) for ear in ears]))


def _outside(s: Samples) -> Samples:
    """Without the inside of the mouth and what is behind the eyes: the farthest points in each direction."""
    distance = np.linalg.norm(s.points, axis=1)
    way = s.points / distance[:, None]
    cell = np.round(way * 12.0).astype(int) @ np.array([1, 100, 10_000])
    _, direction_of = np.unique(cell, return_inverse=True)
    farthest = np.zeros(direction_of.max() + 1)
    np.maximum.at(farthest, direction_of, distance)
    kept = distance > 0.85 * farthest[direction_of]
    return Samples(s.points[kept], s.normals[kept], s.border)


def _asymmetry(points: Array, axis: int) -> float:
    """How far the points are from their mirror image: the part of occupied cells that have no partner."""
    centered = points.copy()
    low, high = np.quantile(points[:, axis], [0.01, 0.99])
    centered[:, axis] -= 0.5 * (low + high)
    mirrored = centered.copy()
    mirrored[:, axis] *= -1.0
    cells, partners = (np.unique(np.round(p / 0.12).astype(int), axis=0) for p in (centered, mirrored))
    both = len(np.unique(np.concatenate([cells, partners]), axis=0))
    return (both - len(cells)) / len(cells) + 0.02


def _looks_like_a_head(s: Samples) -> float:
    """Of samples in units of their own spread, Z up, facing -Y."""
    x, y, z = s.points.T
    low, high = np.quantile(z, [0.002, 0.998])
    height = high - low
    # The end of the neck or bust is a cut, flat or open; the top of a head is a dome.
    slab = 0.04 * height
    flat = _steep(s, z < low + slab) - _steep(s, z > high - slab)
    flat += 0.5 * (_extent(s.points[z < low + slab]) - _extent(s.points[z > high - slab]))
    tall = float(np.log(height / np.ptp(np.quantile(y, [0.002, 0.998]))))
    open_below = 0.0
    if len(s.border):
        below, above = s.border[:, 2] < low + 0.25 * height, s.border[:, 2] > high - 0.25 * height
        open_below = float(below.mean() - above.mean())
    # The skull is round above and behind: its normals point away from its center. A face's do not.
    skull = z > high - 0.55 * min(height, 1.3 * (np.quantile(y, 0.99) - np.quantile(y, 0.01)))
    upper = s.points[skull]
    center = np.array([np.median(upper[:, 0]), 0.5 * (upper[:, 1].min() + upper[:, 1].max()), upper[:, 2].min()])
    away = s.points - center
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
    rough = 1.0 - np.abs(np.einsum("nk,nk->n", away, s.normals))
    middle = skull & (np.abs(x - center[0]) < 0.5 * np.ptp(upper[:, 0]) * 0.7)
    front, back = middle & (away[:, 1] < -0.35), middle & (away[:, 1] > 0.35)
    top = (np.abs(x - center[0]) < 0.3) & (away[:, 2] > 0.8)
    facing = _mean(rough[front]) - _mean(rough[back])
    dome = _mean(rough[front]) - _mean(rough[top])
    return flat + open_below + tall + 3.0 * facing + 1.0 * dome


def _steep(s: Samples, chosen: NDArray[np.bool_]) -> float:
    """How steep the surface is at an end, 0 to 1; what closes a cut, flat, is left out."""
    across = np.abs(s.normals[chosen, 2])
    return _mean(1.0 - across[across < 0.97])


def _extent(points: Array) -> float:
    """The spread across the axis z."""
    return float(np.ptp(points[:, 0]) * np.ptp(points[:, 1])) ** 0.5 if len(points) > 3 else 0.0


def _mean(values: Array) -> float:
    return float(values.mean()) if len(values) else 0.0
