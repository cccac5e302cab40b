"""What counts as numbers in Python's own functions: the same as in the compiled modules (numpy_conversion.cpp)."""

import operator
import reprlib
from collections.abc import Iterable
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


def real_number(name: str, given: float) -> float:
    """One real number of any type; else ValueError."""
    numbers = real_numbers(name, given)
    if numbers.ndim:
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: one number")
    return float(numbers)


def whole_number(name: str, given: int, largest: int = 2**31 - 1) -> int:
    """A whole number, by default one of the compiled modules' 32 bits; else ValueError. A float is none."""
    try:
        number = operator.index(given)
    except TypeError:
        number = None
    if number is None or abs(number) > largest:
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: a whole number (an integer type)")
    return number


def indices(name: str, given: Iterable[int]) -> list[int]:
    """Whole numbers, 0 or more; else ValueError naming the entry."""
    try:
        found = [whole_number(f"{name}[{i}]", number) for i, number in enumerate(given)]
    except TypeError:  # no iterable
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: a sequence of indices") from None
    for i, number in enumerate(found):
        if number < 0:
            raise ValueError(f"{name}[{i}] is {number}; allowed: indices, 0 or more")
    return found


def require_type(name: str, given: object, kind: type, allowed: str) -> None:
    """ValueError on what is neither of the type nor None."""
    if given is not None and not isinstance(given, kind):
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: {allowed}, or None")


def require_function(name: str, given: object) -> None:
    """ValueError on what can neither be called nor is None."""
    if given is not None and not callable(given):
        raise ValueError(f"{name} is {reprlib.repr(given)}; allowed: a function, or None")


def fixed(array: Array) -> Array:
    """The array, made read-only: what is kept and given out must not be changed by who gets it."""
    array.setflags(write=False)
    return array
