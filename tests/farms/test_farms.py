"""40 frames x 2 rigs of the example scene through OpenJD and Slurm, with workers killed at random.

Run by scripts/test --farms, not by the ordinary tests.
"""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
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
sb.render_batch("//scene_alone", "1-4")
sb.freeze(None, 1, 4)
bpy.ops.wm.save_as_mainfile(filepath=bpy.path.abspath("//frozen.blend"))
"""


@pytest.fixture(scope="module")
def farm(tmp_path_factory: pytest.TempPathFactory) -> FarmProgram:
    program = FarmProgram(tmp_path_factory.mktemp("farm"))
    scene = program.folder / "scene.blend"
    make = [sys.executable, "-m", "studies", "batch", "--scene", "--out", program.folder, "--blender", program.blender]
    done = subprocess.run(make, cwd=PROJECT, env=program.environment, capture_output=True, text=True, timeout=SECONDS)
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
    # Each input was read once, by whichever worker came first.
    read = [json.loads(line)[0] for line in (folder / ".skinglow_digests").read_text().splitlines()]
    assert sorted(read) == sorted([str(folder.parent / "scene.blend"), RIGS[1]])


def test_openjd(farm: FarmProgram) -> None:
    def run(_killer: Killer) -> None:
        codes = []
        while not codes or (codes[-1] and len(codes) <= KILLS):
            codes.append(farm.openjd(*job_arguments(farm.folder / "job", farm.blender)).returncode)
        assert codes == [1] * KILLS + [0]

    render(farm.folder / "openjd", run)


class Queue:
    """A cluster, and the script of the documentation."""

    script = str(PROJECT / "blender_addon" / "farm" / "skinglow_slurm.sh")

    def __init__(self, cluster: Cluster, farm: FarmProgram) -> None:
        self.cluster, self.farm = cluster, farm

    def run(self, environment: dict[str, str], array: str, blend: str, out: Path, *arguments: object) -> str:
        """Runs an array of tasks to its end; returns what the tasks told."""
        logs = Path(tempfile.mkdtemp(dir=self.farm.folder))
        own = {"SLURM_CONF": self.cluster.environment["SLURM_CONF"], "PATH": self.cluster.path}
        environment = {**environment, **own, "BLENDER": self.farm.blender}
        task = [self.script, str(self.farm.folder / blend), str(out), *map(str, arguments)]
        self.cluster.run("sbatch", f"--array={array}", *task, env=environment, cwd=logs)
        until = time.monotonic() + SECONDS
        while queue := self.cluster.run("squeue", "-h", "-o", "%i %T"):
            assert time.monotonic() < until, queue
            time.sleep(0.5)
        return "".join(path.read_text() for path in sorted(logs.glob("*.txt")))


@pytest.fixture(scope="module")
def queue(farm: FarmProgram) -> Iterator[Queue]:
    with Cluster() as cluster:
        yield Queue(cluster, farm)


def test_slurm(farm: FarmProgram, queue: Queue) -> None:
    out, told = farm.folder / "slurm", []

    def run(_killer: Killer) -> None:
        chunks = f"0-{FRAMES // CHUNK - 1}"
        told.append(queue.run(farm.environment, chunks, "scene.blend", out, 1, FRAMES, CHUNK, *RIGS, "--onto", "head"))

    render(out, run)
    assert told[0].count("Killed") == KILLS, told
    # Workers are named by their manager.
    assert [path.name for path in out.glob("*.jsonl")] == ["manifest-localhost.jsonl"]


def test_slurm_does_not_try_again_what_is_useless(farm: FarmProgram, queue: Queue) -> None:
    told = queue.run(farm.environment, "0", "scene.blend", farm.folder / "none", 1, 1, 1, "nobody")
    assert told.count("'nobody' is neither a light") == 1, told


def test_slurm_renders_frozen_scenes_without_the_add_on(farm: FarmProgram, queue: Queue) -> None:
    out = farm.folder / "frozen"
    told = queue.run({**farm.without_addon, "LIGHT": "frozen"}, "0-1", "frozen.blend", out, 1, 4, 2)
    names = [f"scene/{frame:04d}.exr" for frame in range(1, 5)]
    assert pictures(out) == names, told
    assert_same_pixels(out, farm.folder / "scene_alone", names)
