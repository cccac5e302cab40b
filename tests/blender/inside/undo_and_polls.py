"""Each operator undone and redone, why a button is gray, and measuring that is canceled or overtaken."""

import time

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.read import measured_geometry
from skinglow_blender.session import SESSION
from skinglow_blender.thickness import thickness_attribute
from skinglow_blender.thickness.measuring import Measuring

from inside.scenes import add_light, assert_fresh, depsgraph

sb.register()

THICKNESS = thickness_attribute.THICKNESS_ATTRIBUTE


def ball(name="Ball", radius=0.5):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius)
    bpy.context.object.name = name
    return bpy.context.object


def skin_ball():
    obj = ball()
    obj.skinglow.unit_mm = 10.0
    bpy.ops.skinglow.make(mode="PAPER")
    return obj


def the_ball():
    return bpy.data.objects["Ball"]


def thickness_of(obj):
    attribute = obj.data.attributes.get(THICKNESS)
    if attribute is None:
        return None
    values = np.empty(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", values)
    return values


def do_undo_redo(operator, before, after, **arguments):
    """Runs an operator from a state that is on the undo stack; checks all three states."""
    bpy.ops.ed.undo_push(message="before")
    before()
    assert operator("EXEC_DEFAULT", True, **arguments) == {"FINISHED"}
    after()
    bpy.ops.ed.undo()
    sb_update()
    before()
    bpy.ops.ed.redo()
    sb_update()
    after()
    bpy.ops.ed.undo()
    sb_update()
    before()


def sb_update():
    """What a window does by itself after undo, and a script has to ask for."""
    if bpy.data.node_groups:
        sb.update(depsgraph())


def check_make(_work):
    add_light("Key")
    ball()

    def before():
        assert not the_ball().skinglow.enabled and thickness_of(the_ball()) is None
        assert not bpy.data.node_groups and not the_ball().material_slots

    def after():
        assert the_ball().skinglow.enabled and len(thickness_of(the_ball()))
        assert_fresh(the_ball())

    do_undo_redo(bpy.ops.skinglow.make, before, after, mode="PAPER")


def check_redo_of_make_in_each_lighting(_work):
    """It shows what it did, follows the light, and leaves a file in which others can be made."""
    for weights in ("OBJECT", "SURFACE", "SHAPE"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        add_light("Key", location=(0.0, 0.0, 2.0))
        ball().skinglow.unit_mm = 10.0
        bpy.ops.ed.undo_push(message="before")
        assert bpy.ops.skinglow.make("EXEC_DEFAULT", True, weights=weights) == {"FINISHED"}
        shown = sb.lut(the_ball(), depsgraph())
        assert shown.max() > 0.0
        bpy.ops.ed.undo()
        depsgraph()
        bpy.ops.ed.redo()
        depsgraph()
        sb.update(depsgraph())
        assert sb.health(the_ball()) == [] and not SESSION.faults, weights
        np.testing.assert_allclose(sb.lut(the_ball(), depsgraph()), shown, rtol=1e-6)
        bpy.data.objects["Key"].data.energy *= 2.0
        np.testing.assert_allclose(sb.lut(the_ball(), depsgraph()), 2.0 * shown, rtol=1e-6)
        bpy.data.objects.remove(the_ball())
        depsgraph()
        ball().skinglow.unit_mm = 10.0
        assert bpy.ops.skinglow.make(weights=weights) == {"FINISHED"}
        np.testing.assert_allclose(sb.lut(the_ball(), depsgraph()), 2.0 * shown, rtol=1e-6)


def check_remove(_work):
    add_light("Key")
    skin_ball()

    def before():
        assert the_ball().skinglow.enabled and len(thickness_of(the_ball()))
        assert_fresh(the_ball())

    def after():
        assert not the_ball().skinglow.enabled and thickness_of(the_ball()) is None and not bpy.data.node_groups

    do_undo_redo(bpy.ops.skinglow.remove, before, after)


def check_reset(_work):
    add_light("Key")
    skin_ball().skinglow.blood_weight = (9.0, 9.0, 9.0)

    def before():
        assert the_ball().skinglow.blood_weight[0] == 9.0
        assert sb.lut(the_ball(), depsgraph())[0, 2] > 5.0

    def after():
        assert the_ball().skinglow.blood_weight[0] != 9.0 and the_ball().skinglow.mode == "PHYSICAL"
        assert 0.0 < sb.lut(the_ball(), depsgraph())[0, 2] < 1.0

    do_undo_redo(bpy.ops.skinglow.reset, before, after)


def check_measure_thickness(_work):
    add_light("Key")
    obj = skin_ball()
    thickness_attribute.store(obj, [3.0] * len(obj.data.vertices), unit_mm=1000.0)

    def before():
        assert (thickness_of(the_ball()) == 3.0).all()

    def after():
        np.testing.assert_allclose(thickness_of(the_ball()), 10.0, rtol=0.05)

    do_undo_redo(bpy.ops.skinglow.measure_thickness, before, after)
    # What was measured on this geometry is known as such: making the skin again does not measure it again.
    bpy.ops.skinglow.measure_thickness()
    assert not thickness_attribute.ensure_measured(the_ball(), bpy.context.scene)


def check_update(_work):
    """Not live: the light's color reaches the skin by the button alone."""
    key = add_light("Key")
    obj = skin_ball()
    obj.skinglow.live = False
    depsgraph()
    key.data.color = (0.0, 0.0, 1.0)
    depsgraph()
    bpy.ops.ed.undo_push(message="blue")
    stale = sb.lut(obj, depsgraph())
    assert bpy.ops.skinglow.update("EXEC_DEFAULT", True) == {"FINISHED"}
    assert_fresh(the_ball())
    assert not np.array_equal(sb.lut(the_ball(), depsgraph()), stale)
    bpy.ops.ed.undo()
    assert tuple(bpy.data.objects["Key"].data.color) == (0.0, 0.0, 1.0) and the_ball().skinglow.enabled
    bpy.ops.ed.redo()
    sb_update()
    assert_fresh(the_ball())


def check_select_light(_work):
    add_light("Key")
    add_light("Rim")
    skin_ball()

    def selected(*names):
        return lambda: sorted(o.name for o in bpy.context.selected_objects) == list(names) or fail(names)

    def fail(names):
        raise AssertionError(f"{[o.name for o in bpy.context.selected_objects]} is selected, not {names}")

    do_undo_redo(bpy.ops.skinglow.select_light, selected("Ball"), selected("Rim"), light="Rim")
    bpy.ops.skinglow.select_light(light="Rim")
    # The skin is active still, so that the panel stays, and the buttons still mean it.
    assert bpy.context.object == the_ball()
    assert bpy.ops.skinglow.reset() == {"FINISHED"}
    bpy.data.objects["Key"].hide_set(True)
    refused("is hidden or not selectable", bpy.ops.skinglow.select_light, light="Key")
    refused("'Nobody' is not in this view layer", bpy.ops.skinglow.select_light, light="Nobody")


def refused(text, operator, **arguments):
    try:
        operator(**arguments)
    except RuntimeError as error:
        assert text in str(error), str(error)
    else:
        raise AssertionError(f"nothing was said of {text}")


def check_why_a_button_is_gray(_work):
    ops = bpy.ops.skinglow
    refused("Select a mesh to make glow", ops.make)
    refused("This file has no skin yet", ops.update)
    refused("This file has no skin yet", ops.export_povray, directory="//")
    ball()
    for operator in (ops.measure_thickness, ops.reset, ops.remove):
        refused("Select a skin, or create one", operator)
    ops.make()
    bpy.ops.object.mode_set(mode="EDIT")
    for operator in (ops.make, ops.measure_thickness, ops.reset, ops.remove):
        refused("Only available in Object Mode", operator)
    bpy.ops.object.mode_set(mode="OBJECT")
    refused("No folder selected", ops.export_povray)


def check_all_selected_or_none(_work):
    """One of the selected meshes cannot be a skin: that is said before any is changed."""
    obj = ball()
    empty = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    bpy.context.scene.collection.objects.link(empty)
    empty.select_set(True)
    refused("'Nothing' has no faces", bpy.ops.skinglow.make)
    assert not obj.skinglow.enabled and thickness_of(obj) is None and not bpy.data.node_groups
    empty.select_set(False)
    other = ball("Other")
    obj.select_set(True)
    bpy.ops.skinglow.make(mode="PAPER")
    assert obj.skinglow.enabled and other.skinglow.enabled
    obj.skinglow.strength = other.skinglow.strength = 3.0
    bpy.ops.skinglow.reset()
    assert obj.skinglow.strength == other.skinglow.strength == 1.0


def fine_ball():
    """Takes seconds to measure."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=8)
    obj = bpy.context.object
    obj.skinglow.rays = 4096
    return obj


def check_a_canceled_measuring_stops_soon(_work):
    geometry = measured_geometry.read_geometry(fine_ball(), bpy.context.scene)
    measuring = Measuring({"Ball": geometry})
    end = time.monotonic() + 60.0
    while not measuring.done and time.monotonic() < end:
        time.sleep(0.01)
    assert measuring.running and 0.0 < measuring.done < 1.0, measuring.done
    measuring.cancel()
    assert not measuring.running and not measuring.thicknesses
    try:
        measuring.wait()
    except RuntimeError as error:
        assert "cancel" in str(error), str(error)
    else:
        raise AssertionError("a canceled measuring gave a result")
    assert SESSION.measuring is None


def check_a_mesh_edited_while_measured_keeps_what_it_had(_work):
    obj = skin_ball()
    before = thickness_of(obj)
    geometry = measured_geometry.read_geometry(obj, bpy.context.scene)
    values, _no_far_side = Measuring({obj.name: geometry}).wait()[obj.name]
    obj.data.vertices[0].co.z += 1.0
    try:
        thickness_attribute.store_measured(obj, bpy.context.scene, geometry, values * 2.0)
    except sb.SkinError as error:
        assert "was changed while its thickness was measured" in str(error)
    else:
        raise AssertionError("thickness of another shape was stored")
    np.testing.assert_array_equal(thickness_of(obj), before)


def check_removing_the_add_on_stops_measuring(_work):
    geometry = measured_geometry.read_geometry(fine_ball(), bpy.context.scene)
    SESSION.measuring = measuring = Measuring({"Ball": geometry})
    refused("Thickness is being measured", bpy.ops.skinglow.make)
    sb.unregister()
    try:
        assert not measuring.running
    finally:
        SESSION.measuring = None
        sb.register()
