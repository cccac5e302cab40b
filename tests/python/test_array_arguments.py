"""What counts as numbers: real ones of any type and layout. Text, complex numbers, dates and objects do not."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import skinglow as sg

TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
CORNERS = [[0, 1, 2]]
LIGHT = sg.Light("POINT", (1, 1, 1), (0, 0, 1), power=1)
GRAY = sg.BaseLut([1.0, 0.5], 12.0)


def scene(**change: object) -> object:
    given = dict(camera_matrix=np.eye(4), resolution=(8, 8), angle_x=0.7, base=GRAY) | change
    return sg.povray_files(TRIANGLE, CORNERS, given.pop("lut_u", np.zeros(3)), **given)


# Each takes an array, here in its place as strings or others of the right shape.
CALLS: dict[str, tuple[Callable[[object], object], object]] = {
    "position": (lambda a: sg.Light("POINT", (1, 1, 1), a), [1.0, 2, 3]),
    "color": (lambda a: sg.Light("POINT", a, (1, 1, 1)), [1.0, 0, 1]),
    "distance": (sg.attenuation, [1.0, 2]),
    "point": (lambda a: sg.light_weights([LIGHT], a), [0.0, 0, 0]),
    "values": (lambda a: sg.BaseLut(a, 12.0), [1.0, 0.5]),
    "weight": (lambda a: sg.recolor(GRAY, a), [1.0, 0.5, 0.5]),
    "vertices": (lambda a: sg.thickness(a, CORNERS), TRIANGLE),
    "meshes": (lambda a: sg.Occluders([(a, CORNERS)]), TRIANGLE),
    "origin": (lambda a: sg.Occluders([], a), [0.0, 0, 0]),
    "points": (lambda a: sg.Occluders([]).visible_fraction([], a, TRIANGLE), TRIANGLE),
    "normals": (lambda a: sg.Occluders([]).visible_fraction([], TRIANGLE, a), TRIANGLE),
    "lut_u": (lambda a: scene(lut_u=a), [0.0, 0.5, 1.0]),
    "camera_matrix": (lambda a: scene(camera_matrix=a), np.eye(4)),
    "resolution": (lambda a: scene(resolution=a), [8, 8]),
}


@pytest.mark.parametrize("name", CALLS)
def test_only_real_numbers_are_numbers(name: str) -> None:
    call, good = CALLS[name]
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
    ):
        with pytest.raises(ValueError, match=f"{name}.*allowed: .*numbers"):
            call(bad)


@pytest.mark.parametrize("name", CALLS)
def test_any_real_type_and_layout_is_taken(name: str) -> None:
    call, good = CALLS[name]
    numbers = np.asarray(good, float)
    for kind in (np.float32, np.float16, np.longdouble, ">f8"):
        call(numbers.astype(kind))
    call(np.repeat(numbers, 2, axis=0)[::2])
    call(np.asfortranarray(numbers))
    if (numbers == numbers.astype(int)).all():
        call(numbers.astype(np.int16))
        call(numbers.astype(int).tolist())


@pytest.mark.parametrize("triangles", [[["0", "1", "2"]], [[0j, 1, 2]], [[0.0, 1, 2]], np.array(CORNERS, object)])
def test_triangles_are_whole_numbers(triangles: object) -> None:
    for call in (
        lambda: sg.thickness(TRIANGLE, triangles),
        lambda: sg.Occluders([(TRIANGLE, triangles)]),
        lambda: sg.povray_files(
            TRIANGLE, triangles, np.zeros(3), camera_matrix=np.eye(4), resolution=(8, 8), angle_x=0.7, base=GRAY
        ),
    ):
        with pytest.raises(ValueError, match="triangles is of type .*whole numbers"):
            call()
