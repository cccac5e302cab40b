"""Lights and worlds as Cycles evaluates them: muted nodes and links, the output of its engine, skewed transforms."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.read import scene_lights, scene_reading

from inside.light_units import AGREEMENT, UP, rendered_irradiance, sg, stage
from inside.scenes import add_light, depsgraph, link


def irradiance_read():
    """At the origin facing up, from everything that the add-on reads of the scene."""
    sb.register()
    reading = scene_reading.read_scene(depsgraph())
    lights = [scene_lights.make_light(light) for light in reading.lights if not light.unlit_reason]
    total = sg.surface_irradiance(lights, np.zeros((1, 3)), UP)[0]
    if reading.world is not None:
        total = total + reading.world.environment.irradiance(UP)[0]
    return total, [light.note for light in reading.lights]


def assert_as_rendered(work, scene, what):
    ours, _notes = irradiance_read()
    np.testing.assert_allclose(ours, rendered_irradiance(work, scene), rtol=AGREEMENT, atol=1e-6, err_msg=what)


def light_with_nodes():
    obj = add_light(energy=10.0, location=(0.0, 0.0, 1.0))
    if obj.data.node_tree is None:
        obj.data.use_nodes = True
    obj.visible_camera = False
    tree = obj.data.node_tree
    tree.nodes.clear()
    emission, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputLight")
    emission.inputs["Color"].default_value = (0.8, 0.6, 0.4, 1.0)
    tree.links.new(emission.outputs[0], output.inputs[0])
    return obj, tree, emission


def color_node(tree, socket):
    node = tree.nodes.new("ShaderNodeRGB")
    node.outputs[0].default_value = (0.1, 0.2, 0.9, 1.0)
    return node, tree.links.new(node.outputs[0], socket)


def mute(what):
    if isinstance(what, bpy.types.NodeLink):
        what.is_muted = True
    else:
        what.mute = True


def check_muted_nodes_of_lights(work):
    for case in ("nothing", "emission", "output link", "color", "color link", "gamma", "reroute"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = stage(64)
        _obj, tree, emission = light_with_nodes()
        if case == "emission":
            mute(emission)
        elif case == "output link":
            mute(tree.links[0])
        elif case in ("color", "color link"):
            mute(color_node(tree, emission.inputs["Color"])[case == "color link"])
        elif case in ("gamma", "reroute"):
            between = tree.nodes.new("ShaderNodeGamma" if case == "gamma" else "NodeReroute")
            color_node(tree, between.inputs[0])
            tree.links.new(between.outputs[0], emission.inputs["Color"])
            if case == "gamma":
                between.inputs["Gamma"].default_value = 3.0
                mute(between)
        assert_as_rendered(work, scene, case)


def check_muted_nodes_of_worlds(work):
    for case in ("nothing", "background", "color link"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = stage(64)
        world = scene.world = bpy.data.worlds.new("World")
        if bpy.app.version < (5, 0, 0):
            world.use_nodes = True
        node = next(n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground")
        node.inputs["Color"].default_value = (0.5, 0.4, 0.3, 1.0)
        if case == "background":
            mute(node)
        elif case == "color link":
            mute(color_node(world.node_tree, node.inputs["Color"])[1])
        assert_as_rendered(work, scene, case)


def check_output_of_the_engine(work):
    """The one for Cycles counts where Cycles renders."""
    scene = stage(64)
    _obj, tree, _emission = light_with_nodes()
    red, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputLight")
    red.inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
    output.target = "CYCLES"
    tree.links.new(red.outputs[0], output.inputs[0])
    assert_as_rendered(work, scene, "output for Cycles")
    scene.render.engine = "BLENDER_WORKBENCH"
    ours, _notes = irradiance_read()
    assert ours[1] > 0.0, "the other engines use the output for all"


def check_area_lights_under_uneven_scales(work):
    """A rectangle that became another rectangle is followed; one that is skewed is noted."""
    for turn, scale, is_noted in (
        ((0.0, 0.4, 0.0), (1.0, 1.0, 0.5), False),
        ((0.0, 0.4, 0.0), (2.0, 1.0, 1.0), False),
        ((0.3, 0.4, 0.1), (-1.0, 1.0, 1.0), False),
        ((0.0, 0.0, 0.7), (1.0, 2.0, 1.0), True),
        ((0.3, 0.2, 0.7), (1.5, 0.8, 1.0), True),
    ):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = stage()
        parent = link(bpy.data.objects.new("Parent", None))
        parent.location, parent.scale = (0.0, 0.0, 2.0), scale
        obj = add_light(kind="AREA", energy=10.0, location=(0.0, 0.0, 0.0))
        obj.data.size, obj.visible_camera = 0.05, False
        obj.parent, obj.rotation_euler = parent, turn
        _ours, notes = irradiance_read()
        assert any(notes) == is_noted, (turn, scale, notes)
        if not is_noted:
            assert_as_rendered(work, scene, f"{turn} {scale}")


def check_spots_of_uneven_scale_are_noted(_work):
    """Their cone is another one in a render: told, as long as it is not followed."""
    obj = add_light(kind="SPOT")
    for scale, is_noted in (((2.0, 2.0, 2.0), False), ((3.0, 1.0, 1.0), True), ((1.0, 1.0, 0.5), True)):
        obj.scale = scale
        (note,) = irradiance_read()[1]
        assert ("apply the scale" in note) == is_noted, (scale, note)


def check_what_only_eevee_follows_is_noted(_work):
    light = add_light("Light")
    obj = link(bpy.data.objects.new("Skin", bpy.data.meshes.new("Skin")))
    obj.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    sb.make_skin(obj, thickness=[1.0] * 3)

    def notes():
        return [row["note"] for row in sb.light_report(obj, depsgraph()) if row["name"] == "Light"]

    bpy.context.scene.render.engine = "BLENDER_EEVEE_NEXT" if (4, 2) <= bpy.app.version < (5, 0) else "BLENDER_EEVEE"
    assert notes() == [""]
    light.data.use_custom_distance = True
    assert "EEVEE alone" in notes()[0]
    light.data.use_custom_distance, light.data.diffuse_factor = False, 0.5
    assert "EEVEE alone" in notes()[0]
    bpy.context.scene.render.engine = "CYCLES"
    assert notes() == [""]


def check_shadow_linking_is_noted(_work):
    light = add_light("Light")
    obj = link(bpy.data.objects.new("Skin", bpy.data.meshes.new("Skin")))
    obj.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    sb.make_skin(obj, thickness=[1.0] * 3)

    def note():
        return next(row["note"] for row in sb.light_report(obj, depsgraph()) if row["name"] == "Light")

    assert note() == ""
    if bpy.app.version >= (4, 0, 0):
        light.light_linking.blocker_collection = bpy.data.collections.new("Blockers")
        assert "shadow linking is ignored" in note()
        light.light_linking.blocker_collection = None
        assert note() == ""
