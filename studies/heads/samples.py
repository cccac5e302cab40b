"""A surface as points: what the guesses about heads look at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Enough for a grid of a hundred cells across.
COUNT = 60_000


@dataclass
class Samples:
    """Points spread evenly over the triangles of a mesh, with normals; and points of its open border."""

    points: Array  # (n, 3)
    normals: Array  # (n, 3), of length 1
    border: Array  # (k, 3)

    def turned(self, rotation: Array) -> Samples:
        """Each point p as rotation @ p."""
        return Samples(self.points @ rotation.T, self.normals @ rotation.T, self.border @ rotation.T)

    def where(self, points: NDArray[np.bool_], border: NDArray[np.bool_]) -> Samples:
        """Those points, and those of the border."""
        return Samples(self.points[points], self.normals[points], self.border[border])

    def scaled(self, factor: float) -> Samples:
        return Samples(self.points * factor, self.normals, self.border * factor)


def sample(vertices: Array, triangles: NDArray[np.integer], count: int = COUNT) -> Samples:
    """Spreads `count` points evenly; the same mesh has the same points."""
    corners = vertices[triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(cross, axis=1)
    chosen = np.flatnonzero(area > 0.0)
    if not len(chosen):
        raise ValueError("the mesh has no area")
    random = np.random.default_rng(0)
    of = chosen[np.searchsorted(np.cumsum(area[chosen]), random.random(count) * area.sum() * (1.0 - 1e-12))]
    u, v = random.random((2, count))
    flip = u + v > 1.0
    u[flip], v[flip] = 1.0 - u[flip], 1.0 - v[flip]
    a, b, c = (corners[of, k] for k in range(3))
    points = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return Samples(points, cross[of] / area[of, None], _border(vertices, triangles))


def welded(vertices: Array, triangles: NDArray[np.integer]) -> NDArray[np.integer]:
    """(m, 3): the corners of the triangles, vertices at one position as one: seams of a UV map hang together."""
    _, position_of = np.unique(
        np.round(vertices / (1e-6 * np.ptp(vertices, axis=0).max())), axis=0, return_inverse=True
    )
    return position_of.ravel()[triangles]


def _border(vertices: Array, triangles: NDArray[np.integer]) -> Array:
    """Middles of edges with one triangle; seams are no border."""
    corners = welded(vertices, triangles)
    edges = np.sort(np.concatenate([corners[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    original = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    _, first, times = np.unique(edges, axis=0, return_index=True, return_counts=True)
    return vertices[original[first[times == 1]]].mean(axis=1)
