"""Every kind of light on a white Lambert plane: what Cycles renders, against the core, to 0.5 %."""

import math

import bpy
import numpy as np
import skinglow as sg
from mathutils import Vector
from skinglow_blender.read import scene_lights

from inside.scenes import add_light, camera_above, depsgraph, patch, read_exr, render_settings

AGREEMENT = 0.005
UP = np.array([[0.0, 0.0, 1.0]])


def white_lambert():
    material = bpy.data.materials.new("White")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    diffuse.inputs["Roughness"].default_value = 0.0
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material


def stage(samples=2048):
    """A patch so small that its irradiance is that of its middle, seen from above, and nothing else."""
    patch(size=0.002, material=white_lambert())
    camera_above(size=0.001, location=(0.0, 0.0, 0.5))
    scene = render_settings(4, 4)
    scene.cycles.samples = samples
    scene.cycles.max_bounces = 0
    scene.cycles.sample_clamp_direct = 0.0
    scene.cycles.use_adaptive_sampling = False
    if hasattr(scene.cycles, "light_sampling_threshold"):
        scene.cycles.light_sampling_threshold = 0.0
    return scene


def rendered_irradiance(work, scene):
    scene.render.filepath = str(work / "plane.exr")
    bpy.ops.render.render(write_still=True)
    return math.pi * read_exr(scene.render.filepath).astype(float).mean(axis=(0, 1))


def core_irradiance(obj):
    evaluated = obj.evaluated_get(depsgraph())
    read = scene_lights.read_light(evaluated, evaluated.matrix_world, obj.name)
    light = scene_lights.make_light(read)
    return sg.surface_irradiance([light], np.zeros((1, 3)), UP)[0]


def compare(work, scene, kind, location, aim=(0.0, 0.0, 0.0), scale=(1.0, 1.0, 1.0), setup=None, **settings):
    """Places one light that looks at `aim`; returns the worst relative difference of Cycles and the core."""
    obj = add_light(kind=kind, energy=100.0, color=(1.0, 0.5, 0.25), location=location)
    obj.rotation_euler = (Vector(aim) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    obj.scale = scale
    obj.visible_camera = False
    obj.data.shadow_soft_size = 0.0
    for name, value in settings.items():
        setattr(obj.data, name, value)
    if setup is not None:
        setup(obj.data)
    expected = core_irradiance(obj)
    seen = rendered_irradiance(work, scene)
    bpy.data.objects.remove(obj)
    assert abs(expected[0]) > 0.01, f"the case shows nothing: {expected}"
    return float(np.max(np.abs(seen / expected - 1.0))), seen[0], expected[0]


def assert_agree(work, cases):
    scene = stage()
    found = {name: compare(work, scene, **case) for name, case in cases.items()}
    off = {name: values for name, values in found.items() if not values[0] < AGREEMENT}
    assert not off, f"relative difference, Cycles, core: {off}"
    return {name: values[0] for name, values in found.items()}


def check_points(work):
    cases = {
        "small": {"kind": "POINT", "location": (0.6, 0.0, 2.0)},
        "soft": {"kind": "POINT", "location": (0.0, 0.0, 2.0), "shadow_soft_size": 0.5},
        "soft on the horizon": {"kind": "POINT", "location": (1.0, 0.2, 0.2), "shadow_soft_size": 0.6},
        "negative": {"kind": "POINT", "location": (0.0, 0.5, 1.0), "energy": -40.0},
    }
    if "use_soft_falloff" in bpy.types.PointLight.bl_rna.properties:
        ball = {"use_soft_falloff": False}
        cases["ball"] = {"kind": "POINT", "location": (0.0, 0.5, 2.0), "shadow_soft_size": 0.5, **ball}
        cases["ball on the horizon"] = {
            "kind": "POINT",
            "location": (1.0, 0.0, 0.2),
            "shadow_soft_size": 0.5,
            **ball,
        }
    return assert_agree(work, cases)


def check_spots(work):
    cone = {"kind": "SPOT", "location": (0.0, 0.0, 2.0), "spot_size": 1.0, "spot_blend": 0.4}
    return assert_agree(
        work,
        {
            "on the axis": cone,
            "in the blend": {**cone, "aim": (0.85, 0.0, 0.0)},
            "no blend": {**cone, "aim": (0.9, 0.0, 0.0), "spot_blend": 0.0},
            "all blend": {**cone, "aim": (0.5, 0.0, 0.0), "spot_blend": 1.0},
            "half turn": {**cone, "aim": (3.0, 0.0, 0.0), "spot_size": math.pi, "spot_blend": 0.15},
            "soft, on the axis": {**cone, "shadow_soft_size": 0.2},
            "soft, in the blend": {**cone, "aim": (0.85, 0.0, 0.0), "shadow_soft_size": 0.3},
        },
    )


def check_suns(work):
    return assert_agree(
        work,
        {
            "sharp": {"kind": "SUN", "location": (0.5, 0.0, 1.0), "energy": 3.0, "angle": 0.0},
            "wide": {"kind": "SUN", "location": (0.5, 0.0, 1.0), "energy": 3.0, "angle": 0.6},
            "on the horizon": {"kind": "SUN", "location": (1.0, 0.0, 0.05), "energy": 3.0, "angle": 0.3},
        },
    )


def check_areas(work):
    near = {"kind": "AREA", "location": (0.3, 0.0, 1.0)}
    rectangle = {**near, "shape": "RECTANGLE", "size": 1.5, "size_y": 0.5}
    disk = {**near, "shape": "DISK", "size": 1.2}
    low = {"location": (1.0, 0.0, 0.2)}
    return assert_agree(
        work,
        {
            "square": {**near, "shape": "SQUARE", "size": 1.0},
            "rectangle": rectangle,
            "disk": disk,
            "ellipse": {**near, "shape": "ELLIPSE", "size": 1.5, "size_y": 0.5},
            "far": {**rectangle, "location": (0.0, 3.0, 10.0)},
            "scaled": {**rectangle, "scale": (0.5, 2.0, 1.0)},
            "rectangle on the horizon": {**rectangle, **low},
            "disk on the horizon": {**disk, **low},
            "off its axis": {**rectangle, "aim": (1.0, 0.5, 0.0)},
            "rectangle with spread": {**rectangle, "spread": 1.0},
            "disk with spread": {**disk, "spread": 2.0, "aim": (0.2, 0.3, 0.0)},
        },
    )


def check_areas_with_a_size_of_0(work):
    """Neither Cycles nor the core gives any light; a size just above 0 is a line, and does."""
    scene = stage(samples=512)
    found = {}
    for shape in ("RECTANGLE", "ELLIPSE"):
        for size_x, size_y in ((0.0, 1.0), (1.0, 0.0), (0.0, 0.0), (1.0, 0.01)):
            obj = add_light(kind="AREA", energy=100.0, location=(0.3, 0.0, 1.0))
            obj.data.shape, obj.data.size, obj.data.size_y = shape, size_x, size_y
            expected, seen = core_irradiance(obj), rendered_irradiance(work, scene)
            found[f"{shape} {size_x} {size_y}"] = (seen[0], expected[0])
            bpy.data.objects.remove(obj)
    wrong = {
        name: (seen, expected)
        for name, (seen, expected) in found.items()
        if not (abs(seen - expected) <= 0.05 * expected and (expected > 1.0) == name.endswith("0.01"))
    }
    assert not wrong, f"Cycles, core: {wrong}"
    return found


def check_nodes(work):
    def nodes(light):
        light.use_nodes = True
        emission = next(n for n in light.node_tree.nodes if n.type == "EMISSION")
        emission.inputs["Strength"].default_value = 2.5
        emission.inputs["Color"].default_value = (0.5, 0.25, 1.0, 1.0)

    return assert_agree(work, {"nodes": {"kind": "POINT", "location": (0.0, 0.3, 1.0), "setup": nodes}})


def check_settings_of_4_5(work):
    """Exposure, temperature and lights that are not normalized; Blender before 4.5 has none of them."""
    if "exposure" not in bpy.types.Light.bl_rna.properties:
        assert bpy.app.version < (4, 5, 0)
        return None
    point = {"kind": "POINT", "location": (0.0, 0.3, 1.0), "shadow_soft_size": 0.2}
    return assert_agree(
        work,
        {
            "exposure": {**point, "exposure": 1.5},
            "temperature": {**point, "use_temperature": True, "temperature": 3000.0},
            "point": {**point, "normalize": False},
            "spot": {**point, "kind": "SPOT", "normalize": False},
            "sun": {"kind": "SUN", "location": (0.0, 0.3, 1.0), "angle": 0.5, "normalize": False},
            "rectangle": {"kind": "AREA", "location": (0.0, 0.3, 1.0), "size": 0.6, "normalize": False},
            "ellipse": {
                "kind": "AREA",
                "location": (0.0, 0.3, 1.0),
                "shape": "ELLIPSE",
                "size": 0.6,
                "size_y": 0.3,
                "normalize": False,
            },
        },
    )
