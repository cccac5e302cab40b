# SPDX-License-Identifier: GPL-3.0-or-later
"""Which material slots are skin, as a setting of the operator that makes skins."""

import bpy
from bpy.props import BoolProperty, StringProperty

from ..identity import library_of


class SlotChoice(bpy.types.PropertyGroup):
    """A material of the objects that an operator acts on."""

    name: StringProperty(name="Material", description="Name of the material")
    is_skin: BoolProperty(
        name="Skin",
        default=True,
        description="Let light shine through the faces with this material; not for eyes, teeth and hair",
    )


def offer(choices: bpy.types.bpy_prop_collection, objects: list[bpy.types.Object]) -> None:
    """Fills an operator's choices with the materials of objects as they are, unless they were chosen."""
    if len(choices):
        return
    materials = dict.fromkeys(slot.material for obj in objects for slot in obj.material_slots)
    for material in materials:
        if material is not None and library_of(material) is None:
            choice = choices.add()
            choice.name, choice.is_skin = material.name, material.skinglow.is_skin


def chosen(choices: bpy.types.bpy_prop_collection, obj: bpy.types.Object) -> list[str] | None:
    """The materials of an object that were chosen; None if none of its materials was offered."""
    names = [slot.material.name for slot in obj.material_slots if slot.material is not None]
    offered = {choice.name: choice.is_skin for choice in choices}
    if not offered.keys() & set(names):
        return None
    return [name for name in names if offered.get(name, False)]


def draw(layout: bpy.types.UILayout, choices: bpy.types.bpy_prop_collection) -> None:
    """A box for each material."""
    if len(choices) < 2:
        return
    column = layout.column(heading="Skin", align=True)
    for choice in choices:
        column.prop(choice, "is_skin", text=choice.name)


def register() -> None:
    """Adds the type of the setting."""
    bpy.utils.register_class(SlotChoice)


def unregister() -> None:
    """Removes it."""
    bpy.utils.unregister_class(SlotChoice)
