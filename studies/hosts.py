"""Runs the job of a study inside Blender: a Python that has the bpy wheel, or a full Blender program."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studies import in_blender
from studies.display import virtual_display
from studies.paths import ENVIRONMENTS
from studies.progress import Progress, StudyError

ASK = (
    "import bpy, os, sys; print('ASK', bpy.app.version_string, '|', bpy.utils.system_resource('DATAFILES'));"
    "sys.stdout.flush(); os._exit(0)"
)


@dataclass
class Host:
    program: str
    is_full_program: bool
    version: str
    datafiles: Path

    @classmethod
    def find(cls, program: str | None) -> Host:
        """The given program, or the bpy wheel installed by scripts/setup."""
        program = program or str(ENVIRONMENTS / "blender" / "bin" / "python")
        found = shutil.which(program)
        if found is None:
            raise StudyError(f"--blender {program}: no such program; omit the option to use the bpy wheel")
        about = subprocess.run([found, "--version"], capture_output=True, text=True).stdout
        full = about.startswith("Blender")
        command = [found, "-b", "--factory-startup", "--python-expr", ASK] if full else [found, "-c", ASK]
        answer = subprocess.run(command, capture_output=True, text=True, timeout=120)
        line = next((x for x in answer.stdout.splitlines() if x.startswith("ASK ")), None)
        if line is None:
            why = answer.stderr.strip()[-200:]
            raise StudyError(f"--blender {program}: neither Blender nor a Python with bpy: {why}")
        version, datafiles = line.removeprefix("ASK ").split(" | ")
        return cls(found, full, version.strip(), Path(datafiles))

    def run(self, module: str, job: dict[str, Any], progress: Progress, *, display: bool = False) -> dict[str, Any]:
        """Calls `main` of that module with a job; prints its progress and returns its result.

        display  EEVEE needs one: a virtual one is made where there is none
        """
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump({**job, "host": self.version}, file)
            file.flush()
            options = ["-b", "--factory-startup", "-noaudio", "--python-exit-code", "3", "-P"]
            start = [self.program, *options] if self.is_full_program else [self.program]
            command = [*start, in_blender.__file__, "--", module, file.name]
            if not display or "DISPLAY" in os.environ:
                return self._follow(command, {**os.environ}, progress)
            with virtual_display() as name:
                return self._follow(command, {**os.environ, "DISPLAY": name}, progress)

    def _follow(self, command: list[str], environment: dict[str, str], progress: Progress) -> dict[str, Any]:
        result: dict[str, Any] | None = None
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
        ) as running:
            assert running.stdout is not None
            for line in running.stdout:
                if not line.startswith(in_blender.MARK):
                    if not line.startswith("Fra:"):  # Cycles' progress
                        progress.note(line)
                    continue
                message = json.loads(line.removeprefix(in_blender.MARK))
                if "result" in message:
                    result = message["result"] or {}
                else:
                    progress.say(message["step"], message["done"], message["of"])
        if result is None:
            raise StudyError(f"Blender {self.version} stopped early; its output is in {progress.log}")
        return result
