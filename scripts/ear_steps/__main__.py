"""Compares the back-lit ear in every mode with random walk, for docs/accuracy.md. Run by scripts/accuracy_ear."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

STEPS = Path(__file__).resolve().parent
# Its own folder first, then scripts/accuracy before the demo: both have a page.py.
sys.path[1:1] = [str(STEPS.parent / "accuracy_steps"), str(STEPS.parent / "demo_steps")]

import blender_host  # noqa: E402
import ear_plots  # noqa: E402
import ear_tables  # noqa: E402
import head_source  # noqa: E402
import page  # noqa: E402
from progress import DemoError, Progress  # noqa: E402
from study import Study  # noqa: E402

PROJECT = STEPS.parents[1]
IMAGES = PROJECT / "docs" / "images"
SCAN = PROJECT.parent / "shared" / "data" / "heads" / "LeePerrySmith.glb"
CREDIT = "Infinite, 3D Head Scan by Lee Perry-Smith (www.triplegangers.com), CC BY 3.0"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/accuracy_ear",
        description="Compares the back-lit ear in every mode with Cycles' random walk: error and CPU time.",
    )
    parser.add_argument("--head", metavar="FILE", help="GLB, OBJ or PLY (default: the scan, else MakeHuman's)")
    parser.add_argument("--unit", type=float, metavar="MM", help="millimeters per unit of the file")
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy")
    parser.add_argument("--size", type=int, default=160, metavar="PIXELS", help="width and height (default 160)")
    parser.add_argument("--samples", type=int, default=1024, help="samples of each reference walk (default 1024)")
    parser.add_argument("--out", type=Path, default=Path("out/ear"), help="output folder (default out/ear)")
    parser.add_argument("--reuse", action="store_true", help="reuse the pictures in --out")
    parser.add_argument("--no-docs", action="store_true", help="do not update docs/accuracy.md; write figures to --out")
    options = parser.parse_args()
    if options.size < 32 or options.samples < 64:
        parser.error("--size must be at least 32 and --samples at least 64")
    return options


def find_head(options: argparse.Namespace, progress: Progress) -> head_source.Head:
    """The given head, or the scan if it is next to the project, or MakeHuman's head."""
    mesh = options.head
    if mesh is None and SCAN.is_file():
        mesh = str(SCAN)
    elif mesh is None:
        progress.say(
            f"no scan at {SCAN}: using MakeHuman's head; the figures in the docs are of the scan (--head FILE)"
        )
    head = head_source.find(mesh, options.unit, progress)
    if mesh is not None and Path(mesh).name == SCAN.name:
        head.license = CREDIT
    return head


def main() -> None:
    options = arguments()
    out: Path = options.out.resolve()
    kept = out / "numbers.json"
    if options.reuse and not kept.is_file():
        sys.exit(f"skinglow: {kept} does not exist: run scripts/accuracy_ear without --reuse first")
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "ear.log")
    if not options.reuse:
        kept.write_text(json.dumps(render(options, out, progress), indent=1))
    report(options, Study(out, json.loads(kept.read_text())), out)
    progress.say("done" if options.no_docs else "done: docs/accuracy.md and its pictures of the ear are up to date")


def render(options: argparse.Namespace, out: Path, progress: Progress) -> dict[str, Any]:
    """Renders all pictures into `out`; returns their CPU times and other numbers."""
    head = find_head(options, progress)
    host = blender_host.Host.find(options.blender)
    job = {
        **head.job(),
        "package": str(blender_host.PACKAGE) if host.is_full_program else None,
        "size": options.size,
        "samples": options.samples,
        "slab_samples": 256,
        # From very noisy to half the samples of a reference.
        "walk_samples": [n for n in (4, 16, 64, 256, 1024) if n <= options.samples // 2],
        "out": str(out),
    }
    numbers = host.run(str(STEPS / "ear_job.py"), job, progress)
    numbers["head"] = f"{head.name} ({head.license})"
    numbers["samples"] = options.samples
    return numbers


def report(options: argparse.Namespace, study: Study, out: Path) -> None:
    images = out if options.no_docs else IMAGES
    ear_plots.error_against_time(images / "ear_error.png", study)
    ear_plots.row_of_pictures(images / "ear_pictures.png", study)
    sections = {
        "ear": ear_tables.compared(study),
        "ear_thickness": ear_tables.thickness(study),
        "ear_slab": ear_tables.slab(study),
    }
    print("\n\n".join(sections.values()), flush=True)
    if not options.no_docs:
        page.fill(PROJECT / "docs" / "accuracy.md", sections)


if __name__ == "__main__":
    try:
        main()
    except DemoError as error:
        sys.exit(f"skinglow: {error}")
