"""Scenes that the core emits, rendered by the real POV-Ray: numbers, pixels, what is left out, odd names."""

import re

import numpy as np
import pytest
import skinglow as sg
from povray_runs import MACROS, PovrayError, exact, render, run, write, write_exr

SQUARE = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])
FROM_ABOVE = np.diag([1.0, 1.0, 1.0, 1.0])
FROM_ABOVE[2, 3] = 5
LIGHTS = [
    sg.Light("POINT", (1, 0.4, 0.2), (0.5, 0, 0.7), power=10, name='a "quoted" \\ lämp'),
    sg.Light("SUN", (0.1, 0.2, 1), power=2),
    sg.Light("SPOT", (1, 1, 1), (0, 3, 3), power=0, name="light without power"),
    sg.Light("AREA", (1, 1, 1), (0, 3, 3), visible=False, name="light unseen"),
]
# Strictly falling, so that each texel has a value of its own.
BASE = sg.BaseLut(0.3 * np.exp(-np.linspace(0, 3, 16)), 6)


def square(lut_u=(0, 1, 1, 0), **changes) -> dict[str, str]:
    settings = dict(camera_matrix=FROM_ABOVE, resolution=(64, 4), ortho_width=2, base=BASE, lights=LIGHTS)
    settings |= changes
    if "size" in settings:
        del settings["base"]
    return sg.povray_files(SQUARE, TRIANGLES, np.array(lut_u, float), **settings)


def picture(folder, files, *arguments) -> np.ndarray:
    """The middle row of the picture, (width, 3)."""
    write(folder, files)
    image = render(folder, "-A", *arguments)
    return image[image.shape[0] // 2]


def along(table: np.ndarray, u: np.ndarray) -> np.ndarray:
    """The lookup at image coordinates: linear between the texels' centers, constant beyond."""
    texels = np.clip(u * len(table) - 0.5, 0, len(table) - 1)
    return np.stack([np.interp(texels, np.arange(len(table)), c) for c in table.T], axis=1)


def paper_table(lights=LIGHTS) -> np.ndarray:
    return sg.recolor(BASE, np.array([1.8, 0.5, 0.4]) + sg.light_weight(lights, (0, 0, 0)))


# What the square shows: u from the first texel's center on the left to the last one's on the right.
U = (15 * (np.arange(64) + 0.5) / 64 + 0.5) / 16
STEP_16_BIT = 2e-5  # of the picture's file, half a step and rounding


def test_macros_compute_the_table_of_the_core(tmp_path):
    write(tmp_path, square() | {"verify_lut.pov": (MACROS / "verify" / "lut.pov").read_text()})
    run(tmp_path, "verify_lut.pov", "-F")
    words = (tmp_path / "lut.txt").read_text().split()
    found = np.array([exact(w) for w in words]).reshape(-1, 3)
    np.testing.assert_allclose(found, paper_table(), rtol=1e-12, atol=0)
    # The EXR that a host writes of the same table holds float32.
    np.testing.assert_allclose(found.astype(np.float32), paper_table().astype(np.float32), rtol=1e-7)


def test_glow_by_macros_has_the_tables_colors(tmp_path):
    row = picture(tmp_path, square(strength=0.9))
    np.testing.assert_allclose(row, 0.9 * along(paper_table(), U), atol=STEP_16_BIT)


def test_glow_by_image_is_the_same_to_half_floats(tmp_path):
    write_exr_of = paper_table()[None]
    files = square(image="lut of head.exr")
    write(tmp_path, files)
    write_exr(tmp_path / "lut of head.exr", write_exr_of)
    row = picture(tmp_path, files)
    np.testing.assert_allclose(row, along(paper_table(), U), atol=1e-5, rtol=2.0**-11)
    # Neither base nor lights: the picture is all it takes.
    assert "Skinglow_Base" not in files["lut.inc"] and "lights.inc" not in files


def test_existing_mode_knows_no_lamp(tmp_path):
    settings = dict(mode="existing", size=64, max_thickness_mm=3, strength=0.5)
    files = square(**settings)
    assert files == square(**settings, lights=[])
    row = picture(tmp_path, files)
    u = (63 * (np.arange(64) + 0.5) / 64 + 0.5) / 64
    np.testing.assert_allclose(row, 0.5 * along(sg.six_gaussian_lookup(64, 3), u), atol=STEP_16_BIT)


def test_one_texel_and_no_lights(tmp_path):
    row = picture(tmp_path, square(base=sg.BaseLut([0.5], 1), lights=[], lut_u=(0.5,) * 4))
    np.testing.assert_allclose(row, np.broadcast_to((0.9, 0.25, 0.2), (64, 3)), atol=STEP_16_BIT)


def test_largest_table(tmp_path):
    base = sg.BaseLut(np.linspace(0.4, 0, 65_536), 12)
    row = picture(tmp_path, square(base=base, lights=[]))
    expected = 0.4 * (1 - (np.arange(64) + 0.5) / 64)[:, None] * (1.8, 0.5, 0.4)
    np.testing.assert_allclose(row, expected, atol=STEP_16_BIT)


def test_lookup_coordinates_beyond_the_table_are_clamped(tmp_path):
    row = picture(tmp_path, square(lut_u=(-1, -1, 7, 7)))
    row_inside = picture(tmp_path, square(lut_u=(0, 0, 1, 1)))
    np.testing.assert_array_equal(row, row_inside)


def test_only_what_the_scene_uses_is_emitted():
    bare = square()
    names = {"scene.ini", "scene.pov", "camera.inc", "mesh.inc", "lut.inc", "skinglow.inc"}
    assert set(bare) == names | {"lights.inc"}
    assert "Skinglow_Light_Sources = 0;" in bare["scene.pov"]
    assert set(square(mode="existing", size=4, max_thickness_mm=3)) == names
    lit = square(surface_color=(0.5, 0.3, 0.2))
    assert "Skinglow_Light_Sources = 1;" in lit["scene.pov"]
    assert lit["lights.inc"].count("\nSkinglow_Light(") == 2
    assert "light without power" not in lit["lights.inc"] and "light unseen" not in lit["lights.inc"]
    assert "lights.inc" not in square(surface_color=(0.5, 0.3, 0.2), lights=LIGHTS[2:])
    normals = np.array([(0, 0, 1.0)] * 4)
    assert "normal_vectors" not in square(normals=normals)["mesh.inc"]
    assert "normal_vectors" in square(normals=normals, surface_color=(1, 1, 1))["mesh.inc"]


def test_unused_vertices_are_left_out():
    vertices = np.vstack([SQUARE[:2], [(9, 9, 9)], SQUARE[2:], [(7, 7, 7)]])
    triangles = np.array([(0, 1, 3), (0, 3, 4)])
    u = np.array([0, 1, 0.5, 1, 0, 0.5])
    same = dict(camera_matrix=FROM_ABOVE, resolution=(64, 4), ortho_width=2, base=BASE, lights=LIGHTS)
    assert sg.povray_files(vertices, triangles, u, **same) == square()


def test_numbers_come_back_as_the_same_doubles():
    random = np.random.default_rng(3)
    vertices = random.normal(size=(50, 3)) * 10.0 ** random.integers(-12, 12, (50, 1))
    triangles = np.arange(48).reshape(-1, 3)
    text = sg.povray_files(
        vertices, triangles, np.full(50, 0.5), camera_matrix=FROM_ABOVE, resolution=(8, 8),
        ortho_width=1, base=BASE,
    )["mesh.inc"]  # fmt: skip
    block = re.search(r"vertex_vectors \{ 48,(.*?)\}", text, re.S).group(1)
    found = np.array(re.findall(r"[-\d.e+]+", block), float).reshape(-1, 3)
    np.testing.assert_array_equal(found, vertices[:48])


@pytest.mark.parametrize("name", ["u", "x", "camera", 'He"ad 2', "größe", "*/ #error", "", "ö" * 63])
def test_names_that_povray_would_stumble_over(tmp_path, name):
    light = sg.Light("POINT", name=name + '\\\n"#error', power=1)
    files = square(name=name, lights=[light], surface_color=(0.1, 0.1, 0.1), resolution=(4, 4))
    row = picture(tmp_path, files)
    assert row.min() > 0


def test_different_names_give_different_identifiers():
    def identifier(name: str) -> str:
        return re.search(r"#declare (\S+) = mesh2", square(name=name)["mesh.inc"]).group(1)

    names = ["a b", "a_b", "a  b", "a_20_b", "ö" * 63, "ö" * 62 + "ä", "A b"]
    assert len({identifier(n) for n in names}) == len(names)


def test_surface_and_glow_add_up_in_one_render(tmp_path):
    lit = [sg.Light("SUN", (0.5, 1, 1), power=1)]
    glow = picture(tmp_path, square(lights=lit, strength=0.5))
    surface = picture(tmp_path, square(lights=lit, strength=0, surface_color=(0.5, 0.3, 0.2)))
    both = picture(tmp_path, square(lights=lit, strength=0.5, surface_color=(0.5, 0.3, 0.2)))
    expected = np.array((0.5, 0.3, 0.2)) * (0.5, 1, 1) / np.pi
    np.testing.assert_allclose(surface, np.broadcast_to(expected, (64, 3)), atol=STEP_16_BIT)
    np.testing.assert_allclose(both, glow + surface, atol=2 * STEP_16_BIT)


def test_surface_picture_is_a_second_render(tmp_path):
    texels = np.linspace(0.1, 0.9, 8)[None, :, None] * np.array((1, 0.5, 0.25))
    uv = np.array([[(0, 0.5), (1, 0.5), (1, 0.5)], [(0, 0.5), (1, 0.5), (0, 0.5)]])
    lit = [sg.Light("SUN", (1, 1, 1), power=np.pi)]
    files = square(lights=lit, surface_image="skin.exr", surface_uv=uv)
    write(tmp_path, files)
    write_exr(tmp_path / "skin.exr", texels)
    surface = picture(tmp_path, files, "Declare=Skinglow_Part=1")
    glow = picture(tmp_path, files, "Declare=Skinglow_Part=2")
    glow_alone = picture(tmp_path / "glow", square(lights=lit))
    np.testing.assert_allclose(glow, glow_alone, atol=STEP_16_BIT)
    u = (np.arange(64) + 0.5) / 64
    inside = (u > 1 / 16) & (u < 15 / 16)  # beyond the outer centers a surface's picture repeats itself
    np.testing.assert_allclose(surface[inside], along(texels[0], u)[inside], rtol=2.0**-11, atol=1e-5)
    with pytest.raises(PovrayError, match="Skinglow_Part is not declared; allowed: 1"):
        run(tmp_path, "scene.ini")


def test_preview_and_final_settings(tmp_path):
    write(tmp_path, square(lights=[], resolution=(64, 8)))
    for section, size in (("", (64, 8)), ("[Preview]", (16, 2)), ("[Final]", (64, 8))):
        run(tmp_path, f"scene.ini{section}", "+Oshown.ppm", "+FP16")
        assert f"{size[0]} {size[1]}" in (tmp_path / "shown.ppm").read_bytes()[:400].decode(errors="replace")


def test_instances_are_the_same_mesh_elsewhere(tmp_path):
    """The square shrunk to a half on the left, and once more, mirrored, on the right."""
    half = np.diag([0.5, 0.5, 1.0, 1.0])
    left, right = half.copy(), np.diag([-0.5, 0.5, 1.0, 1.0])
    left[0, 3], right[0, 3] = -0.5, 0.5
    vertices = SQUARE @ half[:3, :3] + left[:3, 3]
    files = sg.povray_files(
        vertices, TRIANGLES, np.array((0, 1, 1, 0.0)), camera_matrix=FROM_ABOVE, resolution=(64, 4), ortho_width=2,
        base=BASE, lights=[], instances=[right @ np.linalg.inv(left)],
    )  # fmt: skip
    row = picture(tmp_path, files)
    u = (15 * (np.arange(32) + 0.5) / 32 + 0.5) / 16
    np.testing.assert_allclose(row[:32], along(paper_table([]), u), atol=STEP_16_BIT)
    np.testing.assert_allclose(row[32:], row[:32][::-1], atol=STEP_16_BIT)


def test_the_same_scene_gives_the_same_text():
    assert square(surface_color=(1, 1, 1)) == square(surface_color=(1, 1, 1))


def test_povrays_own_message_reaches_the_user_when_the_lookup_is_missing(tmp_path):
    with pytest.raises(PovrayError, match="not_there.exr"):
        picture(tmp_path, square(image="not_there.exr"))


def test_example_the_right_ear_follows_the_light_and_the_left_does_not(tmp_path):
    files = {name: (MACROS / name).read_text() for name in ("example.pov",)}
    files["skinglow.inc"] = sg.povray_macros()
    ini = "Input_File_Name=example.pov\nWidth=80\nHeight=60\n"
    write(tmp_path, files | {"scene.ini": ini})
    share_of_blue = []
    for blue in (0, 1):
        image = render(tmp_path, f"Declare=Blue={blue}")
        middles = image[24:34, 20:26], image[24:34, 54:60]  # within each ear, away from its lit rim
        share_of_blue.append([ear[..., 2].sum() / ear.sum() for ear in middles])
    (left_warm, right_warm), (left_blue, right_blue) = share_of_blue
    assert abs(left_blue - left_warm) < 0.01
    assert right_blue > right_warm + 0.05


REFUSED = [
    (dict(lut_u=(0, 1, 1)), "lut_u is 3 entries; allowed: 4, one per vertex"),
    (dict(lut_u=(0, 1, np.nan, 0)), r"lut_u\[2\] is nan"),
    (dict(image="/etc/lut.exr"), "scene's own folder"),
    (dict(image="lut.png"), "ends in .exr"),
    (dict(image="lut\n.exr"), "without control characters"),
    (dict(surface_image="skin.bmp"), "ends in .exr, .hdr, .png"),
    (dict(surface_image="skin.png"), "surface_uv is 0 entries; allowed: 6"),
    (dict(mode="physical", size=4, max_thickness_mm=1), "matrices is 0 entries; allowed: 4"),
    (dict(thickness_image="t.jpg", surface_uv=np.zeros((2, 3, 2))), "thickness image is .*; allowed: .*.tiff"),
    (dict(thickness_image="t.png"), "surface_uv is 0 entries; allowed: 6"),
    (
        dict(thickness_image="t.png", surface_uv=np.zeros((2, 3, 2)), image="lut.exr"),
        "glow is an image, with a thickness image; allowed: macros",
    ),
    (dict(mode="new"), 'mode is "new"; allowed: existing, paper or physical'),
    (dict(strength=-1), "strength is -1"),
    (dict(strength=np.inf), "strength is inf"),
    (dict(ortho_width=None), "camera is 0 of projection, angle_x and ortho_width; allowed: one of them"),
    (dict(angle_x=1.0), "camera is 2 of"),
    (dict(ortho_width=-1), "camera width is -1"),
    (dict(ortho_width=None, angle_x=4), "camera angle_x is 4"),
    (dict(ortho_width=None, projection=np.zeros((4, 4))), "camera projection is of last row"),
    (dict(resolution=(0, 4)), "resolution is 0; allowed: 1 to 65535 pixels"),
    (dict(camera_matrix=np.zeros((4, 4))), "matrix_world column 0"),
    (dict(camera_matrix=np.eye(3)), r"camera_matrix is of shape \(3, 3\); allowed: shape \(4, 4\)"),
    (dict(coefficients=(1, -1, 0)), "k_l"),
    (dict(background=(-1, 0, 0)), "background"),
    (dict(surface_color=(0, np.nan, 0)), "surface color"),
    (dict(normals=np.zeros((3, 3))), "vertex_normals is 3 entries; allowed: 4"),
    (dict(base=None), "axis is not given; allowed: base, or size and max_thickness_mm"),
    (dict(size=0, max_thickness_mm=1), "size is 0"),
    (dict(base=sg.BaseLut([np.diag([1.0, 2, 3])], 1)), "entry 0 is a matrix; allowed: a gray one"),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED)
def test_refusals(changes, message):
    with pytest.raises(ValueError, match=message):
        square(**changes)


@pytest.mark.parametrize("triangles", [[(0, 1, 4)], [(0, 1, -1)], [(0.0, 1.0, 2.0)], [(0, 1)], []])
def test_triangles_that_are_none(triangles):
    same = dict(camera_matrix=FROM_ABOVE, resolution=(4, 4), ortho_width=2, base=BASE)
    with pytest.raises(ValueError, match="triangles|mesh"):
        sg.povray_files(SQUARE, np.array(triangles), np.zeros(4), **same)
