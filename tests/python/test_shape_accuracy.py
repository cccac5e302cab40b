"""The arithmetic of the study `shape`: errors against a reference of two noisy halves."""

import numpy as np
import pytest

from studies.shape import cases


def halves(truth, noise):
    random = np.random.default_rng(3)
    return [truth * (1.0 + noise * random.standard_normal(truth.shape)) for _ in range(2)]


def test_noise_of_the_reference_drops_out_of_the_error():
    truth = np.random.default_rng(0).uniform(0.5, 1.5, (40000, 3)) * [1.0, 0.3, 0.05]
    a, b = halves(truth, 0.2)
    weight = np.random.default_rng(1).uniform(0.1, 2.0, len(truth))
    found = cases.error(1.1 * truth, a, b, weight)
    exact = cases.error(1.1 * truth, truth, truth, weight)
    assert exact.channels == pytest.approx(10.4, abs=0.2)
    assert found.channels == pytest.approx(exact.channels, rel=0.1)
    assert abs(found.together - exact.together) < 4.0 * found.standard_error
    assert found.standard_error < 0.1 * exact.together


def test_what_equals_the_truth_has_no_error():
    truth = np.random.default_rng(0).uniform(0.5, 1.5, (40000, 3))
    a, b = halves(truth, 0.3)
    assert cases.error(truth, a, b, np.ones(len(truth))).together < 3.0


def test_vertices_count_by_their_area():
    truth = np.ones((2, 3))
    values = truth * [[1.0], [2.0]]
    weights = np.array([1.0, 0.0])
    assert cases.error(values, truth, truth, weights).together == 0.0
    assert cases.error(values, truth, truth, weights[::-1]).together == pytest.approx(100.0)


def test_the_media_are_what_the_page_says():
    assert cases.SKIN1.absorption == (0.032, 0.17, 0.48)
    assert cases.DARK.reduced_scattering == cases.SKIN1.reduced_scattering
    names = [case.name for case in (cases.Case("scan", "behind", cases.SKIN1, 1.4, "smooth"),)]
    assert names == ["scan-behind-skin1-smooth"]
