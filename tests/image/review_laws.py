# SPDX-License-Identifier: Apache-2.0
"""review_laws.py PARHELION REVIEW.json [LEVEL FIRST LAST STEP] -- numbers of a review that
belong together: every contrast is its luminances' own, intervals hold what they are of, one
verdict stands in headline, card, table, JSON and exit status.

With a level, the review is made once for each of its values; pictures are left out.
"""
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile



def contrast(light, reflected):
    bright = max(light["foreground"], light["background"]) + reflected
    dark = min(light["foreground"], light["background"]) + reflected
    return bright / dark if dark > 0 else math.inf


def contrast_ends(case):
    """At the ends of what is reflected, and of what the panel states of its own errors: of what
    it reflects, and of each of the two luminances. Independent halves add up as squares."""
    light, panel = case["luminance_cd_m2"], case["panel"]
    ratio, ends = case["contrast_ratio"], case["reflected_interval"]
    reflects, emits = (1.959964 * panel[key] for key in ("reflection_error", "emission_error"))
    bright = max(light["foreground"], light["background"])
    dark = min(light["foreground"], light["background"])
    found = light["reflected"]
    for sign, reflected in ((-1, ends[1]), (1, ends[0])):
        halves = [contrast(light, reflected) - ratio,
                  contrast(light, found * max(1 - sign * reflects, 0)) - ratio,
                  (bright * max(1 + sign * emits, 0) + found) / (dark + found) - ratio,
                  (bright + found) / (dark * max(1 - sign * emits, 0) + found) - ratio]
        yield max(ratio + sign * math.hypot(*halves), 1)


def broken_mean_laws(case):
    """The part that is judged is no better than the symbol's mean, whose contrast is of the
    same light: with the veil where the profile counts it."""
    light, mean = case["luminance_cd_m2"], case["symbol_mean"]
    if mean is None or mean["reflected"] is None:
        return
    if case["reflected_interval"][1] < mean["reflected_interval"][0]:
        yield f"the mean reflects {mean['reflected']}, the part {light['reflected']}"
    by_it = [contrast(light, mean["reflected"] + veil) for veil in (0, light["veil"] or 0)]
    if not any(abs(mean["contrast_ratio"] - own) <= 2e-4 * own for own in by_it):
        yield f"contrast {mean['contrast_ratio']} of the mean, of luminances that give {by_it}"


def share_within(away, error, distance):
    """Of all that is normal about `away`, `error` wide."""
    normal = statistics.NormalDist(away, error)
    return normal.cdf(distance) - normal.cdf(-distance)


def broken_decision_laws(case):
    """Something keeps open what is too close, and that alone; paths do not where the limit lies,
    more likely than not, within what the panel itself leaves in doubt (or the sun in its mirror,
    of which a case does not say how surely that is known)."""
    by, limit = case["open_by"], case["judged"]
    if (by is not None) != (case["verdict"] == "too close"):
        yield f"{case['verdict']}, open by {by}"
    if by is None:
        return
    if limit["kind"] != "contrast_ratio" or limit["found"] != case["contrast_ratio"]:
        return
    is_above = limit["found"] > limit["value"]
    end = case["reflected_interval"][1 if is_above else 0]
    error = abs(contrast(case["luminance_cd_m2"], end) - limit["found"]) / 1.959964
    far = limit["interval"][0 if is_above else 1]
    if far is None:  # without an end: nothing may be reflected on black
        return
    half = abs(limit["found"] - far)
    panel = math.sqrt(max(half ** 2 - (1.959964 * error) ** 2, 0))
    never = share_within(abs(limit["found"] - limit["value"]), error, panel)
    is_known = case["luminance_cd_m2"]["mirror"] < 0.01 * case["luminance_cd_m2"]["reflected"]
    if by == "paths" and never > 0.52 or by == "panel error" and is_known and never < 0.48:
        yield f"open by {by}: by {never} it lies within the panel's error"


def broken_case_laws(case):
    """Numbers of a case that belong together and do not agree."""
    light, ratio = case["luminance_cd_m2"], case["contrast_ratio"]
    hidden = sum(hider["share"] for hider in case["hidden_by"])
    if abs(hidden + case["visible_share"] - 1) > 1e-4:
        yield f"visible {case['visible_share']}, hidden {hidden}"
    if (case["verdict"] == "cannot be judged") != (case["reason"] is not None):
        yield f"{case['verdict']}, because of {case['reason']}"
    if case["reason"] == "hidden":
        if ratio is not None or case["remedies"]:
            yield f"hidden, and a contrast of {ratio}"
        return
    low, high = case["reflected_interval"]
    ends = case["contrast_interval"]
    if not low / (1 + 1e-5) <= light["reflected"] <= high * (1 + 1e-5):
        yield f"reflected {light['reflected']} lies outside {low} to {high}"
    if ratio is not None and not math.isinf(contrast(light, light["reflected"])):
        wanted = [contrast(light, light["reflected"]), *contrast_ends(case)]
        for found, own in zip([ratio, *ends], wanted):
            is_open = found is None  # nothing may be reflected on black: no end
            if is_open != math.isinf(own) or not is_open and abs(found - own) > 2e-4 * found:
                yield f"contrast {found} of luminances that give {own}"
    yield from broken_mean_laws(case)
    for name, group in case["cause_groups"].items():
        if group and abs(sum(share["share"] for share in group) - 1) > 1e-4:
            yield f"causes by {name} add up to {sum(share['share'] for share in group)}"
        if any(share["what"] == "other" and share["share"] > 0.1 for share in group):
            yield f"causes by {name}: {group[-1]['share']} under 'other'"
    if case["limit"]:
        limit = case["limit"]
        if limit["margin"] != case["margin"]:
            yield f"margin {case['margin']} beside its limit's {limit['margin']}"
        if limit["kind"] == "contrast_ratio" and \
                abs(math.log(limit["found"]) / math.log(limit["value"]) - 1 -
                    limit["margin"]) > 1e-4 * max(1, abs(limit["margin"])):
            yield f"margin {limit['margin']} of {limit['found']} by {limit['value']}"
    if case["precision_asked"] is None or case["precision_reached"] is None:
        yield "no precision"
    yield from broken_decision_laws(case)


def broken_variant_laws(review):
    """A difference is that of its margins; the worst is the least; no failure passes."""
    for variant in review.get("variants", []):
        found = variant["cases"] + variant["sweeps"]
        for case in found:
            if case["margin"] is None or case["margin_before"] is None:
                continue
            low, high = case["margin_difference_interval"]
            apart = case["margin"] - case["margin_before"]
            if not low - 1e-9 <= case["margin_difference"] <= high + 1e-9 or \
                    abs(case["margin_difference"] - apart) > 1e-4 * (1 + abs(case["margin"])):
                yield f"variant {variant['name']}: {case['margin_difference']} of {apart}"
        margins = [case["margin"] for case in found if case["margin"] is not None]
        if margins and variant["worst"]["margin"] != min(margins):
            yield f"variant {variant['name']}: worst {variant['worst']['margin']}"
        if variant["pass"] and any(case["verdict"] == "fail" for case in found):
            yield f"variant {variant['name']} passes"


def broken_step_laws(sweep, row):
    """A step's contrast is of its own light; what is shown goes with the level. (A sweep of an
    eye box is of its middle, its worst of another place.)"""
    worst = sweep["worst"]
    least, ratio, most = (float(row[f"contrast_{key}"]) for key in ("low", "ratio", "high"))
    if not least / 1.0001 <= ratio <= most * 1.0001:
        yield f"a step's contrast lies outside its interval: {row}"
    if worst["reason"] == "hidden" or worst["eye_failed_share"] is not None:
        return
    dimmed, light = float(row["level"]) / worst["level"], worst["luminance_cd_m2"]
    shown = {key: light[key] * dimmed for key in ("foreground", "background")}
    wanted = contrast(shown, float(row["reflected_cd_m2"]))
    if abs(ratio - wanted) > 5e-4 * wanted:  # of five digits each
        yield f"a step's contrast {ratio} of luminances that give {wanted}: {row}"


def broken_laws(review, folder, done):
    cases = review["cases"] + [sweep["worst"] for sweep in review["sweeps"]]
    for case in cases:
        yield from broken_case_laws(case)
    yield from broken_variant_laws(review)
    with open(os.path.join(folder, "cases.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    told = [(f["finding_verdict"], f["quantity"] or "", f["verdict"], f["margin"])
            for f in review["findings"]]
    wrote = [(r["finding_verdict"], r["quantity"], r["verdict"],
              float(r["margin"]) if r["margin"] else None) for r in rows]
    if told != wrote:
        yield f"cases.csv says {wrote}, review.json {told}"
    for case in review["cases"]:
        of = [f for f in review["findings"] if f["kind"] == "symbol" and
              [f["condition"], f["eye"], f["subject"]] ==
              [case["condition"], case["eye"], case["symbol"]]]
        if len(of) != max(len(case["limits"]), 1) or of[0]["finding_verdict"] != case["verdict"]:
            yield f"{len(of)} rows of {len(case['limits'])} limits: {of}"
    for sweep in review["sweeps"]:
        if sweep["verdict"] != sweep["worst"]["verdict"]:
            yield f"a sweep says {sweep['verdict']}, its worst {sweep['worst']['verdict']}"
        if not sweep["table"]:
            continue
        with open(os.path.join(folder, sweep["table"]), encoding="utf-8") as file:
            for row in csv.DictReader(file):
                yield from broken_step_laws(sweep, row)
    verdicts = [c["verdict"] for c in cases if c["reason"] != "no limit" and
                not (c["optional"] and c["reason"] == "hidden")]
    wanted = next((says for says in ("fail", "cannot be judged", "too close")
                   if says in verdicts), "pass")
    if cases and not verdicts and not any(c["optional"] for c in cases):
        wanted = "cannot be judged"
    if review["strict"] and wanted == "too close":
        wanted = "fail"
    passes = wanted in ("pass", "too close")
    if review["verdict"] != wanted or review["pass"] != passes or \
            done.returncode == passes:
        yield f"says {review['verdict']}, status {done.returncode}, its cases {verdicts}"
    if done.stdout and done.stdout.splitlines()[-1] != review["headline"]:
        yield f"the last line is {done.stdout.splitlines()[-1]}"


def review(program, request, folder, responses):
    """What is wrong, and its cases."""
    done = subprocess.run([program, "review", request, "-o", folder, "--quiet",
                           "--responses", responses],
                          capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        return [done.stderr], []
    with open(os.path.join(folder, "review.json"), encoding="utf-8") as file:
        found = json.load(file)
    with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
        page = file.read()
    words = {"pass": "Passes", "fail": "Fails", "too close": "Too close to call",
             "cannot be judged": "Cannot be judged"}
    wrong = list(broken_laws(found, folder, done))
    if not found["headline"].startswith(words[found["verdict"]]) or \
            f"<h1><b>{found['headline']}</b>" not in page:
        wrong.append(f"the page's headline does not say {found['verdict']}")
    return wrong, found["cases"] + [sweep["worst"] for sweep in found["sweeps"]]


def levels_of(words):
    name, first, last, step = words[0], *map(float, words[1:])
    count = int(round((last - first) / step))
    return name, [round(first + i * step, 9) for i in range(count + 1)]


def main(program, request, *words):
    program, request = os.path.abspath(program), os.path.abspath(request)
    with open(request, encoding="utf-8") as file:
        document = json.load(file)
    document["frames"] = {"worst": 0}
    name, values = levels_of(words) if words else (None, [None])
    if name:
        document.pop("variants", None)
    cases, broken = [], 0
    kept = tempfile.TemporaryDirectory()
    for value in values:
        if name:
            document["levels"][name] = {"*": value}
        beside = os.path.join(os.path.dirname(request), f".laws-{os.getpid()}.review.json")
        with tempfile.TemporaryDirectory() as folder:
            try:
                with open(beside, "w", encoding="utf-8") as file:
                    json.dump(document, file)
                wrong, found = review(program, beside, os.path.join(folder, "out"), kept.name)
            finally:
                os.remove(beside)
        cases, broken = cases + found, broken + len(wrong)
        for said in wrong:
            print(f"{os.path.basename(request)}, {name} {value}: {said}", flush=True)
    kept.cleanup()
    close = [case["open_by"] for case in cases if case["verdict"] == "too close"]
    print(f"{len(cases)} cases of {len(values)} reviews, {len(close)} too close, "
          f"{sum(by != 'paths' for by in close)} of them for any number of paths; "
          f"{broken} broken laws")
    return broken > 0 or not cases


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
