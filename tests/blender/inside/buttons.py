"""The operators as scripts and buttons call them, and the panel's drawing, without a window."""

import webbrowser

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.session import SESSION
from skinglow_blender.ui import manual, menus
from skinglow_blender.ui.wrapped_text import wrapped

from inside.bad_input import refused
from inside.scenes import add_light, assert_fresh, black_material, camera_above, depsgraph, patch

sb.register()


def ball():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5)
    return bpy.context.object


def check_make_update_reset_remove(_work):
    key = add_light("Key")
    obj = ball()
    obj.skinglow.unit_mm = 10.0
    assert bpy.ops.skinglow.make(mode="PAPER") == {"FINISHED"}
    assert obj.skinglow.enabled
    assert_fresh(obj)
    obj.skinglow.live = False
    key.data.color = (0.0, 0.0, 1.0)
    before = sb.lut(obj, depsgraph())
    assert bpy.ops.skinglow.update() == {"FINISHED"}
    assert not np.array_equal(sb.lut(obj, depsgraph()), before)
    obj.skinglow.strength = 3.0
    assert bpy.ops.skinglow.reset() == {"FINISHED"}
    assert obj.skinglow.strength == 1.0 and obj.skinglow.live and obj.skinglow.enabled
    assert obj.skinglow.mode == "PHYSICAL"
    obj.skinglow.mode = "PAPER"
    assert_fresh(obj)
    obj.data.attributes["skinglow_thickness"].data[0].value = 99.0
    obj.skinglow.unit_mm = 10.0
    assert bpy.ops.skinglow.measure_thickness() == {"FINISHED"}
    assert obj.data.attributes["skinglow_thickness"].data[0].value < 11.0
    assert bpy.ops.skinglow.remove() == {"FINISHED"}
    assert not obj.skinglow.enabled and not bpy.data.node_groups


def check_nodes_are_where_they_were(_work):
    """However often skin glow is made and removed; but for an output that the artist moved."""
    obj = patch(material=black_material())
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    tree = obj.material_slots[0].material.node_tree
    output = tree.get_output_node("ALL")
    output.location = (300.25, -100.0)
    for _time in range(3):
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
        assert output.location.x > 300.25
        assert bpy.ops.skinglow.remove() == {"FINISHED"}
        assert tuple(output.location) == (300.25, -100.0)
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    output.location = (800.0, 0.0)
    sb.remove_skin(obj)
    assert tuple(output.location) == (800.0, 0.0)


def check_undo_of_each(_work):
    add_light("Key")
    name = ball().name
    bpy.ops.ed.undo_push(message="ball")
    bpy.ops.skinglow.make("EXEC_DEFAULT", True, mode="PAPER")
    assert_fresh(bpy.data.objects[name])
    bpy.ops.ed.undo()
    assert not bpy.data.objects[name].skinglow.enabled
    bpy.ops.ed.redo()
    assert_fresh(bpy.data.objects[name])


def check_errors_in_words(_work):
    obj = patch("Flat")
    obj.scale.x = 0.0
    depsgraph()
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    try:
        bpy.ops.skinglow.make(mode="PAPER")
    except RuntimeError as error:
        assert "'Flat' has scale 0" in str(error)
    else:
        raise AssertionError("nothing was said")


def check_export(work):
    add_light("Key")
    ball()
    bpy.ops.skinglow.make(mode="PAPER")
    camera_above()
    assert bpy.ops.skinglow.export_povray(directory=str(work / "pov")) == {"FINISHED"}
    assert (work / "pov" / "scene.pov").exists()


def check_ten_thousand_updates_leave_nothing(_work):
    """No datablock, no growth of what is remembered."""
    key = add_light("Key")
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    names = ("images", "node_groups", "materials", "meshes", "objects", "lights", "textures", "actions")
    before = {name: len(getattr(bpy.data, name)) for name in names}
    graph = depsgraph()
    for i in range(10000):
        key.data.color = ((i % 101) / 101, (i % 7) / 7, 0.5)
        bpy.context.view_layer.update()
    assert_fresh(obj)
    assert {name: len(getattr(bpy.data, name)) for name in names} == before
    assert len(SESSION.atlases) == 1 and len(SESSION.owners) == 1
    assert sb.update(graph) == []


def check_nothing_is_tagged_when_lights_stay(_work):
    """Editing something else computes nothing, writes nothing and so calls nothing again."""
    add_light("Key")
    obj, other = patch(), patch("Other")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    depsgraph()
    reports = []
    bpy.app.handlers.depsgraph_update_post.append(
        lambda _scene, graph: reports.append([u.id.name for u in graph.updates])
    )
    try:
        other.location.x = 5.0
        depsgraph()
        depsgraph()
    finally:
        bpy.app.handlers.depsgraph_update_post.pop()
    assert len(reports) == 1 and "Other" in reports[0], reports


def check_manual(work):
    """Opened in the browser from the package; the source, which has no pages made of its docs, says so."""
    opened, page = [], work / "a folder" / "manual" / "blender.html"
    webbrowser_open, first_page = webbrowser.open, manual.FIRST_PAGE
    webbrowser.open = opened.append
    try:
        manual.FIRST_PAGE = page
        refused(RuntimeError, "read docs/blender.md", bpy.ops.skinglow.manual)
        page.parent.mkdir(parents=True)
        page.write_text("<p>Skinglow</p>")
        assert bpy.ops.skinglow.manual() == {"FINISHED"}
    finally:
        webbrowser.open, manual.FIRST_PAGE = webbrowser_open, first_page
    assert opened == [page.as_uri()] and "%20" in opened[0]


def check_entries_in_blenders_menus(_work):
    """There while the add-on is on, gone when it is off, each once."""

    def ours():
        draws = [draw for name, _ in menus.ENTRIES for draw in getattr(bpy.types, name)._dyn_ui_initialize()]
        return [draw for draw in draws if draw.__module__ == menus.__name__]

    sb.register()
    assert len(ours()) == len(menus.ENTRIES)
    sb.unregister()
    try:
        assert not ours() and not hasattr(bpy.types, menus.SKINGLOW_MT_object.bl_idname)
    finally:
        sb.register()
    assert len(ours()) == len(menus.ENTRIES)


def check_select_a_skin_with_a_fault(_work):
    add_light("Key")
    own, other = patch("Own"), patch("Other", location=(3.0, 0.0, 0.0))
    for obj in (own, other):
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    bpy.context.view_layer.objects.active = own
    refused(RuntimeError, "No skin has a fault", bpy.ops.skinglow.select_faulty)
    other.skinglow.base = "IMAGE"
    depsgraph()
    bpy.ops.skinglow.select_faulty()
    assert bpy.context.object == other and other.select_get() and not own.select_get()
    # What is hidden is not updated, and so has no fault.
    other.hide_set(True)
    depsgraph()
    refused(RuntimeError, "No skin has a fault", bpy.ops.skinglow.select_faulty)


def check_text_is_wrapped_to_its_width(_work):
    """No line is cut at the panel's edge, whatever its characters; nothing is lost."""
    wide = {"%": 3.0, "i": 0.5}

    def width_of(text):
        return sum(wide.get(letter, 1.0) for letter in text)

    for text in (
        "Estimated error 59%, 104%, 133% (R, G, B)",
        "a",
        "",
        "/home/someone/a/path/without/spaces.exr fails %%%%%%%%%",
    ):
        for width in (3.0, 7.0, 12.0, 100.0):
            lines = list(wrapped(text, width, width_of))
            assert all(width_of(line) <= width for line in lines), (text, width, lines)
            assert "".join(lines).replace(" ", "") == text.replace(" ", "")
            assert len(lines) <= 1 or width < width_of(text)
