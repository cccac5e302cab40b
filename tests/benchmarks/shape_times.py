"""What light in a real ear costs, in seconds of one thread, beside what was asked and the Monte Carlo of reference.

Usage: python tests/benchmarks/shape_times.py [CELL_MM]      needs ../shared/data/shape
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import skinglow as sg

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "shape"
SKIN = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}


def seconds(work: Callable[[], object], repeats: int = 5) -> float:
    """Least processor time of some runs."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def light(position: tuple[float, float, float]) -> sg.Light:
    return sg.Light("POINT", position=position, power=1e6, radius=20.0)


def main(cell_mm: float) -> None:
    mesh, truth = np.load(DATA / "lps_mesh.npz"), np.load(DATA / "lps-a.npz")
    vertices, triangles = mesh["vertices_mm"].astype(float), mesh["triangles"]
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], np.cross(b - a, c - a))
    one = truth["vertex"]
    mirrored = vertices * [-1.0, 1.0, 1.0]
    near = np.linalg.norm(mirrored - truth["ear_centre_mm"], axis=1) < 30.0
    both = np.union1d(one, np.flatnonzero(near))

    def make(chosen: np.ndarray) -> sg.Shape:
        where = {"points": vertices[chosen], "normals": normals[chosen], "threads": 1, "cell_mm": cell_mm}
        return sg.Shape(vertices, triangles, **SKIN, **where)

    def line(what: str, value: float, unit: str, bar: float | None = None) -> None:
        asked = "" if bar is None else f"   asked: below {bar:g}, {'met' if value < bar else 'NOT MET'}"
        print(f"{what:42s}{value:10.3f} {unit}{asked}")

    irradiance = truth["irradiance"].astype(float)
    ear = make(one)
    prepare = seconds(lambda: make(one).exitance(irradiance), 2)
    move = seconds(lambda: ear.exitance(irradiance))
    print(f"cell {cell_mm} mm, {len(one)} points of one ear, three channels, one thread")
    line("prepare and first light", prepare - move, "s", 2)
    line("moved light, irradiance given", 1e3 * move, "ms", 30)
    behind = [light((-160.0, 400.0, 100.0))]
    ear.light(behind, reentries=0)
    line("moved light, its shadows traced", 1e3 * seconds(lambda: ear.light(behind, reentries=0)), "ms")
    ear.light(behind)
    line("the same, two re-entries", 1e3 * seconds(lambda: ear.light(behind)), "ms")
    lit = ear.light(behind)
    lit.recolor([(1.0, 0.5, 0.2)])
    line("another color", 1e3 * seconds(lambda: lit.recolor([(1.0, 0.5, 0.2)])), "ms", 1)
    line("memory", ear.bytes / len(one) / 1000, "kB a point", 15)
    ears = make(both)
    ears.light(behind, reentries=0)
    # Twice as many points take twice the time where it is linear.
    everywhere = np.ones(len(vertices))
    ear.exitance(everywhere)
    ears.exitance(everywhere)
    pair = seconds(lambda: ears.exitance(everywhere)) / seconds(lambda: ear.exitance(everywhere))
    line("both ears over one, a point", pair * len(one) / len(both), "times", 1.1)
    for count in (1, 4, 16, 64):
        angles = np.linspace(0.0, 3.0, count)
        many = [light((600.0 * np.cos(t), 400.0, 600.0 * np.sin(t))) for t in angles]
        ears.light(many, reentries=0)
        taken = 1e3 * seconds(lambda many=many: ears.light(many, reentries=0), 9)
        line(f"both ears, {count} lights, all shadows", taken, "ms", 120 if count == 16 else None)
    reference = float(truth["cpu_s"].sum())
    print(f"Monte Carlo, 7 to 18 % of noise    {reference:8.1f} s = {reference / move:.0f} moved lights")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 0.8)
