"""A shape under lights that change: what Shape.light takes from an earlier answer, and that the result is the same."""

import random

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

FINE = {"solver_tolerance": 1e-6}
WORLD = sg.Environment((0.02, 0.03, 0.05))
TINTED = sg.Environment((0.05, 0.02, 0.02))


def shape(tissue):
    vertices, triangles = bodies.lobe()
    channels = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
    return sg.Shape(vertices * 1e-3, triangles, tissue, unit_mm=1000.0, **({} if tissue else channels))


@pytest.fixture(scope="module", params=[None, sg.Tissue()], ids=["channels", "tissue"])
def made(request):
    return shape(request.param)


def point(seed, color=(1.0, 0.7, 0.4), power=5.0, **more):
    angle = 2.4 * seed
    position = (0.2 * np.cos(angle), 0.05 * np.sin(2.0 * seed), 0.2 * np.sin(angle))
    return sg.Light("POINT", color, position, power=power, radius=0.01, **more)


def lights(count):
    sun = sg.Light("SUN", (0.2, 0.4, 1.0), direction=(0.3, 0.1, 1.0), power=1.0)
    return [sun, *(point(k, (1.0, 0.2 + 0.1 * k, 0.5)) for k in range(count - 1))]


def assert_same(found, expected):
    """To the solver's tolerance: it is 1e-6 here, of numbers in single precision."""
    for name in ("exitance", "transmitted", "irradiance"):
        a, b = getattr(found, name), getattr(expected, name)
        np.testing.assert_allclose(a, b, rtol=1e-3, atol=2e-4 * b.mean(), err_msg=name)


# From two lights to others, few enough to be solved each by itself, or too many.
CHANGES = {
    "moved": lambda old: [*old[:-1], point(17)],
    "another color": lambda old: [*old[:-1], point(len(old) - 2, (0.1, 0.9, 0.2))],
    "another power": lambda old: [*old[:-1], point(len(old) - 2, power=0.5)],
    "off": lambda old: [*old[:-1], point(len(old) - 2, visible=False)],
    "one more": lambda old: [point(21), *old],
    "one less": lambda old: old[1:],
    "one twice": lambda old: [*old, old[-1]],
    "in another order": lambda old: old[::-1],
    "all moved": lambda old: [point(30 + k) for k in range(len(old))],
    "none": lambda old: [],
}


@pytest.mark.parametrize("count", [3, 6])
@pytest.mark.parametrize("change", CHANGES)
def test_changed_lights_are_as_if_solved_anew(made, count, change):
    old = lights(count)
    new = CHANGES[change](old)
    lit = made.light(old, WORLD, **FINE)
    assert_same(made.light(new, WORLD, previous=lit, **FINE), made.light(new, WORLD, **FINE))


# Found by tests/blender/long_edits.py: what a group of lights gave was cut off below 0 before the rest was added.
@pytest.mark.parametrize("world", [None, WORLD], ids=["black", "lit"])
@pytest.mark.parametrize("count", [2, 6])
def test_lights_that_take_light_away_take_it_from_all_others(made, count, world):
    dark = sg.Light("SUN", (0.1, 1.0, 0.8), direction=(0.1, 0.2, -1.0), power=-8.0)
    old = [dark, *lights(count), point(5, power=-1.0)]
    new = [*old[:-3], point(17), point(18), old[-1]]
    lit = made.light(old, world, **FINE)
    found, expected = made.light(new, world, previous=lit, **FINE), made.light(new, world, **FINE)
    assert expected.exitance.min() == 0.0 < expected.exitance.max()
    assert_same(found, expected)
    brighter = made.light([light for light in new if light.power > 0.0], world, **FINE)
    # Not at each point: green light taken away is also the blue that it lacks, where colors are out of gamut.
    assert np.all(expected.exitance.mean(axis=0) < brighter.exitance.mean(axis=0))


@pytest.mark.parametrize("count", [2, 6])
@pytest.mark.parametrize("change", [(None, WORLD), (WORLD, None), (WORLD, TINTED)], ids=["lit", "black", "other"])
def test_another_world_is_as_if_solved_anew(made, count, change):
    lit = made.light(lights(count), change[0], **FINE)
    assert_same(
        made.light(lights(count), change[1], previous=lit, **FINE), made.light(lights(count), change[1], **FINE)
    )


def test_many_changes_do_not_add_up(made):
    """Each answer is made of the one before, and the last is as if solved anew."""
    choice = random.Random(5)
    now = lights(6)
    lit = made.light(now, WORLD, **FINE)
    for step in range(12):
        k = choice.randrange(len(now))
        now = [*now[:k], point(40 + choice.randrange(3), (0.3, 0.6, choice.random())), *now[k + 1 :]]
        if step % 4 == 3:
            lit.per_light  # noqa: B018  solves each by itself, which the next answer takes
        lit = made.light(now, WORLD, previous=lit, **FINE)
    assert_same(lit, made.light(now, WORLD, **FINE))
    colors = np.linspace(0.0, 1.0, 3 * len(now)).reshape(-1, 3)
    np.testing.assert_allclose(
        lit.recolor(colors), made.light(now, WORLD, **FINE).recolor(colors), rtol=1e-3, atol=2e-4 * lit.exitance.mean()
    )


def test_other_occluders_cast_other_shadows(made):
    wall = np.array([[-1.0, -1.0, 0.1], [1.0, -1.0, 0.1], [1.0, 1.0, 0.1], [-1.0, 1.0, 0.1]])
    occluders = sg.Occluders([(wall, [[0, 1, 2], [0, 2, 3]])])
    lit = made.light(lights(3))
    assert_same(made.light(lights(3), occluders=occluders, previous=lit), made.light(lights(3), occluders=occluders))


def test_what_is_solved_better_is_taken_as_it_is(made):
    """A quick answer to a moved light keeps what the full one found of the others."""
    quick = {"reentries": 0, "solver_tolerance": 0.3, "shadow_samples": 1}
    old = lights(3)
    full = made.light(old)
    full.per_light  # noqa: B018
    np.testing.assert_array_equal(made.light(old, previous=full, **quick).exitance, full.exitance)
    off = [*old[:-1], point(1, visible=False)]
    taken = made.light(off, previous=full, **quick).exitance
    np.testing.assert_allclose(taken, full.per_light[:-1].sum(axis=0), atol=1e-3 * full.exitance.max())
    # And what was quick is not taken for a full answer.
    coarse = made.light(old, **quick)
    assert np.abs(coarse.exitance - full.exitance).max() > 1e-3 * full.exitance.max()
    np.testing.assert_allclose(
        made.light(old, previous=coarse).exitance, full.exitance, atol=2e-3 * full.exitance.max()
    )


def test_an_answer_of_another_shape_is_of_no_use(made):
    other = shape(None).light(lights(3), WORLD)
    np.testing.assert_array_equal(
        made.light(lights(3), WORLD, previous=other).exitance, made.light(lights(3), WORLD).exitance
    )


@pytest.mark.parametrize("tolerance", [0.0, 1e-7, 0.6, float("nan")])
def test_a_tolerance_that_is_not_allowed_is_refused(made, tolerance):
    with pytest.raises(ValueError, match=r"solver_tolerance is .*; allowed: 1e-6 to 0\.5"):
        made.light(lights(1), solver_tolerance=tolerance)


def test_what_is_no_earlier_answer_is_told():
    with pytest.raises(ValueError, match=r"previous is 3; allowed: what light\(\) of this shape returned, or None"):
        shape(None).light(lights(1), previous=3)
