"""What counts as numbers: real ones of any type and layout. Text, complex numbers, dates and objects do not."""

from __future__ import annotations

import numpy as np
import pytest
import skinglow as sg
from array_calls import LAYOUT, REAL, TRIANGLE, WHOLE, array_parameters, body, scene

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
        (lambda: sg.FaceTiles(TRIANGLE, [3], [0, 1, 2], []), "wanted is 0 entries; allowed: 3"),
    ],
)
def test_an_empty_array_is_not_the_same_as_none(call, message) -> None:
    with pytest.raises(ValueError, match=message):
        call()
