"""Runs inside Blender: a head at real size, a camera on its ear, lights from a rig. Scene units are meters."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bmesh
import bpy
import numpy as np
import skinglow as sg
from mathutils import Matrix, Vector
from skinglow_blender.batch.rig_lights import add_lights

HEAD_HEIGHT_M = 0.26


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


def load_head(job: dict[str, Any]) -> bpy.types.Object:
    """The mesh of the job as one object, in meters, UV seams welded, smooth, subdivided for a smooth silhouette."""
    eyes: list[bpy.types.Object] = []
    if job["mesh"] == "suzanne":
        bpy.ops.mesh.primitive_monkey_add()
        objects = [bpy.context.object]
    else:
        found = _import(Path(job["mesh"]), split_groups=job["group"] is not None)
        objects = [o for o in found if job["group"] is None or o.name == job["group"]]
        eyes = [o for o in found if o.name in job["eyes"]]
        if not objects:
            raise SystemExit(f"{job['mesh']}: contains no mesh" + (f' "{job["group"]}"' if job["group"] else ""))
        for thing in [o for o in bpy.data.objects if o not in objects + eyes]:
            bpy.data.objects.remove(thing)
    for thing in eyes:
        _at_real_size(thing, job["unit_mm"])
        _subdivide(thing, 2)
        thing.data.materials.clear()
        thing.data.materials.append(_eye_material())
    head = _joined(objects)
    _at_real_size(head, job["unit_mm"])
    _clean(head.data, job["cut_below_m"])
    levels = 2 if len(head.data.polygons) < 8000 else 1 if len(head.data.polygons) < 30000 else 0
    if levels:
        _subdivide(head, levels)
    head.data.polygons.foreach_set("use_smooth", [True] * len(head.data.polygons))
    head.name = "head"
    return head


def _at_real_size(thing: bpy.types.Object, unit_mm: float) -> None:
    """Scales the vertices to meters and applies the object's transform."""
    thing.data.transform(Matrix.Scale(unit_mm / 1000.0, 4) @ thing.matrix_world)
    thing.matrix_world = Matrix()


def _eye_material() -> bpy.types.Material:
    material = bpy.data.materials.get("eye") or bpy.data.materials.new("eye")
    if material.node_tree is None:
        material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (0.55, 0.52, 0.50, 1.0)
    surface.inputs["Roughness"].default_value = 0.15
    return material


def _import(path: Path, split_groups: bool) -> list[bpy.types.Object]:
    """Imports all meshes of a file, which may add its own scenes."""
    suffix = path.suffix.lower()
    if suffix in (".glb", ".gltf"):
        bpy.ops.import_scene.gltf(filepath=str(path))
    elif suffix == ".obj":
        if "use_split_groups" in bpy.ops.wm.obj_import.get_rna_type().properties:
            bpy.ops.wm.obj_import(filepath=str(path), use_split_groups=split_groups)
        else:  # before Blender 3.6
            bpy.ops.import_scene.obj(filepath=str(path), use_split_groups=split_groups)
    elif suffix == ".ply" and hasattr(bpy.ops.wm, "ply_import"):
        try:
            bpy.ops.wm.ply_import(filepath=str(path))
        except AttributeError:  # before Blender 3.6
            bpy.ops.import_mesh.ply(filepath=str(path))
    else:
        raise SystemExit(f"{path}: unsupported mesh file; allowed: .glb, .gltf, .obj, .ply")
    return [o for o in bpy.data.objects if o.type == "MESH"]


def _joined(objects: list[bpy.types.Object]) -> bpy.types.Object:
    head = objects[0]
    for thing in objects:
        if thing.name not in bpy.context.scene.collection.objects:
            bpy.context.scene.collection.objects.link(thing)
    if len(objects) > 1:
        with bpy.context.temp_override(active_object=head, selected_editable_objects=objects):
            bpy.ops.object.join()
    return head


def _clean(mesh: bpy.types.Mesh, cut_below_m: float | None) -> None:
    work = bmesh.new()
    work.from_mesh(mesh)
    if cut_below_m is not None:
        below = [v for v in work.verts if v.co.z < cut_below_m]
        bmesh.ops.delete(work, geom=below, context="VERTS")
    bmesh.ops.remove_doubles(work, verts=work.verts, dist=1e-6)
    bmesh.ops.delete(work, geom=[v for v in work.verts if not v.link_faces], context="VERTS")
    work.to_mesh(mesh)
    work.free()


def _subdivide(head: bpy.types.Object, levels: int) -> None:
    modifier = head.modifiers.new("smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = levels
    fine = bpy.data.meshes.new_from_object(head.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    head.modifiers.clear()
    head.data = fine


def skin_surface(head: bpy.types.Object, color_map: str | None, normal_map: str | None) -> None:
    """The surface to which the glow is added: the given textures, or a plain skin color."""
    material = bpy.data.materials.new("face")
    if material.node_tree is None:
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (0.50, 0.27, 0.19, 1.0)
    surface.inputs["Roughness"].default_value = 0.5
    if color_map:
        picture = nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.load(color_map)
        links.new(picture.outputs["Color"], surface.inputs["Base Color"])
    if normal_map:
        picture = nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.load(normal_map)
        picture.image.colorspace_settings.is_data = True
        bump = nodes.new("ShaderNodeNormalMap")
        links.new(picture.outputs["Color"], bump.inputs["Color"])
        links.new(bump.outputs["Normal"], surface.inputs["Normal"])
    head.data.materials.clear()
    head.data.materials.append(material)


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


def views_of(head: bpy.types.Object) -> dict[str, tuple[Vector, float]]:
    """Camera targets as (point, visible height): the head, and the ear on its +X side."""
    points = [v.co for v in head.data.vertices]
    low, high = (Vector([pick(p[i] for p in points) for i in range(3)]) for pick in (min, max))
    height = min(high.z - low.z, HEAD_HEIGHT_M)  # a scan may include the shoulders
    upper = [p for p in points if p.z > high.z - height]
    ear = max((p for p in upper if p.z < high.z - 0.25 * height), key=lambda p: p.x)
    center = Vector((sum(p.x for p in upper) / len(upper), ear.y, high.z - 0.5 * height))
    width = max(p.x for p in upper) - min(p.x for p in upper)
    return {"": (center, 1.12 * max(height, 0.9 * width)), "_ear": (ear.copy(), 0.42 * height)}


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


def light_behind_ear(scene: bpy.types.Scene, head: bpy.types.Object) -> bpy.types.Object:
    """A warm bulb of 2 W, 15 cm behind the ear found by `views_of`; replaces all other lights."""
    remove_lights()
    ear, _height = views_of(head)["_ear"]
    position = tuple(ear + Vector((0.03, 0.15, 0.0)))
    return add_light(
        scene, sg.Light("POINT", (1.0, 0.75, 0.5), position, power=2.0, name="behind the ear", radius=0.01)
    )


def add_rig(scene: bpy.types.Scene, rig: list[Any], center: Vector) -> None:
    """Adds the lights of a rig by the add-on, its point at `center`; replaces all other lights.

    rig  the arguments of skinglow.read_light_rig
    """
    remove_lights()
    add_lights(scene, sg.read_light_rig(*rig), tuple(center))
    bpy.context.view_layer.update()
