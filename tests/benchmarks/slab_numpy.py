"""The slab solver's thickness curve as one would write it in numpy: same algorithm, same result.

For slab_against_numpy.py, which measures the ratio of the two. One layer between equal media; all
thicknesses of a wavelength are solved in one call of numpy.linalg.solve.
"""

import numpy as np


def stream_grid(n, streams):
    """Cosines inside, weights, and cosines outside (0: totally reflected) for diffuse light."""
    steep = streams if n == 1 else max(2, int(streams * np.arcsin(1 / n) * 2 / np.pi + 1e-9))
    node, weight = np.polynomial.legendre.leggauss(steep)
    outside, weight = (node + 1) / 2, weight / 2
    inside = np.sqrt(1 - (1 - outside**2) / n**2)
    weight = weight * outside / (n * n * inside)
    if n > 1:
        critical = np.sqrt(1 - 1 / n**2)
        node, shallow = np.polynomial.legendre.leggauss(streams - steep)
        inside = np.concatenate([inside, (node + 1) / 2 * critical])
        weight = np.concatenate([weight, shallow / 2 * critical])
        outside = np.concatenate([outside, np.zeros(streams - steep)])
    return inside, weight, outside


def angular_basis(cosine, weight):
    """Orthonormal polynomials on the streams, even and odd ones in columns, and their recurrence."""
    count = len(cosine)
    columns = [np.sqrt(weight / weight.sum())]
    recurrence = []
    for degree in range(1, 2 * count):
        value = cosine * columns[-1]
        own = columns[degree % 2 :: 2]
        for _ in range(2):
            for other in own:
                value = value - other * (other @ value)
        recurrence.append(np.linalg.norm(value))
        columns.append(value / recurrence[-1])
    return np.array(columns[1::2]).T, np.array(recurrence)


def layer_modes(absorption, scattering, g, cosine, odd_basis, recurrence):
    """Decay rates (1/mm) and the shapes of the modes."""
    moment = g ** np.arange(2 * len(cosine))
    rate = absorption + scattering * (1 - moment)
    even, odd = rate[0::2], rate[1::2]
    even[0] = max(absorption, 1e-24 * scattering)
    own, following = recurrence[0::2], recurrence[1::2]
    diagonal = own**2 / even
    diagonal[:-1] += following**2 / even[1:]
    off = following * own[1:] / (even[1:] * np.sqrt(odd[:-1] * odd[1:]))
    value, vector = np.linalg.eigh(np.diag(diagonal / odd) + np.diag(off, 1) + np.diag(off, -1))
    shape = (odd_basis / np.sqrt(cosine)[:, None]) @ (np.sqrt(odd)[:, None] * vector)
    return 1 / np.sqrt(value), shape


def fresnel(n, inside, outside):
    s = (outside - n * inside) / (outside + n * inside)
    p = (inside - n * outside) / (inside + n * outside)
    return np.where(outside > 0, (s * s + p * p) / 2, 1.0)


def transmittance(n, coefficients, thickness, streams):
    """(wavelengths, thicknesses); coefficients: rows of absorption, scattering, g, one per wavelength."""
    inside, weight, outside = stream_grid(n, streams)
    odd_basis, recurrence = angular_basis(inside, weight)
    mirror = fresnel(n, inside, outside)
    root = np.sqrt(n * n * weight * inside)
    out = np.empty((len(coefficients), len(thickness)))
    for row, (absorption, scattering, g) in zip(out, coefficients, strict=True):
        decay, shape = layer_modes(absorption, scattering, g, inside, odd_basis, recurrence)
        load = shape.T @ (((1 - mirror) / (1 + mirror))[:, None] * shape)
        receiver = shape.T @ ((1 - mirror) / (1 + mirror) * root)
        depth = decay * thickness[:, None]
        passed = np.exp(-depth)
        lost_per_rate = -np.expm1(-depth) / decay
        symmetric = decay * decay * lost_per_rate / (1 + passed)
        antisymmetric = (1 + passed) / lost_per_rate
        through = 2 * passed / (lost_per_rate * (1 + passed))
        identity = np.eye(len(decay))
        right_side = np.broadcast_to(receiver[:, None], (len(thickness), len(decay), 1))
        lit = np.linalg.solve(load + symmetric[:, :, None] * identity, 4 * right_side)
        seen = np.linalg.solve(load + antisymmetric[:, :, None] * identity, right_side)
        row[:] = np.sum(seen[:, :, 0] * through * lit[:, :, 0], axis=1)
    return out
