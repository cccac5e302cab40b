"""A sheet of a batch's pictures: a row for each rig, a column for each frame, and what lit them, by the manifest.

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
            entries[entry["rig"], entry["frame"]] = entry  # the last line of a picture counts
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
    """The lamps that count for the skin, and their shares."""
    lamps = [lamp for lamp in entry["skins"][0]["lamps"] if lamp["share"] > 0.0]
    return ", ".join(f"{lamp['name']} {lamp['share']:.0%}" for lamp in lamps)


main(Path(sys.argv[1]), Path(sys.argv[2]))
