"""Measures light through the real shape against brute force, for docs/shape.md. Run by scripts/accuracy_shape."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

STEPS = Path(__file__).resolve().parent
# Its own folder first, then scripts/accuracy's before the demo's: both have a page.py.
sys.path[1:1] = [str(STEPS.parent / name) for name in ("ear_steps", "accuracy_steps", "demo_steps")]

import blender_host  # noqa: E402
import head_source  # noqa: E402
from progress import DemoError, Progress  # noqa: E402
from scenes import HeadMesh  # noqa: E402
from truths import CASES, truth  # noqa: E402

PROJECT = STEPS.parents[1]
SCAN = PROJECT.parent / "shared" / "data" / "heads" / "LeePerrySmith.glb"
PROGRAM = PROJECT / "build" / "reference" / "tests" / "shape" / "shape_monte_carlo"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/accuracy_shape", description=__doc__)
    parser.add_argument(
        "--scan", metavar="FILE", default=str(SCAN), help="the scanned head, GLB (default: %(default)s)"
    )
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy")
    parser.add_argument("--program", type=Path, default=PROGRAM, help="the Monte Carlo (default: %(default)s)")
    parser.add_argument("--photons", type=int, default=800_000, help="per channel and case (default %(default)s)")
    parser.add_argument(
        "--out", type=Path, default=Path("out/shape"), help="references are kept here (default %(default)s)"
    )
    return parser.parse_args()


def heads(options: argparse.Namespace, out: Path, host: blender_host.Host, progress: Progress) -> dict[str, HeadMesh]:
    """The scan, if it is there, and MakeHuman's head, as Blender renders them."""
    found = {}
    for name, file in (("scan", options.scan), ("makehuman", None)):
        if name == "scan" and not Path(file).is_file():
            progress.say(f"no scan at {file}: MakeHuman's head alone (--scan FILE)")
            continue
        path = out / f"{name}.npz"
        if not path.is_file():
            source = head_source.find(file, None, progress)
            host.run(str(STEPS / "head_job.py"), {**source.job(), "mesh_file": str(path)}, progress)
        found[name] = HeadMesh(path)
    return found


def main() -> None:
    options = arguments()
    out: Path = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "shape.log")
    host = blender_host.Host.find(options.blender)
    meshes = heads(options, out, host, progress)
    lit = [
        truth(case, meshes[case.head], options.program, out, options.photons, progress)
        for case in CASES
        if case.head in meshes
    ]
    for one in lit:
        print(one.case.name, one.noise)


if __name__ == "__main__":
    try:
        main()
    except DemoError as error:
        sys.exit(f"skinglow: {error}")
