"""What an interactive host waits for: two ears of the scan and four lights of the default skin, of which one is moved.

All is prepared before. Processor times of one thread; how far quick answers are from the full one (two re-entries), RMS
over mean, all channels; and how long a call goes on after it was told to stop.

Usage: python tests/benchmarks/shape_live_times.py [CELL_MM]      needs ../shared/data/shape
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import skinglow as sg
from numpy.typing import NDArray
from shape_times import DATA, seconds

COLORS = [(1.0, 0.6, 0.3), (0.5, 0.7, 1.0), (1.0, 0.9, 0.8), (1.0, 0.2, 0.1)]
PLACES = [(-160.0, 400.0, 100.0), (600.0, 300.0, 300.0), (-300.0, -500.0, 200.0), (0.0, 600.0, 400.0)]
QUICK: dict[str, dict[str, Any]] = {
    "full": {},
    "no re-entry": {"reentries": 0},
    "and tolerance 1e-2": {"reentries": 0, "solver_tolerance": 1e-2},
    "and 4 shadow rays": {"reentries": 0, "solver_tolerance": 1e-2, "shadow_samples": 4},
    "and tolerance 5e-2": {"reentries": 0, "solver_tolerance": 5e-2, "shadow_samples": 4},
    "tolerance 1e-2, 4 rays": {"solver_tolerance": 1e-2, "shadow_samples": 4},
    "one re-entry, tolerance 1e-2, 4 rays": {"reentries": 1, "solver_tolerance": 1e-2, "shadow_samples": 4},
}


def lights(moved: int = 0, count: int = 4, tint: float = 0.6) -> list[sg.Light]:
    """The first of them moved by some millimeters; more than four go round the head."""
    angles = np.linspace(0.0, 3.0, max(0, count - 4))
    places = [*PLACES, *((600.0 * np.cos(a), 400.0, 600.0 * np.sin(a)) for a in angles)]
    colors = [(1.0, tint, 0.3), *COLORS[1:], *((0.4, 0.5 + 0.1 * a, 0.9) for a in angles)]
    places[0] = (PLACES[0][0], PLACES[0][1], PLACES[0][2] + moved)
    return [
        sg.Light("POINT", color, tuple(np.array(place) / 1000.0), power=50.0, radius=0.02)
        for color, place in zip(colors[:count], places[:count], strict=True)
    ]


def head(cell_mm: float) -> Callable[..., sg.Shape]:
    """Makes a shape of both ears, nothing prepared."""
    mesh, truth = np.load(DATA / "lps_mesh.npz"), np.load(DATA / "lps-a.npz")
    vertices, triangles = mesh["vertices_mm"].astype(float), mesh["triangles"]
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], np.cross(b - a, c - a))
    near = np.linalg.norm(vertices * [-1.0, 1.0, 1.0] - truth["ear_centre_mm"], axis=1) < 30.0
    both = np.union1d(truth["vertex"], np.flatnonzero(near))
    where = {"points": vertices[both] / 1000.0, "normals": normals[both]}
    return lambda **more: sg.Shape(
        vertices / 1000.0, triangles, unit_mm=1000.0, cell_mm=cell_mm, threads=1, **where, **more
    )


def error(found: NDArray[np.float64], full: NDArray[np.float64]) -> float:
    """RMS over mean, percent, of all channels together."""
    return 100.0 * float(np.sqrt(((found - full) ** 2).mean()) / full.mean())


def answers(ears: sg.Shape) -> None:
    step = iter(range(1, 10**6))
    for count in (4, 6, 16):
        start = ears.light(lights(count=count))

        def anew(count: int = count) -> None:
            ears.light(lights(count=count))

        def first(count: int = count, start: sg.LitShape = start) -> None:
            ears.light(lights(next(step), count), previous=start)

        print(f"{count} lights: all anew, full             {1e3 * seconds(anew, 3):8.1f} ms")
        print(f"  one moves for the first time       {1e3 * seconds(first, 3):8.1f} ms")
        for name, options in QUICK.items():
            state = [ears.light(lights(next(step), count), previous=start)]

            def move(options: dict[str, Any] = options, state: list[sg.LitShape] = state, count: int = count) -> None:
                state[0] = ears.light(lights(next(step), count), previous=state[0], **options)

            taken = seconds(move, 5)
            at = next(step)
            full = ears.light(lights(at, count))
            quick = ears.light(lights(at, count), previous=state[0], **options)
            off = error(quick.exitance, full.exitance), error(quick.transmitted, full.transmitted)
            alone = error(ears.light(lights(at, 1), **options).exitance, ears.light(lights(at, 1)).exitance)
            print(
                f"  it moves on, {name:36s} {1e3 * taken:8.1f} ms; off by {off[0]:.2f} %, of what comes through "
                f"{off[1]:.2f} %, of the moved light {alone:.2f} %"
            )
        recent, tints = ears.light(lights(tint=0.1, count=count), previous=start), iter(np.linspace(0.2, 0.9, 50))

        def recolored(count: int = count, recent: sg.LitShape = recent, tints: Iterator[float] = tints) -> None:
            ears.light(lights(tint=next(tints), count=count), previous=recent)

        print(f"  another color                      {1e3 * seconds(recolored):8.2f} ms")


def stops(make: Callable[..., sg.Shape]) -> None:
    """Processor time from the moment a call is told to stop, at 24 moments of each."""

    def told(work: Callable[[Callable[[float], bool]], object], at: float) -> float | None:
        begin, said = time.process_time(), []

        def progress(_: float) -> bool:
            if not said and time.process_time() - begin >= at:
                said.append(time.process_time())
            return not said

        try:
            work(progress)
        except RuntimeError:
            return time.process_time() - said[0]
        return None

    ready = make()
    ready.light(lights())
    new = iter([make() for _ in range(26)])
    for name, work in {
        "Shape()": lambda progress: make(progress=progress),
        "first light, parts made ready": lambda progress: next(new).light(lights(), progress=progress),
        "light": lambda progress: ready.light(lights(), progress=progress),
    }.items():
        begin = time.process_time()
        work(lambda _: True)
        total = time.process_time() - begin
        found = [told(work, total * (k + 0.5) / 24) for k in range(24)]
        ms = np.array([1e3 * x for x in found if x is not None])
        print(f"{name:32s} goes on for {np.median(ms):5.1f} ms in the median, {ms.max():5.1f} at most")


def main(cell_mm: float) -> None:
    make = head(cell_mm)
    ears = make()
    ears.light(lights())
    print(f"{len(ears.points)} points, {ears.report['cells']} cells of {cell_mm} mm")
    answers(ears)
    stops(make)


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 0.8)
