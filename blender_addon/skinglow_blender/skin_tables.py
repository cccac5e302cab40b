# SPDX-License-Identifier: GPL-3.0-or-later
"""From settings, lamps and world to the table that a skin shows. All computing is the core's."""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from .base_image import base_of_image, brightness
from .errors import SkinError, core
from .lut_layout import MAX_TERMS, Layout, layout_of
from .scene_lights import Lamp, make_light
from .scene_reading import Skin
from .scene_world import World
from .skin_settings import TISSUE_SLIDERS

#: With weights 'AUTO' the object's one weight will do where it is off by no more than this share of itself.
AUTO_TOLERANCE = 0.05


#: The largest number of an image's pixels.
BRIGHTEST = float(np.finfo(np.float32).max)


class WeightsChoice(NamedTuple):
    """Which weights a skin shows."""

    weights: str  #: 'OBJECT' or 'SURFACE'
    bound: float | None  #: how far the object's weight may be off on the surface, a share of it; None: not asked for


OBJECT_WEIGHT = WeightsChoice("OBJECT", None)


class Table(NamedTuple):
    """A skin's lookup: one linear Rec.709 color per entry, and where a thickness finds its entry."""

    colors: np.ndarray  #: (size, 3) float64, at the object's weight
    texel_mapping: tuple[float, float]  #: as skinglow.BaseLut.texel_mapping
    weight: tuple[float, float, float] | None  #: what the base was multiplied by; None in mode `existing`
    columns: np.ndarray  #: (size, 3, 3): M(d)
    choice: WeightsChoice = OBJECT_WEIGHT
    lighting: Any = None  #: a skinglow.SurfaceLighting, where the light is worked out at each pixel
    far_lamps: frozenset[str] = frozenset()  #: names of the lamps that it has no term for


class Signature(NamedTuple):
    """All that a skin's table depends on: it is computed again only when this changes."""

    mode: str
    base: tuple
    blood_weight: tuple | None = None
    attenuation: tuple | None = None
    point: tuple | None = None
    weights: str | None = None
    surface: tuple | None = None
    world: tuple | None = None
    lights: tuple = ()


def signature_of(skin: Skin, lamps: list[Lamp], world: World | None) -> Signature:
    """What decides a skin's table in its mode, and nothing else."""
    if skin.mode == "EXISTING":
        return Signature(skin.mode, skin.base)
    lights = _reaching.of(skin, lamps).signatures
    if skin.mode == "PAPER":
        return Signature(skin.mode, skin.base, skin.blood_weight, skin.attenuation, skin.point, lights=lights)
    light = world_irradiance(world)
    if skin.surface is not None and world is not None:
        light = tuple(world.environment.coefficients.ravel())
    return Signature(
        skin.mode,
        skin.base,
        point=skin.point,
        weights=skin.weights,
        surface=skin.surface,
        world=light,
        lights=lights,
    )


class Lit(NamedTuple):
    """The lamps that reach a skin, as far as it sees them."""

    lamps: list[Lamp]
    signatures: tuple[tuple, ...]

    @classmethod
    def by(cls, lamps: list[Lamp]) -> "Lit":
        """By all of these."""
        return cls(lamps, tuple(lamp.signature for lamp in lamps))


class _Reaching:
    """Remembers one reading's lamps, and what was made of them: most skins of a scene are lit by the same ones."""

    def __init__(self) -> None:
        self.lamps: list[Lamp] | None = None
        self.everyone: Lit | None = None  #: of every skin; None where it depends on the skin
        self.made_of: tuple | None = None
        self.made: list[Any] = []

    def of(self, skin: Skin, lamps: list[Lamp]) -> Lit:
        if lamps is not self.lamps:
            self.lamps, shining = lamps, [lamp for lamp in lamps if not lamp.left_out]
            choosy = any(lamp.receivers is not None or lamp.excluded or lamp.visible for lamp in shining)
            self.everyone = None if choosy else Lit.by(shining)
        if self.everyone is not None:
            return self.everyone
        return Lit.by([lamp.seen_by(skin.key) for lamp in lamps if not lamp.left_out and lamp.lights(skin.name)])

    def lights(self, skin: Skin, lamps: list[Lamp]) -> list[Any]:
        found = self.of(skin, lamps)
        # Mostly the same tuples, so that comparing them is a matter of addresses.
        if found.signatures != self.made_of:
            self.made_of, self.made = None, [make_light(lamp) for lamp in found.lamps]
            self.made_of = found.signatures
        return self.made


_reaching = _Reaching()


def lamps_of(skin: Skin, lamps: list[Lamp]) -> list[Lamp]:
    """The lamps that reach this skin, as far as it sees them."""
    return _reaching.of(skin, lamps).lamps


def lights_of(skin: Skin, lamps: list[Lamp]) -> list[Any]:
    """The core's lamps that reach this skin; raises ValueError, naming lamp and field, where the core refuses one."""
    return _reaching.lights(skin, lamps)


def world_irradiance(world: World | None) -> tuple[float, float, float]:
    """What the world brings to a skin of mode physical, W/m^2; zeros without one."""
    return world.irradiance if world is not None else (0.0, 0.0, 0.0)


def compute_table(skin: Skin, lamps: list[Lamp], world: World | None, room: Layout | None = None) -> Table:
    """Computes a skin's lookup. Raises SkinError or ValueError, in words, where it cannot.

    room  what its light on the surface has to fit into; None: as much as it needs
    """
    sg = core()
    base = base_lut(skin.base)
    if skin.mode == "EXISTING":
        colors = sg.six_gaussian_lookup(base.size, base.max_thickness_mm)
        return Table(colors, base.texel_mapping, None, colors[:, :, None] * np.eye(3))
    lights = lights_of(skin, lamps)
    choice, lighting, far = OBJECT_WEIGHT, None, frozenset()
    if skin.mode == "PAPER":
        weight = np.add(skin.blood_weight, sg.light_weight(lights, skin.point, skin.attenuation))
    else:
        irradiance = np.add(sg.irradiance(lights, skin.point), world_irradiance(world))
        choice = _choose_weights(skin, lights, world, irradiance)
        if choice.weights == "SURFACE":
            lighting = _lighting(skin, lights, world, room)
            far = frozenset(lights[i].name for i in lighting.far_lights)
        # Light that leaves diffusely: the radiance is the flux per area over pi.
        weight = irradiance / math.pi
    colors = sg.recolor(base, weight)
    if max(colors.max(), -colors.min()) > BRIGHTEST:
        raise SkinError(f"{skin.name}: the lookup is brighter than an image can hold; turn the lights down")
    return Table(colors, base.texel_mapping, tuple(float(w) for w in weight), base.matrices, choice, lighting, far)


def _choose_weights(skin: Skin, lights: list, world: World | None, irradiance: np.ndarray) -> WeightsChoice:
    if skin.surface is None:
        return OBJECT_WEIGHT
    surface = skin.surface
    off = core().object_irradiance_error(lights, skin.point, surface.least, surface.most, surface.facing)
    if world is not None:
        off = np.add(off, world.environment.mean_irradiance_error)
    largest = float(np.abs(irradiance).max())
    bound = float(off.max()) / largest if largest > 0.0 else 0.0
    return WeightsChoice("SURFACE" if skin.weights == "SURFACE" or bound > AUTO_TOLERANCE else "OBJECT", bound)


def _lighting(skin: Skin, lights: list, world: World | None, room: Layout | None) -> Any:  # noqa: ANN401
    """The light on the surface with as many terms as there may be, or as there is room for."""
    sg = core()
    angular = _angular_weight(skin.base)
    environment = world.environment if world is not None else None
    for most in range(MAX_TERMS, -1, -1):
        found = sg.SurfaceLighting(lights, skin.surface.least, skin.surface.most, environment, angular, max_terms=most)
        if room is None or room.holds(layout_of(found, skin.base[1])):
            return found
    raise SkinError(
        f"{skin.name}: its material has no room for these lamps, and none can be made while rendering; show the lamps "
        "that render in the viewport once, or set Weights to Object"
    )


@lru_cache(maxsize=64)
def _angular_weight(key: tuple) -> Any:  # noqa: ANN401  a skinglow.AngularWeight
    sg = core()
    return sg.skin_angular_weight(sg.Tissue(**dict(zip(TISSUE_SLIDERS, key[3], strict=True))))


def base_lut(key: tuple) -> Any:  # noqa: ANN401  a skinglow.BaseLut
    """The base lookup that a skin's settings ask for."""
    return base_of_image(key) if key[0] == "IMAGE" else _computed_base(key)


@lru_cache(maxsize=64)
def _computed_base(key: tuple) -> Any:  # noqa: ANN401
    sg = core()
    kind, size, max_thickness_mm = key[:3]
    if kind == "BUILTIN":
        return sg.six_gaussian_base(size, max_thickness_mm)
    tissue = sg.Tissue(**dict(zip(TISSUE_SLIDERS, key[3], strict=True)))
    base = sg.base_lut(tissue, size, max_thickness_mm)
    if kind == "TISSUE":
        return base
    return sg.BaseLut(brightness(sg.recolor(base, (1.0, 1.0, 1.0))), max_thickness_mm)
