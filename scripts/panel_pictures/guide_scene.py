"""The scene of the guide's pictures: the demo's head at real size, a warm bulb behind one ear, a blue fill."""

import bpy
from blender_scene import light_behind_ear, load_head, skin_surface
from mathutils import Vector

#: As scripts/demo_steps/head_source.py says of MakeHuman's base mesh.
JOB = {"unit_mm": 100.0, "group": "body", "eyes": ("helper-l-eye", "helper-r-eye"), "cut_below_m": 0.605}


def build_guide_scene(mesh: str) -> bpy.types.Object:
    """Replaces the objects of the file; returns the head, selected, not a skin yet."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    head = load_head({"mesh": mesh, **JOB})
    head.name = "Head"
    skin_surface(head, None, None)
    scene = bpy.context.scene
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.exposure = 2.0
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = scene.cycles.use_preview_denoising = False
    scene.cycles.preview_samples = 32
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.010, 0.011, 0.013, 1.0)
    key = light_behind_ear(scene, head)
    key.name = "Behind the ear"
    fill = bpy.data.objects.new("Fill", bpy.data.lights.new("Fill", "AREA"))
    fill.data.color, fill.data.energy, fill.data.size = (0.4, 0.6, 1.0), 0.3, 0.3
    fill.location = key.location + Vector((0.3, -0.8, 0.1))
    fill.rotation_euler = (-Vector((0.3, -0.8, 0.1))).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(fill)
    for obj in bpy.data.objects:
        obj.select_set(obj == head)
    bpy.context.view_layer.objects.active = head
    return head
