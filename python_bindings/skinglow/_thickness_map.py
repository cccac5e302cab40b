"""Thickness as numbers, colors and images: what hosts show of it, and what they share with other programs."""

import struct
import zlib
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._numbers import fixed, real_number, real_numbers, whole_number

__all__ = [
    "ThicknessImage",
    "ThicknessSummary",
    "bake_thickness",
    "gray_png",
    "sample_image",
    "thickness_colors",
    "thickness_summary",
]

#: Colors of `thickness_colors` from thin to thick, 8-bit sRGB, at equal steps, each darker than the one before.
RAMP = fixed(
    np.array(
        ((255, 246, 199), (255, 205, 105), (249, 152, 66), (222, 91, 73), (168, 48, 92), (98, 30, 95), (31, 12, 56))
    )
)
#: Color where there is no thickness.
NO_THICKNESS = fixed(np.array((0.35, 0.45, 0.5)))
#: Texels that are computed at a time.
BLOCK = 1 << 20


class ThicknessSummary(NamedTuple):
    """How thickness is distributed over vertices."""

    min_mm: float
    median_mm: float
    max_mm: float
    histogram: NDArray[np.float64]  #: (bins,) fraction of the vertices in equal steps from 0 to the given limit
    fraction_above: float  #: of the vertices, thicker than that


def thickness_summary(thickness_mm: ArrayLike, limit_mm: float, bins: int = 32) -> ThicknessSummary:
    """Summary of thicknesses (n,), mm; all 0 without any.

    limit_mm  right end of the histogram, mm, above 0
    bins      of the histogram, 1 or more
    """
    values = _finite("thickness_mm", thickness_mm, 1)
    _positive("limit_mm", limit_mm)
    if whole_number("bins", bins) < 1:
        raise ValueError(f"bins = {bins!r} is not allowed: 1 or more")
    if not len(values):
        return ThicknessSummary(0.0, 0.0, 0.0, np.zeros(bins), 0.0)
    counts, _edges = np.histogram(values, bins, (0.0, limit_mm))
    low, median, high = np.quantile(values, (0.0, 0.5, 1.0))
    above = float(np.mean(values > limit_mm))
    return ThicknessSummary(float(low), float(median), float(high), counts / len(values), above)


def thickness_colors(thickness_mm: ArrayLike, max_mm: float) -> NDArray[np.float64]:
    """Colors (..., 3) of a heat map, sRGB 0 to 1: bright where thin, dark from max_mm on, gray where below 0
    or not a number.

    thickness_mm  (...), mm
    max_mm        finite, above 0
    Raises ValueError naming the argument.
    """
    _positive("max_mm", max_mm)
    values = real_numbers("thickness_mm", thickness_mm)
    steps = np.clip(values / max_mm, 0.0, 1.0) * (len(RAMP) - 1)
    colors = np.stack([np.interp(steps, np.arange(len(RAMP)), RAMP[:, i] / 255.0) for i in range(3)], axis=-1)
    return np.where(values[..., None] >= 0.0, colors, NO_THICKNESS)


class ThicknessImage(NamedTuple):
    """Thickness in texture space, bottom row first."""

    thickness_mm: NDArray[np.float32]  #: (height, width)
    covered: NDArray[np.bool_]  #: (height, width), by a triangle or its margin


def bake_thickness(
    uv: ArrayLike, thickness_mm: ArrayLike, width: int, height: int, *, margin: int = 8, outside_mm: float = 0.0
) -> ThicknessImage:
    """Thickness of triangles at the centers of texels, linear over each triangle.

    uv            (m, 3, 2), of each triangle's corners; what lies outside of 0 to 1 is left out
    thickness_mm  (m, 3), at the corners
    width         of the image, texels; and its height, each 1 to 16384
    margin        texels by which islands are extended, so that filtering does not mix in what is outside; 0 or more
    outside_mm    value of texels that are not covered
    Where triangles overlap, the last one counts.
    """
    corners = _finite("uv", uv, 3)
    values = _finite("thickness_mm", thickness_mm, 2)
    if corners.shape[1:] != (3, 2) or values.shape != corners.shape[:2]:
        raise ValueError(f"uv {corners.shape} and thickness_mm {values.shape} are not allowed: (m, 3, 2) and (m, 3)")
    for name, number, low in (("width", width, 1), ("height", height, 1), ("margin", margin, 0)):
        if not low <= whole_number(name, number) <= 16384:
            raise ValueError(f"{name} = {number!r} is not allowed: {low} to 16384")
    outside = real_number("outside_mm", outside_mm)
    image, covered = np.full((height, width), outside, np.float32), np.zeros((height, width), bool)
    # In texels, with the center of the first at 0.
    points = corners * (width, height) - 0.5
    edges, areas = _edge_functions(points)
    for triangle, row, first, count in _spans(points, edges, areas, width, height):
        # One entry a texel.
        span = np.repeat(np.arange(len(count)), count)
        x = first[span] + np.arange(len(span)) - np.repeat(np.cumsum(count) - count, count)
        inside, y = triangle[span], row[span]
        weights = (edges[inside] * np.stack([x, y, np.ones_like(x)], axis=-1)[:, None]).sum(axis=2)
        weights = np.clip(weights / areas[inside, None], 0.0, 1.0)
        mean = (weights * values[inside]).sum(axis=1) / weights.sum(axis=1)
        image[y, x], covered[y, x] = mean, True
    for _ in range(margin):
        _grow(image, covered)
    return ThicknessImage(image, covered)


def _edge_functions(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Factors (m, 3, 3) of x, y and 1 in each corner's weight times the doubled area, and that area (m,), 0 or more."""
    after, last = points[:, (1, 2, 0)], points[:, (2, 0, 1)]
    a, b = after[..., 1] - last[..., 1], last[..., 0] - after[..., 0]
    c = after[..., 0] * last[..., 1] - last[..., 0] * after[..., 1]
    areas = c.sum(axis=1)
    sign = np.where(areas < 0.0, -1.0, 1.0)
    return np.stack([a, b, c], axis=-1) * sign[:, None, None], np.abs(areas)


def _spans(
    points: NDArray[np.float64], edges: NDArray[np.float64], areas: NDArray[np.float64], width: int, height: int
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]]:
    """Blocks of (triangle, row, first texel, number of texels), each (n,), of the rows that triangles cross."""
    low = np.clip(np.ceil(points[..., 1].min(axis=1) - 1e-6), 0, height).astype(np.int64)
    high = np.clip(np.floor(points[..., 1].max(axis=1) + 1e-6), -1, height - 1).astype(np.int64)
    rows = np.where(areas > 0.0, np.maximum(high - low + 1, 0), 0)
    triangle = np.repeat(np.arange(len(rows)), rows)
    row = low[triangle] + np.arange(len(triangle)) - np.repeat(np.cumsum(rows) - rows, rows)
    for start in range(0, len(triangle), max(BLOCK // width, 1)):
        t, y = triangle[start : start + max(BLOCK // width, 1)], row[start : start + max(BLOCK // width, 1)]
        slope, rest = edges[t, :, 0], edges[t, :, 1] * y[:, None] + edges[t, :, 2]
        # A little wider, so that no texel between two triangles is missed.
        slack = 1e-6 * np.abs(slope) + 1e-9 * areas[t, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -(rest + slack) / slope
            crossing_high = (rest + slack) / -slope
        left = np.where(slope > 0.0, crossing, -np.inf).max(axis=1)
        right = np.where(slope < 0.0, crossing_high, np.inf).min(axis=1)
        left = np.where(((slope == 0.0) & (rest < -slack)).any(axis=1), np.inf, left)
        first = np.clip(np.ceil(left), 0, width).astype(np.int64)
        last = np.clip(np.floor(right), -1, width - 1).astype(np.int64)
        count = np.maximum(last - first + 1, 0)
        yield t, y, first, count


def _grow(image: NDArray[np.float32], covered: NDArray[np.bool_]) -> None:
    """Extends what is covered by one texel, with the mean of its covered neighbors."""
    height, width = image.shape
    values, known = np.pad(np.where(covered, image, 0.0), 1), np.pad(covered, 1)
    total, number = np.zeros((height, width), np.float32), np.zeros((height, width), np.uint8)
    for dy, dx in ((0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1), (2, 2)):
        total += values[dy : dy + height, dx : dx + width]
        number += known[dy : dy + height, dx : dx + width]
    new = ~covered & (number > 0)
    image[new] = total[new] / number[new]
    covered[new] = True


def sample_image(image: ArrayLike, uv: ArrayLike) -> NDArray[np.float64]:
    """Values (n,) of an image (height, width), bottom row first, at uv (n, 2): bilinear, at the border its texels."""
    values, points = _finite("image", image, 2), _finite("uv", uv, 2)
    if not values.size or points.shape[1] != 2:
        raise ValueError(f"image {values.shape} and uv {points.shape} are not allowed: (h, w), not empty, and (n, 2)")
    height, width = values.shape
    x, y = (np.clip(points[:, i] * n - 0.5, 0.0, n - 1.0) for i, n in ((0, width), (1, height)))
    left, low = (np.minimum(np.floor(v).astype(np.int64), max(n - 2, 0)) for v, n in ((x, width), (y, height)))
    right, high = np.minimum(left + 1, width - 1), np.minimum(low + 1, height - 1)
    across, up = x - left, y - low
    below = values[low, left] * (1.0 - across) + values[low, right] * across
    above = values[high, left] * (1.0 - across) + values[high, right] * across
    mixed: NDArray[np.float64] = below * (1.0 - up) + above * up
    return mixed


def gray_png(values: ArrayLike, bits: int = 16) -> bytes:
    """A PNG file's bytes: values (height, width) of 0 to 1, bottom row first, clipped; stored as they are, linear.

    bits  8 or 16
    """
    image = _finite("values", values, 2)
    if whole_number("bits", bits) not in (8, 16) or not image.size:
        raise ValueError(f"bits = {bits!r} and values of shape {image.shape}: allowed 8 or 16, and (h, w), not empty")
    height, width = image.shape
    levels = np.rint(np.clip(image[::-1], 0.0, 1.0) * (2**bits - 1)).astype(">u2" if bits == 16 else "u1")
    rows = b"".join(b"\0" + row.tobytes() for row in levels)
    header = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
    # gAMA 1: the numbers are linear (PNG specification, 11.3.2.2).
    chunks = ((b"IHDR", header), (b"gAMA", struct.pack(">I", 100000)), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    parts = (struct.pack(">I", len(d)) + k + d + struct.pack(">I", zlib.crc32(k + d)) for k, d in chunks)
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def _positive(name: str, number: float) -> None:
    if not (np.isfinite(real_number(name, number)) and number > 0.0):
        raise ValueError(f"{name} = {number!r} is not allowed: a finite number above 0")


def _finite(name: str, given: ArrayLike, dimensions: int) -> NDArray[np.float64]:
    values = real_numbers(name, given)
    if values.ndim != dimensions:
        raise ValueError(f"{name} of shape {values.shape} is not allowed: {dimensions} dimensions")
    if not np.isfinite(values).all():
        raise ValueError(f"{name} has a number that is not finite: allowed are finite ones")
    return values
