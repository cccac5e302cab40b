# SPDX-License-Identifier: GPL-3.0-or-later
"""The Lights panel: the contribution of each light to the skin, or why it has none."""

import bpy

from ..commands.skin import table_of
from ..identity import key_of
from ..live.shape_update import ShapeReport, shape_report
from . import light_list
from .locations import InObjectProperties, InSidebar, SkinPanel
from .progress_bar import draw_progress
from .wrapped_text import draw_wrapped

MIN_ROWS = 4
MAX_ROWS = 12


class SKINGLOW_UL_lights(bpy.types.UIList):  # noqa: N801  Blender's naming
    """One light per row: a color swatch and its fraction of the light, or why it contributes nothing."""

    bl_idname = "SKINGLOW_UL_lights"

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _lights: light_list.LightList,
        row: light_list.LightRow,
        _icon: int,
        _active_data: light_list.LightList,
        _active_property: str,
        *_more: int,
    ) -> None:
        line = layout.row(align=True)
        if row.reason:
            line.active = False
            parts = line.split(factor=0.5, align=True)
            parts.label(text=row.name, icon=_icon_of(row.kind))
            parts.label(text=row.reason)
        else:
            line.label(text=row.name, icon=_icon_of(row.kind))
            _column(line, 1.0).prop(row, "swatch", text="")
            fraction = _column(line, 2.0)
            fraction.alignment = "RIGHT"
            fraction.label(text="<1%" if 0.0 < row.share < 0.01 else f"{row.share:.0%}")
        if row.kind == "WORLD":
            return
        button = line.operator("skinglow.select_light", text="", icon="RESTRICT_SELECT_OFF", emboss=False)
        button.key, button.light = row.object, row.name


class _Lights(SkinPanel):
    bl_label = "Lights"

    def draw(self, context: bpy.types.Context) -> None:
        draw_lights(self.layout, context.object, context)


class SKINGLOW_PT_sidebar_lights(_Lights, InSidebar, bpy.types.Panel):  # noqa: N801
    """In the sidebar."""


class SKINGLOW_PT_object_lights(_Lights, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


def _column(line: bpy.types.UILayout, units: float) -> bpy.types.UILayout:
    column = line.row(align=True)
    column.ui_units_x = units
    return column


def draw_lights(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    """The list, and the details of the active light below."""
    if obj.skinglow.mode == "EXISTING":
        layout.label(text="Fixed mode ignores the lights", icon="INFO")
        return
    if obj.skinglow.mode == "PHYSICAL":
        _draw_lighting(layout, obj, context)
    lights = light_list.list_of(obj, context)
    if lights is None:
        layout.label(text="Updating lights...", icon="LIGHT")
        return
    if not lights.rows:
        layout.label(text="No lights in this scene", icon="LIGHT")
        return
    rows = min(max(len(lights.rows), MIN_ROWS), MAX_ROWS)
    layout.template_list(
        SKINGLOW_UL_lights.bl_idname, key_of(obj), lights, "rows", lights, "active", rows=rows, maxrows=MAX_ROWS
    )
    if 0 <= lights.active < len(lights.rows):
        _draw_details(layout, lights.rows[lights.active], obj.skinglow.mode == "PHYSICAL", context)


def _icon_of(kind: str) -> str:
    return "WORLD" if kind == "WORLD" else f"LIGHT_{kind}"


def _draw_lighting(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    """How a skin in Physical mode is lit."""
    column = layout.column(align=True)
    column.use_property_split, column.use_property_decorate = True, False
    column.prop(obj.skinglow, "weights")
    report = shape_report(obj)
    if report is not None:
        column.prop(obj.skinglow, "cell_mm")
        column.prop(obj.skinglow, "reentries")
        _draw_shape(column, report, context)
    table = table_of(obj, context.view_layer.depsgraph)
    if table is not None and table.bound is not None:
        off = f"up to {table.bound:.0%}" if table.bound < 1.0 else "more than 100%"
        draw_wrapped(column, f"Per Object would be {off} off here", context, "INFO")
    column.prop(context.scene.skinglow, "occlusion")


def _draw_shape(column: bpy.types.UILayout, report: ShapeReport, context: bpy.types.Context) -> None:
    """How the light of a skin through its shape was found."""
    if report.reason is not None:
        draw_wrapped(column, f"Lit per pixel: {report.reason.why}", context, "ERROR")
        return
    if report.progress is not None:
        draw_progress(column.row(), f"Solving: {report.progress:.0%}", report.progress)
    if report.shown == "TABLE":
        draw_wrapped(column, "The lookup by thickness stands in until light is solved", context, "INFO")
        return
    solved = f"{report.ready_parts} of {report.parts} thin parts solved"
    if report.ready_parts < report.parts:
        solved += ", no light falls on the others"
    draw_wrapped(column, solved, context, "MESH_DATA")
    draw_wrapped(column, f"{report.cells:,} cells, {report.bytes / 1e6:.0f} MB", context, "BLANK1")
    first = f"The first light took {report.first_seconds:.1f} s, as each frame takes in which the mesh deforms"
    draw_wrapped(column, first, context, "BLANK1")
    # What making the body ready took is no light's.
    if report.milliseconds is not None:
        draw_wrapped(column, f"The last light took {report.milliseconds:.0f} ms", context, "BLANK1")
    if report.error:
        error = ", ".join(f"{part:.0%}" if part < 1.0 else "100% or more" for part in report.error)
        draw_wrapped(column, f"Estimated error {error} (R, G, B)", context, "BLANK1")
    if report.thick_points:
        share = report.thick_points / report.points
        draw_wrapped(column, f"{share:.0%} of the skin shown is too thick for light to come through", context, "BLANK1")


def _draw_details(
    layout: bpy.types.UILayout, row: light_list.LightRow, physical: bool, context: bpy.types.Context
) -> None:
    column = layout.column(align=True)
    if row.reason:
        draw_wrapped(column, f"No light from {row.name}: {row.reason}", context, icon="INFO")
    else:
        numbers = "  ".join(f"{part:.3g}" for part in row.weight)
        column.label(text=row.name, icon=_icon_of(row.kind))
        column.label(text=f"RGB  {numbers}{' W/m^2' if physical else ''}", icon="BLANK1")
        distant = {"SUN": "at infinite distance", "WORLD": "from all directions"}
        where = distant.get(row.kind, f"at a distance of {length_text(row.distance, context.scene)}")
        draw_wrapped(column, f"{row.share:.1%} of all light, {where}", context, icon="BLANK1")
    if row.note:
        draw_wrapped(column, row.note, context, icon="ERROR")


def length_text(length: float, scene: bpy.types.Scene) -> str:
    """A length of the scene as Blender writes it, in the units of the scene."""
    units = scene.unit_settings
    text = bpy.utils.units.to_string(units.system, "LENGTH", length * units.scale_length, precision=4)
    return text if units.system != "NONE" else f"{length:.4g}"


CLASSES = (SKINGLOW_UL_lights, SKINGLOW_PT_sidebar_lights, SKINGLOW_PT_object_lights)
