"""Runs inside Blender: the ear of a head under several rigs with every rung that Cycles renders."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from mathutils import Vector
from skinglow_blender.batch.rig_lights import added_lights

from studies import rendering, skins
from studies import scenes as stage
from studies.in_blender import Steps
from studies.medium import SKIN1
from studies.timing import timed

#: Of the camera, off the front (-Y) towards the ear.
CAMERA_AZIMUTH = math.radians(25.0)
#: Settings of make_skin by rung. Through the shape with cells of these sizes, mm.
LOOKUPS: dict[str, dict[str, Any]] = {
    "fixed": {"mode": "existing"},
    "tinted": {"mode": "paper"},
    "object": {"mode": "physical", "weights": "object"},
    "pixel": {"mode": "physical", "weights": "surface"},
    **{f"shape {c:g}": {"mode": "physical", "weights": "shape", "cell_mm": c, "reentries": 0} for c in (1.2, 0.8, 0.5)},
}
SAMPLES, SEEDS = 4, (1, 2)
#: A render's first call loads what later ones have.
REPEATS = 2


def build(job: dict[str, Any]) -> tuple[bpy.types.Scene, bpy.types.Object, Vector]:
    """The head at real size in the dark, seen from the front of its ear. Its mesh is that of the Monte Carlo."""
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    rendering.linear_render(scene, job["size"])
    with np.load(job["mesh_file"]) as file:
        mesh = bpy.data.meshes.new("head")
        mesh.from_pydata((file["vertices_mm"] / rendering.MM_PER_METER).tolist(), [], file["triangles"].tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    head = bpy.data.objects.new("head", mesh)
    scene.collection.objects.link(head)
    ear = Vector(job["center"])
    stage.aim_camera(scene, ear, job["height"], CAMERA_AZIMUTH)
    return scene, head, ear


class Ladder:
    """Pictures and CPU seconds by (rig, rung)."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.scene, self.head, self.ear = build(job)
        self.out = Path(job["out"])
        self.rigs = {name: sg.read_light_rig(path) for name, path in job["rigs"].items()}
        self.pictures: dict[str, np.ndarray] = {}
        self.seconds: dict[str, float] = {}
        self.prepared: dict[str, float] = {}

    def render(self, name: str, samples: int, seed: int = 0, repeats: int = 1, before: float = 0.0) -> float:
        """The least CPU seconds of the renders, and `before`, what an update before them took."""
        found = [rendering.render(self.scene, samples, seed, self.out) for _ in range(repeats)]
        self.pictures[name] = found[-1].pixels
        self.seconds[name] = before + min(each.cpu_seconds for each in found)
        return self.seconds[name]

    def lit(self, rig: str) -> Any:  # noqa: ANN401  a context manager
        return added_lights(self.scene, self.rigs[rig], tuple(self.ear))

    def show_attributes(self, path: Path) -> None:
        """Values at vertices as pixels: what is compared, and the Monte Carlo's."""
        with np.load(path) as file:
            for name in file.files:
                rendering.store_color(self.head.data, name, file[name])
                rendering.assign_material(self.head, rendering.shown_attribute(name))
                self.render(name, 8)

    def show_lookup(self, rung: str) -> None:
        """The first rig makes the skin ready, and that is not timed with the pictures."""
        with skins.tables_of(SKIN1):
            with self.lit(next(reversed(self.rigs))):
                _, self.prepared[rung] = timed(skins.make, self.head, SKIN1, **LOOKUPS[rung])
            for rig in self.rigs:
                with self.lit(rig):
                    _, update = timed(skins.update, self.head)
                    self.render(f"{rig}|{rung}", SAMPLES, repeats=REPEATS, before=update)
            sb.remove_skin(self.head)


def main(job: dict[str, Any]) -> dict[str, Any]:
    step = Steps(of=2 + len(LOOKUPS) + len(job["rigs"]))
    step("the head")
    ladder = Ladder(job)
    step("what is compared, and the Monte Carlo")
    ladder.show_attributes(Path(job["attributes"]))
    for rung in LOOKUPS:
        step(f"{rung}: the skin, and a picture under each rig")
        ladder.show_lookup(rung)
    rendering.assign_material(ladder.head, rendering.random_walk(SKIN1))
    for rig in ladder.rigs:
        step(f"random walk under the rig {rig}")
        with ladder.lit(rig):
            for samples in job["walk_samples"]:
                ladder.render(f"{rig}|walk {samples}", samples, 10 + samples)
            for seed in SEEDS:
                ladder.render(f"{rig}|reference {seed}", job["samples"], seed)
            few, many = job["walk_samples"][0], job["samples"]
            each = (ladder.seconds[f"{rig}|reference 1"] - ladder.seconds[f"{rig}|walk {few}"]) / (many - few)
            equal = max(1, round(ladder.seconds[f"{rig}|shape 0.8"] / each))
            ladder.render(f"{rig}|equal time {equal}", equal, 7)
    np.savez_compressed(job["pictures"], **{name: each.astype(np.float32) for name, each in ladder.pictures.items()})
    return {"blender": job["host"], "seconds": ladder.seconds, "prepared": ladder.prepared, "samples": job["samples"]}
