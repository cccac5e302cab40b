# SPDX-License-Identifier: GPL-3.0-or-later
"""The skin's node group where light is worked out at each pixel: color = sum over j of column_j(d) E_j(x, n).

Everything that changes with the lamps is texels of the skin's row, and all texels are read through one small group
inside, so that a changed lamp is new pixels and one image swapped, as with plain rows, and no formula is compiled anew.
"""

import bpy

from . import blender_version
from .lamp_term_nodes import FarSide, LampTexels, lamp_irradiance
from .lut_image import SURFACE_NODE, TEXEL_NODE, show_image, shown_image
from .lut_layout import LAYOUT_PROPERTY, Layout
from .node_building import NodeBuilder, Socket
from .skin_group import INNER_GROUPS, RowSockets, clear, finish, new_lookup


def build_surface(group: bpy.types.NodeTree, layout: Layout) -> None:
    """Makes a skin group's nodes anew for that layout; the images it showed stay in it."""
    image = shown_image(group)
    clear(group)
    build = NodeBuilder(group, -2400.0, 200.0)
    row = RowSockets(build)
    texels = _Texels(build, row, _texel_group())
    constant, depth_per_mm = texels.read(layout.constant)
    far = _far_side(build, row, depth_per_mm, tuple(texels.read(layout.angular + i)[0] for i in range(4)))
    light = constant
    if layout.world:
        light = build.vector(
            "ADD", light, _world(build, far, [texels.read(layout.polynomial + i)[0] for i in range(9)])
        )
    first = layout.lamps
    for count, profiled in ((layout.plain, False), (layout.profiled, True)):
        inner = _lamp_group(profiled) if count else None
        for i in range(count):
            lamp = _instance(build, inner, f"Lamp {i + 1}{' with profile' if profiled else ''}")
            for k, part in enumerate(LampTexels.parts(profiled)):
                color, alpha = texels.read(first + 4 * i + k)
                build.give(lamp.inputs[part], color)
                build.give(lamp.inputs[f"{part} 4"], alpha)
            build.give(lamp.inputs["far place"], far.place)
            build.give(lamp.inputs["facing"], far.facing)
            for k, coefficient in enumerate(far.angular):
                build.give(lamp.inputs[f"angular {k}"], coefficient)
            light = build.vector("ADD", light, lamp.outputs[0])
        first += 4 * count
    finish(build, _through(build, row, texels, layout, light), row.strength)
    group[LAYOUT_PROPERTY] = tuple(int(n) for n in layout)
    if image is not None:
        show_image(group, image)


def _through(build: NodeBuilder, row: RowSockets, texels: "_Texels", layout: Layout, light: Socket) -> Socket:
    """M(d) times the light, between the two entries about the thickness."""
    last = float(layout.entries - 1)
    texel = build.math("MINIMUM", row.texel, last)
    below = build.math("FLOOR", texel)
    share = build.math("SUBTRACT", texel, below)
    above = build.math("MINIMUM", build.math("ADD", below, 1.0), last)
    total = None
    for j, part in enumerate(build.split(light)):
        lower, upper = (texels.read_at(build.math("ADD", entry, float(j * layout.entries))) for entry in (below, above))
        column = build.vector("MULTIPLY_ADD", build.vector("SUBTRACT", upper, lower), share, lower)
        total = (
            build.vector("SCALE", column, part) if total is None else build.vector("MULTIPLY_ADD", column, part, total)
        )
    return total


class _Texels:
    """Reads texels of the skin's row through the group inside."""

    def __init__(self, build: NodeBuilder, row: RowSockets, inner: bpy.types.NodeTree) -> None:
        self.build, self.row, self.inner = build, row, inner

    def _node(self, texel: Socket | float) -> bpy.types.Node:
        node = _instance(self.build, self.inner, "Texel")
        if TEXEL_NODE not in self.build.tree.nodes:
            node.name = TEXEL_NODE
        for name, value in (("Texel", texel), ("Texel width", self.row.texel_width), ("Row", self.row.row)):
            self.build.give(node.inputs[name], value)
        return node

    def read(self, texel: int) -> tuple[Socket, Socket]:
        """Three numbers and the fourth of a texel that is always the same one."""
        node = self._node(float(texel))
        return node.outputs["Color"], node.outputs["Alpha"]

    def read_at(self, texel: Socket) -> Socket:
        """Three numbers of a texel that depends on the pixel."""
        return self._node(texel).outputs["Color"]


def _instance(build: NodeBuilder, inner: bpy.types.NodeTree, label: str) -> bpy.types.Node:
    node = build.node("ShaderNodeGroup", label)
    node.node_tree = inner
    return node


def _inner_group(name: str, inputs: dict[str, str], outputs: dict[str, str]) -> tuple[NodeBuilder, bpy.types.Node]:
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for in_out, sockets in (("INPUT", inputs), ("OUTPUT", outputs)):
        for socket, kind in sockets.items():
            blender_version.new_group_socket(tree, socket, f"NodeSocket{kind}", in_out, "")
    build = NodeBuilder(tree, 0.0, 0.0)
    return build, build.node("NodeGroupInput")


def _texel_group() -> bpy.types.NodeTree:
    build, entry = _inner_group(
        INNER_GROUPS[0],
        {"Texel": "Float", "Texel width": "Float", "Row": "Float"},
        {"Color": "Color", "Alpha": "Float"},
    )
    center = build.math("ADD", entry.outputs["Texel"], 0.5)
    along = build.math("MULTIPLY", center, entry.outputs["Texel width"])
    lookup = new_lookup(build, build.combine(along, entry.outputs["Row"]), SURFACE_NODE)
    out = build.node("NodeGroupOutput")
    build.give(out.inputs["Color"], lookup.outputs["Color"])
    build.give(out.inputs["Alpha"], lookup.outputs["Alpha"])
    return build.tree


def _lamp_group(profiled: bool) -> bpy.types.NodeTree:
    inputs = {}
    for part in LampTexels.parts(profiled):
        inputs |= {part: "Vector", f"{part} 4": "Float"}
    inputs |= {"far place": "Vector", "facing": "Vector"} | {f"angular {k}": "Vector" for k in range(4)}
    build, entry = _inner_group(INNER_GROUPS[2 if profiled else 1], inputs, {"Irradiance": "Vector"})
    given = entry.outputs
    lamp = LampTexels(*((given[part], given[f"{part} 4"]) for part in LampTexels.parts(profiled)))
    far = FarSide(given["far place"], given["facing"], tuple(given[f"angular {k}"] for k in range(4)))
    out = build.node("NodeGroupOutput")
    build.give(out.inputs["Irradiance"], lamp_irradiance(build, lamp, far, profiled))
    return build.tree


def _far_side(build: NodeBuilder, row: RowSockets, depth_per_mm: Socket, angular: tuple[Socket, ...]) -> FarSide:
    geometry = build.node("ShaderNodeNewGeometry")
    # Blender turns the normal of a face seen from behind towards the viewer.
    turned = build.math("MULTIPLY_ADD", geometry.outputs["Backfacing"], 2.0, -1.0)
    facing = build.vector("SCALE", geometry.outputs["Normal"], turned, label="Out of the far side")
    depth = build.math("MULTIPLY", row.thickness, depth_per_mm)
    place = build.vector("MULTIPLY_ADD", facing, depth, geometry.outputs["Position"], label="Far side")
    return FarSide(place, facing, angular)


def _world(build: NodeBuilder, far: FarSide, coefficients: list[Socket]) -> Socket:
    """The polynomial of skinglow.SurfaceLighting in the far side's normal, not below 0."""
    x, y, z = build.split(far.facing)
    squares = build.math("MULTIPLY_ADD", build.math("MULTIPLY", z, z), 3.0, -1.0)
    difference = build.math("MULTIPLY", build.math("ADD", x, y), build.math("SUBTRACT", x, y))
    products = (build.math("MULTIPLY", a, b) for a, b in ((x, y), (y, z), (x, z)))
    xy, yz, xz = products
    total = coefficients[0]
    for coefficient, term in zip(coefficients[1:], (y, z, x, xy, yz, squares, xz, difference), strict=True):
        total = build.vector("MULTIPLY_ADD", coefficient, term, total)
    return build.vector("MAXIMUM", total, (0.0, 0.0, 0.0))
