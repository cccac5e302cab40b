"""Runs inside Blender: the materials to compare, and rendering to arrays."""

from __future__ import annotations

import resource
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import bpy
import numpy as np
import skinglow as sg

from studies.medium import Medium

Result = TypeVar("Result")
MM_PER_METER = 1000.0
THICKNESS = "skinglow_thickness"


@dataclass
class Picture:
    """Linear radiance, (height, width, 4), top row first; alpha is the coverage by the head."""

    pixels: np.ndarray
    cpu_seconds: float  # of the render call


def timed(function: Callable[[], Result]) -> tuple[Result, float]:
    """The result of a function and its CPU seconds: user and system, all threads, less affected by other work."""
    before = resource.getrusage(resource.RUSAGE_SELF)
    result = function()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return result, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def linear_render(scene: bpy.types.Scene, size: int) -> None:
    """Unbiased rendering: box filter, no clamping, no adaptive sampling."""
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.film_transparent = True
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
    cycles = scene.cycles
    cycles.pixel_filter_type, cycles.use_adaptive_sampling = "BOX", False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    bounce(scene, 0)


def bounce(scene: bpy.types.Scene, times: int) -> None:
    """Sets the number of bounces between surfaces after transmission."""
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = times


def render(scene: bpy.types.Scene, samples: int, seed: int, folder: Path) -> Picture:
    scene.cycles.samples, scene.cycles.seed = samples, seed
    path = folder / "render.exr"
    scene.render.filepath = str(path)
    _, cpu = timed(lambda: bpy.ops.render.render(write_still=True))
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return Picture(pixels.reshape(height, width, 4)[::-1].astype(np.float64), cpu)


def assign_material(thing: bpy.types.Object, material: bpy.types.Material) -> None:
    thing.data.materials.clear()
    thing.data.materials.append(material)


def _empty(name: str) -> tuple[bpy.types.Material, bpy.types.NodeTree, bpy.types.NodeSocket]:
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]


def random_walk(medium: Medium) -> bpy.types.Material:
    """Only that medium: no specular reflection, and minimal refraction (the min index of Cycles)."""
    material, tree, surface = _empty("random walk")
    node = tree.nodes.new("ShaderNodeSubsurfaceScattering")
    node.falloff = "RANDOM_WALK"
    # Up to 5.1 Cycles divides the radius by 4 pi; 5.2 uses it as the mean free path and has a legacy mode.
    legacy = "RANDOM_WALK_LEGACY" not in node.bl_rna.properties["falloff"].enum_items
    radius_m = medium.mean_free_path_mm / MM_PER_METER * (4.0 * np.pi if legacy else 1.0)
    node.inputs["Color"].default_value = (*medium.walk_color, 1.0)
    node.inputs["Radius"].default_value = radius_m
    node.inputs["Scale"].default_value = 1.0
    node.inputs["IOR"].default_value = 1.0
    node.inputs["Roughness"].default_value = 0.0
    node.inputs["Anisotropy"].default_value = 0.0
    tree.links.new(node.outputs[0], surface)
    return material


def _attribute(tree: bpy.types.NodeTree, name: str) -> bpy.types.Node:
    node = tree.nodes.new("ShaderNodeAttribute")
    node.attribute_name = name
    return node


def shown_attribute(name: str) -> bpy.types.Material:
    """Shows a color attribute."""
    material, tree, surface = _empty(name)
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(_attribute(tree, name).outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], surface)
    return material


def _lookup(tree: bpy.types.NodeTree, table: np.ndarray, coordinate: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    image = bpy.data.images.new("lookup", len(table), 1, float_buffer=True)
    image.colorspace_settings.is_data = True  # before writing: setting it clears the pixels
    image.pixels.foreach_set(np.column_stack([table, np.ones(len(table))]).astype(np.float32).ravel())
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.extension, node.interpolation = image, "EXTEND", "Linear"
    tree.links.new(coordinate, node.inputs["Vector"])
    return node.outputs["Color"]


def lookup_skin(
    name: str,
    tables: list[np.ndarray],
    max_thickness_mm: float,
    weight: str | None,
    strength: float,
    thickness: str = THICKNESS,
) -> bpy.types.Material:
    """A black surface that emits the transmitted light.

    tables  one (n, 3) lookup over thickness; or three, the columns of M(d), for the channels of the attribute `weight`
    """
    material, tree, surface = _empty(name)
    # Otherwise Cycles may sample every triangle as a light, which costs more than the picture itself.
    material.cycles.emission_sampling = "NONE"
    scale, offset = sg.BaseLut(tables[0][:, 0], max_thickness_mm).texel_mapping
    u = tree.nodes.new("ShaderNodeMath")
    u.operation = "MULTIPLY_ADD"
    u.inputs[1].default_value, u.inputs[2].default_value = scale, offset
    tree.links.new(_attribute(tree, thickness).outputs["Fac"], u.inputs[0])
    coordinate = tree.nodes.new("ShaderNodeCombineXYZ")
    coordinate.inputs["Y"].default_value = 0.5
    tree.links.new(u.outputs[0], coordinate.inputs["X"])
    light = _lookup(tree, tables[0], coordinate.outputs[0])
    if weight is not None:
        split = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(_attribute(tree, weight).outputs["Vector"], split.inputs[0])
        light = None
        for table, channel in zip(tables, split.outputs, strict=True):
            add = tree.nodes.new("ShaderNodeVectorMath")
            add.operation = "MULTIPLY_ADD"
            tree.links.new(_lookup(tree, table, coordinate.outputs[0]), add.inputs[0])
            tree.links.new(channel, add.inputs[1])
            if light is None:
                add.inputs[2].default_value = (0.0, 0.0, 0.0)
            else:
                tree.links.new(light, add.inputs[2])
            light = add.outputs[0]
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Strength"].default_value = strength
    tree.links.new(light, emission.inputs["Color"])
    tree.links.new(emission.outputs[0], surface)
    return material
