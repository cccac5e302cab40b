# SPDX-License-Identifier: GPL-3.0-or-later
"""What tells one data-block from another, whatever they are called."""

import bpy

#: Blender 4.1 and later number all data-blocks of a session.
HAS_UID = "session_uid" in bpy.types.ID.bl_rna.properties


def key_of(data: bpy.types.ID) -> str:
    """The same for a data-block as long as the file is open, through renames and undo, and for its evaluated copies.

    Before Blender 4.1 its name and its library's file, which another may take after a rename.
    """
    original = data.original
    if HAS_UID:
        return str(original.session_uid)
    return f"{original.name}\n{original.library.filepath}" if original.library is not None else original.name
