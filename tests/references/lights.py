"""Lights: weights of the paper, irradiance in physical units, factors of hosts."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import skinglow as sg

from tests.references.reference import generator, held_against, of_largest, relative

PI = np.pi
ORIGIN = (0.0, 0.0, 0.0)


def some_lights(rng: np.random.Generator, count: int) -> list[sg.Light]:
    """Points, some with a radius, and suns, at 0.5 to 20 of the origin."""
    lights = []
    for index in range(count):
        away = rng.normal(size=3)
        common = {"color": rng.random(3), "direction": -away, "power": rng.uniform(0.0, 100.0)}
        if index % 3 == 2:
            lights.append(sg.Light("SUN", **common))
        else:
            position = away / np.linalg.norm(away) * rng.uniform(0.5, 20.0)
            lights.append(sg.Light("POINT", position=position, **common))
    return lights


def facing(lights: list[sg.Light], point: np.ndarray) -> np.ndarray:
    """Irradiance of a surface that faces each light, which is a point or a sun: inverse squares."""
    rows = []
    for light in lights:
        squared = ((light.position - point) ** 2).sum()
        rows.append(light.color * light.power / (1.0 if light.kind == "SUN" else 4 * PI * squared))
    return np.array(rows)


@held_against("Eq. 2 in exact fractions", "attenuation", domain="distances 1e-6 to 1e6", limit=1e-15)
def attenuation() -> float:
    rng, worst = generator(1), 0.0
    for distance, *k in zip(10.0 ** rng.uniform(-6, 6, 500), *10.0 ** rng.uniform(-3, 3, (3, 500)), strict=True):
        d, (c, l, q) = Fraction(distance), map(Fraction, k)  # noqa: E741  as the formula has them
        exact = min(1 / (c + l * d + q * d * d), Fraction(1))
        worst = max(worst, relative(sg.attenuation(distance, k), float(exact)))
    return worst


@held_against(
    "Eq. 2 and 3 in exact fractions", "light_weights", "light_weight", "Light", domain="200 point lights", limit=1e-14
)
def weights() -> float:
    rng = generator(2)
    lights = [sg.Light("POINT", rng.random(3), rng.normal(size=3), power=1.0) for _ in range(200)]
    rows = []
    for light in lights:
        squared = sum(Fraction(x) ** 2 for x in light.position)
        rows.append([float(Fraction(c) / (1 + squared)) for c in light.color])
    total = [float(sum(map(Fraction, column))) for column in zip(*rows, strict=True)]
    each = relative(sg.light_weights(lights, ORIGIN), rows)
    return max(each, relative(sg.light_weight(lights, ORIGIN), total))


@held_against(
    "inverse square law, in numpy",
    "object_irradiance",
    "object_irradiance_by_light",
    "PreparedRig",
    domain="300 points and suns",
    limit=1e-13,
)
def points_and_suns() -> float:
    lights = some_lights(generator(3), 300)
    exact = facing(lights, np.zeros(3))
    rig = sg.PreparedRig(lights)
    each = relative(sg.object_irradiance_by_light(rig, ORIGIN), exact)
    return max(each, relative(sg.object_irradiance(lights, ORIGIN), exact.sum(axis=0)))


@held_against(
    "Gauss-Legendre rule of 200 x 200 nodes over the light, in numpy",
    "surface_irradiance",
    domain="rectangles in full view, 1 to 4 of their size away",
    limit=1e-13,
)
def rectangles() -> float:
    rng, worst = generator(4), 0.0
    node, weight = np.polynomial.legendre.leggauss(200)
    for _ in range(20):
        size = rng.uniform(0.2, 2.0, 2)
        light = sg.Light("AREA", position=(0, 0, 0), power=50.0, size_x=size[0], size_y=size[1])
        point = np.array([*rng.uniform(-1, 1, 2), -size.max() * rng.uniform(1.0, 4.0)])
        normal = np.array([0.0, 0.0, 1.0])
        x, y = np.meshgrid(0.5 * size[0] * node, 0.5 * size[1] * node, indexing="ij")
        away = np.stack([x, y, 0 * x], axis=-1) - point
        squared = (away**2).sum(axis=-1)
        # Radiance power / (pi area); cosines at both ends are the height over the distance.
        integrand = 50.0 / (PI * size.prod()) * (away @ normal) ** 2 / squared**2
        exact = 0.25 * size.prod() * weight @ integrand @ weight
        worst = max(worst, relative(sg.surface_irradiance([light], point[None], normal[None])[0], exact))
    return worst


@held_against(
    "closed form of the view factor of a disk off its axis",
    "surface_irradiance",
    domain="a disk, 0 to 3 aside of its axis",
    limit=1e-12,
)
def disks() -> float:
    radius, height = 0.5, 1.5
    disk = sg.Light("AREA", position=(0, 0, height), size_x=1, size_y=1, area_shape="DISK")
    aside = np.linspace(0.0, 3.0, 50)
    s = aside**2 + height**2 + radius**2
    view = 0.5 * (1 - (s - 2 * radius**2) / np.sqrt(s**2 - 4 * aside**2 * radius**2))
    points = np.stack([aside, 0 * aside, 0 * aside], axis=1)
    found = sg.surface_irradiance([disk], points, np.tile([0.0, 0.0, 1.0], (50, 1)))[:, 0]
    return relative(found, view / (PI * radius**2))


@held_against("vector sums, in numpy", "far_side", domain="500 points, normals of any length", limit=1e-13)
def far_sides() -> float:
    rng = generator(5)
    points, normals, depth = rng.normal(size=(500, 3)), rng.normal(size=(500, 3)), rng.random(500)
    unit = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    at, along = sg.far_side(points, normals, depth)
    return max(of_largest(at, points - depth[:, None] * unit), of_largest(along, -unit))


@held_against(
    "surface_irradiance at the far side, itself held above", "far_side_irradiance", domain="200 points", limit=0.0
)
def far_side_irradiance() -> float:
    rng = generator(6)
    points, normals, lights = rng.normal(size=(200, 3)), rng.normal(size=(200, 3)), some_lights(rng, 9)
    there = sg.surface_irradiance(lights, *sg.far_side(points, normals, 0.3))
    return of_largest(sg.far_side_irradiance(lights, points, normals, 0.3), there)


@held_against(
    "inverse squares of what is left out, against the bound told",
    "PreparedRig.cull",
    domain="60 rigs of 30 lights, boxes",
    limit=0.0,
)
def culling() -> float:
    rng, beyond, rigs = generator(7), 0.0, 0
    for _ in range(60):
        lights = some_lights(rng, 30)
        corner = rng.normal(size=3) * 0.2
        told = sg.PreparedRig(lights).cull(corner, corner + 0.1, 3.0)
        left_out = [light for index, light in enumerate(lights) if index not in told["kept"]]
        if left_out:
            rigs += 1
            missing = facing(left_out, corner + 0.1 * rng.random(3)).sum(axis=0)
            beyond = max(beyond, float((missing / np.maximum(told["bound"], 1e-300)).max()) - 1.0)
    assert rigs > 20
    return max(beyond, 0.0)


@held_against(
    "irradiance at 100 points of the box, against the bound told",
    "object_irradiance_error",
    domain="20 rigs of 10 lights",
    limit=0.0,
)
def one_weight_for_an_object() -> float:
    rng, beyond = generator(8), 0.0
    for _ in range(20):
        lights = some_lights(rng, 10)
        bound = sg.object_irradiance_error(lights, ORIGIN, (-0.2, -0.2, -0.2), (0.2, 0.2, 0.2))
        here = facing(lights, np.zeros(3)).sum(axis=0)
        for point in rng.uniform(-0.2, 0.2, (100, 3)):
            off = np.abs(facing(lights, point).sum(axis=0) - here)
            beyond = max(beyond, float((off / np.maximum(bound, 1e-300)).max()) - 1.0)
    return max(beyond, 0.0)


@held_against("the sum of all lights before", "merge_identical", domain="40 lights, each twice or thrice", limit=1e-13)
def merged() -> float:
    rng = generator(9)
    lights = [light for light in some_lights(rng, 40) for _ in range(int(rng.integers(2, 4)))]
    fewer = sg.merge_identical(lights)
    assert len(fewer) == 40
    return relative(sg.object_irradiance(fewer, ORIGIN), facing(lights, np.zeros(3)).sum(axis=0))


@held_against("inverse squares and arc cosines, in numpy", "light_report", domain="30 lights", limit=1e-13)
def reports() -> float:
    lights = some_lights(generator(10), 30)
    normal = np.array([0.3, -0.5, 0.8])
    each = facing(lights, np.zeros(3))
    toward = np.array([-light.direction if light.kind == "SUN" else light.position for light in lights])
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    cosine = toward @ normal / np.linalg.norm(normal)
    weight = each * np.maximum(cosine, 0.0)[:, None]
    shares = sg.luminance(weight) / sg.luminance(weight.sum(axis=0))
    told = sg.light_report(lights, ORIGIN, normal)
    errors = [
        of_largest([one["weight"] for one in told], weight),
        of_largest([one["share"] for one in told], shares),
        of_largest([one["normal_angle"] for one in told], np.arccos(cosine)),
    ]
    return max(errors)


@held_against(
    "surface_irradiance, itself held above",
    "SurfaceLighting",
    "SurfaceLighting.irradiance",
    domain="6 points and suns, a box of points",
    limit=1e-13,
)
def terms_per_pixel() -> float:
    rng = generator(11)
    lights = some_lights(rng, 6)
    points, normals = rng.uniform(-0.1, 0.1, (300, 3)), rng.normal(size=(300, 3))
    terms = sg.SurfaceLighting(lights, (-0.1, -0.1, -0.1), (0.1, 0.1, 0.1))
    return of_largest(terms.irradiance(points, normals), sg.surface_irradiance(lights, points, normals))


@held_against(
    "pi L, 2 pi / 3 and pi / 4 by order (Ramamoorthi and Hanrahan 2001)",
    "Environment",
    "Environment.irradiance",
    domain="a world of second degree in the direction, as coefficients",
    limit=1e-14,
)
def worlds() -> float:
    rng = generator(12)
    c = rng.random((9, 3))
    c[0] += 10.0
    x, y, z = (normals := (n := rng.normal(size=(200, 3))) / np.linalg.norm(n, axis=1, keepdims=True)).T
    k = np.sqrt(np.array([1, 3, 3, 3, 15, 15, 1.25, 15, 3.75]) / (4 * PI))
    basis = np.stack([1 + 0 * x, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y], axis=1) * k
    factor = np.repeat([PI, 2 * PI / 3, PI / 4], [1, 3, 5])
    return of_largest(sg.Environment(c).irradiance(normals), basis * factor @ c)


@held_against(
    "2 integral of w(mu) mu dmu = 1 by its trapezoids in closed form",
    "AngularWeight",
    "AngularWeight.at",
    domain="a straight transmittance",
    limit=1e-13,
)
def angular_weights() -> float:
    # T = 0.2 + 0.8 mu, whose mean over diffuse light is 2 (0.1 + 0.8 / 3).
    mu = np.linspace(0.0, 1.0, 101)
    weight = sg.AngularWeight(mu, 0.2 + 0.8 * mu)
    return relative(weight.at(mu), ((0.2 + 0.8 * mu) / (0.2 + 1.6 / 3))[:, None])


@held_against("half angle and axis of a made cone", "normal_cone", domain="cones of 0.05 to 1.2", limit=1e-13)
def cones() -> float:
    worst = 0.0
    for half in (0.05, 0.4, 1.2):
        turn = np.linspace(0.0, 2 * PI, 361)[:-1]
        rim = np.stack([np.sin(half) * np.cos(turn), np.sin(half) * np.sin(turn), np.cos(half) + 0 * turn], axis=1)
        axis, angle = sg.normal_cone(rim * 3.0)
        worst = max(worst, abs(angle - half), float(np.abs(axis - (0, 0, 1)).max()))
    return worst


@held_against(
    "powers of two and areas in closed form",
    "exposure_factor",
    "unnormalized_power_factor",
    "legacy_sun_power_factor",
    domain="-20 to 20 stops; each kind of light",
    limit=1e-14,
)
def factors() -> float:
    stops, angle = np.linspace(-20.0, 20.0, 81), np.linspace(0.01, 3.0, 50)
    cosine = np.cos(angle / 2)
    area = {"size_x": 2.0, "size_y": 3.0}
    lights = {
        sg.Light("AREA", area_shape="RECTANGLE", **area): 6.0,
        sg.Light("AREA", area_shape="ELLIPSE", **area): 1.5 * PI,
        sg.Light("POINT", radius=0.3): 4 * PI * 0.09,
        sg.Light("SUN", sun_angle=1.0): PI * np.sin(0.5) ** 2,
    }
    return max(
        relative([sg.exposure_factor(s) for s in stops], 2.0**stops),
        relative([sg.legacy_sun_power_factor(a) for a in angle], 2 * cosine / (1 + cosine)),
        relative([sg.unnormalized_power_factor(light) for light in lights], list(lights.values())),
    )


@held_against("its axes by cross products, in numpy", "light_rotation", domain="100 lights", limit=1e-14)
def rotations() -> float:
    rng, worst = generator(13), 0.0
    for _ in range(100):
        direction, tangent = rng.normal(size=(2, 3))
        light = sg.Light("AREA", direction=direction, tangent=tangent, size_x=1.0, size_y=1.0)
        z = -direction / np.linalg.norm(direction)
        y = np.cross(z, tangent)
        y /= np.linalg.norm(y)
        worst = max(worst, float(np.abs(sg.light_rotation(light) - np.column_stack([np.cross(y, z), y, z])).max()))
    return worst
