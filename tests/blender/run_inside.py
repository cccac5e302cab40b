"""Runs in Blender: the checks of one module, each on an empty file, with one JSON line for each."""

import importlib
import json
import os
import sys
import time
import traceback
import warnings
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "blender_addon")]
# Behind all else: what the studies have of the same.
sys.path.append(str(HERE.parents[1]))
if os.environ.get("SKINGLOW_SITE"):
    # Behind Blender's own: only the core is wanted from there.
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
from process_end import run_and_exit  # noqa: E402


def main() -> None:
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    module_name, work, results, *wanted = arguments
    module = importlib.import_module(f"inside.{module_name}")
    checks = {name: value for name, value in vars(module).items() if name.startswith("check_")}
    with Path(results).open("w") as out:
        for name, check in checks.items():
            if wanted and name not in wanted:
                continue
            started = time.perf_counter()
            try:
                bpy.ops.wm.read_factory_settings(use_empty=True)
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always", DeprecationWarning)
                    outcome = {"value": check(Path(work))}
                require_current_names(caught)
            except BaseException:
                outcome = {"error": traceback.format_exc()}
            outcome.update(check=name, seconds=round(time.perf_counter() - started, 3))
            out.write(json.dumps(outcome) + "\n")
            out.flush()


def require_current_names(caught: list[warnings.WarningMessage]) -> None:
    """Raises AssertionError if a deprecated name of ours was used, by the add-on or by the check itself.

    Recorded rather than raised where it happens: handlers keep exceptions.
    """
    ours = {f"{w.filename}:{w.lineno}: {w.message}" for w in caught if " is now " in str(w.message)}
    assert not ours, "deprecated names:\n" + "\n".join(sorted(ours))


run_and_exit(main)
