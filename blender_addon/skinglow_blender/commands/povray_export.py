# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports the scene to POV-Ray for comparison: same camera, mesh, lights and lookup. The core writes the text."""

import os
import shutil
from itertools import chain, count
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError, core
from ..read import working_space
from ..read.mesh_reading import vertices_of_slots
from ..read.scene_lights import make_light
from ..read.scene_reading import SceneReading, Skin, read_scene
from ..show.frozen import is_frozen, read_frozen_tiles
from ..show.skin_material import skin_node
from ..show.tile_group import MAX_ROUNDING
from ..show.tile_image import tiles_shown
from ..table.skin_tables import base_lut, compute_table, lights_of
from ..table.texel_mapping import texels_per_mm
from ..thickness.thickness_attribute import read
from ..thickness.tile_attribute import rows_of, texels_of

LUT_FILE, TILES_FILE = "lut.exr", "tiles.exr"


def export_povray(
    depsgraph: bpy.types.Depsgraph,
    directory: str | os.PathLike,
    obj: bpy.types.Object | None = None,
    surface: bool = True,
    compute_lut: bool = False,
) -> list[Path]:
    """Writes a POV-Ray 3.7 scene of a skin; `povray scene.ini` in the folder renders it. Returns the files written.

    obj          the skin; None: every skin of the depsgraph, each in its own folder if there are several
    surface      False: only the transmitted light, without lights
    compute_lut  True: POV-Ray computes the lookup by Eq. 1 to 3 itself (mode paper); False: it reads the EXR
    Only what the scene uses is written. Raises SkinError if there is no camera or skin, or if writing fails.
    """
    reading = read_scene(depsgraph)
    skins = [each for each in reading.skins if obj is None or each[0] == obj.original]
    if not skins:
        what = "no skin" if obj is None else f"no skin '{obj.name}'"
        raise SkinError(f"There is {what} to export in this view layer: make one first, and unhide it")
    if depsgraph.scene.camera is None:
        raise SkinError("The scene has no camera: POV-Ray needs one")
    written: list[Path] = []
    names = _folder_names([skin.name for _original, skin in skins])
    for (original, skin), name in zip(skins, names, strict=True):
        folder = Path(directory) if len(skins) == 1 else Path(directory) / name
        try:
            folder.mkdir(parents=True, exist_ok=True)
            written += _export_skin(depsgraph, reading, original, skin, folder, surface, compute_lut)
        except OSError as error:
            raise SkinError(f"Cannot write to {folder}: {error.strerror or error}") from error
    return written


def _folder_names(names: list[str]) -> list[str]:
    """A folder's name for each skin: objects of different libraries, or "a b" and "a_b", may have the same one."""
    found: list[str] = []
    taken: set[str] = set()
    for name in map(bpy.path.clean_name, names):
        # Without regard to case: some file systems have none.
        free = next(n for n in chain((name,), (f"{name}_{i}" for i in count(2))) if n.casefold() not in taken)
        taken.add(free.casefold())
        found.append(free)
    return found


def _export_skin(
    depsgraph: bpy.types.Depsgraph,
    reading: SceneReading,
    original: bpy.types.Object,
    skin: Skin,
    folder: Path,
    surface: bool,
    compute_lut: bool,
) -> list[Path]:
    if compute_lut and skin.mode != "PAPER":
        raise SkinError(f"POV-Ray computes lookups in mode paper only; '{skin.name}' is in mode {skin.mode.lower()}")
    obj = original.evaluated_get(depsgraph)
    base = base_lut(skin.base)
    tiles = None if compute_lut else _tiles(original, depsgraph)
    arguments: dict[str, Any] = _mesh_arguments(obj, skin, base, tiles)
    arguments.update(_camera_arguments(depsgraph))
    written = []
    if surface:
        look, picture = _surface_arguments(obj, folder)
        arguments.update(look)
        written += picture
    else:
        arguments.pop("surface_uv", None)
    if "surface_image" not in arguments:
        arguments.pop("surface_uv", None)
    if tiles is not None:
        arguments["image"] = TILES_FILE
        # With a dark row for all that shows no light.
        light = np.pad(working_space.to_rec709(tiles[:, :, :3]), ((0, 1), (0, 0), (0, 0)))
        written.append(_write_light(light, folder / TILES_FILE))
    elif not compute_lut:
        arguments["image"] = LUT_FILE
        colors = compute_table(skin, reading.lights, reading.world).colors
        written.append(_write_light(colors[None], folder / LUT_FILE))
    files = core().povray_files(
        mode=skin.mode.lower(),
        base=base if skin.mode == "PAPER" else None,
        size=base.size,
        max_thickness_mm=base.max_thickness_mm,
        lights=[make_light(light) for light in lights_of(skin, reading.lights)],
        point=skin.point,
        coefficients=skin.attenuation,
        blood_weight=skin.blood_weight,
        strength=skin.strength,
        name=skin.name,
        **arguments,
    )
    return written + [_write_whole(folder / name, text) for name, text in files.items()]


def _tiles(original: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """The pixels (h, width, 4) of the tiles that a skin shows; None if it shows a lookup."""
    settings = original.skinglow
    if is_frozen(settings.group):
        frame = depsgraph.scene.frame_current
        return read_frozen_tiles(settings.group, settings.row, frame, rows_of(original.data))
    found = tiles_shown(original, depsgraph.mode)
    return found[1] if found is not None else None


def _mesh_arguments(
    obj: bpy.types.Object,
    skin: Skin,
    base: Any,  # noqa: ANN401
    tiles: np.ndarray | None,
) -> dict[str, Any]:
    """The evaluated mesh in world space, with the coordinates of its light."""
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
        matrix = np.array(obj.matrix_world, np.float64)
        found = {
            "vertices": points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3],
            "triangles": triangles.reshape(-1, 3),
        }
        if tiles is not None:
            found["glow_uv"] = _texel_uv(obj, mesh, corners.reshape(-1, 3), tiles.shape)
        else:
            found["lut_u"] = _lut_u(obj, mesh, skin, base)
        if smooth.any():
            normals = blender_version.corner_normals(mesh)[corners] @ np.linalg.inv(matrix[:3, :3])
            found["normals"] = (normals / np.linalg.norm(normals, axis=1, keepdims=True)).reshape(-1, 3, 3)
        if mesh.uv_layers.active is not None:
            uv = np.empty(2 * len(mesh.loops), np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uv)
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
    shows = _glowing_slots(obj)
    tile = texels[:, :, 2]
    dark = (tile.min(axis=1) < 1.0) | (np.ptp(tile, axis=1) > MAX_ROUNDING)
    if shows:
        dark |= ~np.array(shows)[np.minimum(slot, len(shows) - 1)]
    uv = (texels[:, :, :2] + 0.5) / (width, height)
    uv[dark] = 0.5 / width, 1.0 - 0.5 / height
    return uv


def _glowing_slots(obj: bpy.types.Object) -> list[bool]:
    """Whether the material of each slot adds light."""
    materials = [slot.material for slot in obj.material_slots]
    nodes = [skin_node(material) if material is not None else None for material in materials]
    return [node is not None and not node.mute for node in nodes]


def _glowing_vertices(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> np.ndarray:
    """(n,) bool: the vertices of faces whose material adds light."""
    slots = _glowing_slots(obj)
    return vertices_of_slots(mesh, slots) if slots else np.ones(len(mesh.vertices), bool)


def _camera_arguments(depsgraph: bpy.types.Depsgraph) -> dict[str, Any]:
    render = depsgraph.scene.render
    width = max(1, render.resolution_x * render.resolution_percentage // 100)
    height = max(1, render.resolution_y * render.resolution_percentage // 100)
    camera = depsgraph.scene.camera.evaluated_get(depsgraph)
    projection = camera.calc_matrix_camera(
        depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y
    )
    return {
        "camera_matrix": np.array(camera.matrix_world, np.float64),
        "projection": np.array(projection, np.float64),
        "resolution": (width, height),
    }


def _surface_arguments(obj: bpy.types.Object, folder: Path) -> tuple[dict[str, Any], list[Path]]:
    """The surface's base color or texture; empty if it has no Principled BSDF."""
    material = next((s.material for s in obj.material_slots if s.material and skin_node(s.material)), None)
    tree = blender_version.shader_tree(material) if material is not None else None
    principled = next((n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled"), None) if tree else None
    if principled is None:
        return {}, []
    socket = principled.inputs["Base Color"]
    source = socket.links[0].from_node if socket.is_linked else None
    if source is not None and source.bl_idname == "ShaderNodeTexImage" and source.image is not None:
        picture = _copy_picture(source.image, folder)
        if picture is not None:
            return {"surface_image": picture.name}, [picture]
    color = working_space.to_rec709(np.array(socket.default_value)[:3])
    return {"surface_color": tuple(color.clip(0.0).tolist())}, []


def _copy_picture(image: bpy.types.Image, folder: Path) -> Path | None:
    """Copies an image's packed or external file into the folder; None if it has neither."""
    source = Path(bpy.path.abspath(image.filepath, library=image.library))
    target = folder / f"surface{source.suffix.lower()}"
    if image.packed_file is not None:
        target.write_bytes(image.packed_file.data)
    elif source.is_file():
        if source.resolve() != target.resolve():
            shutil.copyfile(source, target)
    else:
        return None
    return target


def _write_light(colors: np.ndarray, path: Path) -> Path:
    """Writes colors (height, width, 3) as a float32 EXR by Blender's own writer; exact."""
    height, width = colors.shape[:2]
    image = bpy.data.images.new(".Skinglow export", width, height, alpha=False, float_buffer=True)
    partial = path.with_name(f".{path.name}.part.exr")
    try:
        image.colorspace_settings.name = blender_version.data_color_space(image)
        pixels = np.ones((height, width, 4), np.float32)
        pixels[:, :, :3] = colors
        image.pixels.foreach_set(pixels.ravel())
        image.file_format = "OPEN_EXR"
        image.filepath_raw = str(partial)
        try:
            image.save()
        except RuntimeError as error:
            raise SkinError(f"Cannot write {path}: {error}") from error
        os.replace(partial, path)
    finally:
        bpy.data.images.remove(image)
        partial.unlink(missing_ok=True)
    return path


def _write_whole(path: Path, text: str) -> Path:
    """Writes a text file atomically."""
    partial = path.with_name(f".{path.name}.part")
    try:
        partial.write_text(text, encoding="utf-8")
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
    return path
