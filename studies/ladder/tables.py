"""The ladder's sections of docs/accuracy.md."""

from __future__ import annotations

import argparse

import numpy as np

from studies import report
from studies.errors import Error
from studies.ladder.results import BY_EYE, RIG_NAMES, RUNGS, Results


def percent(value: float) -> str:
    return f"{100 * value:.0f} %" if value >= 0.0995 else f"{100 * value:.1f} %" if value > 0.0 else "< noise"


def with_bar(error: Error) -> str:
    return percent(error.rms) + (f" ± {100 * error.standard_error:.1f}" if error.rms > 0.0 else "")


def seconds(value: float) -> str:
    return f"{value:.2f} s" if value < 10 else f"{value:.0f} s"


def ladder(found: list[Results], options: argparse.Namespace) -> str:
    """One table: heads across, rungs down, over the four rigs."""
    heading = ["rung"]
    for head in found:
        heading += [f"{head.title}: error", "at best strength", "against the walk, at best", "picture"]
    heading.append("once per mesh, each head")
    rows = []
    for rung, title in RUNGS.items():
        row = [title]
        for head in found:
            by_eye = rung in BY_EYE
            row += [
                "-" if by_eye else percent(head.mean(rung, "monte_carlo")),
                percent(head.mean(rung, "monte_carlo_at_best")),
                percent(head.mean(rung, "walk_at_best")),
                seconds(head.mean(rung, "seconds")),
            ]
        once = [head.prepared(rung) for head in found]
        row.append(" / ".join(f"{each:.1f} s" for each in once) if rung != "eevee" else "")
        rows.append(row)
    walks = []
    for index, (samples, *_rest) in enumerate(found[0].walk_errors(found[0].rigs[0])):
        row = [f"random walk, {samples:,} sample{'s' if samples > 1 else ''}"]
        for head in found:
            each = [head.walk_errors(rig)[index] for rig in head.rigs]
            row += ["", "", percent(float(np.sqrt(np.mean([e[2] ** 2 for e in each])))), seconds(each[0][1])]
        walks.append([*row, ""])
    cycles, eevee = found[0].versions
    pixels = ", ".join(f"{int(np.mean([h.compared(r).sum() for r in h.rigs])):,}" for h in found)
    noise = max(h.monte_carlo(r).noise for h in found for r in h.rigs)
    about = (
        f"Pictures of {options.size} x {options.size} pixels, of which {pixels} show back-lit skin; Cycles of Blender "
        f"{cycles}, EEVEE of {eevee} by software. Errors are RMS over mean, over the four rigs. Monte Carlo of "
        f"{options.photons:,} photons per channel and rig; converged walk of {options.samples:,} samples; the "
        f"noise of both (up to {100 * noise:.0f} % a pixel) is taken out. CPU seconds of all threads."
    )
    return f"{about}\n\n{report.table(heading, rows + walks)}"


def by_rig(found: list[Results]) -> str:
    heading = ["head", "rung", *(RIG_NAMES[rig] for rig in found[0].rigs)]
    rows = []
    for head in found:
        for rung, title in RUNGS.items():
            errors = (
                step.monte_carlo_at_best if rung in BY_EYE else step.monte_carlo
                for step in (head.steps[rig, rung] for rig in head.rigs)
            )
            first = rung == next(iter(RUNGS))
            rows.append([head.title if first else "", title, *map(with_bar, errors)])
    return report.table(heading, rows)
