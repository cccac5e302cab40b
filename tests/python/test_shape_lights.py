"""A shape under lights: what adds up, what recoloring does, light that enters skin again, shadows, lit skin."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

ABSORPTION, SCATTERING = (0.032, 0.17, 0.48), (0.74, 0.88, 1.01)
METERS = 1e-3
# What a tissue makes of light is interpolated in its logarithm: it adds up as well as that.
TOLERANCE = np.array([0.03, 0.03, 0.08])
LIGHTS = [
    sg.Light("POINT", (1.0, 0.7, 0.4), (0.02, 0.03, 0.3), power=5.0, radius=0.01),
    sg.Light("SUN", (0.2, 0.4, 1.0), direction=(0.3, 0.0, 1.0), power=1.0),
    sg.Light("POINT", (0.5, 1.0, 0.5), (0.3, 0.0, -0.1), power=8.0),
]


def assert_close(found, expected):
    """RMS over mean; single points, where one light is reflected and another comes through, may differ by more."""
    error = np.sqrt(((found - expected) ** 2).mean(axis=0)) / expected.mean(axis=0)
    assert (error < TOLERANCE).all(), error


def shape(body, tissue=None, **options):
    medium = {} if tissue else {"absorption": ABSORPTION, "reduced_scattering": SCATTERING, "refractive_index": 1.0}
    return sg.Shape(body[0] * METERS, body[1], tissue, unit_mm=1000.0, **medium, **options)


@pytest.fixture(scope="module")
def lobe():
    return bodies.lobe()


@pytest.fixture(scope="module", params=[None, sg.Tissue()], ids=["channels", "tissue"])
def made(request, lobe):
    return shape(lobe, request.param)


def test_lights_are_the_exitance_of_their_irradiance(made):
    lit = made.light(LIGHTS, reentries=0)
    assert_close(lit.exitance, made.exitance(lit.irradiance))


def test_all_lights_together_are_the_sum_of_each(made):
    lit = made.light(LIGHTS)
    assert lit.per_light.shape == (3, len(made.points), 3)
    assert_close(lit.per_light.sum(axis=0), lit.exitance)


def test_a_light_that_takes_away_is_what_it_takes(made):
    """By itself it was nothing, and the single lights added up to more than all of them."""
    less = sg.Light("POINT", (1.0, 0.7, 0.4), LIGHTS[0].position, power=-2.0, radius=0.01)
    lit = made.light([LIGHTS[0], less])
    np.testing.assert_allclose(lit.per_light[1], -0.4 * lit.per_light[0], rtol=1e-5)
    np.testing.assert_allclose(lit.per_light.sum(axis=0), lit.exitance, atol=1e-4 * lit.exitance.max())


def test_recoloring_is_a_light_of_that_color(made):
    colors = np.array([[0.1, 0.9, 0.3], [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]])
    changed = [
        sg.Light(light.kind, tuple(color), light.position, light.direction, power=light.power, radius=light.radius)
        for light, color in zip(LIGHTS, colors, strict=True)
    ]
    expected = made.light(changed)
    lit = made.light(LIGHTS)
    assert_close(lit.recolor(colors), expected.exitance)
    assert_close(lit.recolor(colors, transmitted=True), expected.transmitted)


def test_no_lights_are_dark(made):
    lit = made.light([])
    assert not lit.exitance.any()
    assert lit.per_light.shape == (0, len(made.points), 3)


def test_a_convex_body_lights_itself_no_more():
    ball = shape(bodies.ball(4.0))
    once, again = (ball.light(LIGHTS[:1], reentries=n).exitance for n in (0, 2))
    np.testing.assert_allclose(again, once, atol=1e-3 * once.max())


def test_light_that_enters_again_brightens_a_hollow():
    """Two balls that nearly touch: the dark one sees the lit one alone."""
    lit, dark = bodies.ball(4.0, 3), bodies.ball(4.0, 3)
    count = len(lit[0])
    body = (np.concatenate([lit[0], dark[0] + [8.6, 0.0, 0.0]]), np.concatenate([lit[1], dark[1] + count]))
    pair = shape(body)
    light = [sg.Light("SUN", (1.0, 1.0, 1.0), direction=(1.0, 0.0, 0.0), power=1.0)]  # shines along +x
    found = [pair.light(light, reentries=n).exitance[count:].mean(axis=0) for n in (0, 1, 2, 4)]
    assert (found[1] > 2.0 * found[0] + 1e-6).all()
    assert (found[2] >= found[1]).all()
    # Each time there is much less.
    assert (found[3] - found[2] < 0.3 * (found[2] - found[0]) + 1e-6).all()


def test_the_world_alone_is_the_same_from_everywhere():
    """In a white world a body that does not absorb sends back what it gets, wherever it is convex."""
    body = bodies.ball(4.0)
    white = sg.Shape(
        body[0] * METERS,
        body[1],
        absorption=(0.0, 0.0, 0.0),
        reduced_scattering=(1.0, 1.0, 1.0),
        refractive_index=1.0,
        unit_mm=1000.0,
    )
    lit = white.light([], sg.Environment((1.0, 1.0, 1.0)), reentries=0)
    np.testing.assert_allclose(lit.irradiance, np.pi, rtol=0.02)
    np.testing.assert_allclose(lit.exitance.mean(axis=0), np.pi, rtol=0.02)


def test_other_objects_cast_shadows(made):
    wall = np.array([[-1.0, -1.0, 0.1], [1.0, -1.0, 0.1], [1.0, 1.0, 0.1], [-1.0, 1.0, 0.1]])
    occluders = sg.Occluders([(wall, [[0, 1, 2], [0, 2, 3]])])
    free, hidden = (made.light(LIGHTS[:1], occluders=other) for other in (None, occluders))
    assert free.exitance.max() > 0.0
    assert not hidden.exitance.any()


def test_lit_skin_keeps_what_comes_through_alone(made):
    lit = made.light(LIGHTS[:1])
    assert (lit.transmitted >= 0.0).all()
    assert (lit.transmitted <= lit.exitance + 1e-9).all()
    # Where no light falls, on the point and about it, all of it came through. Light from skin to skin counts as lit.
    alone = made.light(LIGHTS[:1], reentries=0)
    triangles = bodies.lobe()[1]
    dark = np.ones(len(made.points), bool)
    dark[triangles[alone.irradiance.any(axis=1)[triangles].any(axis=1)]] = False
    assert dark.sum() > 100
    np.testing.assert_allclose(alone.transmitted[dark], alone.exitance[dark], atol=1e-3 * alone.exitance.max())


def test_lights_without_shadows_shine_through_walls(made):
    wall = np.array([(-1, -1, -0.05), (1, -1, -0.05), (1, 1, -0.05), (-1, 1, -0.05)], float)
    occluders = sg.Occluders([(wall, [(0, 1, 2), (0, 2, 3)])])
    sun = [sg.Light("SUN", (1.0, 1.0, 1.0), direction=(0.0, 0.0, 1.0))]
    free = made.light(sun, shadowless=[0])
    shadowed = made.light(sun, None, occluders, previous=free)
    assert shadowed.exitance.max() == 0.0 < free.exitance.max()
    through = made.light(sun, None, occluders, shadowless=[0], previous=shadowed)
    np.testing.assert_allclose(through.exitance, free.exitance, rtol=1e-6)
    with pytest.raises(ValueError, match=r"shadowless\[0\] is 1"):
        made.light(sun, shadowless=[1])


def test_saturated_colors_are_recolored_too(made):
    """Their reflected light may be out of gamut, where what is clamped is summed apart."""
    for color in ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)):
        colors = np.tile(color, (3, 1))
        lit = made.light([light_of(light, color) for light in LIGHTS])
        found = lit.recolor(colors, transmitted=True)
        np.testing.assert_allclose(found, lit.transmitted, atol=0.05 * lit.transmitted.max())


def light_of(light, color):
    return sg.Light(light.kind, color, light.position, light.direction, power=light.power, radius=light.radius)


def test_what_encloses_flesh():
    sheet = (np.array([(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)], float), [(0, 1, 2), (0, 2, 3)])
    assert sg.Shape(*sheet).report["enclosed"] == 0.0
    assert sg.Shape(*bodies.lobe()).report["enclosed"] > 0.99


@pytest.mark.parametrize("change", [{"power": 0.0}, {"color": (0.0, 0.0, 0.0)}])
def test_a_light_of_no_power_changes_nothing(change):
    """A fifth light, though dark, made a tissue's lights be solved together, which differs by up to 8 %."""
    shape = sg.Shape(*bodies.lobe(levels=3), sg.Tissue())
    four = [
        sg.Light("POINT", color=color, position=position, power=5.0)
        for color, position in (
            ((1.0, 0.8, 0.6), (0.0, 0.0, 40.0)),
            ((0.3, 0.5, 1.0), (40.0, 0.0, -40.0)),
            ((1.0, 1.0, 1.0), (-40.0, 20.0, 0.0)),
            ((1.0, 0.2, 0.1), (0.0, -40.0, 12.0)),
        )
    ]
    dark = sg.Light("POINT", **{"color": (1.0, 1.0, 1.0), "position": (0.0, 50.0, 0.0), "power": 5.0, **change})
    lit = shape.light([*four, dark])
    np.testing.assert_array_equal(lit.exitance, shape.light(four).exitance)
    np.testing.assert_array_equal(lit.per_light[4], 0.0)


@pytest.mark.parametrize("name", ["exitance", "transmitted", "error", "irradiance", "per_light"])
def test_what_is_kept_cannot_be_written(lobe, name):
    lit = shape(lobe).light(LIGHTS)
    kept = getattr(lit, name)
    before = kept.copy()
    with pytest.raises(ValueError, match="read-only"):
        kept /= np.pi
    np.testing.assert_array_equal(getattr(lit, name), before)
