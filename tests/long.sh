#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# long.sh -- what takes too long for run.sh: slow units, every closed form, guide and fault, two
# hundred pairs of frames of other noise, a hundred kills, all units and thousands of broken
# models and panels under the address sanitizer, the thread sanitizer, packages, another Debian,
# the second compiler, five minutes of fuzzing. Stopped, it goes on where it was: a step that
# passed on the same files is not run again.
cd "$(dirname "$0")/.." || exit 1
sh third_party/install.sh --tests || exit 1
. tests/steps.sh
keep_steps

# build_native: the second compiler, every instruction that this machine has
build_native()
{
    cmake --preset clang -B .build/native -DCMAKE_C_FLAGS=-march=native &&
        cmake --build .build/native --target parhelion
}

# run_mutations: 100,000 mutated panel files under the sanitizers
run_mutations()
{
    PARHELION_MUTATIONS=100000
    export PARHELION_MUTATIONS
    run_units '100,000 broken panels' panels-long .build/asan --timeout 10800 -R '^panel_files$'
    unset PARHELION_MUTATIONS
}

# run_beams: every profile of a narrow beam
run_beams()
{
    PARHELION_BEAMS=all
    export PARHELION_BEAMS
    run_units 'every narrow beam' beams-long .build/release -R '^panel_beam$'
    unset PARHELION_BEAMS
}

run_one 'release build' build-release build release all || finish
run_beams
if run_one 'build with address sanitizer' build-asan build asan all; then
    export UBSAN_OPTIONS=print_stacktrace=1
    run_units 'unit tests, address sanitizer' unit-asan .build/asan --timeout 10800
    # The panels keep one processor busy for half an hour: the rest has the other.
    start 'thousands of broken models' hostile-long \
        python3 tests/hostile/run.py --all .build/asan/parhelion
    start 'what grids can see of a panel' panel-coarse-long \
        python3 tests/bench/panel_coarse.py .build/release/parhelion --jobs 1
    start 'a second reader, 100,000 questions' agreement-long \
        python3 tests/library/agreement.py .build/release --queries 100000
    start 'another renderer, less noise' renderer-long \
        python3 tests/library/other_renderer.py .build/release --samples 1024
    start 'a hundred kills' resume-long \
        python3 tests/hostile/resume.py --kills 100 .build/release/parhelion
    start 'parts of every kind' merge-long \
        python3 tests/image/merge.py --all .build/release/parhelion
    start 'every fault' faults-long \
        python3 tests/hostile/faults.py --all .build/release/parhelion
    start 'every key of a review' review-request-long \
        python3 tests/hostile/review_request.py --all .build/release/parhelion
    run_mutations
    gather
    run 'every fault, address sanitizer' faults-asan \
        python3 tests/hostile/faults.py --all .build/asan/parhelion
fi
run 'packages built twice' packages python3 tests/install/packages.py .build/packages
run 'the suite in another Debian' other-debian \
    python3 tests/install/other_debian.py .build/release/parhelion
run 'packages in a bare Debian' bare-root \
    python3 tests/install/bare_root.py .build/packages/first/.build/release/packages
run 'all closed forms in frames' image-long \
    python3 tests/image/run.py --all .build/release/parhelion
run 'a glare review, thirty hours of weather' review-long \
    python3 tests/image/review.py --all .build/release/parhelion
run 'all variants of a review, slopes, mends' variants-long \
    python3 tests/image/variants.py --all .build/release/parhelion
run 'a hunt for wrong answers, 200 rooms' hunt-long \
    python3 tests/hunt/hunt.py --count 200 .build/release/parhelion
run_one 'verdicts whose truth is known' verdicts \
    python3 tests/bench/verdicts.py .build/release --rooms open,window --trials 200
run "another maker's car" other-maker \
    python3 tests/image/other_maker.py .build/release/parhelion
run 'verdicts beside their limits' review-laws \
    python3 tests/image/review_laws.py .build/release/parhelion scenes/glance.review.json \
    dimmed 0.2 0.4 0.005
run 'daylight through a roof, every point' roof-long \
    python3 tests/image/roof.py .build/release/parhelion --all
run_units 'unit tests that take long' unit-long .build/release -L long
start 'laminated panes' glazing python3 tests/image/glazing.py .build/release/parhelion
start 'curved panes' curved python3 tests/image/curved_pane.py .build/release/parhelion
start 'paper and opal' translucent \
    python3 tests/image/translucent.py .build/release/parhelion
start 'prisms' dispersion python3 tests/image/dispersion.py .build/release/parhelion
start 'films on glass' films python3 tests/image/films.py .build/release/parhelion
start 'a head-up display' hud python3 tests/image/hud.py .build/release/parhelion
start 'a luxmeter under every light' luxmeter \
    python3 tests/image/luxmeter.py .build/release/parhelion
gather
start 'a review shared in a job' review-job \
    python3 tests/slurm/review_job.py .build/release/parhelion
start 'every guide as written' guides-long \
    python3 tests/image/guides.py .build/release/parhelion
gather
run 'what is learnt moves no mean' guided-long \
    python3 tests/image/guided.py .build/release/parhelion
run 'false alarms and power of compare' compare-power \
    python3 tests/bench/compare_power.py .build/release/parhelion .build/release/bench_statistic
run 'frames shared by Slurm' slurm python3 tests/slurm/cluster.py .build/release/parhelion
run 'reviews killed, stopped and starved' review-resume-long \
    python3 tests/hostile/review_resume.py --all --kills 40 .build/release/parhelion
run 'what moves in a page' live python3 tests/page/live.py .build/release/parhelion
run 'models of others equipped' equip-models \
    python3 tests/hostile/equip.py .build/release/parhelion
run 'a review that watches its files' review-watch \
    python3 tests/hostile/review_watch.py --all .build/release/parhelion
run 'a model equipped by clicks' equip python3 tests/page/equip.py .build/release/parhelion
if run_one 'build by the second compiler' build-clang build clang all; then
    run_units 'unit tests, second compiler' unit-clang .build/clang
    run 'same bits from both compilers' bits-clang \
        python3 tests/image/bits.py --against .build/release/parhelion .build/clang/parhelion
fi
# A panel file is queried in place: every build must read every other one's.
if run_one 'build for this processor only' build-native build_native; then
    run 'panels of one build in another' panels-native \
        python3 tests/hostile/panel_commands.py --against .build/release/parhelion \
        .build/native/parhelion
fi
if run_one 'build with thread sanitizer' build-tsan \
    build tsan parhelion test_base test_render test_checkpoint; then
    export TSAN_OPTIONS=ignore_noninstrumented_modules=1
    run_units 'unit tests, thread sanitizer' unit-tsan .build/tsan \
        -R '^(base|render|checkpoint)$'
    run 'two threads, thread sanitizer' tsan \
        python3 tests/image/bits.py --small .build/tsan/parhelion
    run 'checkpoint and interrupt, the same' tsan-resume \
        python3 tests/hostile/resume.py --small .build/tsan/parhelion
fi
if run_one 'build for fuzzing' build-fuzz build fuzz fuzz; then
    run 'five minutes of fuzzing' fuzz python3 tests/fuzz/run.py .build/fuzz
fi
finish
