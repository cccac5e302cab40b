# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells when a window turns to another scene or view layer, of which Blender's handlers are told nothing."""

from collections.abc import Callable

import bpy

_OWNER = object()


def watch(changed: Callable[[], None]) -> None:
    """Has `changed` called whenever a window shows another scene or view layer. A load ends it."""
    stop()
    for what in ("scene", "view_layer"):
        bpy.msgbus.subscribe_rna(key=(bpy.types.Window, what), owner=_OWNER, args=(), notify=changed)


def stop() -> None:
    """Watches no longer."""
    bpy.msgbus.clear_by_owner(_OWNER)
