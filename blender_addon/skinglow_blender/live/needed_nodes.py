# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes and images that the skins of a node group need: built before they are used.

While a window renders, in a thread of its own, none are built. Without a window Blender evaluates what a frame's
handler writes before the frame is rendered, and so it gets what it needs.
"""

from collections.abc import Callable
from typing import NamedTuple

import bpy

from ..errors import SkinError
from ..identity import key_of
from ..read.possible_lights import lights_that_may_shine, world_may_shine
from ..read.scene_reading import SceneReading, Skin
from ..session import SESSION
from ..show.group_nodes import GroupNodes, build_nodes, nodes_of
from ..show.image_pairs import have_room, keep_animated
from ..show.inner_groups import has_inner_groups
from ..show.lut_image import ROWS, Atlas, ensure_images, images_of
from ..table.light_room import layout_with_room
from ..table.lut_layout import Layout, layout_of
from ..table.skin_tables import Table

#: What to do about nodes for too few lights, or parts of large ones: where none can be added while rendering, and where
#: they belong to a library.
OTHERWISE = "or set Lighting to Per Object or Through the Shape"
SHOW_LIGHTS = f"show these in the viewport once, {OTHERWISE}"
SHOW_FRAME = f"show this frame in the viewport once, {OTHERWISE}"
SHOW_IN_LIBRARY = f"open that file, show as many lights there and save it, or make the skin local, {OTHERWISE}"
SHOW_AS_NEAR_IN_LIBRARY = (
    f"open that file, show as large lights as near to it there and save it, or make the skin local, {OTHERWISE}"
)
#: All of these.
REMEDIES = (SHOW_LIGHTS, SHOW_FRAME, SHOW_IN_LIBRARY, SHOW_AS_NEAR_IN_LIBRARY)


def is_fixed(group: bpy.types.NodeTree) -> bool:
    """Nodes cannot be added while a window renders, nor to a group from a library."""
    return SESSION.is_layout_fixed() or group.library is not None


def is_cut_down(table: Table) -> bool:
    """Whether the nodes of a skin show less of its light than they should."""
    return bool(table.crowded_out or table.coarse)


def crowding(group: bpy.types.NodeTree, skin: Skin, table: Table) -> str:
    """The fault of a skin whose nodes have no room for some of its light (is_cut_down)."""
    lights = table.crowded_out or table.coarse
    names = [f"'{name}'" for name in lights[:3]]
    if len(lights) > len(names):
        names.append(f"{len(lights) - len(names)} more")
    shown = "the same all over it" if table.crowded_out else "coarser than it should be"
    shown = f"so that the light of {', '.join(names)} is {shown}"
    if group.library is not None:
        what = f"its nodes, linked from {group.library.filepath}, are too few for these lights"
        remedy = SHOW_IN_LIBRARY if table.crowded_out else SHOW_AS_NEAR_IN_LIBRARY
    else:
        what = "its material has too few nodes for these lights while rendering"
        remedy = SHOW_LIGHTS if table.crowded_out else SHOW_FRAME
    return f"{skin.name}: {what}, {shown}: {remedy}"


def make_room(group: bpy.types.NodeTree, width: int, rows: int) -> list[bpy.types.Image]:
    """Enlarges the group's images if they are too small; returns them."""
    images = images_of(group)
    ROWS.require(group, images)
    if have_room(images, width, rows):
        return images
    if SESSION.is_layout_fixed():
        raise SkinError("its images are too small and cannot be enlarged while rendering: update before rendering")
    ensure_images(group, width, rows)
    return images_of(group)


def fit_nodes(
    group: bpy.types.NodeTree,
    atlas: Atlas,
    members: list[tuple[bpy.types.Object, Skin]],
    reading: SceneReading,
    depsgraph: bpy.types.Depsgraph,
) -> bool:
    """Builds the nodes that the group's skins need, and may need while rendering; returns whether that invalidated the
    atlas.
    """
    if group.library is not None:
        return False
    there = nodes_of(group)
    wanted = _wanted_nodes(group, atlas, members, there)
    if not SESSION.rendering and wanted.layout is not None:
        wanted = wanted._replace(layout=_with_room(wanted.layout, atlas, members, reading, depsgraph))
    if wanted == there:
        return False
    # Nodes that are no longer needed may stay.
    if SESSION.rendering and _are_enough(there, wanted):
        return False
    if SESSION.is_layout_fixed():
        raise SkinError(
            "its material lacks nodes for this way of lighting, and none can be added while rendering: "
            "update before rendering"
        )
    if not has_inner_groups(group):
        raise SkinError("its node group lacks a part, or is of an earlier version: press Repair, or call make_skin")
    if wanted.layout is not None:
        ensure_images(group, wanted.layout.width, atlas.pixels.shape[0])
    build_nodes(group, wanted)
    if depsgraph.mode == "RENDER":
        SESSION.built_while_rendering = True
        keep_animated()
    return not atlas.fits(group)


def _are_enough(there: GroupNodes, wanted: GroupNodes) -> bool:
    return there.rows >= wanted.rows and there.tiles >= wanted.tiles and wanted.layout in (None, there.layout)


def _wanted_nodes(
    group: bpy.types.NodeTree, atlas: Atlas, members: list[tuple[bpy.types.Object, Skin]], there: GroupNodes
) -> GroupNodes:
    shapes = {skin.key for _obj, skin in members if skin.shape is not None}
    # All of the file's objects are asked only where that may keep nodes that there are.
    others = _Others(group, shapes)
    by_tiles = bool(shapes) or (there.tiles and others.any(lambda s: s.mode == "PHYSICAL" and s.weights == "SHAPE"))
    by_rows = len(shapes) < len(members) or (
        there.rows and others.any(lambda s: s.mode != "PHYSICAL" or s.weights != "SHAPE")
    )
    if not by_rows:
        return GroupNodes(None, tiles=True, rows=False)
    return GroupNodes(_wanted_layout(atlas, members, others), tiles=by_tiles, rows=True)


class _Others(NamedTuple):
    """The skins of a group in the whole file, in other scenes too, but for some."""

    group: bpy.types.NodeTree
    left_out: set[str]

    def any(self, holds: Callable[[bpy.types.PropertyGroup], bool]) -> bool:
        """Whether the settings of one of them have a property."""
        for obj in bpy.data.objects:
            settings = obj.skinglow
            if settings.enabled and obj.type == "MESH" and settings.group == self.group and holds(settings):
                if key_of(obj) not in self.left_out:
                    return True
        return False


def _wanted_layout(atlas: Atlas, members: list[tuple[bpy.types.Object, Skin]], others: _Others) -> Layout | None:
    """The layout of rows that are lit per pixel; None: plain rows."""
    wanted = atlas.layout
    tables = [atlas.tables[skin.key] for _obj, skin in members if skin.key in atlas.tables]
    lit = [table for table in tables if table.lighting is not None]
    if not lit and wanted is None:
        return None
    # The nodes for light per pixel are kept as long as any skin of the group may be lit so.
    if not lit and not others.any(lambda s: s.mode == "PHYSICAL" and s.weights not in ("OBJECT", "SHAPE")):
        return None
    entries = max((len(table.colors) for table in tables), default=1)
    for table in lit:
        needed = layout_of(table.lighting, entries)
        wanted = needed if wanted is None else wanted.joined(needed)
    return wanted if wanted.entries >= entries else wanted._replace(entries=entries)


def _with_room(
    wanted: Layout,
    atlas: Atlas,
    members: list[tuple[bpy.types.Object, Skin]],
    reading: SceneReading,
    depsgraph: bpy.types.Depsgraph,
) -> Layout:
    """The layout with nodes for the lights that are off or hidden now, and may shine in a render."""
    tables = {skin: atlas.tables.get(skin.key) for _obj, skin in members if skin.surface is not None}
    lit = {skin: table for skin, table in tables.items() if table is not None and table.lighting is not None}
    if not lit:
        return wanted
    possible = lights_that_may_shine(depsgraph, reading.lights, reading.known)
    world = world_may_shine(depsgraph.scene)
    for skin, table in lit.items():
        wanted = wanted.joined(layout_with_room(skin, table, possible, world))
    return wanted
