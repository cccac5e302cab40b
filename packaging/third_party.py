"""What is compiled into the portable modules: its licenses, and a bill of materials (CycloneDX).

Usage: third_party.py wheel|addon TARGET PROJECT PORTABLE OUT NAME=VERSION=SHA256...
TARGET: as scripts/package has it, or "all"; NAME=...: libraries built from fetched source.
Writes OUT/licenses/NAME.txt, OUT/NAME.cdx.json (NAME: of the package), and OUT/holders.json: the licenses (SPDX) and
the holders of copyright, for the extension's manifest.
"""

from __future__ import annotations

import json
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
    holder: str  #: of its copyright, after the years, which Blender asks for
    website: str
    texts: tuple[Path, ...]  #: its license, and the notices of what it holds itself
    version: str
    sha256: str = ""  #: of its source, where it was fetched


def debian(package: str) -> tuple[tuple[Path, ...], str]:
    """License and version of headers that an installed package brings."""
    asked = ["dpkg-query", "-W", "-f", "${Version}", package]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    return (Path("/usr/share/doc", package, "copyright"),), done.stdout


def libraries(target: str, portable: Path, fetched: dict[str, tuple[str, str]]) -> Iterator[Library]:
    """All of them that a target's modules hold."""
    source, highway, tools = portable / "embree_source", portable / "highway_source", portable / "tools"
    notices = (source / "LICENSE.txt", source / "third-party-programs.txt")
    yield Library(
        "embree", "Apache-2.0", "2009-2021 Intel Corporation", "https://www.embree.org", notices, *fetched["embree"]
    )
    site, texts = "https://github.com/google/highway", (highway / "LICENSE",)
    yield Library("highway", "Apache-2.0 OR BSD-3-Clause", "2020 Google LLC", site, texts, *fetched["highway"])
    (license,) = tools.glob("pybind11-*.dist-info/licenses/LICENSE")
    found = python_version("pybind11")
    holder = "2016 Wenzel Jakob and others"
    yield Library("pybind11", "BSD-3-Clause", holder, "https://github.com/pybind/pybind11", (license,), found)
    for name, license, holder, site, package in (
        ("glm", "MIT", "2005-2015 G-Truc Creation", "https://github.com/g-truc/glm", "libglm-dev"),
        ("eigen", "MPL-2.0", "2006-2013 Benoit Jacob and others", "https://eigen.tuxfamily.org", "libeigen3-dev"),
        ("nlohmann_json", "MIT", "2013-2022 Niels Lohmann", "https://github.com/nlohmann/json", "nlohmann-json3-dev"),
        (
            "fast_float",
            "Apache-2.0 OR MIT",
            "2020-2023 Daniel Lemire and others",
            "https://github.com/fastfloat/fast_float",
            "libfast-float-dev",
        ),
    ):
        yield Library(name, license, holder, site, *debian(package))
    # What the compiler links into every module. macOS brings an unwinder; Windows gets a part of the C library.
    lib = tools / "ziglang" / "lib"
    number = re.search(r"_LIBCPP_VERSION (\d\d)(\d\d)(\d\d)", (lib / "libcxx" / "include" / "__config").read_text())
    if number is None:
        sys.exit(f"{lib}/libcxx does not say its version")
    llvm = ".".join(str(int(part)) for part in number.groups())
    holder = "2003-2019 LLVM contributors"
    for name in ("libcxx", "libcxxabi") if target.startswith("macos") else ("libcxx", "libcxxabi", "libunwind"):
        site = f"https://github.com/llvm/llvm-project/{name}"
        yield Library(name, LLVM, holder, site, (lib / name / "LICENSE.TXT",), llvm)
    texts, found = (tools / "ziglang" / "LICENSE",), python_version("ziglang")
    yield Library("zig_compiler_rt", "MIT", "2015-2026 Zig contributors", "https://ziglang.org", texts, found)
    if target in ("windows-x64", "all"):
        site, texts = "https://www.mingw-w64.org", (lib / "libc" / "mingw" / "COPYING",)
        yield Library("mingw_w64", "ZPL-2.1", "2009-2013 mingw-w64 project", site, texts, f"zig-{found}")


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


def holders(held: list[Library]) -> dict[str, list[str]]:
    """What the extension's manifest says of them: Blender's sites know licenses by SPDX names without exceptions."""
    names = {name.partition(" WITH ")[0] for library in held for name in library.license.split(" OR ")}
    copyright: dict[str, list[str]] = {}
    for library in held:
        copyright.setdefault(library.holder, []).append(library.name)
    return {
        "license": sorted(f"SPDX:{name}" for name in names),
        "copyright": [f"{holder} ({', '.join(names)})" for holder, names in copyright.items()],
    }


def main(package: str, target: str, project: Path, portable: Path, out: Path, *fetched: str) -> None:
    sources = {name: (number, digest) for name, number, digest in (each.split("=") for each in fetched)}
    number = re.search(r"project\(skinglow VERSION ([0-9.]+)", (project / "CMakeLists.txt").read_text())[1]
    shutil.rmtree(out, ignore_errors=True)
    (out / "licenses").mkdir(parents=True)
    held = []
    compiled_in = list(libraries(target, portable, sources))
    (out / "holders.json").write_text(json.dumps(holders(compiled_in)))
    for library in compiled_in:
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


main(*sys.argv[1:3], *map(Path, sys.argv[3:6]), *sys.argv[6:])
