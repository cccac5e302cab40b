# SPDX-License-Identifier: GPL-3.0-or-later
"""The texels of a skin's row in the lookup image, for the nodes that read them and the code that writes them.

A plain row holds the colors by thickness and nothing else. The row of a skin that is lit per pixel:

    columns   `entries` texels for each of the three columns of M(d)
    constant  light that is the same everywhere; alpha: scene units per millimeter of thickness
    angular   four coefficients of the cubic in the cosine
    object    the object's single weight; read by lut(), not by the nodes
    world     nine coefficients of the polynomial in the normal, if there is one
    terms     four texels per term, plain terms first
"""

from typing import NamedTuple

import numpy as np

from ..errors import core

#: Maximum number of terms (lights or tiles of area lights) of each kind that a material evaluates per pixel.
MAX_TERMS = 8
#: Custom property of a skin's node group: entries, plain terms, terms with a profile, has a world (Layout).
LAYOUT_PROPERTY = "skinglow_layout"
#: A term without light, at a non-zero distance and size, so that nothing is divided by 0.
DARK_TERM = np.array(((0, 0, 0, 1), (0, 0, 1, 1), (0, 0, 0, 0), (0, 1, 0, 0)), np.float32)
LAMBERT = np.array(((1, 1, 1), (0, 0, 0), (0, 0, 0), (0, 0, 0)), np.float32)


class Layout(NamedTuple):
    """Layout of the row of a skin that is lit per pixel."""

    entries: int  #: of each column
    plain: int  #: terms without a profile
    profiled: int  #: terms with one
    world: bool  #: whether there is a polynomial

    @property
    def constant(self) -> int:
        """Texel of the constant light."""
        return 3 * self.entries

    @property
    def angular(self) -> int:
        """First texel of the cubic."""
        return self.constant + 1

    @property
    def object(self) -> int:
        """Texel of the object's weight."""
        return self.angular + 4

    @property
    def polynomial(self) -> int:
        """First texel of the polynomial."""
        return self.object + 1

    @property
    def terms(self) -> int:
        """First texel of the first term."""
        return self.polynomial + (9 if self.world else 0)

    @property
    def width(self) -> int:
        """Texels of a row."""
        return self.terms + 4 * (self.plain + self.profiled)

    def holds(self, other: "Layout") -> bool:
        """Whether everything of the other layout fits into this one."""
        return all(a >= b for a, b in zip(self, other, strict=True))

    def joined(self, other: "Layout") -> "Layout":
        """The smallest layout that holds both."""
        return Layout(*(max(a, b) for a, b in zip(self, other, strict=True)))


def layout_of(lighting: object, entries: int) -> Layout:
    """The layout that a skinglow.SurfaceLighting needs, rounded up so that few changes need another one."""
    profiled = len(lighting.terms) - lighting.plain_terms
    return layout_with(entries, lighting.plain_terms, profiled, bool(np.any(lighting.polynomial)))


def layout_with(entries: int, plain: int, profiled: int, world: bool) -> Layout:
    """The layout with at least so many terms."""
    return Layout(entries, _next_power_of_two(plain), _next_power_of_two(profiled), world)


def _next_power_of_two(count: int) -> int:
    return 0 if count == 0 else 1 << (count - 1).bit_length()


def plain_row(colors: np.ndarray, width: int) -> np.ndarray:
    """A row (width, 4) of colors (size, 3), padded with the last color."""
    row = np.empty((width, 4), np.float32)
    row[:, 3] = 1.0
    row[: len(colors), :3] = colors
    row[len(colors) :, :3] = colors[-1]
    return row


def surface_row(
    columns: np.ndarray,
    weight: np.ndarray,
    lighting: object | None,
    depth_per_mm: float,
    layout: Layout,
    constant: np.ndarray | tuple[float, ...] = (0.0, 0.0, 0.0),
) -> np.ndarray:
    """A row (layout.width, 4).

    columns       (size, 3, 3): the three columns of M(d), each a color, for each entry
    weight        (3,): the object's weight, used everywhere if there is no lighting
    lighting      a skinglow.SurfaceLighting that fits the layout; its irradiance becomes radiance here
    depth_per_mm  scene units per millimeter of the thickness attribute
    constant      (3,): irradiance besides that of the lighting, the same everywhere
    """
    row = np.ones((layout.width, 4), np.float32)
    size = len(columns)
    for j in range(3):
        start = j * layout.entries
        row[start : start + size, :3] = columns[:, j]
        row[start + size : start + layout.entries, :3] = columns[-1, j]
    row[layout.constant] = (*weight, depth_per_mm)
    row[layout.angular : layout.angular + 4, :3] = LAMBERT
    row[layout.object, :3] = weight
    slots = row[layout.terms :].reshape(-1, 4, 4)
    slots[:] = DARK_TERM
    if layout.world:
        row[layout.polynomial : layout.terms] = 0.0
    if lighting is not None:
        row[layout.constant, :3] = core().diffuse_radiance(constant)
        row[layout.angular : layout.angular + 4, :3] = lighting.angular
        if layout.world:
            row[layout.polynomial : layout.terms, :3] = core().diffuse_radiance(lighting.polynomial)
        terms, plain = lighting.terms, lighting.plain_terms
        terms[:, 2, :3] = core().diffuse_radiance(terms[:, 2, :3])
        slots[:plain] = terms[:plain]
        slots[layout.plain : layout.plain + len(terms) - plain] = terms[plain:]
    return row


def shown_colors(row: np.ndarray, size: int, layout: Layout) -> np.ndarray:
    """The lookup (size, 3) at the object's weight, float32, from the row of a skin that is lit per pixel."""
    columns = row[: layout.constant, :3].reshape(3, layout.entries, 3)[:, :size].astype(np.float64)
    base = core().BaseLut(columns.transpose(1, 2, 0), 1.0)
    return core().recolor(base, row[layout.object, :3]).astype(np.float32)
