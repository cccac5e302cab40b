# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes written like arithmetic, so that a formula in nodes can be read as one."""

import bpy

Socket = bpy.types.NodeSocket
#: What can go into a socket: another one, or a value.
Value = Socket | float | tuple[float, float, float]

COLUMN, ROW = 160.0, 170.0


class NodeBuilder:
    """Adds nodes to a tree, from left to right in the order in which they are asked for."""

    def __init__(self, tree: bpy.types.NodeTree, x: float, y: float, columns: int = 12) -> None:
        """x, y: where the first node stands; after that many columns a new row begins."""
        self.tree = tree
        self._left, self._y, self._columns = x, y, columns
        self._count = 0

    def node(self, kind: str, label: str = "") -> bpy.types.Node:
        """A new node at the next place."""
        node = self.tree.nodes.new(kind)
        row, column = divmod(self._count, self._columns)
        node.location = (self._left + COLUMN * column, self._y - ROW * row)
        node.label = label
        # Hundreds of open nodes hide each other.
        node.hide = True
        self._count += 1
        return node

    def give(self, socket: Socket, value: Value) -> None:
        """Links a socket, or sets its own value."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, tuple) or isinstance(socket.default_value, float):
            socket.default_value = value
        else:
            socket.default_value = (value,) * 3

    def math(self, operation: str, *values: Value, clamp: bool = False, label: str = "") -> Socket:
        """A number from numbers, by ShaderNodeMath."""
        node = self.node("ShaderNodeMath", label)
        node.operation, node.use_clamp = operation, clamp
        for socket, value in zip(node.inputs, values, strict=False):
            self.give(socket, value)
        return node.outputs[0]

    def vector(self, operation: str, *values: Value, label: str = "") -> Socket:
        """A vector from vectors (SCALE takes a number second), by ShaderNodeVectorMath; of DOT_PRODUCT the number."""
        node = self.node("ShaderNodeVectorMath", label)
        node.operation = operation
        sockets = (node.inputs[0], node.inputs["Scale"]) if operation == "SCALE" else node.inputs
        for socket, value in zip(sockets, values, strict=False):
            self.give(socket, value)
        return node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]

    def split(self, vector: Socket) -> tuple[Socket, Socket, Socket]:
        """The three numbers of a vector."""
        node = self.node("ShaderNodeSeparateXYZ")
        self.give(node.inputs[0], vector)
        return tuple(node.outputs)

    def combine(self, x: Value, y: Value, z: Value = 0.0) -> Socket:
        """A vector of three numbers."""
        node = self.node("ShaderNodeCombineXYZ")
        for socket, value in zip(node.inputs, (x, y, z), strict=True):
            self.give(socket, value)
        return node.outputs[0]
