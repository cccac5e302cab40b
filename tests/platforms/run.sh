#!/usr/bin/env bash
# The tests of `scripts/test --platforms`: packages for other systems are made and tested as far as this machine can, and the
# core with other compilers and processors. Takes an hour and more on two cores from nothing.
# Usage: run.sh [PYTEST-ARGUMENT...]
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
bash scripts/setup --tests
bash scripts/setup --platforms
bash scripts/build
bash scripts/package --repository all
bash tests/platforms/prepare_windows.sh
bash tests/platforms/build_arm64.sh
make_environment twine "$(find_python 3.11)"
say "packages for other systems, other compilers and processors"
SKINGLOW_CLI=$project/build/release/bin/skinglow "$envs/tools/bin/python" -m pytest tests/platforms "$@" | tee build/pytest_platforms.log
! grep '^SKIPPED' build/pytest_platforms.log || fail "tests were skipped"
