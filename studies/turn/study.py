"""Makes the first picture of docs/blender.md: a light carried round the ear in six frames, through the shape in EEVEE,
and by the random walk of Cycles in the same medium, with the time of each frame.

EEVEE needs a full Blender and a display; where there is none, Xvfb makes one.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from studies import hosts
from studies.figures import plt, save, to_screen
from studies.heads import sources
from studies.paths import IMAGES, PROJECT
from studies.progress import Progress
from studies.turn.film import AZIMUTHS, save_film

#: The brightest three percent of the first frame's pixels may be clipped.
EXPOSED_PERCENTILE = 97.0


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m studies turn", description=__doc__)
    parser.add_argument("--eevee", metavar="BLENDER", default="blender", help="a full Blender (default %(default)s)")
    parser.add_argument("--cycles", metavar="BLENDER", help="a Blender program or a Python with bpy (default: 4.5)")
    parser.add_argument("--size", type=int, default=240, help="of a picture, pixels (default %(default)s)")
    parser.add_argument("--samples", type=int, default=256, help="of a pixel of Cycles' walk (default %(default)s)")
    parser.add_argument("--out", type=Path, default=PROJECT / "out" / "turn", help="(default %(default)s)")
    parser.add_argument("--picture", type=Path, default=IMAGES / "round_the_ear.png")
    return parser.parse_args(arguments)


def render(
    kind: str, host: hosts.Host, options: argparse.Namespace, progress: Progress
) -> tuple[np.ndarray, list[float], dict[str, object]]:
    """Pictures (frames, height, width, 4) linear, CPU seconds of each frame, and what the job told."""
    pictures = options.out / f"{kind}.npz"
    job = {
        **sources.head_job(None, progress),
        "kind": kind,
        "azimuths": AZIMUTHS,
        "size": options.size,
        "samples": options.samples,
        "out": str(options.out),
        "pictures": str(pictures),
    }
    told = host.run("studies.turn.job", job, progress, display=kind == "shape")
    with np.load(pictures) as file:
        return file["frames"], told["seconds"], told


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    progress = Progress(options.out / "turn.log")
    programs = {"shape": hosts.Host.find(options.eevee), "walk": hosts.Host.find(options.cycles)}
    rows = {kind: render(kind, host, options, progress) for kind, host in programs.items()}
    first = rows["walk"][0][0]
    exposure = 0.9 / np.percentile(first[first[:, :, 3] > 0.999][:, :3].max(axis=1), EXPOSED_PERCENTILE)
    labels = {
        "shape": f"Skinglow, Through the Shape\nEEVEE of Blender {programs['shape'].version}",
        "walk": f"random walk, {options.samples} samples\nCycles of Blender {programs['walk'].version}",
    }
    sheet, axes = plt.subplots(2, len(AZIMUTHS), figsize=(2.1 * len(AZIMUTHS), 4.9))
    for line, (kind, (frames, seconds, _told)) in zip(axes, rows.items(), strict=True):
        for ax, frame, cpu in zip(line, frames, seconds, strict=True):
            ax.imshow(to_screen(exposure * frame[:, :, :3]), interpolation="nearest")
            ax.set(xticks=[], yticks=[], xlabel=f"{cpu:.1f} s")
        line[0].set_ylabel(labels[kind], fontsize=9)
    save(sheet, options.picture, dpi=100)
    save_film(
        options.picture.with_name("round_the_ear_film.jpg"),
        [frames for frames, _seconds, _told in rows.values()],
        exposure,
    )
    print({kind: told for kind, (_frames, _seconds, told) in rows.items()})
    print(options.picture)
