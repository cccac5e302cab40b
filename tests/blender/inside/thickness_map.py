"""Thickness as numbers in the mesh, as an image in the mesh's own UV map, and from an image back."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands.thickness_map import OPAQUE_MM, WHITE_PROPERTY
from skinglow_blender.thickness import thickness_attribute
from skinglow_blender.thickness.thickness_attribute import SUMMARY

from inside.bad_input import refused
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings

sb.register()


def grid(work, cuts=24, name="Grid"):
    """A square of many vertices with a UV map, 1 to 5 mm thick across and up, saved."""
    work.mkdir(exist_ok=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=cuts, y_subdivisions=cuts, size=2.0)
    obj = bpy.context.object
    obj.name = name
    obj.data.materials.append(black_material())
    sb.make_skin(obj, thickness=wanted(obj), mode="physical", unit_mm=10.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "grid.blend"))
    return obj


def wanted(obj):
    points = np.array([vertex.co[:2] for vertex in obj.data.vertices])
    return 3.0 + points @ (1.5, 0.5)


def thickness_of(obj):
    return thickness_attribute.read(obj.data)


def check_there_and_back(work):
    """Baked in each format and read back: as exact as its steps, between the vertices and at them."""
    obj = grid(work / "there")
    for format_, white, step in (("EXR", 1.0, 1e-6), ("PNG_16", 12.0, 12.0 / 65535), ("PNG_8", 12.0, 12.0 / 255)):
        sb.make_skin(obj, thickness=wanted(obj))
        baked = sb.bake_thickness(obj, size=256, format=format_)
        assert baked.file.name == f"Grid_thickness{'.exr' if format_ == 'EXR' else '.png'}" and baked.file.is_file()
        assert baked.white_mm == white == baked.image[WHITE_PROPERTY] and baked.covered_fraction == 1.0
        assert baked.image.colorspace_settings.is_data and baked.image.filepath.startswith("//")
        assert [path.name for path in baked.file.parent.glob(".*")] == []
        sb.make_skin(obj, thickness=np.zeros(len(obj.data.vertices)))
        sb.thickness_from_image(obj, baked.image)
        thickness, known = thickness_of(obj)
        assert known.all()
        # The outermost vertices lie half a texel beyond the last texel's center.
        np.testing.assert_allclose(thickness, wanted(obj), atol=0.51 * step + 4.0 / 256)
        inner = np.abs([vertex.co[:2] for vertex in obj.data.vertices]).max(axis=1) < 0.99
        np.testing.assert_allclose(thickness[inner], wanted(obj)[inner], atol=0.51 * step + 2e-5)
        assert not thickness_attribute.is_from_measurement(obj.data)
    values = read_exr(work / "there" / "Grid_thickness.exr")
    u, v = np.meshgrid((np.arange(256) + 0.5) / 128 - 1.0, (np.arange(256) + 0.5) / 128 - 1.0)
    np.testing.assert_allclose(values[:, :, 0], 3.0 + 1.5 * u + 0.5 * v, atol=1e-5)


def check_what_is_not_known_stays_dark(work):
    """Vertices without thickness: no texel is thin there, in no format, and reading it back lets nothing glow."""
    obj = grid(work / "unknown")
    left = np.array([vertex.co.x < -0.3 for vertex in obj.data.vertices])
    values = np.where(left, 0.0, 1.0).astype(np.float32)
    obj.data.attributes[thickness_attribute.KNOWN_ATTRIBUTE].data.foreach_set("value", values)
    for format_, darkest in (("EXR", OPAQUE_MM), ("PNG_8", 12.0)):
        baked = sb.bake_thickness(obj, size=64, format=format_)
        assert 0.5 < baked.covered_fraction < 0.9
        pixels = np.empty(64 * 64 * baked.image.channels, np.float32)
        baked.image.pixels.foreach_get(pixels)
        gray = pixels.reshape(64, 64, -1)[:, :, 0] * baked.white_mm
        np.testing.assert_allclose(gray[:, :10], darkest)
        assert gray[:, 40:].max() < 6.0


def check_scaled_since(work):
    """An object that was scaled is as thick as it is now, and stays so when it is read back."""
    obj = grid(work / "scaled")
    obj.scale = (2.0, 2.0, 2.0)
    depsgraph()
    baked = sb.bake_thickness(obj, size=128)
    np.testing.assert_allclose(read_exr(baked.file)[64, 64, 0], 2.0 * 3.0, atol=0.1)
    sb.thickness_from_image(obj, baked.image)
    np.testing.assert_allclose(thickness_of(obj)[0], 2.0 * wanted(obj), atol=0.05)


def check_image_in_the_material(work):
    """The baked image in the node's Thickness socket renders as the measured thickness does."""
    obj = grid(work / "socket")
    add_light("Behind", energy=60.0, location=(0.0, 0.0, -1.0))
    camera_above()
    scene = render_settings(32, 32)
    pictures = []
    for linked in (False, True):
        if linked:
            image = sb.bake_thickness(obj, size=256).image
            tree = obj.active_material.node_tree
            node = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeGroup")
            texture = tree.nodes.new("ShaderNodeTexImage")
            texture.image, texture.extension = image, "EXTEND"
            tree.links.new(texture.outputs["Color"], node.inputs["Thickness"])
        scene.render.filepath = str(work / "socket" / f"{linked}.exr")
        bpy.ops.render.render(write_still=True)
        pictures.append(read_exr(scene.render.filepath))
    assert pictures[0].max() > 0.01
    np.testing.assert_allclose(pictures[1][1:-1, 1:-1], pictures[0][1:-1, 1:-1], rtol=0.01)


def check_numbers_in_the_mesh(work):
    obj = grid(work / "numbers")
    limit, low, median, high, above, *histogram = obj.data[SUMMARY]
    assert (limit, above) == (12.0, 0.0)
    np.testing.assert_allclose((low, median, high), (1.0, 3.0, 5.0), atol=1e-5)
    assert len(histogram) == 32 and abs(sum(histogram) - 1.0) < 1e-6
    sb.make_skin(obj, thickness=np.full(len(obj.data.vertices), 20.0))
    assert obj.data[SUMMARY][4] == 1.0
    sb.remove_skin(obj)
    assert SUMMARY not in obj.data


def check_buttons_and_undo(work):
    obj = grid(work / "buttons")
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.skinglow.bake_thickness("EXEC_DEFAULT", True, size=64) == {"FINISHED"}
    image = bpy.data.images["Grid_thickness.exr"]
    assert obj.skinglow.thickness_image == image
    values = np.zeros(64 * 64 * 4, np.float32) + 2.0
    image.pixels.foreach_set(values)
    before = thickness_of(obj)[0].copy()
    assert bpy.ops.skinglow.thickness_from_image("EXEC_DEFAULT", True) == {"FINISHED"}
    assert (thickness_of(bpy.data.objects["Grid"])[0] == 2.0).all()
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(thickness_of(bpy.data.objects["Grid"])[0], before)
    bpy.ops.ed.redo()
    assert (thickness_of(bpy.data.objects["Grid"])[0] == 2.0).all()


def check_names_that_files_cannot_tell_apart(work):
    """Each skin has an image of its own."""
    for name, value in (("Ear L", 1.0), ("ear_L", 2.0)):
        obj = grid(work / "alike", cuts=2, name=name)
        sb.make_skin(obj, thickness=[value] * len(obj.data.vertices))
    files = {}
    for name in ("Ear L", "ear_L", "Ear L"):
        files[name] = sb.bake_thickness(bpy.data.objects[name], size=16).file
    assert {path.name for path in files.values()} == {"Ear_L_thickness.exr", "ear_L_2_thickness.exr"}, files
    assert read_exr(files["Ear L"])[8, 8, 0] == 1.0 and read_exr(files["ear_L"])[8, 8, 0] == 2.0


def check_refused(work):
    (work / "refused").mkdir()
    obj = patch(material=black_material())
    refused(sb.SkinError, "is not a skin", sb.bake_thickness, obj)
    sb.make_skin(obj, thickness=[1.0] * 4)
    refused(sb.SkinError, "Save the file first", sb.bake_thickness, obj)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "refused" / "patch.blend"))
    refused(sb.SkinError, "has no UV map", sb.bake_thickness, obj)
    obj.data.uv_layers.new(name="UVMap")
    for loop in obj.data.uv_layers[0].data:
        loop.uv = (2.5, 2.5)
    refused(sb.SkinError, "outside of the first tile", sb.bake_thickness, obj)
    refused(ValueError, "format = 'TIFF' is not allowed", sb.bake_thickness, obj, format="TIFF")
    refused(ValueError, "size = 8", sb.bake_thickness, obj, size=8)
    refused(ValueError, "white_mm = 0.0", sb.bake_thickness, obj, format="PNG_8", white_mm=0.0)
    image = bpy.data.images.new("Colors", 8, 8)
    image.colorspace_settings.name = "sRGB"
    refused(sb.SkinError, "set its Color Space to Non-Color", sb.thickness_from_image, obj, image)
    image.colorspace_settings.name = "Non-Color"
    tiled = bpy.data.images.new("Tiled", 8, 8, tiled=True)
    tiled.colorspace_settings.name = "Non-Color"
    refused(
        sb.SkinError, "'Tiled' has UDIM tiles, of which only the first is read", sb.thickness_from_image, obj, tiled
    )
    sb.thickness_from_image(obj, image, white_mm=5.0)
    assert not list((work / "refused").glob("*thickness*"))
