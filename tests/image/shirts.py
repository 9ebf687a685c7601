# SPDX-License-Identifier: Apache-2.0
"""shirts.py PARHELION -- what a driver's shirt does to the car's odometer with the sun ahead:
the figures of the guide on glare reviews, by a review of two of the shipped car's conditions,
and of one with nobody in the seat. Half a minute.
"""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
REQUEST = os.path.join("scenes", "car_dashboard.review.json")


def request_of(folder):
    """The shipped request without all that has nothing to do with shirts."""
    with open(os.path.join(folder, REQUEST), encoding="utf-8") as file:
        request = json.load(file)
    ahead = [c for c in request["conditions"] if c["name"].startswith("sun ahead")]
    nobody = {key: value for key, value in ahead[0].items() if key != "with"}
    kept = {key: request[key] for key in ("scene", "forward", "with", "profile", "levels")}
    return {**kept, "eyes": {"driver": request["eyes"]["driver"]},
            "symbols": {"odometer": request["symbols"]["odometer"]},
            "conditions": [*ahead, {**nobody, "name": "sun ahead, nobody"}],
            "frames": {"size": [16, 9], "worst": 0}}


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        for name in ("scenes", "assets"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(folder, name))
        path = os.path.join(folder, "scenes", "shirts.review.json")
        request = request_of(folder)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(request, file)
        out = os.path.join(folder, "out")
        done = subprocess.run([program, "review", path, "-o", out], capture_output=True,
                              text=True)
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        with open(os.path.join(out, "cases.csv"), encoding="utf-8", newline="") as file:
            for case in (row for row in csv.DictReader(file) if row["decides"] == "true"):
                print(f"{case['condition']}: reflected {case['reflected_cd_m2']} cd/m2, "
                      f"contrast {case['contrast_ratio_without_veil']}")


if __name__ == "__main__":
    sys.exit(main())
