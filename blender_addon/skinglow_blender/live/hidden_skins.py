# SPDX-License-Identifier: GPL-3.0-or-later
"""Skins that the viewport hides and a render may show: they get the nodes that they need before, as none can be added
while rendering.
"""

import bpy

from ..identity import key_of
from ..read.possible_lights import has_animation, lights_that_may_shine, rendered_collections, world_may_shine
from ..read.scene_reading import SceneReading, lit_per_pixel, read_skin
from ..session import SESSION
from ..show.frozen import is_frozen
from ..table.light_room import layout_of_lights
from ..table.lut_layout import Layout
from ..table.skin_tables import world_irradiance
from ..thickness.tile_attribute import rows_of


def to_make_ready(depsgraph: bpy.types.Depsgraph, reading: SceneReading, seen: set[str]) -> list[bpy.types.Object]:
    """The skins that a render may show and this reading does not, if they may need other nodes than at the last time.

    seen  keys of the skins that need no look
    """
    if depsgraph.mode != "VIEWPORT" or SESSION.rendering:
        return []
    try:
        return _to_make_ready(depsgraph, reading, seen)
    except ReferenceError:  # one was deleted, and another one made
        SESSION.hidden_skins = None
        return _to_make_ready(depsgraph, reading, seen)


def _to_make_ready(depsgraph: bpy.types.Depsgraph, reading: SceneReading, seen: set[str]) -> list[bpy.types.Object]:
    found = []
    for obj in _hidden_skins(depsgraph.scene, reading, seen):
        settings, group = obj.skinglow, obj.skinglow.group
        if key_of(obj) in seen or not settings.enabled or (obj.hide_render and not has_animation(obj)):
            continue
        if group is None or group.library is not None or is_frozen(group):
            continue
        needed = key_of(group), settings.row, _needed_nodes(obj, depsgraph, reading)
        if SESSION.made_ready.get(key_of(obj)) != needed:
            SESSION.made_ready[key_of(obj)] = needed
            found.append(obj)
    return found


def _hidden_skins(scene: bpy.types.Scene, reading: SceneReading, seen: set[str]) -> list[bpy.types.Object]:
    """Those of the scene that are in some collection that is rendered, looked for again where that may have changed."""
    collections = list(dict.fromkeys(rendered_collections(scene)))
    mark = key_of(scene), reading.known, [(key_of(each), len(each.objects)) for each in collections]
    if reading.known is None or SESSION.hidden_skins is None or SESSION.hidden_skins[0] != mark:
        objects = dict.fromkeys(obj for each in collections for obj in each.objects)
        skins = [obj for obj in objects if obj.type == "MESH" and obj.skinglow.enabled]
        SESSION.hidden_skins = mark, [obj for obj in skins if key_of(obj) not in seen]
    return SESSION.hidden_skins[1]


def _needed_nodes(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, reading: SceneReading) -> tuple:
    """What tells whether a skin needs other nodes; of one that is lit per pixel, a layout that its light fits into."""
    settings = obj.skinglow
    if settings.mode != "PHYSICAL" or settings.weights == "OBJECT":
        return settings.size, None, 0
    tiles = rows_of(obj.data) if settings.weights == "SHAPE" else 0
    return settings.size, None if tiles else _layout(obj, depsgraph, reading), tiles


def _layout(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, reading: SceneReading) -> Layout:
    skin = read_skin(obj, obj.matrix_world)
    if skin.surface is None:
        skin = lit_per_pixel(skin, obj, obj.matrix_world)
    lights = [light for light in reading.lights if not light.unlit_reason]
    possible = lights_that_may_shine(depsgraph, reading.lights, reading.known)
    names = {light.object_name for light in lights}
    lights += [light for light in possible if light.object_name not in names]
    world = any(world_irradiance(reading.world)) or world_may_shine(depsgraph.scene)
    return layout_of_lights(skin, lights, world)
