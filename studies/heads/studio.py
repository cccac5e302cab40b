"""Runs inside Blender: the light and the cameras of the demo's pictures, made for an ear."""

from __future__ import annotations

import math

# isort: off  (importing bpy is what makes the others importable in the wheels)
import bpy
import numpy as np
import skinglow as sg
from mathutils import Vector

# isort: on
from studies import scenes as stage
from studies.heads.any_head import EAR_HEIGHT_M, Placed
from studies.heads.ears import Ear

Color = tuple[float, float, float]

WARM: Color = (1.0, 0.72, 0.45)
BULB_W, BULB_RADIUS_M = 35.0, 0.01
PANEL_M = 0.3
EXPOSURE_STOPS = 1.1
#: From the ear, of an ear on +X: x out of the head, y to the back, z up, meters.
BULB, FILL, RIM = (0.0, 0.14, -0.04), (-0.42, -0.58, 0.30), (-0.5, 0.4, 0.5)


def settings(scene: bpy.types.Scene, width: int, height: int, samples: int) -> None:
    """Cycles on the processor, few bounces, denoised where this Blender has a denoiser."""
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.adaptive_threshold = samples, True, 0.03
    # Without a denoiser, what the bulb lights is noise where it is seen by a bounce.
    cycles.max_bounces = 3 if can_denoise() else 0
    cycles.diffuse_bounces, cycles.glossy_bounces, cycles.transmission_bounces = 2, 1, 0
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_indirect = 4.0
    cycles.use_denoising = can_denoise()
    _first_of(scene.view_settings, "view_transform", ("AgX", "Filmic"))
    _first_of(scene.view_settings, "look", ("AgX - Punchy", "High Contrast"))
    scene.view_settings.exposure = EXPOSURE_STOPS


def quicken(scene: bpy.types.Scene) -> None:
    """For pictures shown small: a viewer sees no difference, and each takes half the time."""
    cycles = scene.cycles
    cycles.denoising_prefilter = "FAST"
    cycles.sample_clamp_direct = 4.0  # of few samples, one that meets a glint on a hair is a white dot


def show_as_it_is(scene: bpy.types.Scene) -> None:
    """Linear light by sRGB's curve, and no more: pictures that are compared."""
    scene.view_settings.view_transform, scene.view_settings.exposure = "Standard", 0.0
    _first_of(scene.view_settings, "look", ("None",))


def _first_of(settings: bpy.types.ColorManagedViewSettings, name: str, choices: tuple[str, ...]) -> None:
    """Sets what this Blender has; which choices there are depends on its color configuration."""
    for choice in choices:
        try:
            setattr(settings, name, choice)
            return
        except TypeError:
            continue


def can_denoise() -> bool:
    """Debian's Blender has no denoiser, and cancels a render that asks for one."""
    try:
        import _cycles
    except ImportError:
        return False
    return bool(getattr(_cycles, "with_openimagedenoise", False))


def world(scene: bpy.types.Scene, color: Color = (0.004, 0.006, 0.009)) -> None:
    scene.world = bpy.data.worlds.new("dark room")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1.0)


def ear_of(placed: Placed) -> Ear:
    """The ear of the pictures; where none was found, the side of the head at the height of ears."""
    if placed.ears:
        return placed.ears[0]
    size = placed.size
    center = (size.middle_x + 0.5 * size.width, float(np.median(placed.samples.points[:, 1])), 0.0)
    return Ear(np.array(center) + (0.0, 0.0, size.top - 0.85 * size.width), EAR_HEIGHT_M, 1.0)


def lights(scene: bpy.types.Scene, ear: Ear) -> bpy.types.Object:
    """A warm bulb behind the ear, which is returned, a dim cool fill before and a rim from the far side."""
    behind = bulb(scene, ear)
    _panel(scene, "fill", ear, FILL, 2.6, (0.82, 0.88, 1.0))
    _panel(scene, "rim", ear, RIM, 4.0, (0.60, 0.75, 1.0))
    return behind


def bulb(scene: bpy.types.Scene, ear: Ear, power: float = BULB_W) -> bpy.types.Object:
    position = tuple(from_ear(ear, BULB))
    return stage.add_light(scene, sg.Light("POINT", WARM, position, power=power, name="bulb", radius=BULB_RADIUS_M))


def _panel(scene: bpy.types.Scene, name: str, ear: Ear, off: Color, power: float, color: Color) -> None:
    """A square that shines on the ear."""
    position = from_ear(ear, off)
    direction = stage.toward(position, Vector(ear.center))
    size = {"area_shape": "SQUARE", "size_x": PANEL_M, "size_y": PANEL_M}
    stage.add_light(scene, sg.Light("AREA", color, tuple(position), direction, power=power, name=name, **size))


def from_ear(ear: Ear, off: Color) -> Vector:
    """A point off the ear: x out of the head, y to the back, z up, meters."""
    return Vector(ear.center) + Vector((ear.side * off[0], off[1], off[2]))


def outward(ear: Ear, azimuth: float, height: float = 0.06) -> Vector:
    """To where it is seen from: `azimuth` degrees off the front to the ear's side, a little from above."""
    angle = math.radians(azimuth)
    return Vector((ear.side * math.sin(angle), -math.cos(angle), height)).normalized()


def camera(
    scene: bpy.types.Scene, ear: Ear, off: Color, width_m: float, azimuth: float, height: float = 0.06
) -> bpy.types.Object:
    """A portrait lens on a point off the ear that sees `width_m`, `azimuth` degrees off the front to the ear's side."""
    toward = outward(ear, azimuth, height)
    made = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    made.data.lens, made.data.sensor_width = 85.0, 36.0
    target, distance = from_ear(ear, off), width_m * 85.0 / 36.0
    made.location = target + distance * toward
    made.rotation_euler = (-toward).to_track_quat("-Z", "Y").to_euler()
    made.data.clip_start, made.data.clip_end = 0.02 * distance, 20.0 * distance
    scene.collection.objects.link(made)
    return made


def hero_camera(scene: bpy.types.Scene, ear: Ear) -> bpy.types.Object:
    """The ear, the cheek and an eye."""
    return camera(scene, ear, (-0.028, 0.0, -0.008), 0.15, 6.0)


def portrait_camera(scene: bpy.types.Scene, ear: Ear) -> bpy.types.Object:
    """The whole head, with the beginning of the shoulders."""
    return camera(scene, ear, (-0.066, 0.0, -0.01), 0.33, 22.0)
