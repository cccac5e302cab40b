# SPDX-License-Identifier: GPL-3.0-or-later
"""`import skinglow_blender` for scripts where the add-on is an extension.

An extension's own name depends on its repository, and Blender asks it to bring no top-level modules; but it
welcomes them in wheels, and this is one. All names are the extension's, which has to be enabled in
the preferences, under add-ons.
"""

import importlib
from typing import Any

import bpy


def _extension_name() -> str:
    """The add-on's full name, bl_ext.<repository>.skinglow_blender."""
    for name in bpy.context.preferences.addons.keys():
        if name.startswith("bl_ext.") and name.endswith(".skinglow_blender"):
            return name
    raise ImportError("the Skinglow extension is installed but not enabled: Edit > Preferences > Add-ons")


_extension = importlib.import_module(_extension_name())
__doc__ = _extension.__doc__
__all__ = getattr(_extension, "__all__", ())


def __getattr__(name: str) -> Any:  # noqa: ANN401  whatever the extension has by that name
    return getattr(_extension, name)
