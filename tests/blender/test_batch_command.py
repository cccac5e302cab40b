"""The batch as a program: `blender -b scene.blend --python-expr ...`, its exit codes and what it says."""

import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from hosts import ADDON_FOLDER, HERE, HOSTS, host_named

SECONDS = 120
#: Makes and saves a scene: two lights, a skin, a camera.
SCENE = """
import bpy
from inside.scenes import black_material, camera_above, add_light, patch, render_settings
import skinglow_blender as sb
bpy.ops.wm.read_factory_settings(use_empty=True)
add_light("Key", color=(1.0, 0.0, 0.0))
add_light("Fill", color=(0.0, 0.0, 1.0))
sb.make_skin(patch(material=black_material()), thickness=[0.0] * 4, mode='paper')
camera_above()
scene = render_settings(4, 4)
scene.frame_end = 4
bpy.ops.wm.save_as_mainfile(filepath={blend!r})
"""


class Program:
    """The full Blender program with a scene of its own."""

    def __init__(self, folder: Path) -> None:
        self.host = host_named("3.4")
        assert self.host.path, f"Blender {self.host.name} is not there: {self.host.variable} does not say where it is"
        self.environment = self.host.environment(folder)
        self.blend = folder / "scene.blend"
        done = self.run([], SCENE.format(blend=str(self.blend)), factory=True)
        assert self.blend.exists(), done.stdout + done.stderr

    def command(self, arguments: list[str], text: str, factory: bool = False) -> list[str]:
        paths = f"import sys; sys.path[:0] = [{str(ADDON_FOLDER)!r}, {str(HERE)!r}]"
        paths += f"; sys.path.append({self.environment['SKINGLOW_SITE']!r})"
        file = [] if factory else [str(self.blend)]
        start = [self.host.path, "-b", "--factory-startup", *file, "--python-expr"]
        return [*start, f"{paths}\n{text}", "--", *arguments]

    def run(self, arguments: list[str], text: str = "", factory: bool = False) -> subprocess.CompletedProcess[str]:
        text = text or "import skinglow_blender as sb; sb.batch_main()"
        command = self.command(arguments, text, factory)
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=SECONDS)


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Program:
    return Program(tmp_path_factory.mktemp("batch"))


def manifest(folder: Path) -> list[dict]:
    return [json.loads(line) for line in (folder / "manifest.jsonl").read_text().splitlines()]


def test_pictures_progress_and_resume(program: Program, tmp_path: Path) -> None:
    options = ["--rigs", "Key", "both=Key,Fill", "--frames", "1-2", "--out", str(tmp_path)]
    first = program.run(options)
    assert first.returncode == 0, first.stdout + first.stderr
    assert {(e["rig"], e["frame"]) for e in manifest(tmp_path)} == {("Key", 1), ("Key", 2), ("both", 1), ("both", 2)}
    told = [line for line in first.stderr.splitlines() if line.startswith("[")]
    assert [line.split("]")[0] for line in told] == ["[1/4", "[2/4", "[3/4", "[4/4"]
    assert told[0].startswith("[1/4] Key, frame 1: rendered in ") and told[0].endswith(" left")
    assert "4 rendered, 0 kept, 0 failed" in first.stderr
    (tmp_path / "both" / "0002.exr").unlink()
    again = program.run(options)
    assert again.returncode == 0, again.stdout + again.stderr
    assert "1 rendered, 3 kept, 0 failed" in again.stderr and "its file is missing" in again.stderr
    assert len(manifest(tmp_path)) == 5


def test_by_default_beside_the_file_as_the_scene_has_it(program: Program) -> None:
    done = program.run([])
    assert done.returncode == 0, done.stdout + done.stderr
    folder = program.blend.parent / "batch"
    assert sorted(p.name for p in (folder / "scene").iterdir()) == [f"{n:04d}.exr" for n in range(1, 5)]
    (skin,) = manifest(folder)[0]["skins"]
    assert {row["name"] for row in skin["lamps"] if row["share"] > 0.0} == {"Key", "Fill"}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--rigs", "Nothing"], "'Nothing' is neither a light nor a collection of lights"),
        (["--frames", "9-1"], "is reversed: write 1-9"),
        (["--out", "/proc/nothing"], "Cannot write to /proc/nothing"),
        (["--scene", "Nothing"], "There is no scene 'Nothing'"),
        (["--speed", "9"], "unrecognized arguments: --speed 9"),
        (["--freeze", "/tmp/frozen.blend", "--again"], "nothing is rendered, which --again is about: leave it out"),
    ],
)
def test_bad_arguments(program: Program, arguments: list[str], told: str) -> None:
    done = program.run(arguments)
    assert done.returncode == 2 and told in done.stderr, done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_help(program: Program) -> None:
    done = program.run(["--help"])
    assert done.returncode == 0
    assert "--rigs RIG [RIG ...]" in done.stdout and "exit code" in done.stdout


def test_one_that_fails_leaves_the_others(program: Program, tmp_path: Path) -> None:
    text = "import bpy, skinglow_blender as sb\n"
    text += "off = bpy.data.collections.new('Off'); bpy.context.scene.collection.children.link(off)\n"
    text += "fill = bpy.data.objects['Fill']; bpy.context.scene.collection.objects.unlink(fill)\n"
    text += "off.objects.link(fill); off.hide_render = True\nsb.batch_main()"
    done = program.run(["--rigs", "Fill", "Key", "--frames", "1", "--out", str(tmp_path)], text)
    assert done.returncode == 3, done.stdout + done.stderr
    assert "Fill, frame 1: FAILED: light 'Fill' of the rig is not in the render" in done.stderr
    assert [e["rig"] for e in manifest(tmp_path)] == ["Key"]


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM], ids=lambda sent: sent.name)
def test_ctrl_c_ends_after_a_whole_picture(program: Program, tmp_path: Path, sent: signal.Signals) -> None:
    options = ["--frames", "1-500", "--rigs", "Key", "--out", str(tmp_path)]
    command = program.command(options, "import skinglow_blender as sb; sb.batch_main()")
    with (tmp_path / "told.txt").open("w+") as log:
        running = subprocess.Popen(command, env=program.environment, stdout=subprocess.DEVNULL, stderr=log)
        try:
            until = time.monotonic() + SECONDS
            while not list(tmp_path.glob("Key/*.exr")):
                assert running.poll() is None and time.monotonic() < until, (tmp_path / "told.txt").read_text()
                time.sleep(0.05)
            running.send_signal(sent)
            assert running.wait(SECONDS) == 130
        finally:
            running.kill()
            running.wait()
    assert "run the same command to continue" in (tmp_path / "told.txt").read_text()
    entries = manifest(tmp_path)
    assert 1 <= len(entries) < 500
    assert {e["file"] for e in entries} == {f"Key/{p.name}" for p in (tmp_path / "Key").iterdir()}


def test_a_picture_that_hangs_ends_the_process(program: Program, tmp_path: Path) -> None:
    """Exit code 1: another try may help. The handler holds Python's lock in C, as a driver that hangs would."""
    text = "import re, bpy, skinglow_blender as sb\n"
    text += "def hang(*_):\n    if bpy.context.scene.frame_current == 2: re.match('(a+)+b', 'a' * 60)\n"
    text += "bpy.app.handlers.frame_change_pre.append(hang)\nsb.batch_main()"
    done = program.run(["--frames", "1-3", "--timeout", "3", "--out", str(tmp_path)], text)
    assert done.returncode == 1 and "Timeout (0:00:03)!" in done.stderr, done.stdout + done.stderr
    assert [e["frame"] for e in manifest(tmp_path)] == [1]


def test_workers_share_a_folder(program: Program, tmp_path: Path) -> None:
    """Two processes at once, a range each, one manifest."""
    text = "import skinglow_blender as sb; sb.batch_main()"
    running = [
        subprocess.Popen(
            program.command(["--frames", frames, "--rigs", "Key", "Fill", "--out", str(tmp_path)], text),
            env=program.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        for frames in ("1-2", "3-4")
    ]
    for worker in running:
        _out, told = worker.communicate(timeout=SECONDS)
        assert worker.returncode == 0, told
    assert sorted(e["file"] for e in manifest(tmp_path)) == [
        f"{r}/000{f}.exr" for r in ("Fill", "Key") for f in range(1, 5)
    ]
    assert "8 kept" in program.run(["--rigs", "Key", "Fill", "--out", str(tmp_path)]).stderr


@pytest.mark.parametrize("host", [h for h in HOSTS if not h.is_program], ids=lambda host: host.name)
def test_process_of_a_wheel_ends_with_the_exit_code(host, tmp_path: Path) -> None:
    """In a bpy wheel there is no program: a script calls the command."""
    script = tmp_path / "batch_script.py"
    paths = f"import os, sys\nsys.path[:0] = [{str(ADDON_FOLDER)!r}, {str(HERE)!r}]\n"
    scene = SCENE.format(blend=str(tmp_path / "scene.blend"))
    call = "code = 9\ntry:\n    sb.batch_main(sys.argv[1:])\nexcept SystemExit as end:\n    code = end.code\n"
    script.write_text(f"{paths}{scene}{call}sys.stderr.flush()\nos._exit(code)\n")
    for rigs, wanted in (("Key", 0), ("Nothing", 2)):
        arguments = ["--rigs", rigs, "--frames", "1", "--out", str(tmp_path / "out")]
        done = subprocess.run(
            [host.path, str(script), *arguments],
            env=host.environment(tmp_path),
            capture_output=True,
            text=True,
            timeout=SECONDS,
        )
        assert done.returncode == wanted, done.stdout + done.stderr
    assert (tmp_path / "out" / "Key" / "0001.exr").exists()


def test_freeze_saves_a_file_that_renders_without_the_add_on(program: Program, tmp_path: Path) -> None:
    frozen = tmp_path / "frozen.blend"
    done = program.run(["--freeze", str(frozen), "--frames", "2-3", "--out", str(tmp_path / "light")])
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Patch: frames 2 to 3 frozen to" in done.stderr
    files = sorted(path.name for path in (tmp_path / "light" / "Patch").iterdir())
    assert files == ["light_0002.exr", "light_0003.exr"]
    program.run(["--frames", "3", "--out", str(tmp_path / "live")])
    assert difference_without_add_on(program, frozen, tmp_path) == 0.0
    shutil.rmtree(tmp_path / "light")
    assert difference_without_add_on(program, frozen, tmp_path) > 0.1
    refused = program.run(["--freeze", str(frozen), "--rigs", "Key"])
    assert refused.returncode == 2 and "leave out --rigs" in refused.stderr


def difference_without_add_on(program: Program, file: Path, folder: Path) -> float:
    """The largest one between frame 3 of a file as it renders without the add-on, and as it was rendered live."""
    command = [program.host.path, "-b", "--factory-startup", str(file), "-o", f"{folder}/without/####", "-f", "3"]
    subprocess.run(command, env=program.environment, capture_output=True, timeout=SECONDS, check=True)
    pictures = [str(folder / "live/scene/0003.exr"), str(folder / "without/0003.exr")]
    compared = json.loads(subprocess.check_output([os.environ["SKINGLOW_CLI"], "compare", "--json", *pictures]))
    return max(compared[channel]["max"] for channel in ("red", "green", "blue"))
