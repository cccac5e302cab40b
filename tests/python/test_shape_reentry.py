"""Light that leaves skin and enters it again is the same whichever points of the body are asked for."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg


def joined(*parts):
    """One mesh of bodies, each moved, and the normals of its vertices."""
    vertices, triangles, count = [], [], 0
    for (points, corners), moved in parts:
        vertices.append(points + np.array(moved, float))
        triangles.append(corners + count)
        count += len(points)
    body = np.concatenate(vertices), np.concatenate(triangles)
    return (*body, bodies.vertex_normals(body))


@pytest.mark.parametrize("reentries", [1, 2, 4, 8])
def test_between_two_balls_that_absorb_nothing_it_adds_up_to_the_world(reentries):
    fine, coarse = bodies.ball(3.0, 3), bodies.ball(3.0, 2)
    vertices, triangles, normals = joined((fine, (0, 0, 0)), (coarse, (6.3, 0, 0)))
    in_gap = (np.abs(vertices[:, 0] - 3.15) < 1.2) & (np.arange(len(vertices)) >= len(fine[0]))
    flesh = {"absorption": 0.0, "reduced_scattering": 5.0, "refractive_index": 1.0, "max_thickness_mm": 2.0}
    world = sg.Environment((1.0, 1.0, 1.0))

    def mean(chosen):
        shape = sg.Shape(vertices, triangles, points=vertices[chosen], normals=normals[chosen], **flesh)
        lit = shape.light([], world, reentries=reentries)
        return lit.exitance[in_gap[chosen]].mean() / np.pi

    assert mean(in_gap) == pytest.approx(mean(np.ones(len(vertices), bool)), rel=1e-5)
    if reentries == 8:
        assert mean(in_gap) == pytest.approx(1.0, abs=0.02)


def test_skin_that_shines_back_is_as_bright_as_where_it_is_asked_for_itself():
    lit, dark = bodies.ball(10.0, 4), bodies.ball(3.0, 1)
    vertices, triangles, normals = joined((lit, (0, 0, 0)), (dark, (14, 0, 0)))
    light = [sg.Light("POINT", position=(6, 0, 30.0), power=1e4)]

    def again(first):
        points = {"points": vertices[first:], "normals": normals[first:]}
        shape = sg.Shape(
            vertices, triangles, absorption=0.5, reduced_scattering=50.0, refractive_index=1.0, **points
        )  # opaque: a half-space everywhere
        none, once = (shape.light(light, reentries=n).exitance[-len(dark[0]) :].mean() for n in (0, 1))
        return once - none

    few = again(len(lit[0]))
    assert few > 0.0
    assert few == pytest.approx(again(0), rel=1e-5)


@pytest.mark.parametrize("reentries", [0, 2])
def test_the_same_call_gives_the_same_answer_though_parts_are_ready_by_then(reentries):
    lobe = bodies.lobe(levels=3)
    vertices, triangles, normals = joined(
        (lobe, (0, 0, 0)), (bodies.ball(3.0, 3), (0, 0, 8)), (bodies.plate(20, 2, 10), (0, 0, -9))
    )
    own = slice(len(lobe[0]))
    shape = sg.Shape(
        vertices,
        triangles,
        absorption=(0.032, 0.17, 0.48),
        reduced_scattering=(0.74, 0.88, 1.01),
        refractive_index=1.0,
        points=vertices[own],
        normals=normals[own],
    )
    world = sg.Environment((0.02, 0.03, 0.05))
    first, second = (shape.light([], world, reentries=reentries, solver_tolerance=1e-6) for _ in range(2))
    for name in ("exitance", "irradiance", "error"):
        np.testing.assert_allclose(getattr(second, name), getattr(first, name), rtol=1e-5, err_msg=name)
    assert first.irradiance.max() > 0.0


@pytest.mark.parametrize(
    "tissue",
    [
        {"melanin_fraction": 0.3},
        {"epidermal_thickness_mm": 0.12},
        {"melanin_fraction": 0.43, "epidermal_thickness_mm": 0.3},
    ],
    ids=str,
)
def test_another_skin_has_its_own_epidermis_each_time_that_light_enters(tissue):
    ball = bodies.ball(6.0, 3)
    vertices, triangles, _normals = joined((ball, (0, 0, 0)), (ball, (13, 0, 0)))
    second = slice(len(ball[0]), None)  # lit by the first one alone
    shape = sg.Shape(vertices, triangles, sg.Tissue())
    sun = [sg.Light("SUN", direction=(1, 0, 0), power=1.0)]
    world = sg.Environment((0.01, 0.02, 0.03))
    other = sg.Tissue(**tissue)
    expected = shape.with_tissue(other).light(sun, world)
    found = shape.light(sun, world).with_tissue(other)
    mean = shape.with_tissue(other).light(sun).exitance[second].mean(axis=0)
    np.testing.assert_allclose(shape.light(sun).with_tissue(other).exitance[second].mean(axis=0), mean, rtol=1e-4)
    for name in ("exitance", "transmitted"):
        largest = getattr(expected, name).max()
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), atol=1e-5 * largest, err_msg=name)
    np.testing.assert_allclose(found.recolor([(0.2, 0.5, 1.0)]), expected.recolor([(0.2, 0.5, 1.0)]), rtol=1e-4)
