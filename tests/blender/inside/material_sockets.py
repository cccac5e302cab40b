"""The sockets of the skin's node: what is connected or typed acts in renders, and no update resets it."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.live import file_upgrade
from skinglow_blender.show import lut_image
from skinglow_blender.show.group_sockets import SOCKETS
from skinglow_blender.show.inner_groups import remove_unused
from skinglow_blender.show.skin_group import build_plain
from skinglow_blender.show.skin_material import skin_node
from skinglow_blender.show.tile_image import TILES
from skinglow_blender.thickness.thickness_attribute import KNOWN_ATTRIBUTE, THICKNESS_ATTRIBUTE

from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings
from studies import scenes as stage

WEIGHTS = ("object", "surface")


def skin_scene(weights="object", thickness=2.0):
    """A black patch that glows, and a light behind it."""
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[thickness] * 4, mode="physical", weights=weights)
    camera_above()
    return obj


def node_of(obj):
    return skin_node(obj.material_slots[0].material)


def picture(work, engine="CYCLES", size=4):
    scene = render_settings(size, size, engine)
    scene.render.filepath = str(work / "picture.exr")
    bpy.ops.render.render(write_still=True)
    return read_exr(work / "picture.exr")


def connect(node, name, value):
    """A node with that value, connected to the socket."""
    tree = node.id_data
    source = tree.nodes.new("ShaderNodeRGB" if name == "Tint" else "ShaderNodeValue")
    source.outputs[0].default_value = value
    tree.links.new(source.outputs[0], node.inputs[name])
    return source


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def check_mask_tint_and_strength(work):
    """Typed and connected, lit per object and per pixel."""
    factors = {
        "Mask": (0.25, 0.25),
        "Strength": (3.0, 3.0),
        "Tint": ((0.5, 0.25, 2.0, 1.0), np.array((0.5, 0.25, 2.0))),
    }
    for weights in WEIGHTS:
        fresh()
        obj = skin_scene(weights)
        node = node_of(obj)
        before = picture(work)
        assert before.min(axis=(0, 1)).max() > 1e-3
        for name, (value, factor) in factors.items():
            default = node.inputs[name].default_value
            default = default if isinstance(default, float) else tuple(default)
            node.inputs[name].default_value = value
            np.testing.assert_allclose(picture(work), before * factor, rtol=1e-5, err_msg=name)
            node.inputs[name].default_value = default
            np.testing.assert_array_equal(picture(work), before, err_msg=name)
            connect(node, name, value)
            np.testing.assert_allclose(picture(work), before * factor, rtol=1e-5, err_msg=name)
            node.id_data.links.remove(node.inputs[name].links[0])
        for value in (-1.0, 7.0):
            connect(node, "Mask", value)
            np.testing.assert_allclose(picture(work), before * min(max(value, 0.0), 1.0), rtol=1e-5)


def check_given_thickness(work):
    """A connected thickness is used, also where nothing was measured; a negative one is not."""
    for weights in WEIGHTS:
        pictures = {}
        for thickness in (2.0, 4.0):
            fresh()
            obj = skin_scene(weights, thickness)
            pictures[thickness] = picture(work)
        assert pictures[2.0].max() > 1.5 * pictures[4.0].max()
        source = connect(node_of(obj), "Thickness", 2.0)
        np.testing.assert_allclose(picture(work), pictures[2.0], rtol=1e-5)
        source.outputs[0].default_value = -1.0
        np.testing.assert_array_equal(picture(work), pictures[4.0])
        for name in (THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE):
            obj.data.attributes.remove(obj.data.attributes[name])
        assert picture(work).max() == 0.0
        source.outputs[0].default_value = 2.0
        np.testing.assert_allclose(picture(work), pictures[2.0], rtol=1e-5)
        assert sb.health(obj) == []


def check_given_thickness_of_a_map(work):
    """A float image in mm in the mesh's own UV map."""
    obj = skin_scene(thickness=9.0)
    uv = obj.data.uv_layers.new(name="UVMap")
    for loop, corner in zip(uv.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        loop.uv = corner
    image = bpy.data.images.new("Thickness", 4, 4, float_buffer=True, is_data=True)
    values = np.repeat(np.array((1.0, 2.0, 3.0, 4.0), np.float32), 4)
    image.pixels = np.stack([values, values, values, np.ones(16, np.float32)], axis=-1).ravel().tolist()
    node = node_of(obj)
    texture = node.id_data.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    node.id_data.links.new(texture.outputs["Color"], node.inputs["Thickness"])
    rows = picture(work)[:, 1]
    for row, thickness in zip(rows, (1.0, 2.0, 3.0, 4.0), strict=True):
        fresh()
        skin_scene(thickness=thickness)
        np.testing.assert_allclose(row, picture(work)[1, 1], rtol=1e-4)


def check_light_output(work):
    """As an AOV it is the light that the surface got, and the picture less it is the surface."""
    for weights in WEIGHTS:
        fresh()
        obj = skin_scene(weights)
        tree = obj.material_slots[0].material.node_tree
        node_of(obj).inputs["Tint"].default_value = (0.5, 1.0, 2.0, 1.0)
        glow = picture(work)
        emission = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeEmission")
        emission.inputs["Strength"].default_value = 0.125
        both = picture(work)
        np.testing.assert_allclose(both - glow, 0.125, rtol=1e-3)
        stage.add_light_aov(bpy.context.scene, obj)
        stage.show_pass(bpy.context.scene, stage.AOV)
        np.testing.assert_allclose(picture(work), glow, rtol=1e-5)


def check_light_group(work):
    """The light of a skin in a light group of its own is that group's pass, and no other's."""
    obj = skin_scene()
    light = add_light("Front", location=(0.0, 0.0, 3.0))
    glow = picture(work)
    plain = patch("White", location=(1.0, 1.0, 0.1))
    plain.data.materials.append(bpy.data.materials.new("White"))
    for name, member in (("Glow", obj), ("Room", light)):
        bpy.context.view_layer.lightgroups.add(name=name)
        member.lightgroup = name
    stage.show_pass(bpy.context.scene, "Combined_Glow")
    shown = picture(work)
    np.testing.assert_allclose(shown[:2], glow[:2], rtol=1e-5)
    assert shown[2:, 2:].max() == 0.0
    stage.show_pass(bpy.context.scene, "Combined_Room")
    shown = picture(work)
    assert shown[:2].max() == 0.0 and shown[2:, 2:].max() > 0.0


def check_updates_reset_nothing(_work):
    """Lights, modes, more lights than there are nodes for, a render, saving: all that was connected or typed stays."""
    obj = skin_scene("surface")
    node = node_of(obj)
    connect(node, "Mask", 0.5)
    connect(node, "Tint", (1.0, 0.5, 0.25, 1.0))
    node.inputs["Strength"].default_value = 2.5
    node.inputs["Thickness"].default_value = 3.0

    def require(node):
        assert [node.inputs[name].is_linked for name in ("Surface", "Mask", "Tint")] == [True] * 3
        assert (node.inputs["Strength"].default_value, node.inputs["Thickness"].default_value) == (2.5, 3.0)
        assert node.outputs["Shader"].is_linked

    layout = lut_image.group_layout(obj.skinglow.group)
    for i in range(6):
        add_light(f"More {i}", "SPOT", location=(0.3 * i, 0.0, -1.0))
    depsgraph()
    assert lut_image.group_layout(obj.skinglow.group) != layout
    require(node)
    for mode, weights in (("paper", "object"), ("existing", "object"), ("physical", "object"), ("physical", "surface")):
        sb.make_skin(obj, thickness=[1.0] * 4, mode=mode, weights=weights)
        require(node)
    render_settings(4, 4)
    bpy.ops.render.render()
    require(node)
    assert bpy.ops.skinglow.update() == {"FINISHED"}
    require(node)


def check_another_group_keeps_what_is_connected(_work):
    """As when a library's material is assigned to the skin: its node group takes over."""
    obj = skin_scene()
    node = node_of(obj)
    connect(node, "Mask", 0.5)
    node.inputs["Strength"].default_value = 2.5
    second = black_material("Second")
    obj.data.materials.append(second)
    old = obj.skinglow.group
    # A group whose sockets have other identifiers.
    group = bpy.data.node_groups.new("Skinglow", "ShaderNodeTree")
    for socket in reversed(SOCKETS):
        sb.blender_version.new_group_socket(
            group, socket.name, socket.kind, socket.in_out, socket.description, **socket.values
        )
    group[lut_image.GROUP_PROPERTY] = lut_image.GROUP_VERSION
    build_plain(group)
    lut_image.renew_images(group, 256, 1)
    other = second.node_tree.nodes.new("ShaderNodeGroup")
    other.node_tree = group
    obj.data.materials[0], obj.data.materials[1] = second, obj.data.materials[0]
    sb.make_skin(obj, thickness=[1.0] * 4)
    assert node.node_tree == obj.skinglow.group == group != old
    assert node.inputs["Mask"].is_linked and node.inputs["Surface"].is_linked and node.outputs["Shader"].is_linked
    assert node.inputs["Strength"].default_value == 2.5


def make_older(group):
    """Takes a group back to what the version before the sockets made."""
    image = lut_image.shown_image(group)
    TILES.remove(group)
    group.nodes.clear()
    remove_unused(list(bpy.data.node_groups))
    if hasattr(group, "interface"):
        for item in [i for i in group.interface.items_tree if i.name not in ("Surface", "Shader")]:
            group.interface.remove(item)
    else:
        for sockets in (group.inputs, group.outputs):
            for socket in [s for s in sockets if s.name not in ("Surface", "Shader")]:
                sockets.remove(socket)
    for name in lut_image.EARLIER_NODES:
        texture = group.nodes.new("ShaderNodeTexImage")
        texture.name, texture.image = name, image
    group[lut_image.GROUP_PROPERTY] = 2


def require_sockets(node):
    assert [s.name for s in node.inputs if s.type != "CUSTOM"] == ["Surface", "Mask", "Thickness", "Tint", "Strength"]


def check_older_groups_get_the_sockets(work):
    """A file of an earlier version: it glows as before, and the new sockets act."""
    obj = skin_scene()
    before = picture(work)
    make_older(obj.skinglow.group)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "earlier.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(work / "earlier.blend"))
    obj = bpy.data.objects["Patch"]
    node = node_of(obj)
    assert obj.skinglow.group[lut_image.GROUP_PROPERTY] == lut_image.GROUP_VERSION
    require_sockets(node)
    np.testing.assert_array_equal(picture(work), before)
    node.inputs["Strength"].default_value = 2.0
    np.testing.assert_allclose(picture(work), 2.0 * before, rtol=1e-6)
    nodes = len(obj.skinglow.group.nodes)
    file_upgrade.upgrade()
    assert len(obj.skinglow.group.nodes) == nodes


def check_an_appended_material_of_an_earlier_version(work):
    """It gets the sockets when a skin is made with it; a linked one stays as its file has it."""
    obj = skin_scene()
    before = picture(work)
    make_older(obj.skinglow.group)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "earlier.blend"), copy=True)
    for link in (False, True):
        fresh()
        with bpy.data.libraries.load(str(work / "earlier.blend"), link=link) as (_source, target):
            target.materials = ["Black"]
        add_light(location=(0.0, 0.0, -1.0), energy=100.0)
        camera_above()
        obj = patch(material=target.materials[0])
        sb.make_skin(obj, thickness=[2.0] * 4, mode="physical")
        assert sb.health(obj) == []
        if link:
            assert [s.name for s in node_of(obj).inputs if s.type != "CUSTOM"] == ["Surface"]
        else:
            require_sockets(node_of(obj))
            np.testing.assert_allclose(picture(work), before, rtol=1e-6)
