# SPDX-License-Identifier: Apache-2.0
"""review_request.py [--all] PARHELION -- every key of REVIEW.json with values that it cannot
have: of another kind, no number, negative, zero, huge, empty, too short, too long, an unknown
key beside it. The schema says which are wrong; those are refused in one line that names the
place, and what the schema takes is taken or refused so. Without --all every 53rd of them. Then
the files that a request names, what `explain` is asked, and what is in the output's way.
"""
import calendar
import concurrent.futures
import copy
import json
import os
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]
from gltf import Scene, png  # noqa: E402
from report import Report  # noqa: E402
from review import EPW, PANEL, dashboard, weather_row  # noqa: E402
from schemas import written  # noqa: E402

TIMEOUT_S = 60
MARK = "written as it stands"
NO_JSON = ("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "01", "'text'")
OTHER_KINDS = (None, True, "", "no such word", -1, 0, 0.5, 1e300, -1e300, [], {}, [[]], [None],
               {"no such key": 1}, "x" * 5000, "line\nfeed\u001b[31m")
PLACE = re.compile(r"\((/[^()]*)\)(?: — .*)?$|: (/[^:]*): ")

# Says all that one can say: check_whole sees to that.
GOOD = {
    "title": "all of it", "scene": ["dash.gltf"], "forward": [0, 0, -2],
    "eyes": {"driver": {"camera": "eye"}, "first": {"camera": 0},
             "tall": {"position_m": [0.1, 0.2, 0.8], "proposed_from": "a seat"},
             "box": {"centre_m": [0, 0.15, 0.8], "half_size_m": [0.1, 0.1, 0],
                     "grid": [2, 3, 1]},
             "drivers": {"centre_m": [0, 0.15, 0.8], "ellipse_m": [0.2, 0.06, 0.09],
                         "tilt_deg": 6.4}},
    "observer": {"age_years": 60, "pigment": 1},
    "gaze": [{"at": "symbols", "name": "here", "eyes": ["driver"]},
             {"name": "road", "direction": [0, 0, -4], "eyes": ["tall", "driver"],
              "road": {"luminance_cd_m2": 0.3, "s_p": 1.4, "ages_years": [25, 70],
                       "dimming_cd_m2": [0.1, 1]}}],
    "with": {"somebody": ["person.gltf"]},
    "document": {"number": "R-1", "revision": "B", "date": "2026-11-30", "author": "somebody"},
    "symbols": {"bar": {"display": "screen", "content": "letters.png",
                        "uv": [0.1, 0.1, 0.9, 0.9], "polarity": "light-on-dark",
                        "distinct_from": ["text"]},
                "drawn": {"display": "screen", "mask": "letters.png", "visible": "optional",
                          "must_not_be_read": ["tall"]},
                "text": {"display": "node:face", "uv": [0, 0, 1, 1], "find": "text",
                         "visible": {"driver": "optional", "tall": "required"}}},
    "privacy": {"security_min_s": 1.5}, "visibility": {"ages": [40, 70], "glance_s": 0.2},
    "pane_images": {"within_deg": 20, "contrast_max": 0.1, "against_cd_m2": 0.3,
                    "areas": [{"name": "mirror", "direction": [-1, 0, -2], "within_deg": 8,
                               "contrast_max": 0.05}]},
    "profile": "iso-15008",
    "levels": {"night": {"*": 0.04, "screen": 0.1},
               "auto": {"sensor": {"position_m": [0, 0.2, 0.2], "normal": [0, 3, 4]},
                        "table_lx": [[0, 0.02], [100, 0.1], [10000, 1]]}},
    "max_level": 2,
    "precision": {"contrast": 0.02, "clear": 0.05, "paths": 65536, "seed": 3},
    "frames": {"size": [64, 36], "noise": 0.1, "worst": 2, "denoise": False},
    "variants": {
        "all": {"panels": {"screen": "ips.panel"}, "contents": {"screen": "letters.png"},
                "levels": {"night": {"*": 0.05}}, "brightness": {"screen": 1.5, "*": 1},
                "coatings": {"coated": {"stack": "mgf2"}}, "glazings": {"coated": None},
                "materials": {"coated": {"doubleSided": True}},
                "nodes": {"face": {"tilt_deg": 2, "turn_deg": -1, "roll_deg": 0.5,
                                   "move_m": [0, 0.01, 0], "with": ["shelf"],
                                   "hinge": {"axis": [0, 2, 0], "through_m": [0.1, 0, 0],
                                             "angle_deg": 3}}},
                "finishes": {"screen": {"scatters": 0.8, "width_deg": 4}},
                "mirror": {"middle_m": 0.1}, "hoods": {"screen": 0.02},
                "eyes": {"box": {"move_m": [0, 0.01, 0]}},
                "scene": ["dash.gltf"], "add": ["lamp.gltf"]}},
    "conditions": [
        {"name": "noon", "level": "auto", "with": "somebody", "polarity": "light-on-dark",
         "contents": {"screen": "letters.png"},
         "environment": {"type": "constant", "luminance": 3000},
         "sunglasses": {"transmittance": 0.2, "polarising": {"axis_deg": 5, "extinction": 80}}},
        {"name": "night", "lights": ["lamp.gltf"], "level": "night", "heading_deg": -20,
         "sunglasses": {"category": 1},
         "polarity": {"bar": "light-on-dark"}},
        {"name": "suns", "sweep": {"sun": {"azimuth_deg": [0, 360, 90],
                                           "elevation_deg": [5, 5, 1]}, "sky": "sky"}},
        {"name": "year", "sweep": {"year": 2026, "where": [48, 11, 520], "step_minutes": 720,
                                   "headings_deg": [0, 90], "weather": "w.epw",
                                   "weather_lux": "perez", "night": True}}]}
# The same without a road, which requires a moment.
PLAIN = {**GOOD, "gaze": [{key: gaze[key] for key in gaze if key != "road"}
                          for gaze in GOOD["gaze"]]}

DAYS = [(month, day) for month in range(1, 13)
        for day in range(1, calendar.monthrange(2026, month)[1] + 1)]


def is_of_letter(x, y):
    """HHHH, 12 pixels tall."""
    column = (x - 16) % 12
    return 16 <= x < 64 and 18 <= y < 30 and (column in (0, 1, 6, 7) or
                                             (y in (23, 24) and column < 8))


def write_files(requests):
    """What the good document names."""
    folder = requests.folder

    def path(name):
        return os.path.join(folder, name)
    shutil.copy(PANEL, path("ips.panel"))
    dash = dashboard()
    for node, name in enumerate(("face", "shelf")):
        dash.document["nodes"][node]["name"] = name
    dash.quad(dash.material("coated", {"KHR_materials_ior": {"ior": 1.5}},
                            pbrMetallicRoughness={"metallicFactor": 0}),
              [2, 0, 1], [0.1, 0, 0], [0, 0.1, 0])
    dash.write(path("dash.gltf"))
    for name in ("person.gltf", "lamp.gltf"):
        scene = Scene()
        scene.quad(scene.lambert(0.5), [2, 0, 0], [0.1, 0, 0], [0, 0.1, 0])
        scene.write(path(name))
    with open(path("letters.png"), "wb") as file:
        file.write(png(96, 48, [[255 * is_of_letter(x, y) for x in range(96) for _ in range(3)]
                                for y in range(48)]))
    with open(path("w.epw"), "w", encoding="utf-8") as file: # no lux of its own
        file.write(EPW + "".join(weather_row(month, day, hour, 500, 100, 0)
                                 for month, day in DAYS for hour in range(1, 25)))


def places(node, at=()):
    """The ways to every value of a document."""
    items = enumerate(node) if isinstance(node, list) else \
        node.items() if isinstance(node, dict) else ()
    for key, value in items:
        yield at + (key,)
        yield from places(value, at + (key,))


def value_at(document, place):
    for key in place:
        document = document[key]
    return document


def changed(place, value):
    document = copy.deepcopy(GOOD)
    value_at(document, place[:-1])[place[-1]] = value
    return document


def without(place):
    document = copy.deepcopy(GOOD)
    del value_at(document, place[:-1])[place[-1]]
    return document


def neighbours(value):
    """The same but for what stands in it."""
    if isinstance(value, list):
        yield value[:-1]
        yield value + value[-1:]
        yield value + [None]
    if isinstance(value, dict):
        yield {**value, "no such key": 1}


def text_of(place):
    return "/" + "/".join(map(str, place))


def trials():
    """(place, document as text, the document or None where it is no JSON)."""
    for place in places(GOOD):
        kept = value_at(GOOD, place)
        documents = [changed(place, value) for value in (*OTHER_KINDS, *neighbours(kept))
                     if value != kept or type(value) is not type(kept)]
        for document in (*documents, without(place)):
            yield place, json.dumps(document), document
        if not isinstance(kept, (dict, list)):
            text = json.dumps(changed(place, MARK))
            for word in NO_JSON:
                yield place, text.replace(f'"{MARK}"', word), None


def is_near(told, place, document):
    """The place itself, what is in it, or what it is in; what was taken away may be missed by
    those beside it."""
    parent = text_of(place[:-1])
    is_gone = place[-1:] not in places(value_at(document, place[:-1]))
    return told == parent or (told + "/").startswith(text_of(place) + "/") or \
        (is_gone and told.startswith(parent + "/"))


class Requests:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run(self, *words):
        done = subprocess.run([self.program, *words, "--quiet"], cwd=self.folder,
                              capture_output=True, timeout=TIMEOUT_S)
        return done.returncode, done.stderr.decode("utf-8", "replace")

    def ask(self, number, text, *options):
        name = f"{number}.json"
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        answer = self.run("review", name, *(options or ("--dry-run",)))
        os.remove(self.path(name))
        return answer


def is_refusal(status, said, wanted=3):
    return status == wanted and said.count("\n") == 1 and said.startswith("parhelion: ")


def is_forward(line):
    """An eye behind the display looks backwards: the program warns of that, rightly."""
    return line.startswith("parhelion: warning: ") and line.endswith("(/forward)")


def fault_of(status, said, trial, validator):
    """What is wrong with the program's answer; None: nothing."""
    place, _, document = trial
    takes = document is not None and validator.is_valid(document)
    if takes and status == 0 and all(is_forward(line) for line in said.splitlines()):
        return None
    if not is_refusal(status, said):
        return f"status {status}"
    if document is None:
        return None if "not valid JSON" in said else "takes what is no JSON"
    told = PLACE.search(said)
    if takes or not told:
        named = told or "symbol '" in said or "there is no profile" in said or \
            f"key '{place[0]}' is missing" in said
        return None if named else "names no place"
    where = told[1] or told[2]
    return None if is_near(where, place, document) else f"names {where}"


def check_keys(report, requests, step):
    try:
        import jsonschema
    except ImportError:
        report.skip("reviews against their schema: python3-jsonschema is not installed")
        return
    schema = written(requests.program, "review")
    validator = jsonschema.validators.validator_for(schema)(schema)
    chosen = list(trials())[::step]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        answers = pool.map(requests.ask, range(len(chosen)), [text for _, text, _ in chosen])
        for number, (trial, answer) in enumerate(zip(chosen, answers)):
            fault = fault_of(*answer, trial, validator)
            report.claim(not fault, f"{text_of(trial[0])}, trial {number} of {step}: {fault}: "
                                    f"{answer[1][:300]}")


def check_whole(report, requests):
    """The good request is taken, and says all keys of the schema."""
    status, said = requests.ask("good", json.dumps(GOOD))
    report.claim(status == 0 and not said, f"the good request: status {status}: {said}")
    said_keys = {key for place in places(GOOD) for key in place if isinstance(key, str)}
    schema = written(requests.program, "review")
    # its members are the scene's, which other tests say
    schema["properties"]["conditions"]["items"]["properties"]["environment"] = {}
    missing = set(keys_of(schema)) - said_keys
    report.claim(not missing, f"the good request does not say {sorted(missing)}")


def keys_of(schema):
    if isinstance(schema, list):
        for item in schema:
            yield from keys_of(item)
    elif isinstance(schema, dict):
        yield from schema.get("properties", {})
        for value in schema.values():
            yield from keys_of(value)


# ---- names that it gives elsewhere -------------------------------------------------------

# What the names in an object of that key are names of.
NAMED = {"visible": "unknown eye", "polarity": "unknown symbol", "eyes": "unknown eye",
         "levels": "unknown level", "panels": "no material", "contents": "no display",
         "brightness": "no display", "night": "no display", "glazings": "no material",
         "materials": "no material", "nodes": "no node", "finishes": "no display",
         "hoods": "no display"}


def check_names(report, requests):
    """Of each map from names, a name with one letter more: told is what it should be a name of,
    and which was meant."""
    met = set()
    for place in places(GOOD):
        *above, name = place
        if not above or above[-1] not in NAMED or name == "*" or \
                len(above) == 1 or not isinstance(value_at(GOOD, above), dict):
            continue
        document = copy.deepcopy(GOOD)
        names = value_at(document, above)
        names[name + "x"] = names.pop(name)
        status, said = requests.ask("name", json.dumps(document))
        report.claim(is_refusal(status, said) and NAMED[above[-1]] in said and
                     name + "x" in said and f"did you mean {name}?" in said,
                     f"{text_of(place)}x: {said}")
        met.add(above[-1])
    report.claim(met == set(NAMED), f"not asked of {set(NAMED) - met}")


# ---- files that it names -----------------------------------------------------------------

HOURS = "".join(weather_row(month, day, hour, 500, 100, 0)
                for month, day in DAYS for hour in range(10, 15))
MARKED = b"\xef\xbb\xbf"
WEATHERS = ((EPW + HOURS, None), (MARKED + (EPW + HOURS).encode(), None),
            ((EPW + HOURS).replace("\n", "\r\n"), None), ("", "is empty"), (EPW, "no hours"),
            ((EPW + HOURS).encode("utf-16"), "zero bytes"), (EPW[:40], "line 1"),
            (EPW + HOURS.replace(",500,", ",nan,"), "line 9"),
            (EPW + HOURS.replace(",500,", ",9999,"), "no direct or no diffuse"),
            (EPW + re.sub(",1[234],60", ",9,60", HOURS), "has no row"),
            (EPW + HOURS.replace(",500,", ",1600,"), "more than the sun's own"),
            (EPW + HOURS.replace("x,20,12,", "x,20,99.9,"), None),
            (EPW + HOURS.replace("x,20,12,", "x,20,85,"), "a number from -99 to 70"),
            (EPW + HOURS[:-40], "fields"))


def check_files(report, requests):
    """The weather of each day's noon is wrong; told is in which file."""
    year = {"year": 2026, "step_minutes": 1440, "weather": "weather.epw"}
    text = json.dumps({**PLAIN, "conditions": [{"name": "year", "sweep": year}]})
    for number, (contents, words) in enumerate(WEATHERS):
        with open(requests.path("weather.epw"), "wb") as file:
            file.write(contents if isinstance(contents, bytes) else contents.encode())
        status, said = requests.ask("files", text)
        holds = not said and status == 0 if words is None else \
            is_refusal(status, said) and "weather.epw" in said and words in said
        report.claim(holds, f"weather {number}: status {status}, required: {words}: {said}")


def check_pictures(report, requests):
    """Heads that PNG does not have: the library that reads pictures would say it twice."""
    whole = png(60, 30, [[0] * 180] * 30)
    text = json.dumps({**PLAIN, "conditions": [{"name": "noon"}],
                       "symbols": {"drawn": {"display": "screen", "mask": "head.png"}}})
    for head in ((0, 0, 8, 2, 0, 0, 0), (60, 0, 8, 2, 0, 0, 0), (60, 30, 3, 2, 0, 0, 0),
                 (60, 30, 8, 5, 0, 0, 0), (60, 30, 8, 2, 1, 0, 0), (60, 30, 8, 2, 0, 0, 2)):
        part = b"IHDR" + struct.pack(">IIBBBBB", *head)
        with open(requests.path("head.png"), "wb") as file:
            file.write(whole[:12] + part + struct.pack(">I", zlib.crc32(part)) + whole[33:])
        status, said = requests.ask("pictures", text)
        report.claim(is_refusal(status, said) and "head.png" in said and "its head" in said,
                     f"{head}: status {status}: {said}")


# ---- beside the request ------------------------------------------------------------------

SCENE = ("dash.gltf", "--environment", "constant:300", "--paths", "1024")
EXPLAIN = ((2, "good.json", "--uv", "0,0,1,1"), (2, "good.json", "--size", "10x10"),
           (2, "good.json", "--fov", "20"), (2, "good.json", "--look-at", "0,0,0"),
           (2, "good.json", "--pixel", "1,1"), (2, "good.json", "--condition", "none"),
           (2, "good.json", "--condition", "suns", "--symbol", "bar", "--sun", "0,95"),
           (2, "good.json", "--condition", "suns", "--symbol", "bar", "--sun", "nan,5"),
           (2, *SCENE, "--display", "screen", "--uv", "0.9,0,0.1,1"),
           (2, *SCENE, "--pixel", "1280,0"), (3, *SCENE, "--display", "none"))


def check_explain(report, requests):
    with open(requests.path("good.json"), "w", encoding="utf-8") as file:
        json.dump(PLAIN, file)
    for wanted, *words in EXPLAIN:
        status, said = requests.run("explain", *words)
        report.claim(is_refusal(status, said, wanted), f"explain {words}: {status}: {said}")


def check_moments(report, requests):
    """A dry run looks into the scenes of moments, too."""
    for symbol, words in (({"display": "none", "content": "letters.png"}, "/symbols/bar"),
                          ({"display": "none"}, "/symbols/bar/display"),
                          ({"display": "screen", "content": "w.epw"}, "/symbols/bar")):
        document = {**PLAIN, "symbols": {"bar": {**symbol, "uv": [0, 0, 1, 1]}},
                    "conditions": [{"name": "noon"}]}
        status, said = requests.ask("moment", json.dumps(document))
        report.claim(is_refusal(status, said) and words in said and "moment.json" in said,
                     f"{symbol}: status {status}: {said}")


def check_marks(report, requests):
    """A byte order mark before JSON is passed over at every door; two, or UTF-16, are no JSON."""
    with open(requests.path("plain.json"), "w", encoding="utf-8") as file:
        json.dump(PLAIN, file)
    panels = os.path.join(ROOT, "assets", "panels")
    shutil.copy(os.path.join(panels, "ips_cluster.recipe.json"), requests.path("recipe.json"))
    shutil.copy(os.path.join(ROOT, "scenes", "after_dark.profile.json"),
                requests.path("own.profile.json"))
    with open(requests.path("white.csv"), "w", encoding="utf-8") as file:
        file.write("theta,phi,X,Y,Z\n0,0,90,100,80\n30,0,80,90,70\n60,0,50,60,40\n")
    with open(requests.path("set.json"), "w", encoding="utf-8") as file:
        file.write('{"emission": {"white": "white.csv"}}')
    for name, words in (("plain.json", ("review", "plain.json", "--dry-run")),
                        ("dash.gltf", ("check", "dash.gltf")),
                        ("recipe.json", ("panel", "simulate", "recipe.json", "-o", "sim",
                                         "--grid", "2x3")),
                        ("set.json", ("panel", "fit", "set.json", "-o", "x.panel")),
                        ("own.profile.json", ("review", "plain.json", "--dry-run", "--profile",
                                              "own.profile.json"))):
        with open(requests.path(name), "rb") as file:
            text = file.read()
        wanted = requests.run(*words)
        report.claim(wanted[0] == 0, f"{name}: {wanted}")
        for what, before, code, status in (
                ("a mark", b"\xef\xbb\xbf", "utf-8", 0), ("two", b"\xef\xbb\xbf" * 2, "utf-8", 3),
                ("UTF-16", b"", "utf-16", 3), ("a part", b"\xef\xbb", "utf-8", 3)):
            with open(requests.path(name), "wb") as file:
                file.write(before + text.decode().encode(code))
            found = requests.run(*words)
            report.claim(found == wanted if not status else found[0] == 3 and
                         (words[0] == "check" or is_refusal(*found)),
                         f"{what} before {name}: {found}")
        with open(requests.path(name), "wb") as file:
            file.write(text)


def check_output(report, requests):
    """What cannot be written over is told before any work, and nothing stands beside it."""
    for name in ("review.json", "index.html", "run.json", "cases.csv"):
        os.makedirs(requests.path("out", name))
        status, said = requests.ask("blocked", json.dumps(PLAIN), "-o", "out")
        report.claim(is_refusal(status, said, 4) and name in said and
                     os.listdir(requests.path("out")) == [name],
                     f"{name} is a folder: status {status}: {said}")
        shutil.rmtree(requests.path("out"))


def check_full(report, requests, is_whole):
    """A disk without room for one byte is left as it was: by a small review; is_whole: by all."""
    few = {**PLAIN, "conditions": PLAIN["conditions"][:1], "precision": {"paths": 8192},
           "eyes": {name: PLAIN["eyes"][name] for name in ("driver", "tall")}}
    del few["variants"]
    with open(requests.path("full.json"), "w", encoding="utf-8") as file:
        json.dump(PLAIN if is_whole else few, file)
    done = subprocess.run([requests.program, "review", "full.json", "-o", "out", "--quiet"],
                          cwd=requests.folder, capture_output=True, text=True,
                          timeout=TIMEOUT_S, preexec_fn=lambda: resource.setrlimit(
                              resource.RLIMIT_FSIZE, (0, 0)))
    report.claim(is_refusal(done.returncode, done.stderr, 4) and
                 not os.path.exists(requests.path("out")),
                 f"no room at all: status {done.returncode}: {done.stderr}")


def main(program, step):
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        requests = Requests(program, folder)
        write_files(requests)
        check_whole(report, requests)
        check_keys(report, requests, step)
        check_names(report, requests)
        check_files(report, requests)
        check_pictures(report, requests)
        check_explain(report, requests)
        check_moments(report, requests)
        check_marks(report, requests)
        check_output(report, requests)
        check_full(report, requests, step == 1)
    report.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[-1], 1 if "--all" in sys.argv else 53))
