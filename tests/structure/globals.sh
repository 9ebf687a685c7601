#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# globals.sh BUILD_DIR -- the libraries keep no state of their own: no variable of the product
# can be written to, except those listed in exceptions.txt.
cd "$(dirname "$0")/../.." || exit 1
build=${1:-.build/release}
passed=0 failed=0

# Every symbol in a section that the program may write to; DW.ref.* are the compiler's own
# references for exceptions, the other three what it puts into every module.
writable()
{
    objdump -t "$1" 2>/dev/null | awk '
        $0 ~ / O / || $0 ~ /\*COM\*/ {
            for (i = 1; i <= NF; i++)
                if ($i ~ /^(\.data|\.bss|\.tdata|\.tbss|\*COM\*)/ && $i !~ /^\.data\.rel\.ro/ &&
                    $NF !~ /^(DW\.ref\.|completed\.|__dso_handle$|__TMC_END__$)/)
                    print $NF
        }'
}

for library in "$build"/lib*.a "$build"/*.so; do
    [ -e "$library" ] || { echo "FAILED no libraries in $build"; failed=1; break; }
    bad=
    for name in $(writable "$library"); do
        grep -q "^global  *$name " tests/structure/exceptions.txt || bad="$bad $name"
    done
    if [ -n "$bad" ]; then
        echo "FAILED $(basename "$library") can write to:$bad"
        failed=$((failed + 1))
    else
        passed=$((passed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
