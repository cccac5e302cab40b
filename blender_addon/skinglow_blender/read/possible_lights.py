# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights that do not shine in a reading but may in a render: what is built before has to have room for them."""

from collections.abc import Iterator

import bpy

from ..blender_version import output_target, shader_tree
from ..identity import key_of
from ..session import SESSION
from .known_objects import Known
from .scene_lights import SceneLight, read_light

#: Indices of color and power in a light's signature (scene_lights.FIELDS).
COLOR, POWER = 2, 3


def lights_that_may_shine(
    depsgraph: bpy.types.Depsgraph, lights: list[SceneLight], known: Known | None
) -> list[SceneLight]:
    """The light objects of the scene that are animated in any way, and those that only a render shows.

    They are read as they are in the file, not evaluated: hidden ones are in no depsgraph of the viewport. Left out are
    those that are on and not animated, and those that no render can ever show.

    lights  what was read of the depsgraph
    known   what that reading found of its objects; while it stays the same, they are not looked through again
    """
    scene = depsgraph.scene
    target = output_target(scene)
    there = {light.object_name for light in lights}
    try:
        return list(_that_may_shine(_light_objects(scene, known), there, target))
    except ReferenceError:  # one was deleted, and another one made
        return list(_that_may_shine(_light_objects(scene, None), there, target))


def _that_may_shine(objects: list[bpy.types.Object], there: set[str], target: str) -> Iterator[SceneLight]:
    for obj in objects:
        is_animated = any(map(_has_animation, (obj, obj.data, shader_tree(obj.data))))
        if not is_animated and (obj.hide_render or obj.name_full in there):
            continue
        light = read_light(obj, obj.matrix_world, obj.name, target)
        if is_animated or not (light.unlit_reason or _is_dark(light)):
            yield light


def world_may_shine(scene: bpy.types.Scene) -> bool:
    """Whether the world of a scene is animated: it may be black now."""
    world = scene.world
    return world is not None and any(map(_has_animation, (world, shader_tree(world))))


def _light_objects(scene: bpy.types.Scene, known: Known | None) -> list[bpy.types.Object]:
    """The light objects of a scene that some view layer renders, apart from what they are set to themselves."""
    collections = list(dict.fromkeys(_rendered_collections(scene)))
    # Each light object is a user of its light; to count all objects would take as long as to look at them.
    users = [light.users for light in bpy.data.lights]
    mark = key_of(scene), known, users, [key_of(each) for each in collections]
    if known is not None and SESSION.light_objects is not None and SESSION.light_objects[0] == mark:
        return SESSION.light_objects[1]
    found = dict.fromkeys(obj for each in collections for obj in each.objects if obj.type == "LIGHT")
    SESSION.light_objects = mark, list(found)
    return list(found)


def _rendered_collections(scene: bpy.types.Scene) -> Iterator[bpy.types.Collection]:
    waiting = [layer.layer_collection for layer in scene.view_layers]
    while waiting:
        layer_collection = waiting.pop()
        if layer_collection.collection.hide_render:
            continue  # and all that is in it
        if not layer_collection.exclude:
            yield layer_collection.collection
        waiting += layer_collection.children


def _has_animation(owner: bpy.types.ID | None) -> bool:
    data = owner.animation_data if owner is not None else None
    return data is not None and (data.action is not None or bool(data.drivers) or bool(data.nla_tracks))


def _is_dark(light: SceneLight) -> bool:
    return light.signature[POWER] == 0.0 or not any(light.signature[COLOR])
