"""Runs inside Blender: the ear of a head under several rigs with every rung that Cycles renders."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
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
from studies.ladder.cells import Cells
from studies.ladder.results import equal_samples
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
#: Of pictures without noise: fewer leave edges between folds of the ear to chance, which was 14 % of error on the scan.
SAMPLES, SEEDS = 64, (1, 2)
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
    """Renders what its cells do not have yet."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.scene, self.head, self.ear = build(job)
        self.out, self.samples = Path(job["out"]), job["samples"]
        self.rigs = {name: sg.read_light_rig(path) for name, path in job["rigs"].items()}
        self.cells = Cells(Path(job["cells"]))

    def render(self, name: str, samples: int, seed: int = 0, repeats: int = 1, **also: float) -> None:
        """Keeps a picture with the least CPU seconds of its renders; also: what was made ready for it (CPU s)."""
        found = [rendering.render(self.scene, samples, seed, self.out) for _ in range(repeats)]
        seconds = min(each.cpu_seconds for each in found) + also.get("update", 0.0)
        self.cells.keep(name, found[-1].pixels, seconds, also.get("prepared", 0.0))

    def lit(self, rig: str) -> AbstractContextManager[object]:
        return added_lights(self.scene, self.rigs[rig], tuple(self.ear))

    def show_attributes(self, path: Path) -> None:
        """Values at vertices as pixels: what is compared, and the Monte Carlo's."""
        with np.load(path) as file:
            for name in file.files:
                rendering.store_color(self.head.data, name, file[name])
                rendering.assign_material(self.head, rendering.shown_attribute(name))
                self.render(name, SAMPLES)

    def show_lookup(self, rung: str, say: Callable[[str], None]) -> None:
        """The last rig makes the skin ready, and that is not timed with the pictures."""
        if all(f"{rig}|{rung}" in self.cells for rig in self.rigs):
            return
        say(f"{rung}: the skin, and a picture under each rig")
        with skins.tables_of(SKIN1):
            with self.lit(next(reversed(self.rigs))):
                _, prepared = timed(skins.make, self.head, SKIN1, **LOOKUPS[rung])
            for rig in self.rigs:
                with self.lit(rig):
                    _, update = timed(skins.update, self.head)
                    self.render(f"{rig}|{rung}", SAMPLES, repeats=REPEATS, update=update, prepared=prepared)
            sb.remove_skin(self.head)

    def walk(self, rig: str, what: str, samples: int, seed: int) -> None:
        if f"{rig}|{what}" not in self.cells:
            self.render(f"{rig}|{what}", samples, seed)

    def show_walks(self, rig: str, fewer: list[int]) -> None:
        """Walks of fewer samples, the halves of the reference, together a rung too, and that of equal time."""
        with self.lit(rig):
            for samples in fewer:
                self.walk(rig, f"walk {samples}", samples, 10 + samples)
            for seed in SEEDS:
                self.walk(rig, f"half {self.samples} {seed}", self.samples // 2, seed)
            equal = equal_samples(self.cells, rig, self.samples)
            self.walk(rig, f"equal {equal}", equal, 7)


def main(job: dict[str, Any]) -> dict[str, Any]:
    step = Steps(of=2 + len(LOOKUPS) + len(job["rigs"]))
    step("the head")
    ladder = Ladder(job)
    step("what is compared, and the Monte Carlo")
    ladder.show_attributes(Path(job["attributes"]))
    for rung in LOOKUPS:
        ladder.show_lookup(rung, step)
    rendering.assign_material(ladder.head, rendering.random_walk(SKIN1))
    for rig in ladder.rigs:
        step(f"random walk under the rig {rig}")
        ladder.show_walks(rig, job["walk_samples"])
    return {}
