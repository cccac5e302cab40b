"""Runs inside Blender: renders the ear with every method and saves the pictures and their CPU times."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import skinglow as sg

from studies import rendering
from studies.ear import scene, slab_check
from studies.in_blender import Steps
from studies.medium import SKIN1

TABLE_SIZE, MAX_THICKNESS_MM = 256, 12.0  # the add-on's defaults
LOOKUP_SAMPLES = 16
# The min of several renders: a lookup is so fast that one-time loading would dominate the first.
REPEATS = 3
BOUNCES = 4
REFERENCE_SEEDS, WALK_SEED, EQUAL_TIME_SEED = (1, 2), 3, 4


def lookup_materials(ear: scene.Ear) -> dict[str, Any]:
    """The lookup methods, as shown by the modes of the add-on (docs/method.md)."""
    weight = sg.PAPER_BLOOD_WEIGHT + sg.light_weight([ear.light], ear.reference_point)
    base = SKIN1.base_lut(TABLE_SIZE, MAX_THICKNESS_MM)
    object_weight = sg.object_irradiance([ear.light], ear.reference_point)
    existing = sg.six_gaussian_lookup(TABLE_SIZE, MAX_THICKNESS_MM)
    paper = sg.recolor(sg.six_gaussian_base(TABLE_SIZE, MAX_THICKNESS_MM), weight)
    one_weight = sg.recolor(base, object_weight)
    columns = [base.matrices[:, :, j] for j in range(3)]
    diffuse = 1.0 / np.pi  # physical: irradiance in, diffuse radiance out
    return {
        "existing": rendering.lookup_skin("existing", [existing], MAX_THICKNESS_MM, None, 1.0),
        "paper": rendering.lookup_skin("paper", [paper], MAX_THICKNESS_MM, None, 1.0),
        "object": rendering.lookup_skin("object", [one_weight], MAX_THICKNESS_MM, None, diffuse),
        "surface": rendering.lookup_skin("surface", columns, MAX_THICKNESS_MM, scene.FAR_SIDE, diffuse),
        # Not a mode: the same with another definition of thickness, to measure its effect.
        "surface_open": rendering.lookup_skin(
            "surface_open", columns, MAX_THICKNESS_MM, scene.FAR_SIDE_OPEN, diffuse, scene.THICKNESS_OPEN
        ),
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
    materials, ear.cpu_seconds["tables"] = rendering.timed(lambda: lookup_materials(ear))
    for name, material in materials.items():
        rendering.assign_material(ear.head, material)
        for _ in range(REPEATS):
            render(name, LOOKUP_SAMPLES)

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
        "core_seconds": ear.cpu_seconds,
        "equal_time_samples": equal,
        "vertices": len(ear.head.data.vertices),
        "reference_point": ear.reference_point,
    }
