"""Images of the lookup that somebody reloads or unpacks, as scripts and menus do with all images of a file."""

import shutil

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.image_pairs import read_pixels
from skinglow_blender.show.lut_image import images_of, shown_image
from skinglow_blender.show.tile_image import TILES

from inside.scenes import (
    add_light,
    assert_shows,
    black_material,
    camera_above,
    depsgraph,
    paper_table,
    patch,
    read_exr,
    render_settings,
)
from inside.shape_scenes import assert_through, shape_skin, sun, thin_body

THICKNESS_MM = 0.0


def scene():
    """A skin that shows the first entry of its lookup, and its light."""
    sb.register()
    key = add_light("Key", location=(0.0, 0.0, 2.0), color=(1.0, 0.2, 0.0))
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[THICKNESS_MM] * 4, mode="paper")
    camera_above()
    render_settings(4, 4)
    return key, obj


def picture(work):
    scene = bpy.context.scene
    scene.render.filepath = str(work / "picture.exr")
    bpy.ops.render.render(write_still=True)
    return read_exr(scene.render.filepath)[2, 2]


def assert_right(work, obj, key):
    """Viewport and picture show the light of now."""
    np.testing.assert_allclose(picture(work), paper_table([key])[0], rtol=1e-5)
    assert_shows(obj, paper_table([key]))
    assert sb.health(obj) == []


def open_again(path):
    bpy.ops.wm.open_mainfile(filepath=path)
    return bpy.data.objects["Key"], bpy.data.objects["Patch"]


def reload_all():
    for image in bpy.data.images:
        image.reload()


def check_reloaded(work):
    """Not saved yet they go black; saved ones go back to the light at that time."""
    key, obj = scene()
    path = str(work / "reloaded.blend")
    for color in ((0.0, 1.0, 0.0), (0.0, 0.5, 1.0), (1.0, 1.0, 0.0)):
        key.data.color = color
        depsgraph()
        assert_right(work, obj, key)
        for image in bpy.data.images:
            image.reload()
        assert_right(work, obj, key)
        reload_all()
        depsgraph()
        assert_shows(obj, paper_table([key]))
        bpy.ops.wm.save_as_mainfile(filepath=path)
        key.data.color.r *= 0.5
    key, obj = open_again(path)
    assert_right(work, obj, key)


def check_reloaded_tiles(_work):
    sb.register()
    key, obj = sun(), thin_body(material=black_material())
    shape_skin(obj)
    before = read_pixels(TILES.shown(obj.skinglow.group))
    assert before[:, :, :3].max() > 0.0
    reload_all()
    depsgraph()
    np.testing.assert_array_equal(read_pixels(TILES.shown(obj.skinglow.group)), before)
    key.data.color = (0.2, 1.0, 0.1)
    assert_through(obj)


def check_nothing_is_written_anew_after_saving(work):
    """What was packed is what was written: the next update leaves it alone."""
    key, obj = scene()
    key.data.color = (0.0, 1.0, 0.0)
    depsgraph()
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "saved.blend"))
    for _ in range(3):
        obj.update_tag()
        sb.update(depsgraph())
        assert not any(image.is_dirty for image in images_of(obj.skinglow.group))


def check_unpacked(work):
    """Cycles renders the files that Unpack Resources wrote, whatever the pixels of an image are since."""
    key, obj = scene()
    path = str(work / "unpacked.blend")
    key.data.color = (0.0, 1.0, 0.0)
    depsgraph()
    assert_right(work, obj, key)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    key.data.color = (0.0, 1.0, 0.5)  # not saved when it is unpacked
    assert_right(work, obj, key)
    bpy.ops.file.unpack_all(method="WRITE_LOCAL")
    assert_right(work, obj, key)
    for color in ((1.0, 0.0, 1.0), (0.0, 0.0, 1.0), (0.3, 0.4, 0.5)):
        key.data.color = color
        depsgraph()
        assert_right(work, obj, key)
    bpy.ops.file.unpack_all(method="WRITE_LOCAL")
    bpy.ops.wm.save_mainfile()
    shutil.rmtree(work / "textures")
    key, obj = open_again(path)
    assert_right(work, obj, key)
    key.data.color = (1.0, 0.0, 1.0)
    depsgraph()
    assert_right(work, obj, key)


def check_unpacked_while_the_add_on_was_off(work):
    """Of a file that was sent without its folder of textures nothing was left but an error at each update."""
    for is_through in (False, True):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        key, obj = scene()
        path = str(work / "off.blend")
        if is_through:
            sun()
            body = thin_body(material=obj.data.materials[0])
            body.location.x = 50.0
            shape_skin(body)
        depsgraph()
        picture(work)
        bpy.ops.wm.save_as_mainfile(filepath=path)
        sb.unregister()
        bpy.ops.file.unpack_all(method="WRITE_LOCAL")
        bpy.ops.wm.save_mainfile()
        shutil.rmtree(work / "textures")
        sb.register()
        key, obj = open_again(path)
        lights = [each for each in bpy.data.objects if each.type == "LIGHT"]
        assert_shows(obj, paper_table(lights))
        np.testing.assert_allclose(picture(work), paper_table(lights)[0], rtol=1e-5)
        assert sb.health(obj) == [] and shown_image(obj.skinglow.group).size[0] > 0
        if is_through:
            assert_through(bpy.data.objects["Body"])
        key.data.color = (0.0, 0.2, 1.0)
        depsgraph()
        np.testing.assert_allclose(picture(work), paper_table(lights)[0], rtol=1e-5)
