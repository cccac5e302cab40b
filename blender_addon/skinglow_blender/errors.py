# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's exception, and access to the compiled core with a helpful message if it is missing."""

from types import ModuleType


class SkinError(RuntimeError):
    """An error that the user can fix; the message says what is wrong, where, and how to fix it."""


class TemporaryError(SkinError):
    """A cause that may be gone at another try: a full disk, a network folder that does not answer."""


def core() -> ModuleType:
    """The Python package `skinglow`, which does all computation. Raises SkinError if it is missing."""
    try:
        import skinglow
    except ImportError as error:
        raise SkinError(
            f"The compiled core, the Python package 'skinglow', cannot be imported ({error}). Install the add-on from "
            "its zip, which contains the core, or a wheel for this Blender's Python, and restart Blender"
        ) from error
    return skinglow
