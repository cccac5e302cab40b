"""The tables of docs/shape.md: errors against the reference, and cost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import skinglow as sg

from studies import report
from studies.progress import Progress
from studies.shape.cases import Array, Error, error
from studies.shape.pictures import Pictures, ViewDependence
from studies.shape.truths import Lit
from studies.timing import timed

CELLS_MM = (0.8, 0.5)
REPEATS = 5
#: From the ear's center: what is farther lights no vertex that counts.
NEAR_MM = 60.0


def shape_of(lit: Lit, cell_mm: float, threads: int = 0, **asked: np.ndarray) -> sg.Shape:
    """Everything thin on the head, in the medium of the case; `asked` as skinglow.Shape's points and normals."""
    return sg.Shape(
        lit.head.vertices,
        lit.head.triangles,
        absorption=lit.case.medium.absorption,
        reduced_scattering=lit.case.medium.reduced_scattering,
        refractive_index=lit.case.refractive_index,
        surface=lit.case.surface,
        cell_mm=cell_mm,
        threads=threads,
        **asked,
    )


def light_on_ear(lit: Lit) -> Array:
    """Irradiance without what falls elsewhere on the head, too far away to matter."""
    far = np.linalg.norm(lit.head.vertices - lit.head.ear_center, axis=1) > NEAR_MM
    return np.where(far, 0.0, lit.irradiance)


class Errors(NamedTuple):
    """Of one method in one case, over the area of the ear's skin that is dark and that is lit."""

    back: Error
    lit: Error
    brightness: Array  # mean over the reference's, back-lit, per channel


def errors_of(lit: Lit, exitance: Array) -> Errors:
    ear = lit.head.ear
    dark = lit.head.back_lit(lit.irradiance)
    area = lit.head.vertex_area
    back, front = ear[dark], ear[~dark]
    weight = area[back, None]
    mean = 0.5 * (lit.a + lit.b)
    return Errors(
        error(exitance[back], lit.a[back], lit.b[back], area[back]),
        error(exitance[front], lit.a[front], lit.b[front], area[front]),
        (weight * exitance[back]).sum(axis=0) / (weight * mean[back]).sum(axis=0),
    )


class Measured(NamedTuple):
    case: Lit
    shape: dict[float, Errors]  # by cell
    table: Errors | None  # where the table is of the same surface


def measure(lit: Lit, progress: Progress) -> tuple[Measured, dict[float, Array]]:
    """Errors of the shape and of the thickness table; and the shape's exitance by cell."""
    exitance = {}
    for cell in CELLS_MM if lit.case.is_solved_fine else CELLS_MM[:1]:
        shape = shape_of(lit, cell)
        exitance[cell] = np.asarray(shape.exitance(light_on_ear(lit)))
        progress.say(f"{lit.case.name}, cells of {cell} mm: {shape.bytes / 1e6:.0f} MB")
    table = None
    if lit.case.refractive_index == 1.0:
        table = errors_of(lit, lit.head.table(lit.case.light, lit.case.medium))
    return Measured(lit, {cell: errors_of(lit, values) for cell, values in exitance.items()}, table), exitance


def percent(value: float) -> str:
    if value == 0.0:
        return "< noise"
    return f"{value:.0f}" if value >= 9.95 else f"{value:.1f}"


def with_error(found: Error) -> str:
    bar = f" ± {found.standard_error:.1f}" if found.together > 0.0 else ""
    return f"**{percent(found.together)}**{bar}"


def errors_table(measured: list[Measured]) -> str:
    heading = ["Head", "Light", "Medium, surface", "Cells, mm", "R", "G", "B", "All"]
    heading += ["Brightness R, G, B", "Lit side, all", "Table over thickness, all"]
    rows = []
    for one in measured:
        case = one.case.case
        surface = "index matched" if case.refractive_index == 1.0 else f"n = {case.refractive_index:g}, {case.surface}"
        for cell, found in one.shape.items():
            first = cell == CELLS_MM[0]
            rows.append(
                [
                    *((case.head, case.light, f"{case.medium.name.split()[0]}, {surface}") if first else ("", "", "")),
                    f"{cell:g}",
                    *(percent(value) for value in found.back.channels),
                    with_error(found.back),
                    ", ".join(f"{value:.2f}" for value in found.brightness),
                    percent(found.lit.together),
                    "" if one.table is None or not first else percent(one.table.back.together),
                ]
            )
    return report.table(heading, rows)


def noise_table(measured: list[Measured]) -> str:
    rows = [[one.case.case.name, *(f"{value:.0f}" for value in one.case.noise)] for one in measured]
    return report.table(["Reference", "R, %", "G, %", "B, %"], rows)


class Cost(NamedTuple):
    cell_mm: float
    points: int
    cells: int
    prepare: float  # CPU seconds
    move: float
    megabytes: float


def costs(lit: Lit) -> list[Cost]:
    """One ear, three channels, one thread. The first light prepares the parts that it falls on."""
    found = []
    for cell in CELLS_MM:

        def prepare(cell: float = cell) -> sg.Shape:
            ear = lit.head.ear
            shape = shape_of(lit, cell, 1, points=lit.head.vertices[ear], normals=lit.head.normals[ear])
            shape.exitance(light_on_ear(lit))
            return shape

        shape, seconds = timed(prepare)
        times = []
        for i in range(REPEATS):
            moved = light_on_ear(lit) * (1.0 + 0.01 * i)
            times.append(timed(shape.exitance, moved)[1])
        cells = sum(part.cells for part in shape.parts)
        found.append(Cost(cell, len(shape.points), cells, seconds - min(times), min(times), shape.bytes / 1e6))
    return found


def costs_table(found: list[Cost]) -> str:
    heading = ["Cells, mm", "Points", "Cells", "Prepare, s", "A moved light, ms", "Memory, MB", "kB a point"]
    return report.table(
        heading,
        [
            [
                f"{cost.cell_mm:g}",
                f"{cost.points:,}",
                f"{cost.cells:,}",
                f"{cost.prepare:.1f}",
                f"{1e3 * cost.move:.0f}",
                f"{cost.megabytes:.0f}",
                f"{1e3 * cost.megabytes / cost.points:.1f}",
            ]
            for cost in found
        ],
    )


def view_table(found: dict[str, ViewDependence]) -> str:
    heading = ["Head", "Pixels", "Cycles over exitance / π, means", "RMS difference, %", "At best scale, %"]

    def triple(values: Array, form: str) -> str:
        return ", ".join(format(value, form) for value in values)

    return report.table(
        heading,
        [
            [head, f"{one.pixels:,}", triple(one.ratio, ".2f"), triple(one.rms, ".0f"), triple(one.rms_at_best, ".0f")]
            for head, one in found.items()
        ],
    )


def walk_seconds(pictures: Pictures, percent_error: float) -> float:
    """CPU seconds that Cycles' walk of the view from the front takes until its noise is that error."""
    chosen = pictures.exposed("front")
    first, second = (pictures.images[f"front-walk_{k}"][chosen][:, :3] for k in (1, 2))
    noise = 100.0 * np.sqrt(0.5 * ((first - second) ** 2).mean()) / (0.5 * (first + second)).mean()
    return pictures.seconds["front-walk_1"] * (noise / percent_error) ** 2


def time_table(walks: dict[str, tuple[float, float]], cost: Cost) -> str:
    """Walks: error of the shape in percent, and CPU seconds until Cycles' noise in one view is that, by head."""
    heading = ["Head", "Error, %", "Cycles' walk to that noise, CPU s", "Over a moved light", "Over the first light"]
    rows = []
    for head, (off, seconds) in walks.items():
        first = seconds / (cost.prepare + cost.move)
        rows.append([head, percent(off), f"{seconds:.0f}", f"{seconds / cost.move:,.0f}", f"{first:.0f}"])
    return report.table(heading, rows)


def surface_table(cases: list[Lit]) -> str:
    """What the surface does: back-lit exitance by the reference, over that of an index matched surface."""
    matched = next(one for one in cases if one.case.refractive_index == 1.0)
    rows = []
    for other in cases:
        same = (other.case.head, other.case.light, other.case.medium) == (
            matched.case.head,
            matched.case.light,
            matched.case.medium,
        )
        if other is matched or not same:
            continue
        chosen = matched.head.ear[matched.head.back_lit(matched.irradiance)]
        weight = matched.head.vertex_area[chosen]
        part = (weight / weight.sum())[:, None]
        mean, base = ((part * one.mean[chosen]).sum(axis=0) for one in (other, matched))
        product = (other.a - matched.a) * (other.b - matched.b)
        rms = 100.0 * np.sqrt(np.maximum((part * product[chosen]).sum(axis=0), 0.0)) / mean
        rows.append(
            [
                f"n = {other.case.refractive_index:g}, {other.case.surface}",
                ", ".join(f"{value:.2f}" for value in mean / base),
                ", ".join(f"{value:.0f}" for value in rms),
            ]
        )
    heading = ["Surface", "Mean over index matched: R, G, B", "Index matched taken for it, RMS, %"]
    return report.table(heading, rows)
