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


@pytest.fixture(scope="module")
def fin_on_a_block() -> tuple[np.ndarray, np.ndarray]:
    """A block of 120 x 140 x 60 mm with a fin, 4 mm thick and 25 mm high, on its top."""
    block, fin = box((-60, -70, -60), (60, 70, 0), 2.5), box((-20, -2, -1), (20, 2, 25), 2.0)
    return np.concatenate([block[0], fin[0]]), np.concatenate([block[1], fin[1] + len(block[0])])


def test_flesh_beside_thin_flesh_counts(fin_on_a_block: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, triangles = fin_on_a_block
    thin = sg.in_thin_parts(vertices, triangles)
    assert thin.shape == (len(vertices),)
    assert thin[vertices[:, 2] > 2.0].all()
    top = vertices[:, 2] == 0.0
    # The floor beside the fin, which is 60 mm thick.
    beside = top & (np.abs(vertices[:, 0]) < 15.0) & (np.abs(vertices[:, 1]) < 7.0) & (np.abs(vertices[:, 1]) > 2.0)
    assert beside.any()
    assert thin[beside].all()
    away = top & (np.abs(vertices[:, 1]) > 25.0) & (np.abs(vertices[:, 1]) < 40.0) & (np.abs(vertices[:, 0]) < 15.0)
    assert away.any()
    assert not thin[away].any()


def test_in_other_units(fin_on_a_block: tuple[np.ndarray, np.ndarray]) -> None:
    vertices, triangles = fin_on_a_block
    meters = sg.in_thin_parts(vertices / 1000.0, triangles, unit_mm=1000.0)
    assert (meters != sg.in_thin_parts(vertices, triangles)).mean() < 0.01


def test_what_is_not_allowed() -> None:
    with pytest.raises(ValueError, match="triangles"):
        sg.in_thin_parts(np.zeros((3, 3)), [(0, 1, 3)])
