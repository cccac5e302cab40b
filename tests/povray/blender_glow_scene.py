"""Runs inside Blender: renders a lopsided glowing mesh with a leaning, shifted camera, and leaves what POV-Ray needs.

Usage: blender -b -P blender_glow_scene.py -- FOLDER, with FOLDER/job.json; leaves scene.npz and picture.npy there.
With "read" in the job: turns that EXR of the folder into FOLDER/picture.npy and renders nothing.
"""

import json
import os
import sys
from pathlib import Path

import bpy
import numpy as np

# isort: split
from mathutils import Euler, Matrix


def main(folder: Path) -> None:
    job = json.loads((folder / "job.json").read_text())
    if "read" in job:
        np.save(folder / "picture.npy", pixels(folder / job["read"]))
        return
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.cycles.samples = job["samples"]
    scene.render.resolution_x, scene.render.resolution_y = job["resolution"]
    scene.render.resolution_percentage = 100
    if job["samples"] == 1:  # every sample at the center of its pixel
        scene.cycles.pixel_filter_type = "GAUSSIAN"
        scene.cycles.filter_width = 0.01
    else:
        scene.cycles.pixel_filter_type = "BOX"
    head = lopsided_head(job)
    camera = leaning_camera(scene, job)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = head.data
    mesh.calc_loop_triangles()
    vertices = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", vertices.reshape(-1))
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.reshape(-1))
    width, height = job["resolution"]
    np.savez(
        folder / "scene.npz",
        vertices=vertices.astype(float),
        triangles=triangles,
        lut_u=lut_u(vertices, job),
        camera_matrix=np.array(camera.matrix_world),
        projection=np.array(camera.calc_matrix_camera(depsgraph, x=width, y=height)),
    )
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(folder / "blender.exr")
    bpy.ops.render.render(write_still=True)
    np.save(folder / "picture.npy", pixels(folder / "blender.exr"))


def pixels(path: Path) -> np.ndarray:
    """(height, width, 3), row 0 on top."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.is_data = True
    width, height = image.size
    flat = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(height, width, 4)[::-1, :, :3]


def lopsided_head(job: dict) -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    head = bpy.context.object
    modifier = head.modifiers.new("smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = 2
    head.data = bpy.data.meshes.new_from_object(head.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    head.modifiers.clear()
    shear = Matrix(((1.3, 0.2, 0.1, 0.3), (0, 0.9, 0.3, -0.2), (0.2, 0, 1.1, 0.4), (0, 0, 0, 1)))
    head.data.transform(shear)
    coordinates = np.empty((len(head.data.vertices), 3), np.float32)
    head.data.vertices.foreach_get("co", coordinates.reshape(-1))
    attribute = head.data.attributes.new("lut_u", "FLOAT", "POINT")
    attribute.data.foreach_set("value", lut_u(coordinates, job).astype(np.float32))
    head.data.materials.append(glow_material(job))
    return head


def lut_u(vertices: np.ndarray, job: dict) -> np.ndarray:
    """A thickness that differs everywhere, as image coordinate in a table of the job's size."""
    x, y, z = vertices.astype(float).T
    fraction = np.clip(0.5 + 0.25 * np.sin(2.1 * x + 0.4) + 0.2 * np.sin(3.3 * z) + 0.1 * y, 0, 1)
    size = len(job["table"])
    return (fraction * (size - 1) + 0.5) / size


def glow_material(job: dict) -> bpy.types.Material:
    table = np.ones((len(job["table"]), 4), np.float32)
    table[:, :3] = job["table"]
    image = bpy.data.images.new("lookup", len(table), 1, alpha=True, float_buffer=True)
    image.colorspace_settings.is_data = True
    image.pixels.foreach_set(table.reshape(-1))
    image.update()
    material = bpy.data.materials.new("glow")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "lut_u"
    combine = nodes.new("ShaderNodeCombineXYZ")
    combine.inputs["Y"].default_value = 0.5
    lookup = nodes.new("ShaderNodeTexImage")
    lookup.image, lookup.extension = image, "EXTEND"
    emission = nodes.new("ShaderNodeEmission")
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(attribute.outputs["Fac"], combine.inputs["X"])
    links.new(combine.outputs["Vector"], lookup.inputs["Vector"])
    links.new(lookup.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    return material


def leaning_camera(scene: bpy.types.Scene, job: dict) -> bpy.types.Object:
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = job["camera"]
    camera.data.lens, camera.data.ortho_scale = 42, 5.2
    camera.data.shift_x, camera.data.shift_y = 0.07, -0.04
    camera.location = (2.4, -5.2, 1.9)
    camera.rotation_euler = Euler((1.3, 0.25, 0.4))
    camera.scale = (2, 2, 2)
    scene.collection.objects.link(camera)
    scene.camera = camera
    return camera


try:
    main(Path(sys.argv[-1]))
    code = 0
except BaseException as error:  # the 4.5 wheel hangs at exit: nothing may pass os._exit
    print(repr(error), file=sys.stderr)
    code = 1
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)
