"""A contact sheet of a batch: one row per rig, one column per frame, with the lights from the manifest.

Usage: contact_sheet.py FOLDER SHEET.png
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

BACKGROUND, INK = "#16181c", "#d8dade"


def main(folder: Path, sheet: Path) -> None:
    entries: dict[tuple[str, int], dict] = {}
    for path in sorted(folder.glob("manifest*.jsonl")):
        for line in path.read_text().splitlines():
            entry = json.loads(line)
            entries[entry["rig"], entry["frame"]] = entry  # the last entry of a picture counts
    rigs = list(dict.fromkeys(rig for rig, _frame in entries))
    frames = sorted({frame for _rig, frame in entries})
    figure, axes = plt.subplots(len(rigs), len(frames), figsize=(2.6 * len(frames), 2.9 * len(rigs)), squeeze=False)
    figure.set_facecolor(BACKGROUND)
    for row, rig in zip(axes, rigs, strict=True):
        for axis, frame in zip(row, frames, strict=True):
            axis.axis("off")
            entry = entries.get((rig, frame))
            if entry is None:
                continue
            axis.imshow(plt.imread(folder / entry["file"]))
            axis.set_title(f"{rig}, frame {frame}\n{lit_by(entry)}", color=INK, fontsize=8, loc="left")
    figure.tight_layout()
    figure.savefig(sheet, dpi=100)


def lit_by(entry: dict) -> str:
    """The lights that contribute to the skin, and their fractions."""
    lights = [light for light in entry["skins"][0]["lamps"] if light["share"] > 0.0]
    return ", ".join(f"{light['name']} {light['share']:.0%}" for light in lights)


main(Path(sys.argv[1]), Path(sys.argv[2]))
