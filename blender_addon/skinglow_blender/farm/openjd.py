# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a batch as a job bundle of Open Job Description, for AWS Deadline Cloud and `openjd run`.

Specification: https://github.com/OpenJobDescription/openjd-specifications, "2023-09", with the extension TASK_CHUNKING.
"""

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import bpy

from ..batch.files import input_files
from ..batch.pictures import PATTERN
from ..batch.render import plan_batch
from ..batch.rigs import ReadyRig, RigLike
from ..commands.freezing import frozen_state
from ..errors import SkinError
from ..whole_file import whole_file

#: How a task calls the add-on, and the exit code if it is not installed there.
BATCH = ("--python-exit-code", "2", "--python-expr", "import skinglow_blender as sb; sb.batch_main()", "--")
#: What a worker may take to end a picture when a task is canceled, in seconds.
GRACE_SECONDS = 120


def write_openjd(
    folder: str | os.PathLike,
    frames: str | int | Iterable[int] | None = None,
    rigs: RigLike | Iterable[RigLike] | Mapping[str, Any] | None = None,
    *,
    scene: bpy.types.Scene | None = None,
    out: str | os.PathLike = "//batch",
    chunk: int = 10,
    onto: bpy.types.Object | None = None,
    pattern: str = PATTERN,
    timeout: float = 0.0,
    frozen: bool = False,
) -> Path:
    """Writes a job bundle that renders the saved scene: frames x light rigs, as `render_batch` does.

    folder   of the bundle; made if there is none; "//" is the blend file's folder
    frames, rigs, scene, onto, pattern   as in `render_batch`
    out      folder of the pictures
    chunk    frames of one task: each task starts Blender once (docs/farm.md)
    timeout  seconds that a picture may take, then its task fails; 0: any
    frozen   False: each worker needs this add-on. True: workers need Blender alone; the skins have to be frozen, there
             are no rigs and no manifest, and running the job again renders all frames
    Returns the path of the template: `openjd run TEMPLATE -p file://parameters.json`, or
    `deadline bundle submit FOLDER`. Raises SkinError if the scene is not saved, or not fit for the batch.
    """
    scene = scene or bpy.context.scene
    if not bpy.data.filepath or _has_unsaved_changes():
        raise SkinError("Save the file first: workers render it as it is saved")
    if chunk < 1:
        raise SkinError(f"chunk = {chunk} is not allowed: 1 or more frames")
    if frozen:
        _require_frozen(scene, rigs, pattern)
    ready, pictures = plan_batch(scene, frames, rigs, pattern)
    numbers = sorted({picture.frame for picture in pictures})
    output = str(Path(bpy.path.abspath(str(out))).absolute())
    parameters = {
        "BlendFile": bpy.data.filepath,
        "OutDir": output,
        "Frames": _ranges(numbers),
        "FramesPerTask": chunk,
        "Blender": "blender",
    }
    if frozen:
        script = _frozen_script(scene, timeout)
    else:
        # With =, as names may begin with a dash.
        options = [f"--scene={scene.name}", f"--pattern={pattern}"]
        options += [f"--onto={onto.name}"] if onto is not None else []
        script = _live_script(options, timeout, has_rigs=rigs is not None)
    rig_names = [] if rigs is None else [_as_option(rig) for rig in ready]
    _require_no_braces(scene.name, pattern, onto.name if onto is not None else "", *rig_names)
    template = _template(f"{Path(bpy.data.filepath).stem}, {scene.name}", script, rig_names)
    files = [*input_files(), *(rig.rig.file for rig in ready if rig.rig.file is not None)]
    attachments = {
        "inputs": {"filenames": sorted({str(file) for file in files}), "directories": []},
        "outputs": {"directories": [output]},
        "referencedPaths": [],
    }
    where = Path(bpy.path.abspath(str(folder))).absolute()
    values = [{"name": name, "value": value} for name, value in parameters.items()]
    for name, content in (
        ("parameters.json", parameters),
        ("parameter_values.json", {"parameterValues": values}),
        ("asset_references.json", {"assetReferences": attachments}),
        ("template.json", template),
    ):
        _write(where / name, content)
    return where / "template.json"


def _has_unsaved_changes() -> bool:
    # In the background Blender does not follow what changes.
    return bpy.data.is_dirty and not bpy.app.background


def _require_frozen(scene: bpy.types.Scene, rigs: Any, pattern: str) -> None:  # noqa: ANN401
    if rigs is not None or pattern != PATTERN:
        raise SkinError("frozen=True: without the add-on there are no light rigs and no pattern: leave them out")
    live = [obj.name for obj in scene.objects if obj.type == "MESH" and obj.skinglow.enabled and not frozen_state(obj)]
    if live:
        raise SkinError(f"{', '.join(live)}: not frozen, so workers need the add-on: freeze them first and save")


def _as_option(ready: ReadyRig) -> str:
    """A rig as the option --rigs has it."""
    rig = ready.rig
    if rig.file is not None and rig.lights:
        raise SkinError(f"Light rig '{rig.name}': a job takes the lights of the scene or those of a file, not both")
    return f"{rig.name}={rig.file if rig.file is not None else ','.join(rig.lights or ())}"


def _require_no_braces(*texts: str) -> None:
    for text in texts:
        if "{{" in text:
            raise SkinError(f"'{text}': {{{{ begins an expression in Open Job Description: rename it")


def _template(name: str, script: dict[str, Any], rigs: list[str]) -> dict[str, Any]:
    chunks = {"defaultTaskCount": "{{Param.FramesPerTask}}", "rangeConstraint": "NONCONTIGUOUS"}
    tasks = [{"name": "Rig", "type": "STRING", "range": rigs}] if rigs else []
    tasks.append({"name": "Frames", "type": "CHUNK[INT]", "range": "{{Param.Frames}}", "chunks": chunks})
    return {
        "specificationVersion": "jobtemplate-2023-09",
        "extensions": ["TASK_CHUNKING"],
        "name": f"Skinglow: {name}"[:128],
        "parameterDefinitions": [
            {"name": "BlendFile", "type": "PATH", "objectType": "FILE", "dataFlow": "IN"},
            {"name": "OutDir", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "OUT"},
            {"name": "Frames", "type": "STRING"},
            {"name": "FramesPerTask", "type": "INT", "minValue": 1},
            {"name": "Blender", "type": "STRING", "default": "blender", "description": "The program on the workers"},
        ],
        "steps": [{"name": "Pictures", "parameterSpace": {"taskParameterDefinitions": tasks}, "script": script}],
    }


def _live_script(options: list[str], timeout: float, *, has_rigs: bool) -> dict[str, Any]:
    frames = ["--frames={{Task.Param.Frames}}", "--out", "{{Param.OutDir}}"]
    mapping = ["--path-mapping", "{{Session.PathMappingRulesFile}}"]
    rig = ["--rigs={{Task.Param.Rig}}"] if has_rigs else []
    limit = ["--timeout", f"{timeout:g}"] if timeout else []
    return _script([*BATCH, "--progress", "openjd", *frames, *rig, *options, *limit, *mapping])


def _frozen_script(scene: bpy.types.Scene, timeout: float) -> dict[str, Any]:
    arguments = ["{{Task.Param.Frames}}", "{{Param.OutDir}}", scene.name, f"{timeout:g}"]
    script = _script(["--python-exit-code", "1", "-P", "{{Task.File.Render}}", "--", *arguments])
    text = Path(__file__).with_name("frozen_frames.py").read_text(encoding="utf-8")
    return {
        "embeddedFiles": [{"name": "Render", "type": "TEXT", "filename": "frozen_frames.py", "data": text}],
        **script,
    }


def _script(arguments: list[str]) -> dict[str, Any]:
    cancelation = {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": GRACE_SECONDS}
    run = {"command": "{{Param.Blender}}", "args": ["-b", "-y", "{{Param.BlendFile}}", *arguments]}
    return {"actions": {"onRun": {**run, "cancelation": cancelation}}}


def _ranges(numbers: list[int]) -> str:
    """Frames in ascending order as an integer range expression: "1-10,15,20-30:5"."""
    parts = []
    while numbers:
        step = numbers[1] - numbers[0] if len(numbers) > 1 else 1
        count = 1
        while count < len(numbers) and numbers[count] - numbers[count - 1] == step:
            count += 1
        # Two numbers a step apart are no range.
        count = count if count > 2 or step == 1 else 1
        first, last = numbers[0], numbers[count - 1]
        parts.append(f"{first}" if count == 1 else f"{first}-{last}" + (f":{step}" if step > 1 else ""))
        numbers = numbers[count:]
    return ",".join(parts)


def _write(path: Path, content: dict[str, Any]) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(path) as partial:
            partial.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    except OSError as error:
        raise SkinError(f"Cannot write to {path}: {error.strerror or error}") from error
