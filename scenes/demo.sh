#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# demo.sh -- from a fresh checkout to a picture: installs what is missing, builds, renders the
# dashboard at noon, a denoised preview and then the frame, and develops it. SIZE, SPP and
# NOISE in the environment change the render.
set -eu
cd "$(dirname "$0")/.."
size=${SIZE:-1280x720} spp=${SPP:-1024} noise=${NOISE:-0.05}
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

say "rendering a preview of 4 samples a pixel, denoised; soon a first look at it stands in
$PWD/$out/preview.png"
.build/release/parhelion render scenes/car_dashboard.gltf scenes/noon.gltf \
    --size "$size" --preview -o $out/preview.exr --png $out/preview.png
say "A preview, for looking and not for figures: $PWD/$out/preview.png"

say "rendering $size until the relative error is $noise, at most $spp samples a pixel"
.build/release/parhelion render scenes/car_dashboard.gltf scenes/noon.gltf \
    --size "$size" --spp "$spp" --noise "$noise" -o $out/dashboard.exr
.build/release/parhelion develop $out/dashboard.exr -o $out/dashboard.png
say "The dashboard at noon, as a camera at the driver's eye sees it:"
echo "$PWD/$out/dashboard.png"
