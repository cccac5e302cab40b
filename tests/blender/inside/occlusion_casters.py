"""What casts shadows on skin and what does not, after whatever is done to it: edited, hidden, undone, loaded."""

import bpy
import skinglow_blender as sb

from inside.occlusion import brightness, head, point_light, row_of, switch, wall
from inside.scenes import depsgraph, link


def check_edited_and_modified_meshes(_work):
    point_light()
    obj = head()
    free = brightness(obj)
    switch()
    between = wall(location=(5.0, 0.0, 0.5))
    assert brightness(obj) == free
    for vertex in between.data.vertices:
        vertex.co.x -= 5.0
    between.data.update()
    assert brightness(obj) == 0.0
    between.modifiers.new("Away", "DISPLACE").strength = 3.0  # along its normal, up
    assert brightness(obj) == free
    between.modifiers.clear()
    assert brightness(obj) == 0.0
    key = between.shape_key_add(name="Basis")
    key = between.shape_key_add(name="Aside")
    for point in key.data:
        point.co.x += 5.0
    key.value = 1.0
    assert brightness(obj) == free
    key.value = 0.0
    assert brightness(obj) == 0.0


def check_edit_mode(_work):
    point_light()
    obj = head()
    switch()
    between = wall()
    assert brightness(obj) == 0.0
    bpy.context.view_layer.objects.active = between
    bpy.ops.object.mode_set(mode="EDIT")
    assert brightness(obj) == 0.0
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(5.0, 0.0, 0.0))
    assert brightness(obj) > 0.0
    bpy.ops.object.mode_set(mode="OBJECT")
    assert brightness(obj) > 0.0
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    lit = brightness(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert lit == brightness(obj) > 0.0


def check_what_does_not_cast(_work):
    point_light()
    obj = head()
    free = brightness(obj)
    switch()
    between = wall()
    collection = bpy.data.collections.new("Set")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(between)
    collection.objects.link(between)
    layer = bpy.context.view_layer.layer_collection.children["Set"]
    for owner, name, value in (
        (between, "visible_shadow", False),
        (between, "hide_viewport", True),
        (layer, "exclude", True),
        (layer, "hide_viewport", True),
        (collection, "hide_viewport", True),
    ):
        assert brightness(obj) == 0.0, name
        before = getattr(owner, name)
        setattr(owner, name, value)
        assert brightness(obj) == free, name
        setattr(owner, name, before)
    between.hide_set(True)
    sb.update(depsgraph())
    assert brightness(obj) == free
    between.hide_set(False)
    sb.update(depsgraph())
    assert brightness(obj) == 0.0
    # A light that casts no shadows.
    data = bpy.data.lights["Key"]
    owner, name = (data.cycles, "cast_shadow") if hasattr(data.cycles, "cast_shadow") else (data, "use_shadow")
    setattr(owner, name, False)
    data.update_tag()  # what add-ons define reports nothing by itself
    assert brightness(obj) == free


def check_curves_and_instances_cast(_work):
    point_light()
    obj = head()
    free = brightness(obj)
    switch()
    curve = bpy.data.curves.new("Disc", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    spline = curve.splines.new("POLY")
    spline.points.add(3)
    for point, (x, y) in zip(spline.points, ((-1, -1), (1, -1), (1, 1), (-1, 1)), strict=True):
        point.co = (x, y, 0.0, 1.0)
    spline.use_cyclic_u = True
    disc = link(bpy.data.objects.new("Disc", curve))
    disc.location.z = 0.5
    assert brightness(obj) == 0.0
    bpy.data.objects.remove(disc)
    assert brightness(obj) == free
    collection = bpy.data.collections.new("Props")
    collection.objects.link(bpy.data.objects.new("Prop", wall(location=(9.0, 0.0, 0.0)).data))
    empty = link(bpy.data.objects.new("Instancer", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.location.z = 0.5
    assert brightness(obj) == 0.0
    empty.location.x = 5.0
    assert brightness(obj) == free
    empty.location.x, empty.visible_shadow = 0.0, False
    assert brightness(obj) == free


def check_another_skin_casts(_work):
    point_light()
    obj = head()
    switch()
    free = brightness(obj)
    other = head("Other", radius=0.3, location=(0.0, 0.0, 0.5))
    assert brightness(obj) == 0.0
    assert brightness(other) > 0.0
    other.location.x = 3.0
    assert brightness(obj) == free


def check_a_skin_that_is_hidden_or_flat(_work):
    point_light()
    obj = head()
    switch()
    between = wall()
    layer = bpy.context.view_layer.layer_collection
    collection = bpy.data.collections.new("Cast")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(obj)
    collection.objects.link(obj)
    layer.children["Cast"].hide_viewport = True
    sb.update(depsgraph())
    layer.children["Cast"].hide_viewport = False
    sb.update(depsgraph())
    assert brightness(obj) == 0.0
    obj.scale = (1.0, 1.0, 0.0)
    sb.update(depsgraph())
    obj.scale = (-1.0, 1.0, 2.0)  # mirrored: its far sides still face outwards
    between.location.x = 5.0
    lit = brightness(obj)
    assert lit > 0.0 and row_of(obj)["visible"] == 1.0


def check_undo_save_and_load(work):
    point_light()
    free = brightness(head())
    switch()
    wall(location=(5.0, 0.0, 0.5))
    depsgraph()
    bpy.ops.ed.undo_push(message="aside")
    bpy.data.objects["Wall"].location.x = 0.0
    assert brightness(bpy.data.objects["Head"]) == 0.0
    bpy.ops.ed.undo_push(message="between")
    bpy.ops.ed.undo()
    sb.update(depsgraph())
    assert brightness(bpy.data.objects["Head"]) == free
    bpy.ops.ed.redo()
    sb.update(depsgraph())
    assert brightness(bpy.data.objects["Head"]) == 0.0
    path = str(work / "occluded.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not bpy.context.scene.skinglow.occlusion
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.context.scene.skinglow.occlusion
    assert brightness(bpy.data.objects["Head"]) == 0.0
    bpy.data.objects["Wall"].location.x = 5.0
    assert brightness(bpy.data.objects["Head"]) == free
