"""The slab solver from Python: what must hold for any slab, and what is refused."""

import math

import numpy as np
import pytest
import skinglow as sg
from hypothesis import example, given, settings
from hypothesis import strategies as st

INDICES = st.sampled_from([1.0, 1.0 + 1e-9, 1.0001, 1.33, 1.4, 1.41, 1.6]) | st.floats(1.0, 1.6)
EXPONENT_OF_LOSS = st.floats(-12, 0)
INCIDENCE = st.sampled_from(["normal", "diffuse"]) | st.floats(0.01, 1.0)
PLAIN = settings(deadline=None, max_examples=60)


@st.composite
def layers(draw: st.DrawFn, least_depth: float = -6, most_depth: float = 6) -> sg.Layer:
    attenuation = 10 ** draw(st.floats(-3, 3))
    loss = draw(st.just(0.0) | st.just(1.0) | EXPONENT_OF_LOSS.map(lambda x: 10**x))
    return sg.Layer(
        refractive_index=draw(INDICES),
        absorption=attenuation * loss,
        scattering=attenuation * (1 - loss),
        anisotropy=draw(st.floats(-0.95, 0.99)),
        thickness=10 ** draw(st.floats(least_depth, most_depth)) / attenuation,
    )


@PLAIN
@given(st.lists(layers(), min_size=1, max_size=8), INCIDENCE, INDICES, INDICES)
def test_light_is_neither_made_nor_lost(stack, incidence, n_above, n_below):
    result = sg.slab(stack, incidence, n_above, n_below, streams=8)
    parts = [result.reflectance, result.transmittance, *result.absorbed]
    assert all(0 <= part <= 1 for part in parts)
    assert 0 <= result.unscattered <= result.transmittance
    assert sum(parts) == pytest.approx(1, abs=1e-10)


def test_fifty_layers_with_fifty_indices():
    rng = np.random.default_rng(3)
    stack = [
        sg.Layer(n, a, s, g, d)
        for n, a, s, g, d in zip(
            rng.uniform(1, 1.6, 50),
            10 ** rng.uniform(-6, 0, 50),
            10 ** rng.uniform(-3, 3, 50),
            rng.uniform(-0.95, 0.99, 50),
            10 ** rng.uniform(-3, 0, 50),
            strict=True,
        )
    ]
    result = sg.slab(stack, "diffuse", streams=16)
    assert result.absorbed.shape == (50,)
    total = result.reflectance + result.transmittance + result.absorbed.sum()
    assert total == pytest.approx(1, abs=1e-10)


@PLAIN
@given(st.floats(1.0, 1.6), st.floats(0, 500))
def test_pure_absorber_has_a_closed_form(n, depth):
    mirror = ((n - 1) / (n + 1)) ** 2
    passed = math.exp(-depth)
    expected = (1 - mirror) ** 2 * passed / (1 - mirror**2 * passed**2)
    result = sg.slab([sg.Layer(n, depth, 0, 0, 1)], streams=4)
    assert result.transmittance == pytest.approx(expected, rel=1e-11)
    assert result.unscattered == pytest.approx(expected, rel=1e-11)


@PLAIN
@given(layers(), INCIDENCE)
def test_what_does_not_absorb_keeps_its_light(layer, incidence):
    layer.scattering += layer.absorption
    layer.absorption = 0
    result = sg.slab([layer], incidence, streams=8)
    assert result.reflectance + result.transmittance == pytest.approx(1, abs=1e-10)
    assert result.absorbed[0] < 1e-10


@PLAIN
@given(st.lists(layers(-2, 1), min_size=1, max_size=4), INDICES, INDICES)
def test_reciprocity(stack, n_above, n_below):
    down = n_above**2 * sg.slab(stack, "diffuse", n_above, n_below, streams=8).transmittance
    up = n_below**2 * sg.slab(stack[::-1], "diffuse", n_below, n_above, streams=8).transmittance
    assert up == pytest.approx(down, rel=1e-9)


@PLAIN
@given(layers(-3, 2), INCIDENCE, st.integers(2, 7))
def test_a_slab_in_pieces_is_the_same_slab(layer, incidence, pieces):
    whole = sg.slab([layer], incidence, streams=8)
    layer.thickness /= pieces
    cut = sg.slab([layer] * pieces, incidence, streams=8)
    assert cut.reflectance == pytest.approx(whole.reflectance, abs=1e-10)
    assert cut.transmittance == pytest.approx(whole.transmittance, rel=1e-9)
    assert cut.absorbed.sum() == pytest.approx(whole.absorbed.sum(), abs=1e-10)


@PLAIN
@given(layers(), st.sampled_from(["normal", "diffuse"]))
def test_transmittance_falls_with_thickness(layer, incidence):
    attenuation = layer.absorption + layer.scattering
    curve = sg.ThicknessCurve([layer], 0, incidence, streams=8)
    fall = curve.transmittance(np.logspace(-6, 6, 49) / attenuation)
    assert np.all((fall >= 0) & (fall <= 1))
    assert np.all(np.diff(fall) <= 0)


@PLAIN
@given(st.floats(-6, -0.1), st.floats(-0.9, 0.9), INDICES, st.sampled_from(["normal", "diffuse"]))
def test_log_slope_tends_to_the_smallest_eigenvalue(loss, anisotropy, n, incidence):
    layer = sg.Layer(n, 10**loss, 1 - 10**loss, anisotropy)
    curve = sg.ThicknessCurve([layer], 0, incidence, streams=8)
    # Far in, the slowest mode alone is left; where absorption is strong the next one is not far behind.
    far = 300 / curve.decay_rate
    first, second = curve.transmittance([far, 1.1 * far])
    slope = math.log(first / second) / (0.1 * far)
    assert slope == pytest.approx(curve.decay_rate, rel=1e-9 if loss < -1 else 0.01)


@PLAIN
@given(layers(-3, 3), layers(-3, 1), INCIDENCE, st.booleans())
# Without absorption, and so thick that only the slowest mode, which then hardly decays, comes through.
@example(sg.Layer(1, 0, 1, 0, 1), sg.Layer(1.5, 0, 1, 0, 1), 0.015625, False)
def test_thickness_curve_is_the_slab(inner, outer, incidence, both_sides):
    stack = [outer, inner, outer] if both_sides else [outer, inner]
    curve = sg.ThicknessCurve(stack, 1, incidence, streams=8)
    assert curve.transmittance([inner.thickness])[0] == pytest.approx(
        sg.slab(stack, incidence, streams=8).transmittance, rel=1e-8
    )


def test_directions_add_up_to_diffuse_light():
    stack = [sg.Layer(1.4, 0.1, 10, 0.8, 1)]
    beams = sg.directional_transmittance(stack, streams=32)
    total = np.sum(2 * beams["mu"] * beams["weight"] * beams["transmittance"])
    assert total == pytest.approx(sg.slab(stack, "diffuse", streams=32).transmittance, rel=1e-6)
    assert beams["transmittance"][0] == pytest.approx(sg.slab(stack, streams=32).transmittance, rel=1e-12)


def test_layer_takes_names_and_positions():
    assert sg.Layer(1.5, 0.1, 2, 0.5, 3) == sg.Layer(
        refractive_index=1.5, absorption=0.1, scattering=2, anisotropy=0.5, thickness=3
    )
    assert "thickness=3" in repr(sg.Layer(1.5, 0.1, 2, 0.5, 3))


@pytest.mark.parametrize(
    ("field", "values"),
    [
        ("refractive_index", [0.99, math.nan, math.inf]),
        ("absorption", [-1e-9, math.nan, math.inf]),
        ("scattering", [-1.0, math.nan, math.inf]),
        ("anisotropy", [1.0, -1.0, math.nan]),
        ("thickness", [-1.0, math.nan, math.inf]),
    ],
)
def test_refusal_names_layer_and_field(field, values):
    for value in values:
        bad = sg.Layer(1.4, 0.1, 1, 0.5, 1)
        setattr(bad, field, value)
        with pytest.raises(ValueError, match=rf"layers\[1\]\.{field} is "):
            sg.slab([sg.Layer(), bad, sg.Layer()])


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"layers": []}, "layers"),
        ({"layers": sg.Layer()}, "layers"),
        ({"layers": [1.4]}, r"layers\[0\]"),
        ({"streams": 7}, "streams"),
        ({"streams": 2}, "streams"),
        ({"streams": 130}, "streams"),
        ({"incidence": "sideways"}, "incidence"),
        ({"incidence": 0.0}, "incidence"),
        ({"incidence": 1.01}, "incidence"),
        ({"n_above": 0.5}, "n_above"),
        ({"n_below": math.nan}, "n_below"),
    ],
)
def test_refusal_names_the_argument(arguments, name):
    with pytest.raises(ValueError, match=f"{name} is .*allowed"):
        sg.slab(**{"layers": [sg.Layer(1.4, 0.1, 1, 0.5, 1)], **arguments})
    if not any(key in arguments for key in ("layers",)):
        with pytest.raises(ValueError, match=f"{name} is .*allowed"):
            sg.ThicknessCurve([sg.Layer(1.4, 0.1, 1, 0.5, 1)], **arguments)
