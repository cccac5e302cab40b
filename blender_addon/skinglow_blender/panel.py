# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, in the 3D view's sidebar and in the object's properties."""

import bpy

from .light_listing import light_report
from .live_update import STATE
from .lut_preview import icon_of
from .skin_settings import TISSUE_SLIDERS
from .thickness_attribute import unit_mm


class _SkinPanel:
    bl_label = "Skinglow"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        obj = context.object
        _draw_faults(layout)
        if obj is None or obj.type != "MESH" or not obj.skinglow.enabled:
            layout.operator("skinglow.make", icon="LIGHT_SUN")
            if obj is not None and obj.type == "MESH":
                layout.label(text=f"{max(obj.dimensions) * unit_mm(obj, context.scene):.4g} mm across")
                layout.prop(obj.skinglow, "unit_mm")
            return
        _draw_settings(layout, obj.skinglow, context.scene)
        icon = icon_of(obj, context.view_layer.depsgraph)
        if icon:
            layout.template_icon(icon_value=icon, scale=4.0)
        row = layout.row(align=True)
        row.prop(obj.skinglow, "live", toggle=True)
        row.operator("skinglow.update", text="Update now")
        _draw_lamps(layout, obj, context)
        column = layout.column(align=True)
        column.prop(obj.skinglow, "unit_mm")
        column.prop(obj.skinglow, "rays")
        column.prop(obj.skinglow, "min_openness")
        column.operator("skinglow.bake")
        layout.operator("skinglow.export_povray")
        row = layout.row(align=True)
        row.operator("skinglow.reset")
        row.operator("skinglow.remove")


def _draw_faults(layout: bpy.types.UILayout) -> None:
    for fault in STATE.faults.values():
        box = layout.box()
        box.alert = True
        words, line = fault.split(), ""
        icon = "ERROR"
        for word in [*words, ""]:
            if len(line) + len(word) > 44 or not word:
                box.label(text=line.strip(), icon=icon)
                line, icon = "", "BLANK1"
            line += word + " "


def _draw_settings(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, scene: bpy.types.Scene) -> None:
    layout.row().prop(settings, "mode", expand=True)
    layout.prop(settings, "strength")
    if settings.mode == "PAPER":
        layout.prop(settings, "base")
        if settings.base == "IMAGE":
            layout.template_ID(settings, "base_image", open="image.open")
        layout.prop(settings, "blood_weight")
        layout.prop(settings, "attenuation")
    if settings.mode == "PHYSICAL" or (settings.mode == "PAPER" and settings.base == "SKIN"):
        layout.prop(settings, "preset")
        column = layout.column(align=True)
        for name in TISSUE_SLIDERS:
            column.prop(settings, name, slider=True)
    column = layout.column(align=True)
    column.prop(settings, "max_thickness_mm")
    column.prop(settings, "size")
    if settings.mode != "EXISTING":
        layout.prop(settings, "reference")
        if settings.reference == "POINT":
            layout.prop(settings, "reference_point")
    if settings.mode == "PHYSICAL":
        layout.prop(scene.skinglow, "occlusion")


def _draw_lamps(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    if obj.skinglow.mode == "EXISTING":
        return
    box = layout.box()
    graph = context.view_layer.depsgraph
    rows = light_report(obj, graph) if graph is not None else []
    if not rows:
        box.label(text="No lamps in this scene", icon="LIGHT")
    for row in rows:
        line = box.row()
        line.label(text=row["name"], icon="WORLD" if row["kind"] == "WORLD" else f"LIGHT_{row['kind']}")
        if row["reason"]:
            line.label(text=row["reason"])
        else:
            line.label(text=f"{row['share']:.0%}  ({', '.join(f'{w:.3g}' for w in row['weight'])})")


class SKINGLOW_PT_sidebar(_SkinPanel, bpy.types.Panel):  # noqa: N801  Blender's naming
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Skinglow"


class SKINGLOW_PT_object(_SkinPanel, bpy.types.Panel):  # noqa: N801
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


CLASSES = (SKINGLOW_PT_sidebar, SKINGLOW_PT_object)


def register() -> None:
    """Adds the panels."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Takes them away."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
