# Sourced by scripts/package: a static Highway for the portable wheels, in $built/highway: the version that the ordinary
# build links, with what skinglow uses of it and no more.
highway_version=1.0.3
highway_source=highway_$highway_version.orig.tar.gz
highway_sha256=566fc77315878473d9a6bd815f7de78c73734acdcb745c3dde8579560ac5440e

build_highway() {
    local want
    want=$(cat "$steps/highway.sh" "$steps/highway/CMakeLists.txt" "$toolchain" "$portable/tools/requirements" |
        sha256sum)
    [ "$(cat "$built/highway/digest" 2>/dev/null)" != "$want" ] || return 0
    fetch_source libhwy-dev "$highway_source" "$highway_sha256"
    say "building Highway $highway_version for $target"
    rm -rf "$built"/highway{,_build} "$portable/highway_source"
    mkdir -p "$portable/highway_source"
    tar -C "$portable/highway_source" --strip-components=1 -xzf "$portable/$highway_source"
    {
        cmake -G Ninja -S "$steps/highway" -B "$built/highway_build" -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_INSTALL_PREFIX="$built/highway" \
            -DHIGHWAY_SOURCE="$portable/highway_source" &&
            cmake --build "$built/highway_build" && cmake --install "$built/highway_build"
    } >"$built/highway.log" 2>&1 ||
        { tail -n 20 "$built/highway.log" >&2; fail "Highway did not build; the whole log: $built/highway.log"; }
    printf '%s' "$want" >"$built/highway/digest"
}
