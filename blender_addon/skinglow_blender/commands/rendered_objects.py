# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects a scene renders, found without evaluating it: a look before anything is rendered."""

from functools import cached_property

import bpy

from ..read.enabled_objects import enabled_objects
from ..read.known_objects import may_instance

#: Types of data by which an object instances others.
PASSING_ON = (bpy.types.Collection, bpy.types.GeometryNodeTree, bpy.types.ParticleSettings)


class RenderedObjects:
    """The objects in the renders of a scene at the frame that it is at."""

    def __init__(self, scene: bpy.types.Scene) -> None:
        self._layers = [enabled_objects(layer, "hide_render") for layer in scene.view_layers if layer.use]

    def shows(self, obj: bpy.types.Object) -> bool:
        """Whether any view layer that is rendered has the object, or may have instances of it."""
        if obj.hide_render:
            return False
        return any(obj in layer for layer in self._layers) or self._may_be_instanced(obj)

    def follows(self, obj: bpy.types.Object) -> bool:
        """Whether every view layer that is rendered evaluates the object."""
        return all(obj in layer for layer in self._layers)

    def _may_be_instanced(self, obj: bpy.types.Object) -> bool:
        """Whether something rendered may instance an object or a collection around it, to any depth."""
        seen, left = {obj}, [obj]
        while left:
            for user in self._users.get(left.pop(), ()):
                if user in seen:
                    continue
                if isinstance(user, bpy.types.Object):
                    if not may_instance(user):
                        continue
                    if not user.hide_render and any(user in layer for layer in self._layers):
                        return True
                elif not isinstance(user, PASSING_ON):
                    continue
                seen.add(user)
                left.append(user)
        return False

    @cached_property
    def _users(self) -> dict[bpy.types.ID, set[bpy.types.ID]]:
        return bpy.data.user_map()
