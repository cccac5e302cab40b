"""Mesh files far from the origin, of unusual size, open, and outputs over them, by the command line."""

import base64
import json
import os

import numpy as np
import pytest
import trimesh
from mesh_files import ROOT, measured, peak_memory, run

MEGABYTE = 2**20


def plate(offset=(0.0, 0.0, 0.0)):
    body = trimesh.creation.box((40.0, 40.0, 2.0)).subdivide().subdivide()
    return trimesh.Trimesh(body.vertices + np.array(offset), body.faces, process=False)


def write_ply(path, vertices, faces, kind):
    """As text, with every digit, or binary of that type."""
    header = f"ply\nformat {{}} 1.0\nelement vertex {len(vertices)}\n"
    header += "".join(f"property {kind} {axis}\n" for axis in "xyz")
    header += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    if path.stem.endswith("text"):
        rows = [" ".join(map(repr, map(float, row))) for row in vertices] + [f"3 {a} {b} {c}" for a, b, c in faces]
        path.write_text(header.format("ascii") + "\n".join(rows) + "\n")
        return
    face = np.zeros(len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    face["count"], face["corners"] = 3, faces
    numbers = vertices.astype({"float": "<f4", "double": "<f8"}[kind])
    path.write_bytes(header.format("binary_little_endian").encode() + numbers.tobytes() + face.tobytes())


def write_stl_text(path, vertices, faces):
    loops = ("".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in vertices[face].tolist()) for face in faces)
    facets = "".join(f"facet normal 0 0 0\nouter loop\n{loop}endloop\nendfacet\n" for loop in loops)
    path.write_text(f"solid far\n{facets}endsolid far\n")


def write_far_files(folder, near, offset):
    """The plate in all formats, its offset in a node's transform where they have one."""
    far = near.vertices + offset
    obj = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in far.tolist())
    (folder / "far.obj").write_text(obj + "".join(f"f {a} {b} {c}\n" for a, b, c in near.faces + 1))
    for name, kind in (("double_text", "double"), ("float_text", "float"), ("double", "double"), ("float", "float")):
        write_ply(folder / f"far_{name}.ply", far, near.faces, kind)
    write_stl_text(folder / "far_text.stl", far, near.faces)
    trimesh.Trimesh(far, near.faces, process=False).export(folder / "far.stl")
    trimesh.Trimesh(far, near.faces, process=False).export(folder / "far_vertices.glb")
    scene = trimesh.Scene()
    scene.add_geometry(near, transform=trimesh.transformations.translation_matrix(offset))
    scene.export(folder / "far.glb")
    for name, content in trimesh.exchange.gltf.export_gltf(scene).items():
        (folder / ("far.gltf" if name == "model.gltf" else name)).write_bytes(content)


def test_five_kilometers_from_the_origin(tmp_path):
    """In mm. Binary STL, PLY of floats and the vertices of glTF have a grain of 0.5 mm there: a plate on that grain is
    read as it is, and another one as the file has it."""
    offset = np.array((5e6, -5e6, 5e6))
    near = plate()
    wanted = {}
    for name, body in (("any", near), ("grain", trimesh.Trimesh(np.round(near.vertices * 2) / 2, near.faces))):
        (tmp_path / name).mkdir()
        body.export(tmp_path / name / "near.ply")
        wanted[name] = measured(tmp_path / name / "near.ply", rays=32).by_position()
        write_far_files(tmp_path / name, body, offset)
    coarse = {"far_float.ply", "far.stl", "far_vertices.glb"}
    files = {path.name for path in (tmp_path / "any").glob("far*.[gops]*")}
    assert len(files) == 10
    for name in sorted(files):
        kind = "grain" if name in coarse else "any"
        result = measured(tmp_path / kind / name, "--unit", 1, rays=32)
        assert len(result.positions) == len(wanted[kind])
        places = np.array(list(wanted[kind]))
        match = np.linalg.norm(places[:, None] - (result.positions - offset)[None], axis=2).argmin(axis=1)
        mm = list(wanted[kind].values())
        np.testing.assert_allclose(result.thickness[match], mm, rtol=1e-3, err_msg=name)


def test_what_found_no_far_side_is_told(tmp_path):
    sheet = trimesh.Trimesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    sheet.export(tmp_path / "sheet.ply")
    done = run("thickness", tmp_path / "sheet.ply", "-o", tmp_path / "t.csv")
    assert "4 of 4 vertices (100 %) found no far side" in done.stderr
    plate().export(tmp_path / "plate.ply")
    assert run("thickness", tmp_path / "plate.ply", "-o", tmp_path / "t.csv").stderr == ""


def write_round_polygon(folder, corners=900_000):
    angle = 2.0 * np.pi * np.arange(corners) / corners
    radius = np.where(np.arange(corners) % 2 == 0, 100.0, 99.9)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(corners)], 1)
    lines = "\n".join(f"v {x:.6f} {y:.6f} {z:.0f}" for x, y, z in points)
    path = folder / "polygon.obj"
    path.write_text(lines + "\nf " + " ".join(map(str, range(1, corners + 1))) + "\n")
    return path


def write_gltf(path, nodes, **more):
    """A triangle, shown by the nodes."""
    data = np.eye(3, dtype="<f4").tobytes()
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36, "uri": "data:;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}, *more.pop("accessors", [])],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": nodes,
        **more,
    }
    path.write_text(json.dumps(document))
    return path


def test_memory_is_in_proportion_to_the_file(tmp_path):
    """Ten times the file's size, what the program itself takes, and 16 MB."""
    itself, _ = peak_memory("thickness", plate_file(tmp_path), "-o", tmp_path / "t.ply", "--rays", 1)
    instanced = {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}
    zeros = {"componentType": 5126, "count": 3_000_000, "type": "VEC3"}
    deep = [{"children": [i + 1]} for i in range(30_000)] + [{"mesh": 0}]
    twice = [{"children": [i + 1, i + 1]} for i in range(30)] + [{"mesh": 0}]
    cases = [
        (write_round_polygon(tmp_path), 0, "no far side"),
        (write_gltf(tmp_path / "deep.gltf", deep), 0, "no far side"),
        (write_gltf(tmp_path / "twice.gltf", twice), 2, "the child of a node twice"),
        (write_gltf(tmp_path / "instances.gltf", [instanced], accessors=[zeros]), 2, "repeats its meshes"),
        (write_gltf(tmp_path / "zeros.gltf", [instanced], accessors=[{**zeros, "count": 10**15}]), 2, "no data"),
        (write_gltf(tmp_path / "lists.gltf", [{"mesh": 0}], extras=[[]] * 4_100_000), 2, "4000000 values"),
    ]
    for path, code, words in cases:
        used, said = peak_memory("thickness", path, "-o", tmp_path / "t.ply", "--rays", 1, code=code)
        assert words in said
        assert used < itself + 10 * path.stat().st_size + 16 * MEGABYTE, path.name


def plate_file(folder):
    plate().export(folder / "plate.ply")
    return folder / "plate.ply"


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/stdin", "/proc/self/mem"])
def test_devices_are_refused_at_once(tmp_path, name):
    for extension in ("obj", "ply", "glb", "stl"):
        path = tmp_path / f"device.{extension}"
        path.symlink_to(name)
        done = run("thickness", path, "-o", tmp_path / "t.csv", code=2)
        assert done.stderr.startswith("skinglow: file ") and done.stderr.count("\n") == 1


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
