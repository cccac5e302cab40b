# SPDX-License-Identifier: GPL-3.0-or-later
"""Text of any length in a panel: Blender cuts labels off at the panel's edge."""

import textwrap

import blf
import bpy

#: Widths of an icon and of a panel's edges, in units of Blender's interface scale.
ICON, EDGES = 22.0, 46.0
FEWEST_LETTERS = 16


def draw_wrapped(layout: bpy.types.UILayout, text: str, context: bpy.types.Context, icon: str) -> None:
    """Labels below each other that hold the text, broken to the width of the region drawn."""
    for line in textwrap.wrap(text, letters_a_line(context)):
        layout.label(text=line, icon=icon)
        icon = "BLANK1"


def letters_a_line(context: bpy.types.Context) -> int:
    """How many letters of Blender's interface font fit beside an icon."""
    system = context.preferences.system
    points = context.preferences.ui_styles[0].widget.points if context.preferences.ui_styles else 11.0
    font = 0
    if bpy.app.version < (4, 0, 0):
        blf.size(font, points * system.ui_scale, 72)
    else:
        blf.size(font, points * system.ui_scale)
    sample = "its collection is hidden or excluded"
    letter = blf.dimensions(font, sample)[0] / len(sample)
    width = context.region.width - (ICON + EDGES) * system.ui_scale if context.region is not None else 0.0
    return max(FEWEST_LETTERS, int(width / max(letter, 1.0)))
