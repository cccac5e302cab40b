"""Files that work in Rec.2020 or ACEScg (5.0 and later) show the same skin as in Rec.709."""

import bpy
import numpy as np
import skinglow_blender as sb
from mathutils import Color
from skinglow_blender.show.lut_image import shown_image

from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings, table_1

#: Blender rounds the colors that it converts to five digits.
ROUNDED = 5e-5


def spaces():
    """The working spaces that this Blender has besides Rec.709: none before 5.0."""
    colorspace = getattr(bpy.data, "colorspace", None)
    if colorspace is None:
        assert bpy.app.version < (5, 0, 0)
        return []
    names = [item.identifier for item in colorspace.bl_rna.properties["working_space"].enum_items]
    assert names[0] == colorspace.working_space == "Linear Rec.709" and len(names) == 3, names
    return names[1:]


def work_in(space, work):
    """As a person does: saved, then converted with all its colors."""
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "space.blend"))
    assert bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=True) == {"FINISHED"}
    assert bpy.data.colorspace.working_space == space


def shown_pixels(obj):
    image = shown_image(obj.skinglow.group)
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], -1, 4)[obj.skinglow.row, :256, :3]


def skin(mode):
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0, 2.0, 2.0, 0.0], mode=mode)
    return obj


def check_lookup_is_the_same(work):
    """lut() is linear Rec.709 in every space; the pixels are the same colors in the file's own."""
    for mode in ("paper", "physical"):
        for space in spaces():
            bpy.ops.wm.read_factory_settings(use_empty=True)
            table_1()
            obj = skin(mode)
            before, pixels = sb.lut(obj, depsgraph()), shown_pixels(obj)
            np.testing.assert_array_equal(before, pixels)
            work_in(space, work)
            obj = bpy.data.objects["Patch"]
            after, pixels = sb.lut(obj, depsgraph()), shown_pixels(obj)
            np.testing.assert_allclose(after, before, rtol=1e-3, atol=ROUNDED * before.max())
            expected = [Color(c).from_rec709_linear_to_scene_linear()[:] for c in after.tolist()]
            np.testing.assert_allclose(pixels, expected, rtol=1e-5, atol=1e-6 * before.max())
            assert np.abs(pixels - after).max() > 0.02 * before.max()
            # And it follows its lights there.
            bpy.data.lights["Light1"].color = (0.3, 0.3, 0.8)
            moved = sb.lut(obj, depsgraph())
            assert np.abs(moved - after).max() > 0.01 * before.max()
            work_in("Linear Rec.709", work)
            obj = bpy.data.objects["Patch"]
            np.testing.assert_allclose(sb.lut(obj, depsgraph()), moved, rtol=1e-3, atol=ROUNDED * before.max())


def check_picture_is_the_same(work):
    """Cycles' pictures, converted to Rec.709; a file loaded in its space; a light's temperature, its nodes, its color.

    Each by itself: Blender multiplies them channel by channel, and what comes of that depends on the space.
    """
    for space in spaces():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        add_light("Color", color=(1.0, 0.3, 0.1))
        key = add_light("Key")
        key.data.use_temperature, key.data.temperature = True, 4000.0
        fill = add_light("Fill", location=(1.0, 0.0, 1.0))
        if fill.data.node_tree is None:
            fill.data.use_nodes = True  # 5.0
        fill.data.node_tree.nodes.clear()
        emission = fill.data.node_tree.nodes.new("ShaderNodeEmission")
        emission.inputs["Color"].default_value = (0.9, 0.5, 0.7, 1.0)
        output = fill.data.node_tree.nodes.new("ShaderNodeOutputLight")
        fill.data.node_tree.links.new(emission.outputs[0], output.inputs["Surface"])
        skin("paper")
        camera_above()
        pictures = {}
        for name in ("Linear Rec.709", space):
            if name != bpy.data.colorspace.working_space:
                work_in(name, work)
                bpy.ops.wm.save_mainfile()
                bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
            render_settings(8, 4).render.filepath = str(work / f"{name}.exr")
            bpy.ops.render.render(write_still=True)
            pixels = read_exr(work / f"{name}.exr").reshape(-1, 3).tolist()
            pictures[name] = np.array([Color(pixel).from_scene_linear_to_rec709_linear() for pixel in pixels])
        bpy.ops.wm.read_factory_settings(use_empty=True)
        first, second = pictures.values()
        assert first.max() > 0.5
        np.testing.assert_allclose(second, first, rtol=1e-3, atol=ROUNDED * first.max())


def check_colors_beyond_rec709_are_told(work):
    """A light more saturated than Rec.709 gives its share of what Rec.709 holds, and the report says so."""
    for space in spaces():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        add_light("Key", color=(0.2, 0.4, 0.3))
        skin("paper")
        work_in(space, work)
        obj = bpy.data.objects["Patch"]
        assert sb.light_report(obj, depsgraph())[0]["note"] == ""
        bpy.data.lights["Key"].color = (1.0, 0.0, 0.0)
        row = sb.light_report(obj, depsgraph())[0]
        assert "gamut" in row["note"], row
        assert row["weight"][0] > 0.0 and row["weight"][1] == row["weight"][2] == 0.0, row
        assert sb.update(depsgraph()) == []
