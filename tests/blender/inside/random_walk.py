"""A thousand random edits, after each of which every skin's lookup is compared with a fresh computation.

The seed is printed and is part of every failure; SKINGLOW_SEED repeats a walk, SKINGLOW_STEPS changes its length.
"""

import os
import random

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands.freezing import frozen_state

from inside.scenes import (
    add_light,
    black_material,
    camera_above,
    depsgraph,
    link,
    patch,
    render_settings,
)
from inside.stored_edits import edit_and_store
from inside.walk_files import LIBRARY, THIN, expected, require_images_in_use, write_library
from inside.walk_mesh_edits import skin_nodes
from inside.walk_shape_edits import ShapeEdits

#: Names each edit as it comes: for a Blender that crashes.
TRACE = bool(os.environ.get("SKINGLOW_TRACE"))


class Walk(ShapeEdits):
    """All edits, the steps of the walk, and what is compared after each."""

    #: The share of the edits that are made as in a window.
    in_a_window = 0.5

    def __init__(self, seed, folder):
        super().__init__(seed, folder)
        #: Apart from the edits: which of them are made as in a window, and whether the last one was.
        self.ways = random.Random(seed)
        self.is_stored = False
        self.undoable = 0
        self.compared = self.late = 0
        self.tables = set()
        self.done = []

    def playback(self):
        for frame in range(1, 5):
            bpy.context.scene.frame_set(frame)
            self.compare(bpy.context.evaluated_depsgraph_get())

    # Edits of skins.
    def add_skin(self):
        if len(self.skins()) < 6:
            material = self.pick([None, *self.materials()])
            sb.make_skin(patch("Patch", location=self.position(), material=material), thickness=THIN, mode="paper")

    def materials(self):
        return [m for m in bpy.data.materials if m.users and not m.library]

    def change_material(self):
        """Another material on a skin, in its slot or a new one; sometimes made a skin again."""
        obj = self.pick(self.own_skins())
        if obj is None:
            return
        material = self.pick([*self.materials(), None]) or black_material()
        if obj.material_slots and self.random.random() < 0.7:
            obj.material_slots[0].material = material
        elif len(obj.material_slots) < 3:
            obj.data.materials.append(material)
        if self.random.random() < 0.5:
            sb.make_skin(obj, thickness=[1.0] * len(obj.data.vertices), mode="paper")

    def from_library(self, linked, names):
        with bpy.data.libraries.load(str(self.folder / LIBRARY), link=linked) as (_source, target):
            target.objects = names
        there = set(bpy.context.scene.collection.objects)
        for obj in target.objects:
            if obj not in there:
                link(obj)
        return target.objects

    def append(self):
        if len(self.skins()) < 6 and len(self.lights()) < 24:
            for obj in self.from_library(
                False, self.random.choice((["Library skin"], ["Library lamp", "Library skin"]))
            ):
                obj.location = self.position()

    def link_library(self):
        if len(self.skins()) < 6:
            self.from_library(True, ["Library skin", "Library lamp"])

    def override(self):
        obj = self.pick([o for o in bpy.context.scene.objects if o.library])
        if obj is not None:
            obj.override_create(remap_local_usages=True)

    def move_override(self):
        obj = self.pick([o for o in bpy.context.scene.objects if o.override_library])
        if obj is not None:
            obj.location = self.position()

    def duplicate_skin(self):
        obj = self.pick(self.own_skins())
        if obj is not None and len(self.skins()) < 6:
            copy = link(obj.copy())
            copy.location = self.position()
            if self.random.random() < 0.5:
                copy.data = copy.data.copy()

    def delete_skin(self):
        if len(self.skins()) > 1:
            bpy.data.objects.remove(self.pick(self.skins()))

    def remove_skin(self):
        if len(self.skins()) > 1:
            obj = self.pick(self.own_skins())
            if obj is not None:
                sb.remove_skin(obj)

    def move_skin(self):
        obj = self.pick(self.own_skins())
        if obj is None:
            return
        obj.location, obj.rotation_euler = self.position(), self.position()
        obj.scale = [self.random.choice((0.5, 1.0, -1.0, 2.0))] * 3

    def table_size(self):
        obj = self.pick(self.own_skins())
        if obj is not None:
            obj.skinglow.size = self.random.choice((16, 256, 300))

    def freeze_and_back(self):
        """Frozen, seen to be, and live again: the comparison that follows finds nothing stale.

        Not one of the random edits: with it walks would be others than those known to stay clear of Blender's own
        crashes over dependency cycles.
        """
        self.is_stored = False
        obj, frame = next(iter(self.own_skins()), None), bpy.context.scene.frame_current
        if obj is None or not {slot.material for slot in obj.material_slots} - {None}:
            return
        try:
            (frozen,) = sb.freeze([obj], frame, frame + 1, self.folder / "frozen")
        except sb.SkinError as error:
            known = "belongs to|light it differently|not rendered|Skinglow node|no camera|too few nodes"
            assert any(words in str(error) for words in known.split("|")), str(error)
            return
        # Two frames, of rows and where skins are lit through their shape of tiles.
        assert len(list(frozen.folder.iterdir())) in (2, 4)
        assert frozen_state(obj) == frozen._replace(skins=(obj.name,))
        assert obj.name in sb.unfreeze()
        assert frozen_state(obj) is None

    # What replaces all data, and what renders.
    def push_undo(self):
        depsgraph()
        bpy.ops.ed.undo_push(message="step")
        self.undoable = min(self.undoable + 1, 20)

    def undo(self):
        """One to three steps back, and sometimes some of them forth again.

        What was edited otherwise than in a window is pushed before: undo over edits that no step holds leaves Blender
        with dangling pointers of its own.
        """
        if not self.is_stored:
            self.push_undo()
        steps = min(self.random.randint(1, 3), self.undoable - 1)
        for _ in range(steps):
            bpy.ops.ed.undo()
        self.undone = True
        again = self.random.randint(0, steps)
        for _ in range(again):
            bpy.ops.ed.redo()
        self.undoable -= steps - again
        self.push_undo()

    def save_and_load(self):
        path = str(self.folder / "walk.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        self.undoable, self.undone = 0, False
        self.push_undo()

    def render(self):
        render_settings(2, 2)
        bpy.ops.render.render()

    def step(self):
        often = (self.recolor, self.power, self.kind, self.move_light, self.hide_light, self.hide_with_h,
                 self.new_light, self.duplicate_light, self.delete_light, self.rename_light, self.parent,
                 self.constrain, self.key, self.drive, self.exclude, self.hide_collection, self.close_eye,
                 self.instance, self.move_empty, self.delete_empty, self.frame, self.frame, self.add_skin,
                 self.add_body, self.deform,
                 self.duplicate_skin, self.delete_skin, self.move_skin, self.mode, self.hide_light_in_renders,
                 self.add_modifier, self.remove_modifier, self.apply_scale, self.join, self.switch_slot,
                 self.push_undo, self.undo)  # fmt: skip
        seldom = (self.save_and_load, self.render, self.remove_skin, self.table_size, self.change_material, self.append,
                  self.copy_group, self.copy_material, self.leave_slot_out,
                  self.link_library, self.override, self.move_override, self.move_override, self.add_view_layer,
                  self.switch_view_layer, self.switch_view_layer, self.switch_scene, self.engine,
                  self.playback, self.reload_library)  # fmt: skip
        edit = self.random.choice(seldom if self.random.random() < 0.12 else often)
        if TRACE:
            print(edit.__name__, flush=True)
        stored = edit in often and edit not in (self.push_undo, self.undo) and self.ways.random() < self.in_a_window
        if stored:
            edit_and_store(edit)
            self.undoable = min(self.undoable + 1, 20)
        else:
            edit()
        self.is_stored = stored
        return edit.__name__

    def settle(self):
        """The evaluated scene, when handlers have nothing more to edit."""
        return depsgraph()

    def advance(self):
        """One edit, and what is compared after it."""
        name = self.step()
        self.done.append(name)
        graph = self.settle()
        # Lights that Blender moves after its report (handlers.py): a window looks again, here the script does.
        again = sb.update(graph)
        # Without a window Blender reports no change of view layer or scene (test_in_window.py has one).
        if not name.startswith("switch"):
            self.take_late([rebuilt.why for rebuilt in again])
        self.compare(graph)

    def take_late(self, reasons):
        """What was seen only when the scene was looked at once more."""
        self.late += bool(reasons)
        assert all(" in " in why for why in reasons), reasons

    def compare(self, graph):
        """Every skin of the view layer shows what is computed afresh, and its materials show that."""
        for obj in self.skins():
            shown, wanted = sb.lut(obj, graph), expected(obj, graph)
            np.testing.assert_allclose(shown, wanted, rtol=5e-6, atol=2e-6 * wanted.max(), err_msg=obj.name)
            self.compared += 1
            self.compare_shape(obj, graph)
            self.tables.add(shown.tobytes())
            groups = {node.node_tree for node in skin_nodes(obj)}
            assert groups <= {obj.skinglow.group}, (obj.name, groups, obj.skinglow.group)
        rows = [(o.skinglow.group, o.skinglow.row) for o in self.skins()]
        assert len(set(rows)) == len(rows), rows


def begin_walk(seed, work):
    """Two scenes, a skin and a light in each, and collections that both have; the walk of them."""
    scenes = [bpy.context.scene, bpy.data.scenes.new("Other")]
    collections = [bpy.data.collections.new(name) for name in ("Rig", "Store")]
    for scene in reversed(scenes):
        bpy.context.window_manager.windows[0].scene = scene
        for collection in collections:
            scene.collection.children.link(collection)
        sb.make_skin(patch(material=black_material()), thickness=THIN, mode="paper")
        add_light("Lamp")
        camera_above()
        render_settings(2, 2)
    return Walk(seed, work)


def check_random_walk(work):
    seed = int(os.environ.get("SKINGLOW_SEED", "20260704"))
    steps = int(os.environ.get("SKINGLOW_STEPS", "1000"))
    print(f"random walk: SKINGLOW_SEED={seed}, {steps} steps", flush=True)
    write_library(work / LIBRARY)
    walk = begin_walk(seed, work)
    walk.push_undo()
    try:
        for _ in range(steps):
            walk.advance()
            if len(walk.done) % 25 == 0:
                walk.freeze_and_back()
                walk.compare(depsgraph())
    except BaseException as error:
        raise AssertionError(
            f"seed {seed}, step {len(walk.done)}, the last edits: {walk.done[-12:]}\n{error}"
        ) from error
    assert walk.late <= steps / 100, walk.late
    assert walk.through > steps / 10, walk.through
    assert len(walk.tables) > steps / 10, len(walk.tables)
    # What none shows any more does not outlive the file's next loading.
    walk.save_and_load()
    require_images_in_use()
    return {
        "seed": seed,
        "steps": len(walk.done),
        "compared": walk.compared,
        "through": walk.through,
        "late": walk.late,
        "different": len(walk.tables),
    }
