# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of a skin that is lit per pixel, as texels: what the nodes compute at a pixel, for other renderers."""

from typing import NamedTuple

import numpy as np

from ..errors import core
from .skin_tables import Table, base_lut

#: Distance of texels, mm, and the most of them; where they bind, the distance grows.
SPACING_MM = 0.2
MAX_TEXELS = 1 << 22
#: Of the extent of a skin; single precision does not see it.
APART = 1e-8


class SurfaceTiles(NamedTuple):
    """An image, and where each triangle has its texels in it."""

    pixels: np.ndarray  #: (rows, width, 3) float32, linear Rec.709 radiance
    texels: np.ndarray  #: (m, 3, 3) as FaceTiles.texels, of each corner


def surface_tiles(
    vertices: np.ndarray,
    triangles: np.ndarray,
    normals: np.ndarray,
    thickness_mm: np.ndarray,
    unit_mm: float,
    base_key: tuple,
    table: Table,
) -> SurfaceTiles:
    """Evaluates a table's lighting at the texels of tiles.

    vertices      (n, 3), world
    normals       (m, 3, 3) of the triangles' corners, unit, world
    thickness_mm  (n,), as the object is scaled now
    unit_mm       length of a unit of the world
    base_key      Skin.base
    """
    sg = core()
    # A vertex for each of its normals, a little apart, for the core takes those at one point for one: light differs on
    # both sides of a sharp edge.
    corners = np.column_stack((triangles.ravel(), np.rint(normals.reshape(-1, 3) * 1e4)))
    _, first, split = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    split, vertex, normals = split.reshape(-1, 3), triangles.ravel()[first], normals.reshape(-1, 3)[first]
    body = vertices[vertex] + normals * (APART * np.ptp(vertices, axis=0).max())
    at = {"unit_mm": unit_mm}
    sizes = np.full(len(split), 3, np.int32)
    layout = sg.FaceTiles(body, sizes, split.ravel(), spacing_mm=SPACING_MM, max_texels=MAX_TEXELS, **at)
    texels = np.asarray(layout.texels).reshape(-1, 3, 3)
    targets = sg.TileTargets(body, split, texels, layout.height, **at)
    values = targets.at_vertices(np.column_stack((thickness_mm[vertex], normals)))
    mm, facing = values[:, 0], values[:, 1:]
    facing = facing / np.linalg.norm(facing, axis=1, keepdims=True)
    light = table.lighting.irradiance(*sg.far_side(targets.points, facing, mm / unit_mm))
    mapping = base_lut(base_key).texel_mapping
    # M(d) E, a column for each channel of E.
    shown = sum(sg.table_at(table.columns[:, :, j], mapping, mm) * light[:, j : j + 1] for j in range(3))
    return SurfaceTiles(targets.spread(sg.diffuse_radiance(shown)), texels)
