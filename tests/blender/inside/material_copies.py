"""A skin's material copied, appended, linked and used as an asset, and its group copied, still show the light."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender import blender_version
from skinglow_blender.show.lut_image import images_of, is_skin_group, skin_groups
from skinglow_blender.show.skin_material import skin_node

from inside.material_sockets import connect, node_of, picture, skin_scene
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings


def material_of(obj):
    return obj.material_slots[0].material


def alone(obj, work):
    """The picture of this skin alone."""
    others = [o for o in bpy.context.scene.objects if o.type == "MESH" and o != obj and not o.hide_render]
    for other in others:
        other.hide_render = True
    try:
        return picture(work)
    finally:
        for other in others:
            other.hide_render = False


def second_skin(material, thickness=4.0):
    obj = patch("Second", material=material)
    sb.make_skin(obj, thickness=[thickness] * 4, mode="physical")
    return obj


def require_separate(*skins):
    """No two skins use the same row of the same images."""
    rows = [(images_of(obj.skinglow.group)[0].name_full, obj.skinglow.row) for obj in skins]
    assert len(set(rows)) == len(rows), rows
    for obj in skins:
        assert skin_node(material_of(obj)).node_tree == obj.skinglow.group


def expected(thickness, work):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    skin_scene(thickness=thickness)
    return picture(work)


def check_copied_material(work):
    """What is connected and typed comes along; each skin shows its own light."""
    thin, thick = expected(2.0, work), expected(4.0, work)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = skin_scene()
    connect(node_of(obj), "Mask", 0.5)
    other = second_skin(material_of(obj).copy())
    node_of(other).inputs["Strength"].default_value = 3.0
    require_separate(obj, other)
    np.testing.assert_allclose(alone(obj, work), 0.5 * thin, rtol=1e-5)
    np.testing.assert_allclose(alone(other, work), 1.5 * thick, rtol=1e-5)


def check_group_made_a_single_user(work):
    """The number beside the group's name copies it with the images of the other in it: its skin goes back to that."""
    thin, thick = expected(2.0, work), expected(4.0, work)
    for weights in ("object", "surface"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj = skin_scene(weights)
        other = second_skin(material_of(obj).copy())
        node_of(other).node_tree = node_of(other).node_tree.copy()
        depsgraph()
        sb.update(depsgraph())
        require_separate(obj, other)
        assert obj.skinglow.group == other.skinglow.group
        for _ in range(2):
            np.testing.assert_allclose(alone(other, work), thick, rtol=1e-5 if weights == "object" else 1e-2)
            alone_thin = alone(obj, work)
            if weights == "object":
                np.testing.assert_allclose(alone_thin, thin, rtol=1e-5)
            bpy.data.lights["Lamp"].energy *= 2.0
            thin, thick = 2.0 * thin, 2.0 * thick
        thin, thick = thin / 4.0, thick / 4.0
        path = str(work / "copied.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        require_separate(bpy.data.objects["Patch"], bpy.data.objects["Second"])


def saved_library(work, asset=False):
    """A file with a skin whose material is masked by half."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = skin_scene()
    connect(node_of(obj), "Mask", 0.5)
    material_of(obj).name = "Library Skin"
    obj.skinglow.group.name = "Library Skinglow"
    if asset:
        material_of(obj).asset_mark()
        obj.skinglow.group.asset_mark()
    path = str(work / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return path


def check_appended_and_linked_material(work):
    """Into a file with a skin of its own: both show what they should, also after the file is opened again."""
    thin, thick = expected(2.0, work), expected(4.0, work)
    for link in (False, True):
        path = saved_library(work)
        obj = skin_scene()
        with bpy.data.libraries.load(path, link=link) as (_source, target):
            target.materials = ["Library Skin"]
        other = second_skin(target.materials[0])
        require_separate(obj, other)
        for factor in (1.0, 2.0):
            bpy.data.lights["Lamp"].energy = 100.0 * factor
            np.testing.assert_allclose(alone(obj, work), factor * thin, rtol=1e-5, err_msg=f"{link}")
            np.testing.assert_allclose(alone(other, work), 0.5 * factor * thick, rtol=1e-5, err_msg=f"{link}")
        bpy.ops.wm.save_as_mainfile(filepath=str(work / "user.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(work / "user.blend"))
        obj, other = bpy.data.objects["Patch"], bpy.data.objects["Second"]
        np.testing.assert_allclose(alone(obj, work), factor * thin, rtol=1e-5, err_msg=f"{link}")
        np.testing.assert_allclose(alone(other, work), 0.5 * factor * thick, rtol=1e-5, err_msg=f"{link}")
        assert sb.health(other) == []


def check_group_of_a_library_made_local(work):
    """Its images stay the library's: that is told, and Repair gives it its own."""
    thick = expected(4.0, work)
    path = saved_library(work)
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    camera_above()
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.materials = ["Library Skin"]
    material = target.materials[0]
    obj = second_skin(material)
    np.testing.assert_allclose(picture(work), 0.5 * thick, rtol=1e-5)
    material.make_local()
    group = node_of(obj).node_tree.make_local()
    depsgraph()
    assert node_of(obj).node_tree == obj.skinglow.group == group and group.library is None
    assert [fault.what for fault in sb.health(obj)] == ["Its node group was made local without its images"]
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.skinglow.repair() == {"FINISHED"}
    assert sb.health(obj) == [] and not any(image.library for image in images_of(group))
    np.testing.assert_allclose(picture(work), 0.5 * thick, rtol=1e-5)


def check_asset(work):
    """A material and a node group marked as assets, into a file that has no skin yet."""
    thick = expected(4.0, work)
    path = saved_library(work, asset=True)
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    camera_above()
    with bpy.data.libraries.load(path, link=False, assets_only=True) as (source, target):
        assert source.materials == ["Library Skin"]
        target.materials = source.materials
    other = second_skin(target.materials[0])
    np.testing.assert_allclose(picture(work), 0.5 * thick, rtol=1e-5)
    assert len(skin_groups()) == 1 and other.skinglow.group.name == "Library Skinglow"
    # On what is not a skin it gives no light.
    plain = patch("Plain", material=target.materials[0])
    assert alone(plain, work).max() == 0.0


def check_group_as_asset(work):
    """A node group alone, put into a material by hand: make_skin takes it as it is."""
    thick = expected(4.0, work)
    path = saved_library(work, asset=True)
    add_light(location=(0.0, 0.0, -1.0), energy=100.0)
    camera_above()
    with bpy.data.libraries.load(path, link=False, assets_only=True) as (source, target):
        assert "Library Skinglow" in source.node_groups
        target.node_groups = ["Library Skinglow"]
    group = target.node_groups[0]
    assert is_skin_group(group)
    material = black_material()
    tree = material.node_tree
    out = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    assert (node.inputs["Mask"].default_value, node.inputs["Thickness"].default_value) == (1.0, -1.0)
    tree.links.new(out.inputs["Surface"].links[0].from_socket, node.inputs["Surface"])
    tree.links.new(node.outputs["Shader"], out.inputs["Surface"])
    sampling = blender_version.emission_sampling(material)
    obj = second_skin(material)
    assert skin_node(material) == node and obj.skinglow.group == group
    assert blender_version.emission_sampling(material) == blender_version.NO_EMISSION_SAMPLING != sampling
    np.testing.assert_allclose(picture(work), thick, rtol=1e-5)
    sb.remove_skin(obj)
    assert blender_version.emission_sampling(material) == sampling


def check_emission_of_the_user_stays_sampled(_work):
    """A tattoo of light, also in a node group, goes on being a light to Cycles; a black emission is none."""
    for name, strength, in_group in (("Dark", 0.0, False), ("Bright", 5.0, False), ("Bright inside", 5.0, True)):
        material = black_material(name)
        tree = material.node_tree
        emission = tree.nodes["Emission"]
        if in_group:
            inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
            if hasattr(inner, "interface"):
                inner.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
            else:
                inner.outputs.new("NodeSocketShader", "Shader")
            tree.nodes.remove(emission)
            emission, end = inner.nodes.new("ShaderNodeEmission"), inner.nodes.new("NodeGroupOutput")
            inner.links.new(emission.outputs[0], end.inputs[0])
            node = tree.nodes.new("ShaderNodeGroup")
            node.node_tree = inner
            tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        emission.inputs["Strength"].default_value = strength
        before = blender_version.emission_sampling(material)
        obj = second_skin(material)
        stays = before if strength else blender_version.NO_EMISSION_SAMPLING
        assert blender_version.emission_sampling(material) == stays, name
        sb.remove_skin(obj)
        assert blender_version.emission_sampling(material) == before


def check_appended_object(work):
    """With its material, twice, as Copy and Paste do."""
    thin = expected(2.0, work)
    path = saved_library(work)
    obj = skin_scene()
    copies = []
    for _ in range(2):
        with bpy.data.libraries.load(path, link=False) as (_source, target):
            target.objects = ["Patch"]
        bpy.context.scene.collection.objects.link(target.objects[0])
        copies.append(target.objects[0])
    depsgraph()
    sb.update(depsgraph())
    require_separate(obj, *copies)
    np.testing.assert_allclose(alone(obj, work), thin, rtol=1e-5)
    for copy in copies:
        np.testing.assert_allclose(alone(copy, work), 0.5 * thin, rtol=1e-5)


def check_frames_of_a_copied_group(work):
    """Rendered with a light that is keyed: the copy shows each frame's own light."""
    obj = skin_scene()
    other = second_skin(material_of(obj).copy(), thickness=2.0)
    node_of(other).node_tree = node_of(other).node_tree.copy()
    sb.update(depsgraph())
    obj.hide_render = True
    lamp = bpy.data.lights["Lamp"]
    for frame in (1, 2, 3):
        lamp.energy = 100.0 * frame
        lamp.keyframe_insert("energy", frame=frame)
    scene = render_settings(4, 4)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = f"{work}/copied_####"
    bpy.ops.render.render(animation=True)
    shown = [read_exr(work / f"copied_{frame:04d}.exr") for frame in (1, 2, 3)]
    assert shown[0].max() > 1e-3
    for factor, each in zip((1.0, 2.0, 3.0), shown, strict=True):
        np.testing.assert_allclose(each, factor * shown[0], rtol=1e-5)


def check_node_in_a_group_of_the_artist(work):
    """Packed into a group with the rest of the shader: it is found there, masked there, and removed from there."""
    obj = skin_scene()
    before = picture(work)
    material, node = material_of(obj), node_of(obj)
    tree, group = material.node_tree, obj.skinglow.group
    packed = bpy.data.node_groups.new("Shader", "ShaderNodeTree")
    blender_version.new_group_socket(packed, "Shader", "Shader", "OUTPUT", "")
    emission, inner = packed.nodes.new("ShaderNodeEmission"), packed.nodes.new("ShaderNodeGroup")
    emission.inputs["Strength"].default_value, inner.node_tree = 0.0, group
    packed.links.new(emission.outputs[0], inner.inputs["Surface"])
    packed.links.new(inner.outputs["Shader"], packed.nodes.new("NodeGroupOutput").inputs[0])
    tree.nodes.remove(node)
    outer = tree.nodes.new("ShaderNodeGroup")
    outer.node_tree = packed
    out = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
    tree.links.new(outer.outputs[0], out.inputs["Surface"])
    depsgraph()
    assert sb.health(obj) == []
    sb.make_skin(obj, thickness=[2.0] * 4)
    assert [n.bl_idname for n in tree.nodes].count("ShaderNodeGroup") == 1
    np.testing.assert_allclose(picture(work), before, rtol=1e-6)
    other = patch("Second")
    other.data.materials.append(material)
    sb.make_skin(other, thickness=[4.0] * 4, mode="physical")
    require_separate(obj, other)
    obj.vertex_groups.new(name="None").add([0, 1, 2, 3], 0.0, "REPLACE")
    material.skinglow.mask, material.skinglow.mask_group = "VERTEX_GROUP", "None"
    assert inner.inputs["Mask"].is_linked and alone(obj, work).max() == 0.0
    for each in (obj, other):
        sb.remove_skin(each)
    assert [n.bl_idname for n in packed.nodes].count("ShaderNodeGroup") == 0
    assert [n.bl_idname for n in packed.nodes].count("ShaderNodeAttribute") == 0
