# SPDX-License-Identifier: GPL-3.0-or-later
"""Freezes the light of skins: what each frame shows is written to images, which their materials then read."""

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

import bpy

from ..errors import SkinError
from ..identity import key_of
from ..live.frozen_update import mark_of
from ..live.live_update import update_scene
from ..live.waiting import require_uninterrupted
from ..read.file_skins import skins_of_file
from ..read.scene_reading import read_scene
from ..session import SESSION
from ..show.frozen import (
    MARK_LENGTH,
    file_number,
    freeze_group,
    frozen_folder,
    frozen_frames,
    is_frozen,
    unfreeze_group,
)
from ..show.group_nodes import build_nodes, nodes_of
from ..show.lut_image import shown_image
from ..table.occlusion import with_visible_fractions
from .frozen_part import FrozenPart, clear_stale, group_of_its_own, sharing_materials
from .shown_in_render import shown_in_render

#: Where the folders go, one for each skin.
FOLDER = "//skinglow_frozen"
#: How often the nodes of a material may grow within the frames: each time all frames are written anew.
MAX_RESTARTS = 16


class Frozen(NamedTuple):
    """What `freeze` wrote for one material group of skins."""

    skins: tuple[str, ...]  #: names of the objects
    first: int  #: frame
    last: int
    folder: Path


class Freezing:
    """Freezes a range of frames, one a step, so that a window can show how far it is.

    Nothing is changed in the file before `finish`, and folders get their name when all their images are complete.
    """

    def __init__(
        self, skins: Iterable[bpy.types.Object], first: int, last: int, folder: str, scene: bpy.types.Scene
    ) -> None:
        groups = sharing_materials(list(skins))
        if scene.camera is None and not any(marker.camera for marker in scene.timeline_markers):
            raise SkinError(f"Scene '{scene.name}' has no camera: add one, or set it in the Scene properties")
        if last < first:
            raise SkinError(f"The frames {first} to {last} are reversed: the first one has to come first")
        if folder.startswith("//") and not bpy.data.filepath:
            raise SkinError("Save the file first: the images are written next to it")
        self.scene, self.first, self.last = scene, first, last
        self.before = scene.frame_current, scene.frame_subframe
        parent = Path(bpy.path.abspath(folder)).absolute()
        self.parts: list[FrozenPart] = []
        for each in groups:
            self.parts.append(FrozenPart(each, parent, [part.folder.name for part in self.parts]))
        self.frame = first
        self._restarts = 0
        try:
            parent.mkdir(parents=True, exist_ok=True)
            clear_stale(parent)
        except OSError as error:
            raise SkinError(f"Cannot write to {parent}: {error.strerror or error}") from error

    @property
    def done(self) -> float:
        """The fraction of the frames that is written, 0 to 1."""
        return (self.frame - self.first) / (self.last - self.first + 1)

    def step(self) -> bool:
        """Writes one frame; returns whether there are more."""
        self.scene.frame_set(self.frame)
        require_uninterrupted()
        marks = _marks(self.scene)
        shown = shown_in_render(self.scene)
        require_uninterrupted()
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
            group = group_of_its_own(part)
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
            part.clear()


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
    skins = skins_of_file()
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


def _marks(scene: bpy.types.Scene) -> dict[str, str]:
    """By skin: the mark of what its light depends on in the viewport, where health() compares it later."""
    if scene != bpy.context.scene:
        return {}
    depsgraph = bpy.context.evaluated_depsgraph_get()
    reading = with_visible_fractions(read_scene(depsgraph), depsgraph, {})
    return {skin.key: mark_of(obj, skin, reading) for obj, skin in reading.skins}
