# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual, which is a part of the add-on's packages: it needs no network and fits the version."""

from pathlib import Path

import bpy

#: Made from the project's docs when the add-on is packed.
FIRST_PAGE = Path(__file__).parents[1] / "manual" / "blender.html"


class SKINGLOW_OT_manual(bpy.types.Operator):  # noqa: N801  Blender's naming
    """Opens the manual."""

    bl_idname = "skinglow.manual"
    bl_label = "Skinglow Manual"
    bl_description = "Open the manual of this version, which needs no network, in the web browser"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if not FIRST_PAGE.is_file():
            cls.poll_message_set("Only installed packages hold the manual: read docs/blender.md in the source")
            return False
        return True

    def execute(self, _context: bpy.types.Context) -> set[str]:
        bpy.ops.wm.url_open(url=FIRST_PAGE.as_uri())
        return {"FINISHED"}


def draw_in_header(layout: bpy.types.UILayout) -> None:
    """Draws the button at the right of a panel's header, where there is a manual."""
    if FIRST_PAGE.is_file():
        layout.operator(SKINGLOW_OT_manual.bl_idname, text="", icon="HELP", emboss=False)
        # Otherwise it would touch the handle by which panels are moved.
        layout.separator()


def register() -> None:
    """Adds the operator."""
    bpy.utils.register_class(SKINGLOW_OT_manual)


def unregister() -> None:
    """Removes the operator."""
    bpy.utils.unregister_class(SKINGLOW_OT_manual)
