"""Runs inside Blender: saves a scene for the batch example, a turning head and two light rigs."""

from __future__ import annotations

import math
from typing import Any

import bpy
import skinglow as sg
import skinglow_blender as sb
from mathutils import Matrix

from studies import scenes as stage
from studies.heads import loading

#: At the size of a person's head Suzanne's mouth and eyelids are as thin as ears and glow, too: she is larger.
SUZANNE_MM, LARGER = 60.0, 100.0 / 60.0
FRAMES = 3
TURN_DEGREES = 30.0  # to each side
#: Tables are dark at the thickness of these ears; shaders that use them scale them up by hand.
STRENGTH = 60.0
#: Collection, light, linear color, power in W, and position in meters relative to the center of a head facing -Y.
LIGHTS = (
    ("sunset", "low sun", (1.0, 0.60, 0.25), 12.0, (0.30, 0.35, 0.05)),
    ("sunset", "sky", (0.25, 0.40, 1.0), 8.0, (-0.50, -0.60, 0.50)),
)
SUN_AT_THE_END = (1.0, 0.15, 0.02)


def main(job: dict[str, Any]) -> None:
    scene = stage.empty_scene()
    scene.render.resolution_x = scene.render.resolution_y = 240
    scene.cycles.samples = 32
    scene.frame_start, scene.frame_end = 1, FRAMES
    head, _placed = loading.load({"mesh": "suzanne", "unit_mm": SUZANNE_MM})
    head.data.transform(Matrix.Scale(LARGER, 4))
    center = stage.center_of(head)
    stage.aim_camera(scene, center, 0.29, 0.0)
    for collection, name, color, power, position in LIGHTS:
        add_light(scene, collection, name, color, power, [a + b for a, b in zip(center, position, strict=True)])
    for frame in range(1, FRAMES + 1):
        head.rotation_euler.z = math.radians(TURN_DEGREES * (2 * (frame - 1) / (FRAMES - 1) - 1))
        head.keyframe_insert("rotation_euler", frame=frame)
    sun = bpy.data.lights["low sun"]
    sun.keyframe_insert("color", frame=1)
    sun.color = SUN_AT_THE_END
    sun.keyframe_insert("color", frame=FRAMES)
    scene.frame_set(1)
    sb.make_skin(head, mode="paper", strength=STRENGTH)
    bpy.ops.wm.save_as_mainfile(filepath=job["blend"])


def add_light(
    scene: bpy.types.Scene, collection: str, name: str, color: tuple[float, ...], power: float, position: list[float]
) -> None:
    """Adds a point light to the collection of its rig."""
    rig = bpy.data.collections.get(collection)
    if rig is None:
        rig = bpy.data.collections.new(collection)
        scene.collection.children.link(rig)
    light = stage.add_light(scene, sg.Light("POINT", color, position, power=power, name=name, radius=0.03))
    scene.collection.objects.unlink(light)
    rig.objects.link(light)
