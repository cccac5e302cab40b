# SPDX-License-Identifier: GPL-3.0-or-later
"""What tells one data-block from another, whatever they are called, and where it comes from."""

import bpy

#: Blender 4.1 and later number all data-blocks of a session.
HAS_UID = "session_uid" in bpy.types.ID.bl_rna.properties


def key_of(data: bpy.types.ID) -> str:
    """The same for a data-block as long as the file is open, through renames and undo, and for its evaluated copies.

    Before Blender 4.1 its lasting key, which another may take after a rename.
    """
    return str(data.original.session_uid) if HAS_UID else lasting_key_of(data)


def lasting_key_of(data: bpy.types.ID) -> str:
    """The same whenever the file is opened, until a rename: its name and its library's file.

    Not name_full, which a local data-block may have in common with a linked one.
    """
    original = data.original
    return f"{original.name}\n{original.library.filepath}" if original.library is not None else original.name


def library_of(data: bpy.types.ID) -> bpy.types.Library | None:
    """The library from which a data-block is read again whenever the file is opened; None: it is the file's own.

    Also of an override, which keeps settings that were changed in it, but no attribute and no node that was added.
    """
    override = data.override_library
    if override is not None and override.reference is not None:
        return override.reference.library
    return data.library
