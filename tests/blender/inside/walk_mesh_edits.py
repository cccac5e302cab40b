"""Random edits of what skins consist of: meshes, scales, modifiers, material slots, libraries."""

import bpy
import numpy as np
from skinglow_blender.read.scene_reading import ROW_PROPERTY
from skinglow_blender.thickness import thickness_attribute

from inside.scenes import black_material, depsgraph
from inside.walk_edits import SceneEdits

MODIFIERS = ("SUBSURF", "SOLIDIFY", "MIRROR", "TRIANGULATE")


class MeshEdits(SceneEdits):
    """Edits of the meshes and materials of skins that belong to this file."""

    def meshed_skin(self):
        """A skin whose mesh no other object has, made the active and only selected object; None if there is none."""
        shown = [o for o in self.own_skins() if o.data.users == 1 and o.visible_get() and o.data.library is None]
        obj = self.pick(shown)
        if obj is not None:
            for other in bpy.context.view_layer.objects:
                other.select_set(False)
            obj.select_set(True)
            bpy.context.view_layer.objects.active = obj
        return obj

    def apply_scale(self):
        """As thick as before, in texels of the lookup."""
        obj = self.meshed_skin()
        if obj is None or obj.modifiers or obj.parent or obj.animation_data or obj.constraints:
            return
        depsgraph()
        before = obj[ROW_PROPERTY][0] * self.thickness(obj)
        bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
        depsgraph()
        np.testing.assert_allclose(obj[ROW_PROPERTY][0] * self.thickness(obj), before, rtol=1e-4)

    def thickness(self, obj):
        values, known = thickness_attribute.read(obj.data)
        return values[known]

    def join(self):
        """What is joined has no thickness."""
        obj = self.meshed_skin()
        if obj is None or len(obj.data.vertices) > 12:
            return
        count = len(obj.data.vertices)
        mesh = bpy.data.meshes.new("Joined")
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
        other = bpy.data.objects.new("Joined", mesh)
        bpy.context.view_layer.active_layer_collection.collection.objects.link(other)
        if other.name not in bpy.context.view_layer.objects or not other.visible_get():
            bpy.data.objects.remove(other)
            return
        other.select_set(True)
        bpy.ops.object.join()
        _values, known = thickness_attribute.read(obj.data)
        assert not known[count:].any()

    def add_modifier(self):
        obj = self.pick(self.own_skins())
        if obj is not None and len(obj.modifiers) < 3:
            obj.modifiers.new("Walk", self.random.choice(MODIFIERS))

    def remove_modifier(self):
        obj = self.pick([o for o in self.own_skins() if o.modifiers])
        if obj is not None:
            obj.modifiers.remove(obj.modifiers[0])

    def switch_slot(self):
        """Another order of the slots, an empty one, or one less."""
        obj = self.pick([o for o in self.own_skins() if o.data.library is None])
        if obj is None:
            return
        materials = obj.data.materials
        if len(materials) > 1 and self.random.random() < 0.5:
            materials.pop(index=0)
        elif len(materials) < 3:
            materials.append(self.random.choice((None, black_material("Slot"))))

    def reload_library(self):
        library = self.pick(list(bpy.data.libraries))
        if library is not None:
            library.reload()
            # What other steps of the undo stack point to is gone.
            self.undoable = 0
            self.push_undo()
