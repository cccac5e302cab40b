"""Skin lit diffusely by the diffusion approximation (P1) with partly reflecting surfaces, layer by layer.

In each layer the fluence obeys D f'' = mua f; fluence and flux are continuous, and at each surface the partial currents
f/4 +- F/2 are joined by the diffuse Fresnel reflectance (e.g. A. Ishimaru, "Wave Propagation and Scattering in Random
Media", 1978, ch. 9).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import skinglow as sg


class Field(NamedTuple):
    """Fluence and flux (towards the far side) at a plane, times exp(-log_scale)."""

    fluence: np.ndarray
    flux: np.ndarray
    log_scale: np.ndarray


class Medium(NamedTuple):
    """A layer at every wavelength."""

    rate: np.ndarray  # 1/mm
    impedance: np.ndarray  # 1 / (D k)

    def through(self, far: Field, thickness_mm: np.ndarray) -> Field:
        """The field on the near side of a layer whose far side has `far`."""
        passed = np.exp(-2.0 * self.rate * thickness_mm)
        return Field(
            0.5 * ((1.0 + passed) * far.fluence + (1.0 - passed) * self.impedance * far.flux),
            0.5 * ((1.0 + passed) * far.flux + (1.0 - passed) * far.fluence / self.impedance),
            far.log_scale + self.rate * thickness_mm,
        )


def diffuse_fresnel_reflectance(refractive_index: float) -> float:
    """Reflectance of a smooth surface for diffuse light from outside: Fresnel's formulae over the hemisphere."""
    points = 64  # midpoint rule in the cosine: off by 1e-4, far less than the approximation
    outside = (np.arange(points) + 0.5) / points
    inside = np.sqrt(1.0 - (1.0 - outside**2) / refractive_index**2)
    s = (outside - refractive_index * inside) / (outside + refractive_index * inside)
    p = (refractive_index * outside - inside) / (refractive_index * outside + inside)
    return float(np.mean(outside * (s * s + p * p)))


def _medium(layers: list[sg.Layer]) -> Medium:
    absorption = np.array([layer.absorption for layer in layers])
    reduced = np.array([layer.scattering * (1.0 - layer.anisotropy) for layer in layers])
    rate = np.sqrt(3.0 * absorption * (absorption + reduced))
    return Medium(rate, rate / absorption)  # skin always absorbs a little


def transmittance(tissue: sg.Tissue, thickness_mm: np.ndarray, wavelength_nm: np.ndarray) -> np.ndarray:
    """Transmittance of skin in air under diffuse light, (n_thickness, n_wavelength)."""
    stacks = [sg.skin_layers(tissue, 1.0, nm) for nm in np.asarray(wavelength_nm)]
    epidermis, inner = _medium([stack[0] for stack in stacks]), _medium([stack[1] for stack in stacks])
    total = np.asarray(thickness_mm, dtype=float)[:, None]
    outer_mm = np.minimum(tissue.epidermal_thickness_mm, 0.5 * total)
    entering = 1.0 - diffuse_fresnel_reflectance(tissue.refractive_index)
    # Reciprocity: light that enters a surface diffusely and light that leaves it do so in the ratio n^2.
    leaving = entering / tissue.refractive_index**2
    reflected = 1.0 - leaving
    field = Field(2.0 * (1.0 + reflected) / leaving, 1.0, 0.0)  # flux 1 leaves
    for medium, mm in ((epidermis, outer_mm), (inner, np.maximum(0.0, total - 2.0 * outer_mm)), (epidermis, outer_mm)):
        field = medium.through(field, mm)
    incident = (0.25 * leaving * field.fluence + 0.5 * (1.0 + reflected) * field.flux) / entering
    return np.exp(-field.log_scale) / incident
