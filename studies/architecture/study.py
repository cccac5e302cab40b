"""Draws which floor of the C++ core builds on which, as the includes have it: docs/images/architecture.svg."""

from __future__ import annotations

import argparse
import itertools
import math
import random
from pathlib import Path

import matplotlib
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from studies.architecture.includes import PUBLIC, arrows, arrows_text, floors
from studies.figures import plt
from studies.paths import IMAGES, PROJECT

CORE = PROJECT / "core"
WIDTH, HEIGHT, PAD = 2.3, 0.6, 0.06  #: of a box
#: Targets of their own; the other folders make up skinglow_core.
OWN_TARGETS = {
    "rays": "#e8c39e",
    "shape": "#e8c39e",
    "povray": "#e8c39e",
    "rig_files": "#e8c39e",
    "files": "#e8c39e",
    "cli": "#d9a5a0",
}
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


def columns(stacked: list[list[str]], drawn: set[tuple[str, str]]) -> dict[str, float]:
    """A column for each floor, so that arrows run past boxes, cross seldom and are short: a search from fixed seeds."""
    level = {floor: y for y, row in enumerate(stacked) for floor in row}

    def cost(x: dict[str, float]) -> float:
        total = 0.0
        for a, b in drawn:
            total += abs(x[a] - x[b]) + 0.3 * (level[a] - level[b] - 1)
            for other in level:
                if level[b] < level[other] < level[a]:
                    t = (level[other] - level[b]) / (level[a] - level[b])
                    total += 20.0 * (abs(x[b] + t * (x[a] - x[b]) - x[other]) < 0.75)
        for (a, b), (c, d) in itertools.combinations(drawn, 2):
            if level[a] == level[c] and level[b] == level[d]:
                total += 3.0 * ((x[a] - x[c]) * (x[b] - x[d]) < 0.0)
        return total

    best: tuple[float, dict[str, float]] = (math.inf, {})
    for seed in range(12):
        choose = random.Random(seed)
        x = {floor: i - (len(row) - 1) / 2 for row in stacked for i, floor in enumerate(choose.sample(row, len(row)))}
        now = cost(x)
        for _ in range(3000):
            moved = dict(x)
            row = choose.choice(stacked)
            first = choose.choice(row)
            wanted = choose.choice((-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5))
            for other in row:
                if other != first and abs(x[other] - wanted) < 1.0:
                    moved[other] = x[first]
            moved[first] = wanted
            apart = all(abs(moved[a] - moved[b]) >= 1.0 for a, b in itertools.combinations(row, 2))
            if apart and (new := cost(moved)) <= now:
                x, now = moved, new
        best = min(best, (now, x), key=lambda each: each[0])
    return best[1]


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m studies architecture", description=__doc__)
    parser.add_argument("also", nargs="*", type=Path, metavar="ALSO.png", help="other files to write it to")
    also: list[Path] = parser.parse_args(arguments).also
    drawn = direct_arrows()
    stacked = rows(drawn)
    x = columns(stacked, drawn)
    place = {floor: (2.9 * x[floor], 1.3 * y) for y, row in enumerate(stacked) for floor in row}
    left, right = min(p[0] for p in place.values()) - 1.5, max(p[0] for p in place.values()) + 1.5
    figure, axes = plt.subplots(figsize=(right - left, 1.3 * len(stacked) + 0.2))
    for a, b in sorted(drawn):
        (x0, y0), (x1, y1) = place[a], place[b]
        lean = max(-0.6, min(0.6, 0.25 * (x1 - x0)))
        ends = ((x0 + lean, y0 - HEIGHT / 2 - PAD), (x1 - lean, y1 + HEIGHT / 2 + PAD))
        look = {"arrowstyle": "-|>", "mutation_scale": 14, "color": "#555555"}
        axes.add_patch(FancyArrowPatch(*ends, shrinkA=0, shrinkB=0, **look))
    for floor, (x_center, y) in place.items():
        corner = (x_center - WIDTH / 2, y - HEIGHT / 2)
        look = {"boxstyle": f"round,pad={PAD}", "facecolor": OWN_TARGETS.get(floor, CORE_COLOR), "edgecolor": "#333333"}
        axes.add_patch(FancyBboxPatch(corner, WIDTH, HEIGHT, **look))
        headers = sorted(name.removesuffix(".h") for name in PUBLIC if PUBLIC[name] == floor and is_there(name))
        axes.text(x_center, y + (0.13 if headers else 0.0), floor, ha="center", va="center", fontsize=13, weight="bold")
        axes.text(x_center, y - 0.17, ", ".join(headers), ha="center", va="center", fontsize=8)
    axes.set_xlim(left, right)
    axes.set_ylim(-0.6, 1.3 * (len(stacked) - 1) + 0.6)
    axes.set_aspect("equal")
    axes.axis("off")
    figure.tight_layout(pad=0.2)
    matplotlib.rcParams["svg.hashsalt"] = "skinglow"  # the same file from the same includes
    target = IMAGES / "architecture.svg"
    figure.savefig(target, metadata={"Date": None, "Description": arrows_text(CORE)})
    for path in also:
        figure.savefig(path, dpi=100)


def is_there(header: str) -> bool:
    return (CORE / "include" / "skinglow" / header).exists()
