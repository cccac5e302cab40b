# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of batches: `blender -b scene.blend --python-expr ...` and `blender --command skinglow ...`."""

import argparse
import signal
import threading
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy

from ..commands.freezing import FOLDER, freeze
from ..errors import SkinError, TemporaryError
from .blender_command import BlenderCommand
from .frames import parse_frames
from .pictures import PATTERN
from .progress import MANAGERS, Progress, say, why_failed
from .render import render_batch
from .worker import PathMapping, worker_name

#: Exit codes: all done; failed, another try may help; bad arguments, nothing done; some pictures would fail again, the
#: others are done; stopped by Ctrl-C or SIGTERM.
DONE, TRY_AGAIN, BAD_ARGUMENTS, FAIL_AGAIN, STOPPED = 0, 1, 2, 3, 130

USAGE = """
  blender -b scene.blend --python-expr "import skinglow_blender as sb; sb.batch_main()" -- [OPTIONS]
  blender --command skinglow --blend scene.blend [OPTIONS]                      (Blender 4.2 and later)"""
EXAMPLES = """examples of OPTIONS:
  --frames 1-10,15 --rigs Sunset Neon --out //batch
  --frames 1-100x5 --rigs "day=Key,Fill" noon.json --onto Head
exit code: 0 all pictures are complete; 1 some failed for a reason that may pass (memory, disk, time-out): another try
may help; 2 bad arguments, nothing rendered; 3 some would fail again, the others are complete; 130 stopped by Ctrl-C or
SIGTERM
Running the same command again renders only what is missing or out of date."""


def parser() -> argparse.ArgumentParser:
    """The options, as listed by --help."""
    found = argparse.ArgumentParser(
        prog="skinglow",
        usage=USAGE,
        description="Renders frames x light rigs of a scene with glowing skins, and writes a manifest of their inputs.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = found.add_argument
    add("--blend", type=Path, metavar="FILE", help="blend file, if Blender was started without one")
    add("--scene", metavar="NAME", help="scene in the file (default: the active one)")
    add("--frames", metavar="RANGES", help='such as 1-10,15 or 1-100x5 (default: the scene\'s range); "--frames=-5-3"')
    add(
        "--rigs",
        nargs="+",
        metavar="RIG",
        help="a light or a collection of lights by name, NAME=LIGHT,LIGHT, or a rig file (.json, .sl) "
        "(default: the lights of the scene, unchanged, as one rig 'scene')",
    )
    add("--out", metavar="FOLDER", help="output folder (default: //batch, next to the blend file)")
    add("--pattern", default=PATTERN, help=f"pattern of the file names (default: {PATTERN})".replace("%", "%%"))
    add("--onto", metavar="SKIN", help="move the point of rig files to the reference point of this object")
    add(
        "--freeze",
        type=Path,
        metavar="FILE",
        help="render nothing: write the light of all skins in these frames to images (in --out, //skinglow_frozen by "
        "default) and save as this blend file, which then renders without Skinglow",
    )
    add("--again", action="store_true", help="also render pictures that are up to date")
    add(
        "--worker",
        metavar="NAME",
        help="write a separate manifest, manifest-NAME.jsonl, for this farm worker (default: the name that Deadline "
        'Cloud, Flamenco or Slurm gives it, if one does); "--worker=" for none',
    )
    add(
        "--timeout",
        type=_seconds,
        default=0.0,
        metavar="SECONDS",
        help="end with exit code 1 after a picture takes so long",
    )
    add("--progress", choices=MANAGERS, default="", help="also print lines that this farm manager parses")
    add("--path-mapping", type=Path, metavar="FILE", help="rules of Open Job Description for paths of other machines")
    return found


def _seconds(text: str) -> float:
    seconds = float(text)
    if not 0.0 <= seconds <= 1e6:
        raise argparse.ArgumentTypeError(f"{text} is not allowed: seconds from 0 (no limit) to 1000000")
    return seconds


def run(arguments: Sequence[str]) -> int:
    """Runs the command line; returns the exit code and reports all errors except those of Blender itself."""
    try:
        options = parser().parse_args(list(arguments))
    except SystemExit as end:  # argparse has printed the error or the help
        return end.code if isinstance(end.code, int) else BAD_ARGUMENTS
    progress = Progress(options.progress, options.timeout)
    try:
        with _stopping_after_a_picture(progress):
            return _run(options, progress)
    except SkinError as error:
        say(f"skinglow: {error}")
        progress.failed(str(error))
        return TRY_AGAIN if isinstance(error, TemporaryError) else BAD_ARGUMENTS
    except KeyboardInterrupt:
        say("skinglow: stopped; run the same command to continue")
        return STOPPED
    except Exception as error:  # noqa: BLE001  Blender would print it and end with exit code 0
        traceback.print_exc()
        progress.failed(f"Unexpected {type(error).__name__}: {error}")
        return TRY_AGAIN
    finally:
        progress.end()


def _run(options: argparse.Namespace, progress: Progress) -> int:
    mapping = PathMapping(options.path_mapping)
    _open(options.blend)
    mapping.apply()
    scene = _named(bpy.data.scenes, options.scene, "scene") or bpy.context.scene
    out = options.out or (FOLDER if options.freeze else "//batch")
    if out.startswith("//") and not bpy.data.filepath:
        raise SkinError("--out: the scene was not saved, so // has no folder: give a folder")
    if options.freeze:
        _freeze(options, out, scene, progress)
        return DONE
    result = render_batch(
        out,
        options.frames,
        [_on_this_machine(rig, mapping) for rig in options.rigs] if options.rigs else None,
        scene=scene,
        pattern=options.pattern,
        resume=not options.again,
        onto=_named(scene.objects, options.onto, "object"),
        worker=worker_name() if options.worker is None else options.worker,
        progress=progress,
    )
    counts = f"{len(result.rendered)} rendered, {len(result.kept)} kept, {len(result.failed)} failed"
    say(f"skinglow: {counts}; {result.manifest}")
    if not result.failed:
        return DONE
    progress.failed(why_failed(result))
    return TRY_AGAIN if result.retry_helps else FAIL_AGAIN


def _on_this_machine(rig: str, mapping: PathMapping) -> str:
    """A rig whose file, if it is one, is where this machine has it."""
    name, equals, file = rig.rpartition("=")
    return f"{name}{equals}{mapping.of(file)}"


def _freeze(options: argparse.Namespace, out: str, scene: bpy.types.Scene, progress: Progress) -> None:
    """Freezes from the first to the last of the frames, and saves."""
    if options.rigs is not None:
        raise SkinError("--freeze: the lights are frozen as they are in the scene: leave out --rigs")
    for name in ("pattern", "onto", "again", "worker"):
        if getattr(options, name) != parser().get_default(name):
            raise SkinError(f"--freeze: nothing is rendered, which --{name} is about: leave it out")
    frames = parse_frames(options.frames) if options.frames else (scene.frame_start, scene.frame_end)
    frozen = freeze(
        None, min(frames), max(frames), out, scene=scene, progress=lambda done: progress.fraction(done, "frozen")
    )
    for each in frozen:
        say(f"skinglow: {', '.join(each.skins)}: frames {each.first} to {each.last} frozen to {each.folder}")
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.freeze.absolute()))
    except RuntimeError as error:
        raise SkinError(f"--freeze: {' '.join(str(error).split())}") from error


def _open(path: Path | None) -> None:
    if path is None:
        return
    if not path.is_file():
        raise SkinError(f"--blend: no such file: {path}")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.absolute()), load_ui=False)
    except RuntimeError as error:
        raise SkinError(f"--blend: {' '.join(str(error).split())}") from error


def _named(
    collection: bpy.types.bpy_prop_collection, name: str | None, what: str
) -> bpy.types.Scene | bpy.types.Object | None:
    if name is None:
        return None
    found = collection.get(name)
    if found is None:
        raise SkinError(f"There is no {what} '{name}'; there are: {', '.join(sorted(collection.keys())) or 'none'}")
    return found


@contextmanager
def _stopping_after_a_picture(progress: Progress) -> Iterator[None]:
    """Ctrl-C and SIGTERM end the batch after the current picture. Blender itself would cancel it and go on."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {each: signal.signal(each, progress.stop) for each in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for each, handler in before.items():
            # None: the handler was not set from Python but by Blender; Python cannot restore that.
            signal.signal(each, signal.SIG_DFL if handler is None else handler)


COMMAND = BlenderCommand("skinglow", run)
