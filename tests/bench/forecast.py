#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""forecast.py [--size WxH] PARHELION -- how well `render --noise` foretells its end.

Renders shipped scenes to a relative error, takes what the progress says was left after a tenth
of the time, and of the samples, and prints it over what was left in truth.
"""
import argparse
import json
import os
import subprocess
import tempfile

SCENES = (("car_dashboard", "noon", "0.06"), ("car_dashboard", "night", "0.12"),
          ("cockpit", "low_sun_left", "0.07"), ("cockpit", "cloud_noon", "0.1"),
          ("car_dashboard", "noon", "display:0.03"), ("car_dashboard", "dusk", "0.08"))


def progress_of(parhelion, car, light, noise, size, folder):
    """The progress, line by line, and the answer."""
    scenes = os.path.join(os.path.dirname(__file__), "..", "..", "scenes")
    run = subprocess.run(
        [parhelion, "render", f"{scenes}/{car}.gltf", f"{scenes}/{light}.gltf", "--size", size,
         "--noise", noise, "--spp", "8192", "--progress", "json", "--json", "-o",
         f"{folder}/frame.exr"], capture_output=True, text=True, check=True)
    lines = [json.loads(line)["progress"] for line in run.stderr.splitlines()
             if line.startswith('{"progress"')]
    return lines, json.loads(run.stdout)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--size", default="160x90")
    parser.add_argument("parhelion")
    args = parser.parse_args()
    print(f"{'scene':24} {'error':>13} {'seconds':>8} {'samples':>8}"
          "   foretold / true at a tenth: seconds left, samples left")
    with tempfile.TemporaryDirectory() as folder:
        for car, light, noise in SCENES:
            lines, answer = progress_of(args.parhelion, car, light, noise, args.size, folder)
            seconds, end = answer["seconds"], lines[-1]["done"]
            at = next(p for p in lines if p["elapsed_s"] >= 0.1 * seconds)
            by = next(p for p in lines if p["done"] >= 0.1 * end)
            print(f"{car + ', ' + light:24} {noise:>13} {seconds:8.1f} {answer['samples']:8}"
                  f"   {at['remaining_s'] / (seconds - at['elapsed_s']):.2f}"
                  f" {(by['total'] - by['done']) / (end - by['done']):.2f}", flush=True)


main()
