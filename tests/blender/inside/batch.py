"""Batches: frames x rigs, each picture with the lookup of its own rig and frame, resumed, told in the manifest."""

import hashlib
import json
import threading
from pathlib import Path

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.batch import command
from skinglow_blender.batch.frames import parse_frames
from skinglow_blender.batch.manifest import Manifest

from inside.scenes import (
    BLOOD,
    TABLE_1,
    black_material,
    camera_above,
    depsgraph,
    grey,
    lamp,
    patch,
    read_exr,
    render_settings,
)

DATA = Path(__file__).parents[2] / "data"
FRAMES = (1, 2, 3)
RIGS = ("warm", "cold")


def color_at(rig, frame):
    return np.array((1.0, 0.25 * frame, 0.0) if rig == "warm" else (0.0, 0.5, 0.3 * frame))


def studio():
    """A patch of no thickness, and a collection of one lamp for each rig, its colour keyed on every frame."""
    for rig in RIGS:
        collection = bpy.data.collections.new(rig)
        bpy.context.scene.collection.children.link(collection)
        obj = lamp(f"{rig} lamp", location=(0.0, 0.0, 1.0), collection=collection)
        for frame in FRAMES:
            obj.data.color = color_at(rig, frame)
            obj.data.keyframe_insert("color", frame=frame)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0] * 4)
    camera_above()
    scene = render_settings(4, 4)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.frame_set(2)
    return scene, obj


def expected(*lights):
    """Eq. 1 to 3 at no thickness for lamps of (colour, distance)."""
    weight = BLOOD + sum(np.asarray(color, np.float32).astype(float) / (1.0 + d**2) for color, d in lights)
    return grey()[0] * weight


def shown_in(path):
    return read_exr(path)[2, 2]


def manifest_of(folder):
    return [json.loads(line) for path in sorted(folder.glob("*.jsonl")) for line in path.read_text().splitlines()]


def names(paths, folder):
    return sorted(path.relative_to(folder).as_posix() for path in paths)


def raises(text, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except sb.SkinError as error:
        assert text in str(error), f"'{error}' does not say '{text}'"
        return str(error)
    raise AssertionError(f"nothing was refused; expected: {text}")


def everything():
    """What a batch may not change: settings of the scene, of every object and lamp, and which data there are."""
    scene = bpy.context.scene
    depsgraph()
    state = {
        "scene": (scene.frame_current, scene.frame_subframe, scene.render.filepath, scene.render.use_lock_interface),
        "objects": {
            o.name: (o.hide_render, o.hide_viewport, [list(row) for row in o.matrix_world], o.users)
            for o in bpy.data.objects
        },
        "collections": {c.name: (c.hide_render, len(c.objects)) for c in bpy.data.collections},
        "lights": {x.name: (list(x.color), x.energy) for x in bpy.data.lights},
        "curves": [c.mute for o in bpy.data.objects if o.animation_data for c in o.animation_data.drivers],
        "data": {kind: sorted(getattr(bpy.data, kind).keys()) for kind in ("meshes", "images", "materials", "worlds")},
        "handlers": {
            name: len(handlers)
            for name, handlers in ((n, getattr(bpy.app.handlers, n)) for n in dir(bpy.app.handlers))
            if isinstance(handlers, list)
        },
        "lut": {o.name: sb.lut(o, depsgraph()).tolist() for o in bpy.data.objects if o.skinglow.enabled},
    }
    state["data"]["images"] = [name for name in state["data"]["images"] if name != "Render Result"]
    return state


def assert_same(before):
    after = everything()
    for part, value in before.items():
        assert after[part] == value, f"{part}: {str(value)[:2000]} became {str(after[part])[:2000]}"


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
        table = (grey()[:, None] * (BLOOD + light)).astype("<f4")
        assert skin["lookup"]["entries"] == 256
        assert skin["lookup"]["sha256"] == hashlib.sha256(table.tobytes()).hexdigest()
        lamps = {row["name"]: row for row in skin["lamps"]}
        assert lamps[f"{entry['rig']} lamp"]["share"] == 1.0
        (other,) = set(RIGS) - {entry["rig"]}
        assert lamps[f"{other} lamp"]["reason"] == "hidden in renders"


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
    assert why["warm", 2] == "its file is not the one that was written" and why["cold", 1] == "not rendered yet"
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


def check_rig_file_is_placed_and_removed(work):
    """The paper's Table 1: its lamps light the pictures, the scene's own do not, and nothing is left of them."""
    _, obj = studio()
    before = everything()
    folder = work / "file"
    result = sb.render_batch(folder, 1, [DATA / "table1.json"])
    assert result.failed == () and names(result.rendered, folder) == ["table1/0001.exr"]
    lights = [(np.array(color) / 255, distance) for _name, color, distance in TABLE_1]
    np.testing.assert_allclose(shown_in(folder / "table1/0001.exr"), expected(*lights), rtol=2e-6)
    (entry,) = manifest_of(folder)
    reports = {row["name"]: row for row in entry["skins"][0]["lamps"]}
    assert {name for name, row in reports.items() if not row["reason"]} == {"Light1", "Light2", "Light3"}
    assert_same(before)
    # The rig goes along with the skin it is put onto.
    obj.location = (2.0, 3.0, 4.0)
    bpy.context.scene.camera.location = (2.0, 3.0, 9.0)
    sb.render_batch(work / "onto", 1, {"there": DATA / "table1.json"}, onto=obj)
    np.testing.assert_allclose(shown_in(work / "onto/there/0001.exr"), expected(*lights), rtol=2e-6)
    # A rig of all kinds of lamp, which give in mode physical what the core computes for the file itself.
    obj.skinglow.mode = "PHYSICAL"
    before = everything()
    rig = sg.read_light_rig(DATA / "all_kinds.json")
    sb.render_batch(work / "kinds", 1, [str(DATA / "all_kinds.json")], onto=obj)
    (entry,) = manifest_of(work / "kinds")
    lights = [as_this_blender_has_it(light) for light in rig.lights if light.visible]
    each = {light.name: sg.irradiance([light], rig.point) for light in lights}
    assert all(np.all(weight > 0.0) for weight in each.values()), "all four kinds reach the point"
    for row in entry["skins"][0]["lamps"]:
        if row["name"] in each:
            np.testing.assert_allclose(row["weight"], each.pop(row["name"]), rtol=2e-5, err_msg=row["name"])
    assert not each
    assert_same(before)
    assert ("spot_cosine" in "".join(entry["notes"])) == (bpy.app.version >= (4, 0, 0))


def as_this_blender_has_it(light):
    """Whether a spot falls off by the cosine to its axis, and whether a ball can be one, depends on the version."""
    if light.kind not in ("POINT", "SPOT"):
        return light
    names = "kind color position direction power name radius spot_angle spot_blend".split()
    has_balls = "use_soft_falloff" in bpy.types.PointLight.bl_rna.properties
    return sg.Light(
        **{name: getattr(light, name) for name in names},
        spot_cosine=light.kind == "SPOT" and bpy.app.version < (4, 0, 0),
        soft_falloff=light.soft_falloff or not has_balls,
    )


def check_studio_light(work):
    """Blender's own format of lamps, which are suns."""
    studio()
    sb.render_batch(work / "sl", 1, [DATA / "two_lamps.sl"])
    (entry,) = manifest_of(work / "sl")
    suns = [row for row in entry["skins"][0]["lamps"] if not row["reason"]]
    assert [row["kind"] for row in suns] == ["SUN"] * len(suns) and len(suns) == 2
    assert entry["notes"] == sg.read_light_rig(DATA / "two_lamps.sl").notes


def check_lamps_by_name_and_hidden_ones(work):
    """Rigs by lamp names; a lamp hidden in renders shines where it is named; instanced and animated ones are hidden."""
    studio()
    hidden = lamp("Hidden", color=(0.0, 1.0, 0.0), location=(0.0, 0.0, 2.0))
    hidden.hide_render = True
    blinking = lamp("Blinking", color=(1.0, 1.0, 1.0), location=(0.0, 0.0, 0.5))
    for frame in (1, 2):
        blinking.hide_render = frame == 2
        blinking.keyframe_insert("hide_render", frame=frame)
    inside = bpy.data.collections.new("Inside")
    lamp("Instanced", color=(0.0, 0.0, 1.0), location=(0.0, 0.0, 3.0), collection=inside)
    instancer = bpy.data.objects.new("Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", inside
    bpy.context.scene.collection.objects.link(instancer)
    before = everything()
    rigs = {"hidden": ["Hidden"], "blinking": ["Blinking"], "inside": ["Instanced", "Hidden"]}
    result = sb.render_batch(work / "names", "1-2", rigs)
    assert result.failed == ()
    green, white, blue = ((0, 1, 0), 2.0), ((1, 1, 1), 0.5), ((0, 0, 1), 3.0)
    for name, lights in (
        ("hidden/0001", [green]),
        ("hidden/0002", [green]),
        ("blinking/0001", [white]),
        ("blinking/0002", []),
        ("inside/0001", [green, blue]),
    ):
        picture = shown_in(work / f"names/{name}.exr")
        np.testing.assert_allclose(picture, expected(*lights), rtol=1e-5, err_msg=name)
    assert_same(before)
    # As the scene has it: no rig is asked for.
    sb.render_batch(work / "as_it_is", 2)
    lights = [(color_at(rig, 2), 1.0) for rig in RIGS] + [blue]
    np.testing.assert_allclose(shown_in(work / "as_it_is/scene/0002.exr"), expected(*lights), rtol=1e-5)


def check_collection_disabled_in_renders_is_a_rig(work):
    """A rig in a collection of its own that is switched off, as artists keep them."""
    scene, _ = studio()
    scene.collection.children["cold"].hide_render = True
    before = everything()
    sb.render_batch(work / "off", 1, ["cold"])
    np.testing.assert_allclose(shown_in(work / "off/cold/0001.exr"), expected((color_at("cold", 1), 1.0)), rtol=1e-5)
    assert_same(before)
    # By its own name the lamp stays in a collection that is off: the picture fails and says why.
    result = sb.render_batch(work / "still_off", 1, {"lamp": ["cold lamp"], "warm": ["warm"]})
    ((path, reason),) = result.failed
    assert path.parent.name == "lamp" and "'cold lamp'" in reason and "disabled in renders" in reason
    assert names(result.rendered, work / "still_off") == ["warm/0001.exr"]
    assert not path.exists() and [e["rig"] for e in manifest_of(work / "still_off")] == ["warm"]
    assert_same(before)


def check_view_layers_and_motion_blur(work):
    """The manifest tells of every view layer, and of the frame itself, not of a step of its blur."""
    scene, obj = studio()
    scene.view_layers.new("Second")
    scene.render.use_motion_blur = True
    obj.keyframe_insert("location", frame=1)
    sb.render_batch(work / "layers", 2, ["warm"])
    (entry,) = manifest_of(work / "layers")
    assert {skin["view_layer"] for skin in entry["skins"]} == {"ViewLayer", "Second"}
    for skin in entry["skins"]:
        np.testing.assert_allclose(skin["weight"], color_at("warm", 2) / 2.0, rtol=1e-6)


def check_another_scene_and_linked_lamps(work):
    """A scene that is not the window's, whose lamps come from a library: they are hidden and shown as its own are."""
    key, fill = lamp("Key", color=(1.0, 0.0, 0.0)), lamp("Fill", color=(0.0, 0.0, 1.0))
    library = work / "lamps.blend"
    bpy.data.libraries.write(str(library), {key, fill})
    bpy.ops.wm.read_factory_settings(use_empty=True)
    studio()
    first = bpy.context.scene
    with bpy.data.libraries.load(str(library), link=True) as (there, here):
        here.objects = there.objects
    other = bpy.data.scenes.new("Other")
    other.render.engine = "CYCLES"
    for obj in (*here.objects, bpy.data.objects["Camera"], bpy.data.objects["Patch"]):
        other.collection.objects.link(obj)
    other.camera = bpy.data.objects["Camera"]
    for name in ("resolution_x", "resolution_y", "filter_size"):
        setattr(other.render, name, getattr(first.render, name))
    other.cycles.samples, other.cycles.use_denoising, other.cycles.device = 1, False, "CPU"
    other.render.image_settings.file_format, other.render.image_settings.color_depth = "OPEN_EXR", "32"
    before = everything()
    result = sb.render_batch(work / "other", 1, ["Key", "Fill"], scene=other)
    assert len(result.rendered) == 2, result
    for name, color in (("Key", (1, 0, 0)), ("Fill", (0, 0, 1))):
        picture = shown_in(work / f"other/{name}/0001.exr")
        np.testing.assert_allclose(picture, expected((color, 1.0)), rtol=1e-5, err_msg=name)
    assert_same(before)


def check_names_of_files(work):
    scene, _ = studio()
    scene.name = "Shot 7"
    # Blender 4.5 and later fill in braces of an output path by itself.
    folder = work / "with {braces} and #"
    result = sb.render_batch(folder, 2, RIGS, pattern="{scene}_{frame:06d}_{rig}")
    assert names(result.rendered, folder) == ["Shot_7_000002_cold.exr", "Shot_7_000002_warm.exr"], result
    scene.render.image_settings.file_format = "PNG"
    assert names(sb.render_batch(folder, 2, "warm").rendered, folder) == ["warm/0002.png"]


def check_scene_is_restored_after_a_fault(work):
    scene, _ = studio()
    before = everything()

    def break_down(step):
        raise ZeroDivisionError(step.state)

    try:
        sb.render_batch(work / "fault", rigs=[DATA / "table1.json"], progress=break_down)
        raise AssertionError("the exception was lost")
    except ZeroDivisionError:
        assert_same(before)


def check_a_picture_that_fails_does_not_stop_the_others(work):
    """A frame whose lookup would be too bright for an image: its picture is not written, and the reason is told."""
    studio()
    lamp_data = bpy.data.lights["warm lamp"]
    bpy.data.objects["Patch"].skinglow.mode = "PHYSICAL"
    for frame, energy in ((1, 10.0), (2, 3e38), (3, 10.0)):
        lamp_data.energy = energy
        lamp_data.keyframe_insert("energy", frame=frame)
    lamp_data.shadow_soft_size = 0.0
    bpy.data.objects["warm lamp"].location.z = 1e-3
    result = sb.render_batch(work / "fails", rigs=["warm"])
    assert names(result.rendered, work / "fails") == ["warm/0001.exr", "warm/0003.exr"], result
    ((path, reason),) = result.failed
    assert path.name == "0002.exr" and "Patch" in reason and not path.exists(), reason
    assert not [p for p in (work / "fails").rglob("*") if ".part" in p.name]


def check_bad_input_is_refused_before_anything_is_rendered(work):
    scene, obj = studio()
    folder = work / "bad"
    raises("'Nowhere' is neither a lamp nor a collection", sb.render_batch, folder, 1, ["Nowhere"])
    raises("'cold lamp', 'warm lamp'", sb.render_batch, folder, 1, ["Nowhere"])
    bpy.context.scene.collection.children.link(bpy.data.collections.new("Empty"))
    raises("'Empty' holds no lamps", sb.render_batch, folder, 1, ["Empty"])
    raises("Two light rigs are named 'warm'", sb.render_batch, folder, 1, ["warm", "warm"])
    raises("cannot be the name of a light rig", sb.render_batch, folder, 1, {"a/b": ["warm"]})
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
    raises("no file inside", sb.render_batch, folder, 1, RIGS, pattern="../{rig}{frame}")
    assert not folder.exists()
    (work / "a_file").write_text("")
    raises("Cannot write to", sb.render_batch, work / "a_file" / "inside", 1, RIGS)
    raises("Cannot write to /proc", sb.render_batch, "/proc/skinglow", 1, RIGS)
    raises("worker", sb.render_batch, folder, 1, RIGS, worker="../a")
    raises("'cold lamp' is not a skin", sb.render_batch, folder, 1, RIGS, onto=bpy.data.objects["cold lamp"])
    scene.render.image_settings.file_format = "FFMPEG" if bpy.app.version < (5, 0, 0) else "PNG"
    if bpy.app.version < (5, 0, 0):
        raises("film", sb.render_batch, folder, 1, RIGS)
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
    assert command.run(["--out", str(folder), "--frames", "1", "--rigs", "x=cold lamp", "warm"]) == 1


def check_command_is_registered_where_blender_has_commands(work):
    if not hasattr(bpy.utils, "register_cli_command"):
        assert bpy.app.version < (4, 2, 0) and command._command is None
        return
    sb.register()
    assert command._command is not None
    sb.unregister()
    assert command._command is None
    sb.register()
    assert command._command is not None
