"""Runs inside Blender: the ear from two sides, by attributes of its vertices and by Cycles' random walk."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import skinglow as sg
from mathutils import Vector

from studies import rendering
from studies import scenes as stage
from studies.heads import loading
from studies.in_blender import Steps
from studies.medium import SKIN1

#: Off the front, towards +X: the camera in the dark, and the one on the light's side.
VIEWS = {"front": 25.0, "back": 135.0}
ATTRIBUTE_SAMPLES, SEEDS = 8, (1, 2)


def main(job: dict[str, Any]) -> dict[str, Any]:
    out = Path(job["out"])
    with np.load(job["attributes"]) as file:
        attributes = {name: file[name] for name in file.files}
    seeds = SEEDS if job["samples"] else ()
    step = Steps(of=len(VIEWS) * (1 + len(seeds)))
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    rendering.linear_render(scene, job["size"])
    head, _placed = loading.load_alone(job)
    stage.add_light(scene, sg.Light(**job["light"]))
    for name, values in attributes.items():
        if len(values) != len(head.data.vertices):
            raise SystemExit(f"{name} has {len(values)} values, the head {len(head.data.vertices)} vertices")
        rendering.store_color(head.data, name, values)

    pictures: dict[str, np.ndarray] = {}
    seconds: dict[str, float] = {}
    walk = rendering.random_walk(SKIN1)
    for view, azimuth in VIEWS.items():
        stage.aim_camera(scene, Vector(job["center"]), job["height"], math.radians(azimuth))
        step(f"{view}: {len(attributes)} attributes")
        for name in attributes:
            rendering.assign_material(head, rendering.shown_attribute(name))
            pictures[f"{view}-{name}"] = rendering.render(scene, ATTRIBUTE_SAMPLES, 0, out).pixels
        rendering.assign_material(head, walk)
        for seed in seeds:
            step(f"{view}: Cycles' random walk, {job['samples']} samples per pixel, seed {seed}")
            picture = rendering.render(scene, job["samples"], seed, out)
            pictures[f"{view}-walk_{seed}"] = picture.pixels
            seconds[f"{view}-walk_{seed}"] = picture.cpu_seconds
    np.savez_compressed(job["pictures"], **pictures)
    return {"blender": job["host"], "seconds": seconds}
