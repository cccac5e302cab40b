"""The ladder: a back-lit ear of three heads under four rigs by every method, error against run time: docs/accuracy.md.

References are the house's Monte Carlo in the mesh itself and Cycles' random walk, each in two halves, so that their
noise drops out. Pictures, and what the Monte Carlo found, are kept in --out.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
import skinglow as sg

from studies import hosts, monte_carlo, report
from studies.demo import head_source
from studies.ladder import figures, tables
from studies.ladder.results import Results
from studies.medium import SKIN1
from studies.paths import IMAGES, PROJECT, SCAN
from studies.progress import Progress
from studies.shape.cases import EAR_RADIUS_MM, MM_PER_METER, HeadMesh

RIGS = {path.stem: path for path in sorted(Path(__file__).with_name("rigs").glob("*.json"))}
#: Light that falls farther from the ear lights no vertex that counts.
NEAR_MM = 60.0
SUZANNE_MM = 60.0


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m studies ladder", description=__doc__)
    parser.add_argument("--scan", default=str(SCAN), metavar="FILE", help="LeePerrySmith.glb (default: %(default)s)")
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy, for Cycles")
    parser.add_argument("--eevee", metavar="PROGRAM", default="blender", help="a full Blender (default: %(default)s)")
    parser.add_argument("--program", type=Path, help="the Monte Carlo (default: it is built)")
    parser.add_argument("--photons", type=int, default=400_000, help="per channel and rig (default %(default)s)")
    parser.add_argument("--size", type=int, default=96, metavar="PIXELS", help="(default %(default)s)")
    parser.add_argument("--samples", type=int, default=256, help="of each half of the walk (default %(default)s)")
    parser.add_argument("--out", type=Path, default=Path("out/ladder"), help="(default %(default)s)")
    parser.add_argument("--no-docs", action="store_true", help="do not update docs/accuracy.md; figures go to --out")
    return parser.parse_args(arguments)


def found_heads(scan: str, progress: Progress) -> dict[str, head_source.Head]:
    heads = {"scan": scan, "demo": None, "suzanne": "suzanne"}
    if not Path(scan).is_file():
        progress.say(f"no scan at {scan}: without it (--scan FILE)")
        del heads["scan"]
    unit = {"suzanne": SUZANNE_MM}
    return {name: head_source.find(file, unit.get(name), progress) for name, file in heads.items()}


class Climb:
    """The renders of one head, each kept once it is there."""

    def __init__(self, name: str, source: head_source.Head, options: argparse.Namespace, progress: Progress) -> None:
        self.name, self.source, self.options, self.progress = name, source, options, progress
        self.out: Path = options.out
        self.cycles = hosts.Host.find(options.blender)

    def path(self, kind: str) -> Path:
        return self.out / f"{self.name}-{kind}"

    def mesh(self) -> HeadMesh:
        path = self.path("mesh.npz")
        if not path.is_file():
            job = {**self.source.job(), "mesh_file": str(path)}
            self.cycles.run("studies.shape.head_job", job, self.progress)
        return HeadMesh(path)

    def attributes(self, head: HeadMesh, program: Path) -> Path:
        """By rig: which vertices are compared, and the Monte Carlo's radiance there, twice."""
        path = self.path("attributes.npz")
        if path.is_file():
            return path
        values: dict[str, np.ndarray] = {}
        near = np.linalg.norm(head.vertices - head.ear_center, axis=1) < NEAR_MM
        to_ear = np.eye(4)
        to_ear[:3, 3] = head.ear_center / MM_PER_METER
        for rig, file in RIGS.items():
            lights = [light.moved(to_ear) for light in sg.read_light_rig(file).lights]
            irradiance = head.irradiance_of(lights) * near[:, None]
            dark = np.zeros((len(near), 3))
            dark[head.ear[head.back_lit(irradiance.max(axis=1))]] = 1.0
            self.progress.say(f"{self.name}, {rig}: Monte Carlo of {self.options.photons:,} photons per channel")
            truth = monte_carlo.monte_carlo(
                program,
                head.vertices,
                head.triangles,
                irradiance,
                SKIN1.absorption,
                SKIN1.reduced_scattering,
                photons=self.options.photons,
                targets=head.ear,
            )
            self.progress.say(f"{self.name}, {rig}: {truth.seconds:.0f} s")
            values |= {f"{rig}|dark": dark, f"{rig}|mc 1": truth.a / np.pi, f"{rig}|mc 2": truth.b / np.pi}
        np.savez_compressed(path, **values)
        return path

    def job(self, head: HeadMesh) -> dict[str, Any]:
        radius = float(np.linalg.norm(head.vertices[head.ear] - head.ear_center, axis=1).max())
        return {
            "mesh_file": str(self.path("mesh.npz")),
            "rigs": {name: str(path) for name, path in RIGS.items()},
            "center": (head.ear_center / MM_PER_METER).tolist(),
            "height": 2.0 * min(radius, EAR_RADIUS_MM) / MM_PER_METER,
            "size": self.options.size,
            "samples": self.options.samples,
            "walk_samples": [n for n in (1, 4, 16, 64, 256, 1024) if n < self.options.samples],
            "out": str(self.out),
        }

    def results(self, program: Path) -> Results:
        head = self.mesh()
        job = {**self.job(head), "attributes": str(self.attributes(head, program))}
        told: dict[str, Any] = {}
        for kind in ("cycles", "eevee"):
            pictures, kept = self.path(f"{kind}.npz"), self.path(f"{kind}.json")
            if not kept.is_file():
                host = self.cycles if kind == "cycles" else hosts.Host.find(self.options.eevee)
                module = "studies.ladder.job" if kind == "cycles" else "studies.ladder.eevee_job"
                told[kind] = host.run(
                    module, {**job, "pictures": str(pictures)}, self.progress, display=kind == "eevee"
                )
                kept.write_text(json.dumps(told[kind], indent=1))
            told[kind] = json.loads(kept.read_text())
        return Results(self.name, self.source.name, [self.path("cycles.npz"), self.path("eevee.npz")], told, list(RIGS))


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    progress = Progress(options.out / "ladder.log")
    program = options.program or monte_carlo.build(progress)
    heads = found_heads(options.scan, progress)
    found = [Climb(name, source, options, progress).results(program) for name, source in heads.items()]
    images = options.out if options.no_docs else IMAGES
    for each in found:
        figures.error_against_time(images / f"ladder_{each.head}.png", each)
        figures.pictures(images / f"ladder_{each.head}_pictures.png", each)
    sections = {"ladder": tables.ladder(found, options), "ladder_rigs": tables.by_rig(found)}
    print("\n\n".join(sections.values()), flush=True)
    if not options.no_docs:
        report.fill(PROJECT / "docs" / "accuracy.md", sections)
    progress.say("done")
