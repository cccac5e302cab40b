# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of node sockets, as far as they are known without evaluating the nodes."""

import bpy


def linked_node(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    """The node linked to an input, as `linked_socket` finds it; None if nothing is linked."""
    link = linked_socket(socket)
    return link.node if link is not None else None


def linked_socket(socket: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """The output linked to an input; None if nothing is linked.

    Skips reroutes, and muted nodes where Blender passes an input of theirs on; a muted link is none.
    """
    if not socket.is_linked:
        return None
    found = None
    while True:
        for link in socket.links:
            if not link.is_muted:
                break
        else:
            # Behind a reroute without an input the reroute itself remains.
            return found
        found = link.from_socket
        node = found.node
        if node.mute:
            passed = next((inner for inner in node.internal_links if inner.to_socket == found), None)
            if passed is None:
                return None
            socket, found = passed.from_socket, None
        elif node.bl_idname == "NodeReroute":
            socket = node.inputs[0]
        else:
            return found


def socket_value(socket: bpy.types.NodeSocket) -> tuple[object, str]:
    """An input's value and a note of what is not supported.

    Unlinked values and RGB and Value nodes are supported. For any other linked node the socket's own value is returned,
    and the note says so.
    """
    node = linked_node(socket)
    if node is None:
        return socket.default_value, ""
    if node.bl_idname in ("ShaderNodeRGB", "ShaderNodeValue"):
        value = node.outputs[0].default_value
        if socket.type == "RGBA" and isinstance(value, float):
            return (value, value, value), ""
        if socket.type == "VALUE" and not isinstance(value, float):
            return socket.default_value, f"its node '{node.name}' is a color linked to {socket.name}"
        return value, ""
    return (
        socket.default_value,
        f"its node '{node.name}' is not supported; the value stored in the {socket.name} input is used",
    )
