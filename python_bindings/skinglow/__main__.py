"""The package from a shell: python -m skinglow weights | lut | thickness | shape. Refusals are one line, exit code 2.

The program `skinglow` (C++) reads and writes more formats; this one comes with `pip install skinglow`.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

import skinglow as sg
from skinglow._mesh_files import read_mesh

Array = NDArray[np.float64]


class Parser(argparse.ArgumentParser):
    """One line and exit code 2, as every refusal."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"skinglow: command line: {message}: see {self.prog} --help\n")


def read_rig(options: argparse.Namespace) -> tuple[sg.LightRig, Array, Array, Array]:
    """The rig, and its point, coefficients and blood weight, or what the options say in their place."""
    turned = options.camera_rotation
    rig = sg.read_light_rig(options.rig, None if turned is None else np.radians(turned))
    for note in rig.notes:
        print(f"skinglow: file {options.rig}: note: {note}", file=sys.stderr)
    given = (options.point, options.coefficients, options.blood)
    held = (rig.point, rig.coefficients, rig.blood_weight)
    point, coefficients, blood = (
        np.array(one if ours is None else ours) for one, ours in zip(held, given, strict=True)
    )
    return rig, point, coefficients, blood


def write_table(path: Path, header: str, columns: str, table: Array) -> None:
    """A table as .csv, with every digit, or as .npy."""
    with whole_file(path) as partial:
        if path.suffix == ".npy":
            np.save(partial, table)
            return
        rows = [",".join(repr(value) for value in row) for row in table.tolist()]
        partial.write_text("\n".join([*header.splitlines(), columns, *rows]) + "\n", encoding="utf-8")


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Context manager with a file beside `path` to write, which takes its place when it is complete.

    What is no regular file, as /dev/stdout, is written itself. Nothing is left where something fails.
    """
    if path.exists() and not path.is_file():
        yield path
        return
    told = path
    path = path.resolve()  # what a link leads to is replaced, not the link
    partial = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield partial
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        os.replace(partial, path)
    except OSError as error:
        # Its own words would name the partial file, of which nobody knows.
        remedy = "choose a folder that exists and that you may write to"
        raise ValueError(f"file {told}: cannot be written: {error.strerror or error}: {remedy}") from error
    finally:
        partial.unlink(missing_ok=True)


def weights(options: argparse.Namespace) -> None:
    rig, point, coefficients, blood = read_rig(options)
    each = sg.light_weights(rig.lights, point, coefficients)
    total = sg.light_weight(rig.lights, point, coefficients)
    brightness = float(sg.luminance(total))
    lights = [
        {
            "name": light.name or f"lights[{index}]",
            "kind": light.kind,
            "on": light.is_on,
            "weight": weight.tolist(),
            "share": float(sg.luminance(weight)) / brightness if brightness > 0.0 else 0.0,
        }
        for index, (light, weight) in enumerate(zip(rig.lights, each, strict=True))
    ]
    sums = {"light_weight": total, "blood_weight": blood, "weight": blood + total}
    if options.json:
        told = {"point": point.tolist(), "lights": lights} | {name: value.tolist() for name, value in sums.items()}
        print(json.dumps(told, indent=2, ensure_ascii=False))
        return
    rows = [(one["name"], one["weight"], f"{100 * one['share']:.6g}%" if one["on"] else "off") for one in lights]
    rows += [(name, value, "") for name, value in zip(("L", "B", "B + L"), sums.values(), strict=True)]
    # A name's line ends and other control characters would act on the terminal.
    rows = [("".join(c if c.isprintable() else "?" for c in name), *rest) for name, *rest in rows]
    width = max(len(name) for name, *_ in rows)
    for name, value, share in rows:
        print(f"{name:{width}}" + "".join(f"{number:13.6g}" for number in value) + f"  {share}".rstrip())


def refuse_options(options: argparse.Namespace, names: Sequence[str], why: str) -> None:
    """Raises ValueError where one of the options was given: it would change nothing."""
    for name in names:
        if getattr(options, name) is not None:
            raise ValueError(f"{why}, which --{name.replace('_', '-')} would not change: leave it out")


def lut(options: argparse.Namespace) -> None:
    size, depth = options.size, options.max_thickness
    chosen = {name: value for name in sg.TISSUE_PARAMETERS if (value := getattr(options, name)) is not None}
    of_skin = options.skin or chosen or options.tolerance is not None
    mode = options.mode or ("physical" if of_skin else "paper")
    if mode != "physical" and of_skin:
        raise ValueError("--skin and its options belong to --mode physical")
    if mode == "physical":
        refuse_options(options, ("coefficients", "blood"), "--mode physical is light in W/m^2")
    if not options.rig:
        refuse_options(options, ("point", "coefficients", "blood", "camera_rotation"), "there is no RIG")
    if mode == "existing":
        if options.rig:
            raise ValueError("--mode existing knows no lights: leave out RIG")
        base, colors = sg.six_gaussian_base(size, depth), sg.six_gaussian_lookup(size, depth)
    elif mode == "paper":
        if not options.rig:
            raise ValueError("--mode paper needs lights: give a RIG file")
        rig, point, coefficients, blood = read_rig(options)
        base = sg.six_gaussian_base(size, depth)
        colors = sg.recolor(base, blood + sg.light_weight(rig.lights, point, coefficients))
    else:
        skin = sg.TISSUE_PRESETS[options.skin or "light"].replace(**chosen)
        base = sg.base_lut(skin, size, depth, 1e-3 if options.tolerance is None else options.tolerance)
        irradiance: Array = np.ones(3)
        if options.rig:
            rig, point, *_ = read_rig(options)
            irradiance = sg.object_irradiance(rig.lights, point)
        colors = sg.recolor(base, irradiance)
    header = f"# skinglow:max_thickness_mm: {depth!r}\n# skinglow:mode: {mode}\n# skinglow:table: recolored"
    write_table(options.output, header, "thickness_mm,r,g,b", np.column_stack([base.thickness_mm, colors]))
    print(f"{options.output}: mode {mode}, {size} texels, 0 to {depth:g} mm")


def thickness(options: argparse.Namespace) -> None:
    vertices, triangles = read_mesh(options.mesh)
    report = sg.thickness_report(
        vertices, triangles, options.unit, options.rays, min_sky_visibility=options.min_sky_visibility
    )
    values = report.thickness_mm
    table = np.column_stack([vertices, values])
    write_table(options.output, f"# One unit is {options.unit!r} mm.", "x,y,z,thickness_mm", table)
    if report.no_far_side.any():
        count = int(report.no_far_side.sum())
        print(f"skinglow: note: {count} vertices have no far side: the mesh is open there", file=sys.stderr)
    low, middle, high = np.percentile(values, [0, 50, 100]) if len(values) else (0.0, 0.0, 0.0)
    print(f"{options.output}: {len(values)} vertices, thickness {low:.6g} to {high:.6g} mm, median {middle:.6g} mm")


def shape(options: argparse.Namespace) -> None:
    vertices, triangles = read_mesh(options.mesh)
    rig, *_ = read_rig(options)
    body = sg.Shape(
        vertices,
        triangles,
        sg.TISSUE_PRESETS[options.skin],
        unit_mm=options.unit,
        cell_mm=options.cell,
        tolerance=options.tolerance,
    )
    exitance = body.light(rig.lights, reentries=options.reentries).exitance
    table = np.column_stack([vertices, exitance])
    header = f"# One unit is {options.unit!r} mm. Exitance: light that leaves the flesh, W/m^2, linear Rec.709."
    write_table(options.output, header, "x,y,z,r,g,b", table)
    told = f"cells of {body.report['cell_mm']:.3g} mm, {body.report['ready_parts']} thin parts lit"
    print(f"{options.output}: {len(vertices)} vertices, {told}")


def add_rig_options(command: argparse.ArgumentParser, required: bool, *, at_a_point: bool = True) -> None:
    """at_a_point: whether lights are asked for at one point, by Eq. 2 and 3; a shape has points of its own."""
    command.add_argument(
        "rig", metavar="RIG", nargs=None if required else "?", help="rig file (JSON) or *.sl of Blender"
    )
    options = [("--camera-rotation", "X Y Z", "of the camera that the lights of *.sl hang on, degrees")]
    if at_a_point:
        options += [
            ("--point", "X Y Z", "where on the skin, in units of the rig; else the rig's"),
            ("--coefficients", "KC KL KQ", "of the attenuation; else the rig's"),
            ("--blood", "R G B", "blood weight B; else the rig's"),
        ]
    for name, metavar, told in options:
        command.add_argument(name, metavar=tuple(metavar.split()), nargs=3, type=float, help=told)


def table_file(text: str) -> Path:
    path = Path(text)
    if path.suffix not in (".csv", ".npy"):
        raise argparse.ArgumentTypeError(f"{text!r}; name it .csv or .npy")
    if not path.parent.is_dir():  # told before anything is worked out
        raise argparse.ArgumentTypeError(f"{text!r}: there is no folder {str(path.parent)!r}; choose one that exists")
    return path


def parser() -> Parser:
    program = Parser(prog="python -m skinglow", description=__doc__.splitlines()[0])
    program.add_argument("--version", action="version", version=sg.__version__)
    commands = program.add_subparsers(required=True, metavar="COMMAND", parser_class=Parser)

    def add(run: Callable[[argparse.Namespace], None], told: str) -> argparse.ArgumentParser:
        command = commands.add_parser(run.__name__, help=told, description=told)
        command.set_defaults(run=run)
        return command

    def add_mesh(command: argparse.ArgumentParser, unit: float) -> None:
        command.add_argument("mesh", metavar="MESH", type=Path, help="triangles: .npz, or any format of meshio")
        command.add_argument("--unit", metavar="MM", type=float, default=unit, help="length of one unit (%(default)s)")

    def add_output(command: argparse.ArgumentParser) -> None:
        command.add_argument("-o", "--output", metavar="FILE", type=table_file, required=True, help=".csv or .npy")

    skins = tuple(sg.TISSUE_PRESETS)
    command = add(weights, "How much each light counts at a point (Eq. 2 and 3 of the paper)")
    add_rig_options(command, required=True)
    command.add_argument("--json", action="store_true", help="print JSON with every digit")

    command = add(lut, "A lookup table of light that comes through skin")
    add_rig_options(command, required=False)
    command.add_argument("--mode", choices=("existing", "paper", "physical"), help="paper; physical with --skin")
    command.add_argument("--size", metavar="N", type=int, default=256, help="texels (%(default)s)")
    command.add_argument(
        "--max-thickness", metavar="MM", type=float, default=12.0, help="of the last texel (%(default)s)"
    )
    command.add_argument("--tolerance", metavar="X", type=float, help="largest relative error of physical (0.001)")
    command.add_argument("--skin", choices=skins, help="tissue of physical")
    for name, (_, least, most, _, told) in sg.TISSUE_PARAMETERS.items():
        text = f"{told}; {least:g} to {most:g}; else the preset's"
        command.add_argument(f"--{name.replace('_', '-')}", metavar="X", type=float, help=text)
    add_output(command)

    command = add(thickness, "How thick a body is at each vertex of its mesh, mm")
    add_mesh(command, 1.0)
    command.add_argument("--rays", metavar="N", type=int, help="per vertex")
    command.add_argument("--min-sky-visibility", metavar="X", type=float, default=0.0, help="of a far side, 0 to 1")
    add_output(command)

    command = add(shape, "Light through the body itself: what leaves each vertex, W/m^2")
    add_mesh(command, 1000.0)
    command.set_defaults(point=None, coefficients=None, blood=None)
    add_rig_options(command, required=True, at_a_point=False)
    command.add_argument("--skin", choices=skins, default="light", help="tissue (%(default)s)")
    command.add_argument("--cell", metavar="MM", type=float, help="edge of the cells")
    command.add_argument("--tolerance", metavar="X", type=float, help="instead of --cell: the error that is allowed")
    command.add_argument(
        "--reentries", metavar="N", type=int, default=2, help="how often light enters again (%(default)s)"
    )
    add_output(command)
    return program


def main(arguments: list[str] | None = None) -> int:
    # A file's name may be any bytes, a light's any characters: to print one must not fail when the work is done.
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout.errors == "strict":
        sys.stdout.reconfigure(errors="backslashreplace")
    options = parser().parse_args(arguments)
    try:
        options.run(options)
    except OSError as error:
        told = error.strerror or str(error)
        if error.filename is not None:  # none of a full disk
            told = f"file {error.filename}: {told}: check the name and the permissions"
        print(f"skinglow: {told}", file=sys.stderr)
        return 2
    except (ValueError, TypeError, MemoryError) as error:
        print(f"skinglow: {error or 'not enough memory'}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
