# SPDX-License-Identifier: GPL-3.0-or-later
"""Skins that the viewport hides and a render may show: they get the nodes that they need before, as none can be added
while rendering.
"""

from typing import NamedTuple

import bpy

from ..identity import key_of
from ..read.possible_lights import has_animation, lights_that_may_shine, rendered_collections, world_may_shine
from ..read.scene_lights import SceneLight
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
        SESSION.scene_skins = None
        return _to_make_ready(depsgraph, reading, seen)


def _to_make_ready(depsgraph: bpy.types.Depsgraph, reading: SceneReading, seen: set[str]) -> list[bpy.types.Object]:
    found, light = [], None
    for obj in _scene_skins(depsgraph.scene):
        settings, group = obj.skinglow, obj.skinglow.group
        if key_of(obj) in seen or not settings.enabled or (obj.hide_render and not has_animation(obj)):
            continue
        if group is None or group.library is not None or is_frozen(group):
            continue
        needed = [key_of(group), settings.row, settings.size]
        if settings.mode == "PHYSICAL" and settings.weights != "OBJECT":
            tiles = rows_of(obj.data) if settings.weights == "SHAPE" else 0
            if not tiles:
                light = light or _Light.of(depsgraph, reading)
            needed += [tiles, _layout(obj, light) if not tiles else None]
        if SESSION.made_ready.get(key_of(obj)) != needed:
            SESSION.made_ready[key_of(obj)] = needed
            found.append(obj)
    return found


class _Light(NamedTuple):
    """What may light the skins of a scene in a render."""

    lights: list[SceneLight]
    world: bool  #: whether there is light of the world

    @classmethod
    def of(cls, depsgraph: bpy.types.Depsgraph, reading: SceneReading) -> "_Light":
        lights = [light for light in reading.lights if not light.unlit_reason]
        names = {light.object_name for light in lights}
        possible = lights_that_may_shine(depsgraph, reading.lights, reading.known)
        lights += [light for light in possible if light.object_name not in names]
        return cls(lights, any(world_irradiance(reading.world)) or world_may_shine(depsgraph.scene))


def _scene_skins(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Those in collections that are rendered, looked for again where objects were added to these or taken out."""
    collections = list(dict.fromkeys(rendered_collections(scene)))
    mark = key_of(scene), [(key_of(each), len(each.objects)) for each in collections]
    if SESSION.scene_skins is None or SESSION.scene_skins[0] != mark:
        objects = [obj for each in collections for obj in each.objects if obj.type == "MESH" and obj.skinglow.enabled]
        SESSION.scene_skins = mark, list(dict.fromkeys(objects))
    return SESSION.scene_skins[1]


def _layout(obj: bpy.types.Object, light: _Light) -> Layout:
    """A layout that the light of a skin that is lit per pixel fits into."""
    skin = read_skin(obj, obj.matrix_world)
    if skin.surface is None:
        skin = lit_per_pixel(skin, obj, obj.matrix_world)
    return layout_of_lights(skin, light.lights, light.world)
