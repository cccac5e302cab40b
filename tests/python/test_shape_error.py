"""Estimated errors of light in a shape, and cells that are chosen from a tolerance."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg
from test_shape_heads import at_hand, ear

SKIN = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}
DARK = {**SKIN, "absorption": (0.10, 0.40, 0.90)}
SUN = [sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0)]


@pytest.fixture(scope="module")
def lobe():
    return sg.Shape(*bodies.lobe(), **SKIN)


@pytest.mark.parametrize("name", ["lps-a", "lps-c", "mh-a", "lps-a-dark", "lps-a-sdiff"])
def test_it_is_above_what_monte_carlo_measures_and_not_far(name):
    truth, shape, vertices, irradiance = ear(name, 0.8)
    chosen = truth["back_lit"]
    index = truth["vertex"][chosen]
    mesh = at_hand(f"{name.split('-')[0]}_mesh")
    weight = bodies.vertex_areas((vertices, mesh["triangles"]))[index]
    weight /= weight.sum()
    a, b = (truth[half][chosen].astype(float) for half in ("exitance_half_a", "exitance_half_b"))
    found, error = shape.exitance(irradiance)[index], shape.exitance_error(irradiance)[index]
    measured, estimated = weight @ ((found - a) * (found - b)), weight @ error**2
    # An error that is less than two deviations of the reference's noise may be that much.
    product = (found - a) * (found - b)
    noise = 2.0 * np.sqrt((weight**2) @ (product - measured) ** 2)
    noise_of_all = 2.0 * np.sqrt((weight**2) @ (product.mean(axis=1) - measured.mean()) ** 2)
    largest = np.where(measured > noise, measured, measured + noise)
    largest_of_all = measured.mean() + (0.0 if measured.mean() > noise_of_all else noise_of_all)
    assert estimated.mean() > measured.mean()
    assert estimated.mean() < 3.0**2 * largest_of_all
    assert (estimated > measured).all()
    assert estimated[2] < 3.5**2 * largest[2]


def test_it_grows_as_light_falls_and_with_the_cells(lobe):
    light = np.maximum(bodies.vertex_normals(bodies.lobe()) @ (0.0, 0.6, 0.8), 0.0)
    exitance, error = lobe.exitance(light), lobe.exitance_error(light)
    assert error.shape == exitance.shape
    relative = error / np.maximum(exitance, 1e-12)
    lit, dark = light > 0.5, light == 0.0
    assert (relative[lit].mean(axis=0) < 0.15).all()
    assert (relative[dark].mean(axis=0) > 1.2 * relative[lit].mean(axis=0)).all()
    fine = sg.Shape(*bodies.lobe(), **SKIN, cell_mm=0.4)
    assert (fine.exitance_error(light).sum(axis=0) < error.sum(axis=0)).all()
    np.testing.assert_allclose(lobe.exitance_error(3.0 * light), 3.0 * error, rtol=1e-4, atol=1e-7)
    assert not lobe.exitance_error(0.0 * light).any()


def test_a_lit_shape_reports_it(lobe):
    lit = lobe.light(SUN, reentries=0)
    np.testing.assert_allclose(lit.error, lobe.exitance_error(lit.irradiance), rtol=1e-5)
    area = bodies.vertex_areas(bodies.lobe())
    for c in range(3):
        through = lit.transmitted[:, c] > 0.5 * lit.exitance[:, c]
        light = (area * lit.exitance[:, c])[through]
        relative = (lit.error / np.maximum(lit.exitance, 1e-30))[through, c]
        expected = np.sqrt(light @ relative**2 / light.sum())
        np.testing.assert_allclose(lit.report["error"][c], expected, rtol=0.02)
    np.testing.assert_allclose(lit.report["part_errors"], [lit.report["error"]], rtol=1e-6)


def test_what_is_reported_is_above_what_finer_cells_say_and_not_by_much(lobe):
    """Points that nearly no light reaches had as much weight as all others: 59 to 133 % of a head were reported."""
    fine = sg.Shape(*bodies.lobe(), **SKIN, cell_mm=0.3).light(SUN, reentries=0).exitance
    lit = lobe.light(SUN, reentries=0)
    area = bodies.vertex_areas(bodies.lobe())
    for c in range(2):
        through = lit.transmitted[:, c] > 0.5 * lit.exitance[:, c]
        light = (area * lit.exitance[:, c])[through]
        off = (lit.exitance - fine)[through, c] / lit.exitance[through, c]
        measured = np.sqrt(light @ off**2 / light.sum())
        # The cells are but a part of the error.
        assert measured < lit.report["error"][c] < 0.2
    assert (lit.error <= lit.exitance).all()


def test_where_nothing_is_lit_no_error_is_reported(lobe):
    assert (lobe.light([]).report["error"] == 0.0).all()


@pytest.mark.parametrize("lights", [SUN, SUN * 4, []])
def test_of_a_tissue_it_is_finite_and_not_negative(lights):
    lit = sg.Shape(*bodies.lobe(levels=3), sg.Tissue()).light(lights, sg.Environment((0.1, 0.2, 0.3)))
    assert np.isfinite(lit.error).all()
    assert lit.error.min() >= 0.0
    assert (lit.error.mean(axis=0) > 0.02 * lit.exitance.mean(axis=0)).all()


def test_cells_follow_a_tolerance():
    def cell(tolerance, medium=SKIN):
        return sg.Shape(*bodies.lobe(levels=2), **medium, tolerance=tolerance).report["cell_mm"]

    assert 0.3 <= cell(0.11) < cell(0.12) < cell(0.13) < cell(0.15) <= 1.6
    assert cell(0.2, DARK) < cell(0.2)
    assert cell(10.0) == 1.6
    assert sg.Shape(*bodies.lobe(levels=2), **SKIN).report["cell_mm"] == 0.8
    assert sg.Shape(*bodies.lobe(levels=2), **SKIN, cell_mm=0.6).report["cell_mm"] == 0.6


def test_light_with_chosen_cells_is_within_the_tolerance():
    """Of much finer cells, on the side that is lit through."""
    light = np.where(bodies.lobe()[0][:, 2] > 1.0, 1.0, 0.0)
    dark = light == 0.0

    def exitance(**cells):
        return sg.Shape(*bodies.lobe(), **SKIN, **cells).exitance(light)[dark]

    fine = exitance(cell_mm=0.25)
    for tolerance in (0.12, 0.2, 0.4):
        found = exitance(tolerance=tolerance)
        assert np.sqrt(((found - fine) ** 2).mean()) < tolerance * fine.mean()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tolerance": 0.01}, r"tolerance is 0.01; allowed: 0\.\d+ or more in this medium"),
        ({"tolerance": 0.0}, "tolerance is 0.0"),
        ({"tolerance": -1.0}, "tolerance is -1.0"),
        ({"tolerance": np.nan}, "tolerance is nan"),
        ({"tolerance": np.inf}, "tolerance is inf"),
        ({"tolerance": 0.2, "cell_mm": 0.8}, "cell_mm is given"),
    ],
)
def test_bad_tolerances_are_refused_in_words(change, message):
    with pytest.raises(ValueError, match=message):
        sg.Shape(*bodies.lobe(levels=2), **SKIN, **change)
