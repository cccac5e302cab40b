"""Batches: frames x rigs, each picture with the lookup of its own rig and frame, resumed, told in the manifest."""

import hashlib
import threading

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.batch import command
from skinglow_blender.batch.frames import parse_frames
from skinglow_blender.batch.manifest import Manifest

from inside.batch_studio import (
    FRAMES,
    RIGS,
    assert_same,
    color_at,
    everything,
    expected,
    manifest_of,
    names,
    raises,
    shown_in,
    studio,
)
from inside.scenes import (
    BLOOD,
    gray,
)


def check_each_picture_shows_its_rig_and_frame(work):
    scene, _ = studio()
    before = everything()
    for persistent in (False, True):
        scene.render.use_persistent_data = persistent
        folder = work / f"six_{persistent}"
        result = sb.render_batch(folder, rigs=RIGS)
        assert names(result.rendered, folder) == sorted(f"{r}/{f:04d}.exr" for r in RIGS for f in FRAMES)
        assert result.kept == () and result.failed == ()
        for rig in RIGS:
            for frame in FRAMES:
                picture = shown_in(folder / rig / f"{frame:04d}.exr")
                np.testing.assert_allclose(picture, expected((color_at(rig, frame), 1.0)), rtol=1e-5)
        assert_same(before)


def check_manifest_tells_what_each_picture_was_made_with(work):
    scene, obj = studio()
    folder = work / "manifest"
    sb.render_batch(folder, "1-3", RIGS)
    entries = manifest_of(folder)
    assert [(e["rig"], e["frame"]) for e in entries] == [(r, f) for r in RIGS for f in FRAMES]
    for entry in entries:
        path = folder / entry["file"]
        assert entry["bytes"] == path.stat().st_size
        assert entry["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
        assert (entry["engine"], entry["resolution"], entry["samples"]) == ("CYCLES", [4, 4], 1)
        assert (entry["blender"], entry["skinglow"]) == (bpy.app.version_string, sg.__version__)
        assert entry["seconds"] > 0 and entry["time"].endswith("+00:00")
        (skin,) = entry["skins"]
        assert (skin["name"], skin["mode"], skin["view_layer"]) == ("Patch", "PAPER", "ViewLayer")
        assert skin["settings"]["blood_weight"] == [float(np.float32(b)) for b in BLOOD]
        light = np.asarray(color_at(entry["rig"], entry["frame"]), np.float32).astype(float) / 2.0
        np.testing.assert_allclose(skin["weight"], light, rtol=1e-12)
        table = (gray()[:, None] * (BLOOD + light)).astype("<f4")
        assert skin["lookup"]["entries"] == 256
        assert skin["lookup"]["sha256"] == hashlib.sha256(table.tobytes()).hexdigest()
        rows = {row["name"]: row for row in skin["lamps"]}
        assert rows[f"{entry['rig']} lamp"]["share"] == 1.0
        (other,) = set(RIGS) - {entry["rig"]}
        assert rows[f"{other} lamp"]["reason"] == "hidden in renders"


def check_interrupted_batch_goes_on_with_what_is_missing(work):
    studio()
    folder = work / "interrupted"
    before = everything()

    def stop_at_the_fourth(step):
        if step.state == "RENDERING" and step.done == 3:
            raise KeyboardInterrupt

    try:
        sb.render_batch(folder, rigs=RIGS, progress=stop_at_the_fourth)
        raise AssertionError("the progress callback's exception was lost")
    except KeyboardInterrupt:
        assert_same(before)
    done = sorted(folder.rglob("*.exr"))
    assert len(done) == 3 and len(manifest_of(folder)) == 3
    # A worker that was killed: a picture cut short, one without its line, and a line cut short.
    (folder / "warm" / "0002.exr").write_bytes((folder / "warm" / "0002.exr").read_bytes()[:100])
    (folder / "cold").mkdir(exist_ok=True)
    (folder / "cold" / "0001.exr").write_bytes(b"half")
    with (folder / "manifest.jsonl").open("a") as file:
        file.write('{"skinglow_manifest": 1, "file": "cold/0002.exr", "fra')
    steps = []
    result = sb.render_batch(folder, rigs=RIGS, progress=steps.append)
    assert names(result.kept, folder) == ["warm/0001.exr", "warm/0003.exr"]
    assert names(result.rendered, folder) == ["cold/0001.exr", "cold/0002.exr", "cold/0003.exr", "warm/0002.exr"]
    why = {(s.rig, s.frame): s.reason for s in steps if s.state == "RENDERED"}
    assert why["warm", 2] == "its file was modified" and why["cold", 1] == "not rendered yet"
    assert steps[-1].done == steps[-1].total == 6 and steps[-1].seconds_left == 0.0
    for rig in RIGS:
        for frame in FRAMES:
            picture = shown_in(folder / rig / f"{frame:04d}.exr")
            np.testing.assert_allclose(picture, expected((color_at(rig, frame), 1.0)), rtol=1e-5)
    again = sb.render_batch(folder, rigs=RIGS)
    assert again.rendered == () and len(again.kept) == 6
    assert not [path for path in folder.rglob("*") if ".part" in path.name]
    # The line cut short spoiled none of those after it.
    whole = [line for line in (folder / "manifest.jsonl").read_text().splitlines() if line.endswith("}")]
    assert len(whole) == 3 + 4
    assert len(sb.render_batch(folder, rigs=RIGS, resume=False).rendered) == 6


def check_what_changed_is_rendered_again(work):
    scene, obj = studio()
    folder = work / "changed"

    def rendered():
        steps = []
        result = sb.render_batch(folder, "1-2", RIGS, progress=steps.append)
        assert result.failed == ()
        return names(result.rendered, folder), {s.reason for s in steps if s.state == "RENDERED"}

    assert len(rendered()[0]) == 4
    assert rendered() == ([], set())
    bpy.data.objects["cold lamp"].location.z = 3.0
    assert rendered() == (["cold/0001.exr", "cold/0002.exr"], {"changed since: rig"})
    np.testing.assert_allclose(shown_in(folder / "cold/0001.exr"), expected((color_at("cold", 1), 3.0)), rtol=1e-5)
    warm = bpy.data.objects["warm lamp"]
    warm.data.color = (0.1, 0.2, 0.3)
    warm.data.keyframe_insert("color", frame=2)
    assert rendered() == (["warm/0001.exr", "warm/0002.exr"], {"changed since: rig"})
    obj.skinglow.blood_weight = (0.0, 0.0, 0.0)
    assert len(rendered()[0]) == 4
    scene.cycles.samples = 2
    assert rendered()[1] == {"changed since: render"}
    assert rendered() == ([], set())
    scene.frame_set(3)
    scene.render.filepath = "elsewhere"
    assert rendered() == ([], set()), "where the file stands and writes to is nothing to a batch"
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "changed.blend"))
    assert rendered()[1] == {"changed since: files"}
    assert rendered() == ([], set())


def check_names_of_files(work):
    scene, _ = studio()
    scene.name = "Shot 7"
    # Blender 4.5 and later fill in braces of an output path by itself.
    folder = work / "with {braces} and #"
    result = sb.render_batch(folder, 2, RIGS, pattern="{scene}_{frame:06d}_{rig}")
    assert names(result.rendered, folder) == ["Shot_7_000002_cold.exr", "Shot_7_000002_warm.exr"], result
    scene.render.image_settings.file_format = "PNG"
    assert names(sb.render_batch(folder, 2, "warm").rendered, folder) == ["warm/0002.png"]


def check_a_picture_that_fails_does_not_stop_the_others(work):
    """A frame whose lookup would be too bright for an image: its picture is not written, and the reason is told."""
    studio()
    light_data = bpy.data.lights["warm lamp"]
    bpy.data.objects["Patch"].skinglow.mode = "PHYSICAL"
    for frame, energy in ((1, 10.0), (2, 3e38), (3, 10.0)):
        light_data.energy = energy
        light_data.keyframe_insert("energy", frame=frame)
    light_data.shadow_soft_size = 0.0
    bpy.data.objects["warm lamp"].location.z = 1e-3
    result = sb.render_batch(work / "fails", rigs=["warm"])
    assert names(result.rendered, work / "fails") == ["warm/0001.exr", "warm/0003.exr"], result
    ((path, reason),) = result.failed
    assert path.name == "0002.exr" and "Patch" in reason and not path.exists(), reason
    assert not [p for p in (work / "fails").rglob("*") if ".part" in p.name]


def check_bad_input_is_refused_before_anything_is_rendered(work):
    scene, obj = studio()
    folder = work / "bad"
    raises("'Nowhere' is neither a light nor a collection", sb.render_batch, folder, 1, ["Nowhere"])
    raises("'cold lamp', 'warm lamp'", sb.render_batch, folder, 1, ["Nowhere"])
    bpy.context.scene.collection.children.link(bpy.data.collections.new("Empty"))
    raises("'Empty' contains no lights", sb.render_batch, folder, 1, ["Empty"])
    raises("Two light rigs are named 'warm'", sb.render_batch, folder, 1, ["warm", "warm"])
    raises("is not allowed as the name of a light rig", sb.render_batch, folder, 1, {"a/b": ["warm"]})
    raises("no/such.json", sb.render_batch, folder, 1, ["no/such.json"])
    (work / "wrong.json").write_text('{"skinglow_rig": 1, "lights": [{"kind": "POINT", "watts": 3}]}')
    raises("watts", sb.render_batch, folder, 1, [work / "wrong.json"])
    for text, what in (("1-", "'1-'"), ("9-3", "3-9"), ("1-9x0", "step 0"), ("", "''"), ("1,a", "'a' in '1,a'")):
        raises(what, sb.render_batch, folder, text, RIGS)
    raises("2000000", sb.render_batch, folder, [2000000], RIGS)
    raises("1.5", sb.render_batch, folder, [1.5], RIGS)
    raises("No frames", sb.render_batch, folder, [], RIGS)
    raises("{rig} and {frame}", sb.render_batch, folder, "1-2", RIGS, pattern="{frame}")
    raises("'{nothing}'", sb.render_batch, folder, 1, RIGS, pattern="{nothing}")
    raises("not a file inside", sb.render_batch, folder, 1, RIGS, pattern="../{rig}{frame}")
    assert not folder.exists()
    (work / "a_file").write_text("")
    raises("Cannot write to", sb.render_batch, work / "a_file" / "inside", 1, RIGS)
    raises("Cannot write to /proc", sb.render_batch, "/proc/skinglow", 1, RIGS)
    raises("worker", sb.render_batch, folder, 1, RIGS, worker="../a")
    raises("'cold lamp' is not a skin", sb.render_batch, folder, 1, RIGS, onto=bpy.data.objects["cold lamp"])
    scene.render.image_settings.file_format = "FFMPEG" if bpy.app.version < (5, 0, 0) else "PNG"
    if bpy.app.version < (5, 0, 0):
        raises("movie", sb.render_batch, folder, 1, RIGS)
        scene.render.image_settings.file_format = "PNG"
    camera, scene.camera = scene.camera, None
    raises("no camera", sb.render_batch, folder, 1, RIGS)
    scene.camera = camera
    sb.remove_skin(obj)
    raises("no skin", sb.render_batch, folder, 1, RIGS)


def check_frame_ranges(work):
    assert parse_frames("1-4,15") == [1, 2, 3, 4, 15]
    assert parse_frames("1-10x4, 2, 5") == [1, 5, 9, 2]
    assert parse_frames("-3--1,-7") == [-3, -2, -1, -7]
    assert parse_frames(7) == [7] and parse_frames(range(2)) == [0, 1]


def check_workers_do_not_mix_their_lines(work):
    """Many at once, into one manifest and into their own; long lines, none torn."""
    folder = work / "workers"
    folder.mkdir()

    def write(number):
        manifest = Manifest(folder, "" if number % 2 else f"w{number}")
        for line in range(50):
            manifest.append({"file": f"{number}/{line}", "padding": "x" * 20_000})

    threads = [threading.Thread(target=write, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(list(folder.glob("manifest*.jsonl"))) == 5
    entries = Manifest(folder).entries()
    assert {e["file"] for e in entries} == {f"{n}/{i}" for n in range(8) for i in range(50)} and len(entries) == 400
    # A farm's workers, each with its range, see each other's pictures.
    studio()
    sb.render_batch(work / "farm", "1-2", ["warm"], worker="a")
    sb.render_batch(work / "farm", "3", ["warm"], worker="b")
    assert names((work / "farm").glob("*.jsonl"), work / "farm") == ["manifest-a.jsonl", "manifest-b.jsonl"]
    assert len(sb.render_batch(work / "farm", "1-3", ["warm"]).kept) == 3


def check_command(work):
    """As `blender --command skinglow` calls it: a file is opened, exit codes tell how it went."""
    studio()
    blend = work / "command.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    folder = work / "command"
    options = ["--blend", str(blend), "--out", str(folder), "--frames", "1-2", "--rigs", "warm", "day=warm,cold lamp"]
    assert command.run(options) == 0
    lights = [(color_at(rig, 2), 1.0) for rig in RIGS]
    np.testing.assert_allclose(shown_in(folder / "day/0002.exr"), expected(*lights), rtol=1e-5)
    assert len(manifest_of(folder)) == 4
    assert command.run(options) == 0 and len(manifest_of(folder)) == 4
    assert command.run([*options, "--again"]) == 0 and len(manifest_of(folder)) == 8
    for wrong in (
        ["--rigs", "nothing"],
        ["--frames", "x"],
        ["--blend", "none.blend"],
        ["--nonsense"],
        ["--scene", "x"],
    ):
        assert command.run(["--out", str(work / "never"), *wrong]) == 2
    assert command.run(["--help"]) == 0
    assert not (work / "never").exists()
    bpy.data.collections["cold"].hide_render = True
    assert command.run(["--out", str(folder), "--frames", "1", "--rigs", "x=cold lamp", "warm"]) == 3


def check_command_is_registered_where_blender_has_commands(work):
    if not hasattr(bpy.utils, "register_cli_command"):
        assert bpy.app.version < (4, 2, 0) and not command.COMMAND.is_registered
        return
    sb.register()
    assert command.COMMAND.is_registered
    sb.unregister()
    assert not command.COMMAND.is_registered
    sb.register()
    assert command.COMMAND.is_registered
