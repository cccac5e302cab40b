"""Runs inside Blender: saves a scene for the batch example, a turning head and two light rigs.

Usage: python batch_scene.py SCENE.blend, with a Python that has bpy, or blender -b -P batch_scene.py -- SCENE.blend
"""

from __future__ import annotations

import math
import os
import sys
import traceback
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(SCRIPTS / "demo_steps"), str(SCRIPTS.parent / "blender_addon")]

import bpy  # noqa: E402

import blender_scene as stage  # noqa: E402  isort: skip
import skinglow_blender as sb  # noqa: E402

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


def main(blend: Path) -> None:
    scene = stage.empty_scene()
    scene.render.resolution_x = scene.render.resolution_y = 240
    scene.cycles.samples = 32
    scene.frame_start, scene.frame_end = 1, FRAMES
    head = stage.load_head({"mesh": "suzanne", "unit_mm": 100.0, "group": None, "eyes": (), "cut_below_m": None})
    stage.skin_surface(head, None, None)
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
    bpy.ops.wm.save_as_mainfile(filepath=str(blend.resolve()))


def add_light(
    scene: bpy.types.Scene, collection: str, name: str, color: tuple[float, ...], power: float, position: list[float]
) -> None:
    """Adds a point light to the collection of its rig."""
    rig = bpy.data.collections.get(collection)
    if rig is None:
        rig = bpy.data.collections.new(collection)
        scene.collection.children.link(rig)
    data = bpy.data.lights.new(name, "POINT")
    data.color, data.energy, data.shadow_soft_size = color, power, 0.03
    obj = bpy.data.objects.new(name, data)
    obj.location = position
    rig.objects.link(obj)


code = 0
try:
    main(Path(sys.argv[-1]))
except BaseException:  # any error: on a normal exit the 4.5 wheel would hang
    traceback.print_exc()
    code = 1
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)
