"""Light in shapes at the ends of what may be asked: right, or refused in words."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

SKIN = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
BODY = bodies.lobe()
LIGHT = np.where(BODY[0][:, 2] > 1.0, 1.0, 0.0)
LIT_AREA = (bodies.vertex_areas(BODY) * LIGHT).sum()


def exitance(absorption, scattering, light=LIGHT, **options):
    medium = {"absorption": [absorption] * 3, "reduced_scattering": [scattering] * 3, "refractive_index": 1.0}
    return sg.Shape(*BODY, **{**medium, **options}).exitance(light)


@pytest.fixture(scope="module")
def lobe():
    return sg.Shape(*BODY, **SKIN)


@pytest.mark.parametrize("absorption", [0.0, 5e-324, 1e-9])
@pytest.mark.parametrize("index", [1.0, 3.0])
def test_flesh_that_does_not_absorb_returns_its_light(absorption, index):
    found = exitance(absorption, 1.0, refractive_index=index)
    leaving = bodies.vertex_areas(BODY) @ found[:, 0]
    entering = LIT_AREA if index == 1.0 else leaving  # a surface throws some of it back
    assert leaving == pytest.approx(entering, rel=0.05)
    np.testing.assert_allclose(found, exitance(0.0, 1.0, refractive_index=index), rtol=1e-3)


@pytest.mark.parametrize(
    ("absorption", "scattering", "largest"),
    [(1e3, 1.0, 1e-3), (1e5, 1e5, 0.2), (0.1, 1e3, 1.0), (10.0, 0.0, 1e-6), (1e-6, 0.0, 1.0), (0.0, 1e-6, 1.0)],
)
@pytest.mark.parametrize("surface", ["rough", "smooth"])
def test_any_medium_gives_light_between_nothing_and_what_fell(absorption, scattering, largest, surface):
    found = exitance(absorption, scattering, refractive_index=1.4, surface=surface)
    assert found.min() >= 0.0
    assert found.max() <= largest


@pytest.mark.parametrize("scale", [1e30, 1e-30])
@pytest.mark.parametrize("medium", [SKIN, {"tissue": sg.Tissue()}], ids=["channels", "tissue"])
def test_light_of_any_brightness_is_linear(scale, medium):
    """Squares in the solver's single precision overflowed or vanished: the light within flesh was 0."""
    shape = sg.Shape(*BODY, **medium)
    expected = shape.exitance(LIGHT)
    np.testing.assert_allclose(shape.exitance(scale * LIGHT) / scale, expected, atol=2e-3 * expected.max())
    assert np.isfinite(shape.exitance_error(scale * LIGHT)).all()


def test_light_beyond_single_precision_is_refused(lobe):
    with pytest.raises(ValueError, match=r"irradiance\[\d+\] is 1e\+300; allowed: .* 1e30"):
        lobe.exitance(1e300 * LIGHT)
    light = sg.Light("POINT", position=(0.0, 0.0, 50.0), power=1e300)
    with pytest.raises(ValueError, match="light at vertices"):
        lobe.light([light])
    with pytest.raises(ValueError, match="1e30"):
        lobe.light([], sg.Environment((1e30, 0.0, 0.0)))


def test_colors_beyond_single_precision_are_sums(lobe):
    lit = lobe.light([sg.Light("POINT", position=(0.0, 0.0, 50.0), power=1.0)])
    np.testing.assert_allclose(lit.recolor([(1e300, 0.0, 1.0)])[:, 0] / 1e300, lit.exitance[:, 0], rtol=1e-5)


@pytest.mark.parametrize(
    "light",
    [
        sg.Light("POINT", position=(0.0, 0.0, 0.2), power=1.0, radius=0.01),  # in the flesh
        sg.Light("POINT", position=tuple(BODY[0][5]), power=1.0, radius=0.0),  # on a vertex
        sg.Light("POINT", position=(0.0, 0.0, 0.2), power=1.0, radius=100.0),  # the body is in it
        sg.Light("POINT", position=(0.0, 0.0, 1e30), power=1.0),
        sg.Light("POINT", position=(0.0, 0.0, 50.0), power=5e-324),
        sg.Light("POINT", position=(0.0, 0.0, 50.0), power=1e30),
        sg.Light("SUN", direction=(0.0, 0.0, -1.0), power=1.0, sun_angle=np.pi),
    ],
)
def test_lights_anywhere_give_finite_light(lobe, light):
    lit = lobe.light([light])
    for values in (lit.exitance, lit.transmitted, lit.irradiance, lit.error):
        assert np.isfinite(values).all()
        assert values.min() >= 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cell_mm": 1e30}, r"cell_mm is 1e\+30; allowed: 0.02 to 1000"),  # Embree's rays were not valid
        ({"cell_mm": 1e-3}, "cell_mm"),
        ({"absorption": (1e6, 0.0, 0.0)}, r"absorption\[0\]"),
    ],
)
def test_what_cannot_be_is_refused_in_words(change, message):
    with pytest.raises(ValueError, match=message):
        sg.Shape(*BODY, **{**SKIN, **change})


@pytest.mark.parametrize("scale", [1e3, 1e6])
def test_a_body_in_the_wrong_unit_is_a_half_space_at_once(scale):
    """All blocks of its large triangles were made, gigabytes, though no flesh was thin."""
    shape = sg.Shape(BODY[0] * scale, BODY[1], **SKIN)
    assert shape.parts == []
    assert shape.exitance(LIGHT).max() == pytest.approx(0.628, abs=0.01)


@pytest.mark.parametrize("point", [[1e9, 0.0, 0.0], [0.0, -1e30, 0.0], [0.0, 0.0, 1e300], [0.1, 0.1, 0.1]])
def test_vertices_of_no_triangle_change_nothing(point):
    """Embree's rays were not valid, and nearer ones widened all gaps between rays and the surface."""
    medium = {"absorption": (0.01,) * 3, "reduced_scattering": (1.0,) * 3}
    alone = sg.Shape(*BODY, **medium).exitance(np.ones((len(BODY[0]), 3)))
    found = sg.Shape(np.vstack([BODY[0], [point]]), BODY[1], **medium).exitance(np.ones((len(BODY[0]) + 1, 3)))
    np.testing.assert_array_equal(found[:-1], alone)
    np.testing.assert_array_equal(found[-1], 0.0)


@pytest.mark.parametrize("point", [[1e6, 0.0, 0.0], [5e-324, 0.0, 0.0]])
def test_points_anywhere_are_moved_to_the_surface(point):
    shape = sg.Shape(*BODY, **SKIN, points=[point], normals=np.full((1, 3), 5e-324))
    assert np.isfinite(shape.exitance(LIGHT)).all()
    assert np.abs(shape.points).max() < 10.0


@pytest.mark.parametrize("point", [[1e30, 0.0, 0.0], [0.0, 0.0, -1e300]])
def test_points_far_away_are_refused(point):
    """In single precision they were at infinity, and came back from there."""
    with pytest.raises(ValueError, match=r"points\[1\] is .* 1e9 mm"):
        sg.Shape(*BODY, **SKIN, points=[[0.0, 0.0, 0.0], point])


def stacked():
    """Two plates, one on the other: the walls between them are inside."""
    vertices, triangles = bodies.plate(12.0, 1.5, 12)
    two = np.concatenate([vertices, vertices + [0.0, 0.0, 1.5]])
    return (two, np.concatenate([triangles, triangles + len(vertices)])), bodies.plate(12.0, 3.0, 12)


def test_coincident_walls_are_inside():
    both, one = stacked()
    count = len(one[0]) // 2
    inner = (np.abs(one[0][:, :2]) < 3.5).all(axis=1)

    def light_on_top(body):  # and not on its sides
        return np.where((body[0][:, 2] == 3.0) & (np.abs(body[0][:, :2]) < 5.5).all(axis=1), 1.0, 0.0)

    found = sg.Shape(*both, **SKIN).exitance(light_on_top(both))
    expected = sg.Shape(*one, **SKIN).exitance(light_on_top(one))
    np.testing.assert_allclose(found[:count][inner[:count]], expected[:count][inner[:count]], rtol=0.05)


@pytest.mark.parametrize("levels", [3])
def test_shells_within_shells_are_inside(levels):
    vertices, triangles = bodies.ball(6.0, levels)
    count = len(vertices)
    nested = np.concatenate([vertices, 0.6 * vertices, 0.3 * vertices])
    light = np.where(nested[:, 2] > 0.0, 1.0, 0.0)
    found = sg.Shape(nested, np.concatenate([triangles + k * count for k in range(3)]), **SKIN).exitance(light)
    alone = sg.Shape(vertices, triangles, **SKIN).exitance(light[:count])
    np.testing.assert_allclose(found[:count], alone, atol=1e-3 * alone.max())


@pytest.mark.parametrize(
    "body",
    [
        ([[0.0, 0, 0], [0, 0, 0], [0, 0, 0]], [[0, 1, 2]]),
        ([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 1]]),
        (BODY[0] * [1.0, 1.0, 0.0], BODY[1]),
        (BODY[0] * [1e-4, 1e-4, 10.0], BODY[1]),
        (BODY[0] * 1e-30, BODY[1]),
        (BODY[0] + 1e30, BODY[1]),
    ],
    ids=["a point", "a line", "flat", "a needle", "tiny", "all at one point far away"],
)
def test_bodies_without_flesh_are_finite(body):
    found = sg.Shape(*body, **SKIN).exitance(np.ones(len(body[0])))
    assert np.isfinite(found).all()
    assert found.min() >= 0.0
    assert found.max() <= 1.001  # what is kept of a row has 16 bits
