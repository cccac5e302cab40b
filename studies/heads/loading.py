"""Runs inside Blender: a head in the scene, in meters, Z up, facing -Y: the person, Suzanne, or any of a file."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

# isort: off  (importing bpy is what makes the others importable in the wheels)
import bmesh
import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

# isort: on
from studies.heads import human_head, person_materials, portrait
from studies.heads.any_head import Placed, place_head
from studies.heads.human_head import HeadError
from studies.heads.samples import Array

#: What Blender's importers do to a file's axes: rows are Blender's x, y, z.
Y_UP = np.array([(1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)])
AS_IT_IS = np.eye(3)


def load(job: dict[str, Any]) -> tuple[bpy.types.Object, Placed]:
    """The head of a job, with materials, of which the first slot alone is skin, and where its ears are.

    job: of sources.head_job: "mesh" ("person", "makehuman", "suzanne" or a path), "folder" of the shapes of the first
    two, and, None or given, "up", "facing", "unit_mm", "ear", "color_map", "normal_map".
    Raises HeadError in words.
    """
    options = {key: job.get(key) for key in ("up", "facing", "unit_mm", "ear")}
    if job["mesh"] == "person":
        head = portrait.build(human_head.read(Path(job["folder"])))
        return head, _placed(head, "the person", AS_IT_IS, {"up": "+Z", "facing": "-Y", "unit_mm": 1000.0})
    if job["mesh"] in ("makehuman", "suzanne"):
        if job["mesh"] == "suzanne":
            bpy.ops.mesh.primitive_monkey_add()
            head = bpy.context.object
        else:
            base = human_head.read(Path(job["folder"]), recipe={}, cut_below=human_head.CUT_NECK)
            head = portrait.object_of(base.body)
            options["unit_mm"] = options["unit_mm"] or 1000.0
        name, axes = job["mesh"].capitalize(), AS_IT_IS
        options["up"], options["facing"] = options["up"] or "+Z", options["facing"] or "-Y"
    else:
        head, name, axes = _import(Path(job["mesh"])), Path(job["mesh"]).name, _axes(Path(job["mesh"]))
    placed = _placed(head, name, axes, options)
    _leave_out(head.data, placed.away)
    matrix = np.eye(4)
    matrix[:3, :3] = placed.matrix() @ axes.T
    head.data.transform(Matrix(matrix.tolist()))
    _clean(head.data)
    count = len(head.data.polygons)
    if levels := 2 if count < 8000 else 1 if count < 30000 else 0:
        portrait.subdivide(head, levels)
    head.data.polygons.foreach_set("use_smooth", np.ones(len(head.data.polygons), bool))
    head.name = "head"
    if job.get("color_map") or job.get("normal_map") or not _has_own_colors(head):
        head.data.materials.clear()
        head.data.materials.append(person_materials.plain(job.get("color_map"), job.get("normal_map")))
        head.data.polygons.foreach_set("material_index", np.zeros(len(head.data.polygons), np.int32))
    return head, placed


def load_alone(job: dict[str, Any]) -> tuple[bpy.types.Object, Placed]:
    """The head of a job as skin alone, without eyes and hair."""
    head, placed = load(job)
    for thing in [each for each in bpy.data.objects if each.type == "MESH" and each != head]:
        bpy.data.objects.remove(thing)
    return head, placed


def skin_slots(head: bpy.types.Object) -> list[int]:
    """Of the person the first; of a file's head all."""
    return [0] if portrait.MASK_GROUP in head.vertex_groups else list(range(len(head.material_slots)))


def _axes(path: Path) -> Array:
    return AS_IT_IS if path.suffix.lower() in (".ply", ".stl") else Y_UP


def _placed(head: bpy.types.Object, name: str, axes: Array, options: dict[str, Any]) -> Placed:
    mesh = head.data
    vertices = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", vertices.ravel())
    return place_head(vertices.astype(float) @ axes, _triangles(mesh), name, **options)


def _triangles(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    return triangles


def _import(path: Path) -> bpy.types.Object:
    """All meshes of a file as one object at the origin."""
    before = set(bpy.data.objects)
    try:
        _importer(path)(filepath=str(path))
    except RuntimeError as error:
        raise HeadError(f"{path.name}: Blender could not read it ({_reason(str(error))}); export it again") from None
    new = [thing for thing in bpy.data.objects if thing not in before]
    meshes = [thing for thing in new if thing.type == "MESH" and len(thing.data.polygons) and not _is_aid(thing)]
    if not meshes:
        raise HeadError(f"{path.name}: contains no mesh with faces")
    others, head = [thing for thing in new if thing not in meshes], meshes[0]
    for thing in meshes:
        _stand_still(thing)
    if len(meshes) > 1:
        with bpy.context.temp_override(active_object=head, selected_editable_objects=meshes):
            bpy.ops.object.join()  # all but the head are gone then
    for thing in others:
        bpy.data.objects.remove(thing)
    return head


def _reason(error: str) -> str:
    """Of an importer's message; of a traceback, the exception, unless Blender cut it off."""
    if "Traceback" not in error:
        return error.strip().removeprefix("Error: ")
    raised = re.findall(r"^[\w.]+(?:Error|Exception)\b.*", error, re.MULTILINE)
    return raised[-1].strip() if raised else "it is damaged, or of another format than its name says"


def _is_aid(thing: bpy.types.Object) -> bool:
    """The shape of bones, which the glTF importer adds."""
    return any(collection.name.startswith("glTF_not_exported") for collection in thing.users_collection)


def _stand_still(thing: bpy.types.Object) -> None:
    """A mesh of its own, at rest, where it is: without shape keys, bones and parents."""
    if thing.data.users > 1:
        thing.data = thing.data.copy()
    if thing.data.shape_keys:
        thing.shape_key_clear()
    thing.modifiers.clear()
    thing.data.transform(thing.matrix_world)
    world = bpy.context.scene.collection
    thing.parent, thing.matrix_world = None, Matrix()
    if thing.name not in world.objects:
        world.objects.link(thing)


def _importer(path: Path) -> Callable[..., object]:
    suffix = path.suffix.lower()
    if suffix in (".glb", ".gltf"):
        if not hasattr(np, "bool"):
            np.bool = bool  # type: ignore[misc]  # Blender 3.4's importer asks for it; numpy 1.24, in Debian, has none
        return bpy.ops.import_scene.gltf
    if suffix == ".obj" and bpy.app.version >= (3, 3, 0):
        return bpy.ops.wm.obj_import
    if suffix == ".ply":
        return bpy.ops.wm.ply_import if bpy.app.version >= (3, 6, 0) else bpy.ops.import_mesh.ply
    if suffix == ".stl":
        return bpy.ops.wm.stl_import if bpy.app.version >= (4, 1, 0) else bpy.ops.import_mesh.stl
    raise HeadError(f"{path.name}: this file format is not read; allowed: .glb, .gltf, .obj, .ply, .stl")


def _leave_out(mesh: bpy.types.Mesh, away: NDArray[np.bool_]) -> None:
    """Deletes pieces of the mesh, given by its triangles, with their vertices."""
    if not away.any():
        return
    loose = set(_triangles(mesh)[away].ravel().tolist())
    work = bmesh.new()
    work.from_mesh(mesh)
    bmesh.ops.delete(work, geom=[vertex for vertex in work.verts if vertex.index in loose], context="VERTS")
    work.to_mesh(mesh)
    work.free()


def _clean(mesh: bpy.types.Mesh) -> None:
    """Welds the seams of UV maps, at which subdividing would open the mesh."""
    work = bmesh.new()
    work.from_mesh(mesh)
    bmesh.ops.remove_doubles(work, verts=work.verts, dist=1e-6)
    bmesh.ops.delete(work, geom=[v for v in work.verts if not v.link_faces], context="VERTS")
    work.to_mesh(mesh)
    work.free()


def _has_own_colors(head: bpy.types.Object) -> bool:
    """Whether the file brought a texture."""
    trees = [slot.material.node_tree for slot in head.material_slots if slot.material is not None]
    return any(node.bl_idname == "ShaderNodeTexImage" for tree in trees if tree is not None for node in tree.nodes)
