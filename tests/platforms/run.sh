#!/usr/bin/env bash
# The tests of `scripts/test --platforms`: another compiler; the source package; packages for Windows, under Wine, and for macOS,
# which are only looked at.
# Usage: run.sh [PYTEST-ARGUMENT...]
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
source tests/runners.sh
bash scripts/setup --tests
bash scripts/setup --platforms
bash scripts/build
bash scripts/package linux-x64 windows-x64 macos-arm64 3.11
bash tests/platforms/prepare_windows.sh
make_environment twine "$(find_python 3.11)"
"$envs/tools/bin/python" -c 'import lief, yaml' 2>/dev/null || install_pinned "$envs/tools" macos
test_cpp clang
say "packages for other systems"
export SKINGLOW_CLI=$project/build/release/bin/skinglow
if [ $# -eq 0 ]; then set -- tests/platforms; fi
test_python platforms "$envs/tools/bin/python" --durations=0 "$@"
say "all passed, in $(((SECONDS + 59) / 60)) minutes"
