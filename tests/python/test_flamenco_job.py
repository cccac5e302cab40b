"""The job type for Flamenco, compiled in node with stand-ins for what Flamenco Manager provides."""

import json
import shutil
import subprocess
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "blender_addon" / "farm" / "skinglow_batch.js"
STAND_INS = Path(__file__).with_name("flamenco_stand_ins.js")
SETTINGS = {"frames": "1-4,9", "chunk_size": 3, "rigs": "", "folder": "/share/out", "light": "live"}
SETTINGS |= {"blendfile": "/share/head scene.blend", "scene": "Scene"}
START = "import skinglow_blender as sb; sb.batch_main()"


def run(**settings: object) -> subprocess.CompletedProcess[str]:
    node = shutil.which("node")
    assert node, "node is not there: scripts/setup --tests installs it (Debian package nodejs)"
    command = [node, str(STAND_INS), str(SCRIPT), json.dumps({**SETTINGS, **settings})]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def tasks(**settings: object) -> list[dict]:
    done = run(**settings)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["tasks"]


def test_commands_of_a_live_job() -> None:
    first, second = tasks(rigs="Sunset 'day=Key, Fill' /share/noon.json")
    assert (first["name"], first["type"], second["name"]) == ("pictures-1-3", "blender", "pictures-4,9")
    (command,) = first["commands"]
    assert command["name"] == "blender-render" and command["steps"] == 9
    assert second["commands"][0]["steps"] == 6
    assert command["parameters"] == {
        "exe": "{blender}",
        "exeArgs": "{blenderArgs}",
        "argsBefore": [],
        "blendfile": "/share/head scene.blend",
        "args": ["--python-exit-code", "2", "--python-expr", START, "--", "--progress", "flamenco"]
        + ["--frames=1-3", "--out=/share/out", "--scene=Scene"]
        + ["--rigs", "Sunset", "day=Key, Fill", "/share/noon.json"],
    }


def test_without_rigs_and_scene_the_file_decides() -> None:
    (command,) = tasks(frames="7", scene="")[0]["commands"]
    assert command["steps"] == 1
    assert command["parameters"]["args"][5:] == ["--progress", "flamenco", "--frames=7", "--out=/share/out"]


def test_commands_of_a_frozen_job_are_blenders_own() -> None:
    first, second = tasks(light="frozen")
    args = ["--scene", "Scene", "--render-output", "/share/out/scene/####", "--render-frame"]
    assert first["commands"][0]["parameters"]["args"] == [*args, "1..3"]
    assert second["commands"][0]["parameters"]["args"] == [*args, "4,9"]
    refused = run(light="frozen", rigs="Sunset")
    assert refused.returncode != 0 and "do not follow light rigs" in refused.stderr


def test_settings_are_those_that_flamenco_knows() -> None:
    settings = json.loads(run().stdout)["type"]["settings"]
    assert [each["key"] for each in settings] == [*list(SETTINGS)[:5], "blendfile", "scene"]
    known = {"key", "type", "subtype", "required", "eval", "evalInfo", "description", "default", "propargs", "visible"}
    assert all(set(each) <= known | {"choices"} and each["type"] in ("string", "int32") for each in settings)
    assert {each.get("visible") for each in settings} == {None, "submission", "web"}
