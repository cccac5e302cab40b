"""Truncation error of nine coefficients: irradiance of a world for many normals, compared with the full integral."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skinglow as sg

HEIGHT = 512
#: Direction to the sun, unit vector.
SUN = np.array((0.6, 0.0, 0.8))
#: Angles of a surface's normal to the sun, degrees, in the sun's vertical plane.
ANGLES = (0, 45, 90, 135, 180)


@dataclass
class WorldError:
    """Errors relative to the max irradiance over all normals in this world."""

    world: str
    at_angles: list[float]  #: signed, nine coefficients minus the integral
    worst: float  #: of 500 normals all around
    negative: float  #: fraction of those normals where nine coefficients are negative and clamped at 0
    object_weight: float  #: of the mean over all normals, relative


def _directions() -> np.ndarray:
    v, u = np.meshgrid((np.arange(HEIGHT) + 0.5) / HEIGHT, (np.arange(2 * HEIGHT) + 0.5) / (2 * HEIGHT), indexing="ij")
    theta, azimuth = np.pi * v, np.pi * (1.0 - 2.0 * u)
    return np.stack([np.sin(theta) * np.cos(azimuth), np.sin(theta) * np.sin(azimuth), np.cos(theta)], axis=-1)


def worlds(d: np.ndarray) -> dict[str, np.ndarray]:
    """Radiance by direction, one channel; directions (height, width, 3) from the top row down."""
    z = d[..., 2]
    # Bright at the horizon, a third of that at the zenith, a tenth on the ground: a generic sky.
    sky = np.where(z > 0.0, 1.0 - 2.0 / 3.0 * np.abs(z), 0.1)

    def with_sun(radius_degrees: float, fraction: float) -> np.ndarray:
        """The sky with a disk that contributes that fraction of the irradiance on a surface facing it."""
        disc = d @ SUN > np.cos(np.radians(radius_degrees))
        facing = np.maximum(d @ SUN, 0.0)
        return sky + disc * _integral(sky * facing) / _integral(disc * facing) * fraction / (1.0 - fraction)

    return {
        "constant": np.ones_like(z),
        "gradient sky over dark ground": sky,
        "white sky, black ground": (z > 0.0).astype(float),
        "soft box: a white cap of 30 degrees": (d @ SUN > np.cos(np.radians(30.0))).astype(float),
        "sky and sun of 2 degrees, sun 50 %": with_sun(2.0, 0.5),
        "sky and sun of 2 degrees, sun 85 %": with_sun(2.0, 0.85),
        "a spot of 2 degrees alone": (d @ SUN > np.cos(np.radians(2.0))).astype(float),
    }


def _integral(values: np.ndarray) -> float:
    edges = np.cos(np.pi * np.arange(HEIGHT + 1) / HEIGHT)
    return float((values.sum(axis=1) * (edges[:-1] - edges[1:])).sum() * np.pi / HEIGHT)


def _normals() -> tuple[np.ndarray, np.ndarray]:
    """At ANGLES to the sun, and 500 all around on a spiral (of equal areas)."""
    across = np.array((SUN[2], 0.0, -SUN[0]))
    a = np.radians(ANGLES)[:, None]
    i = np.arange(500) + 0.5
    z, turn = 1.0 - 2.0 * i / 500, np.pi * (1.0 + 5.0**0.5) * i
    r = np.sqrt(1.0 - z * z)
    return np.cos(a) * SUN + np.sin(a) * across, np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=-1)


def world_errors() -> list[WorldError]:
    """Each world for each normal. The integral is over the same pixels, so the error is that of the omitted bands."""
    d = _directions()
    listed, around = _normals()
    found = []
    for name, radiance in worlds(d).items():
        pixels = np.repeat(radiance.astype(np.float32)[..., None], 3, axis=2)
        nine = sg.Environment.from_image(pixels)
        normals = np.concatenate([listed, around])
        exact = np.array([_integral(radiance * np.maximum(d @ n, 0.0)) for n in normals])
        off = (nine.irradiance(normals)[:, 0] - exact) / exact.max()
        mean = np.pi * _integral(radiance) / (4.0 * np.pi)
        found.append(
            WorldError(
                name,
                [float(e) for e in off[: len(listed)]],
                float(np.abs(off).max()),
                float((nine.irradiance(around)[:, 0] == 0.0).mean()),
                float(abs(nine.mean_irradiance[0] / mean - 1.0)),
            )
        )
    return found
