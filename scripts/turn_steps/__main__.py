"""Makes the first picture of docs/blender.md: a light carried round the ear in six frames, through the shape in EEVEE,
and by the random walk of Cycles in the same medium, with the time of each frame.

Usage: python scripts/turn_steps [--eevee BLENDER] [--cycles BLENDER] [--size N] [--samples N] [--out FOLDER]
EEVEE needs a full Blender and a display: run it under xvfb-run where there is none.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

STEPS = Path(__file__).resolve().parent
sys.path[1:1] = [str(STEPS.parent / name) for name in ("ear_steps", "shape_steps", "demo_steps")]

import blender_host  # noqa: E402
import head_source  # noqa: E402
import matplotlib  # noqa: E402
import numpy as np  # noqa: E402
from pictures import to_screen  # noqa: E402
from progress import DemoError, Progress  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  after selecting the backend

PROJECT = STEPS.parents[1]
#: Of the light, off the front towards the ear's side: from behind the head to beside it.
AZIMUTHS = (190.0, 178.0, 166.0, 154.0, 140.0, 120.0)
#: The brightest three percent of the first frame's pixels may be clipped.
EXPOSED_PERCENTILE = 97.0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python scripts/turn_steps", description=__doc__)
    parser.add_argument("--eevee", metavar="BLENDER", default="blender", help="a full Blender (default %(default)s)")
    parser.add_argument("--cycles", metavar="BLENDER", help="a Blender program or a Python with bpy (default: 4.5)")
    parser.add_argument("--size", type=int, default=240, help="of a picture, pixels (default %(default)s)")
    parser.add_argument("--samples", type=int, default=256, help="of a pixel of Cycles' walk (default %(default)s)")
    parser.add_argument("--out", type=Path, default=PROJECT / "out" / "turn", help="(default %(default)s)")
    parser.add_argument("--picture", type=Path, default=PROJECT / "docs" / "images" / "round_the_ear.png")
    return parser.parse_args()


def render(
    kind: str, host: blender_host.Host, options: argparse.Namespace, progress: Progress
) -> tuple[np.ndarray, list[float], dict[str, object]]:
    """Pictures (frames, height, width, 4) linear, CPU seconds of each frame, and what the job told."""
    pictures = options.out / f"{kind}.npz"
    job = {
        **head_source.find(None, None, progress).job(),
        "package": str(blender_host.PACKAGE) if host.is_full_program else None,
        "kind": kind,
        "azimuths": AZIMUTHS,
        "size": options.size,
        "samples": options.samples,
        "out": str(options.out),
        "pictures": str(pictures),
    }
    told = host.run(str(STEPS / "turn_job.py"), job, progress)
    with np.load(pictures) as file:
        return file["frames"], told["seconds"], told


def main() -> None:
    options = arguments()
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    progress = Progress(options.out / "turn.log")
    hosts = {"shape": blender_host.Host.find(options.eevee), "walk": blender_host.Host.find(options.cycles)}
    rows = {kind: render(kind, host, options, progress) for kind, host in hosts.items()}
    first = rows["walk"][0][0]
    exposure = 0.9 / np.percentile(first[first[:, :, 3] > 0.999][:, :3].max(axis=1), EXPOSED_PERCENTILE)
    labels = {
        "shape": f"Skinglow, Through the Shape\nEEVEE of Blender {hosts['shape'].version}",
        "walk": f"random walk, {options.samples} samples\nCycles of Blender {hosts['walk'].version}",
    }
    sheet, axes = plt.subplots(2, len(AZIMUTHS), figsize=(2.1 * len(AZIMUTHS), 4.9))
    for line, (kind, (frames, seconds, _told)) in zip(axes, rows.items(), strict=True):
        for ax, frame, cpu in zip(line, frames, seconds, strict=True):
            ax.imshow(to_screen(exposure * frame[:, :, :3]), interpolation="nearest")
            ax.set(xticks=[], yticks=[], xlabel=f"{cpu:.1f} s")
        line[0].set_ylabel(labels[kind], fontsize=9)
    sheet.tight_layout()
    sheet.savefig(options.picture, dpi=100)
    print({kind: told for kind, (_frames, _seconds, told) in rows.items()})
    print(options.picture)


if __name__ == "__main__":
    try:
        main()
    except DemoError as error:
        sys.exit(f"skinglow: {error}")
