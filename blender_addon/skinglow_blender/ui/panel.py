# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel and its subpanels, both in the sidebar of the 3D Viewport and in the Object properties."""

import bpy

from ..commands.health import quick_faults
from ..live.live_update import STATE
from ..read.measured_geometry import unit_mm
from .light_list_panel import SKINGLOW_UL_lights, draw_lights
from .lut_preview import icon_of
from .measuring_operators import measuring_now
from .skin_panel import draw_look, draw_lookup, draw_thickness
from .wrapped_text import draw_wrapped


def is_skin(obj: bpy.types.Object | None) -> bool:
    """Whether the object is a skin to show in the panel."""
    return obj is not None and obj.type == "MESH" and obj.skinglow.enabled


class _Main:
    bl_label = "Skinglow"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        obj = context.object
        for fault in STATE.faults.values():
            box = layout.box()
            box.alert = True
            draw_wrapped(box.column(align=True), fault, context, icon="ERROR")
        if measuring_now() is not None:
            _draw_progress(layout)
        if not is_skin(obj):
            _draw_start(layout, obj, context)
            return
        _draw_faults(layout, obj, context)
        row = layout.row()
        icon = icon_of(obj, context.view_layer.depsgraph)
        if icon:
            row.template_icon(icon_value=icon, scale=3.0)
        column = row.column(align=True)
        column.label(text=f"0 to {obj.skinglow.max_thickness_mm:.4g} mm")
        column.prop(obj.skinglow, "live", toggle=True)
        column.operator("skinglow.update", text="Update Now")


def _draw_faults(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    faults = quick_faults(obj)
    if not faults:
        return
    box = layout.box()
    column = box.column(align=True)
    for fault in faults:
        draw_wrapped(column, fault.what, context, icon="ERROR")
    box.operator("skinglow.repair", text="Repair", icon="FILE_REFRESH")


def _draw_start(layout: bpy.types.UILayout, obj: bpy.types.Object | None, context: bpy.types.Context) -> None:
    button = layout.row()
    button.scale_y = 1.5
    button.operator("skinglow.make", icon="LIGHT_SUN")
    if obj is None or obj.type != "MESH":
        draw_wrapped(layout.column(align=True), "Select a mesh to make glow", context, icon="INFO")
        return
    column = layout.column(align=True)
    column.use_property_split, column.use_property_decorate = True, False
    column.prop(obj.skinglow, "unit_mm", text="Unit (mm)")
    across = max(obj.dimensions) * unit_mm(obj, context.scene)
    column.label(text=f"{obj.name} is {across:.4g} mm across", icon="DRIVER_DISTANCE")


def _draw_progress(layout: bpy.types.UILayout) -> None:
    measuring = measuring_now()
    row = layout.row(align=True)
    text = "Canceling" if measuring.canceled else f"Measuring: {measuring.done:.0%}"
    if hasattr(row, "progress"):
        row.progress(factor=measuring.done, text=text)
    else:
        row.label(text=text, icon="SORTTIME")
    row.operator("skinglow.cancel_measuring", text="", icon="CANCEL")


class _Part:
    """A subpanel that is shown for skins only."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_skin(context.object)


class _Look(_Part):
    bl_label = "Look"

    def draw(self, context: bpy.types.Context) -> None:
        draw_look(self.layout, context.object.skinglow)


class _Lights(_Part):
    bl_label = "Lights"

    def draw(self, context: bpy.types.Context) -> None:
        draw_lights(self.layout, context.object, context)


class _Thickness(_Part):
    bl_label = "Thickness"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_thickness(self.layout, context.object, context)


class _Lookup(_Part):
    bl_label = "Lookup Table"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_lookup(self.layout, context.object.skinglow)


class _Export(_Part):
    bl_label = "Export"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.operator("skinglow.export_povray", text="POV-Ray Scene", icon="EXPORT")


class _Remove(_Part):
    bl_label = "Reset and Remove"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        row = self.layout.row(align=True)
        row.operator("skinglow.reset", text="Reset", icon="LOOP_BACK")
        row.operator("skinglow.remove", text="Remove", icon="TRASH")


#: Where the panels are shown: name and Blender's attributes.
LOCATIONS = (
    ("sidebar", {"bl_space_type": "VIEW_3D", "bl_region_type": "UI", "bl_category": "Skinglow"}),
    ("object", {"bl_space_type": "PROPERTIES", "bl_region_type": "WINDOW", "bl_context": "object"}),
)
PARTS = (_Look, _Lights, _Thickness, _Lookup, _Export, _Remove)


def _panel_classes() -> list[type]:
    made = []
    for location, attributes in LOCATIONS:
        main = f"SKINGLOW_PT_{location}"
        closed = {"bl_options": {"DEFAULT_CLOSED"}} if location == "object" else {}
        made.append(type(main, (_Main, bpy.types.Panel), {**attributes, **closed, "bl_idname": main}))
        for part in PARTS:
            name = f"{main}{part.__name__.lower()}"
            made.append(type(name, (part, bpy.types.Panel), {**attributes, "bl_idname": name, "bl_parent_id": main}))
    return made


CLASSES = (SKINGLOW_UL_lights, *_panel_classes())


def register() -> None:
    """Adds the panels."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the panels."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
