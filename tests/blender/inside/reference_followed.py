"""Light Distance From > Object: where Blender does not evaluate that object, its distance follows nothing, and that is
told; the eye, renders and whatever else depends on it are no reason to."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands.health import INCLUDE_REFERENCE
from skinglow_blender.session import SESSION

from inside.bad_input import refused
from inside.batch_studio import manifest_of
from inside.measured_as_shown import geometry_nodes
from inside.panel_faults import panel
from inside.scenes import add_light, camera_above, depsgraph, link, render_settings
from inside.skin_health import healthy_skin

TOLD = "'Empty' is not evaluated in this view layer (excluded or disabled)"


def skin_and_empty():
    obj = healthy_skin()
    controls = bpy.data.collections.new("Controls")
    bpy.context.scene.collection.children.link(controls)
    empty = link(bpy.data.objects.new("Empty", None), controls)
    sb.make_skin(obj, weights="object", reference_object=empty)
    assert sb.health(obj) == []
    return obj, empty, controls


def layer_collection():
    return bpy.context.view_layer.layer_collection.children["Controls"]


def exclude(_empty, _controls, on):
    layer_collection().exclude = on


def disable(empty, _controls, on):
    empty.hide_viewport = on


def disable_collection(_empty, controls, on):
    controls.hide_viewport = on


def hide(empty, _controls, on):
    empty.hide_set(on)


def hide_collection(_empty, _controls, on):
    layer_collection().hide_viewport = on


def hide_in_renders(empty, _controls, on):
    empty.hide_render = on


def hide_collection_in_renders(_empty, controls, on):
    controls.hide_render = on


def follows(obj, empty):
    """Whether the skin's point is where the empty was moved to."""
    empty.location.z += 0.25
    point = sb.state_of(obj, depsgraph()).point
    return abs(point[2] - empty.location.z) < 1e-6


def check_what_is_not_followed_is_told(_work):
    for how in (exclude, disable, disable_collection):
        obj, empty, controls = skin_and_empty()
        how(empty, controls, True)
        assert not follows(obj, empty), how.__name__
        (fault,) = sb.health(obj)
        assert TOLD in fault.what and fault.remedy == INCLUDE_REFERENCE and not fault.is_hint, fault
        text, buttons = panel(obj)
        assert TOLD in text and "hide it with the eye" in text and buttons == [], (text, buttons)
        # No button mends it, and that is what it says.
        refused(RuntimeError, TOLD, bpy.ops.skinglow.repair)
        how(empty, controls, False)
        shown = sb.lut(obj, depsgraph())
        SESSION.forget_tables()
        sb.update(depsgraph())
        np.testing.assert_array_equal(sb.lut(obj, depsgraph()), shown)
        assert follows(obj, empty) and sb.health(obj) == [] and panel(obj) == ("", []), how.__name__


def check_what_is_followed_is_no_fault(_work):
    for how in (hide, hide_collection, hide_in_renders, hide_collection_in_renders):
        obj, empty, controls = skin_and_empty()
        how(empty, controls, True)
        assert follows(obj, empty), how.__name__
        assert sb.health(obj) == [] and panel(obj) == ("", []), how.__name__


def needs_as_parent(obj, empty):
    obj.parent = empty


def needs_as_parent_of_another(_obj, empty):
    child = link(bpy.data.objects.new("Child", None))
    child.parent = empty


def needs_as_parent_of_an_excluded_one(_obj, empty):
    child = link(bpy.data.objects.new("Child", None), bpy.data.collections["Controls"])
    child.parent = empty
    link(bpy.data.objects.new("Grandchild", None)).parent = child


def needs_for_a_constraint(obj, empty):
    obj.constraints.new("LIMIT_DISTANCE").target = empty


def needs_for_a_modifier(obj, empty):
    obj.modifiers.new("Bent", "SIMPLE_DEFORM").origin = empty


def needs_for_an_input_of_nodes(obj, empty):
    geometry_nodes(obj, "GeometryNodeSetShadeSmooth")
    modifier = obj.modifiers[0]
    if hasattr(modifier.node_group, "interface"):
        socket = modifier.node_group.interface.new_socket("Empty", in_out="INPUT", socket_type="NodeSocketObject")
    else:
        socket = modifier.node_group.inputs.new("NodeSocketObject", "Empty")
    if hasattr(modifier, "properties"):
        getattr(modifier.properties.inputs, socket.identifier).value = empty
    else:
        modifier[socket.identifier] = empty


def needs_for_an_instance(_obj, _empty):
    instance = link(bpy.data.objects.new("Instance", None))
    instance.instance_type, instance.instance_collection = "COLLECTION", bpy.data.collections["Controls"]


def needs_for_a_driver(obj, empty):
    driver = obj.driver_add("location", 0).driver
    driver.expression = "x"
    variable = driver.variables.new()
    variable.name, variable.type = "x", "TRANSFORMS"
    variable.targets[0].id = empty


def check_what_something_else_depends_on_is_followed(_work):
    """An excluded rig that deforms the head, say: Blender evaluates it."""
    for need in (
        needs_as_parent,
        needs_as_parent_of_another,
        needs_as_parent_of_an_excluded_one,
        needs_for_a_constraint,
        needs_for_a_modifier,
        needs_for_an_input_of_nodes,
        needs_for_an_instance,
        needs_for_a_driver,
    ):
        obj, empty, controls = skin_and_empty()
        need(obj, empty)
        exclude(empty, controls, True)
        assert follows(obj, empty), need.__name__
        assert not any(TOLD in fault.what for fault in sb.health(obj)), need.__name__


def check_nodes_of_the_skin_are_no_reason(_work):
    """Smooth shading by geometry nodes, say, which have nothing to do with the empty."""
    obj, empty, controls = skin_and_empty()
    geometry_nodes(obj, "GeometryNodeSetShadeSmooth")
    obj.modifiers.new("Empty nodes", "NODES")
    exclude(empty, controls, True)
    assert not follows(obj, empty) and TOLD in sb.health(obj)[0].what


def check_nobody_evaluates_what_an_excluded_one_needs(_work):
    obj, empty, controls = skin_and_empty()
    child = link(bpy.data.objects.new("Child", None), controls)
    child.parent = empty
    exclude(empty, controls, True)
    assert not follows(obj, empty) and TOLD in sb.health(obj)[0].what


def check_batches(work):
    """One refuses what its renders do not follow, and renders with what is disabled in the viewport alone."""
    obj, empty, controls = skin_and_empty()
    add_light("Near", location=(0.0, 0.0, 0.3))
    camera_above()
    render_settings(4, 4)
    exclude(empty, controls, True)
    refused(sb.SkinError, TOLD, sb.render_batch, work / "excluded", frames=[1])
    exclude(empty, controls, False)
    disable(empty, controls, True)
    assert TOLD in sb.health(obj)[0].what
    done = sb.render_batch(work / "disabled", frames=[1])
    assert len(done.rendered) == 1 and not done.failed
    disable(empty, controls, False)
    hide_in_renders(empty, controls, True)
    for frame, z in ((1, 0.25), (2, 0.5)):
        empty.location.z = z
        empty.keyframe_insert("location", frame=frame)
    sb.render_batch(work / "moving", frames=[1, 2])
    points = [entry["skins"][0]["point"][2] for entry in manifest_of(work / "moving")]
    assert np.allclose(points, (0.25, 0.5)), points
    disable(empty, controls, True)
    refused(sb.SkinError, TOLD, sb.render_batch, work / "hidden", frames=[1])
