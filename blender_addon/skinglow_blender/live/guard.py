# SPDX-License-Identifier: GPL-3.0-or-later
"""What handlers and timers have in common: nothing may interrupt the user's work, and no file without skins pays."""

import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..errors import SkinError
from ..session import SESSION
from ..show.lut_image import GROUP_PROPERTY

#: Blender 4.3 and later report when data was appended or linked; before, that node groups were evaluated.
REPORTS_IMPORTS = hasattr(bpy.app.handlers, "blend_import_post")


@contextmanager
def faults_shown() -> Iterator[None]:
    """Turns an exception into a fault that the panel shows."""
    try:
        yield
    except Exception as error:  # noqa: BLE001  nothing may interrupt the user's work
        _show(error)


def guarded(function: Callable[..., None]) -> Callable[..., None]:
    """A handler that never raises. Blender passes as many arguments as the function has positional ones: two."""

    def handler(first: Any, second: Any = None) -> None:  # noqa: ANN401  differs between handlers and versions
        try:
            function(first, second)
        except Exception as error:  # noqa: BLE001  nothing may interrupt the user's work
            _show(error)

    handler.__name__ = function.__name__
    return persistent(handler)


def _show(error: Exception) -> None:
    is_told = isinstance(error, (SkinError, ValueError))
    text = str(error) if is_told else f"Unexpected {type(error).__name__}: {error} (details in the system console)"
    SESSION.faults["*"] = text
    if SESSION.rendering:
        SESSION.render_faults["*"] = text
    if not is_told:
        traceback.print_exception(error)


def has_skins(depsgraph: bpy.types.Depsgraph | None = None) -> bool:
    """Whether the file has, or had since the last update, a skin; costs nothing in those that have none.

    depsgraph  what was evaluated just now; None: the file's node groups are looked at in any case
    """
    if SESSION.owners or SESSION.faults:
        return True
    if depsgraph is None or SESSION.has_none is None or (not REPORTS_IMPORTS and depsgraph.id_type_updated("NODETREE")):
        SESSION.has_none = not any(GROUP_PROPERTY in tree for tree in bpy.data.node_groups)
        if SESSION.has_none:
            SESSION.known.clear()
    return not SESSION.has_none
