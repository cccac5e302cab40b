# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a POV-Ray scene needs from Blender: mesh, camera and surface, as arguments of the core."""

from typing import Any

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..read.measured_size import MEASURED_UNIT
from ..read.mesh_reading import vertices_of_slots
from ..read.scene_reading import MM_PER_METER, Skin
from ..show.frozen import is_frozen, read_frozen_tiles
from ..show.tile_group import MAX_ROUNDING
from ..show.tile_image import tiles_shown
from ..table.skin_tables import Table
from ..table.surface_light import surface_tiles
from ..table.texel_mapping import texels_per_mm
from ..thickness.thickness_attribute import read
from ..thickness.tile_attribute import rows_of, texels_of
from .povray_pictures import Pictures, glowing_slots

CAMERAS = ("PERSP", "ORTHO")


def transforms_of(depsgraph: bpy.types.Depsgraph, original: bpy.types.Object) -> list[np.ndarray]:
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
    transforms: list[np.ndarray],
    table: Table | None,
    pictures: Pictures,
) -> tuple[dict[str, Any], np.ndarray | None]:
    """The evaluated mesh and its instances in world space, with the coordinates of its light and pictures.

    Also the tiles that it shows: those given, or of light that the table works out at each pixel.
    """
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
        matrix = transforms[0] if transforms else np.array(obj.matrix_world, np.float64)
        found = {
            "vertices": points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3],
            "triangles": triangles.reshape(-1, 3),
            "instances": [each @ np.linalg.inv(matrix) for each in transforms[1:]],
        }
        if tiles is not None:
            found["glow_uv"] = glow_uv(_texels(obj, mesh, corners.reshape(-1, 3)), _unlit(obj, mesh), tiles.shape)
        elif table is not None and table.lighting is not None:
            mm = (base.size * _lut_u(obj, mesh, skin, base) - 0.5) / (base.size * base.texel_mapping[0])
            unit_mm = obj.original.data.get(MEASURED_UNIT, MM_PER_METER)
            body = found["vertices"], found["triangles"], _normals(mesh, corners, matrix)
            lit = surface_tiles(*body, mm, unit_mm, skin.base, table)
            tiles, texels = lit.pixels, lit.texels.astype(np.float64)
            found["glow_uv"] = glow_uv(texels, _unlit(obj, mesh), tiles.shape)
        elif "thickness_image" not in pictures.arguments:
            found["lut_u"] = _lut_u(obj, mesh, skin, base)
        if smooth.any():
            found["normals"] = _normals(mesh, corners, matrix)
        if pictures.uv_map:
            uv = np.empty(2 * len(mesh.loops), np.float32)
            mesh.uv_layers[pictures.uv_map].data.foreach_get("uv", uv)
            found["surface_uv"] = uv.reshape(-1, 2)[corners].reshape(-1, 3, 2)
        return found, tiles
    finally:
        obj.to_mesh_clear()


def _normals(mesh: bpy.types.Mesh, corners: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(m, 3, 3), of the triangles' corners, in the world."""
    normals = blender_version.corner_normals(mesh)[corners] @ np.linalg.inv(matrix[:3, :3])
    return (normals / np.linalg.norm(normals, axis=1, keepdims=True)).reshape(-1, 3, 3)


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


def _texels(obj: bpy.types.Object, mesh: bpy.types.Mesh, corners: np.ndarray) -> np.ndarray:
    """(m, 3, 3), of the tiles that Blender shows, at each triangle's corners."""
    texels = texels_of(mesh)
    if texels is None:
        raise SkinError(f"'{obj.name}' has no tiles behind its modifiers: apply them, or set Lighting to Per Object")
    return texels[corners].astype(np.float64)


def _unlit(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> np.ndarray:
    """(m,) bool: the triangles of slots that are no skin."""
    slot = np.empty(len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("material_index", slot)
    shows = glowing_slots(obj)
    return ~np.array(shows)[np.minimum(slot, len(shows) - 1)] if shows else np.zeros(len(slot), bool)


def glow_uv(texels: np.ndarray, unlit: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """The coordinates (m, 3, 2) of each triangle's corners in the image of the tiles and the dark row above them."""
    height, width = shape[0] + 1, shape[1]
    tile = texels[:, :, 2]
    uv = (texels[:, :, :2] + 0.5) / (width, height)
    dark = unlit | (tile.min(axis=1) < 1.0) | (np.ptp(tile, axis=1) > MAX_ROUNDING)
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
