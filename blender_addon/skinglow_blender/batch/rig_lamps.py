# SPDX-License-Identifier: GPL-3.0-or-later
"""The lamps of a rig file as lamps of a scene, for a while."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy
from mathutils import Matrix, Vector

from .. import blender_version
from ..errors import SkinError, core

#: On the lamps placed here, so that they are told from the scene's own.
PLACED = "skinglow_rig"


@contextmanager
def placed_lamps(
    scene: bpy.types.Scene,
    rig: Any,  # noqa: ANN401  a skinglow.LightRig
    onto: tuple[float, float, float] | None,
) -> Iterator[list[str]]:
    """While it lasts, the rig's lamps are in the scene; gives notes on what Blender's lamps cannot do.

    onto  where the rig's point comes to lie, world, scene units; None: lamps stand where the file says
    Raises SkinError, naming the lamp, where a number of it lies outside what Blender allows.
    """
    offset = Vector() if onto is None else Vector(onto) - Vector(rig.point)
    notes = list(rig.notes)
    placed: list[bpy.types.Object] = []
    try:
        for number, light in enumerate(rig.lights):
            if light.visible:
                _place(scene, light, light.name or f"Lamp {number + 1}", offset, notes, placed)
        yield notes
    finally:
        for obj in placed:
            # The object goes with its lamp.
            bpy.data.lights.remove(obj.data)


def _place(
    scene: bpy.types.Scene,
    light: Any,  # noqa: ANN401  a skinglow.Light
    name: str,
    offset: Vector,
    notes: list[str],
    placed: list[bpy.types.Object],
) -> None:
    data = bpy.data.lights.new(name, light.kind)
    obj = bpy.data.objects.new(name, data)
    placed.append(obj)
    obj[PLACED] = True
    for field, value in _fields(light).items():
        if not hasattr(data, field):
            if field == "use_soft_falloff" and not value:
                notes.append(f"lamp '{name}': this Blender has soft falloff only")
            continue
        setattr(data, field, value)
        kept = getattr(data, field)
        if isinstance(value, float) and abs(kept - value) > 1e-5 * max(1.0, abs(value)):
            raise SkinError(f"lamp '{name}': {field} = {value:g} is outside what Blender allows (it makes it {kept:g})")
    if light.kind == "SPOT" and light.spot_cosine != blender_version.SPOT_HAS_COSINE:
        has = "has" if blender_version.SPOT_HAS_COSINE else "lacks"
        notes.append(f"lamp '{name}': a spot of this Blender {has} the cosine to its axis (spot_cosine)")
    obj.matrix_world = Matrix.Translation(Vector(light.position) + offset) @ _turned(light).to_4x4()
    scene.collection.objects.link(obj)


def _fields(light: Any) -> dict[str, Any]:  # noqa: ANN401
    """The properties of Blender's lamp that a skinglow.Light sets."""
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
    """The inverse of scene_lights: what to set, so that this Blender's lamp gives the light's power."""
    sg = core()
    if blender_version.LEGACY_LIGHT_POWER:
        if light.kind == "AREA":
            return light.power / sg.LEGACY_AREA_POWER_FACTOR
        if light.kind == "SUN":
            return light.power / sg.legacy_sun_power_factor(light.sun_angle)
    return light.power


def _turned(light: Any) -> Matrix:  # noqa: ANN401
    """The rotation by which a lamp, which shines along its -Z, shines along the light's direction."""
    back = -Vector(light.direction)
    if light.kind == "POINT" or back.length == 0.0:
        return Matrix.Identity(3)
    back.normalize()
    across = Vector(light.tangent) if light.kind == "AREA" else Vector((1.0, 0.0, 0.0))
    across -= across.dot(back) * back
    if across.length < 1e-6:  # the tangent lies along the direction: any other will do
        across = back.orthogonal()
    across.normalize()
    return Matrix((across, back.cross(across), back)).transposed()
