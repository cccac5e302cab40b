"""Run by a Python with bpy: imports a mesh file as Blender does and saves its triangles in the file's own axes.

Usage: import_meshes.py RESULTS.npz FILE...
"""

import sys

import bpy
import numpy as np


def import_file(path: str) -> None:
    """Without turning its axes, but for glTF's, which Blender always turns."""
    extension = path.rsplit(".", 1)[1]
    axes = {"forward_axis": "Y", "up_axis": "Z"}
    if extension in ("glb", "gltf"):
        bpy.ops.import_scene.gltf(filepath=path)
    elif extension == "obj":
        bpy.ops.wm.obj_import(filepath=path, **axes)
    elif extension == "ply":
        bpy.ops.wm.ply_import(filepath=path, **axes)
    else:
        bpy.ops.wm.stl_import(filepath=path, **axes)


def triangles() -> np.ndarray:
    """Of all meshes of the scene, with modifiers and shape keys, (n, 3, 3)."""
    found = []
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for instance in depsgraph.object_instances:
        if instance.object.type != "MESH" or instance.object.original.name.startswith("Icosphere"):
            continue  # the importer's own shape of bones
        mesh = instance.object.to_mesh()
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", vertices)
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        world = np.array(instance.matrix_world, float)
        placed = vertices.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3]
        corners = corners.reshape(-1, 3)
        found.append(placed[corners[:, ::-1] if np.linalg.det(world[:3, :3]) < 0.0 else corners])
    return np.concatenate(found)


results = {}
for name in sys.argv[2:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    import_file(name)
    shape = triangles()
    if name.endswith(("glb", "gltf")):
        shape = np.stack([shape[..., 0], shape[..., 2], -shape[..., 1]], axis=-1)  # back to y up
    results[name] = shape
np.savez(sys.argv[1], **results)
