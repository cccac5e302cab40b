# SPDX-License-Identifier: GPL-3.0-or-later
"""The inner groups of a skin's node group: they are made with it and stay, whatever its other nodes are.

In a window Blender stores the undo step of an edit before the update that follows it, so what an update edits is in no
step. Blender 4.5 to 5.2 crash in an undo where a datablock points to one that no step has. So an update may replace
nodes only: inner groups and images are made by operators, and are kept by nodes without connections.
"""

from collections.abc import Callable, Iterable

import bpy

from .light_term_nodes import FarSide, LightTexels, light_irradiance
from .node_building import NodeBuilder, inner_group

#: The node that keeps the inner group which reads a texel of the row, and the image node in it.
TEXEL_NODE, SURFACE_NODE = "LUT texel", "LUT"
#: The same for a texel of the tiles.
TILE_NODE, TILE_IMAGE_NODE = "Tile texel", "Tile"
#: Those that keep the inner groups of one light, without and with a profile.
LIGHT_NODE, PROFILED_NODE = "Light", "Light with profile"


def _texel_group(name: str) -> bpy.types.NodeTree:
    build, entry = inner_group(
        name, {"Texel": "Float", "Texel width": "Float", "Row": "Float"}, {"Color": "Color", "Alpha": "Float"}
    )
    center = build.math("ADD", entry.outputs["Texel"], 0.5)
    u = build.math("MULTIPLY", center, entry.outputs["Texel width"])
    lookup = build.texel(build.combine(u, entry.outputs["Row"]), SURFACE_NODE)
    out = build.node("NodeGroupOutput")
    build.set(out.inputs["Color"], lookup.outputs["Color"])
    build.set(out.inputs["Alpha"], lookup.outputs["Alpha"])
    return build.tree


def _tile_group(name: str) -> bpy.types.NodeTree:
    build, entry = inner_group(name, {"Texel": "Vector"}, {"Color": "Color"})
    texel = build.texel(entry.outputs["Texel"], TILE_IMAGE_NODE)
    build.set(build.node("NodeGroupOutput").inputs["Color"], texel.outputs["Color"])
    return build.tree


def _light_group(name: str, profiled: bool = False) -> bpy.types.NodeTree:
    inputs = {}
    for part in LightTexels.parts(profiled):
        inputs |= {part: "Vector", f"{part} 4": "Float"}
    inputs |= {"far point": "Vector", "normal": "Vector"} | {f"angular {k}": "Vector" for k in range(4)}
    build, entry = inner_group(name, inputs, {"Irradiance": "Vector"})
    given = entry.outputs
    light = LightTexels(*((given[part], given[f"{part} 4"]) for part in LightTexels.parts(profiled)))
    far = FarSide(given["far point"], given["normal"], tuple(given[f"angular {k}"] for k in range(4)))
    out = build.node("NodeGroupOutput")
    build.set(out.inputs["Irradiance"], light_irradiance(build, light, far, profiled))
    return build.tree


def _profiled_group(name: str) -> bpy.types.NodeTree:
    return _light_group(name, profiled=True)


#: By the node that keeps each: its name, by which files hold it, and what makes it.
INNER_GROUPS: dict[str, tuple[str, Callable[[str], bpy.types.NodeTree]]] = {
    TEXEL_NODE: (".Skinglow texel", _texel_group),
    TILE_NODE: (".Skinglow tile", _tile_group),
    LIGHT_NODE: (".Skinglow light", _light_group),
    PROFILED_NODE: (".Skinglow light with profile", _profiled_group),
}
#: The beginning of the lights' names before version 4.
EARLIER_NAME = ".Skinglow lamp"


def inner_groups_of(group: bpy.types.NodeTree) -> dict[str, bpy.types.NodeTree]:
    """The inner groups that a skin group keeps, by the node that keeps each."""
    found = {}
    for name in INNER_GROUPS:
        node = group.nodes.get(name)
        if node is not None and node.bl_idname == "ShaderNodeGroup" and node.node_tree is not None:
            found[name] = node.node_tree
    return found


def has_inner_groups(group: bpy.types.NodeTree) -> bool:
    """Whether a skin group has all of them; those of earlier versions have not."""
    return len(inner_groups_of(group)) == len(INNER_GROUPS)


def clear(group: bpy.types.NodeTree, keep: bool = True) -> None:
    """Deletes a skin group's nodes but those that keep its inner groups; makes the inner groups that it lacks.

    keep  False: all of them are made anew
    """
    kept = inner_groups_of(group) if keep else {}
    left = {n.node_tree for n in group.nodes if n.bl_idname == "ShaderNodeGroup"} - {None, *kept.values()}
    group.nodes.clear()
    build = NodeBuilder(group, -1300.0, 500.0)
    for name, (tree_name, make) in INNER_GROUPS.items():
        tree = kept.get(name) or make(tree_name)
        build.instance(tree, "Kept for other lights").name = name
    remove_unused(left)


def delete_group(group: bpy.types.NodeTree) -> None:
    """Deletes a skin group, and its inner groups where nothing else uses them."""
    inner = {n.node_tree for n in group.nodes if n.bl_idname == "ShaderNodeGroup"} - {None}
    bpy.data.node_groups.remove(group)
    remove_unused(inner)


def remove_unused(trees: Iterable[bpy.types.NodeTree]) -> None:
    """Deletes those of these trees that are inner groups and that nothing uses."""
    names = (*(name for name, _make in INNER_GROUPS.values()), EARLIER_NAME)
    for tree in trees:
        if tree.library is None and tree.users == 0 and tree.name.startswith(names):
            bpy.data.node_groups.remove(tree)
