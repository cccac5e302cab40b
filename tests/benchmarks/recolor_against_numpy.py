"""Recoloring 256 texels by the core, against numpy doing the same and against copying the bytes of the result.

Run: python tests/benchmarks/recolor_against_numpy.py     Prints medians and ratios of one run, pair by pair.
"""

import statistics
import timeit

import numpy as np
import skinglow as sg

SIZE, ROUNDS, CALLS = 256, 31, 2000

base = sg.six_gaussian_base(SIZE)
matrices = np.ascontiguousarray(base.matrices)
weight = np.array([2.9, 1.4, 1.6])
table = sg.recolor(base, weight)
np.testing.assert_allclose(matrices @ weight, table, rtol=1e-14)

variants = {
    "skinglow.recolor": lambda: sg.recolor(base, weight),
    "numpy: matrices @ weight": lambda: matrices @ weight,
    "numpy: einsum": lambda: np.einsum("kij,j->ki", matrices, weight),
    "copy of the result": table.copy,
}
times = {name: [] for name in variants}
for _ in range(ROUNDS):  # in turn, so that a drift of the machine's speed meets all alike
    for name, variant in variants.items():
        times[name].append(timeit.timeit(variant, number=CALLS) / CALLS)
ours = times["skinglow.recolor"]
print(f"{SIZE} texels, {ROUNDS} rounds of {CALLS} calls")
for name, taken in times.items():
    ratio = statistics.median(other / own for other, own in zip(taken, ours, strict=True))
    print(f"{name:26} {statistics.median(taken) * 1e6:7.2f} us   {ratio:5.2f} x skinglow")
