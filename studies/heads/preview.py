"""What is about to be lit, drawn in a moment: the head from the front and from the side, its ears marked."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from studies.heads.any_head import Placed
from studies.heads.samples import Array

SIZE = 170
BACKGROUND, SKIN, MARK = np.array([22, 24, 28]), np.array([206, 160, 138]), np.array([255, 120, 60])


def draw(placed: Placed, path: Path) -> None:
    """Writes a PNG: left what the front camera sees, right the side at which the first ear is."""
    side = placed.ears[0].side if placed.ears else 1.0
    points = placed.samples.points
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    extent = float(np.ptp(points, axis=0).max()) * 1.08
    views = []
    for right, toward in (((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), ((0.0, side, 0.0), (side, 0.0, 0.0))):
        axes = np.array([right, (0.0, 0.0, 1.0), toward])
        image = _splat((points - middle) @ axes.T / extent, placed.samples.normals @ axes.T)
        for ear in placed.ears:
            x, y, depth = axes @ (ear.center - middle) / extent
            if toward[0] == 0.0 or depth > 0.0:
                _circle(image, x, y, 0.75 * ear.size / extent)
        views.append(image)
    path.write_bytes(_png(np.concatenate(views, axis=1)))


def _splat(points: Array, normals: Array) -> NDArray[np.uint8]:
    """Nearest points in front, lit from the camera's upper left."""
    column = np.clip(((0.5 + points[:, 0]) * SIZE).astype(int), 0, SIZE - 1)
    row = np.clip(((0.5 - points[:, 1]) * SIZE).astype(int), 0, SIZE - 1)
    seen = np.flatnonzero(normals[:, 2] > -0.05)
    order = seen[np.argsort(points[seen, 2])]
    light = np.clip(normals @ np.array([-0.35, 0.5, 0.79]), 0.0, 1.0) * 0.85 + 0.15
    image = np.tile(BACKGROUND.astype(np.uint8), (SIZE, SIZE, 1))
    for down, across in ((0, 1), (1, 0), (0, 0)):  # a point covers its neighbors too, less than they themselves do
        where = np.clip(row[order] + down, 0, SIZE - 1), np.clip(column[order] + across, 0, SIZE - 1)
        image[where] = (light[order, None] * SKIN).astype(np.uint8)
    return image


def _circle(image: NDArray[np.uint8], x: float, y: float, radius: float) -> None:
    rows, columns = np.mgrid[:SIZE, :SIZE]
    off = np.hypot(columns - (0.5 + x) * SIZE, rows - (0.5 - y) * SIZE)
    image[np.abs(off - radius * SIZE) < 1.0] = MARK


def _png(image: NDArray[np.uint8]) -> bytes:
    height, width, _ = image.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), image.reshape(height, -1)], axis=1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows.tobytes())), chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)
