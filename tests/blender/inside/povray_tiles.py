"""The exported scene of a skin that shows tiles: POV-Ray interpolates them as Blender's nodes do."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.group_nodes import build_nodes

from inside.povray_files import away_from_edges, povray
from inside.scenes import add_light, black_material, camera_above, depsgraph, read_exr, render_settings
from inside.shape_scenes import lobe, shape_skin, sun
from inside.tile_scenes import TILES_ONLY, ball, fill, make_skins, render, without_updates

SIZE = 96


def check_same_light_in_tiles(work):
    """Subdivided, mirrored, and with a slot that is no skin: root of the mean square at most 1/255."""
    add_light()
    obj = ball("Ball", material=black_material())
    obj.scale, obj.rotation_euler = (-1.0, 1.1, 0.9), (0.2, 0.5, 0.4)
    subdivision = obj.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = subdivision.render_levels = 1
    obj.data.materials.append(black_material("Eye"))
    slots = np.zeros(len(obj.data.polygons), np.int32)
    slots[40:70] = 1
    obj.data.polygons.foreach_set("material_index", slots)
    group = make_skins([obj])
    obj.data.materials[1].skinglow.is_skin = False
    obj.skinglow.strength = 0.75
    sb.update(depsgraph())
    build_nodes(group, TILES_ONLY)
    camera_above(26.0, (0.0, 0.0, 100.0))
    scene = render_settings(SIZE, SIZE)
    scene.cycles.samples, scene.cycles.filter_width = 64, 1.0
    with without_updates():
        for mode in ("VIEWPORT", "RENDER"):
            fill(group, [obj], mode)
        expected = render(work / "blender.exr")
        files = sb.export_povray(depsgraph(), work / "povray", surface=False)
    assert "tiles.exr" in {path.name for path in files} and "lut.exr" not in {path.name for path in files}
    povray(work / "povray")
    shown = read_exr(work / "povray" / "scene.exr")
    where = away_from_edges(expected) & away_from_edges(shown)
    assert where.sum() > 1000 and expected[where].max() > 0.5
    # The slot that is no skin.
    center = np.s_[SIZE // 4 : -SIZE // 4, SIZE // 4 : -SIZE // 4]
    assert ((expected[center].max(axis=2) == 0.0) == (shown[center].max(axis=2) < 1e-6)).mean() > 0.95
    assert (expected[center].max(axis=2) == 0.0).sum() > 10
    rms = float(np.sqrt(np.mean((shown[where] - expected[where]) ** 2)))
    assert rms <= 1 / 255, rms
    return rms


def check_through_the_shape(work):
    """The light that was solved, as Blender renders it: root of the mean square at most 1/255 of the brightest."""
    sun()
    obj = lobe(material=black_material())
    obj.rotation_euler = (0.2, 0.3, 0.4)
    shape_skin(obj, strength=2.0)
    camera_above(14.0, (0.0, 0.0, 100.0))
    scene = render_settings(SIZE, SIZE)
    scene.cycles.samples, scene.cycles.filter_width = 64, 1.0
    expected = render(work / "shape.exr")
    sb.export_povray(depsgraph(), work / "shape", surface=False)
    assert (work / "shape" / "tiles.exr").is_file()
    povray(work / "shape")
    shown = read_exr(work / "shape" / "scene.exr")
    brightest = expected.max()
    where = away_from_edges(expected / brightest) & away_from_edges(shown / brightest)
    assert where.sum() > 1000
    rms = float(np.sqrt(np.mean((shown[where] - expected[where]) ** 2)) / brightest)
    assert rms <= 1 / 255, rms
    return rms


def check_light_per_pixel(work):
    """A mirrored ear's lobe with a sharp edge, lit by lights that are close: at most 1/255 of the brightest."""
    for name, kind, position in (("Near", "POINT", (0.5, 0.3, -1.2)), ("Cone", "SPOT", (-0.8, 0.2, -1.6))):
        light = add_light(name, kind, energy=40.0, color=(1.0, 0.5, 0.2), location=position)
        light.rotation_euler = (3.0, -0.3, 0.0)
    obj = lobe(material=black_material())
    centers = np.array([polygon.center.x for polygon in obj.data.polygons])
    obj.data.polygons.foreach_set("use_smooth", centers > -2.0)
    obj.rotation_euler, obj.scale = (0.2, 0.3, 0.4), (-0.1, 0.1, 0.1)
    bpy.context.view_layer.update()
    thickness = 2.0 + 0.3 * np.array([vertex.co.x for vertex in obj.data.vertices])
    sb.make_skin(obj, thickness=thickness, mode="physical", weights="surface", unit_mm=10.0, strength=3.0)
    camera_above(1.4, (0.0, 0.0, 10.0))
    render_settings(SIZE, SIZE)
    expected = render(work / "pixels.exr")
    assert not sb.export_povray(depsgraph(), work / "pixels", surface=False).notes
    povray(work / "pixels", "-A")
    shown = read_exr(work / "pixels" / "scene.exr")
    brightest = expected.max()
    lit = expected.max(axis=2) > 0.0
    assert lit.sum() > 1000 and np.ptp(expected[lit], axis=0).max() > 0.5 * brightest
    rms = float(np.sqrt(np.mean((shown[lit] - expected[lit]) ** 2)) / brightest)
    assert rms <= 1 / 255, rms
    # One weight for the whole skin is another picture, which is told.
    per_object = sb.export_povray(depsgraph(), work / "object", surface=False, compute_lut=True)
    assert "varies over the surface" in per_object.notes[0], per_object.notes
    return rms


def check_tiles_are_exact(work):
    """The image that POV-Ray reads holds the tiles as they are, and a dark row above them."""
    obj = ball("Ball", material=black_material())
    group = make_skins([obj])
    camera_above()
    with without_updates():
        atlas = fill(group, [obj], "VIEWPORT")
        sb.export_povray(depsgraph(), work / "exact", surface=False)
    image = bpy.data.images.load(str(work / "exact" / "tiles.exr"))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, -1)[:, :, :3]
    np.testing.assert_array_equal(pixels[:-1], atlas.pixels[: height - 1, :, :3])
    assert pixels[0].max() > 0.1 and pixels[-1].max() == 0.0
