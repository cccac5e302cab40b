"""What light in tiles costs: a frame against plain emission and the other ways of the add-on, and new pixels.

Run in a Blender whose Python finds skinglow:

    python tests/benchmarks/tiles_in_blender.py [SEGMENTS [ENGINE]]     # a bpy wheel; default 200: 20,000 vertices

    frame    CPU time of a frame, 48 x 48 at 64 samples, the smallest of 14, s, in turns; in Cycles on one thread.
             The surface below the light of the skin is black and gets no light, so that Cycles has nothing to do but
             to find the point of the skin and run the nodes; or diffuse, in one light, the least that lit skin can be;
             or a Principled BSDF that four lights shine on. "four reads" is the least that tiles can be: four texels
             of their image at the coordinates that the mesh has, added up
    write    from pixels in memory to the image of the renderer that is shown, median of 50, ms, by the image's rows
"""

import os
import resource
import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow as sg  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.live import handlers  # noqa: E402
from skinglow_blender.show.group_nodes import GroupNodes, build_nodes  # noqa: E402
from skinglow_blender.show.node_building import NodeBuilder  # noqa: E402
from skinglow_blender.show.tile_image import TILES, place_tiles, show_tiles, tile_atlas  # noqa: E402
from skinglow_blender.table.lut_layout import Layout  # noqa: E402
from skinglow_blender.thickness.tile_attribute import TEXEL_ATTRIBUTE, ensure_tiles, rows_of  # noqa: E402

ROUNDS = 14
#: What is below the light of the skin, and how many lights there are.
SURFACES = {"black surface": ("ShaderNodeEmission", 4), "diffuse, 1 light": ("ShaderNodeBsdfDiffuse", 1)}
SURFACES["Principled, 4 lights"] = ("ShaderNodeBsdfPrincipled", 4)
#: Nodes of the skin's group, and whether the object shows tiles.
WAYS = {
    "one weight": (GroupNodes(), False),
    "tiles": (GroupNodes(tiles=True, rows=False), True),
    "tiles and rows": (GroupNodes(tiles=True), True),
    "per pixel, 4 lights": (GroupNodes(Layout(256, 2, 2, False)), False),
}


def scene(segments: int, lights: int = 4, engine: str = "CYCLES") -> bpy.types.Object:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=segments, ring_count=segments // 2, radius=30.0)
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.data.clip_end = (0.0, 0.0, 100.0), 1000.0
    bpy.context.collection.objects.link(camera)
    for i in range(lights):
        light = bpy.data.objects.new(f"Light {i}", bpy.data.lights.new(f"Light {i}", "POINT"))
        light.location, light.data.energy = (60.0 * (i % 2) - 30.0, 60.0 * (i // 2) - 30.0, 80.0), 1e5
        bpy.context.collection.objects.link(light)
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    bpy.context.scene.camera = camera
    if engine == "EEVEE":
        engine = "BLENDER_EEVEE_NEXT" if (4, 2) <= bpy.app.version < (5, 0) else "BLENDER_EEVEE"
    render.engine = engine
    bpy.context.scene.eevee.taa_render_samples = 64
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 64, False, False
    cycles.filter_width = 0.01
    render.resolution_x = render.resolution_y = 48
    render.threads_mode, render.threads = "FIXED", 1
    return ball


def tree_of(material: bpy.types.Material) -> bpy.types.NodeTree:
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    return material.node_tree


def set_surface(material: bpy.types.Material, kind: str) -> None:
    tree = tree_of(material)
    tree.nodes.clear()
    surface, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    if kind == "ShaderNodeEmission":
        surface.inputs["Strength"].default_value = 0.0
    tree.links.new(surface.outputs[0], output.inputs["Surface"])


def four_reads(material: bpy.types.Material, image: bpy.types.Image) -> None:
    """The sum of four texels of an image of tiles added to the surface."""
    emission = plain_emission(material)
    build = NodeBuilder(material.node_tree, 0.0, 0.0)
    at = build.attribute("GEOMETRY", TEXEL_ATTRIBUTE, "Texel").outputs["Vector"]
    total = None
    for step in ((0.5, 0.5, 0.0), (1.5, 0.5, 0.0), (0.5, 1.5, 0.0), (1.5, 1.5, 0.0)):
        size = tuple(1.0 / n for n in image.size)
        shift = tuple(a * b for a, b in zip(step, (*size, 0.0), strict=True))
        texel = build.texel(build.vector("MULTIPLY_ADD", at, (*size, 0.0), shift), "Texel")
        texel.image = image
        color = texel.outputs["Color"]
        total = color if total is None else build.vector("ADD", total, color)
    build.set(emission.inputs["Color"], total)


def plain_emission(material: bpy.types.Material) -> bpy.types.Node:
    """Emission of one color added to the surface, as the skin's node does it; returns its node."""
    tree = tree_of(material)
    surface = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeOutputMaterial").inputs["Surface"]
    emission, add = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeAddShader")
    emission.inputs["Strength"].default_value = 0.3
    tree.links.new(surface.links[0].from_socket, add.inputs[0])
    tree.links.new(emission.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], surface)
    sb.blender_version.set_emission_sampling(material, sb.blender_version.NO_EMISSION_SAMPLING)
    return emission


def show_random(ball: bpy.types.Object, mode: str) -> None:
    group = ball.skinglow.group
    ensure_tiles(ball, bpy.context.scene)
    (first,) = place_tiles(group, {ball: rows_of(ball.data)}).values()
    atlas = tile_atlas(group, mode)
    pixels = np.random.default_rng(1).random((rows_of(ball.data), sg.FaceTiles.WIDTH, 4), np.float32)
    atlas.rows_for(sb.identity.key_of(ball), first, len(pixels), None)[:] = pixels
    atlas.write(group)
    atlas.show(group)
    show_tiles(ball, atlas, first)


def cpu_seconds() -> float:
    """Of a frame; EEVEE compiles its shaders in one before."""
    if bpy.context.scene.render.engine != "CYCLES":
        bpy.ops.render.render()
    before = resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def frames(segments: int, kind: str, lights: int, engine: str) -> dict[str, float]:
    """Smallest times by way; all are made in one scene and shown in turns, as the machine is not alone."""
    ball = scene(segments, lights, engine)
    plain = bpy.data.materials.new("Plain")
    set_surface(plain, kind)
    skin_material, bare = plain.copy(), plain.copy()
    plain_emission(plain)
    ball.data.materials.append(skin_material)
    sb.make_skin(ball, thickness=[2.0] * len(ball.data.vertices), unit_mm=1.0, mode="physical", weights="object")
    handlers.unregister()
    build_nodes(ball.skinglow.group, WAYS["tiles"][0])
    show_random(ball, "RENDER")
    four_reads(bare, TILES.shown(ball.skinglow.group))
    best: dict[str, float] = {}
    for _ in range(ROUNDS):
        for name, material in (("emission", plain), ("four reads", bare)):
            ball.data.materials[0] = material
            best[name] = min(best.get(name, 1e9), cpu_seconds())
        ball.data.materials[0] = skin_material
        for name, (nodes, shows_tiles) in WAYS.items():
            build_nodes(ball.skinglow.group, nodes)
            if shows_tiles:
                show_random(ball, "RENDER")
            else:
                show_tiles(ball, None)
            best[name] = min(best.get(name, 1e9), cpu_seconds())
    handlers.register()
    return best


def writes(segments: int) -> None:
    ball = scene(segments)
    sb.make_skin(ball, thickness=[2.0] * len(ball.data.vertices), unit_mm=1.0, mode="physical", weights="object")
    handlers.unregister()
    group = ball.skinglow.group
    build_nodes(group, WAYS["tiles"][0])
    show_random(ball, "RENDER")
    for rows in (64, 128, 256, 512):
        TILES.renew(group, sg.FaceTiles.WIDTH, rows)
        for mode in ("VIEWPORT", "RENDER"):
            atlas = tile_atlas(group, mode)
            atlas.write(group)
            times = []
            for i in range(50):
                atlas.pixels[0, 0, 0] = i
                started = time.perf_counter()
                atlas.write(group)
                atlas.show(group)
                times.append(1e3 * (time.perf_counter() - started))
            what = "swapped" if mode == "RENDER" else "in place"
            print(f"RESULT write {rows:4} rows, {what:8}  {statistics.median(times):6.2f} ms")
            sys.stdout.flush()
    handlers.register()


def main() -> None:
    segments = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    engine = sys.argv[2] if len(sys.argv) > 2 else "CYCLES"
    print(f"Blender {bpy.app.version_string}, {engine}")
    for surface, (kind, lights) in SURFACES.items():
        best = frames(segments, kind, lights, engine)
        for name, seconds in best.items():
            print(f"RESULT frame {surface:20}  {name:20} {seconds:6.3f} s ({seconds / best['emission']:4.2f}x)")
            sys.stdout.flush()
    writes(segments)


main()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(0)
