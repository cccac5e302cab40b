"""What users install: wheels for any Linux that Blender runs on, and the add-on by Blender's own installer.

scripts/package makes the packages; SKINGLOW_PACKAGES says where they are.
"""

import importlib.util
import json
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from hosts import HERE, HOSTS, Host
from installation import PACKAGES
from package_in_use import check_installed_and_used

PROJECT = HERE.parents[1]
#: Blender asks for glibc 2.28 from 4.2 on.
GLIBC = (2, 28)
#: The C library and its parts: there on every Linux.
SYSTEM_LIBRARIES = {
    "libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2",
}  # fmt: skip
#: Whose code is in the modules, of all targets and of those for some.
THIRD_PARTY = {
    "embree", "highway", "pybind11", "glm", "eigen", "nlohmann_json", "fast_float",
    "libcxx", "libcxxabi", "zig_compiler_rt",
}  # fmt: skip
MORE_THIRD_PARTY = {"manylinux": {"libunwind"}, "linux-x64": {"libunwind"}, "win_amd64": {"libunwind", "mingw_w64"}}


def packages(pattern: str) -> list[Path]:
    found = sorted(PACKAGES.glob(pattern))
    assert found, f"no {pattern} in {PACKAGES}: scripts/package makes it"
    return found


def third_party(package: Path) -> set[str]:
    return THIRD_PARTY.union(*(more for mark, more in MORE_THIRD_PARTY.items() if mark in package.name))


def modules(wheel: Path, folder: Path) -> list[Path]:
    with zipfile.ZipFile(wheel) as archive:
        return [Path(archive.extract(name, folder)) for name in archive.namelist() if name.endswith(".so")]


def zips() -> tuple[Path, Path]:
    """The extension for Blender 4.2 and later, the add-on for those before."""
    (legacy,) = packages("skinglow_blender-*-legacy-*-linux-x64.zip")
    (extension,) = [path for path in packages("skinglow_blender-*-linux-x64.zip") if path != legacy]
    return extension, legacy


def objdump(*arguments: str) -> str:
    return subprocess.run(["objdump", *arguments], capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("python", ["cp311", "cp313"])
def test_wheel_runs_on_any_linux(python: str, tmp_path: Path) -> None:
    (wheel,) = packages(f"skinglow-*-{python}-{python}-manylinux*.whl")
    tag = re.search(r"manylinux_2_(\d+)_x86_64", wheel.name)
    assert tag and int(tag[1]) <= GLIBC[1], wheel.name
    found = modules(wheel, tmp_path)
    assert sorted(path.name.split(".")[0] for path in found) == ["_core", "_rays"]
    for module in found:
        needed = set(re.findall(r"NEEDED\s+(\S+)", objdump("-p", str(module))))
        assert needed <= SYSTEM_LIBRARIES, f"{module.name} needs {needed - SYSTEM_LIBRARIES}"
        symbols = objdump("-T", str(module))
        asked = {tuple(map(int, version.split("."))) for version in re.findall(r"GLIBC_([\d.]+)", symbols)}
        assert asked and max(asked) <= (2, int(tag[1])), f"{module.name} needs glibc {max(asked)}"
        unversioned = re.findall(r"\*UND\*\s+[0-9a-f]+\s+(\w+)$", symbols, re.MULTILINE)
        assert not [name for name in unversioned if not re.match("_?Py", name)], f"{module.name} lacks a part"
        # Nothing to be taken for a host's own Embree, TBB or C++ library.
        shown = [line.split()[-1] for line in symbols.splitlines() if " g " in line and "*UND*" not in line]
        assert shown == [f"PyInit_{module.name.split('.')[0]}"]


@pytest.mark.parametrize("python", ["cp311", "cp313"])
def test_wheel_brings_its_licenses_and_nothing_else(python: str) -> None:
    (wheel,) = packages(f"skinglow-*-{python}-{python}-manylinux*.whl")
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    assert {name.split("/")[0].split("-")[0] for name in names} == {"skinglow"}
    assert {Path(name).stem for name in names if re.search("/licenses/third_party/.", name)} == third_party(wheel)


def test_bills_of_materials_and_licenses_tell_all_that_is_compiled_in() -> None:
    """In each package; what zips of wheels hold is told by the zip itself, too."""
    wheels = [(path, "skinglow-*.dist-info/sboms/skinglow.cdx.json", set()) for path in packages("skinglow-*.whl")]
    held = [*wheels, *((path, "*skinglow_blender.cdx.json", {"skinglow"}) for path in zips())]
    for path, bill, more in held:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            texts = {Path(name).stem: archive.read(name) for name in names if re.search("licenses/third_party/.", name)}
            (bill,) = [name for name in names if Path(name).match(bill) and "/lib/" not in name]
            told = json.loads(archive.read(bill))
        assert set(texts) == third_party(path) and all(len(text) > 1000 for text in texts.values()), path.name
        assert b"Intel(R) Embree" in texts["embree"] or b"third" in texts["embree"].lower()
        assert told["bomFormat"] == "CycloneDX" and told["metadata"]["component"]["version"] in path.name
        components = {part["name"]: part for part in told["components"]}
        assert set(components) == third_party(path) | more, path.name
        for part in components.values():
            assert part["version"] and part["licenses"][0]["expression"], part
        digests = [
            link for part in components.values() for link in part.get("externalReferences", ()) if "hashes" in link
        ]
        assert len(digests) == 2  # of the sources that were fetched


def test_source_package_holds_just_what_builds_it() -> None:
    (source,) = packages("skinglow-*.tar.gz")
    with tarfile.open(source) as archive:
        names = {Path(*Path(name).parts[1:]) for name in archive.getnames()}
    alone = {"CHANGELOG.md", "CMakeLists.txt", "LICENSE", "PKG-INFO", "README.md", "pyproject.toml"}
    assert {path.parts[0] for path in names} == alone | {"core", "povray_macros", "python_bindings"}
    assert Path("core/include/skinglow/light.h") in names and Path("python_bindings/skinglow/__main__.py") in names


def test_what_pip_fetches_is_pinned_by_digests() -> None:
    pins = PROJECT / "packaging" / "pins"
    lists = sorted(pins.glob("*.in"))
    assert len(lists) > 8 and {path.stem for path in lists} == {path.stem for path in pins.glob("*.txt")}
    for path in lists:
        lines = path.with_suffix(".txt").read_text().replace("\\\n", " ").splitlines()
        pinned = [line for line in lines if line and not line.startswith("#")]
        assert pinned and all(re.match(r"[\w.-]+==[\w.]+ .*--hash=sha256:\w{64}$", line) for line in pinned), path.name
        wanted = [re.match(r"[\w.-]+", line)[0] for line in path.read_text().splitlines()[1:]]
        assert set(wanted) <= {line.partition("==")[0] for line in pinned}, path.name
    scripts = [*(PROJECT / "scripts").iterdir(), *PROJECT.glob("packaging/*.sh"), *PROJECT.glob("tests/platforms/*.sh")]
    fetching = "".join(path.read_text() for path in scripts)
    installs = re.findall(r"pip\"? install(?:[^\n]*\\\n)*[^\n]*", fetching)
    assert installs and all("--require-hashes" in call or "--no-index" in call for call in installs), installs


def test_zips_hold_the_addon_and_no_leftovers() -> None:
    root = PROJECT / "blender_addon"
    sources = {path.relative_to(root) for path in root.glob("skinglow_blender/**/*.py")}
    extension, legacy = zips()
    for path, inside in ((legacy, Path()), (extension, Path("skinglow_blender"))):
        with zipfile.ZipFile(path) as archive:
            held = {inside / name for name in archive.namelist() if not name.endswith("/")}
        # An extension gets the core as a wheel, and needs no search path of its own.
        wanted = sources if path == legacy else sources - {Path("skinglow_blender/bundled_core.py")}
        assert wanted <= held, f"{path.name} lacks {wanted - held}"
        assert Path("skinglow_blender/LICENSE") in held
        assert not [name for name in held if "__pycache__" in name.parts]
        code = {name for name in held if name.suffix == ".py" and "lib" not in name.parts}
        assert code == wanted, f"{path.name} holds {code - wanted}"
        with zipfile.ZipFile(path) as archive:
            text = archive.read(str(Path("skinglow_blender/__init__.py").relative_to(inside))).decode()
        assert ("bl_info" in text) == ("bundled_core" in text) == (path == legacy)


def test_legacy_addon_says_which_pythons_it_is_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = shutil.copy(PROJECT / "blender_addon/skinglow_blender/bundled_core.py", tmp_path)
    (tmp_path / "lib/skinglow").mkdir(parents=True)
    (tmp_path / "lib/skinglow/_core.cpython-39-x86_64-linux-gnu.so").touch()
    spec = importlib.util.spec_from_file_location("bundled_core", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(sys, "path", sys.path[:])
    with pytest.raises(RuntimeError, match=r"3.9 on Linux \(x86_64\); this Blender brings Python 3.*on Linux"):
        module.register()
    assert str(tmp_path / "lib") not in sys.path


def test_zips_hold_the_manual() -> None:
    """Its first page, and everything that its pages show and link to, but for other sites."""
    for path in zips():
        with zipfile.ZipFile(path) as archive:
            names = [name for name in archive.namelist() if "/manual/" in f"/{name}" and not name.endswith("/")]
            pages = {name: archive.read(name).decode() for name in names if name.endswith(".html")}
        (first,) = (name for name in pages if name.endswith("manual/blender.html"))
        folder = Path(first).parent
        assert "<h1" in pages[first] and "Make Skin Glow" in pages[first]
        for page, text in pages.items():
            shown = re.findall(r'src="([^"]+)"', text)
            for target in shown + re.findall(r'href="(?!https://)([^"]+)"', text):
                name, _, anchor = target.partition("#")
                linked = (folder / name).as_posix() if name else page
                assert linked in names, f"{path.name}: {page} links to {target}"
                assert not anchor or f'id="{anchor}"' in pages[linked], f"{path.name}: {page} links to {target}"
        assert any(name.endswith(".png") for name in names)


@pytest.mark.parametrize("host", HOSTS, ids=lambda host: host.name)
def test_installed_by_blender_and_used_without_the_project(host: Host, tmp_path: Path) -> None:
    extension, legacy = zips()
    check_installed_and_used(host, legacy if host.is_program else extension, tmp_path)
