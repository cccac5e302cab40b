"""Instances of lights that only a render shows, or that come on in an animation: there are nodes for them before."""

import bpy
import skinglow_blender as sb

from inside.lights_that_come_on import BELOW, as_beside_a_window, close, in_animation, key_visibility, keyed, layout
from inside.scenes import add_light, depsgraph, link
from inside.surface_weights import core_lights, expected, skin


def instanced_light(name, **settings):
    """A light of a collection that an empty shows; returns the empty."""
    collection = bpy.data.collections.new(name)
    add_light(name, collection=collection, **settings)
    empty = link(bpy.data.objects.new(f"{name} shown", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    return empty


@as_beside_a_window()
def check_instances_of_lights(work):
    """Those of collections that objects of the scene show: off in the viewport, or dark at first."""
    sb.register()
    for how in ("hidden", "animated", "animated instancer", "nested"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        empty = instanced_light("Rig", **BELOW)
        empty.instance_collection.instance_offset = empty.location = (0.2, 0.1, 0.0)
        if how == "nested":
            outer = bpy.data.collections.new("Outer")
            bpy.context.scene.collection.objects.unlink(empty)
            outer.objects.link(empty)
            empty = link(bpy.data.objects.new("Outer shown", None))
            empty.instance_type, empty.instance_collection = "COLLECTION", outer
        if how in ("hidden", "nested"):
            empty.hide_viewport = True
        elif how == "animated":
            keyed(bpy.data.lights["Rig"], "energy", (0.0, 0.0, 80.0))
        else:
            key_visibility(empty)
        bpy.context.scene.frame_set(1)
        obj = skin()
        assert layout(obj) == (256, 1, 0, 0), (how, layout(obj))
        shown, faults = in_animation(work)
        assert faults and not any(faults) and sb.health(obj) == [], (how, faults)
        empty.hide_viewport = False
        bpy.context.scene.frame_set(3)
        empty.update_tag()
        close(shown, expected(core_lights()), what=how)
    # What no render shows needs nothing.
    bpy.ops.wm.read_factory_settings(use_empty=True)
    empty = instanced_light("Rig", **BELOW)
    empty.hide_viewport = empty.hide_render = True
    obj = skin()
    assert layout(obj) == (256, 0, 0, 0)
    empty.hide_render, empty.instance_collection.hide_render = False, True
    sb.update(depsgraph())
    assert layout(obj) == (256, 0, 0, 0)
