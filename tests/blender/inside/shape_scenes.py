"""A body in Blender that light goes through, and what its tiles ought to show, computed apart from the add-on."""

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from mathutils import Matrix, Vector
from skinglow_blender.show.image_pairs import read_pixels
from skinglow_blender.show.tile_image import TILE_PROPERTY, TILES

from inside.scenes import depsgraph, link, physical_light, visible_lights


def lobe(name="Lobe", material=None, levels=3):
    """A bent flat ellipsoid of 12 x 10 x 3 units, something like an ear's lobe."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=levels + 1, radius=1.0)
    obj = bpy.context.object
    obj.name = name
    mesh = obj.data
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3) * (6.0, 5.0, 1.5)
    points[:, 2] += 1.8 * np.sin(points[:, 0] / 3.6)
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.update()
    if material is not None:
        mesh.materials.append(material)
    return obj


BODY_VERTICES = 12
#: By all that was asked, what `fresh` found: environments and occluders by identity, so that they are kept, too.
SOLVED = {}


def thin_body(name="Body", material=None):
    """A flat body of 5 x 4 x 2 units and few cells: light is solved in it in a few hundredths of a second."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=1.0)
    obj = bpy.context.object
    obj.name = name
    for vertex in obj.data.vertices:
        vertex.co = [length * x for length, x in zip((2.5, 2.0, 1.0), vertex.co, strict=True)]
    assert len(obj.data.vertices) == BODY_VERTICES
    if material is not None:
        obj.data.materials.append(material)
    return obj


def shape_skin(obj, **settings):
    """Makes it a skin whose unit is 1 mm, lit through its shape."""
    thickness = [3.0] * len(obj.data.vertices)
    return sb.make_skin(obj, thickness=thickness, **{"unit_mm": 1.0, "weights": "shape", "cell_mm": 1.0, **settings})


def sun(location_free=True, energy=3.0, direction=(0.2, 0.1, 1.0)):
    """From below, upwards."""
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = energy
    obj = link(bpy.data.objects.new("Sun", light))
    turn(obj, direction)
    return obj


def turn(obj, direction):
    """Has a light shine in a direction."""
    obj.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()


def corners(obj, graph, matrix):
    """Of the triangles of the evaluated mesh: vertices in the world, triangles, texels."""
    mesh = obj.evaluated_get(graph).data
    matrix = np.array(matrix, float)
    vertices = np.array([v.co for v in mesh.vertices], float) @ matrix[:3, :3].T + matrix[:3, 3]
    mesh.calc_loop_triangles()
    triangles = np.array([t.vertices for t in mesh.loop_triangles])
    loops = np.array([t.loops for t in mesh.loop_triangles])
    texels = np.array([d.vector for d in mesh.attributes["skinglow_texel"].data], np.float32)[loops]
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        triangles, texels = triangles[:, ::-1], texels[:, ::-1]
    return vertices, np.ascontiguousarray(triangles), np.ascontiguousarray(texels)


def shown(obj, graph, rows):
    """The pixels that the object's material shows, (rows, 1024, 4)."""
    first, _width, height, use = obj[TILE_PROPERTY]
    assert use == 1.0, "its tiles are not shown"
    pixels = read_pixels(TILES.pair(obj.skinglow.group, graph.mode)[_front(obj, graph)])
    assert abs(height * len(pixels) - 1.0) < 1e-6
    return pixels[int(first) : int(first) + rows]


def _front(obj, graph):
    from skinglow_blender.identity import key_of
    from skinglow_blender.session import SESSION

    return SESSION.tile_atlases[key_of(obj.skinglow.group), graph.mode].front


def fresh(
    obj, graph, as_it_stands=False, flesh=None, environment=None, occluders=None, cell_mm=1.0, reentries=2, matrix=None
):
    """(k, 3) radiance at the targets, the targets, and where no light falls on the skin.

    as_it_stands  solved in the orientation of the world, which cuts other cells from a turned body; else turned back
    matrix        in the world, of an instance; None: the object's own
    """
    matrix = obj.evaluated_get(graph).matrix_world if matrix is None else matrix
    vertices, triangles, texels = corners(obj, graph, matrix)
    position, rotation, _scale = matrix.decompose()
    # Far from the world's origin single precision would be what differs.
    to_world = np.array(Matrix.Translation(position) @ rotation.to_matrix().to_4x4(), float)
    if as_it_stands:
        to_world[:3, :3] = np.eye(3)
    vertices = (vertices - to_world[:3, 3]) @ to_world[:3, :3]
    to_body, lights, shadowless = np.linalg.inv(to_world), [], []
    for light, at in visible_lights(graph, dark=True):  # an instance is valid no longer than its turn
        if not light.data.use_shadow:
            shadowless.append(len(lights))
        lights.append(physical_light(light.data, to_body @ at))
    rows = int(obj.data["skinglow_tiles"]["rows"])
    flesh = {"tissue": sg.TISSUE_PRESETS["light"]} if flesh is None else flesh
    # What nothing changed that it depends on is the same again: random edits ask for it after each.
    asked = (vertices.tobytes(), triangles.tobytes(), texels.tobytes(), rows, repr(flesh), cell_mm)
    asked += (repr([fields_of(light) for light in lights]), tuple(shadowless), environment, occluders, reentries)
    if asked not in SOLVED:
        if len(SOLVED) > 100:
            SOLVED.clear()
        targets = sg.TileTargets(vertices, triangles, texels, rows, unit_mm=1.0)
        where = {"points": targets.points, "normals": targets.normals}
        shape = sg.Shape(vertices, triangles, unit_mm=1.0, cell_mm=cell_mm, **where, **flesh)
        lit = shape.light(lights, environment, occluders, reentries, shadowless=shadowless)
        dark = (lit.exitance - lit.transmitted).max(axis=1) <= 1e-3 * lit.exitance.max()
        SOLVED[asked] = lit.transmitted / np.pi, targets, dark
    return SOLVED[asked]


def fields_of(light):
    """All that a light of the core is."""
    fields = {name: getattr(light, name) for name in dir(light) if not name.startswith("_")}
    return {name: np.asarray(value).tolist() for name, value in fields.items() if not callable(value)}


def differences(obj, graph, as_it_stands=False, **expected):
    """(RMS of what the tiles show against what is computed afresh, mean of that).

    as_it_stands  only where no light falls on the skin: elsewhere what comes through is a small difference of what the
                  skin sends out, and other cells change it
    """
    wanted, targets, dark = fresh(obj, graph, as_it_stands, **expected)
    pixels = shown(obj, graph, len(targets.of_texel))
    there = targets.of_texel >= 0
    if as_it_stands:
        there &= dark[targets.of_texel]
    if not there.any():
        return 0.0, 0.0
    found, want = pixels[there][:, :3], wanted[targets.of_texel[there]]
    return float(np.sqrt(((found - want) ** 2).mean())), float(want.mean())


def assert_through(obj, tolerance=1e-3, graph=None, **more):
    """The tiles show what is computed afresh, RMS over mean."""
    error, mean = differences(obj, graph or depsgraph(), **more)
    assert mean > 0.0
    assert error <= tolerance * mean, error / mean
    return error / mean


def assert_through_turned(obj, tolerance=0.1):
    """The same of a body that is turned in the world, as it stands."""
    return assert_through(obj, tolerance, as_it_stands=True)
