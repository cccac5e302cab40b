# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights of an evaluated scene as `skinglow.Light`, and the signatures by which changes are detected."""

from collections.abc import Mapping
from functools import lru_cache
from operator import mul
from types import MappingProxyType
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix, Vector

from .. import blender_version
from ..errors import core
from ..identity import key_of
from . import working_space
from .light_nodes import node_factor

#: The entries of a light's signature, as `Rebuilt.why` names them.
FIELDS = ("name", "type", "color", "power", "position", "direction", "shape", "normalization", "visible fraction")


class SceneLight(NamedTuple):
    """One light; each instance of a light is one of its own."""

    name: str  #: for people: an instance is named after its light and its instancer
    object_name: str  #: full name of the light object, also of an instance: with the file that it is linked from
    shown_by: bpy.types.Object  #: what to select for it, of an instance its instancer; invalid after undo or load
    signature: tuple  #: everything its emission depends on (FIELDS); equal signatures emit equal light
    receivers: frozenset[str] | None  #: keys (Skin.key) of the only objects it lights; None: all
    excluded: frozenset[str]  #: keys of objects it does not light
    unlit_reason: str  #: why it emits nothing, or ""
    note: str  #: what is not supported and was ignored, or ""
    casts_shadows: bool = True
    visible: Mapping[str, float] = MappingProxyType({})  #: visible fraction, 0 to 1, by Skin.key; missing: 1

    def lights(self, skin_key: str) -> bool:
        """Whether light linking lets this light illuminate that skin."""
        if skin_key in self.excluded:
            return False
        return self.receivers is None or skin_key in self.receivers

    def seen_by(self, skin_key: str) -> "SceneLight":
        """The light reduced to the fraction of it that is visible from that skin."""
        fraction = self.visible.get(skin_key, 1.0)
        return self if fraction == 1.0 else self._replace(signature=(*self.signature[:-1], fraction))


class Placement(NamedTuple):
    """What a light's emission takes from its matrix."""

    position: tuple[float, float, float]
    direction: tuple[float, float, float]
    x_axis: tuple[float, float, float]
    x_length: float
    y_length: float
    note: str  #: what of the transform is not followed, or ""


def read_light(
    obj: bpy.types.Object,
    matrix: Matrix,
    name: str,
    target: str = "ALL",
    instancer: bpy.types.Object | None = None,
) -> SceneLight:
    """Reads an evaluated light object with the given world matrix, for the renders of `target`
    (blender_version.output_target).
    """
    light = obj.data
    kind = light.type
    color = light.color[:]
    power = light.energy
    note = ""
    if blender_version.shader_tree(light) is not None:
        nodes = node_factor(light, target)
        color = tuple(map(mul, color, nodes.color))
        power *= nodes.strength
        note = nodes.note
    tint = blender_version.light_temperature_color(light)
    if tint is not None:
        color = tuple(map(mul, color, tint))
    color, gamut_note = working_space.light_color(color)
    stops = blender_version.light_exposure(light)
    if stops != 0.0:
        power *= core().exposure_factor(stops)

    placement = _placement(kind, matrix.copy().freeze())
    shape = _shape(light, kind, placement)
    normalized = blender_version.light_is_normalized(light)
    signature = (name, kind, color, power, placement.position, placement.direction, shape, normalized, 1.0)
    receivers, excluded = _linked_objects(obj)
    unlit_reason = _unlit_reason(obj, light, kind, placement.direction)
    casts_shadows = blender_version.light_casts_shadows(light)
    shown_by = (instancer or obj).original
    note = note or placement.note or gamut_note or (_eevee_note(light) if target == "EEVEE" else "")
    if not note and blender_version.has_shadow_linking(obj):
        note = "its shadow linking is ignored: all objects block it alike"
    full_name = obj.name_full
    return SceneLight(name, full_name, shown_by, signature, receivers, excluded, unlit_reason, note, casts_shadows)


def make_light(light: SceneLight) -> Any:  # noqa: ANN401  a skinglow.Light
    """The core's light; raises ValueError, naming light and field, if the core rejects it."""
    return light_of(light.signature)


@lru_cache(maxsize=4096)
def light_of(signature: tuple) -> Any:  # noqa: ANN401
    """The core's light of a signature (SceneLight); raises as make_light."""
    sg = core()
    name, kind, color, power, position, direction, shape, normalized, visible = signature
    power *= visible
    fields = dict(shape, kind=kind, color=color, position=position, direction=direction, name=name)
    if blender_version.LEGACY_LIGHT_POWER:
        if kind == "AREA":
            power *= sg.LEGACY_AREA_POWER_FACTOR
        elif kind == "SUN":
            power *= sg.legacy_sun_power_factor(fields["sun_angle"])
    light = sg.Light(power=power, **fields)
    if not normalized:
        light = sg.Light(power=power * sg.unnormalized_power_factor(light), **fields)
    return light


#: Relative difference of lengths, and cosine of angles, that may come from single precision alone.
ROUNDED = 1e-5


@lru_cache(maxsize=4096)
def _placement(kind: str, matrix: Matrix) -> Placement:
    """Most lights stay where they are: what a matrix means is computed once."""
    x, y, z, position = (column.to_3d() for column in matrix.copy().col)
    direction = _area_axis(x, y, z) if kind == "AREA" else -z
    return Placement(tuple(position), tuple(direction), tuple(x), x.length, y.length, _transform_note(kind, x, y, z))


def _area_axis(x: Vector, y: Vector, z: Vector) -> Vector:
    """The axis of an area light: Cycles takes the normal of its two sides, whatever became of its own z axis."""
    normal = x.cross(y)
    if normal.length == 0.0:
        return -z
    return -normal if normal.dot(z) > 0.0 else normal


def _transform_note(kind: str, x: Vector, y: Vector, z: Vector) -> str:
    """What of a light's transform is not followed, or ""."""
    if kind == "AREA" and abs(x.dot(y)) > ROUNDED * x.length * y.length:
        return "the uneven scale of its parent skews it, which a render shows differently: apply that scale"
    lengths = [x.length, y.length, z.length]
    is_uneven = max(lengths) - min(lengths) > ROUNDED * max(lengths)
    is_skewed = max(abs(x.dot(z)), abs(y.dot(z))) > ROUNDED * max(lengths) ** 2
    if kind == "SPOT" and (is_uneven or is_skewed):
        return "its scale is uneven, which changes the cone in a render: apply the scale"
    return ""


def _shape(light: bpy.types.Light, kind: str, placement: Placement) -> tuple[tuple[str, Any], ...]:
    """The fields of `skinglow.Light` that are specific to this kind, by name."""
    if kind == "SUN":
        return (("sun_angle", light.angle),)
    if kind == "AREA":
        form, size = light.shape, light.size
        size_y = light.size_y if form in ("RECTANGLE", "ELLIPSE") else size
        return (
            ("area_shape", "ELLIPSE" if form in ("DISK", "ELLIPSE") else "RECTANGLE"),
            ("size_x", size * placement.x_length),
            ("size_y", size_y * placement.y_length),
            ("tangent", placement.x_axis),
            ("spread", light.spread),
        )
    fields = (("radius", light.shadow_soft_size), ("soft_falloff", blender_version.light_has_soft_falloff(light)))
    if kind != "SPOT":
        return fields
    return (
        *fields,
        ("spot_angle", light.spot_size),
        ("spot_blend", light.spot_blend),
        ("spot_cosine", blender_version.SPOT_HAS_COSINE),
    )


def _unlit_reason(
    obj: bpy.types.Object, light: bpy.types.Light, kind: str, direction: tuple[float, float, float]
) -> str:
    if not obj.visible_diffuse:
        return "its ray visibility excludes diffuse rays"
    if kind == "AREA" and getattr(getattr(light, "cycles", None), "is_portal", False):
        return "it is a portal, which emits no light"
    if kind == "AREA" and (light.size == 0.0 or (light.size_y == 0.0 and light.shape in ("RECTANGLE", "ELLIPSE"))):
        return "it has a size of 0, of which Cycles renders nothing"
    if kind != "POINT" and direction == (0.0, 0.0, 0.0):
        return "its scale is 0, so it has no direction"
    return ""


#: What EEVEE alone follows, and its neutral values.
EEVEE_ONLY = (("diffuse_factor", 1.0), ("transmission_factor", 1.0), ("use_custom_distance", False))


def _eevee_note(light: bpy.types.Light) -> str:
    if all(getattr(light, name, neutral) == neutral for name, neutral in EEVEE_ONLY):
        return ""
    return "its diffuse and transmission factors and its custom distance, which EEVEE alone follows, are ignored"


def _linked_objects(obj: bpy.types.Object) -> tuple[frozenset[str] | None, frozenset[str]]:
    """Keys of the objects a light is linked to (None: all) and of those excluded from it."""
    collection = blender_version.light_receivers(obj)
    if collection is None:
        return None, frozenset()
    included, excluded = set(), set()
    for states, members in (
        (collection.collection_objects, ((o,) for o in collection.objects)),
        (collection.collection_children, (c.all_objects for c in collection.children)),
    ):
        for state, objects in zip(states, members, strict=True):
            keys = {key_of(o) for o in objects}
            (included if state.light_linking.link_state == "INCLUDE" else excluded).update(keys)
    # With exclusions alone the light illuminates everything else.
    return (frozenset(included - excluded) if included else None), frozenset(excluded)
