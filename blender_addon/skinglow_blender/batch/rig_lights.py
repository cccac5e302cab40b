# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the lights of a rig file to a scene, for good or for a while."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
from mathutils import Matrix, Vector

from .. import blender_version
from ..errors import SkinError, core

#: Custom property that marks the lights added here.
ADDED = "skinglow_rig"


def add_lights(
    scene: bpy.types.Scene,
    rig: Any,  # noqa: ANN401  a skinglow.LightRig
    onto: tuple[float, float, float] | None,
) -> tuple[list[bpy.types.Object], list[str]]:
    """Adds the rig's lights to the scene; returns them, and notes on what Blender's lights do not support.

    onto  target of the rig's point, world, scene units; None: the lights are placed as in the file
    Raises SkinError, naming the light, if one of its values is outside Blender's range; then none is added.
    """
    offset = Vector() if onto is None else Vector(onto) - Vector(rig.point)
    notes = list(rig.notes)
    added: list[bpy.types.Object] = []
    try:
        for number, light in enumerate(rig.lights):
            if light.visible:
                _add(scene, light, light.name or f"Light {number + 1}", offset, notes, added)
    except SkinError:
        _remove(added)
        raise
    return added, notes


@contextmanager
def added_lights(
    scene: bpy.types.Scene,
    rig: Any,  # noqa: ANN401
    onto: tuple[float, float, float] | None,
) -> Iterator[list[str]]:
    """Context manager with the rig's lights in the scene, as by `add_lights`; yields the notes."""
    added, notes = add_lights(scene, rig, onto)
    try:
        yield notes
    finally:
        _remove(added)


def _remove(added: list[bpy.types.Object]) -> None:
    for obj in added:
        # This also removes the object.
        bpy.data.lights.remove(obj.data)


def _add(
    scene: bpy.types.Scene,
    light: Any,  # noqa: ANN401  a skinglow.Light
    name: str,
    offset: Vector,
    notes: list[str],
    added: list[bpy.types.Object],
) -> None:
    data = bpy.data.lights.new(name, light.kind)
    obj = bpy.data.objects.new(name, data)
    added.append(obj)
    obj[ADDED] = True
    for field, value in _fields(light).items():
        if not hasattr(data, field):
            if field == "use_soft_falloff" and not value:
                notes.append(f"light '{name}': this Blender version only supports soft falloff")
            continue
        setattr(data, field, value)
        kept = getattr(data, field)
        if isinstance(value, float) and abs(kept - value) > 1e-5 * max(1.0, abs(value)):
            raise SkinError(f"light '{name}': {field} = {value:g} is outside Blender's range (clamped to {kept:g})")
    if light.kind == "SPOT" and light.spot_cosine != blender_version.SPOT_HAS_COSINE:
        has = "have" if blender_version.SPOT_HAS_COSINE else "lack"
        notes.append(f"light '{name}': spots of this Blender version {has} the cosine falloff (spot_cosine)")
    obj.matrix_world = (
        Matrix.Translation(Vector(light.position) + offset) @ Matrix(core().light_rotation(light).tolist()).to_4x4()
    )
    scene.collection.objects.link(obj)


def _fields(light: Any) -> dict[str, Any]:  # noqa: ANN401
    """The properties of a Blender light for a skinglow.Light."""
    fields: dict[str, Any] = {"color": tuple(light.color), "energy": _energy(light)}
    if light.kind in ("POINT", "SPOT"):
        fields |= {"shadow_soft_size": light.radius, "use_soft_falloff": light.soft_falloff}
    if light.kind == "SPOT":
        fields |= {"spot_size": light.spot_angle, "spot_blend": light.spot_blend}
    elif light.kind == "SUN":
        fields["angle"] = light.sun_angle
    elif light.kind == "AREA":
        fields |= {"shape": light.area_shape, "size": light.size_x, "size_y": light.size_y, "spread": light.spread}
    return fields


def _energy(light: Any) -> float:  # noqa: ANN401
    """The inverse of scene_lights: Blender's energy for the light's power."""
    sg = core()
    if blender_version.LEGACY_LIGHT_POWER:
        if light.kind == "AREA":
            return light.power / sg.LEGACY_AREA_POWER_FACTOR
        if light.kind == "SUN":
            return light.power / sg.legacy_sun_power_factor(light.sun_angle)
    return light.power
