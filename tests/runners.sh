# Sourced by scripts/test and tests/platforms/run.sh: how tests are run, each kind with a log of its own in build.

# test_cpp PRESET [PROGRAM...]: all C++ tests of that preset, or those of these programs, and for release the benchmarks, which
# have to build.
test_cpp() {
    say "building the C++ tests, preset $1"
    cmake --preset "$1" >"build/configure_$1.log" 2>&1 ||
        { tail -n 20 "build/configure_$1.log" >&2; fail "see build/configure_$1.log"; }
    cmake --build "build/$1" ${2:+--target "${@:2}"}
    say "C++ tests, preset $1"
    ctest --preset "$1" --parallel "$(nproc)" >"build/ctest_$1.log" 2>&1 ||
        { grep -vE 'Start |Passed' "build/ctest_$1.log" >&2; fail "C++ tests failed; the whole log: build/ctest_$1.log"; }
    tail -n 4 "build/ctest_$1.log"
}

# test_python NAME PYTHON PYTEST-ARGUMENT...: what is skipped for want of something that scripts/setup installs is a failure;
# the heads and references in ../shared are no part of the project.
test_python() {
    local log=build/pytest_$1.log python=$2
    shift 2
    "$python" -m pytest "$@" | tee "$log"
    ! grep '^SKIPPED' "$log" | grep -v '\.\./shared/data/\(heads\|shape\)' || fail "tests were skipped"
}
