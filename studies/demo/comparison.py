"""POV-Ray renders what Blender exported; the transmitted light of both is compared as linear EXR."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from studies.paths import CLI
from studies.progress import Progress, StudyError

ALLOWED_RMS = 1.0 / 255.0


def render_and_compare(out: Path, size: int, progress: Progress) -> dict[str, Any]:
    """Writes POV-Ray's pictures and difference.png to `out`; returns the numbers of the comparison."""
    progress.say("POV-Ray: the ear, about 5 s")
    _povray(out / "povray", out / "table1_povray.png", ["+FN", "+R3"], size, progress)
    progress.say("POV-Ray: transmitted light only, to be compared and to be shown, about 12 s")
    _povray(out / "povray_light_through", out / "light_through_povray.exr", ["+FE", "+R8"], size, progress)
    _povray(out / "povray_light_through", out / "light_through_povray.png", ["+FN", "+R3"], size, progress)
    progress.say("comparing both")
    pictures = ["light_through_blender.exr", "light_through_povray.exr"]
    options = ["--ignore-edges", "--json", "--heatmap", "difference.png"]
    compared = subprocess.run([CLI, "compare", *pictures, *options], cwd=out, capture_output=True, text=True)
    if compared.returncode != 0:
        raise StudyError(compared.stderr.strip())
    figures = json.loads(compared.stdout)
    figures["allowed_rms"] = ALLOWED_RMS
    verdict = "within" if figures["rms"] <= ALLOWED_RMS else "ABOVE"
    progress.say(f"RMS difference {figures['rms']:.2e}, {verdict} 1/255 = {ALLOWED_RMS:.2e}")
    return figures


def _povray(folder: Path, picture: Path, kind: list[str], size: int, progress: Progress) -> None:
    """Samples pixels on a regular grid without jitter, equivalent to Blender's box filter."""
    sampling = ["+A0.0", "+AM1", "-J"]
    command = [
        "povray",
        "scene.pov",
        f"+O{picture}",
        f"+W{size}",
        f"+H{size}",
        *kind,
        "+UA",
        "-D",
        *sampling,
        "+WT2",
    ]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    progress.note(done.stderr)
    if done.returncode != 0 or not picture.is_file():
        raise StudyError(f"POV-Ray could not render {folder / 'scene.pov'}; its output is in {progress.log}")
