# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights that do not shine in a reading but may in a render: what is built before has to have room for them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import bpy
from mathutils import Matrix

from ..blender_version import output_target, shader_tree
from ..identity import key_of
from ..session import SESSION
from .known_objects import Known
from .scene_lights import SceneLight, read_light

#: Indices of color and power in a light's signature (scene_lights.FIELDS).
COLOR, POWER = 2, 3


class PlacedLight(NamedTuple):
    """A light object of a scene, or one of a collection that an object of the scene has an instance of."""

    obj: bpy.types.Object
    instancers: tuple[bpy.types.Object, ...]  #: the outermost first; of a light object of the scene none

    @property
    def name(self) -> str:
        """As SceneLight.name."""
        return f"{self.obj.name} in {self.instancers[0].name}" if self.instancers else self.obj.name

    @property
    def matrix(self) -> Matrix:
        """To the world."""
        matrix = self.obj.matrix_world
        for each in reversed(self.instancers):
            matrix = each.matrix_world @ Matrix.Translation(-each.instance_collection.instance_offset) @ matrix
        return matrix


def lights_that_may_shine(
    depsgraph: bpy.types.Depsgraph, lights: list[SceneLight], known: Known | None
) -> list[SceneLight]:
    """The light objects of the scene that are animated in any way, and those that only a render shows.

    Also those of collections that objects of the scene instance. They are read as they are in the file, not evaluated:
    hidden ones are in no depsgraph of the viewport. Left out are those that are on and not animated, and those that no
    render can ever show.

    lights  what was read of the depsgraph
    known   what that reading found of its objects; while it stays the same, they are not looked through again
    """
    scene = depsgraph.scene
    target = output_target(scene)
    there = {light.object_name for light in lights}, {light.name for light in lights}
    try:
        return list(_that_may_shine(_light_objects(scene, known), there, target))
    except ReferenceError:  # one was deleted, and another one made
        return list(_that_may_shine(_light_objects(scene, None), there, target))


def _that_may_shine(placed: list[PlacedLight], there: tuple[set[str], set[str]], target: str) -> Iterator[SceneLight]:
    """there: full names of the light objects that were read, and names of the lights."""
    for each in placed:
        obj = each.obj
        owners = (obj, *each.instancers)
        is_animated = any(map(has_animation, (*owners, obj.data, shader_tree(obj.data))))
        is_there = each.name in there[1] if each.instancers else obj.name_full in there[0]
        if not is_animated and (is_there or any(owner.hide_render for owner in owners)):
            continue
        light = read_light(obj, each.matrix, each.name, target)
        if is_animated or not (light.unlit_reason or _is_dark(light)):
            yield light


def world_may_shine(scene: bpy.types.Scene) -> bool:
    """Whether the world of a scene is animated: it may be black now."""
    world = scene.world
    return world is not None and any(map(has_animation, (world, shader_tree(world))))


def _light_objects(scene: bpy.types.Scene, known: Known | None) -> list[PlacedLight]:
    """The light objects of a scene that some view layer renders, apart from what they are set to themselves."""
    collections = list(dict.fromkeys(rendered_collections(scene)))
    # Each light object is a user of its light; to count all objects would take as long as to look at them.
    users = [light.users for light in bpy.data.lights]
    off = [each.hide_render for each in bpy.data.collections]
    mark = key_of(scene), known, users, [key_of(each) for each in collections], off
    if known is not None and SESSION.light_objects is not None and SESSION.light_objects[0] == mark:
        return SESSION.light_objects[1]
    instanced: dict[bpy.types.Collection, list[PlacedLight]] = {}
    found = _placed_lights(dict.fromkeys(obj for each in collections for obj in each.objects), instanced)
    SESSION.light_objects = mark, found
    return list(found)


def _placed_lights(
    objects: Iterable[bpy.types.Object], instanced: dict[bpy.types.Collection, list[PlacedLight]]
) -> list[PlacedLight]:
    """The lights among objects, and those of the collections that these instance.

    instanced  what was found in collections so far
    """
    found = []
    for obj in objects:
        kind = obj.type
        if kind == "LIGHT":
            found.append(PlacedLight(obj, ()))
        elif kind == "EMPTY" and obj.instance_type == "COLLECTION" and obj.instance_collection is not None:
            collection = obj.instance_collection
            if collection not in instanced:
                instanced[collection] = []  # nothing, where it has an instance of itself
                instanced[collection] = _placed_lights(_rendered_objects(collection), instanced)
            found += [PlacedLight(light.obj, (obj, *light.instancers)) for light in instanced[collection]]
    return found


def _rendered_objects(collection: bpy.types.Collection) -> Iterator[bpy.types.Object]:
    """The objects of a collection whose instance is rendered."""
    if not collection.hide_render:
        yield from collection.objects
        for child in collection.children:
            yield from _rendered_objects(child)


def rendered_collections(scene: bpy.types.Scene) -> Iterator[bpy.types.Collection]:
    """The collections of a scene that some view layer of it renders."""
    waiting = [layer.layer_collection for layer in scene.view_layers]
    while waiting:
        layer_collection = waiting.pop()
        if layer_collection.collection.hide_render:
            continue  # and all that is in it
        if not layer_collection.exclude:
            yield layer_collection.collection
        waiting += layer_collection.children


def has_animation(owner: bpy.types.ID | None) -> bool:
    """Whether keys, drivers or NLA tracks may change an object or data-block."""
    data = owner.animation_data if owner is not None else None
    return data is not None and (data.action is not None or bool(data.drivers) or bool(data.nla_tracks))


def _is_dark(light: SceneLight) -> bool:
    return light.signature[POWER] == 0.0 or not any(light.signature[COLOR])
