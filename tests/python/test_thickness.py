"""skinglow.thickness: closed forms, refusals, progress. Real heads: test_thickness_heads.py."""

import os
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skinglow._thickness import thickness


def sphere(radius, levels=4):
    """Octahedron, split and pushed out to the sphere."""
    v = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    t = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(levels):
        edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
        unique, index = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = index.reshape(3, -1) + len(v)
        middles = v[unique].mean(axis=1)
        v = np.concatenate([v, middles / np.linalg.norm(middles, axis=1, keepdims=True)])
        x, y, z = t.T
        t = np.concatenate([np.c_[x, a, c], np.c_[a, y, b], np.c_[c, b, z], np.c_[a, b, c]])
    return v * radius, t


def shell(outer, wall):
    v, t = sphere(outer)
    w, _ = sphere(outer - wall)
    return np.concatenate([v, w]), np.concatenate([t, t[:, ::-1] + len(v)])


def test_sphere_is_its_diameter_in_mm():
    vertices, triangles = sphere(2.0)
    result = thickness(vertices, triangles, unit_mm=50.35)
    assert result.shape == (len(vertices),)
    assert result.dtype == np.float64
    np.testing.assert_allclose(result, 4.0 * 50.35, rtol=5e-3)


def test_shell_is_its_wall_from_both_sides():
    np.testing.assert_allclose(thickness(*shell(10.0, 1.0)), 1.0, rtol=0.02)


def test_cavity_is_flesh_when_it_gets_no_light():
    vertices, triangles = shell(10.0, 1.0)
    result = thickness(vertices, triangles, min_sky_visibility=0.05)
    outer = len(vertices) // 2
    np.testing.assert_allclose(result[:outer], 20.0, rtol=0.01)
    np.testing.assert_allclose(result[outer:], 1.0, rtol=0.02)


def test_plane_is_its_boxes_diagonal():
    plane = [[0, 0, 0], [3, 0, 0], [3, 4, 0], [0, 4, 0]]
    np.testing.assert_allclose(thickness(plane, [[0, 1, 2], [0, 2, 3]], unit_mm=10), 50.0)


def test_nothing_gives_nothing():
    assert thickness(np.zeros((0, 3)), np.zeros((0, 3), int)).shape == (0,)


@settings(deadline=None, max_examples=25)
@given(
    scale=st.floats(1e-6, 1e6),
    offset=st.tuples(*[st.floats(-1e3, 1e3)] * 3),
    rays=st.integers(1, 100),
    flip=st.booleans(),
)
def test_sphere_of_any_size_anywhere(scale, offset, rays, flip):
    vertices, triangles = sphere(1.0, 3)
    moved = (vertices + np.array(offset)) * scale
    result = thickness(moved, triangles[:, ::-1] if flip else triangles, rays=rays)
    np.testing.assert_allclose(result / scale, 2.0, rtol=0.03)


@settings(deadline=None, max_examples=50)
@given(
    corners=st.lists(st.tuples(*[st.floats(-1e9, 1e9)] * 3), min_size=3, max_size=12),
    data=st.data(),
)
def test_any_mesh_gives_finite_values_within_its_box(corners, data):
    index = st.integers(0, len(corners) - 1)
    faces = data.draw(st.lists(st.tuples(index, index, index), min_size=1, max_size=20))
    vertices, triangles = np.array(corners), np.array(faces)
    openness = data.draw(st.sampled_from([0.0, 0.1]))
    result = thickness(vertices, triangles, rays=16, min_sky_visibility=openness)
    assert np.isfinite(result).all()
    assert (result >= 0).all()
    used = vertices[np.unique(triangles)]
    assert (result <= np.linalg.norm(np.ptp(used, axis=0)) * (1 + 1e-12)).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": np.zeros((4, 2))}, r"vertices .*\(4, 2\).*\(n, 3\)"),
        ({"vertices": "abc"}, "vertices"),
        ({"triangles": [[0, 1, 2, 3]]}, r"triangles .*\(1, 4\).*\(m, 3\)"),
        ({"triangles": [[0, 1, 18]]}, r"triangles\[0\] is \(0, 1, 18\).*below 18"),
        ({"triangles": [[0, 1, 2], [0, -1, 2]]}, r"triangles\[1\] is \(0, -1, 2\).*below 18"),
        ({"triangles": [[0, 1, 2**40]]}, r"triangles\[0\]"),
        ({"triangles": [[0.0, 1.0, 2.0]]}, "triangles .*float64.*integer"),
        ({"triangles": np.zeros((0, 3), int)}, "triangles is empty"),
        ({"unit_mm": 0.0}, "unit_mm is 0"),
        ({"unit_mm": -1.0}, "unit_mm is -1"),
        ({"unit_mm": float("nan")}, "unit_mm is nan"),
        ({"rays": 0}, "rays is 0; allowed: 1 to 65536"),
        ({"rays": -3}, "rays is -3"),
        ({"cone_half_angle": 2.0}, "cone_half_angle is 2"),
        ({"min_sky_visibility": 1.5}, "min_sky_visibility is 1.5"),
        ({"threads": -1}, "threads is -1"),
    ],
)
def test_refusals_name_argument_value_and_what_is_allowed(change, message):
    vertices, triangles = sphere(1.0, 1)
    arguments = {"vertices": vertices, "triangles": triangles} | change
    with pytest.raises(ValueError, match=message):
        thickness(**arguments)


def test_former_keyword_goes_on_working_with_a_warning():
    mesh = sphere(1.0, 2)
    with pytest.warns(DeprecationWarning, match="min_openness is now min_sky_visibility"):
        found = thickness(*mesh, min_openness=0.1)
    np.testing.assert_array_equal(found, thickness(*mesh, min_sky_visibility=0.1))
    with pytest.raises(TypeError, match="min_sky_visibility.*former name.*min_openness"):
        thickness(*mesh, min_openness=0.1, min_sky_visibility=0.1)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_vertex_that_is_not_finite_is_named(value):
    vertices, triangles = sphere(1.0, 1)
    vertices[11, 2] = value
    with pytest.raises(ValueError, match=r"vertices\[11\] is .*allowed: three finite numbers"):
        thickness(vertices, triangles)


def test_integer_types_and_float32_are_taken():
    vertices, triangles = sphere(1.0, 3)
    expected = thickness(vertices, triangles)
    for kind in (np.int32, np.uint32, np.uint64, np.int16):
        np.testing.assert_array_equal(thickness(vertices, triangles.astype(kind)), expected)
    # Rounded corners: a ray through an edge may leave by the triangle beside it.
    np.testing.assert_allclose(thickness(vertices.astype(np.float32), triangles), expected, 1e-3)


def test_progress_ascends_to_one_and_can_stop():
    vertices, triangles = sphere(1.0, 5)
    told = []
    thickness(vertices, triangles, progress=lambda done: told.append(done) or True)
    assert told == sorted(told)
    assert 0 <= told[0] < 1
    assert told[-1] == 1
    with pytest.raises(RuntimeError, match="cancelled"):
        thickness(vertices, triangles, progress=lambda done: done < 0.3)


def test_what_progress_raises_comes_through():
    def fail(done):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        thickness(*sphere(1.0, 3), progress=fail)


def test_same_on_any_number_of_threads():
    mesh = shell(1.0, 0.3)
    expected = thickness(*mesh, threads=1)
    for threads in (0, 2, 5):
        np.testing.assert_array_equal(thickness(*mesh, threads=threads), expected)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc/self/maps")
def test_embree_is_loaded_by_the_first_call_and_not_before():
    code = """
import sys, skinglow
assert "skinglow._rays" not in sys.modules
assert "embree" not in open("/proc/self/maps").read()
skinglow.thickness([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
assert "skinglow._rays" in sys.modules
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=os.environ)
    assert done.returncode == 0, done.stderr
