# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a POV-Ray scene needs from Blender: mesh, camera and surface, as arguments of the core."""

from typing import Any

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..read.mesh_reading import vertices_of_slots
from ..read.scene_reading import Skin
from ..show.frozen import is_frozen, read_frozen_tiles
from ..show.tile_group import MAX_ROUNDING
from ..show.tile_image import tiles_shown
from ..table.texel_mapping import texels_per_mm
from ..thickness.thickness_attribute import read
from ..thickness.tile_attribute import rows_of, texels_of
from .povray_pictures import Pictures, glowing_slots

CAMERAS = ("PERSP", "ORTHO")


def places_of(depsgraph: bpy.types.Depsgraph, original: bpy.types.Object) -> list[np.ndarray]:
    """The world matrices at which an object is shown: its own, unless it is hidden, and those of its instances."""
    return [
        np.array(each.matrix_world, np.float64)
        for each in depsgraph.object_instances
        if each.show_self and (each.instance_object if each.is_instance else each.object).original == original
    ]


def tiles_of(original: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """The pixels (h, width, 4) of the tiles that a skin shows; None if it shows a lookup."""
    settings = original.skinglow
    if is_frozen(settings.group):
        frame = depsgraph.scene.frame_current
        return read_frozen_tiles(settings.group, settings.row, frame, rows_of(original.data))
    found = tiles_shown(original, depsgraph.mode)
    return found[1] if found is not None else None


def mesh_arguments(
    obj: bpy.types.Object,
    skin: Skin,
    base: Any,  # noqa: ANN401
    tiles: np.ndarray | None,
    places: list[np.ndarray],
    pictures: Pictures,
) -> dict[str, Any]:
    """The evaluated mesh in world space, at all of its places, with the coordinates of its light and pictures."""
    mesh = obj.to_mesh()
    try:
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        mesh.calc_loop_triangles()
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("loops", corners)
        smooth = np.empty(len(mesh.loop_triangles), bool)
        mesh.loop_triangles.foreach_get("use_smooth", smooth)
        matrix = places[0] if places else np.array(obj.matrix_world, np.float64)
        found = {
            "vertices": points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3],
            "triangles": triangles.reshape(-1, 3),
            "instances": [place @ np.linalg.inv(matrix) for place in places[1:]],
        }
        if tiles is not None:
            found["glow_uv"] = _texel_uv(obj, mesh, corners.reshape(-1, 3), tiles.shape)
        elif "thickness_image" not in pictures.arguments:
            found["lut_u"] = _lut_u(obj, mesh, skin, base)
        if smooth.any():
            normals = blender_version.corner_normals(mesh)[corners] @ np.linalg.inv(matrix[:3, :3])
            found["normals"] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).reshape(-1, 3, 3)
        if pictures.uv_map:
            uv = np.empty(2 * len(mesh.loops), np.float32)
            mesh.uv_layers[pictures.uv_map].data.foreach_get("uv", uv)
            found["surface_uv"] = uv.reshape(-1, 2)[corners].reshape(-1, 3, 2)
        return found
    finally:
        obj.to_mesh_clear()


def _lut_u(obj: bpy.types.Object, mesh: bpy.types.Mesh, skin: Skin, base: Any) -> np.ndarray:  # noqa: ANN401
    """The lookup coordinate of each vertex."""
    thickness, known = read(mesh)
    glows = _glowing_vertices(obj, mesh)
    unknown = np.count_nonzero(~known & glows)
    if unknown:
        raise SkinError(
            f"'{skin.name}': the thickness is not known at {unknown} of {len(known)} vertices, "
            "which a modifier or an edit added: apply the modifier, or press Measure Thickness"
        )
    # What is not skin gets the light of the thickest.
    texels = np.where(glows, texels_per_mm(obj, skin, base.texel_mapping) * thickness.astype(np.float64), base.size - 1)
    return (texels + 0.5) / base.size


def _texel_uv(obj: bpy.types.Object, mesh: bpy.types.Mesh, corners: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """The coordinates (m, 3, 2) of each triangle's corners in the image of the tiles and the dark row above them."""
    height, width = shape[0] + 1, shape[1]
    texels = texels_of(mesh)
    if texels is None:
        raise SkinError(f"'{obj.name}' has no tiles behind its modifiers: apply them, or set Lighting to Per Object")
    texels = texels[corners].astype(np.float64)
    slot = np.empty(len(corners), np.int32)
    mesh.loop_triangles.foreach_get("material_index", slot)
    shows = glowing_slots(obj)
    tile = texels[:, :, 2]
    dark = (tile.min(axis=1) < 1.0) | (np.ptp(tile, axis=1) > MAX_ROUNDING)
    if shows:
        dark |= ~np.array(shows)[np.minimum(slot, len(shows) - 1)]
    uv = (texels[:, :, :2] + 0.5) / (width, height)
    uv[dark] = 0.5 / width, 1.0 - 0.5 / height
    return uv


def _glowing_vertices(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> np.ndarray:
    """(n,) bool: the vertices of faces whose material adds light."""
    slots = glowing_slots(obj)
    return vertices_of_slots(mesh, slots) if slots else np.ones(len(mesh.vertices), bool)


def camera_arguments(depsgraph: bpy.types.Depsgraph) -> dict[str, Any]:
    render = depsgraph.scene.render
    width = max(1, render.resolution_x * render.resolution_percentage // 100)
    height = max(1, render.resolution_y * render.resolution_percentage // 100)
    camera = depsgraph.scene.camera.evaluated_get(depsgraph)
    if camera.data.type not in CAMERAS:
        raise SkinError(
            f"The camera '{camera.name}' is {camera.data.type.lower()}; POV-Ray scenes are exported for perspective "
            "and orthographic cameras"
        )
    projection = camera.calc_matrix_camera(
        depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    return {
        "camera_matrix": np.array(camera.matrix_world, np.float64),
        "projection": np.array(projection, np.float64),
        "resolution": (width, height),
    }
