"""What is seen from a body that moves: lights moved into its frame, occluders that stay in theirs."""

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg

LIGHTS = [
    sg.Light("POINT", (1.0, 0.7, 0.4), (0.2, 0.1, 0.3), power=5.0, radius=0.05, name="key"),
    sg.Light("SUN", (0.2, 0.4, 1.0), direction=(0.3, 0.2, -1.0), sun_angle=0.3),
    sg.Light("SPOT", (0.5, 1.0, 0.5), (0.3, 0.0, 0.4), (-0.6, 0.1, -0.9), 8.0, spot_angle=1.2, spot_blend=0.4),
    sg.Light(
        "AREA", (1, 1, 1), (0.0, 0.3, 0.5), (0.1, -0.5, -1.0), 9.0, size_x=0.5, size_y=0.1, tangent=(1.0, 1.0, 0.2)
    ),
    sg.Light(
        "AREA", (1, 1, 1), (0.3, -0.2, 0.5), (0, 0.2, -1), area_shape="ELLIPSE", size_x=0.4, size_y=0.2, spread=1.5
    ),
]


def rotation(x: float, y: float, z: float) -> np.ndarray:
    result = np.eye(3)
    for axis, angle in enumerate((x, y, z)):
        turn = np.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn[i, i] = turn[j, j] = np.cos(angle)
        turn[j, i], turn[i, j] = np.sin(angle), -np.sin(angle)
        result = turn @ result
    return result


def motion(turn: np.ndarray, offset: tuple[float, float, float]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = offset
    return matrix


@pytest.mark.parametrize("light", LIGHTS, ids=lambda light: light.kind)
@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_a_moved_light_lights_a_moved_surface_as_before(light: sg.Light, mirror: float) -> None:
    rng = np.random.default_rng(3)
    points, normals = 0.1 * rng.normal(size=(50, 3)), rng.normal(size=(50, 3)) + [0, 0, 2]
    turn = rotation(0.4, 1.1, -2.0) @ np.diag([mirror, 1.0, 1.0])
    offset = (3.0, -20.0, 0.5)
    moved = light.moved(motion(turn, offset))
    before = sg.surface_irradiance([light], points, normals)
    after = sg.surface_irradiance([moved], points @ turn.T + offset, normals @ turn.T)
    assert before.max() > 0
    # Of areas the integral is good to a tolerance.
    assert np.allclose(after, before, rtol=1e-3 if light.kind == "AREA" else 1e-9, atol=1e-4 * before.max())
    same = [name for name in dir(light) if not name.startswith("_") and name != "moved"]
    for name in set(same) - {"position", "direction", "tangent"}:
        assert np.array_equal(getattr(moved, name), getattr(light, name))
    back = moved.moved(np.linalg.inv(motion(turn, offset)))
    for name in ("position", "direction", "tangent"):
        assert np.allclose(getattr(back, name), getattr(light, name), atol=1e-12)


def test_a_body_among_occluders_of_another_frame() -> None:
    vertices, triangles = bodies.lobe(levels=3)
    shape = sg.Shape(
        vertices * 1e-3,
        triangles,
        absorption=[0.03, 0.2, 0.5],
        reduced_scattering=1.0,
        refractive_index=1.0,
        unit_mm=1000.0,
    )
    lights = [sg.Light("POINT", (1, 1, 1), (0.0, 0.0, 0.3), power=5.0), sg.Light("SUN", direction=(0.3, 0.0, 1.0))]
    corners = np.array([(-0.02, -0.02, 0.05), (0.001, -0.02, 0.05), (0.001, 0.02, 0.05), (-0.02, 0.02, 0.05)])
    faces = [[0, 1, 2], [0, 2, 3]]
    expected = shape.light(lights, sg.Environment([0.1, 0.2, 0.3]), sg.Occluders([(corners, faces)]))
    free = shape.light(lights, sg.Environment([0.1, 0.2, 0.3]))
    assert expected.exitance.sum() < 0.9 * free.exitance.sum()
    frame = motion(rotation(0.3, -0.8, 1.5), (40.0, -3.0, 7.0))
    scene = sg.Occluders([(corners @ frame[:3, :3].T + frame[:3, 3], faces)])
    found = shape.light(lights, sg.Environment([0.1, 0.2, 0.3]), scene, occluder_frame=frame)
    scale = expected.exitance.mean()
    assert np.abs(found.exitance - expected.exitance).mean() < 1e-3 * scale
    # Carried away from the occluders, with lights that go along: what was found amid them is of no use.
    away = shape.light(lights, sg.Environment([0.1, 0.2, 0.3]), scene, previous=found, occluder_frame=np.eye(4))
    assert np.abs(away.exitance - free.exitance).mean() < 1e-3 * scale


@pytest.mark.parametrize(
    ("matrix", "words"),
    [
        (np.diag([2.0, 1, 1, 1]), "a rotation and a translation"),
        (np.full((4, 4), np.nan), "nan"),
        (motion(np.eye(3), (np.inf, 0.0, 0.0)), "inf"),
        (np.diag([1.0, 1, 1, 2]), "a rotation and a translation"),
        (np.eye(3), r"of shape \(3, 3\); allowed: shape \(4, 4\)"),
    ],
)
def test_motions_that_are_not_rigid_are_refused(matrix: np.ndarray, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        LIGHTS[0].moved(matrix)
    shape = sg.Shape(*bodies.ball(2.0, 1))
    with pytest.raises(ValueError, match=words):
        shape.light([], occluder_frame=matrix)
