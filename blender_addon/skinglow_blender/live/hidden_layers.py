# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers that were not shown while something was undone: Blender does not evaluate there what came back.

What undo deletes and redo brings back has another address. A layer that is shown evaluates that; in one
that is not, the copies from before stay, with the settings of before, and refer to the deleted originals (4.5 to 5.2).
"""

import bpy

from ..session import SESSION


def remember_hidden() -> None:
    """Called after undo: of the layers that Blender does not evaluate now, any may hold copies from before."""
    shown = bpy.context.view_layer
    layers = [layer for scene in bpy.data.scenes for layer in scene.view_layers if layer != shown]
    graphs = [layer.depsgraph for layer in layers]
    SESSION.undone_graphs.update(graph.as_pointer() for graph in graphs if graph is not None)


def is_of_before(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether what is evaluated may be of before an undo: nothing is to be read from it until it is evaluated anew."""
    return depsgraph.mode == "VIEWPORT" and depsgraph.as_pointer() in SESSION.undone_graphs


def evaluate_anew(depsgraph: bpy.types.Depsgraph) -> None:
    """Has Blender evaluate all data of such a layer. Not for handlers, which are called by what evaluates."""
    if not is_of_before(depsgraph):
        return
    # Until a graph is built anew it knows what came back by its old address, and tags of that do not reach it.
    depsgraph.update()
    for data in bpy.data.user_map():
        data.update_tag()
        tree = getattr(data, "node_tree", None)
        if tree is not None:
            tree.update_tag()
    SESSION.undone_graphs.discard(depsgraph.as_pointer())
    depsgraph.update()
