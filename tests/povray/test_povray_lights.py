"""Blender's watts in POV-Ray: a white matt plane under each kind of light, against Blender's measured laws."""

import numpy as np
import pytest
import skinglow as sg
from povray_runs import render, write

WIDTH, HEIGHT_OF_LAMP = 8.0, 2.0
PIXELS = 64
STEP_16_BIT = 2e-5
X = ((np.arange(PIXELS) + 0.5) / PIXELS - 0.5) * WIDTH  # along the plane, y = 0


def radiance(folder, *lights) -> np.ndarray:
    """What the white plane z = 0 shows along x, (PIXELS,)."""
    camera = np.eye(4)
    camera[2, 3] = 50
    corners = np.array([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], float)
    files = sg.povray_files(
        corners, np.array([(0, 1, 2), (0, 2, 3)]), np.full(4, 0.5), camera_matrix=camera,
        resolution=(PIXELS, 1), ortho_width=WIDTH, base=sg.BaseLut([0.0], 1), strength=0,
        surface_color=(1, 1, 1), lights=list(lights),
    )  # fmt: skip
    write(folder, files)
    return render(folder, "-A")[0, :, 0]


def falloff(power: float, x: float = 0.0, radius: float = 0.0) -> np.ndarray:
    """Irradiance of a point light above the plane: P / (4 pi (d^2 + r^2)) times the receiver's cosine."""
    d2 = (X - x) ** 2 + HEIGHT_OF_LAMP**2
    return power / (4 * np.pi * (d2 + radius**2)) * HEIGHT_OF_LAMP / np.sqrt(d2)


def above(x: float = 0.0) -> tuple[float, float, float]:
    return (x, 0.0, HEIGHT_OF_LAMP)


@pytest.mark.parametrize("radius", [0.0, 0.5])
def test_point(tmp_path, radius):
    found = radiance(tmp_path, sg.Light("POINT", position=above(0.3), power=100, radius=radius))
    np.testing.assert_allclose(found, falloff(100, 0.3, radius) / np.pi, atol=STEP_16_BIT)


def test_ball_has_no_soft_law(tmp_path):
    ball = sg.Light("POINT", position=above(), power=100, radius=0.5, soft_falloff=False)
    np.testing.assert_allclose(radiance(tmp_path, ball), falloff(100) / np.pi, atol=STEP_16_BIT)


def test_sun(tmp_path):
    found = radiance(tmp_path, sg.Light("SUN", direction=(1, 0, -2), power=2))
    np.testing.assert_allclose(found, 2 / np.pi * 2 / np.sqrt(5), atol=STEP_16_BIT)


@pytest.mark.parametrize("blend", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("with_cosine", [False, True])
def test_spot(tmp_path, blend, with_cosine):
    light = sg.Light(
        "SPOT", position=above(), direction=(0.2, 0, -1), power=100, spot_angle=1.6,
        spot_blend=blend, spot_cosine=with_cosine,
    )  # fmt: skip
    d = np.hypot(X, HEIGHT_OF_LAMP)
    cosine = (0.2 * X + HEIGHT_OF_LAMP) / d / np.hypot(0.2, 1)
    edge = np.cos(0.8)
    if blend:
        t = np.clip((cosine - edge) / (blend * (1 - edge)), 0, 1)
        profile = t * t * (3 - 2 * t)
    else:
        profile = (cosine > edge).astype(float)
    profile *= cosine if with_cosine else 1
    assert profile.min() == 0 and profile.max() > 0.9
    expected = falloff(100) * profile / np.pi
    np.testing.assert_allclose(radiance(tmp_path, light), expected, atol=STEP_16_BIT)


@pytest.mark.parametrize(("size", "error"), [(1e-3, 1e-4), (0.6, 0.004)])
def test_area(tmp_path, size, error):
    """A Lambert emitter, summed over its face; POV-Ray samples an area at 9 x 9 points."""
    light = sg.Light("AREA", position=above(), power=20, size_x=size, size_y=size)
    offsets = size * ((np.arange(64) + 0.5) / 64 - 0.5)
    dx, dy = np.meshgrid(offsets, offsets)
    d2 = (X[:, None, None] - dx) ** 2 + dy**2 + HEIGHT_OF_LAMP**2
    expected = np.mean(20 / np.pi * HEIGHT_OF_LAMP**2 / d2**2, axis=(1, 2)) / np.pi
    found = radiance(tmp_path, light)
    np.testing.assert_allclose(found, expected, atol=error * expected.max())


@pytest.mark.parametrize("spread", [0.3, 1.0, 2.0, 2.8])
def test_spread_is_close_not_equal(tmp_path, spread):
    """Blender's law for a spread is not among POV-Ray's; docs/povray.md states the error that is tested here."""
    half = spread / 2
    gain_on_axis = np.tan(half) / (np.tan(half) - half)
    power = 0.9 * np.pi**2 * HEIGHT_OF_LAMP**2 / gain_on_axis  # brightest: 0.9
    d = np.hypot(X, HEIGHT_OF_LAMP)
    gain = np.clip((np.tan(half) - np.abs(X) / HEIGHT_OF_LAMP) / (np.tan(half) - half), 0, None)
    expected = power / np.pi**2 / d**2 * (HEIGHT_OF_LAMP / d) ** 2 * gain
    found = radiance(tmp_path, sg.Light("AREA", position=above(), power=power, spread=spread))
    assert np.abs(found - expected).max() < 0.13 * 0.9


def test_negative_power_takes_light_away(tmp_path):
    lights = [sg.Light("POINT", position=above(0.3), power=p) for p in (200, -100)]
    np.testing.assert_allclose(radiance(tmp_path, *lights), falloff(100, 0.3) / np.pi, atol=STEP_16_BIT)


def test_cones_of_no_angle_give_nothing(tmp_path):
    shut = [
        sg.Light("SPOT", position=above(), power=9, spot_angle=0),
        sg.Light("AREA", position=above(), power=9, spread=0),
        sg.Light("AREA", position=above(), power=9, size_y=0),
    ]
    np.testing.assert_array_equal(radiance(tmp_path, *shut), 0)


def test_extreme_lights_are_read_and_say_the_same(tmp_path):
    """Lengths of directions do not matter, to any exponent; spreads go down to none, with a finite picture."""
    lights = [
        sg.Light(kind, position=above(), direction=(0, 0, -length), power=1, spread=0.5, spot_angle=0.5)
        for kind in ("SPOT", "AREA", "SUN")
        for length in (1, 1e-170, 1e200)
    ]
    found = [radiance(tmp_path, *lights[i::3]) for i in range(3)]
    assert found[0].max() > 0
    np.testing.assert_allclose(found[1], found[0], atol=STEP_16_BIT)
    np.testing.assert_allclose(found[2], found[0], atol=STEP_16_BIT)
    narrow = [
        sg.Light("AREA", position=(1e-3, 0, 2), direction=(0, 0, -1), power=1e-9, spread=spread)
        for spread in (0.0, 1e-300, 1e-8, 1e-5, 1e-3)
    ]
    far = [sg.Light("SPOT", position=(0, 0, 1e20), direction=(0, 0, -1), power=1, radius=1e-170)]
    assert np.isfinite(radiance(tmp_path, *narrow, *far)).all()
