"""Small scenes for the checks, and what the skin in them ought to show, computed apart from the add-on."""

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from mathutils import Vector

TABLE_1 = (
    ("Light1", (255, 112, 69), 0.92357),
    ("Light2", (15, 64, 255), 0.85231),
    ("Light3", (255, 255, 255), 1.01292),
)
BLOOD = np.array((1.8, 0.5, 0.4))


def link(obj, collection=None):
    (collection or bpy.context.scene.collection).objects.link(obj)
    return obj


def patch(name="Patch", size=2.0, location=(0.0, 0.0, 0.0), material=None):
    """A square that looks up, of four vertices, corners 0, 1, 2, 3 counter-clockwise from (-, -)."""
    h = size / 2
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [], [(0, 1, 2, 3)])
    obj = link(bpy.data.objects.new(name, mesh))
    obj.location = location
    if material is not None:
        mesh.materials.append(material)
    return obj


def strips(count, size=2.0, material=None):
    """A square that looks up, in upright strips that share no vertex, so that each has a thickness of its own."""
    edges = [-size / 2 + size * i / count for i in range(count + 1)]
    vertices, faces = [], []
    for left, right in zip(edges, edges[1:], strict=False):
        n = len(vertices)
        vertices += [(left, -size / 2, 0), (right, -size / 2, 0), (right, size / 2, 0), (left, size / 2, 0)]
        faces.append((n, n + 1, n + 2, n + 3))
    mesh = bpy.data.meshes.new("Strips")
    mesh.from_pydata(vertices, [], faces)
    if material is not None:
        mesh.materials.append(material)
    return link(bpy.data.objects.new("Strips", mesh))


def black_material(name="Black"):
    """Gives no light of its own, so that a render shows the lookup alone."""
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Strength"].default_value = 0.0
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def add_light(name="Lamp", kind="POINT", color=(1.0, 1.0, 1.0), energy=10.0, location=(0.0, 0.0, 1.0), collection=None):
    light = bpy.data.lights.new(name, kind)
    light.color, light.energy = color, energy
    obj = link(bpy.data.objects.new(name, light), collection)
    obj.location = location
    return obj


def table_1():
    """The paper's three lights, at their distances from the origin, each on an axis of its own."""
    objects = []
    for axis, (name, color, distance) in enumerate(TABLE_1):
        location = [0.0, 0.0, 0.0]
        location[axis] = distance
        objects.append(add_light(name, color=[c / 255 for c in color], location=location))
    return objects


def depsgraph():
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def weight(objects, point, coefficients=(1.0, 0.0, 1.0)):
    """Eq. 2 and 3 in numpy, from the lights as Blender has them."""
    bpy.context.view_layer.update()
    total = np.zeros(3)
    for obj in objects:
        color = np.array(obj.data.color, dtype=np.float64)
        # A light that the viewport hides has no world matrix yet.
        free = obj.parent is None and not obj.constraints
        place = np.array(obj.location if free else obj.matrix_world.translation, dtype=np.float64)
        distance = 0.0 if obj.data.type == "SUN" else np.linalg.norm(place - np.asarray(point))
        k_c, k_l, k_q = coefficients
        below = k_c + k_l * distance + k_q * distance**2
        total += color if obj.data.type == "SUN" else color * min(1.0 / below, 1.0)
    return total


def visible_lights(graph, dark=False):
    """(evaluated light, world matrix) of all that shine in a depsgraph, instances too; dark: and without power."""
    for instance in graph.object_instances:
        obj = instance.object
        if obj.type != "LIGHT" or (obj.data.energy == 0.0 and not dark):
            continue
        base = instance.parent if instance.is_instance else obj
        if graph.mode == "VIEWPORT" and not base.original.visible_get(view_layer=graph.view_layer):
            continue
        yield obj, np.array(instance.matrix_world, dtype=float)


def fresh_table(obj, graph, size=256, thickest=12.0):
    """Eq. 1 to 3 for a skin at its bounds' center, in numpy, from a depsgraph's own list of lights."""
    evaluated = obj.evaluated_get(graph)
    corners = np.array([evaluated.matrix_world @ Vector(corner) for corner in evaluated.bound_box], dtype=float)
    point = (corners[0] + corners[6]) / 2
    total = np.array(BLOOD)
    for other, matrix in visible_lights(graph):
        distance = 0.0 if other.data.type == "SUN" else np.linalg.norm(matrix[:3, 3] - point)
        total += np.array(other.data.color, dtype=float) / (1.0 + distance**2)
    return (gray(size, thickest)[:, None] * total).astype(np.float32)


def fresh_physical_table(obj, graph, base):
    """M(d) E / pi for a skin at its bounds' center, from a depsgraph's own list of lights."""
    evaluated = obj.evaluated_get(graph)
    matrix = np.array(evaluated.matrix_world, dtype=float)
    corners = np.array(evaluated.bound_box, dtype=float)[[0, 6]]
    point = matrix[:3, :3] @ corners.mean(axis=0) + matrix[:3, 3]
    lights = [physical_light(other.data, place) for other, place in visible_lights(graph)]
    return sg.recolor(base, sg.object_irradiance(lights, point) / np.pi).astype(np.float32)


def physical_light(light, matrix):
    """The core's light for one of Blender's without nodes, square where it has an area."""
    fields = {
        "kind": light.type,
        "color": light.color,
        "power": light.energy,
        "position": matrix[:3, 3],
        "direction": -matrix[:3, 2],
    }
    early = bpy.app.version < (4, 0, 0)
    if light.type in ("POINT", "SPOT"):
        fields["radius"] = light.shadow_soft_size
        fields["soft_falloff"] = early or light.use_soft_falloff
    if light.type == "SPOT":
        fields |= {"spot_angle": light.spot_size, "spot_blend": light.spot_blend, "spot_cosine": early}
    if light.type == "SUN":
        fields["sun_angle"] = light.angle
        fields["power"] *= sg.legacy_sun_power_factor(light.angle) if early else 1.0
    if light.type == "AREA":
        across, up = (light.size * np.linalg.norm(matrix[:3, axis]) for axis in (0, 1))
        fields |= {"area_shape": "RECTANGLE", "size_x": across, "size_y": up}
        fields |= {"tangent": matrix[:3, 0], "spread": light.spread}
        fields["power"] *= sg.LEGACY_AREA_POWER_FACTOR if early else 1.0
    return sg.Light(**fields)


def assert_fresh(*skins):
    """Each skin shows what is computed afresh; its corner's sums are taken in single precision here."""
    graph = depsgraph()
    for obj in skins:
        shown = sb.lut(obj, graph)
        expected = fresh_table(obj, graph)
        np.testing.assert_allclose(shown, expected, rtol=3e-6, err_msg=obj.name)


def gray(size=256, thickest=12.0):
    return sg.six_gaussian_base(size, thickest).matrices[:, 0, 0]


def paper_table(objects, point=(0.0, 0.0, 0.0), size=256, thickest=12.0, coefficients=(1.0, 0.0, 1.0)):
    """Eq. 1, single precision."""
    return (gray(size, thickest)[:, None] * (BLOOD + weight(objects, point, coefficients))).astype(np.float32)


def assert_shows(obj, expected, ulps=1):
    """The lookup shown is this one, but for the last bit of sums taken in another order."""
    shown = sb.lut(obj, depsgraph())
    assert shown.shape == expected.shape, (shown.shape, expected.shape)
    np.testing.assert_array_max_ulp(shown, expected, ulps)


def camera_above(size=2.0, location=(0.0, 0.0, 5.0)):
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale = "ORTHO", size
    obj = link(bpy.data.objects.new("Camera", camera))
    obj.location = location
    bpy.context.scene.camera = obj
    return obj


def render_settings(width=16, height=16, engine="CYCLES"):
    scene = bpy.context.scene
    if engine == "EEVEE":
        engine = "BLENDER_EEVEE_NEXT" if (4, 2) <= bpy.app.version < (5, 0) else "BLENDER_EEVEE"
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.filter_size = 0.01
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.device = 1, False, "CPU"
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.eevee.taa_render_samples = 1
    if engine != "CYCLES":
        leave_out_what_no_check_asks_for(scene)
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    return scene


def leave_out_what_no_check_asks_for(scene):
    """EEVEE draws what reflections show of the world, and shadows, for each picture: nine tenths of its time here."""
    if bpy.app.version < (4, 2):
        scene.eevee.gi_cubemap_resolution = "128"
        return
    scene.eevee.use_shadows = False
    if scene.world is None:
        scene.world = bpy.data.worlds.new("Dark")
        scene.world.color = (0.0, 0.0, 0.0)
        if scene.world.node_tree:
            scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    scene.world.probe_resolution = "128"


def read_exr(path):
    """(height, width, 3), bottom row first."""
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[:, :, :3]
