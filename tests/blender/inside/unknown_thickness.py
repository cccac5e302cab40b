"""Where the thickness is not known there is no glow, whatever added the vertices; what is known glows as before."""

import bmesh
import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.live import file_upgrade
from skinglow_blender.show import lut_image
from skinglow_blender.thickness import thickness_attribute
from skinglow_blender.thickness.thickness_attribute import KNOWN_ATTRIBUTE

from inside.bad_input import refused
from inside.scenes import add_light, black_material, camera_above, depsgraph, link, patch, read_exr, render_settings


def picture(work):
    """(16, 16, 3) of the scene from above."""
    scene = render_settings()
    scene.render.filepath = str(work / "picture.exr")
    bpy.ops.render.render(write_still=True)
    return read_exr(work / "picture.exr")


def scene_with_patch(thickness=(2.0,) * 4):
    add_light()
    obj = patch(material=black_material())
    # The reference point stays where it is when the mesh grows.
    sb.make_skin(obj, thickness=thickness, mode="paper", reference="origin")
    camera_above()
    return obj


def check_remesh(work):
    """A modifier that makes new vertices takes the attributes away."""
    obj = scene_with_patch()
    assert picture(work).min() > 0.01
    solid = obj.modifiers.new("Solid", "SOLIDIFY")
    solid.thickness = 0.5
    glowing = picture(work)
    assert glowing.min() > 0.01, "Solidify copies what its vertices come from"
    remesh = obj.modifiers.new("New", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", 0.1
    assert picture(work)[4:12, 4:12].max() == 0.0


def check_joined_mesh(work):
    """A joined mesh glows where it was measured alone."""
    obj = scene_with_patch()
    before = picture(work)
    other = patch("Other", 1.0, (0.5, 0.0, 0.01), obj.material_slots[0].material)
    for each in (obj, other):
        each.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    after = picture(work)
    np.testing.assert_allclose(after[:, :7], before[:, :7], rtol=1e-6)
    assert after[6:10, 9:15].max() == 0.0
    values, known = thickness_attribute.read(obj.data)
    assert known.sum() == 4 and len(known) == 8 and set(values[known]) == {2.0}


def check_edge_between_known_and_unknown(work):
    """Towards new vertices the glow fades; it never becomes that of thinner skin."""
    obj = scene_with_patch((6.0, 6.0, 6.0, 6.0))
    known = picture(work)
    edit = bmesh.new()
    edit.from_mesh(obj.data)
    # The right half, of vertices that have no values.
    layers = [edit.verts.layers.float[name] for name in (thickness_attribute.THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE)]
    for vertex in edit.verts:
        if vertex.co.x > 0.0:
            for layer in layers:
                vertex[layer] = 0.0
    edit.to_mesh(obj.data)
    edit.free()
    faded = picture(work)
    assert (faded <= known * (1.0 + 1e-5)).all()
    across = faded[8, :, 0] / known[8, :, 0]
    np.testing.assert_allclose(across, 1.0 - (np.arange(16) + 0.5) / 16, atol=1e-3)


def check_absent_attributes(work):
    """As on hair, and on whatever else shares the material without having been measured."""
    obj = scene_with_patch()
    for name in (thickness_attribute.THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE):
        obj.data.attributes.remove(obj.data.attributes[name])
    assert picture(work).max() == 0.0


def check_export_of_unknown_thickness(work):
    obj = scene_with_patch()
    other = link(bpy.data.objects.new("Other", obj.data.copy()))
    for name in (thickness_attribute.THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE):
        other.data.attributes.remove(other.data.attributes[name])
    for each in (obj, other):
        each.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    refused(sb.SkinError, "not known at 4 of 8 vertices", sb.export_povray, depsgraph(), work / "povray")


def check_file_of_an_earlier_version(work):
    """Its nodes and meshes are brought up to date: it glows as it did, and knows what it does not know."""
    obj = scene_with_patch((1.0, 2.0, 3.0, 4.0))
    before = picture(work)
    group = obj.skinglow.group
    obj.data.attributes.remove(obj.data.attributes[KNOWN_ATTRIBUTE])
    for node in [n for n in group.nodes if n.bl_idname == "ShaderNodeAttribute"]:
        if node.attribute_name == KNOWN_ATTRIBUTE:
            group.nodes.remove(node)
    group[lut_image.GROUP_PROPERTY] = 1
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "earlier.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(work / "earlier.blend"))
    np.testing.assert_array_equal(picture(work), before)
    group = bpy.data.objects["Patch"].skinglow.group
    assert group[lut_image.GROUP_PROPERTY] == lut_image.GROUP_VERSION
    nodes = len(group.nodes)
    file_upgrade.upgrade()
    assert len(group.nodes) == nodes
