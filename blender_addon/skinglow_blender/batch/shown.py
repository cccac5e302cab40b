# SPDX-License-Identifier: GPL-3.0-or-later
"""Records what the skins show while a picture is rendered, from the render's own depsgraph."""

import hashlib
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
import numpy as np

from ..commands import light_listing, skin
from ..errors import SkinError
from ..read.scene_reading import SceneReading, read_scene, read_skin
from ..session import SESSION
from ..show.frozen import frozen_file, is_frozen
from ..table.occlusion import with_visible_fractions
from .inputs import skin_values
from .manifest import file_digest


class Shown:
    """What the skins showed in one picture."""

    def __init__(self) -> None:
        self.skins: list[dict[str, Any]] = []  #: for the manifest, one per skin and view layer
        self.lights: set[str] = set()  #: full names of the light objects in the render, instances included
        self.faults: list[str] = []


@contextmanager
def watching(scene: bpy.types.Scene) -> Iterator[Shown]:
    """Context manager that records what the skins show in renders of that scene.

    The depsgraph passed to frame_change_post is the render's own. It is called once per view layer, and also for each
    motion blur step; those are ignored.
    """
    shown = Shown()

    def watch(rendered: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        if rendered.name != scene.name or depsgraph.mode != "RENDER":
            return
        if SESSION.render_frame not in (None, rendered.frame_current + rendered.frame_subframe):
            return
        try:
            _record(shown, depsgraph)
        except (SkinError, ValueError) as error:
            shown.faults.append(str(error))
        except Exception as error:  # noqa: BLE001  Blender would swallow it
            shown.faults.append(f"Unexpected {type(error).__name__}: {error}")
            traceback.print_exc()

    # The add-on's own handler runs before this one and has updated the lookups.
    bpy.app.handlers.frame_change_post.append(watch)
    try:
        yield shown
    finally:
        bpy.app.handlers.frame_change_post.remove(watch)


def _record(shown: Shown, depsgraph: bpy.types.Depsgraph) -> None:
    # The add-on's own handler has just read it.
    reading = SESSION.reading_of(depsgraph) or with_visible_fractions(read_scene(depsgraph), depsgraph, {})
    shown.faults += SESSION.faults.values()
    shown.lights.update(light.object_name for light in reading.lights)
    for obj, _skin in reading.skins:
        shown.skins.append(_skin_entry(obj, depsgraph, reading))


def _skin_entry(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, reading: SceneReading) -> dict[str, Any]:
    evaluated = obj.evaluated_get(depsgraph)
    seen = read_skin(evaluated, evaluated.matrix_world)
    report = light_listing.light_report(obj, depsgraph, reading)
    return {
        "name": obj.name_full,
        "view_layer": depsgraph.view_layer.name,
        "mode": seen.mode,
        "weights": seen.weights,
        "live": seen.live,
        "point": list(seen.point),
        # L of Eq. 3 in modes existing and paper; E, W/m^2, in mode physical.
        "weight": [float(value) for value in np.sum([row["weight"] for row in report], axis=0)]
        if report
        else [0.0] * 3,
        "settings": skin_values(evaluated),
        "lookup": _lookup_entry(obj, depsgraph, seen.base[2]),
        "lamps": [_light_entry(row) for row in report],
    }


def _lookup_entry(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, max_thickness_mm: float) -> dict[str, Any]:
    if is_frozen(obj.skinglow.group):
        file = frozen_file(obj.skinglow.group, depsgraph.scene.frame_current)
        return {"frozen": file.name, "sha256": file_digest(file), "max_thickness_mm": max_thickness_mm}
    table = skin.lut(obj, depsgraph)
    digest = hashlib.sha256(np.ascontiguousarray(table, "<f4").tobytes()).hexdigest()
    return {"sha256": digest, "entries": len(table), "max_thickness_mm": max_thickness_mm}


def _light_entry(row: dict[str, Any]) -> dict[str, Any]:
    distance = row["distance"]
    return {
        "name": row["name"],
        "kind": row["kind"],
        "weight": [float(value) for value in row["weight"]],
        "share": float(row["share"]),
        "distance": None if distance is None else float(distance),
        "reason": row["reason"],
        "note": row["note"],
    }
