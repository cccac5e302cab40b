# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the pictures of a batch, one after another, and restores the scene."""

import errno
import os
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ..commands.freezing import frozen_state
from ..commands.health import require_health
from ..commands.rendered_objects import RenderedObjects
from ..commands.skin import skin_settings_of
from ..errors import SkinError, TemporaryError
from ..live.live_update import update_scene
from ..read.scene_reading import read_skin
from .frames import parse_frames
from .inputs import rig_inputs, scene_inputs
from .manifest import Manifest
from .one_picture import clear_leftovers, make_picture
from .pictures import PATTERN, Picture, plan_pictures, why_not_kept
from .rigs import ReadyRig, RigLike, as_rigs, lit_by, make_ready


class BatchStep(NamedTuple):
    """The argument of a progress callback, before and after each rendered picture and for each kept one."""

    state: str  #: 'KEPT', 'RENDERING', 'RENDERED' or 'FAILED'
    rig: str
    frame: int
    file: Path
    reason: str  #: why it is rendered, or why it failed
    done: int  #: pictures that are finished, including kept ones
    total: int
    seconds: float  #: render time of this picture
    seconds_left: float | None  #: estimate for the remaining pictures, from the mean so far; None before the first


class BatchResult(NamedTuple):
    """The result of a batch."""

    rendered: tuple[Path, ...]
    kept: tuple[Path, ...]  #: existing, complete and up to date
    failed: tuple[tuple[Path, str], ...]  #: with the reason
    manifest: Path
    retry_helps: bool = False  #: whether any of the failures may be gone at another try


#: Errors of a folder that comes back, or gets space again.
_TEMPORARY_NAMES = (
    "EAGAIN EBUSY EDQUOT EHOSTDOWN EHOSTUNREACH EINTR EIO EMFILE ENFILE ENOLCK ENOSPC ESTALE ETIMEDOUT".split()
)
TEMPORARY = frozenset(getattr(errno, name) for name in _TEMPORARY_NAMES if hasattr(errno, name))

Progress = Callable[[BatchStep], None]


def render_batch(
    folder: str | os.PathLike,
    frames: str | int | Iterable[int] | None = None,
    rigs: RigLike | Iterable[RigLike] | Mapping[str, Any] | None = None,
    *,
    scene: bpy.types.Scene | None = None,
    pattern: str = PATTERN,
    resume: bool = True,
    onto: bpy.types.Object | None = None,
    worker: str = "",
    progress: Progress | None = None,
) -> BatchResult:
    """Renders frames x light rigs into a folder, with a manifest of the inputs of each picture (docs/batch.md).

    folder    output folder of pictures and manifest; "//" is the blend file's folder
    frames    "1-10,15", "1-100x5", a number or an iterable of them; None: the scene's range
    rigs      names of lights or collections, "name=Key,Fill", rig files, or a mapping of names to these (rigs.as_rigs);
              None: the scene's lights, unchanged, as one rig "scene"
    scene     None: the context's
    pattern   file name in the folder, of {rig}, {frame} and {scene}; the format's extension is added
    resume    keep pictures that are complete and were made from the same inputs; False: render all
    onto      a skin to whose reference point a rig file's point is moved; None: lights are placed as in the file
    worker    name of a farm worker, which then writes its own manifest
    progress  called with a BatchStep; an exception in it ends the batch, and finished pictures are kept
    Workers may render to one folder at once, and a batch may be run again after any end: what is complete is kept.
    Lights, rig files, frames, folder, names and the health of the skins are checked before anything is rendered
    (SkinError). A picture that fails does not stop the others. The scene is restored when this returns or raises.
    """
    scene = scene or bpy.context.scene
    ready, pictures = plan_batch(scene, frames, rigs, pattern)
    where = Path(bpy.path.abspath(str(folder))).absolute()
    manifest = Manifest(where, worker)
    try:
        where.mkdir(parents=True, exist_ok=True)
        manifest.check_writable()
    except OSError as error:
        kind = TemporaryError if error.errno in TEMPORARY else SkinError
        raise kind(f"Cannot write to {where}: {error.strerror or error}") from error
    with ExitStack() as undo:
        _keep(undo, scene)
        return _Batch(scene, ready, manifest, onto, progress).run(pictures, resume)


def plan_batch(
    scene: bpy.types.Scene,
    frames: str | int | Iterable[int] | None,
    rigs: RigLike | Iterable[RigLike] | Mapping[str, Any] | None,
    pattern: str,
) -> tuple[list[ReadyRig], list[Picture]]:
    """The rigs and pictures of a batch, with arguments as in `render_batch`.

    Raises SkinError if they, or the scene, are not fit for it.
    """
    if frames is None:
        frames = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
    frame_list = parse_frames(frames)
    _check_scene(scene)
    require_health(scene, frame_list)
    if rigs is not None:
        _require_live(scene)
    ready = [make_ready(scene, rig) for rig in as_rigs(rigs)]
    return ready, plan_pictures(scene, [r.rig.name for r in ready], frame_list, pattern)


def _check_scene(scene: bpy.types.Scene) -> None:
    if scene.camera is None and not any(marker.camera for marker in scene.timeline_markers):
        raise SkinError(f"Scene '{scene.name}' has no camera: add one, or set it in the Scene properties")
    if not any(obj.type == "MESH" and obj.skinglow.enabled for obj in scene.objects):
        raise SkinError(f"Scene '{scene.name}' has no skin: create one with make_skin or the button Make Skin Glow")


def _require_live(scene: bpy.types.Scene) -> None:
    """Raises SkinError for a skin that no rig can light."""
    rendered = RenderedObjects(scene)
    frozen = [obj.name for obj in scene.objects if obj.type == "MESH" and frozen_state(obj) and rendered.shows(obj)]
    if frozen:
        raise SkinError(f"{', '.join(frozen)}: frozen, so they do not follow light rigs: unfreeze them first")


def _keep(undo: ExitStack, scene: bpy.types.Scene) -> None:
    """Registers everything that a batch changes in a scene to be restored when `undo` is closed."""
    render = scene.render
    undo.callback(_show_viewport_again, scene)
    # Markers bind cameras to frames.
    undo.callback(setattr, scene, "camera", scene.camera)
    undo.callback(scene.frame_set, scene.frame_current, subframe=scene.frame_subframe)
    for name in ("filepath", "use_lock_interface"):
        undo.callback(setattr, render, name, getattr(render, name))
    # Redrawing a window while its data is rendered can crash Blender.
    render.use_lock_interface = True


def _show_viewport_again(scene: bpy.types.Scene) -> None:
    if scene == bpy.context.scene:
        update_scene(bpy.context.evaluated_depsgraph_get(), only_live=True)


class _Batch:
    """The common data of all pictures of a batch, and the results so far."""

    def __init__(
        self,
        scene: bpy.types.Scene,
        ready: list[ReadyRig],
        manifest: Manifest,
        onto: bpy.types.Object | None,
        progress: Progress | None,
    ) -> None:
        self.scene, self.ready, self.manifest, self.progress = scene, ready, manifest, progress
        self.folder = manifest.folder
        # The values read below are those of a fixed frame, independent of the file's current frame.
        scene.frame_set(scene.frame_start)
        self.onto = None
        if onto is not None:
            skin_settings_of(onto)
            evaluated = onto.evaluated_get(scene.view_layers[0].depsgraph or bpy.context.evaluated_depsgraph_get())
            self.onto = read_skin(evaluated, evaluated.matrix_world).point
        shared = scene_inputs(scene, self.folder)
        self.inputs = [{**shared, **rig_inputs(scene, rig, self.onto, self.folder)} for rig in ready]
        self.rendered: list[Path] = []
        self.kept: list[Path] = []
        self.failed: list[tuple[Path, str]] = []
        self.retry_helps = False
        self.seconds = 0.0
        self.total = 0

    def run(self, pictures: list[Picture], resume: bool) -> BatchResult:
        self.total = len(pictures)
        folders = {(self.folder / picture.name).parent for picture in pictures}
        clear_leftovers(folders)
        to_do: dict[int, list[tuple[Picture, str]]] = {}
        entries = self.entries()
        for picture in pictures:
            why = self.why_not_kept(picture, entries) if resume else "requested again"
            if why:
                to_do.setdefault(picture.rig, []).append((picture, why))
            else:
                self.keep(picture)
        for index, todo in to_do.items():
            self.run_rig(self.ready[index], todo, resume)
        clear_leftovers(folders)
        rendered, kept, failed = tuple(self.rendered), tuple(self.kept), tuple(self.failed)
        return BatchResult(rendered, kept, failed, self.manifest.path, self.retry_helps)

    def entries(self) -> dict[str, list[dict[str, Any]]]:
        """The manifest's entries by file, as they are now."""
        found: dict[str, list[dict[str, Any]]] = {}
        for entry in self.manifest.entries():
            found.setdefault(str(entry.get("file")), []).append(entry)
        return found

    def why_not_kept(self, picture: Picture, entries: dict[str, list[dict[str, Any]]]) -> str:
        return why_not_kept(self.folder, picture, entries.get(picture.name, []), self.inputs[picture.rig])

    def keep(self, picture: Picture) -> None:
        self.kept.append(self.folder / picture.name)
        self.report("KEPT", picture, "", 0.0)

    def run_rig(self, ready: ReadyRig, to_do: list[tuple[Picture, str]], resume: bool) -> None:
        with ExitStack() as undo:
            notes: list[str] = []
            fault: Exception | None = None
            try:
                notes = undo.enter_context(lit_by(self.scene, ready, self.onto))
            except SkinError as error:
                fault = error
            for picture, why in to_do:
                # Another worker may have made it by now.
                if resume and not self.why_not_kept(picture, self.entries()):
                    self.keep(picture)
                else:
                    self.make(picture, why, ready, notes, fault, resume)

    def make(
        self, picture: Picture, why: str, ready: ReadyRig, notes: list[str], fault: Exception | None, resume: bool
    ) -> None:
        self.report("RENDERING", picture, why, 0.0)
        started = time.perf_counter()
        path = self.folder / picture.name

        def publish(partial: Path, fields: dict[str, Any]) -> bool:
            def take() -> bool:
                if resume and not self.why_not_kept(picture, self.entries()):
                    return False
                os.replace(partial, path)
                return True

            identity = {"file": picture.name, "frame": picture.frame, "rig": picture.rig_name, "notes": notes}
            return self.manifest.append({**identity, **fields, "inputs": self.inputs[picture.rig]}, take)

        state, reason = "RENDERED", why
        try:
            if fault is not None:
                raise fault
            if not make_picture(self.scene, picture.frame, path, ready, publish):
                self.keep(picture)
                return
            self.rendered.append(path)
        except (SkinError, ValueError, RuntimeError, OSError, MemoryError) as error:
            state, reason = "FAILED", " ".join(str(error).split()) or type(error).__name__
            self.failed.append((path, reason))
            if isinstance(error, TemporaryError) or not isinstance(error, SkinError | ValueError):
                self.retry_helps = True
        seconds = time.perf_counter() - started
        self.seconds += seconds
        self.report(state, picture, reason, seconds)

    def report(self, state: str, picture: Picture, reason: str, seconds: float) -> None:
        if self.progress is None:
            return
        made = len(self.rendered) + len(self.failed)
        done = made + len(self.kept)
        left = self.seconds / made * (self.total - done) if made else None
        path = self.folder / picture.name
        self.progress(BatchStep(state, picture.rig_name, picture.frame, path, reason, done, self.total, seconds, left))
