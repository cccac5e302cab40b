"""Thickness summarized, colored, baked to images and read back."""

import io

import matplotlib.image
import numpy as np
import pytest
import skinglow as sg
from hypothesis import given, settings
from hypothesis import strategies as st

SQUARE = [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]


def test_summary() -> None:
    found = sg.thickness_summary([1.0, 2.0, 2.5, 30.0], 4.0, 4)
    assert found[:3] == (1.0, 2.25, 30.0) and found.fraction_above == 0.25
    np.testing.assert_array_equal(found.histogram, [0.0, 0.25, 0.5, 0.0])
    assert found.histogram.sum() + found.fraction_above == 1.0
    assert sg.thickness_summary([], 4.0).max_mm == 0.0
    for wrong in ({"limit_mm": 0.0}, {"limit_mm": np.inf}, {"limit_mm": 1.0, "bins": 0}):
        with pytest.raises(ValueError, match="not allowed"):
            sg.thickness_summary([1.0], **wrong)
    with pytest.raises(ValueError, match="thickness_mm has a number that is not finite"):
        sg.thickness_summary([np.nan], 1.0)


def test_colors_get_darker_with_thickness() -> None:
    colors = sg.thickness_colors(np.linspace(0.0, 12.0, 50), 12.0)
    assert colors.shape == (50, 3) and colors.min() >= 0.0 and colors.max() <= 1.0
    assert (np.diff(sg.luminance(colors)) < 0.0).all()
    np.testing.assert_array_equal(sg.thickness_colors([13.0, 12.0], 12.0)[0], colors[-1])
    assert np.ptp(sg.thickness_colors([-1.0], 12.0)) < 0.2
    np.testing.assert_array_equal(sg.thickness_colors([np.nan], 12.0), sg.thickness_colors([-1.0], 12.0))
    for wrong in (0.0, -5.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="max_mm = .* a finite number above 0"):
            sg.thickness_colors([0.0, 1.0], wrong)


def test_square_is_covered_and_linear() -> None:
    """z = 1 + 2 u + 3 v over two triangles, exactly, at each texel's center."""
    corners = np.array(SQUARE, float)
    image, covered = sg.bake_thickness(corners, 1.0 + corners @ (2.0, 3.0), 16, 8, margin=0)
    u, v = np.meshgrid((np.arange(16) + 0.5) / 16, (np.arange(8) + 0.5) / 8)
    assert covered.all()
    np.testing.assert_allclose(image, 1.0 + 2.0 * u + 3.0 * v, rtol=1e-6)


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(*[st.floats(-0.5, 1.5)] * 6), min_size=1, max_size=8), st.integers(1, 40), st.integers(1, 40))
def test_same_texels_as_point_by_point(triangles: list, width: int, height: int) -> None:
    """Against the plain test of each texel with each triangle; those on an edge may go either way."""
    corners = np.array(triangles).reshape(-1, 3, 2)
    _image, covered = sg.bake_thickness(corners, np.ones(corners.shape[:2]), width, height, margin=0)
    points = np.stack(np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height), -1)
    surely, perhaps = np.zeros((height, width), bool), np.zeros((height, width), bool)
    for a, b, c in corners:
        offsets = [(q - p, points - p) for p, q in ((a, b), (b, c), (c, a))]
        sides = [edge[0] * offset[..., 1] - edge[1] * offset[..., 0] for edge, offset in offsets]
        area = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
        inside = np.min(np.array(sides) * np.sign(area), axis=0)
        surely |= (inside > 1e-5) & (area != 0.0)
        perhaps |= inside > -1e-5
    assert (covered >= surely).all() and (covered <= perhaps).all()


def test_margin_and_outside() -> None:
    corners = np.array(SQUARE, float) * 0.5 + 0.25
    image, covered = sg.bake_thickness(corners, np.full((2, 3), 3.0), 16, 16, margin=2, outside_mm=99.0)
    assert covered.sum() == 12 * 12
    assert (image[covered] == 3.0).all() and (image[~covered] == 99.0).all()


def test_large_triangles_and_many() -> None:
    """A grid of 20,000 triangles of 1024 x 1024 texels: what each vertex has is there."""
    n = 100
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1)))
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.concatenate([np.c_[i, i + 1, i + n + 2], np.c_[i, i + n + 2, i + n + 1]])
    values = 2.0 + np.sin(6.0 * u) * np.cos(5.0 * v)
    image, covered = sg.bake_thickness(np.c_[u, v][triangles], values[triangles], 1024, 1024, margin=0)
    assert covered.all()
    np.testing.assert_allclose(sg.sample_image(image, np.c_[u, v]), values, atol=0.02)


def test_sampling_is_bilinear() -> None:
    image = np.array([[0.0, 1.0], [2.0, 3.0]])
    found = sg.sample_image(image, [(0.5, 0.5), (0.25, 0.25), (0.0, 0.0), (1.0, 1.0), (0.75, 0.5)])
    np.testing.assert_allclose(found, [1.5, 0.0, 0.0, 3.0, 2.0])
    np.testing.assert_array_equal(sg.sample_image([[7.0]], [(0.1, 0.9)]), [7.0])
    with pytest.raises(ValueError, match="not allowed"):
        sg.sample_image(np.zeros((0, 0)), [(0.0, 0.0)])


@pytest.mark.parametrize("bits", (8, 16))
def test_png(bits: int) -> None:
    values = np.linspace(-0.1, 1.1, 35).reshape(5, 7)
    picture = matplotlib.image.imread(io.BytesIO(sg.gray_png(values, bits)), format="png")
    assert picture.shape == (5, 7)
    np.testing.assert_allclose(picture[::-1], values.clip(0.0, 1.0), atol=0.51 / (2**bits - 1))
    with pytest.raises(ValueError, match="8 or 16"):
        sg.gray_png(values, 12)


@pytest.mark.parametrize(
    ("given", "words"),
    (
        ({"uv": np.zeros((1, 2, 2))}, r"\(m, 3, 2\)"),
        ({"thickness_mm": [[1.0, np.inf, 1.0]]}, "not finite"),
        ({"width": 0}, "width = 0"),
        ({"height": 20000}, "1 to 16384"),
        ({"margin": -1}, "margin = -1"),
    ),
)
def test_refused(given: dict, words: str) -> None:
    good = {"uv": [[(0, 0), (1, 0), (1, 1)]], "thickness_mm": [[1.0, 1.0, 1.0]], "width": 4, "height": 4}
    with pytest.raises(ValueError, match=words):
        sg.bake_thickness(**{**good, **given})
