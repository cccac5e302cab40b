"""Irradiance in W/m^2 and tables of mode physical as POV-Ray computes them, with every digit, against the core."""

import numpy as np
import pytest
import skinglow as sg
from povray_runs import MACROS, PovrayError, exact, numbers, run, sdl_vector, vectors, write

COUNT = 1000


def sdl_light(light) -> str:
    """Skinglow_Light of a skinglow light. Kinds in lower case: any is allowed."""
    if light.kind == "AREA":
        name = "Ellipse" if light.area_shape == "ELLIPSE" else "Rectangle"
        numbers_of = (light.size_x, light.size_y, sdl_vector(light.tangent), light.spread)
    elif light.kind == "SPOT":
        name = "Spot"
        cone = light.spot_angle, light.spot_blend, int(light.spot_cosine)
        numbers_of = (light.radius, int(light.soft_falloff), *cone)
    elif light.kind == "POINT":
        name, numbers_of = "Point", (light.radius, int(light.soft_falloff))
    else:
        name, numbers_of = "Sun", (light.sun_angle,)
    shape = f"Skinglow_{name}_Shape({', '.join(str(n) for n in numbers_of)})"
    vectors_of = ", ".join(sdl_vector(v) for v in (light.color, light.position, light.direction))
    return f'Skinglow_Light("{light.kind.lower()}", {vectors_of}, {light.power!r}, {shape})'


def listed(folder, lights, point=(0.0, 0.0, 0.0)) -> np.ndarray:
    """Irradiance of each light at a point that faces it, (n, 3)."""
    declared = "#declare Skinglow_Light_Sources = 0;\n" + "\n".join(map(sdl_light, lights))
    declared += f"\n#declare P = {sdl_vector(point)};"
    return vectors(folder, [f"Skinglow_Irradiance_Of({k}, P)" for k in range(len(lights))], declared)


def random_lights(kinds: list[str], count: int, seed: int, **fixed) -> list:
    """Lights about the origin, of sizes from far smaller than their distance to larger, in and out of their cones."""
    random = np.random.default_rng(seed)
    lights = []
    for _ in range(count):
        position = random.normal(size=3) * 10 ** random.uniform(-2, 2)
        near = random.normal(size=3) * np.linalg.norm(position) * random.uniform(0, 1)
        settings = dict(
            position=position, direction=near - position, color=random.random(3), power=random.normal() * 50,
            radius=random.choice([0, 1]) * 10 ** random.uniform(-3, 1), soft_falloff=random.random() < 0.7,
            sun_angle=random.uniform(0, 3), spot_angle=random.uniform(0.05, np.pi), tangent=random.normal(size=3),
            spot_blend=random.choice([0, 1, random.random()]), spot_cosine=random.random() < 0.2,
            size_x=10 ** random.uniform(-2, 1), size_y=10 ** random.uniform(-2, 1),
            area_shape=str(random.choice(["RECTANGLE", "ELLIPSE"])),
            spread=random.choice([np.pi, random.uniform(0.05, 3.1)]),
        )  # fmt: skip
        lights.append(sg.Light(str(random.choice(kinds)), **(settings | fixed)))
    return lights


def worst(found: np.ndarray, lights: list, point=(0.0, 0.0, 0.0)) -> float:
    """Largest difference to the core, relative to the light."""
    expected = sg.object_irradiance_by_light(lights, point, tolerance=1e-10)
    size = np.abs(expected).max(axis=1)
    lit = size > 0
    assert lit.mean() > 0.5
    np.testing.assert_array_equal(found[~lit], 0)
    return float((np.abs(found - expected).max(axis=1)[lit] / size[lit]).max())


@pytest.mark.parametrize(
    ("kinds", "fixed", "allowed"),
    [
        (["POINT", "SUN"], {}, 1e-9),
        (["SPOT"], {"radius": 0.0}, 1e-9),
        (["AREA"], {"area_shape": "RECTANGLE", "spread": np.pi}, 1e-9),
    ],
    ids=["point and sun", "spot", "rectangle"],
)
def test_closed_forms(tmp_path, kinds, fixed, allowed):
    lights = random_lights(kinds, COUNT, 5, **fixed)
    difference = worst(listed(tmp_path, lights), lights)
    print(f"{kinds}: {difference:.1e}")
    assert difference <= allowed


@pytest.mark.parametrize(
    ("kind", "fixed"),
    [("SPOT", {}), ("AREA", {"spread": np.pi, "area_shape": "ELLIPSE"}), ("AREA", {})],
    ids=["spot with a radius", "ellipse", "area with a spread"],
)
def test_integrals(tmp_path, kind, fixed):
    lights = random_lights([kind], 300, 6, **fixed)
    difference = worst(listed(tmp_path, lights), lights)
    print(f"{kind}: {difference:.1e}")
    assert difference <= 1e-7


def test_sum_of_the_list_and_the_point_that_faces(tmp_path):
    lights = random_lights(["POINT", "SUN", "SPOT", "AREA"], 40, 7)
    point = (0.2, -0.1, 0.3)
    declared = "\n".join(map(sdl_light, lights)) + "\nSkinglow_Forget_Lights()\n" + "\n".join(map(sdl_light, lights))
    found = vectors(tmp_path, [f"Skinglow_Listed_Irradiance({sdl_vector(point)})"], declared)[0]
    np.testing.assert_allclose(found, sg.object_irradiance(lights, point, tolerance=1e-10), rtol=1e-7)


def test_at_the_lights_and_without_light(tmp_path):
    """A receiver in the middle of a light, behind it, out of its cone; no width, no angle, no power."""
    here = dict(position=(0, 0, 0), direction=(0, 0, -1), power=3)
    lights = [
        sg.Light("POINT", **here), sg.Light("POINT", radius=0.5, **here),
        sg.Light("POINT", radius=0.5, soft_falloff=False, **here), sg.Light("SPOT", radius=0.2, **here),
        sg.Light("AREA", size_x=2, size_y=1, **here), sg.Light("AREA", size_x=2, size_y=1, spread=0.4, **here),
        sg.Light("AREA", size_x=2, size_y=1, area_shape="ELLIPSE", **here),
        sg.Light("AREA", position=(0, 0, -1), direction=(0, 0, -1), size_x=1, size_y=1),
        sg.Light("SPOT", position=(0, 0, -1), direction=(0, 0, -1)), sg.Light("SPOT", spot_angle=0, **here),
        sg.Light("AREA", size_x=0, **here), sg.Light("AREA", spread=0, **here),
        sg.Light("SUN", power=0), sg.Light("POINT", position=(1, 1, 1), power=0),
    ]  # fmt: skip
    expected = sg.object_irradiance_by_light(lights, (0, 0, 0), tolerance=1e-10)
    found = listed(tmp_path, lights)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    assert np.count_nonzero(expected.sum(axis=1)) == 7


@pytest.mark.parametrize("size", [1, 64])
def test_physical_table_of_an_exported_scene(tmp_path, size):
    """The scene's own text, changed lights and all, gives the core's table: 1e-6, by the tolerance of area lights."""
    base = sg.base_lut(sg.Tissue(), size, 6.0, tolerance=1e-2)
    lights = random_lights(["POINT", "SUN", "SPOT", "AREA"], 8, 8)
    world, point = np.array((0.3, 0.2, 0.5)), (0.1, 0.0, -0.2)
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0)], float)
    files = sg.povray_files(
        corners, np.array([(0, 1, 2)]), np.zeros(3), camera_matrix=np.eye(4), resolution=(4, 4), ortho_width=1,
        mode="physical", base=base, lights=lights, point=point, world_irradiance=world,
    )  # fmt: skip
    irradiance = world + sg.object_irradiance(lights, point, tolerance=1e-10)

    def table() -> np.ndarray:
        run(tmp_path, "lut.pov", "-F")
        return np.array([exact(w) for w in (tmp_path / "lut.txt").read_text().split()]).reshape(-1, 3)

    write(tmp_path, files | {"lut.pov": (MACROS / "verify" / "lut.pov").read_text()})
    expected = sg.recolor(base, sg.diffuse_radiance(irradiance))
    np.testing.assert_allclose(table(), expected, rtol=1e-6, atol=1e-6 * expected.max())
    # One light more in the scene's text, and the skin follows without the core.
    changed = files["lights.inc"] + sdl_light(sg.Light("POINT", (0, 0, 1), (0, 0, 2), power=500)) + "\n"
    write(tmp_path, {"lights.inc": changed})
    irradiance += sg.object_irradiance([sg.Light("POINT", (0, 0, 1), (0, 0, 2), power=500)], point)
    expected = sg.recolor(base, sg.diffuse_radiance(irradiance))
    np.testing.assert_allclose(table(), expected, rtol=1e-6, atol=1e-6 * expected.max())


@pytest.mark.parametrize("spread", [3.0, 1.0, 0.1, 1e-3, 1e-5])
def test_tightness_of_a_spread_meets_blenders_law_half_way(tmp_path, spread):
    half = spread / 2
    tightness = numbers(tmp_path, [f"Skinglow_Spread_Tightness({half!r})"])[0]
    versine, versine_half = 2 * np.sin(half / 2) ** 2, 2 * np.sin(half / 4) ** 2  # 1 - cos, without the cancellation
    s = (versine - versine_half) / versine
    law = s * s * (3 - 2 * s) * np.exp((tightness - 1) * np.log1p(-versine_half))
    assert law == pytest.approx(1 - np.tan(half / 2) / np.tan(half), abs=1e-9)


REFUSED = {
    'Skinglow_Light("LASER", x, x, x, 1, Skinglow_Sun_Shape(0))': 'kind of light 0 is "LASER"; allowed: POINT',
    'Skinglow_Light("spot", x, x, 0*x, 1, Skinglow_Spot_Shape(0, 1, 1, 0, 0))': "length of the direction is 0",
    'Skinglow_Light("point", -x, x, x, 1, Skinglow_Point_Shape(0, 1))': "red of color of light 0 is -1",
    'Skinglow_Light("point", x, x, x, 1e300, Skinglow_Point_Shape(0, 1))': "intensity is .*; allowed: below 3.4e38",
    "#declare S = Skinglow_Point_Shape(-1, 1)": "Skinglow_Point_Shape: radius or width is -1",
    "#declare S = Skinglow_Spot_Shape(0, 1, 4, 0, 0)": "angle is 4.0*e0; allowed: 0 to pi radians",
    "#declare S = Skinglow_Spot_Shape(0, 1, 1, 2, 0)": "blend is 2.0*e0; allowed: 0 to 1",
    "#declare S = Skinglow_Rectangle_Shape(1, 1e400, x, 1)": "height is inf",
    "#declare A = array[2] {x, y}\n#declare B = array[1] {x}\n"
    "#declare T = Skinglow_Recolor_Columns(A, A, B, x)": "length of the shortest column is 1",
    "#declare A = array[1] {x}\n#declare T = Skinglow_Recolor_Columns(A, A, A, <0,1e400,0>)": "weight is inf",
}  # fmt: skip


@pytest.mark.parametrize("sdl", REFUSED)
def test_refusals_say_what_is_wrong(tmp_path, sdl):
    with pytest.raises(PovrayError, match=REFUSED[sdl]):
        numbers(tmp_path, ["1"], sdl)
