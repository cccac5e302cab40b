# SPDX-License-Identifier: GPL-3.0-or-later
"""The Export panel and the Reset and Remove panel."""

import bpy

from .locations import InObjectProperties, InSidebar, SkinPanel


class _Export(SkinPanel):
    bl_label = "Export"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.operator("skinglow.export_povray", text="POV-Ray Scene", icon="EXPORT")
        self.layout.operator("skinglow.compare_povray", text="Compare with POV-Ray", icon="IMAGE_ALPHA")


class SKINGLOW_PT_sidebar_export(_Export, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_export(_Export, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


class _Remove(SkinPanel):
    bl_label = "Reset and Remove"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        row = self.layout.row(align=True)
        row.operator("skinglow.reset", text="Reset", icon="LOOP_BACK")
        row.operator("skinglow.remove", text="Remove", icon="TRASH")


class SKINGLOW_PT_sidebar_remove(_Remove, InSidebar, bpy.types.Panel):  # noqa: N801
    """In the sidebar."""


class SKINGLOW_PT_object_remove(_Remove, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


CLASSES = (
    SKINGLOW_PT_sidebar_export,
    SKINGLOW_PT_object_export,
    SKINGLOW_PT_sidebar_remove,
    SKINGLOW_PT_object_remove,
)
