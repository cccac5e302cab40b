"""The arithmetic of the study `ear`: errors against a noisy reference, costs, and the medium for Cycles."""

import numpy as np
import pytest

from studies import errors, medium


def noisy_reference(truth, noise, seed=1):
    random = np.random.default_rng(seed)
    return errors.Reference(*(truth * (1.0 + noise * random.standard_normal(truth.shape)) for _ in range(2)))


def test_the_references_noise_drops_out_of_the_error():
    truth = np.random.default_rng(0).uniform(0.5, 1.5, (40000, 3))
    picture = truth * 1.1
    exact = errors.Reference(truth, truth).error(picture).rms
    error = noisy_reference(truth, noise=0.5).error(picture)
    assert exact == pytest.approx(0.1 * np.sqrt((truth**2).mean()) / truth.mean())
    # Without the second seed it would be five times as much.
    assert abs(error.rms - exact) < 4.0 * error.standard_error < 0.3 * exact


def test_a_picture_without_error_has_none():
    truth = np.random.default_rng(0).uniform(0.5, 1.5, (40000, 3))
    reference = noisy_reference(truth, noise=0.3)
    assert reference.error(truth).rms < 0.03
    assert reference.noise == pytest.approx(0.3 / np.sqrt(2.0) * np.sqrt((truth**2).mean()) / truth.mean(), rel=0.02)


def test_the_best_strength_undoes_a_factor():
    truth = np.random.default_rng(0).uniform(0.5, 1.5, (1000, 3))
    reference = errors.Reference(truth, truth)
    assert reference.best_factor(0.2 * truth) == pytest.approx(5.0)
    assert reference.error_at_best(0.2 * truth).rms == pytest.approx(0.0, abs=1e-12)


def test_a_walks_cost_is_found_from_its_renders():
    samples = np.array([4, 16, 64, 256])
    cost = errors.walk_cost(samples, 0.25 + 0.02 * samples, 3.0 / np.sqrt(samples))
    assert cost.fixed == pytest.approx(0.25)
    assert cost.each == pytest.approx(0.02)
    assert cost.seconds_to(0.3) == pytest.approx(0.25 + 0.02 * 100)
    assert cost.samples_to(10.0) == 1.0


def test_a_table_fitted_to_the_reference_is_its_mean_at_each_thickness():
    thickness = np.repeat([1.1, 2.1, 3.1], 50)
    truth = np.repeat([[3.0, 1.0, 0.2], [2.0, 0.5, 0.1], [1.0, 0.2, 0.0]], 50, axis=0)
    fitted = errors.fitted_by_thickness(thickness, errors.Reference(truth * 0.9, truth * 1.1))
    np.testing.assert_allclose(fitted, truth)


def test_the_walks_color_gives_the_mediums_albedo():
    skin = medium.SKIN1
    albedo = medium.cycles_single_scattering_albedo(skin.walk_color)
    np.testing.assert_allclose(albedo, skin.single_scattering_albedo, atol=1e-6)
    np.testing.assert_allclose(albedo, [0.74 / 0.772, 0.88 / 1.05, 1.01 / 1.49], atol=1e-6)


def test_the_mediums_table_is_its_slab_channel_by_channel():
    lut = medium.SKIN1.base_lut(13, 12.0)
    diagonal = np.diagonal(lut.matrices, axis1=1, axis2=2)
    np.testing.assert_allclose(diagonal, medium.SKIN1.transmittance(lut.thickness_mm))
    assert np.count_nonzero(lut.matrices) == diagonal.size
    # Index 1 has no surface to reflect from.
    np.testing.assert_allclose(diagonal[0], 1.0)
    assert (np.diff(diagonal, axis=0) < 0.0).all()
