# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a POV-Ray scene needs of a skin's materials: the surface's color, and pictures in a UV map."""

from pathlib import Path
from typing import Any, NamedTuple

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError, core
from ..read import working_space
from ..read.image_pixels import colorspace_note, linear_pixels
from ..read.measured_size import scale_since_measured
from ..read.node_values import linked_node
from ..read.scene_reading import Skin
from ..show.image_pairs import read_pixels
from ..show.skin_material import skin_input, skin_node, skin_nodes
from .exr_writing import write_exr
from .povray_writing import SceneFiles, float_image

THICKNESS_FILE = "thickness.exr"
#: First bytes of files whose colors POV-Ray decodes as Blender does, and how it wants their names to end.
READ_ALIKE = {b"\x89PNG\r\n\x1a\n": "png", b"\xff\xd8\xff": "jpg"}
#: What a PNG says of its own colors: POV-Ray listens to it, Blender goes by the image's color space.
PNG_WORDS = (b"gAMA", b"cHRM", b"sRGB", b"iCCP", b"cICP")
#: Bits of a pixel of gray and RGB, of bytes.
DEPTHS_WITHOUT_ALPHA = (8, 24)
#: Shaders whose color POV-Ray shows as a matt surface, and the name of its input.
BASE_COLORS = {"ShaderNodeBsdfPrincipled": "Base Color", "ShaderNodeBsdfDiffuse": "Color"}


class Pictures(NamedTuple):
    """What the materials add to a scene."""

    arguments: dict[str, Any]  #: of the core's povray_files
    uv_map: str  #: that the pictures lie in; "": there are none
    notes: list[str]  #: what is not exported


class _NotExportedError(Exception):
    """Why something is not exported."""


def pictures_of(
    obj: bpy.types.Object,
    skin: Skin,
    files: SceneFiles,
    frame: int,
    *,
    surface: bool,
    by_thickness: bool,
    varies: bool,
) -> Pictures:
    """Reads the materials, and writes their pictures.

    surface       whether the surface is exported
    by_thickness  whether the glow depends on thickness, which may be a picture
    varies        whether it depends on the position too, so that the picture cannot be looked up
    """
    found = _surface(obj, files.folder) if surface else Pictures({}, "", [])
    arguments, uv_map, notes = found
    if by_thickness:
        try:
            thickness, uv_map = _thickness(obj, skin, files, frame, uv_map, varies)
            arguments |= thickness
        except _NotExportedError as reason:
            notes.append(
                f"'{obj.name}': Thickness of the Skinglow node {reason}, which is not exported: POV-Ray shows the "
                "measured one"
            )
    notes += [
        f"'{obj.name}': {name} of the Skinglow node is not exported: POV-Ray shows the glow without it"
        for name in ("Mask", "Tint", "Strength")
        if not all(_is_one(socket) for socket in _inputs(obj, name))
    ]
    return Pictures(arguments, uv_map, notes)


def _is_one(socket: bpy.types.NodeSocket) -> bool:
    return linked_node(socket) is None and np.all(np.array(socket.default_value) == 1.0)


def _inputs(obj: bpy.types.Object, name: str) -> list[bpy.types.NodeSocket]:
    """That input of every Skinglow node of the object."""
    nodes = [node for material in materials_of_skin(obj) for node in skin_nodes(material)]
    return [socket for node in nodes if (socket := skin_input(node, name)) is not None]


def materials_of_skin(obj: bpy.types.Object) -> list[bpy.types.Material]:
    """The materials of the object that have the Skinglow node."""
    return [m for m in dict.fromkeys(slot.material for slot in obj.material_slots) if m is not None and skin_node(m)]


def glowing_slots(obj: bpy.types.Object) -> list[bool]:
    """Whether the material of each slot adds light."""
    materials = [slot.material for slot in obj.material_slots]
    nodes = [skin_node(material) if material is not None else None for material in materials]
    return [node is not None and not node.mute for node in nodes]


def _surface(obj: bpy.types.Object, folder: Path) -> Pictures:
    """The surface's base color or texture."""
    socket = next(filter(None, map(_base_color, materials_of_skin(obj))), None)
    if socket is None:
        note = (
            f"'{obj.name}': its surface has no Principled or Diffuse BSDF, and is not exported: there is only the glow"
        )
        return Pictures({}, "", [note])
    source = linked_node(socket)
    if source is None:
        return Pictures({"surface_color": _rest_color(socket)}, "", [])
    try:
        image = _image_of(source)
        uv_map = _uv_map(obj, source)
        name, told = _write_picture(image, folder, source.outputs["Alpha"], socket.node.inputs.get("Alpha"))
        return Pictures({"surface_image": name}, uv_map, [f"'{obj.name}': {note}" for note in told])
    except _NotExportedError as reason:
        note = f"'{obj.name}': the base color {reason}, which is not exported: POV-Ray shows the color behind the link"
        return Pictures({"surface_color": _rest_color(socket)}, "", [note])


def _base_color(material: bpy.types.Material) -> bpy.types.NodeSocket | None:
    tree = blender_version.shader_tree(material)
    shader = next((node for node in tree.nodes if node.bl_idname in BASE_COLORS), None) if tree else None
    return shader.inputs[BASE_COLORS[shader.bl_idname]] if shader else None


def _thickness(
    obj: bpy.types.Object, skin: Skin, files: SceneFiles, frame: int, uv_map: str, varies: bool
) -> tuple[dict[str, Any], str]:
    """A picture of the thickness, where the Skinglow node has one, and its UV map.

    uv_map  of the surface's picture: a mesh has one set of coordinates in POV-Ray
    """
    sockets = _inputs(obj, "Thickness")
    if all(linked_node(socket) is None and socket.default_value < 0.0 for socket in sockets):
        return {}, uv_map
    if varies:
        raise _NotExportedError("is given to a skin that is lit per pixel")
    sources = {_scaled_image(socket) for socket in sockets}
    if len(sources) != 1 or not all(glowing_slots(obj)):
        raise _NotExportedError("is not the same in all of its slots")
    node, factor = sources.pop()
    image, own_map = _image_of(node), _uv_map(obj, node)
    if uv_map and own_map != uv_map:
        raise _NotExportedError(f"is the picture '{image.name}' in another UV map than that of the base color")
    if not image.colorspace_settings.is_data:
        raise _NotExportedError(f"is the picture '{image.name}', which is read as colors and not as Non-Color data")
    if not image.has_data:
        len(image.pixels)  # reads the file
    if not image.has_data:
        raise _NotExportedError(f"is the picture '{image.name}', whose file is missing")
    colors = read_pixels(image)[:, :, :3]
    if (colors < 0.0).any():
        raise _NotExportedError(f"is the picture '{image.name}', which leaves it to the measured one in parts")
    mm = core().luminance(colors)  # as Blender uses a color as a number
    scale = factor * scale_since_measured(obj.data, skin.world_size)
    name = files.write(THICKNESS_FILE, float_image(np.repeat(mm[..., None], 3, axis=2), files.folder), frame)
    return {"thickness_image": name, "thickness_range": (0.0, scale)}, own_map


def _scaled_image(socket: bpy.types.NodeSocket) -> tuple[bpy.types.Node, float]:
    """The node linked to a socket and a factor on it: the mm of white, where a picture holds fractions."""
    node = linked_node(socket)
    if node is None:
        raise _NotExportedError(f"is {socket.default_value:g} mm")
    if node.bl_idname == "ShaderNodeMath" and node.operation == "MULTIPLY" and not node.use_clamp:
        for factor, image in ((0, 1), (1, 0)):
            source = linked_node(node.inputs[image])
            if linked_node(node.inputs[factor]) is None and source is not None:
                return source, node.inputs[factor].default_value
    return node, 1.0


def _image_of(node: bpy.types.Node) -> bpy.types.Image:
    """The image of a texture that POV-Ray can show."""
    if node.bl_idname != "ShaderNodeTexImage" or node.image is None or node.projection != "FLAT":
        raise _NotExportedError(f"comes from the node '{node.name}'")
    if node.image.source not in ("FILE", "GENERATED"):
        kind = {"TILED": "is a picture in tiles (UDIM)", "SEQUENCE": "is a sequence of pictures"}
        raise _NotExportedError(f"{kind.get(node.image.source, 'is a movie')} '{node.image.name}'")
    return node.image


def _uv_map(obj: bpy.types.Object, node: bpy.types.Node) -> str:
    """The UV map in which a texture lies."""
    layers = obj.data.uv_layers
    source = linked_node(node.inputs["Vector"])
    name = ""
    if source is not None and source.bl_idname == "ShaderNodeUVMap":
        name = source.uv_map
    elif source is not None:
        output = next(link.from_socket for link in node.inputs["Vector"].links)
        if source.bl_idname != "ShaderNodeTexCoord" or output.name != "UV":
            raise _NotExportedError(f"lies where the node '{source.name}' says")
    layer = layers.get(name) if name else next((each for each in layers if each.active_render), layers.active)
    if layer is None:
        raise _NotExportedError(f"is the picture '{node.image.name}' in a UV map that the mesh does not have")
    return layer.name


def _rest_color(socket: bpy.types.NodeSocket) -> tuple[float, ...]:
    color = working_space.to_rec709(np.array(socket.default_value)[:3])
    return tuple(color.clip(0.0).tolist())


def _write_picture(
    image: bpy.types.Image, folder: Path, alpha: bpy.types.NodeSocket, shader_alpha: bpy.types.NodeSocket | None
) -> tuple[str, list[str]]:
    """Puts an image into the folder so that POV-Ray shows it as Blender does; its name there, and notes.

    alpha         that output of its texture: where it is linked, Blender does not multiply the colors by it
    shader_alpha  that input of the shader: where the one is linked to the other, holes in the picture are holes
    POV-Ray goes by a name's ending, knows few formats, takes 8 bits of a TIFF for linear and what has alpha for
    transparent. So a file is taken as it is where both programs read the same of it, else its colors as an EXR.
    """
    told = [f"the base color: {note}"] if (note := colorspace_note(image)) else []
    if image.is_dirty and image.source == "FILE" and image.packed_file is None:
        told.append(
            f"the picture '{image.name}' has edits that are not in its file: POV-Ray shows them, Cycles' final renders "
            "do not before it is saved"
        )
    content = b"" if image.is_dirty or image.is_float else _file_of(image)
    ending = next((ending for first, ending in READ_ALIKE.items() if content.startswith(first)), "")
    if image.source == "GENERATED" and not image.is_float:
        ending = "png"
    has_holes = any(link.to_socket == shader_alpha for link in alpha.links)
    alike = ending and image.colorspace_settings.name == "sRGB"
    if has_holes and not alike and not _is_opaque(image):
        told.append(f"the alpha of the picture '{image.name}' is not exported: save it as PNG, and read it as sRGB")
    if not (alike and (has_holes or _is_opaque(image))):
        ending = ""
    path = folder / f"surface.{ending or 'exr'}"
    if path.exists():
        return path.name, told  # of an earlier frame
    if ending:
        if content:
            path.write_bytes(_without_words(content) if ending == "png" else content)
        else:
            _write_generated(image, path)
        return path.name, told
    try:
        pixels = linear_pixels(image, shown=not alpha.is_linked)
    except SkinError as error:
        raise _NotExportedError(f"is the picture '{image.name}', whose file is missing") from error
    colors = np.repeat(pixels[:, :, :1], 3, axis=2) if pixels.shape[2] < 3 else pixels[:, :, :3]
    if image.colorspace_settings.is_data:
        colors = working_space.to_rec709(colors)  # shaders take numbers for colors of the working space
    write_exr(path, colors)
    return path.name, told


def _file_of(image: bpy.types.Image) -> bytes:
    """The bytes of an image's packed or external file; none if there is no such file."""
    if image.packed_file is not None:
        return image.packed_file.data
    path = Path(bpy.path.abspath(image.filepath, library=image.library))
    return path.read_bytes() if image.source == "FILE" and path.is_file() else b""


def _without_words(png: bytes) -> bytes:
    """A PNG without the chunks that say what its colors are; POV-Ray takes it for sRGB then."""
    kept, at = [png[:8]], 8
    while at + 8 <= len(png):
        end = at + 12 + int.from_bytes(png[at : at + 4], "big")
        if png[at + 4 : at + 8] not in PNG_WORDS:
            kept.append(png[at:end])
        at = end
    return b"".join(kept)


def _is_opaque(image: bpy.types.Image) -> bool:
    if image.depth in DEPTHS_WITHOUT_ALPHA:
        return True
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    return image.channels < 4 or bool((pixels[3::4] >= 1.0).all())


def _write_generated(image: bpy.types.Image, path: Path) -> None:
    """Saves bytes that have no file; a copy of the datablock would have lost what was painted."""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    copy = bpy.data.images.new(".Skinglow export", *image.size, alpha=True)
    try:
        copy.colorspace_settings.name = image.colorspace_settings.name
        copy.pixels.foreach_set(pixels)
        copy.file_format, copy.filepath_raw = "PNG", str(path)
        copy.save()
    finally:
        bpy.data.images.remove(copy)
