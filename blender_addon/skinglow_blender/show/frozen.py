# SPDX-License-Identifier: GPL-3.0-or-later
"""Frozen groups: their nodes read an image sequence in place of the live lookups, so that a Blender without the add-on
renders the same.

An image of the sequence has twice as many rows as there are skins: the lower half holds what the rows of the lookup
image held, the upper half what changes with the frames in the object's property. That property keeps the position of
the row alone, and 1 in place of the strength: an object without it still does not glow.

Where skins are lit through their shape, a second sequence holds their tiles.
"""

import os
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..read.scene_reading import ROW_PROPERTY
from .image_pairs import SLOTS, GroupImages, delete_images, read_pixels
from .lut_image import FROZEN_PROPERTY, HEADER_NODE, ROWS, shown_image
from .node_building import NodeBuilder, Socket
from .tile_image import DARK, TILES

#: Files of a sequence: Blender takes the last number of a name for the frame's.
FILE_NAME, TILES_FILE_NAME = "light_{:04d}.exr", "tiles_{:04d}.exr"
#: Characters of a mark in the group's property (marks of frozen frames, commands/freezing.py).
MARK_LENGTH = 8


def is_frozen(group: bpy.types.NodeTree | None) -> bool:
    """Whether a skin group shows an image sequence."""
    return group is not None and FROZEN_PROPERTY in group


def frozen_frames(group: bpy.types.NodeTree) -> tuple[int, int]:
    """First and last frame of a frozen group."""
    stored = group[FROZEN_PROPERTY]
    return stored["first"], stored["last"]


def frozen_folder(group: bpy.types.NodeTree) -> Path:
    """The folder of a frozen group's images."""
    image = shown_image(group)
    return Path(os.path.normpath(bpy.path.abspath(image.filepath, library=image.library))).parent


def file_number(frame: int, first: int) -> int:
    """The number in the file name of a frame: the frame's own, unless the sequence begins below 1."""
    return frame - first + max(first, 1)


def frozen_file(group: bpy.types.NodeTree, frame: int) -> Path:
    """The file with the rows that a frozen group shows at a frame: outside of the sequence its nearest one."""
    return _files(group, frame)[0]


def missing_file(group: bpy.types.NodeTree, frame: int) -> Path | None:
    """A file that a frozen group shows at a frame and that is not there."""
    wanted = _files(group, frame)
    if group[FROZEN_PROPERTY].get("tiles") is None:
        del wanted[1:]
    return next((file for file in wanted if not file.is_file()), None)


def _files(group: bpy.types.NodeTree, frame: int) -> list[Path]:
    first, last = frozen_frames(group)
    number = file_number(min(max(frame, first), last), first)
    return [frozen_folder(group) / name.format(number) for name in (FILE_NAME, TILES_FILE_NAME)]


def frozen_mark(group: bpy.types.NodeTree, row: int, frame: int) -> str:
    """The mark of what a skin's light depended on at a frozen frame; "" where it is not known."""
    first, last = frozen_frames(group)
    marks = group[FROZEN_PROPERTY]["marks"].get(str(row), "")
    start = (frame - first) * MARK_LENGTH
    return marks[start : start + MARK_LENGTH].strip() if first <= frame <= last else ""


def holds_row(group: bpy.types.NodeTree, row: int) -> bool:
    """Whether a skin's row was frozen."""
    return str(row) in group[FROZEN_PROPERTY]["marks"].keys()  # noqa: SIM118  a group of properties has no `in`


def frozen_row(group: bpy.types.NodeTree, row: int) -> tuple[float, float, float, float]:
    """The object's property in a frozen group."""
    stored = group[FROZEN_PROPERTY]
    if not holds_row(group, row):
        return 0.0, 0.0, 0.0, 0.0
    return 1.0, 1.0 / stored["width"], (row + 0.5) / (2 * stored["rows"]), 1.0


def frozen_tiles(group: bpy.types.NodeTree, row: int) -> tuple[float, float, float, float]:
    """The object's property of tiles in a frozen group."""
    stored = group[FROZEN_PROPERTY].get("tiles")
    first_row = stored["first_rows"].get(str(row)) if stored is not None else None
    if first_row is None:
        return DARK
    return float(first_row), 1.0 / stored["width"], 1.0 / stored["height"], 1.0


def frozen_pixels(rows: np.ndarray, scales: np.ndarray) -> np.ndarray:
    """The image (2 n, width, 4) of a frame from the rows (n, width, 4) and the (texels per mm, strength) (n, 2)."""
    header = np.zeros_like(rows)
    header[:, :, 0], header[:, :, 3] = scales[:, :1], scales[:, 1:]
    return np.concatenate([rows, header])


class TileRange(NamedTuple):
    """The rows of a skin's tiles in the image."""

    first_row: int
    rows: int


def freeze_group(
    group: bpy.types.NodeTree,
    folder: Path,
    frames: tuple[int, int],
    size: tuple[int, int],
    marks: dict[int, str],
    tiles: tuple[int, int, dict[int, TileRange]] | None = None,
) -> None:
    """Makes a group show a sequence.

    folder  where its images are
    frames  first and last
    size    width, and number of rows of skins
    marks   by row: the marks of all frames, MARK_LENGTH characters each
    tiles   width and height of the images of tiles, and the range of each skin in them, by row; None: there are none
    """
    marked = {str(row): text for row, text in marks.items()}
    stored = {"first": frames[0], "last": frames[1], "width": size[0], "rows": size[1], "marks": marked}
    number = file_number(frames[0], frames[0])
    _show_sequence(group, ROWS, folder / FILE_NAME.format(number), (size[0], 2 * size[1]))
    if tiles is not None:
        first_rows = {str(row): each.first_row for row, each in tiles[2].items()}
        stored["tiles"] = {"width": tiles[0], "height": tiles[1], "first_rows": first_rows}
        _show_sequence(group, TILES, folder / TILES_FILE_NAME.format(number), tiles[:2])
    group[FROZEN_PROPERTY] = stored
    add_frozen_nodes(group)


def _show_sequence(group: bpy.types.NodeTree, kind: GroupImages, file: Path, size: tuple[int, int]) -> None:
    """Puts a sequence in place of a group's live images, which it keeps."""
    live = kind.all_of(group)
    image = bpy.data.images.new(f".Skinglow {file.parent.name}", *size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = blender_version.data_color_space(image)
    image.alpha_mode, image.use_half_precision = "CHANNEL_PACKED", False
    image.source = "SEQUENCE"
    image.filepath = path_in_file(file)
    for slot, each in zip(SLOTS, live, strict=True):
        setattr(image.skinglow, slot, each)
    kind.show(group, image)


def path_in_file(file: Path) -> str:
    """Relative to the blend file where that is possible: farms see folders under other paths."""
    try:
        return bpy.path.relpath(str(file)) if bpy.data.filepath else str(file)
    except ValueError:  # another drive
        return str(file)


def unfreeze_group(group: bpy.types.NodeTree) -> None:
    """Gives a group its live images back; its nodes have to be built again, and its skins updated."""
    group.pop(FROZEN_PROPERTY)
    for kind in (ROWS, TILES):
        image, live = kind.shown(group), kind.all_of(group)
        if live:
            kind.show(group, live[0])
        if image is not None and image not in live:
            delete_images([image])


def add_frozen_nodes(group: bpy.types.NodeTree) -> None:
    """Makes the nodes of a frozen group, built as live ones are, take scale and strength from the sequence."""
    first, last = frozen_frames(group)
    row = next(n for n in group.nodes if n.bl_idname == "ShaderNodeAttribute" and n.attribute_name == ROW_PROPERTY)
    build = NodeBuilder(group, row.location.x, row.location.y + 400.0)
    links = row.outputs["Vector"].links
    # There is none where only tiles are shown.
    split = links[0].to_node.outputs if links else build.split(row.outputs["Vector"])
    scaled, lit = _targets(split[0]), _targets(row.outputs["Alpha"])
    above = build.math("ADD", split[2], 0.5, label="Row in the upper half")
    header = build.texel(build.combine(0.5, above), HEADER_NODE)
    texels_per_mm = build.split(header.outputs["Color"])[0]
    strength = build.math("MULTIPLY", row.outputs["Alpha"], header.outputs["Alpha"], label="Frozen strength")
    for source, sockets in ((texels_per_mm, scaled), (strength, lit)):
        for socket in sockets:
            group.links.new(source, socket)
    header.image = shown_image(group)
    for node in [*ROWS.nodes(group), *TILES.nodes(group)]:
        user = node.image_user
        user.frame_start, user.frame_duration, user.frame_offset = (
            first,
            last - first + 1,
            file_number(first, first) - 1,
        )
        user.use_cyclic, user.use_auto_refresh = False, True


def _targets(output: Socket) -> list[Socket]:
    return [link.to_socket for link in output.links]


def read_frozen(group: bpy.types.NodeTree, row: int, frame: int) -> np.ndarray:
    """A skin's texels (width, 4) at a frame, from the file. Raises SkinError if it is missing. Not while rendering."""
    return _read_file(frozen_file(group, frame))[row].copy()


def read_frozen_tiles(group: bpy.types.NodeTree, row: int, frame: int, rows: int) -> np.ndarray | None:
    """The pixels (rows, width, 4) of a skin's tiles at a frame, as `read_frozen`; None if it shows none."""
    first_row, _width, _height, use = frozen_tiles(group, row)
    if not use:
        return None
    return _read_file(_files(group, frame)[1])[int(first_row) : int(first_row) + rows].copy()


def _read_file(file: Path) -> np.ndarray:
    if not file.is_file():
        raise SkinError(f"The frozen image {file} is missing: freeze again, or unfreeze")
    image = bpy.data.images.load(str(file), check_existing=False)
    try:
        image.colorspace_settings.name = blender_version.data_color_space(image)
        image.alpha_mode = "CHANNEL_PACKED"
        return read_pixels(image)
    finally:
        bpy.data.images.remove(image)
