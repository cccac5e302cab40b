"""Errors of RGB transport for colored lights, compared with transporting the full spectrum through the skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skinglow as sg

THICKNESS_MM = (1.0, 3.0, 6.0)

# LEDs as Gaussian lines of usual center and full width at half maximum; low-pressure sodium as its doublet at 589.3 nm.
LIGHTS = {
    "red LED (630 nm, FWHM 20 nm)": sg.line_spectrum(630.0, 20.0),
    "green LED (525 nm, FWHM 35 nm)": sg.line_spectrum(525.0, 35.0),
    "blue LED (455 nm, FWHM 20 nm)": sg.line_spectrum(455.0, 20.0),
    "low-pressure sodium (589.3 nm)": sg.line_spectrum(589.3, 0.6),
    "black body 2700 K": sg.blackbody_spectrum(2700.0),
    "black body 6500 K": sg.blackbody_spectrum(6500.0),
}


@dataclass
class LightColorError:
    """Errors of the two RGB methods: max channel difference relative to the max channel of the full spectral result."""

    light: str
    thickness_mm: float
    diagonal: float
    matrix: float
    clipped_matrix: float


def _error(found: np.ndarray, exact: np.ndarray) -> float:
    return float(np.max(np.abs(found - exact)) / np.max(np.abs(exact)))


def light_color_errors(tissue: sg.Tissue, streams: int = 32) -> list[LightColorError]:
    """Each light at each thickness.

    `diagonal`: the color of white light behind the skin times the light's color, channel by channel, as a fixed lookup
    does. `matrix`: M(d) times the light's color. Both with the light's exact color, which may lie outside the gamut;
    `clipped_matrix`: M(d) with negative channels set to 0, as host applications store light colors.
    """
    through = sg.transmittance(tissue, THICKNESS_MM, sg.SAMPLE_WAVELENGTHS_NM, streams=streams)
    errors = []
    for name, spectrum in LIGHTS.items():
        color = sg.spectral_color(spectrum)
        for thickness, filter_ in zip(THICKNESS_MM, through, strict=True):
            exact = sg.spectral_color(spectrum, filter_)
            matrix = sg.transmission_matrix(filter_)
            errors.append(
                LightColorError(
                    name,
                    thickness,
                    _error((matrix @ np.ones(3)) * color, exact),
                    _error(matrix @ color, exact),
                    _error(matrix @ np.maximum(color, 0.0), exact),
                )
            )
    return errors
