"""Where light may come through a body: thin skin and what is near it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["near_thin_skin"]


def near_thin_skin(
    vertices: ArrayLike,
    triangles: ArrayLike,
    thickness_mm: ArrayLike,
    *,
    unit_mm: float = 1.0,
    max_thickness_mm: float = 12.0,
    margin_mm: float = 8.0,
) -> NDArray[np.bool_]:
    """At which vertices of a body of skin light may come through its shape: (n,).

    Thin skin, and what is near it along the edges of the triangles: light goes on sideways in flesh, and falls into
    the thick floor of a fold from the thin wall beside it. On two heads with a light behind the ear, the rest sends
    out 0.2 to 1.6 % of the light that comes through; without the margin it would be 20 to 37 %.

    vertices          (n, 3), finite, in units of unit_mm; those at one position are one
    triangles         (m, 3), whole numbers from 0 to below n
    thickness_mm      (n,), as `thickness` gives it; infinite or NaN where it is not known
    unit_mm           length of one unit of the vertices, mm, above 0
    max_thickness_mm  skin up to this is thin, 0 or more. The default skin lets 0.2 % of the red light through 8 mm
    margin_mm         how far from thin skin, 0 or more

    Raises ValueError naming the argument, the value and what is allowed.
    """
    points = np.asarray(vertices, np.float64)
    corners, thickness = np.asarray(triangles), np.asarray(thickness_mm, np.float64)
    _check(points, corners, thickness)
    for name, value, least in (("unit_mm", unit_mm, "above"), ("margin_mm", margin_mm, "at least")):
        if not (np.isfinite(value) and (value > 0.0 or (value == 0.0 and least == "at least"))):
            raise ValueError(f"{name} is {value}; allowed: a finite number, {least} 0")
    if not max_thickness_mm >= 0.0:
        raise ValueError(f"max_thickness_mm is {max_thickness_mm}; allowed: a number, at least 0")
    if not len(points):
        return np.zeros(0, bool)
    # Seams of a mesh are cuts in its vertices, not in the body.
    places, place_of = np.unique(points, axis=0, return_inverse=True)
    place_of = place_of.reshape(-1)
    distance = np.full(len(places), np.inf)
    distance[place_of[thickness <= max_thickness_mm]] = 0.0
    edges = place_of[np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])]
    lengths = unit_mm * np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1)
    short = lengths <= margin_mm
    edges, lengths = edges[short], lengths[short]
    while True:  # each round goes one edge further
        before = distance.copy()
        for start, end in ((0, 1), (1, 0)):
            reached = distance[edges[:, start]] + lengths
            within = reached <= margin_mm
            np.minimum.at(distance, edges[within, end], reached[within])
        if np.array_equal(before, distance):
            return (distance <= margin_mm)[place_of]


def _check(points: NDArray[np.float64], corners: NDArray[np.int64], thickness: NDArray[np.float64]) -> None:
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise ValueError(f"vertices have shape {points.shape}; allowed: (n, 3), finite")
    is_whole = corners.size == 0 or np.issubdtype(corners.dtype, np.integer)
    if corners.ndim != 2 or corners.shape[1] != 3 or not is_whole:
        raise ValueError(f"triangles have shape {corners.shape}, {corners.dtype}; allowed: (m, 3), whole numbers")
    if corners.size and not (0 <= corners.min() and corners.max() < len(points)):
        raise ValueError(
            f"triangles have indices from {corners.min()} to {corners.max()}; allowed: 0 to {len(points) - 1}"
        )
    if thickness.shape != (len(points),):
        raise ValueError(f"thickness_mm has shape {thickness.shape}; allowed: ({len(points)},), one per vertex")
