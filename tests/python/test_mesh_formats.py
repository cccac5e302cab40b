"""Random meshes as other libraries, and the formats' own text, write them: vertices, triangles and thickness agree.

All coordinates are 64ths, which every format and number holds exactly, so that what is read must be exactly what was
written; their small offsets keep rays from hitting an edge, where either neighbor may answer.
"""

import meshio
import numpy as np
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mesh_files import in_order, measured

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
FLOATS = {"float": "f4", "double": "f8"}
few = settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
seeds = st.integers(0, 2**32 - 1)


def body_of(random, grain=64.0):
    """A closed body: a ball, a box or a cylinder with every vertex moved a little."""
    kind = random.integers(3)
    if kind == 0:
        body = trimesh.creation.icosphere(subdivisions=1, radius=40.0)
    elif kind == 1:
        body = trimesh.creation.box(random.integers(10, 80, 3)).subdivide()
    else:
        body = trimesh.creation.cylinder(radius=30.0, height=float(random.integers(10, 80)), sections=9)
    vertices = np.round((body.vertices + random.uniform(-1.0, 1.0, body.vertices.shape)) * grain) / grain
    return trimesh.Trimesh(vertices, body.faces, process=False)


def assert_same(result, vertices, faces):
    """Exactly the vertices and the triangles with their winding."""
    assert set(map(tuple, result.positions)) == set(map(tuple, np.asarray(vertices)[np.unique(faces)]))
    np.testing.assert_array_equal(result.corners(), in_order(np.asarray(vertices)[np.asarray(faces)]))


def assert_thickness_agrees(results):
    first, *others = [result.by_position() for result in results]
    for other in others:
        assert other.keys() == first.keys()
        np.testing.assert_allclose([other[at] for at in first], list(first.values()), rtol=1e-4)


def placement(random, mirrored, i):
    """A turn about an axis by a quarter, a scale of a power of two and a shift: what keeps 64ths exact."""
    matrix = np.eye(4)
    turn = np.eye(3)[random.permutation(3)] * random.choice([-1.0, 1.0], 3)
    if (np.linalg.det(turn) < 0.0) != mirrored:
        turn[:, 0] *= -1.0
    matrix[:3, :3] = turn * random.choice([0.5, 1.0, 2.0], 3)
    matrix[:3, 3] = [512.0 * i, *random.integers(-50, 50, 2)]
    return matrix


@few
@given(st.booleans(), seeds)
def test_scenes_of_turned_and_mirrored_instances(tmp_path, mirrored, seed):
    random = np.random.default_rng(seed)
    body = body_of(random)
    scene, expected = trimesh.Scene(), []
    for i in range(random.integers(1, 4)):
        matrix = placement(random, mirrored, i)
        scene.add_geometry(body, node_name=f"n{i}", geom_name="body", transform=matrix)
        expected.append(body.copy().apply_transform(matrix))  # flips the winding of what is mirrored
    whole = trimesh.util.concatenate(expected)
    scene.export(tmp_path / "scene.glb")
    paths = [tmp_path / "scene.glb"]
    for extension in ("obj", "ply", "stl"):
        paths.append(tmp_path / f"scene.{extension}")
        whole.export(paths[-1], **({"digits": 12} if extension == "obj" else {}))
    for name, options in (("meshio.obj", {}), ("meshio.ply", {"binary": False}), ("binary.ply", {})):
        paths.append(tmp_path / name)
        meshio.Mesh(whole.vertices, [("triangle", whole.faces)]).write(paths[-1], **options)
    results = [measured(path, "--unit", 1) for path in paths]
    for result in results:
        assert_same(result, whole.vertices, whole.faces)
    assert_thickness_agrees(results)


def ply_of(vertices, faces, random, draw):
    """A PLY of random number types, byte order, order of elements and further properties."""
    coding = draw(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
    endian = ">" if coding == "binary_big_endian" else "<"
    all_types = {**TYPES, **FLOATS}
    names = random.permutation(["x", "y", "z", "red"])
    types = [draw(st.sampled_from(sorted(FLOATS))) if name != "red" else "uchar" for name in names]
    count, index = draw(st.sampled_from(sorted(all_types))), draw(st.sampled_from(sorted(all_types)))
    name = draw(st.sampled_from(["vertex_indices", "vertex_index"]))
    columns = {"x": vertices[:, 0], "y": vertices[:, 1], "z": vertices[:, 2], "red": np.full(len(vertices), 7)}
    rows = [
        [np.array([columns[each][i]]).astype(endian + all_types[t]) for each, t in zip(names, types, strict=True)]
        for i in range(len(vertices))
    ]
    polygons = [
        [
            np.array([3]).astype("u1"),
            np.array([len(face)]).astype(endian + all_types[count]),
            np.array(face).astype(endian + all_types[index]),
        ]
        for face in faces
    ]
    elements = [
        (f"vertex {len(rows)}", [f"property {t} {n}" for n, t in zip(names, types, strict=True)], rows),
        (f"face {len(faces)}", ["property uchar flag", f"property list {count} {index} {name}"], polygons),
        ("edge 1", ["property list uchar short pair"], [[np.array([2], "u1"), np.array([0, 1], endian + "i2")]]),
    ]
    random.shuffle(elements)
    lines = ["ply", f"format {coding} 1.0", "comment element vertex 1", "obj_info by a test"]
    for element, properties, _ in elements:
        lines += [f"element {element}", *properties]
    header = "\n".join([*lines, "end_header\n"]).encode()
    entries = [entry for _, _, part in elements for entry in part]
    if coding == "ascii":
        text = "\n".join(" ".join(repr(float(x)) for values in entry for x in values) for entry in entries)
        return header + text.encode() + b"\n"
    return header + b"".join(values.tobytes() for entry in entries for values in entry)


@settings(few, max_examples=25)
@given(seeds, st.data())
def test_ply_of_every_type_coding_and_order(tmp_path, seed, data):
    random = np.random.default_rng(seed)
    body = body_of(random)
    (tmp_path / "body.ply").write_bytes(ply_of(body.vertices, body.faces, random, data.draw))
    assert_same(measured(tmp_path / "body.ply", rays=1), body.vertices, body.faces)


def prism(random):
    """A body of a concave outline: (vertices, polygons, volume)."""
    count = int(random.integers(5, 14))
    angle = 2.0 * np.pi * (np.arange(count) + random.uniform(-0.3, 0.3, count)) / count
    radius = random.uniform(8.0, 40.0, count)
    outline = np.round(np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1) * 64.0) / 64.0
    height = float(random.integers(2, 20))
    vertices = np.concatenate([np.insert(outline, 2, 0.0, axis=1), np.insert(outline, 2, height, axis=1)])
    ring = np.arange(count)
    sides = [[i, (i + 1) % count, count + (i + 1) % count, count + i] for i in range(count)]
    following = np.roll(outline, -1, axis=0)
    area = 0.5 * np.sum(outline[:, 0] * following[:, 1] - outline[:, 1] * following[:, 0])
    return vertices, [ring[::-1].tolist(), (count + ring).tolist(), *sides], area * height


@settings(few, max_examples=15)
@given(seeds, st.data())
def test_concave_polygons_are_filled_once(tmp_path, seed, data):
    random = np.random.default_rng(seed)
    vertices, faces, volume = prism(random)
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in vertices)
    text += "".join("f " + " ".join(f"{i - len(vertices)}//1" for i in face) + "\n" for face in faces)
    (tmp_path / "prism.obj").write_text(text)
    (tmp_path / "prism.ply").write_bytes(ply_of(vertices, faces, random, data.draw))
    results = [measured(tmp_path / f"prism.{extension}") for extension in ("obj", "ply")]
    for result in results:
        assert len(result.triangles) == sum(len(face) - 2 for face in faces)
        a, b, c = np.moveaxis(result.positions[result.triangles], 1, 0)
        assert np.isclose(np.sum(a * np.cross(b, c)) / 6.0, volume, rtol=1e-12)
        normals = np.cross(b - a, c - a)
        flat = np.all(a[:, 2:] == np.stack([b[:, 2], c[:, 2]], 1), axis=1)
        # Each triangle of the ends faces outwards, so that equal volumes mean no overlap.
        assert np.all(normals[flat, 2] * np.where(a[flat, 2] > 0.0, 1.0, -1.0) >= 0.0)
    np.testing.assert_array_equal(results[0].corners(), results[1].corners())
    assert_thickness_agrees(results)
