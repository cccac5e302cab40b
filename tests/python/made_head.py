"""A head of balls and a tube, on which guesses about heads can be tried."""

import numpy as np


def ball(center, radii, count=48):
    """An ellipsoid: vertices and triangles."""
    polar, around = np.meshgrid(np.linspace(0.0, np.pi, count), np.linspace(0.0, 2.0 * np.pi, 2 * count), indexing="ij")
    unit = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1)
    return np.array(center) + unit.reshape(-1, 3) * radii, grid(count, 2 * count)


def tube(bottom, top, radius, count=48):
    """An open cylinder along z."""
    height, around = np.meshgrid(np.linspace(bottom, top, count), np.linspace(0.0, 2.0 * np.pi, count), indexing="ij")
    points = np.stack([radius * np.cos(around), radius * np.sin(around) + 0.01, height], axis=-1)
    return points.reshape(-1, 3), grid(count, count)[:, ::-1]


def grid(rows, columns):
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    return np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])


def head(ears=("left", "right"), detail=48):
    """Meters, Z up, facing -Y: a skull, a jaw, a nose, a brow, lips, ears and an open neck."""
    parts = [
        ball((0.0, 0.0, 0.08), (0.076, 0.098, 0.095), detail),
        ball((0.0, -0.040, 0.0), (0.055, 0.055, 0.070), detail),
        ball((0.0, -0.100, 0.035), (0.012, 0.022, 0.024), detail // 2),
        ball((0.0, -0.088, 0.075), (0.045, 0.012, 0.010), detail // 2),
        ball((0.0, -0.092, -0.010), (0.024, 0.010, 0.008), detail // 2),
        tube(-0.13, 0.02, 0.055, detail),
    ]
    return joined(parts + [ear(side, detail // 2) for side in _sides(ears)])


def ear(side, detail):
    """It stands out behind."""
    points, corners = ball((side, 0.01, 0.045), (0.014, 0.016, 0.031), detail)
    points[:, 0] += np.sign(side) * 0.6 * (points[:, 1] - 0.01)
    return points, corners


def body():
    """The head on a person with the arms held out."""
    parts = [head(), ball((0.0, 0.01, -0.40), (0.19, 0.10, 0.32))]
    for side in (1.0, -1.0):
        parts.append(ball((0.45 * side, 0.01, -0.22), (0.33, 0.045, 0.045)))
        parts.append(ball((0.09 * side, 0.01, -1.02), (0.075, 0.085, 0.45)))
        parts.append(ball((0.09 * side, -0.05, -1.45), (0.045, 0.12, 0.035)))
    return joined(parts)


def joined(parts):
    vertices, triangles, count = [], [], 0
    for points, corners in parts:
        vertices.append(points)
        triangles.append(corners + count)
        count += len(points)
    return np.concatenate(vertices), np.concatenate(triangles)


def _sides(ears):
    return [x for name, x in (("left", 0.082), ("right", -0.082)) if name in ears]
