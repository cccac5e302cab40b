"""Every check of inside/*.py in every Blender host; the checks themselves run in Blender (run_inside.py)."""

import ast
from pathlib import Path

import pytest
from hosts import HERE, Host, hosts_here, run_module

#: Seconds that a module may take, where it is more than the rest.
SECONDS = {"rendered_eevee": 300}


def checks() -> list[tuple[str, str]]:
    """(module, check) of all of them, read without importing: they import bpy."""
    found = []
    for path in sorted((HERE / "inside").glob("*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("check_"):
                found.append((path.stem, node.name))
    return found


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("blender")


@pytest.mark.parametrize("host", hosts_here(), ids=lambda host: host.name)
@pytest.mark.parametrize(("module", "check"), checks())
def test_check(host: Host, module: str, check: str, run_folder: Path) -> None:
    run = run_module(host, module, run_folder, SECONDS.get(module, 120))
    assert check in run.outcomes, f"{check} gave no result in Blender {host.name}:\n{run.output}"
    outcome = run.outcomes[check]
    assert "error" not in outcome, f"in Blender {host.name}:\n{outcome['error']}"
