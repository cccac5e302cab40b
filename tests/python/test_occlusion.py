"""skinglow.Occluders: closed forms, meshes left out, extremes, refusals. More: tests/rays/visibility_test.cpp."""

import os
import subprocess
import sys

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given, settings
from hypothesis import strategies as st

UP = np.array([[0.0, 0.0, 1.0]])
ORIGIN = np.zeros((1, 3))
QUAD = np.array([[0, 1, 2], [0, 2, 3]])


def sheet(low, high, z):
    """A level rectangle from corner (x, y) to corner (x, y)."""
    (a, b), (c, d) = low, high
    return np.array([[a, b, z], [c, b, z], [c, d, z], [a, d, z]], float), QUAD


def ball(radius=1.0, middle=(0.0, 0.0, 0.0), rings=24):
    """Latitude and longitude."""
    t, p = np.meshgrid(np.linspace(0, np.pi, rings), np.linspace(0, 2 * np.pi, 2 * rings), indexing="ij")
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1)
    index = np.arange(t.size).reshape(t.shape)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.concatenate([np.stack(x, -1).reshape(-1, 3) for x in ((a, b, c), (a, c, d))])
    return points.reshape(-1, 3) * radius + np.array(middle), triangles


def seen(occluders, light, points=ORIGIN, normals=UP, **options):
    return occluders.visible_fraction([light], points, normals, **options).mean[0]


def test_half_plane_leaves_half_of_a_disk():
    disk = sg.Light(kind="AREA", area_shape="DISK", size_x=1, size_y=1, position=(0, 0, 2))
    wall = sg.Occluders([sheet((0, -99), (99, 99), 1)])
    assert abs(seen(wall, disk, samples=4096) - 0.5) < 1e-3
    assert abs(seen(wall, disk) - 0.5) < 0.07


def test_sphere_between_hides_a_lamp_and_behind_it_does_not():
    lamp = sg.Light(position=(0, 0, 2))
    assert seen(sg.Occluders([ball(0.3, (0, 0, 1))]), lamp) == 0
    assert seen(sg.Occluders([ball(0.3, (0, 0, 2.4))]), lamp) == 1
    assert seen(sg.Occluders([ball(0.3, (0.4, 0, 1))]), lamp) == 1
    assert seen(sg.Occluders([]), lamp) == 1


def test_own_mesh_is_left_out():
    skin, wall = ball(1.0), sheet((-9, -9), (9, 9), 3)
    scene = sg.Occluders([skin, wall])
    assert len(scene) == 2
    assert scene.triangles > 2
    points, normals = sg.far_side([[0.1, 0.05, 1.0]], [[0, 0, 1.0]], 1.5)  # within the ball, facing down
    np.testing.assert_allclose(points, [[0.1, 0.05, -0.5]])
    np.testing.assert_allclose(normals, [[0, 0, -1]])
    below, above = sg.Light(position=(0, 0, -4)), sg.Light(position=(0, 0, 4))
    assert seen(scene, below, points, normals) == 0
    assert seen(scene, below, points, normals, excluded=[0]) == 1
    assert seen(scene, above, points, -normals, excluded=[0]) == 0
    assert seen(scene, above, points, -normals, excluded=[0, 1]) == 1


def test_far_side_is_where_its_irradiance_is_taken():
    random = np.random.default_rng(4)
    vertices, normals, depth = *random.normal(size=(2, 20, 3)), random.uniform(0, 2, 20)
    points, facing = sg.far_side(vertices, normals, depth)
    np.testing.assert_allclose(points, vertices - depth[:, None] * normals / np.linalg.norm(normals, axis=1)[:, None])
    np.testing.assert_allclose(np.linalg.norm(facing, axis=1), 1)
    lamp = [sg.Light(position=(0, 0, 5), power=9)]
    np.testing.assert_allclose(
        sg.surface_irradiance(lamp, points, facing), sg.far_side_irradiance(lamp, vertices, normals, depth)
    )
    with pytest.raises(ValueError, match=r"depth\[1\] is -1"):
        sg.far_side(vertices[:2], normals[:2], [0, -1])


def test_mean_counts_points_by_what_the_lamp_would_bring():
    lamp = sg.Light(position=(0, 0, 2))
    points, normals = np.array([[0, 0, 0], [3, 0, 0], [0, 0, 0]], float), np.array([[0, 0, 1], [-1, 0, 1], [0, 0, -1]])
    found = sg.Occluders([sheet((1, -9), (9, 9), 1)]).visible_fraction([lamp], points, normals)
    np.testing.assert_array_equal(found.at_points, [[1], [0], [1]])
    brought = sg.surface_irradiance([lamp], points, normals)[:, 0]
    np.testing.assert_allclose(found.mean, brought[0] / brought[:2].sum())


def test_rows_are_points_and_columns_lamps():
    lamps = [sg.Light(position=(0, 0, 2)), sg.Light(position=(0, 0, 0.5)), sg.Light(kind="SUN")]
    found = sg.Occluders([sheet((1, -9), (9, 9), 1)]).visible_fraction(lamps, [[0, 0, 0], [3, 0, 0]], [[0, 0, 1]] * 2)
    np.testing.assert_array_equal(found.at_points, [[1, 1, 1], [0, 1, 0]])
    assert found.mean.shape == (3,)
    empty = sg.Occluders([ball()]).visible_fraction([], np.zeros((0, 3)), np.zeros((0, 3)))
    assert empty.mean.shape == (0,)
    assert empty.at_points.shape == (0, 0)


def brute_force(vertices, triangles, start, end):
    """Which ways meet a triangle (Moeller and Trumbore), and how near each is to deciding otherwise."""
    a, e1, e2 = vertices[triangles[:, 0]], *(vertices[triangles[:, k]] - vertices[triangles[:, 0]] for k in (1, 2))
    d = (end - start)[:, None]
    p = np.cross(d, e2)
    det = (e1 * p).sum(-1)
    s = start[:, None] - a
    q = np.cross(s, e1)
    u, v, w = (s * p).sum(-1) / det, (d * q).sum(-1) / det, (e2 * q).sum(-1) / det
    inside = np.min([u, v, 1 - u - v, w, 1 - w], axis=0)
    return (inside > 0).any(1), np.abs(inside).min(1)


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**32 - 1), size=st.floats(1e-3, 1e6), far=st.floats(0, 1e3))
def test_agrees_with_brute_force_at_any_size_anywhere(seed, size, far):
    random = np.random.default_rng(seed)
    vertices = (random.uniform(-1, 1, (60, 3)) + far) * size
    triangles = np.arange(60).reshape(-1, 3)
    start, end = (random.uniform(-2, 2, (2, 50, 3)) + far) * size
    hit, margin = brute_force(vertices, triangles, start, end)
    scene = sg.Occluders([(vertices, triangles)])
    shares = [seen(scene, sg.Light(position=b), a[None], (b - a)[None]) for a, b in zip(start, end, strict=True)]
    clear = margin > 1e-3
    np.testing.assert_array_equal(np.array(shares)[clear], 1.0 - hit[clear])


@settings(deadline=None, max_examples=50)
@given(
    corners=st.lists(st.tuples(*[st.floats(-1e300, 1e300)] * 3), min_size=3, max_size=9),
    kind=st.sampled_from(["POINT", "SUN", "SPOT", "AREA"]),
    position=st.tuples(*[st.floats(-1e300, 1e300)] * 3),
    point=st.tuples(*[st.floats(-1e300, 1e300)] * 3),
    size=st.floats(0, 1e200),
    power=st.floats(-1e20, 1e20),
)
def test_anything_finite_gives_a_share(corners, kind, position, point, size, power):
    triangles = [(i, (i + 1) % len(corners), (i + 2) % len(corners)) for i in range(len(corners))]
    light = sg.Light(kind=kind, position=position, radius=size, size_x=size, power=power, sun_angle=1.0)
    found = sg.Occluders([(corners, triangles)]).visible_fraction([light], [point], UP)
    assert 0 <= found.mean[0] <= 1
    assert 0 <= found.at_points[0, 0] <= 1


def test_same_on_any_number_of_threads():
    random = np.random.default_rng(3)
    scene = sg.Occluders([ball(0.5, random.normal(size=3) * 2) for _ in range(8)])
    lamps = [sg.Light(position=random.normal(size=3) * 4, radius=0.5) for _ in range(20)]
    points, normals = random.normal(size=(2, 30, 3))
    expected = scene.visible_fraction(lamps, points, normals, threads=1)
    assert 0.05 < (expected.at_points < 1).mean()
    for threads in (0, 2, 5):
        found = scene.visible_fraction(lamps, points, normals, threads=threads)
        np.testing.assert_array_equal(found.at_points, expected.at_points)
        np.testing.assert_array_equal(found.mean, expected.mean)


@pytest.mark.parametrize(
    ("meshes", "message"),
    [
        ([(np.full((3, 3), np.nan), [[0, 1, 2]])], r"meshes\[0\] vertices\[0\] is .*finite"),
        ([ball(), (np.zeros((3, 3)), [[0, 1, 3]])], r"meshes\[1\] triangles\[0\] is \(0, 1, 3\).*below 3"),
        ([(np.zeros((3, 3)), [[0, 1, -2]])], r"meshes\[0\] triangles\[0\]"),
        ([(np.zeros((3, 2)), [[0, 1, 2]])], r"meshes\[0\] vertices .*\(n, 3\)"),
        ([(np.zeros((3, 3)), [[0.0, 1.0, 2.0]])], r"meshes\[0\] triangles .*integer"),
        ([ball(), 7], r"meshes\[1\] is .*int.*pair"),
        ([ball() + ball()], r"meshes\[0\] is .*tuple.*pair"),
    ],
)
def test_bad_meshes_are_named(meshes, message):
    with pytest.raises(ValueError, match=message):
        sg.Occluders(meshes)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": [[0, np.inf, 0]]}, r"points\[0\]"),
        ({"normals": [[0, 0, np.nan]]}, r"normals\[0\]"),
        ({"normals": np.zeros((2, 3))}, "number of normals is 2"),
        ({"points": [0, 0, 0]}, r"points .*\(n, 3\)"),
        ({"samples": 0}, "samples is 0; allowed: 1 to 4096"),
        ({"samples": 5000}, "samples is 5000"),
        ({"excluded": [1]}, r"excluded mesh is 1.*below the number of meshes \(1\)"),
        ({"threads": -1}, "threads is -1"),
    ],
)
def test_refusals_name_argument_value_and_what_is_allowed(change, message):
    arguments = {"lights": [sg.Light()], "points": ORIGIN, "normals": UP} | change
    with pytest.raises(ValueError, match=message):
        sg.Occluders([ball()]).visible_fraction(**arguments)


def test_former_names_go_on_working_with_a_warning():
    scene = sg.Occluders([ball()])
    lamp = sg.Light(position=(0, 0, 5))
    with pytest.warns(DeprecationWarning) as told:
        found = scene.visible_share([lamp], [[0, 0, -5]], UP, without=[0])
    assert {str(w.message) for w in told} == {
        "Occluders.visible_share is now visible_fraction",
        "visible_fraction: without is now excluded",
    }
    assert found.mean == 1
    with pytest.warns(DeprecationWarning, match="skinglow.VisibleFraction"):
        assert isinstance(found, sg.VisibleShare)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc/self/maps")
def test_embree_is_loaded_by_the_first_occluders_and_not_before():
    code = """
import sys, skinglow
assert "skinglow._rays" not in sys.modules
assert "embree" not in open("/proc/self/maps").read()
skinglow.Occluders([])
assert "skinglow._rays" in sys.modules
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=os.environ)
    assert done.returncode == 0, done.stderr
