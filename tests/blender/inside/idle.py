"""What cannot change a skin is not looked at: counted by how often the scene is read, and every object of it."""

from contextlib import contextmanager

import bpy
import skinglow_blender as sb
from skinglow_blender.live import handlers, live_update

from inside.scenes import add_light, assert_fresh, assert_shows, black_material, depsgraph, link, paper_table, patch


@contextmanager
def counted_readings():
    """The number of times that the scene is read, in a list, and that all its objects are looked at."""
    count, read_scene, look_for_skins = [0, 0], live_update.read_scene, handlers.skins_of_file

    def counting(graph, known=None):
        count[0] += 1
        count[1] += known is None
        return read_scene(graph, known)

    def looking():
        count[1] += 1
        return look_for_skins()

    live_update.read_scene, handlers.skins_of_file = counting, looking
    try:
        yield count
    finally:
        live_update.read_scene, handlers.skins_of_file = read_scene, look_for_skins


def add_empty(name="Empty"):
    return link(bpy.data.objects.new(name, None))


def check_file_without_skins(_work):
    empty, key, obj = add_empty(), add_light(), patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    sb.remove_skin(obj)
    depsgraph()
    with counted_readings() as count:
        for step in range(3):
            empty.location.x = obj.location.x = step
            key.data.energy = 10.0 + step
            depsgraph()
            bpy.context.scene.frame_set(step)
        assert count == [0, 0]
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
        assert count[0] > 0


def check_edits_that_move_no_light_and_no_skin(_work):
    key, empty, plain, obj = add_light(), add_empty(), patch("Plain", material=black_material()), patch("Skin")
    for nodes in ("Modifier", "Moved with it"):
        if hasattr(bpy.types, "GeometryNodeTree"):
            add_geometry_nodes(patch(nodes))
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    plain.data.materials[0].node_tree.nodes[0].inputs["Strength"].default_value = 0.1
    depsgraph()
    with counted_readings() as count:
        for edit in (
            lambda: setattr(empty, "location", (1.0, 0.0, 0.0)),
            lambda: setattr(plain, "location", (0.0, 2.0, 0.0)),
            lambda: setattr(plain.data.vertices[0], "co", (0.0, 0.0, 1.0)) or plain.data.update(),
            lambda: setattr(plain.data.materials[0].node_tree.nodes[0].inputs["Strength"], "default_value", 0.2),
            lambda: setattr(bpy.data.objects["Modifier"], "location", (0.0, 3.0, 0.0)),
            lambda: plain.select_set(True),
            lambda: plain.hide_set(True),
            lambda: plain.hide_set(False),
        ):
            edit()
            depsgraph()
            assert count == [0, 0], edit.__code__.co_firstlineno
    assert_shows(obj, paper_table([key]))


def add_geometry_nodes(obj):
    tree = bpy.data.node_groups.new("Plain nodes", "GeometryNodeTree")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", "NodeGroupOutput")]
    for into in ("INPUT", "OUTPUT"):
        if hasattr(tree, "interface"):
            tree.interface.new_socket("Geometry", in_out=into, socket_type="NodeSocketGeometry")
        else:
            (tree.inputs if into == "INPUT" else tree.outputs).new("NodeSocketGeometry", "Geometry")
    tree.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree


def check_what_changes_by_itself_is_read_alone(_work):
    """A light, a skin, a frame: not all objects of the scene are looked at, and no plain one is."""
    key, fill, empty, obj = add_light("Key"), add_light("Fill"), add_empty(), patch("Skin")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    fill.parent = empty
    key.keyframe_insert("location", frame=1)
    key.location = (0.0, 1.0, 2.0)
    key.keyframe_insert("location", frame=5)
    for step in range(2):
        empty.location.y = step
        depsgraph()
    with counted_readings() as count:
        for number, edit in enumerate(
            (
                lambda: setattr(key.data, "color", (1.0, 0.5, 0.2)),
                lambda: setattr(obj, "location", (0.3, 0.2, 0.1)),
                lambda: setattr(empty, "location", (1.0, 2.0, 3.0)),
                lambda: setattr(obj.skinglow, "strength", 2.0),
                lambda: bpy.context.scene.frame_set(3),
                lambda: bpy.context.scene.frame_set(5),
            ),
            1,
        ):
            edit()
            depsgraph()
            assert count[0] >= number and count[1] == 0, (number, count)
            assert_fresh(obj)


def check_edits_that_move_a_light_or_a_skin(_work):
    """By themselves, by their parent, their constraint's target, an instancer or their visibility."""
    key, fill, empty, obj = add_light("Key"), add_light("Fill"), add_empty(), patch("Skin")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    key.parent = empty
    fill.constraints.new("COPY_LOCATION").target = empty
    depsgraph()
    empty.location = (1.0, 2.0, 3.0)
    depsgraph()
    assert_shows(obj, paper_table([key, fill]), ulps=2)
    fill.hide_viewport = True
    assert_shows(obj, paper_table([key]))
    fill.hide_viewport = False
    fill.hide_set(True)
    assert_shows(obj, paper_table([key]))
    fill.hide_set(False)
    assert_shows(obj, paper_table([key, fill]), ulps=2)
    bpy.data.objects.remove(fill)
    assert_shows(obj, paper_table([key]))
    empty.scale = (2.0, 2.0, 2.0)
    assert_shows(obj, paper_table([key]))


def check_occlusion_looks_at_every_object(_work):
    obj, plain = patch("Skin"), patch("Plain")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="physical")
    bpy.context.scene.skinglow.occlusion = True
    depsgraph()
    with counted_readings() as count:
        plain.location.y = 2.0
        depsgraph()
        assert count[0] > 0


def check_lights_that_nothing_but_the_scene_reports(_work):
    """Hidden and shown, in collections and as parents, made by instancers, keyed: after each, all lights are seen."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    obj, store = patch("Skin"), bpy.data.collections.new("Store")
    scene.collection.children.link(store)
    add_light("Key")
    parents = [add_light("Parent", location=(0.0, 1.0, 1.0)), add_light("Stored", collection=store)]
    for parent in parents:
        patch(f"Child of {parent.name}").parent = parent
    hidden = bpy.data.collections.new("Instanced")
    add_light("Instanced", location=(0.2, 0.0, 0.5), collection=hidden)
    empties = [add_empty(name) for name in ("Later", "Empty")]
    empties[1].instance_type, empties[1].instance_collection = "COLLECTION", bpy.data.collections.new("Nothing")
    keyed = add_light("Keyed", location=(2.0, 0.0, 1.0))
    for frame, is_hidden in ((1, False), (4, True)):
        keyed.hide_viewport = is_hidden
        keyed.keyframe_insert("hide_viewport", frame=frame)
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    assert_fresh(obj)

    def instance(empty):
        empty.instance_type, empty.instance_collection = "COLLECTION", hidden

    def eye(is_closed):
        layer.layer_collection.children["Store"].hide_viewport = is_closed

    def exclude(is_out):
        layer.layer_collection.children["Store"].exclude = is_out

    for edit in (
        *(lambda state=state: parents[0].hide_set(state) for state in (True, False)),
        *(lambda state=state: parents[1].hide_set(state) for state in (True, False)),
        *(lambda state=state: eye(state) for state in (True, False)),
        *(lambda state=state: exclude(state) for state in (True, False)),
        *(lambda state=state: setattr(store, "hide_viewport", state) for state in (True, False)),
        *(lambda frame=frame: scene.frame_set(frame) for frame in (4, 1, 5, 2)),
        lambda: instance(empties[1]),
        lambda: setattr(empties[1], "location", (1.0, 1.0, 0.0)),
        lambda: setattr(empties[1], "instance_type", "NONE"),
        lambda: instance(empties[0]),
        lambda: empties[0].hide_set(True),
        lambda: empties[0].hide_set(False),
        lambda: setattr(keyed, "name", "Renamed"),
        lambda: bpy.data.objects.remove(parents[0]),
        lambda: add_light("New", location=(0.0, 0.0, 3.0)),
    ):
        edit()
        assert_fresh(obj)
        bpy.data.objects["Key"].data.energy += 1.0
        bpy.data.objects["Key"].data.color[0] *= 0.9
        assert_fresh(obj)


def check_edits_while_skins_do_not_follow(_work):
    """What was added meanwhile is seen afterwards, in a layer that was not shown too."""
    scene, obj = bpy.context.scene, patch("Skin")
    add_light("Key")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    depsgraph()
    sb.preferences._follows = False
    try:
        add_light("Meanwhile", location=(1.0, 0.0, 1.0))
        depsgraph()
    finally:
        sb.preferences._follows = True
    bpy.data.objects["Key"].data.color = (0.2, 0.4, 0.6)
    assert_fresh(obj)
    window, first = bpy.context.window_manager.windows[0], scene.view_layers[0]
    if bpy.app.version < (4, 0, 0):
        return  # frame_set would crash it (walk_edits.py)
    window.view_layer = scene.view_layers.new("Other")
    sb.update(depsgraph())
    add_light("In the other", location=(0.0, 2.0, 1.0))
    assert_fresh(obj)
    window.view_layer = first
    scene.frame_set(2)
    bpy.data.objects["Key"].data.color = (0.9, 0.4, 0.6)
    assert_fresh(obj)


def check_skins_come_into_a_file_without(work):
    path = str(work / "skin.blend")
    sb.make_skin(patch("Skin"), thickness=[1.0] * 4, mode="paper")
    add_light("Key")
    depsgraph()
    bpy.ops.wm.save_as_mainfile(filepath=path)

    def load():
        with bpy.data.libraries.load(path) as (_source, target):
            target.objects = ["Skin", "Key"]
        for obj in target.objects:
            link(obj)

    def append():
        for name in ("Skin", "Key"):
            bpy.ops.wm.append(filepath=f"{path}/Object/{name}", directory=f"{path}/Object/", filename=name)

    for come in (load, append):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        empty = add_empty()
        depsgraph()
        empty.location.x = 1.0
        depsgraph()
        assert sb.session.SESSION.has_none
        come()
        bpy.data.objects["Key"].data.color = (0.1, 0.2, 0.3)
        assert_fresh(bpy.data.objects["Skin"])
