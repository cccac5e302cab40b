# SPDX-License-Identifier: GPL-3.0-or-later
"""The lists of lights in the panel, cached between redraws and refilled after an edit.

Drawing must not write data, and happens with every mouse move. So it only compares stamps and requests lists that are
out of date; a timer fills them a moment later and redraws the panels. The lists belong to the window manager, so they
are not part of a scene and not affected by undo.
"""

from typing import Any

import bpy
from bpy.props import CollectionProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from ..commands.light_listing import light_report
from ..errors import SkinError
from ..identity import key_of
from ..live.guard import faults_shown
from ..read.scene_reading import SceneReading
from ..session import SESSION

#: Seconds between a request and the update: the update interval while a light is dragged.
DELAY = 0.05


class LightRow(bpy.types.PropertyGroup):
    """The row of a light, from light_listing.light_report."""

    name: StringProperty(name="Light")
    kind: StringProperty()
    share: FloatProperty(name="Fraction", description="Fraction of all light on this skin, 0 to 1")
    weight: FloatVectorProperty(
        name="Light on the Skin",
        size=3,
        precision=4,
        description="Red, green and blue: color times attenuation, or irradiance in W/m^2 in Physical mode",
    )
    distance: FloatProperty(default=-1.0)
    reason: StringProperty()
    note: StringProperty()
    object: StringProperty()
    swatch: FloatVectorProperty(
        name="Color",
        subtype="COLOR",
        size=3,
        min=0.0,
        max=1.0,
        get=lambda row: _hue(row.weight),
        description="Color of the light on this skin, at full brightness",
    )


class LightList(bpy.types.PropertyGroup):
    """The rows of a skin, strongest light first; named after the skin."""

    rows: CollectionProperty(type=LightRow)
    active: IntProperty(name="Light", description="Light whose details are shown below the list")


def list_of(obj: bpy.types.Object, context: bpy.types.Context) -> LightList | None:
    """A skin's list as last filled, or None; requests an update if it is out of date. For draw()."""
    key = key_of(obj)
    stamp = (SESSION.updates, context.scene.name, context.view_layer.name)
    if SESSION.filled_lists.get(key) != stamp:
        SESSION.requested_lists[key] = stamp
        # There are no timers in background mode.
        if not bpy.app.background and not bpy.app.timers.is_registered(_fill_soon):
            bpy.app.timers.register(_fill_soon, first_interval=DELAY)
    return context.window_manager.skinglow_lists.get(key)


def fill_requested() -> int:
    """Fills the requested lists; returns their number."""
    lists = bpy.context.window_manager.skinglow_lists
    filled = 0
    while SESSION.requested_lists:
        key, stamp = SESSION.requested_lists.popitem()
        obj = next((o for o in bpy.data.objects if key_of(o) == key), None)
        layer = view_layer_of(*stamp[1:])
        if obj is None or layer is None or layer.depsgraph is None:
            continue
        try:
            rows = light_report(obj, layer.depsgraph, _last_reading(layer.depsgraph, stamp[0]))
        except (SkinError, ValueError):
            continue  # the panel shows the fault of the update
        _fill(lists.get(key) or _new_list(lists, key), rows)
        SESSION.filled_lists[key] = stamp
        filled += 1
    return filled


def _last_reading(depsgraph: bpy.types.Depsgraph, updates: int) -> SceneReading | None:
    """What the update read for which the list was requested, if it was of that depsgraph: nothing changed since."""
    return SESSION.reading_of(depsgraph) if SESSION.updates == updates else None


def _fill_soon() -> float | None:
    if SESSION.rendering:
        return DELAY
    with faults_shown():
        if fill_requested():
            redraw_panels()
    return None


def redraw_panels() -> None:
    """Redraws the panels of all windows."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "PROPERTIES"):
                area.tag_redraw()


def view_layer_of(scene: str, layer: str) -> bpy.types.ViewLayer | None:
    """The view layer of those names, or None."""
    found = bpy.data.scenes.get(scene)
    return found.view_layers.get(layer) if found is not None else None


def _new_list(lists: bpy.types.bpy_prop_collection, key: str) -> LightList:
    there = {key_of(obj) for obj in bpy.data.objects}
    for i in reversed(range(len(lists))):
        if lists[i].name not in there:
            SESSION.filled_lists.pop(lists[i].name, None)
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
        for field in ("name", "kind", "share", "weight", "reason", "note", "object"):
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
    """Removes the lists and their contents."""
    if bpy.app.timers.is_registered(_fill_soon):
        bpy.app.timers.unregister(_fill_soon)
    for manager in bpy.data.window_managers:
        manager.property_unset("skinglow_lists")
    del bpy.types.WindowManager.skinglow_lists
    bpy.utils.unregister_class(LightList)
    bpy.utils.unregister_class(LightRow)
    SESSION.filled_lists.clear()
    SESSION.requested_lists.clear()
