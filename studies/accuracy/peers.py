"""The approximations that engines use instead of solving the slab, for the same skin."""

from __future__ import annotations

import numpy as np
import skinglow as sg

# An opaque slab, for the reflectance and the decay rate of deep skin.
DEEP_MM = (30.0, 31.0)


def six_gaussians(thickness_mm: np.ndarray) -> np.ndarray:
    """The six-Gaussian skin profile as engines use it for translucency, linear RGB, (n, 3); the same for any tissue.

    E. d'Eon, D. Luebke, GPU Gems 3 (2007), ch. 14.
    """
    return np.asarray(sg.six_gaussian_lookup(thickness_mm.size, float(thickness_mm[-1])))


def deep_skin(tissue: sg.Tissue, wavelengths_nm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Reflectance of thick skin lit diffusely, and the asymptotic decay rate of its transmittance, 1/mm."""
    reflectance = np.array(
        [sg.slab(sg.skin_layers(tissue, DEEP_MM[0], nm), "diffuse", streams=16).reflectance for nm in wavelengths_nm]
    )
    deep = sg.transmittance(tissue, DEEP_MM, wavelengths_nm, streams=16)
    return reflectance, -np.log(deep[1] / deep[0]) / (DEEP_MM[1] - DEEP_MM[0])


def burley(thickness_mm: np.ndarray, reflectance: np.ndarray, decay_rate: np.ndarray) -> np.ndarray:
    """The plane integral of Burley's normalized diffusion profile, (thickness, wavelength).

    R(r) = A (exp(-r/s) + exp(-r/3s)) / (8 pi s r) summed over the plane at distance d is
    A (exp(-d/s) + 3 exp(-d/3s)) / 4. A is the reflectance of deep skin and
    s = l / (3.5 + 100 (A - 0.33)^4), l the diffuse mean free path 1 / mu_eff
    (P. Christensen, B. Burley, Pixar Technical Memo 15-04, 2015).
    """
    s = 1.0 / (decay_rate * (3.5 + 100.0 * (reflectance - 0.33) ** 4))
    d = thickness_mm[:, None] / s[None, :]
    return reflectance * 0.25 * (np.exp(-d) + 3.0 * np.exp(-d / 3.0))


def to_rgb(transmittance: np.ndarray) -> np.ndarray:
    """Color of white light (D65) behind filters given at the 81 sample wavelengths, (n, 3)."""
    return np.array([sg.transmission_matrix(row) @ np.ones(3) for row in transmittance])
