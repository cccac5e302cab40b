"""Bodies for tests of light in a shape, in mm, wound counter-clockwise from outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Body = tuple[NDArray[np.float64], NDArray[np.int64]]


def ball(radius: float, levels: int = 4) -> Body:
    """An octahedron, each triangle split in four `levels` times and pushed out to the sphere."""
    vertices = [np.array(v, float) for v in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(levels):
        middles: dict[tuple[int, int], int] = {}

        def middle(a: int, b: int, middles: dict[tuple[int, int], int] = middles) -> int:
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(vertices)
                vertices.append(vertices[a] + vertices[b])
                vertices[-1] /= np.linalg.norm(vertices[-1])
            return middles[key]

        finer = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    return radius * np.array(vertices), np.array(faces)


def icosahedron(x: float, y: float, z: float) -> Body:
    """Its semi-axes; the first vertex is on the positive z axis, the next five about it, at z / sqrt(5)."""
    turn = 0.4 * np.pi * np.arange(5)
    upper, lower = (
        np.stack([2.0 * np.cos(turn + more), 2.0 * np.sin(turn + more), np.full(5, height)], 1) / np.sqrt(5.0)
        for more, height in ((0.0, 1.0), (0.2 * np.pi, -1.0))
    )
    i = np.arange(5)
    j = (i + 1) % 5
    top, bottom = np.zeros(5, int), np.full(5, 11)
    sides = [(top, 1 + i, 1 + j), (1 + i, 6 + i, 1 + j), (1 + j, 6 + i, 6 + j), (6 + i, bottom, 6 + j)]
    vertices = np.concatenate([[(0.0, 0.0, 1.0)], upper, lower, [(0.0, 0.0, -1.0)]]) * (x, y, z)
    return vertices, np.concatenate([np.stack(side, 1) for side in sides])


def plate(width: float, thickness: float, cells: int) -> Body:
    """Centered on the z axis, from z = 0 up; its faces share the vertices of their edges."""
    line = np.linspace(-0.5 * width, 0.5 * width, cells + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    bottom = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], 1)
    index = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    up = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    rim = np.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
    after = np.roll(rim, -1)
    sides = [np.stack([rim, after, after + x.size], 1), np.stack([rim, after + x.size, rim + x.size], 1)]
    return np.concatenate([bottom, bottom + [0.0, 0.0, thickness]]), np.concatenate([up[:, ::-1], up + x.size, *sides])


def lobe(size: float = 12.0, thickness: float = 3.0, levels: int = 4) -> Body:
    """A bent flat ellipsoid, something like an ear's lobe: convex here, concave there."""
    vertices, triangles = ball(1.0, levels)
    vertices = vertices * [0.5 * size, 0.4 * size, 0.5 * thickness]
    vertices[:, 2] += 0.15 * size * np.sin(vertices[:, 0] / (0.3 * size))
    return vertices, triangles


def vertex_areas(body: Body) -> NDArray[np.float64]:
    """A third of the triangles about each vertex."""
    vertices, triangles = body
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.bincount(triangles.ravel(), np.repeat(area / 3.0, 3), len(vertices))


def vertex_normals(body: Body) -> NDArray[np.float64]:
    vertices, triangles = body
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], np.cross(b - a, c - a))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)
