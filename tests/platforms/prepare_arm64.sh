#!/usr/bin/env bash
# The core, its C++ tests and platform_results for arm64, by the compiler of the packages, in build/arm64; qemu runs them. Called by
# scripts/test --platforms. With the same recipes as the packages' Embree and Highway.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
command -v qemu-aarch64 >/dev/null || fail "qemu-aarch64 is needed: scripts/setup --platforms"
steps=$project/packaging
portable=$project/build/portable
target=arm64
built=$project/build/arm64
toolchain=$project/tests/platforms/linux_arm64.cmake
# One instruction set, or Embree refuses to be static: as for Apple's processors, which Embree knows by their system.
embree_more=(-DEMBREE_ARM=ON -DEMBREE_ISA_SSE42=OFF -DEMBREE_ISA_AVX2=OFF -DEMBREE_ISA_AVX512=OFF -DEMBREE_ISA_NEON=ON -DEMBREE_ISA_NEON2X=OFF)
mkdir -p "$portable" "$built"
source "$steps/portable_tools.sh"
use_portable_tools "$(find_python 3.11)"
source "$steps/debian_source.sh"
source "$steps/embree.sh"
source "$steps/highway.sh"
source "$steps/wheels.sh"
build_embree
build_highway
gather_headers

if [ ! -e "$built/googletest/lib/cmake/GTest/GTestConfig.cmake" ]; then
    say "building GoogleTest for $target"
    {
        cmake -G Ninja -S /usr/src/googletest -B "$built/googletest_build" -DCMAKE_BUILD_TYPE=Release -DBUILD_GMOCK=OFF \
            -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_INSTALL_PREFIX="$built/googletest" -DCMAKE_INSTALL_LIBDIR=lib &&
            cmake --build "$built/googletest_build" && cmake --install "$built/googletest_build"
    } >"$built/googletest.log" 2>&1 || { tail -n 20 "$built/googletest.log" >&2; fail "see $built/googletest.log"; }
fi

say "building the core and its C++ tests for $target"
{
    # Tests are found when they are asked for, not by qemu after each link.
    cmake -G Ninja -S . -B "$built/skinglow" -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$toolchain" \
        -DSKINGLOW_TOOLS=OFF -DSKINGLOW_TESTS=ON -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST \
        -DGTest_DIR="$built/googletest/lib/cmake/GTest" -Dglm_DIR="$portable/headers/glm" \
        -Dembree_DIR="$built/embree/lib/cmake/embree-$embree_version" -Dhwy_DIR="$built/highway/lib/cmake/hwy" &&
        cmake --build "$built/skinglow" --target ground_tests light_tests tile_tests slab_tests skin_tests rays_tests shape_tests \
            platform_results
} >"$built/skinglow.log" 2>&1 || { tail -n 30 "$built/skinglow.log" >&2; fail "see $built/skinglow.log"; }
