#!/bin/sh
# long.sh -- what takes too long for run.sh: every closed form, thousands of broken models under
# the address sanitizer, and the second compiler.
cd "$(dirname "$0")/.." || exit 1
sh third_party/install.sh --tests || exit 1
. tests/steps.sh

run_one 'release build' build-release build release all || finish
run 'all closed forms in frames' image-long \
    python3 tests/image/run.py --all .build/release/parhelion
if run_one 'build by the second compiler' build-clang build clang all; then
    run_units 'unit tests, second compiler' unit-clang .build/clang
    run 'same bits from both compilers' bits-clang \
        python3 tests/image/bits.py --against .build/release/parhelion .build/clang/parhelion
fi
if run_one 'build with address sanitizer' build-asan build asan all; then
    export UBSAN_OPTIONS=print_stacktrace=1
    run 'thousands of broken models' hostile-long \
        python3 tests/hostile/run.py --all .build/asan/parhelion
fi
finish
