"""What a host needs around tables, meshes and lights."""

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given
from hypothesis import strategies as st


def test_luminance_is_that_of_rec_709_and_never_negative() -> None:
    np.testing.assert_allclose(sg.luminance(np.eye(3)), (0.2126, 0.7152, 0.0722))
    assert sg.luminance((1.0, 1.0, 1.0)) == pytest.approx(1.0)
    assert sg.luminance((-1.0, 0.0, 0.0)) == 0.0
    assert sg.luminance(np.ones((2, 5, 3))).shape == (2, 5)


def test_diffuse_radiance_over_the_hemisphere_is_the_exitance() -> None:
    radiance = sg.diffuse_radiance((1.0, 2.0, 3.0))
    cosines, weights = np.polynomial.legendre.leggauss(8)
    cosines, weights = 0.5 * (cosines + 1.0), 0.5 * weights
    np.testing.assert_allclose(2.0 * np.pi * (weights @ cosines) * radiance, (1.0, 2.0, 3.0))


def test_visible_entries_end_where_the_picture_is_black() -> None:
    table = np.exp(-np.arange(100.0))[:, None] * (1.0, 0.5, 0.25)
    assert sg.visible_entries(table) == 6  # e^-5 = 1/148, e^-6 = 1/403
    assert sg.visible_entries(np.zeros((9, 3))) == 1
    assert sg.visible_entries(np.ones((9, 3))) == 9


@given(st.integers(0, 5000), st.integers(1, 300))
def test_stratified_indices_are_one_a_stratum(count: int, samples: int) -> None:
    chosen = sg.stratified_indices(count, samples)
    assert len(chosen) == min(count, samples)
    assert (np.diff(chosen) > 0).all() if count <= samples else (np.diff(chosen) >= 0).all()
    if count > samples:
        np.testing.assert_array_equal(chosen * samples // count <= np.arange(samples), True)
        assert chosen[0] >= 0 and chosen[-1] < count


@given(st.floats(1e-3, 1e3), st.integers(0, 1000))
def test_uniform_scale_of_turned_and_moved_points(factor: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    points = random.normal(size=(8, 3))
    turned = points @ np.linalg.qr(random.normal(size=(3, 3)))[0].T * factor + random.normal(size=3)
    assert sg.uniform_scale(points, turned) == pytest.approx(factor, rel=1e-6)
    turned[3] += factor
    assert sg.uniform_scale(points, turned) is None


@given(st.floats(1e-3, 1e3), st.integers(0, 1000))
def test_what_is_mirrored_and_what_is_turned(factor: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    points = random.normal(size=(8, 3))
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    after = factor * points @ turn.T + random.normal(size=3)
    assert sg.is_mirrored(points, after) == (np.linalg.det(turn) < 0.0)
    assert not sg.is_mirrored(points * (1.0, 1.0, 0.0), after * (1.0, 1.0, 0.0))
    assert not sg.is_mirrored(points[:3], -points[:3])


def test_uniform_scale_of_what_has_none() -> None:
    assert sg.uniform_scale(np.zeros((4, 3)), np.ones((4, 3))) is None
    assert sg.uniform_scale(np.eye(3), np.zeros((3, 3))) is None


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: sg.luminance((1.0, 2.0)), r"colors is of shape \(2,\); allowed: shape \(\.\.\., 3\)"),
        (lambda: sg.luminance(1.0), r"colors is of shape \(\)"),
        (
            lambda: sg.visible_entries(np.zeros((0, 3))),
            r"table is of shape \(0, 3\); allowed: shape \(size, 3\), not empty",
        ),
        (lambda: sg.visible_entries((1.0, 2.0, 3.0)), r"table is of shape \(3,\)"),
        (lambda: sg.uniform_scale(np.eye(4), np.eye(4)), r"before is of shape \(4, 4\); allowed: shape \(n, 3\)"),
        (lambda: sg.uniform_scale(np.eye(3), np.ones((4, 3))), r"after is of shape \(4, 3\); allowed: that of before"),
        (lambda: sg.stratified_indices(10, 0), "samples is 0; allowed: 1 or more"),
        (lambda: sg.stratified_indices(-1, 3), "count is -1; allowed: 0 or more"),
    ],
)
def test_other_shapes_are_told_with_what_is_allowed(call, told: str) -> None:
    """It was numpy that told, of gufunc signatures and axes."""
    with pytest.raises(ValueError, match=told):
        call()


@pytest.mark.parametrize("kind", ["SPOT", "AREA", "SUN"])
@pytest.mark.parametrize("direction", [(0, 0, -1), (0, 0, 1), (1, 0, 0), (-1, 0, 0), (0.3, -2.0, 1.0)])
def test_light_rotation_points_the_light(kind: str, direction: tuple[float, ...]) -> None:
    tangent = {"tangent": (0.0, 1.0, 0.5)} if kind == "AREA" else {}
    light = sg.Light(kind=kind, color=(1, 1, 1), position=(0, 0, 0), direction=direction, power=1.0, **tangent)
    rotation = sg.light_rotation(light)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    np.testing.assert_allclose(rotation @ (0, 0, -1), np.array(direction) / np.linalg.norm(direction), atol=1e-12)
    if kind == "AREA":
        # Its width lies in the plane of the tangent and the direction.
        assert abs(np.linalg.det(np.array((rotation[:, 0], light.tangent, light.direction)))) < 1e-12
        assert rotation[:, 0] @ np.array(light.tangent) >= -1e-12


def test_light_rotation_of_a_point_light_is_none() -> None:
    light = sg.Light(kind="POINT", color=(1, 1, 1), position=(0, 0, 0), power=1.0)
    np.testing.assert_array_equal(sg.light_rotation(light), np.eye(3))


def test_irradiance_difference_of_an_area_light_in_one_term_and_in_many() -> None:
    box = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    light = sg.Light("AREA", position=(0.5, 0.5, 1.5), power=1.0, size_x=4.0, size_y=4.0)
    coarse, fine, dark = (
        sg.SurfaceLighting(lights, *box, max_terms=terms) for lights, terms in (([light], 1), ([light], 8), ([], 8))
    )
    assert sg.irradiance_difference(fine, fine, *box) == sg.irradiance_difference(dark, dark, *box) == 0.0
    assert sg.irradiance_difference(coarse, fine, *box) > 0.05
    assert sg.irradiance_difference(dark, fine, *box) == 1.0
    assert sg.irradiance_difference(fine, dark, *box) == np.inf
    with pytest.raises(ValueError, match="box_max is of shape"):
        sg.irradiance_difference(fine, fine, box[0], (1.0, 1.0))
