# SPDX-License-Identifier: GPL-3.0-or-later
"""Freezes the light of skins: what each frame of a range shows is written to images, which their materials then read.

What a render shows differs from what the viewport shows. So each frame is evaluated as for a render, with an engine
that draws nothing; the add-on's own handlers then show what they would show in a picture, and that is written.
"""

import os
import platform
import shutil
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError, core
from ..identity import key_of
from ..live.frozen_update import mark_of
from ..live.live_update import update_scene
from ..read.scene_reading import ROW_PROPERTY, read_scene
from ..session import SESSION
from ..show.frozen import (
    FILE_NAME,
    MARK_LENGTH,
    TILES_FILE_NAME,
    TileRange,
    file_number,
    freeze_group,
    frozen_folder,
    frozen_frames,
    frozen_pixels,
    is_frozen,
    unfreeze_group,
)
from ..show.group_nodes import GroupNodes, build_nodes, nodes_of
from ..show.group_sockets import replace_group
from ..show.lut_image import ensure_images, shown_image
from ..show.skin_group import new_group
from ..show.skin_material import skin_nodes
from ..show.tile_image import TILES, tiles_shown
from ..table.occlusion import with_visible_fractions
from .exr_writing import write_exr
from .skin import skin_settings_of

#: Where the folders go, one for each skin.
FOLDER = "//skinglow_frozen"
#: Folders that are not complete are kept this long, in seconds: another Blender may be writing them.
STALE_SECONDS = 3600.0
#: How often the nodes of a material may grow within the frames: each time all frames are written anew.
MAX_RESTARTS = 16


NOT_ALWAYS_TILES = (
    "it is lit through its shape in some of the frames only, and a frozen material does so in all or none: "
    "set Lighting to Per Pixel, or see in the panel why its shape cannot be used"
)


class Frozen(NamedTuple):
    """What `freeze` wrote for one material group of skins."""

    skins: tuple[str, ...]  #: names of the objects
    first: int  #: frame
    last: int
    folder: Path


class _Shown(NamedTuple):
    """What a skin shows in one frame of a render."""

    texels: np.ndarray  #: (width, 4)
    scale: tuple[float, float]  #: texels per mm, strength
    nodes: GroupNodes
    tiles: tuple[TileRange, np.ndarray] | None  #: with their pixels (rows, width, 4)


class _Evaluation(bpy.types.RenderEngine):
    """Evaluates the scene for a render and draws nothing."""

    bl_idname = "SKINGLOW_EVALUATION"
    bl_label = "Skinglow Evaluation"

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Called by Blender for each view layer, which it has evaluated."""


class _Part:
    """Skins that share materials, and so a folder."""

    def __init__(self, skins: list[bpy.types.Object], parent: Path) -> None:
        self.skins = skins
        self.group = skins[0].skinglow.group
        self.nodes = GroupNodes()
        self.width = 0
        self.tiles: dict[int, TileRange] = {}  #: by row
        self.rows = 1 + max(obj.skinglow.row for obj in skins)
        self.marks: dict[int, str] = {}
        self.folder = _free_folder(parent, bpy.path.clean_name(skins[0].name))
        self.partial = parent / f".{self.folder.name}.{platform.node()}-{os.getpid()}.part"

    def take(self, shown: dict[str, _Shown]) -> bool:
        """Returns whether these texels are laid out as those before; takes their layout if not."""
        is_first, before = not self.width, (self.nodes, self.width, dict(self.tiles))
        for obj in self.skins:
            each = shown.get(key_of(obj))
            if each is None:
                continue
            self.nodes, self.width = each.nodes, len(each.texels)
            if each.tiles is not None:
                self.tiles[obj.skinglow.row] = each.tiles[0]
        return is_first or before == (self.nodes, self.width, self.tiles)

    def write(self, number: int, shown: dict[str, _Shown]) -> None:
        """Writes the image of a frame, complete under its name or not at all."""
        rows, scales = np.zeros((self.rows, max(self.width, 1), 4), np.float32), np.zeros((self.rows, 2), np.float32)
        width, height = self.tile_size
        tiles = np.zeros((height, width, 4), np.float32)
        for obj in self.skins:
            each, row = shown.get(key_of(obj)), obj.skinglow.row
            if each is None:
                continue
            rows[row], scales[row] = each.texels, each.scale
            if each.tiles is not None:
                (first_row, count), pixels = each.tiles
                tiles[first_row : first_row + count] = pixels
            elif row in self.tiles:
                raise SkinError(f"{obj.name}: {NOT_ALWAYS_TILES}")
        self.partial.mkdir(parents=True, exist_ok=True)
        _write_image(self.partial / FILE_NAME.format(number), frozen_pixels(rows, scales))
        if self.tiles:
            _write_image(self.partial / TILES_FILE_NAME.format(number), tiles)

    @property
    def tile_size(self) -> tuple[int, int]:
        """Width and height of the images of tiles."""
        return core().FaceTiles.WIDTH if self.tiles else 0, max((1, *map(sum, self.tiles.values())))


class Freezing:
    """Freezes a range of frames, one a step, so that a window can show how far it is.

    Nothing is changed in the file before `finish`, and folders get their name when all their images are complete.
    """

    def __init__(
        self, skins: Iterable[bpy.types.Object], first: int, last: int, folder: str, scene: bpy.types.Scene
    ) -> None:
        groups = _sharing_materials(list(skins))
        if scene.camera is None and not any(marker.camera for marker in scene.timeline_markers):
            raise SkinError(f"Scene '{scene.name}' has no camera: add one, or set it in the Scene properties")
        if last < first:
            raise SkinError(f"The frames {first} to {last} are reversed: the first one has to come first")
        if folder.startswith("//") and not bpy.data.filepath:
            raise SkinError("Save the file first: the images are written next to it")
        self.scene, self.first, self.last = scene, first, last
        self.before = scene.frame_current, scene.frame_subframe
        parent = Path(bpy.path.abspath(folder)).absolute()
        self.parts = [_Part(each, parent) for each in groups]
        self.frame = first
        self._restarts = 0
        try:
            parent.mkdir(parents=True, exist_ok=True)
            _clear_stale(parent)
        except OSError as error:
            raise SkinError(f"Cannot write to {parent}: {error.strerror or error}") from error

    @property
    def done(self) -> float:
        """The fraction of the frames that is written, 0 to 1."""
        return (self.frame - self.first) / (self.last - self.first + 1)

    def step(self) -> bool:
        """Writes one frame; returns whether there are more."""
        self.scene.frame_set(self.frame)
        marks = _marks(self.scene)
        shown = _shown_in_render(self.scene)
        if not all([part.take(shown) for part in self.parts]):
            self._restart()
            return True
        for part in self.parts:
            for obj in part.skins:
                row = obj.skinglow.row
                if key_of(obj) in shown or row in part.marks:
                    before = part.marks.get(row, " " * (MARK_LENGTH * (self.frame - self.first)))
                    part.marks[row] = before + marks.get(key_of(obj), "").ljust(MARK_LENGTH)
            try:
                part.write(file_number(self.frame, self.first), shown)
            except OSError as error:
                raise SkinError(f"Cannot write to {part.partial}: {error.strerror or error}") from error
        self.frame += 1
        return self.frame <= self.last

    def _restart(self) -> None:
        """All frames have one layout: the largest, which the nodes have from now on."""
        self._restarts += 1
        if self._restarts > MAX_RESTARTS:
            raise SkinError("The lookup changes its size from frame to frame: set Table Size and Lighting to one value")
        self.frame = self.first
        for part in self.parts:
            part.marks.clear()

    def finish(self) -> list[Frozen]:
        """Gives the folders their names and makes the materials read them."""
        self.scene.frame_set(self.before[0], subframe=self.before[1])
        for part in self.parts:
            if not part.marks:
                names = ", ".join(obj.name for obj in part.skins)
                raise SkinError(f"{names}: not rendered in scene '{self.scene.name}' in any of the frames")
        frozen = []
        for part in self.parts:
            os.rename(part.partial, part.folder)
            group = _group_of_its_own(part)
            tiles = (*part.tile_size, part.tiles) if part.tiles else None
            freeze_group(group, part.folder, (self.first, self.last), (part.width, part.rows), part.marks, tiles)
            names = tuple(obj.name for obj in part.skins)
            frozen.append(Frozen(names, self.first, self.last, part.folder))
        SESSION.forget_tables()
        update_scene(bpy.context.evaluated_depsgraph_get())
        return frozen

    def cancel(self) -> None:
        """Removes what was written, and returns to the frame that was shown."""
        self.clear()
        self.scene.frame_set(self.before[0], subframe=self.before[1])

    def clear(self) -> None:
        """Removes what was written and did not become a folder of its own."""
        for part in self.parts:
            shutil.rmtree(part.partial, ignore_errors=True)


def freeze(
    objects: Iterable[bpy.types.Object] | None = None,
    first: int | None = None,
    last: int | None = None,
    folder: str | os.PathLike = FOLDER,
    *,
    scene: bpy.types.Scene | None = None,
    progress: Callable[[float], bool | None] | None = None,
) -> list[Frozen]:
    """Writes what skins show in each frame to images, which their materials read from now on, with or without add-on.

    objects   skins; None: all of the scene. Skins that share a material are frozen together
    first     frame; None: the scene's first
    last      frame; None: the scene's last
    folder    where a folder for each skin is made; "//" is the blend file's folder. Existing folders are kept
    scene     None: the context's
    progress  called with the fraction of the frames that is written; returns False to cancel
    Raises SkinError if it cannot be done or was canceled; nothing is changed then.
    """
    scene = scene or bpy.context.scene
    if objects is None:
        objects = [obj for obj in scene.objects if obj.type == "MESH" and obj.skinglow.enabled]
    first = scene.frame_start if first is None else first
    last = scene.frame_end if last is None else last
    freezing = Freezing(objects, first, last, str(folder), scene)
    try:
        while freezing.step():
            if progress is not None and progress(freezing.done) is False:
                raise SkinError("Freezing was canceled: nothing was changed")
        return freezing.finish()
    except BaseException:
        freezing.cancel()
        raise


def unfreeze(objects: Iterable[bpy.types.Object] | None = None) -> list[str]:
    """Makes frozen skins follow the lights again, and all that share their materials; returns the names of all.

    objects  skins; None: all that are frozen in the file. The folders with the images are kept.
    """
    if SESSION.rendering:
        raise SkinError("Skins cannot be unfrozen while Blender renders: wait until it ends")
    skins = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.skinglow.enabled]
    groups = {obj.skinglow.group for obj in (skins if objects is None else objects)}
    names = []
    for group in groups:
        if not is_frozen(group):
            continue
        if group.library is not None:
            raise SkinError(f"The material was frozen in {group.library.filepath}: unfreeze it there")
        nodes = nodes_of(group)
        unfreeze_group(group)
        build_nodes(group, nodes)
        names += [obj.name for obj in skins if obj.skinglow.group == group]
    SESSION.forget_tables()
    update_scene(bpy.context.evaluated_depsgraph_get())
    return names


def frozen_state(obj: bpy.types.Object) -> Frozen | None:
    """How a skin is frozen; None: it is live."""
    group = obj.skinglow.group
    if not is_frozen(group) or shown_image(group) is None:
        return None
    return Frozen((obj.name,), *frozen_frames(group), frozen_folder(group))


def _sharing_materials(wanted: list[bpy.types.Object]) -> list[list[bpy.types.Object]]:
    """The skins and all others of the file that share materials with them, those that share some together."""
    if not wanted:
        raise SkinError("There is no skin to freeze: create one with make_skin or the button Make Skin Glow")
    for obj in wanted:
        _check(obj)
    others = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.skinglow.enabled and obj not in wanted]
    parts: list[list[bpy.types.Object]] = []
    taken: set[bpy.types.Object] = set()
    for obj in wanted:
        if obj in taken:
            continue
        # By node: materials may share one in a group of the artist.
        part, nodes = [obj], _nodes_of(obj)
        grown = True
        while grown:
            more = [o for o in (*wanted, *others) if o not in part and _nodes_of(o) & nodes]
            for other in more:
                _check(other)
                nodes |= _nodes_of(other)
            part += more
            grown = bool(more)
        taken.update(part)
        parts.append(part)
    return parts


def _nodes_of(obj: bpy.types.Object) -> set[bpy.types.Node]:
    """The skin nodes of an object's materials."""
    materials = {slot.material for slot in obj.material_slots} - {None}
    return {node for material in materials for node in skin_nodes(material)}


def _check(obj: bpy.types.Object) -> None:
    """Raises SkinError for a skin that cannot be frozen."""
    group = skin_settings_of(obj).group
    if is_frozen(group):
        raise SkinError(f"'{obj.name}' is frozen already: unfreeze it first")
    nodes = _nodes_of(obj)
    if not nodes:
        raise SkinError(f"'{obj.name}': none of its materials has the Skinglow node: press Repair, or call make_skin")
    for owner in (obj, group, *(node.id_data for node in nodes)):
        if owner.library is not None:
            raise SkinError(f"'{obj.name}' belongs to {owner.library.filepath}: freeze it there, or make it local")


def _free_folder(parent: Path, name: str) -> Path:
    """Folders are never written over: a farm may be reading them."""
    number = 1
    while True:
        found = parent / (name if number == 1 else f"{name}_{number}")
        if not found.exists():
            return found
        number += 1


def _clear_stale(parent: Path) -> None:
    """Removes what a Blender that died left behind."""
    for leftover in parent.glob(".*.part"):
        with suppress(OSError):
            if time.time() - leftover.stat().st_mtime > STALE_SECONDS:
                shutil.rmtree(leftover)


def _marks(scene: bpy.types.Scene) -> dict[str, str]:
    """By skin: the mark of what its light depends on in the viewport, where health() compares it later."""
    if scene != bpy.context.scene:
        return {}
    depsgraph = bpy.context.evaluated_depsgraph_get()
    reading = with_visible_fractions(read_scene(depsgraph), depsgraph, {})
    return {skin.key: mark_of(obj, skin, reading) for obj, skin in reading.skins}


def _shown_in_render(scene: bpy.types.Scene) -> dict[str, _Shown]:
    """What the skins show in a render of the frame that the scene is at."""
    found: dict[str, _Shown] = {}
    faults: list[str] = []

    def look(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        if depsgraph.mode != "RENDER":
            return
        faults.extend(SESSION.faults.values())
        for obj, shown in _rows_shown(depsgraph):
            before = found.setdefault(key_of(obj), shown)
            if not _shows_the_same(before, shown):
                faults.append(
                    f"{obj.name}: view layers light it differently, and a frozen material can show one of them: "
                    "turn off Use for Rendering of the others"
                )

    # The add-on's own handler runs before this one.
    bpy.app.handlers.frame_change_post.append(look)
    try:
        with _evaluating(scene):
            bpy.ops.render.render("EXEC_DEFAULT", scene=scene.name)
    except RuntimeError as error:
        raise SkinError(f"Frame {scene.frame_current} cannot be evaluated: {' '.join(str(error).split())}") from error
    finally:
        bpy.app.handlers.frame_change_post.remove(look)
    if faults:
        raise SkinError(f"Frame {scene.frame_current}: {'; '.join(dict.fromkeys(faults))}")
    return found


def _shows_the_same(a: _Shown, b: _Shown) -> bool:
    if not np.array_equal(a.texels, b.texels) or a.scale != b.scale or (a.tiles is None) != (b.tiles is None):
        return False
    return a.tiles is None or (a.tiles[0] == b.tiles[0] and np.array_equal(a.tiles[1], b.tiles[1]))


def _rows_shown(depsgraph: bpy.types.Depsgraph) -> Iterator[tuple[bpy.types.Object, _Shown]]:
    for obj, skin in SESSION.reading[1].skins:
        group = obj.skinglow.group
        atlas = SESSION.atlases.get((key_of(group), depsgraph.mode)) if group is not None else None
        if atlas is not None and skin.key in atlas.tables:
            scale, _width, _row, strength = obj[ROW_PROPERTY]
            texels = atlas.pixels[obj.skinglow.row].copy()
            yield obj, _Shown(texels, (scale, strength), nodes_of(group), _tiles_of(obj, depsgraph.mode))


def _tiles_of(obj: bpy.types.Object, mode: str) -> tuple[TileRange, np.ndarray] | None:
    found = tiles_shown(obj, mode)
    return (TileRange(found[0], len(found[1])), found[1]) if found is not None else None


@contextmanager
def _evaluating(scene: bpy.types.Scene) -> Iterator[None]:
    """Context manager in which a render only evaluates the scene, as for the scene's own engine."""
    render = scene.render
    with ExitStack() as undo:
        bpy.utils.register_class(_Evaluation)
        undo.callback(bpy.utils.unregister_class, _Evaluation)
        blender_version.STANDS_FOR[_Evaluation.bl_idname] = render.engine
        undo.callback(blender_version.STANDS_FOR.pop, _Evaluation.bl_idname)
        wanted = {"engine": _Evaluation.bl_idname, "use_compositing": False, "use_sequencer": False}
        for name, value in {**wanted, "use_lock_interface": True}.items():
            undo.callback(setattr, render, name, getattr(render, name))
            setattr(render, name, value)
        yield


def _group_of_its_own(part: _Part) -> bpy.types.NodeTree:
    """The group of a part's skins; a new one if skins outside of it have the same."""
    skins = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.skinglow.enabled]
    if all(obj in part.skins for obj in skins if obj.skinglow.group == part.group):
        return part.group
    group = new_group()
    ensure_images(group, part.width, part.rows)
    build_nodes(group, part.nodes)
    if part.tiles:
        TILES.ensure(group, *part.tile_size)
    for node in set().union(*map(_nodes_of, part.skins)):
        replace_group(node, group)
    for obj in part.skins:
        obj.skinglow.group = group
    return group


def _write_image(path: Path, pixels: np.ndarray) -> None:
    """Writes pixels (height, width, 4) as a float32 EXR by Blender's own writer, exactly; complete or not at all."""
    partial = path.with_name(f".{path.name}.part.exr")
    write_exr(partial, pixels)
    with partial.open("rb+") as file:
        os.fsync(file.fileno())
    os.replace(partial, path)
