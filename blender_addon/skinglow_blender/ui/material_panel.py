# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what can be set in the materials of a skin, in the panel of the skin and in the Material properties."""

import bpy

from ..identity import library_of
from ..show.mask import masked_by_artist
from ..show.skin_material import skin_input, skin_node
from ..show.subsurface import SHOWN_BY, has_subsurface, light_shown_by
from .locations import InObjectProperties, InSidebar, SkinPanel, is_skin


class SKINGLOW_UL_slots(bpy.types.UIList):  # noqa: N801  Blender's naming
    """The material slots of a skin, with a box for each that is skin."""

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _data: bpy.types.Object,
        slot: bpy.types.MaterialSlot,
        icon: int,
        _active_data: bpy.types.Object,
        _active_property: str,
    ) -> None:
        """Draws one slot."""
        material = slot.material
        row = layout.row(align=True)
        box = row.row()
        if material is None:
            row.label(text="", icon="BLANK1")
            row.label(text="Empty Slot", icon="MATERIAL")
            return
        box.enabled = library_of(material) is None
        box.prop(material.skinglow, "is_skin", text="")
        row.label(text=material.name, icon_value=icon)
        if light_shown_by(material) == "BOTH":
            row.label(text="", icon="ERROR")


def draw_slots(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """Which slots are skin."""
    if len(obj.material_slots) > 1:
        rows = min(max(len(obj.material_slots), 2), 5)
        layout.template_list(
            "SKINGLOW_UL_slots", "", obj, "material_slots", obj, "active_material_index", rows=rows, maxrows=rows
        )


def draw_material(layout: bpy.types.UILayout, obj: bpy.types.Object, material: bpy.types.Material) -> None:
    """The settings of one material: mask, the sockets of its node, who shows the light."""
    layout.use_property_split, layout.use_property_decorate = True, False
    node = skin_node(material)
    if node is None:
        layout.prop(material.skinglow, "is_skin")
        return
    column = layout.column()
    column.enabled = library_of(material) is None
    _draw_mask(column, obj, material, node)
    column.use_property_decorate = True
    for name in ("Thickness", "Tint", "Strength"):
        _draw_socket(column, node, name)
    if has_subsurface(material):
        _draw_light_shown_by(column, material)


def _draw_mask(
    layout: bpy.types.UILayout, obj: bpy.types.Object, material: bpy.types.Material, node: bpy.types.Node
) -> None:
    if masked_by_artist(node):
        _draw_socket(layout, node, "Mask")
        return
    settings = material.skinglow
    layout.prop(settings, "mask")
    if settings.mask == "VERTEX_GROUP":
        layout.prop_search(settings, "mask_group", obj, "vertex_groups", text="Group")
    elif settings.mask == "IMAGE":
        layout.template_ID(settings, "mask_image", new="image.new", open="image.open")


def _draw_socket(layout: bpy.types.UILayout, node: bpy.types.Node, name: str) -> None:
    socket = skin_input(node, name)
    if socket is None:
        return
    is_measured = name == "Thickness" and socket.default_value < 0.0
    if not socket.is_linked and not is_measured:
        layout.prop(socket, "default_value", text=f"{name} (mm)" if name == "Thickness" else name)
        return
    row = layout.split(factor=0.4)
    label = row.row()
    label.alignment = "RIGHT"
    label.label(text=name)
    row.label(text=f"From {socket.links[0].from_node.name}" if socket.is_linked else "Measured")


def _draw_light_shown_by(layout: bpy.types.UILayout, material: bpy.types.Material) -> None:
    column = layout.column(align=True)
    column.label(text="Light Shown By")
    draw_shown_by(column.row(align=True), light_shown_by(material))


def draw_shown_by(row: bpy.types.UILayout, now: str) -> None:
    """The buttons that choose who shows the light that comes through."""
    for name, text, _description in SHOWN_BY:
        row.operator("skinglow.show_light_by", text=text, depress=now == name).shown_by = name


class _Material(SkinPanel):
    bl_label = "Material"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_slots(self.layout, context.object)
        material = context.object.active_material
        if material is not None:
            draw_material(self.layout, context.object, material)


class SKINGLOW_PT_sidebar_material(_Material, InSidebar, bpy.types.Panel):  # noqa: N801
    """In the sidebar."""


class SKINGLOW_PT_object_material(_Material, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


class SKINGLOW_PT_material_tab(bpy.types.Panel):  # noqa: N801
    """The same in the Material properties."""

    bl_label = "Skinglow"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.material is not None and is_skin(context.object)

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.enabled = context.material.library is None
        self.layout.prop(context.material.skinglow, "is_skin", text="")

    def draw(self, context: bpy.types.Context) -> None:
        if skin_node(context.material) is not None:
            draw_material(self.layout, context.object, context.material)


CLASSES = (
    SKINGLOW_UL_slots,
    SKINGLOW_PT_sidebar_material,
    SKINGLOW_PT_object_material,
    SKINGLOW_PT_material_tab,
)
