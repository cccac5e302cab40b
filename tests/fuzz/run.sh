#!/usr/bin/env bash
# Runs every fuzz target under the address and undefined-behavior sanitizers, one after the other, from its corpus, and prints
# what each executed and covered. An input that fails stays in build/fuzz/failed/TARGET: mend the fault, and keep the input as
# tests/fuzz/corpus/TARGET/mended/WHAT_IT_IS. What more is found on the way is kept in build/fuzz/found, for the next run. All runs
# are added up in build/fuzz/tally.csv, and their sums written into docs/trust.md.
# Usage: scripts/test --fuzz SECONDS [TARGET...]    SECONDS in all, shared by the targets: more for those that execute fast
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
jobs=${FUZZ_JOBS:-$(nproc)}

# share TARGET: its parts of the time. Readers of text and meshes execute thousands of inputs a second, solvers some ten.
share() {
    case $1 in
    studio_light | mesh_* | lut_csv) echo 4 ;;
    rig_file | irradiance | thickness | povray) echo 2 ;;
    *) echo 1 ;;
    esac
}
parts=0
for target in "${targets[@]}"; do parts=$((parts + $(share "$target"))); done
each=$((seconds * jobs / parts))
[ "$each" -gt 0 ] || fail "$seconds s are too few for ${#targets[@]} targets"

# limits TARGET: megabytes that one allocation and all together may take, and seconds. Pictures may have 2^26 pixels, whatever their file's size.
limits() {
    case $1 in
    lut_exr | lut_png | compare) echo 1100 3000 20 ;;
    shape) echo 256 1000 120 ;; # a plate of 20 x 6 x 0.4 is 35,000 cells: 2 s without the sanitizers
    *) echo 64 1000 20 ;;
    esac
}

# run_target TARGET ARGUMENT...: without as much memory in quarantine as is the default, whose first use takes most of the time.
run_target() {
    local name=$1 one all longest
    shift
    read -r one all longest < <(limits "$name")
    ASAN_OPTIONS=malloc_context_size=8:quarantine_size_mb=16 "build/fuzz/tests/fuzz/${name}_fuzz" "$@" -timeout="$longest" \
        -malloc_limit_mb="$one" -rss_limit_mb="$all" -artifact_prefix="build/fuzz/failed/$name/"
}

# fuzz TARGET: a time-out or more memory than allowed counts as a failure; a time-out only if it shows again, because the process may
# have been held up.
fuzz() {
    local name=$1 found=build/fuzz/found/$1 log=build/fuzz/$1.log start=$SECONDS outcome=passed input executions edges
    mkdir -p "$found" "build/fuzz/failed/$name"
    if ! run_target "$name" "$found" "tests/fuzz/corpus/$name" -max_total_time=$((each * $(share "$name"))) -max_len=1024 \
        -print_final_stats=1 >"$log" 2>&1; then
        outcome=failed
        input=$(grep -o 'build/fuzz/failed/.*/timeout-[0-9a-f]*' "$log" | tail -n 1)
        if [ -n "$input" ] && run_target "$name" "$input" >>"$log" 2>&1; then
            rm "$input"
            outcome=passed
        fi
    fi
    executions=$(awk '/number_of_executed_units/ {print $2}' "$log")
    edges=$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -c6-)
    printf '%s,%s,%s,%s,%s\n' "$name" "${executions:-0}" $((SECONDS - start)) "${edges:-0}" "$outcome" >>build/fuzz/tally.csv
    if [ "$outcome" = passed ]; then
        printf '%-14s %12s executions, %6s edges\n' "$name" "$executions" "$edges"
    else
        printf '%-14s FAILED: %s\n' "$name" "$(grep -m 1 -E 'property does not hold|ERROR:|runtime error' "$log")"
        return 1
    fi
}
export -f fuzz run_target limits share
export each
say "${#targets[@]} targets, $each s or a multiple each, $jobs at a time"
printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I {} bash -c 'fuzz {}' || fail "see build/fuzz/TARGET.log and build/fuzz/failed"
"$envs/tools/bin/python" -m tests.fuzz.tally build/fuzz/tally.csv docs/trust.md
