# Sourced by scripts/package: what is particular to macOS 11 and later, on Apple's processors and Intel's.
# Blender for Intel's ended with 4.5.
# One instruction set, or Embree refuses to be static.
if [ "$target" = macos-arm64 ]; then
    target_pythons=(3.11 3.13)
    export SKINGLOW_ARCH=arm64
    embree_more=(-DEMBREE_ISA_SSE42=OFF -DEMBREE_ISA_AVX2=OFF -DEMBREE_ISA_AVX512=OFF -DEMBREE_ISA_NEON=ON -DEMBREE_ISA_NEON2X=OFF)
else
    target_pythons=(3.11)
    export SKINGLOW_ARCH=x86_64
    embree_more=(-DEMBREE_ISA_AVX2=OFF -DEMBREE_ISA_AVX512=OFF)
fi
toolchain=$steps/portable_macos.cmake
wheel_platform=macosx_11_0_$SKINGLOW_ARCH
built=$portable/$target

# prepare_linker PYTHON: what the modules are linked by (portable_modules.cmake): LLVM's linker, the list of what macOS 11 has (from
# an older zig; the newest lists more than there is on 11), and zig's C++ library, which it tells of when it links.
prepare_linker() {
    local zig=ziglang-0.10.1.post1-py3-none-manylinux_2_12_x86_64.manylinux2010_x86_64.musllinux_1_1_x86_64.whl
    local list=$portable/libSystem.11.tbd triple=x86_64-macos.11.0 told=$built/linker.txt
    SKINGLOW_LLD=$(command -v ld64.lld-16 || command -v /usr/lib/llvm-16/bin/ld64.lld) ||
        fail "macOS needs LLVM's linker: install Debian's lld-16 (scripts/setup --platforms)"
    if [ ! -s "$list" ]; then
        [ -e "$portable/$zig" ] || "$1" -m pip download --quiet --no-deps --only-binary :all: --platform manylinux_2_12_x86_64 \
            --dest "$portable" ziglang==0.10.1.post1 || fail "pip could not fetch ziglang 0.10.1.post1"
        sha256sum --check --status <<<"e9f7aa2c6a44dd23fb0c11722eaaca2626272ef52ac1aeb20fe8d761ca490638  $portable/$zig" ||
            fail "$portable/$zig does not have the expected SHA-256 digest"
        "$1" -c 'import sys, zipfile
sys.stdout.buffer.write(zipfile.ZipFile(sys.argv[1]).read("ziglang/lib/libc/darwin/libSystem.11.tbd"))' "$portable/$zig" >"$list"
    fi
    [ "$SKINGLOW_ARCH" = x86_64 ] || triple=aarch64-macos.11.0
    # Another zig has another library, in another folder.
    if ! [ "$told" -nt "$portable/tools/requirements" ] || ! ls $(cat "$told") >/dev/null 2>&1; then
        echo 'int nothing() { return 0; }' >"$built/nothing.cpp"
        ZIG_VERBOSE_LINK=1 "$SKINGLOW_ZIG" c++ -target "$triple" -shared "$built/nothing.cpp" -o "$built/nothing.dylib" \
            >"$built/linker.log" 2>&1 || { cat "$built/linker.log" >&2; fail "zig could not build its C++ library for $target"; }
        # By paths from the current folder, which is not the one that the modules are linked in.
        tr ' ' '\n' <"$built/linker.log" | grep -E '/lib(c\+\+|c\+\+abi|compiler_rt)\.a$' | sort -u | xargs realpath >"$told" ||
            fail "zig does not tell where its C++ library is: $built/linker.log"
    fi
    SKINGLOW_MACOS_LIBRARIES="$(tr '\n' ' ' <"$told") $list"
    export SKINGLOW_LLD SKINGLOW_MACOS_LIBRARIES
}

# target_settings VERSION: CMake's further definitions, in more_settings: the headers of that Python. Those of 3.11 for Apple's
# processors are the same as Intel's.
target_settings() {
    local folder=$portable/python_macos_$1
    case $1 in
    3.11) fetch_python_jar "$folder" 3.11.3-1.5.9 macosx-x86_64 223aed1538351b9df68781f60afa865c5ca6cc640353cb5d46b4706049cec5e4 ;;
    3.13) fetch_python_jar "$folder" 3.13.0-1.5.11 macosx-arm64 7ad951d158fcb50d5fc3d485712c700c248ce1c747a64148c7dfda5ec140cf0b ;;
    *) fail "no Blender for macOS brings Python $1" ;;
    esac
    prepare_linker "$first_python"
    # pybind11 derives the second from the first, but keeps that of the version that was built before.
    more_settings=(PYBIND11_USE_CROSSCOMPILING=ON PYTHON_MODULE_{EXT_SUFFIX,EXTENSION}=".cpython-${1/./}-darwin.so" PYTHON_MODULE_DEBUG_POSTFIX=
        Python_INCLUDE_DIR="$folder/include/python$1")
}

# finish_wheel PYTHON FOLDER: from FOLDER/*.whl, which is named for this machine, into build/packages.
finish_wheel() { "$1" "$steps/name_wheel.py" "$2"/*.whl "$packages" "$wheel_platform"; }
