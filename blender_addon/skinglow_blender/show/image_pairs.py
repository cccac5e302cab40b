# SPDX-License-Identifier: GPL-3.0-or-later
"""The images that a node group shows, four of a kind, and the way new pixels reach the renderers.

Cycles never reloads an image. While a Cycles view is open we therefore write the hidden image of a pair and swap it
in; otherwise we write the visible one, which is cheaper. Viewport and render see different lights, so each has its own
pair, and the viewport's picture is restored after a render without computing anything.
"""

from collections.abc import Callable

import bpy
import numpy as np
from bpy.props import PointerProperty

from .. import blender_version
from ..errors import SkinError
from ..read import working_space

FIRST_ROWS = 16
SLOTS = ("viewport_a", "viewport_b", "render_a", "render_b")


class LutImages(bpy.types.PropertyGroup):
    """The images of a skin node group, stored on each of them (why there are four is explained above).

    Not stored on the node group: Blender miscounts the users of data that a node tree's properties point to.
    """

    viewport_a: PointerProperty(type=bpy.types.Image)
    viewport_b: PointerProperty(type=bpy.types.Image)
    render_a: PointerProperty(type=bpy.types.Image)
    render_b: PointerProperty(type=bpy.types.Image)


class GroupImages:
    """Images of one kind: which nodes of a group show them, and how they are found, made and deleted."""

    def __init__(self, title: str, nodes: Callable[[bpy.types.NodeTree], list[bpy.types.Node]]) -> None:
        """title: their names in the file; nodes: the nodes of a group that show such an image."""
        self.title, self.nodes = title, nodes

    def shown(self, group: bpy.types.NodeTree) -> bpy.types.Image | None:
        """The image in a group's nodes."""
        nodes = self.nodes(group)
        return nodes[0].image if nodes else None

    def show(self, group: bpy.types.NodeTree, image: bpy.types.Image) -> None:
        """Puts an image into a group's nodes."""
        for node in self.nodes(group):
            # Assigning an equal value also tags the node tree, and each tag restarts the viewport.
            if node.image != image:
                node.image = image

    def all_of(self, group: bpy.types.NodeTree) -> list[bpy.types.Image]:
        """A group's four images in the order of SLOTS; fewer if some were deleted."""
        return slots_of(self.shown(group))

    def pair(
        self, group: bpy.types.NodeTree, mode: str, images: list[bpy.types.Image] | None = None
    ) -> tuple[bpy.types.Image, bpy.types.Image]:
        """The two images of a depsgraph mode, 'VIEWPORT' or 'RENDER'; images: all_of the group, if known."""
        images = self.all_of(group) if images is None else images
        self.require(group, images)
        return (images[2], images[3]) if mode == "RENDER" else (images[0], images[1])

    def has_room(self, group: bpy.types.NodeTree, width: int, rows: int) -> bool:
        """Whether a group's images exist and are that large."""
        return have_room(self.all_of(group), width, rows)

    def ensure(self, group: bpy.types.NodeTree, width: int, rows: int) -> None:
        """Enlarges a group's images to be that large. Raises SkinError if one is missing. Not while rendering."""
        images = self.all_of(group)
        if have_room(images, width, rows):
            return
        self.require(group, images)
        width, rows = max(width, *(i.size[0] for i in images)), max(power_of_two(rows), *(i.size[1] for i in images))
        for image in images:
            if image.size[0]:
                image.scale(width, rows)
            else:
                _revive(image, width, rows)

    def shrink(self, group: bpy.types.NodeTree) -> None:
        """Makes a group's images as low as new ones are: what nothing shows takes no memory. Not while rendering."""
        for image in self.all_of(group):
            if image.size[1] > FIRST_ROWS:
                image.scale(image.size[0], FIRST_ROWS)

    def require(self, group: bpy.types.NodeTree, images: list[bpy.types.Image]) -> None:
        """Raises SkinError if some of a group's images are missing, or a library's where the group is not."""
        if len(images) != len(SLOTS):
            raise SkinError(f"An image of the node group '{group.name}' was deleted: press Repair, or call make_skin")
        if group.library is None and images[0].library is not None:
            raise SkinError(
                f"The node group '{group.name}' was made local without its images: press Repair, or call make_skin"
            )

    def renew(self, group: bpy.types.NodeTree, width: int, rows: int) -> None:
        """Gives a group four new images of at least that size, empty until the next update. By operators alone."""
        images = []
        try:
            for slot in SLOTS:
                name = f".Skinglow {self.title} {slot.replace('_', ' ')}"
                images.append(_new_image(name, width, power_of_two(rows)))
        except SkinError:
            for image in images:
                bpy.data.images.remove(image)
            raise
        # Each points to all four, so that the visible one keeps the others in the file and in appended copies.
        for image in images:
            for slot, other in zip(SLOTS, images, strict=True):
                setattr(image.skinglow, slot, other)
        self.show(group, images[0])

    def remove(self, group: bpy.types.NodeTree) -> None:
        """Deletes a group's images."""
        delete_with_slots(self.shown(group))


def slots_of(image: bpy.types.Image | None) -> list[bpy.types.Image]:
    """The images that one of them, or a sequence in their place, points to."""
    if image is None:
        return []
    pointers = image.skinglow
    return [each for each in (getattr(pointers, slot) for slot in SLOTS) if each is not None]


def have_room(images: list[bpy.types.Image], width: int, rows: int) -> bool:
    """Whether these are all images of a group, each that large."""
    sizes = [image.size[:] for image in images]
    return len(sizes) == len(SLOTS) and all(size[0] >= width and size[1] >= rows for size in sizes)


def delete_with_slots(image: bpy.types.Image | None) -> None:
    """Deletes an image and those that it points to, unless they are a library's."""
    images = {image, *slots_of(image)} - {None}
    delete_images([each for each in images if each.library is None])


def delete_images(images: list[bpy.types.Image]) -> None:
    """Deletes images that may point to each other: Blender 5.0 crashes over what points to a deleted image."""
    for image in images:
        for slot in SLOTS:
            image.skinglow.property_unset(slot)
    for image in images:
        bpy.data.images.remove(image)


def power_of_two(rows: int) -> int:
    """The height of an image of that many rows."""
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


def _revive(image: bpy.types.Image, width: int, height: int) -> None:
    """Gives an image pixels again whose file is gone: it was saved unpacked, with the add-on off."""
    image.filepath = ""
    image.source = "GENERATED"
    image.use_generated_float = True
    image.generated_width, image.generated_height = width, height


def is_read_from_disk(image: bpy.types.Image) -> bool:
    """Whether Cycles renders the image's file, if there is one, and not its pixels: after Unpack Resources."""
    return image.source == "FILE" and image.packed_file is None


def keep_in_file(image: bpy.types.Image) -> None:
    """Has an image saved with the blend file, as it is now."""
    if is_read_from_disk(image) and not image.is_dirty:
        # Blender would pack what is on the disk, if that is still there.
        image.pixels.foreach_set(read_pixels(image).ravel())
    if image.is_dirty:
        image.pack()


class PairContents:
    """The contents of one pair of images; cached, since reading pixels back is slow."""

    def __init__(self, images: GroupImages, group: bpy.types.NodeTree, mode: str) -> None:
        self.images, self.mode = images, mode
        pair = images.pair(group, mode)
        self._data = _addresses(group, pair)
        width, height = pair[0].size
        self.pixels = np.zeros((height, width, 4), np.float32)
        self.space = working_space.working_space()
        self.is_dirty = False
        #: Which image of the pair is up to date, and whether a renderer may have read it since it was written.
        self.front = 1 if images.shown(group) == pair[1] else 0
        self.was_shown = True
        self._is_compared = False
        #: Whether the image was written and is still known to be as it was.
        self._is_written = False

    def fits(self, group: bpy.types.NodeTree, images: list[bpy.types.Image] | None = None) -> bool:
        """Whether group and images, their size, and the file's working space are still those of this object.

        A group made anew has the name of the deleted one.
        images  all images of the group, if known
        """
        pair = self.images.pair(group, self.mode, images)
        if self._data != _addresses(group, pair):
            return False
        width, height = pair[0].size
        return self.pixels.shape[:2] == (height, width) and self.space == working_space.working_space()

    def is_of_same_images(self, other: "PairContents") -> bool:
        """Whether the other one is of the same group, images and working space; their size may differ."""
        return self._data == other._data and self.space == other.space

    def look_for_loss(self, group: bpy.types.NodeTree, images: list[bpy.types.Image] | None = None) -> None:
        """Has the image written anew if somebody else may have taken its pixels back: reloaded or unpacked all images.

        images  all images of the group, if known
        """
        if not self._is_written:
            return
        image = self.images.pair(group, self.mode, images)[self.front]
        # What was written is not in the file, until it is saved.
        if not image.is_dirty or is_read_from_disk(image):
            self._is_written = self._is_compared = False
            self.is_dirty = True

    def write(self, group: bpy.types.NodeTree) -> None:
        """Writes the pixels into an image that no renderer holds a copy of.

        The first time only if it differs: a file that was opened and not changed is not to be saved again.
        """
        pair = self.images.pair(group, self.mode)
        if not self._is_compared:
            self._is_compared = True
            image = pair[self.front]
            is_unsaved = image.is_dirty and is_read_from_disk(image)
            if not is_unsaved and np.array_equal(read_pixels(image), self.pixels):
                self.is_dirty = False
                return
        if self.was_shown and (self.mode == "RENDER" or is_rendered_in_view()):
            self.front = 1 - self.front
            self.was_shown = False
        image = pair[self.front]
        image.pixels.foreach_set(self.pixels.ravel())
        self.is_dirty, self._is_written = False, True
        if is_read_from_disk(image):
            image.pack()
        # Drop the GPU texture of the old pixels.
        image.gl_free()

    def show(self, group: bpy.types.NodeTree) -> None:
        """Puts the up-to-date image into the nodes, unless it is there already."""
        image = self.images.pair(group, self.mode)[self.front]
        if self.mode == "RENDER" and self.images.shown(group) != image:
            keep_animated()
        self.images.show(group, image)
        self.was_shown = True


def _addresses(group: bpy.types.NodeTree, pair: tuple[bpy.types.Image, bpy.types.Image]) -> tuple[int, ...]:
    return tuple(data.as_pointer() for data in (group, *pair))


def keep_animated() -> None:
    """Has Blender evaluate the animation of materials again.

    A change of their nodes copies them anew, with the values of the frame that the viewport shows.
    """
    materials = [owner for m in bpy.data.materials for owner in (m, m.node_tree) if owner is not None]
    for owner in (*materials, *bpy.data.node_groups):
        if owner.animation_data is not None:
            owner.update_tag(refresh={"TIME"})


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


def read_pixels(image: bpy.types.Image) -> np.ndarray:
    """All texels, (height, width, 4) float32, unconverted."""
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)


def register() -> None:
    """Adds the pointers to Blender's images."""
    bpy.utils.register_class(LutImages)
    bpy.types.Image.skinglow = PointerProperty(type=LutImages, name="Skin Glow Images")


def unregister() -> None:
    """Removes them; what is stored in files remains there."""
    del bpy.types.Image.skinglow
    bpy.utils.unregister_class(LutImages)
