# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a material of skins: a property group on every material, `material.skinglow`.

Files store settings by property name: names must not change, labels may.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty, StringProperty

from ..read.file_skins import skins_of_file
from .mask import fill_mask, remove_mask_nodes, store_masks
from .skin_material import insert, remove_from_material, skin_node
from .subsurface import follow_sockets, restore_subsurface

MASKS = (
    ("NONE", "None", "Light comes through everywhere"),
    ("VERTEX_GROUP", "Vertex Group", "By the weights of a vertex group"),
    ("IMAGE", "Image", "By the brightness of an image, in the mesh's own UV map"),
)


def _skin_chosen(settings: "MaterialSettings", _context: bpy.types.Context) -> None:
    material = settings.id_data
    if not settings.is_skin:
        clear_material(material)
        return
    skins = _skins_with(material)
    group = next((obj.skinglow.group for obj in skins if obj.skinglow.group is not None), None)
    if group is not None and skin_node(material) is None:
        insert(material, group)
        _mask_changed(settings, _context)


def _mask_changed(settings: "MaterialSettings", _context: bpy.types.Context) -> None:
    fill_mask(settings.id_data)
    follow_sockets(settings.id_data)
    for obj in _skins_with(settings.id_data):
        store_masks(obj)


def _skins_with(material: bpy.types.Material) -> list[bpy.types.Object]:
    return [obj for obj in skins_of_file() if any(slot.material == material for slot in obj.material_slots)]


class MaterialSettings(bpy.types.PropertyGroup):
    """The settings of a material of skins."""

    is_skin: BoolProperty(
        name="Skin",
        default=True,
        update=_skin_chosen,
        options=set(),
        description="Let light shine through the faces with this material; not for eyes, teeth and hair",
    )
    mask: EnumProperty(
        name="Mask",
        items=MASKS,
        default="NONE",
        update=_mask_changed,
        options=set(),
        description="What limits where light comes through; fills the Mask socket of the Skinglow node",
    )
    mask_group: StringProperty(
        name="Vertex Group",
        update=_mask_changed,
        options=set(),
        description="Light comes through by the weights of this vertex group; where the mesh has none, nowhere",
    )
    mask_image: PointerProperty(
        name="Image",
        type=bpy.types.Image,
        update=_mask_changed,
        description="Light comes through by the brightness of this image: white all, black none",
    )


def clear_material(material: bpy.types.Material) -> None:
    """Removes everything that was added to a material's nodes."""
    restore_subsurface(material)
    remove_mask_nodes(material)
    remove_from_material(material)


def reset_material(material: bpy.types.Material) -> None:
    """Resets a material's settings to their defaults, without a word to its nodes."""
    for name in MaterialSettings.__annotations__:
        material.skinglow.property_unset(name)


def register() -> None:
    """Adds the properties to Blender's materials."""
    bpy.utils.register_class(MaterialSettings)
    bpy.types.Material.skinglow = PointerProperty(type=MaterialSettings, name="Skin Glow")


def unregister() -> None:
    """Removes the properties; values stored in files remain there."""
    del bpy.types.Material.skinglow
    bpy.utils.unregister_class(MaterialSettings)
