"""Adds up what the fuzz targets executed, and writes it into a page: python -m tests.fuzz.tally TALLY.CSV PAGE.MD"""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from pathlib import Path

from studies import report

CORPUS = Path(__file__).parent / "corpus"
WHAT = {
    "compare": "pictures compared: finite figures that agree",
    "irradiance": "light of every kind on a surface; what culling leaves out is within its bound",
    "lut_csv": "tables as text; written is read back equal",
    "lut_exr": "tables and base images as EXR",
    "lut_png": "tables and base images as PNG",
    "mesh_glb": "GLB and glTF meshes; written is read back equal",
    "mesh_obj": "OBJ meshes; written is read back equal",
    "mesh_ply": "PLY meshes; written is read back equal",
    "mesh_stl": "STL meshes; written is read back equal",
    "povray": "POV-Ray text: balanced, strings end, numbers are numbers",
    "rig_file": "light rigs; written is read back equal",
    "shape": "light through small bodies: finite, none from nothing",
    "slab": "slabs of layers: R + T + A = 1",
    "studio_light": "Blender's studio lights",
    "thickness": "thickness: within the body",
    "tissue": "tables of any tissue: fall with thickness",
}


def rows(tally: Path) -> list[list[str]]:
    """A row for each target and one for all: what it is, executions, seconds, edges, inputs that failed and are mended.

    TALLY has rows of target, executions, seconds, edges of the code that were covered, outcome; one for each run.
    """
    executions: dict[str, int] = defaultdict(int)
    seconds: dict[str, float] = defaultdict(float)
    edges: dict[str, int] = defaultdict(int)
    with tally.open(newline="") as file:
        for target, executed, took, covered, _ in csv.reader(file):
            executions[target] += int(executed or 0)
            seconds[target] += float(took)
            edges[target] = max(edges[target], int(covered or 0))
    unknown = executions.keys() - WHAT.keys()
    if unknown:
        raise ValueError(f"{tally} tells of {', '.join(sorted(unknown))}, which tally.py does not describe")
    found = {name: mended(name) for name in WHAT}
    table = []
    for name in sorted(executions):
        counts = f"{executions[name]:,}", f"{seconds[name]:,.0f}", f"{edges[name]:,}", str(found[name])
        table.append([f"`{name}`", WHAT[name], *counts])
    sums = f"{sum(executions.values()):,}", f"{sum(seconds.values()):,.0f}"
    return [*table, ["**all**", "", *sums, "", str(sum(found.values()))]]


def mended(target: str) -> int:
    """Inputs that once failed, which every run replays."""
    folder = CORPUS / target / "mended"
    return sum(1 for each in folder.iterdir()) if folder.is_dir() else 0


def write(tally: Path, page: Path) -> None:
    heading = ["target", "what it takes, and what holds", "executions", "seconds", "edges covered", "found and mended"]
    report.fill(page, {"fuzz": report.table(heading, rows(tally))})


if __name__ == "__main__":
    write(Path(sys.argv[1]), Path(sys.argv[2]))
