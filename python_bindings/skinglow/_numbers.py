"""What counts as numbers in Python's own functions: the same as in the compiled modules (numpy_conversion.cpp)."""

import reprlib
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = TypeVar("Array", bound=NDArray[Any])


def real_numbers(name: str, given: ArrayLike) -> NDArray[np.float64]:
    """Real numbers of any type as doubles, not copied if they are; ValueError on text, complex numbers and dates.

    np.asarray(given, np.float64) would read text, drop imaginary parts and count days.
    """
    try:
        numbers = np.asarray(given)
    except ValueError:  # rows of different lengths
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: numbers") from None
    if numbers.dtype.kind not in "biuf":
        shown = f"{reprlib.repr(given)}, of type {numbers.dtype}".replace("\n", " ")
        raise ValueError(f"{name} is {shown}; allowed: real numbers (a boolean, integer or float type)")
    return numbers.astype(np.float64, copy=False)


def fixed(array: Array) -> Array:
    """The array, made read-only: what is kept and given out must not be changed by who gets it."""
    array.setflags(write=False)
    return array
