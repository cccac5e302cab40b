"""Draws which floor of the C++ core builds on which, as the includes have it.

Usage: architecture_steps [ALSO.png]     (writes docs/images/architecture.svg)
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from includes import PUBLIC, arrows, arrows_text, floors  # noqa: E402
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch  # noqa: E402

ROOT = Path(__file__).parents[2]
CORE = ROOT / "core"
WIDTH, HEIGHT = 2.3, 0.62  #: of a box
#: Targets of their own; the other folders make up skinglow_core.
OWN_TARGETS = {"rays": "#e8c39e", "povray": "#e8c39e", "rig_files": "#e8c39e", "files": "#e8c39e", "cli": "#d9a5a0"}
CORE_COLOR = "#b9d3e6"


def direct_arrows() -> set[tuple[str, str]]:
    """Those that no way over other floors stands for."""
    all_arrows = set(arrows(CORE))

    def reached(start: str) -> set[str]:
        found: set[str] = set()
        todo = [start]
        while todo:
            here = todo.pop()
            for a, b in all_arrows:
                if a == here and b not in found:
                    found.add(b)
                    todo.append(b)
        return found

    below = {floor: reached(floor) for floor in floors(CORE)}
    return {(a, b) for a, b in all_arrows if not any(b in below[c] for d, c in all_arrows if d == a and c != b)}


def rows(drawn: set[tuple[str, str]]) -> list[list[str]]:
    """The floors in rows from the ground up: each stands above all that it includes."""
    row: dict[str, int] = {}
    for floor in floors(CORE):
        row[floor] = max((row[b] + 1 for a, b in drawn if a == floor), default=0)
    return [[floor for floor in row if row[floor] == i] for i in range(max(row.values()) + 1)]


def main(also: list[str]) -> None:
    drawn = direct_arrows()
    stacked = rows(drawn)
    widest = max(map(len, stacked))
    place = {}
    for y, row in enumerate(stacked):
        for x, floor in enumerate(row):
            place[floor] = ((x - (len(row) - 1) / 2) * 3.0, y * 1.35)
    figure, axes = plt.subplots(figsize=(3.0 * widest + 0.6, 1.35 * len(stacked) + 0.3))
    for a, b in sorted(drawn):
        (x0, y0), (x1, y1) = place[a], place[b]
        lean = 0.3 * max(-1.0, min(1.0, x1 - x0))
        ends = ((x0 + lean, y0 - HEIGHT / 2), (x1 - lean, y1 + HEIGHT / 2))
        look = {"arrowstyle": "-|>", "mutation_scale": 14, "color": "#555555"}
        axes.add_patch(FancyArrowPatch(*ends, shrinkA=0, shrinkB=0, **look))
    for floor, (x, y) in place.items():
        corner = (x - WIDTH / 2, y - HEIGHT / 2)
        color = OWN_TARGETS.get(floor, CORE_COLOR)
        look = {"boxstyle": "round,pad=0.06", "facecolor": color, "edgecolor": "#333333"}
        axes.add_patch(FancyBboxPatch(corner, WIDTH, HEIGHT, **look))
        headers = sorted(name.removesuffix(".h") for name in PUBLIC if PUBLIC[name] == floor and is_there(name))
        axes.text(x, y + (0.13 if headers else 0.0), floor, ha="center", va="center", fontsize=13, fontweight="bold")
        if headers:
            axes.text(x, y - 0.17, ", ".join(headers), ha="center", va="center", fontsize=7.5)
    axes.set_xlim(-1.5 * widest, 1.5 * widest)
    axes.set_ylim(-0.6, 1.35 * (len(stacked) - 1) + 0.6)
    axes.set_aspect("equal")
    axes.axis("off")
    figure.tight_layout(pad=0.2)
    matplotlib.rcParams["svg.hashsalt"] = "skinglow"  # the same file from the same includes
    target = ROOT / "docs" / "images" / "architecture.svg"
    figure.savefig(target, metadata={"Date": None, "Description": arrows_text(CORE)})
    for path in also:
        figure.savefig(path, dpi=100)


def is_there(header: str) -> bool:
    return (CORE / "include" / "skinglow" / header).exists()


main(sys.argv[1:])
