"""The glow over the user's own texture, and thickness from pictures and functions: POV-Ray's pixels."""

import numpy as np
import pytest
import skinglow as sg
from povray_runs import PovrayError, numbers, render, sdl_array, sdl_vector, write, write_exr
from test_povray_scene import (
    BASE,
    FROM_ABOVE,
    LIGHTS,
    SQUARE,
    STEP_16_BIT,
    TRIANGLES,
    along,
    paper_table,
    picture,
    square,
)

PIXELS = 64
TABLE = np.linspace((0.3, 0.1, 0.02), (0.05, 0.2, 0.3), 8)
HEAD = (
    '#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\n#include "skinglow.inc"\n'
    "camera { orthographic location <.5, .5, -9> direction z right x up y }\n"
    'Skinglow_Light("SUN", <1, 1, 1>, <0, 9, -9>, <0, -1, 2>, 2, Skinglow_Sun_Shape(0))\n'
)
PATTERNED = """texture { checker
    texture { pigment { granite color_map { [0 rgb .1] [1 rgb <.6, .4, .3>] } scale .2 } finish { specular .4 } }
    texture { pigment { rgb <.2, .3, .1> } normal { bumps .6 scale .03 } finish { phong .5 reflection .1 } }
    scale .25 }"""
LAYERED = """texture { pigment { rgb <.5, .3, .2> } finish { diffuse .7 } }
    texture { pigment { gradient x color_map { [0 rgbt 1] [1 rgbt <.1, 0, 0, .3>] } } finish { specular .3 } }"""


def surface(texture: str) -> str:
    return f"plane {{ -z, 0 texture {{ {texture} }} }}\n"


def rendered(folder, scene: str) -> np.ndarray:
    """Linear, (PIXELS, PIXELS, 3), row 0 at the bottom: y up."""
    table = sdl_array("Table", [sdl_vector(c) for c in TABLE])
    ini = f"Input_File_Name=scene.pov\nWidth={PIXELS}\nHeight={PIXELS}\n"
    write(folder, {"skinglow.inc": sg.povray_macros(), "scene.ini": ini, "scene.pov": HEAD + table + scene})
    return render(folder, "-A")[::-1]


@pytest.mark.parametrize("texture", [PATTERNED, LAYERED], ids=["patterned", "layered"])
def test_glow_over_any_texture_is_the_sum(tmp_path, texture):
    declared = "#declare Along = function(x, y, z) { 2 * x }\n"
    mapped = "Skinglow_Thickness_Pigment(Table, 2, Along, 0)"
    alone = rendered(tmp_path, f"plane {{ -z, 0 {texture} }}\n")
    glow = rendered(tmp_path, declared + surface(f"Skinglow_Glow({mapped}, 0.5)"))
    both = rendered(tmp_path, declared + surface(f"Skinglow_Over({texture}, {mapped}, 0.5)"))
    assert np.ptp(alone) > 0.1 and np.ptp(glow) > 0.05
    np.testing.assert_allclose(both, alone + glow, atol=3 * STEP_16_BIT)


def test_thickness_by_a_function_of_space(tmp_path):
    scene = "#declare Mm = function(x, y, z) { 3 * y * y }\n"
    found = rendered(tmp_path, scene + surface("Skinglow_Glow(Skinglow_Thickness_Pigment(Table, 2, Mm, 0), 1)"))
    y = (np.arange(PIXELS) + 0.5) / PIXELS
    entries = np.clip(3 * y * y / 2 * 7, 0, 7)
    expected = np.stack([np.interp(entries, np.arange(8), c) for c in TABLE.T], axis=1)
    np.testing.assert_allclose(found, np.broadcast_to(expected[:, None], found.shape), atol=STEP_16_BIT)


@pytest.mark.parametrize("ending", ["png", "exr"])
def test_textured_skin_with_a_thickness_picture_is_one_render(tmp_path, ending):
    """Surface and thickness are pictures in the mesh's own uv, which do not look alike."""
    uv = SQUARE[TRIANGLES][..., :2] / 2 + 0.5
    thickness = np.linspace(0, 1, 8)[None, :] ** 2
    skin = np.linspace(0.1, 0.9, 8)[::-1][None, :, None] * np.array((1, 0.5, 0.25))
    lit = [sg.Light("SUN", (1, 1, 1), power=1), *LIGHTS[:1]]
    files = sg.povray_files(
        SQUARE, TRIANGLES, None, camera_matrix=FROM_ABOVE, resolution=(64, 4), ortho_width=2, base=BASE, strength=0.5,
        lights=lit, thickness_image=f"mm.{ending}", thickness_range=(0.5, 5.0), surface_image="skin.exr", surface_uv=uv,
    )  # fmt: skip
    assert "Skinglow_Part" not in files["scene.pov"]
    write(tmp_path, files)
    write_exr(tmp_path / "skin.exr", skin)
    if ending == "png":
        (tmp_path / "mm.png").write_bytes(sg.gray_png(thickness))
    else:
        write_exr(tmp_path / "mm.exr", np.repeat(thickness[..., None], 3, axis=2))
    both = picture(tmp_path, files)
    u = (np.arange(64) + 0.5) / 64
    inside = (u > 1 / 16) & (u < 15 / 16)  # beyond the outer centers a picture repeats itself
    mm = 0.5 + 4.5 * along(thickness[0][:, None].repeat(3, 1), u)[:, 0]
    table = paper_table(lit)
    glow = np.stack([np.interp(mm / 6 * 15, np.arange(16), c) for c in table.T], axis=1)
    lone = square(lights=lit, surface_color=(1, 1, 1), strength=0)
    white = picture(tmp_path / "white", lone)
    expected = 0.5 * glow + along(skin[0], u) * white
    np.testing.assert_allclose(both[inside], expected[inside], rtol=2.0**-9, atol=1e-4)


def test_pictures_of_other_types_are_refused(tmp_path):
    with pytest.raises(PovrayError, match='file is "mm.jpg"; allowed: a name that ends in .exr, .png, .tif or .tiff'):
        numbers(tmp_path, ["1"], '#declare T = Skinglow_Picture_Thickness("mm.jpg", 0, 1)')
    with pytest.raises(PovrayError, match="thickness at white is inf"):
        numbers(tmp_path, ["1"], '#declare T = Skinglow_Picture_Thickness("mm.png", 0, 1e400)')
