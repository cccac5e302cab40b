"""A batch looks at the skins that it renders, whichever way the others are kept from it."""

import bpy
import skinglow_blender as sb
from skinglow_blender.commands.rendered_objects import RenderedObjects

from inside.bad_input import refused
from inside.measured_as_shown import geometry_nodes, plate
from inside.scenes import camera_above, depsgraph, link, render_settings
from inside.skin_health import healthy_skin, remove_node

FAULT = "'Old': None of its materials"


def good_and_old():
    """A healthy skin, and one with a fault in a collection of its own, inside another."""
    healthy_skin()
    camera_above()
    render_settings(4, 4)
    archive, inner = bpy.data.collections.new("Archive"), bpy.data.collections.new("Inner")
    bpy.context.scene.collection.children.link(archive)
    archive.children.link(inner)
    old = plate()
    old.name = "Old"
    sb.make_skin(old, mode="physical")
    old.material_slots[0].material = old.material_slots[0].material.copy()
    remove_node(old)
    bpy.context.scene.collection.objects.unlink(old)
    inner.objects.link(old)
    depsgraph()
    return old, archive, inner


def layer_collection(*names, layer=None):
    found = (layer or bpy.context.view_layer).layer_collection
    for name in names:
        found = found.children[name]
    return found


def hide_object(old, _archive, _inner):
    old.hide_render = True


def hide_collection(_old, _archive, inner):
    inner.hide_render = True


def hide_outer_collection(_old, archive, _inner):
    archive.hide_render = True


def exclude(_old, _archive, _inner):
    layer_collection("Archive", "Inner").exclude = True


def exclude_outer(_old, _archive, _inner):
    layer_collection("Archive").exclude = True


def rendered_names():
    """The meshes of a render, as Blender has them."""
    found = set()

    def look(_scene, graph):
        if graph.mode == "RENDER":
            found.update(i.object.original.name for i in graph.object_instances if i.object.type == "MESH")

    bpy.app.handlers.frame_change_post.append(look)
    try:
        bpy.ops.render.render()
    finally:
        bpy.app.handlers.frame_change_post.remove(look)
    return found


def check_skins_that_are_not_rendered_are_not_looked_at(work):
    for how in (hide_object, hide_collection, hide_outer_collection, exclude, exclude_outer):
        parts = good_and_old()
        refused(sb.SkinError, FAULT, sb.render_batch, work / f"{how.__name__}_before", frames=[1])
        assert "Old" in rendered_names()
        how(*parts)
        depsgraph()
        assert "Old" not in rendered_names(), how.__name__
        done = sb.render_batch(work / how.__name__, frames=[1])
        assert len(done.rendered) == 1 and not done.failed


def check_other_view_layers(work):
    """What one of them renders is looked at; one that is not used for rendering shows nothing."""
    old, *_ = good_and_old()
    scene = bpy.context.scene
    exclude(old, None, None)
    second = scene.view_layers.new("Second")
    layer_collection("Archive", "Inner", layer=second).exclude = False
    depsgraph()
    refused(sb.SkinError, FAULT, sb.render_batch, work / "two", frames=[1])
    second.use = False
    done = sb.render_batch(work / "one", frames=[1])
    assert len(done.rendered) == 1 and not done.failed


def check_a_collection_in_an_excluded_one(_work):
    """It may be included; what hides the one around it hides it too."""
    old, archive, inner = good_and_old()
    for is_hidden in (False, True):
        layer_collection("Archive").exclude = True
        layer_collection("Archive", "Inner").exclude = False
        archive.hide_render = is_hidden
        depsgraph()
        is_rendered = "Old" in rendered_names()
        assert RenderedObjects(bpy.context.scene).shows(old) == is_rendered, is_hidden
        assert is_rendered != is_hidden


def instance_collection(_old, archive):
    empty = link(bpy.data.objects.new("Instance", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", archive
    return empty


def instance_by_nodes(old, _archive):
    obj = plate()
    obj.name = "Scattering"
    geometry_nodes(obj, "GeometryNodeSetShadeSmooth")
    nodes = obj.modifiers[0].node_group.nodes
    info = nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = old
    output = next(node for node in nodes if node.bl_idname == "NodeGroupOutput")
    obj.modifiers[0].node_group.links.new(info.outputs["Geometry"], output.inputs[0])
    for socket in info.inputs:
        if socket.name == "As Instance":
            socket.default_value = True
    return obj


def instance_by_particles(old, _archive):
    obj = plate()
    obj.name = "Haired"
    obj.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = obj.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length, settings.particle_size = "HAIR", 3, 0.01, 1.0
    settings.render_type, settings.instance_object = "OBJECT", old
    return obj


def check_instances_of_what_is_excluded_are_rendered(work):
    """So they are looked at, unless what makes them is hidden itself."""
    for make in (instance_collection, instance_by_nodes, instance_by_particles):
        old, archive, _inner = good_and_old()
        exclude_outer(None, None, None)
        maker = make(old, archive)
        depsgraph()
        assert "Old" in rendered_names(), make.__name__
        refused(sb.SkinError, FAULT, sb.render_batch, work / make.__name__, frames=[1])
        maker.hide_render = True
        depsgraph()
        assert "Old" not in rendered_names(), make.__name__
        done = sb.render_batch(work / f"{make.__name__}_hidden", frames=[1])
        assert len(done.rendered) == 1 and not done.failed


def check_frozen_skins_that_are_not_rendered_take_part_in_no_rig(work):
    """They refuse no rig, as those whose own camera icon is off do not."""
    old, archive, inner = good_and_old()
    sb.make_skin(old)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "frozen.blend"))
    sb.freeze([old], 1, 1)
    refused(sb.SkinError, "Old: frozen", sb.render_batch, work / "rigs", frames=[1], rigs=[sb.Rig("all", ("Lamp",))])
    hide_collection(old, archive, inner)
    done = sb.render_batch(work / "rigs", frames=[1], rigs=[sb.Rig("all", ("Lamp",))])
    assert len(done.rendered) == 1 and not done.failed
