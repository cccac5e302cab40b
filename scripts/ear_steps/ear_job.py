"""Runs inside Blender: renders the ear with every method and saves the pictures and their CPU times."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

STEPS = Path(__file__).resolve().parent
sys.path[:0] = [str(STEPS), str(STEPS.parent / "demo_steps")]
JOB: dict[str, Any] = json.loads(Path(sys.argv[-1]).read_text())
if JOB["package"]:
    sys.path.append(JOB["package"])  # last: a full Blender has its own numpy

import bpy  # noqa: E402, F401  isort: skip  (importing it makes the others importable)
import ear_scene  # noqa: E402
import numpy as np  # noqa: E402
import shading  # noqa: E402
import skinglow as sg  # noqa: E402
import slab_check  # noqa: E402
from job_steps import Steps, run  # noqa: E402
from medium import SKIN1  # noqa: E402

OUT = Path(JOB["out"])
TABLE_SIZE, MAX_THICKNESS_MM = 256, 12.0  # the add-on's defaults
LOOKUP_SAMPLES = 16
# The min of several renders: a lookup is so fast that one-time loading would dominate the first.
REPEATS = 3
BOUNCES = 4
REFERENCE_SEEDS, WALK_SEED, EQUAL_TIME_SEED = (1, 2), 3, 4


def lookup_materials(ear: ear_scene.Ear) -> dict[str, Any]:
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
        "existing": shading.lookup_skin("existing", [existing], MAX_THICKNESS_MM, None, 1.0),
        "paper": shading.lookup_skin("paper", [paper], MAX_THICKNESS_MM, None, 1.0),
        "object": shading.lookup_skin("object", [one_weight], MAX_THICKNESS_MM, None, diffuse),
        "surface": shading.lookup_skin("surface", columns, MAX_THICKNESS_MM, ear_scene.FAR_SIDE, diffuse),
        # Not a mode: the same with another definition of thickness, to measure its effect.
        "surface_open": shading.lookup_skin(
            "surface_open", columns, MAX_THICKNESS_MM, ear_scene.FAR_SIDE_OPEN, diffuse, ear_scene.THICKNESS_OPEN
        ),
    }


def main() -> dict[str, Any]:
    pictures: dict[str, np.ndarray] = {}
    seconds: dict[str, float] = {}
    counts = JOB["walk_samples"]
    step = Steps(of=8 + len(counts))

    step(f"a plane slab of {SKIN1.name}, compared with the solver")
    slab = slab_check.compare(SKIN1, 48, JOB["slab_samples"], OUT)
    step("the head, its thickness, irradiance on the far side")
    ear = ear_scene.build(JOB)

    def render(name: str, samples: int, seed: int = 0) -> None:
        picture = shading.render(ear.scene, samples, seed, OUT)
        pictures[name] = picture.pixels
        seconds[name] = min(picture.cpu_seconds, seconds.get(name, picture.cpu_seconds))

    for name in (ear_scene.FACTS, ear_scene.FAR_SIDE):
        shading.assign_material(ear.head, shading.shown_attribute(name))
        render(name, LOOKUP_SAMPLES)
    step("the lookups")
    materials, ear.cpu_seconds["tables"] = shading.timed(lambda: lookup_materials(ear))
    for name, material in materials.items():
        shading.assign_material(ear.head, material)
        for _ in range(REPEATS):
            render(name, LOOKUP_SAMPLES)

    shading.assign_material(ear.head, shading.random_walk(SKIN1))
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
        step(f"random walk, reference: {JOB['samples']} samples per pixel, seed {seed}")
        render(f"reference_{seed}", JOB["samples"], seed)
    shading.bounce(ear.scene, BOUNCES)
    for seed in REFERENCE_SEEDS:
        step(f"random walk with {BOUNCES} bounces between skin surfaces, seed {seed}")
        render(f"bounced_{seed}", JOB["samples"] // 4, seed)
    np.savez_compressed(OUT / "pictures.npz", **pictures)
    return {
        "blender": JOB["host"],
        "slab": slab,
        "seconds": seconds,
        "core_seconds": ear.cpu_seconds,
        "equal_time_samples": equal,
        "vertices": len(ear.head.data.vertices),
        "reference_point": ear.reference_point,
    }


run(main)
