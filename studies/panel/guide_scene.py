"""Runs inside Blender: the scene of the guide's pictures, the demo's person and its lights, not a skin yet."""

from __future__ import annotations

from typing import Any

import bpy

from studies.heads import loading, portrait, studio
from studies.heads.ears import Ear


def build_guide_scene(job: dict[str, Any]) -> Ear:
    """Replaces the objects of the file; the head is selected, and the camera sees the ear that is returned up close.

    job  of sources.head_job. The add-on is registered.
    """
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    head, placed = loading.load(job)
    head.name = "Head"
    portrait.mask_glow(head)
    scene = bpy.context.scene
    # Debian's Blender has no denoiser.
    studio.settings(scene, 640, 640, 64 if studio.can_denoise() else 256)
    scene.cycles.preview_samples = 32
    scene.cycles.use_preview_denoising = studio.can_denoise()
    studio.world(scene)
    ear = studio.ear_of(placed)
    studio.lights(scene, ear).name = "Behind the ear"
    scene.camera = studio.hero_camera(scene, ear)
    for thing in bpy.data.objects:
        thing.select_set(thing == head)
    bpy.context.view_layer.objects.active = head
    return ear
