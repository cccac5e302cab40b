"""Skins that show a function of the place through tiles, filled by the checks themselves rather than by the update."""

from contextlib import contextmanager

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.live import handlers
from skinglow_blender.show.group_nodes import GroupNodes, build_nodes
from skinglow_blender.show.tile_image import place_tiles, show_tiles, tile_atlas
from skinglow_blender.thickness.tile_attribute import ensure_tiles, rows_of, texels_of

from inside.scenes import depsgraph, patch, read_exr

TILES_ONLY = GroupNodes(tiles=True, rows=False)
#: Of the sine, per mm: light falls by a power of e in 2 to 4 mm of skin.
WAVES = np.array(((0.31, 0.12, -0.2), (-0.1, 0.33, 0.16), (0.2, -0.15, 0.3)))
THICKNESS = 2.0


def function(points):
    """(n, 3) to (n, 3), from .1 to .9."""
    return 0.5 + 0.4 * np.sin(points @ WAVES.T + np.array((0.3, 1.1, 2.0)))


@contextmanager
def without_updates():
    """The add-on's handlers leave nodes and tiles as the check made them."""
    handlers.unregister()
    try:
        yield
    finally:
        handlers.register()


def ball(name, location=(0.0, 0.0, 0.0), mesh=None, material=None):
    """A ball of 10 mm, with bumps, of quads and triangles; 1 unit is 1 mm."""
    if mesh is None:
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=10.0)
        made = bpy.context.object
        mesh = made.data
        bpy.data.objects.remove(made)
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        points = points.reshape(-1, 3)
        points *= 1.0 + 0.05 * np.sin(points @ np.array((0.5, 0.7, 0.3)))[:, None]
        mesh.vertices.foreach_set("co", points.ravel())
        mesh.materials.append(material)
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    obj.location = location
    return obj


def block(name, size, location, material):
    """A square that looks up, as scenes.patch, on a closed body of 2 mm: light comes through bodies alone."""
    obj = patch(name, size, location, material)
    h, low = size / 2, -THICKNESS
    top = [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)]
    sides = [(i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)]
    obj.data.clear_geometry()
    obj.data.from_pydata([*top, *((x, y, low) for x, y, _z in top)], [], [(0, 1, 2, 3), (7, 6, 5, 4), *sides])
    return obj


def make_skins(objects, nodes=TILES_ONLY):
    """Skins of one group with these nodes."""
    for obj in objects:
        sb.make_skin(obj, thickness=[THICKNESS] * len(obj.data.vertices), unit_mm=1.0, mode="paper")
    group = objects[0].skinglow.group
    build_nodes(group, nodes)
    return group


def fill(group, objects, mode="RENDER", light=function):
    """Gives the objects tiles with `light` at each point of the evaluated mesh, in the object's own space."""
    for obj in objects:
        ensure_tiles(obj, bpy.context.scene)
    graph = depsgraph()
    rows = place_tiles(group, {obj: rows_of(obj.data) for obj in objects})
    atlas = tile_atlas(group, mode)
    for obj in objects:
        key = sb.identity.key_of(obj)
        height = rows_of(obj.data)
        pixels = pixels_of(obj.evaluated_get(graph).data, height, light)
        atlas.rows_for(key, rows[key], height, None)[:] = pixels
        show_tiles(obj, atlas, rows[key])
    atlas.write(group)
    atlas.show(group)
    return atlas


def pixels_of(mesh, height, light=function):
    """(height, width, 4): light and thickness at the texels of an evaluated mesh."""
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    mesh.calc_loop_triangles()
    triangles, corners = (np.empty(3 * len(mesh.loop_triangles), np.int32) for _ in range(2))
    mesh.loop_triangles.foreach_get("vertices", triangles)
    mesh.loop_triangles.foreach_get("loops", corners)
    texels = texels_of(mesh)[corners].reshape(-1, 3, 3)
    targets = sg.TileTargets(vertices.reshape(-1, 3), triangles.reshape(-1, 3), texels, height)
    values = np.empty((len(targets.points), 4), np.float32)
    values[:, :3], values[:, 3] = light(np.asarray(targets.points)), THICKNESS
    return targets.spread(values)


def render(path):
    """(height, width, 3) of the scene, bottom row first."""
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return read_exr(path)


def places(path, offset, scale):
    """(height, width, 3): the place in each pixel, by a material that emits it; NaN where there is nothing."""
    material = bpy.data.materials.new("Place")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    geometry, away, emission, output = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("NewGeometry", "VectorMath", "Emission", "OutputMaterial")
    )
    away.operation = "SUBTRACT"
    away.inputs[1].default_value = np.subtract(offset, 2.0 * scale)
    tree.links.new(geometry.outputs["Position"], away.inputs[0])
    tree.links.new(away.outputs[0], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    bpy.context.view_layer.material_override = material
    try:
        found = render(path).astype(np.float64)
    finally:
        bpy.context.view_layer.material_override = None
    found[found.max(axis=2) == 0.0] = np.nan
    return found + offset - 2.0 * scale
