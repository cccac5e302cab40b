"""A head of a file: which way it looks, how large it is, where its ears are; all said, all to be overruled."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from studies.heads.ears import MEAN_WIDTH_MM, WIDTH_MM, Ear, HeadSize, find_ears, measure, unit_by_size
from studies.heads.human_head import HeadError
from studies.heads.orientation import OF_FORMAT, Guess, Orientation, guess, normalized
from studies.heads.pieces import split
from studies.heads.samples import Array, Samples, sample

#: Of an ear that was not measured.
EAR_HEIGHT_M = 0.06
#: Scans whose unit is known.
KNOWN_UNITS_MM = {"LeePerrySmith.glb": 50.35}
#: Formats whose axes are part of the standard: a guess does not overrule them.
STRICT = (".glb", ".gltf")
#: Where the head is less of the height than that it is a body's, and looked at alone, with so much of its height below.
BODY, NECK = 0.4, 0.4


@dataclass
class Placed:
    """A head, how it is brought to meters, Z up, facing -Y, and what was assumed."""

    orientation: Orientation
    unit_mm: float
    size: HeadSize  # meters
    ears: list[Ear]  # meters; none if none were found
    samples: Samples  # meters, Z up, facing -Y
    said: list[str] = field(default_factory=list)  # sentences for the terminal
    #: (m,) of the triangles: what lies about the head, and is no part of it.
    away: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))

    @property
    def left_ear(self) -> Ear:
        """The one at +X; HeadError if it was not found."""
        for ear in self.ears:
            if ear.side > 0.0:
                return ear
        raise HeadError("the left ear was not found; give a head with both ears uncovered")

    def matrix(self) -> Array:
        """(3, 3), of points of the file."""
        return self.unit_mm / 1000.0 * self.orientation.rotation()


def place_head(
    vertices: Array,
    triangles: NDArray[np.integer],
    name: str,
    up: str | None = None,
    facing: str | None = None,
    unit_mm: float | None = None,
    ear: tuple[float, float, float] | None = None,
) -> Placed:
    """Decides by what is given, then by the format, then by the mesh.

    vertices, triangles  in the file's axes and units
    name                 of the file, with its suffix
    up, facing           axes of the file, "+Y", "-z", "x"; None: by the format or the mesh
    unit_mm              millimeters of a unit; None: the usual unit that makes it a person's head
    ear                  where the ear of the close-up is, in the file's axes and units; None: it is looked for
    Raises HeadError, in words and with the remedy, where it cannot be a head of a person.
    """
    if unit_mm is not None and not 0.0 < unit_mm < np.inf:
        raise HeadError(f"--unit is {unit_mm}; allowed: millimeters per unit of the file, above 0")
    try:
        pieces = split(vertices, triangles)
        found = sample(vertices, triangles[pieces.counts])
    except ValueError:
        raise HeadError(f"{name}: has no surface; export the head as triangles or quads") from None
    orientation, said = _orientation(found, name, up, facing)
    if pieces.away_count:
        said.append(f"note: {_pieces(pieces.away_count)} away from the head in {name}; left out")
    turned = found.turned(orientation.rotation())
    size = measure(turned)
    if size.top - size.bottom < BODY * np.ptp(turned.points[:, 2]):
        turned = _head_alone(vertices, triangles[~pieces.away], orientation, size)
        size = measure(turned)
    unit, sentence = _unit(size.width, name, unit_mm)
    said += [sentence] if sentence else []
    meters = turned.scaled(unit / 1000.0)
    size = measure(meters)
    if ear is not None:
        center = unit / 1000.0 * orientation.rotation() @ np.array(ear, float)
        ears = [Ear(center, EAR_HEIGHT_M, 1.0 if center[0] > size.middle_x else -1.0)]
    else:
        ears = find_ears(meters, size)
        said.append(_about_ears(ears, name))
    return Placed(orientation, unit, size, ears, meters, said, pieces.away)


def _pieces(count: int) -> str:
    return f"{count:,} pieces lie" if count > 1 else "a piece lies"


def _head_alone(vertices: Array, triangles: NDArray[np.integer], orientation: Orientation, size: HeadSize) -> Samples:
    """Samples, turned, of the head of a body: of all of the body too few are of its ears."""
    rotation = orientation.rotation()
    height = (vertices @ rotation[2])[triangles].mean(axis=1)
    head = triangles[height > size.bottom - NECK * (size.top - size.bottom)]
    return sample(vertices, head[split(vertices, head).counts]).turned(rotation)


def _orientation(found: Samples, name: str, up: str | None, facing: str | None) -> tuple[Orientation, list[str]]:
    try:
        given = {key: normalized(text) for key, text in (("up", up), ("facing", facing)) if text is not None}
    except ValueError as error:
        raise HeadError(f"--up and --facing: {error}") from None
    if len(given) == 2:
        if given["up"][1] == given["facing"][1]:
            raise HeadError(f"--up {given['up']} and --facing {given['facing']}: no head faces along its up axis")
        return Orientation(**given), []
    suffix = name[name.rfind(".") :].lower() if "." in name else ""
    usual = OF_FORMAT.get(suffix)
    best = guess(found, **given)
    taken, reason = best.orientation, "guessed from its neck, ears and symmetry"
    said = []
    if not given and usual is not None and (suffix in STRICT or not best.is_sure):
        taken, reason = Orientation(*usual), f"as {suffix[1:]} files have it"
        if best.is_sure and best.orientation != taken:
            said.append(_doubt(name, best))
    if not best.is_sure and suffix not in STRICT:
        said.append(f"note: {name} could stand another way too; look at the preview")
    said.insert(0, f"{name}: {taken.up} is up and it faces {taken.facing}, {reason}; --up and --facing overrule that")
    return taken, said


def _doubt(name: str, best: Guess) -> str:
    other = best.orientation
    return (
        f"note: the mesh of {name} looks as if {other.up} were up and it faced {other.facing}; if the preview is "
        f"wrong, add --up={other.up} --facing={other.facing}"
    )


def _unit(width: float, name: str, unit_mm: float | None) -> tuple[float, str]:
    """Millimeters of a unit, and what to say."""
    usual = (KNOWN_UNITS_MM[name], "known") if name in KNOWN_UNITS_MM else unit_by_size(width)
    fitting = usual[0] if usual is not None else float(f"{MEAN_WIDTH_MM / width:.3g}")
    if unit_mm is None:
        kind = f"{usual[1]}, " if usual is not None else "no usual unit, "
        return fitting, (
            f"{name}: its unit is taken for {fitting:g} mm ({kind}a head {width * fitting:.0f} mm wide); "
            "--unit overrules that"
        )
    if not WIDTH_MM[0] <= width * unit_mm <= WIDTH_MM[1]:
        raise HeadError(
            f"{name}: with --unit {unit_mm:g} the head would be {_length(width * unit_mm)} wide, a person's is "
            f"{WIDTH_MM[0]:.0f} to {WIDTH_MM[1]:.0f} mm, and light comes through skin only where it is a few mm thick; "
            f"give --unit {fitting:g}, or leave it out"
        )
    return unit_mm, ""


def _length(mm: float) -> str:
    return f"{mm / 1000.0:.3g} m" if mm >= 1000.0 else f"{mm:.3g} mm"


def _about_ears(ears: list[Ear], name: str) -> str:
    if not ears:
        return (
            f"note: no ear was found in {name} (covered by hair, cut off, or it faces another way: see the preview, "
            "--up and --facing); the close-up shows the side of the head. --ear X,Y,Z says where an ear is, in "
            "the file's units"
        )
    if len(ears) == 1:
        side = "left" if ears[0].side > 0.0 else "right"
        return f"only the {side} ear was found; the close-up is of that"
    return f"both ears were found, {1000 * ears[0].size:.0f} and {1000 * ears[1].size:.0f} mm high"
