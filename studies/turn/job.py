"""Runs inside Blender: six frames of a light that is carried round the ear."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from mathutils import Vector

from studies import rendering
from studies import scenes as stage
from studies.heads import loading
from studies.in_blender import Steps
from studies.medium import INDEX, SKIN1
from studies.timing import timed

DISTANCE_M, COLOR, POWER_W, RADIUS_M = 0.16, (1.0, 0.78, 0.55), 3.0, 0.012
CAMERA_AZIMUTH, VISIBLE_M = math.radians(28.0), 0.078


def lit_surface() -> bpy.types.Material:
    """What thick flesh of that medium sends back, as a diffuse surface."""
    back = [
        sg.slab([sg.Layer(INDEX, absorption, scattering, 0.0, np.inf)], "diffuse").reflectance
        for absorption, scattering in zip(SKIN1.absorption, SKIN1.reduced_scattering, strict=True)
    ]
    material = bpy.data.materials.new("thick flesh")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*back, 1.0)
    tree.links.new(diffuse.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def main(job: dict[str, Any]) -> dict[str, Any]:
    out = Path(job["out"])
    step = Steps(of=1 + len(job["azimuths"]))
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    rendering.linear_render(scene, job["size"])
    head, placed = loading.load_alone(job)
    ear = Vector(placed.left_ear.center)
    stage.aim_camera(scene, ear + Vector((-0.004, 0.008, -0.004)), VISIBLE_M, CAMERA_AZIMUTH)
    light = stage.add_light(scene, sg.Light("POINT", COLOR, tuple(ear), power=POWER_W, radius=RADIUS_M))
    samples = job["samples"]
    told: dict[str, Any] = {"blender": job["host"]}
    step("the skin")
    if job["kind"] == "shape":
        samples = 32
        rendering.use_eevee(scene, samples)
        rendering.sharpen_shadows(scene, light.data)
        rendering.assign_material(head, lit_surface())
        sb.register()
        sb.make_skin(head)
        sb.set_medium(head, SKIN1.absorption, SKIN1.reduced_scattering, refractive_index=INDEX)
        _place(light, ear, job["azimuths"][0])
        _, told["made_s"] = timed(sb.make_skin, head, weights="shape")
    else:
        rendering.assign_material(head, rendering.random_walk(SKIN1))
        rendering.bounce(scene, 2)
    frames, seconds = [], []
    for azimuth in job["azimuths"]:
        step(f"light at {azimuth:g} degrees")
        _place(light, ear, azimuth)
        picture = rendering.render(scene, samples, 0, out)
        frames.append(picture.pixels.astype(np.float32))
        seconds.append(picture.cpu_seconds)
    np.savez_compressed(job["pictures"], frames=np.stack(frames))
    return {**told, "seconds": seconds}


def _place(light: bpy.types.Object, ear: Vector, azimuth: float) -> None:
    angle = math.radians(azimuth)
    light.location = ear + DISTANCE_M * Vector((math.sin(angle), -math.cos(angle), 0.1)).normalized()
    bpy.context.view_layer.update()
