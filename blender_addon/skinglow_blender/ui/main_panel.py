# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel Skinglow: what is wrong, the lookup, and buttons; and the order of its subpanels."""

import bpy

from ..commands.health import BY_HAND, FREEZE_AGAIN, FREEZE_MORE, MEASURE_APPLIED
from ..commands.material_health import CHOOSE_SHOWN_BY
from ..identity import key_of
from ..preferences import follows_lights
from ..read.measured_geometry import unit_mm
from ..session import SESSION
from ..show.frozen import is_frozen
from . import (
    freeze_panel,
    lights_panel,
    look_panel,
    lookup_table_panel,
    material_panel,
    thickness_faults,
    thickness_panel,
    tools_panel,
)
from .locations import ObjectProperties, Sidebar, is_skin
from .lut_preview import icon_of
from .manual import draw_in_header
from .material_panel import draw_shown_by
from .progress_bar import draw_progress
from .wrapped_text import draw_wrapped


class _Main:
    bl_label = "Skinglow"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        draw_in_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        obj = context.object
        _draw_faults_of_update(layout, obj, context)
        if SESSION.measuring is not None:
            _draw_progress(layout)
        if not is_skin(obj):
            _draw_start(layout, obj, context)
            return
        _draw_faults(layout, obj, context)
        row = layout.row()
        icon, thickness_mm = icon_of(obj, context.view_layer.depsgraph)
        if icon:
            row.template_icon(icon_value=icon, scale=3.0)
        column = row.column(align=True)
        column.label(text=f"0 to {thickness_mm:.3g} mm" if icon else "No lookup yet")
        if is_frozen(obj.skinglow.group):
            column.label(text="Frozen", icon="FREEZE")
            return
        column.prop(obj.skinglow, "live", toggle=True)
        column.operator("skinglow.update", text="Update Now")
        if not follows_lights():
            text = "Lights are not followed: see Follow the Lights in the preferences of the add-on"
            draw_wrapped(layout.column(align=True), text, context, icon="INFO")


def _draw_faults_of_update(
    layout: bpy.types.UILayout, obj: bpy.types.Object | None, context: bpy.types.Context
) -> None:
    """What went wrong in the last update or render: with this object or as a whole, and the way to other skins with
    faults.
    """
    shown, told = ("*", key_of(obj) if obj is not None else ""), SESSION.told()
    for fault in [told[key] for key in shown if key in told]:
        box = layout.box()
        box.alert = True
        draw_wrapped(box.column(align=True), fault, context, icon="ERROR")
    others = len(told.keys() - set(shown))
    if others:
        row = layout.row()
        row.alert = True
        text = "Select Another Skin with a Fault" if others == 1 else f"Select One of {others} Skins with Faults"
        row.operator("skinglow.select_faulty", text=text, icon="ERROR")


def _draw_faults(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    faults = thickness_faults.shown_faults(obj, context)
    if not faults:
        return
    box = layout.box()
    column = box.column(align=True)
    for fault in faults:
        # What no button does; Repair measures, but applies no modifier.
        text = str(fault) if fault.remedy in {*BY_HAND, MEASURE_APPLIED} else fault.what
        draw_wrapped(column, text, context, icon="INFO" if fault.is_hint else "ERROR")
    remedies = {fault.remedy for fault in faults if not fault.is_hint}
    if remedies - {FREEZE_AGAIN, FREEZE_MORE} - BY_HAND:
        box.operator("skinglow.repair", text="Repair", icon="FILE_REFRESH")
    elif remedies & {FREEZE_AGAIN, FREEZE_MORE}:
        box.operator("skinglow.unfreeze", text="Unfreeze", icon="LIGHT_SUN")
    if any(fault.remedy == CHOOSE_SHOWN_BY for fault in faults):
        box.label(text="Light Shown By:")
        draw_shown_by(box.row(align=True), "BOTH")


def _draw_start(layout: bpy.types.UILayout, obj: bpy.types.Object | None, context: bpy.types.Context) -> None:
    button = layout.row()
    button.scale_y = 1.5
    button.operator("skinglow.make", icon="LIGHT_SUN")
    if obj is None or obj.type != "MESH":
        draw_wrapped(layout.column(align=True), "Select a mesh to make glow", context, icon="INFO")
        return
    column = layout.column(align=True)
    column.use_property_split, column.use_property_decorate = True, False
    column.prop(obj.skinglow, "unit_mm", text="Unit")
    across = max(obj.dimensions) * unit_mm(obj, context.scene)
    column.label(text=f"{obj.name} is {across:.4g} mm across", icon="DRIVER_DISTANCE")


def _draw_progress(layout: bpy.types.UILayout) -> None:
    measuring = SESSION.measuring
    row = layout.row(align=True)
    text = "Canceling" if measuring.canceled else f"Measuring: {measuring.done:.0%}"
    draw_progress(row, text, measuring.done)
    row.operator("skinglow.cancel_measuring", text="", icon="CANCEL")


class SKINGLOW_PT_sidebar(_Main, Sidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object(_Main, ObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""

    bl_options = {"DEFAULT_CLOSED"}


CLASSES = (
    SKINGLOW_PT_sidebar,
    SKINGLOW_PT_object,
    *look_panel.CLASSES,
    *material_panel.CLASSES,
    *lights_panel.CLASSES,
    *thickness_panel.CLASSES,
    *lookup_table_panel.CLASSES,
    *freeze_panel.CLASSES,
    *tools_panel.CLASSES,
)


def register() -> None:
    """Adds the panels, each below the one before."""
    for each in CLASSES:
        bpy.utils.register_class(each)
    thickness_faults.register()


def unregister() -> None:
    """Removes the panels."""
    thickness_faults.unregister()
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
