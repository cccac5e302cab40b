"""What is compiled into the portable modules: its licenses, and a bill of materials (CycloneDX).

Usage: third_party.py wheel|addon PROJECT PORTABLE OUT NAME=VERSION=SHA256...    (libraries built from fetched source)
Writes OUT/licenses/NAME.txt and OUT/NAME.cdx.json, NAME that of the package.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from datetime import datetime, timezone
from importlib.metadata import version as python_version
from pathlib import Path
from typing import NamedTuple
from uuid import NAMESPACE_URL, uuid5

from cyclonedx.model import ExternalReference, ExternalReferenceType, HashAlgorithm, HashType, XsUri
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output import make_outputter
from cyclonedx.schema import OutputFormat, SchemaVersion

LLVM = "Apache-2.0 WITH LLVM-exception"


class Library(NamedTuple):
    """A library whose code is in the modules."""

    name: str
    license: str  #: SPDX expression
    website: str
    texts: tuple[Path, ...]  #: its license, and the notices of what it holds itself
    version: str
    sha256: str = ""  #: of its source, where it was fetched


def debian(package: str) -> tuple[tuple[Path, ...], str]:
    """License and version of headers that an installed package brings."""
    asked = ["dpkg-query", "-W", "-f", "${Version}", package]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    return (Path("/usr/share/doc", package, "copyright"),), done.stdout


def libraries(portable: Path, fetched: dict[str, tuple[str, str]]) -> Iterator[Library]:
    """All of them."""
    source, highway, tools = portable / "embree_source", portable / "highway_source", portable / "tools"
    notices = (source / "LICENSE.txt", source / "third-party-programs.txt")
    yield Library("embree", "Apache-2.0", "https://www.embree.org", notices, *fetched["embree"])
    site, texts = "https://github.com/google/highway", (highway / "LICENSE",)
    yield Library("highway", "Apache-2.0 OR BSD-3-Clause", site, texts, *fetched["highway"])
    (license,) = tools.glob("pybind11-*.dist-info/licenses/LICENSE")
    found = python_version("pybind11")
    yield Library("pybind11", "BSD-3-Clause", "https://github.com/pybind/pybind11", (license,), found)
    for name, license, site, package in (
        ("glm", "MIT", "https://github.com/g-truc/glm", "libglm-dev"),
        ("eigen", "MPL-2.0", "https://eigen.tuxfamily.org", "libeigen3-dev"),
        ("nlohmann_json", "MIT", "https://github.com/nlohmann/json", "nlohmann-json3-dev"),
        ("fast_float", "Apache-2.0 OR MIT", "https://github.com/fastfloat/fast_float", "libfast-float-dev"),
    ):
        yield Library(name, license, site, *debian(package))
    # What the compiler links into every module.
    lib = tools / "ziglang" / "lib"
    number = re.search(r"_LIBCPP_VERSION (\d\d)(\d\d)(\d\d)", (lib / "libcxx" / "include" / "__config").read_text())
    if number is None:
        sys.exit(f"{lib}/libcxx does not say its version")
    llvm = ".".join(str(int(part)) for part in number.groups())
    for name in ("libcxx", "libcxxabi", "libunwind"):
        yield Library(name, LLVM, f"https://github.com/llvm/llvm-project/{name}", (lib / name / "LICENSE.TXT",), llvm)
    texts, found = (tools / "ziglang" / "LICENSE",), python_version("ziglang")
    yield Library("zig_compiler_rt", "MIT", "https://ziglang.org", texts, found)


def component(library: Library) -> Component:
    links = [ExternalReference(type=ExternalReferenceType.WEBSITE, url=XsUri(library.website))]
    if library.sha256:
        digest = HashType(alg=HashAlgorithm.SHA_256, content=library.sha256)
        source = {"type": ExternalReferenceType.SOURCE_DISTRIBUTION, "url": XsUri("https://deb.debian.org/debian")}
        links.append(ExternalReference(**source, hashes=[digest]))
    return Component(
        type=ComponentType.LIBRARY,
        name=library.name,
        bom_ref=library.name,
        version=library.version,
        licenses=[LicenseExpression(library.license)],
        external_references=links,
    )


def bill(root: Component, held: list[Component]) -> str:
    """The text of a bill of materials."""
    # The same bill each time: with the date of all packages, and a number by what it tells.
    when = datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), timezone.utc)
    told = " ".join(f"{part.name} {part.version}" for part in (root, *held))
    bom = Bom(components=held, serial_number=uuid5(NAMESPACE_URL, told))
    bom.metadata.timestamp = when
    bom.metadata.component = root
    bom.register_dependency(root, held)
    return make_outputter(bom, OutputFormat.JSON, SchemaVersion.V1_6).output_as_string(indent=1)


def main(package: str, project: Path, portable: Path, out: Path, *fetched: str) -> None:
    sources = {name: (number, digest) for name, number, digest in (each.split("=") for each in fetched)}
    number = re.search(r"project\(skinglow VERSION ([0-9.]+)", (project / "CMakeLists.txt").read_text())[1]
    shutil.rmtree(out, ignore_errors=True)
    (out / "licenses").mkdir(parents=True)
    held = []
    for library in libraries(portable, sources):
        # As they are, to the byte: not all are UTF-8.
        texts = [text.read_bytes() for text in library.texts]
        (out / "licenses" / f"{library.name}.txt").write_bytes(b"\n\n".join(texts))
        held.append(component(library))
    core = {"name": "skinglow", "version": number, "licenses": [LicenseExpression("Apache-2.0")]}
    if package == "wheel":
        root = Component(type=ComponentType.LIBRARY, bom_ref="skinglow", **core)
    else:
        root = Component(
            type=ComponentType.APPLICATION,
            name="skinglow_blender",
            bom_ref="skinglow_blender",
            version=number,
            licenses=[LicenseExpression("GPL-3.0-or-later")],
        )
        held.append(Component(type=ComponentType.LIBRARY, bom_ref="skinglow", **core))
    (out / f"{root.name}.cdx.json").write_text(bill(root, held) + "\n", encoding="utf-8")


main(sys.argv[1], *map(Path, sys.argv[2:5]), *sys.argv[5:])
