"""Undo and redo of edits after which the update of the skins needs other nodes (stored_edits.py).

What the update edits is in no step. Blender 4.5 to 5.2 crash in an undo where that made a datablock that another points
to, without any add-on too.
"""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.session import SESSION
from skinglow_blender.show.group_nodes import nodes_of
from skinglow_blender.show.lut_image import images_of

from inside.scenes import add_light, black_material, depsgraph
from inside.stored_edits import edit_and_store
from inside.tile_scenes import block
from inside.walk_files import THIN, expected

sb.register()


def skin():
    return bpy.data.objects["Ear"]


def require_fresh():
    """What the skin shows is what is computed when nothing is remembered."""
    graph = depsgraph()
    sb.update(graph)
    obj = skin()
    shown = sb.lut(obj, graph)
    if obj.skinglow.weights == "OBJECT":
        np.testing.assert_allclose(shown, expected(obj, graph), rtol=5e-6, atol=1e-7)
    SESSION.forget_tables()
    sb.update(graph)
    np.testing.assert_array_equal(shown, sb.lut(obj, graph))
    assert not sb.health(obj)


def begin(weights):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    sb.register()
    obj = block("Ear", 10.0, (0.0, 0.0, 0.0), black_material())
    add_light("Key", location=(0.0, 0.0, -30.0))
    sb.make_skin(obj, thickness=THIN * 2, unit_mm=1.0, mode="physical", weights=weights)
    depsgraph()
    # Without a window there are no steps before this.
    bpy.ops.ed.undo_push(message="begin")
    edit_and_store(lambda: add_light("Fill", location=(5.0, 0.0, -30.0)))
    require_fresh()


def there_and_back(edits):
    """Each edit with a step of its own, then undo to the beginning, and redo to the end, twice; and back once.

    Returns the different nodes that the skin's group had.
    """
    nodes = {nodes_of(skin().skinglow.group)}
    for run in edits:
        edit_and_store(run)
        require_fresh()
        nodes.add(nodes_of(skin().skinglow.group))
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo) * 2:
        for _edit in edits:
            step()
            require_fresh()
    bpy.ops.ed.undo()
    require_fresh()
    return nodes


def set_weights(weights):
    return lambda: setattr(skin().skinglow, "weights", weights)


def check_more_lights(_work):
    begin("surface")
    kinds = ("POINT", "SUN", "SPOT", "AREA", "SPOT", "AREA")
    nodes = there_and_back(
        [lambda n=n, kind=kind: add_light(kind, kind, location=(n, 0.0, -20.0)) for n, kind in enumerate(kinds)]
    )
    assert len(nodes) > 1, nodes


def check_light_per_object_per_pixel_and_through_the_shape(_work):
    begin("object")
    nodes = there_and_back([set_weights(each) for each in ("SURFACE", "SHAPE", "OBJECT", "SHAPE", "SURFACE")])
    assert len(nodes) > 1, nodes


def check_a_copied_group(_work):
    begin("shape")

    def copy():
        node = next(n for n in skin().data.materials[0].node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
        other = block("Other", 10.0, (30.0, 0.0, 0.0), black_material("Other"))
        other.data.materials[0] = skin().data.materials[0].copy()
        node = next(n for n in other.data.materials[0].node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
        node.node_tree = node.node_tree.copy()

    there_and_back([copy, set_weights("SURFACE"), set_weights("OBJECT")])


def check_a_deleted_image(_work):
    begin("object")
    if bpy.app.version[:2] == (5, 0):
        return  # crashes over any image that another one's custom property points to, also without the add-on
    edit_and_store(lambda: bpy.data.images.remove(images_of(skin().skinglow.group)[3]))
    edit_and_store(set_weights("SURFACE"))
    depsgraph()
    assert [fault.what for fault in sb.health(skin())] == ["An image of its lookup was deleted"]
    for step in (bpy.ops.ed.undo, bpy.ops.ed.redo, bpy.ops.ed.undo):
        step()
        depsgraph()
    bpy.context.view_layer.objects.active = skin()
    assert bpy.ops.skinglow.repair("EXEC_DEFAULT", True) == {"FINISHED"}
    require_fresh()
    there_and_back([set_weights("SURFACE")])
