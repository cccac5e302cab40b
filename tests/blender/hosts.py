"""Runs modules of checks inside real Blender hosts, one process for a module, and brings back what each check found."""

import json
import os
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).parent
ADDON_FOLDER = HERE.parents[1] / "blender_addon"


@dataclass(frozen=True)
class Host:
    """A Blender: the full program, or a Python whose environment holds the bpy wheel."""

    name: str
    variable: str  #: environment variable that says where it is
    is_program: bool = False

    @property
    def path(self) -> str:
        return os.environ.get(self.variable, "")

    def require(self) -> None:
        """Raises AssertionError where nothing says where the host is."""
        if not self.path:
            raise AssertionError(f"Blender {self.name} is not there: {self.variable} does not say where it is")

    def command(self, script: Path, arguments: list[str]) -> list[str]:
        if self.is_program:
            start = [self.path, "-b", "--factory-startup", "-P", str(script), "--"]
        else:
            start = [self.path, str(script)]
        return [*start, *arguments]

    def environment(self, folder: Path) -> dict[str, str]:
        """Without the user's own Blender settings; the program gets the core's package from a folder."""
        environment = {**os.environ, "BLENDER_USER_RESOURCES": str(folder / "profile")}
        environment["SKINGLOW_SITE"] = os.environ.get("SKINGLOW_SITE_311", "") if self.is_program else ""
        return environment


#: Those that the project promises to run on. One that is not there fails its tests.
HOSTS = (
    Host("3.4", "SKINGLOW_BLENDER_34", is_program=True),
    Host("4.5", "SKINGLOW_BLENDER_45"),
    Host("5.0", "SKINGLOW_BLENDER_50"),
    Host("5.2", "SKINGLOW_BLENDER_52"),
)


def host_named(name: str) -> Host:
    """The host of that version."""
    return next(host for host in HOSTS if host.name == name)


@dataclass
class Run:
    """What became of one module in one host."""

    outcomes: dict[str, dict] = field(default_factory=dict)  #: by check: {"value": ...} or {"error": traceback}
    output: str = ""


def run_module(host: Host, module: str, folder: Path, seconds: float) -> Run:
    """Runs the checks of `inside/<module>.py` in a host."""
    host.require()
    work = folder / f"{host.name}_{module}"
    work.mkdir(parents=True, exist_ok=True)
    results = work / "results.jsonl"
    command = host.command(HERE / "run_inside.py", [module, str(work), str(results)])
    run = Run()
    with (work / "output.txt").open("w+") as log:
        process = subprocess.Popen(
            command, stdout=log, stderr=subprocess.STDOUT, env=host.environment(work), cwd=work, start_new_session=True
        )
        try:
            process.wait(seconds)
            ending = f"exit code {process.returncode}"
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            ending = f"stopped after {seconds:g} s"
        log.seek(0)
        run.output = f"{log.read()[-6000:]}\n[{' '.join(command)}: {ending}]"
    if results.exists():
        for line in results.read_text().splitlines():
            outcome = json.loads(line)
            run.outcomes[outcome.pop("check")] = outcome
    return run
