# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes the table that a skin shows from its settings, lights and world, by calls to the core."""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..errors import SkinError, core
from ..read.base_image import base_of_image
from ..read.scene_lights import SceneLight, make_light
from ..read.scene_reading import Skin
from ..read.scene_world import World
from ..session import SESSION
from ..tissue_presets import TISSUE_SLIDERS
from .light_room import NO_ROOM, coarse_lights, fit_lights
from .lut_layout import MAX_TERMS, Layout, layout_of

#: The largest pixel value of a float image.
BRIGHTEST = float(np.finfo(np.float32).max)


class Table(NamedTuple):
    """A skin's lookup: one linear Rec.709 color per entry, and the mapping from thickness to entry."""

    colors: np.ndarray  #: (size, 3) float64, at the object's weight
    texel_mapping: tuple[float, float]  #: as skinglow.BaseLut.texel_mapping
    weight: tuple[float, float, float] | None  #: what the base was multiplied by; None in mode `existing`
    columns: np.ndarray  #: (size, 3, 3): M(d)
    bound: float | None = None  #: relative error bound of the object's weight on the surface; None: not computed
    lighting: Any = None  #: a skinglow.SurfaceLighting if lit per pixel
    far_lights: frozenset[str] = frozenset()  #: names of the lights without a term in it
    near_lights: frozenset[str] = frozenset()  #: full names of the light objects with terms
    #: Names of what its nodes have no room for, though it is lit per pixel.
    crowded_out: tuple[str, ...] = ()
    #: Irradiance of these at the reference point, which is shown everywhere.
    constant: tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Names of area lights in fewer parts than they should have, for which its nodes have no room.
    coarse: tuple[str, ...] = ()


class Signature(NamedTuple):
    """Everything a skin's table depends on: it is recomputed only when this changes."""

    mode: str
    base: tuple
    blood_weight: tuple | None = None
    attenuation: tuple | None = None
    point: tuple | None = None
    weights: str | None = None
    surface: tuple | None = None
    shape: tuple | None = None
    world: tuple | None = None
    lights: tuple = ()
    mesh: int | None = None  #: version of the evaluated mesh, where light goes through its shape


def signature_of(skin: Skin, lights: list[SceneLight], world: World | None) -> Signature:
    """The inputs that a skin's table depends on in its mode, and no others."""
    if skin.mode == "EXISTING":
        return Signature(skin.mode, skin.base)
    signatures = _prepared().of(skin, lights).signatures
    if skin.mode == "PAPER":
        return Signature(skin.mode, skin.base, skin.blood_weight, skin.attenuation, skin.point, lights=signatures)
    world_light = world_irradiance(world)
    if (skin.surface is not None or skin.shape is not None) and world is not None:
        world_light = tuple(world.environment.coefficients.ravel())
    return Signature(
        skin.mode,
        skin.base,
        point=skin.point,
        weights=skin.weights,
        surface=skin.surface,
        shape=skin.shape,
        world=world_light,
        lights=signatures,
    )


class SkinLights(NamedTuple):
    """The lights that illuminate a skin, each reduced to its visible fraction."""

    lights: list[SceneLight]
    signatures: tuple[tuple, ...]

    @classmethod
    def from_lights(cls, lights: list[SceneLight], before: "SkinLights | None" = None) -> "SkinLights":
        """All of these lights; signatures that are as before are the very same tuples, which compare at once."""
        old = before.signatures if before is not None else ()
        new = tuple(light.signature for light in lights)
        if len(new) == len(old):
            new = tuple(a if a == b else b for a, b in zip(old, new, strict=True))
        return cls(lights, old if new == old else new)


class PreparedLights:
    """Caches the lights of one scene reading and the core's lights made from them: most skins share the same ones."""

    def __init__(self) -> None:
        self.reading: list[SceneLight] | None = None
        self.shared: SkinLights | None = None  #: the same for every skin; None where it depends on the skin
        self.core_signatures: tuple | None = None  #: what core_lights were made from
        self.core_lights: list[Any] = []

    def of(self, skin: Skin, lights: list[SceneLight]) -> SkinLights:
        if lights is not self.reading:
            self.reading, lit = lights, [light for light in lights if not light.unlit_reason]
            per_skin = any(light.receivers is not None or light.excluded or light.visible for light in lit)
            self.shared = None if per_skin else SkinLights.from_lights(lit, self.shared)
        if self.shared is not None:
            return self.shared
        return SkinLights.from_lights(
            [light.seen_by(skin.key) for light in lights if not light.unlit_reason and light.lights(skin.key)]
        )

    def core_lights_of(self, skin: Skin, lights: list[SceneLight]) -> list[Any]:
        found = self.of(skin, lights)
        # Mostly the very same tuples, which compare by identity first.
        if found.signatures != self.core_signatures:
            self.core_signatures, self.core_lights = None, [make_light(light) for light in found.lights]
            self.core_signatures = found.signatures
        return self.core_lights


def _prepared() -> PreparedLights:
    if SESSION.prepared_lights is None:
        SESSION.prepared_lights = PreparedLights()
    return SESSION.prepared_lights


def lights_of(skin: Skin, lights: list[SceneLight]) -> list[SceneLight]:
    """The lights that illuminate this skin, each reduced to its visible fraction."""
    return _prepared().of(skin, lights).lights


def core_lights_of(skin: Skin, lights: list[SceneLight]) -> list[Any]:
    """The same as the core's lights; raises ValueError, naming light and field, if the core rejects one."""
    return _prepared().core_lights_of(skin, lights)


def world_irradiance(world: World | None) -> tuple[float, float, float]:
    """Irradiance of a skin in mode physical from the world, W/m^2; zeros without a world."""
    return world.irradiance if world is not None else (0.0, 0.0, 0.0)


def compute_table(skin: Skin, lights: list[SceneLight], world: World | None, capacity: Layout | None = None) -> Table:
    """Computes a skin's lookup. Raises SkinError or ValueError with the reason if it cannot.

    capacity  the layout that its per-pixel lighting has to fit into; NO_ROOM: plain rows; None: unlimited. What has no
              room lights the skin as one light
    """
    sg = core()
    base = base_lut(skin.base)
    if skin.mode == "EXISTING":
        colors = sg.six_gaussian_lookup(base.size, base.max_thickness_mm)
        return Table(colors, base.texel_mapping, None, colors[:, :, None] * np.eye(3))
    core_lights = core_lights_of(skin, lights)
    bound, surface = None, _Surface()
    if skin.mode == "PAPER":
        weight = np.add(skin.blood_weight, sg.light_weight(core_lights, skin.point, skin.attenuation))
    else:
        irradiance = np.add(sg.object_irradiance(core_lights, skin.point), world_irradiance(world))
        if skin.surface is not None:
            bound = _object_weight_error(skin, core_lights, world, irradiance)
            surface = _lighting(skin, lights_of(skin, lights), core_lights, world, capacity)
        # Light leaves the skin diffusely: radiance is radiant exitance over pi.
        weight = sg.diffuse_radiance(irradiance)
    colors = sg.recolor(base, weight)
    if np.abs(colors).max() > BRIGHTEST:
        raise SkinError(f"{skin.name}: the lookup exceeds the range of a float image: reduce the power of the lights")
    return Table(colors, base.texel_mapping, tuple(weight.tolist()), base.matrices, bound, *surface)


def _object_weight_error(skin: Skin, lights: list, world: World | None, irradiance: np.ndarray) -> float:
    surface = skin.surface
    error = core().object_irradiance_error(lights, skin.point, surface.min, surface.max, surface.normal_cone)
    if world is not None:
        error = np.add(error, world.environment.mean_irradiance_error)
    largest = float(np.abs(irradiance).max())
    return float(error.max()) / largest if largest > 0.0 else 0.0


class _Surface(NamedTuple):
    """The light of a skin that is lit per pixel; the fields are those of Table."""

    lighting: Any = None
    far_lights: frozenset[str] = frozenset()
    near_lights: frozenset[str] = frozenset()
    crowded_out: tuple[str, ...] = ()
    constant: tuple[float, float, float] = (0.0, 0.0, 0.0)
    coarse: tuple[str, ...] = ()


def _lighting(
    skin: Skin, lights: list[SceneLight], core_lights: list[Any], world: World | None, capacity: Layout | None
) -> _Surface:
    """The light on the surface with as many terms as allowed, or as fit."""
    sg = core()
    angular = _angular_weight(skin.base)
    environment = world.environment if world is not None else None
    box = skin.surface.min, skin.surface.max
    wanted = None
    for max_terms in range(MAX_TERMS, -1, -1):
        lighting = sg.SurfaceLighting(core_lights, *box, environment, angular, max_terms=max_terms)
        wanted = wanted or lighting
        if capacity is None or capacity.holds(layout_of(lighting, skin.base[1])):
            far = frozenset(core_lights[i].name for i in lighting.far_lights)
            near = frozenset(lights[i].object_name for i in lighting.lights_of_terms)
            coarse = coarse_lights(lighting, wanted, box) if lighting is not wanted else ()
            return _Surface(lighting, far, near, coarse=tuple(core_lights[i].name for i in coarse))
    if capacity != NO_ROOM and capacity.entries < skin.base[1]:
        raise SkinError(
            f"{skin.name}: its material has nodes for a lookup of {capacity.entries} entries, and these cannot be "
            f"changed now: set Size to {capacity.entries}"
        )
    fitted = fit_lights(core_lights, skin, angular, capacity)
    crowded_out = [core_lights[i].name for i in fitted.others]
    constant = sg.object_irradiance([core_lights[i] for i in fitted.others], skin.point)
    if any(world_irradiance(world)):
        crowded_out.append(world.name)
        constant = np.add(constant, world_irradiance(world))
    near = fitted.lighting.lights_of_terms if fitted.lighting is not None else ()
    near_lights = frozenset(lights[fitted.lights[i]].object_name for i in near)
    return _Surface(fitted.lighting, frozenset(), near_lights, tuple(crowded_out), tuple(constant))


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
    return sg.BaseLut(sg.luminance(sg.recolor(base, (1.0, 1.0, 1.0))), max_thickness_mm)
