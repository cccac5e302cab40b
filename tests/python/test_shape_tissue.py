"""Another skin by what was solved for the first: LitShape.with_tissue and Shape.with_tissue, for sliders."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

BODY = bodies.lobe(levels=4)
SKIN = sg.Tissue()
LIGHTS = [
    sg.Light("POINT", position=(0.0, 5.0, 60.0), power=1000.0, radius=3.0, color=(1.0, 0.5, 0.2)),
    sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0, sun_angle=0.01),
]
AREA = bodies.vertex_areas(BODY)


@pytest.fixture(scope="module")
def shape():
    return sg.Shape(*BODY, SKIN)


@pytest.fixture(scope="module")
def lit(shape):
    return shape.light(LIGHTS, reentries=0)


def fresh(tissue, lights=LIGHTS):
    return sg.Shape(*BODY, tissue).light(lights, reentries=0)


def error(found, expected, chosen):
    """RMS over mean, all channels together."""
    weight = AREA[chosen, None] / (3.0 * AREA[chosen].sum())
    squared = (weight * (found - expected)[chosen] ** 2).sum()
    return np.sqrt(squared) / (weight * expected[chosen]).sum()


def back_lit(lit):
    return lit.irradiance.max(axis=1) < 0.01 * lit.irradiance.max()


def test_the_same_skin_is_the_same_light(lit):
    again = lit.with_tissue(SKIN)
    np.testing.assert_allclose(again.exitance, lit.exitance, rtol=1e-6, atol=1e-6 * lit.exitance.max())
    np.testing.assert_array_equal(again.irradiance, lit.irradiance)


@pytest.mark.parametrize("change", [{"melanin_fraction": 0.1}, {"epidermal_thickness_mm": 0.1}])
def test_an_epidermis_is_a_factor_and_exact(lit, change):
    tissue = SKIN.replace(**change)
    found, expected = lit.with_tissue(tissue), fresh(tissue)
    assert expected.exitance.sum() < 0.8 * lit.exitance.sum()
    np.testing.assert_allclose(found.exitance, expected.exitance, atol=1e-4 * expected.exitance.max())
    np.testing.assert_allclose(found.transmitted, expected.transmitted, atol=1e-4 * expected.exitance.max())


@pytest.mark.parametrize(
    ("change", "largest", "of_leaving_it"),
    [
        ({"blood_fraction": 0.0125}, 0.10, 0.6),
        ({"blood_fraction": 0.02}, 0.15, 0.3),
        ({"oxygen_saturation": 0.4}, 0.10, 0.3),
        ({"scattering_scale": 0.8}, 0.15, 0.6),
    ],
)
def test_flesh_is_near_its_own_solution(lit, change, largest, of_leaving_it):
    tissue = SKIN.replace(**change)
    expected = fresh(tissue).exitance
    dark = back_lit(lit)
    found = error(lit.with_tissue(tissue).exitance, expected, dark)
    assert found < largest
    assert found < of_leaving_it * error(lit.exitance, expected, dark)


def test_a_shape_of_another_skin_lights_as_what_was_lit(shape, lit):
    tissue = SKIN.replace(blood_fraction=0.02, melanin_fraction=0.08)
    found = shape.with_tissue(tissue).light(LIGHTS, reentries=0)
    expected = lit.with_tissue(tissue)
    np.testing.assert_allclose(found.exitance, expected.exitance, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(found.per_light, expected.per_light, rtol=1e-6, atol=1e-9)
    assert shape.with_tissue(tissue).bytes == shape.bytes  # nothing is prepared again


def test_many_lights_and_colors_follow(shape):
    lights = [*LIGHTS, *LIGHTS[:1], sg.Light("SUN", (0.2, 1.0, 1.0), direction=(0.3, 0.6, -0.7), power=2.0)]
    tissue = SKIN.replace(melanin_fraction=0.1)
    found = shape.light(lights, reentries=0).with_tissue(tissue)
    expected = fresh(tissue, lights)
    np.testing.assert_allclose(found.exitance, expected.exitance, atol=1e-4 * expected.exitance.max())
    np.testing.assert_allclose(
        found.recolor(np.ones((4, 3))), expected.recolor(np.ones((4, 3))), atol=1e-4 * expected.exitance.max()
    )


def test_light_from_skin_to_skin_follows_roughly(shape):
    tissue = SKIN.replace(melanin_fraction=0.1, blood_fraction=0.0125)
    expected = sg.Shape(*BODY, tissue).light(LIGHTS).exitance
    found = shape.light(LIGHTS).with_tissue(tissue).exitance
    assert error(found, expected, np.ones(len(AREA), bool)) < 0.1


def test_extreme_skins_are_finite(lit):
    for tissue in (
        SKIN.replace(melanin_fraction=0.43, epidermal_thickness_mm=0.15),
        SKIN.replace(blood_fraction=0.0, melanin_fraction=0.0),
        SKIN.replace(blood_fraction=0.1, oxygen_saturation=0.0),
        SKIN.replace(scattering_scale=3.0, refractive_index=1.0),
    ):
        found = lit.with_tissue(tissue)
        assert np.isfinite(found.exitance).all()
        assert found.exitance.min() >= 0.0


def test_coefficients_are_no_tissue():
    shape = sg.Shape(*BODY, absorption=(0.1, 0.2, 0.3), reduced_scattering=(1.0, 1.0, 1.0))
    with pytest.raises(ValueError, match="coefficients"):
        shape.with_tissue(SKIN)
    with pytest.raises(ValueError, match="coefficients"):
        shape.light(LIGHTS[:1]).with_tissue(SKIN)
    with pytest.raises(ValueError, match="tissue is 3"):
        sg.Shape(*BODY, SKIN).with_tissue(3)


@pytest.mark.parametrize("blood", [0.01, 0.02, 0.05])
def test_lit_skin_has_the_color_of_thick_skin(blood):
    """Also in blue, of which nothing comes through: errors of the grid were taken for blue light."""
    tissue = SKIN.replace(blood_fraction=blood)
    front = [sg.Light("SUN", direction=(0.0, 0.0, -1.0), power=1.0)]
    vertices, triangles = bodies.plate(20.0, 6.0, 20)
    lit = sg.Shape(vertices, triangles, tissue).light(front, reentries=0)
    thick = sg.Shape([[0, 0, 0], [9, 0, 0], [0, 9, 0.0]], [[0, 1, 2]], tissue).exitance(np.ones(3))[0]
    inner = (np.abs(vertices[:, :2]) < 6.0).all(axis=1) & (vertices[:, 2] == 6.0)
    np.testing.assert_allclose(lit.exitance[inner].mean(axis=0), thick, rtol=0.2)
    assert (lit.transmitted[inner].mean(axis=0) < 0.1 * thick).all()


def test_a_little_light_in_front_changes_little_of_what_comes_through():
    """Where none falls the nodes are put together as they are; where some does, the grid's errors are mended."""
    vertices, triangles = bodies.plate(30.0, 4.0, 30)
    middle = np.array([[0.3, 0.2, 4.0], [1.7, -0.4, 4.0]])
    shape = sg.Shape(vertices, triangles, SKIN, points=middle, normals=[(0.0, 0.0, 1.0)] * 2)
    behind = np.repeat((vertices[:, 2:] < 1.0).astype(float), 3, axis=1)
    dark = shape.exitance(behind)
    assert dark[:, 0].min() > 1e-4
    for in_front in (1e-7, 1e-5, 1e-3):
        lit = shape.exitance(behind + in_front)
        # It sends back half of that at most. Nodes that are darker than the grid's error of it are guessed.
        np.testing.assert_allclose(lit, dark, rtol=0.15, atol=in_front)
