"""The common task of all methods: transmittance of skin by thickness and wavelength."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import skinglow as sg

Result = TypeVar("Result")

WAVELENGTHS_NM = np.linspace(400.0, 700.0, 30)
THICKNESS_MM = np.linspace(0.0, 12.0, 256)
REFERENCE_STREAMS = 64
# Smaller transmittances are not compared: they are invisible.
MIN_TRANSMITTANCE = 1e-6

THREE_LAYERS = sg.TISSUE_PRESETS["light"]
ONE_LAYER = THREE_LAYERS.replace(epidermal_thickness_mm=0.0)
SKINS = {"one layer (dermis)": ONE_LAYER, "three layers (light skin)": THREE_LAYERS}


def solved(tissue: sg.Tissue, streams: int = REFERENCE_STREAMS, threads: int = 0) -> np.ndarray:
    """Transmittance of the task, (256, 30), by the solver."""
    return sg.transmittance(tissue, THICKNESS_MM, WAVELENGTHS_NM, streams=streams, threads=threads)


def largest_relative_error(found: np.ndarray, exact: np.ndarray) -> float:
    """Over all entries with a transmittance above MIN_TRANSMITTANCE."""
    seen = exact > MIN_TRANSMITTANCE
    return float(np.max(np.abs(found[seen] / exact[seen] - 1.0)))


def timed(function: Callable[[], Result], budget_s: float = 1.0) -> tuple[Result, float]:
    """The result of a function, and its min time in ms over as many runs as fit the budget (3 to 50)."""
    shortest = np.inf
    start = time.perf_counter()
    for run in range(50):
        begin = time.perf_counter()
        result = function()
        shortest = min(shortest, time.perf_counter() - begin)
        if run >= 2 and time.perf_counter() - start > budget_s:
            break
    return result, 1e3 * shortest
