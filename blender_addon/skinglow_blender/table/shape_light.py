# SPDX-License-Identifier: GPL-3.0-or-later
"""Light through the shape of a skin, at the targets that its texels show, by calls to the core.

Everything here is arrays and objects of the core, never Blender's data: it is computed in a thread.
"""

import time
from collections.abc import Callable, Iterator
from functools import cached_property
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from ..errors import core
from ..read.shown_mesh import BodyMesh, Frame
from ..tissue_presets import TISSUE_SLIDERS

#: How a coarse answer is solved, which is seen while a light moves: some 8 % off the full one. The second re-entry
#: takes half as long again, for 1 %; without any it would be 40 % off.
COARSE = {"solver_tolerance": 1e-2, "shadow_samples": 4}
COARSE_REENTRIES = 1
#: Parts of the work that a first answer is: finding the parts, making them ready.
FINDING = 0.1

Progress = Callable[[float], bool]


class BodyKey(NamedTuple):
    """What light is solved in."""

    mesh: int  #: version of the evaluated mesh
    rows: int  #: of its texels
    frame: Frame  #: its stretch counts, not how it stands
    unit_mm: float
    cell_mm: float
    medium: tuple[float, ...] | None
    tissue: tuple[float, ...]  #: sliders; not read where there is a medium

    def same_place(self, other: "BodyKey") -> bool:
        """Whether the texels show the same points of the same body."""
        mine, others = (self.mesh, self.rows, self.unit_mm), (other.mesh, other.rows, other.unit_mm)
        return mine == others and self.frame.same_stretch(other.frame)

    def same_body(self, other: "BodyKey") -> bool:
        """Whether light is solved in the same."""
        flesh = self.medium or self.tissue
        return self.same_place(other) and (self.cell_mm, flesh) == (other.cell_mm, other.medium or other.tissue)


class Tiles:
    """The texels of a skin's tiles and the points of its surface that they show."""

    def __init__(self, mesh: BodyMesh, rows: int, unit_mm: float, thickness_mm: np.ndarray) -> None:
        self.mesh, self.rows, self.unit_mm = mesh, rows, unit_mm
        self._thickness_mm = thickness_mm  #: at the vertices
        self._lock = Lock()

    @property
    def targets(self) -> Any:  # noqa: ANN401  a skinglow.TileTargets
        """Found when they are first needed."""
        with self._lock:
            return self._targets

    @cached_property
    def _targets(self) -> Any:  # noqa: ANN401
        mesh = self.mesh
        return core().TileTargets(mesh.vertices, mesh.triangles, mesh.texels, self.rows, unit_mm=self.unit_mm)

    @cached_property
    def thickness_mm(self) -> np.ndarray:
        """Of the targets, (k,)."""
        found = self.targets.at_vertices(self._thickness_mm[:, None])[:, 0]
        found.setflags(write=False)
        return found

    def draw(self, radiance: np.ndarray, pixels: np.ndarray, *, alpha: bool = True) -> None:
        """Writes a radiance at the targets (k, 3) into an image (rows, width, 4), with the thickness in mm as alpha.

        alpha  False: the image has that already
        """
        self.targets.spread(np.column_stack((radiance, self.thickness_mm)) if alpha else radiance, out=pixels)


class Body:
    """A body that light is solved in, made ready when light first falls on it."""

    def __init__(self, key: BodyKey, tiles: Tiles, threads: int) -> None:
        self.key, self.tiles, self.threads = key, tiles, threads
        self.last_lit: Any = None  #: a skinglow.LitShape, of which the next one takes what did not change
        self.first_seconds = 0.0  #: that making it ready and its first light took, up to the full answer
        self.is_ready = False  #: a full answer was given, so that nothing is made ready any more
        self._shape: Any = None
        self._lock = Lock()

    def shape(self, progress: Progress | None = None) -> Any:  # noqa: ANN401  a skinglow.Shape
        with self._lock:
            if self._shape is None:
                started = time.perf_counter()
                self._shape = self._make(progress)
                self.first_seconds = time.perf_counter() - started
            return self._shape

    def _make(self, progress: Progress | None) -> Any:  # noqa: ANN401
        targets, key = self.tiles.targets, self.key
        flesh: dict[str, Any]
        if key.medium is not None:
            medium = key.medium
            flesh = {"absorption": medium[:3], "reduced_scattering": medium[3:6], "refractive_index": medium[6]}
            flesh["surface"] = "smooth" if medium[7] else "rough"
        else:
            flesh = {"tissue": tissue_of(key.tissue)}
        return core().Shape(
            self.tiles.mesh.vertices,
            self.tiles.mesh.triangles,
            unit_mm=key.unit_mm,
            cell_mm=key.cell_mm,
            points=targets.points,
            normals=targets.normals,
            threads=self.threads,
            progress=progress,
            **flesh,
        )


class Light(NamedTuple):
    """What falls on a body."""

    lights: tuple[tuple, ...]  #: signatures (scene_lights.FIELDS), each without the name
    core_lights: tuple[Any, ...]  #: the same as skinglow.Light, in the world; not compared
    shadowless: tuple[int, ...]  #: indices of those that cast no shadows
    world: tuple[float, ...]  #: coefficients of the environment
    frame: Frame
    reentries: int
    occluders: int  #: version of what stands in the way
    own: tuple[int, ...]  #: which of the occluders are the body itself
    scene: Any  #: those as skinglow.Occluders, in the world; not compared

    def same(self, other: "Light") -> bool:
        """Whether the same falls on a body."""
        return self._but_colors() == other._but_colors() and self.lights == other.lights

    def same_but_colors(self, other: "Light") -> bool:
        """Whether only colors and powers of lights differ."""
        if self._but_colors() != other._but_colors() or len(self.lights) != len(other.lights):
            return False
        return all(_without_color(a) == _without_color(b) for a, b in zip(self.lights, other.lights, strict=True))

    def _but_colors(self) -> tuple:
        return self.shadowless, self.world, self.frame.body_to_world, self.reentries, self.occluders, self.own


def _without_color(signature: tuple) -> tuple:
    """A light's signature without name, color and power."""
    return signature[:1] + signature[3:]


class Answer(NamedTuple):
    """Light through a body."""

    body: Body
    light: Light
    lit: Any  #: a skinglow.LitShape
    radiance: np.ndarray  #: (k, 3) at the targets, linear Rec.709
    full: bool  #: not a coarse one
    recolors: bool  #: whether other colors are sums alone
    seconds: float | None  #: that it took; None: it was the body's first light (Body.first_seconds)
    report: dict[str, Any]  #: of the shape then, as skinglow.Shape.report
    error: tuple[float, ...] = ()  #: RMS of the estimated error over the mean; only if full

    def is_of(self, key: BodyKey, light: Light) -> bool:
        """Whether it is the light of that body under these lights."""
        return self.body.key.same_body(key) and self.light.same(light)


def tissue_of(sliders: tuple[float, ...]) -> Any:  # noqa: ANN401  a skinglow.Tissue
    """The tissue that the sliders say."""
    return core().Tissue(**dict(zip(TISSUE_SLIDERS, sliders, strict=True)))


def radiance_of(lit: Any) -> np.ndarray:  # noqa: ANN401  a skinglow.LitShape
    """What comes through, (k, 3). What is thrown back on the lit side is the surface's own shader's."""
    return core().diffuse_radiance(lit.transmitted)


def solve(body: Body, light: Light, progress: Progress, *, coarse: bool, recolors: bool) -> Iterator[Answer]:
    """The light through a body: coarse if asked for, then full, then if asked for the same ready for other colors."""
    shape = body.shape(lambda fraction: progress(FINDING * fraction))

    def rest(fraction: float) -> bool:
        return progress(FINDING + (1.0 - FINDING) * fraction)

    if coarse:
        yield _solved(shape, body, light, rest, full=False)
    answer = _solved(shape, body, light, rest, full=True)
    yield answer
    if recolors and light.core_lights:
        answer.lit.recolor([each.color for each in light.core_lights], progress=rest)
        yield answer._replace(recolors=True)


def _solved(shape: Any, body: Body, light: Light, progress: Progress, *, full: bool) -> Answer:  # noqa: ANN401
    started = time.perf_counter()
    to_body = np.linalg.inv(np.array(light.frame.body_to_world))
    environment = core().Environment(np.reshape(light.world, (9, 3))) if any(light.world) else None
    lit = shape.light(
        [each.moved(to_body) for each in light.core_lights],
        environment.rotated(to_body[:3, :3]) if environment is not None else None,
        light.scene,
        light.reentries if full else min(light.reentries, COARSE_REENTRIES),
        excluded=light.own,
        shadowless=light.shadowless,
        occluder_frame=np.array(light.frame.body_to_world) if light.scene is not None else None,
        previous=body.last_lit,
        progress=progress,
        **({} if full else COARSE),
    )
    seconds: float | None = time.perf_counter() - started
    # Coarse answers to a light that is dragged meanwhile are no part of the first light.
    if body.last_lit is None or (full and not body.is_ready):
        body.first_seconds, seconds = body.first_seconds + seconds, None
    body.is_ready = body.is_ready or full
    body.last_lit = lit
    error = tuple(float(e) for e in lit.report["error"]) if full else ()
    radiance = radiance_of(lit)
    return Answer(body, light, lit, radiance, full, False, seconds, shape.report, error)


def recolored(answer: Answer, light: Light) -> Answer | None:
    """The answer with the colors and powers of other lights; None if that is not sums alone."""
    if not (answer.recolors and answer.light.same_but_colors(light)):
        return None
    colors = []
    for old, new in zip(answer.light.core_lights, light.core_lights, strict=True):
        if old.power == 0.0 or new.power / old.power < 0.0:
            return None
        colors.append(np.multiply(new.color, new.power / old.power))
    started = time.perf_counter()
    radiance = core().diffuse_radiance(answer.lit.recolor(colors, transmitted=True))
    # It keeps the lights that it was solved for, so that the next colors are theirs times new ones.
    return answer._replace(radiance=radiance, full=False, seconds=time.perf_counter() - started)


def of_other_tissue(answer: Answer, key: BodyKey) -> np.ndarray | None:
    """The radiance of the answer's light in another tissue; None if it is of another body."""
    if key.medium is not None or answer.body.key.medium is not None or not answer.body.key.same_place(key):
        return None
    if answer.body.key.tissue == key.tissue:
        return answer.radiance  # other cells alone
    return radiance_of(answer.lit.with_tissue(tissue_of(key.tissue)))


def by_table(tiles: Tiles, colors: np.ndarray, texel_mapping: tuple[float, float]) -> np.ndarray:
    """What the table shows at the targets, (k, 3): until light is solved."""
    return core().table_at(colors, texel_mapping, tiles.thickness_mm)
