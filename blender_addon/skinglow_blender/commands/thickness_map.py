# SPDX-License-Identifier: GPL-3.0-or-later
"""Thickness as an image in the mesh's own UV map, and from an image back."""

import os
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError, core
from ..read.file_skins import skins_of_file
from ..read.measured_geometry import check_mesh, unit_mm
from ..read.measured_size import scale_since_measured
from ..read.mesh_reading import triangles_of
from ..show.image_pairs import read_pixels
from ..thickness import thickness_attribute
from ..whole_file import whole_file
from .skin import skin_settings_of

#: Formats of the image: file extension, and bits a texel; 0: mm as floats.
FORMATS = {"EXR": (".exr", 0), "PNG_16": (".png", 16), "PNG_8": (".png", 8)}
#: Value of float texels without a thickness, mm: thicker than any flesh that lets light through.
OPAQUE_MM = 1000.0
#: Custom property of an image: the thickness that its white stands for, mm.
WHITE_PROPERTY = "skinglow_white_mm"
EVERY_TEXEL = 8192


class BakedThickness(NamedTuple):
    """An image of thickness."""

    image: bpy.types.Image
    file: Path
    white_mm: float  #: thickness of the value 1: 1 in float images
    covered_fraction: float  #: of the texels


def bake_thickness(
    obj: bpy.types.Object,
    file: str | os.PathLike | None = None,
    size: int = 1024,
    format: str = "EXR",  # noqa: A002  as Blender calls it
    white_mm: float | None = None,
) -> BakedThickness:
    """Writes the thickness of a skin to an image in the UV map that its renders use, and loads it.

    file      None: "//NAME_thickness.exr" or ".png", next to the blend file
    size      width and height, texels, 16 to 8192
    format    "EXR": mm, as floats; "PNG_16", "PNG_8": fractions of white_mm
    white_mm  thickness of white in PNG, mm; None: the thickness at the last entry of the skin's lookup
    Where no thickness is known, texels are as thick as the format can tell, so that nothing glows there.
    """
    skin_settings_of(obj)
    check_mesh(obj)
    if format not in FORMATS:
        raise ValueError(f"bake_thickness: format = {format!r} is not allowed: {', '.join(FORMATS)}")
    if not 16 <= size <= EVERY_TEXEL:
        raise ValueError(f"bake_thickness: size = {size!r} is not allowed: 16 to {EVERY_TEXEL}")
    extension, bits = FORMATS[format]
    white = 1.0 if not bits else obj.skinglow.max_thickness_mm if white_mm is None else float(white_mm)
    if not (np.isfinite(white) and white > 0.0):
        raise ValueError(f"bake_thickness: white_mm = {white_mm!r} is not allowed: mm, finite and above 0")
    path = _path_of(obj, file, extension)
    corners, values = _triangles_in_uv(obj)
    found = core().bake_thickness(corners, values, size, size, outside_mm=white if bits else OPAQUE_MM)
    if not found.covered.any():
        raise SkinError(f"'{obj.name}': its UV map is empty, or lies outside of the first tile: unwrap the mesh")
    _write(path, found.thickness_mm, bits, white)
    return BakedThickness(_loaded(path, white), path, white, float(found.covered.mean()))


def thickness_from_image(obj: bpy.types.Object, image: bpy.types.Image, white_mm: float | None = None) -> None:
    """Takes the thickness of a skin from an image in its UV map, at each vertex; it is kept as given.

    white_mm  thickness of the value 1, mm; None: that of the bake that made the image, or 1, as values are mm
    """
    skin_settings_of(obj)
    check_mesh(obj)
    thickness_attribute.check_local(obj)
    white = image.get(WHITE_PROPERTY, 1.0) if white_mm is None else float(white_mm)
    if not (np.isfinite(white) and white > 0.0):
        raise ValueError(f"thickness_from_image: white_mm = {white_mm!r} is not allowed: mm, finite and above 0")
    if not image.colorspace_settings.is_data:
        raise SkinError(
            f"'{image.name}' is read as colors ({image.colorspace_settings.name}): set its Color Space to Non-Color"
        )
    if not image.has_data:
        len(image.pixels)  # reads the file
    if not image.has_data or image.channels < 1 or 0 in image.size:
        raise SkinError(f"'{image.name}' has no pixels: check that its file '{image.filepath}' exists")
    mesh = obj.data
    uv = _uv_of(obj)
    if image.source == "TILED" and ((uv < 0.0) | (uv > 1.0)).any():
        raise SkinError(
            f"'{image.name}' has UDIM tiles, of which only the first is read, and '{obj.name}' has faces in others: "
            "connect an Image Texture to Thickness of the Skinglow node in its material instead"
        )
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    sampled = core().sample_image(read_pixels(image)[:, :, 0], uv) * white
    # A vertex on a seam has several points in the image.
    count = np.bincount(corners, minlength=len(mesh.vertices))
    total = np.bincount(corners, sampled, minlength=len(mesh.vertices))
    if (total < 0.0).any():
        raise SkinError(f"'{image.name}' has a negative thickness: allowed: 0 mm or more")
    thickness_attribute.store(obj, total / np.maximum(count, 1), unit_mm(obj, bpy.context.scene), known=count > 0)
    obj.update_tag(refresh={"OBJECT", "DATA"})


def _path_of(obj: bpy.types.Object, file: str | os.PathLike | None, extension: str) -> Path:
    text = str(file) if file is not None else f"//{_file_name(obj)}_thickness{extension}"
    if text.startswith("//") and not bpy.data.filepath:
        raise SkinError("Save the file first, or give the image's file: it is written next to the blend file")
    path = Path(bpy.path.abspath(text)).absolute()
    return path if path.suffix.lower() == extension else path.with_name(path.name + extension)


def _file_name(obj: bpy.types.Object) -> str:
    """The object's name as files can have it, with a number where that is the same for others: 'Ear L' and 'Ear_L'."""
    name = bpy.path.clean_name(obj.name)
    alike = {o.name for o in skins_of_file() if bpy.path.clean_name(o.name).casefold() == name.casefold()}
    number = sorted(alike).index(obj.name) + 1
    return name if number == 1 else f"{name}_{number}"


def _uv_of(obj: bpy.types.Object) -> np.ndarray:
    """(n, 2) of each face corner, in the UV map that renders use."""
    layers = obj.data.uv_layers
    layer = next((each for each in layers if each.active_render), layers.active)
    if layer is None:
        raise SkinError(f"'{obj.name}' has no UV map: unwrap it (U in Edit Mode) or use Smart UV Project")
    uv = np.empty(2 * len(obj.data.loops), np.float32)
    layer.data.foreach_get("uv", uv)
    return uv.reshape(-1, 2)


def _triangles_in_uv(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (m, 3, 2) in the UV map and thicknesses (m, 3), mm, of the triangles whose thickness is known."""
    mesh = obj.data
    thickness, known = thickness_attribute.read(mesh)
    world_size = abs(obj.matrix_world.to_3x3().determinant()) ** (1.0 / 3.0)
    thickness = thickness * scale_since_measured(mesh, world_size)
    triangles = triangles_of(mesh)
    loops = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    chosen = known[triangles].all(axis=1)
    return _uv_of(obj)[loops.reshape(-1, 3)[chosen]], thickness[triangles[chosen]]


def _write(path: Path, thickness_mm: np.ndarray, bits: int, white_mm: float) -> None:
    """Writes a PNG, or a float EXR by Blender's own writer, complete or not at all."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(path) as partial:
            if bits:
                partial.write_bytes(core().gray_png(thickness_mm / white_mm, bits))
            else:
                _write_exr(partial, thickness_mm)
    except (OSError, RuntimeError) as error:
        raise SkinError(f"Cannot write {path}: {error}") from error


def _write_exr(path: Path, values: np.ndarray) -> None:
    height, width = values.shape
    image = bpy.data.images.new(".Skinglow thickness", width, height, alpha=False, float_buffer=True)
    try:
        image.colorspace_settings.name = blender_version.data_color_space(image)
        pixels = np.ones((height, width, 4), np.float32)
        pixels[:, :, :3] = values[:, :, None]
        image.pixels.foreach_set(pixels.ravel())
        image.file_format, image.filepath_raw = "OPEN_EXR", str(path)
        image.save()
    finally:
        bpy.data.images.remove(image)


def _loaded(path: Path, white_mm: float) -> bpy.types.Image:
    image = bpy.data.images.load(str(path), check_existing=True)
    image.reload()
    image.colorspace_settings.name = blender_version.data_color_space(image)
    if bpy.data.filepath:
        image.filepath = bpy.path.relpath(str(path))
    image[WHITE_PROPERTY] = white_mm
    return image
