"""`skinglow povray`: the scene means what the mesh's format and the table say."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from povray_runs import render

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))
RIG = ROOT / "tests" / "data" / "table1.json"


def skinglow(*arguments: object) -> str:
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def plate(path: Path, extents: tuple[float, float, float]) -> Path:
    trimesh.creation.box(extents=extents).subdivide().export(path)
    return path


@pytest.mark.parametrize("mode", ["paper", "physical", "existing"])
@pytest.mark.parametrize("ending", [".exr", ".csv"])
def test_a_table_of_a_file_shows_what_the_macros_compute(tmp_path, mode, ending):
    mesh = ("--mesh", plate(tmp_path / "plate.ply", (40.0, 30.0, 2.0)), "--width", 40, "--height", 40)
    table = tmp_path / f"table{ending}"
    skinglow("lut", *([] if mode == "existing" else [RIG]), "--mode", mode, "-o", table)
    strength = ("--strength", 0.25)
    skinglow("povray", RIG, *mesh, *strength, "--mode", mode, "-o", tmp_path / "computed")
    skinglow("povray", RIG, *mesh, *strength, "--lut", table, "-o", tmp_path / "read")
    computed, read = (render(tmp_path / name, "-A") for name in ("computed", "read"))
    assert computed.max() > 0.01
    np.testing.assert_allclose(read, computed, atol=2e-5 + 2**-11 * computed.max())


@pytest.mark.parametrize(("ending", "tall"), [(".glb", 2), (".ply", 1), (".obj", 1), (".stl", 1)])
def test_a_mesh_stands_as_its_format_says(tmp_path, ending, tall):
    """y is up in glTF; where the format does not say it is z, and --up overrules both."""
    mesh = plate(tmp_path / f"plate{ending}", (0.03, 0.06, 0.002))
    for up, axis in (([], tall), (["--up", "y"], 2), (["--up", "z"], 1)):
        told = skinglow("povray", RIG, "--mesh", mesh, "--unit", 1000, *up, "-o", tmp_path / "scene")
        assert "100 % of the vertices thinner than the table's 12 mm" in told
        text = (tmp_path / "scene" / "mesh.inc").read_text().partition("vertex_vectors")[2].partition("}")[0]
        vertices = np.array([word.split(",") for word in re.findall(r"<([^>]*)>", text)], float)
        assert np.argmax(np.ptp(vertices, axis=0)) == axis, up


def test_a_mesh_too_thick_to_glow_is_told(tmp_path):
    mesh = plate(tmp_path / "plate.ply", (4000.0, 3000.0, 200.0))
    told = skinglow("povray", RIG, "--mesh", mesh, "-o", tmp_path / "scene")
    assert "0 % of the vertices thinner" in told and "nothing glows: is --unit right?" in told
