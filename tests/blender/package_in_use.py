"""What a package has to do once Blender has installed it."""

import shutil
from pathlib import Path
from urllib.parse import unquote, urlparse

import numpy as np
from hosts import HERE, Host
from installation import Installation

PROJECT = HERE.parents[1]
#: What installed_package.py provokes in both modules, and the exception that it has to see.
REFUSALS = {
    "attenuation": ("ValueError", "distance"),
    "file": ("ValueError", "rig.json"),
    "type in _core": ("TypeError", "six_gaussian_base"),
    "thickness": ("ValueError", "triangles"),
    "type in _rays": ("TypeError", "thickness"),
    "raised by progress": ("ZeroDivisionError", "division"),
    "cancelled": ("ThicknessCancelled", ""),
    "mesh": ("ValueError", "meshes[1]"),
    "samples": ("ValueError", "samples"),
    "no light": ("TypeError", "Light"),
}


def check_installed_and_used(host: Host, package: Path, folder: Path) -> None:
    """Installs a copy of it into a clean profile in folder, uses it there without the project, and uninstalls it."""
    assert not folder.is_relative_to(PROJECT)
    installation = Installation(host, folder)
    package = Path(shutil.copy(package, folder))
    name = "skinglow_blender" if host.is_program else "bl_ext.user_default.skinglow_blender"
    assert installation.run("install", str(package))["enabled"] == name
    package.unlink()

    found = installation.run("use")
    assert found["enabled"] == name, "the add-on is enabled again when Blender starts"
    for part in ("skinglow", "core", "rays", "addon"):
        assert Path(found[part]).is_relative_to(installation.profile), f"{part} comes from {found[part]}"
    assert found["functions"] == []
    assert not [p for p in found["search_path"] if Path(p).is_relative_to(PROJECT)]
    assert {found["core"], found["rays"]} <= set(found["mapped"])
    # Of the project's folder only the environments are read, where bpy is, and nothing of ours in them.
    environments = PROJECT / "build" / "envs"
    used = [path for path in map(Path, found["opened"] + found["mapped"]) if path.is_relative_to(PROJECT)]
    assert not [path for path in used if not path.is_relative_to(environments)]
    assert not [path for path in used if "skinglow" in str(path.relative_to(environments))]

    # A ball of 48 x 24 faces around one of 20 mm is at most 1 % thinner, and rays add some of their own.
    np.testing.assert_allclose(found["thickness_mm"], 20.0, rtol=0.03)
    np.testing.assert_allclose(found["shown"], found["expected"], rtol=1e-6)
    assert found["shown"][0] != found["shown"][1]
    assert found["preferences"] == ["PAPER", False, True]
    assert found["refused"].keys() == REFUSALS.keys()
    for case, (kind, word) in REFUSALS.items():
        told = found["refused"][case]
        assert told and told[0] == kind and word in told[1], f"{case}: {told}"
    # The skin is closed and does not shadow itself; the wall does, and half of it about half.
    visible = found["visible"]
    assert visible["off"][0] == visible["alone"][0] == 1.0, visible
    assert visible["off"][1] == visible["alone"][1] > 0.0, visible
    assert 0.3 < visible["half"][0] < 0.7, visible
    assert visible["wall"] == [0.0, 0.0], visible
    assert 0.0 < found["render"] < 100.0
    assert found["batch"] == {"counts": [[2, 0, 0], [0, 2, 0]], "lines": ["rig", "rig"]}
    assert found["warnings"] == {}
    (page,) = found["manual"]
    assert Path(unquote(urlparse(page).path)).is_relative_to(installation.profile), page
    assert found["handlers_left"] == []
    assert found["removed"] == []
