"""Shadow rays a second by skinglow.Occluders against Moeller and Trumbore in numpy, and error by samples.

`python tests/benchmarks/occlusion_against_numpy.py` prints both as tables, which are in docs/accuracy.md.
"""

import time

import numpy as np
import skinglow as sg


def ball(rings):
    t, p = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1), indexing="ij")
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1)
    index = np.arange(t.size).reshape(t.shape)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    triangles = np.concatenate([np.stack(x, -1).reshape(-1, 3) for x in ((a, b, c), (a, c, d))])
    return points.reshape(-1, 3), triangles


def moeller_trumbore(vertices, triangles, start, end):
    """Whether each ray meets any triangle, with one numpy expression for all triangles of a ray."""
    a = vertices[triangles[:, 0]]
    e1, e2 = vertices[triangles[:, 1]] - a, vertices[triangles[:, 2]] - a
    hits = np.zeros(len(start), bool)
    with np.errstate(divide="ignore", invalid="ignore"):
        for i, (here, there) in enumerate(zip(start, end, strict=True)):
            d = there - here
            p = np.cross(d, e2)
            det = np.einsum("ij,ij->i", e1, p)
            s = here - a
            u = np.einsum("ij,ij->i", s, p) / det
            q = np.cross(s, e1)
            v, w = q @ d / det, np.einsum("ij,ij->i", e2, q) / det
            hits[i] = ((u > 0) & (v > 0) & (u + v < 1) & (w > 0) & (w < 1)).any()
    return hits


def best_of(function, repeats=3):
    times = []
    for _ in range(repeats):
        started = time.perf_counter()
        result = function()
        times.append(time.perf_counter() - started)
    return min(times), result


def speed():
    random = np.random.default_rng(1)
    position = np.array((0.0, 0.0, 4.0))
    print("| triangles | skinglow, rays/s (one thread) | numpy, rays/s | ratio | building, ms | rays that differ |")
    print("| --- | --- | --- | --- | --- | --- |")
    for rings in (16, 64, 256):
        vertices, triangles = ball(rings)
        points = random.uniform(-3, 3, (20000, 3)) * (1, 1, 0) - (0, 0, 2)
        building, scene = best_of(lambda mesh=(vertices, triangles): sg.Occluders([mesh]))
        light = sg.Light(position=position)
        ours, found = best_of(
            lambda s=scene, p=points, m=light: s.visible_fraction([m], p, position - p, threads=1).at_points[:, 0]
        )
        few = max(20, 2_000_000 // len(triangles) // 4)
        theirs, hits = best_of(
            lambda v=vertices, t=triangles, p=points[:few]: moeller_trumbore(
                v, t, p, np.broadcast_to(position, p.shape)
            ),
            1,
        )
        rate, other = len(points) / ours, few / theirs
        differ = int(np.sum((found[:few] == 0) != hits))
        print(
            f"| {len(triangles)} | {rate:.3g} | {other:.3g} | {rate / other:.3g} | {1e3 * building:.3g} | "
            f"{differ} of {few} |"
        )


def error():
    """A straight edge across a light, anywhere and at any angle, from one point and from 256."""
    random = np.random.default_rng(2)
    lights = {
        "disk": dict(kind="AREA", area_shape="DISK", size_x=1.0, size_y=1.0, position=(0, 0, 2)),
        "rectangle": dict(kind="AREA", area_shape="RECTANGLE", size_x=1.0, size_y=0.5, position=(0, 0, 2)),
        "ball": dict(kind="POINT", radius=0.5, soft_falloff=False, position=(0, 0, 2)),
        "sun": dict(kind="SUN", sun_angle=0.5),
    }
    point = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    skin = random.normal(size=(256, 3)) * 0.05, np.tile((0.0, 0.0, 1.0), (256, 1))
    walls = []
    for turn, shift in zip(random.uniform(0, 2 * np.pi, 40), random.uniform(-0.2, 0.2, 40), strict=True):
        along, across = np.array((np.cos(turn), np.sin(turn), 0)), np.array((-np.sin(turn), np.cos(turn), 0))
        corner = shift * across - 50 * along + (0, 0, 1)
        corners = np.array([corner, corner + 100 * along, corner + 100 * (along + across), corner + 100 * across])
        walls.append(sg.Occluders([(corners, [[0, 1, 2], [0, 2, 3]])]))
    print("| light | rays a point | RMS error, one point | RMS error of the mean, 256 points | ms, 256 points |")
    print("| --- | --- | --- | --- | --- |")
    for name, settings in lights.items():
        light = [sg.Light(**settings)]
        exact = {
            id(p): np.array([w.visible_fraction(light, *p, samples=4096).mean[0] for w in walls]) for p in (point, skin)
        }
        for samples in (1, 4, 16, 64, 256):
            row = [name, str(samples)]
            for p in (point, skin):
                found = np.array([w.visible_fraction(light, *p, samples=samples).mean[0] for w in walls])
                row.append(f"{np.sqrt(np.mean((found - exact[id(p)]) ** 2)):.2g}")
            took, _ = best_of(lambda m=light, n=samples: walls[0].visible_fraction(m, *skin, samples=n, threads=1))
            print("| " + " | ".join([*row, f"{1e3 * took:.2g}"]) + " |")


if __name__ == "__main__":
    speed()
    print()
    error()
