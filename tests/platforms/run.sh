#!/usr/bin/env bash
# The tests of `scripts/test --platforms`: another compiler; the source package; other versions of Blender; the core on another
# processor, by qemu; packages for Windows, under Wine, and for macOS, which are only looked at.
# Usage: run.sh [PYTEST-ARGUMENT...]
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
source tests/runners.sh
bash scripts/setup --tests
bash scripts/setup --platforms
bash scripts/build
bash scripts/package --repository all 3.11 3.13
bash tests/platforms/prepare_blenders.sh
bash tests/platforms/prepare_windows.sh
bash tests/platforms/prepare_arm64.sh
make_environment twine "$(find_python 3.11)"
"$envs/tools/bin/python" -c 'import lief, yaml' 2>/dev/null || install_pinned "$envs/tools" macos
test_cpp clang
cmake --build build/clang --target platform_results
say "packages for other systems, and another processor"
export SKINGLOW_CLI=$project/build/release/bin/skinglow
for version in 4.5 5.2; do export "SKINGLOW_BLENDER_${version/./}=$envs/blender-$version/bin/python"; done
if [ $# -eq 0 ]; then set -- tests/platforms tests/blender/test_repository.py; fi
test_python platforms "$envs/tools/bin/python" --durations=0 "$@"
say "all passed, in $(((SECONDS + 59) / 60)) minutes"
