#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# headers.sh -- every header compiles alone as C17; those of the wrappers as C++17 as well.
cd "$(dirname "$0")/../.." || exit 1
passed=0 failed=0
embree=3
[ -e /usr/include/embree4 ] && embree=4
flags="-fsyntax-only -Wall -Wextra -Wpedantic -Wno-psabi -Werror -D_GNU_SOURCE
    -DEMBREE_MAJOR=$embree -Isrc -I. -Ithird_party
    $(pkg-config --cflags jansson cairo libxml-2.0)"

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

for header in $(find src shaders third_party -name '*.h' | sort); do
    alone c c17 "$header"
    case $header in third_party/*) alone c++ c++17 "$header" ;; esac
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
