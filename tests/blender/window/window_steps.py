"""Runs in a Blender with a window: user actions as steps, between which Blender draws."""

import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator

import bpy

#: Default pause between two steps, seconds.
PAUSE = 0.3


def run_steps(steps: Callable[[], Iterator[float | None]]) -> None:
    """Runs a generator from a Blender timer; it yields pauses in seconds. Quits Blender at the end."""
    bpy.context.preferences.view.show_splash = False
    running = steps()

    def step() -> float | None:
        try:
            return next(running) or PAUSE
        except StopIteration:
            print("STEPS DONE", flush=True)
        except Exception:  # noqa: BLE001  the caller checks the output
            traceback.print_exc()
        sys.stdout.flush()
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(step, first_interval=1.0, persistent=True)


def window() -> bpy.types.Window:
    """The first window; references to it become invalid when a file is loaded."""
    return bpy.context.window_manager.windows[0]


def area_of(kind: str) -> bpy.types.Area:
    """The largest area of a kind, as 'VIEW_3D'."""
    return max((a for a in window().screen.areas if a.type == kind), key=lambda a: a.width * a.height)


def region_of(area: bpy.types.Area, kind: str) -> bpy.types.Region:
    """An area's region, as 'UI', the sidebar."""
    return next(r for r in area.regions if r.type == kind)


def in_view(**more: object) -> object:
    """The context of a pointer over the 3D Viewport."""
    area = area_of("VIEW_3D")
    return bpy.context.temp_override(window=window(), area=area, region=region_of(area, "WINDOW"), **more)


def open_sidebar(tab: str, class_of_tab: type) -> Iterator[float]:
    """Opens the sidebar at a tab; before 4.2 by a click, which requires --enable-event-simulate."""
    area = area_of("VIEW_3D")
    area.spaces.active.show_region_ui = True
    yield 0.5
    sidebar = region_of(area, "UI")
    if hasattr(sidebar, "active_panel_category"):
        sidebar.active_panel_category = tab
    else:
        hide_other_tabs(class_of_tab)
        area.tag_redraw()
        yield 0.5
        # Below the only other tab, Item.
        yield from click(sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - 80)
    area.tag_redraw()
    yield 0.5


def hide_other_tabs(class_of_tab: type) -> None:
    """Hides Blender's own sidebar tabs for this run."""
    for panel in bpy.types.Panel.__subclasses__():
        where = (getattr(panel, "bl_space_type", ""), getattr(panel, "bl_region_type", ""))
        if where == ("VIEW_3D", "UI") and panel.__module__.startswith("bl_ui") and panel is not class_of_tab:
            if panel.is_registered:
                bpy.utils.unregister_class(panel)


def click(x: int, y: int, seconds: float = 0.2) -> Iterator[float]:
    """A click of the left mouse button, in pixels from the window's lower left corner."""
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield seconds
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    yield seconds
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
    yield seconds


def press(key: str, x: int, y: int, **with_keys: bool) -> Iterator[float]:
    """A key press with the pointer at x, y; with_keys: ctrl, shift, alt."""
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield 0.2
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type=key, value=value, x=x, y=y, **with_keys)
        yield 0.1


def wait_for(true: Callable[[], bool], seconds: float, what: str) -> Iterator[float]:
    """Waits until a condition is true; raises TimeoutError naming it otherwise."""
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise TimeoutError(f"timed out after {seconds:g} s waiting for {what}")
        yield 0.1


def save_picture(path: str) -> None:
    """Saves a screenshot of the window as PNG; by scrot from 4.2 on, whose own are black in Xvfb."""
    if bpy.app.version >= (4, 2, 0):
        subprocess.run(["scrot", "-o", path], check=True)
    else:
        bpy.ops.screen.screenshot(filepath=path)
