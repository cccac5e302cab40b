"""What the pages name is there: links and their headings, options, and names of the code."""

import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
#: Names of others' programs, and those that are made up.
OTHERS = {"--max-retries-per-task", "Segmentation", "SetThreadIdealProcessorEx", "WHAT_IT_IS"}


def headings(page: Path) -> set[str]:
    """The anchors of a page, as GitHub and packaging/manual.py make them."""
    titles = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if link.startswith("https://"):
            continue
        name, _, anchor = link.partition("#")
        target = page.parent / name if name else page
        assert target.exists(), link
        assert not anchor or anchor in headings(target), link


@cache
def sources() -> str:
    """All text of the project but its pages."""
    folders = ("core", "python_bindings", "blender_addon", "povray_macros", "studies", "packaging", "tests")
    kinds = (".py", ".pyi", ".h", ".cpp", ".inc", ".pov", ".js", ".sh", ".txt", ".in", ".toml", ".json", ".cmake")
    files = [
        *(ROOT / "scripts").glob("*"),
        *ROOT.glob("CMake*"),
        *(file for folder in folders for file in (ROOT / folder).rglob("*")),
    ]
    left_out = {"corpus", "__pycache__"}
    return "\n".join(
        file.read_text()
        for file in files
        if (file.suffix in kinds or file.parent.name == "scripts")
        and file.is_file()
        and not left_out & {*file.parts}
        and file != Path(__file__)
    )


@pytest.mark.parametrize("page", [p for p in PAGES if p.name != "CHANGELOG.md"], ids=lambda page: page.name)
def test_options_and_names_are_those_of_the_code(page: Path) -> None:
    """An option, or a name with an underscore in code, that nothing has any more was renamed or removed."""
    text = page.read_text()
    options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+[a-z]", text))
    code = " ".join(re.findall(r"`([^`]+)`", re.sub(r"^```\w*$", "", text, flags=re.M)))
    files = set(re.findall(r"[\w/*.-]+\.[a-z]+\b", code))
    names = {word for word in re.findall(r"[A-Za-z]\w*_\w*\w", code) if not any(word in file for file in files)}
    missing = {word for word in options | names if word not in sources()} - OTHERS
    assert not missing
