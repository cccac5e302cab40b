"""Runs inside Blender: the ear from two sides, by attributes of its vertices and by Cycles' random walk."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

STEPS = Path(__file__).resolve().parent
sys.path[:0] = [str(STEPS), str(STEPS.parent / "ear_steps"), str(STEPS.parent / "demo_steps")]
JOB: dict[str, Any] = json.loads(Path(sys.argv[-1]).read_text())
if JOB["package"]:
    sys.path.append(JOB["package"])  # last: a full Blender has its own numpy

import bpy  # noqa: E402  isort: skip  (importing it makes the others importable)
import blender_scene as stage  # noqa: E402
import numpy as np  # noqa: E402
import shading  # noqa: E402
from job_steps import Steps, run  # noqa: E402
from mathutils import Vector  # noqa: E402
from medium import SKIN1  # noqa: E402

OUT = Path(JOB["out"])
#: Off the front, towards +X: the camera in the dark, and the one on the light's side.
VIEWS = {"front": 25.0, "back": 135.0}
ATTRIBUTE_SAMPLES, SEEDS = 8, (1, 2)


def spot(scene: bpy.types.Scene, light: dict[str, Any]) -> None:
    data = bpy.data.lights.new("light", "SPOT")
    data.energy, data.shadow_soft_size = light["power"], light["radius"]
    data.spot_size, data.spot_blend = light["spot_angle"], light["spot_blend"]
    thing = bpy.data.objects.new("light", data)
    thing.location = light["position"]
    thing.rotation_euler = Vector(light["direction"]).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(thing)


def store_color(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.column_stack([values, np.ones(len(values))]).astype(np.float32).ravel())


def main() -> dict[str, Any]:
    with np.load(JOB["attributes"]) as file:
        attributes = {name: file[name] for name in file.files}
    seeds = SEEDS if JOB["samples"] else ()
    step = Steps(of=len(VIEWS) * (1 + len(seeds)))
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    shading.linear_render(scene, JOB["size"])
    head = stage.load_head(JOB)
    spot(scene, JOB["light"])
    for name, values in attributes.items():
        if len(values) != len(head.data.vertices):
            raise SystemExit(f"{name} has {len(values)} values, the head {len(head.data.vertices)} vertices")
        store_color(head.data, name, values)

    pictures: dict[str, np.ndarray] = {}
    seconds: dict[str, float] = {}
    walk = shading.random_walk(SKIN1)
    for view, azimuth in VIEWS.items():
        stage.aim_camera(scene, Vector(JOB["center"]), JOB["height"], math.radians(azimuth))
        step(f"{view}: {len(attributes)} attributes")
        for name in attributes:
            shading.assign_material(head, shading.shown_attribute(name))
            pictures[f"{view}-{name}"] = shading.render(scene, ATTRIBUTE_SAMPLES, 0, OUT).pixels
        shading.assign_material(head, walk)
        for seed in seeds:
            step(f"{view}: Cycles' random walk, {JOB['samples']} samples per pixel, seed {seed}")
            picture = shading.render(scene, JOB["samples"], seed, OUT)
            pictures[f"{view}-walk_{seed}"] = picture.pixels
            seconds[f"{view}-walk_{seed}"] = picture.cpu_seconds
    np.savez_compressed(JOB["pictures"], **pictures)
    return {"blender": JOB["host"], "seconds": seconds}


run(main)
