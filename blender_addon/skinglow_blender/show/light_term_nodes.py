# SPDX-License-Identifier: GPL-3.0-or-later
"""The irradiance of one light on the far side of the skin at a pixel, in nodes: skinglow.SurfaceLighting's formula."""

from typing import NamedTuple

from .. import blender_version
from .node_building import NodeBuilder, Socket

#: Avoids a division by 0 for lights without a size; negligible next to 1 in single precision.
EPSILON = 1e-20


class FarSide(NamedTuple):
    """The point where light enters, and its weighting there."""

    point: Socket  #: world, on the far side
    normal: Socket  #: unit normal of the far side, pointing out of the skin
    angular: tuple[Socket, Socket, Socket, Socket]  #: coefficients of the cubic in the cosine, each linear Rec.709


class LightTexels(NamedTuple):
    """The four texels of a row of skinglow.SurfaceLighting.terms, as (color, alpha) each."""

    point: tuple[Socket, Socket]  #: position, or direction of a sun; 1, or 0 for a sun
    reverse_axis: tuple[Socket, Socket]  #: reversed light direction; squared radius
    strength: tuple[Socket, Socket]  #: W/m^2 at a distance of 1; smoothstep factor of its profile
    profile: tuple[Socket, Socket] | None = None  #: cos_scale, bias, sin_scale; cosine falloff factor

    @classmethod
    def parts(cls, profiled: bool) -> tuple[str, ...]:
        """The texels that a light with or without a profile needs, in order."""
        return cls._fields if profiled else cls._fields[:-1]


def light_irradiance(build: NodeBuilder, light: LightTexels, far: FarSide, profiled: bool) -> Socket:
    """The light's irradiance on the far side, W/m^2 in linear Rec.709, a vector.

    profiled  False: an isotropic light, whose profile is not read
    """
    receiver = build.vector("SCALE", far.point, light.point[1])
    offset = build.vector("SUBTRACT", light.point[0], receiver, label="Offset to the light")
    distance_sq = build.math("ADD", build.vector("DOT_PRODUCT", offset, offset), light.reverse_axis[1])
    direction = build.vector("NORMALIZE", offset)
    cosine = build.vector("DOT_PRODUCT", direction, far.normal, label="Cosine")
    factor = _above_horizon(build, cosine, build.math("SQRT", build.math("DIVIDE", light.reverse_axis[1], distance_sq)))
    if profiled:
        factor = build.math("MULTIPLY", factor, _profile(build, light, direction))
    factor = build.math("DIVIDE", factor, distance_sq)
    weight = far.angular[3]
    clamped = build.math("ADD", cosine, 0.0, clamp=True)
    for coefficient in far.angular[2::-1]:
        weight = build.vector("MULTIPLY_ADD", weight, clamped, coefficient)
    weight = build.vector("MAXIMUM", weight, (0.0, 0.0, 0.0))
    strength = build.vector("MULTIPLY", light.strength[0], weight)
    return build.vector("SCALE", strength, factor)


def _above_horizon(build: NodeBuilder, cosine: Socket, sine: Socket) -> Socket:
    """The effective cosine of a light whose angular radius has that sine, partly hidden by the horizon."""
    risen = build.math("MAXIMUM", build.math("ADD", cosine, sine), 0.0)
    risen = build.math("MINIMUM", risen, build.math("MULTIPLY", sine, 2.0))
    below = build.math("DIVIDE", build.math("MULTIPLY", risen, risen), build.math("MULTIPLY_ADD", sine, 4.0, EPSILON))
    return build.math("ADD", below, build.math("MAXIMUM", build.math("SUBTRACT", cosine, sine), 0.0))


def _profile(build: NodeBuilder, light: LightTexels, direction: Socket) -> Socket:
    """Relative intensity of the light in this direction, 0 to 1."""
    axis_cosine = build.vector("DOT_PRODUCT", light.reverse_axis[0], direction)
    cos_scale, bias, sin_scale = build.split(light.profile[0])
    sine_sq = build.math("MAXIMUM", build.math("SUBTRACT", 1.0, build.math("MULTIPLY", axis_cosine, axis_cosine)), 0.0)
    step = build.math("MULTIPLY_ADD", sin_scale, build.math("SQRT", sine_sq), bias)
    step = build.math("MULTIPLY_ADD", cos_scale, axis_cosine, step, clamp=True)
    smooth = build.math("MULTIPLY", step, build.math("MULTIPLY_ADD", step, -2.0, 3.0))
    smooth = build.math("MULTIPLY_ADD", build.math("SUBTRACT", smooth, 1.0), light.strength[1], 1.0)
    factor = build.math("MULTIPLY", step, smooth)
    if blender_version.SPOT_HAS_COSINE:
        fall = build.math("MULTIPLY_ADD", build.math("SUBTRACT", axis_cosine, 1.0), light.profile[1], 1.0)
        factor = build.math("MULTIPLY", factor, fall)
    return factor
