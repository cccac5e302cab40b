# SPDX-License-Identifier: GPL-3.0-or-later
"""The tiles of all skins of a node group in one image: the light at each point of the skin (image_pairs.py).

Each skin has a range of rows of its own. The corners of its mesh know their texel in it (tile_attribute.py), and the
object's custom property where the range begins.
"""

from collections.abc import Iterable, Mapping
from itertools import pairwise

import bpy
import numpy as np

from ..errors import SkinError, core
from ..identity import key_of
from ..session import SESSION
from ..thickness.tile_attribute import rows_of
from .image_pairs import GroupImages, PairContents, power_of_two
from .inner_groups import TILE_IMAGE_NODE, TILE_NODE

#: Custom property of a skin object: first row, width and height of a texel, and whether its tiles are shown, 1 or 0.
TILE_PROPERTY = "skinglow_tiles"
#: The same as its node group reads it, with as little arithmetic as can be: (u, v) of the center of its first texel, 0,
#: and whether tiles are shown; width and height of a texel, 0.
FIRST_TEXEL_PROPERTY, TEXEL_SIZE_PROPERTY = "skinglow_first_texel", "skinglow_texel_size"
OBJECT_PROPERTIES = (TILE_PROPERTY, FIRST_TEXEL_PROPERTY, TEXEL_SIZE_PROPERTY)
DARK = (0.0, 0.0, 0.0, 0.0)
#: Of a skin that has no rows.
NO_RANGE = (-1, -1)


def tile_nodes(group: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """The node through which a group reads the image of its tiles, if it has those nodes; empty if it was deleted."""
    texel = group.nodes.get(TILE_NODE)
    node = texel.node_tree.nodes.get(TILE_IMAGE_NODE) if texel is not None and texel.node_tree is not None else None
    return [node] if node is not None else []


TILES = GroupImages("Tiles", tile_nodes)


class TileAtlas(PairContents):
    """The tiles of one node group's images for one depsgraph mode. Alpha is the thickness in mm."""

    def __init__(self, group: bpy.types.NodeTree, mode: str) -> None:
        super().__init__(TILES, group, mode)
        self._written: dict[str, tuple[int, int, object]] = {}  #: first row, the one behind the last, source

    def take_over(self, smaller: "TileAtlas") -> None:
        """Takes what these images held before they were enlarged: not every skin is put again at once."""
        self.pixels[: len(smaller.pixels)] = smaller.pixels
        self._written, self.is_dirty = smaller._written, True

    def holds(self, key: str, first_row: int, source: object) -> bool:
        """Whether a skin's rows hold exactly what this object was put for."""
        return self.written(key, first_row) is source

    def rows_for(self, key: str, first_row: int, height: int, source: object) -> np.ndarray:
        """The pixels (height, width, 4) of a skin, to be written into. source: what is written, for `holds`."""
        end = first_row + height
        overwritten = [k for k, (first, last, _source) in self._written.items() if first < end and first_row < last]
        for other in overwritten:
            del self._written[other]
        self._written[key] = first_row, end, source
        self.is_dirty = True
        return self.pixels[first_row:end]

    def written(self, key: str, first_row: int) -> object | None:
        """What the rows of a skin that begin there were written from; None: nothing."""
        row, _end, source = self._written.get(key, (None, None, None))
        return source if row == first_row else None


def tile_atlas(group: bpy.types.NodeTree, mode: str) -> TileAtlas:
    """The cached contents of a group's tile images; new and empty where these are others."""
    key = (key_of(group), mode)
    known = SESSION.tile_atlases.get(key)
    if known is not None and known.fits(group):
        return known
    atlas = SESSION.tile_atlases[key] = TileAtlas(group, mode)
    if known is not None and known.is_of_same_images(atlas) and len(known.pixels) < len(atlas.pixels):
        atlas.take_over(known)
    return atlas


def place_tiles(group: bpy.types.NodeTree, heights: Mapping[bpy.types.Object, int]) -> dict[str, int]:
    """The first row of each skin's tiles, by key; enlarges the images where they are too small.

    heights  the rows that each skin of the group needs. Those that it had before are kept where nothing else needs
             them, also by skins that are not among these.
    Raises SkinError if the images are too small while Blender renders.
    """
    placed = SESSION.tile_rows.setdefault(key_of(group), {})
    wanted = {key_of(obj): height for obj, height in heights.items()}
    if any(placed.get(key, (0, -1))[1] != height for key, height in wanted.items()) or _overlap(placed, wanted):
        # Rows of a skin that is gone are another one's now, also when one of its name or an undo brings it back.
        there_is = {key_of(obj) for obj in bpy.data.objects if obj.skinglow.group == group}
        for key in placed.keys() - there_is:
            del placed[key]
        others = [o for o in bpy.data.objects if o.skinglow.group == group and o not in heights and TILE_PROPERTY in o]
        ranges = [_stored_range(obj, placed) for obj in others if obj.skinglow.enabled]
        taken = [each for each in ranges if each != NO_RANGE]
        there = max((image.size[1] for image in TILES.all_of(group)), default=0)
        # By row: it stays, so that a copy moves and not the one that was copied.
        for obj in sorted(heights, key=lambda obj: (key_of(obj) not in placed, obj.skinglow.row)):
            height = heights[obj]
            first = _stored_range(obj, placed)[0]
            # Of a skin that comes from another group the rows may be beyond the images of this one.
            if first < 0 or first + height > there or not _is_free(first, height, taken):
                ends = [0, *(end for _start, end in taken)]
                first = min(end for end in ends if _is_free(end, height, taken))
            taken.append((first, first + height))
            placed[key_of(obj)] = first, height
    _make_room(group, max((sum(placed[key]) for key in wanted), default=1))
    return {key: placed[key][0] for key in wanted}


def _stored_range(obj: bpy.types.Object, placed: Mapping[str, tuple[int, int]]) -> tuple[int, int]:
    """First row and the one behind the last, as far as they are known, or NO_RANGE."""
    if key_of(obj) in placed:
        first, height = placed[key_of(obj)]
        return first, first + height
    stored = obj.get(TILE_PROPERTY)
    if stored is None or stored[1] == 0.0:
        return NO_RANGE
    return int(stored[0]), int(stored[0]) + rows_of(obj.data)


def _overlap(placed: Mapping[str, tuple[int, int]], keys: Iterable[str]) -> bool:
    """Whether two of these skins have a row in common."""
    ranges = sorted(placed[key] for key in keys)
    return any(first + height > after for (first, height), (after, _height) in pairwise(ranges))


def _is_free(first: int, height: int, taken: list[tuple[int, int]]) -> bool:
    return all(first + height <= start or end <= first for start, end in taken)


def _make_room(group: bpy.types.NodeTree, rows: int) -> None:
    width = core().FaceTiles.WIDTH
    if TILES.has_room(group, width, rows):
        return
    if SESSION.is_layout_fixed():
        raise SkinError("its tile images are too small and cannot be enlarged while rendering: update before rendering")
    TILES.ensure(group, width, power_of_two(rows))


def tiles_shown(obj: bpy.types.Object, mode: str) -> tuple[int, np.ndarray] | None:
    """The first row and the pixels (h, width, 4) of the tiles that an object shows; None if it shows none."""
    group = obj.skinglow.group
    atlas = SESSION.tile_atlases.get((key_of(group), mode)) if group is not None else None
    first, _width, _height, use = obj.get(TILE_PROPERTY, DARK)
    if atlas is None or not use:
        return None
    return int(first), atlas.pixels[int(first) : int(first) + rows_of(obj.data)].copy()


def show_tiles(obj: bpy.types.Object, atlas: TileAtlas | None, first_row: int = 0, use: bool = True) -> None:
    """Sets the property by which the object's material finds its tiles; without an atlas they are not shown."""
    height, width = atlas.pixels.shape[:2] if atlas is not None else (0, 0)
    wanted = (float(first_row), 1.0 / width, 1.0 / height, float(use)) if atlas is not None else DARK
    set_tile_property(obj, wanted, during_render=atlas is not None and atlas.mode == "RENDER")


def set_tile_property(
    obj: bpy.types.Object, wanted: tuple[float, float, float, float], during_render: bool = False
) -> None:
    """Writes the properties if they differ, and has Blender evaluate the object again."""
    if tuple(obj.get(TILE_PROPERTY, DARK)) != wanted:
        first_row, width, height, use = wanted
        obj[TILE_PROPERTY] = wanted
        obj[FIRST_TEXEL_PROPERTY] = 0.5 * width, (first_row + 0.5) * height, 0.0, use
        obj[TEXEL_SIZE_PROPERTY] = width, height, 0.0
        # In an animation render the object itself is at the frame where that began: its keys have to be evaluated
        # again. In the viewport that would take back what was edited and not keyed yet.
        obj.update_tag(refresh={"OBJECT", "TIME"} if during_render else {"OBJECT"})
