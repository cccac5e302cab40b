"""The light rigs: Blender's rim.sl (or the user's rig) and the three lights of the paper's Table 1."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import skinglow as sg

from studies.hosts import Host
from studies.paths import PROJECT
from studies.progress import Progress, StudyError

TABLE1 = PROJECT / "tests" / "data" / "table1.json"
CAMERA_AZIMUTH_DEGREES = 35.0  # from the front, so that an ear is in front of the rim lights


def gather(own: Path | None, host: Host, progress: Progress) -> dict[str, Any]:
    """By name, what scenes.add_rig reads: "rim" and "table1"; their point is the reference point of the skin."""
    rim = own or host.datafiles / "studiolights" / "studio" / "rim.sl"
    if not rim.is_file():
        raise StudyError(f"{rim}: no such file; give a light rig with --rig")
    progress.say(f"lights: {rim.name} and Table 1 of the paper")
    return {"rim": _read(rim), "table1": _read(TABLE1)}


def _read(path: Path) -> list[Any]:
    """The arguments of skinglow.read_light_rig; a studio light is attached to the demo's camera."""
    read = [
        str(path.resolve()),
        [math.pi / 2.0, 0.0, math.radians(CAMERA_AZIMUTH_DEGREES)] if path.suffix == ".sl" else None,
    ]
    try:
        sg.read_light_rig(*read)
    except ValueError as error:
        raise StudyError(str(error)) from None
    return read
