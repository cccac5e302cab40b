# SPDX-License-Identifier: GPL-3.0-or-later
"""Frozen groups: their nodes read an image sequence in place of the live lookups, so that a Blender without the add-on
renders the same.

An image of the sequence has twice as many rows as there are skins: the lower half holds what the rows of the lookup
image held, the upper half what changes with the frames in the object's property. That property keeps the position of
the row alone, and 1 in place of the strength: an object without it still does not glow.
"""

import os
from pathlib import Path

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..read.scene_reading import ROW_PROPERTY
from .image_pairs import SLOTS, read_pixels
from .lut_image import FROZEN_PROPERTY, HEADER_NODE, image_nodes, images_of, show_image, shown_image
from .node_building import NodeBuilder, Socket

#: Files of a sequence: Blender takes the last number of a name for the frame's.
FILE_NAME = "light_{:04d}.exr"
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
    """The file that a frozen group shows at a frame: outside of the sequence its nearest one."""
    first, last = frozen_frames(group)
    return frozen_folder(group) / FILE_NAME.format(file_number(min(max(frame, first), last), first))


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


def frozen_pixels(rows: np.ndarray, scales: np.ndarray) -> np.ndarray:
    """The image (2 n, width, 4) of a frame from the rows (n, width, 4) and the (texels per mm, strength) (n, 2)."""
    header = np.zeros_like(rows)
    header[:, :, 0], header[:, :, 3] = scales[:, :1], scales[:, 1:]
    return np.concatenate([rows, header])


def freeze_group(
    group: bpy.types.NodeTree, file: Path, frames: tuple[int, int], size: tuple[int, int], marks: dict[int, str]
) -> None:
    """Makes a group show a sequence.

    file    the first of its images
    frames  first and last
    size    width, and number of rows of skins
    marks   by row: the marks of all frames, MARK_LENGTH characters each
    """
    live = images_of(group)
    image = bpy.data.images.new(f".Skinglow {file.parent.name}", size[0], 2 * size[1], alpha=True, float_buffer=True)
    image.colorspace_settings.name = blender_version.data_color_space(image)
    image.alpha_mode, image.use_half_precision = "CHANNEL_PACKED", False
    image.source = "SEQUENCE"
    image.filepath = path_in_file(file)
    for slot, each in zip(SLOTS, live, strict=True):
        setattr(image.skinglow, slot, each)
    marked = {str(row): text for row, text in marks.items()}
    group[FROZEN_PROPERTY] = {"first": frames[0], "last": frames[1], "width": size[0], "rows": size[1], "marks": marked}
    show_image(group, image)
    add_frozen_nodes(group)


def path_in_file(file: Path) -> str:
    """Relative to the blend file where that is possible: farms see folders under other paths."""
    try:
        return bpy.path.relpath(str(file)) if bpy.data.filepath else str(file)
    except ValueError:  # another drive
        return str(file)


def unfreeze_group(group: bpy.types.NodeTree) -> None:
    """Gives a group its live images back; its nodes have to be built again, and its skins updated."""
    image, live = shown_image(group), images_of(group)
    group.pop(FROZEN_PROPERTY)
    if live:
        show_image(group, live[0])
    if image is not None and image not in live:
        for slot in SLOTS:
            image.skinglow.property_unset(slot)
        bpy.data.images.remove(image)


def add_frozen_nodes(group: bpy.types.NodeTree) -> None:
    """Makes the nodes of a frozen group, built as live ones are, take scale and strength from the sequence."""
    first, last = frozen_frames(group)
    row = next(n for n in group.nodes if n.bl_idname == "ShaderNodeAttribute" and n.attribute_name == ROW_PROPERTY)
    split = row.outputs["Vector"].links[0].to_node
    build = NodeBuilder(group, row.location.x, row.location.y + 400.0)
    scaled, lit = _targets(split.outputs[0]), _targets(row.outputs["Alpha"])
    above = build.math("ADD", split.outputs[2], 0.5, label="Row in the upper half")
    header = build.texel(build.combine(0.5, above), HEADER_NODE)
    texels_per_mm = build.split(header.outputs["Color"])[0]
    strength = build.math("MULTIPLY", row.outputs["Alpha"], header.outputs["Alpha"], label="Frozen strength")
    for source, sockets in ((texels_per_mm, scaled), (strength, lit)):
        for socket in sockets:
            group.links.new(source, socket)
    image = shown_image(group)
    for node in image_nodes(group):
        node.image = image
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
    file = frozen_file(group, frame)
    if not file.is_file():
        raise SkinError(f"The frozen image {file} is missing: freeze again, or unfreeze")
    image = bpy.data.images.load(str(file), check_existing=False)
    try:
        image.colorspace_settings.name = blender_version.data_color_space(image)
        image.alpha_mode = "CHANNEL_PACKED"
        return read_pixels(image)[row].copy()
    finally:
        bpy.data.images.remove(image)
