#!/usr/bin/env bash
# Runs every fuzz target under the address and undefined-behavior sanitizers, one after the other, from its corpus, and prints
# what each executed and covered. An input that fails stays in build/fuzz/failed/TARGET: mend the fault, and keep the input as
# tests/fuzz/corpus/TARGET/WHAT_IT_IS. What more is found on the way is kept in build/fuzz/found, for the next run.
# Usage: scripts/test --fuzz SECONDS [TARGET...]    SECONDS in all, shared by the targets
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
seconds=${1:?how many seconds in all?}
shift
bash scripts/setup --tests
install_packages clang libclang-rt-14-dev
say "building the fuzz targets"
mkdir -p build/fuzz
cmake --preset fuzz -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >build/fuzz/configure.log 2>&1 ||
    { tail -n 20 build/fuzz/configure.log >&2; fail "see build/fuzz/configure.log"; }
cmake --build --preset fuzz
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls tests/fuzz/corpus)
each=$((seconds * $(nproc) / ${#targets[@]}))
[ "$each" -gt 0 ] || fail "$seconds s are too few for ${#targets[@]} targets"

# fuzz TARGET: a time-out or more memory than allowed counts as a failure.
fuzz() {
    local name=$1 found=build/fuzz/found/$1 log=build/fuzz/$1.log
    mkdir -p "$found" "build/fuzz/failed/$name"
    # Without the stack of each allocation unwound slowly, which the suppressions of leaks in libraries need, and nobody else.
    if ASAN_OPTIONS=fast_unwind_on_malloc=$([ "$name" = lut_png ] && echo 0 || echo 1) "build/fuzz/tests/fuzz/${name}_fuzz" "$found" "tests/fuzz/corpus/$name" -max_total_time="$each" -max_len=4096 -timeout=20 \
        -rss_limit_mb=3000 -print_final_stats=1 -artifact_prefix="build/fuzz/failed/$name/" >"$log" 2>&1; then
        printf '%-14s %12s executions, %6s edges\n' "$name" "$(awk '/number_of_executed_units/ {print $2}' "$log")" \
            "$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -c6-)"
    else
        printf '%-14s FAILED: %s\n' "$name" "$(grep -m 1 -E 'property does not hold|ERROR:|runtime error' "$log")"
        return 1
    fi
}
export -f fuzz
export each
say "${#targets[@]} targets, $each s each, $(nproc) at a time"
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I {} bash -c 'fuzz {}' || fail "see build/fuzz/TARGET.log and build/fuzz/failed"
