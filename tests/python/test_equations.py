"""Eq. 1-3 and the tables through the Python package: values by hand, extremes, refusals, properties."""

import json
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given
from hypothesis import strategies as st

TABLE1 = [((255, 112, 69), "0.92357"), ((15, 64, 255), "0.85231"), ((255, 255, 255), "1.01292")]
AWAY = [(1, 0, 0), (0, -0.6, 0.8), (0, 0, -1)]


def table1_by_hand():
    """(3, 3) weights in exact fractions, rounded once."""
    rows = []
    for color, distance in TABLE1:
        attenuation = 1 / (1 + Fraction(distance) ** 2)
        rows.append([float(Fraction(c, 255) * attenuation) for c in color])
    return np.array(rows)


def table1_lights():
    return [
        sg.Light(
            kind="POINT",
            color=np.array(color) / 255,
            position=np.array(away) * float(distance),
            name=f"Light{k}",
        )
        for k, ((color, distance), away) in enumerate(zip(TABLE1, AWAY, strict=True), 1)
    ]


def test_weights_of_table_1_match_the_hand():
    lights = table1_lights()
    by_hand = table1_by_hand()
    np.testing.assert_allclose(sg.light_weights(lights, (0, 0, 0)), by_hand, rtol=1e-14)
    np.testing.assert_allclose(sg.light_weight(lights, (0, 0, 0)), by_hand.sum(axis=0), rtol=1e-14)


def test_recolored_table_is_equation_1():
    weight = np.array(sg.PAPER_BLOOD_WEIGHT) + sg.light_weight(table1_lights(), (0, 0, 0))
    gray = np.array([1.0, 0.25, 1e-9, 0.0])
    table = sg.recolor(sg.BaseLut(gray, 12.0), weight)
    by_hand = gray[:, None] * (np.array([1.8, 0.5, 0.4]) + table1_by_hand().sum(axis=0))
    np.testing.assert_allclose(table, by_hand, rtol=1e-14)


def test_attenuation_takes_any_shape():
    distances = np.array([[0.0, 1.0], [2.0, 1e30]])
    result = sg.attenuation(distances, coefficients=(1, 0, 1))
    assert result.shape == (2, 2)
    np.testing.assert_allclose(result, [[1, 0.5], [0.2, 1e-60]], rtol=1e-15)
    assert sg.attenuation(3.0, (0, 0, 0)) == 1.0
    assert isinstance(sg.attenuation(3.0), float)
    assert sg.attenuation([]).shape == (0,)


def test_gray_and_matrix_tables():
    gray = sg.BaseLut([1.0, 0.5, 0.0], 6)
    assert gray.size == len(gray) == 3
    np.testing.assert_array_equal(gray.thickness_mm, [0, 3, 6])
    np.testing.assert_array_equal(gray.matrices, np.array([1, 0.5, 0])[:, None, None] * np.eye(3))
    values = np.arange(18.0).reshape(2, 3, 3)
    base = sg.BaseLut(values, 6)
    np.testing.assert_array_equal(base.matrices, values)
    np.testing.assert_allclose(sg.recolor(base, (1, 10, 100)), values @ [1, 10, 100])


def test_matrices_are_a_view_that_outlives_its_table():
    matrices = sg.BaseLut(np.ones(100), 6).matrices
    assert not matrices.flags.writeable
    assert matrices[99, 1, 1] == 1.0


def test_texel_mapping_hits_texel_centers():
    base = sg.BaseLut(np.ones(7), 3.0)
    scale, offset = base.texel_mapping
    np.testing.assert_allclose(scale * base.thickness_mm + offset, (np.arange(7) + 0.5) / 7)


@pytest.mark.parametrize("size", [1, 65536])
def test_smallest_and_largest_table(size):
    table = sg.recolor(sg.BaseLut(np.full(size, 0.5), 12.0), (2, 4, 1e6))
    assert table.shape == (size, 3)
    np.testing.assert_array_equal(table[-1], [1, 2, 5e5])


def test_no_lights_give_nothing():
    assert sg.light_weights([], (0, 0, 0)).shape == (0, 3)
    np.testing.assert_array_equal(sg.light_weight([], (0, 0, 0)), [0, 0, 0])


@pytest.mark.parametrize(
    "off",
    [{"visible": False}, {"power": 0.0}, {"color": (0, 0, 0)}],
    ids=["hidden", "power", "black"],
)
def test_lamps_that_are_off_are_left_out(off):
    lamp = sg.Light(**{"color": (1, 1, 1), "power": 5.0, **off})
    assert not lamp.is_on
    np.testing.assert_array_equal(sg.light_weight([lamp], (0, 0, 0)), [0, 0, 0])


@pytest.mark.parametrize(
    ("call", "names"),
    [
        (lambda: sg.attenuation(-1.0), "distance is -1"),
        (lambda: sg.attenuation(np.nan), "distance is nan"),
        (lambda: sg.attenuation(1.0, (1, 0, np.inf)), "k_q"),
        (lambda: sg.attenuation(1.0, (1, 0)), r"coefficients is of shape \(2,\)"),
        (lambda: sg.attenuation("far"), "distance is 'far'"),
        (lambda: sg.Light(color=(1, -1, 1), name="key"), '"key" color'),
        (lambda: sg.Light(color=(1, np.nan, 1)), "color"),
        (lambda: sg.Light(color=(1, 1)), r"shape \(3,\)"),
        (lambda: sg.Light(kind="HEMI"), "POINT, SUN, SPOT or AREA"),
        (lambda: sg.Light(kind="SUN", direction=(0, 0, 0)), "direction"),
        (lambda: sg.Light(position=(0, np.inf, 0)), "position"),
        (lambda: sg.light_weight([], (0, 0)), "point"),
        (lambda: sg.light_weight([], (0, 0, np.nan)), "point"),
        (lambda: sg.BaseLut([], 12), "table size is 0"),
        (lambda: sg.BaseLut(np.ones(65537), 12), "65537"),
        (lambda: sg.BaseLut([1, -1], 12), "entry 1"),
        (lambda: sg.BaseLut([[1, 2]], 12), r"shape \(size,\) or \(size, 3, 3\)"),
        (lambda: sg.BaseLut([1], 0), "max_thickness_mm"),
        (lambda: sg.BaseLut(np.full((2, 3, 3), np.nan), 1), "matrix 0"),
        (lambda: sg.recolor(sg.BaseLut([1], 1), (1, 2)), "weight"),
        (lambda: sg.recolor(sg.BaseLut([10], 1), (1e308, 0, 0)), "weight"),
        (lambda: sg.six_gaussian_lookup(0), "table size is 0"),
    ],
)
def test_bad_input_is_refused_by_name(call, names):
    with pytest.raises(ValueError, match=names):
        call()


finite = st.floats(0, 1e30)


@given(finite, st.tuples(finite, finite, finite))
def test_attenuation_is_a_share(distance, coefficients):
    value = sg.attenuation(distance, coefficients)
    assert 0.0 <= value <= 1.0


@given(st.lists(st.tuples(finite, finite, finite), max_size=20), st.randoms())
def test_sum_does_not_mind_the_order(colors, random):
    lights = [sg.Light(color=c, position=(k, 0, 0)) for k, c in enumerate(colors)]
    total = sg.light_weight(lights, (0, 0, 0))
    random.shuffle(lights)
    np.testing.assert_allclose(sg.light_weight(lights, (0, 0, 0)), total, rtol=5e-16)


def test_import_loads_no_library_that_blender_has_too():
    code = (
        "import json, skinglow; maps = open('/proc/self/maps').read().lower();"
        "print(json.dumps([n for n in ('openimageio', 'embree', 'libtbb') if n in maps]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == []
