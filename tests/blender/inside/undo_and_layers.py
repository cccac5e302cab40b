"""A skin that undo deleted and redo brought back, seen in a view layer that was not shown meanwhile."""

import bpy
import numpy as np
import skinglow_blender as sb

from inside.scenes import add_light, depsgraph, patch
from inside.walk_files import THIN, expected

sb.register()

#: Blender 3.4 crashes when a layer is shown that was not while something was undone, also without add-ons.
ONE_LAYER = bpy.app.version < (4, 0, 0)


def push():
    depsgraph()
    bpy.ops.ed.undo_push(message="step")


def show(name):
    layers = bpy.context.scene.view_layers
    bpy.context.window_manager.windows[0].view_layer = layers[name]
    graph = depsgraph()
    sb.update(graph)
    return graph


def require_fresh(graph):
    """What is shown is computed of the skin as it is, and evaluated data is of what there is."""
    obj = bpy.data.objects["Patch"]
    np.testing.assert_allclose(sb.lut(obj, graph), expected(obj, graph), rtol=5e-6, atol=1e-7)
    # The originals' own numbers: what a copy refers to may be deleted.
    assert obj.evaluated_get(graph)["edits"] == obj["edits"]
    assert obj.evaluated_get(graph).data["edits"] == obj.data["edits"]
    material = obj.material_slots[0].material
    for data in (material, material.node_tree, obj.skinglow.group):
        assert data.evaluated_get(graph)["edits"] == data["edits"], data


def edit(number, mode):
    obj = bpy.data.objects["Patch"]
    material = obj.material_slots[0].material
    for data in (obj, obj.data, material, material.node_tree, obj.skinglow.group):
        data["edits"] = number
        data.update_tag()
    obj.skinglow.mode = mode


def check_brought_back_in_another_layer(_work):
    scene = bpy.context.scene
    first, *others = names = [scene.view_layers[0].name] + [
        scene.view_layers.new(name).name for name in ("Second", "Third") if not ONE_LAYER
    ]
    for name in names:
        show(name)
    show(first)
    add_light("Key")
    push()
    sb.make_skin(patch(), thickness=THIN, mode="paper")
    edit(0, "PAPER")
    for name in (*others, first):
        require_fresh(show(name))
    push()
    edit(1, "EXISTING")
    push()
    for _ in range(2):
        bpy.ops.ed.undo()
    assert "Patch" not in bpy.data.objects
    for _ in range(2):
        bpy.ops.ed.redo()
    assert bpy.data.objects["Patch"].skinglow.mode == "EXISTING"
    for name in (first, *others, first):
        require_fresh(show(name))
        # Once: then nothing is evaluated for it.
        assert sb.update(depsgraph()) == []
    edit(2, "PAPER")
    for name in (first, *others):
        require_fresh(show(name))
