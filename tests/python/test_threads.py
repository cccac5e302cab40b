"""Everything that runs on several threads: the same on 1, 2 and 8, stopped in the middle, and all at once."""

from __future__ import annotations

import inspect
import os
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import shape_bodies as bodies
import skinglow as sg
from tile_reading import of_triangles

BODY = bodies.lobe(levels=3)
NORMALS = bodies.vertex_normals(BODY)
LIGHTS = [
    sg.Light("POINT", position=(0.0, 5.0, 60.0), power=1000.0, radius=3.0, color=(1.0, 0.5, 0.2)),
    sg.Light("SUN", direction=(0.0, 0.6, -0.8), power=2.0, sun_angle=0.01),
    sg.Light("AREA", position=(0, 0, 40), direction=(0, 0, -1), power=500.0, size_x=5.0, size_y=4.0, spread=2.0),
]
IRRADIANCE = np.arange(float(len(BODY[0])))
SKIN = sg.TISSUE_PRESETS["light"]
SCENE = sg.Occluders([BODY, bodies.plate(30.0, 1.0, 6)])
LAYOUT = sg.FaceTiles(*(mesh := of_triangles(*bodies.lobe(levels=5))))
SHOWN = mesh.vertices, mesh.triangles, LAYOUT.texels[mesh.fans], LAYOUT.height

Call = Callable[..., Any]


def shape(threads: int, progress: Call | None = None) -> sg.Shape:
    return sg.Shape(*BODY, sg.Tissue(), cell_mm=1.2, threads=threads, progress=progress)


def lit(threads: int, progress: Call | None = None) -> np.ndarray:
    answer = shape(threads).light(LIGHTS, occluders=SCENE, excluded=[0], shadow_samples=4, progress=progress)
    return np.concatenate([answer.exitance, answer.error])


def recolored(threads: int, progress: Call | None = None) -> np.ndarray:
    return shape(threads).light(2 * LIGHTS, reentries=1).recolor(np.eye(6)[:, :3], progress=progress)


def relit(threads: int, progress: Call | None = None) -> np.ndarray:
    before = shape(threads)
    first = before.light(LIGHTS, reentries=0)
    motion = np.eye(4)
    motion[1, 3] = 3.0
    moved = [LIGHTS[0].moved(motion), *LIGHTS[1:]]
    return before.light(moved, reentries=0, previous=first, progress=progress).exitance


def points_of_shape(threads: int, progress: Call | None = None) -> np.ndarray:
    at = sg.Shape(*BODY, sg.Tissue(), cell_mm=1.2, threads=threads, points=0.99 * BODY[0], normals=NORMALS)
    return at.exitance(IRRADIANCE, progress=progress)


def thickness(threads: int, progress: Call | None = None) -> np.ndarray:
    return sg.thickness(*BODY, rays=64, min_sky_visibility=0.05, threads=threads, progress=progress)


#: With progress, by which they can be stopped.
LONG: dict[str, Call] = {
    "thickness": thickness,
    "thickness_report": lambda n, p=None: sg.thickness_report(*BODY, threads=n, progress=p).no_far_side,
    "Shape": lambda n, p=None: [part.points for part in shape(n, p).parts],
    "Shape.exitance": lambda n, p=None: shape(n).exitance(IRRADIANCE, progress=p),
    "Shape.exitance_error": lambda n, p=None: shape(n).exitance_error(IRRADIANCE, progress=p),
    "Shape.light": lit,
    "Shape.light of moved lights": relit,
    "Shape at points": points_of_shape,
    "LitShape.recolor": recolored,
}
SHORT: dict[str, Call] = {
    "visible_fraction": lambda n: SCENE.visible_fraction(LIGHTS, BODY[0], NORMALS, threads=n).at_points,
    "surface_irradiance": lambda n: sg.surface_irradiance(LIGHTS, BODY[0], NORMALS, threads=n),
    "far_side_irradiance": lambda n: sg.far_side_irradiance(LIGHTS, *BODY[:1], NORMALS, 1.0, threads=n),
    "transmittance": lambda n: sg.transmittance(SKIN, [0.5, 2.0, 7.0], sg.SAMPLE_WAVELENGTHS_NM, threads=n),
    "base_lut": lambda n: sg.base_lut(SKIN, 32, threads=n).matrices,
    "base_lut_report": lambda n: sg.base_lut_report(SKIN, 32, threads=n)[0].matrices,
    "reference_lut": lambda n: sg.reference_lut(SKIN, 16, streams=8, threads=n).matrices,
}
PARALLEL = LONG | SHORT


def tiles() -> list[np.ndarray]:
    targets = sg.TileTargets(*SHOWN)
    return [targets.of_texel, targets.points, targets.spread(targets.points)]


def assert_same(one: Any, other: Any) -> None:  # noqa: ANN401
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def takes_threads(call: Any) -> bool:  # noqa: ANN401
    try:
        return bool({"threads", "progress"} & inspect.signature(call).parameters.keys())
    except ValueError:  # compiled: the first line of its docstring is its signature
        return "threads: " in (call.__doc__ or "").split("\n")[0]


def test_all_functions_with_threads_or_progress_are_here() -> None:
    """Who adds one adds it to this file."""
    found = set()
    for name in sg.__all__:
        public = getattr(sg, name)
        if isinstance(public, type):
            found |= {f"{name}.{own}" for own, call in vars(public).items() if callable(call) and takes_threads(call)}
        elif callable(public) and takes_threads(public):
            found.add(name)
    covered = {"Shape.__init__", "Occluders.visible_fraction", *PARALLEL} & found
    assert found - covered == set()
    assert len(found) > 12


@pytest.mark.parametrize("name", PARALLEL)
def test_the_same_to_the_last_bit_on_any_number_of_threads(name: str) -> None:
    expected = PARALLEL[name](1)
    for threads in (2, 8):
        assert_same(PARALLEL[name](threads), expected)


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system lets no process choose its processors")
def test_tiles_are_the_same_on_any_number_of_processors() -> None:
    expected = tiles()
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        assert_same(tiles(), expected)
    finally:
        os.sched_setaffinity(0, before)


class StoppedByHostError(Exception):
    pass


def test_a_call_is_stopped_at_any_time_by_what_progress_returns_or_raises() -> None:
    """In the middle of each, on one thread and on eight, as often as it tells of itself; then it still works."""
    for call in LONG.values():
        for threads in (1, 8):
            told: list[float] = []
            expected = call(threads, lambda done, told=told: told.append(done) or True)
            assert told == sorted(told)
            assert 0.0 <= told[0] <= told[-1] <= 1.0
            for stop in sorted({1, max(1, len(told) // 2)}):
                seen: list[float] = []

                def raising(done: float, seen: list[float] = seen, stop: int = stop) -> bool:
                    seen.append(done)
                    if len(seen) == stop:
                        raise StoppedByHostError
                    return True

                # A quicker machine may be through before the `stop`th telling.
                try:
                    call(threads, raising)
                except StoppedByHostError:
                    assert len(seen) == stop, "nothing is told after progress raised"
            with pytest.raises(RuntimeError, match="cancelled"):
                call(threads, lambda done: False)
            assert_same(call(threads), expected)


def test_what_a_thread_refuses_reaches_the_caller_and_nothing_hangs() -> None:
    """Refusals that are found within the parallel part, at the last of many points."""
    points = np.tile([1.0, 0.0, 0.0], (20_000, 1))
    points[-1] = np.nan
    for threads in (1, 2, 8):
        with pytest.raises(ValueError, match=r"19999|finite"):
            sg.surface_irradiance(LIGHTS, points, points, threads=threads)
        with pytest.raises(ValueError, match=r"19999|finite"):
            SCENE.visible_fraction(LIGHTS, points, points, threads=threads)


def test_two_python_threads_call_everything_at_once() -> None:
    """Objects that are shared, and calls that are not: each has its own answer."""
    one_shape = shape(0)
    shared = PARALLEL | {
        "one shape": lambda n: one_shape.light(LIGHTS, reentries=1).exitance,
        "one shape, other light": lambda n: one_shape.exitance(IRRADIANCE),
        "tiles": lambda n: np.concatenate([part.ravel() for part in tiles()]),
    }
    expected = {name: call(1) for name, call in shared.items()}
    failures: list[BaseException] = []
    start = threading.Barrier(2)

    def work(order: list[str]) -> None:
        try:
            start.wait()
            for name in order:
                assert_same(shared[name](2), expected[name])
        except BaseException as failure:
            failures.append(failure)

    names = list(shared)
    both = [threading.Thread(target=work, args=(order,)) for order in (names, names[::-1])]
    for each in both:
        each.start()
    for each in both:
        each.join()
    assert not failures, failures
