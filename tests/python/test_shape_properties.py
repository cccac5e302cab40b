"""What must hold of light in a shape whatever the body, medium and light: energy, reciprocity, symmetry, limits."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

# Skin 1 of Jensen et al. 2001, 1/mm.
ABSORPTION, SCATTERING = (0.032, 0.17, 0.48), (0.74, 0.88, 1.01)
SURFACES = ((1.0, "rough"), (1.4, "rough"), (1.4, "smooth"))


def solve(body, irradiance, absorption=ABSORPTION, scattering=SCATTERING, index=1.0, surface="rough", **options):
    shape = sg.Shape(
        *body,
        absorption=absorption,
        reduced_scattering=scattering,
        refractive_index=index,
        surface=surface,
        **{"cell_mm": 0.5, **options},
    )
    return shape.exitance(irradiance)


def sun(body, direction):
    """Irradiance of a sun of 1 W/m^2, without shadows."""
    return np.maximum(bodies.vertex_normals(body) @ direction, 0.0)


def reflection(index):
    """Of diffuse light that strikes a smooth surface from outside."""
    cosine = (np.arange(2000) + 0.5) / 2000
    inside = np.sqrt(1.0 - (1.0 - cosine**2) / index**2)
    s = (cosine - index * inside) / (cosine + index * inside)
    p = (index * cosine - inside) / (index * cosine + inside)
    return float((2.0 * cosine * 0.5 * (s**2 + p**2)).mean())


@pytest.mark.parametrize(("index", "surface"), SURFACES)
@pytest.mark.parametrize("make", [lambda: bodies.ball(4.0), bodies.lobe])
def test_what_enters_a_body_that_does_not_absorb_leaves_it(make, index, surface):
    body = make()
    area, light = bodies.vertex_areas(body), sun(body, (0.0, 0.6, 0.8))
    left = area @ solve(body, light, absorption=(0.0, 0.0, 0.0), index=index, surface=surface)
    entered = (1.0 - (0.0 if index == 1.0 else reflection(index))) * (area @ light)
    np.testing.assert_allclose(left, entered, rtol=0.01)


def test_what_leaves_a_body_that_absorbs_is_less_than_what_enters():
    body = bodies.lobe()
    area, light = bodies.vertex_areas(body), sun(body, (0.0, 0.6, 0.8))
    left = area @ solve(body, light)
    assert (left < area @ light).all()
    assert left[0] > left[1] > left[2]


@pytest.mark.parametrize(
    # The last flight knows directions, the equations before it do not: at a sharp rim the two differ, however small
    # the cells.
    ("make", "tolerance"),
    [(lambda: bodies.ball(4.0), 0.01), (bodies.lobe, 0.08)],
)
@pytest.mark.parametrize("pair", [(0, 5), (2, 5), (20, 30)])
def test_light_from_here_to_there_is_light_from_there_to_here(make, tolerance, pair):
    body = make()
    area, vertices = bodies.vertex_areas(body), body[0]
    near = [np.exp(-np.sum((vertices - vertices[k]) ** 2, axis=1) / 4.0) for k in pair]
    there = (area * near[1]) @ solve(body, near[0])
    here = (area * near[0]) @ solve(body, near[1])
    np.testing.assert_allclose(there, here, rtol=tolerance)


def test_light_adds_up():
    body = bodies.lobe()
    first, second = sun(body, (0.0, 0.6, 0.8)), sun(body, (0.6, 0.0, -0.8))
    one, two = solve(body, first), solve(body, second)
    both = solve(body, 2.0 * first + 0.5 * second)
    np.testing.assert_allclose(both, 2.0 * one + 0.5 * two, atol=2e-3 * both.max())


def test_colors_are_solved_by_themselves():
    body = bodies.lobe()
    light = sun(body, (0.0, 0.6, 0.8))
    white = solve(body, light)
    np.testing.assert_allclose(
        solve(body, light[:, None] * [1.0, 0.5, 0.0]), white * [1.0, 0.5, 0.0], atol=1e-4 * white.max()
    )


def test_no_light_gives_no_light():
    body = bodies.lobe()
    assert (solve(body, np.zeros(len(body[0]))) == 0.0).all()


MEDIA = [
    ((0.0, 1e-9, 1e3), (1.0, 1.0, 1.0)),
    ((0.1, 0.1, 0.1), (0.0, 1e-6, 1e3)),
    ((1e-9, 1e-9, 1e-9), (1.0, 10.0, 100.0)),
    ((5.0, 20.0, 100.0), (0.1, 1.0, 10.0)),
]


@pytest.mark.parametrize("medium", MEDIA)
@pytest.mark.parametrize(("index", "surface"), SURFACES)
def test_no_medium_gives_negative_or_endless_light(medium, index, surface):
    body = bodies.lobe(levels=3)
    random = np.random.default_rng(4)
    light = random.uniform(0.0, 2.0, len(body[0])) * (random.uniform(size=len(body[0])) < 0.3)
    exitance = solve(body, light, *medium, index=index, surface=surface, cell_mm=0.8)
    assert np.isfinite(exitance).all()
    assert (exitance >= 0.0).all()
    # No more than what entered leaves. Where light hardly scatters within a cell, what leaves is only estimated.
    area = bodies.vertex_areas(body)
    assert (area @ exitance <= 1.3 * (area @ light)).all()


def test_size_is_a_matter_of_units():
    vertices, triangles = bodies.lobe()
    light = sun((vertices, triangles), (0.0, 0.6, 0.8))
    mm = solve((vertices, triangles), light)
    np.testing.assert_allclose(solve((vertices / 1000.0, triangles), light, unit_mm=1000.0), mm, atol=1e-3 * mm.max())
    twice = solve(
        (2.0 * vertices, triangles),
        light,
        np.array(ABSORPTION) / 2.0,
        np.array(SCATTERING) / 2.0,
        cell_mm=1.0,
        max_thickness_mm=50.0,
    )
    np.testing.assert_allclose(twice, mm, atol=0.01 * mm.max())


def test_a_turned_or_moved_body_looks_the_same():
    vertices, triangles = bodies.lobe()
    light = sun((vertices, triangles), (0.0, 0.6, 0.8))
    straight = solve((vertices, triangles), light)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    for other in (vertices @ turn.T, vertices + [0.21, 0.13, 0.37], vertices + [2000.0, -700.0, 1300.0]):
        difference = solve((other, triangles), light) - straight
        error = np.sqrt((difference**2).mean(axis=0)) / straight.mean(axis=0)
        assert (error < [0.04, 0.06, 0.10]).all()


def middle_of_plate(thickness, index=1.0, surface="rough", cell_mm=0.5):
    """Exitance over irradiance on the dark side of a wide plate, in its middle."""
    body = bodies.plate(44.0, thickness, 44)
    vertices = body[0]
    light = np.where(vertices[:, 2] == 0.0, 1.0, 0.0)
    chosen = (vertices[:, 2] > 0.0) & (np.abs(vertices[:, :2]) < 4.0).all(axis=1)
    return solve(body, light, index=index, surface=surface, cell_mm=cell_mm)[chosen].mean(axis=0)


def slab(thickness, index):
    return np.array(
        [
            sg.slab([sg.Layer(index, a, s, 0.0, thickness)], "diffuse").transmittance
            for a, s in zip(ABSORPTION, SCATTERING, strict=True)
        ]
    )


def test_a_body_that_changes_by_its_last_digits_looks_the_same():
    """On ridges that light grazes, a node was without light or had a trace of it, and color jumped by half."""
    vertices, triangles = bodies.icosahedron(5.0, 4.0, 2.0)
    one, other = vertices[1:6], np.roll(vertices[1:6], -1, axis=0)
    points = np.concatenate([other + part * (one - other) for part in (1 / 3, 1 / 2, 2 / 3)])
    normals = points / np.square((5.0, 4.0, 2.0))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    lights = [
        sg.Light("POINT", (0.2, 0.0, 0.25), (1.84, 1.38, 2.29), power=48.0),
        sg.Light("POINT", (1.0, 0.75, 0.5), (-0.65, -1.55, 2.61), power=20.0),
    ]

    def light(matrix):
        where = {"points": points @ matrix, "normals": normals}
        return sg.Shape(vertices @ matrix, triangles, sg.Tissue(), cell_mm=1.0, **where).light(lights).transmitted

    expected, random = light(np.eye(3)), np.random.default_rng(2)
    assert expected.min() > 0.0
    for _ in range(4):
        found = light(np.eye(3) + 1e-7 * random.standard_normal((3, 3)))
        assert np.sqrt(np.square(found - expected).mean()) < 1e-3 * expected.mean()


@pytest.mark.parametrize("thickness", [1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize(("index", "surface"), [(1.0, "rough"), (1.4, "smooth")])
def test_a_plate_is_a_slab(thickness, index, surface):
    ratio = middle_of_plate(thickness, index, surface) / slab(thickness, index)
    np.testing.assert_allclose(ratio[:2], 1.0, atol=0.02)


def test_thicker_is_darker():
    exitance = np.array([middle_of_plate(t, cell_mm=0.8) for t in (0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0)])
    assert (np.diff(exitance, axis=0) < 0.0).all()


def ball_walked_through(radius, absorption, scattering, photons=400_000):
    """Monte Carlo in an exact ball, lit by a sun along +x: the flux that leaves, weighted by how far back."""
    random = np.random.default_rng(5)

    def sphere(count):
        z, angle = random.uniform(-1.0, 1.0, count), random.uniform(0.0, 2.0 * np.pi, count)
        ring = np.sqrt(1.0 - z**2)
        return np.stack([z, ring * np.cos(angle), ring * np.sin(angle)], 1)

    normal = sphere(photons)
    x = np.sqrt(random.uniform(size=photons))
    normal[:, 1:] *= (np.sqrt(1.0 - x**2) / np.linalg.norm(normal[:, 1:], axis=1))[:, None]
    normal[:, 0] = x
    position, direction = radius * normal, sphere(photons) - normal
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    flux = 0.0
    while len(position):
        b = (position * direction).sum(axis=1)
        way = -b + np.sqrt(np.maximum(0.0, b**2 + radius**2 - (position**2).sum(axis=1)))
        flight = random.exponential(1.0 / (absorption + scattering), len(position))
        leaves = flight >= way
        end = position[leaves] + way[leaves, None] * direction[leaves]
        flux += np.maximum(0.0, -end[:, 0] / radius).sum()
        scatters = ~leaves & (random.uniform(size=len(position)) < scattering / (absorption + scattering))
        position = position[scatters] + flight[scatters, None] * direction[scatters]
        direction = sphere(len(position))
    return flux / photons


def test_a_ball_is_what_monte_carlo_says():
    radius = 4.0
    body = bodies.ball(radius, 5)
    light = np.maximum(body[0][:, 0] / radius, 0.0)
    weight = bodies.vertex_areas(body) * np.maximum(-body[0][:, 0] / radius, 0.0)
    found = weight @ solve(body, light) / (bodies.vertex_areas(body) @ light)
    expected = [ball_walked_through(radius, a, s) for a, s in zip(ABSORPTION, SCATTERING, strict=True)]
    np.testing.assert_allclose(found[:2], expected[:2], rtol=0.02)
    np.testing.assert_allclose(found[2], expected[2], rtol=0.03)


def test_a_wall_inside_flesh_does_nothing():
    vertices, triangles = bodies.ball(4.0)
    light = np.maximum(vertices[:, 0] / 4.0, 0.0)
    alone = solve((vertices, triangles), light)
    doubled = (np.concatenate([vertices, 0.93 * vertices]), np.concatenate([triangles, triangles + len(vertices)]))
    with_wall = solve(doubled, np.concatenate([light, np.zeros(len(light))]))[: len(vertices)]
    np.testing.assert_allclose(with_wall.mean(axis=0), alone.mean(axis=0), rtol=0.01)
    np.testing.assert_allclose(with_wall, alone, atol=0.03 * alone.max())


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_light_stays_on_its_side_of_a_narrow_gap(turn):
    """Two plates, 1.2 mm apart, light between: a tenth of it came over in cells of 0.8 mm."""
    vertices, triangles = bodies.plate(12.0, 3.0, 12)
    count = len(vertices)
    light = np.where(vertices[:, 2] == 3.0, 1.0, 0.0)
    both = np.concatenate([vertices, vertices + [0.0, 0.0, 4.2]])
    c, s = np.cos(turn), np.sin(turn)
    both = both @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    pair = np.concatenate([triangles, triangles + count])
    found = solve((both, pair), np.concatenate([light, np.zeros(count)]), cell_mm=0.8)
    assert found[count:].max() < 0.02
    alone = solve((both[:count], triangles), light, cell_mm=0.8)
    error = np.sqrt(((found[:count] - alone) ** 2).mean(axis=0)) / alone.mean(axis=0)
    assert (error < [0.03, 0.08, 0.15]).all()
