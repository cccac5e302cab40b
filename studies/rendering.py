"""Runs inside Blender: the materials to compare, and rendering to arrays."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from studies.medium import Medium
from studies.timing import timed

MM_PER_METER = 1000.0


@dataclass
class Picture:
    """Linear radiance, (height, width, 4), top row first; alpha is the coverage by the head."""

    pixels: np.ndarray
    cpu_seconds: float  # of the render call


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
    path = folder / f"render-{os.getpid()}.exr"  # several may render into a folder
    scene.render.filepath = str(path)
    _, cpu = timed(bpy.ops.render.render, write_still=True)
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    path.unlink()
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
    if "Roughness" in node.inputs:  # since Blender 4.0
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


def black() -> bpy.types.Material:
    """A surface that sends nothing back: what the add-on adds to it is all that is seen."""
    material, tree, surface = _empty("black")
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Strength"].default_value = 0.0
    tree.links.new(emission.outputs[0], surface)
    return material


def mesh_arrays(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n, 3) in the mesh's unit, normals (n, 3), triangles (m, 3)."""
    count = len(mesh.vertices)
    points, normals = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
    mesh.vertices.foreach_get("co", points.ravel())
    mesh.vertex_normals.foreach_get("vector", normals.ravel())
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    return points.astype(np.float64), normals.astype(np.float64), triangles


def store_color(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    """Values (vertices, 3) as a color attribute."""
    attribute = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.column_stack([values, np.ones(len(values))]).astype(np.float32).ravel())


def use_eevee(scene: bpy.types.Scene, samples: int) -> None:
    is_next = (4, 2, 0) <= bpy.app.version < (5, 0, 0)
    scene.render.engine = "BLENDER_EEVEE_NEXT" if is_next else "BLENDER_EEVEE"
    scene.eevee.taa_render_samples = samples


def sharpen_shadows(scene: bpy.types.Scene, light: bpy.types.Light) -> None:
    """The shadow maps of EEVEE before Blender 4.2 let light through what is as thin as an ear."""
    if not hasattr(scene.eevee, "shadow_cube_size"):
        return
    scene.eevee.use_soft_shadows = scene.eevee.use_shadow_high_bitdepth = True
    scene.eevee.shadow_cube_size = "4096"
    light.shadow_buffer_clip_start, light.shadow_buffer_bias = 0.02, 0.01
    light.use_contact_shadow = True
    light.contact_shadow_distance, light.contact_shadow_bias, light.contact_shadow_thickness = 0.04, 0.0005, 0.01
