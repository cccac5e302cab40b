"""The light rigs: Blender's rim.sl (or the user's rig) and the three lights of the paper's Table 1."""

from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from studies.hosts import Host
from studies.paths import CLI, PROJECT
from studies.progress import Progress, StudyError

TABLE1 = PROJECT / "tests" / "data" / "table1.json"
CAMERA_AZIMUTH_DEGREES = 35.0  # from the front, so that an ear is in front of the rim lights


def gather(own: Path | None, host: Host, progress: Progress) -> dict[str, Any]:
    """{"rim": rig, "table1": rig}; a rig's origin is the reference point of the skin."""
    rim = own or host.datafiles / "studiolights" / "studio" / "rim.sl"
    if not rim.is_file():
        raise StudyError(f"{rim}: no such file; give a light rig with --rig")
    progress.say(f"lights: {rim.name} and Table 1 of the paper")
    return {"rim": _read(rim), "table1": _read(TABLE1)}


def _read(rig: Path) -> dict[str, Any]:
    """The rig as read by the command line; a studio light is attached to the demo's camera."""
    camera = ["--camera-rotation", "90", "0", str(CAMERA_AZIMUTH_DEGREES)] if rig.suffix == ".sl" else []
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "rig.json"
        done = subprocess.run([CLI, "rig", rig, *camera, "-o", plain], capture_output=True, text=True)
        if done.returncode != 0:
            raise StudyError(done.stderr.strip())
        return json.loads(plain.read_text())
