"""Runs inside Blender: scenes, cameras, lights from a rig, and passes. Scene units are meters."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import skinglow as sg
from mathutils import Vector
from skinglow_blender.batch.rig_lights import add_lights


def empty_scene() -> bpy.types.Scene:
    """An empty scene, rendered by Cycles on the CPU, with the Standard view transform."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False  # Debian's Blender has no denoiser and would cancel the render
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("dim room")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.010, 0.011, 0.013, 1.0)
    return scene


@contextmanager
def transmitted_light_only(head: bpy.types.Object) -> Iterator[None]:
    """Context manager in which only the head is visible, with transmitted light and a black surface."""
    others = [o for o in bpy.context.scene.objects if o.type == "MESH" and o != head]
    tree = head.active_material.node_tree
    surface = next(n.inputs["Surface"] for n in tree.nodes if n.bl_idname == "ShaderNodeGroup")
    source = surface.links[0].from_socket
    tree.links.remove(surface.links[0])
    for other in others:
        other.hide_render = True
    kept = [slot.material for slot in head.material_slots]
    for slot in head.material_slots:
        if slot.material != head.active_material:
            slot.material = _black()
    try:
        yield
    finally:
        tree.links.new(source, surface)
        for slot, material in zip(head.material_slots, kept, strict=True):
            slot.material = material
        for other in others:
            other.hide_render = False


def _black() -> bpy.types.Material:
    material = bpy.data.materials.new("black")
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes.remove(material.node_tree.nodes["Principled BSDF"])
    return material


AOV = "Transmitted Light"


def add_light_aov(scene: bpy.types.Scene, head: bpy.types.Object) -> None:
    """Connects the Light of the head's Skinglow node with AOV, an AOV of the view layer."""
    tree = head.active_material.node_tree
    light = next(n.outputs["Light"] for n in tree.nodes if n.bl_idname == "ShaderNodeGroup")
    out = tree.nodes.new("ShaderNodeOutputAOV")
    if hasattr(out, "aov_name"):
        out.aov_name = AOV
    else:
        out.name = AOV  # before Blender 4.2
    tree.links.new(light, out.inputs["Color"])
    aov = scene.view_layers[0].aovs.add()
    aov.name, aov.type = AOV, "COLOR"


def show_pass(scene: bpy.types.Scene, name: str) -> None:
    """Renders show a pass in place of the picture."""
    if bpy.app.version >= (5, 0, 0):
        tree = bpy.data.node_groups.new("Pass", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        scene.compositing_node_group = tree
        out = tree.nodes.new("NodeGroupOutput")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        out = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(tree.nodes.new("CompositorNodeRLayers").outputs[name], out.inputs[0])


@contextmanager
def shown_pass(scene: bpy.types.Scene, name: str) -> Iterator[None]:
    """Context manager in which renders show a pass in place of the picture."""
    show_pass(scene, name)
    try:
        yield
    finally:
        if bpy.app.version >= (5, 0, 0):
            scene.compositing_node_group = None
        else:
            scene.use_nodes = False


def pixels_of(path: Path) -> np.ndarray:
    """An image file's linear pixels (height, width, 3), top row first."""
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[::-1, :, :3]


def center_of(head: bpy.types.Object) -> Vector:
    """Center of the bounding box: the add-on's default reference point, and the origin of a rig."""
    corners = [Vector(c) for c in head.bound_box]
    return sum(corners, Vector()) / 8.0


def aim_camera(scene: bpy.types.Scene, target: Vector, height_m: float, azimuth: float) -> bpy.types.Object:
    """A portrait lens on `target` that sees `height_m` around it, from `azimuth` off the front (-Y) towards +X."""
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens, camera.data.sensor_width = 85.0, 36.0
    outward = Vector((math.sin(azimuth), -math.cos(azimuth), 0.08)).normalized()
    distance = height_m * camera.data.lens / camera.data.sensor_width
    camera.location = target + outward * distance
    camera.rotation_euler = (-outward).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_start, camera.data.clip_end = distance * 0.01, distance * 10
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return camera


def remove_lights() -> None:
    for old in [o for o in bpy.data.objects if o.type == "LIGHT"]:
        bpy.data.objects.remove(old)


def add_light(scene: bpy.types.Scene, light: sg.Light) -> bpy.types.Object:
    """Adds a light as the add-on adds those of a rig; scene units are meters."""
    rig = SimpleNamespace(lights=[light], point=(0.0, 0.0, 0.0), notes=[])
    (added,), notes = add_lights(scene, rig, None)
    if notes:
        raise ValueError("; ".join(notes))
    bpy.context.view_layer.update()
    return added


def toward(position: Vector, target: Vector) -> tuple[float, ...]:
    """The direction of a light at a position that looks at a target."""
    return tuple((target - position).normalized())


def add_rig(scene: bpy.types.Scene, rig: list[Any], center: Vector) -> None:
    """Adds the lights of a rig by the add-on, its point at `center`; replaces all other lights.

    rig  the arguments of skinglow.read_light_rig
    """
    remove_lights()
    add_lights(scene, sg.read_light_rig(*rig), tuple(center))
    bpy.context.view_layer.update()
