"""The figures of the ear: error against time, and the pictures side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.ticker import LogLocator, PercentFormatter, StrMethodFormatter

from studies.ear.results import METHODS, Study
from studies.figures import COLORS, MARKS, plt, save, to_screen

TITLES = {
    "existing": "existing",
    "paper": "paper",
    "object": "physical,\nper object",
    "surface": "physical,\nper pixel",
}
MARGIN = 6


def error_against_time(path: Path, study: Study) -> None:
    figure, axes = plt.subplots(figsize=(7.5, 5))
    cost = study.cost
    along = np.geomspace(0.9 * study.walk_errors[-1].rms, 1.1 * study.walk_errors[0].rms, 100)
    axes.loglog(
        [cost.seconds_to(e) for e in along],
        along,
        "-",
        color=COLORS[4],
        linewidth=1,
        label="its noise, by 1 / sqrt(samples)",
    )
    axes.loglog(study.walk_seconds, [e.rms for e in study.walk_errors], MARKS[4], color=COLORS[4], label="random walk")
    for result, color, mark in zip(study.methods, COLORS, MARKS, strict=False):
        axes.loglog(result.seconds, result.at_best.rms, mark, color=color, markersize=9, label=METHODS[result.name])
        if result.name in ("object", "surface"):
            axes.loglog(result.seconds, result.as_it_is.rms, mark, color=color, markersize=9, fillstyle="none")
    # Plain numbers instead of powers of ten. Last, since drawing on log axes resets them.
    for axis, form in ((axes.xaxis, StrMethodFormatter("{x:g}")), (axes.yaxis, PercentFormatter(1.0, decimals=0))):
        axis.set_major_formatter(form)
        axis.set_minor_formatter(form)
        axis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    axes.set_xlabel("CPU time of the render, s")
    axes.set_ylabel("RMS error / mean")
    axes.set_title(
        "The back-lit ear compared with the converged random walk\n(filled: best strength; hollow: unscaled)"
    )
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    save(figure, path)


def row_of_pictures(path: Path, study: Study) -> None:
    """Each method at its best strength, a random walk in equal time, and the converged random walk."""
    rows, columns = np.nonzero(study.ear)
    height, width = study.ear.shape
    box = (
        slice(max(0, rows.min() - MARGIN), min(height, rows.max() + MARGIN)),
        slice(max(0, columns.min() - MARGIN), min(width, columns.max() + MARGIN)),
    )
    exposure = 0.9 / np.percentile(study.reference.mean[:, 0], 97)
    shown = {TITLES[m.name]: m.factor * study.pictures[m.name] for m in study.methods}
    shown["random walk,\nequal time"] = study.pictures["equal_time"]
    shown["random walk,\nconverged"] = 0.5 * (study.pictures["reference_1"] + study.pictures["reference_2"])
    aspect = (box[0].stop - box[0].start) / (box[1].stop - box[1].start)
    figure, axes = plt.subplots(1, len(shown), figsize=(2 * len(shown), 2 * aspect + 0.7))
    for ax, (title, picture) in zip(axes, shown.items(), strict=True):
        ax.imshow(to_screen(exposure * picture[box][:, :, :3]), interpolation="nearest")
        ax.set_title(title, fontsize=10)
        ax.axis("off")
    save(figure, path, dpi=130)
