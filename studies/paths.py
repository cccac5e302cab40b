"""Where things are."""

from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
IMAGES = PROJECT / "docs" / "images"
ENVIRONMENTS = PROJECT / "build" / "envs"
#: The core for full Blender programs, which have their own Python.
SITE = ENVIRONMENTS / "site"
#: The command line.
CLI = PROJECT / "build" / "release" / "bin" / "skinglow"
#: The scanned head, which is no part of the project.
SCAN = PROJECT.parent / "shared" / "data" / "heads" / "LeePerrySmith.glb"
