# SPDX-License-Identifier: GPL-3.0-or-later
"""Word-wrapped text in panels: Blender truncates labels at the panel's edge."""

import textwrap

import blf
import bpy

#: Widths of an icon and of the margins of a panel and a box in it, in units of Blender's interface scale.
ICON, EDGES = 22.0, 66.0
MIN_CHARACTERS = 16


def draw_wrapped(layout: bpy.types.UILayout, text: str, context: bpy.types.Context, icon: str) -> None:
    """Draws the text as lines of labels, wrapped to the width of the current region."""
    for line in textwrap.wrap(text, characters_per_line(context)):
        layout.label(text=line, icon=icon)
        icon = "BLANK1"


def characters_per_line(context: bpy.types.Context) -> int:
    """Number of average characters of the interface font that fit next to an icon."""
    system = context.preferences.system
    points = context.preferences.ui_styles[0].widget.points if context.preferences.ui_styles else 11.0
    font = 0
    if bpy.app.version < (4, 0, 0):
        blf.size(font, points * system.ui_scale, 72)
    else:
        blf.size(font, points * system.ui_scale)
    sample = "its collection is hidden or excluded"
    character = blf.dimensions(font, sample)[0] / len(sample)
    width = context.region.width - (ICON + EDGES) * system.ui_scale if context.region is not None else 0.0
    return max(MIN_CHARACTERS, int(width / max(character, 1.0)))
