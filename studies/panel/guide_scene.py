"""The scene of the guide's pictures: the demo's head at real size, a warm bulb behind one ear."""

import bpy

from studies.scenes import aim_camera, light_behind_ear, load_head, skin_surface, views_of

#: As studies/demo/head_source.py says of MakeHuman's base mesh.
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
    light_behind_ear(scene, head).name = "Behind the ear"
    ear, height = views_of(head)["_ear"]
    aim_camera(scene, ear, height, 0.9)
    scene.render.resolution_x, scene.render.resolution_y, scene.cycles.samples = 640, 640, 128
    for obj in bpy.data.objects:
        obj.select_set(obj == head)
    bpy.context.view_layer.objects.active = head
    return head
