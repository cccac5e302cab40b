# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, in the 3D view's sidebar and in the object's properties."""

import bpy

from .live_update import STATE

TISSUE = (
    "preset",
    "melanin_fraction",
    "blood_fraction",
    "oxygen_saturation",
    "epidermal_thickness_mm",
    "scattering_scale",
    "cartilage_fraction",
    "refractive_index",
)


def draw_skin(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """One button for a mesh that is no skin yet; for a skin what its mode asks for, and no more."""
    obj = context.object
    if obj is None or obj.type != "MESH":
        layout.label(text="Select a mesh", icon="INFO")
        return
    settings = obj.skinglow
    if not settings.enabled:
        layout.operator("skinglow.make_skin", icon="LIGHT_SUN")
        return
    fault = STATE.faults.get(obj.name_full)
    if fault is not None:
        box = layout.box()
        box.alert = True
        for line in fault.split(": "):
            box.label(text=line, icon="ERROR" if fault.startswith(line) else "NONE")
    layout.use_property_split = True
    layout.prop(settings, "mode")
    layout.prop(settings, "strength")
    column = layout.column()
    if settings.mode == "PHYSICAL":
        for name in TISSUE:
            column.prop(settings, name)
    elif settings.mode == "PAPER":
        column.prop(settings, "base")
        if settings.base == "IMAGE":
            column.prop(settings, "base_image")
        column.prop(settings, "blood_weight")
        column.prop(settings, "attenuation")
    column = layout.column(heading="Lookup")
    for name in ("size", "max_thickness_mm", "unit_mm", "min_openness", "reference"):
        column.prop(settings, name)
    if settings.reference == "POINT":
        column.prop(settings, "reference_point")
    row = layout.row()
    row.prop(settings, "live", toggle=True)
    row.operator("skinglow.update", icon="FILE_REFRESH")
    row = layout.row()
    row.operator("skinglow.export_povray", icon="EXPORT")
    row.operator("skinglow.remove", icon="X")


class SKINGLOW_PT_sidebar(bpy.types.Panel):
    bl_label = "Skinglow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Skinglow"

    def draw(self, context: bpy.types.Context) -> None:
        draw_skin(self.layout, context)


class SKINGLOW_PT_object(bpy.types.Panel):
    bl_label = "Skinglow"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"

    def draw(self, context: bpy.types.Context) -> None:
        draw_skin(self.layout, context)


CLASSES = (SKINGLOW_PT_sidebar, SKINGLOW_PT_object)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
