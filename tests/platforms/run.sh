#!/usr/bin/env bash
# The tests of `scripts/test --platforms`: packages for Windows are made and tested under Wine.
# Usage: run.sh [PYTEST-ARGUMENT...]
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
bash scripts/setup --tests
bash scripts/setup --platforms
bash scripts/build
bash scripts/package linux-x64 windows-x64 3.11
bash tests/platforms/prepare_windows.sh
make_environment twine "$(find_python 3.11)"
say "packages for other systems"
SKINGLOW_CLI=$project/build/release/bin/skinglow "$envs/tools/bin/python" -m pytest tests/platforms "$@" | tee build/pytest_platforms.log
! grep '^SKIPPED' build/pytest_platforms.log || fail "tests were skipped"
