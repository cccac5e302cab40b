"""Runs inside Blender: six frames of a light that is carried round the ear."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

STEPS = Path(__file__).resolve().parent
JOB: dict[str, Any] = json.loads(Path(sys.argv[-1]).read_text())
sys.path[:0] = [str(STEPS.parent / name) for name in ("ear_steps", "demo_steps")]
sys.path.insert(0, str(STEPS.parents[1] / "blender_addon"))
if JOB["package"]:
    sys.path.append(JOB["package"])  # last: a full Blender has its own numpy

import bpy  # noqa: E402  isort: skip  (importing it makes the others importable)
import blender_scene as stage  # noqa: E402
import numpy as np  # noqa: E402
import shading  # noqa: E402
import skinglow as sg  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from job_steps import Steps, run  # noqa: E402
from mathutils import Vector  # noqa: E402
from medium import INDEX, SKIN1  # noqa: E402

OUT = Path(JOB["out"])
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


def main() -> dict[str, Any]:
    step = Steps(of=1 + len(JOB["azimuths"]))
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    shading.linear_render(scene, JOB["size"])
    head = stage.load_head(JOB)
    ear, _height = stage.views_of(head)["_ear"]
    stage.aim_camera(scene, ear + Vector((-0.004, 0.008, -0.012)), VISIBLE_M, CAMERA_AZIMUTH)
    light = bpy.data.objects.new("light", bpy.data.lights.new("light", "POINT"))
    light.data.energy, light.data.color, light.data.shadow_soft_size = POWER_W, COLOR, RADIUS_M
    scene.collection.objects.link(light)
    samples = JOB["samples"]
    told: dict[str, Any] = {"blender": JOB["host"]}
    step("the skin")
    if JOB["kind"] == "shape":
        scene.render.engine = eevee()
        samples, scene.eevee.taa_render_samples = 32, 32
        _sharpen_shadows(scene, light.data)
        shading.assign_material(head, lit_surface())
        sb.register()
        sb.make_skin(head)
        sb.set_medium(head, SKIN1.absorption, SKIN1.reduced_scattering, refractive_index=INDEX)
        _place(light, ear, JOB["azimuths"][0])
        _, told["made_s"] = shading.timed(lambda: sb.make_skin(head, weights="shape"))
    else:
        shading.assign_material(head, shading.random_walk(SKIN1))
        shading.bounce(scene, 2)
    frames, seconds = [], []
    for azimuth in JOB["azimuths"]:
        step(f"light at {azimuth:g} degrees")
        _place(light, ear, azimuth)
        picture = shading.render(scene, samples, 0, OUT)
        frames.append(picture.pixels.astype(np.float32))
        seconds.append(picture.cpu_seconds)
    np.savez_compressed(JOB["pictures"], frames=np.stack(frames))
    return {**told, "seconds": seconds}


def _place(light: bpy.types.Object, ear: Vector, azimuth: float) -> None:
    angle = math.radians(azimuth)
    light.location = ear + DISTANCE_M * Vector((math.sin(angle), -math.cos(angle), 0.1)).normalized()
    bpy.context.view_layer.update()


def _sharpen_shadows(scene: bpy.types.Scene, light: bpy.types.Light) -> None:
    """The shadow maps of EEVEE before Blender 4.2 let light through what is as thin as an ear."""
    if not hasattr(scene.eevee, "shadow_cube_size"):
        return
    scene.eevee.use_soft_shadows = scene.eevee.use_shadow_high_bitdepth = True
    scene.eevee.shadow_cube_size = "4096"
    light.shadow_buffer_clip_start, light.shadow_buffer_bias = 0.02, 0.01
    light.use_contact_shadow = True
    light.contact_shadow_distance, light.contact_shadow_bias, light.contact_shadow_thickness = 0.04, 0.0005, 0.01


def eevee() -> str:
    return "BLENDER_EEVEE" if bpy.app.version < (4, 2, 0) or bpy.app.version >= (5, 0, 0) else "BLENDER_EEVEE_NEXT"


run(main)
