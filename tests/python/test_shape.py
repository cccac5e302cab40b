"""skinglow.Shape and its light: what is asked for and what comes back; refusals, awkward bodies, colors, shadows."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

SKIN = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
LIGHTS = [
    sg.Light("POINT", position=(0.0, 5.0, 60.0), power=1000.0, radius=3.0, color=(1.0, 0.5, 0.2)),
    sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0, sun_angle=0.01),
]


@pytest.fixture(scope="module")
def lobe():
    return sg.Shape(*bodies.lobe(), **SKIN)


def cup():
    """Two plates that stand on each other's edge: light goes from skin to skin."""
    vertices, triangles = bodies.plate(12.0, 2.0, 12)
    upright = vertices[:, [2, 1, 0]] * [1.0, 1.0, -1.0] + [-8.0, 0.0, 8.5]
    return np.concatenate([vertices, upright]), np.concatenate([triangles, triangles + len(vertices)])


def test_irradiance_is_the_rigs_and_exitance_is_that_of_the_irradiance(lobe):
    body = bodies.lobe()
    lit = lobe.light(LIGHTS, reentries=0)
    expected = sg.surface_irradiance(LIGHTS, body[0], bodies.vertex_normals(body))
    # The lobe shadows itself at its bend alone.
    assert np.median(np.abs(lit.irradiance - expected)) < 1e-6 * expected.max()
    np.testing.assert_array_equal(lobe.exitance(lit.irradiance), lit.exitance)
    assert lit.exitance.shape == (len(body[0]), 3)
    assert (lit.transmitted <= lit.exitance).all()
    assert (lit.transmitted >= 0.0).all()


def test_lights_add_up_and_are_recolored(lobe):
    lit = lobe.light(LIGHTS)
    scale = lit.exitance.max()
    assert lit.per_light.shape == (2, *lit.exitance.shape)
    np.testing.assert_allclose(lit.per_light.sum(axis=0), lit.exitance, atol=1e-4 * scale)
    np.testing.assert_allclose(lit.recolor([light.color for light in LIGHTS]), lit.exitance, atol=1e-4 * scale)
    red = lit.recolor([(2.0, 0.0, 0.0), (0.0, 0.0, 0.0)])
    np.testing.assert_allclose(red[:, 0], 2.0 * lit.per_light[0, :, 0], atol=1e-4 * scale)
    assert (red[:, 1:] == 0.0).all()


def test_tissue_lets_red_through_and_adds_up():
    lit = sg.Shape(*bodies.lobe(), sg.Tissue(), surface="smooth").light(LIGHTS, reentries=0)
    back = lit.irradiance.max(axis=1) == 0.0
    red, green, blue = lit.exitance[back].mean(axis=0)
    assert red > 1.5 * green > 1.5 * blue > 0.0
    # Colors are put together from logarithms, which do not add up exactly.
    np.testing.assert_allclose(lit.per_light.sum(axis=0), lit.exitance, atol=0.02 * lit.exitance.max())


def test_light_from_skin_to_skin_only_adds():
    shape = sg.Shape(*cup(), **SKIN)
    once, twice, thrice = (shape.light(LIGHTS, reentries=n).exitance for n in (0, 1, 2))
    assert (twice >= once - 1e-6 * once.max()).all()
    assert 1.001 < twice.sum() / once.sum() < 1.5
    assert thrice.sum() - twice.sum() < 0.5 * (twice.sum() - once.sum())


def test_other_objects_cast_shadows(lobe):
    wall = (np.array([[-50, -50, 10.0], [50, -50, 10], [50, 50, 10], [-50, 50, 10]]), [[0, 1, 2], [0, 2, 3]])
    occluders = sg.Occluders([wall])
    assert lobe.light(LIGHTS, occluders=occluders).exitance.max() == 0.0
    free = lobe.light(LIGHTS, occluders=occluders, excluded=[0])
    np.testing.assert_array_equal(free.exitance, lobe.light(LIGHTS).exitance)


def test_a_body_shadows_itself():
    vertices, triangles = bodies.plate(12.0, 2.0, 12)
    pair = (np.concatenate([vertices, vertices - [0, 0, 6.0]]), np.concatenate([triangles, triangles + len(vertices)]))
    sun = [sg.Light("SUN", direction=(0.0, 0.0, -1.0), power=1.0)]
    irradiance = sg.Shape(*pair, **SKIN).light(sun).irradiance
    middle = (np.abs(pair[0][:, :2]) < 5.0).all(axis=1)
    np.testing.assert_allclose(irradiance[middle & (pair[0][:, 2] == 2.0)], 1.0, rtol=1e-6)
    assert (irradiance[middle & (pair[0][:, 2] < 1.0)] == 0.0).all()


def test_the_world_shines_from_everywhere(lobe):
    lit = lobe.light([], environment=sg.Environment((1.0, 0.5, 0.0)), reentries=0)
    open_sky = np.median(lit.irradiance, axis=0)
    np.testing.assert_allclose(open_sky, np.pi * np.array([1.0, 0.5, 0.0]), rtol=1e-6)
    assert lit.exitance[:, 0].min() > lit.exitance[:, 1].min() > 0.0
    assert (lit.exitance[:, 2] == 0.0).all()
    np.testing.assert_allclose(lit.recolor(np.zeros((0, 3))), lit.exitance, rtol=1e-5)


def test_ten_thousand_lights_are_all_at_once(lobe):
    random = np.random.default_rng(0)
    lights = [
        sg.Light("POINT", position=tuple(random.normal(size=3) * 50 + [0, 0, 100]), power=1.0) for _ in range(10000)
    ]
    lit = lobe.light(lights, reentries=0)
    body = bodies.lobe()
    expected = sg.surface_irradiance(lights, body[0], bodies.vertex_normals(body))
    assert np.median(np.abs(lit.irradiance - expected)) < 2e-3 * expected.max()
    assert lit.exitance.min() >= 0.0


def test_points_anywhere_agree_with_vertices():
    body = bodies.lobe(levels=5)
    normals = bodies.vertex_normals(body)
    light = np.maximum(normals @ (0.0, 0.6, 0.8), 0.0)
    at_vertices = sg.Shape(*body, **SKIN)
    shape = sg.Shape(*body, **SKIN, points=body[0][::11] + 0.01 * normals[::11], normals=normals[::11])
    np.testing.assert_allclose(shape.points, body[0][::11], atol=0.02)
    found, expected = shape.exitance(light), at_vertices.exitance(light)[::11]
    error = np.sqrt(((found - expected) ** 2).mean(axis=0)) / expected.mean(axis=0)
    assert (error < 0.08).all()
    np.testing.assert_allclose(found.mean(axis=0), expected.mean(axis=0), rtol=0.02)


def test_threads_do_not_change_anything():
    light = np.arange(1026.0)
    one, three = (sg.Shape(*bodies.lobe(), **SKIN, threads=n).exitance(light) for n in (1, 3))
    np.testing.assert_array_equal(one, three)


def test_report_says_what_was_made(lobe):
    lobe.exitance(np.ones(1026))
    report = lobe.report
    assert report["points"] == report["points_in_parts"] == 1026
    assert report["parts"] == report["ready_parts"] == len(lobe.parts) == 1
    assert report["cells"] > 100
    assert report["bytes"] == lobe.bytes > 0
    np.testing.assert_array_equal(lobe.parts[0].points, np.arange(1026))


def test_parts_without_light_cost_nothing():
    vertices, triangles = bodies.lobe()
    two = (np.concatenate([vertices, vertices + [80.0, 0, 0]]), np.concatenate([triangles, triangles + len(vertices)]))
    shape = sg.Shape(*two, **SKIN)
    exitance = shape.exitance(np.where(two[0][:, 0] < 40.0, 1.0, 0.0))
    assert [part.is_ready for part in shape.parts] == [True, False]
    assert (exitance[len(vertices) :] == 0.0).all()


def test_thick_flesh_has_the_exitance_of_a_half_space():
    body = bodies.ball(30.0, 4)
    shape = sg.Shape(*body, **SKIN)
    assert shape.parts == []
    found = shape.exitance(np.ones(len(body[0])))
    half_space = [
        sg.slab([sg.Layer(1.0, a, s, 0.0, np.inf)], "diffuse").reflectance
        for a, s in zip(SKIN["absorption"], SKIN["reduced_scattering"], strict=True)
    ]
    np.testing.assert_allclose(found, np.broadcast_to(half_space, found.shape), rtol=0.03)


def broken_balls():
    """Balls of radius 4 that enclose the same flesh in awkward ways; the last column are the ball's own vertices."""
    vertices, triangles = bodies.ball(4.0)
    count, random = len(vertices), np.random.default_rng(1)
    flipped = triangles.copy()
    chosen = random.choice(len(triangles), len(triangles) // 100, replace=False)
    flipped[chosen] = flipped[chosen][:, ::-1]
    doubled = np.concatenate([triangles, triangles + count])
    return {
        "turned inside out": (vertices, triangles[:, ::-1]),
        "1 % of faces flipped": (vertices, flipped),
        "1 % of faces missing": (vertices, triangles[random.uniform(size=len(triangles)) > 0.01]),
        "every face twice": (np.concatenate([vertices, vertices]), doubled),
        "a shell inside": (np.concatenate([vertices, 0.93 * vertices]), doubled),
        "far from the origin": (vertices + 1e5, triangles),
    }


@pytest.mark.parametrize("name", broken_balls())
def test_awkward_meshes_enclose_the_same_flesh(name):
    vertices, triangles = bodies.ball(4.0)
    count = len(vertices)
    light = np.maximum(vertices[:, 0] / 4.0, 0.0)
    expected = sg.Shape(vertices, triangles, **SKIN).exitance(light)
    body = broken_balls()[name]
    light = np.concatenate([light, light if name == "every face twice" else 0.0 * light])[: len(body[0])]
    found = sg.Shape(*body, **SKIN).exitance(light)[:count]
    error = np.sqrt(((found - expected) ** 2).mean(axis=0)) / expected.mean(axis=0)
    assert (error < 0.06).all(), error


def test_an_open_neck_does_not_change_the_light_above_it():
    """A long body cut open below, as a head's mesh ends at its neck."""
    vertices, triangles = bodies.ball(4.0)
    vertices = vertices * [1.0, 1.0, 4.0]
    is_low = vertices[:, 2] < -10.0
    light = np.maximum(vertices[:, 0] / 4.0, 0.0) * ~is_low
    expected = sg.Shape(vertices, triangles, **SKIN).exitance(light)
    found = sg.Shape(vertices, triangles[~is_low[triangles].any(axis=1)], **SKIN).exitance(light)
    above = vertices[:, 2] > 0.0
    error = np.sqrt(((found - expected)[above] ** 2).mean(axis=0)) / expected[above].mean(axis=0)
    assert (error < 0.02).all(), error


@pytest.mark.parametrize("cell_mm", [0.8, 5.0, 50.0])
def test_cells_are_never_larger_than_the_flesh(cell_mm):
    body = bodies.ball(4.0)
    light = np.ones(len(body[0]))
    found = sg.Shape(*body, **SKIN, cell_mm=cell_mm).exitance(light).mean(axis=0)
    fine = sg.Shape(*body, **SKIN, cell_mm=0.4).exitance(light).mean(axis=0)
    np.testing.assert_allclose(found[:2], fine[:2], rtol=0.15)


@pytest.mark.parametrize("squares", [1, 2, 8])
def test_large_triangles_are_solved_all_over(squares):
    def at(cells):
        vertices, triangles = bodies.plate(44.0, 2.0, cells)
        points = np.array([[0.3, 0.4, 2.0], [5.0, 3.0, 2.0], [-7.0, 9.0, 2.0]])
        shape = sg.Shape(vertices, triangles, **SKIN, points=points)
        assert len(shape.parts) == 1
        return shape.exitance(np.where(vertices[:, 2] == 0.0, 1.0, 0.0))

    np.testing.assert_allclose(at(squares), at(44), rtol=0.04)


def test_one_triangle_is_a_half_space():
    shape = sg.Shape([[0, 0, 0], [10, 0, 0], [0, 10, 0.0]], [[0, 1, 2]], **SKIN)
    assert shape.parts == []
    assert (shape.exitance([1.0, 1.0, 1.0]) > 0.2).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"absorption": (-1.0, 0, 0)}, r"absorption\[0\] is -1"),
        ({"absorption": (0.0, 0, 0), "reduced_scattering": (0.0, 1, 1)}, "channel 0"),
        ({"absorption": None}, "absorption is not given"),
        ({"tissue": sg.Tissue()}, "tissue is given with coefficients"),
        ({"refractive_index": 0.9}, "refractive_index"),
        ({"surface": "glossy"}, 'surface is "glossy"'),
        ({"cell_mm": 0.0}, "cell_mm"),
        ({"unit_mm": -1.0}, "unit_mm"),
        ({"unit_mm": 1e30}, "mm from their center"),
        ({"max_thickness_mm": np.nan}, "max_thickness_mm"),
        ({"threads": -1}, "threads"),
        ({"normals": [[0, 0, 1.0]]}, "normals"),
        ({"points": [[0, 0, np.inf]]}, r"points\[0\]"),
        ({"points": [[0, 0, 0.0]], "normals": [[0, 0, 1.0], [0, 0, 1.0]]}, "normals"),
    ],
)
def test_bad_arguments_are_refused_in_words(change, message):
    with pytest.raises(ValueError, match=message):
        sg.Shape(*bodies.lobe(levels=2), **{**SKIN, **change})


def test_bad_light_is_refused_in_words(lobe):
    with pytest.raises(ValueError, match="irradiance is 3 entries"):
        lobe.exitance([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"irradiance\[5\]"):
        lobe.exitance(np.where(np.arange(1026) == 5, np.nan, 1.0))
    with pytest.raises(ValueError, match="reentries"):
        lobe.light(LIGHTS, reentries=-1)
    with pytest.raises(ValueError, match="colors"):
        lobe.light(LIGHTS).recolor([(1.0, 1.0, 1.0)])


def test_progress_ascends_and_cancels():
    seen = []
    sg.Shape(*bodies.lobe(), **SKIN, progress=lambda done: seen.append(done) or True)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    with pytest.raises(RuntimeError, match="cancelled"):
        sg.Shape(*bodies.lobe(), **SKIN, progress=lambda done: False)
