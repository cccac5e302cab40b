# SPDX-License-Identifier: GPL-3.0-or-later
"""The lookups of all skins in one image, a row for each, and how new pixels reach the renderers.

Cycles never reads an image again that it has loaded. So where it may be looking an image that is shown is not written:
the idle one of a pair is, and is then put in its place. Viewport and render see different lights, so each has a pair of
its own, and coming back from a render shows the viewport's again without computing anything.
"""

from typing import Any

import bpy
import numpy as np

from . import working_space
from .errors import SkinError
from .lut_layout import LAYOUT_PROPERTY, Layout

FIRST_ROWS = 16
#: The image nodes of a group for plain rows: of the texel below a thickness and of the one above.
NODE_NAMES = ("LUT below", "LUT above")
#: In a group with surface weights: a node that holds the group which reads a texel, and the image node in there.
TEXEL_NODE, SURFACE_NODE = "LUT texel", "LUT"
#: On the node groups that are ours.
GROUP_PROPERTY = "skinglow"
SLOTS = ("viewport_a", "viewport_b", "render_a", "render_b")


def is_skin_group(tree: bpy.types.NodeTree | None) -> bool:
    """Whether a node tree is one of ours."""
    return tree is not None and GROUP_PROPERTY in tree and bool(image_nodes(tree))


def image_nodes(group: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """The nodes through which a group reads its image; none where they are gone."""
    texel = group.nodes.get(TEXEL_NODE)
    if texel is not None:
        node = texel.node_tree.nodes.get(SURFACE_NODE) if texel.node_tree is not None else None
        return [node] if node is not None else []
    nodes = [group.nodes.get(name) for name in NODE_NAMES]
    return nodes if None not in nodes else []


def group_layout(group: bpy.types.NodeTree) -> Layout | None:
    """The layout that a skin group's nodes read; None for plain rows."""
    stored = group.get(LAYOUT_PROPERTY)
    return Layout(stored[0], stored[1], stored[2], bool(stored[3])) if stored is not None else None


def skin_groups() -> list[bpy.types.NodeTree]:
    """All skin node groups of the file."""
    return [tree for tree in bpy.data.node_groups if is_skin_group(tree)]


def shown_image(group: bpy.types.NodeTree) -> bpy.types.Image | None:
    """The image that a group's nodes show."""
    nodes = image_nodes(group)
    return nodes[0].image if nodes else None


def show_image(group: bpy.types.NodeTree, image: bpy.types.Image) -> None:
    """Has a group's nodes show an image."""
    for node in image_nodes(group):
        # An equal value would be tagged all the same, and each tag restarts the viewport.
        if node.image != image:
            node.image = image


def images_of(group: bpy.types.NodeTree) -> list[bpy.types.Image]:
    """A group's four images in the order of SLOTS; fewer where some are gone."""
    shown = shown_image(group)
    if shown is None:
        return []
    return [image for image in (getattr(shown.skinglow, slot) for slot in SLOTS) if image is not None]


def image_pair(group: bpy.types.NodeTree, mode: str) -> tuple[bpy.types.Image, bpy.types.Image]:
    """The two images of a depsgraph mode, 'VIEWPORT' or 'RENDER'."""
    images = images_of(group)
    if len(images) != len(SLOTS):
        raise SkinError(f"An image of the node group '{group.name}' is gone; make the skin again to restore it")
    return (images[2], images[3]) if mode == "RENDER" else (images[0], images[1])


def has_room(group: bpy.types.NodeTree, width: int, rows: int) -> bool:
    """Whether a group's images are there and hold that many entries and rows."""
    images = images_of(group)
    return len(images) == len(SLOTS) and all(i.size[0] >= width and i.size[1] >= rows for i in images)


def ensure_images(group: bpy.types.NodeTree, width: int, rows: int) -> None:
    """Makes a group's images, or enlarges them, to hold that many entries and rows. Not while rendering."""
    if has_room(group, width, rows):
        return
    images = images_of(group)
    if len(images) != len(SLOTS):
        images = [_new_image(f".Skinglow LUT {slot.replace('_', ' ')}", width, _power_of_two(rows)) for slot in SLOTS]
        # Each knows all four, so that whichever is shown keeps the others in the file and brings them along.
        for image in images:
            for slot, other in zip(SLOTS, images, strict=True):
                setattr(image.skinglow, slot, other)
        show_image(group, images[0])
        return
    width, rows = max(width, images[0].size[0]), max(_power_of_two(rows), images[0].size[1])
    for image in images:
        image.scale(width, rows)


def _power_of_two(rows: int) -> int:
    height = FIRST_ROWS
    while height < rows:
        height *= 2
    return height


def _new_image(name: str, width: int, height: int) -> bpy.types.Image:
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True)
    # Before any pixel is written: setting it clears them.
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    # EEVEE would upload half floats.
    image.use_half_precision = False
    return image


def remove_images(group: bpy.types.NodeTree) -> None:
    """Deletes a group's images."""
    for image in images_of(group):
        if image.library is None:
            bpy.data.images.remove(image)


class Atlas:
    """What the images of one node group hold for one depsgraph mode; kept beside them, as reading back is slow."""

    def __init__(self, group: bpy.types.NodeTree, mode: str) -> None:
        self.mode = mode
        pair = image_pair(group, mode)
        width, height = pair[0].size
        self.layout = group_layout(group)
        self.pixels = np.zeros((height, width, 4), np.float32)
        self.pixels[:, :, 3] = 1.0
        self.space = working_space.working_space()
        self.signatures: dict[str, tuple] = {}
        self.rows: dict[str, int] = {}
        self._written: dict[str, object] = {}
        self.is_dirty = False
        self.tables: dict[str, Any] = {}  #: skin_tables.Table by skin
        #: Which of the pair is up to date, and whether a renderer may have read it since it was written.
        self.front = 1 if shown_image(group) == pair[1] else 0
        self.was_shown = True

    def fits(self, group: bpy.types.NodeTree) -> bool:
        """Whether the images still have the size and layout, and the file the working space, that this was made for."""
        width, height = image_pair(group, self.mode)[0].size
        same_shape = self.pixels.shape[:2] == (height, width) and self.layout == group_layout(group)
        return same_shape and self.space == working_space.working_space()

    def holds(self, key: str, row: int, table: object) -> bool:
        """Whether a skin's row is this very table."""
        return self.rows.get(key) == row and self._written.get(key) is table

    def put(self, key: str, row: int, table: object, texels: np.ndarray) -> None:
        """Takes the texels (n, 4) of a skin's table into its row."""
        self.pixels[row, : len(texels)] = texels
        self.rows[key], self._written[key] = row, table
        self.is_dirty = True

    def write(self, group: bpy.types.NodeTree) -> None:
        """Brings the rows into an image that no renderer holds a copy of."""
        if self.was_shown and (self.mode == "RENDER" or is_rendered_in_view()):
            self.front = 1 - self.front
            self.was_shown = False
        image = image_pair(group, self.mode)[self.front]
        image.pixels.foreach_set(self.pixels.ravel())
        self.is_dirty = False
        # The texture that EEVEE made of the pixels before.
        image.gl_free()

    def show(self, group: bpy.types.NodeTree) -> None:
        """Puts the image that is up to date into the node, if it is not there."""
        show_image(group, image_pair(group, self.mode)[self.front])
        self.was_shown = True


#: Engines that draw images from textures, which are made anew.
DRAWING_ENGINES = ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT", "BLENDER_WORKBENCH")


def is_rendered_in_view() -> bool:
    """Whether Cycles, or another renderer that may keep what it has read, shows a scene in a window.

    Anything else begins afresh when it is asked for. Swapping images is what a changed lamp costs most: Blender brings
    every material with the group up to date.
    """
    if bpy.app.background:
        return False
    for window in bpy.context.window_manager.windows:
        if window.scene.render.engine in DRAWING_ENGINES:
            continue
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                return True
    return False


def read_row(image: bpy.types.Image, row: int) -> np.ndarray:
    """A row's texels, (width, 4) float32, as they are in the image."""
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)[row].copy()
