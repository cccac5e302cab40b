"""Irradiance in physical units: formulae written out here in numpy, bounds, shapes and errors."""

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given
from hypothesis import strategies as st

PI = np.pi
coordinate = st.floats(-10, 10, allow_nan=False)
vector = st.tuples(coordinate, coordinate, coordinate)
direction = vector.filter(lambda v: np.linalg.norm(v) > 1e-3)
fraction = st.floats(0, 1)
light = st.builds(
    sg.Light,
    kind=st.sampled_from(["POINT", "SUN", "SPOT", "AREA"]),
    color=st.tuples(fraction, fraction, fraction),
    position=vector,
    direction=direction,
    power=st.floats(-100, 100),
    visible=st.booleans(),
    radius=st.floats(0, 2),
    soft_falloff=st.booleans(),
    sun_angle=st.floats(0, PI),
    spot_angle=st.floats(0, PI),
    spot_blend=fraction,
    spot_cosine=st.booleans(),
    area_shape=st.sampled_from(["RECTANGLE", "ELLIPSE"]),
    size_x=st.floats(0, 3),
    size_y=st.floats(0, 3),
    tangent=vector,
    spread=st.floats(0, PI),
)


def test_each_kind_is_its_formula():
    above = {"position": (0, 0, 2), "power": 100}
    point = 100 / (4 * PI * 4)
    assert sg.object_irradiance([sg.Light("POINT", **above)], (0, 0, 0)) == pytest.approx([point] * 3)
    assert sg.object_irradiance([sg.Light("SPOT", **above)], (0, 0, 0)) == pytest.approx([point] * 3)
    assert sg.object_irradiance([sg.Light("SUN", power=3)], (7, 7, 7)) == pytest.approx([3] * 3)
    assert sg.object_irradiance([sg.Light("AREA", **above)], (0, 0, 0)) == pytest.approx([4 * point] * 3)
    soft = sg.Light("POINT", **above, radius=0.5)
    assert sg.object_irradiance([soft], (0, 0, 0))[0] == pytest.approx(1.8724, abs=5e-5)


def test_disk_off_its_axis_is_the_closed_form():
    radius, height = 0.5, 1.5
    disk = sg.Light("AREA", position=(0, 0, height), size_x=1, size_y=1, area_shape="DISK")
    aside = np.linspace(0, 3, 50)
    points = np.stack([aside, 0 * aside, 0 * aside], axis=1)
    s = aside**2 + height**2 + radius**2
    view = 0.5 * (1 - (s - 2 * radius**2) / np.sqrt(s**2 - 4 * aside**2 * radius**2))
    up = np.tile([0.0, 0.0, 1.0], (50, 1))
    ours = sg.surface_irradiance([disk], points, up)[:, 0]
    np.testing.assert_allclose(ours, view / (PI * radius**2), rtol=1e-6)


@given(st.lists(light, max_size=6), vector)
def test_parts_add_up_and_are_finite(lights, point):
    parts = sg.object_irradiance_by_light(lights, point)
    assert parts.shape == (len(lights), 3)
    assert np.isfinite(parts).all()
    total = sg.object_irradiance(lights, point)
    np.testing.assert_allclose(total, parts.sum(axis=0), rtol=1e-9, atol=1e-12 * abs(parts).sum())
    for one, part in zip(lights, parts, strict=True):
        assert (part == 0).all() or one.is_on


@given(st.lists(light, max_size=4), st.lists(st.tuples(vector, direction), max_size=5))
def test_surface_is_never_above_what_faces_the_lamps(lights, places):
    points = np.array([p for p, _ in places]).reshape(-1, 3)
    normals = np.array([n for _, n in places]).reshape(-1, 3)
    values = sg.surface_irradiance(lights, points, normals)
    assert values.shape == points.shape
    assert np.isfinite(values).all()
    for point, value in zip(points, values, strict=True):
        box = sg.PreparedRig(lights).cull(point, point, 1e30)
        assert (abs(value) <= box["bound"] * (1 + 1e-9) + 1e-12).all()


@given(st.lists(light, max_size=12), vector, st.floats(0, 2), st.floats(0, 10), direction)
def test_culling_keeps_its_bound(lights, middle, half, tolerance, normal):
    low, high = np.subtract(middle, half), np.add(middle, half)
    result = sg.PreparedRig(lights).cull(low, high, tolerance)
    dropped = [i for group in result["dropped"] for i in group["lights"]]
    assert sorted(dropped + result["kept"]) == list(range(len(lights)))
    assert (result["bound"] <= tolerance).all()
    left_out = [lights[i] for i in dropped]
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    lost = sg.surface_irradiance(left_out, corners, np.tile(normal, (8, 1)))
    assert (abs(lost) <= result["bound"] + 1e-12).all()
    for corner in corners:
        assert (abs(sg.object_irradiance(left_out, corner)) <= result["bound"] + 1e-12).all()


@given(st.lists(light, max_size=5), vector, st.floats(0, 1))
def test_object_weight_error_holds(lights, middle, half):
    low, high = np.subtract(middle, half), np.add(middle, half)
    error = sg.object_irradiance_error(lights, middle, low, high)
    here = sg.object_irradiance(lights, middle)
    for corner in (low, high):
        change = abs(sg.object_irradiance(lights, corner) - here)
        assert (change <= error * (1 + 1e-9) + 1e-12).all()


def test_far_side_is_behind_and_faces_away():
    back = sg.Light("POINT", position=(0, 0, -3), power=4 * PI)
    normals = np.array([[0, 0, 1.0], [0, 0, -1.0]])
    values = sg.far_side_irradiance([back], np.array([[0, 0, 1.0]] * 2), normals, 2.0)
    np.testing.assert_allclose(values, [[0.25] * 3, [0] * 3], atol=1e-15)


def test_report_names_reasons():
    lights = [
        sg.Light("POINT", position=(0, 0, 2), power=10, name="Key"),
        sg.Light("POINT", visible=False),
        sg.Light("SPOT", position=(0, 0, 2), direction=(1, 0, 0)),
        sg.Light("AREA", position=(0, 0, 2), direction=(0, 0, 1)),
        sg.Light("POINT", position=(0, 0, 2)),
    ]
    report = sg.light_report(lights, (0, 0, 0), occluded=[False] * 4 + [True])
    states = [entry["state"] for entry in report]
    assert states == ["shines", "hidden", "outside cone", "behind light", "occluded"]
    assert report[0]["share"] == 1
    assert report[0]["normal_angle"] is None
    assert sg.light_report(lights, (0, 0, 0), normal=(0, 0, -1))[0]["state"] == "behind"


def test_environment_and_angles():
    constant = sg.Environment((0.5, 1, 2))
    normals = np.array([[0, 0, 1.0], [0.6, 0, 0.8], [0, 0, 0]])
    expected = np.array([[0.5, 1, 2], [0.5, 1, 2], [0, 0, 0]]) * PI
    np.testing.assert_allclose(constant.irradiance(normals), expected)
    image = sg.Environment(np.ones((8, 16, 3)) * [0.5, 1, 2])
    np.testing.assert_allclose(image.irradiance(normals), expected)
    weight = sg.AngularWeight([0, 1], [0.2, 1.0])
    np.testing.assert_allclose(constant.irradiance(normals, weight), expected)
    mu = (np.arange(1000) + 0.5) / 1000
    np.testing.assert_allclose((2 * mu[:, None] * weight.at(mu)).mean(axis=0), 1, rtol=1e-6)


# Whole numbers and halves: exactly the same in single precision.
pixel = st.integers(0, 64).map(lambda i: i / 2)
rotation = st.tuples(direction, direction).filter(lambda v: np.linalg.norm(np.cross(*v)) > 1e-2 * np.linalg.norm(v[0]))


@given(st.integers(1, 5), st.integers(1, 5), st.integers(1, 5), st.data())
def test_environment_of_a_hosts_image_is_that_of_the_turned_over_array(height, width, channels, data):
    values = data.draw(st.lists(pixel, min_size=height * width * channels, max_size=height * width * channels))
    pixels = np.array(values, np.float32).reshape(height, width, channels)
    colors = np.repeat(pixels[:, :, :1], 3, axis=2) if channels < 3 else pixels[:, :, :3]
    expected = sg.Environment(colors[::-1].astype(float)).coefficients
    np.testing.assert_array_equal(sg.Environment.from_image(pixels, bottom_first=True).coefficients, expected)
    np.testing.assert_array_equal(sg.Environment.from_image(pixels[::-1]).coefficients, expected)


@given(st.lists(vector, min_size=9, max_size=9), rotation, direction, st.booleans())
def test_turned_environment_on_a_turned_surface_is_the_same(coefficients, axes, normal, mirrored):
    x = axes[0] / np.linalg.norm(axes[0])
    z = np.cross(*axes) / np.linalg.norm(np.cross(*axes))
    turn = np.array([x, np.cross(z, x), -z if mirrored else z])
    still = sg.Environment(np.array(coefficients))
    turned = still.rotated(turn)
    normals = np.array([normal])
    found = turned.irradiance(normals @ turn.T)
    np.testing.assert_allclose(found, still.irradiance(normals), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(turned.mean_irradiance, still.mean_irradiance)


def test_mirror_ball_of_one_color_and_what_lies_outside_it():
    pixels = np.full((64, 64, 3), 1e6, np.float32)
    middles = 2 * (np.arange(64) + 0.5) / 64 - 1
    pixels[np.add.outer(middles**2, middles**2) <= 1] = (0.5, 1, 2)
    ball = sg.Environment.from_image(pixels, projection="MIRROR_BALL")
    np.testing.assert_allclose(ball.mean_irradiance, np.array([0.5, 1, 2]) * PI)
    np.testing.assert_allclose(ball.coefficients[1:], 0, atol=0.05)


@pytest.mark.parametrize("radiance", [(1e30,) * 3, np.full((4, 8, 3), 1e30), np.full((9, 3), -4e30)])
def test_the_brightest_worlds_have_irradiance(radiance) -> None:
    world = sg.Environment(radiance)
    turned = world.rotated(np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0])
    for each in (world, turned, sg.Environment(sg.Environment((1e30,) * 3).coefficients)):
        normals = np.random.default_rng(1).normal(size=(9, 3))
        for found in (each.mean_irradiance, each.mean_irradiance_error, each.irradiance(normals)):
            assert np.isfinite(found).all() and (found >= 0.0).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sg.Light("AREA", size_x=-1, name="A"), 'light "A" size_x is -1'),
        (lambda: sg.Light("SPOT", spot_angle=4), "spot_angle is 4"),
        (lambda: sg.Light("AREA", area_shape="ROUND"), "RECTANGLE, SQUARE, ELLIPSE or DISK"),
        (lambda: sg.object_irradiance([], (0, 0, np.nan)), "point is"),
        (lambda: sg.object_irradiance([], (0, 0, 0), tolerance=0), "tolerance is 0"),
        (lambda: sg.surface_irradiance([], np.zeros((2, 3)), np.zeros((1, 3))), "normals is 1"),
        (lambda: sg.surface_irradiance([], np.zeros(3), np.zeros(3)), r"shape \(n, 3\)"),
        (lambda: sg.Environment(np.zeros((2, 2))), r"\(9, 3\)"),
        (lambda: sg.Environment(np.zeros((0, 2, 3))), "radiance is of shape.*pixel at least"),
        (lambda: sg.Environment((1, -1, 1)), "radiance is .*0 or more"),
        (lambda: sg.Environment((1, 1e31, 1)), "radiance is .*0 to 1e30"),
        (lambda: sg.Environment((1, np.inf, 1)), "radiance is .*three finite"),
        (lambda: sg.Environment(np.full((9, 3), 1e308)), r"radiance\[0\] is 1e.308.*at most 4e30"),
        (lambda: sg.Environment(np.full((9, 3), np.nan)), r"radiance\[0\] is nan"),
        (lambda: sg.Environment(np.diag(np.full(9, -1e31))[:, :3]), r"radiance\[0\] is -1e.31"),
        (lambda: sg.Environment(np.full((2, 2, 3), np.nan)), r"radiance\[0, 0\] is nan.*at most 1e30"),
        (lambda: sg.Environment(np.ones((2, 2, 3)) * [[[1], [1]], [[1], [1e31]]]), r"radiance\[1, 1\] is 1e.31"),
        (lambda: sg.Environment.from_image(np.full((2, 2, 3), 2e30)), "pixels is .*at most 1e30"),
        (lambda: sg.Environment.from_image(np.full((2, 2, 3), 1e39)), "pixels is not all finite"),
        (lambda: sg.Environment.from_image(np.full((8, 8, 1), 2e30), projection="MIRROR_BALL"), "pixels is .*1e30"),
        (lambda: sg.Environment.from_image(np.zeros((2, 2))), r"shape \(height, width, channels\)"),
        (lambda: sg.Environment.from_image(np.zeros((0, 2, 3))), "at least 1"),
        (lambda: sg.Environment.from_image(np.full((1, 1, 3), np.nan)), "not all finite"),
        (lambda: sg.Environment.from_image(np.ones((1, 1, 3)), projection="CUBE"), "MIRROR_BALL"),
        (lambda: sg.Environment((1, 1, 1)).rotated(2 * np.eye(3)), "orthogonal"),
        (lambda: sg.Environment((1, 1, 1)).rotated(np.eye(3)[:2]), r"shape \(3, 3\)"),
        (lambda: sg.AngularWeight([0, 1], [0, 0]), "above 0"),
        (lambda: sg.PreparedRig([]).cull((1, 0, 0), (0, 1, 1), 1), "box min"),
        (lambda: sg.black_body_color(10), "800 to 20000 K"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()
