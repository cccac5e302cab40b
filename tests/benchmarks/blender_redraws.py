"""How often a window is drawn while light is solved: a light is dragged round a head with two ears and four lights.

Run in the full program, which has a window, and whose Python finds skinglow (or SKINGLOW_SITE names where it is); needs
../shared/data/shape/lps_mesh.npz:

    blender --factory-startup --window-geometry 0 0 640 480 --python tests/benchmarks/blender_redraws.py

A modal operator moves the light at each event of a timer, 120 times a second, as a hand does; each event is followed
by Blender's evaluation, the add-on's handler and a redraw. In turns, for each of VIEWS:

    off      the add-on follows no lights
    drag     a light is dragged: its light is solved, coarsely while it moves
    first    the same while the first light is solved, which makes the body ready
    busy     the add-on is off, and as many threads as the solver's compute something else without ever holding Python's
             lock: what drawing loses to any work beside it on this machine

Prints redraws a second, the longest time between two in milliseconds, the main thread's processor time for each
redraw in milliseconds (which a busy machine does not make longer), answers a second that were shown, and the load of
the machine.
"""

import hashlib
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "blender_addon"), str(Path(__file__).parent)]
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from blender_shape import EARS, build  # noqa: E402
from skinglow_blender.live import handlers, shape_answers  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.thickness import thickness_attribute  # noqa: E402

SECONDS = 2.0
ROUNDS = 2
#: What the view shows. Without a graphics processor drawing the faces of a scan takes longest: with them out of sight
#: what is left is what Blender, the handlers and Python's lock take.
VIEWS = ("away", "solid", "rendered")
#: Between two events of the timer, s.
INTERVAL = 1.0 / 120.0

drawn: list[float] = []
answers: list[float] = []


def view() -> tuple[bpy.types.Window, bpy.types.Area]:
    window = bpy.context.window_manager.windows[0]
    return window, max((a for a in window.screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height)


def phases(head: bpy.types.Object) -> Iterator[tuple[str, float]]:
    """Names what is to be measured, each with its seconds; what is between two is not measured."""
    for shown in VIEWS:
        space = view()[1].spaces.active
        space.shading.type = "RENDERED" if shown == "rendered" else "SOLID"
        space.region_3d.view_location = (0.0, 0.0, 1e5 if shown == "away" else 0.0)
        for _ in range(ROUNDS):
            for what in ("off", "busy", "drag"):
                follow(what == "drag")
                stop = burn() if what == "busy" else lambda: None
                yield "", 1.0
                yield f"{shown} {what}", SECONDS
                stop()
        follow(True)
        # The cells of a body that was solved are others: it is made ready anew.
        head.skinglow.cell_mm += 0.01
        yield f"{shown} first", SECONDS
        while SESSION.shape_worker.is_busy:
            yield "", 0.5


def follow(lights: bool) -> None:
    """Whether the add-on follows lights, in place of the switch in its preferences: it is not installed here."""
    on_edit = bpy.app.handlers.depsgraph_update_post
    if handlers.on_depsgraph_update in on_edit:
        on_edit.remove(handlers.on_depsgraph_update)
    if lights:
        on_edit.append(handlers.on_depsgraph_update)


def burn() -> Callable[[], None]:
    """Computes in as many threads as the solver, without Python's lock; returns what stops it."""
    stopped = threading.Event()
    block = bytes(1 << 22)

    def work() -> None:
        while not stopped.is_set():
            hashlib.sha256(block).digest()

    for _ in range(max((os.cpu_count() or 1) - 1, 1)):
        threading.Thread(target=work, daemon=True).start()
    return stopped.set


class SKINGLOW_OT_drag(bpy.types.Operator):
    """Moves the light."""

    bl_idname = "skinglow.drag_for_benchmark"
    bl_label = "Drag a Light"

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        self.phases, self.phase, self.end = phases(bpy.data.objects["Head"]), "", 0.0
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, _context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        now = time.perf_counter()
        if now > self.end:
            if self.phase:
                tell(self.phase, self.begun, now, self.thread_begun)
            try:
                self.phase, seconds = next(self.phases)
            except StopIteration:
                sys.stdout.flush()
                os._exit(0)  # without a question about unsaved changes
            drawn.clear()
            answers.clear()
            self.begun, self.thread_begun = time.perf_counter(), time.thread_time()
            self.end = self.begun + seconds
        light = bpy.data.objects["Light 0"]
        light.location.x = -150.0 + 100.0 * np.sin(2.0 * now)
        return {"RUNNING_MODAL"}


def tell(name: str, begun: float, end: float, thread_begun: float) -> None:
    """Prints what was counted between two times."""
    seconds, gaps = end - begun, np.diff([begun, *drawn, end])
    thread_ms = 1e3 * (time.thread_time() - thread_begun) / max(len(drawn), 1)
    line = f"{name:16} {len(drawn) / seconds:10.1f} {1e3 * gaps.max():10.0f} {thread_ms:10.2f}"
    print(f"{line} {len(answers) / seconds:10.1f} {os.getloadavg()[0]:6.1f}", flush=True)


def make_head() -> None:
    """The head, whose skin is lit through its shape at the ears alone: through the rest no light comes."""
    head, _lights = build()
    sb.make_skin(head, unit_mm=1.0, weights="object")
    thickness, _known = thickness_attribute.read(head.data)
    across = np.abs([vertex.co.x for vertex in head.data.vertices])
    sb.make_skin(head, weights="shape", thickness=np.where(across > EARS, thickness, 100.0))


def start() -> None:
    window, area = view()
    area.spaces.active.clip_end = 1e4
    region = next(r for r in area.regions if r.type == "WINDOW")
    bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(time.perf_counter()), (), "WINDOW", "POST_PIXEL")
    shown = shape_answers.write_tiles

    def counted(*arguments: object) -> None:
        answers.append(time.perf_counter())
        shown(*arguments)

    shape_answers.write_tiles = counted
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.view3d.view_axis(type="LEFT")
        bpy.ops.view3d.view_all()
        bpy.ops.skinglow.drag_for_benchmark("INVOKE_DEFAULT")


def begin() -> Iterator[float]:
    """Steps with pauses, in which Blender draws."""
    make_head()
    yield 2.0
    while SESSION.shape_worker.is_busy:
        yield 0.5
    print(f"Blender {bpy.app.version_string}")
    print(f"{'':16} {'redraws/s':>10} {'longest ms':>10} {'main ms':>10} {'answers/s':>10} {'load':>6}", flush=True)
    start()


if __name__ == "__main__":
    bpy.context.preferences.view.show_splash = False
    sb.register()
    bpy.utils.register_class(SKINGLOW_OT_drag)
    steps = begin()
    bpy.app.timers.register(lambda: next(steps, None), first_interval=2.0, persistent=True)
