# Sourced by scripts/package: what is particular to Windows on x86-64.
target_pythons=(3.11 3.13)
toolchain=$steps/portable_windows.cmake
wheel_platform=win_amd64
built=$portable/$target
embree_more=()

# target_settings VERSION: CMake's further definitions, in more_settings: the headers and the import library of that Python.
target_settings() {
    local folder=$portable/python_windows_$1 tag=${1/./}
    case $1 in
    3.11) fetch_python_jar "$folder" 3.11.3-1.5.9 windows-x86_64 3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834 ;;
    3.13) fetch_python_jar "$folder" 3.13.0-1.5.11 windows-x86_64 dd3590a19413e7e3e8b01d8dfd88ee2fc97f2fd0079e50d47fa6a55c41b0afc3 ;;
    *) fail "no Blender for Windows brings Python $1" ;;
    esac
    # pybind11 derives the second from the first, but keeps that of the version that was built before.
    more_settings=(PYBIND11_USE_CROSSCOMPILING=ON PYTHON_MODULE_{EXT_SUFFIX,EXTENSION}=".cp$tag-win_amd64.pyd" PYTHON_MODULE_DEBUG_POSTFIX=
        Python_INCLUDE_DIR="$folder/include" Python_LIBRARY="$folder/libs/python$tag.lib")
}

# finish_wheel PYTHON FOLDER: from FOLDER/*.whl, which is named for this machine, into build/packages.
finish_wheel() { "$1" "$steps/name_wheel.py" "$2"/*.whl "$packages" win_amd64; }
