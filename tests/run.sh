#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh -- the tests of every day: 7 min 45 s on two processors, among them two for the build of
# a fresh clone without a compiler's cache. tests/long.sh has the rest: what is slow, what one room
# alone can break, every guide, the sanitizers.
# Installs what is missing, builds, and ends with one line: "N passed, N failed"; the steps
# stand in .build/logs/junit.xml, too.
cd "$(dirname "$0")/.." || exit 1
sh third_party/install.sh --tests || exit 1
. tests/steps.sh

# guides_and_meeting: the review that the README has made, of one variant, is the one whose
# pages are looked at
guides_and_meeting()
{
    python3 tests/image/guides.py --keep .build/readme --few $program README.md \
        assets/guides/validation.md assets/panels/README.md &&
        python3 tests/page/meeting.py $program .build/readme/glance
}

start 'headers compile alone' headers sh tests/structure/headers.sh
start 'no shell, no socket, no mapped file' calls python3 tests/structure/calls.py
start 'folders include what they may' layers python3 tests/structure/layers.py
start 'the module is the file' modules python3 tests/structure/modules.py
start 'sizes and contents of the sources' source python3 tests/structure/source.py
start 'the layout of the sources' format python3 tests/structure/format.py
start 'every source says its licence' spdx python3 tests/structure/spdx.py
start 'the README names what is there' readme python3 tests/structure/readme.py
start 'a surface model is known by its own files' models python3 tests/structure/models.py
start 'a long step runs when what it needs changes' steps python3 tests/structure/steps.py
start 'figures of pages stand on something' figures python3 tests/image/figures.py
start 'pages and comments point to what is there' pointers python3 tests/structure/pointers.py
gather

run_one 'release build, warnings are errors' build-release build release everyday || finish
program=.build/release/parhelion
start 'scenes, sets and their schemas' schemas python3 tests/structure/schemas.py $program
start 'extensions as the guide says' extensions python3 tests/structure/extensions.py $program
start 'libraries keep no state' globals sh tests/structure/globals.sh .build/release
start 'kernels keep their vectors' kernels python3 tests/structure/kernels.py .build/release
start 'no function that differs by CPU' libm sh tests/structure/libm.sh .build/release
run 'unit tests' unit units .build/release -LE long

# Long ones first: at the end no processor waits.
start 'malformed and foreign models' hostile python3 tests/hostile/run.py $program
start 'a glare review' review python3 tests/image/review.py $program
start 'a hunt for wrong answers' hunt python3 tests/hunt/hunt.py --count 1 --unguided $program
start "a review's pictures are denoised, and nothing else" review-denoised \
    python3 tests/image/review_denoised.py $program
start "a frame's glare beside closed forms" glare python3 tests/image/glare.py $program
start 'intervals of light that is rare' gaze-intervals \
    python3 tests/image/gaze_intervals.py $program
start 'intervals of judged parts' judged-parts \
    python3 tests/image/every_interval.py gradient $program
start 'variants of a review' variants python3 tests/image/variants.py $program
start 'colours of symbols as they are seen' colour python3 tests/image/colour.py $program
start 'a matte finish tried out' finish python3 tests/image/finish.py $program
start 'the README as written, its review met' guides guides_and_meeting
start 'columns of answers' answers python3 tests/image/answers.py $program
start 'the command line' cli python3 tests/hostile/cli.py $program
start 'what was removed says what to do' removed python3 tests/hostile/removed.py $program
start 'what is not known is no pass' unjudged python3 tests/hostile/unjudged.py $program
start 'files are read whole or named' read-whole python3 tests/hostile/read_whole.py $program
start 'one judged quantity a row' judged python3 tests/hostile/judged.py $program
start 'reviews that ask wrongly' review-request python3 tests/hostile/review_request.py $program
start "a review's folder is the user's too" review-files \
    python3 tests/hostile/review_files.py $program
start 'panel commands' panel-commands python3 tests/hostile/panel_commands.py $program
start 'frames held against accepted ones' regression python3 tests/image/regression.py $program
start 'what a verdict rests on' rests python3 tests/image/rests.py $program
start 'same bits, killed and resumed' resume python3 tests/hostile/resume.py --kills 1 $program
start 'same bits, any parts' merge python3 tests/image/merge.py $program
start 'what one pixel sees' explain-pixel python3 tests/image/explain_pixel.py $program
start 'scenes moved and turned' moved python3 tests/image/moved.py $program
start 'faults and their outcomes' faults python3 tests/hostile/faults.py $program
start 'closed forms in frames' image python3 tests/image/run.py $program
start 'frames that were multiplied' multiplied python3 tests/image/multiplied.py $program
start 'lamps by every way' lamps-by-every-way \
    python3 tests/image/lamps_by_every_way.py --few $program
start 'light that no path connects' missed python3 tests/image/missed.py $program
start 'comparisons' compare python3 tests/hostile/compare.py $program
start 'same bits, any threads' bits python3 tests/image/bits.py $program
start 'golden frames' golden python3 tests/image/golden.py $program
start 'another renderer' library-renderer \
    python3 tests/library/other_renderer.py .build/release
start 'a display under sun and sky' reflection-few \
    python3 tests/image/reflection.py assets/panels/ips_cluster.panel $program
start 'displays against their panels' display python3 tests/image/display.py $program
start 'panes, and displays behind them' panes python3 tests/image/panes.py $program
start 'its Python module' library-module python3 tests/library/module.py .build/release
start 'variants and animations' states python3 tests/image/states.py $program
start "glTF's faults by their codes" gltf-codes python3 tests/hostile/gltf_codes.py $program
start "displays' contrast in frames" display-contrast python3 tests/image/contrast.py $program
start 'displays the right way round' marked python3 tests/image/marked.py $program
start 'materials without data' no-data python3 tests/hostile/no_data.py $program
start "the panel library's ABI" library-abi python3 tests/library/abi.py .build/release
gather
run 'figures of pages that tests print' figures-tests \
    python3 tests/image/figures.py --logs $program
finish
