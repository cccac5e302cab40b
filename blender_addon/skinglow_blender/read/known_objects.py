# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects of a depsgraph matter to skins, remembered so that an edit need not look at every object again."""

from collections.abc import Iterable
from typing import NamedTuple

import bpy

from ..blender_version import output_target
from ..identity import key_of
from . import working_space
from .scene_world import read_world


class Known(NamedTuple):
    """What one pass over a depsgraph found. Original objects: invalid after undo or load."""

    read: tuple[bpy.types.Object, ...]  #: lights and skins, in the order of the reading
    watched: tuple[bpy.types.Object, ...]  #: the same and all instancers, those hidden in the view layer too
    keys: frozenset[str]  #: key_of what is watched
    instancing: frozenset[str]  #: keys of the objects whose instances are lights or skins
    mark: tuple  #: mark_of the depsgraph


def known_of(
    depsgraph: bpy.types.Depsgraph,
    read: Iterable[bpy.types.Object],
    instancers: Iterable[bpy.types.Object],
    instancing: frozenset[str],
) -> Known | None:
    """What to remember of a pass; None for a render, whose depsgraph is looked at once, and where any object matters.

    read        lights and skins of the view layer, original ones
    instancers  objects that may have instances, original ones
    """
    if depsgraph.mode != "VIEWPORT" or depsgraph.scene.skinglow.occlusion:
        return None
    read = tuple(read)
    # What is hidden may be in the depsgraph, as the parent of something, and is not reported when it is shown.
    layer = depsgraph.view_layer
    more = [o for o in layer.objects if o.type == "LIGHT" or (not o.visible_get(view_layer=layer) and may_instance(o))]
    watched = tuple(dict.fromkeys((*read, *more, *instancers)))
    mark = mark_of(depsgraph, watched)
    return Known(read, watched, frozenset(map(key_of, watched)), instancing, mark)


def may_instance(obj: bpy.types.Object) -> bool:
    """Whether an object may have instances: modifiers with geometry nodes may make any."""
    if obj.is_instancer:
        return True
    modifiers = obj.modifiers
    return bool(modifiers) and any(modifier.type == "NODES" for modifier in modifiers)


def mark_of(depsgraph: bpy.types.Depsgraph, watched: Iterable[bpy.types.Object]) -> tuple:
    """What a reading depends on that no object reports; the same for a selection, another for what is hidden."""
    scene, layer = depsgraph.scene, depsgraph.view_layer
    return (
        key_of(scene),
        layer.name,
        len(layer.objects),
        scene.skinglow.occlusion,
        output_target(scene),
        working_space.working_space(),
        read_world(depsgraph),
        [(o.visible_get(view_layer=layer), o.instance_type, _key_of(o.instance_collection)) for o in watched],
    )


def _key_of(data: bpy.types.ID | None) -> str | None:
    return key_of(data) if data is not None else None


def still_holds(known: Known, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether nothing that is watched was hidden, shown or deleted."""
    try:
        return mark_of(depsgraph, known.watched) == known.mark
    except ReferenceError:
        return False


def evaluated_objects(known: Known, depsgraph: bpy.types.Depsgraph) -> list[bpy.types.Object] | None:
    """Lights and skins as they are evaluated now; None if one of them is gone."""
    try:
        found = [obj.evaluated_get(depsgraph) for obj in known.read]
    except ReferenceError:
        return None
    return found if all(obj.is_evaluated for obj in found) else None
