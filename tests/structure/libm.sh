#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# libm.sh BUILD_DIR -- what reaches a pixel calls no function of the C library whose bits depend
# on its version or on the CPU: base/mathd.h and base/mathf.h have their own.
cd "$(dirname "$0")/../.." || exit 1
build=${1:-.build/release}
passed=0 failed=0
names='exp|exp2|expm1|log|log2|log10|log1p|pow|sin|cos|tan|sincos|asin|acos|atan|atan2|sinh'
names="$names|cosh|tanh|cbrt|erf|erfc|hypot|tgamma|lgamma"

for name in base text spectrum hemisphere hemisphere_tree \
    sky image panel_query panel_set panel_fit_common \
    panel_fit_emission panel_fit_reflection panel_fit import_set vision review \
    review_request review_symbol import_text import_scatter import_luminaire import scene bvh \
    light camera path film kernel render shaders_facets shaders; do
    library=$build/lib$name.a
    [ -e "$library" ] || { echo "FAILED no $library"; failed=$((failed + 1)); continue; }
    # The pictures that people look at are developed elsewhere: exposure and false colours.
    bad=$(nm -A --undefined-only "$library" 2>/dev/null |
        grep -v 'exposure\.c\|false_colour\.c' |
        grep -E " U ($names)f?\$" | sed 's/.*a:\([^:]*\):.* U /\1: /')
    if [ -n "$bad" ]; then
        echo "FAILED $library:" $bad
        failed=$((failed + 1))
    else
        passed=$((passed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]
