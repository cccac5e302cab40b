"""Runs inside Blender: a plane slab, to verify that solver and random walk use the same medium."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow as sg

from studies import rendering
from studies import scenes as stage
from studies.medium import Medium

THICKNESS_MM = 4.0
ANGLES_DEGREES = (0.0, 60.0)
MIN_INDEX = 1.01
WIDE_M = 1.0  # so wide that no light passes around it


def compare(medium: Medium, size: int, samples: int, folder: Path) -> list[dict[str, Any]]:
    """Transmittance by Cycles over that by the solver, for white light of 1 W/m^2 from directly behind.

    Cycles traces from the eye: it enters along the view ray and leaves diffusely at the far side. By reciprocity that
    is the solver's transmittance for light along the view ray, refracted by the min index of Cycles.
    """
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    rendering.linear_render(scene, size)
    bpy.ops.mesh.primitive_cube_add(size=1.0)
    slab = bpy.context.object
    slab.scale = (WIDE_M, THICKNESS_MM / rendering.MM_PER_METER, WIDE_M)
    rendering.assign_material(slab, rendering.random_walk(medium))
    stage.add_light(scene, sg.Light("SUN", direction=(0.0, -1.0, 0.0), power=1.0))
    lens = bpy.data.cameras.new("camera")
    lens.type, lens.ortho_scale, lens.clip_start = "ORTHO", 0.01, 0.001
    camera = bpy.data.objects.new("camera", lens)
    scene.collection.objects.link(camera)
    scene.camera = camera
    rows = []
    for degrees in ANGLES_DEGREES:
        angle = math.radians(degrees)
        camera.location = (0.2 * math.sin(angle), -0.2 * math.cos(angle), 0.0)
        camera.rotation_euler = (math.pi / 2.0, 0.0, angle)
        seen = rendering.render(scene, samples, 1, folder).pixels[:, :, :3].reshape(-1, 3) * math.pi
        inside = math.sqrt(1.0 - (math.sin(angle) / MIN_INDEX) ** 2)
        by_angle = medium.transmittance(np.array([THICKNESS_MM]), inside)[0]
        diffuse = medium.transmittance(np.array([THICKNESS_MM]))[0]
        rows.append(
            {
                "degrees": degrees,
                "over_solver": (seen.mean(axis=0) / by_angle).tolist(),
                "standard_error": (seen.std(axis=0) / math.sqrt(len(seen)) / by_angle).tolist(),
                "over_diffuse": (seen.mean(axis=0) / diffuse).tolist(),
            }
        )
    return rows
