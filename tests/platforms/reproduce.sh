#!/usr/bin/env bash
# Makes packages a second time, from nothing, in another folder, by another user's habits, and compares them byte by byte with those
# in build/packages. Called by scripts/test --reproducible; takes as long as the packages do.
# Usage: reproduce.sh [TARGET...] [PYTHON-VERSION...]     as scripts/package; default: linux-x64 3.11
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
if [ $# -eq 0 ]; then set -- linux-x64 3.11; fi
bash scripts/package "$@"
again=$(mktemp -d)/another/longer/path
trap 'rm -rf "${again%/another/*}"' EXIT
mkdir -p "$again/build/portable"
# What is committed or will be; a changed file as it is here.
git ls-files -z --cached --others --exclude-standard | tar -c --null --files-from=- |
    (umask 077 && tar -x --no-same-permissions -C "$again")
ln -s "$envs" "$again/build/envs"
[ ! -e build/pythons ] || ln -s "$project/build/pythons" "$again/build/pythons"
# What was fetched, and nothing that was made. Those tools are checked by their digests when they are installed.
find build/portable -maxdepth 1 -type f \( -name '*.tar.*' -o -name '*.jar' -o -name '*.whl' \) -exec cp -t "$again/build/portable" {} +
say "making the packages again, in $again"
(
    umask 077
    export LC_ALL=C HOME=$again/home TZ=Asia/Tokyo
    # Compiled, not taken from the cache of the first.
    export CMAKE_CXX_COMPILER_LAUNCHER= CMAKE_C_COMPILER_LAUNCHER= CCACHE_DISABLE=1
    mkdir -p "$HOME"
    bash "$again/scripts/package" "$@"
)
"$envs/tools/bin/python" tests/platforms/compare_packages.py build/packages "$again/build/packages"
