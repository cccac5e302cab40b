"""The ladder: a back-lit ear of three heads under four rigs by every method, error against run time: docs/accuracy.md.

References are the house's Monte Carlo in the mesh itself and Cycles' random walk, each in two halves, so that their
noise drops out. Each picture, and what the Monte Carlo found, is kept in --out: a run that was ended goes on there.
"""

from __future__ import annotations

import argparse
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import skinglow as sg

from studies import hosts, monte_carlo, report
from studies.heads import sources
from studies.ladder import figures, tables
from studies.ladder.cells import Cells
from studies.ladder.results import RUNGS, WALKS, Results
from studies.medium import SKIN1
from studies.paths import IMAGES, PROJECT, SCAN
from studies.progress import Progress, StudyError
from studies.shape.cases import EAR_RADIUS_MM, MM_PER_METER, HeadMesh

RIGS = {path.stem: path for path in sorted(Path(__file__).with_name("rigs").glob("*.json"))}
#: Light that falls farther from the ear lights no vertex that counts.
NEAR_MM = 60.0
SUZANNE_MM = 60.0
TITLES = {"scan": "LeePerrySmith", "person": "the person", "suzanne": "Suzanne"}


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m studies ladder", description=__doc__)
    parser.add_argument("--scan", default=str(SCAN), metavar="FILE", help="LeePerrySmith.glb (default: %(default)s)")
    parser.add_argument("--blender", metavar="PROGRAM", help="a Blender program or a Python with bpy, for Cycles")
    parser.add_argument("--eevee", metavar="PROGRAM", default="blender", help="a full Blender (default: %(default)s)")
    parser.add_argument("--program", type=Path, help="the Monte Carlo (default: it is built)")
    parser.add_argument("--photons", type=int, default=1_600_000, help="per channel and rig (default %(default)s)")
    parser.add_argument("--size", type=int, default=96, metavar="PIXELS", help="(default %(default)s)")
    parser.add_argument("--samples", type=int, default=1024, help="of the walk, in two halves (default %(default)s)")
    parser.add_argument(
        "--again", nargs="*", choices=RUNGS, default=[], metavar="RUNG", help="render these anew: " + ", ".join(RUNGS)
    )
    parser.add_argument("--out", type=Path, default=Path("out/ladder"), help="(default %(default)s)")
    parser.add_argument("--no-docs", action="store_true", help="do not update docs/accuracy.md; figures go to --out")
    return parser.parse_args(arguments)


def found_heads(scan: str, progress: Progress) -> dict[str, dict[str, Any]]:
    """By name, what is loaded."""
    heads = {
        "scan": ("", {}) if not Path(scan).is_file() else (scan, {}),
        "person": (None, {}),
        "suzanne": ("suzanne", {"unit_mm": SUZANNE_MM}),
    }
    if heads["scan"][0] == "":
        progress.say(f"no scan at {scan}: without it (--scan FILE)")
        del heads["scan"]
    return {name: sources.head_job(mesh, progress, **given) for name, (mesh, given) in heads.items()}


class Climb:
    """The renders of one head, each kept once it is there."""

    def __init__(self, name: str, head: dict[str, Any], options: argparse.Namespace, progress: Progress) -> None:
        self.name, self.head_job, self.options, self.progress = name, head, options, progress
        self.out: Path = options.out
        self.hosts = {"job": hosts.Host.find(options.blender), "eevee_job": hosts.Host.find(options.eevee)}

    @cached_property
    def mesh(self) -> HeadMesh:
        path = self.out / f"{self.name}-mesh.npz"
        if not path.is_file():
            told = self.hosts["job"].run(
                "studies.heads.mesh_job", {**self.head_job, "mesh_file": str(path)}, self.progress
            )
            if "error" in told:
                raise StudyError(told["error"])
        return HeadMesh(path)

    @cached_property
    def job(self) -> dict[str, Any]:
        ear, center = self.mesh.vertices[self.mesh.ear], self.mesh.ear_center
        radius = float(np.linalg.norm(ear - center, axis=1).max())
        job = {
            "mesh_file": str(self.out / f"{self.name}-mesh.npz"),
            "rigs": {name: str(path) for name, path in RIGS.items()},
            "center": (center / MM_PER_METER).tolist(),
            "height": 2.0 * min(radius, EAR_RADIUS_MM) / MM_PER_METER,
            "size": self.options.size,
            "samples": self.options.samples,
            "walk_samples": [n for n in WALKS if n < self.options.samples],
            "out": str(self.out),
        }
        of = {**job, "host": [host.version for host in self.hosts.values()]}
        return {**job, "cells": str(Cells.of(self.out, self.name, of).folder)}

    def attributes(self, program: Path) -> Path:
        """By rig: which vertices are compared, and the Monte Carlo's radiance there, twice."""
        cells = Path(self.job["cells"])
        together: dict[str, np.ndarray] = {}
        for rig, file in RIGS.items():
            path = cells / f"vertices - {rig} - {self.options.photons}.npz"
            if not path.is_file():
                partial = path.with_suffix(".part")
                with partial.open("wb") as kept:
                    np.savez_compressed(kept, **self.lit_vertices(rig, file, program))
                partial.replace(path)
            with np.load(path) as kept:
                together |= {f"{rig}|{name}": kept[name] for name in kept.files}
        path = cells / "attributes.npz"
        np.savez(path, **together)
        return path

    def lit_vertices(self, rig: str, file: Path, program: Path) -> dict[str, np.ndarray]:
        head = self.mesh
        near = np.linalg.norm(head.vertices - head.ear_center, axis=1) < NEAR_MM
        to_ear = np.eye(4)
        to_ear[:3, 3] = head.ear_center / MM_PER_METER
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
        return {"dark": dark, "mc 1": truth.a / np.pi, "mc 2": truth.b / np.pi}

    def results(self, program: Path) -> Results:
        job = {**self.job, "attributes": str(self.attributes(program))}
        cells = Cells(Path(job["cells"]))
        for rung in self.options.again:
            cells.forget(rung)
        for module, host in self.hosts.items():
            self.progress.say(f"{self.name}: what is not there yet, by Blender {host.version}")
            host.run(f"studies.ladder.{module}", job, self.progress, display=module == "eevee_job")
        versions = tuple(host.version for host in self.hosts.values())
        return Results(self.name, TITLES[self.name], cells, list(RIGS), self.options.samples, versions)


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    progress = Progress(options.out / "ladder.log")
    program = options.program or monte_carlo.build(progress)
    heads = found_heads(options.scan, progress)
    found = [Climb(name, head, options, progress).results(program) for name, head in heads.items()]
    images = options.out if options.no_docs else IMAGES
    for each in found:
        figures.error_against_time(images / f"ladder_{each.head}.png", each)
        figures.pictures(images / f"ladder_{each.head}_pictures.png", each)
    sections = {"ladder": tables.ladder(found, options), "ladder_rigs": tables.by_rig(found)}
    print("\n\n".join(sections.values()), flush=True)
    if not options.no_docs:
        report.fill(PROJECT / "docs" / "accuracy.md", sections)
    progress.say("done")
