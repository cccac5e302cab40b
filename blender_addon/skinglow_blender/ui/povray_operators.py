# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators of POV-Ray: export, and comparison of both programs' pictures."""

import bpy
from bpy.props import BoolProperty, StringProperty

from ..batch.povray_comparison import compare_with_povray
from ..commands import povray_export
from ..commands.povray_run import povray_program
from ..errors import SkinError
from .operators import AnySkinOperator, SelectedSkinsOperator, selected_skins


def _folder(given: str) -> str:
    """The folder that a person chose."""
    if not given:
        raise SkinError("No folder selected for the POV-Ray files")
    if given.startswith("//") and not bpy.data.filepath:
        raise SkinError(f"Save the file first, or select another folder: '{given}' is one next to the blend file")
    return bpy.path.abspath(given)


class SKINGLOW_OT_export_povray(AnySkinOperator, bpy.types.Operator):  # noqa: N801
    """Writes POV-Ray scenes. No undo: it changes no Blender data."""

    bl_idname = "skinglow.export_povray"
    bl_label = "Export Skin Glow to POV-Ray"
    bl_description = "Write the skins of the scene with camera, lights and lookup as POV-Ray 3.7 files to a folder"
    bl_options = {"REGISTER"}

    directory: StringProperty(subtype="DIR_PATH", description="Folder to write to")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    surface: BoolProperty(
        name="Surface", default=True, description="Export the surface too; if disabled, only the transmitted light"
    )
    animation: BoolProperty(
        name="Animation", description="Export the frames of the scene's range; if disabled, the current frame"
    )
    compute_lut: BoolProperty(
        name="Compute in POV-Ray",
        description="POV-Ray computes the lookup, so that it follows lights that you change in the files",
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        def export() -> str:
            folder = _folder(self.directory)
            graph, scene = context.evaluated_depsgraph_get(), context.scene
            files = povray_export.export_povray(
                graph,
                folder,
                surface=self.surface,
                compute_lut=self.compute_lut,
                frames=(scene.frame_start, scene.frame_end) if self.animation else None,
            )
            for note in files.notes:
                self.report({"WARNING"}, note)
            missing = "" if povray_program() else "; POV-Ray is not installed on this computer"
            return f"{len(files)} files written to {folder}{missing}"

        return self.attempt(export)


class SKINGLOW_OT_compare_povray(SelectedSkinsOperator, bpy.types.Operator):  # noqa: N801
    """Renders by both programs and compares. No undo: it leaves the scene as it was."""

    bl_idname = "skinglow.compare_povray"
    bl_label = "Compare Skin Glow with POV-Ray"
    bl_description = (
        "Render the light through the active skin by Cycles and by POV-Ray, in each mode and under each light, "
        "and write a report of the differences to a folder"
    )
    bl_options = {"REGISTER"}

    directory: StringProperty(subtype="DIR_PATH", description="Folder to write to")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    per_light: BoolProperty(name="Each Light", default=True, description="Also under each light alone")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        def compare() -> str:
            folder = _folder(self.directory)
            skin = selected_skins(context)[0]
            done = compare_with_povray(skin, folder, per_light=self.per_light, scene=context.scene)
            for note in (*done.notes, *(entry["error"] for entry in done.entries if "error" in entry)):
                self.report({"WARNING"}, note)
            measured = [entry["rms"] for entry in done.entries if "rms" in entry]
            found = f"largest RMS {max(measured):.2e}" if measured else "nothing compared"
            return f"{len(measured)} of {len(done.entries)} compared, {found}: {done.report}"

        return self.attempt(compare)


CLASSES = (SKINGLOW_OT_export_povray, SKINGLOW_OT_compare_povray)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the operators."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
