"""Where a body gets texels for light that comes through: thin flesh and what is near it."""

from __future__ import annotations

import numpy as np
import pytest
import skinglow as sg


def box(low: tuple[float, ...], high: tuple[float, ...], step: float) -> tuple[np.ndarray, np.ndarray]:
    """A closed box, its faces cut into squares of about `step`, counter-clockwise from outside."""
    vertices, triangles = [], []
    low, high = np.array(low), np.array(high)
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        nu, nv = (int(np.ceil((high[k] - low[k]) / step)) for k in (u, v))
        for side in (0, 1):
            first = sum(map(len, vertices))
            i, j = np.meshgrid(np.arange(nu + 1), np.arange(nv + 1), indexing="ij")
            face = np.empty((i.size, 3))
            face[:, axis] = (low, high)[side][axis]
            face[:, u] = low[u] + (high - low)[u] * i.ravel() / nu
            face[:, v] = low[v] + (high - low)[v] * j.ravel() / nv
            vertices.append(face)
            a = (first + np.arange(nu)[:, None] * (nv + 1) + np.arange(nv)).ravel()
            quads = np.stack([a, a + nv + 1, a + nv + 2, a + 1], axis=1)
            quads = quads if side else quads[:, ::-1]
            triangles += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    return np.concatenate(vertices), np.concatenate(triangles)


Fin = tuple[np.ndarray, np.ndarray, np.ndarray]


@pytest.fixture(scope="module")
def fin_on_a_block() -> Fin:
    """A block of 120 x 140 x 60 mm with a fin, 4 mm thick and 25 mm high, on its top; seams between them, thickness."""
    block, fin = box((-60, -70, -60), (60, 70, 0), 2.0), box((-20, -2, 0), (20, 2, 25), 2.0)
    thickness = np.concatenate([np.full(len(block[0]), 60.0), np.full(len(fin[0]), 4.0)])
    return np.concatenate([block[0], fin[0]]), np.concatenate([block[1], fin[1] + len(block[0])]), thickness


def test_flesh_beside_thin_flesh_counts(fin_on_a_block: Fin) -> None:
    vertices, triangles, thickness = fin_on_a_block
    near = sg.near_thin_skin(vertices, triangles, thickness)
    assert near.shape == (len(vertices),)
    assert near[(thickness < 12.0) & (vertices[:, 2] > 1.0)].all()
    # The floor beside the fin, which is 60 mm thick.
    across = np.where((vertices[:, 2] == 0.0) & (np.abs(vertices[:, 0]) < 15.0), np.abs(vertices[:, 1]) - 2.0, np.nan)
    assert near[across < 4.0].all() and (across < 4.0).sum() > 50
    away = (across > 25.0) & (across < 45.0)
    assert not near[away].any() and away.sum() > 50


def test_in_other_units(fin_on_a_block: Fin) -> None:
    vertices, triangles, thickness = fin_on_a_block
    near = sg.near_thin_skin(vertices, triangles, thickness)
    meters = sg.near_thin_skin(vertices / 1000.0, triangles, thickness, unit_mm=1000.0)
    assert (meters != near).mean() < 0.01


def test_the_thickness_that_is_given_counts(fin_on_a_block: Fin) -> None:
    vertices, triangles, thickness = fin_on_a_block
    for unknown in (np.inf, np.nan, 60.0):
        assert not sg.near_thin_skin(vertices, triangles, np.full(len(thickness), unknown)).any()


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("triangles", {"triangles": [(0, 1, 3)]}),
        ("vertices", {"vertices": [(0.0, np.nan, 0.0)] * 3}),
        ("thickness_mm", {"thickness_mm": [1.0]}),
        ("unit_mm", {"unit_mm": 0.0}),
    ],
)
def test_what_is_not_allowed(name: str, given: dict) -> None:
    good = {"vertices": np.eye(3), "triangles": [(0, 1, 2)], "thickness_mm": [1.0, 2.0, 3.0]}
    with pytest.raises(ValueError, match=name):
        sg.near_thin_skin(**{**good, **given})
