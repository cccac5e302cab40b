"""The wheels for macOS, by what can be seen of them without a Mac: nothing here runs them."""

import zipfile
from dataclasses import replace
from pathlib import Path

import mach_o
import pytest
from installation import PACKAGES

PORTABLE = Path(__file__).parents[2] / "build" / "portable"
SYSTEM = "/usr/lib/libSystem.B.dylib"
WHEELS = [("arm64", "311"), ("arm64", "313"), ("x86_64", "311")]


@pytest.fixture(params=[(*wheel, name) for wheel in WHEELS for name in ("_core", "_rays")], ids="-".join)
def module(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[mach_o.Module, str, str]:
    architecture, python, name = request.param
    (wheel,) = PACKAGES.glob(f"skinglow-*-cp{python}-cp{python}-macosx_11_0_{architecture}.whl")
    with zipfile.ZipFile(wheel) as archive:
        held = [entry for entry in archive.namelist() if entry.endswith((".so", ".dylib", ".pyd"))]
        assert sorted(held) == [f"skinglow/{each}.cpython-{python}-darwin.so" for each in ("_core", "_rays")]
        path = Path(archive.extract(f"skinglow/{name}.cpython-{python}-darwin.so", tmp_path))
    module = mach_o.read(path)
    assert module.architecture == architecture
    return module, python, name


def test_is_a_bundle_for_macos_11_that_needs_the_system_alone(module: tuple) -> None:
    found, _, _ = module
    assert found.file_type == mach_o.BUNDLE and found.minimum_macos == (11, 0)
    assert found.libraries == [SYSTEM]


def test_shows_its_entry_point_alone_and_takes_nothing_of_others(module: tuple) -> None:
    """A weak symbol would be bound to whichever module has it first, and Blender has the same libraries."""
    found, _, name = module
    assert found.exports == {f"_PyInit_{name}"}
    assert found.weak_bind_bytes == 0
    assert not found.flags & (mach_o.WEAK_DEFINES | mach_o.BINDS_TO_WEAK)


def test_what_it_asks_for_is_there(module: tuple) -> None:
    """Of Python what a real one has, all else in the list of macOS 11."""
    found, python, _ = module
    looked_up = {name for name, library in found.imports.items() if library == mach_o.DYNAMIC_LOOKUP}
    of_system = found.imports.keys() - looked_up
    version = f"{python[0]}.{python[1:]}"
    (libpython,) = (PORTABLE / f"python_macos_{version}").rglob(f"libpython{version}.dylib")
    theirs, system = mach_o.defined_symbols(libpython), mach_o.listed_symbols(PORTABLE / "libSystem.11.tbd")
    assert len(looked_up) > 50 and len(theirs) > 1000 and len(of_system) > 50 and len(system) > 5000
    assert not looked_up - theirs, f"Python {version} lacks them"
    assert not of_system - system, "macOS 11 lacks them"


def test_its_signature_is_that_of_its_pages(module: tuple) -> None:
    found, _, _ = module
    assert mach_o.wrong_pages(found) == []
    # A bit that changes is seen, or this test sees nothing.
    damaged = bytearray(found.data)
    damaged[5000] ^= 1
    assert mach_o.wrong_pages(replace(found, data=bytes(damaged))) == [f"page {5000 // 4096}"]


@pytest.mark.parametrize(("target", "pythons"), [("macos-arm64", {"cp311", "cp313"}), ("macos-x64", {"cp311"})])
def test_extension_holds_its_wheels(target: str, pythons: set[str]) -> None:
    (package,) = PACKAGES.glob(f"skinglow_blender-*-{target}.zip")
    with zipfile.ZipFile(package) as archive:
        names = [Path(name).name for name in archive.namelist() if name.endswith(".whl")]
        manifest = archive.read("blender_manifest.toml").decode()
    assert {name.split("-")[2] for name in names if name.startswith("skinglow-")} == pythons
    assert f'platforms = ["{target}"]' in manifest
