"""Exitance at points of the surface: on an edge the nearest triangle is either, and makes no difference."""

import numpy as np
import shape_bodies as bodies
import skinglow as sg


def test_points_with_smooth_normals_do_not_depend_on_the_triangle_they_are_nearest_to() -> None:
    vertices, triangles = bodies.lobe(levels=3)
    middles = 0.5 * (vertices[triangles[:, 0]] + vertices[triangles[:, 1]])
    corners = vertices[triangles]
    of_triangles = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    of_vertices = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(of_vertices, triangles[:, k], of_triangles)
    of_vertices /= np.linalg.norm(of_vertices, axis=1, keepdims=True)
    normals = of_vertices[triangles[:, 0]] + of_vertices[triangles[:, 1]]
    moved = middles + np.random.default_rng(1).uniform(-5e-4, 5e-4, middles.shape)
    light = [sg.Light("SUN", direction=(0.2, 0.1, 1.0), power=3.0)]
    found, other = (
        sg.Shape(vertices, triangles, cell_mm=1.0, points=points, normals=normals).light(light).exitance
        for points in (middles, moved)
    )
    assert np.sqrt(((found - other) ** 2).mean()) < 0.03 * found.mean()


def test_rounding_of_vertices_changes_nothing_at_targets_of_tiles() -> None:
    vertices, triangles = bodies.lobe(levels=4)
    layout = sg.FaceTiles(vertices, np.full(len(triangles), 3), triangles.ravel())
    light = [sg.Light("SUN", direction=(0.5, -0.3, -1.0), power=7.0)]
    found = []
    for rounding in (0.0, 1e-9):
        moved = vertices + np.random.default_rng(0).uniform(-rounding, rounding, vertices.shape)
        targets = sg.TileTargets(moved, triangles, layout.texels.reshape(-1, 3, 3), layout.height)
        body = sg.Shape(moved, triangles, cell_mm=1.0, points=targets.points, normals=targets.normals)
        found.append(body.light(light).exitance)
    assert np.sqrt(((found[0] - found[1]) ** 2).mean()) < 5e-3 * found[0].mean()


def test_no_points_are_no_points() -> None:
    body = bodies.lobe(levels=2)
    lights = [sg.Light("SUN", direction=(0.2, 0.1, 1.0), power=3.0), sg.Light(position=(0, 0, 30))]
    for none in ({}, {"normals": np.empty((0, 3))}):
        shape = sg.Shape(*body, points=np.empty((0, 3)), **none)
        lit = shape.light(lights, sg.Environment((1.0, 1.0, 1.0)))
        for found in (
            shape.points,
            shape.exitance(np.ones(len(body[0]))),
            shape.exitance_error(np.ones(len(body[0]))),
            lit.exitance,
            lit.transmitted,
            lit.error,
            lit.recolor(np.ones((2, 3))),
            lit.recolor(np.ones((2, 3)), transmitted=True),
            lit.with_tissue(sg.Tissue(blood_fraction=0.01)).exitance,
            shape.light(lights[:1], previous=lit).exitance,
        ):
            assert found.shape == (0, 3)
        assert lit.per_light.shape == (2, 0, 3)
        assert lit.irradiance.shape == body[0].shape
        assert shape.parts == [] and shape.report["points"] == 0
        np.testing.assert_array_equal(lit.report["error"], 0.0)
