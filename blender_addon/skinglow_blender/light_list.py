# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel's lists of lights show, kept between redraws and filled anew after an edit.

Drawing may write nothing, and happens at each move of the pointer. So it only compares stamps, and asks for what is out
of date; a timer fills that a moment later and has the panels drawn again. The lists are the window manager's: they are
no part of anybody's scene, and undo leaves them alone.
"""

from typing import Any

import bpy
from bpy.props import CollectionProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from .errors import SkinError
from .light_listing import light_report
from .live_update import STATE

#: Seconds from a redraw that asked to the filling: as often as this while a lamp is dragged.
DELAY = 0.05

#: By skin: (STATE.looks, scene, view layer) that its list was filled at, and those that drawing asked for.
_filled: dict[str, tuple[int, str, str]] = {}
_wanted: dict[str, tuple[int, str, str]] = {}


class LightRow(bpy.types.PropertyGroup):
    """A lamp's line, from light_listing.light_report."""

    name: StringProperty(name="Light")
    kind: StringProperty()
    share: FloatProperty(name="Share", description="Of all that the lamps bring to this skin, 0 to 1")
    weight: FloatVectorProperty(
        name="Weight",
        size=3,
        precision=4,
        description="Red, green and blue: color times attenuation; in mode physical irradiance, W/m^2",
    )
    distance: FloatProperty(default=-1.0)
    reason: StringProperty()
    note: StringProperty()
    swatch: FloatVectorProperty(
        name="Color",
        subtype="COLOR",
        size=3,
        min=0.0,
        max=1.0,
        get=lambda row: _hue(row.weight),
        description="The color that this lamp brings, at full brightness",
    )


class LightList(bpy.types.PropertyGroup):
    """A skin's lines, the strongest lamp first; named as the skin."""

    rows: CollectionProperty(type=LightRow)
    active: IntProperty(name="Light", description="The lamp whose details stand below the list")


def list_of(obj: bpy.types.Object, context: bpy.types.Context) -> LightList | None:
    """A skin's list as far as it is filled; asks for it to be filled where an edit came since. For draw()."""
    key = obj.name_full
    stamp = (STATE.looks, context.scene.name, context.view_layer.name)
    if _filled.get(key) != stamp:
        _wanted[key] = stamp
        # Without a window there are no timers, and nobody to look.
        if not bpy.app.background and not bpy.app.timers.is_registered(_fill_soon):
            bpy.app.timers.register(_fill_soon, first_interval=DELAY)
    return context.window_manager.skinglow_lists.get(key)


def fill_wanted() -> int:
    """Fills the lists that drawing asked for; how many that were."""
    lists = bpy.context.window_manager.skinglow_lists
    filled = 0
    while _wanted:
        key, stamp = _wanted.popitem()
        obj = next((o for o in bpy.data.objects if o.name_full == key), None)
        layer = _view_layer(*stamp[1:])
        if obj is None or layer is None or layer.depsgraph is None:
            continue
        try:
            rows = light_report(obj, layer.depsgraph)
        except (SkinError, ValueError):
            continue  # the panel shows the fault that the update had
        _fill(lists.get(key) or _new_list(lists, key), rows)
        _filled[key] = stamp
        filled += 1
    return filled


def _fill_soon() -> None:
    if STATE.rendering or not fill_wanted():
        return
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "PROPERTIES"):
                area.tag_redraw()


def _view_layer(scene: str, layer: str) -> bpy.types.ViewLayer | None:
    found = bpy.data.scenes.get(scene)
    return found.view_layers.get(layer) if found is not None else None


def _new_list(lists: bpy.types.bpy_prop_collection, key: str) -> LightList:
    there = {obj.name_full for obj in bpy.data.objects}
    for i in reversed(range(len(lists))):
        if lists[i].name not in there:
            _filled.pop(lists[i].name, None)
            lists.remove(i)
    made = lists.add()
    made.name = key
    return made


def _fill(lights: LightList, rows: list[dict[str, Any]]) -> None:
    chosen = lights.rows[lights.active].name if lights.active < len(lights.rows) else ""
    lights.rows.clear()
    lights.active = 0
    for i, found in enumerate(sorted(rows, key=lambda row: (-row["share"], bool(row["reason"]), row["name"]))):
        row = lights.rows.add()
        for field in ("name", "kind", "share", "weight", "reason", "note"):
            setattr(row, field, found[field])
        row.distance = -1.0 if found["distance"] is None else found["distance"]
        if row.name == chosen:
            lights.active = i


def _hue(weight: bpy.types.bpy_prop_array) -> tuple[float, float, float]:
    brightest = max(*weight, 0.0)
    if brightest == 0.0:
        return 0.0, 0.0, 0.0
    return tuple(max(part, 0.0) / brightest for part in weight)


def register() -> None:
    """Adds the lists to the window manager."""
    bpy.utils.register_class(LightRow)
    bpy.utils.register_class(LightList)
    bpy.types.WindowManager.skinglow_lists = CollectionProperty(type=LightList)


def unregister() -> None:
    """Takes them away with what they hold."""
    if bpy.app.timers.is_registered(_fill_soon):
        bpy.app.timers.unregister(_fill_soon)
    for manager in bpy.data.window_managers:
        manager.property_unset("skinglow_lists")
    del bpy.types.WindowManager.skinglow_lists
    bpy.utils.unregister_class(LightList)
    bpy.utils.unregister_class(LightRow)
    _filled.clear()
    _wanted.clear()
