# SPDX-License-Identifier: Apache-2.0
"""review_resume.py [--all] [--kills N] PARHELION -- a review that is killed, stopped or starved
goes on with the next condition, to the very files that it would have made, and its responses
serve the next one; so do reviews of some conditions each that are merged. Until its verdicts
stand, an earlier one in the same folder stays as it was. --kills: how many SIGKILLs at random
moments (default 1). --all: reviews after damage, TERM, a full disk, too.
"""
import argparse
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from review import PANEL, dashboard, moment, request  # noqa: E402
from running import Running  # noqa: E402

FILE_LIMIT = 20000  # bytes: room for what a review finds, none for its page
PATIENCE_S = 300
PICTURE = {"size": [400, 225], "noise": 0.3, "worst": 1}
STOPS = [0.1, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9]  # shares of the work of one that is not stopped
STOP_S = 2                                   # of two threads


def cabin():
    """The niche closed but for a strip of sky, so that few directions are asked."""
    scene = dashboard()
    wall = scene.lambert(0.5)
    scene.quad(wall, [0.6, -0.3, 1.2], [0, 0.8, 0], [0, 0, -1.3])
    scene.quad(wall, [-0.6, -0.3, 1.2], [0, 0.8, 0], [1.2, 0, 0])
    scene.quad(wall, [-0.6, -0.3, -0.1], [1.2, 0, 0], [0, 0.8, 0])
    scene.quad(wall, [-0.6, 0.5, 0.2], [1.2, 0, 0], [0, 0, -0.3])
    scene.quad(wall, [-0.6, 0.5, 1.2], [1.2, 0, 0], [0, 0, -0.6])
    return scene


def sweep(name):
    return {"name": name, "sweep": {"sun": {"azimuth_deg": [0, 90, 30],
                                            "elevation_deg": [60, 72, 12]}, "sky": "sky"}}


def document(*names):
    return request(precision={"contrast": 0.05},
                   frames={"size": [48, 27], "noise": 0.1, "worst": 1},
                   conditions=[moment("grey", type="constant", luminance=3000),
                               *[sweep(name) for name in names]])


def files_of(folder):
    """What must be the same; what is not finished stands apart."""
    found = {}
    for at, _, names in os.walk(folder):
        for name in names:
            path = os.path.relpath(os.path.join(at, name), folder)
            if path != "run.json":
                with open(os.path.join(at, name), "rb") as file:
                    found[path] = file.read()
    return found


def is_of_review(path):
    return not path.startswith(("unfinished", "responses"))


class Work(Running):
    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder
        super().__init__()
        shutil.copy(PANEL, self.path("ips.panel"))
        cabin().write(self.path("dash.gltf"))
        self.ask(document("suns"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def ask(self, what):
        with open(self.path("r.json"), "w", encoding="utf-8") as file:
            json.dump(what, file)

    def words(self, *options):
        output = () if "-o" in options else ("-o", "out")
        return [self.program, "review", "r.json", *output, "--quiet", *options]

    def start(self, *options):
        self.started.append(subprocess.Popen(self.words(*options), cwd=self.folder, text=True,
                                             stdout=subprocess.PIPE, stderr=subprocess.PIPE))
        return self.started[-1]

    def run(self, *options, **kept):
        return subprocess.run(self.words(*options), cwd=self.folder, capture_output=True,
                              text=True, timeout=PATIENCE_S, **kept)

    def clear(self):
        shutil.rmtree(self.path("out"), ignore_errors=True)

    def files(self):
        return files_of(self.path("out"))

    def reused(self):
        with open(self.path("out", "run.json"), encoding="utf-8") as file:
            return json.load(file)["responses_reused"]

    def claim_whole(self, status, err, wanted, what):
        """Finished, with the files of the reference and nothing left beside them."""
        if not self.report.claim(status in (0, 1), f"{what}: status {status}: {err[-400:]}"):
            return
        found = self.files()
        self.report.claim(found.keys() == wanted.keys(),
                          f"{what}: other files: {sorted(found.keys() ^ wanted.keys())}")
        other = [name for name in found if name in wanted and found[name] != wanted[name]]
        self.report.claim(not other, f"{what}: other bytes: {other}")


# ---- killed and stopped ------------------------------------------------------------------

def reference(work):
    begun = time.monotonic()
    done = work.run("--threads", "2")
    took = time.monotonic() - begun
    work.report.claim(done.returncode in (0, 1), f"not reviewed: {done.stderr}")
    files = work.files()
    responses = [name for name in files if name.startswith("responses")]
    work.report.claim(len(responses) == 2 and "frames/1-suns-eye.exr" in files,
                      f"files: {sorted(files)}")
    return files, took


def check_kills(work, wanted, took, kills):
    work.clear()
    hits = finished = 0
    while hits < kills and finished < 20 * kills:
        running = work.start("--threads", str(random.choice((1, 2, 3))))
        try:
            running.wait(random.uniform(0, took))
        except subprocess.TimeoutExpired:
            running.kill()
        _, err = running.communicate(timeout=PATIENCE_S)
        if running.returncode == -signal.SIGKILL:
            hits += 1
            continue
        work.claim_whole(running.returncode, err, wanted, f"after {hits} kills")
        work.clear()
        finished += 1
    done = work.run()
    work.claim_whole(done.returncode, done.stderr, wanted, f"after all {hits} kills")
    print(f"{hits} kills, {finished + 1} reviews finished, {took:.1f} s the first")


def wait_for_condition(work, running, name="1-grey"):
    """Until it is kept."""
    until = time.monotonic() + PATIENCE_S
    kept = work.path("out", "unfinished", f"{name}.condition")
    while running.poll() is None and time.monotonic() < until and not os.path.exists(kept):
        time.sleep(0.005)
    return kept


def check_next(work, wanted):
    """What is kept is not read again: the file stays as it was written."""
    work.clear()
    running = work.start("--threads", "1")
    kept = wait_for_condition(work, running)
    running.kill()
    running.communicate(timeout=PATIENCE_S)
    written = os.stat(kept).st_mtime_ns
    running = work.start("--threads", "1")
    wait_for_condition(work, running, "2-suns")
    work.report.claim(os.stat(kept).st_mtime_ns == written, "a condition is read again")
    _, err = running.communicate(timeout=PATIENCE_S)
    work.claim_whole(running.returncode, err, wanted, "after a kill between conditions")


# ---- parts -------------------------------------------------------------------------------

def check_merge(work, wanted):
    """A review a condition, one of them twice, in any order: the files of one review."""
    for part in ("suns", "grey", "grey"):
        done = work.run("-o", f"of {part}", "--only", part, "--threads", "1")
        work.report.claim(done.returncode in (0, 1), f"--only {part}: {done.stderr}")
        shutil.copytree(work.path(f"of {part}"), work.path("again"), dirs_exist_ok=True)
    work.clear()
    for parts, status, said in (
            (("of suns",), 3, "r.json: no part has 'grey'"),
            (("of suns", "none"), 3, ""), (("out", "of suns"), 3, ""),
            (("of suns", "again", "of grey"), 0, "")):
        done = subprocess.run([work.program, "merge", *parts, "-o", "out", "--quiet"],
                              cwd=work.folder, capture_output=True, text=True,
                              timeout=PATIENCE_S)
        if status:
            work.report.claim(done.returncode == status and said in done.stderr and
                              done.stderr.count("\n") == 1, f"{parts}: {done.stderr}")
    work.claim_whole(done.returncode, done.stderr, wanted, "merged")


def check_strangers(work):
    """Parts that do not belong together are refused in one line, by name."""
    def merged(what, status, said):
        done = subprocess.run([work.program, "merge", "of suns", what, "-o", "none"],
                              cwd=work.folder, capture_output=True, text=True,
                              timeout=PATIENCE_S)
        work.report.claim(done.returncode == status and said in done.stderr and
                          done.stderr.count("\n") == 1 and
                          not os.path.exists(work.path("none")),
                          f"{what}: status {done.returncode}: {done.stderr}")

    merged("nowhere", 3, "nowhere: cannot be opened: No such folder")
    shutil.copytree(work.path("of suns"), work.path("cut"))
    part = os.path.join(work.path("cut"), "conditions",
                        os.listdir(os.path.join(work.path("cut"), "conditions"))[0])
    os.truncate(part, os.path.getsize(part) // 2)
    merged("cut", 3, "is cut off: has")
    for what, options, status, said in (
            ("of sse2", ("--isa", "sse2"), 5, "was made with sse2"),
            ("strict", ("--strict",), 3, "is of another review than")):
        work.run("-o", what, "--only", "grey", *options)
        merged(what, status, said)
    work.ask(document("suns", "more suns"))
    work.run("-o", "of other", "--only", "grey")
    merged("of other", 3, "is of another review than")
    work.ask(document("suns"))
    done = work.run("--only", "gray")
    work.report.claim(done.returncode == 2 and "did you mean grey?" in done.stderr, done.stderr)


def check_stop(work, wanted):
    """TERM tells how to go on, and a second review in the same folder is refused meanwhile."""
    work.clear()
    running = work.start("--threads", "1")
    wait_for_condition(work, running)
    second = work.run()
    work.report.claim(second.returncode == 4 and "another review is at work" in second.stderr
                      and second.stderr.count("\n") == 1, f"two at once: {second.stderr}")
    running.send_signal(signal.SIGTERM)
    _, err = running.communicate(timeout=PATIENCE_S)
    line = "parhelion: out: stopped by TERM; what is done is kept in out/unfinished — the " \
           "same command goes on: parhelion review r.json -o out"
    work.report.claim(running.returncode == 143 and err.strip() == line,
                      f"TERM: status {running.returncode}: {err}")
    plan = work.run("--dry-run")
    work.report.claim("out/unfinished holds what is done" in plan.stdout, plan.stdout)
    done = work.run()
    work.claim_whole(done.returncode, done.stderr, wanted, "after TERM")


def cpu_s(pid):
    """Of a running process, so that others' load does not count."""
    with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def wait_until(running, seconds):
    """Until it has worked so long."""
    while running.poll() is None and cpu_s(running.pid) < seconds:
        time.sleep(0.01)
    return running.poll() is None


def check_prompt(work):
    """With a picture that is long work, TERM at any moment ends it within STOP_S of work; all
    that it then has goes on to the files of a review that nobody stopped."""
    asked = request(precision={"contrast": 0.05}, frames=PICTURE,
                    conditions=[moment("grey", type="constant", luminance=3000)])
    work.clear()
    work.ask(asked)
    whole = work.start("--threads", "2")
    _, status, used = os.wait4(whole.pid, 0)
    whole.returncode = os.waitstatus_to_exitcode(status)
    wanted, all_s = work.files(), used.ru_utime + used.ru_stime
    stops, slowest = 0, 0
    for share in STOPS:
        work.clear()
        running = work.start("--threads", "2")
        if wait_until(running, share * all_s):
            before = cpu_s(running.pid)
            running.send_signal(signal.SIGTERM)
            _, status, used = os.wait4(running.pid, 0)
            running.returncode = os.waitstatus_to_exitcode(status)
            took = used.ru_utime + used.ru_stime - before
            stops += running.returncode == 143
            slowest = max(slowest, took)
            work.report.claim(running.returncode in (0, 1) or took < STOP_S,
                              f"TERM after {before:.1f} s of {all_s:.1f}: {took:.1f} s more")
        running.communicate(timeout=PATIENCE_S)
    done = work.run()
    work.claim_whole(done.returncode, done.stderr, wanted, f"after {stops} stops")
    work.report.claim(stops >= len(STOPS) / 2, f"only {stops} were stopped")
    print(f"{stops} stops, of {slowest:.1f} s of work at most, of {all_s:.1f} s")
    work.ask(document("suns"))


# ---- responses ---------------------------------------------------------------------------

def check_plan(work):
    """What is there is told: here, in another folder; not when the scene is another one."""
    shutil.copytree(work.path("out", "responses"), work.path("shared"))
    with open(work.path("dash.gltf"), encoding="utf-8") as file:
        scene = file.read()
    for text, options, kept in ((scene, (), 2), (scene, ("--responses", "shared"), 2),
                                (scene, ("--responses", "none"), 0), (scene + "\n", (), 0)):
        with open(work.path("dash.gltf"), "w", encoding="utf-8") as file:
            file.write(text)
        answer = json.loads(work.run("--dry-run", "--json", *options).stdout)
        work.report.claim(answer["responses"] == 2 and answer["responses_reused"] == kept,
                          f"{options}: {answer}, required: {kept}")
    with open(work.path("dash.gltf"), "w", encoding="utf-8") as file:
        file.write(scene)


def check_reuse(work, wanted):
    """The damaged one is replaced, the other one and then both are read."""
    for reused in (1, 2):
        done = work.run()
        work.claim_whole(done.returncode, done.stderr, wanted, "again")
        work.report.claim(work.reused() == reused, f"{work.reused()} responses reused")
        work.report.claim(("it is traced again" in done.stderr) == (reused == 1), done.stderr)


def check_damage(work, wanted):
    """What is not a response of this question is told by its name, and traced again."""
    name = next(name for name in wanted if "face-of" in name)
    other = next(name for name in wanted
                 if name.startswith("responses") and "face-of" not in name)
    bytes_of = wanted[name]
    middle = len(bytes_of) // 2
    for damaged, part in ((bytes_of[:middle], "is cut off"),
                          (bytes_of[:middle] + bytes([bytes_of[middle] ^ 1]) +
                           bytes_of[middle + 1:], "is damaged"),
                          (wanted[other], "is the response of something else: ")):
        with open(work.path("out", name), "wb") as file:
            file.write(damaged)
        plan = work.run("--dry-run", "--json")
        work.report.claim(json.loads(plan.stdout)["responses_reused"] == 1 and
                          f"out/{name}: {part}" in plan.stderr and
                          "it is traced again" in plan.stderr and plan.stderr.count("\n") == 1,
                          f"{part}: {plan.stderr}")


# ---- a full disk -------------------------------------------------------------------------

def limit_files():
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_LIMIT, FILE_LIMIT))


def check_full_disk(work, wanted):
    """The earlier review stays whole; with room again the new one stands in its place."""
    work.ask(document("other suns"))
    done = work.run("--responses", "shared", preexec_fn=limit_files)
    before, now = ({name: data for name, data in files.items() if is_of_review(name)}
                   for files in (wanted, work.files()))
    work.report.claim(done.returncode == 4 and before == now and
                      done.stderr.count("\n") == 1 and
                      "the same command goes on" in done.stderr,
                      f"full disk: status {done.returncode}: {done.stderr}")
    done = work.run("--responses", "shared")
    names = {name for name in work.files() if is_of_review(name)}
    work.report.claim(done.returncode in (0, 1) and
                      "sweeps/1-other-suns-eye-bar.csv" in names and
                      "sweeps/1-suns-eye-bar.csv" not in names, f"{done.stderr}, {names}")
    work.report.claim(not os.path.exists(work.path("out", "unfinished")), "is left unfinished")
    work.ask(document("suns"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--kills", type=int, default=1)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("program")
    given = parser.parse_args()
    report = Report()
    random.seed(given.kills)
    with tempfile.TemporaryDirectory() as folder, Work(report, given.program, folder) as work:
        wanted, took = reference(work)
        check_merge(work, wanted)
        check_plan(work)
        check_damage(work, wanted)
        if given.all:
            check_reuse(work, wanted)
            check_next(work, wanted)
            check_strangers(work)
            check_full_disk(work, wanted)
            check_stop(work, wanted)
            check_prompt(work)
        check_kills(work, wanted, took, given.kills)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
