"""Errors and run times of simplified lighting on a sphere the size of a head."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import skinglow as sg

from studies.accuracy import task

#: A sphere of this radius with skin of this depth, m: a simplified head.
RADIUS, DEPTH = 0.1, 0.004
VERTICES = 2000
SEED = 5


@dataclass
class WeightError:
    """Errors and times of one rig."""

    rig: str
    object_rms: float  #: of a single weight for the object, relative to the mean irradiance
    object_bound: float  #: proven bound of the difference, relative to the weight
    surface_rms: float  #: of the material's formula
    surface_worst: float  #: its max difference, relative to the max irradiance
    terms: int
    object_ms: float
    surface_ms: float
    exact_ms: float


@dataclass
class Step:
    """One setting of a tolerance or a number."""

    setting: str
    error: float
    time_ms: float
    detail: str = ""


def _sphere(count: int) -> np.ndarray:
    """Unit normals on a spiral of equal areas."""
    i = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * i / count, np.pi * (1.0 + 5.0**0.5) * i
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)


NORMALS = _sphere(VERTICES)
BOX = ((-RADIUS,) * 3, (RADIUS,) * 3)


def _around(count: int, near: float, far: float, power: float = 20.0) -> list:
    rng = np.random.default_rng(SEED)
    positions = _sphere(count) * rng.uniform(near, far, count)[:, None]
    return [sg.Light(position=p, power=power, color=rng.uniform(0.2, 1.0, 3), radius=0.05) for p in positions]


def _towards_center(position: tuple[float, float, float], **settings: object) -> sg.Light:
    return sg.Light(
        position=position, direction=tuple(-x for x in position), power=50.0, color=(1.0, 0.7, 0.4), **settings
    )


RIGS: dict[str, list] = {
    "a small light at 1 m": [_towards_center((0.0, 1.0, 0.0), kind="POINT")],
    "the same at 0.3 m": [_towards_center((0.0, 0.3, 0.0), kind="POINT")],
    "a soft light, radius 0.2 m, at 1 m": [_towards_center((0.0, 1.0, 0.0), kind="POINT", radius=0.2)],
    "a spot of 30 degrees at 1 m": [_towards_center((0.0, 1.0, 0.0), kind="SPOT", spot_angle=0.52, spot_blend=0.3)],
    "a soft box, 0.6 m by 0.4 m, at 0.7 m": [_towards_center((0.0, 0.7, 0.0), kind="AREA", size_x=0.6, size_y=0.4)],
    "a disk of 1 m at 0.7 m": [
        _towards_center((0.0, 0.7, 0.0), kind="AREA", area_shape="DISK", size_x=1.0, size_y=1.0)
    ],
    "a sun": [_towards_center((0.0, 1.0, 0.0), kind="SUN")],
    "three lights at 0.8 to 2 m": _around(3, 0.8, 2.0),
    "40 lights at 1 to 4 m": _around(40, 1.0, 4.0),
}


def tiled(lights: list, count: int = 40) -> list:
    """The same lights with area lights split into tiles, so that the light of each tile enters at its own angle."""
    found = []
    for light in lights:
        if light.kind != "AREA":
            found.append(light)
            continue
        step = (np.arange(count) + 0.5) / count - 0.5
        x, y = (grid.ravel() for grid in np.meshgrid(step, step))
        if light.area_shape == "ELLIPSE":
            inside = x * x + y * y < 0.25
            x, y = x[inside], y[inside]
        along = light.tangent / np.linalg.norm(light.tangent)
        up = np.cross(light.direction / np.linalg.norm(light.direction), along)
        positions = light.position + np.outer(x * light.size_x, along) + np.outer(y * light.size_y, up)
        size = {"size_x": light.size_x / count, "size_y": light.size_y / count, "tangent": light.tangent}
        shared = {"direction": light.direction, "color": light.color, "power": light.power / len(x), **size}
        found += [sg.Light("AREA", position=position, **shared) for position in positions]
    return found


def exact(lights: list, weight: sg.AngularWeight | None) -> np.ndarray:
    """The irradiance on the far side at each vertex, with the angular weight of the skin."""
    return sg.far_side_irradiance(lights, NORMALS * RADIUS, NORMALS, DEPTH, angular_weight=weight, threads=1)


def shown(lights: list, weight: sg.AngularWeight, **settings: object) -> tuple[sg.SurfaceLighting, np.ndarray]:
    """The lighting of the material at the same points."""
    lighting = sg.SurfaceLighting(lights, *BOX, angular_weight=weight, **settings)
    return lighting, lighting.irradiance(NORMALS * (RADIUS - DEPTH), -NORMALS)


def _rms(difference: np.ndarray, truth: np.ndarray) -> float:
    return float(np.sqrt((difference**2).mean()) / truth.mean())


def weight_errors() -> list[WeightError]:
    """Each rig by one weight for the object and by the material's formula."""
    weight = sg.skin_angular_weight(task.THREE_LAYERS)
    found = []
    for name, lights in RIGS.items():
        _, exact_ms = task.timed(lambda lights=lights: exact(lights, weight))
        truth = exact(tiled(lights), weight)
        one, object_ms = task.timed(lambda lights=lights: sg.object_irradiance(lights, (0.0, 0.0, 0.0)))
        (lighting, surface), _ = task.timed(lambda lights=lights: shown(lights, weight))
        _, surface_ms = task.timed(lambda lights=lights: sg.SurfaceLighting(lights, *BOX, angular_weight=weight))
        bound = sg.object_irradiance_error(lights, (0, 0, 0), *BOX, ((0, 0, 1), np.pi))
        found.append(
            WeightError(
                name,
                _rms(one - truth, truth),
                float(bound.max() / one.max()),
                _rms(surface - truth, truth),
                float(np.abs(surface - truth).max() / truth.max()),
                len(lighting.terms),
                object_ms,
                surface_ms,
                exact_ms,
            )
        )
    return found


def term_steps() -> list[Step]:
    """40 lights with increasing numbers of terms; the others are treated as distant."""
    weight = sg.skin_angular_weight(task.THREE_LAYERS)
    lights = RIGS["40 lights at 1 to 4 m"]
    truth = exact(lights, weight)
    steps = []
    for count in (0, 1, 2, 4, 8, 16, 40):
        (_, surface), _ = task.timed(lambda n=count: shown(lights, weight, max_terms=n))
        _, ms = task.timed(lambda n=count: sg.SurfaceLighting(lights, *BOX, angular_weight=weight, max_terms=n))
        steps.append(Step(str(count), float(np.abs(surface - truth).max() / truth.max()), ms))
    return steps


def area_steps() -> list[Step]:
    """Ellipses and spreads are integrated to a tolerance: 200 points, compared with a tolerance of 1e-12."""
    rng = np.random.default_rng(SEED)
    lights = [
        _towards_center((0.0, 0.7, 0.0), kind="AREA", area_shape="DISK", size_x=1.0, size_y=0.6),
        _towards_center((0.3, 0.5, 0.2), kind="AREA", size_x=0.5, size_y=0.5, spread=1.2),
    ]
    points, normals = rng.uniform(-RADIUS, RADIUS, (200, 3)), _sphere(200)

    def at(tolerance: float) -> Callable[[], np.ndarray]:
        return lambda: sg.surface_irradiance(lights, points, normals, tolerance=tolerance, threads=1)

    truth = at(1e-12)()
    steps = []
    for tolerance in (1e-1, 1e-3, 1e-5, 1e-7, 1e-9):
        values, ms = task.timed(at(tolerance))
        steps.append(Step(f"{tolerance:g}", float(np.abs(values - truth).max() / truth.max()), ms / 400 * 1e3))
    return steps


def culling_steps() -> list[Step]:
    """10,000 lights of which about a hundred matter: lights kept, error bound and actual error."""
    rng = np.random.default_rng(SEED)
    lights = _around(100, 1.0, 3.0, 100.0) + _around(9900, 20.0, 200.0, 0.5)
    order = rng.permutation(len(lights))
    lights = [lights[i] for i in order]
    points, facing = NORMALS[::4] * RADIUS, -NORMALS[::4]
    everything, all_ms = task.timed(lambda: sg.surface_irradiance(lights, points, facing, threads=1))
    whole = float(sg.object_irradiance(lights, (0, 0, 0)).max())
    tree = sg.PreparedRig(lights)
    steps = [Step("0 (all lights)", 0.0, all_ms, f"{len(lights)}")]
    for tolerance in (1e-4, 1e-3, 1e-2, 1e-1):
        result = tree.cull(*BOX, tolerance * whole)
        kept = [lights[k] for k in result["kept"]]

        def cut(tolerance: float = tolerance) -> np.ndarray:
            chosen = tree.cull(*BOX, tolerance * whole)["kept"]
            return sg.surface_irradiance([lights[k] for k in chosen], points, facing, threads=1)

        values, ms = task.timed(cut)
        lost = float(np.abs(values - everything).max() / whole)
        detail = f"{len(kept)}; bound {float(result['bound'].max()) / whole:.1e}"
        steps.append(Step(f"{tolerance:g}", lost, ms, detail))
    return steps
