"""Jobs for render farms: what is written, and what is refused before anything is."""

import json
import types
from pathlib import Path

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.batch.files import input_files
from skinglow_blender.farm import frozen_frames, openjd
from skinglow_blender.farm.openjd import _ranges
from skinglow_blender.ui import farm_operators

from inside.batch_studio import RIGS, color_at, expected, raises, shown_in, studio

write = sb.farm.write_openjd


def saved_studio(work):
    scene, obj = studio()
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "scene.blend"))
    return scene, obj


def read(folder, name):
    return json.loads((folder / f"{name}.json").read_text())


def arguments(folder):
    return read(folder, "template")["steps"][0]["script"]["actions"]["onRun"]["args"]


def check_bundle_of_a_live_scene(work):
    scene, obj = saved_studio(work)
    texture = work / "skin.1001.png"
    texture.write_bytes(b"none")
    tiled = bpy.data.images.new("skin", 4, 4, tiled=True)
    tiled.filepath, tiled.use_fake_user = str(work / "skin.<UDIM>.png"), True
    bpy.ops.wm.save_mainfile()
    (work / "noon.json").write_text('{"skinglow_rig": 1, "lights": []}')
    rigs = {"day": ["warm", "cold lamp"], "noon": work / "noon.json"}
    written = write(work / "job", "1-9x2,20", rigs, out="//pictures", chunk=4, onto=obj, timeout=90)
    assert written == work / "job" / "template.json"
    template = read(work / "job", "template")
    rig, frames = template["steps"][0]["parameterSpace"]["taskParameterDefinitions"]
    assert rig == {"name": "Rig", "type": "STRING", "range": ["day=warm,cold lamp", f"noon={work / 'noon.json'}"]}
    assert frames["range"] == "{{Param.Frames}}" and frames["chunks"]["defaultTaskCount"] == "{{Param.FramesPerTask}}"
    given = arguments(work / "job")
    wanted = {"--onto=Patch", f"--scene={scene.name}", "--rigs={{Task.Param.Rig}}", "--frames={{Task.Param.Frames}}"}
    assert wanted <= set(given), given
    for option, value in (("--timeout", "90"), ("--python-exit-code", "2"), ("--progress", "openjd")):
        assert given[given.index(option) + 1] == value
    parameters = read(work / "job", "parameters")
    assert parameters == {
        "BlendFile": str(work / "scene.blend"),
        "OutDir": str(work / "pictures"),
        "Frames": "1-9:2,20",
        "FramesPerTask": 4,
        "Blender": "blender",
    }
    values = read(work / "job", "parameter_values")["parameterValues"]
    assert {each["name"]: each["value"] for each in values} == parameters
    attached = read(work / "job", "asset_references")["assetReferences"]
    assert attached["inputs"]["filenames"] == sorted(map(str, (work / "noon.json", work / "scene.blend", texture)))
    assert attached["outputs"]["directories"] == [str(work / "pictures")]


def check_bundle_of_a_frozen_scene(work):
    saved_studio(work)
    raises("Patch: not frozen, so workers need the add-on", write, work / "job_2", frozen=True)
    sb.freeze()
    bpy.ops.wm.save_mainfile()
    raises("there are no light rigs", write, work / "job_2", rigs=["warm"], pattern="{rig}{frame}", frozen=True)
    raises("no pattern", write, work / "job_2", pattern="{frame}", frozen=True)
    assert not (work / "job_2").exists()
    write(work / "job_2", frozen=True)
    step = read(work / "job_2", "template")["steps"][0]
    (script,) = step["script"]["embeddedFiles"]
    assert "skinglow_blender" not in script["data"] and "{{" not in script["data"]
    assert "sb.batch_main()" not in " ".join(arguments(work / "job_2"))
    attached = read(work / "job_2", "asset_references")["assetReferences"]["inputs"]["filenames"]
    light = work / "skinglow_frozen" / "Patch"
    assert set(attached) >= {str(light / f"light_000{n}.exr") for n in (1, 2, 3)}
    assert attached == [str(path) for path in input_files()]


def check_frames_of_a_frozen_scene(work):
    """What a task does, in this Blender: other than with the full program, the add-on is there."""
    scene, _ = saved_studio(work)
    sb.freeze(folder=work / "light")
    folder = work / "frozen {pictures}"
    (folder / ".0003.elsewhere-1.part.exr").parent.mkdir()
    (folder / ".0003.elsewhere-1.part.exr").write_bytes(b"part")
    assert frozen_frames.main("1-3:2", folder, scene.name, 600.0) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["0001.exr", "0003.exr"]
    for frame in (1, 3):
        lights = [(color_at(rig, frame), 1.0) for rig in RIGS]
        np.testing.assert_allclose(shown_in(folder / f"000{frame}.exr"), expected(*lights), rtol=1e-5)
    assert frozen_frames.frame_numbers("-3--1, 7,8") == [-3, -2, -1, 7, 8]
    (folder / "0002.exr").mkdir()
    assert frozen_frames.main("2", folder, scene.name, 0.0) == 1 and not list(folder.glob(".*"))
    assert frozen_frames.main("2", folder, "no scene", 0.0) == 2
    (work / "light").rename(work / "gone")
    assert frozen_frames.main("2", folder, scene.name, 0.0) == 2


def check_refused_before_anything_is_written(work):
    scene, obj = studio()
    folder = work / "never"
    raises("Save the file first", write, folder)
    bpy.ops.wm.save_as_mainfile(filepath=str(work / "refused.blend"))
    raises("chunk = 0", write, folder, chunk=0)
    raises("'Nowhere' is neither a light nor a collection", write, folder, rigs=["Nowhere"])
    raises("is reversed", write, folder, "9-1")
    (work / "noon.json").write_text('{"skinglow_rig": 1, "lights": []}')
    raises("not both", write, folder, rigs=[sb.Rig("mixed", ("warm",), work / "noon.json")])
    raises("begins an expression", write, folder, rigs={"{{a}}": ["warm"]})
    assert not folder.exists()
    raises("Cannot write to", write, work / "noon.json" / "inside")
    before, openjd._has_unsaved_changes = openjd._has_unsaved_changes, lambda: True
    try:
        raises("Save the file first", write, folder)
    finally:
        openjd._has_unsaved_changes = before


def check_operator(work):
    saved_studio(work)
    sb.register()
    done = bpy.ops.skinglow.write_openjd(
        directory=str(work / "by menu"), frames="2", rigs="warm 'c=cold lamp'", chunk=3
    )
    assert done == {"FINISHED"}
    (rig, _frames) = read(work / "by menu", "template")["steps"][0]["parameterSpace"]["taskParameterDefinitions"]
    assert rig["range"] == ["warm=warm", "c=cold lamp"]
    assert read(work / "by menu", "parameters")["OutDir"] == str(work / "batch")
    try:
        bpy.ops.skinglow.write_openjd(directory=str(work / "frozen"), light="FROZEN")
        raise AssertionError("skins are not frozen")
    except RuntimeError as error:
        assert "freeze them first" in str(error)
    assert not Path(work / "frozen").exists()


def check_operator_tells_what_workers_need(work):
    class Layout:
        """Keeps what is drawn."""

        def __init__(self):
            self.texts, self.names = [], []

        def prop(self, _owner, name, **_named):
            self.names.append(name)

        def label(self, text, **_named):
            self.texts.append(text)

    for light, need, rigs in (
        ("LIVE", "Each worker needs Blender with", 1),
        ("FROZEN", "Workers need Blender alone", 0),
    ):
        operator = types.SimpleNamespace(layout=Layout(), light=light)
        farm_operators.SKINGLOW_OT_write_openjd.draw(operator, bpy.context)
        assert need in " ".join(operator.layout.texts), operator.layout.texts
        assert operator.layout.names.count("rigs") == rigs and operator.layout.names[0] == "light"


def check_ranges(work):
    assert _ranges([1]) == "1" and _ranges([1, 2]) == "1-2" and _ranges([1, 3]) == "1,3"
    assert _ranges([-5, -4, -3, 1, 3, 5, 7, 20, 40]) == "-5--3,1-7:2,20,40"
