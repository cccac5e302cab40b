"""Runs a script inside Blender: a Python that has the bpy wheel, or a full Blender program."""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from progress import DemoError, Progress

STEPS = Path(__file__).resolve().parent
PROJECT = STEPS.parents[1]
PACKAGE = PROJECT / "build" / "envs" / "site"  # the core for full Blender programs, which have their own Python
MARK = "@skinglow "


@dataclass
class Host:
    program: str
    is_full_program: bool
    version: str
    datafiles: Path

    @classmethod
    def find(cls, program: str | None) -> Host:
        """The given program, or the bpy wheel installed by scripts/setup."""
        program = program or str(PROJECT / "build" / "envs" / "blender" / "bin" / "python")
        found = shutil.which(program)
        if found is None:
            raise DemoError(f"--blender {program}: no such program; omit the option to use the bpy wheel")
        about = subprocess.run([found, "--version"], capture_output=True, text=True).stdout
        full = about.startswith("Blender")
        ask = (
            "import bpy, os, sys; print('ASK', bpy.app.version_string, '|', bpy.utils.system_resource('DATAFILES'));"
            "sys.stdout.flush(); os._exit(0)"
        )
        command = [found, "-b", "--factory-startup", "--python-expr", ask] if full else [found, "-c", ask]
        answer = subprocess.run(command, capture_output=True, text=True, timeout=120)
        line = next((x for x in answer.stdout.splitlines() if x.startswith("ASK ")), None)
        if line is None:
            raise DemoError(
                f"--blender {program}: neither Blender nor a Python with bpy: {answer.stderr.strip()[-200:]}"
            )
        version, datafiles = line.removeprefix("ASK ").split(" | ")
        return cls(found, full, version.strip(), Path(datafiles))

    def run(self, script: str, job: dict[str, Any], progress: Progress) -> dict[str, Any]:
        """Runs a script of this folder with a job; prints its progress and returns its result."""
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump({**job, "host": self.version}, file)
            file.flush()
            step = str(STEPS / script)
            if self.is_full_program:
                command = [
                    self.program,
                    "-b",
                    "--factory-startup",
                    "-noaudio",
                    "--python-exit-code",
                    "3",
                    "-P",
                    step,
                ]
                command += ["--", file.name]
            else:
                command = [self.program, step, "--", file.name]
            return self._follow(command, progress)

    def _follow(self, command: list[str], progress: Progress) -> dict[str, Any]:
        result: dict[str, Any] | None = None
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
            assert running.stdout is not None
            for line in running.stdout:
                if not line.startswith(MARK):
                    if not line.startswith("Fra:"):  # Cycles' progress
                        progress.note(line)
                    continue
                message = json.loads(line.removeprefix(MARK))
                if "result" in message:
                    result = message["result"]
                    running.kill()  # the 4.5 wheel hangs on exit; all files are closed by now
                else:
                    progress.say(message["step"], message["done"], message["of"])
        if result is None:
            raise DemoError(f"Blender {self.version} stopped early; its output is in {progress.log}")
        return result
