"""Runs inside Blender: the ear, the lamp behind it, and what the core says of both at every vertex."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import blender_scene as stage

# isort: off  (importing bpy is what makes mathutils importable in the wheels)
import bpy

# isort: on
import numpy as np
import shading
import skinglow as sg
from mathutils import Vector

CAMERA_AZIMUTH_DEGREES = 25.0
LAMP_AZIMUTH_DEGREES = 170.0  # behind the ear, a little to its side, so that the skull does not hide the ear from it
LAMP_DISTANCE_M = 0.35
LAMP_COLOR = (1.0, 0.62, 0.35)  # warm
LAMP_POWER_W = 20.0
# Far sides darker than this are mouth and sockets: the add-on's default.
MIN_OPENNESS = 0.1
# The ear: around the thin skin near the head's outermost point.
THIN_MM, NEAR_M = 8.0, 0.05
FACTS, FAR_SIDE = "ear_facts", "ear_far_side"
THICKNESS_OPEN, FAR_SIDE_OPEN = "ear_thickness_open", "ear_far_side_open"


@dataclass
class Ear:
    scene: bpy.types.Scene
    head: bpy.types.Object
    lamp: sg.Light
    reference_point: tuple[float, float, float]  # the add-on's default: center of the bounding box
    cpu_seconds: dict[str, float]  # what the mesh costs once, and a change of lamps


@dataclass
class _Skin:
    """Places (n, 3), meters; normals (n, 3); triangles (m, 3); thickness (n,), mm, once it is measured."""

    places: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    thickness: np.ndarray

    def measured(self, min_openness: float) -> np.ndarray:
        return sg.thickness(self.places, self.triangles, unit_mm=shading.MM_PER_METER, min_sky_visibility=min_openness)

    def far_side(self, lamp: sg.Light, thickness: np.ndarray) -> np.ndarray:
        return sg.far_side_irradiance([lamp], self.places, self.normals, thickness / shading.MM_PER_METER)


def build(job: dict[str, Any]) -> Ear:
    """The scene of the job's head. Light comes from the lamp alone, and the head is alone."""
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    shading.linear_render(scene, job["size"])
    head = stage.load_head(job)
    cpu = {}
    skin = _read(head.data)
    skin.thickness, cpu["thickness"] = shading.timed(lambda: skin.measured(MIN_OPENNESS))
    open_thickness = skin.measured(0.0)
    center, radius = _find_ear(skin, np.array(stage.views_of(head)["_ear"][0]))
    camera = stage.aim_camera(scene, Vector(center), 2.2 * radius, math.radians(CAMERA_AZIMUTH_DEGREES))
    where = _place_lamp(scene, Vector(center))
    lamp = sg.Light("POINT", LAMP_COLOR, where, power=LAMP_POWER_W, name="lamp")

    far_side, cpu["far_side"] = shading.timed(lambda: skin.far_side(lamp, skin.thickness))
    back_lit = _cosine(skin, where) < 0.0
    inside = np.linalg.norm(skin.places - center, axis=1) < radius
    # A color must not be negative, and a cosine is.
    facts = [skin.thickness, np.maximum(_cosine(skin, camera.location), 0.0), back_lit & inside]
    _store(head.data, shading.THICKNESS, skin.thickness)
    _store(head.data, THICKNESS_OPEN, open_thickness)
    _store_color(head.data, FACTS, np.column_stack(facts))
    _store_color(head.data, FAR_SIDE, far_side)
    _store_color(head.data, FAR_SIDE_OPEN, skin.far_side(lamp, open_thickness))
    return Ear(scene, head, lamp, tuple(stage.center_of(head)), cpu)


def _read(mesh: bpy.types.Mesh) -> _Skin:
    count = len(mesh.vertices)
    places, normals = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
    mesh.vertices.foreach_get("co", places.ravel())
    mesh.vertex_normals.foreach_get("vector", normals.ravel())
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    return _Skin(places.astype(np.float64), normals.astype(np.float64), triangles, np.zeros(count))


def _find_ear(skin: _Skin, outermost: np.ndarray) -> tuple[np.ndarray, float]:
    """A ball, center and radius in meters, around the thin skin near the head's outermost point."""
    near = np.linalg.norm(skin.places - outermost, axis=1) < NEAR_M
    thin = skin.places[near & (skin.thickness < THIN_MM)]
    if not len(thin):
        raise SystemExit(f"no skin under {THIN_MM:g} mm within {NEAR_M:g} m of the head's side; is the unit right?")
    center = 0.5 * (thin.min(axis=0) + thin.max(axis=0))
    return center, float(np.linalg.norm(thin - center, axis=1).max())


def _place_lamp(scene: bpy.types.Scene, ear: Vector) -> tuple[float, float, float]:
    azimuth = math.radians(LAMP_AZIMUTH_DEGREES)
    data = bpy.data.lights.new("lamp", "POINT")
    data.color, data.energy, data.shadow_soft_size = LAMP_COLOR, LAMP_POWER_W, 0.0
    lamp = bpy.data.objects.new("lamp", data)
    lamp.location = ear + LAMP_DISTANCE_M * Vector((math.sin(azimuth), -math.cos(azimuth), 0.0))
    scene.collection.objects.link(lamp)
    return tuple(lamp.location)


def _cosine(skin: _Skin, point: Any) -> np.ndarray:  # noqa: ANN401  any triple
    towards = np.array(point) - skin.places
    return np.einsum("ij,ij->i", towards, skin.normals) / np.linalg.norm(towards, axis=1)


def _store(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))


def _store_color(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.column_stack([values, np.ones(len(values))]).astype(np.float32).ravel())
