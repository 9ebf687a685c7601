#!/bin/sh
# long.sh -- what takes too long for run.sh: every closed form, every model rendered under the
# address sanitizer, and the second compiler. About an hour on two cores.
cd "$(dirname "$0")/.." || exit 1
sh third_party/install.sh --tests || exit 1
. tests/steps.sh

if run_one 'build by the second compiler' build-clang build clang all; then
    run_units 'unit tests, second compiler' unit-clang .build/clang
    run 'same bits, second compiler' bits-clang \
        python3 tests/image/bits.py .build/clang/parhelion
fi
if run_one 'release build' build-release build release all; then
    run 'all closed forms in frames' image-long \
        python3 tests/image/run.py --all .build/release/parhelion
fi
if run_one 'build with address sanitizer' build-asan build asan all; then
    export UBSAN_OPTIONS=print_stacktrace=1
    run 'every model rendered' hostile-long \
        python3 tests/hostile/run.py --all .build/asan/parhelion
fi
finish
