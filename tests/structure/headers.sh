#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# headers.sh -- every header compiles alone as C17; those of the wrappers as C++17 as well. One
# that a source includes before all else, and that says "#pragma once", the build compiles so.
cd "$(dirname "$0")/../.." || exit 1
passed=0 failed=0
embree=3
[ -e /usr/include/embree4 ] && embree=4
flags="-fsyntax-only -Wall -Wextra -Wpedantic -Wno-psabi -Werror -D_GNU_SOURCE
    -DEMBREE_MAJOR=$embree -Isrc -I. -Ithird_party
    $(pkg-config --cflags jansson cairo)"

# alone LANGUAGE STANDARD HEADER: included twice, because a second time must do no harm
alone()
{
    # shellcheck disable=SC2086
    # the last line: a header of macros alone declares nothing, which C does not allow a file
    if printf '#include "%s"\n#include "%s"\nextern int any;\n' "$3" "$3" |
        ${CC:-cc} -x "$1" -std="$2" $flags -
    then
        passed=$((passed + 1))
    else
        echo "FAILED $3 does not compile alone as $2"
        failed=$((failed + 1))
    fi
}

# first_included: by the sources, as paths from the root; NAME of -Isrc stands below src
first_included()
{
    # shellcheck disable=SC2046
    awk 'FNR == 1 { is_first = 1 }
         is_first && /^#/ { is_first = 0; if (split($0, part, "\"") == 3) print part[2] }' \
        $(find src shaders -name '*.c') | sed 's,^,src/, ; s,^src/\(shaders/\),\1,'
}

built=" $(first_included | xargs grep -l '^#pragma once' 2>/dev/null | tr '\n' ' ')"
for header in $(find src shaders third_party -name '*.h' | sort); do
    case $built in
    *" $header "*) passed=$((passed + 1)); continue ;;
    esac
    alone c c17 "$header"
    case $header in third_party/*) alone c++ c++17 "$header" ;; esac
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
