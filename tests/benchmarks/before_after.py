"""Two builds of the Python package against each other, in one run: what is faster, what is slower, and by how much.

    python tests/benchmarks/before_after.py BEFORE AFTER [--rounds 15] [--only CASE...]

BEFORE and AFTER are wheels for the Python that runs this, or folders that hold the package `skinglow`. The wheels that
users get: scripts/package makes them in build/packages. Needs numpy alone.

Each build runs in a process of its own. Both stay alive and take turns at a case, the first of them alternating, so
that whatever else the machine does hits both. A turn is the fastest of several calls. Printed are the medians of the
turns, and the median and the quartiles of before / after over the rounds: above 1 the second build is faster.
"difference" is the largest one between the results, over the largest value. "1 processor": bound to one.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
import zipfile
from pathlib import Path

import numpy as np

#: Seconds that a turn lasts at least, and the calls that it makes at least.
TURN_SECONDS, TURN_CALLS = 0.06, 3
POINTS, LIGHTS = 51_200, 16
WHEN = ("before:", "after:")


class Cases:
    """The cases by name: each method gives a function of no arguments that returns an array.

    Where a name of the package has changed, the new one comes first: the old one would warn.
    """

    #: Cases that use threads, and run twice: bound to one processor, and not.
    THREADED = ("base_lut", "thickness", "occlusion", "surface_all_kinds")

    def __init__(self, sg):
        self.sg = sg
        self.rng = np.random.default_rng(1)

    def named(self, *names, of=None):
        owner = self.sg if of is None else of
        public = getattr(owner, "__all__", None) or dir(owner)
        return getattr(owner, next(name for name in names if name in public))

    def directions(self, count):
        found = self.rng.normal(size=(count, 3))
        return found / np.linalg.norm(found, axis=1, keepdims=True)

    def lights(self, *kinds, count=LIGHTS, radius=0.0):
        made = []
        for k in range(count):
            position = self.directions(1)[0] * self.rng.uniform(1.0, 3.0)
            aim = -position + 0.2 * self.rng.normal(size=3)
            fields = {"power": 50.0, "color": self.rng.uniform(size=3), "position": position, "direction": aim}
            fields |= {"spot_angle": 1.2, "radius": radius, "sun_angle": 0.01, "size_x": 0.5, "size_y": 0.3}
            fields["tangent"] = np.cross(aim, (0.3, 0.2, 1.0))
            made.append(self.light(kinds[k % len(kinds)], fields))
        return made

    def light(self, kind, fields):
        """Each kind with the fields that it has."""
        own = {
            "POINT": {"radius"},
            "SPOT": {"radius", "direction", "spot_angle"},
            "SUN": {"direction", "sun_angle"},
            "AREA": {"direction", "size_x", "size_y", "tangent"},
        }
        wanted = {"power", "color", "position"} | own[kind]
        return self.sg.Light(kind, **{name: value for name, value in fields.items() if name in wanted})

    def ball(self, points, radius=0.1):
        """Vertices ring by ring, as meshes have their neighbors near each other, normals and triangles."""
        rings = round((points / 2) ** 0.5)
        theta = np.pi * (np.arange(rings) + 0.5) / rings
        phi = np.pi * np.arange(2 * rings) / rings
        theta, phi = (grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij"))
        normals = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
        i, j = (grid.ravel() for grid in np.meshgrid(np.arange(rings - 1), np.arange(2 * rings), indexing="ij"))
        right = (j + 1) % (2 * rings)
        a, b, c, d = (2 * rings * row + column for row, column in ((i, j), (i + 1, j), (i + 1, right), (i, right)))
        return radius * normals, normals, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])

    def surface(self, *kinds, threads=1, radius=0.0):
        points, normals, _ = self.ball(POINTS)
        lights = self.lights(*kinds, radius=radius)
        return lambda: self.sg.surface_irradiance(lights, points, normals, threads=threads)

    def surface_rectangle(self):
        return self.surface("AREA")

    def surface_spot(self):
        return self.surface("SPOT")

    def surface_sun(self):
        return self.surface("SUN")

    def surface_point(self):
        return self.surface("POINT")

    def surface_soft_spot(self):
        return self.surface("SPOT", radius=0.05)

    def surface_soft_point(self):
        return self.surface("POINT", radius=0.05)

    def surface_all_kinds(self):
        return self.surface("POINT", "SPOT", "SUN", "AREA", threads=0)

    def base_lut(self):
        tissue = self.sg.TISSUE_PRESETS["light"]
        return lambda: self.sg.base_lut(tissue, 256, 12.0, 1e-3).matrices

    def recolor(self):
        base, weight = self.sg.six_gaussian_base(256, 12.0), (2.0, 1.0, 0.5)
        recolor = self.named("recolor", "recolour")
        return lambda: recolor(base, weight)

    def slab(self):
        layers = [self.sg.Layer(1.4, 0.5, 20.0, 0.8, 0.1), self.sg.Layer(1.4, 0.05, 15.0, 0.8, 3.0)]

        def solved():
            result = self.sg.slab(layers, "diffuse", 1.0, 1.0, 16)
            return np.array([result.reflectance, result.transmittance])

        return solved

    def thickness(self):
        vertices, _, triangles = self.ball(4_000)
        return lambda: self.sg.thickness(vertices, triangles, 100.0, 16)

    def occlusion(self):
        vertices, normals, triangles = self.ball(2_000)
        wall = (vertices[:, [2, 0, 1]] + (0.0, 0.0, 0.4), triangles)
        occluders = self.sg.Occluders([(vertices, triangles), wall])
        lights = self.lights("POINT", "SPOT", "SUN", "AREA", count=4)
        visible = self.named("visible_fraction", "visible_share", of=occluders)
        excluded = "excluded" if "excluded" in (visible.__doc__ or "") else "without"
        return lambda: visible(lights, vertices, normals, **{excluded: [0]}).mean

    def shape(self):
        """A berry of 12 mm."""
        vertices, _, triangles = self.ball(8_000, 0.006)
        flesh = {"absorption": (0.03, 0.17, 0.48), "reduced_scattering": (0.7, 0.9, 1.0), "refractive_index": 1.0}
        return self.sg.Shape(vertices, triangles, **flesh, unit_mm=1000.0, threads=1)

    def shape_first_light(self):
        lights = self.lights("POINT", radius=0.05, count=1)
        return lambda: self.shape().light(lights, reentries=0).exitance

    def shape_16_lights(self):
        lights, shape = self.lights("POINT", "SPOT", radius=0.05), self.shape()
        return lambda: shape.light(lights, reentries=0).exitance

    def object_irradiance(self):
        lights = self.lights("POINT", "SPOT", "SUN", "AREA", count=64)
        irradiance = self.named("object_irradiance", "irradiance")
        return lambda: irradiance(lights, (0.01, 0.02, 0.03))

    def light_report(self):
        lights = self.lights("POINT", "SPOT", "SUN", "AREA", count=64)

        def weights():
            return np.array([row["weight"] for row in self.sg.light_report(lights, (0.01, 0.02, 0.03))])

        return weights

    def culling(self):
        lights = self.lights("POINT", "SPOT", "AREA", count=2_000)
        prepared = self.named("PreparedRig", "LightTree")

        def cull():
            return prepared(lights).cull((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1), 1e-2)["bound"]

        return cull


def case_names():
    """(name, bound to one processor)."""
    methods = [name for name, value in vars(Cases).items() if callable(value) and not name.startswith("_")]
    helpers = {"named", "directions", "lights", "light", "ball", "surface", "shape"}
    for name in methods:
        if name not in helpers:
            yield name, True
            if name in Cases.THREADED:
                yield name, False


def work(folder):
    """The other side: a case's name and whether it is bound comes in on each line, seconds for a call go out."""
    sys.path.insert(0, folder)
    warnings.simplefilter("error")
    import skinglow as sg

    if not Path(sg.__file__).is_relative_to(folder):
        sys.exit(f"{sg.__file__} is not the package in {folder}")
    processors = os.sched_getaffinity(0)
    made = {}
    for line in sys.stdin:
        name, bound, result = json.loads(line)
        os.sched_setaffinity(0, {min(processors)} if bound else processors)
        try:
            if name not in made:
                made[name] = getattr(Cases(sg), name)()
            if result:
                np.save(result, made[name]())
            answer = {"seconds": seconds_of(made[name])}
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}".splitlines()[0][:100]}
        print(json.dumps(answer), flush=True)


def seconds_of(call):
    """The fastest of a turn's calls."""
    fastest, calls, start = float("inf"), 0, time.perf_counter()
    while calls < TURN_CALLS or time.perf_counter() - start < TURN_SECONDS:
        before = time.perf_counter()
        call()
        fastest, calls = min(fastest, time.perf_counter() - before), calls + 1
    return fastest


class Build:
    """A package, and the process that runs it."""

    def __init__(self, given, folder):
        self.folder = given.resolve()
        if given.suffix == ".whl":
            self.folder = folder
            with zipfile.ZipFile(given) as archive:
                archive.extractall(folder)
        # -I: neither the user's packages nor the environment's variables.
        command = [sys.executable, "-I", str(Path(__file__).resolve()), "--worker", str(self.folder)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def turn(self, name, bound, result=None):
        self.process.stdin.write(json.dumps([name, bound, result and str(result)]) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"the process with the package in {self.folder} ended at the case {name}")
        return json.loads(answer)


def difference(before, after):
    return float(np.max(np.abs(before - after), initial=0.0) / np.max(np.abs(before), initial=1e-300))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--only", nargs="*", help="cases by name")
    arguments = parser.parse_args()
    cases = [case for case in case_names() if not arguments.only or case[0] in arguments.only]
    print(f"{'case':<20} {'':<12} {'before':>10} {'after':>10}  before / after (quartiles)   difference")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        builds = [Build(arguments.before, folder / "before"), Build(arguments.after, folder / "after")]
        for name, bound in cases:
            results = [folder / f"{i}.npy" for i in range(2)]
            started = [build.turn(name, bound, result) for build, result in zip(builds, results, strict=True)]
            faults = [f"{when} {turn['error']}" for when, turn in zip(WHEN, started, strict=True) if "error" in turn]
            if faults:
                print(f"{name:<20} {'fails':<12} {'; '.join(faults)}", flush=True)
                continue
            seconds = ([], [])
            for k in range(arguments.rounds):
                for i in (0, 1) if k % 2 else (1, 0):
                    seconds[i].append(builds[i].turn(name, bound)["seconds"])
            ratios = [before / after for before, after in zip(*seconds, strict=True)]
            low, median, high = statistics.quantiles(ratios, n=4)
            before, after = (f"{statistics.median(values) * 1e3:.4g} ms" for values in seconds)
            print(
                f"{name:<20} {'1 processor' if bound else 'all':<12} {before:>10} {after:>10}  "
                f"{median:7.2f}  ({low:.2f} to {high:.2f}) {difference(*map(np.load, results)):15.1e}",
                flush=True,
            )


if sys.argv[1:2] == ["--worker"]:
    work(sys.argv[2])
else:
    main()
