"""What the add-on's handlers cost an edit that changes no skin, in large scenes.

Run in a Blender whose Python finds skinglow, as blender_reaction.py. An empty is moved 300 times in

    objects    2,000 mesh objects
    instances  an object that instances another 100,000 times

each without a skin in the file and with one. In turn the edit is followed by the add-on's handler, by one that reads
Blender's own list of what was updated and nothing else, and by one that does nothing. Medians, microseconds of the main
thread: the handlers right after Blender's evaluation, when no cache holds anything of theirs, and that evaluation for
comparison. Then, among the 2,000 objects with a skin, the handler's time after other edits: a plain object is
selected, hidden, its mesh or its material is edited, the frame or a light's power changes; the fastest of 60, which
other processes disturb least. Prints tables, and JSON on one line.
"""

import json
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.live import handlers  # noqa: E402

EDITS = 100  # of each kind


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


def read_list(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        update.id  # noqa: B018


def before_and_after(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """All of the add-on's handlers of an edit."""
    handlers.before_depsgraph_update(scene, None)
    handlers.on_depsgraph_update(scene, depsgraph)


def nothing(_scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph) -> None:
    pass


def measure(build: Callable[[], None], skin: bool) -> dict[str, float]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build()
    link(bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT")))
    if skin:
        sb.make_skin(quad("Skin"), thickness=[1.0] * 4)
    empty = link(bpy.data.objects.new("Empty", None))
    bpy.context.view_layer.update()
    kinds = {"handlers": before_and_after, "list": read_list, "nothing": nothing}
    spent: dict[str, list[float]] = {kind: [] for kind in (*kinds, "blender")}
    for i in range(len(kinds) * EDITS):
        kind, handler = list(kinds.items())[i % len(kinds)]

        def timed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
            started = time.thread_time()
            handler(scene, depsgraph)  # noqa: B023  called before the next round
            spent[kind].append(time.thread_time() - started)  # noqa: B023

        bpy.app.handlers.depsgraph_update_post.append(timed)
        empty.location.x = float(i + 1)
        started = time.perf_counter()
        bpy.context.view_layer.update()
        if kind == "nothing":
            spent["blender"].append(time.perf_counter() - started)
        bpy.app.handlers.depsgraph_update_post.clear()
    found = {kind: 1e6 * statistics.median(each) for kind, each in spent.items()}
    return {kind: found[kind] - found["nothing"] for kind in ("handlers", "list")} | {"blender": found["blender"]}


def other_edits() -> dict[str, float]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects()
    light = bpy.data.lights.new("Light", "POINT")
    link(bpy.data.objects.new("Light", light))
    sb.make_skin(quad("Skin"), thickness=[1.0] * 4)
    plain, material = bpy.data.objects["Object 3"], bpy.data.materials.new("Plain")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    plain.data.materials.append(material)
    color = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value
    bpy.context.view_layer.update()

    def mesh(i: int) -> None:
        plain.data.vertices[0].co.z = i
        plain.data.update()

    edits = {
        "select": lambda i: plain.select_set(i % 2 == 0),
        "hide": lambda i: plain.hide_set(i % 2 == 0),
        "mesh": mesh,
        "material": lambda i: color.__setitem__(0, i / 100),
        "frame": lambda i: bpy.context.scene.frame_set(i + 1),
        "light": lambda i: setattr(light, "energy", float(i)),
    }
    found = {}
    for name, edit in edits.items():
        event = "frame_change_post" if name == "frame" else "depsgraph_update_post"
        handler = handlers.on_frame_change if name == "frame" else before_and_after
        spent: list[float] = []

        def timed(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
            started = time.thread_time()
            handler(scene, depsgraph)  # noqa: B023  called before the next round
            spent.append(time.thread_time() - started)  # noqa: B023

        getattr(bpy.app.handlers, event).append(timed)
        for i in range(60):
            edit(i)
            bpy.context.view_layer.update()
        getattr(bpy.app.handlers, event).clear()
        found[name] = 1e6 * min(spent)
    return found


def main() -> None:
    sb.register()
    handlers.unregister()
    results = []
    print(f"Blender {bpy.app.version_string}: microseconds an edit, medians of {EDITS}")
    print(f"{'scene':>10} {'skins':>6} {'handlers':>9} {'list alone':>11} {'Blender alone':>14}")
    for build in (objects, instances):
        for skin in (False, True):
            found = measure(build, skin)
            results.append({"scene": build.__name__, "skins": int(skin), **found})
            numbers = f"{found['handlers']:9.1f} {found['list']:11.1f} {found['blender']:14.1f}"
            print(f"{build.__name__:>10} {skin:6d} {numbers}")
    others = other_edits()
    print("; ".join(f"{name} {spent:.0f}" for name, spent in others.items()))
    print(json.dumps({"blender": bpy.app.version_string, "microseconds": results, "others": others}))


main()
sys.stdout.flush()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(0)
