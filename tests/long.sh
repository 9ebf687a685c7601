#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# long.sh [--list | --changed [COMMIT]] -- what takes too long for run.sh: slow units, what one
# room alone can break (lamps, pictures as light, outputs, settings, --for, installing),
# every closed form, guide and fault, two hundred pairs of frames of other noise, a hundred
# kills, all units and thousands of broken models and panels under the address sanitizer, the
# thread sanitizer, packages, another Debian, the second compiler, five minutes of fuzzing.
# A step that passed is not run again until a file that it depends on changes: stopped, it goes
# on where it was. --list says which steps would be run; --changed runs of them those alone that
# a commit after COMMIT reaches (the last one, if none is named), or what is not committed.
cd "$(dirname "$0")/.." || exit 1
. tests/steps.sh
keep_steps "$@"
[ "$mode" = list ] || sh third_party/install.sh --tests || exit 1

# ---- what depends on what: with a folder all that it includes (tests/structure/steps.py) ----
build='CMakeLists.txt CMakePresets.json third_party tests/steps.sh tests/structure/report.py'
base="$build src/print src/base src/spectrum"
panels="$base src/text src/record src/hemisphere src/image src/panel src/library assets/panels"
light="$panels src/import src/sky src/scene src/bvh src/light src/mirror src/keep src/guide
    src/camera src/sunlit src/surface src/path src/film src/kernel src/estimate src/render shaders"
options="$light src/table src/missed src/denoise src/vision src/cli/ src/cli/options"
render="$options assets src/cli/render"
tables="$render src/page src/plot src/cli/panel"
review="$render src/probe src/review src/page src/plot src/cli/review src/equip src/cli/explain"
compare="$render src/measure src/page src/compare"
all="$build src shaders assets"

program=.build/release/parhelion

# ---- functions that a step runs ----

# build_native: the second compiler, every instruction that this machine has
build_native()
{
    cmake --preset clang -B .build/native -DCMAKE_C_FLAGS=-march=native &&
        cmake --build .build/native --target parhelion
}

# native_panels: a panel file is queried in place: every build must read every other one's
native_panels()
{
    build_native && python3 tests/hostile/panel_commands.py --against $program \
        .build/native/parhelion
}

# mutations SEED: of 100,000 mutated panel files a third, under the sanitizers
mutations()
{
    PARHELION_MUTATIONS=33334 PARHELION_MUTATIONS_SEED=$1
    export PARHELION_MUTATIONS PARHELION_MUTATIONS_SEED
    units .build/asan --timeout 10800 -R '^panel_files$'
}

# laws: everywhere that they are claimed, where tests/run.sh asks at fewer places or samples
laws()
{
    PARHELION_LAWS=all
    export PARHELION_LAWS
    units .build/release -R '^(shaders(_glass)?|brushed|engine|hour_sky|lamp_mirror'\
'|light(_levels)?|night|noise_stop|panel_(directions|scatter)|path|plates|polarised|ray_ends'\
'|sheets|sun_beam)$'
}

# guides_and_meeting: the pages of the README's review are looked at
guides_and_meeting()
{
    python3 tests/image/guides.py --keep .build/readme-long $program &&
        python3 tests/page/meeting.py $program .build/readme-long/glance
}

export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=ignore_noninstrumented_modules=1

# ---- as it is built for users ----
needs 'release all'
of "$panels tests/unit"
of "$review tests/unit"
run 'laws everywhere that they are claimed' laws-long laws
of "$tables tests/bench"
for share in 1 2 3; do
    start "what grids can see of a panel, $share of 3" panel-coarse-$share \
        python3 tests/bench/panel_coarse.py $program --share $share/3 --jobs 1
done
of "$panels tests/library"
start 'a second reader, 100,000 questions' agreement-long \
    python3 tests/library/agreement.py .build/release --queries 100000
start 'a second reader of panels' library-agreement \
    python3 tests/library/agreement.py .build/release
start 'the library where memory is short' library-memory \
    python3 tests/library/short_memory.py .build/release
start 'another renderer, less noise' renderer-long \
    python3 tests/library/other_renderer.py .build/release --samples 1024
of "$light tests/structure tests/unit CONTRIBUTING.md"
start 'a surface model more, in six files' exercise-long python3 tests/structure/exercise.py
of "$all tests/unit tests/structure"
start 'planted faults are found by the units' planted-long python3 tests/structure/planted.py
of "$render scenes tests/image tests/hostile"
start 'a hundred kills' resume-long python3 tests/hostile/resume.py --kills 100 $program
start 'parts of every kind' merge-long python3 tests/image/merge.py --all $program
of "$all scenes tests/hostile tests/image"
start 'a figure of a panel is one string everywhere' panel-strings \
    python3 tests/hostile/panel_commands.py --all $program
start 'every fault' faults-long python3 tests/hostile/faults.py --all $program
start 'every neighbour of what is read whole' read-whole-long \
    python3 tests/hostile/read_whole.py --all $program
of "$review scenes tests/hostile tests/image"
start 'every key of a review' review-request-long \
    python3 tests/hostile/review_request.py --all $program
start 'one judged quantity a row, every profile' judged-long \
    python3 tests/hostile/judged.py $program --all
start "a sweep through a roof blind's slit" slit-sweep \
    python3 tests/image/slit_sweep.py $program
of "$all scenes tests/hostile tests/image"
start 'names give a terminal no commands' printed python3 tests/hostile/printed.py $program
start 'an output never replaces an input' outputs python3 tests/hostile/outputs.py $program
start 'what is measured twice is held against itself' twice \
    python3 tests/hostile/twice.py --all $program
start 'settings that cannot be meant' settings python3 tests/hostile/settings.py $program
start 'every option given twice' options-long \
    python3 tests/hostile/options.py --all $program
start 'a render that is watched' live-view python3 tests/hostile/live_view.py $program
of "$all scenes tests/blender tests/image"
start 'the Blender add-on' blender python3 tests/blender/run.py $program
of "$all scenes README.md CONTRIBUTING.md tests"
start 'installed, moved, read, completed' install \
    python3 tests/install/install.py .build/release
of "$all scenes tests/image"
start 'same bytes, four names' names-long python3 tests/image/names.py --all $program
start 'a tighter bound is never worse' bounds python3 tests/image/panel_bounds.py $program
start 'sizes of real files' real-sizes python3 tests/image/real_sizes.py $program
start 'panels of foreign layouts' layouts \
    python3 tests/image/foreign_layouts.py $program
start 'one light in every command' one-light python3 tests/image/one_light.py $program
start 'a scene far off is the same' far python3 tests/image/far.py $program
start 'displays under sun and sky' reflection python3 tests/image/reflection.py $program
start 'displays against their panels, all over' display-long \
    python3 tests/image/display.py --all $program
start 'half the space and its glare' fisheye python3 tests/image/fisheye.py $program
start 'light that few paths find' rare python3 tests/image/rare.py $program
of "$review scenes tests/image"
start 'why a display looks so' explain python3 tests/image/explain.py $program
start 'the brightness that passes' remedies python3 tests/image/remedies.py $program
start 'the road after dark' road python3 tests/image/road.py $program
start 'what glass lets be read' private python3 tests/image/private.py $program
start 'through sunglasses' sunglasses python3 tests/image/sunglasses.py $program
start 'visible to whom' visibility-levels \
    python3 tests/image/visibility_levels.py $program
of "$compare scenes tests/image"
start 'samples for an area' favour python3 tests/image/favour.py $program
start 'people in the seats' occupants python3 tests/image/occupants.py $program
start 'pictures as light' hdri python3 tests/image/hdri.py $program
start 'luminaires as lamps' lamps python3 tests/image/lamps.py $program
start 'groups of lights' lights python3 tests/image/lights.py $program
start 'polarised light' polarised python3 tests/image/polarised.py $program
start 'displays by their part of a pixel' display-area \
    python3 tests/image/display_area.py $program
gather
of "$tables tests/image"
run 'a bare display' show python3 tests/image/show.py $program
of "$render scenes tests/image"
run 'all closed forms in frames' image-long python3 tests/image/run.py --all $program
run 'daylight through a roof, every point' roof-long python3 tests/image/roof.py $program --all
start 'laminated panes' glazing python3 tests/image/glazing.py $program
start 'curved panes' curved python3 tests/image/curved_pane.py $program
start 'paper and opal' translucent python3 tests/image/translucent.py $program
start 'prisms' dispersion python3 tests/image/dispersion.py $program
start 'films on glass' films python3 tests/image/films.py $program
start 'a head-up display' hud python3 tests/image/hud.py $program
start 'a luxmeter under every light' luxmeter python3 tests/image/luxmeter.py $program
gather
run 'any place, any turn, any order' moved-long python3 tests/image/moved.py --all $program
run 'what is learnt moves no mean' guided-long python3 tests/image/guided.py $program
run 'samples where noise is move no mean' unbiased-long \
    python3 tests/image/unbiased.py $program
run 'the number of samples moves no mean' noise-stop-long \
    python3 tests/bench/noise_stop.py $program --seeds 60 --scene satin --goal 0.1 0.05 \
    --truth 16384 --check
start 'golden frames, all guided' golden-long python3 tests/image/golden.py --all $program
start 'same bits, any threads, always guided' bits-long \
    python3 tests/image/bits.py --all $program
gather
of "$review src/measure src/compare scenes tests/image tests/hunt"
run 'a hunt for wrong answers, 200 rooms' hunt-long \
    python3 tests/hunt/hunt.py --count 200 $program
run 'rooms whose light is rare, 200' hunt-rare-long \
    python3 tests/hunt/hunt.py --rare --count 200 --keep .build/rare_rooms.jsonl $program
of "$review scenes tests/image"
run 'a glare review, thirty hours of weather' review-long \
    python3 tests/image/review.py --all $program
run 'symbols half in the sun, twenty edges' worst-part-long \
    python3 tests/image/worst_part.py --all $program
run 'years recounted, every hour' year-long python3 tests/image/year.py --all $program
run 'all variants of a review' variants-long \
    python3 tests/image/variants.py --all $program
run 'doors, mirrored vehicles, mirrored light' changed-long \
    python3 tests/image/changed.py --all $program
run 'lamps by every way, 200' lamps-by-every-way-long \
    python3 tests/image/lamps_by_every_way.py $program
run "a dark cabin's intervals" cabin-long python3 tests/image/cabin.py $program
run "another maker's car" other-maker python3 tests/image/other_maker.py $program
run 'intervals of light that is rare' gaze-intervals-long \
    python3 tests/image/gaze_intervals.py --all $program
of "$review src/measure src/compare tests/image"
run "intervals of a frame's glare over forty seeds" glare-intervals \
    python3 tests/image/glare.py --all $program
run 'every interval that commands print' every-interval-long \
    python3 tests/image/every_interval.py --all $program
of "$review scenes tests/image"
run 'verdicts beside their limits' review-laws python3 tests/image/review_laws.py $program \
    scenes/glance.review.json dimmed 0.4 0.45 0.0025
run "laws of a whole car's review" review-laws-car \
    python3 tests/image/review_laws.py $program scenes/car_dashboard.review.json
of "$review tests/bench tests/image"
run 'verdicts whose truth is known' verdicts claim \
    python3 tests/bench/verdicts.py .build/release --rooms open,window --trials 200
run 'verdicts on increments' roads claim \
    python3 tests/bench/roads.py .build/release --trials 40 --rooms cabin,street
run 'verdicts of what must not be read' verdicts-private claim \
    python3 tests/bench/verdicts.py .build/release --rooms open --trials 100 --private
of "$render scenes tests/slurm tests/image"
run 'a frame in parts by Slurm' render-array python3 tests/slurm/render_array.py $program
of "$review scenes tests/hostile tests/slurm tests/image"
run 'a review in parts by Slurm' review-array python3 tests/slurm/review_array.py $program
run 'reviews killed, stopped and starved' review-resume-long \
    python3 tests/hostile/review_resume.py --all --kills 40 $program
run 'models of others equipped' equip-models python3 tests/hostile/equip.py $program
of "$review scenes tests/page tests/image"
run 'the page of a review' review_page python3 tests/page/review_page.py $program
run 'a model equipped by clicks' equip python3 tests/page/equip.py $program
of "$compare scenes tests/bench tests/image"
run 'false alarms and power of compare' compare-power \
    python3 tests/bench/compare_power.py $program .build/release/bench_statistic
of "$all scenes README.md tests/image tests/page"
run 'every guide as written, a review met' guides-long guides_and_meeting
of "$all tests/unit"
run 'unit tests that take long' unit-long units .build/release -L long
of "$all scenes README.md tests"
run 'figures of pages that tests print' figures-long python3 tests/image/figures.py --logs
of "$all scenes README.md CONTRIBUTING.md tests"
run 'packages built twice' packages python3 tests/install/packages.py .build/packages
run 'packages in a bare Debian' bare-root \
    python3 tests/install/bare_root.py .build/packages/first/.build/release/packages
run 'the suite in another Debian' other-debian python3 tests/install/other_debian.py $program

# ---- with the sanitizers for addresses and what is not defined ----
needs 'asan all'
of "$all tests/unit"
run 'unit tests, address sanitizer' unit-asan units .build/asan --timeout 10800
of "$panels tests/unit"
for share in 1 2 3; do
    start "100,000 broken panels, $share of 3" panels-$share mutations $share
done
of "$render scenes tests/hostile"
start 'thousands of broken models' hostile-long \
    python3 tests/hostile/run.py --all .build/asan/parhelion
of "$all scenes tests/hostile tests/image"
start 'every fault, address sanitizer' faults-asan \
    python3 tests/hostile/faults.py --all .build/asan/parhelion
gather

# ---- by the second compiler, and for this processor alone ----
needs 'release all' 'clang all'
of "$all tests/unit"
run 'unit tests, second compiler' unit-clang units .build/clang
of "$render scenes tests/image"
run 'same bits from both compilers' bits-clang \
    python3 tests/image/bits.py --against $program .build/clang/parhelion
of "$tables tests/hostile"
run 'panels of one build in another' panels-native native_panels

# ---- with the sanitizer for threads ----
needs 'tsan parhelion test_base test_render test_checkpoint'
of "$light tests/unit"
run 'unit tests, thread sanitizer' unit-tsan units .build/tsan -R '^(base|render|checkpoint)$'
of "$render scenes tests/image tests/hostile"
run 'two threads, thread sanitizer' tsan \
    python3 tests/image/bits.py --small .build/tsan/parhelion
run 'checkpoint and interrupt, the same' tsan-resume \
    python3 tests/hostile/resume.py --small .build/tsan/parhelion

# ---- by chance ----
needs 'fuzz fuzz'
of "$all tests/fuzz tests/unit"
run 'five minutes of fuzzing' fuzz python3 tests/fuzz/run.py .build/fuzz
finish
