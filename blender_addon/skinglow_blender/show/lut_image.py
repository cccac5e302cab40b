# SPDX-License-Identifier: GPL-3.0-or-later
"""The lookups of all skins in one image, one row each, and the way new pixels reach the renderers.

Cycles never reloads an image. While a Cycles view is open we therefore write the hidden image of a pair and swap it
in; otherwise we write the visible one, which is cheaper. Viewport and render see different lights, so each has its own
pair, and the viewport's lookup is restored after a render without computing anything.
"""

from typing import Any

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..read import working_space
from ..table.lut_layout import LAYOUT_PROPERTY, Layout

FIRST_ROWS = 16
#: The image nodes of a group for plain rows: the texel below a thickness and the one above.
NODE_NAMES = ("LUT below", "LUT above")
#: In a group that lights per pixel: the node of the inner group that reads a texel, and the image node in it.
TEXEL_NODE, SURFACE_NODE = "LUT texel", "LUT"
#: Custom property that marks our node groups, and the version of their nodes (file_upgrade.py).
GROUP_PROPERTY = "skinglow"
#: Custom property of a group that shows an image sequence (frozen.py), and the name of the image node that it adds.
FROZEN_PROPERTY = "skinglow_frozen"
HEADER_NODE = "LUT header"
GROUP_VERSION = 3
SLOTS = ("viewport_a", "viewport_b", "render_a", "render_b")


def is_skin_group(tree: bpy.types.NodeTree | None) -> bool:
    """Whether a node tree is a skin node group."""
    return tree is not None and GROUP_PROPERTY in tree and bool(image_nodes(tree))


def image_nodes(group: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """The nodes through which a group reads its image; empty if they were deleted."""
    # By the properties first: a look for a node by name goes through all of them.
    header = [group.nodes[HEADER_NODE]] if FROZEN_PROPERTY in group and HEADER_NODE in group.nodes else []
    if LAYOUT_PROPERTY in group:
        texel = group.nodes.get(TEXEL_NODE)
        tree = texel.node_tree if texel is not None else None
        node = tree.nodes.get(SURFACE_NODE) if tree is not None else None
        return [node, *header] if node is not None else []
    nodes = [group.nodes.get(name) for name in NODE_NAMES]
    return nodes + header if None not in nodes else []


def group_layout(group: bpy.types.NodeTree) -> Layout | None:
    """The layout that a skin group's nodes read; None for plain rows."""
    stored = group.get(LAYOUT_PROPERTY)
    return Layout(stored[0], stored[1], stored[2], bool(stored[3])) if stored is not None else None


def skin_groups() -> list[bpy.types.NodeTree]:
    """All skin node groups of the file."""
    return [tree for tree in bpy.data.node_groups if is_skin_group(tree)]


def shown_image(group: bpy.types.NodeTree) -> bpy.types.Image | None:
    """The image in a group's nodes."""
    nodes = image_nodes(group)
    return nodes[0].image if nodes else None


def show_image(group: bpy.types.NodeTree, image: bpy.types.Image) -> None:
    """Puts an image into a group's nodes."""
    for node in image_nodes(group):
        # Assigning an equal value also tags the node tree, and each tag restarts the viewport.
        if node.image != image:
            node.image = image


def images_of(group: bpy.types.NodeTree) -> list[bpy.types.Image]:
    """A group's four images in the order of SLOTS; fewer if some were deleted."""
    shown = shown_image(group)
    if shown is None:
        return []
    return [image for image in (getattr(shown.skinglow, slot) for slot in SLOTS) if image is not None]


def image_pair(group: bpy.types.NodeTree, mode: str) -> tuple[bpy.types.Image, bpy.types.Image]:
    """The two images of a depsgraph mode, 'VIEWPORT' or 'RENDER'."""
    images = images_of(group)
    if len(images) != len(SLOTS):
        raise SkinError(f"An image of the node group '{group.name}' was deleted: make the skin again to restore it")
    return (images[2], images[3]) if mode == "RENDER" else (images[0], images[1])


def has_room(group: bpy.types.NodeTree, width: int, rows: int) -> bool:
    """Whether a group's images exist and hold that many entries and rows."""
    images = images_of(group)
    return len(images) == len(SLOTS) and all(i.size[0] >= width and i.size[1] >= rows for i in images)


def ensure_images(group: bpy.types.NodeTree, width: int, rows: int) -> None:
    """Creates or enlarges a group's images to hold that many entries and rows. Not while rendering."""
    if has_room(group, width, rows):
        return
    images = images_of(group)
    if len(images) != len(SLOTS):
        renew_images(group, width, rows)
        return
    width, rows = max(width, images[0].size[0]), max(_power_of_two(rows), images[0].size[1])
    for image in images:
        image.scale(width, rows)


def renew_images(group: bpy.types.NodeTree, width: int, rows: int) -> None:
    """Gives a group four new images of at least that size, empty until the next update. Not while rendering."""
    images = []
    try:
        for slot in SLOTS:
            images.append(_new_image(f".Skinglow LUT {slot.replace('_', ' ')}", width, _power_of_two(rows)))
    except SkinError:
        for image in images:
            bpy.data.images.remove(image)
        raise
    # Each points to all four, so that the visible one keeps the others in the file and in appended copies.
    for image in images:
        for slot, other in zip(SLOTS, images, strict=True):
            setattr(image.skinglow, slot, other)
    show_image(group, images[0])


def _power_of_two(rows: int) -> int:
    height = FIRST_ROWS
    while height < rows:
        height *= 2
    return height


def _new_image(name: str, width: int, height: int) -> bpy.types.Image:
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True)
    try:
        # Must be set before the pixels: setting it clears them.
        image.colorspace_settings.name = blender_version.data_color_space(image)
    except SkinError:
        bpy.data.images.remove(image)
        raise
    image.alpha_mode = "CHANNEL_PACKED"
    # Otherwise EEVEE would upload half floats.
    image.use_half_precision = False
    return image


def remove_images(group: bpy.types.NodeTree) -> None:
    """Deletes a group's images."""
    images = {*images_of(group), shown_image(group)} - {None}
    delete_images([image for image in images if image.library is None])


def delete_images(images: list[bpy.types.Image]) -> None:
    """Deletes images that may point to each other: Blender 5.0 crashes over what points to a deleted image."""
    for image in images:
        for slot in SLOTS:
            image.skinglow.property_unset(slot)
    for image in images:
        bpy.data.images.remove(image)


class Atlas:
    """The contents of one node group's images for one depsgraph mode; cached, since reading pixels back is slow."""

    def __init__(self, group: bpy.types.NodeTree, mode: str) -> None:
        self.mode = mode
        pair = image_pair(group, mode)
        self._data = _addresses(group, mode)
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
        #: Which image of the pair is up to date, and whether a renderer may have read it since it was written.
        self.front = 1 if shown_image(group) == pair[1] else 0
        self.was_shown = True
        self._is_compared = False

    def fits(self, group: bpy.types.NodeTree) -> bool:
        """Whether group and images, their size and layout, and the file's working space are still those of this atlas.

        A group made anew has the name of the deleted one.
        """
        if self._data != _addresses(group, self.mode):
            return False
        width, height = image_pair(group, self.mode)[0].size
        same_shape = self.pixels.shape[:2] == (height, width) and self.layout == group_layout(group)
        return same_shape and self.space == working_space.working_space()

    def holds(self, key: str, row: int, table: object) -> bool:
        """Whether a skin's row holds exactly this table."""
        return self.rows.get(key) == row and self._written.get(key) is table

    def put(self, key: str, row: int, table: object, texels: np.ndarray) -> None:
        """Copies the texels (n, 4) of a skin's table into its row."""
        self.pixels[row, : len(texels)] = texels
        self.rows[key], self._written[key] = row, table
        self.is_dirty = True

    def write(self, group: bpy.types.NodeTree) -> None:
        """Writes the rows into an image that no renderer holds a copy of.

        The first time only if it differs: a file that was opened and not changed is not to be saved again.
        """
        if not self._is_compared:
            self._is_compared = True
            if np.array_equal(read_pixels(image_pair(group, self.mode)[self.front]), self.pixels):
                self.is_dirty = False
                return
        if self.was_shown and (self.mode == "RENDER" or is_rendered_in_view()):
            self.front = 1 - self.front
            self.was_shown = False
        image = image_pair(group, self.mode)[self.front]
        image.pixels.foreach_set(self.pixels.ravel())
        self.is_dirty = False
        # Drop the GPU texture of the old pixels.
        image.gl_free()

    def show(self, group: bpy.types.NodeTree) -> None:
        """Puts the up-to-date image into the nodes, unless it is there already."""
        image = image_pair(group, self.mode)[self.front]
        if self.mode == "RENDER" and shown_image(group) != image:
            _keep_animated()
        show_image(group, image)
        self.was_shown = True


def _keep_animated() -> None:
    """Has Blender evaluate the animation of materials again.

    A change of their nodes copies them anew, with the values of the frame that the viewport shows.
    """
    materials = [owner for m in bpy.data.materials for owner in (m, m.node_tree) if owner is not None]
    for owner in (*materials, *bpy.data.node_groups):
        if owner.animation_data is not None:
            owner.update_tag(refresh={"TIME"})


def _addresses(group: bpy.types.NodeTree, mode: str) -> tuple[int, ...]:
    return tuple(data.as_pointer() for data in (group, *image_pair(group, mode)))


#: Engines that draw images as GPU textures, which are updated.
RASTER_ENGINES = ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT", "BLENDER_WORKBENCH")


def is_rendered_in_view() -> bool:
    """Whether Cycles, or another renderer that may cache images, renders in a 3D view.

    Any other render starts from scratch. Swapping images is the largest cost of a changed light, since Blender then
    updates every material with the group.
    """
    if bpy.app.background:
        return False
    for window in bpy.context.window_manager.windows:
        if window.scene.render.engine in RASTER_ENGINES:
            continue
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.shading.type == "RENDERED":
                return True
    return False


def read_row(image: bpy.types.Image, row: int) -> np.ndarray:
    """A row's texels, (width, 4) float32, unconverted."""
    return read_pixels(image)[row].copy()


def read_pixels(image: bpy.types.Image) -> np.ndarray:
    """All texels, (height, width, 4) float32, unconverted."""
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)
