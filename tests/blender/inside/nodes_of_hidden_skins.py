"""Skins that are hidden when they are made, and nodes that belong to a library: a render glows in both cases."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.session import SESSION

from inside.bad_input import refused
from inside.lights_that_come_on import BELOW, as_beside_a_window, close, layout, panel
from inside.scenes import add_light, black_material, depsgraph, link
from inside.shape_scenes import shape_skin, sun, thin_body
from inside.surface_weights import core_lights, expected, pixels, skin


def hide_by_eye(obj):
    obj.hide_set(True)


def hide_in_viewports(obj):
    obj.hide_viewport = True


def exclude(obj):
    """From the layer that is shown; another one renders it."""
    collection = bpy.data.collections.new("Left out")
    scene = bpy.context.scene
    scene.collection.children.link(collection)
    for each in obj.users_collection:
        each.objects.unlink(obj)
    collection.objects.link(obj)
    scene.view_layers.new("Second")
    bpy.context.view_layer.layer_collection.children["Left out"].exclude = True
    bpy.context.view_layer.use = False


HIDDEN = (hide_by_eye, hide_in_viewports, exclude)


def body(weights):
    """A skin that is lit from below, not made yet."""
    sun()
    spot = add_light("Spot", kind="SPOT", energy=2000.0, location=(0.5, 0.0, -8.0))
    spot.rotation_euler = (np.pi, 0.0, 0.0)
    return thin_body(material=black_material()), {"weights": weights, "mode": "physical"}


@as_beside_a_window()
def check_made_while_it_is_hidden(work):
    sb.register()
    for weights in ("object", "surface", "shape"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj, settings = body(weights)
        shape_skin(obj, **settings)
        wanted = pixels(work)
        assert wanted.max() > 0.0
        for hide in HIDDEN:
            bpy.ops.wm.read_factory_settings(use_empty=True)
            obj, settings = body(weights)
            hide(obj)
            depsgraph()
            state = shape_skin(obj, **settings)
            assert state.weights == weights.upper()
            np.testing.assert_allclose(pixels(work), wanted, rtol=1e-3, atol=1e-5 * wanted.max(), err_msg=hide.__name__)
            assert not SESSION.faults and sb.health(obj) == []
            # Other lights, and the file opened again.
            bpy.data.objects["Spot"].location.x = 0.2
            sb.update(depsgraph())
            bpy.ops.wm.save_as_mainfile(filepath=str(work / "hidden.blend"))
            bpy.ops.wm.open_mainfile(filepath=str(work / "hidden.blend"))
            again = pixels(work)
            assert again.max() > 0.5 * wanted.max() and not SESSION.render_faults, (weights, hide.__name__)


@as_beside_a_window()
def check_made_anew_while_it_is_hidden(work):
    """It was lit in another way while it was shown, and other skins have the same material."""
    sb.register()
    for weights in ("surface", "shape"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj, settings = body(weights)
        other = thin_body("Other", material=obj.data.materials[0])
        other.location.x = 50.0
        shape_skin(other, weights="object")
        shape_skin(obj, weights="object")
        obj.hide_set(True)
        depsgraph()
        shape_skin(obj, **settings)
        sb.update(depsgraph())
        hidden = pixels(work)
        obj.hide_set(False)
        sb.update(depsgraph())
        np.testing.assert_allclose(pixels(work), hidden, rtol=1e-3, atol=1e-5 * hidden.max())


@as_beside_a_window()
def check_a_hidden_sheet_is_lit_per_pixel(work):
    sb.register()
    add_light(**BELOW)
    obj = skin(weights="object")
    obj.hide_set(True)
    depsgraph()
    sb.make_skin(obj, weights="shape")
    close(pixels(work), expected(core_lights()))


@as_beside_a_window()
def check_nodes_of_a_library_for_too_few_lights(work):
    """They show the others as Per Object does; the fault names the file, and what can be done there."""
    sb.register()
    path = str(work / "library_skin.blend")
    add_light(**BELOW)
    obj = skin()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add_light(**BELOW)
    with bpy.data.libraries.load(path, link=True) as (_there, wanted):
        wanted.objects = ["Patch"]
    obj = link(wanted.objects[0])
    sb.update(depsgraph())
    close(pixels(work), expected(core_lights()))
    assert sb.health(obj) == []
    add_light("Second", location=(-0.5, 0.4, -1.0), energy=20.0)
    for reopened in (False, True):
        depsgraph()
        refused(sb.SkinError, "library_skin.blend", sb.update, depsgraph())
        shown = pixels(work)
        close(shown, expected(core_lights()), 0.4)
        notes = {row["name"]: row["note"] for row in sb.light_report(obj, depsgraph())}
        assert "the same all over" in notes.pop("Second") and not any(notes.values()), notes
        (fault,) = sb.health(obj)
        text = str(fault)
        assert "rendering" not in text and "Repair" not in text and "'Second'" in text, text
        assert "library_skin.blend" in text and "open that file" in text and "library_skin" in panel(obj)
        if not reopened:
            bpy.ops.wm.save_as_mainfile(filepath=str(work / "user_of_library.blend"))
            bpy.ops.wm.open_mainfile(filepath=str(work / "user_of_library.blend"))
            obj = bpy.data.objects["Patch"]
    # The remedy that it names.
    bpy.ops.wm.open_mainfile(filepath=path)
    add_light("Second", location=(-0.5, 0.4, -1.0), energy=20.0)
    depsgraph()
    assert layout(bpy.data.objects["Patch"]) == (256, 2, 0, 0)
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=str(work / "user_of_library.blend"))
    obj = bpy.data.objects["Patch"]
    sb.update(depsgraph())
    assert sb.health(obj) == []
    close(pixels(work), expected(core_lights()))


@as_beside_a_window()
def check_lights_that_come_while_it_is_hidden(work):
    """It was made and shown; what is added to the scene meanwhile lights it in renders as if it had been seen."""
    sb.register()
    for hide in HIDDEN:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        light = add_light(**BELOW)
        obj = skin()
        depsgraph()
        hide(obj)
        depsgraph()
        for i in range(3):
            add_light(f"Light {i}", location=(0.3 * i - 0.3, -0.2, -1.2 - 0.2 * i), energy=60.0)
        depsgraph()
        shown = pixels(work)
        assert SESSION.render_faults == {} and layout(obj)[1:] == (4, 0, 0), (hide.__name__, layout(obj))
        close(shown, expected(core_lights()), what=hide.__name__)
        found = SESSION.scene_skins
        light.location.x += 0.1
        depsgraph()
        assert SESSION.scene_skins is found, "all objects of the scene were looked at again"
        close(pixels(work), expected(core_lights()), what=hide.__name__)
        bpy.data.objects.remove(obj)
        light.location.x += 0.1
        assert sb.update(depsgraph()) == []


@as_beside_a_window()
def check_lighting_that_is_chosen_while_it_is_hidden(work):
    sb.register()
    for weights in ("surface", "shape"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj, settings = body(weights)
        shape_skin(obj, **settings)
        wanted = pixels(work)
        for hide in HIDDEN:
            bpy.ops.wm.read_factory_settings(use_empty=True)
            obj, settings = body(weights)
            shape_skin(obj, **{**settings, "weights": "object"})
            depsgraph()
            hide(obj)
            depsgraph()
            obj.skinglow.weights = weights.upper()
            # Any edit that Blender reports.
            bpy.context.scene.tool_settings.use_snap = True
            add_light("Dark", energy=0.0)
            depsgraph()
            shown = pixels(work)
            assert SESSION.render_faults == {}, SESSION.render_faults
            np.testing.assert_allclose(shown, wanted, rtol=1e-3, atol=1e-5 * wanted.max(), err_msg=hide.__name__)


@as_beside_a_window()
def check_no_nodes_for_skins_that_no_render_shows(_work):
    sb.register()
    add_light(**BELOW)
    obj = skin()
    depsgraph()
    obj.hide_viewport = obj.hide_render = True
    add_light("Second", location=(-0.5, 0.4, -1.0), energy=20.0)
    depsgraph()
    assert layout(obj) == (256, 1, 0, 0)
    # Until a render may.
    obj.hide_render = False
    sb.update(depsgraph())
    assert layout(obj) == (256, 2, 0, 0)
