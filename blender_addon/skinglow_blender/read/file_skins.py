# SPDX-License-Identifier: GPL-3.0-or-later
"""The skins of the open file, in whatever scene."""

import bpy


def skins_of_file() -> list[bpy.types.Object]:
    """All skins, original objects; looks at every object of the file."""
    return [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.skinglow.enabled]
