"""The exported scene: what is in it, and that POV-Ray shows the same light coming through."""

import shutil
import subprocess

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.skin_material import skin_node

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


def check_textured_head_with_a_thickness_picture_is_one_render(work):
    """Surface and thickness are pictures in a UV map that is not the first; Blender renders the sum."""
    add_light("Sun", "SUN", energy=1.0, location=(0.0, 0.0, 2.0)).data.angle = 0.0
    obj = patch(size=2.0, material=matt_material())
    for name, turned in (("Other", False), ("Skin", True)):
        layer = obj.data.uv_layers.new(name=name)
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        layer.data.foreach_set("uv", np.ravel(corners[1:] + corners[:1] if turned else corners).astype(np.float32))
    obj.data.uv_layers["Skin"].active_render = True
    sb.make_skin(obj, thickness=[9.0] * 4, mode="paper", strength=0.2)
    tree = obj.active_material.node_tree
    node = skin_node(obj.active_material)
    textures = {}
    for name, socket in (("colors", color_of(obj)), ("fractions", None)):
        image = bpy.data.images.new(name, 8, 8, float_buffer=True, is_data=True)
        pixels = np.ones((8, 8, 4), np.float32)
        pixels[:, :, :3] = np.random.default_rng(len(name)).uniform(0.05, 0.8, (8, 8, 3 if socket else 1))
        image.pixels.foreach_set(pixels.ravel())
        textures[name] = tree.nodes.new("ShaderNodeTexImage")
        textures[name].image = image
        if socket:
            tree.links.new(textures[name].outputs["Color"], socket)
    scaled = tree.nodes.new("ShaderNodeMath")
    scaled.operation, scaled.inputs[1].default_value = "MULTIPLY", 3.0
    tree.links.new(textures["fractions"].outputs["Color"], scaled.inputs[0])
    tree.links.new(scaled.outputs[0], node.inputs["Thickness"])
    camera_above(1.6)
    scene = render_settings(48, 48)
    scene.render.filepath = str(work / "textured.exr")
    bpy.ops.render.render(write_still=True)
    expected = read_exr(work / "textured.exr")
    files = sb.export_povray(depsgraph(), work / "textured")
    assert not files.notes, files.notes
    assert "Skinglow_Part" not in (work / "textured" / "scene.pov").read_text()
    povray(work / "textured", "-A")
    shown = read_exr(work / "textured" / "scene.exr")
    rms = float(np.sqrt(np.mean((shown - expected) ** 2)))
    assert np.ptp(expected, axis=(0, 1)).min() > 0.1 and rms <= 1 / 255, rms
    # What cannot be shown is told, and the measured thickness is taken.
    textures["fractions"].projection = "SPHERE"
    node.inputs["Mask"].default_value = 0.5
    notes = sb.export_povray(depsgraph(), work / "textured").notes
    assert len(notes) == 2 and "Thickness of the Skinglow node comes from" in notes[0], notes
    assert "Mask of the Skinglow node" in notes[1], notes
    assert not (work / "textured" / "thickness.exr").exists()
    assert "Skinglow_Part" in (work / "textured" / "scene.pov").read_text()
    return rms


def matt_material():
    """White, and the same in all directions."""
    material = black_material("Matt")
    tree = material.node_tree
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    output = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def color_of(obj):
    """The color of a matt material."""
    nodes = obj.active_material.node_tree.nodes
    return next(node for node in nodes if node.bl_idname == "ShaderNodeBsdfDiffuse").inputs["Color"]


#: Kind, settings, and the difference allowed, of the brightest point: what docs/povray.md says.
WHITE_PLANE = {
    "point": ("POINT", dict(shadow_soft_size=0.0), 0.005),
    "ball": ("POINT", dict(shadow_soft_size=0.3), 0.005),
    "sun": ("SUN", dict(angle=0.0), 0.005),
    "spot": ("SPOT", dict(shadow_soft_size=0.0, spot_size=1.2, spot_blend=0.5), 0.005),
    "area": ("AREA", dict(size=0.6), 0.005),
    "spread": ("AREA", dict(size=0.01, spread=1.0), 0.15),
}


def check_white_plane_under_each_kind_of_light(work):
    obj = patch(size=4.0, material=matt_material())
    sb.make_skin(obj, thickness=[12.0] * 4, mode="paper", strength=0.0)
    camera_above(3.0)
    scene = render_settings(12, 12)
    scene.cycles.light_sampling_threshold = 0.0  # faint light is not left to chance
    found = {}
    for name, (kind, settings, allowed) in WHITE_PLANE.items():
        light = add_light(name, kind, energy=1.0 if kind == "SUN" else 100.0, location=(0.3, 0.2, 2.0))
        light.rotation_euler = (0.2, 0.1, 0.0)
        for key, value in settings.items():
            setattr(light.data, key, value)
        # A light with an extent is a random point of it in each sample.
        random = name in ("ball", "area")
        scene.cycles.samples = 256 if random else 1
        scene.render.filepath = str(work / f"{name}.exr")
        bpy.ops.render.render(write_still=True)
        expected = read_exr(work / f"{name}.exr")
        notes = sb.export_povray(depsgraph(), work / name).notes
        assert len(notes) == (name == "spread") and all("up to 15 %" in note for note in notes), notes
        povray(work / name, "-A")
        shown = read_exr(work / name / "scene.exr")
        difference = shown - expected
        if random:
            difference = difference.reshape(4, 3, 4, 3, 3).mean(axis=(1, 3))
        found[name] = float(np.abs(difference).max() / expected.max())
        assert expected.max() > 0.1 and found[name] <= allowed, found
        bpy.data.objects.remove(light)
    return found
