# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus: Object, its context menu, File > Export, Add in the Shader Editor, and Help."""

import bpy

from .operators import selected_skins


class SKINGLOW_MT_object(bpy.types.Menu):  # noqa: N801  Blender's naming
    """What can be done with the selected objects."""

    bl_idname = "SKINGLOW_MT_object"
    bl_label = "Skinglow"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        # Otherwise the buttons would run in the background without a progress in the status bar.
        layout.operator_context = "INVOKE_DEFAULT"
        layout.operator("skinglow.make", icon="LIGHT_SUN")
        if selected_skins(context):
            layout.operator("skinglow.measure_thickness")
            layout.operator("skinglow.repair")
            layout.operator("skinglow.freeze", icon="FREEZE")
            layout.operator("skinglow.unfreeze")
            layout.separator()
            layout.operator("skinglow.reset")
            layout.operator("skinglow.remove")


def _in_object_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if context.mode == "OBJECT":
        self.layout.separator()
        self.layout.menu(SKINGLOW_MT_object.bl_idname)


def _in_export_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator("skinglow.export_povray", text="Skin Glow for POV-Ray (.pov)")
    self.layout.operator("skinglow.write_openjd", text="Skin Glow Job for Render Farms (OpenJD)")


def _in_node_menu(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    group = context.object.skinglow.group if context.object is not None else None
    if context.space_data.tree_type != "ShaderNodeTree" or group is None:
        return
    self.layout.separator()
    add = self.layout.operator("node.add_node", text="Skinglow", icon="LIGHT_SUN")
    add.type, add.use_transform = "ShaderNodeGroup", True
    setting = add.settings.add()
    # A name alone is not enough where a library has a group of that name.
    library = group.library.filepath if group.library is not None else None
    setting.name, setting.value = "node_tree", f"bpy.data.node_groups[{group.name!r}, {library!r}]"


def _in_help_menu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator("skinglow.manual", icon="HELP")


#: Blender's menus and what is added to each.
ENTRIES = (
    ("VIEW3D_MT_object", _in_object_menu),
    ("VIEW3D_MT_object_context_menu", _in_object_menu),
    ("TOPBAR_MT_file_export", _in_export_menu),
    ("NODE_MT_add", _in_node_menu),
    ("TOPBAR_MT_help", _in_help_menu),
)


def register() -> None:
    """Adds the entries."""
    bpy.utils.register_class(SKINGLOW_MT_object)
    for name, draw in ENTRIES:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Removes the entries."""
    for name, draw in ENTRIES:
        getattr(bpy.types, name).remove(draw)
    bpy.utils.unregister_class(SKINGLOW_MT_object)
