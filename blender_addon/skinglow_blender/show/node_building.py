# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds shader nodes from arithmetic expressions, so that formulas in nodes read as formulas."""

import bpy

from .. import blender_version

Socket = bpy.types.NodeSocket
#: What a socket accepts: another socket, or a value.
Value = Socket | float | tuple[float, float, float]

COLUMN, ROW = 160.0, 170.0


class NodeBuilder:
    """Adds nodes to a tree, laid out from left to right in the order of creation."""

    def __init__(self, tree: bpy.types.NodeTree, x: float, y: float, columns: int = 12) -> None:
        """x, y: location of the first node; a new row begins after that many columns."""
        self.tree = tree
        self._left, self._y, self._columns = x, y, columns
        self._count = 0

    def node(self, kind: str, label: str = "") -> bpy.types.Node:
        """A new node at the next location."""
        node = self.tree.nodes.new(kind)
        row, column = divmod(self._count, self._columns)
        node.location = (self._left + COLUMN * column, self._y - ROW * row)
        node.label = label
        # Collapsed: hundreds of open nodes would overlap.
        node.hide = True
        self._count += 1
        return node

    def set(self, socket: Socket, value: Value) -> None:
        """Links a socket, or sets its value."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, tuple) or isinstance(socket.default_value, float):
            socket.default_value = value
        else:
            socket.default_value = (value,) * 3

    def math(self, operation: str, *values: Value, clamp: bool = False, label: str = "") -> Socket:
        """The output of a new ShaderNodeMath."""
        node = self.node("ShaderNodeMath", label)
        node.operation, node.use_clamp = operation, clamp
        for socket, value in zip(node.inputs, values, strict=False):
            self.set(socket, value)
        return node.outputs[0]

    def vector(self, operation: str, *values: Value, label: str = "") -> Socket:
        """The output of a new ShaderNodeVectorMath (SCALE takes a scalar second; DOT_PRODUCT returns one)."""
        node = self.node("ShaderNodeVectorMath", label)
        node.operation = operation
        sockets = (node.inputs[0], node.inputs["Scale"]) if operation == "SCALE" else node.inputs
        for socket, value in zip(sockets, values, strict=False):
            self.set(socket, value)
        return node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]

    def mix(self, a: Value, b: Value, fraction: Value, label: str = "") -> Socket:
        """The vector a + (b - a) fraction."""
        node = self.node("ShaderNodeMix", label)
        node.data_type, node.clamp_factor = "VECTOR", False
        sockets = {socket.identifier: socket for socket in node.inputs}
        for name, value in (("A_Vector", a), ("B_Vector", b), ("Factor_Float", fraction)):
            self.set(sockets[name], value)
        return next(socket for socket in node.outputs if socket.identifier == "Result_Vector")

    def split(self, vector: Socket) -> tuple[Socket, Socket, Socket]:
        """The three components of a vector."""
        node = self.node("ShaderNodeSeparateXYZ")
        self.set(node.inputs[0], vector)
        return tuple(node.outputs)

    def combine(self, x: Value, y: Value, z: Value = 0.0) -> Socket:
        """A vector from its components."""
        node = self.node("ShaderNodeCombineXYZ")
        for socket, value in zip(node.inputs, (x, y, z), strict=True):
            self.set(socket, value)
        return node.outputs[0]

    def instance(self, inner: bpy.types.NodeTree, label: str) -> bpy.types.Node:
        """A new node of an inner group."""
        node = self.node("ShaderNodeGroup", label)
        node.node_tree = inner
        return node

    def attribute(self, kind: str, name: str, label: str) -> bpy.types.Node:
        """A new attribute node; kind is 'GEOMETRY' or 'OBJECT'."""
        node = self.node("ShaderNodeAttribute", label)
        node.attribute_type, node.attribute_name = kind, name
        return node

    def texel(self, coordinate: Socket, name: str) -> bpy.types.Node:
        """A new image node that reads one texel, unfiltered."""
        lookup = self.node("ShaderNodeTexImage", "Transmitted light")
        lookup.name, lookup.extension, lookup.interpolation = name, "EXTEND", "Closest"
        self.set(lookup.inputs["Vector"], coordinate)
        return lookup


def inner_group(name: str, inputs: dict[str, str], outputs: dict[str, str]) -> tuple[NodeBuilder, bpy.types.Node]:
    """A new group with these sockets, name to kind: its builder, and the node of its inputs."""
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for in_out, sockets in (("INPUT", inputs), ("OUTPUT", outputs)):
        for socket, kind in sockets.items():
            blender_version.new_group_socket(tree, socket, kind, in_out, "")
    build = NodeBuilder(tree, 0.0, 0.0)
    return build, build.node("NodeGroupInput")
