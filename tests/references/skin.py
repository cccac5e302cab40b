"""Slabs of turbid media, and skin made of them."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import skinglow as sg

from tests.references.reference import generator, held_against, of_largest, relative

DATA = Path(__file__).resolve().parents[2] / "core" / "src" / "color" / "spectral_data"
NODE, WEIGHT = np.polynomial.legendre.leggauss(400)
MU, DMU = 0.5 * (NODE + 1), 0.5 * WEIGHT
LIGHT = sg.TISSUE_PRESETS["light"]
#: Wavelengths that stand for red, green and blue where one does.
PRIMARIES_NM = (611.4, 549.1, 464.2)


@held_against(
    "Beer's law and its integral over the hemisphere, by 400 nodes",
    "slab",
    "Layer",
    "SlabResult",
    domain="absorbers in air of the same index, depths 1e-3 to 20",
    limit=1e-7,
)
def absorbers() -> float:
    worst = 0.0
    for depth in 10.0 ** np.linspace(-3.0, np.log10(20.0), 15):
        layer = [sg.Layer(1.0, 2.0, 0.0, 0.0, depth / 2.0)]
        worst = max(worst, relative(sg.slab(layer, 0.4).transmittance, np.exp(-depth / 0.4)))
        diffuse = 2 * (MU * np.exp(-depth / MU)) @ DMU
        worst = max(worst, of_largest(sg.slab(layer, "diffuse", streams=64).transmittance, diffuse))
    return worst


@held_against(
    "van de Hulst 1980, table 35: R 0.09739, T 0.66096",
    "slab",
    domain="albedo 0.9, g 0.75, depth 2, index matched",
    limit=5e-5,
)
def van_de_hulst() -> float:
    result = sg.slab([sg.Layer(1.0, 1.0, 9.0, 0.75, 0.2)], "normal", streams=32)
    return relative([result.reflectance, result.transmittance], [0.09739, 0.66096])


@held_against("Giovanelli 1955: R 0.2600", "slab", domain="half-space, albedo 0.9, isotropic, index 1.5", limit=1e-3)
def giovanelli() -> float:
    return relative(sg.slab([sg.Layer(1.5, 1.0, 9.0, 0.0, 1e4)], "normal", streams=32).reflectance, 0.2600)


@held_against("R + T + A = 1", "slab", domain="200 stacks of 3 random layers, each incidence", limit=1e-11)
def kept_light() -> float:
    rng, worst = generator(31), 0.0
    for _ in range(200):
        stack = [
            sg.Layer(
                rng.uniform(1, 1.6), *(10.0 ** rng.uniform(-4, 2, 2)), rng.uniform(-0.9, 0.95), rng.uniform(0.01, 3)
            )
            for _ in range(3)
        ]
        for incidence in ("normal", "diffuse", 0.3):
            result = sg.slab(stack, incidence, streams=8)
            total = result.reflectance + result.transmittance + result.absorbed.sum()
            worst = max(worst, abs(total - 1.0))
    return worst


@held_against(
    "slab at each angle; its mean over diffuse light",
    "directional_transmittance",
    domain="two layers, 64 streams",
    limit=1e-5,
)
def by_direction() -> float:
    stack = [sg.Layer(1.4, 0.1, 8.0, 0.7, 0.2), sg.Layer(1.4, 0.02, 5.0, 0.8, 1.0)]
    told = sg.directional_transmittance(stack, streams=64)
    diffuse = (told["weight"] * told["mu"] * told["transmittance"]).sum() / (told["weight"] * told["mu"]).sum()
    each = [sg.slab(stack, float(mu), streams=64).transmittance for mu in told["mu"][-4:]]
    return max(
        relative(diffuse, sg.slab(stack, "diffuse", streams=64).transmittance),
        relative(told["transmittance"][-4:], each),
    )


@held_against(
    "slab at each thickness", "ThicknessCurve", "ThicknessCurve.transmittance", domain="0.05 to 30 mm", limit=1e-9
)
def curves() -> float:
    thickness = np.geomspace(0.05, 30.0, 25)
    outer, inner = sg.Layer(1.4, 0.3, 9.0, 0.75, 0.06), sg.Layer(1.4, 0.05, 12.0, 0.7, 1.0)
    curve = sg.ThicknessCurve([outer, inner, outer], 1)
    exact = []
    for t in thickness:
        inner.thickness = t
        exact.append(sg.slab([outer, inner, outer], "diffuse").transmittance)
    return relative(curve.transmittance(thickness), exact)


@held_against(
    "Case's discrete eigenvalue, 1 = c nu artanh(1 / nu), by bisection",
    "ThicknessCurve.decay_rate",
    domain="isotropic scattering, albedo 0.3 to 0.999",
    limit=1e-7,
)
def decay() -> float:
    worst = 0.0
    for albedo in (0.3, 0.6, 0.9, 0.99, 0.999):
        low, high = 1e-9, 1 - 1e-15  # 1 / nu
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if albedo * np.arctanh(middle) / middle < 1 else (low, middle)
        curve = sg.ThicknessCurve([sg.Layer(1.0, 2 * (1 - albedo), 2 * albedo, 0.0, 1.0)], 0, streams=64)
        worst = max(worst, relative(curve.decay_rate, 2 * low))
    return worst


def coefficients(nm: float, tissue: sg.Tissue) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Absorption and scattering, 1/mm, and anisotropy of epidermis and dermis by the formulas of docs/optics.md."""
    with (DATA / "hemoglobin.csv").open() as file:
        table = np.array([row for row in csv.reader(line for line in file if line[0].isdigit())], float).T
    oxy, deoxy = (np.interp(nm, table[0], column) for column in table[1:3])
    saturation = tissue.oxygen_saturation
    blood = np.log(10.0) * (saturation * oxy + (1 - saturation) * deoxy) * 150.0 / 64500.0
    rest = 0.244 + 85.3 * np.exp(-(nm - 154.0) / 66.2)
    melanosomes = 1.70e12 * nm**-3.48
    m, b = tissue.melanin_fraction, tissue.blood_fraction
    absorption = np.array([m * melanosomes + (1 - m) * rest, b * blood + (1 - b) * rest]) / 10.0
    x, a, f, power = nm / 500.0, np.array([66.7, 43.6]), np.array([0.29, 0.41]), np.array([0.689, 0.562])
    reduced = tissue.scattering_scale * a * (f * x**-4 + (1 - f) * x**-power) / 10.0
    g = np.array([np.interp(nm, [450, 500, 600, 700], [0.730, 0.745, 0.774, 0.804]), 0.715])
    return absorption, reduced / (1 - g), g


@held_against(
    "the published coefficients, in numpy",
    "skin_layers",
    "Tissue",
    domain="20 random skins without cartilage, 450 to 700 nm",
    limit=1e-12,
)
def layers_of_skin() -> float:
    rng, worst = generator(32), 0.0
    for _ in range(20):
        tissue = sg.Tissue(
            melanin_fraction=rng.uniform(0.01, 0.4),
            blood_fraction=rng.uniform(0.002, 0.05),
            oxygen_saturation=rng.random(),
            scattering_scale=rng.uniform(0.5, 2.0),
        )
        nm = rng.uniform(450.0, 700.0)
        absorption, scattering, g = coefficients(nm, tissue)
        epidermis, dermis, last = sg.skin_layers(tissue, 3.0, nm)
        worst = max(
            worst,
            relative([epidermis.absorption, dermis.absorption], absorption),
            relative([epidermis.scattering, dermis.scattering], scattering),
            relative([epidermis.anisotropy, dermis.anisotropy], g),
            relative([epidermis.thickness, dermis.thickness, last.thickness], [0.06, 2.88, 0.06]),
        )
    return worst


@held_against("slab of its layers", "transmittance", domain="3 thicknesses, 5 wavelengths, light skin", limit=1e-9)
def through_skin() -> float:
    thickness, nm = [0.3, 1.0, 4.0], [420.0, 500.0, 580.0, 660.0, 740.0]
    exact = [[sg.slab(sg.skin_layers(LIGHT, t, w), "diffuse").transmittance for w in nm] for t in thickness]
    found = np.asarray(sg.transmittance(LIGHT, thickness, nm))
    return relative(found if found.shape == np.shape(exact) else found.T, exact)


@held_against(
    "transmission_matrix of transmittance",
    "reference_lut",
    "BaseLut.matrices",
    domain="6 entries to 10 mm, 16 streams",
    limit=1e-9,
)
def reference_tables() -> float:
    lut = sg.reference_lut(LIGHT, 6, 10.0, 16)
    exact = [
        sg.transmission_matrix(np.ravel(sg.transmittance(LIGHT, [t], sg.SAMPLE_WAVELENGTHS_NM)))
        for t in np.linspace(0.0, 10.0, 6)
    ]
    return of_largest(lut.matrices, exact)


@held_against(
    "reference_lut of 64 streams, by lut_error",
    "base_lut",
    "base_lut_report",
    "SkinLutReport",
    "lut_error",
    domain="4 skins, 32 entries to 12 mm",
    limit=1e-3,
)
def tables() -> float:
    worst = 0.0
    for name in ("light", "very_dark", "flushed", "ear"):
        tissue = sg.TISSUE_PRESETS[name]
        lut, report = sg.base_lut_report(tissue, 32)
        assert np.array_equal(lut.matrices, sg.base_lut(tissue, 32).matrices)
        assert report.estimated_error <= 1e-3
        worst = max(worst, sg.lut_error(lut, sg.reference_lut(tissue, 32)))
    return worst


@held_against(
    "slab at each angle over that of diffuse light, at the primaries' wavelengths",
    "skin_angular_weight",
    domain="light skin of 4 mm, cosines 0.1 to 1",
    limit=0.03,
)
def angles_of_skin() -> float:
    weight, mu = sg.skin_angular_weight(LIGHT, 4.0, 32), np.array([0.1, 0.2, 0.5, 0.8, 1.0])
    exact = []
    for nm in PRIMARIES_NM:
        layers = sg.skin_layers(LIGHT, 4.0, nm)
        diffuse = sg.slab(layers, "diffuse", streams=32).transmittance
        exact.append([sg.slab(layers, float(m), streams=32).transmittance / diffuse for m in mu])
    return relative(weight.at(mu), np.transpose(exact))
