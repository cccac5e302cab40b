"""Lookup tables and spectra."""

from __future__ import annotations

import csv
from fractions import Fraction
from pathlib import Path

import numpy as np
import skinglow as sg

from tests.references.reference import generator, held_against, of_largest, relative

DATA = Path(__file__).resolve().parents[2] / "core" / "src" / "color" / "spectral_data"
NM = np.arange(380.0, 781.0, 5.0)
#: d'Eon and Luebke, GPU Gems 3, 2007, ch. 14, figure 14-13: variance, mm^2, and weights of red, green and blue.
SIX_GAUSSIANS = np.array(
    [
        (0.0064, 0.233, 0.455, 0.649),
        (0.0484, 0.100, 0.336, 0.344),
        (0.187, 0.118, 0.198, 0.0),
        (0.567, 0.113, 0.007, 0.007),
        (1.99, 0.358, 0.004, 0.0),
        (7.41, 0.078, 0.0, 0.0),
    ]
)


def six_gaussians(thickness: np.ndarray) -> np.ndarray:
    variance, weights = SIX_GAUSSIANS[:, 0], SIX_GAUSSIANS[:, 1:]
    return np.exp(-(thickness[:, None] ** 2) / variance) @ weights


def planck(kelvin: float) -> np.ndarray:
    """Planck's law on the grid by the exact constants of the SI (2019), over its largest sample."""
    h, c, k = 6.62607015e-34, 299792458.0, 1.380649e-23
    meters = NM * 1e-9
    power = 1.0 / (meters**5 * np.expm1(h * c / (meters * k * kelvin)))
    return power / power.max()


@held_against(
    "Eq. 1 in exact fractions", "recolor", "BaseLut", domain="gray and matrix tables, 40 weights", limit=1e-15
)
def recolored() -> float:
    rng, worst = generator(21), 0.0
    for _ in range(20):
        gray, matrices, weight = rng.random(8), rng.random((4, 3, 3)), rng.random(3) * 10
        exact = [[float(Fraction(g) * Fraction(w)) for w in weight] for g in gray]
        worst = max(worst, relative(sg.recolor(sg.BaseLut(gray, 12.0), weight), exact))
        rows = [
            [float(sum(map(Fraction.__mul__, map(Fraction, row), map(Fraction, weight)))) for row in m]
            for m in matrices
        ]
        worst = max(worst, relative(sg.recolor(sg.BaseLut(matrices, 12.0), weight), rows))
    return worst


@held_against("the six Gaussians, in numpy", "six_gaussian_lookup", domain="0 to 12 mm, 500 entries", limit=1e-15)
def lookup() -> float:
    return of_largest(sg.six_gaussian_lookup(500, 12.0), six_gaussians(np.linspace(0.0, 12.0, 500)))


@held_against(
    "Rec.709 luminance of the six Gaussians", "six_gaussian_base", domain="0 to 12 mm, 500 entries", limit=1e-15
)
def base_of_lookup() -> float:
    gray = six_gaussians(np.linspace(0.0, 12.0, 500)) @ (0.2126, 0.7152, 0.0722)
    return of_largest(sg.six_gaussian_base(500, 12.0).matrices, gray[:, None, None] * np.eye(3))


@held_against("numpy.interp", "table_at", domain="-1 to 14 mm of a table to 12 mm", limit=1e-14)
def looked_up() -> float:
    colors, base = generator(22).random((64, 3)), sg.BaseLut(np.ones(64), 12.0)
    at = np.linspace(-1.0, 14.0, 3001)
    exact = np.stack([np.interp(at, np.linspace(0.0, 12.0, 64), colors[:, k]) for k in range(3)], axis=1)
    return of_largest(sg.table_at(colors, base.texel_mapping, at), exact)


@held_against("Planck's law, constants of the SI", "blackbody_spectrum", domain="1000 to 20000 K", limit=2e-8)
def black_bodies() -> float:
    return max(relative(sg.blackbody_spectrum(kelvin), planck(kelvin)) for kelvin in (1000.0, 2856.0, 6500.0, 20000.0))


@held_against(
    "a Gaussian's integral against each sample's triangle, by 400,000 trapezoids",
    "line_spectrum",
    domain="450 to 700 nm, 2 to 60 wide",
    limit=1e-3,
)
def lines() -> float:
    worst = 0.0
    fine = np.linspace(380.0, 780.0, 400_001)
    for center, width in ((450.0, 15.0), (589.3, 2.0), (600.0, 30.0), (700.0, 60.0)):
        gaussian = np.exp(-4 * np.log(2.0) * ((fine - center) / width) ** 2)
        left = np.minimum(((fine - 380.0) / 5.0).astype(int), 79)
        share = (fine - 380.0) / 5.0 - left
        power = np.bincount(left, gaussian * (1 - share), 81) + np.bincount(left + 1, gaussian * share, 81)
        worst = max(worst, of_largest(sg.line_spectrum(center, width), power / power.sum()))
    return worst


@held_against(
    "its power, by trapezoids, and its mean wavelength",
    "tabulated_spectrum",
    domain="tables of 40 random wavelengths within the grid",
    limit=1e-12,
)
def tabulated() -> float:
    rng, worst = generator(23), 0.0
    for _ in range(20):
        nm, power = np.sort(rng.uniform(385.0, 775.0, 40)), rng.random(40)
        spectrum = sg.tabulated_spectrum(nm, power)
        # Between two entries both are straight lines: the integral of nm times power is exact by Simpson's rule.
        middle, half = 0.5 * (nm[1:] + nm[:-1]), 0.5 * (power[1:] + power[:-1])
        width = np.diff(nm)
        moment = (width / 6 * (nm[1:] * power[1:] + nm[:-1] * power[:-1] + 4 * middle * half)).sum()
        total = (width * half).sum()
        scale = spectrum.sum() / total
        worst = max(worst, relative(spectrum @ NM / spectrum.sum(), moment / total))
        worst = max(worst, min(abs(scale - 1.0), abs(5.0 * scale - 1.0)))
    return worst


@held_against(
    "D65 and the basis of Mallett and Yuksel, from their published tables",
    "rgb_spectrum",
    domain="red, green, blue and 20 mixtures",
    limit=1e-14,
)
def basis() -> float:
    d65, spectra = columns_of("d65")[1], columns_of("srgb_basis")[1:].T
    worst = 0.0
    for rgb in [*np.eye(3), *generator(24).random((20, 3))]:
        worst = max(worst, of_largest(sg.rgb_spectrum(rgb), d65 * (spectra @ rgb)))
    return worst


@held_against(
    "CIE 1931 and the primaries of Rec.709, in numpy", "spectral_color", domain="100 random spectra", limit=1e-13
)
def full_spectra() -> float:
    """Taken to Rec.709 by primaries and D65's white, then by the inverse of what that makes of the basis."""
    d65, spectra, observer = columns_of("d65")[1], columns_of("srgb_basis")[1:].T, columns_of("cie1931_2deg")[1:]
    x, y = np.array([(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)]).T
    primaries = np.array([x / y, np.ones(3), (1 - x - y) / y])
    white = observer @ d65
    to_rgb = np.linalg.inv(primaries * np.linalg.solve(primaries, white / white[1]))
    to_light = np.linalg.solve(to_rgb @ observer @ (d65[:, None] * spectra), to_rgb @ observer)
    worst = 0.0
    for spectrum in generator(25).random((100, 81)):
        exact = to_light @ spectrum * white[1] / (observer[1] @ spectrum)
        worst = max(worst, of_largest(sg.spectral_color(spectrum), exact))
    return worst


@held_against(
    "spectral_color of the filtered spectrum",
    "transmission_matrix",
    domain="50 random filters; gray ones to the identity",
    limit=1e-14,
)
def filters() -> float:
    rng = generator(26)
    worst = max(of_largest(sg.transmission_matrix(np.full(81, t)), t * np.eye(3)) for t in (1.0, 0.3, 1e-6))
    for _ in range(50):
        through, rgb = rng.random(81), rng.random(3)
        light = sg.rgb_spectrum(rgb)
        exact = sg.spectral_color(light, through) * sg.luminance(rgb) / sg.luminance(sg.spectral_color(light))
        worst = max(worst, of_largest(sg.transmission_matrix(through) @ rgb, exact))
    return worst


@held_against(
    "spectral_color of Planck's law, in numpy",
    "black_body_color",
    domain="1500 to 15000 K, where none is below 0",
    limit=2e-3,
)
def colors_of_black_bodies() -> float:
    worst = 0.0
    for kelvin in (2000.0, 2856.0, 4000.0, 6500.0, 15000.0):
        color = np.maximum(sg.spectral_color(planck(kelvin)), 0.0)
        worst = max(worst, of_largest(sg.black_body_color(kelvin), color / sg.luminance(color)))
    return worst


def columns_of(name: str) -> np.ndarray:
    """The numbers of a table of core/src/color/spectral_data, (columns, rows)."""
    with (DATA / f"{name}.csv").open() as file:
        rows = [row for row in csv.reader(line for line in file if line[0].isdigit())]
    return np.array(rows, float).T
