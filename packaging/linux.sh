# Sourced by scripts/package: what is particular to Linux on x86-64.
# Blender 4.2 to 5.0 and Debian's 3.4 bring Python 3.11, 5.1 and later 3.13; Blender.org's own 3.4 to 4.0 bring 3.10.
target_pythons=(3.11 3.13)
if find_python 3.10 >/dev/null; then target_pythons+=(3.10)
else say "no Python 3.10 here: the add-on for older Blenders will not fit those with Python 3.10"; fi
toolchain=$steps/portable_linux.cmake
wheel_platform='manylinux*_x86_64'
built=$portable
embree_more=()

# target_settings VERSION: CMake's further definitions, in more_settings.
target_settings() { more_settings=(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES="$portable/headers/debian"); }

# finish_wheel PYTHON FOLDER: from FOLDER/*.whl and FOLDER/unpacked into build/packages. Loading a module looks all its symbols up:
# what is missing shows here.
finish_wheel() {
    "$1" -c 'import ctypes, sys; [ctypes.CDLL(path) for path in sys.argv[1:]]' "$2"/unpacked/skinglow/*.so &&
        "$1" -m auditwheel repair --only-plat --wheel-dir "$packages" "$2"/*.whl
}
