"""40 frames x 2 rigs of the example scene through OpenJD and Slurm, with workers killed at random.

Run by scripts/test --farms, not by the ordinary tests.
"""

import os
import random
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from farm_program import FarmProgram, assert_same_pixels, job_arguments, leftovers, manifest, pictures
from slurm_cluster import Cluster

PROJECT = Path(__file__).parents[2]
FRAMES, CHUNK, KILLS = 40, 10, 2
RIGS = ("sunset", str(PROJECT / "tests" / "data" / "table1.json"))
NAMES = [f"{rig}/{frame:04d}.exr" for rig in ("sunset", "table1") for frame in range(1, FRAMES + 1)]
SECONDS = 900
#: The example scene, its pictures small, its three frames drawn out to forty.
SMALL = f"""
scene = bpy.context.scene
scene.render.resolution_x = scene.render.resolution_y = 24
scene.cycles.samples, scene.cycles.use_denoising = 2, False
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
for action in bpy.data.actions:
    for curve in action.fcurves:
        for key in curve.keyframe_points:
            key.co.x = 1.0 + (key.co.x - 1.0) * {(FRAMES - 1) / 2}
        curve.update()
scene.frame_end = {FRAMES}
bpy.ops.wm.save_mainfile()
onto = bpy.data.objects["head"]
sb.farm.write_openjd("//job", rigs={list(RIGS)!r}, out="//openjd", chunk={CHUNK}, onto=onto)
assert len(sb.render_batch("//alone", rigs={list(RIGS)!r}, onto=onto).rendered) == {len(NAMES)}
"""


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> FarmProgram:
    program = FarmProgram(tmp_path_factory.mktemp("farm"))
    scene = program.folder / "scene.blend"
    make = [program.blender, "-b", "-P", str(PROJECT / "scripts/example_steps/batch_scene.py"), "--", str(scene)]
    done = subprocess.run(make, env=program.environment, capture_output=True, text=True, timeout=SECONDS)
    assert scene.exists(), done.stdout + done.stderr
    program.python(SMALL, str(scene))
    return program


class Killer(threading.Thread):
    """Kills a worker that renders to a folder, each time when a number of pictures by chance is there."""

    def __init__(self, folder: Path) -> None:
        super().__init__(daemon=True)
        seed = int(os.environ.get("SKINGLOW_FARM_SEED", time.time_ns() % 100_000))
        print(f"SKINGLOW_FARM_SEED={seed}")
        chance = random.Random(seed)
        # Not among the last: there has to be a worker.
        self.at = sorted(chance.sample(range(3, len(NAMES) - 15), KILLS))
        self.pauses = [chance.uniform(0.0, 0.3) for _ in self.at]
        self.folder, self.killed, self.ended = folder, [], False

    def run(self) -> None:
        for count, pause in zip(self.at, self.pauses, strict=True):
            while len(pictures(self.folder)) < count and not self.ended:
                time.sleep(0.01)
            time.sleep(pause)
            while not self.ended and not self.kill():
                time.sleep(0.01)

    def kill(self) -> bool:
        for process in workers(self.folder):
            if process not in self.killed:
                os.kill(process, signal.SIGKILL)
                self.killed.append(process)
                return True
        return False


def workers(folder: Path) -> list[int]:
    """The Blenders that render to a folder."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes().split(b"\0")
        except OSError:
            continue
        if os.path.basename(words[0]) == b"blender" and str(folder).encode() in words:
            found.append(int(path.parent.name))
    return found


def render(folder: Path, run: Callable[[Killer], None]) -> None:
    """Lets a farm render while workers are killed, and compares with the pictures of a single machine."""
    killer = Killer(folder)
    killer.start()
    try:
        run(killer)
    finally:
        killer.ended = True
        killer.join()
    assert len(killer.killed) == KILLS
    assert pictures(folder) == NAMES
    assert sorted(entry["file"] for entry in manifest(folder)) == NAMES
    assert_same_pixels(folder, folder.parent / "alone", NAMES)
    assert not leftovers(folder) and not workers(folder)


def test_openjd(farm: FarmProgram) -> None:
    def run(_killer: Killer) -> None:
        codes = []
        while not codes or (codes[-1] and len(codes) <= KILLS):
            codes.append(farm.openjd(*job_arguments(farm.folder / "job", farm.blender)).returncode)
        assert codes == [1] * KILLS + [0]

    render(farm.folder / "openjd", run)


def test_slurm(farm: FarmProgram) -> None:
    """The script of the documentation; its log tells how each task ended."""
    out, logs = farm.folder / "slurm", farm.folder / "logs"
    logs.mkdir()
    with Cluster() as cluster:

        def run(_killer: Killer) -> None:
            environment = {**cluster.environment, **farm.environment, "SLURM_CONF": cluster.environment["SLURM_CONF"]}
            environment |= {"PATH": cluster.path, "BLENDER": farm.blender}
            array = f"--array=0-{FRAMES // CHUNK - 1}"
            script = str(PROJECT / "blender_addon" / "farm" / "skinglow_slurm.sh")
            task = [str(farm.folder / "scene.blend"), str(out), "1", str(FRAMES), str(CHUNK), *RIGS, "--onto", "head"]
            cluster.run("sbatch", array, script, *task, env=environment, cwd=logs)
            until = time.monotonic() + SECONDS
            while queue := cluster.run("squeue", "-h", "-o", "%i %T"):
                assert time.monotonic() < until, queue
                time.sleep(0.5)

        render(out, run)
        told = "".join(path.read_text() for path in logs.glob("*.txt"))
        assert told.count("Killed") == KILLS, told
        # Workers are named by their manager.
        assert [path.name for path in out.glob("*.jsonl")] == ["manifest-localhost.jsonl"]


def test_slurm_does_not_try_again_what_is_useless(farm: FarmProgram) -> None:
    with Cluster() as cluster:
        environment = {**farm.environment, **cluster.environment, "BLENDER": farm.blender}
        script = str(PROJECT / "blender_addon" / "farm" / "skinglow_slurm.sh")
        task = [str(farm.folder / "scene.blend"), str(farm.folder / "none"), "1", "1", "1", "nobody"]
        done = subprocess.run(
            ["sbatch", "--wait", "--array=0", script, *task],
            env=environment,
            cwd=farm.folder,
            capture_output=True,
            text=True,
            timeout=SECONDS,
        )
        assert done.returncode == 2, done.stdout + done.stderr
        (log,) = farm.folder.glob("skinglow_*_0.txt")
        assert log.read_text().count("'nobody' is neither a light") == 1
