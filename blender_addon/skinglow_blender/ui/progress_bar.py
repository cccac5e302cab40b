# SPDX-License-Identifier: GPL-3.0-or-later
"""A progress bar, as far as this Blender has one."""

import bpy


def draw_progress(row: bpy.types.UILayout, text: str, fraction: float) -> None:
    """Draws a bar with a text in it (Blender 4.0 and later), or the text alone."""
    if hasattr(row, "progress"):
        row.progress(factor=fraction, text=text)
    else:
        row.label(text=text, icon="SORTTIME")
