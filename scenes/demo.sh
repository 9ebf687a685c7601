#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# demo.sh -- from a fresh checkout to a picture: installs what is missing, builds, renders the
# dashboard at noon, a preview and then the frame, both developed denoised. SIZE, SPP and NOISE
# in the environment change the render.
set -eu
cd "$(dirname "$0")/.."
size=${SIZE:-1280x720} spp=${SPP:-1024} noise=${NOISE:-0.085}
out=.build/demo
say() { echo "$*" >&2; }

sh third_party/install.sh
say "building (the log is $out/build.log)"
mkdir -p $out
{
    cmake --preset release && cmake --build .build/release --target parhelion
} >$out/build.log 2>&1 || {
    tail -n 30 $out/build.log >&2
    say "demo.sh: the build failed; the whole log is $out/build.log"
    exit 1
}

# By the default view the sunlit street is pale and nothing is black.
render() {
    .build/release/parhelion render scenes/car_dashboard.gltf scenes/noon.gltf --size "$size" \
        --denoise --view 'ACES SDR' --exposure 11.3 --adapt local "$@"
}

say "rendering a preview of 4 samples a pixel, denoised; soon a first look at it stands in
$PWD/$out/preview.png"
render --preview -o $out/preview.exr --png $out/preview.png
say "A preview, for looking and not for figures: $PWD/$out/preview.png"

say "rendering $size until the frame's relative error is $noise, at most $spp samples a pixel"
render --spp "$spp" --noise "$noise" -o $out/dashboard.exr --png $out/dashboard.png
say "Figures are of the frame, $out/dashboard.exr, whose own error stands above. The picture is
denoised: what is smooth has less noise than in a frame of 5 %, leaves have more (NOISE=0.05
makes one; tests/bench/README.md compares them). The dashboard at noon, as a camera at the
driver's eye sees it:"
echo "$PWD/$out/dashboard.png"
