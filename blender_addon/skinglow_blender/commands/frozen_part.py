# SPDX-License-Identifier: GPL-3.0-or-later
"""Skins that share materials are frozen together: their frames' images, in one folder, and their node group."""

import os
import platform
import shutil
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import bpy
import numpy as np

from ..errors import SkinError, core
from ..identity import key_of
from ..read.file_skins import skins_of_file
from ..show.frozen import FILE_NAME, TILES_FILE_NAME, TileRange, frozen_pixels, is_frozen
from ..show.group_nodes import GroupNodes, build_nodes
from ..show.group_sockets import replace_group
from ..show.lut_image import ensure_images
from ..show.skin_group import new_group
from ..show.skin_material import skin_nodes
from ..show.tile_image import TILES
from ..whole_file import whole_file
from .exr_writing import write_exr
from .shown_in_render import Shown
from .skin import skin_settings_of

#: Folders that are not complete are kept this long, in seconds: another Blender may be writing them.
STALE_SECONDS = 3600.0
NOT_ALWAYS_TILES = (
    "it is lit through its shape in some of the frames only, and a frozen material does so in all or none: "
    "set Lighting to Per Pixel, or see in the panel why its shape cannot be used"
)


class FrozenPart:
    """Skins that share materials, and so a folder."""

    def __init__(self, skins: list[bpy.types.Object], parent: Path, taken: Iterable[str] = ()) -> None:
        """taken: names of the folders of other parts, which are not there yet."""
        self.skins = skins
        self.group = skins[0].skinglow.group
        self.nodes = GroupNodes()
        self.width = 0
        self.tiles: dict[int, TileRange] = {}  #: by row
        self.rows = 1 + max(obj.skinglow.row for obj in skins)
        self.marks: dict[int, str] = {}
        self.folder = free_folder(parent, bpy.path.clean_name(skins[0].name), taken)
        self.partial = parent / f".{self.folder.name}.{platform.node()}-{os.getpid()}.part"

    def take(self, shown: dict[str, Shown]) -> bool:
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

    def write(self, number: int, shown: dict[str, Shown]) -> None:
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

    def clear(self) -> None:
        """Removes what was written and did not get the folder's name."""
        shutil.rmtree(self.partial, ignore_errors=True)

    @property
    def tile_size(self) -> tuple[int, int]:
        """Width and height of the images of tiles."""
        return core().FaceTiles.WIDTH if self.tiles else 0, max((1, *map(sum, self.tiles.values())))


def group_of_its_own(part: FrozenPart) -> bpy.types.NodeTree:
    """The group of a part's skins; a new one if skins outside of it have the same."""
    skins = skins_of_file()
    if all(obj in part.skins for obj in skins if obj.skinglow.group == part.group):
        return part.group
    group = new_group()
    ensure_images(group, part.width, part.rows)
    build_nodes(group, part.nodes)
    if part.tiles:
        TILES.ensure(group, *part.tile_size)
    for node in set().union(*map(skin_nodes_of, part.skins)):
        replace_group(node, group)
    for obj in part.skins:
        obj.skinglow.group = group
    return group


def sharing_materials(wanted: list[bpy.types.Object]) -> list[list[bpy.types.Object]]:
    """The skins and all others of the file that share materials with them, those that share some together."""
    if not wanted:
        raise SkinError("There is no skin to freeze: create one with make_skin or the button Make Skin Glow")
    for obj in wanted:
        _check(obj)
    others = [obj for obj in skins_of_file() if obj not in wanted]
    parts: list[list[bpy.types.Object]] = []
    taken: set[bpy.types.Object] = set()
    for obj in wanted:
        if obj in taken:
            continue
        # By node: materials may share one in a group of the artist.
        part, nodes = [obj], skin_nodes_of(obj)
        grown = True
        while grown:
            more = [o for o in (*wanted, *others) if o not in part and skin_nodes_of(o) & nodes]
            for other in more:
                _check(other)
                nodes |= skin_nodes_of(other)
            part += more
            grown = bool(more)
        taken.update(part)
        parts.append(part)
    return parts


def skin_nodes_of(obj: bpy.types.Object) -> set[bpy.types.Node]:
    """The skin nodes of an object's materials."""
    materials = {slot.material for slot in obj.material_slots} - {None}
    return {node for material in materials for node in skin_nodes(material)}


def _check(obj: bpy.types.Object) -> None:
    """Raises SkinError for a skin that cannot be frozen."""
    group = skin_settings_of(obj).group
    if is_frozen(group):
        raise SkinError(f"'{obj.name}' is frozen already: unfreeze it first")
    nodes = skin_nodes_of(obj)
    if not nodes:
        raise SkinError(f"'{obj.name}': none of its materials has the Skinglow node: press Repair, or call make_skin")
    for owner in (obj, group, *(node.id_data for node in nodes)):
        if owner.library is not None:
            raise SkinError(f"'{obj.name}' belongs to {owner.library.filepath}: freeze it there, or make it local")


def free_folder(parent: Path, name: str, taken: Iterable[str] = ()) -> Path:
    """Folders are never written over: a farm may be reading them.

    taken  names of folders that are not there yet. Objects of several names may have one that files can have.
    """
    number, taken = 1, {each.casefold() for each in taken}
    while True:
        found = parent / (name if number == 1 else f"{name}_{number}")
        if not found.exists() and found.name.casefold() not in taken:
            return found
        number += 1


def clear_stale(parent: Path) -> None:
    """Removes what a Blender that died left behind."""
    for leftover in parent.glob(".*.part"):
        with suppress(OSError):
            if time.time() - leftover.stat().st_mtime > STALE_SECONDS:
                shutil.rmtree(leftover)


def _write_image(path: Path, pixels: np.ndarray) -> None:
    """Writes pixels (height, width, 4) as a float32 EXR by Blender's own writer, exactly; complete or not at all."""
    with whole_file(path) as partial:
        write_exr(partial, pixels)
