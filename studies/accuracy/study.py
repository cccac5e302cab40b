"""Runs the measurements, draws the figures and updates docs/accuracy.md."""

from __future__ import annotations

import argparse
import platform

import numpy as np
import skinglow as sg

from studies import report
from studies.accuracy import light_colors, measurements, plots, task, weights, worlds
from studies.paths import IMAGES, PROJECT

DEPTHS_MM = (0.3, 1.0, 3.0, 6.0, 8.0)


def number(value: float) -> str:
    return f"{value:.1e}" if value < 0.01 else f"{value:.2g}"


def percent(value: float) -> str:
    return f"{100 * value:.2g} %" if value < 1 else f"{100 * value:.0f} %"


def say(what: str) -> None:
    print(f"[accuracy] {what}", flush=True)


def solver_section() -> str:
    say("streams")
    series = {name: measurements.streams(tissue) for name, tissue in task.SKINS.items()}
    plots.solver(IMAGES / "accuracy_solver.png", series)
    one, three = series.values()
    say("streams on random skins")
    worst = measurements.streams_on_random_skins()
    rows = [
        [a.label, f"{a.time_ms:.2f}", number(a.error), f"{b.time_ms:.2f}", number(b.error), number(worst[int(a.label)])]
        for a, b in zip(one, three, strict=True)
    ]
    heading = ["streams", "one layer, ms", "error", "three layers, ms", "error", "worst table of 60 random skins"]
    return report.table(heading, rows)


def table_section() -> str:
    say("tolerances")
    points = measurements.tolerances(task.THREE_LAYERS)
    plots.table(IMAGES / "accuracy_table.png", points)
    rows = [
        [f"{p.tolerance:g}", str(p.streams), *(f"{ms:.2f}" for ms in p.times_ms), number(p.estimate), number(p.error)]
        for p in points
    ]
    return report.table(
        ["tolerance", "streams chosen", "one thread, ms", "two, ms", "error estimated", "error measured"], rows
    )


def estimate_section() -> str:
    say("estimates on random skins")
    points = measurements.estimates()
    plots.estimate(IMAGES / "accuracy_estimate.png", points)
    ratios = np.array([p.error / p.estimate for p in points])
    return (
        f"Of {len(points)} random skins {int(np.sum(ratios > 1))} had an error above the estimate; measured over "
        f"estimated was {np.median(ratios):.2f} in the median and {ratios.max():.2f} at most."
    )


def methods_section() -> str:
    say("other methods")
    panels = [measurements.red_curves(name, tissue) for name, tissue in task.SKINS.items()]
    plots.methods(IMAGES / "accuracy_methods.png", panels)
    parts = []
    for panel, tissue in zip(panels, task.SKINS.values(), strict=True):
        exact = panel.curves["solved"]
        at = [int(np.argmin(np.abs(task.THICKNESS_MM - d))) for d in DEPTHS_MM]
        rows = [
            [name, *(f"{curve[i] / exact[i]:.2g}" for i in at)]
            for name, curve in panel.curves.items()
            if name != "solved"
        ]
        heading = [f"red light, {panel.tissue}: times the solution", *(f"{d:g} mm" for d in DEPTHS_MM)]
        parts.append(report.table(heading, rows))
        rows = [[p.label, f"{p.time_ms:.2f}", percent(p.error)] for p in measurements.other_methods(tissue).values()]
        parts.append(report.table([f"30 wavelengths x 256 thicknesses, {panel.tissue}", "ms", "largest error"], rows))
    return "\n\n".join(parts)


def light_colors_section() -> str:
    say("colored lights")
    rows = [
        [e.light, f"{e.thickness_mm:g}", percent(e.diagonal), percent(e.matrix), percent(e.clipped_matrix)]
        for e in light_colors.light_color_errors(task.THREE_LAYERS)
    ]
    heading = ["light", "mm", "RGB by channel", "3x3 matrix", "3x3, light clipped to the gamut"]
    return report.table(heading, rows)


def world_section() -> str:
    say("worlds")
    rows = [
        [
            e.world,
            *(f"{100 * value:+.2g}" if abs(value) > 5e-5 else "0" for value in e.at_angles),
            f"{100 * e.worst:.2g} %" if e.worst > 5e-5 else "below 0.001 %",
            f"{100 * e.negative:.0f} %",
            number(e.object_weight) if e.object_weight > 1e-12 else "0",
        ]
        for e in worlds.world_errors()
    ]
    angles = [f"{angle} deg" for angle in worlds.ANGLES]
    heading = ["world; % of the max irradiance", *angles, "worst of 500", "clamped at 0", "object weight, relative"]
    return report.table(heading, rows)


def weights_section() -> str:
    say("weights of lights")
    rows = [
        [
            e.rig,
            percent(e.object_rms),
            percent(e.object_bound),
            percent(e.surface_rms),
            percent(e.surface_worst),
            str(e.terms),
            f"{e.object_ms:.3f}",
            f"{e.surface_ms:.3f}",
            f"{e.exact_ms:.2f}",
        ]
        for e in weights.weight_errors()
    ]
    heading = ["rig", "per object, RMS", "its bound", "per pixel, RMS", "worst", "terms"]
    times = ["per object, ms", "terms, ms", f"exact, {weights.VERTICES:,} points, ms"]
    parts = [report.table([*heading, *times], rows)]
    rows = [[s.setting, percent(s.error), f"{s.time_ms:.3f}"] for s in weights.term_steps()]
    parts.append(report.table(["terms, of 40 lights", "worst", "ms"], rows))
    rows = [[s.setting, number(s.error), f"{s.time_ms:.2f}"] for s in weights.area_steps()]
    parts.append(report.table(["tolerance of an area light's integral", "error", "us per light and point"], rows))
    rows = [[s.setting, s.detail, number(s.error), f"{s.time_ms:.1f}"] for s in weights.culling_steps()]
    parts.append(report.table(["tolerance of culling", "lights kept", "lost", "ms"], rows))
    return "\n\n".join(parts)


def main(arguments: list[str]) -> None:
    argparse.ArgumentParser(prog="python -m studies accuracy", description=__doc__).parse_args(arguments)
    IMAGES.mkdir(parents=True, exist_ok=True)
    say("presets")
    plots.presets(IMAGES / "accuracy_presets.png")
    sections = {
        "machine": f"Measured with skinglow {sg.__version__} on {platform.machine()}, one thread unless stated.",
        "light_colors": light_colors_section(),
        "methods": methods_section(),
        "solver": solver_section(),
        "table": table_section(),
        "estimate": estimate_section(),
        "worlds": world_section(),
        "weights": weights_section(),
    }
    report.fill(PROJECT / "docs" / "accuracy.md", sections)
    say("docs/accuracy.md and its figures are up to date")
