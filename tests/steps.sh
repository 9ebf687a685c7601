# SPDX-License-Identifier: Apache-2.0
# steps.sh -- what run.sh and long.sh share: steps, each with a line of its own, and the count.
# Sourced from the project's root.
# shellcheck shell=sh
logs=.build/logs
total_passed=0 total_failed=0 total_skipped=0
export PYTHONDONTWRITEBYTECODE=1
mkdir -p $logs

# counts FILE: "PASSED FAILED SKIPPED" from the last line "N passed, N failed[, N skipped]"
counts()
{
    awk '/^[0-9]+ passed, [0-9]+ failed/ { line = $1 " " $3 " " $5 } END { print line }' "$1"
}

# unit_counts FILE: the same from the output of cmocka under ctest
unit_counts()
{
    awk '/\[  PASSED  \]/ { passed += number() }
         /\[  FAILED  \] [0-9]+ test/ { failed += number() }
         /\[  SKIPPED \] [0-9]+ test/ { skipped += number() }
         function number(  line) { line = $0; sub(/.*\] /, "", line); return line + 0 }
         END { print passed + 0, failed + 0, skipped + 0 }' "$1"
}

# report NAME STATUS SECONDS PASSED FAILED SKIPPED: prints the step's line and adds it up.
# A step that fails without having counted a failure counts as one.
report()
{
    failed=$5
    [ "$2" = 0 ] || [ "$failed" != 0 ] || failed=1
    total_passed=$((total_passed + $4))
    total_failed=$((total_failed + failed))
    total_skipped=$((total_skipped + ${6:-0}))
    line=$(printf '%-34s %5d passed %4d failed' "$1" "$4" "$failed")
    [ "${6:-0}" = 0 ] || line="$line $6 skipped"
    echo "$line  ($3 s)"
    [ "$failed" = 0 ] || { grep -h '^FAILED\|\[  FAILED  \]\|error:\|ERROR:\|WARNING: Thread' \
        "$log" | head -n 12 | sed 's/^/    /'; echo "    the whole log: $log"; }
    grep -h '^skipped' "$log" | head -n 5 | sed 's/^/    /' || true
}

# keep_steps: from here on a step that passed on these very files is not run again: its line of
# then is printed instead. For runs of hours; what a step was run on is told by the sum of all
# files, so that a change of one byte runs every step again.
sum=
keep_steps()
{
    sum=$(find CMakeLists.txt CMakePresets.json src shaders scenes assets tests third_party \
        README.md CONTRIBUTING.md -type f ! -name '*.pyc' -print0 | LC_ALL=C sort -z |
        xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1)
}

# was_kept NAME: reports the step whose log is $log as it passed before; false if it did not
was_kept()
{
    [ -n "$sum" ] && [ -f "$log.kept" ] || return 1
    read -r of seconds passed skipped <"$log.kept"
    [ "$of" = "$sum" ] || return 1
    report "$1" 0 "kept, $seconds" "$passed" 0 "$skipped"
}

# keep_step STATUS SECONDS PASSED FAILED SKIPPED: of the step whose log is $log
keep_step()
{
    [ -n "$sum" ] && [ "$1" = 0 ] && [ "$4" = 0 ] || return 0
    echo "$sum $2 $3 $5" >"$log.kept"
}

# run NAME LOG COMMAND...: a step that counts its own claims
run()
{
    name=$1 log=$logs/$2.log start=$(date +%s)
    shift 2
    was_kept "$name" && return
    "$@" >"$log" 2>&1
    status=$?
    # shellcheck disable=SC2046
    set -- $status $(($(date +%s) - start)) $(counts "$log")
    report "$name" "$1" "$2" "${3:-0}" "${4:-0}" "${5:-0}"
    keep_step "$1" "$2" "${3:-0}" "${4:-0}" "${5:-0}"
    return $status
}

# start NAME LOG COMMAND...: as run, but beside others; gather waits for them and reports.
# For steps that mostly wait for one small program after the other.
started=
start()
{
    name=$1 beside=$2 log=$logs/$2.log
    shift 2
    was_kept "$name" && return
    printf '%s' "$name" >"$logs/$beside.name"
    ( begun=$(date +%s)
      "$@" >"$logs/$beside.log" 2>&1
      echo "$? $(($(date +%s) - begun))" >"$logs/$beside.end" ) &
    started="$started $beside"
}

gather()
{
    wait
    for beside in $started; do
        log=$logs/$beside.log
        read -r status seconds <"$logs/$beside.end"
        # shellcheck disable=SC2046
        set -- "$status" "$seconds" $(counts "$log")
        report "$(cat "$logs/$beside.name")" "$1" "$2" "${3:-0}" "${4:-0}" "${5:-0}"
        keep_step "$1" "$2" "${3:-0}" "${4:-0}" "${5:-0}"
    done
    started=
}

# run_one NAME LOG COMMAND...: a step that is one claim
run_one()
{
    name=$1 log=$logs/$2.log start=$(date +%s)
    shift 2
    if "$@" >"$log" 2>&1; then
        report "$name" 0 $(($(date +%s) - start)) 1 0
    else
        report "$name" 1 $(($(date +%s) - start)) 0 1
        return 1
    fi
}

# run_units NAME LOG BUILD_DIR [CTEST ARGUMENT...]: cmocka's cases
run_units()
{
    name=$1 log=$logs/$2.log start=$(date +%s) folder=$3
    shift 3
    was_kept "$name" && return
    ctest --test-dir "$folder" -j "$(nproc)" -V --timeout 300 --no-tests=error "$@" \
        >"$log" 2>&1
    status=$?
    # shellcheck disable=SC2046
    set -- $status $(($(date +%s) - start)) $(unit_counts "$log")
    report "$name" "$@"
    keep_step "$@"
    return $status
}

# build PRESET TARGET...: a warning is an error
build()
{
    preset=$1
    shift
    cmake --preset "$preset" -DPARHELION_WERROR=ON &&
        cmake --build ".build/$preset" --target "$@"
}

finish()
{
    [ $total_skipped = 0 ] || echo "$total_skipped skipped: see the lines above"
    echo "$total_passed passed, $total_failed failed"
    [ $total_failed = 0 ] || exit 1
}
