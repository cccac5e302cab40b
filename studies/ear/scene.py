"""Runs inside Blender: the ear, the light behind it, and the core's results at every vertex."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
import skinglow as sg
from mathutils import Vector

from studies import rendering
from studies import scenes as stage
from studies.heads import loading

CAMERA_AZIMUTH_DEGREES = 25.0
LIGHT_AZIMUTH_DEGREES = 170.0  # behind the ear and slightly to its side, so that the skull does not occlude the light
LIGHT_DISTANCE_M = 0.35
LIGHT_COLOR = (1.0, 0.62, 0.35)  # warm
LIGHT_POWER_W = 20.0
# Far sides that see less of the sky are in the mouth and eye sockets: the add-on's default.
MIN_SKY_VISIBILITY = 0.1
# The ear is the thin skin near its center.
THIN_MM, NEAR_M = 8.0, 0.05
FACTS, FAR_SIDE = "ear_facts", "ear_far_side"


@dataclass
class Ear:
    scene: bpy.types.Scene
    head: bpy.types.Object
    light: sg.Light
    thickness_open: np.ndarray  # mm, by vertex, to any far side, however dark


@dataclass
class _Skin:
    """Points (n, 3), meters; normals (n, 3); triangles (m, 3); thickness (n,), mm, after it is measured."""

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    thickness: np.ndarray

    def measured(self, min_sky_visibility: float) -> np.ndarray:
        return sg.thickness(
            self.points, self.triangles, unit_mm=rendering.MM_PER_METER, min_sky_visibility=min_sky_visibility
        )

    def far_side(self, light: sg.Light, thickness: np.ndarray) -> np.ndarray:
        return sg.far_side_irradiance([light], self.points, self.normals, thickness / rendering.MM_PER_METER)


def build(job: dict[str, Any]) -> Ear:
    """The scene of the job's head, with a single light and nothing else."""
    scene = stage.empty_scene()
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    rendering.linear_render(scene, job["size"])
    head, placed = loading.load_alone(job)
    points, normals, triangles = rendering.mesh_arrays(head.data)
    skin = _Skin(points, normals, triangles, np.zeros(len(points)))
    skin.thickness = skin.measured(MIN_SKY_VISIBILITY)
    center, radius = _find_ear(skin, placed.left_ear.center)
    camera = stage.aim_camera(scene, Vector(center), 2.2 * radius, math.radians(CAMERA_AZIMUTH_DEGREES))
    azimuth = math.radians(LIGHT_AZIMUTH_DEGREES)
    light_position = center + LIGHT_DISTANCE_M * np.array((math.sin(azimuth), -math.cos(azimuth), 0.0))
    light = sg.Light("POINT", LIGHT_COLOR, light_position, power=LIGHT_POWER_W, name="light")
    stage.add_light(scene, light)

    back_lit = _cosine(skin, light_position) < 0.0
    inside = np.linalg.norm(skin.points - center, axis=1) < radius
    # Colors must not be negative, but cosines can be.
    facts = [skin.thickness, np.maximum(_cosine(skin, camera.location), 0.0), back_lit & inside]
    rendering.store_color(head.data, FACTS, np.column_stack(facts))
    rendering.store_color(head.data, FAR_SIDE, skin.far_side(light, skin.thickness))
    return Ear(scene, head, light, skin.measured(0.0))


def _find_ear(skin: _Skin, about: np.ndarray) -> tuple[np.ndarray, float]:
    """A bounding sphere (center and radius in meters) of the thin skin near that point of the ear."""
    near = np.linalg.norm(skin.points - about, axis=1) < NEAR_M
    thin = skin.points[near & (skin.thickness < THIN_MM)]
    if not len(thin):
        raise SystemExit(f"no skin under {THIN_MM:g} mm within {NEAR_M:g} m of the head's side; is the unit right?")
    center = 0.5 * (thin.min(axis=0) + thin.max(axis=0))
    return center, float(np.linalg.norm(thin - center, axis=1).max())


def _cosine(skin: _Skin, point: Any) -> np.ndarray:  # noqa: ANN401  any triple
    offset = np.array(point) - skin.points
    return np.einsum("ij,ij->i", offset, skin.normals) / np.linalg.norm(offset, axis=1)


def _store(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    mesh.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
