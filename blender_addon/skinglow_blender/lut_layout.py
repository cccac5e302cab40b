# SPDX-License-Identifier: GPL-3.0-or-later
"""What a skin's row of the lookup image holds, texel by texel, for the nodes that read it and for what writes it.

Plain: the colors by thickness, and nothing else. With surface weights, where the light is worked out at each pixel:

    columns   entries each of M(d)'s three columns
    constant  light that is the same everywhere; in its alpha the depth of a millimeter, scene units
    angular   four coefficients of the cubic in the cosine
    object    the object's one weight, which no node reads: lut() does
    world     nine coefficients of the polynomial in the normal, where there is one
    lamps     four texels for each term, plain ones first
"""

from typing import NamedTuple

import numpy as np

#: Lamps and tiles of lamps that a material works out at each pixel, at most of each kind.
MAX_TERMS = 8
#: On a skin's node group: entries, plain terms, terms with a profile, and whether there is a world (Layout).
LAYOUT_PROPERTY = "skinglow_layout"
#: A term without light: somewhere, of some size, so that nothing is divided by 0.
DARK_TERM = np.array(((0, 0, 0, 1), (0, 0, 1, 1), (0, 0, 0, 0), (0, 1, 0, 0)), np.float32)
LAMBERT = np.array(((1, 1, 1), (0, 0, 0), (0, 0, 0), (0, 0, 0)), np.float32)


class Layout(NamedTuple):
    """Room in a row with surface weights."""

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
    def lamps(self) -> int:
        """First texel of the first term."""
        return self.polynomial + (9 if self.world else 0)

    @property
    def width(self) -> int:
        """Texels of a row."""
        return self.lamps + 4 * (self.plain + self.profiled)

    def holds(self, other: "Layout") -> bool:
        """Whether all that the other has room for has room here."""
        return all(a >= b for a, b in zip(self, other, strict=True))

    def joined(self, other: "Layout") -> "Layout":
        """The least that holds both."""
        return Layout(*(max(a, b) for a, b in zip(self, other, strict=True)))


def layout_of(lighting: object, entries: int) -> Layout:
    """The layout that a skinglow.SurfaceLighting asks for, in steps so that few changes ask for another."""
    profiled = len(lighting.terms) - lighting.plain_terms
    return Layout(entries, _step(lighting.plain_terms), _step(profiled), bool(np.any(lighting.polynomial)))


def _step(count: int) -> int:
    return 0 if count == 0 else 1 << (count - 1).bit_length()


def plain_row(colors: np.ndarray, width: int) -> np.ndarray:
    """A row (width, 4) of colors (size, 3); the last goes on to the edge."""
    row = np.empty((width, 4), np.float32)
    row[:, 3] = 1.0
    row[: len(colors), :3] = colors
    row[len(colors) :, :3] = colors[-1]
    return row


def surface_row(
    columns: np.ndarray, weight: np.ndarray, lighting: object | None, depth_per_mm: float, layout: Layout
) -> np.ndarray:
    """A row (layout.width, 4).

    columns       (size, 3, 3): of each entry the three columns of M(d), each a color
    weight        (3,): the object's; what there is everywhere where there is no lighting
    lighting      a skinglow.SurfaceLighting that the layout holds; its light counts over pi, as leaving skin does
    depth_per_mm  scene units for a millimeter of the thickness attribute
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
    lamps = row[layout.lamps :].reshape(-1, 4, 4)
    lamps[:] = DARK_TERM
    if layout.world:
        row[layout.polynomial : layout.lamps] = 0.0
    if lighting is not None:
        row[layout.constant, :3] = 0.0
        row[layout.angular : layout.angular + 4, :3] = lighting.angular
        if layout.world:
            row[layout.polynomial : layout.lamps, :3] = lighting.polynomial / np.pi
        terms, plain = lighting.terms, lighting.plain_terms
        terms[:, 2, :3] /= np.pi
        lamps[:plain] = terms[:plain]
        lamps[layout.plain : layout.plain + len(terms) - plain] = terms[plain:]
    return row


def shown_colors(row: np.ndarray, size: int, layout: Layout) -> np.ndarray:
    """The lookup (size, 3) at the object's weight, float32, from a row with surface weights."""
    columns = row[: layout.constant, :3].reshape(3, layout.entries, 3)[:, :size].astype(np.float64)
    return np.einsum("jnc,j->nc", columns, row[layout.object, :3].astype(np.float64)).astype(np.float32)
