"""The Mask by a vertex group or an image: fills the socket, follows what is painted, keeps the artist's links."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show import mask
from skinglow_blender.show.mask import ATTRIBUTE_PREFIX, MASK_PROPERTY

from inside.bad_input import refused
from inside.material_sockets import connect, node_of, picture, skin_scene
from inside.scenes import black_material, depsgraph, link, patch


def painted(obj, name="Ears", weights=(0.0, 1.0, 1.0, 0.0)):
    group = obj.vertex_groups.get(name) or obj.vertex_groups.new(name=name)
    for i, weight in enumerate(weights):
        group.add([i], weight, "REPLACE")
    obj.data.update()
    depsgraph()
    return group


def material_of(obj):
    return obj.material_slots[0].material


def across(before, work, engine="CYCLES"):
    """The factor on the light, from left to right."""
    return (picture(work, engine) / before)[1, :, 0]


RAMP = (np.arange(4) + 0.5) / 4


def check_vertex_group(work):
    """In both engines, lit per object and per pixel."""
    for weights, engine in (("object", "CYCLES"), ("surface", "CYCLES"), ("object", "EEVEE")):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj = skin_scene(weights)
        before = picture(work, engine)
        painted(obj)
        material_of(obj).skinglow.mask_group = "Ears"
        np.testing.assert_array_equal(picture(work, engine), before)
        material_of(obj).skinglow.mask = "VERTEX_GROUP"
        np.testing.assert_allclose(across(before, work, engine), RAMP, rtol=2e-3)
        material_of(obj).skinglow.mask = "NONE"
        np.testing.assert_array_equal(picture(work, engine), before)
        assert not any(MASK_PROPERTY in node for node in node_of(obj).id_data.nodes)
        assert not any(a.name.startswith(ATTRIBUTE_PREFIX) for a in obj.data.attributes)


def check_weights_that_are_painted(work):
    """Changed weights act at once; a mesh that got vertices, a renamed group and a modifier too."""
    obj = skin_scene()
    before = picture(work)
    painted(obj)
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", "Ears"
    painted(obj, weights=(1.0, 0.0, 0.0, 1.0))
    np.testing.assert_allclose(across(before, work), RAMP[::-1], rtol=2e-3)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    depsgraph()
    np.testing.assert_allclose(across(before, work), RAMP[::-1], rtol=2e-3)
    obj.modifiers.new("Finer", "SUBSURF").subdivision_type = "SIMPLE"
    np.testing.assert_allclose(across(before, work), RAMP[::-1], rtol=2e-3)


def check_a_group_that_is_not_there(work):
    """It does not glow by mistake, and it is told; added, it glows."""
    obj = skin_scene()
    before = picture(work)
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", "Ears"
    assert picture(work).max() == 0.0
    assert "no vertex group 'Ears'" in str(sb.health(obj)[0])
    painted(obj)
    assert sb.health(obj) == []
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)
    obj.vertex_groups["Ears"].name = "Nose"
    obj.data.update()
    depsgraph()
    assert "no vertex group 'Ears'" in str(sb.health(obj)[0]) and picture(work).max() == 0.0


def check_several_groups_and_attributes_of_the_artist(_work):
    """Masks that go take no attribute of the artist with them; until 4.5 they took those made after them."""
    obj = skin_scene()
    mine = ["mine", "mine too"]
    obj.data.materials.append(black_material("Second"))
    sb.make_skin(obj)
    groups = [painted(obj, name) for name in ("Ear.L", "Ear.R")]
    for slot, group in zip(obj.material_slots, groups, strict=True):
        slot.material.skinglow.mask, slot.material.skinglow.mask_group = "VERTEX_GROUP", group.name
    for name in mine:
        obj.data.attributes.new(name, "FLOAT", "POINT")
    depsgraph()

    def ours_and_mine():
        names = [a.name for a in obj.data.attributes]
        return sorted(n for n in names if n.startswith(ATTRIBUTE_PREFIX)), [n for n in mine if n in names]

    assert ours_and_mine() == ([ATTRIBUTE_PREFIX + name for name in ("Ear.L", "Ear.R")], mine)
    for group in groups:
        group.name = f"Renamed {group.name}"
    obj.data.update()
    depsgraph()
    assert ours_and_mine() == ([], mine)
    for slot, group in zip(obj.material_slots, groups, strict=True):
        slot.material.skinglow.mask_group = group.name
    mine.append("mine at last")
    obj.data.attributes.new(mine[-1], "FLOAT", "POINT")
    assert len(ours_and_mine()[0]) == 2
    sb.remove_skin(obj)
    assert ours_and_mine() == ([], mine)


def check_long_names_of_groups(work):
    """Names of attributes may be shorter than those of groups: 3.4 cut them, 4.5 refused them."""
    obj = skin_scene()
    before = picture(work)
    names = ["耳" * 20 + "L", "耳" * 20 + "R", "x" * 63]
    for name in names:
        assert painted(obj, name).name == name
    painted(obj, names[1], (1.0, 1.0, 1.0, 1.0))
    material_of(obj).skinglow.mask = "VERTEX_GROUP"
    for name in names:
        material_of(obj).skinglow.mask_group = name
        depsgraph()
        assert sb.health(obj) == []
        if name == names[1]:
            np.testing.assert_allclose(picture(work), before, rtol=1e-5)
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)
    assert len([a for a in obj.data.attributes if a.name.startswith(ATTRIBUTE_PREFIX)]) == 1


def check_a_pose_reads_no_weights(_work):
    """That took 0.6 s for a mesh of 100,000 vertices; what is painted is read, whatever the pose."""
    obj = skin_scene()
    group = painted(obj)
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", group.name
    rig = link(bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig")))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Bone").tail = (0.0, 0.0, 1.0)
    bpy.ops.object.mode_set(mode="POSE")
    obj.modifiers.new("Posed", "ARMATURE").object = rig
    depsgraph()
    calls, read = [], mask._weights
    mask._weights = lambda *each: calls.append(each) or read(*each)
    try:
        rig.pose.bones["Bone"].location.x += 0.1
        depsgraph()
        assert not calls
        painted(obj, weights=(1.0, 0.0, 0.0, 1.0))
        assert calls
    finally:
        mask._weights = read
    values = [each.value for each in obj.data.attributes[ATTRIBUTE_PREFIX + group.name].data]
    assert values == [1.0, 0.0, 0.0, 1.0]


def check_two_objects_on_one_material(work):
    """Each by its own weights."""
    obj = skin_scene()
    before = picture(work)
    painted(obj)
    other = patch("Other", location=(0.0, 0.0, 0.1), material=material_of(obj))
    sb.make_skin(other, thickness=[2.0] * 4, mode="physical")
    painted(other, weights=(1.0, 0.0, 0.0, 1.0))
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", "Ears"
    other.hide_render = True
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)
    other.hide_render, obj.hide_render = False, True
    shown = picture(work)[1, :, 0]
    np.testing.assert_allclose(shown / shown.sum(), RAMP[::-1] / RAMP.sum(), rtol=2e-3)


def check_two_objects_on_one_mesh(work):
    """With materials of their own, of which one is masked: making the other a skin again takes no mask away."""
    obj = skin_scene()
    before = picture(work)
    painted(obj)
    other = bpy.data.objects.new("Other", obj.data)
    bpy.context.scene.collection.objects.link(other)
    other.hide_render = True
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = material_of(obj).copy()
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", "Ears"
    sb.make_skin(other, thickness=[2.0] * 4, mode="physical")
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)


def check_image(work):
    obj = skin_scene()
    before = picture(work)
    uv = obj.data.uv_layers.new(name="UVMap")
    for loop, corner in zip(uv.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        loop.uv = corner
    image = bpy.data.images.new("Mask", 4, 1, float_buffer=True, is_data=True)
    image.pixels = [value for x in RAMP for value in (x, x, x, 1.0)]
    settings = material_of(obj).skinglow
    settings.mask = "IMAGE"
    np.testing.assert_array_equal(picture(work), before, err_msg="no image yet")
    settings.mask_image = image
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)
    # What the artist does with the node of ours stays when the image changes.
    node = node_of(obj).inputs["Mask"].links[0].from_node
    node.interpolation = "Closest"
    settings.mask_image = bpy.data.images.new("Black", 4, 4)
    assert node_of(obj).inputs["Mask"].links[0].from_node == node and node.interpolation == "Closest"
    assert picture(work).max() == 0.0


def check_an_image_that_is_gone(work):
    """Its file or itself: told, and Repair does not take the mask away; another image ends it."""
    obj = skin_scene()
    before = picture(work)
    obj.data.uv_layers.new(name="UVMap")
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    settings = material_of(obj).skinglow
    settings.mask, settings.mask_image = "IMAGE", bpy.data.images.new("Mask", 4, 4)
    assert sb.health(obj) == []
    bpy.data.images.remove(settings.mask_image)
    for _press in range(2):
        assert "image that masks material 'Black' was deleted" in str(sb.health(obj)[0])
        refused(RuntimeError, "choose another image", bpy.ops.skinglow.repair)
    lost = bpy.data.images.new("Lost", 4, 4)
    lost.source, lost.filepath = "FILE", str(work / "lost.png")
    settings.mask_image = lost
    depsgraph()
    assert "file of 'Lost' is missing" in str(sb.health(obj)[0])
    settings.mask_image = bpy.data.images.new("Found", 4, 4)
    depsgraph()
    assert sb.health(obj) == []
    # Emptied by hand, as before one was chosen.
    settings.mask_image = None
    assert sb.health(obj) == []
    np.testing.assert_array_equal(picture(work), before)


def check_what_the_artist_connected_stays(work):
    obj = skin_scene()
    before = picture(work)
    painted(obj)
    source = connect(node_of(obj), "Mask", 0.5)
    settings = material_of(obj).skinglow
    for kind in ("VERTEX_GROUP", "IMAGE", "NONE"):
        settings.mask, settings.mask_group = kind, "Ears"
        assert node_of(obj).inputs["Mask"].links[0].from_node == source
        np.testing.assert_allclose(picture(work), 0.5 * before, rtol=1e-5)


def check_set_before_it_is_a_skin(work):
    """The settings of a material are filled in by make_skin."""
    obj = skin_scene()
    before = picture(work)
    painted(obj)
    sb.remove_skin(obj)
    material_of(obj).skinglow.mask, material_of(obj).skinglow.mask_group = "VERTEX_GROUP", "Ears"
    sb.make_skin(obj, thickness=[2.0] * 4, mode="physical")
    np.testing.assert_allclose(across(before, work), RAMP, rtol=2e-3)
    # Removed, nothing is left.
    sb.remove_skin(obj)
    assert not any(MASK_PROPERTY in node for node in material_of(obj).node_tree.nodes)
    assert not any(a.name.startswith("skinglow") for a in obj.data.attributes)
