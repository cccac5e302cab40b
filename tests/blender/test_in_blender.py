"""Every check of inside/*.py in every Blender host; the checks themselves run in Blender (run_inside.py)."""

import ast
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import pytest
from hosts import HERE, HOSTS, Host, Run, run_module

#: Seconds after which a module is stopped: several times what it takes where two run side by side on two cores.
SECONDS = 900
#: As many Blenders side by side; each uses one core most of its time.
AT_ONCE = min(4, os.cpu_count() or 1)
#: By module and host.
Runs = dict[tuple[str, Host], Future[Run]]


def checks() -> list[tuple[str, str]]:
    """(module, check) of all of them, read without importing: they import bpy."""
    found = []
    for path in sorted((HERE / "inside").glob("*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("check_"):
                found.append((path.stem, node.name))
    return found


@pytest.fixture(scope="session")
def runs(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Runs]:
    """The run of each (module, host) that a chosen test asks for, started ahead of the tests, in their order."""
    folder = tmp_path_factory.mktemp("blender")
    cases = [item.callspec.params for item in request.session.items if item.function is test_check]
    wanted = dict.fromkeys((case["module"], case["host"]) for case in cases)
    with ThreadPoolExecutor(AT_ONCE) as pool:
        yield {(module, host): pool.submit(run_module, host, module, folder, SECONDS) for module, host in wanted}
        pool.shutdown(cancel_futures=True)


@pytest.mark.parametrize("host", HOSTS, ids=lambda host: host.name)
@pytest.mark.parametrize(("module", "check"), checks())
def test_check(host: Host, module: str, check: str, runs: Runs) -> None:
    run = runs[module, host].result()
    assert check in run.outcomes, f"{check} gave no result in Blender {host.name}:\n{run.output}"
    outcome = run.outcomes[check]
    assert "error" not in outcome, f"in Blender {host.name}:\n{outcome['error']}"
