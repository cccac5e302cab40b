"""Runs the real POV-Ray in a folder of its own and reads back what it wrote."""

from __future__ import annotations

import math
import re
import subprocess
from pathlib import Path

import numpy as np
import skinglow as sg

MACROS = Path(__file__).resolve().parents[2] / "povray_macros"
HEADER = '#version 3.7;\n#include "skinglow.inc"\nglobal_settings { assumed_gamma 1.0 }\n'


class PovrayError(Exception):
    """What POV-Ray said, on one line: it breaks its messages at 80 characters."""


def run(folder: Path, *arguments: str) -> None:
    """Raises PovrayError unless POV-Ray ends with exit code 0."""
    done = subprocess.run(["povray", *arguments, "-D"], cwd=folder, capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        # All of it: the heading "[Parsing...]" comes from another thread, before the messages or after them.
        raise PovrayError(re.sub(r"=+ \[Parsing\.\.\.\] =+|\s+", " ", done.stderr))


def numbers(folder: Path, expressions: list[str], declarations: str = "") -> list[float]:
    """Values of SDL expressions, every digit, computed by POV-Ray with the macros included."""
    write(folder, {"skinglow.inc": sg.povray_macros()})
    writes = "".join(f'#write (Out, Skinglow_Exact_Text({e}), "\\n")\n' for e in expressions)
    text = f'{HEADER}{declarations}\n#fopen Out "out.txt" write\n{writes}#fclose Out\n'
    (folder / "numbers.pov").write_text(text + "camera { location -z }\n")
    run(folder, "numbers.pov", "-F")
    return [exact(word) for word in (folder / "out.txt").read_text().split()]


def vectors(folder: Path, expressions: list[str], declarations: str = "") -> np.ndarray:
    """The same for vectors, (n, 3). Each is computed once."""
    for i, expression in enumerate(expressions):
        declarations += f"\n#declare Vector_{i} = {expression};"
    parts = [f"Vector_{i}.{axis}" for i in range(len(expressions)) for axis in "xyz"]
    return np.array(numbers(folder, parts, declarations)).reshape(-1, 3)


def exact(text: str) -> float:
    mantissa, exponent = text.split("p")
    # In two steps: 2^-1074 times a mantissa below 1 is a double, the power alone of a smaller one is not.
    return math.ldexp(float(mantissa), int(exponent))


def write(folder: Path, files: dict[str, str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")


def render(folder: Path, *arguments: str) -> np.ndarray:
    """scene.ini as linear 16-bit picture, (height, width, 3); values above 1 are cut."""
    run(folder, "scene.ini", "+Oscene.ppm", "+FP16", "File_Gamma=1.0", *arguments)
    data = (folder / "scene.ppm").read_bytes()
    header = re.match(rb"P6\s(?:#.*\n)*(\d+) (\d+)\s65535\s", data)
    width, height = int(header.group(1)), int(header.group(2))
    return np.frombuffer(data[header.end() :], ">u2").reshape(height, width, 3) / 65535


def sdl_vector(values: np.ndarray | tuple[float, ...]) -> str:
    return "<" + ",".join(repr(float(v)) for v in values) + ">"


def sdl_array(name: str, items: list[str]) -> str:
    lines = ",\n".join(items)
    return f"#declare {name} = array[{len(items)}] {{\n{lines}\n}}\n"


def sdl_lights(lights: list) -> str:
    """skinglow lights as the arrays that the macros take: Kinds, Colors, Positions, Powers."""
    powers = [repr(float(light.power if light.visible else 0)) for light in lights]
    return (
        sdl_array("Kinds", [f'"{light.kind}"' for light in lights])
        + sdl_array("Colors", [sdl_vector(light.color) for light in lights])
        + sdl_array("Positions", [sdl_vector(light.position) for light in lights])
        + sdl_array("Powers", powers)
    )


def write_exr(path: Path, rgb: np.ndarray) -> None:
    """A float32 EXR without compression: enough of the format for a lookup, so that no library is needed."""
    rgb = np.asarray(rgb, "<f4")
    height, width, _ = rgb.shape

    def integers(*values: int) -> bytes:
        return np.array(values, "<i4").tobytes()

    def attribute(name: str, kind: str, value: bytes) -> bytes:
        return f"{name}\0{kind}\0".encode() + integers(len(value)) + value

    channels = b"".join(c.encode() + b"\0" + integers(2, 0, 1, 1) for c in "BGR") + b"\0"
    box = integers(0, 0, width - 1, height - 1)
    one = np.float32(1).tobytes()
    header = integers(20000630, 2)
    header += attribute("channels", "chlist", channels)
    header += attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", one)
    header += attribute("screenWindowCenter", "v2f", bytes(8))
    header += attribute("screenWindowWidth", "float", one) + b"\0"
    row_bytes = 12 * width
    first = len(header) + 8 * height
    offsets = np.arange(height, dtype="<u8") * (row_bytes + 8) + first
    rows = [integers(y, row_bytes) + rgb[y, :, ::-1].T.tobytes() for y in range(height)]
    path.write_bytes(header + offsets.astype("<u8").tobytes() + b"".join(rows))
