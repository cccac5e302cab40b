# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's one exception, and the compiled core behind a message that says how to get it."""

from types import ModuleType


class SkinError(RuntimeError):
    """Something a person can put right; its text says what, where and how."""


def core() -> ModuleType:
    """The Python package `skinglow`, which does all the computing. Raises SkinError where it is missing."""
    try:
        import skinglow
    except ImportError as error:
        raise SkinError(
            "The compiled core, the Python package 'skinglow', cannot be imported into this Blender "
            f"({error}). Install the add-on from its zip, which holds the core, or the wheel that "
            "fits this Blender's Python, and restart Blender"
        ) from error
    return skinglow
