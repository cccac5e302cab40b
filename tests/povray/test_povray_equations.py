"""Eq. 1-3 as POV-Ray computes them, read back with every digit: against hand-worked values and against the core."""

import math
from fractions import Fraction

import numpy as np
import pytest
import skinglow as sg
from povray_runs import (
    MACROS,
    PovrayError,
    exact,
    numbers,
    run,
    sdl_array,
    sdl_lights,
    sdl_vector,
    vectors,
    write,
)

ORIGIN = "<0,0,0>"
DEFAULT = "<1,0,1>"
DISTANCES = ("0.92357", "0.85231", "1.01292")
BYTES = ((255, 112, 69), (15, 64, 255), (255, 255, 255))
DIRECTIONS = ((1, 0, 0), (0, -0.6, 0.8), (0, 0, -1))
BLOOD = ("1.8", "0.5", "0.4")


def light_weight(count: int = 3, point: str = ORIGIN, coefficients: str = DEFAULT) -> str:
    arrays = "Kinds, Colors, Positions, Powers" if count else "0, 0, 0, 0"
    return f"Skinglow_Light_Weight({count}, {arrays}, {point}, {coefficients})"


def table_1() -> list:
    return [
        sg.Light("POINT", np.array(c) / 255, np.array(v) * float(d))
        for c, v, d in zip(BYTES, DIRECTIONS, DISTANCES, strict=True)
    ]


def exact_table_1() -> list[Fraction]:
    """L of Table 1 in exact fractions of the decimal numbers that the paper prints."""
    attenuations = [1 / (1 + Fraction(d) ** 2) for d in DISTANCES]
    return [sum(Fraction(c[i], 255) * a for c, a in zip(BYTES, attenuations, strict=True)) for i in range(3)]


def random_lights(count: int, decades: float, seed: int = 7) -> list:
    random = np.random.default_rng(seed)
    kinds = random.choice(["POINT", "SUN", "SPOT", "AREA"], count)
    colors = random.random((count, 3)) * 10.0 ** random.uniform(-decades / 2, decades / 2, (count, 1))
    positions = random.normal(size=(count, 3)) * 3
    powers = random.choice([0.0, 1e-12, 5.0, -1.0], count)
    return [sg.Light(str(k), c, p, power=w) for k, c, p, w in zip(kinds, colors, positions, powers, strict=True)]


def test_table_1(tmp_path):
    declared = sdl_lights(table_1()) + sdl_array("Base", ["1", "0.25"])
    declared += f"#declare T = Skinglow_Recolor(Base, Skinglow_Blood, {light_weight()})\n"
    weight, first, quarter = vectors(tmp_path, [light_weight(), "T[0]", "T[1]"], declared)
    for i, light in enumerate(exact_table_1()):
        assert weight[i] == pytest.approx(float(light), rel=1e-12, abs=0)
        assert first[i] == pytest.approx(float(Fraction(BLOOD[i]) + light), rel=1e-12, abs=0)
        assert quarter[i] == pytest.approx(float((Fraction(BLOOD[i]) + light) / 4), rel=1e-12, abs=0)


def test_former_name_of_a_macro_goes_on_working(tmp_path):
    declared = sdl_array("Base", ["1", "0.25"])
    declared += "#declare A = Skinglow_Recolor(Base, <1,2,3>, <4,5,6>)\n"
    declared += "#declare B = Skinglow_Recolour(Base, <1,2,3>, <4,5,6>)\n"
    found = vectors(tmp_path, ["A[0]", "B[0]", "A[1]", "B[1]"], declared)
    assert found.tolist() == [[5, 7, 9], [5, 7, 9], [1.25, 1.75, 2.25], [1.25, 1.75, 2.25]]


def test_verification_scene_of_table_1(tmp_path):
    write(tmp_path, {p.name: p.read_text() for p in MACROS.glob("*.inc")})  # as they are in the folder, in parts
    (tmp_path / "verify.pov").write_text((MACROS / "verify" / "equations.pov").read_text())
    run(tmp_path, "verify.pov", "-F")
    lines = dict(line.split() for line in (tmp_path / "equations.txt").read_text().splitlines())
    assert len(lines) == 27
    for i, channel in enumerate("rgb"):
        expected = float(exact_table_1()[i])
        assert exact(lines[f"L.{channel}"]) == pytest.approx(expected, rel=1e-12, abs=0)


def test_verification_scene_can_fail(tmp_path):
    write(tmp_path, {"skinglow.inc": sg.povray_macros()})
    scene = (MACROS / "verify" / "equations.pov").read_text()
    (tmp_path / "verify.pov").write_text(scene.replace("0.92357", "0.92357000001", 1))
    with pytest.raises(PovrayError, match="attenuation1 is .* should be 0.5396"):
        run(tmp_path, "verify.pov", "-F")


@pytest.mark.parametrize("coefficients", [(1, 0, 1), (0, 0, 0), (0.3, 2.5, 1e-3), (0, 0, 1e6)])
def test_attenuation_of_all_sizes(tmp_path, coefficients):
    distances = [0.0, 1e-30, 1e-9, 0.3, 1.0, 7.7, 1e9, 1e30, 1e200]
    k = sdl_vector(coefficients)
    found = numbers(tmp_path, [f"Skinglow_Attenuation({d!r}, {k})" for d in distances])
    expected = sg.attenuation(np.array(distances), coefficients)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=0)
    assert all(0 <= a <= 1 for a in found)


def test_attenuation_without_coefficients_is_1(tmp_path):
    for value in numbers(tmp_path, [f"Skinglow_Attenuation({d}, <0,0,0>)" for d in (0, 1e-30, 1e30)]):
        assert value == 1.0


def test_no_lights_and_lights_that_are_off(tmp_path):
    off = [sg.Light("POINT", (1, 1, 1), power=0), sg.Light("SUN", (0, 0, 0))]
    found = vectors(tmp_path, [light_weight(0), light_weight(2)], sdl_lights(off))
    np.testing.assert_array_equal(found, np.zeros((2, 3)))


@pytest.mark.parametrize("position", [(0, 0, 0), (1e-30, 0, 0), (1e30, 1e30, 0), (3e-200, 4e-200, 0)])
@pytest.mark.parametrize("color", [(0, 0, 1e-30), (1e6, 1, 0)])
def test_extreme_positions_and_colors(tmp_path, position, color):
    lights = [sg.Light("POINT", color, position)]
    for coefficients in ((1, 0, 1), (0, 0, 1e-3), (0, 1e190, 0)):
        expression = light_weight(1, coefficients=sdl_vector(coefficients))
        found = vectors(tmp_path, [expression], sdl_lights(lights))[0]
        expected = sg.light_weight(lights, (0, 0, 0), coefficients)
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=0)


def test_terms_of_mixed_lights_agree_with_the_core(tmp_path):
    lights = random_lights(24, decades=6)
    point, coefficients = (0.3, -2.0, 0.1), (0.5, 0.25, 2.0)
    arguments = f"24, Kinds, Colors, Positions, Powers, {sdl_vector(point)}, {sdl_vector(coefficients)}"
    declared = sdl_lights(lights) + f"#declare W = Skinglow_Light_Weights({arguments})\n"
    found = vectors(tmp_path, [f"W[{i}]" for i in range(24)], declared)
    expected = sg.light_weights(lights, point, coefficients)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=0)
    assert np.count_nonzero(found.sum(axis=1) == 0) not in (0, 24)  # lights on and lights off are among them


def test_ten_thousand_lights_over_twelve_decades_in_any_order(tmp_path):
    lights = random_lights(10_000, decades=12)
    point = (0.1, 0.2, 0.3)
    exact_sum = [math.fsum(c) for c in sg.light_weights(lights, point).T]
    for shuffled in (lights, lights[::-1]):
        found = vectors(tmp_path, [light_weight(10_000, sdl_vector(point))], sdl_lights(shuffled))[0]
        np.testing.assert_allclose(found, exact_sum, rtol=1e-14, atol=0)


@pytest.mark.parametrize("size", [1, 2, 256, 65_536])
def test_recolored_tables(tmp_path, size):
    declared = f"#declare B = Skinglow_Six_Gaussian_Base({size}, 12)\n"
    declared += "#declare T = Skinglow_Recolor(B, Skinglow_Blood, <1.5, 1e6, 0>)\n"
    entries = sorted({0, size // 3, size // 2, size - 1})
    base = np.array(numbers(tmp_path, [f"B[{i}]" for i in entries], declared))
    found = vectors(tmp_path, [f"T[{i}]" for i in entries], declared)
    expected = sg.recolor(sg.BaseLut(base, 12), np.array([1.8, 0.5, 0.4]) + [1.5, 1e6, 0])
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=0)
    reference = sg.six_gaussian_base(size, 12).matrices[entries, 0, 0]
    np.testing.assert_allclose(base, reference, rtol=1e-12, atol=1e-300)


def test_fixed_lookup_agrees_with_the_core(tmp_path):
    declared = "#declare T = Skinglow_Six_Gaussian(64, 6)\n"
    found = vectors(tmp_path, [f"T[{i}]" for i in range(64)], declared)
    np.testing.assert_allclose(found, sg.six_gaussian_lookup(64, 6), rtol=1e-12, atol=1e-300)
    # By hand: at 0 the sums of the published weights.
    np.testing.assert_allclose(found[0], (1.0, 1.0, 1.0), rtol=1e-12)


LAMP = 'array[1] {"POINT"}', "array[1] {<1,1,1>}", "array[1] {<0,0,1>}", "array[1] {1}"


def one_light(**changes: str) -> str:
    names = ("kinds", "colors", "positions", "powers")
    arrays = [changes.get(name, usual) for name, usual in zip(names, LAMP, strict=True)]
    declared = "".join(f"#declare {n} = {a}\n" for n, a in zip("ABCD", arrays, strict=True))
    rest = f"{changes.get('point', ORIGIN)}, {changes.get('coefficients', DEFAULT)}"
    return f"{declared}#declare R = Skinglow_Light_Weight({changes.get('count', '1')}, A, B, C, D, {rest});"


NAN = "(exp(1000) - exp(1000))"
REFUSED = {
    "#declare R = Skinglow_Attenuation(-1e-30, <1,0,1>);": "distance is -1.0*e-30; allowed: a finite",
    "#declare R = Skinglow_Attenuation(exp(1000), <1,0,1>);": "distance is inf; allowed",
    f"#declare R = Skinglow_Attenuation({NAN}, <1,0,1>);": "distance is -?nan; allowed",
    "#declare R = Skinglow_Attenuation(1, <-1,0,1>);": r"coefficient k_c \(constant\) is -1",
    f"#declare R = Skinglow_Attenuation(1, <1,{NAN},1>);": r"coefficient k_l \(linear\) is -?nan",
    "#declare R = Skinglow_Attenuation(1, <1,0,1e400>);": r"coefficient k_q \(quadratic\) is inf",
    one_light(colors="array[1] {<1,-1e-20,1>}"): "green of color of light 0 is -1.0*e-20",
    one_light(colors=f"array[1] {{<1,1,{NAN}>}}"): "blue of color of light 0 is -?nan",
    one_light(positions="array[1] {<1e400,0,0>}"): r"x \(red\) of position of light 0 is inf",
    one_light(
        kinds='array[1] {"LASER"}'
    ): 'kind of light 0 is "LASER"; allowed: POINT, SUN, SPOT or AREA, in any letter case',
    one_light(powers="array[1] {1e400}"): "power of light 0 is inf",
    one_light(point="<0,1e400,0>"): r"y \(green\) of point is inf",
    one_light(coefficients="<1,0,-1>"): "k_q",
    one_light(count="2"): "length of the shortest array of lights is 1.*; allowed: 2 or more",
    one_light(count="0.5"): "number of lights is 5.0*e-1; allowed: a whole number",
    one_light(count="-1"): "number of lights is -1",
    one_light(positions="array[1] {<1.5e308,0,0>}", point="<-1.5e308,0,0>"): "distance of light 0 is inf",
    "#declare B = array[2] {1, -1}\n#declare R = Skinglow_Recolor(B, <1,1,1>, <0,0,0>)": (
        "entry 1 of the base lookup is -1"
    ),
    "#declare B = array[1] {1}\n#declare R = Skinglow_Recolor(B, <1e400,1,1>, <0,0,0>)": (
        r"x \(red\) of blood weight is inf"
    ),
    "#declare R = Skinglow_Six_Gaussian(0, 12)": "table size is 0.*; allowed: a whole number of 1 to",
    "#declare R = Skinglow_Six_Gaussian(65537, 12)": "table size is 6.5537",
    "#declare R = Skinglow_Six_Gaussian(4, 0)": "max thickness is 0; allowed: a finite number of mm above 0",
    f"#declare R = Skinglow_Lut_U({NAN}, 4, 12);": "thickness is -?nan",
    "#declare B = array[1] {<1e400,0,0>}\n#declare R = Skinglow_Table_Pigment(B)": "entry 0 is inf",
    "#declare P = pigment { rgb 1 }\n#declare R = texture { Skinglow_Glow(P, -1) }": "strength is -1",
    "#declare P = pigment { rgb 1 }\n#declare R = texture { Skinglow_Surface(P, 1e400) }": "diffuse is inf",
}


@pytest.mark.parametrize("sdl", REFUSED)
def test_refusals_say_what_is_wrong(tmp_path, sdl):
    with pytest.raises(PovrayError, match=REFUSED[sdl]):
        numbers(tmp_path, ["1"], sdl)


def test_sums_beyond_the_largest_double_are_refused(tmp_path):
    lights = [sg.Light("SUN", (1.5e308, 0, 0))] * 2
    with pytest.raises(PovrayError, match="the sum of light weights is inf"):
        vectors(tmp_path, [light_weight(2)], sdl_lights(lights))


def test_including_twice_and_names_of_the_users_are_harmless(tmp_path):
    declared = "#declare Red = 3; #declare I = 5; #declare Size = 7; #declare Weight = 9;\n"
    declared += '#include "skinglow.inc"\n#declare T = Skinglow_Six_Gaussian(4, 1)\n'
    declared += "#declare P = Skinglow_Table_Pigment(T)\n"
    assert numbers(tmp_path, ["Red", "I", "Size", "Weight"], declared) == [3, 5, 7, 9]
