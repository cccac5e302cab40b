"""A contact sheet of a batch: one row per rig, one column per frame, with the lights from the manifest."""

from __future__ import annotations

import json
from pathlib import Path

from studies.figures import plt, save

BACKGROUND, INK = "#16181c", "#d8dade"


def draw(folder: Path, sheet: Path) -> None:
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
    save(figure, sheet, dpi=100)


def lit_by(entry: dict) -> str:
    """The lights that contribute to the skin, and their fractions."""
    lights = [light for light in entry["skins"][0]["lamps"] if light["share"] > 0.0]
    return ", ".join(f"{light['name']} {light['share']:.0%}" for light in lights)
