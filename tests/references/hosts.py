"""What hosts need: colors, choice of elements, files."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import skinglow as sg

from tests.references.bodies import plate
from tests.references.reference import generator, held_against, of_largest, relative

DATA = Path(__file__).resolve().parents[1] / "data"


@held_against("ITU-R BT.709-6", "luminance", domain="500 colors, some negative", limit=1e-15)
def luminances() -> float:
    colors = generator(51).normal(size=(500, 3))
    return of_largest(sg.luminance(colors), np.maximum(colors @ (0.2126, 0.7152, 0.0722), 0.0))


@held_against("Lambert's law, over the hemisphere by 64 nodes", "diffuse_radiance", domain="0 to 10", limit=1e-14)
def radiances() -> float:
    exitance = np.linspace(0.0, 10.0, 50)
    node, weight = np.polynomial.legendre.leggauss(64)
    projected = 2 * np.pi * (0.5 * (node + 1)) @ (0.5 * weight)
    return of_largest(sg.diffuse_radiance(exitance) * projected, exitance)


@held_against("counted one by one", "visible_entries", domain="exponential tables", limit=0.0)
def entries() -> float:
    worst = 0
    for rate in (0.1, 1.0, 7.0):
        table = np.exp(-rate * np.linspace(0, 12, 256))[:, None] * (1.0, 0.5, 0.2)
        count = max(i + 1 for i in range(256) if table[i, 0] > 1 / 255)
        worst = max(worst, abs(sg.visible_entries(table) - count))
    return float(worst)


@held_against("one in each of equal strata", "stratified_indices", domain="1 to 10,000 of 20,000", limit=0.0)
def strata() -> float:
    outside = 0
    for samples in (1, 7, 100, 10_000):
        found = sg.stratified_indices(20_000, samples)
        outside += int((found * samples // 20_000 != np.arange(samples)).sum())
    return float(outside)


@held_against(
    "the factor they were scaled by", "uniform_scale", domain="100 turned, moved and scaled clouds", limit=1e-12
)
def scales() -> float:
    rng, worst = generator(52), 0.0
    for _ in range(100):
        points, factor = rng.normal(size=(20, 3)), 10.0 ** rng.uniform(-3, 3)
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        found = sg.uniform_scale(points, factor * points @ turn.T)
        worst = max(worst, np.inf if found is None else relative(found, factor))
    return worst


@held_against("the sign of a determinant", "is_mirrored", domain="100 turned and mirrored clouds", limit=0.0)
def mirrors() -> float:
    rng, wrong = generator(55), 0
    for _ in range(100):
        points, turn = rng.normal(size=(8, 3)), np.linalg.qr(rng.normal(size=(3, 3)))[0]
        wrong += sg.is_mirrored(points, points @ turn.T) != (np.linalg.det(turn) < 0.0)
    return float(wrong)


@held_against("two powers of one light", "irradiance_difference", domain="20 lights about a box", limit=1e-12)
def differences() -> float:
    rng, worst, box = generator(54), 0.0, ((-1, -1, -1), (1, 1, 1))
    for factor in rng.uniform(0.2, 3.0, 20):
        bright, dim = (sg.Light(position=(0, 5, 1), power=power) for power in (1.0, factor))
        apart = sg.irradiance_difference(*(sg.SurfaceLighting([light], *box) for light in (dim, bright)), *box)
        worst = max(worst, abs(apart - abs(factor - 1.0)))
    return worst


@held_against("matrix products, in numpy", "Light.moved", domain="100 rotations and translations", limit=1e-13)
def motions() -> float:
    rng, worst = generator(53), 0.0
    for _ in range(100):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        motion = np.eye(4)
        motion[:3, :3], motion[:3, 3] = turn, rng.normal(size=3)
        light = sg.Light("AREA", position=rng.normal(size=3), direction=rng.normal(size=3), tangent=rng.normal(size=3))
        moved = light.moved(motion)
        worst = max(
            worst,
            of_largest(moved.position, turn @ light.position + motion[:3, 3]),
            of_largest(moved.direction, turn @ light.direction),
            of_largest(moved.tangent, turn @ light.tangent),
        )
    return worst


@held_against("the file's numbers, by Python's json", "read_light_rig", "LightRig", domain="table1.json", limit=0.0)
def rigs() -> float:
    rig, written = sg.read_light_rig(DATA / "table1.json"), json.loads((DATA / "table1.json").read_text())
    worst = 0.0
    for light, told in zip(rig.lights, written["lights"], strict=True):
        worst = max(
            worst,
            relative(light.color, np.array(told["color_bytes"]) / 255.0),
            relative(light.position, told["position"]),
        )
    return worst


@held_against("positions, read back from the text", "povray_files", domain="a plate, with a table", limit=1e-7)
def scenes() -> float:
    vertices, triangles = plate(20.0, 3.0, 4)
    files = sg.povray_files(
        vertices,
        triangles,
        np.linspace(0, 1, len(vertices)),
        camera_matrix=np.eye(4),
        resolution=(8, 8),
        angle_x=0.7,
        base=sg.BaseLut([1.0, 0.5], 12.0),
    )
    text = next(content for content in files.values() if "vertex_vectors" in content)
    block = text[text.index("vertex_vectors") :]
    numbers = re.findall(r"<([^<>]*)>", block)[: len(vertices)]
    return of_largest([[float(x) for x in each.split(",")] for each in numbers], vertices)


@held_against(
    "the macros of povray_macros, and the names of the files",
    "povray_macros",
    "povray_frame_choice",
    domain="the macros; two frames",
    limit=0.0,
)
def texts() -> float:
    macros = Path(__file__).resolve().parents[2] / "povray_macros"
    own = [path.read_text() for path in macros.glob("*.inc")]
    choice = sg.povray_frame_choice([(1, "a.inc"), (5, "b.inc")])
    wrong = sum(line not in sg.povray_macros() for text in own for line in text.splitlines() if "#macro" in line)
    return float(wrong + ("a.inc" not in choice) + ("b.inc" not in choice))
