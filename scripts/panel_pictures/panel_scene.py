"""A scene that shows what the panel shows: a head-sized mesh, lamps that reach it, and lamps that do not."""

import bpy
from mathutils import Vector

#: Name, kind, color, power in W, place; scene units of 25 mm, about the middle of the mesh.
LAMPS = (
    ("Key behind", "AREA", (1.0, 0.92, 0.8), 60.0, (0.6, 2.2, 1.0)),
    ("Rim red", "POINT", (1.0, 0.12, 0.06), 90.0, (-1.8, 1.4, 0.6)),
    ("Fill blue", "SPOT", (0.15, 0.3, 1.0), 150.0, (2.4, 0.6, -0.2)),
    ("Lantern", "POINT", (1.0, 0.6, 0.2), 20.0, (-0.5, -2.5, -1.0)),
    ("Switched off", "POINT", (1.0, 1.0, 1.0), 0.0, (0.0, -3.0, 1.0)),
    ("Put away", "POINT", (0.3, 1.0, 0.4), 50.0, (0.0, 3.0, 0.0)),
)
#: A small head, whose ears are thin enough to let light through.
UNIT_MM = 25.0


def build_scene() -> bpy.types.Object:
    """Puts it in place of what the file holds; returns the mesh, selected, no skin yet."""
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    for name, kind, color, power, place in LAMPS:
        light = bpy.data.lights.new(name, kind)
        light.color, light.energy = color, power
        lamp = bpy.data.objects.new(name, light)
        bpy.context.scene.collection.objects.link(lamp)
        lamp.location = place
        lamp.rotation_euler = (-Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.data.objects["Put away"].hide_viewport = True
    bpy.ops.mesh.primitive_monkey_add()
    head = bpy.context.object
    head.name = "Head"
    smooth = head.modifiers.new("Smooth", "SUBSURF")
    smooth.levels = 2
    bpy.ops.object.modifier_apply(modifier="Smooth")
    head.data.polygons.foreach_set("use_smooth", [True] * len(head.data.polygons))
    head.skinglow.unit_mm = UNIT_MM
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.01, 0.011, 0.014, 1.0)
    return head
