"""Error against time: streams, the whole table by tolerance, and the other methods."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skinglow as sg

from studies.accuracy import diffusion, peers, task

STREAMS = (4, 6, 8, 10, 12, 16, 20, 24, 32, 40)
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
THREADS = (1, 2)
RANDOM_SKINS = 200


@dataclass
class Point:
    """One setting of one method."""

    label: str
    time_ms: float
    error: float
    estimate: float = float("nan")


def streams(tissue: sg.Tissue) -> list[Point]:
    """The task with increasing numbers of streams, compared with 64."""
    exact = task.solved(tissue)
    points = []
    for count in STREAMS:
        found, time_ms = task.timed(lambda n=count: task.solved(tissue, n, threads=1))
        points.append(Point(str(count), time_ms, task.largest_relative_error(found, exact)))
    return points


def streams_on_random_skins(count: int = 60) -> dict[int, float]:
    """Max error in the norm of the table for each number of streams, compared with 64."""
    random = np.random.default_rng(4)
    worst = dict.fromkeys(STREAMS, 0.0)
    for tissue in random_tissues(count, seed=1):
        thickness = 10.0 ** random.uniform(-1.5, 1.5)
        exact = sg.reference_lut(tissue, 32, thickness, 64)
        for n in STREAMS:
            error = sg.lut_error(sg.reference_lut(tissue, 32, thickness, n), exact)
            worst[n] = max(worst[n], error)
    return worst


@dataclass
class TablePoint:
    """base_lut at one tolerance."""

    tolerance: float
    streams: int
    times_ms: list[float]  # by THREADS
    error: float
    estimate: float


def tolerances(tissue: sg.Tissue) -> list[TablePoint]:
    """base_lut as it is used, against 64 streams."""
    exact = sg.reference_lut(tissue, 256, 12.0, task.REFERENCE_STREAMS)
    points = []
    for tolerance in TOLERANCES:
        times = []
        for threads in THREADS:
            (lut, report), time_ms = task.timed(
                lambda t=tolerance, n=threads: sg.base_lut_report(tissue, tolerance=t, threads=n)
            )
            times.append(time_ms)
        points.append(TablePoint(tolerance, report.streams, times, sg.lut_error(lut, exact), report.estimated_error))
    return points


def random_tissues(count: int, seed: int) -> list[sg.Tissue]:
    """Random skins over the full range of all parameters, every second one at a corner of the ranges."""
    random = np.random.default_rng(seed)
    ranges = {name: (minimum, maximum) for name, (_, minimum, maximum, _, _) in sg.TISSUE_PARAMETERS.items()}
    return [
        sg.Tissue(**{name: random.choice(ends) if i % 2 else random.uniform(*ends) for name, ends in ranges.items()})
        for i in range(count)
    ]


def estimates() -> list[Point]:
    """Estimated and measured error of base_lut on random skins, tolerances and thicknesses."""
    random = np.random.default_rng(2)
    points = []
    for tissue in random_tissues(RANDOM_SKINS, seed=3):
        tolerance, thickness = 10.0 ** random.uniform(-5.0, -1.0), 10.0 ** random.uniform(-1.5, 1.5)
        lut, report = sg.base_lut_report(tissue, 48, thickness, tolerance)
        exact = sg.reference_lut(tissue, 48, thickness, 48)
        points.append(Point("", 0.0, sg.lut_error(lut, exact), report.estimated_error))
    return points


def other_methods(tissue: sg.Tissue) -> dict[str, Point]:
    """The spectral methods at the task of 30 wavelengths and 256 thicknesses, against 64 streams."""
    exact = task.solved(tissue)
    reflectance, rate = peers.deep_skin(tissue, task.WAVELENGTHS_NM)
    methods = {
        "this solver, 10 streams": lambda: task.solved(tissue, 10, threads=1),
        "diffusion approximation": lambda: diffusion.transmittance(tissue, task.THICKNESS_MM, task.WAVELENGTHS_NM),
        "Burley's profile": lambda: peers.burley(task.THICKNESS_MM, reflectance, rate),
    }
    points = {}
    for name, method in methods.items():
        found, time_ms = task.timed(method)
        points[name] = Point(name, time_ms, task.largest_relative_error(found, exact))
    return points


@dataclass
class RedCurves:
    """Linear red of white light behind skin, by method, along task.THICKNESS_MM."""

    tissue: str
    curves: dict[str, np.ndarray]


def red_curves(name: str, tissue: sg.Tissue) -> RedCurves:
    """The red channel of the four methods; the six Gaussians are independent of the tissue."""
    nm = sg.SAMPLE_WAVELENGTHS_NM
    exact = sg.transmittance(tissue, task.THICKNESS_MM, nm, streams=32)
    approximate = diffusion.transmittance(tissue, task.THICKNESS_MM, nm)
    profile = peers.burley(task.THICKNESS_MM, *peers.deep_skin(tissue, nm))
    return RedCurves(
        name,
        {
            "solved": peers.to_rgb(exact)[:, 0],
            "diffusion approximation": peers.to_rgb(approximate)[:, 0],
            "Burley's profile": peers.to_rgb(profile)[:, 0],
            "six Gaussians": peers.six_gaussians(task.THICKNESS_MM)[:, 0],
        },
    )
