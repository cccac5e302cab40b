# Sourced by scripts/package: portable wheels of the Python package, in build/packages.

# Folders with just those headers that a portable build may see, none of the machine's C library.
gather_headers() {
    rm -rf "$portable/headers"
    mkdir -p "$portable/headers/glm/include" "$portable/headers/nlohmann_json/include" \
        "$portable/headers/fast_float/include" "$portable/headers/debian"
    cp "$steps/glmConfig.cmake" "$portable/headers/glm/"
    ln -s /usr/include/glm "$portable/headers/glm/include/glm"
    cp "$steps/nlohmann_jsonConfig.cmake" /usr/share/cmake/nlohmann_json/nlohmann_jsonConfigVersion.cmake \
        "$portable/headers/nlohmann_json/"
    ln -s /usr/include/nlohmann "$portable/headers/nlohmann_json/include/nlohmann"
    cp "$steps/FastFloatConfig.cmake" /usr/lib/cmake/FastFloat/FastFloatConfigVersion.cmake "$portable/headers/fast_float/"
    ln -s /usr/include/fast_float "$portable/headers/fast_float/include/fast_float"
    # Debian's Python keeps a part of its configuration apart.
    ln -s /usr/include/x86_64-linux-gnu "$portable/headers/debian/x86_64-linux-gnu"
}

# third_party wheel|addon TARGET FOLDER PYTHON: the licenses of what is compiled in, which ask to be passed on with it, and a bill of
# materials.
third_party() {
    "$4" "$steps/third_party.py" "$1" "$2" "$project" "$portable" "$3" "embree=$embree_version=$embree_sha256" \
        "highway=$highway_version=$highway_sha256" || fail "the licenses or the bill of materials could not be gathered"
}

# build_digest SETTING...: of all that a build folder keeps from its first configuration or that its linker reads unbeknown to ninja: the
# libraries, the toolchain and the recipes, the compiler, and what CMake is told. Another digest asks for another folder.
build_digest() {
    {
        cat "$built"/{embree,highway}/digest "$toolchain" "$steps"/{portable_modules,*Config}.cmake "$steps/exported_symbols.map" \
            "$steps"/{portable_tools,wheels}.sh "$steps/${target%%-*}.sh" "$project"/{pyproject.toml,packaging/pins/package.txt}
        printf '%s\n' "$@"
    } | sha256sum
}

# What wheels are made of; they are made again when it changes.
wheel_digest() {
    {
        find CMakeLists.txt pyproject.toml README.md core python_bindings povray_macros -type f ! -path '*__pycache__*' ! -path 'core/src/cli/*' -print0 |
            sort -z | xargs -0 sha256sum
        cat "$built"/{embree,highway}/digest "$steps"/*.cmake "$steps/exported_symbols.map" "$steps/third_party.py" "$steps"/*.sh
        "$1" --version
    } | sha256sum
}

# build_wheel VERSION PYTHON: the wheel of the target for that version, by this machine's Python of the same version.
build_wheel() {
    local tag=cp${1/./} python=$2 want work=$built/wheel_$1
    want=$(wheel_digest "$python")
    if [ "$(cat "$work/digest" 2>/dev/null)" = "$want" ] && compgen -G "$packages/skinglow-*-$tag-$wheel_platform.whl" >/dev/null
    then return; fi
    say "building the wheel for $target and Python $1"
    gather_headers
    third_party wheel "$target" "$built/wheel_parts" "$python"
    rm -rf "$work" "$packages"/skinglow-*-"$tag-$tag"-$wheel_platform.whl
    mkdir -p "$work"
    local setting told settings=(build-dir="$built/skinglow_build" install.components=python) core_settings=(SKINGLOW_RAYS=ON
        SKINGLOW_PARTS="$built/wheel_parts" CMAKE_TOOLCHAIN_FILE="$toolchain"
        CMAKE_PROJECT_skinglow_INCLUDE="$steps/portable_modules.cmake"
        glm_DIR="$portable/headers/glm" nlohmann_json_DIR="$portable/headers/nlohmann_json" FastFloat_DIR="$portable/headers/fast_float"
        embree_DIR="$built/embree/lib/cmake/embree-$embree_version" hwy_DIR="$built/highway/lib/cmake/hwy")
    target_settings "$1"
    for setting in "${core_settings[@]}" "${more_settings[@]}"; do settings+=("cmake.define.$setting"); done
    # One build folder for all versions: the core does not depend on Python and is compiled once.
    told=$(build_digest "${core_settings[@]}")
    [ "$(cat "$built/skinglow_build/told" 2>/dev/null)" = "$told" ] || rm -rf "$built/skinglow_build"
    mkdir -p "$built/skinglow_build"
    printf '%s' "$told" >"$built/skinglow_build/told"
    {
        "$python" -m pip wheel --no-build-isolation --no-deps --wheel-dir "$work" "${settings[@]/#/--config-settings=}" . &&
            "$python" -m zipfile -e "$work"/*.whl "$work/unpacked" && finish_wheel "$python" "$work"
    } >"$work/log.txt" 2>&1 ||
        { tail -n 30 "$work/log.txt" >&2; fail "the wheel for $target and Python $1 did not build; the whole log: $work/log.txt"; }
    "$python" "$steps/wheel_modes.py" "$packages"/skinglow-*-"$tag-$tag"-$wheel_platform.whl
    printf '%s' "$want" >"$work/digest"
}

# The source as pip takes it, in build/packages.
build_source_package() {
    rm -f "$packages"/skinglow-*.tar.gz
    # From a copy of what is in it: the builder looks at each file of its folder, and build holds a hundred thousand.
    local copy parts
    copy=$(mktemp -d)
    parts=$("$1" -c 'from scikit_build_core._compat import tomllib
included = tomllib.load(open("pyproject.toml", "rb"))["tool"]["scikit-build"]["sdist"]["include"]
print(*(path.strip("/").removesuffix("/**") for path in included))')
    # shellcheck disable=SC2086  # a list of names
    cp -a .gitignore $parts "$copy"
    (cd "$copy" && "$1" -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' "$packages") \
        >"$portable/source_package.log" 2>&1 ||
        { tail -n 20 "$portable/source_package.log" >&2; fail "the source package could not be made"; }
    rm -rf "$copy"
}

# The small wheel by which scripts find the extension, for any Python, in build/portable/script_access.
build_script_access() {
    rm -rf "$portable/script_access"
    "$1" -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir "$portable/script_access" blender_addon/script_access \
        >"$portable/script_access.log" 2>&1 ||
        { tail -n 20 "$portable/script_access.log" >&2; fail "the wheel for scripts did not build"; }
    "$1" "$steps/wheel_modes.py" "$portable/script_access"/*.whl
}
