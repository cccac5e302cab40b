"""Meshes: thickness, images of it, occlusion, texels of faces, light through the shape."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import skinglow as sg

from tests.references.bodies import ball, lobe, plate
from tests.references.recorded import recorded
from tests.references.reference import generator, held_against, of_largest, relative

#: A medium of one wavelength in which a plate of 2 mm lets a third through; air of the same index outside.
MEDIUM = {"absorption": (0.05,) * 3, "reduced_scattering": (1.0,) * 3, "refractive_index": 1.0}
SUN = [sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0, sun_angle=0.01)]


@held_against(
    "the ball's diameter",
    "thickness",
    "thickness_report",
    "ThicknessReport",
    domain="a ball of 8,192 triangles",
    limit=0.02,
)
def balls() -> float:
    report = sg.thickness_report(*ball(3.0, 5))
    assert not report.no_far_side.any()
    assert np.array_equal(report.thickness_mm, sg.thickness(*ball(3.0, 5)))
    return relative(report.thickness_mm, 6.0)


@held_against("the distance of its faces", "thickness", domain="a plate of 40 x 40 x 2, away from its rim", limit=1e-6)
def plates() -> float:
    vertices, triangles = plate(40.0, 2.0, 40)
    inner = (np.abs(vertices[:, :2]) < 10.0).all(axis=1)
    return relative(sg.thickness(vertices, triangles)[inner], 2.0)


@held_against(
    "quantiles and counts, in numpy",
    "thickness_summary",
    "ThicknessSummary",
    domain="1,000 random thicknesses",
    limit=0.0,
)
def summaries() -> float:
    values = generator(41).random(1000) * 5
    told = sg.thickness_summary(values, 4.0, 8)
    counts = np.histogram(values, 8, (0.0, 4.0))[0] / 1000
    exact = [values.min(), np.median(values), values.max(), (values > 4.0).mean(), *counts]
    return relative([told.min_mm, told.median_mm, told.max_mm, told.fraction_above, *told.histogram], exact)


@held_against(
    "a linear function",
    "bake_thickness",
    "ThicknessImage",
    "sample_image",
    domain="two triangles, 64 x 32 texels",
    limit=3e-7,
)
def baked() -> float:
    def function(uv: np.ndarray) -> np.ndarray:
        return 1.0 + 2.0 * uv[..., 0] + 0.5 * uv[..., 1]

    corners = np.array([[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]], float)
    image = sg.bake_thickness(corners, function(corners), 64, 32)
    assert image.covered.all()
    x, y = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(32) + 0.5) / 32)
    at = generator(42).uniform(0.1, 0.9, (500, 2))
    texels = of_largest(image.thickness_mm, function(np.stack([x, y], axis=-1)))
    return max(texels, of_largest(sg.sample_image(image.thickness_mm, at), function(at)))


@held_against(
    "its chunks decoded by zlib, half a level off at most", "gray_png", domain="8 and 16 bits, 30 x 20", limit=0.501
)
def pictures() -> float:
    values, worst = generator(43).random((20, 30)), 0.0
    for bits in (8, 16):
        data, pixels, at = sg.gray_png(values, bits), b"", 8
        while at < len(data):
            (length,), name = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
            chunk = data[at + 8 : at + 8 + length]
            assert struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0] == zlib.crc32(name + chunk)
            pixels += chunk if name == b"IDAT" else b""
            at += 12 + length
        rows = np.frombuffer(zlib.decompress(pixels), np.uint8).reshape(20, -1)
        assert not rows[:, 0].any(), "rows without a filter"
        levels = np.ascontiguousarray(rows[:, 1:]).view(">u1" if bits == 8 else ">u2")[::-1]
        worst = max(worst, float(np.abs(levels - values * (2**bits - 1)).max()))
    return worst


@held_against("its seven colors, straight between them", "thickness_colors", domain="-1 to 10 mm of 8", limit=1e-15)
def heat() -> float:
    ends = sg.thickness_colors(np.array([-1.0, 0.0, 8.0, 10.0, 4.0]), 8.0)
    ramp = np.array([(255, 246, 199), (31, 12, 56), (31, 12, 56), (222, 91, 73)]) / 255.0
    return float(np.abs(ends - [(0.35, 0.45, 0.5), *ramp]).max())


@held_against(
    "what a half-plane covers of a round light, in closed form",
    "Occluders",
    "Occluders.visible_fraction",
    "VisibleFraction",
    domain="-1.2 to 1.2 radii, 1,024 samples",
    limit=0.02,
)
def covered() -> float:
    far, radius, worst = 1000.0, 10.0, 0.0
    light = [sg.Light("AREA", position=(0, 0, far), size_x=2 * radius, size_y=2 * radius, area_shape="DISK")]
    for edge in np.linspace(-1.2, 1.2, 13):
        x = edge * radius / 2  # half-way
        wall = np.array([[x, -500, 500], [500, -500, 500], [500, 500, 500], [x, 500, 500]]), [[0, 1, 2], [0, 2, 3]]
        seen = sg.Occluders([wall]).visible_fraction(light, [[0, 0, 0]], [[0, 0, 1]], samples=1024).at_points[0, 0]
        e = np.clip(edge, -1.0, 1.0)
        worst = max(worst, abs(seen - (0.5 + (e * np.sqrt(1 - e * e) + np.arcsin(e)) / np.pi)))
    return worst


@held_against(
    "a linear function, read back as a renderer does",
    "FaceTiles",
    "TileTargets",
    "TileTargets.spread",
    "TileTargets.at_vertices",
    domain="a plate's texels",
    limit=1e-5,
)
def texels() -> float:
    vertices, triangles = plate(20.0, 3.0, 4)
    layout = sg.FaceTiles(vertices, np.full(len(triangles), 3), triangles.ravel())
    targets = sg.TileTargets(vertices, triangles, layout.texels.reshape(len(triangles), 3, -1), layout.height)
    values = targets.points @ [[0.3, -0.2], [0.1, 0.5], [-0.4, 0.25]]
    image, known = targets.spread(values), targets.of_texel >= 0
    return of_largest(image[known], values[targets.of_texel[known]])


@held_against(
    "the transport equation of the slab",
    "Shape",
    "Shape.exitance",
    domain="the middle of a plate of 44 x 44 x 2, scattering isotropic",
    limit=0.06,
)
def shape_as_slab() -> float:
    vertices, triangles = plate(44.0, 2.0, 44)
    lit = np.where(vertices[:, 2] == 2.0, 1.0, 0.0)
    middle = (np.abs(vertices[:, :2]) < 4.0).all(axis=1) & (vertices[:, 2] == 0.0)
    found = sg.Shape(vertices, triangles, **MEDIUM, cell_mm=0.5).exitance(lit)[middle, 0]
    exact = sg.slab([sg.Layer(1.0, 0.05, 1.0, 0.0, 2.0)], "diffuse", streams=32).transmittance
    return relative(found, exact)


@held_against(
    "sums over lights that are solved alone",
    "Shape.light",
    "LitShape",
    "LitShape.recolor",
    domain="a lobe under two lights",
    limit=2e-3,
)
def adds_up() -> float:
    shape = sg.Shape(*lobe(3), sg.Tissue(), cell_mm=1.2)
    lights = [*SUN, sg.Light("POINT", position=(0.0, 5.0, 60.0), power=1000.0, color=(1.0, 0.5, 0.2))]
    alone = [shape.light([light], reentries=0).exitance for light in lights]
    both = shape.light(lights, reentries=0)
    half = both.recolor(0.5 * np.array([light.color for light in lights]))
    return max(of_largest(both.exitance, alone[0] + alone[1]), of_largest(2 * half, both.exitance))


@held_against(
    "recorded",
    "Shape",
    "ShapePart",
    "Shape.light",
    "LitShape",
    "Shape.exitance_error",
    domain="a lobe under a sun",
    limit=1e-3,
)
def lobe_as_recorded() -> float:
    shape = sg.Shape(*lobe(3), sg.Tissue(), cell_mm=1.2)
    lit = shape.light(SUN, reentries=1)
    error = shape.exitance_error(np.arange(float(len(lobe(3)[0]))))
    parts = [[part.cells, len(part.points)] for part in shape.parts]
    found = {"exitance": lit.exitance[::25], "irradiance": lit.irradiance[::25], "error": error[::50], "parts": parts}
    return recorded("lobe", found)


@held_against("recorded", "thickness", "Occluders.visible_fraction", domain="a lobe, 64 rays", limit=1e-6)
def rays_as_recorded() -> float:
    body = lobe(3)
    seen = sg.Occluders([body]).visible_fraction(SUN, body[0][::10] - (0, 0, 3.0), np.tile([0, 0, 1.0], (26, 1)))
    return recorded("rays", {"thickness": sg.thickness(*body, rays=64)[::10], "visible": seen.at_points})


@held_against("18 mm and what is beside it", "near_thin_skin", domain="a plate of 3 mm, a ball of 60 mm", limit=0.0)
def thin_skin() -> float:
    thin, thick = plate(20.0, 3.0, 10), ball(30.0, 4)
    near = sg.near_thin_skin(*thin, sg.thickness(*thin))
    far = sg.near_thin_skin(*thick, sg.thickness(*thick))
    return float((~near).sum() + far.sum())
