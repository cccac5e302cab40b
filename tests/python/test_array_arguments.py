"""What counts as numbers: real ones of any type and layout. Text, complex numbers, dates and objects do not."""

from __future__ import annotations

import numpy as np
import pytest
import skinglow as sg
from array_calls import LAYOUT, REAL, TRIANGLE, WHOLE, array_parameters, body, scene, shape

#: The memory that is written, or none: it has to be of its type.
WRITTEN = {"TileTargets.spread(out)"}


def argument_of(name: str) -> str:
    return name[name.index("(") + 1 : -1]


def test_every_array_of_a_public_function_is_called_here() -> None:
    called = REAL.keys() | WHOLE.keys() | WRITTEN
    assert called - {"Occluders(triangles)"} == array_parameters()  # which is a part of `meshes`


@pytest.mark.parametrize("name", REAL)
def test_only_real_numbers_are_numbers(name: str) -> None:
    call, good = REAL[name]
    call(good)
    numbers = np.asarray(good)
    for bad in (
        numbers.astype(str),
        numbers.astype(str).tolist(),
        numbers.astype(bytes),
        numbers + 0j,
        (numbers + 1j).tolist(),
        numbers.astype(object),
        numbers.astype("timedelta64[s]"),
        numbers.astype("datetime64[s]"),
    ):
        with pytest.raises(ValueError, match=f"{argument_of(name)}.*allowed: .*numbers"):
            call(bad)


@pytest.mark.parametrize("name", REAL)
def test_any_real_type_and_layout_is_taken(name: str) -> None:
    call, good = REAL[name]
    numbers = np.asarray(good, float)
    for kind in (np.float32, np.float16, np.longdouble, ">f8"):
        call(numbers.astype(kind))
    call(np.repeat(numbers, 2, axis=0)[::2])
    call(np.asfortranarray(numbers))
    if (numbers == numbers.astype(int)).all():
        call(numbers.astype(np.int16))
        call(numbers.astype(int).tolist())


@pytest.mark.parametrize("name", WHOLE)
def test_indices_are_whole_numbers(name: str) -> None:
    call, good = WHOLE[name]
    call(good)
    call(np.asarray(good, np.uint16))
    whole = np.asarray(good)
    for bad in (whole.astype(str), whole.astype(str).tolist(), whole + 0j, whole + 0.0, whole.astype(object)):
        with pytest.raises(ValueError, match=f"{argument_of(name)} is .*type .*whole numbers"):
            call(bad)


@pytest.mark.parametrize("name", ["luminance(colors)", "Environment(radiance)", "Environment.from_image(pixels)"])
def test_rows_of_different_lengths_are_no_numbers(name: str) -> None:
    with pytest.raises(ValueError, match=f"{argument_of(name)} is .*allowed: numbers"):
        REAL[name][0]([[1.0], [1.0, 2.0]])


def test_numbers_beyond_single_precision_are_no_warning() -> None:
    far = np.full((1, 3, 3), 1e39)
    with pytest.raises(ValueError, match="texels"):
        sg.TileTargets(TRIANGLE, [[0, 1, 2]], far, LAYOUT.height)
    if np.finfo(np.longdouble).max > np.finfo(float).max:
        with pytest.raises(ValueError, match="radiance is .*double"):
            sg.Environment(np.full(3, np.longdouble(10) ** 400))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: body(points=TRIANGLE, normals=np.empty((0, 3))), "normals is 0 entries; allowed: 3"),
        (lambda: body(normals=np.empty((0, 3))), "normals is given without points"),
        (lambda: scene(normals=np.empty((0, 3))), "normals is empty; allowed: one per vertex"),
        (lambda: scene(normals=np.empty((0, 3, 3))), "normals is empty; allowed: one per vertex"),
        (
            lambda: scene(lut_u=[], thickness_image="mm.png", surface_uv=np.zeros((1, 3, 2))),
            "lut_u is 0 entries; allowed: 3",
        ),
        (lambda: scene(glow_uv=np.empty((0, 3, 2))), "glow_uv is 0 entries; allowed: 3"),
        (lambda: sg.FaceTiles(TRIANGLE, [3], [0, 1, 2], []), "wanted is 0 entries; allowed: 3, one per vertex"),
    ],
)
def test_an_empty_array_is_not_the_same_as_none(call, message) -> None:
    with pytest.raises(ValueError, match=message):
        call()


#: Single numbers, indices, functions and objects of a type: what is said of one of another type names it.
@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: body(unit_mm=None), "unit_mm is None"),
        (lambda: body(unit_mm="1"), "unit_mm is '1'.*allowed: real numbers"),
        (lambda: body(cell_mm=[1.0]), r"cell_mm is \[1.0\]; allowed: one number"),
        (lambda: body(tolerance="low"), "tolerance is 'low'"),
        (lambda: body(refractive_index=1j), "refractive_index is 1j"),
        (lambda: body(max_thickness_mm=(1, 2)), r"max_thickness_mm is \(1, 2\)"),
        (lambda: body(threads=1.0), "threads is 1.0; allowed: a whole number"),
        (lambda: body(threads=2**40), "threads is 1099511627776; allowed: a whole number"),
        (lambda: body(surface=None), 'surface is None; allowed: "rough" or "smooth"'),
        (lambda: body(progress=1), "progress is 1; allowed: a function, or None"),
        (lambda: shape().exitance([1.0] * 3, progress=1), "progress is 1"),
        (lambda: shape().light([], progress=1), "progress is 1"),
        (lambda: shape().light([], environment=(1.0, 1.0, 1.0)), r"environment is \(1.0, 1.0, 1.0\); .*Environment"),
        (lambda: shape().light([], occluders=[(TRIANGLE, [[0, 1, 2]])]), "occluders is .*allowed: .*Occluders"),
        (lambda: shape().light([], excluded=[-1]), r"excluded\[0\] is -1; allowed: indices, 0 or more"),
        (lambda: shape().light([], excluded=1), "excluded is 1; allowed: a sequence of indices"),
        (lambda: shape().light([], shadowless=[0.5]), r"shadowless\[0\] is 0.5; allowed: a whole number"),
        (lambda: shape().light([], reentries=None), "reentries is None"),
        (lambda: shape().light([], solver_tolerance="low"), "solver_tolerance is 'low'"),
        (lambda: sg.thickness(TRIANGLE, [[0, 1, 2]], rays=1.5), "rays is 1.5; allowed: a whole number"),
        (lambda: sg.thickness(TRIANGLE, [[0, 1, 2]], cone_half_angle="wide"), "cone_half_angle is 'wide'"),
        (lambda: sg.Occluders(5), "meshes is 5; allowed: pairs"),
        (lambda: sg.Occluders([]).visible_fraction([], TRIANGLE, TRIANGLE, excluded=[-1]), r"excluded\[0\] is -1"),
        (lambda: sg.six_gaussian_base(-1), "size is -1; allowed: a whole number, 0 or more"),
        (lambda: sg.six_gaussian_lookup(-1), "size is -1"),
        (lambda: sg.base_lut(sg.Tissue(), -1), "size is -1"),
        (lambda: sg.ThicknessCurve([sg.Layer()], -1), "variable_layer is -1"),
        (lambda: sg.SurfaceLighting([], (0, 0, 0), (1, 1, 1), max_terms=-1), "max_terms is -1"),
        (lambda: sg.FaceTiles(TRIANGLE, [3], [0, 1, 2], max_texels=-1), "max_texels is -1"),
        (lambda: sg.TileTargets(TRIANGLE, [[0, 1, 2]], np.zeros((1, 3, 3)), -1), "height is -1"),
        (lambda: sg.light_report([], (0, 0, 0), kept=[-1]), r"kept\[0\] is -1"),
        (lambda: sg.Tissue(blood_fraction=1j), "blood_fraction is 1j"),
        (lambda: sg.Tissue(blood_fraction=np.array([0.01])), r"blood_fraction is of shape \(1,\); allowed: one number"),
        (lambda: sg.slab([sg.Layer()], 1j), "incidence is 1j"),
        (lambda: scene(angle_x="wide"), "angle_x is 'wide'"),
        (lambda: scene(base=5), "base is 5; allowed: a skinglow.BaseLut"),
        (lambda: scene(base=None, size=4, max_thickness_mm="thick"), "max_thickness_mm is 'thick'"),
        (lambda: scene(base=None, size=4.5, max_thickness_mm=1.0), "size is 4.5; allowed: 1 to 65536"),
        (lambda: sg.thickness_summary([1.0], "thick"), "limit_mm is 'thick'"),
        (lambda: sg.thickness_summary([1.0], 2.0, bins=1.5), "bins is 1.5; allowed: a whole number"),
        (lambda: sg.thickness_colors([1.0], None), "max_mm is None"),
        (
            lambda: sg.bake_thickness(np.zeros((1, 3, 2)), np.zeros((1, 3)), 4.0, 4),
            "width is 4.0; allowed: a whole number",
        ),
        (lambda: sg.gray_png([[0.5]], 8.0), "bits is 8.0; allowed: a whole number"),
        (lambda: sg.stratified_indices(10, 2.5), "samples is 2.5; allowed: a whole number"),
    ],
)
def test_what_is_wrong_is_named(call, message) -> None:
    """The compiled modules' TypeErrors list all arguments, arrays in full, and not which one is wrong."""
    with pytest.raises(ValueError, match=message):
        call()


def test_a_progress_function_without_an_answer_is_told_of() -> None:
    """`progress=print` returns None, which stops."""
    with pytest.raises(RuntimeError, match="cancelled by the progress function, which returns True to go on"):
        body(progress=lambda done: None)
