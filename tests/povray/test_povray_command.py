"""`skinglow povray`: the scene means what the mesh's format and the table say."""

import json
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
        vertices = vectors((tmp_path / "scene" / "mesh.inc").read_text(), "vertex_vectors")
        assert np.argmax(np.ptp(vertices, axis=0)) == axis, up


def test_a_mesh_too_thick_to_glow_is_told(tmp_path):
    mesh = plate(tmp_path / "plate.ply", (4000.0, 3000.0, 200.0))
    told = skinglow("povray", RIG, "--mesh", mesh, "-o", tmp_path / "scene")
    assert "0 % of the vertices thinner" in told and "nothing glows: is --unit right?" in told


def vectors(text: str, name: str, numbers: type = float) -> np.ndarray:
    """The vectors of that part of a mesh2."""
    part = text.partition(f"{name} {{")[2].partition("}")[0]
    return np.array([word.split(",") for word in re.findall(r"<([^>]*)>", part)], numbers)


@pytest.mark.parametrize("ending", [".obj", ".stl", ".glb"])
def test_a_surface_is_smooth_but_for_sharp_edges(tmp_path, ending):
    """Files are read without normals. Facets of a ball are seen for what no skin has; a plate has edges."""
    ball = trimesh.creation.icosphere(subdivisions=2, radius=10.0)
    for body, name in ((ball, "ball"), (trimesh.creation.box(extents=(20, 20, 4)).subdivide(), "plate")):
        body.export(tmp_path / f"{name}{ending}")
        told = ("--mesh", tmp_path / f"{name}{ending}", "--unit", 1)
        skinglow("povray", RIG, *told, "--surface", 0.8, 0.8, 0.8, "-o", tmp_path / name)
        text = (tmp_path / name / "mesh.inc").read_text()
        corners = vectors(text, "vertex_vectors")[vectors(text, "face_indices", int)]
        normals = vectors(text, "normal_vectors")[vectors(text, "normal_indices", int)]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
        want = corners / 10.0 if name == "ball" else np.broadcast_to(flat[:, None], corners.shape)
        np.testing.assert_allclose(normals, want, atol=0.02 if name == "ball" else 1e-6)
    skinglow("povray", RIG, "--mesh", tmp_path / f"ball{ending}", "-o", tmp_path / "glow")
    assert "normal" not in (tmp_path / "glow" / "mesh.inc").read_text()


def test_what_pov_ray_has_not_is_told(tmp_path):
    light = {"kind": "AREA", "position": [0, 0, 90], "size_x": 10, "size_y": 10, "spread": 1.0}
    (tmp_path / "rig.json").write_text(json.dumps({"skinglow_rig": 1, "lights": [light]}))
    scene = ("povray", tmp_path / "rig.json", "--mesh", plate(tmp_path / "plate.ply", (40.0, 30.0, 2.0)))
    for options, told in ((["--surface", 1, 1, 1], "spread of an area light is a cone"), ([], "")):
        command = [PROGRAM, *map(str, (*scene, *options, "-o", tmp_path / "scene"))]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert told in done.stderr and bool(told) == bool(done.stderr)


@pytest.mark.parametrize(("option", "value"), [("--field-of-view", 180), ("--width", 0), ("--height", 0)])
def test_a_camera_is_refused_by_its_option(tmp_path, option, value):
    mesh = plate(tmp_path / "plate.ply", (40.0, 30.0, 2.0))
    command = [PROGRAM, "povray", RIG, "--mesh", mesh, option, str(value), "-o", tmp_path / "scene"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stderr.startswith(f"skinglow: {option} is {value}; allowed: "), done.stderr
