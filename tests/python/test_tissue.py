"""Skin through the Python package: parameters, transmittance, spectra, the base lookup and its bound."""

import sys
import threading

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given, settings
from hypothesis import strategies as st

from studies.accuracy import diffusion

WHITE = np.ones(3)


def tissues():
    """Any tissue that the parameters allow."""
    ranges = {name: st.floats(minimum, maximum) for name, (_, minimum, maximum, _, _) in sg.TISSUE_PARAMETERS.items()}
    return st.builds(lambda values: sg.Tissue(**values), st.fixed_dictionaries(ranges))


def test_parameters_say_what_a_slider_needs():
    tissue = sg.Tissue()
    for name, (default, minimum, maximum, unit, description) in sg.TISSUE_PARAMETERS.items():
        assert getattr(tissue, name) == default
        assert minimum <= default <= maximum
        assert unit in ("1", "mm")
        assert len(description) > 10
        assert name in sg.Tissue.__doc__


def test_presets_are_named_tissues_with_a_line_each():
    assert {"light", "medium", "dark", "flushed", "pale", "ear"} <= set(sg.TISSUE_PRESETS)
    for tissue in sg.TISSUE_PRESETS.values():
        assert isinstance(tissue, sg.Tissue)
        assert len(tissue.description) > 20
    assert sg.TISSUE_PRESETS["light"] == sg.Tissue()
    assert sg.TISSUE_PRESETS["dark"] != sg.Tissue()


def test_replace_changes_a_copy():
    ear = sg.TISSUE_PRESETS["ear"]
    other = ear.replace(blood_fraction=0.05)
    assert other.blood_fraction == 0.05
    assert other.melanin_fraction == ear.melanin_fraction
    assert ear.blood_fraction != 0.05
    assert other == sg.Tissue(**{name: getattr(other, name) for name in sg.TISSUE_PARAMETERS})
    assert hash(other) == hash(ear.replace(blood_fraction=0.05))


@pytest.mark.parametrize("name", list(sg.TISSUE_PARAMETERS))
@pytest.mark.parametrize("value", [-1.0, 10.0, np.nan, np.inf])
def test_out_of_range_is_refused_with_the_range(name, value):
    _, minimum, maximum, _, _ = sg.TISSUE_PARAMETERS[name]
    with pytest.raises(ValueError, match=rf"{name} is .*allowed: {minimum:g} to {maximum:g}"):
        sg.Tissue(**{name: value})


def test_unknown_and_wrong_parameters_are_refused():
    with pytest.raises(ValueError, match="allowed: melanin_fraction, "):
        sg.Tissue(melanin=0.1)
    with pytest.raises(ValueError, match="blood_fraction is 'much'; allowed: a number"):
        sg.Tissue(blood_fraction="much")


def test_transmittance_is_that_of_the_layers():
    tissue = sg.TISSUE_PRESETS["medium"]
    thickness, wavelength = [0.05, 0.3, 2.0], [450.0, 560.0, 650.0, 700.0]
    for incidence in ("diffuse", "normal", 0.5):
        found = sg.transmittance(tissue, thickness, wavelength, incidence=incidence)
        assert found.shape == (3, 4)
        slabs = [
            [sg.slab(sg.skin_layers(tissue, d, nm), incidence).transmittance for nm in wavelength] for d in thickness
        ]
        np.testing.assert_allclose(found, slabs, rtol=1e-9)


@given(tissue=tissues(), wavelength=st.floats(380, 780))
@settings(max_examples=60, deadline=None)
def test_transmittance_falls_with_thickness(tissue, wavelength):
    thickness = np.geomspace(1e-3, 20.0, 60)
    found = sg.transmittance(tissue, thickness, wavelength, streams=8)[:, 0]
    assert np.all(found >= 0) and np.all(found <= 1)
    assert np.all(np.diff(found) <= 0)


@given(tissue=tissues(), exponent=st.floats(-4, -1), max_thickness=st.floats(0.2, 20.0))
@settings(max_examples=25, deadline=None)
def test_the_estimate_bounds_the_error(tissue, exponent, max_thickness):
    tolerance = 10.0**exponent
    lut, report = sg.base_lut_report(tissue, 40, max_thickness, tolerance)
    error = sg.lut_error(lut, sg.reference_lut(tissue, 40, max_thickness, streams=32))
    assert error <= report.estimated_error <= tolerance


def test_base_lut_is_a_table_that_recolors():
    lut = sg.base_lut(sg.TISSUE_PRESETS["light"], size=64, max_thickness_mm=8.0)
    assert isinstance(lut, sg.BaseLut)
    assert lut.matrices.shape == (64, 3, 3)
    assert lut.max_thickness_mm == 8.0
    red, blue = sg.recolor(lut, (1, 0, 0)), sg.recolor(lut, (0, 0, 1))
    assert np.all(np.diff(red[:, 0]) < 0)
    assert blue[10, 0] < 0.02 * red[10, 0]  # a blue lamp does not make a red ear


def test_report_tells_what_was_chosen():
    lut, coarse = sg.base_lut_report(sg.Tissue(), tolerance=1e-1)
    fine = sg.base_lut_report(sg.Tissue(), tolerance=1e-4)[1]
    assert fine.streams > coarse.streams
    assert fine.estimated_error < coarse.estimated_error
    np.testing.assert_array_equal(lut.matrices, sg.reference_lut(sg.Tissue(), streams=coarse.streams).matrices)


def test_number_of_threads_does_not_matter():
    one = sg.base_lut(sg.Tissue(), 32, threads=1)
    np.testing.assert_array_equal(one.matrices, sg.base_lut(sg.Tissue(), 32, threads=3).matrices)


@pytest.mark.parametrize(
    "call",
    [
        lambda: sg.reference_lut(sg.Tissue(), 256, 12.0, 64, threads=1),
        lambda: sg.base_lut(sg.Tissue(), 256, 12.0, 1e-6, threads=1),
        lambda: sg.base_lut_report(sg.Tissue(), 256, 12.0, 1e-6, threads=1),
        lambda: sg.transmittance(sg.Tissue(), np.linspace(0, 12, 99), sg.SAMPLE_WAVELENGTHS_NM, streams=64, threads=1),
        lambda: sg.skin_angular_weight(sg.Tissue(), streams=128),
        lambda: sg.slab([sg.Layer(1.4, 0.1, 10, 0.8, 1)] * 3 + [sg.Layer(1.3, 0.1, 10, 0.8, 1)] * 3, streams=128),
    ],
    ids=["reference_lut", "base_lut", "base_lut_report", "transmittance", "skin_angular_weight", "slab"],
)
def test_other_threads_go_on(call):
    steps, done = [0], threading.Event()
    running = threading.Event()

    def count():
        while not done.is_set():
            steps[0] += 1
            running.set()

    # The switch interval is longer than the call: the other thread advances only if the call lets it.
    before = sys.getswitchinterval()
    thread = threading.Thread(target=count)
    thread.start()
    running.wait()
    sys.setswitchinterval(2.0)
    try:
        start = steps[0]
        call()
        assert steps[0] > start
    finally:
        sys.setswitchinterval(before)
        done.set()
        thread.join()


def test_spectra():
    assert sg.SAMPLE_WAVELENGTHS_NM.shape == (81,)
    assert not sg.SAMPLE_WAVELENGTHS_NM.flags.writeable
    np.testing.assert_allclose(sg.spectral_color(sg.D65_SPECTRUM), 1.0, atol=1e-6)
    np.testing.assert_allclose(sg.transmission_matrix(np.ones(81)), np.eye(3), atol=1e-13)
    table = sg.tabulated_spectrum(sg.SAMPLE_WAVELENGTHS_NM, sg.D65_SPECTRUM)
    np.testing.assert_allclose(sg.spectral_color(table), 1.0, atol=5e-3)
    red, _, blue = sg.spectral_color(sg.blackbody_spectrum(2700.0))
    assert red > 5 * blue
    assert sg.spectral_color(sg.line_spectrum(589.3, 1.0))[2] < 0  # sodium lies outside the gamut


@given(st.lists(st.floats(0, 1), min_size=81, max_size=81), st.tuples(*[st.floats(0, 4)] * 3))
@settings(deadline=None)
def test_matrix_is_the_full_spectral_answer_for_lights_of_the_basis(filter_, rgb):
    if max(rgb) < 1e-3:
        return
    spectrum = sg.rgb_spectrum(rgb)
    exact = sg.spectral_color(spectrum, filter_)
    found = sg.transmission_matrix(filter_) @ sg.spectral_color(spectrum)
    np.testing.assert_allclose(found, exact, atol=1e-9 * max(1.0, np.max(np.abs(found))))


def test_diffusion_theory_is_near_in_deep_skin_only():
    tissue = sg.Tissue()
    exact = sg.transmittance(tissue, [0.3, 6.0], 650.0)[:, 0]
    ratio = diffusion.transmittance(tissue, [0.3, 6.0], [650.0])[:, 0] / exact
    assert abs(ratio[1] - 1) < abs(ratio[0] - 1)


def test_diffusion_theory_has_the_decay_rate_of_the_solution():
    deep = sg.transmittance(sg.Tissue(), [20.0, 21.0], 600.0, streams=32)[:, 0]
    approximate = diffusion.transmittance(sg.Tissue(), [20.0, 21.0], [600.0])[:, 0]
    assert np.log(approximate[1] / approximate[0]) / np.log(deep[1] / deep[0]) == pytest.approx(1.0, abs=0.02)


def test_diffuse_reflectance_of_a_surface():
    assert diffusion.diffuse_fresnel_reflectance(1.0) == 0.0
    # Known value for n = 1.5: 0.0918 (J. W. T. Walsh 1926, tabulated by R. A. Judd, J. Res. NBS 29:329, 1942).
    assert diffusion.diffuse_fresnel_reflectance(1.5) == pytest.approx(0.0918, abs=2e-4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sg.transmittance(sg.Tissue(), [-1.0], [500.0]), "thickness"),
        (lambda: sg.transmittance(sg.Tissue(), [1.0], [300.0]), "wavelength_nm is 300"),
        (lambda: sg.transmittance(sg.Tissue(), [[1.0]], [500.0]), "shape"),
        (lambda: sg.transmittance(sg.Tissue(), [1.0], [500.0], incidence="up"), "incidence"),
        (lambda: sg.transmittance(sg.Tissue(), [1.0], [500.0], streams=5), "streams"),
        (lambda: sg.base_lut(sg.Tissue(), tolerance=0.5), "tolerance is 0.5"),
        (lambda: sg.base_lut(sg.Tissue(), max_thickness_mm=0), "max_thickness_mm"),
        (lambda: sg.base_lut(sg.Tissue(), size=0), "table size"),
        (lambda: sg.blackbody_spectrum(10.0), "temperature_k is 10"),
        (lambda: sg.line_spectrum(900.0, 10.0), "center_nm"),
        (lambda: sg.tabulated_spectrum([500.0, 400.0], [1.0, 1.0]), "wavelength_nm"),
        (lambda: sg.spectral_color(np.ones(80)), r"shape \(80,\)"),
        (lambda: sg.spectral_color(np.zeros(81)), "luminance"),
    ],
)
def test_bad_input_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_former_keyword_of_a_line_spectrum_goes_on_working_with_a_warning() -> None:
    with pytest.warns(DeprecationWarning, match="centre_nm is now center_nm"):
        assert np.array_equal(sg.line_spectrum(centre_nm=500.0, fwhm_nm=20.0), sg.line_spectrum(500.0, 20.0))
