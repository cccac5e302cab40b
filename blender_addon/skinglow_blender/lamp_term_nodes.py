# SPDX-License-Identifier: GPL-3.0-or-later
"""What one lamp brings to the far side of the skin at a pixel, in nodes: skinglow.SurfaceLighting's formula."""

from typing import NamedTuple

from . import blender_version
from .node_building import NodeBuilder, Socket

#: Keeps a division by 0 away where a lamp has no size; below anything that single precision tells from 0 beside 1.
TINY = 1e-20


class FarSide(NamedTuple):
    """The place where light comes in, and what it is weighed by there."""

    place: Socket  #: world, on the far side
    facing: Socket  #: unit normal of the far side, out of the skin
    angular: tuple[Socket, Socket, Socket, Socket]  #: coefficients of the cubic in the cosine, each linear Rec.709


class LampTexels(NamedTuple):
    """Four texels as skinglow.SurfaceLighting.terms has them: three numbers and a fourth each."""

    place: tuple[Socket, Socket]  #: place, or direction of a sun; 1, or 0 of a sun
    against_axis: tuple[Socket, Socket]  #: against the direction it shines to; square of its radius
    strength: tuple[Socket, Socket]  #: W/m^2 at a distance of 1; share of the smooth step in its profile
    profile: tuple[Socket, Socket] | None = None  #: by cosine, constant, by sine; share of the cosine in it

    @classmethod
    def parts(cls, profiled: bool) -> tuple[str, ...]:
        """The texels that a lamp with or without a profile needs, in their order."""
        return cls._fields if profiled else cls._fields[:-1]


def lamp_irradiance(build: NodeBuilder, lamp: LampTexels, far: FarSide, profiled: bool) -> Socket:
    """The lamp's irradiance on the far side, W/m^2 in linear Rec.709, a vector.

    profiled  False: a lamp that shines alike to all sides, whose profile is not asked for
    """
    here = build.vector("SCALE", far.place, lamp.place[1])
    way = build.vector("SUBTRACT", lamp.place[0], here, label="Way to the lamp")
    square = build.math("ADD", build.vector("DOT_PRODUCT", way, way), lamp.against_axis[1])
    towards = build.vector("NORMALIZE", way)
    cosine = build.vector("DOT_PRODUCT", towards, far.facing, label="Cosine")
    share = _above_horizon(build, cosine, build.math("SQRT", build.math("DIVIDE", lamp.against_axis[1], square)))
    if profiled:
        share = build.math("MULTIPLY", share, _profile(build, lamp, towards))
    share = build.math("DIVIDE", share, square)
    weight = far.angular[3]
    clamped = build.math("ADD", cosine, 0.0, clamp=True)
    for coefficient in far.angular[2::-1]:
        weight = build.vector("MULTIPLY_ADD", weight, clamped, coefficient)
    weight = build.vector("MAXIMUM", weight, (0.0, 0.0, 0.0))
    strength = build.vector("MULTIPLY", lamp.strength[0], weight)
    return build.vector("SCALE", strength, share)


def _above_horizon(build: NodeBuilder, cosine: Socket, sine: Socket) -> Socket:
    """The cosine of a lamp with an angular radius of that sine, of which the horizon hides a part."""
    risen = build.math("MAXIMUM", build.math("ADD", cosine, sine), 0.0)
    risen = build.math("MINIMUM", risen, build.math("MULTIPLY", sine, 2.0))
    below = build.math("DIVIDE", build.math("MULTIPLY", risen, risen), build.math("MULTIPLY_ADD", sine, 4.0, TINY))
    return build.math("ADD", below, build.math("MAXIMUM", build.math("SUBTRACT", cosine, sine), 0.0))


def _profile(build: NodeBuilder, lamp: LampTexels, towards: Socket) -> Socket:
    """How bright the lamp is in this direction, 0 to 1."""
    axis_cosine = build.vector("DOT_PRODUCT", lamp.against_axis[0], towards)
    by_cosine, constant, by_sine = build.split(lamp.profile[0])
    sine_square = build.math(
        "MAXIMUM", build.math("SUBTRACT", 1.0, build.math("MULTIPLY", axis_cosine, axis_cosine)), 0.0
    )
    step = build.math("MULTIPLY_ADD", by_sine, build.math("SQRT", sine_square), constant)
    step = build.math("MULTIPLY_ADD", by_cosine, axis_cosine, step, clamp=True)
    smooth = build.math("MULTIPLY", step, build.math("MULTIPLY_ADD", step, -2.0, 3.0))
    smooth = build.math("MULTIPLY_ADD", build.math("SUBTRACT", smooth, 1.0), lamp.strength[1], 1.0)
    share = build.math("MULTIPLY", step, smooth)
    if blender_version.SPOT_HAS_COSINE:
        fall = build.math("MULTIPLY_ADD", build.math("SUBTRACT", axis_cosine, 1.0), lamp.profile[1], 1.0)
        share = build.math("MULTIPLY", share, fall)
    return share
