"""The same glow by Cycles and by POV-Ray, both as linear EXR: not mirrored, pixel on pixel, edges left out."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import skinglow as sg
from hosts import HOSTS, Host
from povray_runs import run, write

SCRIPT = Path(__file__).with_name("blender_glow_scene.py")
LIGHTS = [
    sg.Light("POINT", (1, 0.44, 0.27), (0.92, 0, 0)),
    sg.Light("POINT", (0.06, 0.25, 1), (0, -0.51, 0.68)),
]
BASE = sg.BaseLut(np.exp(-np.linspace(0, 4.8, 256)), 12)
ALLOWED = 1 / 255


def blender(host: Host, folder: Path, job: dict) -> np.ndarray:
    """Runs the script with a job; the picture that it left, (height, width, 3)."""
    folder.mkdir(exist_ok=True)
    (folder / "job.json").write_text(json.dumps(job))
    host.require()
    done = subprocess.run(host.command(SCRIPT, [str(folder)]), capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr[-1000:]
    return np.load(folder / "picture.npy").astype(float)


def both(tmp_path: Path, host: Host, **job) -> tuple[np.ndarray, np.ndarray]:
    """The picture by Blender and by POV-Ray."""
    weight = np.array([1.8, 0.5, 0.4]) + sg.light_weight(LIGHTS, (0, 0, 0))
    job = dict(table=sg.recolor(BASE, weight).tolist(), **job)
    by_blender = blender(host, tmp_path, job)
    with np.load(tmp_path / "scene.npz") as scene:
        files = sg.povray_files(
            scene["vertices"], scene["triangles"], scene["lut_u"], base=BASE, lights=LIGHTS,
            camera_matrix=scene["camera_matrix"], projection=scene["projection"],
            resolution=job["resolution"],
        )  # fmt: skip
    write(tmp_path, files)
    run(tmp_path, "scene.ini", *(["-A"] if job["samples"] == 1 else []))
    reading = tmp_path / "reading"
    reading.mkdir()
    shutil.copy(tmp_path / "scene.exr", reading)
    return by_blender, blender(host, reading, {"read": "scene.exr"})


def away_from_edges(picture: np.ndarray) -> np.ndarray:
    """Pixels whose eight neighbors all show skin."""
    covered = np.pad(picture.sum(axis=2) > 0, 1)
    height, width = picture.shape[:2]
    inside = np.ones((height, width), bool)
    for y in range(3):
        for x in range(3):
            inside &= covered[y : y + height, x : x + width]
    return inside


def rms(difference: np.ndarray) -> float:
    return float(np.sqrt(np.mean(difference**2)))


@pytest.mark.parametrize("host", HOSTS, ids=lambda host: host.name)
@pytest.mark.parametrize(
    ("camera", "resolution"), [("PERSP", [320, 240]), ("PERSP", [180, 260]), ("ORTHO", [260, 180])]
)
def test_middles_of_pixels(tmp_path, host, camera, resolution):
    """One sample at the center of each pixel, so that silhouettes too can be compared."""
    found, expected = both(tmp_path, host, camera=camera, resolution=resolution, samples=1)[::-1]
    inside = away_from_edges(expected)
    assert inside.mean() > 0.15
    assert np.ptp(expected[inside], axis=0).min() > 0.2  # a picture with something in it
    difference = rms((found - expected)[inside])
    print(f"Blender {host.name}, {camera} {resolution}: RMS {difference:.2e}")
    assert difference <= ALLOWED / 20  # POV-Ray's EXR has half floats: about 1e-4 of the value
    assert np.abs(found - expected)[inside].max() <= ALLOWED
    covered = [np.count_nonzero(p.sum(axis=2)) for p in (found, expected)]
    assert np.count_nonzero((found.sum(axis=2) > 0) != (expected.sum(axis=2) > 0)) <= 3, covered
    # The comparison would see a mirrored picture, or one that is a pixel off.
    for wrong in (found[:, ::-1], found[::-1], np.roll(found, 1, 0), np.roll(found, 1, 1)):
        assert rms((wrong - expected)[inside]) > ALLOWED


@pytest.mark.parametrize("host", HOSTS, ids=lambda host: host.name)
def test_antialiased(tmp_path, host):
    """As the scene is emitted: nine samples a pixel in POV-Ray, 64 in a box filter in Cycles."""
    expected, found = both(tmp_path, host, camera="PERSP", resolution=[320, 240], samples=64)
    difference = rms((found - expected)[away_from_edges(expected)])
    print(f"Blender {host.name}, antialiased: RMS {difference:.2e}")
    assert difference <= ALLOWED
    assert rms(found - expected) <= 2 * ALLOWED  # edges too
