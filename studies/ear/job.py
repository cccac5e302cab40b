"""Runs inside Blender: renders the ear with every method and saves the pictures and their CPU times."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow_blender as sb

from studies import rendering, skins
from studies.ear import scene, slab_check
from studies.in_blender import Steps
from studies.medium import SKIN1
from studies.timing import timed

LOOKUP_SAMPLES = 16
# The min of several renders: a lookup is so fast that one-time loading would dominate the first.
REPEATS = 3
BOUNCES = 4
REFERENCE_SEEDS, WALK_SEED, EQUAL_TIME_SEED = (1, 2), 3, 4


#: Settings of make_skin by method. The last is no mode: another definition of thickness, to measure its effect.
SKINS: dict[str, dict[str, Any]] = {
    "existing": {"mode": "existing"},
    "paper": {"mode": "paper"},
    "object": {"mode": "physical", "weights": "object"},
    "surface": {"mode": "physical", "weights": "surface"},
    "surface_open": {"mode": "physical", "weights": "surface"},
}


def main(job: dict[str, Any]) -> dict[str, Any]:
    out = Path(job["out"])
    pictures: dict[str, np.ndarray] = {}
    seconds: dict[str, float] = {}
    counts = job["walk_samples"]
    step = Steps(of=8 + len(counts))

    step(f"a plane slab of {SKIN1.name}, compared with the solver")
    slab = slab_check.compare(SKIN1, 48, job["slab_samples"], out)
    step("the head, its thickness, irradiance on the far side")
    ear = scene.build(job)

    def render(name: str, samples: int, seed: int = 0) -> None:
        picture = rendering.render(ear.scene, samples, seed, out)
        pictures[name] = picture.pixels
        seconds[name] = min(picture.cpu_seconds, seconds.get(name, picture.cpu_seconds))

    for name in (scene.FACTS, scene.FAR_SIDE):
        rendering.assign_material(ear.head, rendering.shown_attribute(name))
        render(name, LOOKUP_SAMPLES)
    step("the lookups")
    core: dict[str, float] = {}
    with skins.tables_of(SKIN1):
        for name, settings in SKINS.items():
            thickness = ear.thickness_open if name == "surface_open" else None
            _, made = timed(skins.make, ear.head, SKIN1, thickness=thickness, **settings)
            core.setdefault("thickness", made)
            for _ in range(REPEATS):
                render(name, LOOKUP_SAMPLES)
            if name == "surface":
                bpy.data.lights["light"].energy *= 1.0 + 1e-6
                _, core["update"] = timed(skins.update, ear.head)
        sb.remove_skin(ear.head)

    rendering.assign_material(ear.head, rendering.random_walk(SKIN1))
    for samples in counts:
        step(f"random walk, {samples} samples per pixel")
        render(f"walk_{samples}", samples, WALK_SEED)
    step("random walk in the render time of a lookup")
    few, many = counts[0], counts[-1]
    each = (seconds[f"walk_{many}"] - seconds[f"walk_{few}"]) / (many - few)
    fixed = max(0.0, seconds[f"walk_{few}"] - few * each)
    equal = max(1, round((seconds["surface"] - fixed) / each))
    render("equal_time", equal, EQUAL_TIME_SEED)
    for seed in REFERENCE_SEEDS:
        step(f"random walk, reference: {job['samples']} samples per pixel, seed {seed}")
        render(f"reference_{seed}", job["samples"], seed)
    rendering.bounce(ear.scene, BOUNCES)
    for seed in REFERENCE_SEEDS:
        step(f"random walk with {BOUNCES} bounces between skin surfaces, seed {seed}")
        render(f"bounced_{seed}", job["samples"] // 4, seed)
    np.savez_compressed(out / "pictures.npz", **pictures)
    return {
        "blender": job["host"],
        "slab": slab,
        "seconds": seconds,
        "core_seconds": core,
        "equal_time_samples": equal,
        "vertices": len(ear.head.data.vertices),
    }
