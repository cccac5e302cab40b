"""The exported scene: what is in it, and that POV-Ray shows the same light coming through."""

import shutil
import subprocess

import bpy
import numpy as np
import skinglow_blender as sb

from inside.bad_input import refused
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings, table_1


def suzanne():
    bpy.ops.mesh.primitive_monkey_add(location=(0.0, 0.0, 0.0), rotation=(0.3, 0.2, 0.1))
    return bpy.context.object


def povray(folder, *options):
    program = shutil.which("povray")
    assert program, "POV-Ray is not installed"
    done = subprocess.run(
        [program, "scene.ini", *options], cwd=folder, capture_output=True, text=True, timeout=100, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]


def away_from_edges(picture):
    """Lit pixels about which the picture is smooth: both programs average over a pixel, each in its own way."""
    brightest = picture.max(axis=2)
    around = [np.roll(brightest, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return (brightest > 1e-6) & (np.max(around, axis=0) - np.min(around, axis=0) < 0.25)


def check_same_light_coming_through(work):
    table_1()
    obj = suzanne()
    obj.data.materials.append(black_material())
    sb.make_skin(obj, unit_mm=2.0, mode="paper")
    camera = camera_above(3.0)
    camera.data.type = "PERSP"
    camera.location = (0.4, 0.2, 5.0)
    camera.rotation_euler = (0.05, 0.08, 0.2)
    scene = render_settings(120, 90)
    scene.cycles.samples, scene.cycles.filter_width = 64, 1.0
    scene.render.filepath = str(work / "blender.exr")
    bpy.ops.render.render(write_still=True)
    expected = read_exr(work / "blender.exr")
    for compute_lut in (False, True):
        folder = work / f"povray_{compute_lut}"
        files = sb.export_povray(depsgraph(), folder, surface=False, compute_lut=compute_lut)
        names = {path.name for path in files}
        assert names == {path.name for path in folder.iterdir()}
        assert ("lut.exr" in names) != compute_lut
        povray(folder)
        shown = read_exr(folder / "scene.exr")
        assert shown.shape == expected.shape
        where = away_from_edges(expected)
        assert where.sum() > 1000
        rms = float(np.sqrt(np.mean((shown[where] - expected[where]) ** 2)))
        assert expected[where].max() > 0.5
        assert rms <= 1 / 255, rms
    return rms


def check_lut_file_is_exact(work):
    add_light("Key", location=(0.0, 0.0, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera_above()
    sb.export_povray(depsgraph(), work / "exact")
    image = bpy.data.images.load(str(work / "exact" / "lut.exr"))
    image.colorspace_settings.name = "Non-Color"
    assert image.is_float and tuple(image.size) == (256, 1)
    pixels = np.empty(256 * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    np.testing.assert_array_equal(pixels.reshape(256, -1)[:, :3], sb.lut(obj, depsgraph()))


def check_only_what_is_used(work):
    """No lights where there is no surface to light; no leftovers in the file."""
    add_light("Key", location=(0.0, 0.0, 2.0))
    off = add_light("Off", location=(0.0, 0.0, 2.0))
    off.hide_viewport = True
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera_above()
    images = len(bpy.data.images)
    files = {path.name for path in sb.export_povray(depsgraph(), work / "glow", surface=False)}
    assert "lights.inc" not in files
    files = {path.name for path in sb.export_povray(depsgraph(), work / "whole")}
    assert "lights.inc" in files
    text = (work / "whole" / "lights.inc").read_text()
    assert text.count("light_source") == 1
    assert len(bpy.data.images) == images
    povray(work / "whole", "+W8", "+H8")


HOSTILE = ("ear:left", "ear/left", "Ear_left", "CON", "nul.x", "..", "-D", " ", "x" * 60, "x" * 60 + "y", "\u00e4" * 30)


def check_hostile_names_have_a_folder_each(work):
    for name in HOSTILE:
        sb.make_skin(patch(name), thickness=[1.0] * 4, mode="paper")
    camera_above()
    for _ in range(2):
        files = sb.export_povray(depsgraph(), work / "hostile")
        assert len(set(files)) == len(files) and all(path.is_file() for path in files)
        assert {path for path in (work / "hostile").rglob("*") if path.is_file()} == set(files)
        folders = {path.parent.relative_to(work / "hostile") for path in files}
        assert len({str(folder).casefold() for folder in folders}) == len(HOSTILE), folders
        assert all(len(folder.parts) == 1 for folder in folders), folders
        assert not {"con", "nul.x"} & {str(folder).casefold() for folder in folders}
    assert not files.notes


def surface_of(obj):
    """The Base Color of the skin's Principled BSDF, and its node tree."""
    tree = obj.active_material.node_tree
    principled = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    return principled.inputs["Base Color"], tree


def check_what_is_not_exported_is_told(work):
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera = camera_above()
    socket, tree = surface_of(obj)
    socket.default_value = (0.2, 0.4, 0.6, 1.0)
    assert not sb.export_povray(depsgraph(), work / "plain").notes
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], socket)
    texture.image = bpy.data.images.new("tiles", 4, 4, tiled=True)
    files = sb.export_povray(depsgraph(), work / "told")
    assert len(files.notes) == 1 and "picture in tiles (UDIM) 'tiles'" in files.notes[0], files.notes
    assert "rgb <0.2" in (work / "told" / "scene.pov").read_text()
    # Generated pixels have no file, and are written; tiles of the earlier export are no more in the folder.
    texture.image = bpy.data.images.new("drawn", 4, 4)
    texture.image.pixels.foreach_set(np.tile((0.5, 0.25, 0.125, 1.0), 16).astype(np.float32))
    obj.data.uv_layers.new()
    files = sb.export_povray(depsgraph(), work / "told")
    assert not files.notes and work / "told" / "surface.png" in files
    image = bpy.data.images.load(str(work / "told" / "surface.png"))
    np.testing.assert_allclose(image.pixels[:3], (0.5, 0.25, 0.125), atol=1 / 255)
    mix = tree.nodes.new("ShaderNodeRGB")
    tree.links.new(mix.outputs["Color"], socket)
    files = sb.export_povray(depsgraph(), work / "told")
    assert f"comes from the node '{mix.name}'" in files.notes[0] and not (work / "told" / "surface.png").exists()
    camera.data.dof.use_dof = True
    assert "Depth of field" in sb.export_povray(depsgraph(), work / "told").notes[1]
    camera.data.type = "PANO"
    before = {path: path.read_bytes() for path in (work / "told").iterdir()}
    refused(sb.SkinError, "is pano", sb.export_povray, depsgraph(), work / "told")
    assert before == {path: path.read_bytes() for path in (work / "told").iterdir()}


def check_whole_or_not_at_all(work):
    good, bad = patch("Good"), patch("Zbad")
    for obj in (good, bad):
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera_above()
    before = sorted(work.rglob("*"))
    bad.data.attributes["skinglow_thickness_known"].data[0].value = 0.0
    bad.data.update()
    refused(sb.SkinError, "not known at 1 of 4", sb.export_povray, depsgraph(), work / "never")
    assert sorted(work.rglob("*")) == before
    sb.make_skin(bad, thickness=[1.0] * 4, mode="paper")
    sb.export_povray(depsgraph(), work / "twice")
    # The last file of the second scene cannot be replaced: both stay as they were, users' files too.
    (work / "twice" / "Good" / "own.txt").write_text("mine")
    (work / "twice" / "Zbad" / "skinglow.inc").unlink()
    (work / "twice" / "Zbad" / "skinglow.inc" / "full").mkdir(parents=True)
    held = {path: path.read_bytes() for path in (work / "twice").rglob("*") if path.is_file()}
    good.skinglow.strength = 3.0
    bpy.ops.object.select_all(action="DESELECT")
    refused(sb.SkinError, "Cannot write", sb.export_povray, depsgraph(), work / "twice")
    assert held == {path: path.read_bytes() for path in (work / "twice").rglob("*") if path.is_file()}
    assert not list(work.rglob(".skinglow_*"))


def check_several_skins(work):
    for name in ("One", "Two"):
        sb.make_skin(patch(name), thickness=[1.0] * 4, mode="paper")
    camera_above()
    files = sb.export_povray(depsgraph(), work / "several")
    assert {path.parent.name for path in files} == {"One", "Two"}
    (lut,) = [p for p in sb.export_povray(depsgraph(), work / "one", obj=bpy.data.objects["One"]) if p.suffix == ".exr"]
    assert lut.parent == work / "one"
