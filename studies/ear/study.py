"""Compares the back-lit ear in every mode with random walk, for docs/accuracy.md."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from studies import hosts, report
from studies.ear import plots, tables
from studies.ear.results import Study
from studies.heads import sources
from studies.paths import IMAGES, PROJECT, SCAN
from studies.progress import Progress, StudyError


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m studies ear",
        description="Compares the back-lit ear in every mode with Cycles' random walk: error and CPU time.",
    )
    parser.add_argument("--head", metavar="FILE", help="GLB, OBJ or PLY (default: the scan, else the demo's person)")
    parser.add_argument("--unit", type=float, metavar="MM", help="millimeters per unit of the file")
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy")
    parser.add_argument("--size", type=int, default=160, metavar="PIXELS", help="width and height (default 160)")
    parser.add_argument("--samples", type=int, default=1024, help="samples of each reference walk (default 1024)")
    parser.add_argument("--out", type=Path, default=Path("out/ear"), help="output folder (default out/ear)")
    parser.add_argument("--reuse", action="store_true", help="reuse the pictures in --out")
    parser.add_argument("--no-docs", action="store_true", help="do not update docs/accuracy.md; write figures to --out")
    options = parser.parse_args(arguments)
    if options.size < 32 or options.samples < 64:
        parser.error("--size must be at least 32 and --samples at least 64")
    made_by = ("head", "unit", "blender", "size", "samples")
    changed = [f"--{name}" for name in made_by if getattr(options, name) != parser.get_default(name)]
    if options.reuse and changed:
        parser.error(f"--reuse takes the pictures as they are, which {' and '.join(changed)} would not change")
    return options


def find_head(options: argparse.Namespace, progress: Progress) -> dict[str, Any]:
    """What is loaded: the given head, or the scan if it is next to the project, or the person."""
    mesh = options.head
    if mesh is None and SCAN.is_file():
        mesh = str(SCAN)
    elif mesh is None:
        progress.say(
            f"no scan at {SCAN}: using the demo's person; the figures in the docs are of the scan (--head FILE)"
        )
    return sources.head_job(mesh, progress, unit_mm=options.unit)


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    out: Path = options.out.resolve()
    kept = out / "numbers.json"
    if options.reuse and not kept.is_file():
        raise StudyError(f"{kept} does not exist: run without --reuse first")
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "ear.log")
    if not options.reuse:
        kept.write_text(json.dumps(render(options, out, progress), indent=1))
    write(options, Study(out, json.loads(kept.read_text())), out)
    progress.say("done" if options.no_docs else "done: docs/accuracy.md and its pictures of the ear are up to date")


def render(options: argparse.Namespace, out: Path, progress: Progress) -> dict[str, Any]:
    """Renders all pictures into `out`; returns their CPU times and other numbers."""
    head = find_head(options, progress)
    host = hosts.Host.find(options.blender)
    job = {
        **head,
        "size": options.size,
        "samples": options.samples,
        "slab_samples": 256,
        # From very noisy to half the samples of a reference.
        "walk_samples": [n for n in (4, 16, 64, 256, 1024) if n <= options.samples // 2],
        "out": str(out),
    }
    numbers = host.run("studies.ear.job", job, progress)
    head = sources.about(head["mesh"])
    numbers["head"] = f"{head['name']} ({head['license']})"
    numbers["samples"] = options.samples
    return numbers


def write(options: argparse.Namespace, study: Study, out: Path) -> None:
    images = out if options.no_docs else IMAGES
    plots.error_against_time(images / "ear_error.png", study)
    plots.row_of_pictures(images / "ear_pictures.png", study)
    sections = {
        "ear": tables.compared(study),
        "ear_thickness": tables.thickness(study),
        "ear_slab": tables.slab(study),
    }
    print("\n\n".join(sections.values()), flush=True)
    if not options.no_docs:
        report.fill(PROJECT / "docs" / "accuracy.md", sections)
