"""How the cost of light in a shape grows: with points, with triangles of which few matter, and with lights.

Processor time of one thread; memory is what the shape holds, and the most that the process had.

Usage: python tests/benchmarks/shape_growth.py [TRIANGLES...]      default 20000 80000 1000000
"""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable

import numpy as np
import skinglow as sg

FLESH = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
THICKNESS, EDGE = 4.0, 0.7  # mm
#: Points, at most, that the body is asked at besides all of its vertices.
FEW = 3_000
SOLVED_WHOLE = 100_000  # triangles


def plate(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed plate, a few mm thick, of equal triangles: vertices in mm."""
    side = round((triangles / 4) ** 0.5)
    x, y = (grid.ravel() for grid in np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij"))
    top = np.stack([EDGE * x, EDGE * y, np.full(len(x), THICKNESS)], axis=1)
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(side), np.arange(side), indexing="ij"))
    a, b, c, d = ((side + 1) * (i + di) + j + dj for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    k = np.arange(side)
    rim = np.concatenate([(side + 1) * k, (side + 1) * side + k, (side + 1) * (side - k) + side, side - k])
    following = np.roll(rim, -1)
    under = len(top)
    sides = np.concatenate(
        [
            np.stack([rim, rim + under, following + under], 1),
            np.stack([rim, following + under, following], 1),
        ]
    )
    return np.concatenate([top, top * (1, 1, 0)]), np.concatenate([faces, faces[:, ::-1] + under, sides])


def taken(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def lights(count: int, size: float) -> list[sg.Light]:
    at = np.random.default_rng(1).uniform(-1.0, 2.0, (count, 2)) * size
    return [sg.Light("POINT", position=(x, y, -200.0), power=1e6 / count, radius=5.0) for x, y in at]


def grown(triangles: int) -> None:
    vertices, faces = plate(triangles)
    where = {}
    if triangles > SOLVED_WHOLE:
        middle = np.flatnonzero(np.linalg.norm(vertices[:, :2] - vertices[:, :2].mean(axis=0), axis=1) < 40 * EDGE)
        where = {"points": vertices[middle[:FEW]]}
    made: list[sg.Shape] = []
    build = taken(lambda: made.append(sg.Shape(vertices, faces, threads=1, **FLESH, **where)))
    shape, behind = made[0], np.ones(len(vertices))
    first = taken(lambda: shape.exitance(behind))
    moved = taken(lambda: shape.exitance(behind))
    count = len(shape.points)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    print(
        f"{len(faces):9d} {count:8d} {build:8.2f} {first:14.2f} {1e6 * (build + first) / count:11.0f} "
        f"{1e3 * moved:9.1f} {shape.bytes / count / 1e3:12.1f} {memory:12.0f}",
        flush=True,
    )


def main(sizes: list[int]) -> None:
    print("triangles   points  shape s  first light s  us a point  moved ms   kB a point   process MB")
    for triangles in sizes:
        grown(triangles)
    vertices, faces = plate(5_000)
    shape = sg.Shape(vertices, faces, threads=1, **FLESH)
    shape.light(lights(1, 25.0), reentries=0)
    print("lights    s   ms a light")
    for count in (100, 1_000, 10_000):
        many = lights(count, 25.0)
        spent = taken(lambda many=many: shape.light(many, reentries=0))
        print(f"{count:6d} {spent:6.2f} {1e3 * spent / count:8.2f}", flush=True)


if __name__ == "__main__":
    main([int(a) for a in sys.argv[1:]] or [20_000, 80_000, 1_000_000])
