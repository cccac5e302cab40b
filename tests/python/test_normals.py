"""Of a normal or a direction only the direction counts, whatever its length; a normal of 0 says nothing."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg
from array_calls import scene

LENGTHS = [1e-300, 1e-30, 1e-6, 1.0, 1e20, 1e39, 1e300]
POINTS = np.random.default_rng(0).normal(size=(20, 3))
NORMALS = POINTS / np.linalg.norm(POINTS, axis=1, keepdims=True)
LIGHTS = [
    sg.Light("POINT", position=(2, 0, 5), radius=0.5, power=100),
    sg.Light("SPOT", position=(0, 3, 5), direction=(0, -3, -5), power=100),
    sg.Light("SUN", direction=(0.3, 0.2, -1), power=3),
    sg.Light("AREA", position=(-2, 1, 4), direction=(0.5, -0.2, -1), size_x=2, size_y=1, power=50),
    sg.Light("AREA", position=(1, -2, 4), direction=(0, 0, -1), area_shape="ELLIPSE", size_x=2, size_y=1, power=50),
]
AXIS = np.array((0.3, 0.2, -1.0)) / np.sqrt(1.13)
SKY = sg.Environment(np.random.default_rng(1).uniform(0.5, 1, (4, 8, 3)))
WEIGHT = sg.AngularWeight([0.0, 0.5, 1.0], [0.2, 0.7, 1.0])
MEDIUM = dict(absorption=(0.032, 0.17, 0.48), reduced_scattering=(0.74, 0.88, 1.01), refractive_index=1.0)


@cache
def lobe() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    vertices, triangles = bodies.lobe(levels=2)
    return vertices, triangles, bodies.vertex_normals((vertices, triangles))


@cache
def occluders() -> sg.Occluders:
    vertices, triangles, _normals = lobe()
    return sg.Occluders([(0.1 * vertices + (0.5, 0.5, 2.0), triangles)])


def exitance(scale: float) -> np.ndarray:
    vertices, triangles, normals = lobe()
    light = np.where(vertices[:, 2] > 0.5, 1.0, 0.0)
    return sg.Shape(vertices, triangles, points=vertices, normals=normals * scale, **MEDIUM).exitance(light)


def written_normals(by_corner: bool) -> Callable[[float], np.ndarray]:
    given = NORMALS[:3][None] if by_corner else NORMALS[:3]

    def call(scale: float) -> np.ndarray:
        text = "".join(scene(normals=given * scale, surface_color=(1, 1, 1)).values())
        listed = re.search(r"normal_vectors \{ 3,(.*?)\}", text, flags=re.DOTALL)[1]
        return np.array(re.findall(r"[-+.\de]+", listed), float)

    return call


def light(kind: str, scale: float, **more: object) -> sg.Light:
    return sg.Light(kind, position=(-2, 1, 4), direction=AXIS * scale, power=50, **more)


def lit_by(kind: str, **more: object) -> Callable[[float], np.ndarray]:
    return lambda s: sg.surface_irradiance([light(kind, s, **more)], POINTS, NORMALS)


AREA = dict(size_x=2.0, size_y=1.0, spread=2.0)
#: What is found with normals or directions of a length.
CALLS: dict[str, Callable[[float], object]] = {
    "Shape": exitance,
    "surface_irradiance": lambda s: sg.surface_irradiance(LIGHTS, POINTS, NORMALS * s, environment=SKY),
    "surface_irradiance, by angle": lambda s: sg.surface_irradiance(LIGHTS, POINTS, NORMALS * s, angular_weight=WEIGHT),
    "far_side": lambda s: np.hstack(sg.far_side(POINTS, NORMALS * s, 0.1)),
    "far_side_irradiance": lambda s: sg.far_side_irradiance(LIGHTS, POINTS, NORMALS * s, 0.1, environment=SKY),
    "visible_fraction": lambda s: occluders().visible_fraction(LIGHTS, POINTS, NORMALS * s).at_points,
    "Environment.irradiance": lambda s: SKY.irradiance(NORMALS * s),
    "SurfaceLighting.irradiance": lambda s: (
        sg.SurfaceLighting(LIGHTS, (-2, -2, -2), (2, 2, 2), SKY).irradiance(POINTS, NORMALS * s)
    ),
    "normal_cone": lambda s: np.hstack(sg.normal_cone((NORMALS + 2 * AXIS) * s)),
    "light_report": lambda s: [
        (e["normal_angle"], *e["weight"]) for e in sg.light_report(LIGHTS, (0, 0, 0), np.array((0, 0.5, 1)) * s)
    ],
    "object_irradiance_error": lambda s: sg.object_irradiance_error(
        LIGHTS, (0, 0, 0), (-1, -1, -1), (1, 1, 1), facing=(np.array((0, 0.5, 1)) * s, 0.3)
    ),
    "povray_files, per vertex": written_normals(by_corner=False),
    "povray_files, per corner": written_normals(by_corner=True),
    "Light.direction of a sun": lit_by("SUN", sun_angle=0.1),
    "Light.direction of a spot": lit_by("SPOT", spot_angle=2.0),
    "Light.direction of an area": lit_by("AREA", **AREA),
    "Light.tangent": lambda s: sg.surface_irradiance(
        [light("AREA", 1.0, tangent=np.array((0.6, 0.8, 0.2)) * s, **AREA)], POINTS, NORMALS
    ),
    "Light.moved": lambda s: sg.surface_irradiance([light("AREA", s, **AREA).moved(np.eye(4))], POINTS, NORMALS),
    "light_rotation": lambda s: sg.light_rotation(light("AREA", s, tangent=np.array((0.6, 0.8, 0.2)) * s)),
    "SurfaceLighting.terms": lambda s: sg.SurfaceLighting([light("SPOT", s)], (-2, -2, -2), (2, 2, 2)).terms,
    "PreparedRig.cull": lambda s: sg.PreparedRig([light("SPOT", s)]).cull((-2, -2, -2), (2, 2, 2), 0.0)["bound"],
    "light_report of a spot": lambda s: sg.light_report([light("SPOT", s)], (0, 0, 0))[0]["axis_angle"],
    "visible_fraction of an area": lambda s: (
        occluders().visible_fraction([light("AREA", s, **AREA)], POINTS, NORMALS).at_points
    ),
}


@cache
def unit_answer(name: str) -> np.ndarray:
    return np.asarray(CALLS[name](1.0), float)


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("name", CALLS)
def test_only_the_direction_counts(name: str, length: float) -> None:
    expected = unit_answer(name)
    np.testing.assert_allclose(CALLS[name](length), expected, rtol=1e-9, atol=1e-12 * (1 + np.abs(expected).max()))


def test_lengths_may_differ_from_point_to_point() -> None:
    vertices, triangles, normals = lobe()
    lengths = 10.0 ** np.random.default_rng(3).uniform(-30, 39, (len(vertices), 1))
    light = np.where(vertices[:, 2] > 0.5, 1.0, 0.0)
    found = sg.Shape(vertices, triangles, points=vertices, normals=normals * lengths, **MEDIUM).exitance(light)
    np.testing.assert_allclose(found, unit_answer("Shape"), rtol=1e-6)


def test_a_normal_of_zero_is_any() -> None:
    vertices, triangles, normals = lobe()
    middles = vertices[triangles].mean(axis=1)
    none, zero = (
        sg.Shape(vertices, triangles, points=middles, normals=given, **MEDIUM)
        for given in (None, np.zeros_like(middles))
    )
    np.testing.assert_array_equal(none.points, zero.points)
    light = np.where(vertices[:, 2] > 0.5, 1.0, 0.0)
    np.testing.assert_array_equal(none.exitance(light), zero.exitance(light))
    for found in (
        sg.surface_irradiance(LIGHTS, POINTS, 0 * NORMALS, environment=SKY),
        SKY.irradiance(0 * NORMALS),
        sg.SurfaceLighting(LIGHTS, (-2, -2, -2), (2, 2, 2), SKY).irradiance(POINTS, 0 * NORMALS),
    ):
        assert not found.any()
