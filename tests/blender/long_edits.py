"""Ten thousand random edits, or any number, in each Blender: the walk of inside/long_walk.py, part after part.

Usage: scripts/test --edits STEPS [VERSION...]     e.g. scripts/test --edits 10000 4.5 5.2
Each Blender walks twice, alone and beside an add-on that edits in its handlers. What there is so far is kept in
build/edits: the same command goes on from there, also after it was killed. A part that finds something wrong, or ends
Blender, is kept with all it needs to be repeated (build/edits/WALK/failed_N), and the walk goes on from before it with
other edits.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

from hosts import HERE, HOSTS, Host, Run, run_module

FOLDER = HERE.parents[1] / "build" / "edits"
#: Edits of one process.
PART = 200
#: Seconds after which a part counts as hanging.
SECONDS = 3600.0
#: MB by which a process may grow over a part: 107 were seen, of tables, bodies and undo steps, which are kept up to a
#: limit. A leak of two megabytes an edit, as of the texels of one body, is 400.
GROWN_MB = 250.0
#: A walk that fails so many times from the same edit on is left.
GIVE_UP = 4
MODULE, CHECK = "long_walk", "check_a_walk_in_parts"


@dataclass(frozen=True)
class LongWalk:
    """One walk: a Blender, alone or beside another add-on."""

    host: Host
    beside: bool

    @property
    def name(self) -> str:
        return f"{self.host.name}_beside" if self.beside else self.host.name

    @property
    def folder(self) -> Path:
        return FOLDER / self.name

    def steps(self) -> int:
        """How many edits it has taken."""
        state = self.folder / "state.json"
        return json.loads(state.read_text())["step"] if state.exists() else 0

    def parts(self) -> list[dict]:
        """What was seen of each part."""
        log = self.folder / "parts.jsonl"
        return [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []

    def failed(self) -> list[Path]:
        """Folders of the parts in which something was wrong."""
        return sorted(self.folder.glob("failed_*"))

    def take_part(self, steps: int) -> str | None:
        """Takes some edits; returns what went wrong, or None."""
        self.folder.mkdir(parents=True, exist_ok=True)
        os.environ |= {"SKINGLOW_EDITS": str(self.folder), "SKINGLOW_STEPS": str(steps), "SKINGLOW_TRACE": "1"}
        os.environ.pop("SKINGLOW_BESIDE", None)
        if self.beside:
            os.environ["SKINGLOW_BESIDE"] = "1"
        run = run_module(self.host, MODULE, self.folder, SECONDS)
        wrong = self._fault(run)
        if wrong is not None:
            self._keep(run, wrong)
        return wrong

    def _fault(self, run: Run) -> str | None:
        """The last line of what a part found, or how Blender ended."""
        outcome = run.outcomes.get(CHECK)
        if outcome is None:
            return f"Blender ended: {run.output.splitlines()[-1]}"
        if "error" in outcome:
            return " ".join(outcome["error"].split())[-400:]
        output = self.folder / f"{self.host.name}_{MODULE}" / "output.txt"
        if "Traceback" in output.read_text(errors="replace"):
            return "a handler raised an exception"
        return grown_too_much(outcome["value"]["sizes"])

    def _keep(self, run: Run, wrong: str) -> None:
        failed = self.folder / f"failed_{1 + len(self.failed())}"
        failed.mkdir()
        for path in self.folder.iterdir():
            if path.is_file():
                shutil.copy(path, failed)
        output = self.folder / f"{self.host.name}_{MODULE}" / "output.txt"
        shutil.copy(output, failed)
        error = run.outcomes.get(CHECK, {}).get("error", "")
        (failed / "wrong.txt").write_text(f"{wrong}\n\n{error}")
        state = self.folder / "state.json"
        if state.exists():
            content = json.loads(state.read_text())
            content["tries"] += 1
            state.write_text(json.dumps(content))


def grown(sizes: list[list[float]]) -> float:
    """MB by which a process grew over a part, from pairs of MB and datablocks at each load."""
    return sizes[-1][0] - sizes[0][0]


def grown_too_much(sizes: list[list[float]]) -> str | None:
    """What is wrong with the sizes of a part, or None."""
    return f"the process grew by {grown(sizes):.0f} MB" if grown(sizes) > GROWN_MB else None


def summary(walk: LongWalk) -> str:
    """One line of what a walk has seen."""
    parts = walk.parts()
    if not parts:
        return f"{walk.name:12} 0 edits"
    sizes = [size for part in parts for size in part["sizes"]]
    most = max(grown(part["sizes"]) for part in parts)
    blocks = [count for _mb, count in sizes]
    sums = {name: sum(part[name] for part in parts) for name in ("compared", "through", "late", "edits_beside")}
    return (
        f"{walk.name:12} {walk.steps():6} edits, {sums['compared']:6} tables and {sums['through']:5} shapes compared, "
        f"{sums['edits_beside']:5} edits beside; a process grew by {most:.0f} MB at most; "
        f"{min(blocks)} to {max(blocks)} datablocks, {blocks[-1]} at last; "
        f"{len(walk.failed())} parts failed"
    )


def main(arguments: list[str]) -> int:
    """Takes parts in turn until every walk has as many edits; returns 1 if anything was wrong in any part ever."""
    wanted, names = int(arguments[0]), arguments[1:] or [host.name for host in HOSTS]
    walks = [LongWalk(host, beside) for beside in (False, True) for host in HOSTS if host.name in names]
    stuck = dict.fromkeys(walks, 0)  # parts in a row that failed
    while left := [walk for walk in walks if walk.steps() < wanted and stuck[walk] < GIVE_UP]:
        # Beside another add-on when all have walked alone.
        for walk in [walk for walk in left if walk.beside == left[0].beside]:
            before = walk.steps()
            wrong = walk.take_part(min(PART, wanted - before))
            stuck[walk] = stuck[walk] + 1 if walk.steps() == before else 0
            print(f"{walk.name}: {before} to {walk.steps()}{f': {wrong}' if wrong else ''}", flush=True)
    print(*map(summary, walks), sep="\n")
    return int(any(walk.failed() for walk in walks))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
