"""The rules of the C++ core's layout: floors, public headers, the length of files, the picture of it all."""

import re
from pathlib import Path

import pytest

from studies.architecture import includes

ROOT = Path(__file__).parents[2]
CORE = ROOT / "core"

FLOORS = includes.floors(CORE)
HEADERS = sorted(path.name for path in (CORE / "include" / "skinglow").iterdir())
LINES = 300
#: One compiled module has one stub; test_stubs.py keeps it in step with the module.
STUB_LINES = 500


def lines_allowed(path: Path) -> int:
    return STUB_LINES if path.suffix == ".pyi" else LINES


def height(floor: str) -> int:
    return FLOORS.index(floor)


def test_every_folder_of_the_core_is_a_floor() -> None:
    assert sorted(FLOORS) == sorted(path.name for path in (CORE / "src").iterdir() if path.is_dir())


@pytest.mark.parametrize("floor", FLOORS)
def test_no_include_runs_to_a_higher_floor(floor: str) -> None:
    files = includes.sources(CORE / "src" / floor)
    assert files
    wrong = []
    for path in files:
        for name, is_public in includes.included(path):
            to = includes.PUBLIC[name] if is_public else name.split("/")[0] if "/" in name else floor
            if height(to) > height(floor):
                wrong.append(f"{path.relative_to(CORE)} includes {name}, of the higher floor {to}")
    assert not wrong


def test_every_public_header_has_a_floor() -> None:
    assert set(HEADERS) <= includes.PUBLIC.keys()


@pytest.mark.parametrize("name", HEADERS)
def test_public_header_includes_public_headers_of_its_floor_or_lower(name: str) -> None:
    path = CORE / "include" / "skinglow" / name
    for header, is_public in includes.included(path):
        assert is_public, f"{name} includes the private {header}"
        assert height(includes.PUBLIC[header]) <= height(includes.PUBLIC[name]), f"{name} includes {header}"
    # A program that uses the package has GLM and the standard library, not the libraries that the core is made with.
    others = re.findall(r"#\s*include\s+<((?!skinglow/)[^>]*[/.][^>]*)>", path.read_text())
    assert not [other for other in others if not other.startswith("glm/")]


def test_no_file_is_long() -> None:
    suffixes = (".h", ".cpp", ".py", ".pyi", ".cmake", ".txt")
    files = [
        path
        for folder in ("core", "python_bindings", "tests")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in suffixes and "__pycache__" not in path.parts
    ]
    assert len(files) > 100
    long = {path for path in files if len(path.read_text().splitlines()) > lines_allowed(path)}
    assert not {str(path.relative_to(ROOT)) for path in long}


def test_picture_of_the_architecture_is_up_to_date() -> None:
    picture = (ROOT / "docs" / "images" / "architecture.svg").read_text()
    assert includes.arrows_text(CORE).replace(">", "&gt;") in picture, "run python -m studies architecture"


ADDON = ROOT / "blender_addon" / "skinglow_blender"
#: The add-on's folders, lowest first: a module imports from its own folder, from lower ones and from the add-on's root.
ADDON_FLOORS = ("read", "thickness", "table", "show", "live", "commands", "batch", "farm", "ui")


def test_every_folder_of_the_addon_is_a_floor() -> None:
    assert sorted(ADDON_FLOORS) == sorted(path.parent.name for path in ADDON.glob("*/__init__.py"))


@pytest.mark.parametrize("floor", ("", *ADDON_FLOORS))
def test_no_import_of_the_addon_runs_to_a_higher_floor(floor: str) -> None:
    files = [path for path in (ADDON / floor).glob("*.py") if path != ADDON / "__init__.py"]
    assert files
    wrong = []
    for path in files:
        # What is imported for type annotations alone does not count.
        text = re.sub(r"^if TYPE_CHECKING:\n(    .*\n|\n(?=    ))+", "", path.read_text(), flags=re.MULTILINE)
        for module in re.findall(r"from \.\.(\w+)" if floor else r"from \.(\w+)", text):
            allowed = ADDON_FLOORS[: ADDON_FLOORS.index(floor)] if floor else ()
            if module in ADDON_FLOORS and module not in allowed:
                wrong.append(f"{path.relative_to(ADDON)} imports {module}")
    assert not wrong


#: Modules by which a program uses the network, or starts another program that might.
NETWORK = set(
    "asyncio email ftplib http httpx imaplib multiprocessing poplib requests select selectors smtplib socket "
    "socketserver ssl subprocess telnetlib urllib urllib3 webbrowser xmlrpc".split()
)


#: Starts POV-Ray and the programs that compare its pictures, when asked to, and none other.
STARTS_PROGRAMS = ("povray_run.py", "subprocess")


def test_the_addon_has_no_network_code() -> None:
    found = set()
    for path in (ROOT / "blender_addon").rglob("*.py"):
        text = path.read_text()
        found |= {(path.name, module) for module in re.findall(r"^\s*(?:from|import) (\w+)", text, flags=re.MULTILINE)}
    assert len({module for _path, module in found}) > 20
    assert [each for each in found if each[1] in NETWORK] == [STARTS_PROGRAMS]
    manifest = (ROOT / "blender_addon" / "blender_manifest.toml.in").read_text()
    permissions = manifest[manifest.index("[permissions]") :].split()
    assert permissions.count("=") == 1 and permissions[1] == "files"
