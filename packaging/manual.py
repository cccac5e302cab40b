"""Makes the manual in the add-on's packages: the pages of docs that are about Blender, as HTML with their images.

Usage: manual.py PROJECT FOLDER   (by a Python that finds markdown-it-py)
"""

import html
import re
import shutil
import sys
from itertools import pairwise
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

#: Pages of docs; the first is the one that the add-on opens. Links to other pages become plain text.
PAGES = ("blender.md", "blender_*.md", "batch.md", "farm.md", "rig_format.md")
FRAME = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ max-width: 60em; margin: 2em auto; padding: 0 1em; font: 16px/1.5 sans-serif; color: #222; }}
img {{ max-width: 100%; }}
table {{ border-collapse: collapse; }}
th, td {{ border: 1px solid #bbb; padding: 0.3em 0.6em; text-align: left; vertical-align: top; }}
pre, code {{ font-family: monospace; background: #f2f2f2; }}
pre {{ padding: 0.6em; overflow-x: auto; }}
</style>
</head>
<body>
{body}</body>
</html>
"""


def main(project: Path, folder: Path) -> None:
    docs = project / "docs"
    pages = [path for pattern in PAGES for path in sorted(docs.glob(pattern))]
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for page in pages:
        write_page(page, {each.name for each in pages}, folder)


def write_page(page: Path, names: set[str], folder: Path) -> None:
    parser = MarkdownIt("commonmark").enable("table")
    tokens = parser.parse(page.read_text())
    headings = [(token, after.content) for token, after in pairwise(tokens) if token.type == "heading_open"]
    title = headings[0][1]
    for token, text in headings:
        token.attrSet("id", anchor_of(text))
    for token in tokens:
        if token.children:
            token.children = linked(token.children, names)
            for image in (each for each in token.children if each.type == "image"):
                copy_image(page.parent, str(image.attrGet("src")), folder)
    body = parser.renderer.render(tokens, parser.options, {})
    (folder / page.with_suffix(".html").name).write_text(FRAME.format(title=html.escape(title), body=body))


def anchor_of(heading: str) -> str:
    """As the pages' own links have it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def linked(children: list[Token], names: set[str]) -> list[Token]:
    """The parts of a paragraph, with links to the manual's pages, and none to what is not part of it."""
    kept, dropped = [], False
    for token in children:
        if token.type == "link_open":
            name, _, anchor = str(token.attrGet("href")).partition("#")
            dropped = name not in names and name != "" and "://" not in name
            if name in names:
                token.attrSet("href", Path(name).with_suffix(".html").name + (f"#{anchor}" if anchor else ""))
        if not (dropped and token.type in ("link_open", "link_close")):
            kept.append(token)
        if token.type == "link_close":
            dropped = False
    return kept


def copy_image(docs: Path, source: str, folder: Path) -> None:
    target = folder / source
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(docs / source, target)


main(*(Path(argument) for argument in sys.argv[1:]))
