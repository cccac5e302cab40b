"""The medium of all pictures, in the parameters of the slab solver and of Cycles' random walk."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skinglow as sg

STREAMS = 32
# Cycles' random walk has no internal reflection: there is no interface between medium and air.
INDEX = 1.0


@dataclass(frozen=True)
class Medium:
    """Homogeneous and isotropic; a triple for R, G, B, 1/mm."""

    name: str
    reduced_scattering: tuple[float, float, float]
    absorption: tuple[float, float, float]

    @property
    def mean_free_path_mm(self) -> np.ndarray:
        """(3,)"""
        return 1.0 / (np.array(self.reduced_scattering) + np.array(self.absorption))

    @property
    def single_scattering_albedo(self) -> np.ndarray:
        """(3,), scattering over extinction."""
        return np.array(self.reduced_scattering) * self.mean_free_path_mm

    def transmittance(self, thickness_mm: np.ndarray, incidence: str | float = "diffuse") -> np.ndarray:
        """Transmittance of a plane slab per channel, (n, 3); a number for `incidence` is the cosine to the normal."""
        curves = [
            sg.ThicknessCurve([sg.Layer(INDEX, absorption, scattering, 0.0)], 0, incidence, streams=STREAMS)
            for absorption, scattering in zip(self.absorption, self.reduced_scattering, strict=True)
        ]
        return np.stack([curve.transmittance(thickness_mm) for curve in curves], axis=1)

    def base_lut(self, size: int, max_thickness_mm: float) -> sg.BaseLut:
        """M(d): diagonal, since each channel is an independent medium."""
        thickness = np.linspace(0.0, max_thickness_mm, size)
        return sg.BaseLut(self.transmittance(thickness)[:, :, None] * np.eye(3), max_thickness_mm)

    @property
    def walk_color(self) -> np.ndarray:
        """The color, (3,), from which Cycles' random walk computes this medium's single scattering albedo."""
        color = np.linspace(0.0, 1.0, 200001)
        return np.interp(self.single_scattering_albedo, cycles_single_scattering_albedo(color), color)


def cycles_single_scattering_albedo(color: np.ndarray) -> np.ndarray:
    """The single scattering albedo that Cycles 4.5 uses for that color, without anisotropy (g = 0).

    A blend of two curves, by the fourth root of the color; from
    intern/cycles/kernel/integrator/subsurface_random_walk.h, its coefficients at g = 0.
    """
    dark = 1.8260523782 * np.arctan(4.98511194385 * color + 0.127355959438 * color) ** 1.09686102424
    bright = 0.496310210422 * np.arctan(4.23190299701 * color + 0.00310603949088 * color) ** 2.40602999408
    blend = color**0.25
    return np.minimum((1.0 - blend) * dark + blend * bright, 0.999999)


# H. W. Jensen, S. Marschner, M. Levoy, P. Hanrahan, "A practical model for subsurface light transport", SIGGRAPH 2001,
# figure 5, `skin1`; its index of 1.3 is ignored (INDEX).
SKIN1 = Medium("skin1 of Jensen et al. 2001", (0.74, 0.88, 1.01), (0.032, 0.17, 0.48))
