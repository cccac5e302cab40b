"""Light per pixel that only a render shows: there are nodes for it before, or it lights the skin as a whole."""

from contextlib import contextmanager

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.blender_version import shader_tree
from skinglow_blender.commands.health import require_health
from skinglow_blender.session import SESSION
from skinglow_blender.ui import main_panel

from inside.panel_faults import Box
from inside.scenes import add_light, depsgraph, link
from inside.surface_weights import core_lights, expected, pixels, skin

#: Below the patch, so on its far side.
BELOW = {"location": (0.3, -0.2, -1.5), "energy": 80.0, "color": (1.0, 0.6, 0.3)}
FRAMES = (1, 2, 3)


@contextmanager
def as_beside_a_window():
    """Renders may build no nodes, as where Blender has a window; also a decorator."""
    SESSION.is_background = False
    try:
        yield
    finally:
        SESSION.is_background = True


def layout(obj):
    return tuple(int(n) for n in obj.skinglow.group["skinglow_layout"])


def spot(name="Spot", **settings):
    obj = add_light(name, kind="SPOT", **{**BELOW, **settings})
    obj.rotation_euler, obj.data.shadow_soft_size = (np.pi, 0.1, 0.0), 0.0
    return obj


def keyed(owner, path, values):
    for frame, value in zip(FRAMES, values, strict=True):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def key_nodes(light):
    if light.data.node_tree is None:
        light.data.use_nodes = True
    socket = next(n for n in shader_tree(light.data).nodes if n.bl_idname == "ShaderNodeEmission").inputs["Strength"]
    keyed(socket, "default_value", (0.0, 0.0, 1.0))


def key_visibility(light):
    keyed(light, "hide_render", (True, True, False))
    keyed(light, "hide_viewport", (True, True, False))


def drive_energy(light):
    light.data.driver_add("energy").driver.expression = "80.0 if frame > 2 else 0.0"


COMING_ON = {
    "energy": lambda light: keyed(light.data, "energy", (0.0, 0.0, 80.0)),
    "color": lambda light: keyed(light.data, "color", ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.6, 0.3))),
    "visibility": key_visibility,
    "nodes": key_nodes,
    "driver": drive_energy,
}


def close(shown, wanted, tolerance=0.02, what=""):
    assert wanted.max() > 0.0
    off = float(np.abs(shown - wanted).max() / wanted.max())
    assert off < tolerance, (off, what)


def in_animation(work):
    """The picture of the last frame, of an animation that the viewport shows at the first."""
    bpy.context.scene.frame_set(1)
    seen = []

    def look(scene, graph):
        if graph.mode == "RENDER" and scene.frame_current == FRAMES[-1]:
            seen.append(SESSION.faults.copy())

    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    bpy.app.handlers.frame_change_post.append(look)
    try:
        return pixels(work, animation=True), seen
    finally:
        bpy.app.handlers.frame_change_post.remove(look)


@as_beside_a_window()
def check_lights_that_come_on_in_an_animation(work):
    sb.register()
    for how, make in COMING_ON.items():
        for kind in (add_light, spot):
            bpy.ops.wm.read_factory_settings(use_empty=True)
            light = kind(**BELOW)
            make(light)
            bpy.context.scene.frame_set(1)
            obj = skin()
            assert layout(obj)[1:] == ((1, 0, 0) if kind is add_light else (0, 1, 0)), (how, layout(obj))
            shown, faults = in_animation(work)
            assert faults and not any(faults) and sb.health(obj) == [], (how, faults)
            bpy.context.scene.frame_set(3)
            light.update_tag()  # 3.4 shows what comes into the viewport by its animation at the origin
            close(shown, expected(core_lights()), what=f"{how} {kind.__name__}")


@as_beside_a_window()
def check_a_world_that_comes_on_in_an_animation(work):
    sb.register()
    world = bpy.context.scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    strength = next(n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground").inputs["Strength"]
    keyed(strength, "default_value", (0.0, 0.0, 1.0))
    bpy.context.scene.frame_set(1)
    obj = skin()
    assert layout(obj)[1:] == (0, 0, 1)
    shown, faults = in_animation(work)
    assert faults and not any(faults)
    bpy.context.scene.frame_set(3)
    close(shown, pixels(work), 1e-3)


@as_beside_a_window()
def check_lights_that_only_a_render_shows(work):
    sb.register()
    hidden = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(hidden)
    light = add_light(collection=hidden, **BELOW)
    other = spot(location=(-0.4, 0.3, -1.2))
    other.hide_viewport = hidden.hide_viewport = True
    obj = skin()
    assert core_lights() == [] and layout(obj)[1:] == (1, 1, 0)
    shown = pixels(work)
    assert sb.health(obj) == []
    other.hide_viewport = hidden.hide_viewport = False
    close(shown, expected(core_lights()))
    # A layer that is not shown, of a collection that the shown one leaves out.
    bpy.data.objects.remove(other)
    second = bpy.context.scene.view_layers.new("Second")
    shown_layer = bpy.context.view_layer
    shown_layer.layer_collection.children["Hidden"].exclude = True
    sb.remove_skin(obj)
    bpy.data.objects.remove(obj)
    obj = skin()
    assert core_lights() == [] and layout(obj)[1:] == (1, 0, 0)
    shown_layer.use, second.use = False, True
    shown = pixels(work)
    shown_layer.layer_collection.children["Hidden"].exclude = False
    close(shown, expected(core_lights()))
    assert light.name in bpy.context.view_layer.objects


@as_beside_a_window()
def check_no_room_for_lights_that_never_shine(_work):
    sb.register()
    off = bpy.data.collections.new("Off")
    bpy.context.scene.collection.children.link(off)
    off.hide_render = off.hide_viewport = True
    keyed(add_light("In a collection that is off", collection=off, **BELOW).data, "energy", (0.0, 1.0, 2.0))
    add_light("Off", **BELOW).hide_render = True
    bpy.data.objects["Off"].hide_viewport = True
    add_light("Dark", **{**BELOW, "energy": 0.0}).hide_viewport = True
    area = add_light("No size", kind="AREA", **BELOW)
    area.data.size, area.hide_viewport = 0.0, True
    excluded = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(excluded)
    add_light("In no layer", collection=excluded, **BELOW)
    bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
    bpy.data.objects["Off"].rotation_euler.x = 1.0
    obj = skin()
    assert layout(obj) == (256, 0, 0, 0)
    # And as soon as they may, they get some.
    bpy.data.objects["Off"].hide_render = False
    sb.update(depsgraph())
    assert layout(obj) == (256, 1, 0, 0)
    keyed(bpy.data.objects["Dark"].data, "energy", (0.0, 0.0, 1.0))
    sb.update(depsgraph())
    assert layout(obj) == (256, 2, 0, 0)
    for i in range(12):
        light = spot(f"Spot {i}", location=(0.1 * i, 0.0, -2.0))
        keyed(light.data, "energy", (0.0, 0.0, 80.0))
    sb.update(depsgraph())
    assert layout(obj) == (256, 2, 8, 1), layout(obj)


@as_beside_a_window()
def check_the_handler_makes_room_for_lights_that_appear(_work):
    """Also where the objects that an edit before it found are known and taken again."""
    sb.register()
    light = add_light(**BELOW)
    obj = skin()
    depsgraph()
    assert layout(obj) == (256, 1, 0, 0)
    new = add_light("New", location=(0.5, 0.4, -1.0))
    new.hide_viewport = True
    light.location.x += 0.1
    depsgraph()
    assert layout(obj) == (256, 2, 0, 0)
    found = SESSION.light_objects
    light.location.x -= 0.1
    depsgraph()
    assert SESSION.light_objects is found, "all objects of the scene were looked at again"
    new = spot("Spot", energy=0.0)
    depsgraph()
    assert layout(obj) == (256, 2, 0, 0)
    new.data.keyframe_insert("energy", frame=1)
    depsgraph()
    light.location.x += 0.1
    depsgraph()
    assert layout(obj) == (256, 2, 1, 0)


def light_of_nodes(name, **settings):
    """A light of a collection that geometry nodes instance, which no look at objects finds; returns their object."""
    collection = bpy.data.collections.new(name)
    add_light(name, collection=collection, **settings)
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    info, end = tree.nodes.new("GeometryNodeCollectionInfo"), tree.nodes.new("NodeGroupOutput")
    info.inputs["Collection"].default_value = collection
    tree.links.new(info.outputs[0], end.inputs[0])
    obj = link(bpy.data.objects.new(f"{name} shown", bpy.data.meshes.new(name)))
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    return obj


def panel(obj):
    box = Box()
    main_panel._draw_faults_of_update(box, obj, bpy.context)
    return " ".join(box.texts)


@as_beside_a_window()
def check_what_has_no_nodes_lights_the_skin_as_a_whole(work):
    """As Per Object does, beside the brightest ones, which take the nodes that there are."""
    sb.register()
    late = light_of_nodes("Late", **BELOW)
    obj = skin(weights="object")
    late_as_a_whole = pixels(work)
    late.hide_viewport = True
    sb.make_skin(obj, weights="surface")
    assert layout(obj) == (256, 0, 0, 0)
    np.testing.assert_allclose(pixels(work), late_as_a_whole, rtol=1e-4, atol=1e-6)
    sb.make_skin(obj, weights="object")
    late.hide_render = True
    key = add_light("Key", location=(-0.4, 0.3, -1.0), energy=20.0)
    key_as_a_whole = pixels(work)
    sb.make_skin(obj, weights="surface")
    close(pixels(work), expected(core_lights()))
    assert layout(obj) == (256, 1, 0, 0) and sb.health(obj) == []
    late.hide_render, key.hide_render = False, True
    late_alone = pixels(work)
    assert sb.health(obj) == []
    key.hide_render = False
    both = pixels(work)
    np.testing.assert_allclose(both, late_alone + key_as_a_whole, rtol=1e-4, atol=1e-5)
    assert "the light of 'Key' is the same all over it" in str(sb.health(obj))
    # A spot has nodes of another kind, which are not there, whatever its power.
    late.hide_render = True
    strong = light_of_nodes("Strong", **{**BELOW, "energy": 1e4})
    light = bpy.data.objects["Strong"]
    light.data.type, light.rotation_euler = "SPOT", (np.pi, 0.1, 0.0)
    strong.hide_viewport = True
    assert pixels(work).mean(axis=(0, 1))[0] > 10.0 * both.mean(axis=(0, 1))[0]
    assert "the light of 'Strong in Strong shown' is the same" in str(sb.health(obj)), sb.health(obj)


@as_beside_a_window()
def check_what_a_render_told_is_kept(work):
    sb.register()
    empty = light_of_nodes("Late", **BELOW)
    empty.hide_viewport = True
    obj = skin()
    pixels(work)
    light = add_light("Dim", energy=0.0)
    for _ in range(2):
        (fault,) = sb.health(obj)
        assert "Render of frame 1: Patch: its material has too few nodes" in fault.what and "'Late" in fault.what, fault
        assert "show these in the viewport once" in fault.remedy and "Repair" not in str(fault)
        assert "too few nodes" in panel(obj)
        require_health(bpy.context.scene, [1])  # the next render tells it anew
        light.location.x += 1.0
        assert sb.update(depsgraph()) == []
    empty.hide_viewport = False
    depsgraph()
    assert sb.health(obj) == [] and panel(obj) == ""
    close(pixels(work), expected(core_lights()))
    assert sb.health(obj) == []
