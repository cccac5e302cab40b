"""Random edits of what skins consist of: meshes, scales, modifiers, material slots, libraries."""

import bpy
import numpy as np
from skinglow_blender.read.scene_reading import ROW_PROPERTY
from skinglow_blender.thickness import thickness_attribute

from inside.scenes import black_material, depsgraph
from inside.walk_edits import SceneEdits

MODIFIERS = ("SUBSURF", "SOLIDIFY", "MIRROR", "TRIANGULATE")


def skin_nodes(obj):
    materials = {slot.material for slot in obj.material_slots} - {None}
    return [n for m in materials for n in m.node_tree.nodes if getattr(n, "node_tree", None)]


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
        if "deformed" in obj.data:
            return
        depsgraph()
        before = obj[ROW_PROPERTY][0] * self.thickness(obj)
        bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
        depsgraph()
        np.testing.assert_allclose(obj[ROW_PROPERTY][0] * self.thickness(obj), before, rtol=1e-4)

    def thickness(self, obj):
        values, known = thickness_attribute.read(obj.data)
        return values[known]

    def deform(self):
        obj = self.meshed_skin()
        if obj is not None:
            obj.data.vertices[self.random.randrange(len(obj.data.vertices))].co.x += 0.2
            obj.data.update()
            # By the vertices that are remembered for that, a scale that is applied afterwards is not told from this.
            obj.data["deformed"] = True

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
        if other not in set(bpy.context.view_layer.objects) or not other.visible_get():
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

    def own_nodes(self):
        """A skin of this file, and its node in a material of this file; None twice if there is none."""
        pairs = [(o, n) for o in self.own_skins() for n in skin_nodes(o) if not n.id_data.library]
        return self.pick([(o, n) for o, n in pairs if not n.node_tree.library]) or (None, None)

    def copy_group(self):
        """The node group of one material made a single user, as the number beside its name does.

        Its node goes back to the other group, and nothing uses the copy any more.
        """
        _obj, node = self.own_nodes()
        if node is not None and len(bpy.data.node_groups) < 20:
            node.node_tree = node.node_tree.copy()
            self.copies += 1

    def copy_material(self):
        obj, node = self.own_nodes()
        slots = [s for s in obj.material_slots if s.material and s.material.node_tree == node.id_data] if obj else []
        if slots:
            slots[0].material = slots[0].material.copy()

    def leave_slot_out(self):
        """A slot is no skin for a moment, and one again."""
        obj, node = self.own_nodes()
        if node is None:
            return
        material = next(m for m in bpy.data.materials if m.node_tree == node.id_data)
        material.skinglow.is_skin = False
        self.compare(depsgraph())
        assert not any(getattr(n, "node_tree", None) for n in material.node_tree.nodes)
        material.skinglow.is_skin = True
