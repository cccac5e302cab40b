"""Exported scenes beside Blender's renders: places, frames, and the comparison of both programs."""

import json
import os
from importlib.util import find_spec

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.batch import povray_command
from skinglow_blender.commands import povray_run
from skinglow_blender.show.skin_material import skin_node

from inside.bad_input import refused
from inside.povray_files import povray, suzanne
from inside.scenes import add_light, black_material, camera_above, depsgraph, patch, read_exr, render_settings

CAMERAS = {
    "wide": dict(type="PERSP", lens=14.0, near=0.36),
    "long": dict(type="PERSP", lens=180.0, near=4.6),
    "orthographic": dict(type="ORTHO", ortho_scale=6.0),
    "shifted": dict(type="PERSP", lens=40.0, shift_x=0.2, shift_y=-0.15),
}


def check_checkerboard_heads_stand_where_blender_shows_them(work):
    """A head under two parents, and an instance of it, by each camera: the picture's shift in pixels."""
    obj = suzanne()
    vertices = np.array([v.co for v in obj.data.vertices])
    checks = np.prod(np.sign(np.sin(7.0 * vertices + 0.4)), axis=1) > 0
    obj.data.materials.append(black_material())
    sb.make_skin(obj, thickness=np.where(checks, 0.5, 4.0), mode="existing", strength=0.9)
    outer, inner = (bpy.data.objects.new(name, None) for name in ("outer", "inner"))
    outer.rotation_euler, outer.scale, outer.location = (0.2, -0.1, 0.7), (1.0, 1.3, 0.8), (0.3, -0.2, 0.1)
    inner.rotation_euler, inner.location = (-0.3, 0.4, 0.0), (0.1, 0.4, -0.2)
    for empty in (outer, inner):
        bpy.context.scene.collection.objects.link(empty)
    inner.parent, obj.parent = outer, inner
    shown = bpy.data.collections.new("shown again")
    shown.objects.link(obj)
    again = bpy.data.objects.new("again", None)
    again.instance_type, again.instance_collection = "COLLECTION", shown
    again.location, again.rotation_euler, again.scale = (1.4, 1.5, -1.0), (0.0, 0.5, 2.0), (0.6, 0.6, 0.9)
    bpy.context.scene.collection.objects.link(again)
    camera = camera_above()
    scene = render_settings(96, 72)
    scene.cycles.samples, scene.cycles.filter_width = 36, 1.0
    scene.cycles.pixel_filter_type = "BOX"
    found = {}
    for name, settings in CAMERAS.items():
        distance = 9.0 * settings.pop("near", 1.0)
        for key, value in settings.items():
            setattr(camera.data, key, value)
        camera.location, camera.rotation_euler = (0.05 * distance, -0.1 * distance, distance), (0.1, 0.05, 0.3)
        scene.render.filepath = str(work / f"{name}.exr")
        bpy.ops.render.render(write_still=True)
        expected = read_exr(work / f"{name}.exr")
        assert not sb.export_povray(depsgraph(), work / name, surface=False).notes
        povray(work / name)
        shown = read_exr(work / name / "scene.exr")
        assert (expected.max(axis=2) > 0).mean() > 0.04
        found[name] = shift_in_pixels(expected, shown)
        assert max(map(abs, found[name])) < 0.5, found
        # The measure sees a pixel.
        assert max(map(abs, shift_in_pixels(expected, np.roll(shown, 1, 1)))) > 0.5
        assert np.sqrt(np.mean((shown - expected) ** 2)) < 0.02, found
    return found


def shift_in_pixels(a, b):
    """What moves picture a to b, by least squares on its gradients: (right, down)."""
    gray_a, gray_b = a.mean(axis=2), b.mean(axis=2)
    down, right = np.gradient(gray_a)
    matrix = -np.stack([right.ravel(), down.ravel()], axis=1)
    return tuple(float(v) for v in np.linalg.lstsq(matrix, (gray_b - gray_a).ravel(), rcond=None)[0])


def check_animation(work):
    """Each file once for a span of frames; POV-Ray's frames are those of stills."""
    light = add_light("Key", location=(0.0, 0.0, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=[1.0, 2.0, 3.0, 4.0], mode="physical")
    camera_above()
    scene = render_settings(8, 8)
    for frame, x in ((2, 0.0), (3, 0.0), (4, 1.0)):
        light.location.x = x
        light.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    for compute_lut in (False, True):
        folder = work / f"frames_{compute_lut}"
        files = sb.export_povray(depsgraph(), folder, surface=False, compute_lut=compute_lut, frames=(1, 4))
        assert scene.frame_current == 1
        names = {path.name for path in files}
        changing = "lights" if compute_lut else "lut"
        assert {"mesh.inc", f"{changing}_0001.inc", f"{changing}_0004.inc"} <= names, names
        assert "mesh_0001.inc" not in names and f"{changing}_0002.inc" not in names
        povray(folder)
        assert len(list(folder.glob("scene*.exr"))) == 4
        for frame in (1, 3, 4):
            scene.frame_set(frame)
            still = work / f"still_{compute_lut}_{frame}"
            sb.export_povray(depsgraph(), still, surface=False, compute_lut=compute_lut)
            povray(still)
            shown = read_exr(folder / f"scene{frame}.exr")
            np.testing.assert_array_equal(shown, read_exr(still / "scene.exr"))
        scene.frame_set(1)
    refused(sb.SkinError, "POV-Ray counts from 0 upward", sb.export_povray, depsgraph(), work, frames=(-3, 4))


def check_comparison(work):
    """Modes, all lights and each alone, by both programs; the scene stays as it was."""
    add_light("Key", location=(0.5, 0.0, 2.0))
    add_light("Rim", location=(-1.0, 0.5, 1.0)).data.color = (0.1, 0.4, 1.0)
    obj = suzanne()
    # Thin in spots smaller than a pixel, where samples at positions of their own would see different light.
    thin = np.arange(len(obj.data.vertices)) % 7 == 0
    sb.make_skin(obj, thickness=np.where(thin, 0.05, 12.0), mode="paper", strength=20.0)
    bystander = patch("Bystander")
    camera_above(3.0)
    scene = render_settings(64, 48)
    before = (scene.render.engine, scene.cycles.samples, scene.render.filepath, len(bpy.data.materials))
    done = sb.compare_with_povray(obj, work / "compared", modes=("existing", "physical"))
    assert before == (scene.render.engine, scene.cycles.samples, scene.render.filepath, len(bpy.data.materials))
    assert obj.skinglow.mode == "PAPER" and not bystander.hide_render
    assert not any(light.hide_render for light in scene.objects if light.type == "LIGHT")
    assert skin_node(obj.active_material).inputs["Surface"].is_linked
    has_flip = find_spec("flip_evaluator") is not None
    assert len(done.notes) == (not has_flip), done.notes
    cases = [(entry["mode"], entry["light"]) for entry in done.entries]
    lights = [("physical", light) for light in ("all lights", "Key", "Rim")]
    assert cases == [("existing", "all lights"), *lights], cases
    for entry in done.entries:
        assert entry["within"] and entry["rms"] > 0.0, entry
        assert entry["percentiles"]["99.9"] <= entry["max"] and entry["compared_pixels"] > 300, entry
        # Of a ball's outline, not of the picture.
        assert 0.0 < entry["left_out_fraction"] < 0.4, entry
        assert (entry["flip"] is not None and 0.0 <= entry["flip"] < 0.05) == has_flip, entry
        assert (work / "compared" / entry["folder"] / "side_by_side.png").is_file()
    read = json.loads((work / "compared" / "report.json").read_text())
    assert read["comparisons"] == list(done.entries)
    assert (work / "compared" / "report.html").read_text().count("<img") == 4
    return {f"{entry['mode']}, {entry['light']}": entry["rms"] for entry in done.entries}


def check_command_line_and_button(work):
    """As `blender --command skinglow_povray` and the menu call it: exit codes, and a report."""
    add_light("Key", location=(0.5, 0.0, 2.0))
    obj = suzanne()
    sb.make_skin(obj, unit_mm=2.0, strength=10.0)
    camera_above(3.0)
    render_settings(48, 48)
    options = ["--out", str(work / "command"), "--modes", "existing", "--all-lights"]
    assert povray_command.run(options) == 0
    assert povray_command.run([*options, "--skin", obj.name]) == 0
    (entry,) = json.loads((work / "command" / "report.json").read_text())["comparisons"]
    assert entry["within"] and entry["mode"] == "existing", entry
    for wrong in (["--skin", "Nobody"], ["--modes", "none"], ["--blend", str(work / "none.blend")], ["--nonsense"]):
        assert povray_command.run(["--out", str(work / "never"), *wrong]) == 2
    assert not (work / "never").exists()
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.skinglow.compare_povray(directory=str(work / "button"), per_light=False) == {"FINISHED"}
    assert len(json.loads((work / "button" / "report.json").read_text())["comparisons"]) > 1


def check_povray_not_there_and_its_messages(work):
    add_light("Key", location=(0.5, 0.0, 2.0))
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera_above()
    render_settings(8, 8)
    path = os.environ["PATH"]
    try:
        os.environ["PATH"] = str(work)
        done = sb.compare_with_povray(obj, work / "alone", modes=["paper"])
        assert bpy.ops.skinglow.export_povray(directory=str(work / "exported")) == {"FINISHED"}
    finally:
        os.environ["PATH"] = path
    assert "POV-Ray is not installed" in done.notes[0], done.notes
    assert (work / "alone" / "00_paper" / "povray" / "scene.pov").is_file() and "rms" not in done.entries[0]
    assert "POV-Ray is not installed" in done.report.read_text()
    lights = work / "exported" / "lut.inc"
    lights.write_text(lights.read_text() + "\n#declare Broken = ;\n")
    line = lights.read_text().count("\n")
    refused(sb.SkinError, f"File 'lut.inc' line {line}: ", povray_run.run_povray, work / "exported")


def check_region_and_folder_are_told(work):
    """A part of the picture is not exported; a file that is not saved has nothing next to it."""
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    camera_above()
    bpy.context.scene.render.use_border = True
    notes = sb.export_povray(depsgraph(), work / "region").notes
    assert len(notes) == 1 and "The render region is not exported" in notes[0], notes
    operators = bpy.ops.skinglow
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    before = set(os.listdir())
    refused(RuntimeError, "Save the file first", operators.export_povray, directory="//beside")
    refused(RuntimeError, "Save the file first", operators.compare_povray, directory="//beside")
    assert set(os.listdir()) == before
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "saved.blend"))
    assert operators.export_povray(directory="//beside") == {"FINISHED"}
    assert (work / "beside" / "scene.pov").is_file()
