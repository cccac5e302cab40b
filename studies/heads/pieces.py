"""Which pieces of a mesh are the head: what lies about it, and strands, lashes and specks, mislead the guesses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studies.heads.samples import Array, welded

#: A piece counts from that part of the surface on; strands of hair and eyeballs do not.
COUNTS = 0.005
#: What is farther than that from the head, in diagonals of its box, lies about it; but not if it is that much.
AWAY, AWAY_PART = 0.03, 0.3


@dataclass
class Pieces:
    """Of the triangles of a mesh, (m,) each."""

    counts: NDArray[np.bool_]  # what is looked at
    away: NDArray[np.bool_]  # what lies about the head
    away_count: int  # pieces that do


def split(vertices: Array, triangles: NDArray[np.integer]) -> Pieces:
    """By what hangs together, vertices at one position being one; ValueError where there is no surface."""
    corners = vertices[triangles]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    if not area.sum() > 0.0:
        raise ValueError("the mesh has no area")
    piece = _piece_of(welded(vertices, triangles))
    count = piece.max() + 1
    areas = np.bincount(piece, area, count)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, piece, corners.min(axis=1))
    np.maximum.at(high, piece, corners.max(axis=1))
    near = np.zeros(count, bool)
    near[areas.argmax()] = True
    while True:
        box = low[near].min(axis=0), high[near].max(axis=0)
        gap = np.maximum(np.maximum(low - box[1], box[0] - high), 0.0)
        more = np.linalg.norm(gap, axis=1) <= AWAY * np.linalg.norm(box[1] - box[0])
        if (more == near).all():
            break
        near = more
    if areas[~near].sum() > AWAY_PART * areas.sum():
        near[:] = True
    large = near & (areas >= COUNTS * areas.sum())
    # A soup of triangles has no large piece.
    counts = large if areas[large].sum() > 0.5 * areas.sum() else near
    return Pieces(counts[piece], ~near[piece], int((~near).sum()))


def _piece_of(corners: NDArray[np.integer]) -> NDArray[np.int64]:
    """A number for each triangle, from 0, by what shares vertices."""
    root = np.arange(corners.max() + 1)
    while True:
        of_corners = root[corners]
        least = of_corners.min(axis=1)
        if (of_corners == least[:, None]).all():
            return np.unique(least, return_inverse=True)[1].ravel()
        np.minimum.at(root, of_corners.ravel(), np.repeat(least, 3))
        while (root != root[root]).any():
            root = root[root]
