"""The ears of a head, and how large it is: from points of its surface, Z up, facing -Y."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studies.heads.samples import Array, Samples

#: Widths of heads without the ears, mm: from a baby to the widest adult; and the mean adult.
WIDTH_MM, MEAN_WIDTH_MM = (95.0, 200.0), 152.0
#: Units that files are in, mm, most usual first.
UNITS_MM = {1000.0: "meters", 1.0: "millimeters", 10.0: "centimeters", 100.0: "decimeters", 25.4: "inches"}
#: An ear stands out from the head by this much over an area of this size, in widths of the head.
EAR_STANDS_OUT, EAR_AREA = 0.02, (0.012, 0.3)
#: An ear is 0.33 to 0.41 widths high; what is higher is a bun, a collar or a strand.
EAR_HEIGHT = 0.55
#: It is that far from the middle; a ball of that radius fits into the skull, and not into an ear. Widths, too.
FROM_MIDDLE, BALL = 0.36, 0.3
CELLS = 64


@dataclass
class Ear:
    """In the units of the samples."""

    center: Array  # (3,) of what stands out
    size: float  # its height
    side: float  # 1: at +X, the left ear; -1
    stands_out: float = 0.0  # from the skull, at most
    backward: float = 0.0  # correlation of that with +Y: an ear's free edge is behind, its attached one in front


@dataclass
class HeadSize:
    top: float  # z
    bottom: float  # z of the chin or, where there is a neck, of its thinnest slice
    width: float  # at the height of the ears, of which little counts
    middle_x: float


def measure(samples: Samples) -> HeadSize:
    """From the widths of slices: they grow from the top to the ears, and fall to the neck."""
    x, _y, z = samples.points.T
    low, top = (float(q) for q in np.quantile(z, [0.0005, 0.9995]))
    slices = 60
    slice_of = np.clip(((top - z) / (top - low) * slices).astype(int), 0, slices - 1)
    of_slices = [x[slice_of == k] for k in range(slices)]
    edges = np.array([np.quantile(of, [0.03, 0.97]) if len(of) else (0.0, 0.0) for of in of_slices])
    widths = edges[:, 1] - edges[:, 0]
    widest, neck = 0, slices - 1
    for k in range(slices):
        if widths[k] > widths[widest]:
            if k > widest + 3 and widths[widest : k + 1].min() < 0.88 * widths[widest]:
                neck = widest + int(widths[widest:k].argmin())  # wider again below: shoulders
                break
            widest = k
    middle = float(np.median(edges[: neck + 1].mean(axis=1)))  # of all slices: one ear alone would shift its own
    width = float(np.median(widths[max(widest - 4, 0) : widest + 5]))
    return HeadSize(top, top - (neck + 0.5) / slices * (top - low), width, middle)


def find_ears(samples: Samples, head: HeadSize) -> list[Ear]:
    """Where the side of the head stands out over a band too narrow for the skull; the larger ear first."""
    found = []
    inside = (samples.points[:, 2] > head.bottom) & (samples.points[:, 2] <= head.top)
    for side in (1.0, -1.0):
        ear = _ear(samples.points[inside], head, side)
        if ear is not None:
            found.append(ear)
    return sorted(found, key=lambda ear: -ear.size)


def _ear(points: Array, head: HeadSize, side: float) -> Ear | None:
    points = points[side * (points[:, 0] - head.middle_x) > 0.0]
    out = side * (points[:, 0] - head.middle_x)
    y0, y1 = (float(q) for q in np.quantile(points[:, 1], [0.0, 1.0]))
    cell = max(y1 - y0, head.top - head.bottom) / CELLS
    shape = (int((y1 - y0) / cell) + 1, int((points[:, 2].max() - head.bottom) / cell) + 1)
    pixel_of = (((points[:, 1] - y0) / cell).astype(int), ((points[:, 2] - head.bottom) / cell).astype(int))
    side_view = np.full(shape, -np.inf)
    np.maximum.at(side_view, pixel_of, out)
    side_view = _filled(side_view)
    # A ball that rolls along the inside of the skull does not get into an ear.
    radius = max(int(BALL * head.width / cell), 2)
    bend = 0.5 * cell / (BALL * head.width) * cell * np.arange(-radius, radius + 1) ** 2
    skull = _window(_window(side_view, bend, np.min), -bend, np.max)
    ear = (side_view - skull > EAR_STANDS_OUT * head.width) & (side_view > FROM_MIDDLE * head.width)
    for part in _parts(ear):
        area = part.sum() * cell**2 / head.width**2
        index = np.argwhere(part)
        low, high = index.min(axis=0), index.max(axis=0) + 1
        size = float((high - low)[1] * cell)
        if EAR_AREA[0] < area < EAR_AREA[1] and size < EAR_HEIGHT * head.width:
            y, z = 0.5 * (low + high) * cell + (y0, head.bottom)
            center = np.array([head.middle_x + side * float(side_view[part].mean()), y, z])
            stands_out = (side_view - skull)[part]
            return Ear(center, size, side, float(stands_out.max()), _correlation(stands_out, index[:, 0]))
    return None


def _correlation(a: Array, b: NDArray[np.integer]) -> float:
    a, b = a - a.mean(), b - b.mean()
    return float(a @ b / np.sqrt(max(a @ a * (b @ b), 1e-300)))


def _filled(image: Array) -> Array:
    """Holes, which no point fell into, take what is about them: a ball would fall in. About the head there is 0."""
    known = np.isfinite(image)
    outside = np.pad(np.zeros_like(known), 1, constant_values=True)
    empty = np.pad(~known, 1, constant_values=True)
    while True:
        spread = empty & (_window(outside.astype(float), NEXT, np.max) > 0.0)
        if (spread == outside).all():
            break
        outside = spread
    known |= outside[1:-1, 1:-1]
    image = np.where(np.isfinite(image), image, 0.0)
    while not known.all():
        around = _window(np.where(known, image, -np.inf), NEXT, np.max)
        image = np.where(known, image, around)
        known = np.isfinite(around) | known
        image = np.where(known, image, 0.0)
    return _window(_window(image, NEXT, np.max), NEXT, np.min)


def _window(image: Array, bend: Array, of: Callable[..., Array]) -> Array:
    """The least or the greatest of what `bend` adds to the neighbors, front to back and then up and down."""
    radius = len(bend) // 2
    for axis in (0, 1):
        padding = [(radius, radius) if k == axis else (0, 0) for k in range(2)]
        windows = np.lib.stride_tricks.sliding_window_view(np.pad(image, padding, mode="edge"), len(bend), axis=axis)
        image = of(windows + bend, axis=-1)
    return image


#: For `_window`: the neighbors as they are.
NEXT = np.zeros(3)


def _parts(mask: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """The connected parts, the largest first."""
    label = np.where(mask, np.arange(1, mask.size + 1).reshape(mask.shape), 0)
    while True:
        spread = np.where(mask, _window(label, NEXT, np.max), 0)
        if (spread == label).all():
            break
        label = spread
    values, counts = np.unique(label[mask], return_counts=True)
    return [label == value for value in values[np.argsort(-counts, kind="stable")]]


def unit_by_size(width: float) -> tuple[float, str] | None:
    """Millimeters per unit that make a head that wide, in units, a person's; and the unit's name."""
    for unit, name in UNITS_MM.items():
        if WIDTH_MM[0] <= width * unit <= WIDTH_MM[1]:
            return unit, name
    return None
