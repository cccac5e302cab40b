# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what the thread finds of the light through shapes, as it finds it."""

from itertools import count

import bpy

from ..identity import key_of
from ..read.file_skins import skins_of_file
from ..session import SESSION
from ..show.frozen import is_frozen
from .guard import faults_shown
from .shape_tiles import write_tiles
from .shape_update import state_of

#: Seconds between two looks at the thread, and to its end when Blender quits; the core looks far more often.
INTERVAL = 0.03
MAX_WAIT = 10.0
#: How many looks make a redraw of the progress in the panel.
LOOKS = 8


def take_soon() -> None:
    """Looks at the thread until it has nothing left to do. There are no timers in background mode."""
    busy = SESSION.shape_worker is not None and SESSION.shape_worker.is_busy
    if busy and not bpy.app.background and not bpy.app.timers.is_registered(_take):
        bpy.app.timers.register(_take, first_interval=INTERVAL)


_looks = count()


def _take() -> float | None:
    # Images are not written while Blender renders.
    if not SESSION.rendering:
        with faults_shown():
            take_answers()
            if next(_looks) % LOOKS == 0:
                _redraw(panels_only=True)
    return INTERVAL if SESSION.shape_worker is not None and SESSION.shape_worker.is_busy else None


def take_answers() -> list[str]:
    """Takes and shows what was found; returns the keys of the skins that show something new."""
    if SESSION.shape_worker is None:
        return []
    answers = SESSION.shape_worker.take()
    new, faulty = [], []
    for key, answer in answers:
        state = state_of(key, "VIEWPORT")
        if state is None:
            continue
        if state.receive(answer) and key not in new:
            new.append(key)
        if state.fault:
            faulty.append(key)
    if answers:
        _show(new, faulty)
        _redraw()
    return new


def _show(new: list[str], faulty: list[str]) -> None:
    groups: dict[bpy.types.NodeTree, dict] = {}
    for obj in skins_of_file():
        key = key_of(obj)
        if key in faulty:
            SESSION.faults[key] = f"{obj.name}: {state_of(key, 'VIEWPORT').fault}"
        group = obj.skinglow.group
        if key in new and group is not None and not is_frozen(group):
            groups.setdefault(group, {})[obj] = state_of(key, "VIEWPORT").shown
    for group, shown in groups.items():
        write_tiles(group, "VIEWPORT", shown)
        for obj in shown:
            # A picture that was sampled to its end is drawn again.
            obj.update_tag(refresh={"OBJECT"})


def _redraw(panels_only: bool = False) -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES" or (area.type == "VIEW_3D" and not panels_only):
                area.tag_redraw()
            elif area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def stop() -> None:
    """Ends the thread, as when Blender quits or the add-on is disabled."""
    if bpy.app.timers.is_registered(_take):
        bpy.app.timers.unregister(_take)
    if SESSION.shape_worker is not None:
        SESSION.shape_worker.stop(MAX_WAIT)
        SESSION.shape_worker = None
