"""Runs inside Blender with a display: the same ear with EEVEE's subsurface scattering and its translucency."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import skinglow as sg
from skinglow_blender.batch.rig_lights import added_lights

from studies import rendering
from studies.in_blender import Steps
from studies.ladder.cells import Cells
from studies.ladder.job import build
from studies.medium import SKIN1

SAMPLES = 16


def main(job: dict[str, Any]) -> dict[str, Any]:
    cells = Cells(Path(job["cells"]))
    missing = {rig: path for rig, path in job["rigs"].items() if f"{rig}|eevee" not in cells}
    step = Steps(of=len(missing))
    scene, head, ear = build(job)
    material = rendering.random_walk(SKIN1)
    material.use_sss_translucency = True
    rendering.assign_material(head, material)
    rendering.use_eevee(scene, SAMPLES)
    for rig, path in missing.items():
        step(f"EEVEE's translucency under the rig {rig}")
        with added_lights(scene, sg.read_light_rig(path), tuple(ear)):
            for light in (each.data for each in scene.objects if each.type == "LIGHT"):
                rendering.sharpen_shadows(scene, light)
            picture = rendering.render(scene, SAMPLES, 0, Path(job["out"]))
        cells.keep(f"{rig}|eevee", picture.pixels, picture.cpu_seconds)
    return {}
