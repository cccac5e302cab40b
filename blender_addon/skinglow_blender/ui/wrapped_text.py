# SPDX-License-Identifier: GPL-3.0-or-later
"""Word-wrapped text in panels: Blender truncates labels at the panel's edge."""

from collections.abc import Callable, Iterator

import blf
import bpy

#: Widths of an icon and of the margins of a panel and a box in it, in units of Blender's interface scale.
ICON, EDGES = 22.0, 66.0
MIN_WIDTH = 96.0
FONT = 0


def draw_wrapped(layout: bpy.types.UILayout, text: str, context: bpy.types.Context, icon: str) -> None:
    """Draws the text as lines of labels, wrapped to the width of the current region."""
    system, styles = context.preferences.system, context.preferences.ui_styles
    if context.region is None or system.ui_scale <= 0:  # no window, as in the bpy wheels: nothing has a width
        layout.label(text=text, icon=icon)
        return
    size = (styles[0].widget.points if styles else 11.0) * system.ui_scale
    if bpy.app.version < (4, 0, 0):
        blf.size(FONT, size, 72)
    else:
        blf.size(FONT, size)
    width = max(context.region.width - (ICON + EDGES) * system.ui_scale, MIN_WIDTH * system.ui_scale)
    for line in wrapped(text, width, lambda part: blf.dimensions(FONT, part)[0]):
        layout.label(text=line, icon=icon)
        icon = "BLANK1"


def wrapped(text: str, width: float, width_of: Callable[[str], float]) -> Iterator[str]:
    """The text in lines of at most that width, broken at spaces, and inside of a word only where that is too wide."""
    line = ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if width_of(longer) <= width:
            line = longer
            continue
        if line:
            yield line
        line = word
        while len(line) > 1 and width_of(line) > width:
            fits = next(n for n in range(len(line) - 1, 0, -1) if n == 1 or width_of(line[:n]) <= width)
            yield line[:fits]
            line = line[fits:]
    if line:
        yield line
