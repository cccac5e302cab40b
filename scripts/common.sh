# Sourced by the scripts beside it: where things are, and how to install only what is missing.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
envs=$project/build/envs
cd "$project"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_ROOT_USER_ACTION=ignore
# What several builds compile alike, as the command line and the package do the core, is compiled once.
export CCACHE_DIR=${CCACHE_DIR:-$project/build/ccache} CCACHE_BASEDIR=$project CCACHE_NOHASHDIR=1
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER+set}" ] && command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

say() { printf '[%s] %s\n' "$(date +%H:%M:%S)" "$*"; }
fail() { printf 'skinglow: %s\n' "$*" >&2; exit 1; }

# is_there NAME: whether another system has what that Debian package brings: a program, a library or a header.
is_there() {
    local header=
    case $1 in
    ninja-build) command -v ninja >/dev/null ;;
    povray-includes) compgen -G "/usr/*share/povray*/include/colors.inc" >/dev/null ||
        compgen -G "/usr/local/share/povray*/include/colors.inc" >/dev/null ;;
    xvfb) command -v Xvfb >/dev/null ;;
    nodejs) command -v node >/dev/null ;;
    maven) command -v mvn >/dev/null ;;
    qemu-user) command -v qemu-aarch64 >/dev/null ;;
    lld-16) command -v ld64.lld-16 >/dev/null ;;
    slurm-wlm) command -v slurmctld >/dev/null ;;
    munge) command -v munged >/dev/null ;;
    wine64) command -v wine64 wine >/dev/null ;;
    python3-numpy) python3 -c 'import numpy' 2>/dev/null ;;
    python3-*) find_python 3.11 >/dev/null ;;
    libx11-6 | libegl1 | libgl1 | libgomp1 | libice6 | libsm6 | libxfixes3 | libxi6 | libxkbcommon0 | libxrender1 | libxxf86vm1)
        # libx11-6 is libX11.so.6, whatever the letters' case.
        ldconfig -p 2>/dev/null | grep -iE "^\s*$(sed -E 's/-?([0-9]+)$/.so.\1/' <<<"$1")\b" >/dev/null ;;
    libglm-dev) header=glm/glm.hpp ;;
    libeigen3-dev) header=Eigen/Core ;;
    libembree-dev) header=embree3/rtcore.h ;;
    libhwy-dev) header=hwy/highway.h ;;
    libopenimageio-dev) header=OpenImageIO/imageio.h ;;
    nlohmann-json3-dev) header=nlohmann/json.hpp ;;
    libfast-float-dev) header=fast_float/fast_float.h ;;
    libcli11-dev) header=CLI/CLI.hpp ;;
    libbenchmark-dev) header=benchmark/benchmark.h ;;
    libgtest-dev) header=gtest/gtest.h ;;
    *) command -v "$1" >/dev/null ;;
    esac || return 1
    # Eigen lies in a folder of its own.
    [ -z "$header" ] || g++ -std=c++20 -I/usr/include/eigen3 -E -x c++ -include "$header" /dev/null >/dev/null 2>&1
}

# Debian packages, only those that are not there yet. Other systems are told what they lack.
install_packages() {
    local missing=() name
    if ! command -v dpkg-query >/dev/null; then
        for name in "$@"; do is_there "$name" || missing+=("$name"); done
        [ ${#missing[@]} -eq 0 ] || fail "this system is not Debian 12, and lacks what these packages of Debian's bring; install" \
            "that by its own package manager, then run this again: ${missing[*]}"
        return 0
    fi
    for name in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    local as_root=()
    [ "$(id -u)" = 0 ] || as_root=(sudo)
    mkdir -p "$project/build"
    if ! { "${as_root[@]}" apt-get update &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
    } >"$project/build/apt.log" 2>&1; then
        tail -n 15 "$project/build/apt.log" >&2
        fail "apt-get could not install these packages; the whole log: build/apt.log"
    fi
}

# find_python 3.11: an interpreter of that version that can make virtual environments and has its C headers, from PATH,
# pyenv or fetch_python.
find_python() {
    local candidate check="import ensurepip, os, sys, sysconfig, venv
header = os.path.join(sysconfig.get_path('include'), 'Python.h')
sys.exit('%d.%d' % sys.version_info[:2] != '$1' or not os.path.exists(header))"
    for candidate in "python$1" python3 /usr/bin/python3 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python3 \
        "$project"/build/pythons/cpython-"$1".*/bin/python3; do
        if "$candidate" -c "$check" 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    return 1
}

# fetch_python 3.13 PYTHON: a Python that the system does not bring, by uv, which PYTHON gets from PyPI; in build/pythons.
fetch_python() {
    if find_python "$1" >/dev/null; then return; fi
    make_environment uv "$2"
    say "fetching Python $1"
    mkdir -p "$project/build"
    UV_PYTHON_INSTALL_DIR=$project/build/pythons "$envs/uv/bin/uv" python install --no-bin "$1" \
        >"$project/build/python_$1.log" 2>&1 && find_python "$1" >/dev/null || {
        tail -n 5 "$project/build/python_$1.log" >&2
        fail "Python $1 is needed, none is on PATH or in pyenv, and uv could not fetch one; install it (pyenv install $1)"
    }
}

# make_environment NAME PYTHON [LIST]: a virtual environment with what packaging/pins/LIST.txt pins, LIST being its name if not given;
# made again when LIST.in changes.
make_environment() {
    local where=$envs/$1 python=$2 list=$project/packaging/pins/${3:-$1} wanted
    mapfile -t wanted < <(grep -v '^#' "$list.in")
    local want="$python ${wanted[*]}"
    if [ "$(cat "$where/requirements" 2>/dev/null)" = "$want" ]; then return; fi
    say "making the Python environment $(basename "$where"): ${wanted[*]}"
    rm -rf "$where"
    "$python" -m venv "$where"
    install_pinned "$where" "$(basename "$list")"
    printf '%s' "$want" >"$where/requirements"
}

# install_pinned ENVIRONMENT LIST
install_pinned() {
    "$1/bin/pip" install --quiet --no-deps --require-hashes --requirement "$project/packaging/pins/$2.txt" ||
        fail "pip could not install packaging/pins/$2.txt"
}

# install_portable PYTHON: the portable wheel for that Python, of scripts/package, in the environment `portable`, with what
# its tests and benchmarks need.
install_portable() {
    local wheel digest
    make_environment portable "$1"
    wheel=$(ls "$project"/build/packages/skinglow-*-"$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')"-manylinux*.whl)
    digest=$(sha256sum <"$wheel")
    if [ "$(cat "$envs/portable/skinglow_digest" 2>/dev/null)" = "$digest" ]; then return; fi
    say "installing the portable wheel into portable"
    "$envs/portable/bin/pip" install --quiet --no-deps --no-index --force-reinstall "$wheel"
    printf '%s' "$digest" >"$envs/portable/skinglow_digest"
}
