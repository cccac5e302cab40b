"""What is measured: a head's ear, a light on it, a medium; and what everything is compared by."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import skinglow as sg
from numpy.typing import NDArray

from studies.medium import SKIN1, Medium

Array = NDArray[np.float64]

MM_PER_METER = 1000.0
#: Directions from the ear to the light: the head looks along -Y, its ear is on +X.
LIGHTS = {"behind": (0.2, 0.97, 0.1), "beside": (0.75, 0.65, 0.15)}
LIGHT_DISTANCE_MM, LIGHT_RADIUS_MM, BEAM_MM = 400.0, 50.0, 96.0
#: Of the light: about 1 W/m^2 at the ear.
LIGHT_POWER_W = 20.0

# Skin 1 of Jensen et al. with three times the absorption, and skin that scatters more and absorbs half.
DARK = Medium("dark", SKIN1.reduced_scattering, (0.10, 0.40, 0.90))
LIGHT = Medium("light", (1.1, 1.4, 1.7), (0.015, 0.06, 0.20))

#: The ear: skin near its center that is thinner than THIN_MM.
EAR_RADIUS_MM, THIN_MM = 40.0, 25.0
#: Back-lit: less than this part of the brightest light (99th percentile).
BACK_LIT = 0.01


@dataclass(frozen=True)
class Case:
    head: str
    light: str
    medium: Medium
    refractive_index: float = 1.0
    surface: str = "rough"
    is_solved_fine: bool = True  # with cells of 0.5 mm too

    @property
    def name(self) -> str:
        suffix = "" if self.refractive_index == 1.0 else f"-{self.surface}"
        return f"{self.head}-{self.light}-{self.medium.name.split()[0]}{suffix}"


class HeadMesh:
    """A head in mm, and its ear."""

    def __init__(self, path: Path) -> None:
        with np.load(path) as file:
            self.vertices: Array = file["vertices_mm"].astype(np.float64)
            self.normals: Array = file["normals"].astype(np.float64)
            self.triangles = file["triangles"]

    @cached_property
    def thickness(self) -> Array:
        return sg.thickness(self.vertices, self.triangles, unit_mm=1.0)

    @cached_property
    def ear_center(self) -> Array:
        """Of the thin skin about the outermost point of the upper head on +X."""
        high = self.vertices[:, 2].max()
        upper = (self.vertices[:, 2] > high - 260.0) & (self.vertices[:, 2] < high - 65.0)
        outermost = self.vertices[upper][self.vertices[upper, 0].argmax()]
        near = np.linalg.norm(self.vertices - outermost, axis=1) < 50.0
        thin = self.vertices[near & (self.thickness < 8.0)]
        return 0.5 * (thin.min(axis=0) + thin.max(axis=0))

    @cached_property
    def ear(self) -> NDArray[np.int64]:
        """Its vertices."""
        near = np.linalg.norm(self.vertices - self.ear_center, axis=1) < EAR_RADIUS_MM
        return np.flatnonzero(near & (self.thickness < THIN_MM))

    @cached_property
    def vertex_area(self) -> Array:
        """mm^2: a third of the triangles about each vertex."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return np.bincount(self.triangles.ravel(), np.repeat(area / 3.0, 3), len(self.vertices))

    def light(self, name: str) -> sg.Light:
        """A warm spot on the ear; meters, as in Blender."""
        direction = np.array(LIGHTS[name]) / np.linalg.norm(LIGHTS[name])
        position = (self.ear_center + LIGHT_DISTANCE_MM * direction) / MM_PER_METER
        return sg.Light(
            "SPOT",
            (1.0, 1.0, 1.0),
            tuple(position),
            tuple(-direction),
            power=LIGHT_POWER_W,
            name="light",
            radius=LIGHT_RADIUS_MM / MM_PER_METER,
            spot_angle=float(2.0 * np.arctan(0.5 * BEAM_MM / LIGHT_DISTANCE_MM)),
            spot_blend=0.2,
        )

    def irradiance(self, name: str) -> Array:
        """W/m^2 by vertex, one for all channels: the light is white."""
        return self.irradiance_of([self.light(name)])[:, 0]

    def irradiance_of(self, lights: list[sg.Light]) -> Array:
        """W/m^2 by vertex and channel. What the head itself hides is dark."""
        points = self.vertices / MM_PER_METER
        occluders = sg.Occluders([(points, self.triangles)], origin=tuple(self.ear_center / MM_PER_METER))
        result = np.zeros((len(points), 3))
        for light in lights:
            free = sg.surface_irradiance([light], points, self.normals)
            lit = free.max(axis=1) > 1e-6 * free.max()
            lifted = points[lit] + 2e-5 * self.normals[lit]
            seen = occluders.visible_fraction([light], lifted, self.normals[lit], samples=32).at_points[:, 0]
            result[lit] += free[lit] * seen[:, None]
        return result

    def back_lit(self, irradiance: Array) -> NDArray[np.bool_]:
        """Of the ear's vertices, those in the dark."""
        near = np.linalg.norm(self.vertices - self.ear_center, axis=1) < EAR_RADIUS_MM
        return irradiance[self.ear] < BACK_LIT * np.percentile(irradiance[near], 99)

    def table(self, light: str, medium: Medium) -> Array:
        """Exitance by the thickness table: what comes through, and what a thick body sends back where it is lit."""
        vertices = self.vertices / MM_PER_METER
        far = sg.far_side_irradiance([self.light(light)], vertices, self.normals, self.thickness / MM_PER_METER)
        through = medium.transmittance(np.minimum(self.thickness, 60.0))
        thick = [
            sg.slab([sg.Layer(1.0, mua, mus, 0.0, np.inf)], "diffuse").reflectance
            for mua, mus in zip(medium.absorption, medium.reduced_scattering, strict=True)
        ]
        return through * far[:, :1] + np.array(thick) * self.irradiance(light)[:, None]


@dataclass
class Error:
    """RMS difference over the mean of the reference, in percent, without the reference's noise."""

    channels: Array  # (3,)
    together: float
    standard_error: float  # of `together`


def error(values: Array, a: Array, b: Array, weight: Array) -> Error:
    """Of values (n, channels) from two halves of a reference whose noise is independent."""
    part = weight / weight.sum()
    mean = (part[:, None] * 0.5 * (a + b)).sum(axis=0)
    squares = (values - a) * (values - b)
    by_channel = (part[:, None] * squares).sum(axis=0)
    of_all = squares.mean(axis=1)
    rms = float(np.sqrt(max((part * of_all).sum(), 0.0)))
    spread = float(np.sqrt((part**2 * (of_all - (part * of_all).sum()) ** 2).sum()))
    scale = 100.0 / mean.mean()
    return Error(
        100.0 * np.sqrt(np.maximum(by_channel, 0.0)) / mean,
        rms * scale,
        spread / (2.0 * rms) * scale if rms > 0.0 else float("inf"),
    )
