# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group of a skin that is lit per pixel: color = sum over j of column_j(d) E_j(x, n).

Everything that depends on the lights is stored in texels of the skin's row, and all texels are read through one small
inner group. So a changed light needs new pixels and one swapped image only, as with plain rows, and no new shader.
"""

from functools import partial, reduce

import bpy

from ..table.lut_layout import LAYOUT_PROPERTY, Layout
from .inner_groups import LIGHT_NODE, PROFILED_NODE, inner_groups_of
from .light_term_nodes import FarSide, LightTexels
from .node_building import NodeBuilder, Socket
from .skin_group import RowSockets, Texels, finish, rebuilding


def build_surface(group: bpy.types.NodeTree, layout: Layout, tiles: bool = False) -> None:
    """Rebuilds a skin group's nodes for that layout, and for tiles if wanted."""
    with rebuilding(group):
        _build(group, layout, tiles)
        group[LAYOUT_PROPERTY] = tuple(int(n) for n in layout)


def _build(group: bpy.types.NodeTree, layout: Layout, tiles: bool) -> None:
    build = NodeBuilder(group, -2400.0, 200.0)
    row, inner = RowSockets(build), inner_groups_of(group)
    texels = Texels(build, row)
    constant, depth_per_mm = texels.read(layout.constant)
    far = _far_side(build, row, depth_per_mm, tuple(texels.read(layout.angular + i)[0] for i in range(4)))
    parts = []
    if layout.world:
        parts.append(_world(build, far, [texels.read(layout.polynomial + i)[0] for i in range(9)]))
    first = layout.terms
    for count, profiled in ((layout.plain, False), (layout.profiled, True)):
        for i in range(count):
            tree = inner[PROFILED_NODE if profiled else LIGHT_NODE]
            light_node = build.instance(tree, f"Light {i + 1}{' with profile' if profiled else ''}")
            for k, part in enumerate(LightTexels.parts(profiled)):
                color, alpha = texels.read(first + 4 * i + k)
                build.set(light_node.inputs[part], color)
                build.set(light_node.inputs[f"{part} 4"], alpha)
            build.set(light_node.inputs["far point"], far.point)
            build.set(light_node.inputs["normal"], far.normal)
            for k, coefficient in enumerate(far.angular):
                build.set(light_node.inputs[f"angular {k}"], coefficient)
            parts.append(light_node.outputs[0])
        first += 4 * count
    light = constant
    if parts:
        # Clamp the sum, not the polynomial: far lights of negative power take light from the others.
        shown = build.vector("MAXIMUM", reduce(partial(build.vector, "ADD"), parts), (0.0, 0.0, 0.0))
        light = build.vector("ADD", constant, shown)
    finish(build, _transmitted(build, row, texels, layout, light), row.light, tiles)


def _transmitted(build: NodeBuilder, row: RowSockets, texels: Texels, layout: Layout, light: Socket) -> Socket:
    """M(d) times the light, interpolated between the two entries next to the thickness."""
    last = float(layout.entries - 1)
    texel = build.math("MINIMUM", row.texel, last)
    below = build.math("FLOOR", texel)
    fraction = build.math("SUBTRACT", texel, below)
    above = build.math("MINIMUM", build.math("ADD", below, 1.0), last)
    total = None
    for j, channel in enumerate(build.split(light)):
        lower, upper = (texels.read_at(build.math("ADD", entry, float(j * layout.entries))) for entry in (below, above))
        column = build.vector("MULTIPLY_ADD", build.vector("SUBTRACT", upper, lower), fraction, lower)
        total = (
            build.vector("SCALE", column, channel)
            if total is None
            else build.vector("MULTIPLY_ADD", column, channel, total)
        )
    return total


def _far_side(build: NodeBuilder, row: RowSockets, depth_per_mm: Socket, angular: tuple[Socket, ...]) -> FarSide:
    geometry = build.node("ShaderNodeNewGeometry")
    # Blender flips the normal of a back face towards the viewer.
    sign = build.math("MULTIPLY_ADD", geometry.outputs["Backfacing"], 2.0, -1.0)
    normal = build.vector("SCALE", geometry.outputs["Normal"], sign, label="Far-side normal")
    depth = build.math("MULTIPLY", row.thickness, depth_per_mm)
    point = build.vector("MULTIPLY_ADD", normal, depth, geometry.outputs["Position"], label="Far point")
    return FarSide(point, normal, angular)


def _world(build: NodeBuilder, far: FarSide, coefficients: list[Socket]) -> Socket:
    """The polynomial of skinglow.SurfaceLighting in the far side's normal."""
    x, y, z = build.split(far.normal)
    squares = build.math("MULTIPLY_ADD", build.math("MULTIPLY", z, z), 3.0, -1.0)
    difference = build.math("MULTIPLY", build.math("ADD", x, y), build.math("SUBTRACT", x, y))
    products = (build.math("MULTIPLY", a, b) for a, b in ((x, y), (y, z), (x, z)))
    xy, yz, xz = products
    total = coefficients[0]
    for coefficient, term in zip(coefficients[1:], (y, z, x, xy, yz, squares, xz, difference), strict=True):
        total = build.vector("MULTIPLY_ADD", coefficient, term, total)
    return total
