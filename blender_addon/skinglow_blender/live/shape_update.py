# SPDX-License-Identifier: GPL-3.0-or-later
"""What an update does for skins that are lit through their shape.

A picture never waits: until light is solved, the table stands in. In a window a thread solves it, coarsely first, and a
timer shows what it found (shape_answers.py); renders and background mode wait for the full answer.
"""

import os
from typing import Any, NamedTuple

import bpy

from ..errors import SkinError
from ..identity import key_of
from ..read.measured_size import scale_since_measured
from ..read.mesh_reading import evaluated_mesh
from ..read.scene_lights import make_light
from ..read.scene_reading import SceneReading, Skin
from ..read.shown_mesh import ShownMesh, ShownMeshes, body_mesh
from ..session import SESSION
from ..table.shape_light import (
    Answer,
    Body,
    BodyKey,
    Light,
    Tiles,
    by_table,
    of_other_tissue,
    recolored,
    solve,
)
from ..table.skin_tables import Table
from ..thickness import thickness_attribute
from ..thickness.tile_attribute import TILES_OF_MESH, encloses_flesh, is_of_this_mesh, rows_of
from .newest_wins import NewestWins
from .waiting import interruptible, may_go_on

#: Fraction of the tiled area that may be covered twice, or lie between two tiles.
MAX_UNFIT = 0.01
#: Seconds without another change after which colors and tissues, which are shown at once, are solved anew.
REST = 0.4
#: Errors of the core that are told to the user.
FAILURES = (ValueError, RuntimeError, MemoryError, SkinError, ImportError)


CANCELED = "canceled before its light was solved: it shows the lookup by thickness"


class Unfit(NamedTuple):
    """Why the light of a skin cannot be shown through its shape."""

    why: str
    remedy: str


APPLY = "apply them (Object > Apply > Visual Geometry to Mesh), then press Repair"
NO_TILES = Unfit("its faces have no texels yet", "press Repair")
EDITED = Unfit("its faces were edited after they were given texels", "press Repair")
LINKED = Unfit(
    "its mesh is linked from a library, where it has no tiles",
    "make the skin in that file, or make object and data local",
)
ALL_THICK = Unfit("it is so thick everywhere that no light comes through", "look whether Unit is right")
NO_FLESH = Unfit(
    "its faces enclose no flesh, as an open sheet does",
    "close the mesh, or give it thickness: a Solidify modifier with Fill, applied (Object > Apply > Visual Geometry to "
    "Mesh), then Repair",
)
EDIT_MODE = Unfit("it is in Edit Mode", "leave it (Tab)")
OVERLAPPING = Unfit("its modifiers show the same faces more than once, as Mirror and Array do", APPLY)
NO_NODES = Unfit(
    "its material has no nodes for that, and nodes cannot be added to a library's material nor while rendering",
    "make the material local, or update before rendering",
)
MIXED = Unfit("its modifiers make faces anew, as Decimate, Remesh and Weld do", APPLY)


class Shown(NamedTuple):
    """What a skin's tiles show."""

    tiles: Tiles
    radiance: Any  #: (k, 3) at the targets, linear Rec.709
    answer: Answer | None  #: None: the table stands in


class ShapeState:
    """One skin in one depsgraph mode."""

    def __init__(self) -> None:
        self.mesh: ShownMesh | None = None
        self.reason: Unfit | None = None  #: None: its light can be shown through its shape
        self.mesh_reason: Unfit | None = None  #: the same as far as the mesh is the reason
        self.tiles: Tiles | None = None
        self.key: BodyKey | None = None
        self.body: Body | None = None
        self.light: Light | None = None  #: that falls on it
        self.shown: Shown | None = None
        self.answer: Answer | None = None  #: the last one that was solved
        #: The answer that is shown in another tissue until that is solved, and the tissue.
        self.quick: tuple[Answer, tuple[float, ...]] | None = None
        self.fault = ""

    @property
    def is_full(self) -> bool:
        """Whether what is shown is the full answer."""
        answer = self.shown.answer if self.shown is not None else None
        return answer is not None and answer.full and answer.body is self.body and answer.light.same(self.light)

    @property
    def is_canceled(self) -> bool:
        """Whether the user ended the wait for its light."""
        return self.fault == CANCELED

    def receive(self, answer: Answer | BaseException) -> bool:
        """Takes an answer of the body; returns whether there is something new to show."""
        if isinstance(answer, BaseException):
            self.fault = f"light through its shape failed: {answer}"
            return False
        if answer.body is not self.body:
            return False
        is_new = self.answer is None or answer.lit is not self.answer.lit
        self.answer, self.fault = answer, ""
        # While a hand moves on, what it was a moment ago is better than what it was before; what is exact is not.
        if is_new and not (self.is_full and not answer.light.same(self.light)):
            self.shown = Shown(answer.body.tiles, answer.radiance, answer)
        return is_new


def worker() -> NewestWins:
    """The thread that solves light for windows."""
    if SESSION.shape_worker is None:
        SESSION.shape_worker = NewestWins("Skinglow shape")
    return SESSION.shape_worker


def state_of(key: str, mode: str) -> ShapeState | None:
    """The state of a skin; None: none of its light was asked for."""
    return SESSION.shapes.get((key, mode))


def is_synchronous(mode: str) -> bool:
    """Whether an update waits for the full answer."""
    return bpy.app.background or mode == "RENDER"


def start(depsgraph: bpy.types.Depsgraph) -> None:
    """Begins an update of skins that are lit through their shape, before their nodes are changed."""
    if SESSION.shown_meshes is None:
        SESSION.shown_meshes = ShownMeshes()
    SESSION.shown_meshes.start(depsgraph)


def prepare(obj: bpy.types.Object, skin: Skin, depsgraph: bpy.types.Depsgraph, has_nodes: bool) -> ShapeState:
    """Reads the mesh of a skin that is lit through its shape, and finds out whether it can be.

    has_nodes  whether its material has, or can be given, the nodes for that
    """
    state = SESSION.shapes.setdefault((skin.key, depsgraph.mode), ShapeState())
    state.reason = NO_NODES if not has_nodes else _reason_of_mesh(state, obj, skin, depsgraph)
    return state


def _reason_of_mesh(
    state: ShapeState, obj: bpy.types.Object, skin: Skin, depsgraph: bpy.types.Depsgraph
) -> Unfit | None:
    evaluated = obj.evaluated_get(depsgraph)
    if evaluated.mode == "EDIT" or obj.mode == "EDIT":
        # What was shown before goes on being shown: nothing is solved in a mesh that is being edited.
        return None if state.shown is not None else EDIT_MODE
    mesh = SESSION.shown_meshes.read(evaluated, depsgraph)
    settings = skin.shape
    key = BodyKey(
        mesh.version,
        rows_of(obj.data),
        settings.frame,
        settings.unit_mm,
        settings.cell_mm,
        settings.medium,
        skin.base[3],
    )
    is_new = state.mesh is None or state.mesh.version != mesh.version
    state.mesh = mesh
    if is_new or state.tiles is None or not state.key.same_place(key):
        state.tiles = None
        state.mesh_reason = _reason_without_tiles(obj, mesh)
        if state.mesh_reason is None:
            state.tiles = _tiles_of(skin, key) or _new_tiles(evaluated, mesh, skin, key)
            state.mesh_reason = _reason_of(state.tiles)
    state.key = key
    return state.mesh_reason


def _reason_without_tiles(obj: bpy.types.Object, mesh: ShownMesh) -> Unfit | None:
    if TILES_OF_MESH not in obj.data:
        return LINKED if obj.data.library is not None else NO_TILES
    if rows_of(obj.data) == 0:
        return ALL_THICK if encloses_flesh(obj.data) else NO_FLESH
    if not is_of_this_mesh(obj.data):
        return EDITED
    return MIXED if mesh.texels is None or not mesh.texels.any() else None


def _reason_of(tiles: Tiles) -> Unfit | None:
    if tiles.targets.overlapping > MAX_UNFIT:
        return OVERLAPPING
    return MIXED if tiles.targets.mixed > MAX_UNFIT else None


def _tiles_of(skin: Skin, key: BodyKey) -> Tiles | None:
    """Tiles of the same place in the other depsgraph mode."""
    for mode in ("VIEWPORT", "RENDER"):
        other = state_of(skin.key, mode)
        if other is not None and other.tiles is not None and other.key.same_place(key):
            return other.tiles
    return None


def _new_tiles(evaluated: bpy.types.Object, mesh: ShownMesh, skin: Skin, key: BodyKey) -> Tiles:
    with evaluated_mesh(evaluated) as data:
        thickness_mm, _known = thickness_attribute.read(data)
    thickness_mm = thickness_mm * scale_since_measured(evaluated.original.data, skin.world_size)
    return Tiles(body_mesh(mesh, key.frame), key.rows, key.unit_mm, thickness_mm)


def follow(state: ShapeState, skin: Skin, table: Table, reading: SceneReading, mode: str) -> None:
    """Has the light of a prepared skin solved, and shows at once what is known of it. Its fault is in the state."""
    if state.tiles is None:
        return  # in Edit Mode
    light = light_of(skin, reading)
    at_once = is_synchronous(mode)
    before = state.light
    if state.body is None or state.body.tiles is not state.tiles or not state.body.key.same_body(state.key):
        state.body = _body_of(skin, state)
        before = None
    is_asked = before is not None and before.same(light)
    state.light = light
    if is_asked and (not at_once or state.is_full):
        return
    state.fault = ""
    answer = _solved_before(skin, state)
    if answer is not None:
        state.answer, state.shown = answer, Shown(state.tiles, answer.radiance, answer)
        _drop(skin.key, mode)
    elif at_once:
        _drop(skin.key, mode)
        _solve_now(state)
    else:
        body, shown = state.body, _show_at_once(state)
        # What is shown at once is better than a coarse answer.
        worker().submit(
            skin.key,
            lambda progress: solve(body, light, progress, coarse=not shown, recolors=True),
            delay=REST if shown else 0.0,
            abandon=before is None,
        )
    if state.shown is None or state.shown.tiles is not state.tiles:
        state.shown = Shown(state.tiles, by_table(state.tiles, table.colors, table.texel_mapping), None)


def keep(state: ShapeState, skin: Skin) -> bool:
    """Whether a skin that is not live goes on showing what it shows, in this depsgraph mode or in the other."""
    if state.tiles is None:
        return True
    for mode in ("VIEWPORT", "RENDER"):
        other = state_of(skin.key, mode)
        if other is not None and other.shown is not None and other.shown.tiles is state.tiles:
            state.shown = state.shown if state.shown is not None else other.shown
            return state.shown.tiles is state.tiles
    return False


def mesh_version(key: str, mode: str) -> int | None:
    """The version of the mesh that light is solved in."""
    state = state_of(key, mode)
    return state.mesh.version if state is not None and state.mesh is not None else None


def light_of(skin: Skin, reading: SceneReading) -> Light:
    """What falls on a skin, with all that stands in the way."""
    lights = [light for light in reading.lights if not light.unlit_reason and light.lights(skin.key)]
    traced = reading.occluders
    world = reading.world.environment.coefficients if reading.world is not None else None
    return Light(
        lights=tuple(light.signature[1:] for light in lights),
        core_lights=tuple(make_light(light) for light in lights),
        shadowless=tuple(i for i, light in enumerate(lights) if not light.casts_shadows),
        world=tuple(world.ravel().tolist()) if world is not None else (),
        frame=skin.shape.frame,
        reentries=skin.shape.reentries,
        occluders=traced.version if traced is not None else -1,
        own=tuple([traced.own[skin.key]] if traced is not None and skin.key in traced.own else []),
        scene=traced.scene if traced is not None else None,
    )


def _body_of(skin: Skin, state: ShapeState) -> Body:
    """The body to solve in: that of the last answer or of the other depsgraph mode, where it is the same."""
    for mode in ("VIEWPORT", "RENDER"):
        other = state_of(skin.key, mode)
        if other is None:
            continue
        for body in (other.body, other.answer.body if other.answer is not None else None):
            if body is not None and body.tiles is state.tiles and body.key.same_body(state.key):
                return body
    # A window goes on drawing meanwhile.
    threads = 0 if bpy.app.background else max((os.cpu_count() or 1) - 1, 1)
    return Body(state.key, state.tiles, threads)


def _solved_before(skin: Skin, state: ShapeState) -> Answer | None:
    """The full answer that was found before, in either mode."""
    for mode in ("VIEWPORT", "RENDER"):
        other = state_of(skin.key, mode)
        answer = other.answer if other is not None else None
        if answer is not None and answer.full and answer.body is state.body and answer.light.same(state.light):
            return answer
    return None


def _drop(key: str, mode: str) -> None:
    if mode == "VIEWPORT" and SESSION.shape_worker is not None:
        SESSION.shape_worker.drop(lambda other: other == key)


def _solve_now(state: ShapeState) -> None:
    try:
        with interruptible():
            for answer in solve(state.body, state.light, may_go_on, coarse=False, recolors=False):
                state.receive(answer)
    except FAILURES as error:
        state.receive(error)
        if SESSION.interrupted:
            state.fault = CANCELED


def _show_at_once(state: ShapeState) -> bool:
    """Shows other colors and tissues by what was solved; returns whether that could be done."""
    answer = state.answer
    if answer is None:
        return False
    try:
        if answer.body is state.body:
            quick = recolored(answer, state.light)
            if quick is not None:
                state.shown = Shown(state.tiles, quick.radiance, quick)
                return True
        elif answer.body.tiles is state.tiles:
            quick = state.quick
            # While a light moves on, it is the same.
            if quick is not None and quick[0] is answer and quick[1] == state.key.tissue:
                return state.shown is not None and state.shown.tiles is state.tiles
            radiance = of_other_tissue(answer, state.key)
            if radiance is not None:
                state.shown = Shown(state.tiles, radiance, answer._replace(full=False))
                state.quick = answer, state.key.tissue
                return True
    except FAILURES:
        return False
    return False


class ShapeReport(NamedTuple):
    """How the light of a skin through its shape was found."""

    shown: str  #: 'TABLE' (stands in until light is solved), 'COARSE' or 'FULL'
    progress: float | None  #: fraction done of what is being solved; None: nothing is
    parts: int  #: thin parts of the body
    ready_parts: int  #: of them those that light fell on, which are solved
    cells: int
    bytes: int
    points: int  #: that the texels show
    thick_points: int  #: of them those in no thin part, through which no light comes
    milliseconds: float | None  #: that the last answer took; None: it was the first
    first_seconds: float | None  #: that its first light took, as in each frame in which the mesh deforms
    error: tuple[float, ...]  #: (r, g, b): estimated error, RMS over mean; empty before the full answer
    reason: Unfit | None  #: why the skin is lit per pixel instead; None: it is not


def shape_report(obj: bpy.types.Object, mode: str = "VIEWPORT") -> ShapeReport | None:
    """The report of a skin; None where its light does not go through its shape."""
    state = state_of(key_of(obj), mode)
    if state is None or obj.skinglow.mode != "PHYSICAL" or obj.skinglow.weights != "SHAPE":
        return None
    answer = state.shown.answer if state.shown is not None else None
    report: dict[str, Any] = answer.report if answer is not None else {}
    progress = SESSION.shape_worker.progress(key_of(obj)) if SESSION.shape_worker is not None else None
    return ShapeReport(
        shown="TABLE" if answer is None else "FULL" if state.is_full else "COARSE",
        progress=progress if mode == "VIEWPORT" else None,
        parts=report.get("parts", 0),
        ready_parts=report.get("ready_parts", 0),
        cells=report.get("cells", 0),
        bytes=report.get("bytes", 0),
        points=report.get("points", 0),
        thick_points=report.get("points", 0) - report.get("points_in_parts", 0),
        milliseconds=1000.0 * answer.seconds if answer is not None and answer.seconds is not None else None,
        first_seconds=answer.body.first_seconds if answer is not None else None,
        error=answer.error if answer is not None else (),
        reason=state.reason,
    )


def forget_lost(skins: set[str]) -> None:
    """Drops what is held of objects that are gone; `skins` are some that are there."""
    lost = {key for key, _mode in SESSION.shapes} - skins
    if not lost:
        return
    lost -= {key_of(obj) for obj in bpy.data.objects if obj.skinglow.enabled and obj.skinglow.weights == "SHAPE"}
    forget(lost)


def forget(keys: set[str] | None = None) -> None:
    """Drops what is held of these skins; None: of all."""
    if keys is None:
        keys = {key for key, _mode in SESSION.shapes}
    for each in [each for each in SESSION.shapes if each[0] in keys]:
        del SESSION.shapes[each]
    if SESSION.shown_meshes is not None:
        SESSION.shown_meshes.forget(keys)
    if SESSION.shape_worker is not None:
        SESSION.shape_worker.drop(lambda key: key in keys)
