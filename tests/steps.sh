# SPDX-License-Identifier: Apache-2.0
# steps.sh -- what run.sh and long.sh share: steps, each with a line of its own, and the count.
# Sourced from the project's root.
# shellcheck shell=sh
logs=.build/logs
total_passed=0 total_failed=0 total_skipped=0
rm -f .build/logs/junit.* .build/logs/processors.*
unset PYTHONDONTWRITEBYTECODE
export PYTHONPYCACHEPREFIX="$PWD/.build/pycache"
mkdir -p $logs

# The interpreter itself: what stands on the path may be a script that looks for one at every
# start (pyenv's takes half a second).
interpreter=$(python3 -c 'import sys; print(sys.executable)') || exit 1
python3()
{
    "$interpreter" "$@"
}

# ---- counting ----

# counts FILE: "PASSED FAILED SKIPPED" from the lines "N passed, N failed[, N skipped]" and from
# what cmocka says under ctest
counts()
{
    awk '/^[0-9]+ passed, [0-9]+ failed/ { passed += $1; failed += $3; skipped += $5 }
         /\[  PASSED  \]/ { passed += number() }
         /\[  FAILED  \] [0-9]+ test/ { failed += number() }
         /\[  SKIPPED \] [0-9]+ test/ { skipped += number() }
         function number(  rest) { rest = $0; sub(/.*\] /, "", rest); return rest + 0 }
         END { print passed + 0 " " failed + 0 " " skipped + 0 }' "$1"
}

# processor_seconds FILE: of a shell's children, from what `times` wrote
processor_seconds()
{
    awk 'NR == 2 { split($1, own, /[ms]/); split($2, of_system, /[ms]/)
                   print int(60 * (own[1] + of_system[1]) + own[2] + of_system[2]) }' "$1"
}

# junit_case NAME LOG SECONDS FAILED: one case of .build/logs/junit.xml, for what shows runs as
# tables
junit_case()
{
    name_in_xml=$(echo "$1" | sed 's/&/\&amp;/g; s/</\&lt;/g; s/"/\&quot;/g')
    echo "<testcase classname=\"steps\" name=\"$name_in_xml\" time=\"$3\">"
    [ "$4" = 0 ] || echo "<failure message=\"$4 failed: $logs/$2.log\"/>"
    echo '</testcase>'
}

# report NAME LOG STATUS TIME PASSED FAILED SKIPPED: prints the step's line and adds it up.
# A step that fails without having counted a failure counts as one.
report()
{
    failed=$6
    [ "$3" = 0 ] || [ "$failed" != 0 ] || failed=1
    total_passed=$((total_passed + $5))
    total_failed=$((total_failed + failed))
    total_skipped=$((total_skipped + $7))
    line=$(printf '%-38s %5d passed %4d failed' "$1" "$5" "$failed")
    [ "$7" = 0 ] || line="$line $7 skipped"
    echo "$line  ($4)"
    took=${4#kept, }
    junit_case "$1" "$2" "${took%% *}" "$failed" >>$logs/junit.cases
    busy=${took#*, }
    [ "$busy" = "$took" ] || echo "${busy%% *} $1" >>$logs/processors.steps
    [ "$failed" = 0 ] || {
        grep -h '^FAILED\|\[  FAILED  \]\|error:\|ERROR:\|WARNING: Thread' "$logs/$2.log" |
            head -n 12 | sed 's/^/    /'
        echo "    the whole log: $logs/$2.log"
    }
    grep -h '^skipped' "$logs/$2.log" | head -n 5 | sed 's/^/    /' || true
}

# ---- steps that are kept ----

# keep_steps [--list | --changed [COMMIT]]: from here on a step that passed on the very files
# that it depends on is not run again: its line of then is printed instead. For runs of hours.
# --list: nothing is run: says of each step whether it would be. --changed: of the others only
# those are run that a commit after COMMIT (the last one but one) reaches, or what is not
# committed.
keeps='' mode='' sum='' reached=''
keep_steps()
{
    keeps=1
    case ${1:-} in
    '') ;;
    --list | --changed) mode=${1#--} ;;
    *) echo "steps: $1: required: --list or --changed [COMMIT]" >&2; exit 2 ;;
    esac
    find CMakeLists.txt CMakePresets.json src shaders scenes assets tests third_party \
        README.md CONTRIBUTING.md -type f ! -name '*.pyc' -print0 | LC_ALL=C sort -z |
        xargs -0 sha256sum | awk '{ print $2, $1 }' >$logs/files.sums
    [ "$mode" = changed ] || return 0
    { git diff --name-only "${2:-HEAD~1}" && git ls-files --others --exclude-standard; } \
        >$logs/files.changed || exit 1
}

# of FOLDER-OR-FILE...: what the steps from here on depend on
of()
{
    sum=$(among "$*" <$logs/files.sums | sha256sum | cut -d ' ' -f 1)
    [ "$mode" != changed ] || reached=$(among "$*" <$logs/files.changed | head -n 1)
}

# among "FOLDER...": of lines that begin with a file's name, those of these folders and files;
# FOLDER/ is without the folders in it
among()
{
    awk -v folders="$1" 'BEGIN { count = split(folders, folder, " ") }
        function is_in(file, folder) {
            if (folder !~ /\/$/) return file == folder || index(file, folder "/") == 1
            return index(file, folder) == 1 && substr(file, length(folder) + 1) !~ /\// }
        { for (i = 1; i <= count; i++) if (is_in($1, folder[i])) { print; break } }'
}

# is_done NAME LOG: says what there is to say of a step that is not to be run; false: it is
is_done()
{
    [ -n "$keeps" ] || return 1
    of='' seconds='' passed='' skipped=''
    [ ! -f "$logs/$2.kept" ] || read -r of seconds passed skipped <"$logs/$2.kept"
    if [ "$mode" = list ]; then
        state=stale
        [ "$of" != "$sum" ] || state=fresh
        [ -n "$of" ] || state='never run'
        printf '%-38s %s%s\n' "$1" "$state" "${seconds:+, $seconds s}"
    elif [ "$of" = "$sum" ]; then
        report "$1" "$2" 0 "kept, $seconds s" "$passed" 0 "$skipped"
    elif [ "$mode" = changed ] && [ -z "$reached" ]; then
        printf '%-38s not reached\n' "$1"
    else
        return 1
    fi
}

# needs 'PRESET TARGET...'...: what the steps from here on need built: before the first of them
# that is run
needed='' built=' '
needs()
{
    needed=
    for each in "$@"; do needed="$needed$each;"; done
}

build_needed()
{
    rest=$needed
    while [ -n "$rest" ]; do
        each=${rest%%;*} rest=${rest#*;}
        case $built in
        *" $each; "*) continue ;;
        esac
        # shellcheck disable=SC2086
        run_one "build: $each" "build-${each%% *}" build $each || return 1
        built="$built$each; "
    done
}

# ---- running them ----

# measured LOG COMMAND...: runs it with its output in the log; LOG.end gets its status, seconds
# and processors' seconds
measured()
{
    end=$logs/$1
    rm -f "$end.end"
    shift
    ( begun=$(date +%s)
      "$@" >"$end.log" 2>&1
      status=$?
      times >"$end.times"
      echo "$status $(($(date +%s) - begun)) $(processor_seconds "$end.times")" >"$end.tmp"
      mv "$end.tmp" "$end.end" )
}

# finished NAME LOG: reports a step that was measured, and keeps it
finished()
{
    read -r status seconds busy <"$logs/$2.end"
    # shellcheck disable=SC2046
    set -- "$1" "$2" $(counts "$logs/$2.log")
    report "$1" "$2" "$status" "$seconds s, $busy s of processors" "$3" "$4" "$5"
    [ -n "$keeps" ] && [ "$status" = 0 ] && [ "$4" = 0 ] &&
        echo "$(cat "$logs/$2.of") $seconds $3 $5" >"$logs/$2.kept"
    [ "$status" = 0 ]
}

# run NAME LOG COMMAND...: a step that counts its own claims
run()
{
    is_done "$1" "$2" && return
    build_needed || return
    name=$1 log=$2
    shift 2
    echo "$sum" >"$logs/$log.of"
    measured "$log" "$@"
    finished "$name" "$log"
}

# start NAME LOG COMMAND...: as run, but beside others, one more than there are processors;
# gather waits for them.
started='' beside_most=$(($(nproc) + 1))
start()
{
    is_done "$1" "$2" && return
    build_needed || return
    name=$1 log=$2
    shift 2
    wait_for_others $((beside_most - 1))
    echo "$sum" >"$logs/$log.of"
    printf '%s' "$name" >"$logs/$log.name"
    rm -f "$logs/$log.end"
    measured "$log" "$@" &
    echo $! >"$logs/$log.pid"
    started="$started $log"
}

# wait_for_others COUNT: until no more than so many run; reports those that ended. Who was
# killed before it could say so has failed.
wait_for_others()
{
    while :; do
        running=
        jobs >$logs/jobs # the shell takes note of those that ended
        for log_of in $started; do
            kill -0 "$(cat "$logs/$log_of.pid")" 2>/dev/null || [ -f "$logs/$log_of.end" ] ||
                echo '137 0 0' >"$logs/$log_of.end"
            if [ -f "$logs/$log_of.end" ]; then finished "$(cat "$logs/$log_of.name")" "$log_of"
            else running="$running $log_of"; fi
        done
        started=$running
        # shellcheck disable=SC2086
        set -- "$1" $running
        [ $(($# - 1)) -gt "$1" ] || return 0
        sleep 0.2
    done
}

gather()
{
    wait_for_others 0
}

# run_one NAME LOG COMMAND...: a step that is one claim, and is never kept
run_one()
{
    name=$1 log=$2
    shift 2
    [ "$mode" != list ] || return 0
    measured "$log" "$@"
    read -r status seconds busy <"$logs/$log.end"
    report "$name" "$log" "$status" "$seconds s, $busy s of processors" \
        $((status == 0)) $((status != 0)) 0
    [ "$status" = 0 ]
}

# claim COMMAND...: one that counts nothing
claim()
{
    "$@" && echo '1 passed, 0 failed'
}

# units BUILD_DIR [CTEST ARGUMENT...]: cmocka's cases
units()
{
    folder=$1
    shift
    ctest --test-dir "$folder" -j "$(nproc)" -V --timeout 300 --no-tests=error "$@"
}

# build PRESET TARGET...: a warning is an error
build()
{
    preset=$1
    shift
    cmake --preset "$preset" -DPARHELION_WERROR=ON &&
        cmake --build ".build/$preset" --target "$@"
}

# table_of_processors: of each step that was run, the longest first, to processors.txt; prints
# the longest five and the sum
table_of_processors()
{
    sort -rn $logs/processors.steps >$logs/processors.txt
    awk 'NR <= 5 { longest = longest (NR > 1 ? ", " : "") $0 } { sum += $1 }
         END { print sum " s of processors: " longest " ... ('$logs'/processors.txt)" }' \
        $logs/processors.txt
}

finish()
{
    [ "$mode" != list ] || exit 0
    { echo '<testsuite name="steps">' && cat $logs/junit.cases && echo '</testsuite>'; } \
        >$logs/junit.xml
    [ ! -f $logs/processors.steps ] || table_of_processors
    [ $total_skipped = 0 ] || echo "$total_skipped skipped: see the lines above"
    echo "$total_passed passed, $total_failed failed"
    [ $total_failed = 0 ] || exit 1
}
