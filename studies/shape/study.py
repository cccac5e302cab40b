"""Measures light through the real shape against brute force, for docs/shape.md."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from studies import hosts, monte_carlo, report
from studies.heads import sources
from studies.paths import IMAGES, PROJECT, SCAN
from studies.progress import Progress
from studies.shape import pictures, tables
from studies.shape.cases import HeadMesh
from studies.shape.truths import CASES, SHOWN, truth

METHODS = {
    "table": "table over thickness",
    "shape_0.8": "shape, cells of 0.8 mm",
    "shape_0.5": "shape, 0.5 mm",
    "monte_carlo": "Monte Carlo",
    "walk": "Cycles' random walk",
}


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m studies shape", description=__doc__)
    parser.add_argument("--scan", metavar="FILE", default=str(SCAN), help="the scanned head (default: %(default)s)")
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy")
    parser.add_argument("--program", type=Path, help="the Monte Carlo (default: it is built)")
    parser.add_argument("--photons", type=int, default=8_000_000, help="per channel and case (default %(default)s)")
    parser.add_argument("--size", type=int, default=160, help="of a picture, pixels (default %(default)s)")
    parser.add_argument("--samples", type=int, default=128, help="of a pixel of Cycles' walk (default %(default)s)")
    parser.add_argument("--out", type=Path, default=Path("out/shape"), help="keeps references (default %(default)s)")
    parser.add_argument("--no-docs", action="store_true", help="do not update docs/shape.md; pictures go to --out")
    return parser.parse_args(arguments)


class Heads:
    """The scan, if it is there, and MakeHuman's head, as Blender renders them."""

    def __init__(self, scan: str, out: Path, host: hosts.Host, progress: Progress) -> None:
        self.jobs: dict[str, dict[str, Any]] = {}
        self.meshes: dict[str, HeadMesh] = {}
        for name, file in (("scan", scan), ("makehuman", sources.MAKEHUMAN)):
            if name == "scan" and not Path(file).is_file():
                progress.say(f"no scan at {file}: MakeHuman's head alone (--scan FILE)")
                continue
            self.jobs[name] = sources.head_job(file, progress)
            path = out / f"{name}.npz"
            if not path.is_file():
                host.run("studies.heads.mesh_job", {**self.jobs[name], "mesh_file": str(path)}, progress)
            self.meshes[name] = HeadMesh(path)


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    out: Path = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "shape.log")
    program = options.program or monte_carlo.build(progress)
    host = hosts.Host.find(options.blender)
    heads = Heads(options.scan, out, host, progress)
    cases = [case for case in CASES if case.head in heads.meshes]
    lit = [truth(case, heads.meshes[case.head], program, out, options.photons, progress) for case in cases]

    measured, shown = [], {}
    for one in lit:
        result, exitance = tables.measure(one, progress)
        measured.append(result)
        if one.case.name in SHOWN:
            shown[one.case.head] = (one, exitance)

    images = out if options.no_docs else IMAGES
    views = {}
    cost = tables.costs(lit[0])
    walks: dict[str, tuple[float, float]] = {}
    sections = {
        "errors": tables.errors_table(measured),
        "noise": tables.noise_table(measured),
        "surface": tables.surface_table(lit),
        "cost": tables.costs_table(cost),
    }
    for head, (one, exitance) in shown.items():
        attributes = {
            "table": one.head.table(one.case.light, one.case.medium),
            **{f"shape_{cell:g}": values for cell, values in exitance.items()},
            "monte_carlo": one.mean,
            "monte_carlo_a": one.a,
            "monte_carlo_b": one.b,
        }
        where = pictures.Stage(heads.jobs[head], one.head, one.case.light, out, head, options.size, host, progress)
        found = where.pictures(attributes, one.head.back_lit(one.irradiance), options.samples)
        pictures.figure(images / f"shape_{head}.png", found, METHODS)
        views[head] = pictures.view_dependence(found)
        error = next(m for m in measured if m.case is one).shape[tables.CELLS_MM[0]].back.together
        walks[head] = (error, tables.walk_seconds(found, error))
    sections["time"] = tables.time_table(walks, cost[0])
    sections["view"] = tables.view_table(views)
    print("\n\n".join(sections.values()), flush=True)
    if not options.no_docs:
        report.fill(PROJECT / "docs" / "shape.md", sections)
    progress.say("done")
