"""The panel says what is wrong with the thickness of a skin, and looks for it only after its mesh changed."""

import bmesh
import bpy
import skinglow_blender as sb
from skinglow_blender.session import SESSION
from skinglow_blender.ui import main_panel, thickness_faults

from inside.measured_as_shown import plate
from inside.no_far_side import Labels, printed
from inside.scenes import add_light, depsgraph


class Box(Labels):
    """A layout that keeps the texts of its labels, and the operators of its buttons."""

    def __init__(self):
        super().__init__()
        self.operators = []

    def box(self):
        return self

    def operator(self, name, **_):
        self.operators.append(name)


def panel(obj):
    """What the panel shows of a skin's faults once the timer found them, and its buttons."""
    main_panel._draw_faults(Box(), obj, bpy.context)
    thickness_faults.find_requested()
    box = Box()
    main_panel._draw_faults(box, obj, bpy.context)
    return " ".join(box.texts), box.operators


def chosen_plate():
    sb.register()
    add_light()
    obj = plate()
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def remesh(obj):
    modifier = obj.modifiers.new("New", "REMESH")
    modifier.mode, modifier.voxel_size = "VOXEL", 0.002


def check_make_on_an_object_with_remesh_is_told(_work):
    """It stays dark: the report and the panel say so, and what to do."""
    obj = chosen_plate()
    remesh(obj)
    for button in (bpy.ops.skinglow.make, bpy.ops.skinglow.measure_thickness):
        with printed() as said:
            assert button() == {"FINISHED"}
        assert "Warning: Plate: The thickness is not known at 100.0% of the vertices shown" in said[0], said
        assert "apply it first" in said[0]
    text, buttons = panel(obj)
    assert "not known at 100.0%" in text and "apply it first" in text and buttons == ["skinglow.repair"], text


def check_a_healthy_skin_shows_nothing(_work):
    obj = chosen_plate()
    with printed() as said:
        assert bpy.ops.skinglow.make() == {"FINISHED"}
    assert "Warning" not in said[0], said
    assert panel(obj) == ("", [])


def check_new_vertices_of_a_given_thickness_are_told(_work):
    obj = chosen_plate()
    sb.make_skin(obj, thickness=[1.0] * len(obj.data.vertices), mode="physical")
    assert panel(obj) == ("", [])
    made = bmesh.new()
    made.from_mesh(obj.data)
    bmesh.ops.create_cube(made, size=0.01)
    made.to_mesh(obj.data)
    made.free()
    depsgraph()
    text, buttons = panel(obj)
    assert "The thickness is not known at 4.7%" in text and buttons == ["skinglow.repair"], text


def check_the_mesh_is_looked_at_once_for_each_change(_work):
    """Neither redraws nor edits of anything else cost a look; settings of the skin do, as Blender reports its shape."""
    obj, lamp = chosen_plate(), bpy.data.objects["Lamp"]
    sb.make_skin(obj, mode="physical")
    calls, find = [], thickness_faults.thickness_faults
    thickness_faults.thickness_faults = lambda *given: calls.append(1) or find(*given)
    try:
        assert panel(obj) == ("", []) and len(calls) == 1
        for edit in (
            lambda: setattr(lamp, "location", (0.0, 1.0, 2.0)),
            lambda: setattr(lamp.data, "energy", 3.0),
            lambda: setattr(obj, "location", (0.0, 1.0, 0.0)),
            lambda: None,
        ):
            edit()
            depsgraph()
            assert panel(obj) == ("", []) and len(calls) == 1, edit.__code__.co_firstlineno
        solid = obj.modifiers.new("Thicker", "SOLIDIFY")
        depsgraph()
        assert "modifiers were edited" in panel(obj)[0] and len(calls) == 2
        # The timer waits until nothing has changed for a moment.
        assert thickness_faults._find_soon() == thickness_faults.DELAY
        SESSION.reshaped_at -= thickness_faults.DELAY
        assert thickness_faults._find_soon() is None
        # What was found stays in the panel until the timer has looked again.
        obj.modifiers.remove(solid)
        depsgraph()
        box = Box()
        main_panel._draw_faults(box, obj, bpy.context)
        assert "modifiers were edited" in " ".join(box.texts)
        assert panel(obj) == ("", []) and len(calls) == 3
        assert sb.health(obj) == []
    finally:
        thickness_faults.thickness_faults = find


def check_edit_mode_is_no_fault(_work):
    """Blender keeps the attributes of a mesh in Edit Mode to itself."""
    obj = chosen_plate()
    sb.make_skin(obj, mode="physical")
    bpy.ops.object.mode_set(mode="EDIT")
    depsgraph()
    assert "not known at" not in panel(obj)[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    depsgraph()
    assert panel(obj) == ("", [])


def check_faces_in_an_empty_slot_are_told(_work):
    """Blender shows its plain material there; a slot that no face has is no fault."""
    obj = chosen_plate()
    assert bpy.ops.skinglow.make() == {"FINISHED"}
    obj.data.materials.append(None)
    depsgraph()
    assert panel(obj) == ("", [])
    obj.data.polygons[0].material_index = 1
    obj.data.update()
    depsgraph()
    text, buttons = panel(obj)
    assert "material slot that is empty" in text and buttons == [], (text, buttons)
    (fault,) = sb.health(obj)
    assert fault.is_hint
