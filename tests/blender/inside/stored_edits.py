"""Edits in the order that a window has: the edit, its undo step, and only then the update of the skins.

What the update edits is in no step. Without a window scripts do it the other way round: bpy.ops.ed.undo_push evaluates
first.
"""

import bpy


class EditAndStore(bpy.types.Operator):
    """Runs what `run` is, and stores an undo step, as every operator of the interface does."""

    bl_idname, bl_label, bl_options = "wm.skinglow_test_edit", "Edit", {"REGISTER", "UNDO"}
    run = staticmethod(lambda: None)

    def execute(self, _context):
        EditAndStore.run()
        return {"FINISHED"}


bpy.utils.register_class(EditAndStore)


def edit_and_store(run):
    """One edit by a user. There has to be a step before it."""
    EditAndStore.run = staticmethod(run)
    assert bpy.ops.wm.skinglow_test_edit("EXEC_DEFAULT", True) == {"FINISHED"}
