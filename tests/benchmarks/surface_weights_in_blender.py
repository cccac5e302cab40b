"""Three ways for a material to get the light on the far side: one weight for the object, nodes that work it out at each
pixel (what the add-on does with weights 'Surface'), and a color attribute that the core fills at each vertex.

Run in a Blender whose Python finds skinglow:

    python tests/benchmarks/surface_weights_in_blender.py [LIGHTS ...]     # a bpy wheel; default 1 4 8

For each number of lights, on a ball of 20,000 vertices, as it is and with a subdivision modifier as characters have:
    change    from a moved light to an evaluated scene, median of 20, ms: the renderer's own work comes on top
    render    CPU time of a Cycles frame, 128 x 128 at 64 samples, one thread, the smallest of three, s
    with skin as lights   the same with Cycles' own choice of what is a light to it, which the add-on takes from skin
All in one run, with each ratio to the object's one weight.
"""

import os
import resource
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow as sg  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender import blender_version  # noqa: E402
from skinglow_blender.read.scene_lights import make_light  # noqa: E402
from skinglow_blender.read.scene_reading import read_scene  # noqa: E402

SEGMENTS, RINGS = 200, 100
DEPTH = 0.05
ATTRIBUTE = "irradiance"


def scene_of(count: int) -> tuple[bpy.types.Object, list[bpy.types.Object]]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=SEGMENTS, ring_count=RINGS)
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    made = []
    rng = np.random.default_rng(1)
    for i in range(count):
        light = bpy.data.lights.new(f"Light {i}", ("POINT", "SPOT")[i % 2])
        obj = bpy.data.objects.new(f"Light {i}", light)
        position = rng.normal(size=3)
        obj.location = 3.0 * position / np.linalg.norm(position)
        obj.rotation_euler = (-obj.location).to_track_quat("-Z", "Y").to_euler()
        bpy.context.collection.objects.link(obj)
        made.append(obj)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0.0, 0.0, 4.0)
    bpy.context.collection.objects.link(camera)
    scene = bpy.context.scene
    scene.camera, scene.render.engine = camera, "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 64, False, False
    scene.render.resolution_x = scene.render.resolution_y = 128
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    return ball, made


def graph() -> bpy.types.Depsgraph:
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def skin_with(weights: str) -> Callable[[bpy.types.Object], Callable[[], None]]:
    def make(ball: bpy.types.Object) -> Callable[[], None]:
        sb.make_skin(ball, thickness=[DEPTH * 1000.0 / 20] * len(ball.data.vertices), mode="physical", weights=weights)
        return lambda: None

    return make


def with_attribute(ball: bpy.types.Object) -> Callable[[], None]:
    """M(d) of one thickness in the material, and the light from an attribute; returns what a changed light asks for."""
    sb.make_skin(ball, thickness=[DEPTH * 1000.0 / 20] * len(ball.data.vertices), mode="physical", weights="object")
    emission = next(n for n in ball.skinglow.group.nodes if n.bl_idname == "ShaderNodeEmission")
    inner = ball.skinglow.group
    source = inner.nodes.new("ShaderNodeAttribute")
    source.attribute_name = ATTRIBUTE
    product = inner.nodes.new("ShaderNodeVectorMath")
    product.operation = "MULTIPLY"
    inner.links.new(emission.inputs["Color"].links[0].from_socket, product.inputs[0])
    inner.links.new(source.outputs["Color"], product.inputs[1])
    inner.links.new(product.outputs[0], emission.inputs["Color"])
    mesh = ball.data
    points, normals = (np.empty(3 * len(mesh.vertices), np.float32) for _ in range(2))
    mesh.vertices.foreach_get("co", points)
    mesh.vertices.foreach_get("normal", normals)
    points, normals = (a.reshape(-1, 3).astype(np.float64) for a in (points, normals))
    colors = np.ones((len(points), 4), np.float32)
    mesh.attributes.new(ATTRIBUTE, "FLOAT_COLOR", "POINT")

    def fill() -> None:
        lights = [make_light(light) for light in read_scene(graph()).lights]
        colors[:, :3] = sg.far_side_irradiance(lights, points, normals, DEPTH)
        mesh.attributes[ATTRIBUTE].data.foreach_set("color", colors.ravel())
        mesh.update()
        bpy.context.view_layer.update()

    return fill


WAYS = {"object": skin_with("object"), "nodes": skin_with("surface"), "attribute": with_attribute}


def measure(way: str, count: int, subdivided: bool) -> tuple[float, float, float]:
    ball, moved = scene_of(count)
    fill = WAYS[way](ball)
    if subdivided:
        ball.modifiers.new("Subdivision", "SUBSURF").levels = 1
    graph()
    changes = []
    for _ in range(20):
        moved[0].location.x += 0.01
        started = time.perf_counter()
        graph()
        fill()
        changes.append(1e3 * (time.perf_counter() - started))
    material = ball.data.materials[0]
    quick = frame()
    blender_version.set_emission_sampling(material, "AUTO" if hasattr(material.cycles, "emission_sampling") else 1)
    return statistics.median(changes), quick, frame()


def frame() -> float:
    times = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_SELF)
        bpy.ops.render.render()
        after = resource.getrusage(resource.RUSAGE_SELF)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(times)


def main() -> None:
    numbers = [int(a) for a in sys.argv[1:] if a.isdigit()] or [1, 4, 8]
    print(f"Blender {bpy.app.version_string}")
    for subdivided in (False, True):
        for count in numbers:
            first = None
            for way in WAYS:
                found = measure(way, count, subdivided)
                first = first or found
                cells = "  ".join(f"{v:8.2f} ({v / w:5.2f}x)" for v, w in zip(found, first, strict=True))
                mesh = "subdivided" if subdivided else "as it is"
                print(
                    f"RESULT {mesh:10} {count:2} lights  {way:9}  change ms, render s, with skin as lights s: {cells}"
                )
                sys.stdout.flush()


main()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(0)
