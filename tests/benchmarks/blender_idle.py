"""What the add-on's handlers cost an edit that changes no skin, in large scenes: with handlers and without, in turn.

Run in a Blender whose Python finds skinglow, as blender_reaction.py. An empty is moved 100 times in

    objects    2,000 mesh objects
    instances  an object that instances another 100,000 times

each without a skin in the file and with one: medians, microseconds, of the handlers alone, and of Blender's own
evaluation of the edit for comparison. Prints a table, and JSON on one line.
"""

import json
import os
import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.live import handlers  # noqa: E402

EDITS = 100


def link(obj: bpy.types.Object) -> bpy.types.Object:
    bpy.context.scene.collection.objects.link(obj)
    return obj


def quad(name: str) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    return link(bpy.data.objects.new(name, mesh))


def objects() -> None:
    for i in range(2_000):
        quad(f"Object {i}").location.x = i


def instances() -> None:
    """By the faces of a mesh, which every version can."""
    points = bpy.data.meshes.new("Faces")
    side = 316
    corners = [(x, y, 0) for y in range(side + 1) for x in range(side + 1)]
    starts = [y * (side + 1) + x for y in range(side) for x in range(side)]
    faces = [(i, i + 1, i + side + 2, i + side + 1) for i in starts]
    points.from_pydata(corners, [], faces)
    host = link(bpy.data.objects.new("Faces", points))
    host.instance_type = "FACES"
    quad("Leaf").parent = host


def measure(build: object, skin: bool) -> dict[str, float]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build()
    link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    if skin:
        sb.make_skin(quad("Skin"), thickness=[1.0] * 4)
    empty = link(bpy.data.objects.new("Empty", None))
    bpy.context.view_layer.update()
    spent = {True: [], False: []}
    for i in range(2 * EDITS):
        with_handlers = i % 2 == 0
        (handlers.register if with_handlers else handlers.unregister)()
        empty.location.x = float(i + 1)
        started = time.perf_counter()
        bpy.context.view_layer.update()
        spent[with_handlers].append(time.perf_counter() - started)
        if with_handlers:
            handlers.unregister()
    with_them, without = (1e6 * statistics.median(spent[each]) for each in (True, False))
    graph = bpy.context.evaluated_depsgraph_get()
    started = time.perf_counter()
    for _ in range(EDITS):
        handlers.on_depsgraph_update(bpy.context.scene, graph)
    alone = 1e6 * (time.perf_counter() - started) / EDITS
    return {"handlers": with_them - without, "blender": without, "handler called again": alone}


def main() -> None:
    sb.register()
    handlers.unregister()
    results = []
    print(f"Blender {bpy.app.version_string}: microseconds an edit, medians of {EDITS}")
    print(f"{'scene':>10} {'skins':>6} {'handlers':>9} {'Blender alone':>14}")
    for build in (objects, instances):
        for skin in (False, True):
            found = measure(build, skin)
            results.append({"scene": build.__name__, "skins": int(skin), **found})
            print(f"{build.__name__:>10} {skin:6d} {found['handlers']:9.1f} {found['blender']:14.1f}")
    print(json.dumps({"blender": bpy.app.version_string, "microseconds": results}))


main()
sys.stdout.flush()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(0)
