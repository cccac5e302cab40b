# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects a view layer evaluates or renders, judged by its collections. What the eye hides is evaluated."""

from collections.abc import Iterator

import bpy
from bpy.types import Collection, LayerCollection, Object, Scene, Screen, ViewLayer, WindowManager, WorkSpace

from ..blender_version import node_inputs
from .known_objects import may_instance

#: Types of data that point to objects and evaluate none for it.
EVALUATING_NOTHING = (Scene, Screen, WindowManager, WorkSpace)


def enabled_objects(layer: ViewLayer, hiding: str) -> set[Object]:
    """The objects of a view layer that neither they themselves nor their collections disable.

    hiding  'hide_viewport' or 'hide_render'
    """
    return set(_enabled(layer.layer_collection, hiding))


def _enabled(collection: LayerCollection, hiding: str) -> Iterator[Object]:
    if getattr(collection.collection, hiding):
        return
    if not collection.exclude:
        yield from (obj for obj in collection.collection.objects if not getattr(obj, hiding))
    # An excluded collection may have others in it that are not.
    for child in collection.children:
        yield from _enabled(child, hiding)


def is_followed(obj: Object, layer: ViewLayer) -> bool:
    """Whether a view layer keeps the position of an object up to date.

    Blender copies any object that a custom property points to into the layer, and calls it evaluated. But it evaluates
    only what is enabled there, and what something else there depends on: an excluded rig that deforms a head, say.
    """
    # The walk over all collections is only for what is hidden.
    if obj.visible_get(view_layer=layer):
        return True
    scene = layer.id_data
    if obj == scene.camera:
        return True
    enabled = enabled_objects(layer, "hide_viewport")
    seen, left = {obj}, [obj]
    users = None
    while left:
        each = left.pop()
        if each in enabled:
            return True
        users = users if users is not None else bpy.data.user_map()
        for user in users.get(each, ()):
            if user in seen or isinstance(user, EVALUATING_NOTHING):
                continue
            if not isinstance(user, Object | Collection):
                return True  # a material or a driver of other data, of which nobody knows who evaluates it
            if isinstance(user, Collection) or _depends_on(user, each):
                seen.add(user)
                left.append(user)
    return False


def _depends_on(user: Object, obj: Object | Collection) -> bool:
    """Whether an object that points to another, or to a collection around it, cannot be evaluated without it."""
    if isinstance(obj, Collection):
        return may_instance(user)
    if user.type != "MESH" or user.skinglow.reference_object != obj:
        return True
    # That is what makes it point there: does anything else?
    if user.parent == obj or any(_points_to(each, obj) for each in (*user.modifiers, *user.constraints)):
        return True
    drivers = user.animation_data.drivers if user.animation_data is not None else ()
    return any(t.id == obj for d in drivers for variable in d.driver.variables for t in variable.targets)


def _points_to(owner: bpy.types.bpy_struct, obj: Object) -> bool:
    found = any(getattr(owner, p.identifier) == obj for p in owner.bl_rna.properties if p.type == "POINTER")
    if found or obj in {target.target for target in getattr(owner, "targets", ())}:
        return True
    return isinstance(owner, bpy.types.NodesModifier) and obj in node_inputs(owner)
