"""The measured sections of the ear in docs/accuracy.md."""

from __future__ import annotations

from studies import report
from studies.ear.results import METHODS, THIN_MM, Study
from studies.errors import Error


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
        equal = cost.seconds_to(m.at_best.rms)
        rows.append(
            [
                METHODS[m.name],
                percent(m.as_it_is) if m.name in ("object", "surface") else "-",
                f"{m.factor:.3g}",
                percent(m.at_best),
                percent(m.thin),
                seconds(m.seconds),
                f"{seconds(equal)} ({cost.samples_to(m.at_best.rms):.0f} samples)",
                f"{equal / m.seconds:.0f}x",
                percent(m.bounced),
            ]
        )
    heading = [
        "method",
        "error unscaled",
        "best strength",
        "error at best strength",
        f"of skin up to {THIN_MM:g} mm",
        "CPU time",
        "random walk with equal error",
    ]
    heading += ["ratio", "error with interreflection"]
    walk = [
        [f"{n}", percent(e), seconds(s)]
        for n, e, s in zip(study.counts, study.walk_errors, study.walk_seconds, strict=True)
    ]
    core = numbers["core_seconds"]
    gain = study.bounced.mean.mean() / study.reference.mean.mean()
    size = study.ear.shape[0]
    about = (
        f"{numbers['head']}, {numbers['vertices']:,} vertices, {size} x {size} pixels, of which "
        f"{int(study.ear.sum()):,} show the back-lit ear; Blender {numbers['blender']}. The reference, two walks of "
        f"{numbers['samples']} samples each, has {100 * study.reference.noise:.0f} % residual noise, which is "
        f"subtracted. CPU time is that of the whole render call; for a walk it is {seconds(cost.fixed)} plus "
        f"{cost.each:.3g} s per sample per pixel. A lookup additionally costs {seconds(core['thickness'])} once per "
        f"mesh, for its thickness above all, and {seconds(core['update'])} per change of the lights. "
        f"Interreflection makes the ear {gain:.2f} times as bright."
    )
    return "\n\n".join(
        [about, report.table(heading, rows), report.table(["random walk, samples", "error", "CPU time"], walk)]
    )


def thickness(study: Study) -> str:
    rows = [
        [
            f"{b.low:g} - {b.high:g}" if b.high < 1e9 else f"over {b.low:g}",
            f"{b.pixels}",
            f"{100 * b.fraction_of_light:.0f} %",
            f"{100 * b.fraction_of_error:.0f} %",
            f"{b.walk_over['surface']:.2f} ± {b.standard_error:.3f}",
            f"{b.walk_over['view']:.2f}",
            f"{b.walk_over['object']:.2f}",
        ]
        for b in study.bins()
    ]
    heading = ["thickness, mm", "pixels", "fraction of the walk's light", "fraction of the squared error per pixel"]
    heading += ["red of the walk over per pixel", "over the slab at the view angle", "over per object"]
    limits = [[limit.name, percent(limit.error), percent(limit.thin)] for limit in study.limits()]
    at_best = ["hypothetical method", "error at best strength", f"of skin up to {THIN_MM:g} mm"]
    return "\n\n".join([report.table(heading, rows), report.table(at_best, limits)])


def slab(study: Study) -> str:
    rows = []
    for row in study.numbers["slab"]:
        ratios = zip(row["over_solver"], row["standard_error"], strict=True)
        over = [f"{ratio:.3f} ± {error:.3f}" for ratio, error in ratios]
        rows.append([f"{row['degrees']:g}°", *over, " / ".join(f"{x:.2f}" for x in row["over_diffuse"])])
    heading = ["view angle", "red: walk over solver", "green", "blue", "over the table for diffuse light, R / G / B"]
    return report.table(heading, rows)
