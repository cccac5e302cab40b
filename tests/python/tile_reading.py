"""Reads images of tiles as a renderer does, and makes meshes for it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import skinglow as sg
from numpy.typing import NDArray


class Mesh(NamedTuple):
    """Faces of any number of corners, cut into triangles as fans."""

    vertices: NDArray[np.float64]
    sizes: NDArray[np.int64]
    corners: NDArray[np.int64]

    @property
    def fans(self) -> NDArray[np.int64]:
        """(m, 3), the corners of each triangle."""
        begins = np.cumsum(self.sizes) - self.sizes
        fans = [(b, b + k, b + k + 1) for b, n in zip(begins, self.sizes, strict=True) for k in range(1, n - 1)]
        return np.array(fans, np.int64).reshape(-1, 3)

    @property
    def triangles(self) -> NDArray[np.int64]:
        return self.corners[self.fans]


def of_triangles(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> Mesh:
    return Mesh(vertices, np.full(len(triangles), 3), triangles.ravel())


def grid(width: float, height: float, nx: int, ny: int, bend: float = 0.0) -> Mesh:
    """Quads in the plane z = 0, or bent up."""
    x, y = np.meshgrid(np.linspace(0, width, nx + 1), np.linspace(0, height, ny + 1), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), bend * np.sin(x.ravel() / width * np.pi)], 1)
    i = np.arange(x.size).reshape(x.shape)
    quads = np.stack([part.ravel() for part in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:])], 1)
    return Mesh(vertices, np.full(len(quads), 4), quads.ravel())


class Points(NamedTuple):
    """Random points of those triangles that have tiles."""

    places: NDArray[np.float64]  #: (n, 3)
    texels: NDArray[np.float32]  #: (n, 3), interpolated as a renderer does


def surface_points(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], texels: NDArray[np.float32], count: int = 20000
) -> Points:
    tiled = np.flatnonzero((texels[:, :, 2] > 0).all(1))
    a, b, c = (vertices[triangles[tiled, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    rng = np.random.default_rng(1)
    chosen = tiled[rng.choice(len(tiled), count, p=area / area.sum())]
    # A quarter on edges, where rounding would show.
    weights = rng.dirichlet(np.ones(3), count)
    weights[: count // 4, 0] = 0.0
    weights /= weights.sum(1, keepdims=True)
    return Points(
        np.einsum("nk,nkc->nc", weights, vertices[triangles[chosen]]),
        np.einsum("nk,nkc->nc", weights.astype(np.float32), texels[chosen]),
    )


def cells(points: Points) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """The first texel of the four that are read, (n, 2), and the way from there, (n, 2)."""
    first = np.floor(points.texels[:, :2])
    return first.astype(np.int64), points.texels[:, :2] - first


def read(pixels: NDArray[np.float32], points: Points) -> NDArray[np.float64]:
    (x, y), (u, v) = (part.T for part in cells(points))
    u, v = u[:, None], v[:, None]
    below = pixels[y, x] * (1 - u) + pixels[y, x + 1] * u
    above = pixels[y + 1, x] * (1 - u) + pixels[y + 1, x + 1] * u
    return below * (1 - v) + above * v


def targets_of(mesh: Mesh, layout: sg.FaceTiles, **options: float) -> sg.TileTargets:
    return sg.TileTargets(mesh.vertices, mesh.triangles, layout.texels[mesh.fans], layout.height, **options)


def split_in_four(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64], texels: NDArray[np.float32]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float32]]:
    """As a modifier subdivides a mesh: middles of edges are shared, texels interpolated for each corner."""
    edges = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], 2).reshape(-1, 2), axis=1)
    unique, index = np.unique(edges, axis=0, return_inverse=True)
    middles = len(vertices) + index.reshape(-1, 3)
    vertices = np.concatenate([vertices, vertices[unique].mean(1)])
    halves = 0.5 * (texels + np.roll(texels, -1, axis=1))
    a, b, c = triangles.T
    ab, bc, ca = middles.T
    pick = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    ta, tb, tc = (texels[:, k] for k in range(3))
    tab, tbc, tca = (halves[:, k] for k in range(3))
    corners = [(ta, tab, tca), (tab, tb, tbc), (tca, tbc, tc), (tab, tbc, tca)]
    return (
        vertices,
        np.concatenate([np.stack(p, 1) for p in pick]),
        np.concatenate([np.stack(p, 1) for p in corners]),
    )
