"""Which flesh of a body skinglow.Shape solves, in what parts, and that nobody sees where they end."""

import numpy as np
import shape_bodies as bodies
import skinglow as sg

SKIN = {"absorption": (0.032, 0.17, 0.48), "reduced_scattering": (0.74, 0.88, 1.01), "refractive_index": 1.0}


def strip():
    """240 x 24 x 2 mm: far longer than light travels."""
    vertices, triangles = bodies.plate(240.0, 2.0, 48)
    return vertices * [1.0, 0.1, 1.0], triangles


def wedge():
    """60 mm square, from 2 to 40 mm thick along x."""
    vertices, triangles = bodies.plate(60.0, 1.0, 60)
    vertices[:, 2] *= 2.0 + 38.0 / 60.0 * (vertices[:, 0] + 30.0)
    return vertices, triangles


def test_a_long_body_is_solved_in_parts_that_light_falls_on():
    vertices, triangles = strip()
    shape = sg.Shape(vertices, triangles, **SKIN)
    assert 2 <= len(shape.parts) <= 6
    counted = np.concatenate([part.points for part in shape.parts])
    np.testing.assert_array_equal(np.sort(counted), np.arange(len(vertices)))
    shape.exitance(np.where(vertices[:, 0] < -100.0, 1.0, 0.0))
    assert sum(part.is_ready for part in shape.parts) == 1


def test_parts_meet_without_a_seam():
    vertices, triangles = strip()
    # So many along that each mean is over a whole cell.
    x = np.arange(-100.0, 100.0, 0.2)
    points = np.stack([x, np.zeros_like(x), np.full_like(x, 2.0)], 1)
    shape = sg.Shape(vertices, triangles, **SKIN, points=points, normals=np.tile([0.0, 0.0, 1.0], (len(x), 1)))
    assert len(shape.parts) >= 2
    exitance = shape.exitance(np.where(vertices[:, 2] == 0.0, 1.0, 0.0))
    for channel, tolerance in enumerate((0.01, 0.01, 0.02)):
        smooth = np.convolve(exitance[:, channel], np.ones(20) / 20.0, "valid")
        np.testing.assert_allclose(smooth, smooth.mean(), rtol=tolerance)


def test_light_fades_where_flesh_gets_thick():
    vertices, triangles = wedge()
    row = np.flatnonzero((vertices[:, 1] == 0.0) & (vertices[:, 2] > 0.0))
    row = row[np.argsort(vertices[row, 2])]
    thick = vertices[row, 2]
    up = np.tile([0.0, 0.0, 1.0], (len(row), 1))
    shape = sg.Shape(vertices, triangles, **SKIN, max_thickness_mm=8.0, points=vertices[row], normals=up)
    red = shape.exitance(np.where(vertices[:, 2] == 0.0, 1.0, 0.0))[:, 0]
    assert (red[(thick > 24.0) & (thick < 30.0)] == 0.0).all()  # there no light is looked for
    seen = np.flatnonzero((red > 0.025 * red[0]) & (thick < 24.0))
    assert (red[seen + 1] > 0.3 * red[seen]).all()


def test_the_foot_of_a_lobe_is_as_thin_as_the_lobe():
    # A plate that stands on a thick block: in the corner between the two, light that comes through the plate comes
    # out, though the flesh along the normal is deep.
    vertices, triangles = bodies.plate(40.0, 40.0, 20)
    sheet = vertices * [1.0, 0.075, 1.0] + [0.0, 0.0, 39.0]
    body = (np.concatenate([vertices, sheet]), np.concatenate([triangles, triangles + len(vertices)]))
    foot = np.array([[0.0, 1.6, 40.0], [4.0, 1.7, 40.0], [-5.0, 1.8, 40.0]])
    shape = sg.Shape(*body, **SKIN, max_thickness_mm=8.0, points=foot, normals=np.tile([0.0, 0.0, 1.0], (3, 1)))
    assert sum(len(part.points) for part in shape.parts) == len(foot)
    light = np.where((body[0][:, 1] < -1.0) & (np.arange(len(body[0])) >= len(vertices)), 1.0, 0.0)
    assert (shape.exitance(light)[:, 0] > 0.01).all()


def test_vertices_between_parts_belong_to_one_on_any_number_of_threads():
    vertices, triangles = strip()
    # A second strip above: light goes from skin to skin, over the seams.
    both = np.concatenate([vertices, vertices * [1.0, 1.0, -1.0] + [0.0, 0.0, 9.0]])
    faces = np.concatenate([triangles, triangles[:, ::-1] + len(vertices)])
    upper = np.flatnonzero(np.isclose(both[:, 2], 2.0) & (both[:, 1] == 0.0) & (np.abs(both[:, 0]) < 110.0))
    assert len(upper) > 40
    where = {"points": both[upper], "normals": np.tile([0.0, 0.0, 1.0], (len(upper), 1))}
    lights = [sg.Light("SUN", direction=(0.0, 0.0, 1.0), power=1.0)]
    one, three = (sg.Shape(both, faces, **SKIN, **where, threads=n).light(lights).exitance for n in (1, 3))
    np.testing.assert_array_equal(one, three)
