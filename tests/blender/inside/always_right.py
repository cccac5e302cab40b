"""After whatever people do in Blender, the lookup shown equals a fresh computation. One check for each kind of deed."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.lut_image import images_of

from inside.scenes import add_light, assert_fresh, assert_shows, depsgraph, fresh_table, link, paper_table, patch

THIN = [0.0, 1.0, 2.0, 3.0]


def skin(name="Patch", **settings):
    obj = patch(name)
    sb.make_skin(obj, thickness=THIN, **{"mode": "paper", **settings})
    return obj


def check_add_duplicate_rename_delete(_work):
    obj = skin()
    key = add_light("Key", color=(1.0, 0.3, 0.1))
    assert_fresh(obj)
    copy = link(key.copy())
    copy.location.x = 2.0
    assert_fresh(obj)
    copy.data = copy.data.copy()
    copy.data.color = (0.0, 1.0, 0.0)
    assert_fresh(obj)
    copy.name, key.name = "Key", "Other"
    assert_fresh(obj)
    bpy.data.objects.remove(copy)
    assert_fresh(obj)
    bpy.data.lights.remove(key.data)
    assert_fresh(obj)


def check_hide_and_exclude(_work):
    obj = skin()
    collection = bpy.data.collections.new("Rig")
    bpy.context.scene.collection.children.link(collection)
    key, fill = add_light("Key"), add_light("Fill", color=(0.0, 0.5, 1.0), collection=collection)
    assert_fresh(obj)
    both = sb.lut(obj, depsgraph())
    layer = bpy.context.view_layer.layer_collection.children["Rig"]
    for owner, name in (
        (layer, "exclude"),
        (layer, "hide_viewport"),
        (collection, "hide_viewport"),
        (fill, "hide_viewport"),
    ):
        setattr(owner, name, True)
        assert_fresh(obj)
        assert_shows(obj, paper_table([key]))
        setattr(owner, name, False)
        assert_fresh(obj)
        np.testing.assert_array_equal(sb.lut(obj, depsgraph()), both)
    fill.hide_set(True)
    assert_shows(obj, paper_table([key]))
    fill.hide_set(False)
    fill.hide_render = True
    assert_shows(obj, paper_table([key, fill]))


def check_a_skin_that_was_hidden_shows_the_light_of_now(_work):
    """Not that of when it was hidden: with H, its eye or its collection."""
    obj = skin()
    collection = bpy.data.collections.new("Heads")
    bpy.context.scene.collection.children.link(collection)
    key = add_light("Key")
    other = skin("Other")
    collection.objects.link(other)
    bpy.context.scene.collection.objects.unlink(other)
    layer = bpy.context.view_layer.layer_collection.children["Heads"]

    def hide(hidden):
        other.hide_set(hidden)

    ways = [hide]
    for owner, name in ((other, "hide_viewport"), (layer, "hide_viewport"), (layer, "exclude")):
        ways.append(lambda hidden, owner=owner, name=name: setattr(owner, name, hidden))
    for number, way in enumerate(ways):
        assert_fresh(other)
        way(True)
        depsgraph()
        key.data.color = (0.1, 0.2 * number, 1.0)
        key.location.x += 0.5
        depsgraph()
        way(False)
        assert_fresh(other)
        assert_fresh(obj)


def check_parent_constrain_drive(_work):
    obj = skin()
    holder = link(bpy.data.objects.new("Holder", None))
    key = add_light("Key")
    key.parent = holder
    assert_fresh(obj)
    holder.location = (1.0, 2.0, 3.0)
    holder.scale = (2.0, 2.0, 0.5)
    assert_fresh(obj)
    key.parent = None
    constraint = key.constraints.new("COPY_LOCATION")
    constraint.target = holder
    assert_fresh(obj)
    holder.location.x = -1.0
    assert_fresh(obj)
    key.constraints.remove(constraint)
    driver = key.data.driver_add("color", 0).driver
    variable = driver.variables.new()
    variable.name = "place"
    variable.type = "TRANSFORMS"
    variable.targets[0].id = holder
    variable.targets[0].transform_type = "LOC_X"
    driver.expression = "abs(place) * 0.25"
    holder.location.x = 2.0
    assert_fresh(obj)
    holder.location.x = 3.0
    assert_fresh(obj)
    assert abs(key.evaluated_get(depsgraph()).data.color[0] - 0.75) < 1e-6


def check_instanced_collections(_work):
    obj = skin()
    rig = bpy.data.collections.new("Rig")
    add_light("Inside", color=(1.0, 0.2, 0.0), collection=rig)
    nest = bpy.data.collections.new("Nest")
    nested = bpy.data.objects.new("Nested", None)
    nested.instance_type, nested.instance_collection = "COLLECTION", rig
    nested.location = (0.0, 0.0, 0.5)
    nest.objects.link(nested)
    instancers = []
    for i in range(2):
        empty = link(bpy.data.objects.new(f"Instancer {i}", None))
        empty.instance_type, empty.instance_collection = "COLLECTION", (rig, nest)[i]
        empty.location = (i, 1.0, 0.0)
        instancers.append(empty)
    assert_fresh(obj)
    assert len(sb.light_report(obj, depsgraph())) == 2
    for empty in instancers:
        empty.location.y += 1.5
        assert_fresh(obj)
    bpy.data.lights["Inside"].color = (0.0, 0.0, 1.0)
    assert_fresh(obj)
    instancers[0].hide_viewport = True
    assert_fresh(obj)
    instancers[1].instance_type = "NONE"
    assert_fresh(obj)


def check_animation_and_frame_changes(_work):
    obj = skin()
    key = add_light("Key")
    scene = bpy.context.scene
    for frame, z, energy in ((1, 1.0, 10.0), (10, 4.0, 20.0), (11, 4.0, 0.0)):
        key.location.z, key.data.energy = z, energy
        key.keyframe_insert("location", frame=frame)
        key.data.keyframe_insert("energy", frame=frame)
    seen = set()
    for frame in (1, 5, 10, 11, 3, 1):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        np.testing.assert_allclose(sb.lut(obj, graph), fresh_table(obj, graph), rtol=3e-6)
        seen.add(float(sb.lut(obj, graph)[0, 0]))
    assert len(seen) == 5


def check_move_and_scale_the_skin(_work):
    add_light("Key", location=(0.5, 0.25, 1.0))
    obj = skin()
    obj.location = (1.0, -0.5, 0.25)
    assert_fresh(obj)
    before = obj["skinglow_lut"][0]
    obj.scale = (2.0, 2.0, 2.0)
    assert_fresh(obj)
    # Twice as large is twice as thick: the attribute holds half of it.
    assert abs(obj["skinglow_lut"][0] / before - 2.0) < 1e-6
    obj.rotation_euler = (0.3, 1.0, 0.2)
    assert_fresh(obj)
    obj.modifiers.new("Array", "ARRAY").count = 3
    assert_fresh(obj)


def check_skins_on_shared_and_own_materials(_work):
    add_light("Key", location=(0.0, 0.0, 1.0))
    shared = bpy.data.materials.new("Shared")
    first = patch("First", material=shared)
    second = patch("Second", location=(2.0, 0.0, 0.0), material=shared)
    third = patch("Third", location=(0.0, 3.0, 0.0), material=bpy.data.materials.new("Own"))
    skins = [first, second, third]
    for obj in skins:
        sb.make_skin(obj, thickness=THIN, mode="paper")
    assert_fresh(*skins)
    assert len({obj.skinglow.row for obj in skins}) == 3
    # A copy has the row of what it was copied from until the add-on gives it its own; so has a copy of a copy.
    for original in (second, second, third):
        copy = link(original.copy())
        copy.location.z = 0.3 * len(skins)
        skins.append(copy)
        assert_fresh(*skins)
    linked = link(skins[-1].copy())
    linked.data = linked.data.copy()
    skins.append(linked)
    assert_fresh(*skins)
    assert len({obj.skinglow.row for obj in skins}) == len(skins)
    bpy.data.objects.remove(skins.pop(1))
    assert_fresh(*skins)


def check_more_skins_than_rows(_work):
    add_light("Key", location=(0.0, 0.0, 1.0))
    skins = [skin()]
    for i in range(40):
        copy = link(skins[0].copy())
        copy.location.x = 0.1 * i
        skins.append(copy)
    assert_fresh(*skins)
    sizes = {tuple(image.size) for image in images_of(skins[0].skinglow.group)}
    assert sizes == {(256, 64)}, sizes


def check_light_linking(_work):
    if bpy.app.version < (4, 0, 0):
        return
    key, fill = add_light("Key"), add_light("Fill", color=(0.0, 0.5, 1.0))
    one, two = skin("One"), skin("Two")
    receivers = bpy.data.collections.new("Receivers")
    receivers.objects.link(one)
    fill.light_linking.receiver_collection = receivers
    assert_shows(one, paper_table([key, fill]))
    assert_shows(two, paper_table([key]))
    receivers.collection_objects[0].light_linking.link_state = "EXCLUDE"
    sb.update(depsgraph())
    assert_shows(one, paper_table([key]))
    assert_shows(two, paper_table([key, fill]))
    fill.light_linking.receiver_collection = None
    assert_shows(one, paper_table([key, fill]))


def check_driven_and_animated_settings(_work):
    """Keyed strength and blood weight follow the frame."""
    key = add_light("Key")
    obj = skin()
    for frame, strength, red in ((1, 1.0, 1.8), (5, 3.0, 0.6)):
        obj.skinglow.strength = strength
        obj.skinglow.blood_weight[0] = red
        obj.keyframe_insert("skinglow.strength", frame=frame)
        obj.keyframe_insert("skinglow.blood_weight", index=0, frame=frame)
    for frame, strength, red in ((1, 1.0, 1.8), (5, 3.0, 0.6), (1, 1.0, 1.8)):
        bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        expected = paper_table([key]).astype(float)
        expected[:, 0] *= (red + 0.5) / 2.3
        np.testing.assert_allclose(sb.lut(obj, graph), expected, rtol=1e-6)
        assert abs(obj["skinglow_lut"][3] - strength) < 1e-6


def check_live_off_waits_for_update(_work):
    key = add_light("Key")
    obj = skin(live=False)
    before = sb.lut(obj, depsgraph())
    key.data.color = (0.0, 0.0, 1.0)
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)
    assert [r.skin for r in sb.update(depsgraph())] == ["Patch"]
    assert_fresh(obj)
    key.data.color = (1.0, 0.0, 1.0)
    obj.skinglow.live = True
    assert_fresh(obj)


def check_remove_without_trace(_work):
    add_light("Key")
    material = bpy.data.materials.new("Skin")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    nodes = {(n.bl_idname, n.name) for n in material.node_tree.nodes}
    links = {(a.from_socket.name, a.to_socket.name) for a in material.node_tree.links}
    obj, other = patch("One", material=material), patch("Two", material=material)
    attributes = set(obj.data.attributes.keys())
    before = {
        name: len(getattr(bpy.data, name)) for name in ("images", "node_groups", "materials", "meshes", "objects")
    }
    for each in (obj, other):
        sb.make_skin(each, thickness=THIN, mode="paper")
    sb.remove_skin(obj)
    assert_fresh(other)
    assert "skinglow_thickness" not in obj.data.attributes
    sb.remove_skin(other)
    depsgraph()
    assert {(n.bl_idname, n.name) for n in material.node_tree.nodes} == nodes
    assert {(a.from_socket.name, a.to_socket.name) for a in material.node_tree.links} == links
    assert set(obj.data.attributes.keys()) == attributes
    assert not [key for each in (obj, obj.data) for key in each.keys() if "skinglow" in key and key != "skinglow"]
    assert {name: len(getattr(bpy.data, name)) for name in before} == before
    # And on again.
    sb.make_skin(obj, thickness=THIN, mode="paper")
    assert_fresh(obj)
