#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# run.sh [RUNS] -- how fast it is: one line a work with its unit, median and spread (smallest
# to largest) of RUNS runs, 5 if not said. Compare two commits on the same quiet machine only.
# Sizes and errors of panels: panel_sizes.py; how true they are: panel_accuracy.py.
set -eu
cd "$(dirname "$0")/../.."
runs=${1:-5}
out=.build/bench
mkdir -p $out
{
    sh third_party/install.sh --tests
    cmake --preset release && cmake --build .build/release
} >$out/build.log 2>&1 || { tail $out/build.log; exit 1; }
[ -e $out/box.gltf ] || python3 tests/bench/box.py $out/box.gltf

echo "commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown), $(nproc) processors"
python3 tests/bench/frames.py "$runs" .build/release/parhelion
dashboard='scenes/car_dashboard.gltf scenes/noon.gltf'
# shellcheck disable=SC2086
.build/release/bench_tracing "$runs" $dashboard
.build/release/bench_tracing "$runs" $out/box.gltf
python3 tests/bench/visibility.py .build/release/bench_visibility
for panel in ips_cluster oled_centre; do
    for set in '' _avx2 _avx512; do
        [ -z "$set" ] || grep -q "${set#_}" /proc/cpuinfo || continue
        echo "panel $panel${set:+, instruction set ${set#_}}"
        .build/release/bench_panel$set "$runs" assets/panels/$panel.recipe.json \
            assets/panels/$panel.panel
    done
done
