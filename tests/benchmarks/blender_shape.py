"""How fast light through the shape of a skin is in Blender: two ears of a scan and four lights.

Run in a Blender whose Python finds skinglow; needs ../shared/data/shape/lps_mesh.npz:

    python tests/benchmarks/blender_shape.py            # a bpy wheel

Medians in milliseconds of processor time of all threads, which a busy machine does not make longer:
    update    all of an update where nothing changed
    recolor   the colors of all lights changed, with Blender's own evaluation and the written image
    quickest  the shortest of those: other processes take the caches from the others
    blender   of that, Blender's own evaluation: the same without the add-on's handlers
    sums      of that, the sums over the lights alone
    request   what a moved light costs the main thread, with Blender's own evaluation
    coarse    the first answer to a moved light
    full      the full answer to it
    tiles     pixels of an answer, before they are written
    deformed  a mesh that was deformed: everything anew, as in each frame of an animation of it
"""

import json
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "blender_addon"))
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from mathutils import Vector  # noqa: E402
from skinglow_blender.identity import key_of  # noqa: E402
from skinglow_blender.live import handlers, shape_answers, shape_update  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.table import shape_light  # noqa: E402
from skinglow_blender.thickness import thickness_attribute  # noqa: E402

MESH = ROOT.parent / "shared" / "data" / "shape" / "lps_mesh.npz"
CHANGES = 9
#: How far from the middle of the head the ears begin, mm.
EARS = 64.0


def build() -> tuple[bpy.types.Object, list[bpy.types.Object]]:
    """The head in mm and four lights about it, of which two are behind it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = np.load(MESH)
    data = bpy.data.meshes.new("Head")
    data.from_pydata(mesh["vertices_mm"].astype(float).tolist(), [], mesh["triangles"].tolist())
    head = bpy.data.objects.new("Head", data)
    collection = bpy.context.scene.collection
    collection.objects.link(head)
    lights = []
    for i, place in enumerate(((-150, 400, 100), (150, 400, 100), (-500, -100, 200), (400, -300, 50))):
        light = bpy.data.lights.new(f"Light {i}", ("SPOT", "POINT", "AREA", "SUN")[i])
        light.energy = 3.0 if light.type == "SUN" else 1e6
        obj = bpy.data.objects.new(f"Light {i}", light)
        obj.location = place
        obj.rotation_euler = Vector(-np.array(place)).to_track_quat("-Z", "Y").to_euler()
        collection.objects.link(obj)
        lights.append(obj)
    return head, lights


def times(function: Callable[[int], object], changes: int) -> list[float]:
    """Milliseconds of processor time, ascending."""
    found = []
    for i in range(changes):
        started = time.process_time()
        function(i)
        found.append(1000.0 * (time.process_time() - started))
    return sorted(found)


def median(function: Callable[[int], object], changes: int = CHANGES) -> float:
    """Milliseconds of processor time."""
    return statistics.median(times(function, changes))


def main_thread(function: Callable[[int], object]) -> float:
    """Milliseconds of processor time of this thread alone."""
    found = []
    for i in range(CHANGES):
        started = time.thread_time()
        function(i)
        found.append(1000.0 * (time.thread_time() - started))
    return statistics.median(found)


def main() -> None:
    head, lights = build()
    started = time.process_time()
    shape_update.is_synchronous = lambda _mode: False
    sb.make_skin(head, unit_mm=1.0, weights="object")
    measured = time.process_time()
    # The ears alone; of the rest of the head no light comes through.
    thickness, _known = thickness_attribute.read(head.data)
    across = np.abs([vertex.co.x for vertex in head.data.vertices])
    sb.make_skin(head, weights="shape", thickness=np.where(across > EARS, thickness, 100.0))
    made = time.process_time()
    wait()
    solved = time.process_time()
    state = shape_update.state_of(key_of(head), "VIEWPORT")
    graph = bpy.context.evaluated_depsgraph_get()
    figures: dict[str, object] = {"measure_s": measured - started, "first_picture_s": made - measured}
    figures["first_full_s"] = solved - made
    figures["targets"], figures["rows"] = len(state.tiles.targets.points), state.tiles.rows
    figures["update"] = main_thread(lambda _i: sb.update(graph))

    def recolor(i: int) -> None:
        for light in lights:
            light.data.color = (0.1 * (i % 10), 0.5, 1.0 - 0.1 * (i % 10))
        bpy.context.view_layer.update()

    # What a handler does is in view_layer.update(), with Blender's own evaluation.
    found = times(recolor, 40)
    figures["recolor"], figures["quickest"] = statistics.median(found), found[0]
    bpy.app.handlers.depsgraph_update_post.remove(handlers.on_depsgraph_update)
    figures["blender"] = median(recolor)
    bpy.app.handlers.depsgraph_update_post.append(handlers.on_depsgraph_update)
    recolor(1)
    answer = shape_update.state_of(key_of(head), "VIEWPORT").answer
    figures["sums"] = median(lambda _i: shape_light.recolored(answer, state.light))
    wait()

    def move(i: int) -> None:
        lights[0].location.x += 1.0 + i
        bpy.context.view_layer.update()

    figures["request"] = main_thread(move)
    wait()
    body = state.body

    def solved_by(i: int, full: bool) -> None:
        lights[0].location.x += 2.0 + i
        bpy.context.view_layer.update()
        SESSION.shape_worker.drop()
        shape_light._solved(body.shape(), body, state.light, lambda _f: True, full=full)

    figures["coarse"] = median(lambda i: solved_by(i, full=False))
    figures["full"] = median(lambda i: solved_by(i, full=True))
    bpy.context.view_layer.update()
    pixels = np.zeros((state.tiles.rows, 1024, 4), np.float32)
    figures["tiles"] = median(lambda _i: state.tiles.draw(state.shown.radiance, pixels, alpha=False))
    report = sb.state_of(head, graph).shape
    figures |= {"parts": report.parts, "solved": report.ready_parts, "cells": report.cells, "MB": report.bytes / 1e6}

    def deform(i: int) -> None:
        head.data.vertices[0].co.x += 0.01 * (1 + i)
        head.data.update()
        bpy.context.view_layer.update()
        wait()

    figures["deformed"] = median(deform, 1)
    for name, value in figures.items():
        print(f"{name:18} {value:.6g}")
    print(json.dumps(figures))


def wait() -> None:
    """Until the thread has nothing to do."""
    while SESSION.shape_worker.is_busy:
        shape_answers.take_answers()
        time.sleep(0.002)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # the 4.5 wheel hangs otherwise
