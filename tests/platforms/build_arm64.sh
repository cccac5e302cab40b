#!/usr/bin/env bash
# Cross-builds the C++ tests of the core and of its rays for Linux on arm64, by the compiler and the Embree (with NEON) of the packages
# for Apple's processors, in build/portable/linux-arm64. Called by scripts/test --platforms; an emulator runs them (test_arm64.py).
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
steps=$project/packaging portable=$project/build/portable target=linux-arm64
built=$portable/$target toolchain=$project/tests/platforms/linux_arm64.cmake
embree_more=(-DEMBREE_ISA_SSE42=OFF -DEMBREE_ISA_NEON=ON -DEMBREE_ISA_NEON2X=OFF)
source "$steps/portable_tools.sh"
source "$steps/debian_source.sh"
use_portable_tools "$(find_python 3.11)"
mkdir -p "$built"
source "$steps/embree.sh"
source "$steps/highway.sh"
source "$steps/wheels.sh"
build_embree
build_highway
gather_headers
say "building the C++ tests for $target"
{
    cmake -G Ninja -S /usr/src/googletest/googletest -B "$built/googletest_build" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_TOOLCHAIN_FILE="$toolchain" -DCMAKE_INSTALL_PREFIX="$built/googletest" &&
        cmake --build "$built/googletest_build" && cmake --install "$built/googletest_build" &&
        cmake -G Ninja -S "$project" -B "$built/tests" -DCMAKE_BUILD_TYPE=Release -DCMAKE_TOOLCHAIN_FILE="$toolchain" \
            -DSKINGLOW_TESTS=ON -DSKINGLOW_TOOLS=OFF -DSKINGLOW_RAYS=ON -Dglm_DIR="$portable/headers/glm" \
            -Dembree_DIR="$built/embree/lib/cmake/embree-$embree_version" -Dhwy_DIR="$built/highway/lib/cmake/hwy" \
            -DGTest_DIR="$built/googletest/lib/cmake/GTest" &&
        cmake --build "$built/tests" --target ground_tests light_tests slab_tests rays_tests
} >"$built/tests.log" 2>&1 || { tail -n 20 "$built/tests.log" >&2; fail "the tests for arm64 did not build; the whole log: $built/tests.log"; }
