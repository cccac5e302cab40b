"""A scene for the pictures of the panel: a head-sized mesh, lights that light it, and lights that do not."""

import bpy
from mathutils import Vector

#: Name, kind, color, power in W, position; scene units of 25 mm, relative to the center of the mesh.
LIGHTS = (
    ("Key behind", "AREA", (1.0, 0.92, 0.8), 60.0, (0.6, 2.2, 1.0)),
    ("Rim red", "POINT", (1.0, 0.12, 0.06), 90.0, (-1.8, 1.4, 0.6)),
    ("Fill blue", "SPOT", (0.15, 0.3, 1.0), 150.0, (2.4, 0.6, -0.2)),
    ("Lantern", "POINT", (1.0, 0.6, 0.2), 20.0, (-0.5, -2.5, -1.0)),
    ("Switched off", "POINT", (1.0, 1.0, 1.0), 0.0, (0.0, -3.0, 1.0)),
    ("Hidden", "POINT", (0.3, 1.0, 0.4), 50.0, (0.0, 3.0, 0.0)),
)
#: A small head with ears that are thin enough to transmit light.
UNIT_MM = 25.0


def build_scene() -> bpy.types.Object:
    """Replaces the objects of the file; returns the mesh, selected, not a skin yet."""
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    for name, kind, color, power, position in LIGHTS:
        light = bpy.data.lights.new(name, kind)
        light.color, light.energy = color, power
        obj = bpy.data.objects.new(name, light)
        bpy.context.scene.collection.objects.link(obj)
        obj.location = position
        obj.rotation_euler = (-Vector(position)).to_track_quat("-Z", "Y").to_euler()
    bpy.data.objects["Hidden"].hide_viewport = True
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
