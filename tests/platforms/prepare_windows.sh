#!/usr/bin/env bash
# Pythons for Windows, run by Wine, with what tests need, in build/windows; 3.11 with Blender's module (330 MB). Called by
# scripts/test --platforms, after scripts/package windows-x64, which fetches these Pythons for their headers.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
command -v wine >/dev/null || fail "wine is needed: scripts/setup --platforms"
for version in 3.11 3.13; do
    here=$project/build/windows/python-$version pins=$project/packaging/pins/windows-$version.txt
    theirs=$project/build/portable/python_windows_$version
    [ -e "$theirs/python.exe" ] || fail "there is no Python $version for Windows: scripts/package windows-x64"
    if cmp -s "$pins" "$here/requirements"; then continue; fi
    say "making the Python environment for Windows and $version"
    rm -rf "$here"
    mkdir -p "$(dirname "$here")"
    cp -r "$theirs" "$here"
    # pip would ask this machine's Python whether the packages are for it.
    "$envs/tools/bin/pip" install --quiet --target "$here/lib/site-packages" --platform win_amd64 --python-version "$version" \
        --only-binary :all: --no-deps --ignore-requires-python --require-hashes --requirement "$pins" || fail "pip could not install $pins"
    if [ "$version" = 3.13 ]; then
        # Its module platform asks Windows by _wmi, of which Wine 8 lacks a part: Wine ends Python there, or waits for a debugger. Without
        # _wmi, platform asks as it did before.
        printf 'import sys\n\nsys.modules["_wmi"] = None\n' >"$here/lib/site-packages/sitecustomize.py"
    fi
    cp "$pins" "$here/requirements"
done
