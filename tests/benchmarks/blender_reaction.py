"""The add-on's whole reaction to a changed light, split into reading lights and skins, computing, and pixels.

Run in a Blender whose Python finds skinglow:

    python tests/benchmarks/blender_reaction.py            # a bpy wheel
    blender -b -P tests/benchmarks/blender_reaction.py     # the full program; SKINGLOW_SITE: folder of the core

For 1 and 16 lights and 1 and 8 skins, 300 changes each: microseconds of the main thread, the tenth percentile, which
other processes disturb least, of
    reading   the walk through the depsgraph and the signatures
    core      weights and recolored tables
    pixels    rows into the image, the image into the node
    whole     all of update(), by what is known as in a handler; Blender's own evaluation and redraw come on top
    idle      update() where nothing changed
and, last, whether any datablock was left behind. Prints a table, and JSON on one line.
"""

import json
import os
import statistics
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.live import handlers, live_update  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.show import lut_image  # noqa: E402
from skinglow_blender.table import skin_tables  # noqa: E402

CHANGES = 300


class Stopwatch:
    """Sums the time spent in functions that it replaces."""

    def __init__(self) -> None:
        self.spent = {}

    def watch(self, owner: object, name: str, part: str) -> None:
        function = getattr(owner, name)

        def timed(*args: object, **kwargs: object) -> object:
            started = time.thread_time()
            try:
                return function(*args, **kwargs)
            finally:
                self.spent[part] = self.spent.get(part, 0.0) + time.thread_time() - started

        setattr(owner, name, timed)


def build(light_count: int, skins: int) -> list:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    collection = bpy.context.scene.collection
    made = []
    for i in range(light_count):
        light = bpy.data.lights.new(f"Light {i}", ("POINT", "AREA", "SPOT", "SUN")[i % 4])
        obj = bpy.data.objects.new(f"Light {i}", light)
        obj.location = (i, 1.0, 2.0)
        collection.objects.link(obj)
        made.append(light)
    for i in range(skins):
        mesh = bpy.data.meshes.new("Patch")
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
        obj = bpy.data.objects.new(f"Skin {i}", mesh)
        obj.location.x = i
        collection.objects.link(obj)
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    return made


def undisturbed(values: Iterable[float]) -> float:
    """The tenth percentile."""
    return statistics.quantiles(values, n=10)[0]


def microseconds(function: Callable[[int], float]) -> float:
    return 1e6 * undisturbed([function(i) for i in range(CHANGES)])


def measure(light_count: int, skins: int) -> dict[str, float]:
    lights = build(light_count, skins)
    watch = Stopwatch()
    originals = {
        (live_update, "read_scene"): "reading",
        (live_update, "signature_of"): "reading",
        (live_update, "compute_table"): "core",
        (lut_image.Atlas, "put"): "pixels",
        (lut_image.Atlas, "write"): "pixels",
        (lut_image.Atlas, "show"): "pixels",
    }
    kept = {key: getattr(*key) for key in originals}

    def change(i: int) -> bpy.types.Depsgraph:
        lights[i % light_count].color = ((i % 97) / 97, (i % 89) / 89, 0.5)
        bpy.context.view_layer.update()
        return bpy.context.evaluated_depsgraph_get()

    def whole(i: int) -> float:
        graph = change(i)
        started = time.thread_time()
        rebuilt = live_update.update_scene(graph, known=SESSION.known.get(graph.as_pointer()))
        spent = time.thread_time() - started
        assert len(rebuilt) == skins
        return spent

    def idle(_i: int) -> float:
        graph = bpy.context.evaluated_depsgraph_get()
        started = time.thread_time()
        assert not live_update.update_scene(graph, known=SESSION.known.get(graph.as_pointer()))
        return time.thread_time() - started

    found = {"lights": light_count, "skins": skins, "whole": microseconds(whole), "idle": microseconds(idle)}
    parts: dict[str, list[float]] = {"reading": [], "core": [], "pixels": []}
    for key, part in originals.items():
        watch.watch(*key, part)
    try:
        for i in range(CHANGES):
            watch.spent.clear()
            whole(i + 1000)
            for part, values in parts.items():
                values.append(1e6 * watch.spent[part])
    finally:
        for key, function in kept.items():
            setattr(*key, function)
    found.update({part: undisturbed(values) for part, values in parts.items()})
    return found


def main() -> None:
    # The handlers would do the work before it could be timed.
    sb.register()
    handlers.unregister()
    assert skin_tables.compute_table is live_update.compute_table
    results = []
    print(f"Blender {bpy.app.version_string}: microseconds, {CHANGES} changes of a light's color")
    print(f"{'lights':>6} {'skins':>6} {'reading':>9} {'core':>9} {'pixels':>9} {'whole':>9} {'idle':>9}")
    for light_count in (1, 16):
        for skins in (1, 8):
            before = None
            found = measure(light_count, skins)
            before = {name: len(getattr(bpy.data, name)) for name in ("images", "node_groups", "materials")}
            assert before["images"] == 4 and before["node_groups"] == 1, before
            results.append(found)
            numbers = [found[name] for name in ("reading", "core", "pixels", "whole", "idle")]
            print(f"{light_count:6d} {skins:6d} " + " ".join(f"{number:9.1f}" for number in numbers))
    print(json.dumps({"blender": bpy.app.version_string, "microseconds": results}))


main()
sys.stdout.flush()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(0)
