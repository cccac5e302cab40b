"""The ladder's figures: error against run time, and pictures at equal time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter, PercentFormatter, StrMethodFormatter

from studies.figures import COLORS, MARKS, plt, save, to_screen
from studies.ladder.results import BY_EYE, RIG_NAMES, RUNGS, Results, equal_samples


def error_against_time(path: Path, head: Results) -> None:
    """Each rung under each rig, pale, and over all rigs; the walk's noise as a line."""
    figure, axes = plt.subplots(figsize=(8.2, 5.2))
    for (rung, title), color, mark in zip(RUNGS.items(), COLORS, MARKS, strict=True):
        steps = [head.steps[rig, rung] for rig in head.rigs]
        errors = [s.monte_carlo_at_best.rms if rung in BY_EYE else s.monte_carlo.rms for s in steps]
        times = [s.seconds for s in steps]
        axes.loglog(times, errors, mark, color=color, markersize=5, alpha=0.35)
        mean = float(np.sqrt(np.mean(np.square(errors))))
        label = title + (", best strength" if rung in BY_EYE else "")
        axes.loglog(np.mean(times), mean, mark, color=color, markersize=10, label=label)
    walks = np.array([head.walk_errors(rig) for rig in head.rigs])
    noise = np.sqrt((walks[:, :, 2] ** 2).mean(axis=0))
    time = walks[:, :, 1].mean(axis=0)
    axes.loglog(time, noise, "-", color="black", linewidth=1, marker=".", label="random walk: its noise")
    for samples, x, y in zip(walks[0, :, 0], time, noise, strict=True):
        axes.annotate(f"{samples:,.0f}", (x, y), (5, 4), textcoords="offset points", fontsize=8)
    for axis, form in ((axes.xaxis, StrMethodFormatter("{x:g}")), (axes.yaxis, PercentFormatter(1.0, decimals=0))):
        axis.set_major_formatter(form)
        axis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
        axis.set_minor_formatter(form if axis is axes.yaxis else NullFormatter())
    axes.set_xlabel("CPU time of a picture after a light was moved, s")
    axes.set_ylabel("RMS error / mean")
    axes.set_title(f"The back-lit ear of {head.title} under four rigs (pale), and all (full)")
    axes.grid(True, which="both", alpha=0.25)
    axes.set_xlim(right=2.0 * time.max())  # the last number of samples is to be read
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    save(figure, path, dpi=100)


def pictures(path: Path, head: Results) -> None:
    """Rows are rigs. Exposed alike in a row; what has no unit of light is shown at its best strength."""
    shown = {rung: RUNGS[rung].replace(", ", ",\n").replace("EEVEE's ", "EEVEE's\n") for rung in RUNGS}
    columns = {**shown, "equal": "walk in the time\nof 0.8 mm", "walk": "walk,\nconverged", "mc": "Monte Carlo"}
    rows, axes = plt.subplots(
        len(head.rigs), len(columns), figsize=(1.45 * len(columns), 1.5 * len(head.rigs) + 0.5), squeeze=False
    )
    for line, rig in zip(axes, head.rigs, strict=True):
        truth, walk = head.monte_carlo(rig), head.walk(rig)
        exposure = 0.9 / np.percentile(truth.mean.max(axis=1), 97)
        for ax, (name, title) in zip(line, columns.items(), strict=True):
            ax.set(xticks=[], yticks=[])
            if rig == head.rigs[0]:
                ax.set_title(title, fontsize=8)
            if name == "mc":
                picture = 0.5 * (head.picture(rig, "mc 1") + head.picture(rig, "mc 2"))
            elif name == "walk":
                picture = 0.5 * sum(head.picture(rig, half) for half in head.halves) * walk.best_factor_to(truth)
            elif name == "equal":
                samples = equal_samples(head.cells, rig, head.samples)
                picture = head.picture(rig, f"equal {samples}") * walk.best_factor_to(truth)
                ax.set_xlabel(f"{samples} samples", fontsize=7)
            else:
                factor = truth.best_factor(head.of(rig, name)) if name in BY_EYE else 1.0
                picture = factor * head.picture(rig, name)
                ax.set_xlabel(f"{head.seconds(rig, name):.2f} s", fontsize=7)
            ax.imshow(to_screen(exposure * picture[:, :, :3]), interpolation="nearest")
        line[0].set_ylabel(RIG_NAMES[rig], fontsize=8)
    save(rows, path, dpi=100)
