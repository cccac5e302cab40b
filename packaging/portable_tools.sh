# Sourced by scripts/package: the compiler and what else packages are made with.

# use_portable_tools PYTHON: sets the environment up for them. Each Python builds its wheel with the same tools, installed once, for
# the oldest of them, with the digests that are pinned.
use_portable_tools() {
    if ! cmp -s "$project/packaging/pins/package.txt" "$portable/tools/requirements"; then
        say "installing the tools for portable packages"
        rm -rf "$portable/tools"
        "$1" -m pip install --quiet --target "$portable/tools" --python-version 3.10 --only-binary :all: \
            --no-deps --require-hashes --requirement "$project/packaging/pins/package.txt" ||
            fail "pip could not install packaging/pins/package.txt"
        cp "$project/packaging/pins/package.txt" "$portable/tools/requirements"
    fi
    export PYTHONPATH=$portable/tools PATH=$portable/tools/bin:$PATH
    export SKINGLOW_ZIG=$portable/tools/ziglang/zig ZIG_GLOBAL_CACHE_DIR=$portable/zig_cache SKINGLOW_BIN=$portable/bin
    # zig's own of these tools know other systems' files; CMake wants a program for each.
    local tool
    mkdir -p "$SKINGLOW_BIN"
    for tool in ar ranlib rc; do
        printf '#!/bin/sh\nexec "$SKINGLOW_ZIG" %s "$@"\n' "$tool" >"$SKINGLOW_BIN/$tool"
        chmod +x "$SKINGLOW_BIN/$tool"
    done
    # The date of every file in the packages, so that the same sources give the same bytes.
    export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-1767225600} TZ=UTC
    unset CXX CC CXXFLAGS CFLAGS LDFLAGS
}
