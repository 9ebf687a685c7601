#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh -- the tests of every day, in fifteen minutes on two processors; tests/long.sh has the
# rest: what is slow, every guide, most of the sanitizers.
# Installs what is missing, builds, and ends with one line: "N passed, N failed".
cd "$(dirname "$0")/.." || exit 1
sh third_party/install.sh --tests || exit 1
. tests/steps.sh

start 'headers compile alone' headers sh tests/structure/headers.sh
start 'no shell, one socket, no mapped file' calls python3 tests/structure/calls.py
run 'folders include what they may' layers python3 tests/structure/layers.py
run 'the module is the file' modules python3 tests/structure/modules.py
run 'sizes and contents of the sources' source python3 tests/structure/source.py
run 'every source says its licence' spdx python3 tests/structure/spdx.py
run 'the README names what is there' readme python3 tests/structure/readme.py
run 'a surface model is known by its own files' models python3 tests/structure/models.py
run 'pages and comments point to what is there' pointers python3 tests/structure/pointers.py
gather
run 'a schedule, simulated' schedule python3 tests/slurm/schedule_laws.py

if run_one 'release build, warnings are errors' build-release build release all; then
    run 'scenes, sets and their schemas' schemas \
        python3 tests/structure/schemas.py .build/release/parhelion
    run 'extensions as the guide says' extensions \
        python3 tests/structure/extensions.py .build/release/parhelion
    run 'libraries keep no state' globals sh tests/structure/globals.sh .build/release
    run 'kernels keep their vectors' kernels python3 tests/structure/kernels.py .build/release
    run 'no function that differs by CPU' libm sh tests/structure/libm.sh .build/release
    run_units 'unit tests' unit .build/release -LE long
    start 'the command line' cli python3 tests/hostile/cli.py .build/release/parhelion
    start 'comparisons' compare python3 tests/hostile/compare.py .build/release/parhelion
    start 'faults and their outcomes' faults \
        python3 tests/hostile/faults.py .build/release/parhelion
    start "glTF's faults by their codes" gltf-codes \
        python3 tests/hostile/gltf_codes.py .build/release/parhelion
    start 'reviews that ask wrongly' review-request \
        python3 tests/hostile/review_request.py .build/release/parhelion
    start 'panel commands' panel-commands \
        python3 tests/hostile/panel_commands.py .build/release/parhelion
    start 'panels of coarse grids' panel-coarse \
        python3 tests/bench/panel_coarse.py .build/release/parhelion --cases few
    start "the panel library's ABI" library-abi \
        python3 tests/library/abi.py .build/release
    start 'its Python module' library-module python3 tests/library/module.py .build/release
    start 'a second reader of panels' library-agreement \
        python3 tests/library/agreement.py .build/release
    start 'another renderer' library-renderer \
        python3 tests/library/other_renderer.py .build/release
    gather
    start 'same bits, any parts' merge python3 tests/image/merge.py .build/release/parhelion
    start 'a frame shared in a job' job python3 tests/slurm/job.py .build/release/parhelion
    start 'groups of lights' lights python3 tests/image/lights.py .build/release/parhelion
    start 'same bits, killed and resumed' resume \
        python3 tests/hostile/resume.py .build/release/parhelion
    start 'a render that is watched' live-view \
        python3 tests/hostile/live_view.py .build/release/parhelion
    start 'same bytes, any names' names python3 tests/image/names.py .build/release/parhelion
    start 'variants and animations' states \
        python3 tests/image/states.py .build/release/parhelion
    gather
    start 'closed forms in frames' image python3 tests/image/run.py .build/release/parhelion
    start 'displays against their panels' display \
        python3 tests/image/display.py .build/release/parhelion
    start 'displays the right way round' marked \
        python3 tests/image/marked.py .build/release/parhelion
    gather
    start 'displays under sun and sky' reflection \
        python3 tests/image/reflection.py .build/release/parhelion
    start 'legibility in frames' legibility \
        python3 tests/image/legibility.py .build/release/parhelion
    start 'sub-pixels' subpixels python3 tests/image/subpixels.py .build/release/parhelion
    start 'polarised light' polarised \
        python3 tests/image/polarised.py .build/release/parhelion
    gather
    start 'a hunt for wrong answers' hunt \
        python3 tests/hunt/hunt.py --count 10 .build/release/parhelion
    start 'materials without data' no-data \
        python3 tests/hostile/no_data.py .build/release/parhelion
    start 'a glare review' review python3 tests/image/review.py .build/release/parhelion
    start 'variants of a review' variants \
        python3 tests/image/variants.py .build/release/parhelion
    start 'pages for a meeting' meeting \
        python3 tests/page/meeting.py .build/release/parhelion
    start 'installed, moved, read, completed' install \
        python3 tests/install/install.py .build/release
    start 'frames held against accepted ones' regression \
        python3 tests/image/regression.py .build/release/parhelion
    start 'the README as written' guides python3 tests/image/guides.py \
        .build/release/parhelion README.md assets/guides/rendering.md
    start 'why a display looks so' explain python3 tests/image/explain.py \
        .build/release/parhelion
    start 'the Blender add-on' blender python3 tests/blender/run.py .build/release/parhelion
    start 'people in the seats' occupants \
        python3 tests/image/occupants.py .build/release/parhelion
    start 'what one pixel sees' probe python3 tests/image/probe.py .build/release/parhelion
    start 'luminaires as lamps' lamps python3 tests/image/lamps.py .build/release/parhelion
    start 'pictures as light' hdri python3 tests/image/hdri.py .build/release/parhelion
    gather
    start 'same bits, any threads' bits python3 tests/image/bits.py .build/release/parhelion
    start 'golden frames' golden python3 tests/image/golden.py .build/release/parhelion
    gather
fi
if run_one 'build with address sanitizer' build-asan build asan parhelion; then
    export UBSAN_OPTIONS=print_stacktrace=1
    run 'malformed and foreign models' hostile \
        python3 tests/hostile/run.py .build/asan/parhelion
fi
finish
