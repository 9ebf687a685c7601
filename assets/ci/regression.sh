#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# regression.sh [reference | today | compare | accept WHY] -- do the frames of this repository
# still show what was accepted? Without a word: reference, today, compare. The page about it:
# `parhelion help regression-in-ci`.
#
# It lies in the folder ci/ at the top of a git repository, beside
#   views      one line a frame: its name, then what `parhelion render` is given, as in a shell
#   limits     if it is there: a line for each frame that has limits, masks or regions of its
#              own: its name, then what `parhelion compare` is given
#   accepted   a line each time that somebody looked and accepted, written by `accept`: the last
#              commit that changed this file is what frames are held against
# and writes into ci/out, which git ignores:
#   reference/COMMIT/, today/                            the frames, NAME.exr; of a view that
#                                                        fails NAME.exr.failed, which says why
#   report.html, compare.txt, compare.json, junit.xml    what `parhelion compare` says of them
#
# PARHELION_OPTIONS    size, samples and the like, of every frame
# PARHELION_LEVEL      share of false alarms that is allowed
# PARHELION_REFERENCE  a folder of frames from elsewhere, instead of reference/COMMIT
#
# Status: 0 the same, 1 different, 3 or more: something could not be done, and a line says what.
# A view that fails ends nothing: all others are rendered and compared first.
set -eu
cd "$(dirname "$0")/.."
options=${PARHELION_OPTIONS:---size 640x360 --spp 256}
level=${PARHELION_LEVEL:-0.001}
out=$PWD/ci/out
tree=$out/accepted
failed=0

fail()
{
    echo "regression.sh: $*" >&2
    exit 3
}

# Where the reference is. A clone without history would take the commit at hand for it.
find_reference()
{
    reference=${PARHELION_REFERENCE:-}
    [ -z "$reference" ] || return 0
    [ "$(git rev-parse --is-shallow-repository)" = false ] ||
        fail "a clone without history, which does not tell what was accepted: fetch all of it"
    commit=$(git log -1 --format=%H -- ci/accepted)
    [ -n "$commit" ] || fail "no commit has ci/accepted: look at the frames that" \
        "\`sh ci/regression.sh today\` makes, then \`... accept WHY\`, and commit it"
    reference=$out/reference/$commit
}

# add_default OPTION VALUE: to the view's words, unless they have the option.
add_default()
{
    case " $words" in *" $1 "* | *" $1="*) ;; *) words="$words $1 $2" ;; esac
}

# render_view TREE NAME WORDS: ci/out/unfinished/NAME.exr. The layers are those that `compare`
# reads. One instruction set on all machines makes the same bits (elsewhere there is one only).
render_view()
{
    words="$3 $options"
    add_default --layers compare
    case $(uname -m) in x86_64 | amd64) add_default --isa avx2 ;; esac
    (cd "$1" && eval "parhelion render $words" --quiet -o '"$out/unfinished/$2.exr"') </dev/null
}

# render_views TREE FOLDER: frames of a tree's views, but those that are there. A frame gets its
# name when it is whole. A last line without its end is a line.
render_views()
{
    seen=' '
    while read -r name words || [ -n "$name" ]; do
        case $name in '' | '#'*) continue ;; esac
        case $seen in *" $name "*) fail "ci/views has $name twice" ;; esac
        seen="$seen$name "
        [ ! -f "$2/$name.exr" ] || continue
        mkdir -p "$(dirname "$2/$name")" "$(dirname "$out/unfinished/$name")"
        rm -f "$2/$name.exr.failed"
        if render_view "$1" "$name" "$words" 2>"$out/unfinished/$name.txt"; then
            mv "$out/unfinished/$name.exr" "$2/$name.exr"
        else
            status=$?
            [ -s "$out/unfinished/$name.txt" ] ||
                echo "ended with status $status" >"$out/unfinished/$name.txt"
            tail -n 1 "$out/unfinished/$name.txt" >"$2/$name.exr.failed"
            failed=1
        fi
        while read -r line; do echo "view $name: $line" >&2; done <"$out/unfinished/$name.txt"
    done <"$1/ci/views"
}

# Frames of the accepted commit, by the program that is here.
render_reference()
{
    find_reference
    [ -z "${PARHELION_REFERENCE:-}" ] || return 0
    rm -rf "$tree"
    git worktree prune
    git worktree add --detach "$tree" "$commit" >/dev/null 2>&1 ||
        fail "commit $commit cannot be checked out"
    mkdir -p "$reference"
    render_views "$tree" "$reference"
    git worktree remove --force "$tree"
}

render_today()
{
    rm -rf "$out/today"
    mkdir -p "$out/today"
    render_views "$PWD" "$out/today"
}

compare_frames()
{
    find_reference
    [ -d "$reference" ] || fail "$reference is not there: \`regression.sh reference\` makes it"
    set -- "$reference" "$out/today" --allow-extra --level "$level" --quiet
    [ ! -f ci/limits ] || set -- "$@" --pairs ci/limits
    status=0
    parhelion compare "$@" --report "$out/report.html" --junit "$out/junit.xml" \
        --answer "$out/compare.json" >"$out/compare.txt" || status=$?
    cat "$out/compare.txt"
    return $status
}

accept()
{
    [ -n "$1" ] ||
        fail "accept: a word on why is required, such as \`accept 'brighter cluster'\`"
    echo "$(date -u +%Y-%m-%dT%H:%MZ) $1" >>ci/accepted
    echo "commit ci/accepted together with what changed the frames"
}

# What a view failed with is on stderr already.
end_rendering()
{
    [ "$failed" = 0 ] || exit 3
}

command -v parhelion >/dev/null || fail "no program parhelion is in PATH"
mkdir -p "$out"
echo '*' >"$out/.gitignore"
case ${1:-all} in
reference) render_reference; end_rendering ;;
today) render_today; end_rendering ;;
compare) compare_frames ;;
accept) accept "${2:-}" ;;
all) render_reference; render_today; compare_frames ;;
*) fail "$1: required: reference, today, compare, accept WHY, or nothing" ;;
esac
