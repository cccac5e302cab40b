"""A batch as a job of Open Job Description: checked and run by `openjd`, with a real Blender."""

import json

import pytest
from farm_program import FarmProgram, assert_same_pixels, job_arguments, leftovers, manifest, pictures

SCENE = """
from inside.scenes import add_light, black_material, camera_above, patch, render_settings
bpy.ops.wm.read_factory_settings(use_empty=True)
for name, color in (("Key", (1.0, 0.0, 0.0)), ("Fill", (0.0, 0.0, 1.0))):
    light = add_light(name, color=color)
    for frame in range(1, 6):
        light.location.x = 0.1 * frame
        light.keyframe_insert("location", frame=frame)
sb.make_skin(patch(material=black_material()), thickness=[0.0] * 4, mode='paper')
camera_above()
scene = render_settings(4, 4)
scene.frame_end = 5
bpy.ops.wm.save_as_mainfile(filepath=folder + "/scene.blend")
sb.farm.write_openjd(folder + "/job", "1-3,5", ["Key", folder + "/noon.json"], out=folder + "/out", chunk=2)
sb.render_batch(folder + "/alone", "1-3,5", ["Key", folder + "/noon.json"])
sb.render_batch(folder + "/alone", "1-3")
sb.freeze(None, 1, 3)
bpy.ops.wm.save_as_mainfile(filepath=folder + "/frozen.blend")
sb.farm.write_openjd(folder + "/frozen_job", "1-3", out=folder + "/frozen_out", chunk=3, frozen=True)
"""


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> FarmProgram:
    folder = tmp_path_factory.mktemp("farm")
    lights = [{"kind": "POINT", "color": [0.2, 0.9, 0.4], "power": 10, "position": [0, 0, 1]}]
    (folder / "noon.json").write_text(json.dumps({"skinglow_rig": 1, "lights": lights}))
    program = FarmProgram(folder)
    program.python(f"folder = {str(folder)!r}\n{SCENE}")
    return program


def test_templates_are_valid(farm: FarmProgram) -> None:
    for job in ("job", "frozen_job"):
        done = farm.openjd("check", farm.folder / job / "template.json")
        assert done.returncode == 0 and "passes validation" in done.stdout, done.stdout


def test_a_frame_that_fails_is_made_by_the_same_command_again(farm: FarmProgram) -> None:
    """Submitted on a machine where everything is elsewhere."""
    job = farm.folder / "job_from_elsewhere"
    job.mkdir()
    for name in ("parameters.json", "template.json"):
        text = (farm.folder / "job" / name).read_text()
        (job / name).write_text(text.replace(str(farm.folder), "/elsewhere"))
    rules = {
        "version": "pathmapping-1.0",
        "path_mapping_rules": [
            {"source_path_format": "POSIX", "source_path": "/elsewhere", "destination_path": str(farm.folder)}
        ],
    }
    command = [*job_arguments(job, farm.blender), "--path-mapping-rules", json.dumps(rules)]
    out = farm.folder / "out"
    (out / "noon" / "0002.exr").mkdir(parents=True)
    first = farm.openjd(*command)
    assert first.returncode == 1, first.stdout
    assert "openjd_fail: 0002.exr: " in first.stdout and "exited with code: 1 " in first.stdout, first.stdout
    assert pictures(out) == [*(f"Key/000{n}.exr" for n in (1, 2, 3, 5)), "noon/0001.exr"]
    (out / "noon" / "0002.exr").rmdir()
    again = farm.openjd(*command)
    assert again.returncode == 0 and "openjd_progress: 100.0" in again.stdout, again.stdout
    wanted = [f"{rig}/000{n}.exr" for rig in ("Key", "noon") for n in (1, 2, 3, 5)]
    assert pictures(out) == wanted and sorted(entry["file"] for entry in manifest(out)) == wanted
    assert_same_pixels(out, farm.folder / "alone", wanted)
    assert not leftovers(out)


def test_frozen_job_needs_no_add_on(farm: FarmProgram) -> None:
    command = job_arguments(farm.folder / "frozen_job", farm.blender)
    done = farm.openjd(*command, with_addon=False)
    assert done.returncode == 0 and "openjd_progress: 100.0" in done.stdout, done.stdout
    assert pictures(farm.folder / "frozen_out") == [f"scene/000{n}.exr" for n in (1, 2, 3)]
    assert_same_pixels(farm.folder / "frozen_out", farm.folder / "alone", pictures(farm.folder / "frozen_out"))
    assert not leftovers(farm.folder / "frozen_out")
    (farm.folder / "skinglow_frozen").rename(farm.folder / "gone")
    done = farm.openjd(*command, with_addon=False)
    assert done.returncode == 1 and "exited with code: 2 " in done.stdout, done.stdout
    assert "with the frozen light" in done.stdout


def test_live_job_without_the_add_on_tells_that_it_is_useless_to_retry(farm: FarmProgram) -> None:
    done = farm.openjd(*job_arguments(farm.folder / "job", farm.blender), with_addon=False)
    assert done.returncode == 1, done.stdout
    assert "exited with code: 2 " in done.stdout and "No module named 'skinglow_blender'" in done.stdout, done.stdout
