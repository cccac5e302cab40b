# SPDX-License-Identifier: GPL-3.0-or-later
"""What each light of a scene and its world contribute to a skin, and why they contribute nothing."""

from typing import Any

import bpy
import numpy as np

from ..errors import core
from ..identity import key_of
from ..read.scene_lights import SceneLight, make_light
from ..read.scene_reading import SceneReading, Skin, read_scene, read_skin
from ..read.scene_world import World
from ..session import SESSION
from ..table.lut_layout import MAX_TERMS
from ..table.occlusion import with_visible_fractions
from ..table.skin_tables import Table
from .skin import skin_settings_of, table_of

#: Note of what the nodes of a skin that is lit per pixel, as a library's, have no room for.
NO_NODES = "the skin has no nodes for it: the same all over the skin"
#: Of a large light for whose parts there is no room.
FEW_NODES = "the skin has too few nodes for its size: coarser than it should be"


def light_report(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, reading: SceneReading | None = None
) -> list[dict[str, Any]]:
    """A dict for each light of the depsgraph, for the world, and for each light of the scene that is hidden from it.

    name      of the light object, followed by " in <instancer>" for an instance; of the world
    kind      'POINT', 'SUN', 'SPOT', 'AREA' or 'WORLD'
    weight    (3,) float64: color times attenuation in modes existing and paper; irradiance, W/m^2, in mode physical
    distance  from the skin's reference point, scene units; 0 for a sun and the world, None for a light that is not in
              the depsgraph
    angle     between the light's axis and the reference point, radians; 0 for a point light, a sun and the world,
              None for a light that is not in the depsgraph
    share     fraction of the sum of all weights, 0 to 1
    visible   fraction of its light that other objects let through to the skin's far side, 0 to 1; 1 unless the
              scene's occlusion is on and the mode is physical
    reason    why its weight is zero, or ""
    note      what of it is not supported, or ""
    object    key (identity.key_of) of the object to select for it: of an instance, its instancer; "" for the world

    reading   the scene as it was just read from this depsgraph; None: as the last update read it, if nothing changed
    """
    skin_settings_of(obj)
    evaluated = obj.evaluated_get(depsgraph)
    skin = read_skin(evaluated, evaluated.matrix_world)
    reading = reading or SESSION.reading_of(depsgraph)
    # What stands between a light and a skin that is hidden was not looked at.
    if reading is None or not any(other.key == skin.key for _obj, other in reading.skins):
        reading = with_visible_fractions(read_scene(depsgraph)._replace(skins=[(obj, skin)]), depsgraph, {})
    lights = reading.lights
    table = table_of(obj, depsgraph)
    rows = [_row(skin, light, table) for light in lights]
    if reading.world is not None:
        rows.append(_world_row(skin, reading.world, table))
    total = sum(float(np.sum(row["weight"])) for row in rows)
    for row in rows:
        row["share"] = float(np.sum(row["weight"])) / total if total > 0.0 else 0.0
    # An object that is shown by its instances alone is hidden itself.
    listed = {key_of(light.shown_by) for light in lights if light.shown_by.type == "LIGHT"}
    for other in depsgraph.scene.objects:
        if other.type == "LIGHT" and key_of(other) not in listed:
            hidden = _entry(other.name, other.data.type, reason=_why_hidden(other, depsgraph))
            rows.append(hidden | {"distance": None, "angle": None, "object": key_of(other)})
    return rows


def _entry(name: str, kind: str, reason: str = "", note: str = "") -> dict[str, Any]:
    """A row without a contribution."""
    return {
        "name": name,
        "kind": kind,
        "weight": np.zeros(3),
        "distance": 0.0,
        "angle": 0.0,
        "share": 0.0,
        "visible": 1.0,
        "reason": reason,
        "note": note,
        "object": "",
    }


def _row(skin: Skin, scene_light: SceneLight, table: Table | None) -> dict[str, Any]:
    sg = core()
    visible = scene_light.visible.get(skin.key, 1.0)
    notes = [scene_light.note]
    if 0.0 < visible < 1.0:
        notes.append(f"other objects let {visible:.1%} of it through")
    if table is not None and scene_light.name in table.far_lights:
        notes.append(f"more than {MAX_TERMS} lights: treated as distant")
    if table is not None and scene_light.name in table.crowded_out:
        notes.append(NO_NODES)
    if table is not None and scene_light.name in table.coarse:
        notes.append(FEW_NODES)
    row = _entry(scene_light.name, scene_light.signature[1], scene_light.unlit_reason, "; ".join(filter(None, notes)))
    row["visible"], row["object"] = visible, key_of(scene_light.shown_by)
    if not row["reason"] and not scene_light.lights(skin.key):
        row["reason"] = "light linking excludes this object"
    try:
        light = make_light(scene_light.seen_by(skin.key))
        found = sg.light_report([light], skin.point)[0]
    except ValueError as error:
        return row | {"distance": None, "angle": None, "reason": row["reason"] or str(error)}
    row["distance"], row["angle"] = found["distance"], found["axis_angle"]
    if row["reason"]:
        return row
    if skin.mode == "PHYSICAL":
        row["weight"] = np.asarray(found["weight"], dtype=np.float64)
    else:
        row["weight"] = sg.light_weights([light], skin.point, skin.attenuation)[0]
    if not np.any(row["weight"]):
        row["reason"] = "occluded" if visible == 0.0 else found["state"]
        if row["reason"] == "shines":
            row["reason"] = "its attenuation is 0"
    return row


def _world_row(skin: Skin, world: World, table: Table | None) -> dict[str, Any]:
    row = _entry(world.name, "WORLD", world.unlit_reason, world.unsupported)
    if skin.mode != "PHYSICAL":
        row["reason"] = "only Physical mode uses the world"
    elif not row["reason"]:
        row["weight"], row["note"] = np.array(world.irradiance), world.note
        if table is not None and world.name in table.crowded_out:
            row["note"] = "; ".join(filter(None, (world.note, NO_NODES)))
        if not row["weight"].any():
            row["reason"] = world.note or "its color or strength is 0"
    return row


def _why_hidden(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str:
    if depsgraph.mode == "RENDER":
        return "hidden in renders" if obj.hide_render else "its collection is hidden in renders or excluded"
    if obj.hide_viewport:
        return "disabled in viewports"
    if obj.hide_get(view_layer=depsgraph.view_layer):  # not where it is in none of the layer's collections
        return "hidden in the viewport"
    return "its collection is hidden or excluded from the view layer"
