# SPDX-License-Identifier: GPL-3.0-or-later
"""The files that a render reads, as far as Blender and their own text name them."""

import os
import re
from collections.abc import Iterator
from pathlib import Path

import bpy

USD_SUFFIXES = (".usd", ".usda")
#: How text of USD names another file: layers, references, payloads, textures.
_USD_ASSET = re.compile(rb"@([^@\n]+)@")


def input_files() -> list[Path]:
    """The blend file, its libraries and every file that it reads: images with their tiles and frames, movies, volumes,
    Alembic and USD caches with their layers, IES profiles, fonts, and the folders of baked simulations.

    Files that do not exist are left out; so are those that binary USD and paths in Geometry Nodes name.
    """
    named = {bpy.data.filepath} if bpy.data.filepath else set()
    named.update(bpy.utils.blend_paths(absolute=True, packed=False, local=False))
    for owner in (*bpy.data.images, *bpy.data.movieclips, *bpy.data.volumes, *bpy.data.cache_files):
        if is_sequence(owner):
            named.update(_numbered(bpy.path.abspath(owner.filepath, library=owner.library)))
    for cache in bpy.data.cache_files:
        named.update(bpy.path.abspath(layer.filepath, library=cache.library) for layer in cache.layers)
    named.add(_bakes_folder())
    found: dict[Path, None] = {}
    for path in sorted(each for name in named if name for each in _of_name(name)):
        _add(path, found)
    return sorted(found)


def _bakes_folder() -> str:
    """Where Blender puts point caches and baked geometry nodes unless it is told another folder."""
    path = Path(bpy.data.filepath)
    return str(path.with_name(f"blendcache_{path.stem}")) if bpy.data.filepath else ""


def _of_name(name: str) -> Iterator[Path]:
    """The files that a path in Blender stands for."""
    name = os.path.normpath(name)
    if "<" in name:
        yield from _tiles(name)
    elif os.path.isdir(name):
        # A cache's folder; the blend file's own folder, or one above, is nothing that was baked.
        if not Path(bpy.data.filepath).is_relative_to(name):
            yield from (path for path in Path(name).rglob("*") if path.is_file())
    elif os.path.isfile(name):
        yield Path(name)


def _add(path: Path, found: dict[Path, None]) -> None:
    """Adds a file, and those that it names if it is USD in text."""
    if path in found:
        return
    found[path] = None
    if path.suffix.lower() not in USD_SUFFIXES:
        return
    try:
        text = path.read_bytes()
    except OSError:
        return
    for match in _USD_ASSET.findall(text) if text.startswith(b"#usda") else ():
        name = str(path.parent / os.fsdecode(match))
        for each in _of_name(name):
            _add(each, found)


def is_sequence(owner: bpy.types.ID) -> bool:
    """Whether an image, movie clip, volume or cache reads one file per frame."""
    return getattr(owner, "source", "") == "SEQUENCE" or getattr(owner, "is_sequence", False)


def _numbered(path: str) -> list[str]:
    """The files whose names differ from that one in its last number alone."""
    folder, name = Path(path).parent, Path(path).name
    found = re.search(r"\d+(?=\D*$)", name)
    if found is None:
        return [path]
    pattern = re.compile(re.escape(name[: found.start()]) + r"\d+" + re.escape(name[found.end() :]))
    return [str(each) for each in folder.glob("*") if pattern.fullmatch(each.name)]


def _tiles(path: str) -> list[Path]:
    """The files of a tiled image, whose name has a token in place of the tile's number."""
    folder, name = Path(path).parent, Path(path).name
    pattern = re.compile(re.escape(name).replace("<UDIM>", r"\d{4}").replace("<UVTILE>", r"u\d+_v\d+"))
    return [each for each in folder.glob("*") if pattern.fullmatch(each.name) and each.is_file()]
