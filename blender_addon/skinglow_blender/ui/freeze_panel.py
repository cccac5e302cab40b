# SPDX-License-Identifier: GPL-3.0-or-later
"""The Freeze panel: whether a skin is frozen, and the buttons for it."""

import bpy

from ..commands.freezing import frozen_state
from ..session import SESSION
from ..show.frozen import path_in_file
from .locations import InObjectProperties, InSidebar, SkinPanel


class _Freeze(SkinPanel):
    bl_label = "Freeze"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_freeze(self.layout, context.object, context)


class SKINGLOW_PT_sidebar_freeze(_Freeze, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_freeze(_Freeze, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


def draw_freeze(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    """The frames to freeze; or which are, and where."""
    layout.use_property_split, layout.use_property_decorate = True, False
    freezing = SESSION.freezing
    if freezing is not None:
        draw_progress(layout, freezing.done, "Freezing")
        return
    frozen = frozen_state(obj)
    if frozen is None:
        column = layout.column(align=True)
        column.prop(context.scene, "frame_start", text="Frame Start")
        column.prop(context.scene, "frame_end", text="End")
        layout.operator("skinglow.freeze", icon="FREEZE")
        return
    layout.label(text=f"Frozen: frames {frozen.first} to {frozen.last}", icon="FREEZE")
    layout.label(text=path_in_file(frozen.folder), icon="FILE_FOLDER")
    layout.operator("skinglow.unfreeze", text="Unfreeze", icon="LIGHT_SUN")


def draw_progress(layout: bpy.types.UILayout, done: float, what: str) -> None:
    """A progress bar (4.0), or the percentage."""
    if hasattr(layout, "progress"):
        layout.progress(factor=done, text=f"{what}: {done:.0%}")
    else:
        layout.label(text=f"{what}: {done:.0%}", icon="SORTTIME")


CLASSES = (SKINGLOW_PT_sidebar_freeze, SKINGLOW_PT_object_freeze)
