"""Other threads of Python run while a call works: about lights, skin and slabs."""

import sys
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
import skinglow as sg

RNG = np.random.default_rng(1)
BOX = ((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1))
ORIGIN = (0.0, 0.0, 0.0)
LIGHTS = [sg.Light(position=p) for p in RNG.normal(size=(50_000, 3)) + 20]
MANY = sg.PreparedRig(LIGHTS)
DISK = {"size_x": 1.0, "size_y": 2.0, "area_shape": "ELLIPSE", "spread": 2.0}
DISKS = sg.PreparedRig([sg.Light("AREA", position=p, direction=-p, **DISK) for p in RNG.normal(size=(2_000, 3)) + 2])
POINTS = RNG.normal(size=(400_000, 3))
COSINES = np.linspace(0.0, 1.0, 400_000)
IMAGE = np.ones((512, 1024, 3))
PIXELS = IMAGE.astype(np.float32)
WORLD = sg.Environment((1.0, 1.0, 1.0))
WEIGHT = sg.AngularWeight([0.0, 1.0], [0.5, 1.0])
SHOWN = sg.SurfaceLighting(MANY, *BOX)
SKIN = sg.TISSUE_PRESETS["light"]
LAYERS = [sg.Layer(1.4, 0.5, 20.0, 0.8, 0.1), sg.Layer(1.5, 0.05, 15.0, 0.8, 3.0)]
CURVE = sg.ThicknessCurve(LAYERS, 1, streams=64)
LONG = sg.six_gaussian_base(65_536, 12.0)

CALLS: dict[str, Callable[[], object]] = {
    "PreparedRig": lambda: sg.PreparedRig(LIGHTS),
    "cull": lambda: MANY.cull(*BOX, 0.0),
    "light_weights": lambda: sg.light_weights(MANY, ORIGIN),
    "light_weight": lambda: sg.light_weight(MANY, ORIGIN),
    "object_irradiance": lambda: sg.object_irradiance(DISKS, ORIGIN),
    "object_irradiance_by_light": lambda: sg.object_irradiance_by_light(DISKS, ORIGIN),
    "object_irradiance_error": lambda: sg.object_irradiance_error(MANY, ORIGIN, *BOX),
    "surface_irradiance": lambda: sg.surface_irradiance(DISKS, POINTS[:50], POINTS[:50]),
    "far_side": lambda: sg.far_side(POINTS, POINTS, 0.1),
    "far_side_irradiance": lambda: sg.far_side_irradiance(DISKS, POINTS[:50], POINTS[:50], 0.1),
    "merge_identical": lambda: sg.merge_identical(MANY),
    "light_report": lambda: sg.light_report(MANY, ORIGIN),
    "SurfaceLighting": lambda: sg.SurfaceLighting(MANY, *BOX),
    "SurfaceLighting.irradiance": lambda: SHOWN.irradiance(POINTS, POINTS),
    "normal_cone": lambda: sg.normal_cone(POINTS),
    "Environment": lambda: sg.Environment(IMAGE),
    "Environment.from_image": lambda: sg.Environment.from_image(PIXELS),
    "Environment.irradiance": lambda: WORLD.irradiance(POINTS),
    "AngularWeight": lambda: sg.AngularWeight(COSINES, COSINES + 0.1),
    "AngularWeight.at": lambda: WEIGHT.at(COSINES),
    "base_lut": lambda: sg.base_lut(SKIN),
    "base_lut_report": lambda: sg.base_lut_report(SKIN),
    "reference_lut": lambda: sg.reference_lut(SKIN, 16, 12.0, 16),
    "transmittance": lambda: sg.transmittance(SKIN, [1.0, 2.0], sg.SAMPLE_WAVELENGTHS_NM),
    "skin_angular_weight": lambda: sg.skin_angular_weight(SKIN),
    "lut_error": lambda: sg.lut_error(LONG, LONG),
    "recolor": lambda: sg.recolor(LONG, (1.0, 0.5, 0.2)),
    "six_gaussian_lookup": lambda: sg.six_gaussian_lookup(65_536, 12.0),
    "six_gaussian_base": lambda: sg.six_gaussian_base(65_536, 12.0),
    "slab": lambda: sg.slab(LAYERS, "diffuse", streams=64),
    "directional_transmittance": lambda: sg.directional_transmittance(LAYERS, streams=64),
    "ThicknessCurve": lambda: sg.ThicknessCurve(LAYERS, 1, streams=64),
    "ThicknessCurve.transmittance": lambda: CURVE.transmittance(COSINES[:1000]),
}


@pytest.fixture
def no_forced_switch() -> Iterator[None]:
    """Python takes the interpreter from nobody: another thread runs only where a call lets go of it."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(100.0)
    yield
    sys.setswitchinterval(before)


@pytest.mark.usefixtures("no_forced_switch")
@pytest.mark.parametrize("name", CALLS)
def test_another_thread_advances(name: str) -> None:
    steps, done = 0, False

    def count() -> None:
        nonlocal steps
        while not done:
            steps += 1
            time.sleep(1e-5)

    other = threading.Thread(target=count)
    other.start()
    while steps == 0:
        time.sleep(1e-3)
    deadline = time.monotonic() + 20.0
    advanced = 0
    # A step may fall between two long holds of it by others: enough that one call lets the thread run.
    while advanced == 0 and time.monotonic() < deadline:
        before = steps
        CALLS[name]()
        advanced = steps - before
    done = True
    other.join()
    assert advanced > 0
