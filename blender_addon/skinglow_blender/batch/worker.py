# SPDX-License-Identifier: GPL-3.0-or-later
"""What a farm manager tells a worker: its name, and where files are on this machine."""

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath, PureWindowsPath

import bpy

from ..errors import SkinError

#: Variables in which managers name the worker: AWS Deadline Cloud, Flamenco (if its workers were given names), Slurm.
NAMES = ("DEADLINE_WORKER_ID", "FLAMENCO_WORKER_NAME", "SLURMD_NODENAME")


def worker_name() -> str:
    """The worker's name by its manager, for a file name; "" where no manager says one."""
    found = next((os.environ[name] for name in NAMES if os.environ.get(name)), "")
    return re.sub(r"[^\w.-]+", "_", found)


class PathMapping:
    """Rules of Open Job Description by which paths of the submitting machine become those of this one.

    file  JSON of the schema pathmapping-1.0; None: no rules
    Raises SkinError if it cannot be read.
    """

    def __init__(self, file: Path | None = None) -> None:
        self.rules: list[tuple[PurePosixPath | PureWindowsPath, str]] = []
        if file is None:
            return
        try:
            for rule in json.loads(file.read_text(encoding="utf-8")).get("path_mapping_rules", ()):
                kind = PureWindowsPath if rule["source_path_format"].upper() == "WINDOWS" else PurePosixPath
                self.rules.append((kind(rule["source_path"]), rule["destination_path"]))
        except (OSError, ValueError, KeyError, AttributeError) as error:
            raise SkinError(f"--path-mapping: {file} is not a file of path mapping rules ({error})") from error
        # The most specific rule counts.
        self.rules.sort(key=lambda rule: -len(rule[0].parts))

    def of(self, path: str) -> str:
        """The path on this machine."""
        for source, destination in self.rules:
            given = type(source)(path)
            if given.is_relative_to(source):
                return str(Path(destination, *given.relative_to(source).parts))
        return path

    def apply(self) -> None:
        """Makes the open file read its absolute paths from where they are on this machine."""
        if not self.rules:
            return
        for library in list(bpy.data.libraries):
            if self._replace(library):
                library.reload()
        for kind in ("images", "movieclips", "volumes", "cache_files", "fonts", "sounds"):
            for owner in getattr(bpy.data, kind):
                self._replace(owner)
        for node in _ies_nodes():
            self._replace(node)

    def _replace(self, owner: bpy.types.bpy_struct) -> bool:
        """Gives the owner of a path that of this machine; returns whether it is another."""
        path = owner.filepath
        if path.startswith("//") or self.of(path) == path:
            return False
        owner.filepath = self.of(path)
        return True


def _ies_nodes() -> Iterator[bpy.types.Node]:
    """The nodes of lights and materials that read a light's profile from a file."""
    trees = [owner.node_tree for owner in (*bpy.data.lights, *bpy.data.materials) if owner.node_tree is not None]
    for tree in (*trees, *bpy.data.node_groups):
        yield from (node for node in tree.nodes if node.bl_idname == "ShaderNodeTexIES")
