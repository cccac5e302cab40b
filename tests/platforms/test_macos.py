"""The wheels for macOS, which nothing on this machine can run: what macOS' loader would look for is read from the
finished modules, and held against the list of what macOS 11 has and against a Python for macOS; the signature is
computed again.
"""

import hashlib
import re
import struct
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import lief
import pytest
import yaml
from installation import PACKAGES

PORTABLE = Path(__file__).parents[2] / "build" / "portable"
WHEELS = sorted(PACKAGES.glob("skinglow-*-macosx_*.whl"))
#: As Mach-O has it: the symbol is looked up in all that the process has loaded.
ANY_LIBRARY = -2
SYSTEM_LIBRARY = "/usr/lib/libSystem.B.dylib"
#: Of <mach-o/loader.h>; of Apple's <kern/cs_blobs.h>: magic numbers, the flags of a signature by a linker, SHA-256.
WEAK_DEFINES, BINDS_TO_WEAK = 0x8000, 0x10000
SUPERBLOB, CODE_DIRECTORY, ADHOC_BY_LINKER, SHA256 = 0xFADE0CC0, 0xFADE0C02, 0x20002, 2


class Module(NamedTuple):
    """A compiled module of a wheel."""

    name: str
    python: str  #: say "3.11"
    arch: str  #: arm64 or x86_64
    data: bytes
    file: lief.MachO.FatBinary  #: which owns the binary: without it that is freed
    binary: lief.MachO.Binary

    def imports(self) -> dict[str, int]:
        """Each symbol that is looked up when the module is loaded or used, and in which library: 1 is the first."""
        return {found.symbol.name: found.library_ordinal for found in self.binary.bindings if found.has_symbol}


def read(name: str, python: str, arch: str, data: bytes) -> Module:
    file = lief.MachO.parse(list(data))
    assert file.size == 1
    return Module(name, python, arch, data, file, file.at(0))


def modules_of(wheel: Path) -> Iterator[Module]:
    digits, arch = re.search(r"-cp3(\d+)-macosx_11_0_(\w+)\.whl$", wheel.name).groups()
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            if name.endswith(".so"):
                yield read(Path(name).name, f"3.{digits}", arch, archive.read(name))


MODULES = [module for wheel in WHEELS for module in modules_of(wheel)]


@pytest.fixture(params=MODULES, ids=lambda module: f"{module.name}-{module.arch}")
def module(request: pytest.FixtureRequest) -> Module:
    return request.param


def test_both_modules_of_each_wheel_are_there() -> None:
    assert any("cp311-macosx_11_0_arm64" in wheel.name for wheel in WHEELS), "scripts/package macos-arm64 makes it"
    held = [(module.name, module.arch) for module in MODULES]
    names = [re.search(r"-cp(\d+)-macosx_11_0_(\w+)\.whl$", wheel.name).groups() for wheel in WHEELS]
    assert held == [(f"{part}.cpython-{tag}-darwin.so", arch) for tag, arch in names for part in ("_core", "_rays")]


def test_is_a_bundle_for_that_processor_and_macos_11(module: Module) -> None:
    binary = module.binary
    assert binary.header.file_type == lief.MachO.Header.FILE_TYPE.BUNDLE
    kinds = {"arm64": lief.MachO.Header.CPU_TYPE.ARM64, "x86_64": lief.MachO.Header.CPU_TYPE.X86_64}
    assert binary.header.cpu_type == kinds[module.arch]
    assert binary.build_version.platform == lief.MachO.BuildVersion.PLATFORMS.MACOS
    assert binary.build_version.minos == [11, 0, 0]
    assert [library.name for library in binary.libraries] == [SYSTEM_LIBRARY]


def test_exports_its_entry_point_alone(module: Module) -> None:
    assert [symbol.name for symbol in module.binary.exported_symbols] == [f"_PyInit_{module.name.split('.')[0]}"]


def test_no_symbol_is_weak(module: Module) -> None:
    """The loader would take a weak one from any library in the process; Blender brings an Embree and a C++ library."""
    binary = module.binary
    assert not binary.header.flags & (WEAK_DEFINES | BINDS_TO_WEAK)
    weak = lief.MachO.DyldBindingInfo.CLASS.WEAK
    assert not [found.symbol.name for found in binary.bindings if found.binding_class == weak or found.weak_import]


def test_looks_for_nothing_that_macos_11_or_python_lacks(module: Module) -> None:
    imports = module.imports()
    of_python = {name for name, library in imports.items() if library == ANY_LIBRARY}
    of_system = {name for name, library in imports.items() if library == 1}
    assert len(imports) == len(of_python) + len(of_system) and len(of_python) > 50 and len(of_system) > 50
    assert not of_python - python_symbols(module.python)
    assert not of_system - system_symbols(module.arch)


def python_symbols(version: str) -> set[str]:
    (library,) = PORTABLE.glob(f"python_macos_{version}/libpython{version}.dylib")
    file = lief.MachO.parse(str(library))
    return {symbol.name for symbol in file.at(0).exported_symbols}


def system_symbols(arch: str) -> set[str]:
    """What macOS 11 exports to that processor, by Apple's text-based list of it."""
    yaml.SafeLoader.add_constructor("!tapi-tbd", lambda loader, node: loader.construct_mapping(node, deep=True))
    found = set()
    for library in yaml.safe_load_all((PORTABLE / "libSystem.11.tbd").read_text()):
        for part in library.get("exports", []) + library.get("reexports", []):
            if f"{arch}-macos" in part["targets"]:
                for kind in ("symbols", "weak-symbols", "thread-local-symbols"):
                    found |= set(part.get(kind, ()))
    return found


def test_list_of_the_system_is_read() -> None:
    for arch in ("arm64", "x86_64"):
        assert {"_malloc", "_pthread_create", "__tlv_bootstrap"} <= system_symbols(arch)
        assert "_no_such_function" not in system_symbols(arch)


def faults_of_signature(module: Module) -> list[str]:
    """What macOS on Apple's processors, which loads nothing that is not signed, would find wrong with it."""
    if not module.binary.has_code_signature:
        return ["there is none"]
    command, data = module.binary.code_signature, module.data
    start, size = command.data_offset, command.data_size
    faults = [] if start + size == len(data) else ["it is not at the end"]
    magic, _, count = struct.unpack_from(">3I", data, start)
    if magic != SUPERBLOB:
        return [*faults, f"it begins with {magic:#x}"]
    slots = [struct.unpack_from(">2I", data, start + 12 + 8 * i) for i in range(count)]
    (directory,) = [start + at for _, at in slots if struct.unpack_from(">I", data, start + at)[0] == CODE_DIRECTORY]
    fields = struct.unpack_from(">9I4B", data, directory)
    flags, hashes, pages, limit, length, kind, page = (fields[i] for i in (3, 4, 7, 8, 9, 10, 12))
    if (flags, kind, length) != (ADHOC_BY_LINKER, SHA256, 32):
        faults.append(f"flags {flags:#x}, hashes of kind {kind} and {length} bytes")
    if limit != start or pages != -(-limit >> page):
        faults.append(f"{pages} pages to byte {limit}, where it begins at {start}")
    for i in range(pages):
        piece = data[i << page : min((i + 1) << page, limit)]
        at = directory + hashes + 32 * i
        if hashlib.sha256(piece).digest() != data[at : at + 32]:
            faults.append(f"page {i} has another hash")
    return faults


def test_signature_is_of_these_bytes(module: Module) -> None:
    assert faults_of_signature(module) == []
    # And the check sees a byte that was changed after the linker signed.
    changed = bytearray(module.data)
    changed[len(changed) // 2] ^= 1
    (fault,) = faults_of_signature(module._replace(data=bytes(changed)))
    assert "another hash" in fault
