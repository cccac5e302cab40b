"""Mesh files as Blender's importers read them and as the command line does: extents and thickness agree."""

import json
import os
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hosts import host_named

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))


def measure(path: Path) -> np.ndarray:
    """Rows of x, y, z, thickness."""
    output = path.with_suffix(".csv")
    subprocess.run([PROGRAM, "thickness", path, "--unit", "1", "-o", output], check=True, capture_output=True)
    rows = [line.split(",")[1:] for line in output.read_text().splitlines() if line[0] not in "#v"]
    return np.array(rows, float)


def glb(path: Path, document: dict, arrays: list[tuple[np.ndarray, str]]) -> None:
    """A GLB of one buffer with an accessor for each array."""
    codes = {"int8": 5120, "uint8": 5121, "int16": 5122, "uint16": 5123, "uint32": 5125, "float32": 5126}
    blob, views, accessors = b"", [], []
    for array, kind in arrays:
        data = np.ascontiguousarray(array).tobytes()
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        accessor = {"bufferView": len(views) - 1, "componentType": codes[array.dtype.name], "type": kind}
        accessor["count"] = array.size // {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        if kind == "VEC3":
            accessor["min"], accessor["max"] = array.min(0).tolist(), array.max(0).tolist()
        accessors.append(accessor)
        blob += data + b"\0" * (-len(data) % 4)
    whole = {"asset": {"version": "2.0"}, "scene": 0, "bufferViews": views, "accessors": accessors, **document}
    whole["buffers"] = [{"byteLength": len(blob)}]
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def write_files(folder: Path) -> list[Path]:
    body = trimesh.creation.box((40.0, 30.0, 2.0)).subdivide().subdivide()
    for extension in ("obj", "ply", "stl", "glb"):
        body.export(folder / f"box.{extension}")
    corners = [(30, 0), (30, 10), (10, 10), (10, 30), (0, 30), (0, 0)]
    points = [(x, y, z) for z in (2, -2) for x, y in corners]
    faces = [(0, 1, 2, 3, 4, 5), (11, 10, 9, 8, 7, 6), *((i, 6 + i, 6 + (i + 1) % 6, (i + 1) % 6) for i in range(6))]
    (folder / "ell.obj").write_text(
        "o left ear\n"
        + "".join(f"v {x} {y} {z}\n" for x, y, z in points)
        + "".join("f " + " ".join(str(i - 12) for i in face) + "\n" for face in faces)
    )
    (folder / "ell.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 8\nproperty list uchar int vertex_indices\nend_header\n"
        + "".join(f"{x} {y} {z}\n" for x, y, z in points)
        + "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
    )
    positions, indices = (body.vertices.astype(np.float32), "VEC3"), (body.faces.astype(np.uint32), "SCALAR")
    plain = {"attributes": {"POSITION": 0}, "indices": 1}
    glb(
        folder / "mirrored.glb",
        {
            "meshes": [{"primitives": [plain]}],
            "nodes": [{"mesh": 0, "translation": [100, 0, 0]}, {"mesh": 0, "scale": [-1, 2, 1]}],
            "scenes": [{"nodes": [0, 1]}],
        },
        [positions, indices],
    )
    offsets = np.zeros_like(positions[0])
    offsets[:, 2] = positions[0][:, 2]
    glb(
        folder / "morphed.glb",
        {
            "meshes": [{"primitives": [{**plain, "targets": [{"POSITION": 2}]}], "weights": [0.5]}],
            "nodes": [{"mesh": 0}],
            "scenes": [{"nodes": [0]}],
        },
        [positions, indices, (offsets, "VEC3")],
    )
    count = len(body.vertices)
    joints, weights = np.zeros((count, 4), np.uint8), np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    glb(
        folder / "skinned.glb",
        {
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}]}],
            "skins": [{"joints": [1], "inverseBindMatrices": 4}],
            "nodes": [{"mesh": 0, "skin": 0, "scale": [3, 3, 3]}, {}, {"scale": [0.5, 0.5, 0.5], "children": [1]}],
            "scenes": [{"nodes": [0, 2]}],
        },
        [positions, indices, (joints, "VEC4"), (weights, "VEC4"), (np.eye(4, dtype=np.float32), "MAT4")],
    )
    quantized = np.round(body.vertices * 100).astype(np.int16)
    padded = np.zeros((count, 3), np.int16)
    padded[:] = quantized
    glb(
        folder / "quantized.glb",
        {
            "extensionsUsed": ["KHR_mesh_quantization"],
            "extensionsRequired": ["KHR_mesh_quantization"],
            "meshes": [{"primitives": [plain]}],
            "nodes": [{"mesh": 0, "scale": [0.01, 0.01, 0.01]}],
            "scenes": [{"nodes": [0]}],
        },
        [(padded, "VEC3"), indices],
    )
    return sorted(path for path in folder.iterdir() if path.suffix in (".obj", ".ply", ".stl", ".glb"))


def test_blender_and_the_command_line_read_the_same(tmp_path):
    host = host_named("4.5")
    host.require()
    files = write_files(tmp_path)
    results = tmp_path / "blender.npz"
    script = Path(__file__).with_name("import_meshes.py")
    done = subprocess.run(
        [host.path, script, results, *files],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ},
    )
    assert results.exists(), done.stdout + done.stderr
    (tmp_path / "again").mkdir()
    with np.load(results) as blender:
        assert len(blender.files) == len(files) == 10
        for path in files:
            theirs = blender[str(path)]
            copy = tmp_path / "again" / f"{path.name}.ply"
            trimesh.Trimesh(theirs.reshape(-1, 3), np.arange(theirs.size // 3).reshape(-1, 3), process=True).export(
                copy
            )
            ours, again = measure(path), measure(copy)
            np.testing.assert_allclose(ours[:, :3].min(0), again[:, :3].min(0), atol=1e-3, err_msg=path.name)
            np.testing.assert_allclose(ours[:, :3].max(0), again[:, :3].max(0), atol=1e-3, err_msg=path.name)
            assert np.median(ours[:, 3]) == pytest.approx(np.median(again[:, 3]), rel=1e-3), path.name
            assert ours[:, 3].max() == pytest.approx(again[:, 3].max(), rel=1e-2), path.name
