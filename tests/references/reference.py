"""What public functions are held against: a table of function, domain, reference and largest error."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Reference(NamedTuple):
    """A comparison of functions with what they should give."""

    functions: tuple[str, ...]  #: names in skinglow; of a method Class.method
    domain: str  #: arguments that are compared
    source: str  #: where the reference comes from
    limit: float  #: largest error that is allowed
    measure: Callable[[], float]  #: the largest error; seeded, so that each build compares the same


REFERENCES: list[Reference] = []


def held_against(source: str, *functions: str, domain: str, limit: float) -> Callable:
    """Decorates a function that returns the largest error over a domain."""

    def add(measure: Callable[[], float]) -> Callable[[], float]:
        REFERENCES.append(Reference(functions, domain, source, limit, measure))
        return measure

    return add


def relative(values: ArrayLike, exact: ArrayLike) -> float:
    """Largest error, each relative to its exact value; where that is 0, to 1."""
    found, wanted = np.broadcast_arrays(np.asarray(values, float), np.asarray(exact, float))
    scale = np.where(wanted == 0.0, 1.0, np.abs(wanted))
    return float((np.abs(found - wanted) / scale).max())


def of_largest(values: ArrayLike, exact: ArrayLike) -> float:
    """Largest error, relative to the largest exact value."""
    found, wanted = np.broadcast_arrays(np.asarray(values, float), np.asarray(exact, float))
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())


def generator(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)
