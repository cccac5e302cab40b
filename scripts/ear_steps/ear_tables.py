"""The measured sections of the ear in docs/accuracy.md."""

from __future__ import annotations

import page
from picture_error import Error
from study import METHODS, THIN_MM, Study


def percent(error: Error) -> str:
    return f"{100 * error.rms:.0f} ± {100 * error.standard_error:.0f} %"


def seconds(value: float) -> str:
    if value < 0.1:
        return f"{1e3 * value:.1f} ms"
    return f"{value:.2f} s" if value < 10 else f"{value:.0f} s"


def compared(study: Study) -> str:
    numbers, cost = study.numbers, study.cost
    rows = []
    for m in study.methods:
        reach = cost.seconds_to(m.at_best.rms)
        rows.append(
            [
                METHODS[m.name],
                percent(m.as_it_is) if m.name in ("object", "surface") else "-",
                f"{m.factor:.3g}",
                percent(m.at_best),
                percent(m.thin),
                seconds(m.seconds),
                f"{seconds(reach)} ({cost.samples_to(m.at_best.rms):.0f} samples)",
                f"{reach / m.seconds:.0f}x",
                percent(m.bounced),
            ]
        )
    heading = [
        "method",
        "error as it is",
        "best strength",
        "error at it",
        f"of skin up to {THIN_MM:g} mm",
        "CPU time",
        "random walk to that error",
    ]
    heading += ["times", "error against walks with bounces"]
    walk = [
        [f"{n}", percent(e), seconds(s)]
        for n, e, s in zip(study.counts, study.walk_errors, study.walk_seconds, strict=True)
    ]
    core = numbers["core_seconds"]
    gain = study.bounced.mean.mean() / study.reference.mean.mean()
    about = (
        f"{numbers['head']}, {numbers['vertices']:,} points, {study.ear.shape[0]} pixels square, of which the back-lit "
        f"ear has {int(study.ear.sum()):,}; Blender {numbers['blender']}. The reference, two walks of "
        f"{numbers['samples']} samples each, has {100 * study.reference.noise:.0f} % noise left, which is taken out. "
        f"CPU time is that of the whole render call; a walk's is {seconds(cost.fixed)} and {cost.each:.3g} s for each "
        f"sample a pixel. A lookup besides costs, once for a mesh, "
        f"{seconds(core['thickness'])} for its thickness; {seconds(core['tables'])} for the tables; and, with surface "
        f"weights, {seconds(core['far_side'])} at each change of lamps. Light that goes on from skin to skin "
        f"makes the ear {gain:.2f} times as bright."
    )
    return "\n\n".join(
        [about, page.table(heading, rows), page.table(["random walk, samples", "error", "CPU time"], walk)]
    )


def thickness(study: Study) -> str:
    rows = [
        [
            f"{b.low:g} - {b.high:g}" if b.high < 1e9 else f"over {b.low:g}",
            f"{b.pixels}",
            f"{100 * b.share_of_light:.0f} %",
            f"{100 * b.share_of_error:.0f} %",
            f"{b.walk_over['surface']:.2f} ± {b.standard_error:.3f}",
            f"{b.walk_over['view']:.2f}",
            f"{b.walk_over['object']:.2f}",
        ]
        for b in study.bins()
    ]
    heading = ["thickness, mm", "pixels", "of the walk's light", "of surface weights' squared error"]
    heading += ["red of the walk over surface weights", "over the slab at the view's angle", "over object weight"]
    limits = [[limit.name, percent(limit.error), percent(limit.thin)] for limit in study.limits()]
    at_best = ["what would come nearer", "error at its best strength", f"of skin up to {THIN_MM:g} mm"]
    return "\n\n".join([page.table(heading, rows), page.table(at_best, limits)])


def slab(study: Study) -> str:
    rows = []
    for row in study.numbers["slab"]:
        ratios = zip(row["over_solver"], row["standard_error"], strict=True)
        over = [f"{ratio:.3f} ± {error:.3f}" for ratio, error in ratios]
        rows.append([f"{row['degrees']:g}°", *over, " / ".join(f"{x:.2f}" for x in row["over_diffuse"])])
    heading = ["seen at", "red: walk over solver", "green", "blue", "over diffuse light's table, R / G / B"]
    return page.table(heading, rows)
