"""Every array that a public function takes: found in the stubs and sources, and a call of each."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
import skinglow as sg

PACKAGE = Path(__file__).parents[2] / "python_bindings" / "skinglow"
DATA = Path(__file__).parents[1] / "data"
TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
CORNERS = [[0, 1, 2]]
LIGHT = sg.Light("POINT", (1, 1, 1), (0, 0, 1), power=1)
GRAY = sg.BaseLut([1.0, 0.5], 12.0)
SKY = sg.Environment((1.0, 1.0, 1.0))
LAYOUT = sg.FaceTiles(TRIANGLE, [3], [0, 1, 2])
TEXELS = LAYOUT.texels.reshape(1, 3, 3)
TARGETS = sg.TileTargets(TRIANGLE, CORNERS, TEXELS, LAYOUT.height)
WEIGHT = sg.AngularWeight([0.0, 1.0], [0.5, 1.0])
CURVE = sg.ThicknessCurve([sg.Layer(1.4, 0.1, 1.0, 0.5, 1.0)], 0)
LIGHTING = sg.SurfaceLighting([LIGHT], (0, 0, 0), (1, 1, 1))
NOTHING = sg.Occluders([])
MEDIUM = {"absorption": 0.1, "reduced_scattering": 1.0}
POINT, COLOR, FLAT, UV = [1.0, 2, 3], [1.0, 0, 1], [0.5] * 81, [[[0.0, 0], [1, 0], [0, 1]]]
ONES = np.ones(len(TARGETS.points))


@cache
def shape() -> sg.Shape:
    return sg.Shape(TRIANGLE, CORNERS, **MEDIUM)


def body(**change: object) -> sg.Shape:
    given = dict(vertices=TRIANGLE, triangles=CORNERS) | MEDIUM | change
    return sg.Shape(**given)


def scene(**change: object) -> dict[str, str]:
    given = dict(
        vertices=TRIANGLE,
        triangles=CORNERS,
        lut_u=None if "glow_uv" in change else np.zeros(3),
        camera_matrix=np.eye(4),
        resolution=(8, 8),
        angle_x=None if "projection" in change else 0.7,
        base=GRAY,
        image="glow.exr" if "glow_uv" in change else "",
    )
    return sg.povray_files(**given | change)


Call = tuple[Callable[[object], object], object]
#: By function(argument): the argument, and what it may be.
REAL: dict[str, Call] = {
    "Light(color)": (lambda a: sg.Light("POINT", a, (1, 1, 1)), COLOR),
    "Light(position)": (lambda a: sg.Light("POINT", (1, 1, 1), a), POINT),
    "Light(direction)": (lambda a: sg.Light("SUN", direction=a), POINT),
    "Light(tangent)": (lambda a: sg.Light("AREA", tangent=a), POINT),
    "Light.moved(motion)": (LIGHT.moved, np.eye(4)),
    "attenuation(distance)": (sg.attenuation, [1.0, 2]),
    "attenuation(coefficients)": (lambda a: sg.attenuation(1.0, a), COLOR),
    "light_weights(point)": (lambda a: sg.light_weights([LIGHT], a), POINT),
    "light_weights(coefficients)": (lambda a: sg.light_weights([LIGHT], POINT, a), COLOR),
    "light_weight(point)": (lambda a: sg.light_weight([LIGHT], a), POINT),
    "light_weight(coefficients)": (lambda a: sg.light_weight([LIGHT], POINT, a), COLOR),
    "BaseLut(values)": (lambda a: sg.BaseLut(a, 12.0), [1.0, 0.5]),
    "recolor(weight)": (lambda a: sg.recolor(GRAY, a), COLOR),
    "table_at(colors)": (lambda a: sg.table_at(a, (1.0, 0.0), [1.0]), TRIANGLE),
    "table_at(thickness_mm)": (lambda a: sg.table_at(TRIANGLE, (1.0, 0.0), a), [0.0, 1.0]),
    "ThicknessCurve.transmittance(thickness_mm)": (CURVE.transmittance, [1.0, 2.0]),
    "transmittance(thickness_mm)": (lambda a: sg.transmittance(sg.Tissue(), a, [600.0]), [1.0]),
    "transmittance(wavelength_nm)": (lambda a: sg.transmittance(sg.Tissue(), [1.0], a), [600.0]),
    "rgb_spectrum(rgb)": (sg.rgb_spectrum, COLOR),
    "tabulated_spectrum(wavelength_nm)": (lambda a: sg.tabulated_spectrum(a, [1.0, 2.0]), [500.0, 600]),
    "tabulated_spectrum(power)": (lambda a: sg.tabulated_spectrum([500.0, 600.0], a), [1.0, 2.0]),
    "spectral_color(spectrum)": (sg.spectral_color, FLAT),
    "spectral_color(transmittance)": (lambda a: sg.spectral_color(FLAT, a), FLAT),
    "transmission_matrix(transmittance)": (sg.transmission_matrix, FLAT),
    "AngularWeight(mu)": (lambda a: sg.AngularWeight(a, [0.5, 1.0]), [0.0, 1.0]),
    "AngularWeight(transmittance)": (lambda a: sg.AngularWeight([0.0, 1.0], a), [0.5, 1.0]),
    "AngularWeight.at(mu)": (WEIGHT.at, [0.0, 1.0]),
    "Environment(radiance)": (sg.Environment, np.ones((2, 4, 3))),
    "Environment.from_image(pixels)": (sg.Environment.from_image, np.ones((2, 4, 3))),
    "Environment.rotated(rotation)": (SKY.rotated, np.eye(3)),
    "Environment.irradiance(normals)": (SKY.irradiance, TRIANGLE),
    "object_irradiance_by_light(point)": (lambda a: sg.object_irradiance_by_light([LIGHT], a), POINT),
    "object_irradiance(point)": (lambda a: sg.object_irradiance([LIGHT], a), POINT),
    "surface_irradiance(points)": (lambda a: sg.surface_irradiance([LIGHT], a, TRIANGLE), TRIANGLE),
    "surface_irradiance(normals)": (lambda a: sg.surface_irradiance([LIGHT], TRIANGLE, a), TRIANGLE),
    "far_side(vertices)": (lambda a: sg.far_side(a, TRIANGLE, 1.0), TRIANGLE),
    "far_side(normals)": (lambda a: sg.far_side(TRIANGLE, a, 1.0), TRIANGLE),
    "far_side(depth)": (lambda a: sg.far_side(TRIANGLE, TRIANGLE, a), [1.0, 2, 3]),
    "far_side_irradiance(vertices)": (lambda a: sg.far_side_irradiance([LIGHT], a, TRIANGLE, 1.0), TRIANGLE),
    "far_side_irradiance(normals)": (lambda a: sg.far_side_irradiance([LIGHT], TRIANGLE, a, 1.0), TRIANGLE),
    "far_side_irradiance(depth)": (lambda a: sg.far_side_irradiance([LIGHT], TRIANGLE, TRIANGLE, a), POINT),
    "SurfaceLighting(box_min)": (lambda a: sg.SurfaceLighting([LIGHT], a, (9, 9, 9)), POINT),
    "SurfaceLighting(box_max)": (lambda a: sg.SurfaceLighting([LIGHT], (0, 0, 0), a), POINT),
    "SurfaceLighting.irradiance(points)": (lambda a: LIGHTING.irradiance(a, TRIANGLE), TRIANGLE),
    "SurfaceLighting.irradiance(normals)": (lambda a: LIGHTING.irradiance(TRIANGLE, a), TRIANGLE),
    "normal_cone(normals)": (sg.normal_cone, TRIANGLE),
    "PreparedRig.cull(box_min)": (lambda a: sg.PreparedRig([LIGHT]).cull(a, (9, 9, 9), 1.0), POINT),
    "PreparedRig.cull(box_max)": (lambda a: sg.PreparedRig([LIGHT]).cull((0, 0, 0), a, 1.0), POINT),
    "object_irradiance_error(point)": (lambda a: sg.object_irradiance_error([], a, POINT, POINT), POINT),
    "object_irradiance_error(box_min)": (lambda a: sg.object_irradiance_error([], POINT, a, POINT), POINT),
    "object_irradiance_error(box_max)": (lambda a: sg.object_irradiance_error([], POINT, POINT, a), POINT),
    "object_irradiance_error(facing)": (
        lambda a: sg.object_irradiance_error([], POINT, POINT, POINT, facing=(a, 1.0)),
        POINT,
    ),
    "light_report(point)": (lambda a: sg.light_report([LIGHT], a), POINT),
    "light_report(normal)": (lambda a: sg.light_report([LIGHT], POINT, a), POINT),
    "read_light_rig(camera_rotation)": (lambda a: sg.read_light_rig(DATA / "two_lamps.sl", a), POINT),
    "povray_files(vertices)": (lambda a: scene(vertices=a), TRIANGLE),
    "povray_files(lut_u)": (lambda a: scene(lut_u=a), [0.0, 0.5, 1.0]),
    "povray_files(camera_matrix)": (lambda a: scene(camera_matrix=a), np.eye(4)),
    "povray_files(resolution)": (lambda a: scene(resolution=a), [8, 8]),
    "povray_files(projection)": (lambda a: scene(projection=a), np.diag([1.0, 1, 1, 1])),
    "povray_files(shift)": (lambda a: scene(shift=a), [0.5, 0.5]),
    "povray_files(point)": (lambda a: scene(point=a), POINT),
    "povray_files(coefficients)": (lambda a: scene(coefficients=a), COLOR),
    "povray_files(blood_weight)": (lambda a: scene(blood_weight=a), COLOR),
    "povray_files(normals)": (lambda a: scene(normals=a), TRIANGLE),
    "povray_files(surface_color)": (lambda a: scene(surface_color=a), COLOR),
    "povray_files(surface_uv)": (lambda a: scene(surface_image="skin.png", surface_uv=a), UV),
    "povray_files(background)": (lambda a: scene(background=a), COLOR),
    "povray_files(glow_uv)": (lambda a: scene(glow_uv=a), UV),
    "povray_files(world_irradiance)": (lambda a: scene(world_irradiance=a), COLOR),
    "povray_files(thickness_range)": (
        lambda a: scene(thickness_image="mm.png", thickness_range=a, surface_uv=UV),
        [0.0, 1.0],
    ),
    "povray_files(instances)": (lambda a: scene(instances=[a]), np.eye(4)),
    "FaceTiles(vertices)": (lambda a: sg.FaceTiles(a, [3], [0, 1, 2]), TRIANGLE),
    "FaceTiles(wanted)": (lambda a: sg.FaceTiles(TRIANGLE, [3], [0, 1, 2], a), [1.0, 0, 1]),
    "TileTargets(vertices)": (lambda a: sg.TileTargets(a, CORNERS, TEXELS, LAYOUT.height), TRIANGLE),
    "TileTargets(texels)": (lambda a: sg.TileTargets(TRIANGLE, CORNERS, a, LAYOUT.height), TEXELS),
    "TileTargets.at_vertices(values)": (TARGETS.at_vertices, [1.0, 2, 3]),
    "TileTargets.spread(values)": (TARGETS.spread, ONES),
    "luminance(colors)": (sg.luminance, COLOR),
    "diffuse_radiance(exitance)": (sg.diffuse_radiance, COLOR),
    "visible_entries(table)": (sg.visible_entries, TRIANGLE),
    "irradiance_difference(box_min)": (lambda a: sg.irradiance_difference(LIGHTING, LIGHTING, a, POINT), POINT),
    "irradiance_difference(box_max)": (lambda a: sg.irradiance_difference(LIGHTING, LIGHTING, POINT, a), POINT),
    "is_mirrored(before)": (lambda a: sg.is_mirrored(a, TRIANGLE), TRIANGLE),
    "is_mirrored(after)": (lambda a: sg.is_mirrored(TRIANGLE, a), TRIANGLE),
    "uniform_scale(before)": (lambda a: sg.uniform_scale(a, TRIANGLE), TRIANGLE),
    "uniform_scale(after)": (lambda a: sg.uniform_scale(TRIANGLE, a), TRIANGLE),
    "Occluders(meshes)": (lambda a: sg.Occluders([(a, CORNERS)]), TRIANGLE),
    "Occluders(origin)": (lambda a: sg.Occluders([], a), POINT),
    "Occluders.visible_fraction(points)": (lambda a: NOTHING.visible_fraction([], a, TRIANGLE), TRIANGLE),
    "Occluders.visible_fraction(normals)": (lambda a: NOTHING.visible_fraction([], TRIANGLE, a), TRIANGLE),
    "thickness(vertices)": (lambda a: sg.thickness(a, CORNERS), TRIANGLE),
    "thickness_report(vertices)": (lambda a: sg.thickness_report(a, CORNERS), TRIANGLE),
    "thickness_summary(thickness_mm)": (lambda a: sg.thickness_summary(a, 12.0), POINT),
    "thickness_colors(thickness_mm)": (lambda a: sg.thickness_colors(a, 12.0), POINT),
    "bake_thickness(uv)": (lambda a: sg.bake_thickness(a, np.ones((len(a), 3)), 4, 4), UV),
    "bake_thickness(thickness_mm)": (lambda a: sg.bake_thickness(UV * len(a), a, 4, 4), [POINT]),
    "sample_image(image)": (lambda a: sg.sample_image(a, [[0.5, 0.5]]), TRIANGLE),
    "sample_image(uv)": (lambda a: sg.sample_image(TRIANGLE, a), [[0.5, 0.5]]),
    "gray_png(values)": (sg.gray_png, TRIANGLE),
    "near_thin_skin(vertices)": (lambda a: sg.near_thin_skin(a, CORNERS, POINT), TRIANGLE),
    "near_thin_skin(thickness_mm)": (lambda a: sg.near_thin_skin(TRIANGLE, CORNERS, a), POINT),
    "Shape(vertices)": (lambda a: body(vertices=a), TRIANGLE),
    "Shape(absorption)": (lambda a: body(absorption=a), POINT),
    "Shape(reduced_scattering)": (lambda a: body(reduced_scattering=a), POINT),
    "Shape(points)": (lambda a: body(points=a), TRIANGLE),
    "Shape(normals)": (lambda a: body(points=TRIANGLE, normals=a), TRIANGLE),
    "Shape.exitance(irradiance)": (lambda a: shape().exitance(a), POINT),
    "Shape.exitance_error(irradiance)": (lambda a: shape().exitance_error(a), POINT),
    "Shape.light(occluder_frame)": (lambda a: shape().light([], occluder_frame=a), np.eye(4)),
    "LitShape.recolor(colors)": (lambda a: shape().light([LIGHT]).recolor(a), [COLOR]),
}
#: Of whole numbers.
WHOLE: dict[str, Call] = {
    "thickness(triangles)": (lambda a: sg.thickness(TRIANGLE, a), CORNERS),
    "thickness_report(triangles)": (lambda a: sg.thickness_report(TRIANGLE, a), CORNERS),
    "Occluders(triangles)": (lambda a: sg.Occluders([(TRIANGLE, a)]), CORNERS),
    "near_thin_skin(triangles)": (lambda a: sg.near_thin_skin(TRIANGLE, a, POINT), CORNERS),
    "Shape(triangles)": (lambda a: body(triangles=a), CORNERS),
    "povray_files(triangles)": (lambda a: scene(triangles=a), CORNERS),
    "FaceTiles(face_sizes)": (lambda a: sg.FaceTiles(TRIANGLE, a, [0, 1, 2]), [3]),
    "FaceTiles(corners)": (lambda a: sg.FaceTiles(TRIANGLE, [3], a), [0, 1, 2]),
    "TileTargets(triangles)": (lambda a: sg.TileTargets(TRIANGLE, a, TEXELS, LAYOUT.height), CORNERS),
}


def public_functions() -> Iterator[tuple[str, ast.FunctionDef]]:
    """All functions that skinglow exports, and methods of its classes, with what they are called here."""
    for path in sorted(PACKAGE.glob("*.py*")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body if path.name != "_rays.pyi" else ():
            if getattr(node, "name", "_") not in sg.__all__:
                continue
            if isinstance(node, ast.FunctionDef):
                yield node.name, node
            for method in node.body if isinstance(node, ast.ClassDef) else ():
                if isinstance(method, ast.FunctionDef) and method.name == "__init__":
                    yield node.name, method
                elif isinstance(method, ast.FunctionDef) and not method.name.startswith("_"):
                    yield f"{node.name}.{method.name}", method


def array_parameters() -> set[str]:
    """All that take an array, as function(argument)."""
    found = set()
    for name, function in public_functions():
        for argument in (*function.args.args, *function.args.kwonlyargs):
            kind = ast.unparse(argument.annotation) if argument.annotation else ""
            if "ArrayLike" in kind or "NDArray" in kind:
                found.add(f"{name}({argument.arg})")
    return found
