# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights and nodes that do not agree: how many nodes a skin may need, and what is shown where there are too few."""

from collections import Counter
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..errors import core
from ..read.scene_lights import SceneLight, light_of
from ..read.scene_reading import Skin
from .lut_layout import MAX_TERMS, Layout, layout_of, layout_with

if TYPE_CHECKING:
    from .skin_tables import Table

#: The capacity of nodes that read plain rows: they light nothing per pixel.
NO_ROOM = Layout(0, 0, 0, False)


#: Relative difference of irradiance from which a light with fewer terms than it should have is told.
COARSE = 0.05


class Fitted(NamedTuple):
    """The light of a skin as far as its nodes can show it."""

    lighting: Any  #: a skinglow.SurfaceLighting of those that have nodes; None: nothing has
    lights: list[int]  #: indices of the lights that it is of
    others: list[int]  #: those of the others, which light the skin as one light


def fit_lights(
    lights: list[Any],
    skin: Skin,
    angular: Any,  # noqa: ANN401  a skinglow.AngularWeight
    capacity: Layout,
) -> Fitted:
    """Takes as many of the strongest lights as fit, without the world, where there are no nodes for distant ones."""
    sg = core()
    if capacity == NO_ROOM:
        return Fitted(None, [], list(range(len(lights))))
    box = skin.surface.min, skin.surface.max
    strength = [np.abs(sg.object_irradiance([light], skin.point)).max() for light in lights]
    lighting, near = sg.SurfaceLighting([], *box, None, angular), []
    for i in sorted(range(len(lights)), key=lambda i: -strength[i]):
        wanted = [*near, i]
        # A large area light may have several terms, or one.
        for max_terms in (capacity.plain + capacity.profiled, len(wanted)):
            found = sg.SurfaceLighting([lights[j] for j in wanted], *box, None, angular, max_terms=max_terms)
            if not found.far_lights and capacity.holds(layout_of(found, skin.base[1])):
                lighting, near = found, wanted
                break
    return Fitted(lighting, near, sorted(set(range(len(lights))) - set(near)))


def coarse_lights(lighting: Any, wanted: Any, box: tuple[tuple, tuple]) -> list[int]:  # noqa: ANN401
    """Indices of the lights that have fewer terms than they should, where that can be seen about the skin's bounds.

    lighting, wanted  skinglow.SurfaceLighting as it fits the nodes, and as it should be
    """
    if core().irradiance_difference(lighting, wanted, *box) <= COARSE:
        return []
    terms, wanted_terms = Counter(lighting.lights_of_terms), Counter(wanted.lights_of_terms)
    return sorted(i for i in wanted_terms if terms[i] < wanted_terms[i])


def layout_with_room(skin: Skin, table: "Table", possible: list[SceneLight], world_may_shine: bool) -> Layout:
    """The layout for what lights a skin now, and for what may light it while nodes cannot be added.

    possible  read.possible_lights.lights_that_may_shine
    """
    plain = table.lighting.plain_terms
    terms = plain, len(table.lighting.terms) - plain
    return _with_terms(skin, terms, [p for p in possible if p.object_name not in table.near_lights], world_may_shine)


def layout_of_lights(skin: Skin, lights: list[SceneLight], world: bool) -> Layout:
    """A layout that these lights fit into, whatever their power and color; quick, and larger than it need be.

    world  whether there is light of the world
    """
    return _with_terms(skin, (0, 0), lights, world)


def _with_terms(skin: Skin, terms: tuple[int, int], lights: list[SceneLight], world: bool) -> Layout:
    """The layout for so many terms without and with a profile, those of other lights, and the world."""
    plain, profiled = terms
    number, before = plain + profiled, plain + profiled
    for light in lights:
        if light.lights(skin.key):
            more = _terms_alone(light.signature, skin.surface.min, skin.surface.max)
            plain, profiled, number = plain + more[0], profiled + more[1], number + 1
    # Those beyond what has terms are in the polynomial.
    world = world or (number > before and number > MAX_TERMS)
    return layout_with(skin.base[1], min(plain, MAX_TERMS), min(profiled, MAX_TERMS), world)


@lru_cache(maxsize=1024)
def _terms_alone(signature: tuple, box_min: tuple, box_max: tuple) -> tuple[int, int]:
    """The terms without and with a profile that a light would have alone, whatever its power and color now."""
    name, kind, _color, _power, *rest, _visible = signature
    try:
        light = light_of((name, kind, (1.0, 1.0, 1.0), 1.0, *rest, 1.0))
        alone = core().SurfaceLighting([light], box_min, box_max, max_terms=MAX_TERMS)
    except ValueError:
        alone = None  # the update in which it is on says what is wrong with it
    if alone is None or not len(alone.terms):
        # Turned away, it may be turned to the skin.
        return (1, 0) if kind in ("POINT", "SUN") else (0, 1)
    return alone.plain_terms, len(alone.terms) - alone.plain_terms
