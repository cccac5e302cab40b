"""The command line is killed while it writes: what was there is whole, and what is new is whole or not there."""

import os
import random
import subprocess
import time
from pathlib import Path

import pytest

DATA = Path(__file__).resolve().parents[1] / "data"
RIGS = (DATA / "table1.json", DATA / "all_kinds.json")
KILLS = 24


TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def write(rig: Path, output: Path) -> list[str]:
    """The command that writes the lookup of a rig."""
    return [os.environ["SKINGLOW_CLI"], "lut", str(rig), "-o", str(output)]


# An EXR has the time in it, and is never the same twice.
@pytest.mark.parametrize("name", ["table.csv", "table.png"])
def test_a_table_is_whole(name: str, tmp_path: Path) -> None:
    versions = []
    for rig in RIGS:
        started = time.perf_counter()
        subprocess.run(write(rig, tmp_path / name), check=True, capture_output=True)
        took = time.perf_counter() - started
        versions.append((tmp_path / name).read_bytes())
    assert versions[0] != versions[1]
    chance, killed = random.Random(name), 0
    for number in range(KILLS):
        with subprocess.Popen(
            write(RIGS[number % 2], tmp_path / name), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as running:
            time.sleep(chance.uniform(0.0, took))
            running.kill()
        killed += running.returncode != 0
        assert (tmp_path / name).read_bytes() in versions, number
    assert killed > KILLS / 8


def test_a_scene_of_pov_ray_is_whole_and_what_else_its_folder_has_stays(tmp_path: Path) -> None:
    mesh, folder = tmp_path / "mesh.obj", tmp_path / "scene"
    mesh.write_text(TETRAHEDRON)

    def command(number: int) -> list[str]:
        given = (str(RIGS[number % 2]), "--mesh", str(mesh), "--point", "0", "0", "0", "-o", str(folder))
        return [os.environ["SKINGLOW_CLI"], "povray", *given]

    def content() -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in folder.iterdir()}

    folder.mkdir()
    (folder / "notes.txt").write_text("of the user")
    versions = []
    for number in range(2):
        started = time.perf_counter()
        subprocess.run(command(number), check=True, capture_output=True)
        took = time.perf_counter() - started
        versions.append(content())
    assert versions[0] != versions[1] and versions[0]["notes.txt"] == b"of the user"
    chance, killed = random.Random(5), 0
    for number in range(KILLS):
        with subprocess.Popen(command(number), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
            time.sleep(chance.uniform(0.0, took))
            running.kill()
        killed += running.returncode != 0
        assert content() in versions, number
    assert killed > KILLS / 8
