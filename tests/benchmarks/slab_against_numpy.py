"""Dermis in diffuse light, 30 wavelengths x 256 thicknesses: the core against numpy doing the same.

Run: OPENBLAS_NUM_THREADS=1 python tests/benchmarks/slab_against_numpy.py
Prints medians and ratios of one run; one thread each.
"""

import statistics
import timeit
from functools import partial

import numpy as np
import skinglow as sg
from slab_numpy import transmittance

ROUNDS = 9
INDEX = 1.4
wavelength = np.linspace(400, 700, 30)
thickness = np.linspace(0.01, 12, 256)
# Dermis after Jacques 2013, with a blood-like edge near 600 nm: a realistic range of albedos.
reduced = 4.36 * (0.41 * (wavelength / 500) ** -4 + 0.59 * (wavelength / 500) ** -0.562)
absorption = 0.03 + 0.6 / (1 + np.exp((wavelength - 595) / 8))
coefficients = [(a, s / (1 - 0.715), 0.715) for a, s in zip(absorption, reduced, strict=True)]


def by_core(streams):
    curves = [sg.ThicknessCurve([sg.Layer(INDEX, a, s, g)], 0, "diffuse", streams=streams) for a, s, g in coefficients]
    return np.array([curve.transmittance(thickness) for curve in curves])


def by_numpy(streams):
    return transmittance(INDEX, coefficients, thickness, streams)


reference = by_core(96)
relevant = reference > 1e-6
print("streams   core ms   numpy ms   ratio   largest error")
for streams in (4, 6, 8, 10, 12, 16, 24, 32):
    ours = by_core(streams)
    np.testing.assert_allclose(by_numpy(streams), ours, rtol=1e-8)
    own, other = [], []
    for _ in range(ROUNDS):  # in turn, so that a drift of the machine's speed meets both alike
        own.append(timeit.timeit(partial(by_core, streams), number=3) / 3)
        other.append(timeit.timeit(partial(by_numpy, streams), number=1))
    ratio = statistics.median(b / a for a, b in zip(own, other, strict=True))
    error = np.max(np.abs(ours / reference - 1)[relevant])
    print(
        f"{streams:7} {statistics.median(own) * 1e3:9.2f} {statistics.median(other) * 1e3:10.1f} "
        f"{ratio:7.1f}   {error:.1e}"
    )
