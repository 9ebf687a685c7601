# SPDX-License-Identifier: Apache-2.0
"""review_job.py PARHELION -- a review that is shared by `review --slurm N` and done by plain
commands has the files of one run, byte for byte: whoever did its parts, in what order, twice,
killed or stopped meanwhile; and what is damaged, missing or of something else is told of in one
line. What jobs have in common is job.py's; Slurm itself is asked by cluster.py.
"""
import copy
import glob
import json
import os
import shutil
import signal
import sys
import tempfile

from jobs import PATIENCE_S, Report, ROOT, Work, contents
from job import newest, run_script, wait_for, write_tool, with_tools

for folder in ("hostile", "image"):
    sys.path.insert(0, os.path.join(ROOT, "tests", folder))
from review import PANEL, moment, request  # noqa: E402
from review_resume import cabin, files_of, sweep  # noqa: E402

LOOSE = {"contrast": 0.05}


def grey(name, luminance):
    return moment(name, type="constant", luminance=luminance)


def of_all_kinds():
    """A moment and a sweep, a gaze that goes elsewhere, a frame."""
    return request(precision=LOOSE, frames={"size": [48, 27], "noise": 0.1, "worst": 1},
                   gaze=[{"at": "symbols"}, {"name": "wall", "direction": [-1, 0, -0.3]}],
                   conditions=[grey("grey", 3000), sweep("suns")])


def of_moments(**members):
    return request(**{"precision": LOOSE, "conditions": [grey("grey", 3000), grey("dim", 30)],
                      **members})


class Reviews(Work):
    """A folder with a small cabin, which is reviewed."""

    def __init__(self, program, folder, report):
        super().__init__(program, folder, report)
        shutil.copy(PANEL, self.path("ips.panel"))
        cabin().write(self.path("dash.gltf"))

    def ask(self, document):
        with open(self.path("r.json"), "w", encoding="utf-8") as file:
            json.dump(document, file)

    def one_run(self, *options):
        """Its files."""
        done = self.run("review", "r.json", "-o", "out", "--quiet", *options)
        self.report.claim(done.returncode in (0, 1), f"one run: {done.stderr}")
        files = files_of(self.path("out"))
        shutil.rmtree(self.path("out"))
        return files

    def share_review(self, count, *options, job="out.parts"):
        done = self.run("review", "r.json", "-o", "out", "--slurm", str(count), "--job", job,
                        *options)
        self.report.claim(done.returncode == 0, f"--slurm {count}: {done.stderr}")
        return job

    def do_parts(self, job, order):
        for i in order:
            done = self.run("part", self.path(job), str(i), "--quiet", cwd="/")
            self.report.claim(done.returncode == 0, f"{job}, part {i}: {done.stderr}")

    def claim_review(self, job, wanted, what, *options, out="out", status=(0, 1)):
        done = self.run("merge", job, "--quiet", *options)
        if self.report.claim(done.returncode in status, f"{what}: {done.stderr[-400:]}"):
            found = files_of(self.path(out))
            other = sorted(name for name in found.keys() | wanted.keys()
                           if found.get(name) != wanted.get(name))
            self.report.claim(not other, f"{what}: not one run's: {other}")
        shutil.rmtree(self.path(out), ignore_errors=True)
        return done


# ---- the same bytes --------------------------------------------------------------------------

def check_all_kinds(work):
    report = work.report
    work.ask(of_all_kinds())
    wanted = work.one_run("--threads", "2")
    report.claim(any(name.startswith("responses") for name in wanted), "no responses")
    job = work.share_review(3)
    manifest = json.loads(contents(work.path(job, "manifest.json")))
    report.claim((manifest["kind"], len(manifest["parts"]), manifest["words"]) ==
                 ("review", 3, ["r.json"]), f"manifest: {manifest}")
    report.claim(not os.path.exists(work.path("out")), "--slurm reviews")
    work.claim_line(work.run("merge", job), 3, "3 of 3 parts are not done")
    work.do_parts(job, (2, 0))
    code, status = work.status(job)
    report.claim(code == 1 and status["kind"] == "review" and not status["output_is_there"]
                 and [part["state"] for part in status["list"]] ==
                 ["done", "missing", "done"], f"status: {status}")
    work.do_parts(job, (1,))
    parts = {name: contents(name) for name in glob.glob(work.path(job, "part-*"))}
    report.claim(sorted(map(os.path.basename, parts)) ==
                 [f"part-{i:04}.answers" for i in range(3)], f"left: {sorted(parts)}")
    work.claim_review(job, wanted, "three parts")
    report.claim(parts == {name: contents(name) for name in parts}, "merge and parts")
    done = work.run("part", job, "2", "--json")
    report.claim(json.loads(done.stdout)["was_there"], f"a part twice: {done.stdout}")
    shutil.rmtree(work.path(job))


def check_cuts(work):
    """One part, more parts than questions, a folder of responses, an output named elsewhere."""
    work.ask(of_moments())
    wanted = work.one_run()
    for name, count in (("one", 1), ("many", 4)):
        job = work.share_review(count, job=name)
        work.do_parts(job, range(count))
        work.claim_review(job, wanted, f"{count} parts")
        shutil.rmtree(work.path(job))
    job = work.share_review(2, job="it's a %a job")
    work.do_parts(job, (0, 1))
    done = work.run("merge", job, "-o", "other", "--json")
    found = files_of(work.path("other"))
    work.report.claim(json.loads(done.stdout)["pass"] and found["cases.csv"] ==
                      wanted["cases.csv"] and found.keys() == wanted.keys(),
                      f"merge -o: {sorted(found)} {done.stderr}")
    shutil.rmtree(work.path("other"))
    work.claim_line(work.run("merge", job, "--part"), 2, "--part")
    again = work.run("review", "r.json", "-o", "out", "--slurm", "2", "--job", job, "--json")
    work.report.claim(json.loads(again.stdout)["was_there"], f"planned again: {again.stdout}")
    shutil.rmtree(work.path(job))


def check_verdict(work):
    """The merge ends as the review does."""
    work.ask(of_moments(conditions=[grey("glare", 300000)]))
    job = work.share_review(2)
    work.do_parts(job, (0, 1))
    done = work.run("merge", job)
    work.report.claim(done.returncode == 1 and done.stdout.endswith("FAIL\n"),
                      f"a review that fails: {done.returncode} {done.stdout}")
    shutil.rmtree(work.path("out"))
    shutil.rmtree(work.path(job))


def check_stopped(work):
    """Killed, stopped by TERM, gone on; twice at once."""
    report = work.report
    work.ask(of_moments(precision={"contrast": 0.002}))
    wanted = work.one_run()
    job = work.share_review(1)
    kept = work.path(job, "part-0000.*.checkpoint")
    for number, status in ((signal.SIGKILL, -9), (signal.SIGTERM, 143)):
        before = newest(kept)
        running = work.start("part", job, "0")
        wait_for(kept, running, before)
        running.send_signal(number)
        err = running.communicate(timeout=PATIENCE_S)[1]
        report.claim(running.returncode == status, f"{number}: {running.returncode} {err}")
        report.claim(work.status(job)[0] == 1, f"after {number}: it is done")
    report.claim("stopped by TERM" in err and f"part {work.path(job)} 0" in err, f"TERM: {err}")
    running = [work.start("part", job, "0") for _ in range(2)]
    ends = [(one.communicate(timeout=PATIENCE_S)[1], one.returncode) for one in running]
    report.claim([code for _, code in ends] == [0, 0], f"twice at once: {ends}")
    report.claim(not glob.glob(kept), f"left: {glob.glob(kept)}")
    work.claim_review(job, wanted, "killed, stopped, gone on")
    shutil.rmtree(work.path(job))


def check_limit(work):
    """The merge of a review, which traces, comes back when its time is over."""
    work.ask(of_moments())
    job = work.share_review(1)
    script = contents(work.path(job, "merge.sbatch")).decode()
    work.report.claim("#SBATCH --requeue\n#SBATCH --signal=B:TERM@60\n" in script, script)
    write_tool(work, "merging", "sleep 60 & sleeper=$!\ntrap 'kill $sleeper; exit $code' TERM\n"
               f">{work.path('begun')}\nwait\n")
    own = os.path.realpath(work.program)
    work.report.claim(script.count(own) == 1, f"no {own}: {script}")
    with open(work.path("slow.sbatch"), "w", encoding="utf-8") as file:
        file.write(script.replace(own, work.path("tools", "merging")))
    for code, state, requeued in (("143", "RUNNING", "requeue 77\n"), ("1", "RUNNING", ""),
                                  ("143", "COMPLETING", ""), ("4", "RUNNING", "requeue 77\n"),
                                  ("3", "RUNNING", "")):
        ended = run_script(work, work.path("slow.sbatch"), state, work.path("begun"), code=code)
        work.report.claim(ended[:2] == (int(code), requeued), f"merge, {code}: {ended}")
        os.remove(work.path("begun"))
    work.do_parts(job, (0,))
    ended = run_script(work, work.path(job, "merge.sbatch"), "RUNNING")
    work.report.claim(ended[:2] == (0, ""), f"merge: {ended}")
    shutil.rmtree(work.path("out"))
    shutil.rmtree(work.path(job))


# ---- what is wrong ---------------------------------------------------------------------------

def check_damage(work):
    work.ask(of_moments(conditions=[grey("grey", 3000)]))
    wanted = work.one_run()
    job = work.share_review(2)
    work.do_parts(job, (0, 1))
    first = work.path(job, "part-0000.answers")
    sound = contents(first)
    for size in (0, 3, 15, 16, len(sound) // 2, len(sound) - 1):
        with open(first, "wb") as file:
            file.write(sound[:size])
        part = work.status(job)[1]["list"][0]
        work.report.claim(part["state"] == "failed" and "part-0000.answers" in part["error"],
                          f"cut to {size}: {part}")
        work.claim_line(work.run("merge", job), 3, "1 of 2 parts are not done")
    for at in (0, 20, len(sound) // 2, len(sound) - 1):
        with open(first, "wb") as file:
            file.write(sound[:at] + bytes([sound[at] ^ 4]) + sound[at + 1:])
        work.report.claim(work.states(job) == ["failed", "done"], f"changed at {at}")
    shutil.copy(work.path(job, "part-0001.answers"), first)
    work.report.claim(work.states(job) == ["failed", "done"], "a part under another's name")
    done = work.run("part", job, "0", "--quiet")
    work.report.claim(done.returncode == 0 and "it is done again" in done.stderr,
                      f"damaged: {done.stderr}")
    work.claim_review(job, wanted, "after damage")
    shutil.rmtree(work.path(job))


def check_failures(work):
    """A scene that is gone, and one that is another."""
    work.ask(of_moments(conditions=[grey("grey", 3000)]))
    job = work.share_review(2)
    scene = work.path("dash.gltf")
    os.rename(scene, scene + ".away")
    done = work.run("part", job, "1")
    work.claim_line(done, 3, "dash.gltf")
    part = work.status(job)[1]["list"][1]
    work.report.claim((part["state"], part["status"], part["error"]) ==
                      ("failed", 3, done.stderr.strip()), f"a failure is kept: {part}")
    with open(scene, "wb") as file:
        file.write(contents(scene + ".away") + b"\n")
    planned = "is not what the job was planned for"
    work.claim_line(work.run("part", job, "0"), 3, "r.json", "'grey'", planned)
    os.rename(scene + ".away", scene)
    work.do_parts(job, (0, 1))
    work.ask(of_moments(conditions=[grey("grey", 3000)], title="another"))
    work.claim_line(work.run("merge", job), 3, planned)
    work.report.claim(not glob.glob(work.path("out", "*.json")), "half a review is left")
    shutil.rmtree(work.path("out"), ignore_errors=True)
    work.claim_line(work.run("review", "r.json", "-o", "out", "--slurm", "2"), 4,
                    "holds another job")
    shutil.rmtree(work.path(job))


def check_manifests(work):
    job = work.share_review(2)
    path = work.path(job, "manifest.json")
    sound = json.loads(contents(path))
    wrong = [("kind", "film", "there are frame, review"), ("kind", 1, "required: a text"),
             ("kind", "frame", "'size' is missing"), ("size", [4, 4], "unknown key")]
    wrong += [(key, None, f"'{key}' is missing") for key in sound
              if key not in ("format", "version")]
    for key, value, words in wrong:
        document = copy.deepcopy(sound)
        if value is None:
            del document[key]
        else:
            document[key] = value
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        for command in (("status", job), ("part", job, "0"), ("merge", job)):
            work.claim_line(work.run(*command), 3, "manifest.json", words)
    check_schema(work, sound)
    shutil.rmtree(work.path(job))


def check_schema(work, sound):
    try:
        import jsonschema
    except ImportError:
        work.report.skip("a manifest against its schema: python3-jsonschema is not installed")
        return
    schema = json.loads(work.run("schema", "job").stdout)
    check = jsonschema.validators.validator_for(schema)(schema)
    work.report.claim_none("a manifest", [error.message for error in check.iter_errors(sound)])
    for key, value in (("kind", "film"), ("kind", "frame"), ("size", [4, 4])):
        work.report.claim(not check.is_valid({**sound, key: value}), f"it takes {key} {value}")


def check_lines(work):
    line = ("review", "r.json", "-o", "out")
    for alone in (("--submit",), ("--job", "a")):
        work.claim_line(work.run(*line, *alone), 2, alone[0], "add --slurm N")
    work.claim_line(work.run(*line, "--slurm", "2", "--dry-run"), 2, "--dry-run")
    work.claim_line(work.run("review", "--init", "new.json", "dash.gltf", "--slurm", "2"), 2,
                    "--init")
    work.claim_line(work.run("review", "r.json", "--slurm", "2"), 2, "-o DIR")
    for count in ("0", "-1", "1.5", "x", "100001"):
        work.claim_line(work.run(*line, "--slurm", count), 2, "--slurm")
    write_tool(work, "sbatch", 'echo "4$(echo "$*" | wc -w)"\n')
    done = work.run(*line, "--slurm", "2", "--submit", "--json", **with_tools(work))
    answer = json.loads(done.stdout)
    work.report.claim((answer["array_job"], answer["merge_job"], answer["split"]) ==
                      ("42", "43", "questions"), f"--submit: {answer}")
    shutil.rmtree(work.path("out.parts"))


def main():
    report = Report()
    with tempfile.TemporaryDirectory(prefix="review-job-") as folder:
        work = Reviews(sys.argv[1], os.path.realpath(folder), report)
        for check in (check_all_kinds, check_cuts, check_verdict, check_stopped, check_limit,
                      check_damage, check_failures, check_manifests, check_lines):
            check(work)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
