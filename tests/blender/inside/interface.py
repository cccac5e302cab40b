"""The buttons: each does what its function does, and says in words what it cannot do."""

import bpy
import numpy as np
import skinglow_blender as sb

from inside.scenes import depsgraph, lamp, patch


def only_selected(obj):
    bpy.context.view_layer.update()
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj


def check_make_update_export_remove(work):
    sb.register()
    lamp(color=(0.0, 0.0, 1.0), location=(0.0, 0.0, 2.0))
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.01)
    obj = bpy.context.object
    assert not bpy.ops.skinglow.update.poll()
    assert bpy.ops.skinglow.make_skin() == {"FINISHED"}
    blue = sb.lut(obj, depsgraph())
    assert blue.shape == (256, 3) and obj.skinglow.enabled

    obj.skinglow.live = False
    bpy.data.lights[0].color = (1.0, 0.0, 0.0)
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), blue)
    assert bpy.ops.skinglow.update() == {"FINISHED"}
    assert sb.lut(obj, depsgraph())[0, 2] < blue[0, 2]

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    assert bpy.ops.skinglow.export_povray(directory=str(work / "pov")) == {"FINISHED"}
    assert (work / "pov" / "scene.pov").is_file()

    assert bpy.ops.skinglow.remove() == {"FINISHED"}
    assert not obj.skinglow.enabled and not [g for g in bpy.data.node_groups if g.name.startswith("Skinglow")]


def check_errors_are_words(_work):
    sb.register()
    empty = bpy.data.objects.new("empty mesh", bpy.data.meshes.new("nothing"))
    bpy.context.scene.collection.objects.link(empty)
    only_selected(empty)
    try:
        bpy.ops.skinglow.make_skin()
    except RuntimeError as error:
        assert "no faces" in str(error)
    else:
        raise AssertionError("a mesh without faces was made a skin")
    assert not empty.skinglow.enabled


def check_panels_are_there(_work):
    sb.register()
    patch()
    for name in ("SKINGLOW_PT_sidebar", "SKINGLOW_PT_object"):
        assert hasattr(bpy.types, name)
    sb.unregister()
    assert not hasattr(bpy.types, "SKINGLOW_PT_sidebar")
    sb.register()
    assert hasattr(bpy.types, "SKINGLOW_PT_sidebar")
