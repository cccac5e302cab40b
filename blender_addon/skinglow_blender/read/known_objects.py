# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects of a depsgraph matter to skins, remembered so that an edit need not look at every object again."""

from functools import cached_property

import bpy

from ..blender_version import output_target
from ..identity import key_of
from . import working_space
from .scene_world import World, read_world


class Known:
    """What one pass over a depsgraph found. Original objects: invalid after undo or load."""

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        read: list[bpy.types.Object],
        instancers: list[bpy.types.Object],
        instancing: set[str],
        world: World | None,
    ) -> None:
        """Remembers lights and skins of the view layer, what may have instances, and what has some of these."""
        self.read = read  #: lights and skins, in the order of the reading
        self.instancing = instancing  #: keys of the objects whose instances are lights or skins
        # What is hidden may be in the depsgraph, as the parent of something, and is not reported when it is shown.
        layer = depsgraph.view_layer
        taken = set(read)
        others = [obj for obj in layer.objects if obj not in taken]
        self._hidden = [obj for obj in others if obj.type == "LIGHT" or (obj.type == "MESH" and obj.skinglow.enabled)]
        self._hidden += [obj for obj in others if not obj.visible_get(view_layer=layer) and may_instance(obj)]
        self._instancers = instancers
        self._mark = self._mark_of(depsgraph, world)

    @cached_property
    def keys(self) -> frozenset[str]:
        """key_of lights, skins and instancers, those hidden in the view layer too; raises ReferenceError."""
        return frozenset(map(key_of, (*self.read, *self._hidden, *self._instancers)))

    def still_holds(self, depsgraph: bpy.types.Depsgraph) -> bool:
        """Whether nothing of this was hidden, shown or deleted, and the scene's own settings are the same."""
        try:
            return self._mark_of(depsgraph, read_world(depsgraph)) == self._mark
        except ReferenceError:
            return False

    def _mark_of(self, depsgraph: bpy.types.Depsgraph, world: World | None) -> tuple:
        """What a reading depends on that no object reports; the same for a selection."""
        scene, layer = depsgraph.scene, depsgraph.view_layer
        return (
            key_of(scene),
            layer.name,
            len(layer.objects),
            len(bpy.data.images),  # Blender 3.4 reports the scene alone when an image of a lookup is deleted
            scene.skinglow.occlusion,
            output_target(scene),
            working_space.working_space(),
            world,
            [obj.visible_get(view_layer=layer) for obj in (*self.read, *self._hidden)],
            [_instances(obj, layer) for obj in self._instancers],
        )

    def evaluated(self, depsgraph: bpy.types.Depsgraph) -> list[bpy.types.Object] | None:
        """Lights and skins as they are evaluated now; None if one of them is gone."""
        try:
            found = [obj.evaluated_get(depsgraph) for obj in self.read]
        except ReferenceError:
            return None
        return found if all(obj.is_evaluated for obj in found) else None


def _instances(obj: bpy.types.Object, layer: bpy.types.ViewLayer) -> tuple[bool, str, str | None]:
    collection = obj.instance_collection
    return obj.visible_get(view_layer=layer), obj.instance_type, key_of(collection) if collection is not None else None


def may_instance(obj: bpy.types.Object) -> bool:
    """Whether an object may have instances: modifiers with geometry nodes may make any."""
    if obj.is_instancer:
        return True
    modifiers = obj.modifiers
    return bool(modifiers) and any(modifier.type == "NODES" for modifier in modifiers)
