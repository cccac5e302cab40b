"""Irradiance per vertex by the core, against vectorized numpy; culling against all lights; growth.

Run: python tests/benchmarks/irradiance_against_numpy.py     Prints medians and ratios of one run, pair by pair.
The numpy version leaves out what is hard to write without branches, the cut of an area light at a face's horizon, so
it does less than the core; points at which the two differ for that reason alone are not compared.
"""

import statistics
import time

import numpy as np
import skinglow as sg

rng = np.random.default_rng(1)
SIZE = (0.5, 0.3)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def sphere(count, radius=0.1):
    """A ball of about that many vertices, ring by ring, as meshes mostly have their neighbors near each other."""
    rings = max(2, round((count / 2) ** 0.5))
    theta = np.pi * (np.arange(rings) + 0.5) / rings
    phi = np.pi * np.arange(2 * rings) / rings
    theta, phi = (grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij"))
    normals = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    return normals * radius, normals


def rig(kinds, count, near=1.0, far=3.0, power=50.0):
    lights = []
    for k in range(count):
        position = unit(rng.normal(size=3)) * rng.uniform(near, far)
        aim = -position + rng.normal(size=3) * 0.2
        lights.append(
            sg.Light(
                kinds[k % len(kinds)],
                color=rng.uniform(size=3),
                position=position,
                direction=aim,
                power=power,
                spot_angle=1.2,
                size_x=SIZE[0],
                size_y=SIZE[1],
                tangent=np.cross(aim, [0.3, 0.2, 1.0]),
            )
        )
    return lights


def numpy_edge(start, end, across, along_normal):
    """Half the angle between two corners, times the normal's component across the edge; all arrays (n,)."""
    length = np.sqrt(across)
    angle = np.arctan2(length * (end - start), across + start * end)
    return 0.5 * angle * along_normal / length


def numpy_area(light, points, normals):
    z = unit(np.asarray(light.direction))
    x = unit(light.tangent - np.dot(light.tangent, z) * z)
    frame = np.stack([x, np.cross(z, x), z], axis=1)
    p, n = (points - light.position) @ frame, normals @ frame
    a, b, h = SIZE[0] / 2, SIZE[1] / 2, p[:, 2]
    x0, x1, y0, y1 = -a - p[:, 0], a - p[:, 0], -b - p[:, 1], b - p[:, 1]
    total = numpy_edge(x0, x1, h * h + y0 * y0, h * n[:, 1] + y0 * n[:, 2])
    total -= numpy_edge(x0, x1, h * h + y1 * y1, h * n[:, 1] + y1 * n[:, 2])
    total += numpy_edge(y0, y1, h * h + x0 * x0, h * n[:, 0] + x0 * n[:, 2])
    total -= numpy_edge(y0, y1, h * h + x1 * x1, h * n[:, 0] + x1 * n[:, 2])
    return np.where(h > 0, np.maximum(total, 0), 0) / (np.pi * 4 * a * b)


def numpy_ball(light, points, normals):
    offset = light.position - points
    distance_sq = np.einsum("ij,ij->i", offset, offset)
    distance = np.sqrt(distance_sq)
    value = np.maximum(np.einsum("ij,ij->i", offset, normals) / distance, 0) / (4 * np.pi * distance_sq)
    if light.kind == "SPOT":
        edge = np.cos(light.spot_angle / 2)
        t = (-(offset @ unit(light.direction)) / distance - edge) / (light.spot_blend * (1 - edge))
        t = np.clip(t, 0, 1)
        value *= t * t * (3 - 2 * t)
    return value


def numpy_irradiance(lights, points, normals):
    total = np.zeros_like(points)
    for light in lights:
        if light.kind == "SUN":
            value = np.maximum(-(normals @ unit(light.direction)), 0)
        elif light.kind == "AREA":
            value = numpy_area(light, points, normals)
        else:
            value = numpy_ball(light, points, normals)
        total += value[:, None] * (light.color * light.power)
    return total


def medians(variants, rounds):
    """Each variant in turn, so that a drift of the machine's speed meets all alike."""
    times = {name: [] for name in variants}
    for _ in range(rounds):
        for name, variant in variants.items():
            start = time.perf_counter()
            variant()
            times[name].append(time.perf_counter() - start)
    return times


def compare(title, lights, count, rounds, against=True):
    points, normals = sphere(count)
    variants = {
        "skinglow, all processors": lambda: sg.surface_irradiance(lights, points, normals),
        "skinglow, 1 thread": lambda: sg.surface_irradiance(lights, points, normals, threads=1),
    }
    if against:
        variants["numpy"] = lambda: numpy_irradiance(lights, points, normals)
    times = medians(variants, rounds)
    print(f"\n{title}: {len(points):,} vertices x {len(lights):,} lights, {rounds} rounds")
    # Against one thread of ours, since numpy has one.
    ours = times["skinglow, 1 thread"]
    for name, taken in times.items():
        ratio = statistics.median(other / own for other, own in zip(taken, ours, strict=True))
        print(f"  {name:26} {statistics.median(taken) * 1e3:9.2f} ms   {ratio:6.2f} x")


def check_equal():
    lights = rig(("POINT", "SPOT", "SUN", "AREA"), 16)
    points, normals = sphere(2000)
    ours, other = sg.surface_irradiance(lights, points, normals), numpy_irradiance(lights, points, normals)
    # Without the cut an area light gives a little less, in the narrow band where its horizon runs through it.
    same = np.isclose(ours, other, rtol=1e-9, atol=1e-12).all(axis=1)
    assert same.mean() > 0.3 and (ours >= other - 1e-9).all()
    no_areas = [light for light in lights if light.kind != "AREA"]
    np.testing.assert_allclose(
        sg.surface_irradiance(no_areas, points, normals),
        numpy_irradiance(no_areas, points, normals),
        rtol=1e-12,
        atol=1e-15,
    )


def culling(count=10_000, matter=100):
    kinds = ("POINT", "SPOT", "AREA")
    lights = rig(kinds, matter, power=100) + rig(kinds, count - matter, near=20, far=200, power=0.5)
    rng.shuffle(lights)
    low, high = np.full(3, -0.1), np.full(3, 0.1)
    whole = sg.object_irradiance(lights, (0, 0, 0))
    tolerance = 1e-3 * whole.max()
    tree = sg.PreparedRig(lights)
    result = tree.cull(low, high, tolerance)
    kept = [lights[k] for k in result["kept"]]
    points, normals = sphere(2000)
    lost = abs(sg.surface_irradiance(lights, points, normals) - sg.surface_irradiance(kept, points, normals)).max()
    print(f"\nculling {count:,} lights at 1e-3: {len(kept)} kept, bound {result['bound'].max() / whole.max():.2e},")
    print(f"  largest loss found {lost / whole.max():.2e}, groups left out {len(result['dropped'])}")
    variants = {
        "cull + kept lights": lambda: sg.surface_irradiance(
            [lights[k] for k in tree.cull(low, high, tolerance)["kept"]], points, normals
        ),
        "kept lights alone": lambda: sg.surface_irradiance(kept, points, normals),
        "all lights": lambda: sg.surface_irradiance(lights, points, normals),
        "cull alone": lambda: tree.cull(low, high, tolerance),
        "tree made anew": lambda: sg.PreparedRig(lights),
    }
    times = medians(variants, 5)
    for name, taken in times.items():
        print(f"  {name:26} {statistics.median(taken) * 1e3:9.2f} ms   ({len(points):,} vertices)")


if __name__ == "__main__":
    check_equal()
    compare("mixed lights", rig(("POINT", "SPOT", "SUN", "AREA"), 16), 100_000, 9)
    for kind in ("POINT", "SPOT", "SUN", "AREA"):
        compare(kind, rig((kind,), 16), 100_000, 5)
    compare("many lights", rig(("POINT", "SPOT", "SUN", "AREA"), 1000), 100_000, 1)
    for count in (1_000, 10_000, 1_000_000):
        compare("growth with vertices", rig(("POINT", "SPOT", "SUN", "AREA"), 16), count, 3, against=False)
    for count in (4, 64, 256):
        compare("growth with lights", rig(("POINT", "SPOT", "SUN", "AREA"), count), 100_000, 3, against=False)
    culling()
