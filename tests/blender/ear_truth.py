"""Run by a Python with bpy: an ear rendered with the add-on's own material, pixel by pixel against a Monte Carlo truth.

Usage: ear_truth.py RESULTS.json SIZE EAR...       needs ../shared/data/shape

The truths' medium and light: skin 1 of Jensen et al., index matched, a spot behind the ear, without light that enters
again. The table that light through the shape is compared with is that of the default skin, another medium. What is
found of each ear and lighting (`Difference`) goes to the results, by name.
"""

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "blender_addon"))

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow as sg  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from mathutils import Matrix, Vector  # noqa: E402
from process_end import run_and_exit  # noqa: E402

DATA = ROOT.parent / "shared" / "data" / "shape"
MEDIUM = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
#: From the ear to the light and to the camera; how far the light is, its radius and the width of its beam, mm.
TO_LIGHT, TO_CAMERA = np.array((-0.2, 0.97, 0.1)), np.array((-0.45, -0.89, 0.0))
DISTANCE, RADIUS, BEAM = 400.0, 50.0, 78.0
#: Width of the picture, mm.
ACROSS = 80.0


class Difference(NamedTuple):
    """A picture against the truth, in the pixels that show back-lit skin, without the noise of the truth."""

    pixels: int
    rms: float  #: over the mean, all three channels together
    channels: list[float]  #: the same of R, G and B
    brightness: list[float]  #: mean over the truth's, R, G, B
    irradiance: float  #: how far the add-on's light differs from the truth's where it is bright, relative
    seconds: float  #: until the light was there


def build(name: str, size: int) -> tuple[bpy.types.Object, dict, float]:
    """Scene in mm; the light's power is that of the truth's irradiance, from which it differs by the last value."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    truth, mesh = dict(np.load(DATA / f"{name}.npz")), np.load(DATA / f"{name.split('-')[0]}_mesh.npz")
    vertices, triangles = mesh["vertices_mm"].astype(float), mesh["triangles"]
    center = truth["ear_centre_mm"].astype(float)
    data = bpy.data.meshes.new(name)
    data.from_pydata((vertices - center).tolist(), [], triangles.tolist())
    data.polygons.foreach_set("use_smooth", [True] * len(triangles))
    data.materials.append(black())
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    to_light = TO_LIGHT if name.startswith("lps") else TO_LIGHT / np.linalg.norm(TO_LIGHT)
    half = np.arctan(BEAM / 2.0 / DISTANCE)
    blend = (np.cos(0.8 * half) - np.cos(half)) / (1.0 - np.cos(half))
    position, axis = DISTANCE * to_light, -to_light / np.linalg.norm(to_light)
    fields = {"radius": RADIUS, "spot_angle": 2.0 * half, "spot_blend": blend}
    light = sg.Light("SPOT", (1, 1, 1), tuple(position), tuple(axis), power=1.0, **fields)
    normals = np.empty(3 * len(vertices), np.float32)
    data.vertices.foreach_get("normal", normals)
    free = sg.surface_irradiance([light], vertices - center, normals.reshape(-1, 3))[:, 0]
    lit = truth["irradiance"] > 0.5 * np.percentile(truth["irradiance"], 99.9)
    powers = truth["irradiance"][lit] / free[lit]
    spot = bpy.data.lights.new("Light", "SPOT")
    spot.energy, spot.shadow_soft_size = float(np.median(powers)), RADIUS
    spot.spot_size, spot.spot_blend = 2.0 * half, blend
    thing = bpy.data.objects.new("Light", spot)
    thing.location, thing.rotation_euler = position, Vector(axis).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
    look_at_the_ear(size)
    return obj, truth, float(np.std(powers) / np.median(powers))


def black() -> bpy.types.Material:
    """A material that shows nothing but the light of the skin."""
    material = bpy.data.materials.new("Black")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Strength"].default_value = 0.0
    tree.links.new(emission.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def look_at_the_ear(size: int) -> None:
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale, camera.clip_end = "ORTHO", ACROSS, 1000.0
    view = bpy.data.objects.new("Camera", camera)
    direction = Vector(TO_CAMERA).normalized()
    view.matrix_world = Matrix.Translation(300.0 * direction) @ direction.to_track_quat("Z", "Y").to_matrix().to_4x4()
    scene = bpy.context.scene
    scene.collection.objects.link(view)
    scene.camera = view
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"


def picture(path: Path) -> np.ndarray:
    """Renders into that EXR file; linear pixels, (size, size, 3), from below."""
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path), check_existing=False)
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    size = image.size[:]
    bpy.data.images.remove(image)
    return pixels.reshape(size[1], size[0], 4)[..., :3]


def truth_pixels(obj: bpy.types.Object, truth: dict, size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Both halves of the truth at the pixels, radiance, and which pixels show back-lit skin alone."""
    index = np.full(len(obj.data.vertices), -1)
    index[truth["vertex"]] = np.arange(len(truth["vertex"]))
    view = bpy.context.scene.camera.matrix_world
    halves, chosen = np.zeros((2, size, size, 3)), np.zeros((size, size), bool)
    back = truth["back_lit"]
    for y in range(size):
        for x in range(size):
            start = view @ Vector((((x + 0.5) / size - 0.5) * ACROSS, ((y + 0.5) / size - 0.5) * ACROSS, 0.0))
            hit, at, _normal, face = obj.ray_cast(start, view.to_3x3() @ Vector((0, 0, -1)))
            if not hit:
                continue
            corners = list(obj.data.polygons[face].vertices)
            known = index[corners]
            if (known < 0).any() or not back[known].all():
                continue
            a, b, c = (np.array(obj.data.vertices[v].co, float) for v in corners)
            weights, *_ = np.linalg.lstsq(np.c_[[a - c, b - c]].T, np.array(at, float) - c, rcond=None)
            weights = np.array((*weights, 1.0 - weights.sum()))
            chosen[y, x] = True
            for k, half in enumerate(("exitance_half_a", "exitance_half_b")):
                halves[k, y, x] = weights @ truth[half][known].astype(float) / np.pi
    return halves[0], halves[1], chosen


def differences(name: str, size: int, lightings: tuple[str, ...], folder: Path) -> Iterator[tuple[str, Difference]]:
    """The lightings of an ear, by name, each rendered and compared."""
    obj, truth, irradiance = build(name, size)
    half_a, half_b, chosen = truth_pixels(obj, truth, size)
    a, b = half_a[chosen], half_b[chosen]
    mean = 0.5 * (a + b).mean(axis=0)
    for weights in lightings:
        started = time.perf_counter()
        sb.make_skin(obj, unit_mm=1.0, weights=weights, reentries=0)
        if weights == "shape":
            sb.set_medium(obj, **MEDIUM)
            sb.update(bpy.context.evaluated_depsgraph_get())
            state = sb.state_of(obj, bpy.context.evaluated_depsgraph_get())
            assert state.shape.reason is None, state.shape.reason
        seconds = time.perf_counter() - started
        found = picture(folder / f"{name}_{weights}.exr")[chosen]
        # The noise of the halves is independent: it drops out of the product.
        squared = ((found - a) * (found - b)).mean(axis=0)
        yield (
            weights,
            Difference(
                pixels=int(chosen.sum()),
                rms=float(np.sqrt(max(squared.mean(), 0.0)) / mean.mean()),
                channels=(np.sqrt(np.maximum(squared, 0.0)) / mean).tolist(),
                brightness=(found.mean(axis=0) / mean).tolist(),
                irradiance=irradiance,
                seconds=seconds,
            ),
        )


def main(results: str, size: str, *ears: str) -> None:
    found = {}
    for ear in ears:
        each = differences(ear, int(size), ("object", "shape"), Path(results).parent)
        found[ear] = {weights: difference._asdict() for weights, difference in each}
    Path(results).write_text(json.dumps(found))


if __name__ == "__main__":
    run_and_exit(main, *sys.argv[1:])
