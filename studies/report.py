"""Replaces the measured tables between the markers of a page; the text around them is unchanged."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path


def table(heading: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [heading, ["---"] * len(heading), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def fill(path: Path, sections: dict[str, str]) -> None:
    """Replaces the text between `<!-- measured: NAME -->` and `<!-- end -->` for each section."""
    text = path.read_text(encoding="utf-8")
    for name, content in sections.items():
        start, end = f"<!-- measured: {name} -->\n", "<!-- end -->"
        before, found, rest = text.partition(start)
        _, ended, after = rest.partition(end)
        if not (found and ended):
            raise ValueError(f"{path} has no section {start.strip()} ... {end.strip()}")
        text = before + start + content + "\n" + end + after
    path.write_text(text, encoding="utf-8")
