# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that writes a batch as a job for render farms."""

import shlex

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ..farm.openjd import write_openjd
from .operators import AnySkinOperator
from .wrapped_text import draw_wrapped

#: What workers need, by the light of the skins.
NEEDS = (
    ("LIVE", "Live", "Each worker needs Blender with this add-on. Light rigs, a manifest, and pictures that are kept"),
    ("FROZEN", "Frozen", "Workers need Blender alone. Freeze the light first; no rigs, no manifest"),
)


class SKINGLOW_OT_write_openjd(AnySkinOperator, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Writes a job bundle. No undo: it changes no Blender data."""

    bl_idname = "skinglow.write_openjd"
    bl_label = "Export Skin Glow Job"
    bl_description = (
        "Write a job in Open Job Description that renders the saved file, for AWS Deadline Cloud or openjd run"
    )
    bl_options = {"REGISTER"}

    directory: StringProperty(subtype="DIR_PATH", description="Folder of the job's files")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    light: EnumProperty(name="Light", items=NEEDS, description="How skins are lit on the workers")
    frames: StringProperty(name="Frames", description="Such as 1-10,15 or 1-100x5; empty: the frame range of the scene")
    chunk: IntProperty(
        name="Frames per Task", default=10, min=1, soft_max=100, description="Each task starts Blender once"
    )
    rigs: StringProperty(
        name="Rigs",
        description="Lights, collections, NAME=LIGHT,LIGHT or rig files, separated by spaces; empty: all lights",
    )
    out: StringProperty(name="Pictures", default="//batch", subtype="DIR_PATH", description="Folder of the pictures")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        layout.prop(self, "light", expand=True)
        draw_wrapped(layout, next(need[2] for need in NEEDS if need[0] == self.light), context, "INFO")
        for name in ("frames", "chunk", "out"):
            layout.prop(self, name)
        if self.light == "LIVE":
            layout.prop(self, "rigs")

    def execute(self, _context: bpy.types.Context) -> set[str]:
        def write() -> str:
            frozen = self.light == "FROZEN"
            template = write_openjd(
                self.directory or "//job",
                self.frames or None,
                None if frozen or not self.rigs else shlex.split(self.rigs),
                out=self.out,
                chunk=self.chunk,
                frozen=frozen,
            )
            return f"Job written: {template}"

        return self.attempt(write)


def register() -> None:
    """Adds the operator."""
    bpy.utils.register_class(SKINGLOW_OT_write_openjd)


def unregister() -> None:
    """Removes the operator."""
    bpy.utils.unregister_class(SKINGLOW_OT_write_openjd)
