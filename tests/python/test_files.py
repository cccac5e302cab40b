"""Files of every format as other libraries write them, read by the command line: extents, triangles, thickness."""

import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))
PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}


def run(*arguments, code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    return done


def measured(path, *options):
    """Positions and thickness by vertex, and the number of triangles."""
    output = path.with_name("out.csv")
    done = run("thickness", path, "-o", output, "--rays", 16, *options)
    rows = [line for line in output.read_text().splitlines() if line[0] not in "#v"]
    table = np.array([row.split(",") for row in rows], float)
    return table[:, 1:4], table[:, 4], int(done.stdout.split(" triangles")[0].split()[-1])


def nearest(wanted, positions):
    """For each wanted position the index of the nearest one. Sorting would swap what rounding brings close."""
    return np.linalg.norm(wanted[:, None] - positions[None], axis=2).argmin(axis=1)


def assert_same(mesh, result, tolerance=1e-5):
    """The vertices and triangles that were written."""
    positions, _thickness, triangles = result
    assert triangles == len(mesh.faces)
    assert len(positions) == len(mesh.vertices)
    match = nearest(np.asarray(mesh.vertices), positions)
    assert len(set(match)) == len(match)
    np.testing.assert_allclose(positions[match], mesh.vertices, atol=tolerance)


def solid(kind, size):
    """A closed body of whole-number corners, so that every number type holds it."""
    if kind == "ball":
        body = trimesh.creation.icosphere(subdivisions=1, radius=100.0)
    elif kind == "box":
        body = trimesh.creation.box(size)
    else:
        body = trimesh.creation.cylinder(radius=40.0, height=float(size[2]), sections=12)
    vertices = np.round(body.vertices)
    return trimesh.Trimesh(vertices, body.faces, process=False)


bodies = st.builds(
    solid,
    st.sampled_from(["ball", "box", "cylinder"]),
    st.tuples(*[st.integers(5, 60).map(lambda half: 2 * half)] * 3),
)


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(bodies, st.booleans(), st.integers(0, 2**32 - 1))
def test_scenes_of_transformed_and_mirrored_instances(tmp_path, body, mirrored, seed):
    random = np.random.default_rng(seed)
    scene = trimesh.Scene()
    expected = []
    for i in range(int(random.integers(1, 4))):
        transform = trimesh.transformations.random_rotation_matrix(random.random(3))
        scale = random.uniform(0.5, 2.0, 3) * ([-1.0, 1.0, 1.0] if mirrored else [1.0, 1.0, 1.0])
        transform[:3, :3] = transform[:3, :3] @ np.diag(scale)
        transform[:3, 3] = [1000.0 * i, *random.uniform(-50, 50, 2)]
        scene.add_geometry(body, node_name=f"n{i}", geom_name="body", transform=transform)
        expected.append(body.copy().apply_transform(transform))
    whole = trimesh.util.concatenate(expected)
    results = {}
    for extension in ("glb", "obj", "ply", "stl"):
        path = tmp_path / f"scene.{extension}"
        if extension == "glb":
            scene.export(path)
        else:
            whole.export(path)
        results[extension] = measured(path, "--unit", 1)
        assert_same(whole, results[extension], tolerance=2e-3)
    for extension, (positions, thickness, _triangles) in results.items():
        match = nearest(results["glb"][0], positions)
        # Float32 lets single ones of the 16 rays pass an edge of these coarse bodies on its other side.
        off = np.abs(thickness[match] / results["glb"][1] - 1.0)
        assert np.quantile(off, 0.9) < 2e-3, extension
        assert off.max() < 0.15, extension


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(bodies, st.sampled_from(sorted(PLY_TYPES)), st.sampled_from("<>"), st.booleans(), st.data())
def test_ply_of_every_type_order_and_byte_order(tmp_path, body, index_type, endian, faces_first, data):
    types = {**PLY_TYPES, "float": "f4", "double": "f8"}
    holding = [name for name in types if name in ("short", "int", "float", "double")]
    columns = [data.draw(st.sampled_from(holding)) for _ in range(3)]
    vertex = np.zeros(len(body.vertices), [(axis, endian + types[t]) for axis, t in zip("xyz", columns, strict=True)])
    for i, axis in enumerate("xyz"):
        vertex[axis] = body.vertices[:, i]
    face = np.zeros(len(body.faces), [("flag", "u1"), ("n", "u1"), ("i", endian + PLY_TYPES[index_type], 3)])
    face["n"], face["i"] = 3, body.faces
    header = {
        "vertex": "\n".join(
            [f"element vertex {len(vertex)}", *(f"property {t} {a}" for a, t in zip("xyz", columns, strict=True))]
        ),
        "face": f"element face {len(face)}\nproperty uchar flag\nproperty list uchar {index_type} vertex_indices",
    }
    order = ["face", "vertex"] if faces_first else ["vertex", "face"]
    blobs = {"vertex": vertex.tobytes(), "face": face.tobytes()}
    path = tmp_path / "body.ply"
    coding = "little" if endian == "<" else "big"
    text = "\n".join([f"ply\nformat binary_{coding}_endian 1.0", *(header[name] for name in order), "end_header\n"])
    path.write_bytes(text.encode() + b"".join(blobs[name] for name in order))
    assert_same(body, measured(path))


def plate(offset=(0.0, 0.0, 0.0)):
    body = trimesh.creation.box((40.0, 40.0, 2.0)).subdivide().subdivide()
    return trimesh.Trimesh(body.vertices + np.array(offset), body.faces, process=False)


def test_five_kilometers_from_the_origin(tmp_path):
    near = plate()
    near.export(tmp_path / "near.ply")
    origin, wanted, _count = measured(tmp_path / "near.ply")
    offset = np.array((5e6, -5e6, 5e6))
    far = plate(offset)
    (tmp_path / "far.obj").write_text(
        "".join(f"v {x:.9f} {y:.9f} {z:.9f}\n" for x, y, z in far.vertices)
        + "".join(f"f {a} {b} {c}\n" for a, b, c in far.faces + 1)
    )
    rows = "".join(f"{x:.9f} {y:.9f} {z:.9f}\n" for x, y, z in far.vertices)
    faces = "".join(f"3 {a} {b} {c}\n" for a, b, c in far.faces)
    (tmp_path / "far.ply").write_text(
        f"ply\nformat ascii 1.0\nelement vertex {len(far.vertices)}\nproperty double x\nproperty double y\n"
        f"property double z\nelement face {len(far.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        f"{rows}{faces}"
    )
    scene = trimesh.Scene()
    scene.add_geometry(near, transform=trimesh.transformations.translation_matrix(offset))
    scene.export(tmp_path / "far.glb")
    for name in ("far.obj", "far.ply", "far.glb"):
        positions, thickness, _count = measured(tmp_path / name, "--unit", 1)
        match = nearest(origin, positions - offset)
        np.testing.assert_allclose(thickness[match], wanted, rtol=1e-3, err_msg=name)


def test_what_found_no_far_side_is_told(tmp_path):
    sheet = trimesh.Trimesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    sheet.export(tmp_path / "sheet.ply")
    done = run("thickness", tmp_path / "sheet.ply", "-o", tmp_path / "t.csv")
    assert "4 of 4 vertices (100 %) found no far side" in done.stderr
    plate().export(tmp_path / "plate.ply")
    assert run("thickness", tmp_path / "plate.ply", "-o", tmp_path / "t.csv").stderr == ""


@pytest.mark.parametrize("name", ["pipe.ply", "pipe.obj", "pipe.glb", "pipe.stl"])
def test_pipes_are_refused_at_once(tmp_path, name):
    os.mkfifo(tmp_path / name)
    assert "is not a file" in run("thickness", tmp_path / name, "-o", tmp_path / "t.csv", code=2).stderr


def test_outputs_over_inputs_are_refused(tmp_path):
    head = tmp_path / "head.ply"
    plate().export(head)
    before = head.read_bytes()
    os.link(head, tmp_path / "hard.ply")
    os.symlink(head, tmp_path / "link.ply")
    for output in ("head.ply", "hard.ply", "link.ply", "./../" + tmp_path.name + "/head.ply"):
        assert "is read as" in run("thickness", head, "-o", tmp_path / output, code=2).stderr
    rig = tmp_path / "mesh.inc"
    rig.write_bytes((ROOT / "tests/data/table1.json").read_bytes())
    done = run("povray", rig, "--mesh", head, "-o", tmp_path, code=2)
    assert "mesh.inc" in done.stderr and json.loads(rig.read_text())
    assert head.read_bytes() == before
