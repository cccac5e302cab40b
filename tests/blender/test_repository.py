"""The static repository that scripts/package --repository makes."""

import functools
import hashlib
import http.server
import json
import re
import shutil
import subprocess
import threading
import zipfile
from pathlib import Path

import numpy as np
from hosts import host_named
from installation import PACKAGES, Installation


def test_installed_and_updated_from_a_repository(tmp_path: Path) -> None:
    """That of scripts/package --repository, in a clean Blender, from a web server of this machine."""
    site = Path(shutil.copytree(PACKAGES / "repository", tmp_path / "site"))
    index = json.loads((site / "index.json").read_text())
    assert index["data"] and {platform for entry in index["data"] for platform in entry["platforms"]} >= {"linux-x64"}
    for entry in index["data"]:
        text = (site / entry["archive_url"]).read_bytes()
        assert entry["archive_hash"] == f"sha256:{hashlib.sha256(text).hexdigest()}" and len(entry["platforms"]) == 1
        assert entry["copyright"][0] == "2026 Skinglow contributors" and len(entry["copyright"]) > 8

    installation = Installation(host_named("4.5"), tmp_path)
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(site))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        found = installation.run("subscribe", f"http://127.0.0.1:{server.server_port}/index.json")
        assert found["enabled"].startswith("bl_ext.") and found["enabled"].endswith(".skinglow_blender")
        assert index["data"][0]["version"] == found["version"]
        np.testing.assert_allclose(found["thickest_mm"], 20.0, rtol=0.03)
        publish_next_version(site, "99.0.0")
        assert installation.run("upgrade") == found | {"version": "99.0.0"}
        server.shutdown()


def publish_next_version(site: Path, version: str) -> None:
    """The package for this machine once more, under another version."""
    (package,) = site.glob("*-linux-x64.zip")
    newer = package.with_name(f"skinglow_blender-{version}-linux-x64.zip")
    with zipfile.ZipFile(package) as old, zipfile.ZipFile(newer, "w", zipfile.ZIP_STORED) as new:
        for entry in old.infolist():
            data = old.read(entry)
            if entry.filename.endswith("blender_manifest.toml"):
                data = re.sub(rb'(?m)^version = ".*"', f'version = "{version}"'.encode(), data)
            new.writestr(entry, data)
    package.unlink()
    python = Path(host_named("4.5").path)
    (program,) = python.parents[1].glob(
        "lib/python3*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    )
    subprocess.run([python, program, "server-generate", "--repo-dir", site], check=True)
