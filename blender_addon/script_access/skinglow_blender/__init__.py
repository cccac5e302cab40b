# SPDX-License-Identifier: GPL-3.0-or-later
"""`import skinglow_blender` for scripts where the add-on is an extension.

The full name of an extension depends on its repository, and extensions must not contain top-level modules; wheels may,
and this is one. It forwards all names to the extension, which has to be enabled in the preferences, under Add-ons.
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


def __getattr__(name: str) -> Any:  # noqa: ANN401  any attribute of the extension
    return getattr(_extension, name)
