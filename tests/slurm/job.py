# SPDX-License-Identifier: Apache-2.0
"""job.py PARHELION -- a frame that is shared by `render --slurm N` and done by plain commands
is the file of one run, byte for byte: whoever did its parts, in what order, twice, killed or
stopped meanwhile; and what is damaged, missing or of something else is told of in one line.
Slurm itself is asked by cluster.py.
"""
import contextlib
import copy
import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from jobs import ISA, PATIENCE_S, Report, Work, contents

# Without guiding but for one job of check_cuts: its lesson takes longer than such a frame.
FRAME = ("--size", "52x36", "--no-guiding", "--layers", "all", *ISA)
SMALL = (*FRAME, "--spp", "12")
LONG_RUN = ("--size", "96x64", "--no-guiding", "--spp", "96", *ISA)
LONG = (*LONG_RUN, "--checkpoint-interval", "0")
HALF = 48  # samples a pixel of one of its two parts


def check_plain(work):
    """Six parts over three processes, from a folder whose name a shell would trip over."""
    report, job = work.report, "it's a %a job"
    work.share(6, *SMALL, job=job)
    report.claim(not os.path.exists(work.path("frame.exr")), "--slurm renders")
    code, status = work.status(job)
    report.claim(code == 1 and status["missing"] == 6 and not status["complete"]
                 and not status["output_is_there"], f"before any part: {code} {status}")
    manifest = json.loads(contents(work.path(job, "manifest.json")))
    report.claim([part["samples"] for part in manifest["parts"]] ==
                 [[2 * i, 2 * i + 2] for i in range(6)], f"parts: {manifest['parts']}")
    work.claim_line(work.run("merge", job), 3, "6 of 6 parts are not done", "parhelion part ",
                    " 0; ", " 3; and so on", f"`parhelion status {job}`")
    with open(work.path(job, "commands.txt"), encoding="utf-8") as commands:
        done = subprocess.run(["xargs", "-L", "1", "-P", "3", "env"], stdin=commands, cwd="/",
                              capture_output=True, text=True, timeout=PATIENCE_S)
    report.claim(done.returncode == 0, f"xargs: {done.stderr}")
    code, status = work.status(job)
    report.claim(code == 0 and status["done"] == 6 and status["complete"], f"after: {status}")
    report.claim(sorted(os.path.basename(name) for name in glob.glob(
        os.path.join(glob.escape(work.path(job)), "part-*"))) ==
        [f"part-{i:04}.exr" for i in range(6)], f"left: {os.listdir(work.path(job))}")
    work.claim_whole(job, SMALL, "six parts")
    parts = [contents(name) for name in sorted(glob.glob(work.path("it*", "part*.exr")))]
    work.claim_whole(job, SMALL, "merged again")
    report.claim(parts == [contents(name) for name in
                           sorted(glob.glob(work.path("it*", "part*.exr")))], "merge and parts")
    again = work.run("render", "small.gltf", "-o", "frame.exr", "--slurm", "6", "--job", job,
                     *SMALL)
    report.claim(again.returncode == 0 and ", as before" in again.stdout
                 and work.status(job)[0] == 0, f"planned again: {again.stdout}{again.stderr}")
    there = work.run("part", job, "3", "--json")
    report.claim(json.loads(there.stdout)["was_there"], f"a part twice: {there.stdout}")
    shutil.rmtree(work.path(job))


def do_all(work, job, cwd="/"):
    count = work.status(job)[1]["parts"]
    for i in range(count):
        done = work.run("part", work.path(job), str(i), "--quiet", cwd=cwd)
        work.report.claim(done.returncode == 0, f"{job}, part {i}: {done.stderr}")


def check_cuts(work):
    """Other cuts, of frames that are parts themselves too."""
    for name, count, options, how in (
            ("rows", 5, SMALL, ("--split", "rows")),
            ("one", 1, SMALL, ()),
            ("late", 3, (*FRAME, "--samples", "2:12"), ()),
            ("window", 4, (*SMALL, "--crop", "3,5,40,30"), ("--split=rows",)),
            ("word", 2, ("--size=52x36", "--spp=5", *ISA), ("--threads", "1"))):
        do_all(work, work.share(count, *options, *how, job=name))
        work.claim_whole(name, options, f"{name}: {count} parts")
        shutil.rmtree(work.path(name))


def newest(names):
    """When the newest file of this pattern was written, 0 without one."""
    times = [0]
    for name in glob.glob(names):
        with contextlib.suppress(OSError):
            times.append(os.stat(name).st_mtime_ns)
    return max(times)


def wait_for(names, running, before=0):
    """Until a file of this pattern is written: then the task hears signals."""
    end = time.time() + PATIENCE_S
    while newest(names) <= before and running.poll() is None and time.time() < end:
        time.sleep(0.02)


def check_stopped(work):
    """Killed, then stopped by TERM, then gone on: the same bits."""
    report = work.report
    job = work.share(2, *LONG, job="stopped")
    kept = work.path(job, "part-0000.*.checkpoint")
    samples = [0]
    for number, wanted in ((signal.SIGKILL, -9), (signal.SIGTERM, 143)):
        before = newest(kept)
        running = work.start("part", job, "0")
        wait_for(kept, running, before)
        part = work.status(job)[1]["list"][0]
        report.claim(part["state"] == "running" and part["worker"].endswith(f"-{running.pid}")
                     or running.poll() is not None, f"at work: {part}")
        running.send_signal(number)
        err = running.communicate(timeout=PATIENCE_S)[1]
        code, status = work.status(job)
        part = status["list"][0]
        report.claim(running.returncode == wanted, f"{number}: {running.returncode} {err}")
        report.claim(code == 1 and part["state"] == "begun" and part["worker"] is None
                     and samples[-1] <= part["samples_kept"] < HALF and part["samples_kept"]
                     and len(glob.glob(kept)) == 1, f"after {number}: {part} {glob.glob(kept)}")
        report.claim(not os.path.exists(work.path(job, "part-0000.exr")),
                     f"after {number}: a partial file")
        samples.append(part["samples_kept"])
    so_far = f"after {samples[-1]} of {HALF}"
    report.claim(f"stopped: part 0: stopped by TERM {so_far} samples" in err
                 and part["command"] in err, f"TERM: {err}")
    text = work.run("status", job).stdout
    report.claim(f"part 0: begun, {samples[-1]} of {HALF} samples a pixel are kept" in text,
                 f"status: {text}")
    foreign = work.path(job, "part-0001.somebody-1.checkpoint")
    shutil.copy(glob.glob(kept)[0], foreign)
    with open(work.path(job, "part-0001.somebody-2.checkpoint"), "wb") as file:
        file.write(contents(foreign)[:5000])
    report.claim(work.states(job) == ["begun", "missing"], "another part's checkpoint counts")
    done = work.run("part", job, "0")
    report.claim(done.returncode == 0 and f"goes on {so_far}" in done.stderr,
                 f"going on: {done.stderr}")
    check_twice_at_once(work, job)
    work.claim_whole(job, LONG_RUN, "killed, stopped, gone on")
    report.claim(not glob.glob(work.path(job, "*checkpoint*")), "checkpoints are left")
    shutil.rmtree(work.path(job))


def check_twice_at_once(work, job):
    """An orphan and its successor: both end well, one file."""
    running = [work.start("part", job, "1") for _ in range(2)]
    ends = [(one.communicate(timeout=PATIENCE_S)[1], one.returncode) for one in running]
    work.report.claim([code for _, code in ends] == [0, 0], f"twice at once: {ends}")
    states = work.states(job)
    work.report.claim(states == ["done", "done"], f"twice at once: {states}")


# ---- what is wrong ---------------------------------------------------------------------------

def check_damage(work):
    """Files that are cut off, changed, or of something else."""
    report = work.report
    job = work.share(2, *SMALL, job="damage")
    do_all(work, job)
    first, second = work.path(job, "part-0000.exr"), work.path(job, "part-0001.exr")
    sound = contents(first)
    for size in (0, 3, 200, len(sound) // 3, len(sound) - 40):
        with open(first, "wb") as file:
            file.write(sound[:size])
        code, status = work.status(job)
        part = status["list"][0]
        report.claim(code == 1 and part["state"] == "failed" and "part-0000.exr" in
                     part["error"], f"cut to {size}: {part}")
        work.claim_line(work.run("merge", job), 3, "1 of 2 parts are not done", "part")
        done = work.run("part", job, "0", "--quiet")
        report.claim(done.returncode == 0 and "it is done again" in done.stderr
                     and contents(first) == sound, f"cut to {size}: {done.stderr}")
    # In the middle of the sums: only who reads all of them finds it.
    place = sound.rindex(b"film\0") if b"film\0" in sound else 0
    middle = (max(place, len(sound) // 2) + len(sound)) // 2
    with open(first, "wb") as file:
        file.write(sound[:middle] + bytes(255 - b for b in sound[middle:middle + 20])
                   + sound[middle + 20:])
    done = work.run("merge", job)
    work.claim_line(done, 3, "part-0000.exr", "make it again")
    done = work.run("part", job, "0")
    report.claim(done.returncode == 0 and contents(first) == sound, f"damaged: {done.stderr}")
    shutil.copy(first, second)
    work.claim_line(work.run("merge", job), 3, "1 of 2")
    report.claim("is another part of the frame" in work.status(job)[1]["list"][1]["error"],
                 "a part under another's name")
    work.run("render", "small.gltf", "-o", second, *FRAME, "--samples", "6:12", "--seed",
             "2", "--quiet")
    report.claim("is a part of another frame" in work.status(job)[1]["list"][1]["error"],
                 "a part of another frame")
    shutil.rmtree(work.path(job))


def check_failures(work):
    """A scene that is gone, and one that is another; a disk that is full."""
    report, scene = work.report, work.path("small.gltf")
    job = work.share(2, *SMALL, job="failing")
    os.rename(scene, scene + ".away")
    done = work.run("part", job, "1")
    work.claim_line(done, 3, "small.gltf")
    part = work.status(job)[1]["list"][1]
    report.claim(part["state"] == "failed" and part["status"] == 3
                 and part["error"] == done.stderr.strip(), f"a failure is kept: {part}")
    text = contents(scene + ".away")
    with open(scene, "wb") as file:
        file.write(text + b"\n")
    work.claim_line(work.run("part", job, "0"), 3, "failing: part 0: was planned for something "
                    "else: input 0: small.gltf", "plan the job again")
    os.rename(scene + ".away", scene)
    line = f"ulimit -f 2; exec '{work.program}' part {job} 0 --quiet"
    full = subprocess.run(["sh", "-c", line],
                          capture_output=True, text=True, cwd=work.folder)
    work.claim_line(full, 4, "part-0000.exr", "cannot be written")
    report.claim([part["status"] for part in work.status(job)[1]["list"]] == [4, 3],
                 "statuses of failures")
    do_all(work, job)
    work.claim_whole(job, SMALL, "after failures")
    report.claim(work.run("status", job).stdout.endswith(
        "2 of 2 parts done\n" + work.path("frame.exr") + " is there\n"), "status of the end")
    shutil.rmtree(work.path(job))


WRONG = [("format", "panel", "is 'panel'"), ("version", 2, "is 2, required: 1"),
         ("parts", [], "has 0 values"), ("parts", {}, "required: an array"),
         ("parts", [7], "required: an object"), ("words", ["a", 1], "required: a text"),
         ("words", "a", "required: an array"), ("program", "bin/a", "required: a path from the "
                                                                  "root"),
         ("folder", "here", "required: a path from the root"), ("size", [4], "required: 2"),
         ("size", [52.5, 36], "whole"), ("keeps_sums", 1, "true or false"),
         ("identity", 5, "required: a text"), ("outptu", 1, "unknown key")]
WRONG_PARTS = [("index", 1, "required: 0"), ("samples", [3, 3], "required: a range"),
               ("samples", [0], "required: 2"), ("samples", [0, 1.5], "whole"),
               ("crop", [0, 0, 53, 36], "inside the frame of 52x36"),
               ("crop", [0, 0, 0, 36], "inside the frame"), ("file", None, "'file' is missing")]


def check_manifests(work):
    """Folders that are no job's, and manifests of any fault: one line from each command."""
    job = work.share(2, *SMALL, job="manifests")
    path = work.path(job, "manifest.json")
    text = contents(path)
    sound = json.loads(text)

    def claim(words):
        for command in (("status", job), ("part", job, "0"), ("merge", job)):
            work.claim_line(work.run(*command), 3, *words)

    for size in (0, 1, 100, len(text) // 2, len(text) - 3):
        with open(path, "wb") as file:
            file.write(text[:size])
        claim(["manifest.json", "JSON"])
    wrong = [(lambda root: root, *row) for row in WRONG]
    wrong += [(lambda root: root["parts"][0], *row) for row in WRONG_PARTS]
    wrong += [(lambda root: root, key, None, f"'{key}' is missing") for key in sound
              if key not in ("format", "version")]
    for place, key, value, words in wrong:
        document = copy.deepcopy(sound)
        if value is None:
            del place(document)[key]
        else:
            place(document)[key] = value
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        claim(["manifest.json", words])
    os.remove(path)
    claim([f"{job}: is no folder of a job", "manifest.json", "--slurm N"])
    shutil.rmtree(work.path(job))
    for command in (("status", job), ("part", job, "0"), ("merge", job)):
        work.claim_line(work.run(*command), 2 if command[0] == "merge" else 3, "")


FOREIGN_WORDS = (("--help",), ("-V",), ("--help=man",), ("--version",), ("-o", "elsewhere.exr"),
                 ("-o=elsewhere.exr",), ("--png", "a.png"), ("--live=a.exr",),
                 ("--replay", "1,1,1"), ("--slurm", "2"), ("--job", "a"), ("--submit",),
                 ("--checkpoint", "c"), ("--resume",), ("--samples", "0:1"), ("--spp", "4"),
                 ("--crop", "0,0,4,4"), ("--noise", "0.1"), ("--threads=2",), ("--json",),
                 ("--quiet",), ("--progress", "none"), ("--false-colour", "luminance"))


def check_foreign_words(work):
    """A manifest that somebody else wrote: words that `--slurm` does not leave there are
    refused by their place, wherever they stand, and nothing is made."""
    job, report = work.share(2, *SMALL, job="foreign"), work.report
    path = work.path(job, "manifest.json")
    sound = json.loads(contents(path))
    for words in FOREIGN_WORDS:
        for place in (0, len(sound["words"])):
            document = copy.deepcopy(sound)
            document["words"][place:place] = words
            with open(path, "w", encoding="utf-8") as file:
                json.dump(document, file)
            before = sorted(os.listdir(work.folder))
            done = work.run("part", job, "0")
            work.claim_line(done, 3, "manifest.json", f"/words/{place}", "`--slurm` lets")
            report.claim(not done.stdout and sorted(os.listdir(work.folder)) == before,
                         f"{words} at {place}: {done.stdout} {os.listdir(work.folder)}")
    document = copy.deepcopy(sound)
    document["words"] += ["--", "--help"]  # a scene of that name
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)
    work.claim_line(work.run("part", job, "0"), 3, "--help", "cannot be opened")
    shutil.rmtree(work.path(job))


def check_foreign_output(work):
    """`merge` alone writes over the job's own frame and nothing else; -o says otherwise."""
    job, report = work.share(2, *SMALL, job="other"), work.report
    do_all(work, job)
    work.run("render", "small.gltf", "-o", "older.exr", *FRAME, "--seed", "2", "--spp", "1",
             "--quiet")
    with open(work.path("mine.exr"), "wb") as file:
        file.write(b"no frame at all")
    path = work.path(job, "manifest.json")
    sound = json.loads(contents(path))
    for name in ("mine.exr", "older.exr", os.path.join(job, "part-0001.exr")):
        before = contents(work.path(name))
        with open(path, "w", encoding="utf-8") as file:
            json.dump({**sound, "output": name}, file)
        work.claim_line(work.run("merge", job), 4, name)
        report.claim(contents(work.path(name)) == before, f"merge writes over {name}")
    before = contents(work.path(job, "part-0000.exr"))
    work.claim_line(work.run("merge", job, "-o", work.path(job, "part-0000.exr")), 4, "part-0")
    report.claim(contents(work.path(job, "part-0000.exr")) == before, "merge -o of a part")
    done = work.run("merge", job, "-o", "older.exr")
    report.claim(done.returncode == 0, f"merge -o: {done.stderr}")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({**sound, "output": "older.exr"}, file)
    again = work.run("merge", job)
    report.claim(again.returncode == 0, f"the job's own frame: {again.stderr}")
    shutil.rmtree(work.path(job))


def check_schema(work):
    try:
        import jsonschema
    except ImportError:
        work.report.skip("a manifest against its schema: python3-jsonschema is not installed")
        return
    job = work.share(3, *SMALL, job="schema")
    schema = json.loads(work.run("schema", "job").stdout)
    check = jsonschema.validators.validator_for(schema)(schema)
    sound = json.loads(contents(work.path(job, "manifest.json")))
    work.report.claim_none("a manifest", [error.message for error in check.iter_errors(sound)])
    for key, value, _ in WRONG:
        work.report.claim(not check.is_valid({**sound, key: value}), f"it takes {key} {value}")
    shutil.rmtree(work.path(job))


def check_lines(work):
    """What does not go with --slurm, and what goes with it alone."""
    line = ("render", "small.gltf", "-o", "refused.exr", *SMALL)
    for more, word in ((("--noise", "0.1"), "--noise"), (("--png", "a.png"), "--png"),
                       (("--live", "b.exr"), "--live"),
                       (("--checkpoint", "c"), "--checkpoint"), (("--resume",), "--resume"),
                       (("--replay", "1,1,1"), "--replay"), (("--slurm", "0"), "--slurm"),
                       (("--slurm", "13"), "only 12 samples"),
                       (("--slurm", "37", "--split", "rows"), "only 36 rows")):
        slurm = () if "--slurm" in more else ("--slurm", "3")
        work.claim_line(work.run(*line, *slurm, *more), 2, word)
    for alone in (("--submit",), ("--job", "a"), ("--split", "rows")):
        work.claim_line(work.run(*line, *alone), 2, alone[0], "add --slurm N")
    work.report.claim(not glob.glob(work.path("refused*")), "something is left")
    job = work.share(3, *SMALL, job="lines")
    for index in ("3", "-1", "x", "1.5", "0x1", "99999999999999999999"):
        work.claim_line(work.run("part", job, "--", index), 2, "required: a number from 0 to 2")
    work.claim_line(work.run(*line[:2], "-o", "f.exr", "--slurm", "3", "--job", job, *SMALL,
                             "--seed", "3"), 4, "holds another job: seed: 0 there, 3 here")
    work.claim_line(work.run(*line, "--slurm", "4", "--job", job), 4, "holds another job: 3 "
                    "parts of `parhelion render small.gltf")
    os.mkdir(work.path("mine"))
    open(work.path("mine", "letter"), "w", encoding="utf-8").close()
    work.claim_line(work.run(*line, "--slurm", "4", "--job", "mine"), 4, "holds letter")
    work.claim_line(work.run(*line, "--slurm", "4", "--job", "small.gltf"), 4, "small.gltf")
    work.claim_line(work.run(*line, "--slurm", "4", "--job", "no/where"), 4, "no/where")
    work.claim_line(work.run(*line, "--slurm", "4", "--job", 'a"b'), 2, "quotes")
    work.claim_line(work.run("merge", job, job, "-o", "f.exr"), 2, "is a folder")
    for name in (job, 'a"b', "mine"):
        shutil.rmtree(work.path(name))


# ---- the scripts, without Slurm --------------------------------------------------------------

def write_tool(work, name, text):
    path = work.path("tools", name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\n" + text)
    os.chmod(path, 0o755)


def with_tools(work):
    return {"PATH": work.path("tools") + os.pathsep + os.environ["PATH"]}


def check_submit(work):
    """sbatch is run twice, and only when asked for; what it says wrong is one line."""
    report, tools = work.report, with_tools(work)
    write_tool(work, "squeue", "exit 0\n")
    write_tool(work, "sbatch", 'echo "$*" >>../submitted\necho warning: busy >&2\n'
                               'echo "4$(wc -l <../submitted);cluster"\n'.replace(
                                   "../submitted", work.path("submitted")))
    work.share(3, *SMALL, job="sent", **tools)
    report.claim(not os.path.exists(work.path("submitted")), "it submits unasked")
    done = work.run("render", "small.gltf", "-o", "frame.exr", "--slurm", "3", "--job", "sent",
                    "--submit", "--json", *SMALL, **tools)
    answer, sent = json.loads(done.stdout), contents(work.path("submitted")).decode()
    report.claim((answer["array_job"], answer["merge_job"]) == ("41", "42")
                 and answer["was_there"], f"--submit: {answer}")
    report.claim(sent == "--parsable {0}/array.sbatch\n--parsable --dependency=afterany:41 "
                 "{0}/merge.sbatch\n".format(work.path("sent")), f"--submit: {sent}")
    line = ("render", "small.gltf", "-o", "frame.exr", "--slurm", "3", "--job", "sent", *SMALL,
            "--submit")
    write_tool(work, "sbatch", "echo sbatch: error: no such partition >&2; exit 1\n")
    work.claim_line(work.run(*line, **tools), 3, "is ready, but not submitted: sbatch failed",
                    "no such partition", "by hand: J=$(sbatch --parsable", "afterany:${J%%;*}")
    write_tool(work, "sbatch", "echo Submitted batch job\n")
    work.claim_line(work.run(*line, **tools), 3, "gave no number of a job")
    os.remove(work.path("submitted"))
    check_again(work, line)
    os.remove(work.path("tools", "sbatch"))
    work.claim_line(work.run(*line, PATH=work.path("tools")), 3, "sbatch cannot be started",
                    "by hand")
    report.claim(work.status("sent")[0] == 1, "the folder stays")
    shutil.rmtree(work.path("sent"))


def check_again(work, line):
    """`status` tells what Slurm has, and a second --submit hands it what nobody does yet."""
    report, tools = work.report, with_tools(work)
    shutil.copy(work.path("small.gltf"), work.path("frame.exr"))  # older than its parts
    note = work.path("submitted")
    write_tool(work, "sbatch", f'echo "$*" >>{note}\necho "5$(wc -l <{note})"\n')

    def again(queue, *words, **counts):
        write_tool(work, "squeue", f"case \"$*\" in *{job}*) printf '{queue}' ;; esac\n")
        status = json.loads(work.run("status", "sent", "--json", **tools).stdout)
        found = {key: status[key] for key in counts}
        report.claim(found == counts and status["merge_job"] == merge, f"{queue}: {status}")
        if os.path.exists(note):
            os.remove(note)
        done = work.run(*line, "--json", **tools)
        report.claim(done.returncode == 0, f"{queue}: {done.stderr}")
        sent = contents(note).decode().splitlines() if os.path.exists(note) else []
        wanted = [f"--parsable {word}" for word in words]
        report.claim([one.replace(work.path("sent") + "/", "") for one in sent] == wanted,
                     f"{queue}: {sent}, required: {wanted}")
        return json.loads(done.stdout)
    job, merge = "--jobs=41,41,42", "42"
    answer = again("41_0 RUNNING\\n41_1 PENDING\\n42 PENDING\\n", "--array=2 array.sbatch",
                   "--dependency=afterany:51:41 merge.sbatch", running=1, queued=1, missing=1)
    report.claim((answer["submitted"], answer["array_job"], answer["merge_job"]) ==
                 (1, "51", "52"), f"what is missing: {answer}")
    job, merge = "--jobs=41,41,51,42,52", "52"
    again("41_0 RUNNING\\n51_2 COMPLETING\\n41_1 REQUEUED\\n52 PENDING\\n99_1 RUNNING\\n"
          "51_3 RUNNING\\n51_x RUNNING\\n", running=2, queued=1, missing=0)
    text = work.run("status", "sent", **tools).stdout
    report.claim("Slurm's job 41, 51; merged by 52, queued\n" in text
                 and "part 0: running\n" in text and "part 1: queued\n" in text, text)
    again("41_1 RUNNING\\n41_2 COMPLETED\\n", "--array=0,2 array.sbatch",
          "--dependency=afterany:51:41 merge.sbatch", running=1, queued=0, missing=2)
    do_all(work, "sent")
    job, merge = "--jobs=41,41,51,51,42,52,52", "52"
    again("", "merge.sbatch", done=3, missing=0)
    work.merge("sent")
    job, merge = "--jobs=41,41,51,51,42,52,52,51", "51"
    again("", done=3)
    os.remove(work.path("frame.exr"))
    os.remove(work.path("sent", "part-0001.exr"))
    write_tool(work, "squeue", "echo slurm_load_jobs error >&2; exit 1\n")
    work.claim_line(work.run(*line, **tools), 3, "is ready, but not submitted: what Slurm has "
                    "of it is not known: squeue failed: slurm_load_jobs error", "by hand")
    report.claim(not os.path.exists(note), "it submits what may be queued")
    text = work.run("status", "sent", **tools).stdout
    report.claim("merged by 51, unknown\n" in text and "slurm_load_jobs error" in text, text)
    write_tool(work, "squeue", "exit 0\n")


NODES = (("avx2,ib\navx512f,ib", "avx2"), ("AVX512\ngpu,avx512vl", "avx512"),
         ("(null)", "avx2"), ("sse4_2\navx512", "sse2"), ("x86-64-v4\nx86-64-v3", "avx2"),
         ("avx", "sse2"),
         ("avx2,avx512", "avx512"), ("cascadelake\navx512", "avx2"), ("noavx512", "avx2"))
SETS = ["sse2", "avx2", "avx512"]


def check_choice(work):
    """The least instruction set of the nodes on which Slurm would run it, if this machine has
    it; without Slurm the machine's best; a job keeps its own, and --isa is obeyed."""
    report, tools = work.report, with_tools(work)
    small = tuple(word for word in SMALL if word not in ISA)
    best = work.run("--version").stdout.partition("instruction set: ")[2].split()[0]

    def choose(*options, **more):
        shutil.rmtree(work.path("choice"), ignore_errors=True)
        work.share(2, *small, *options, job="choice", **tools, **more)
        return json.loads(contents(work.path("choice", "manifest.json")))["isa"]
    write_tool(work, "sinfo", "echo no controller >&2; exit 1\n")
    report.claim(choose() == best, "without Slurm")
    if best not in SETS:
        return
    for features, least in NODES:
        write_tool(work, "sinfo", f"printf '{features}\\n'\n")
        chosen, wanted = choose(), SETS[min(SETS.index(least), SETS.index(best))]
        report.claim(chosen == wanted, f"nodes of {features!r}: {chosen}, required: {wanted}")
    write_tool(work, "sinfo",
               'case "$*" in *--partition=old) echo sse ;; *) echo avx512 ;; esac')
    report.claim(choose(SBATCH_PARTITION="old") == "sse2", "a partition of its own")
    work.share(2, *small, job="choice", **tools)
    report.claim(json.loads(contents(work.path("choice", "manifest.json")))["isa"] == "sse2",
                 "planned again: another set")
    report.claim(choose("--isa", "sse2") == "sse2", "--isa is not obeyed")
    shutil.rmtree(work.path("choice"))
    os.remove(work.path("tools", "sinfo"))


def check_machine(work):
    """A node without the job's instruction set: status 5, and Slurm's task goes elsewhere."""
    report = work.report
    job = work.share(2, *SMALL, job="machine")
    path = work.path(job, "manifest.json")
    document = json.loads(contents(path))
    with open(path, "w", encoding="utf-8") as file:
        json.dump({**document, "isa": "avx9"}, file)
    done = work.run("part", job, "0")
    work.claim_line(done, 5, "part 0: was planned for avx9, and ", "this processor and program",
                    "--isa that all have")
    part = work.status(job)[1]["list"][0]
    report.claim((part["state"], part["status"]) == ("failed", 5), f"status: {part}")
    code, requeued, err = run_task(work, job, 0, "RUNNING")
    report.claim((code, requeued) == (5, "requeue 70_0\nupdate JobId=70_0 ExcNodeList=n1,n7\n"),
                 f"another node: {code} {requeued} {err}")
    code, requeued, err = run_task(work, job, 0, "COMPLETING")
    report.claim((code, requeued) == (5, ""), f"a cancelled one: {code} {requeued} {err}")
    shutil.rmtree(work.path(job))


def run_task(work, job, index, state, stop=False):
    """(exit status, requeued?) of array.sbatch as Slurm would run it."""
    kept = work.path(job, f"part-{index:04}.*.checkpoint") if stop else None
    return run_script(work, work.path(job, "array.sbatch"), state, kept,
                      SLURM_ARRAY_JOB_ID="70", SLURM_ARRAY_TASK_ID=str(index))


def run_script(work, script, state, kept=None, **more):
    """The same of any; with `kept` it gets TERM as soon as such a file is written."""
    note = work.path("requeued")
    write_tool(work, "squeue", f'case "$*" in *%x*) echo n1 ;; *) echo {state} ;; esac\n')
    write_tool(work, "scontrol", f'echo "$*" >>{note}\n')
    if os.path.exists(note):
        os.remove(note)
    before = newest(kept) if kept else 0
    task = subprocess.Popen(["sh", script], cwd="/", text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env={**os.environ, **with_tools(work), "SLURM_JOB_ID": "77",
                                 "SLURMD_NODENAME": "n7", "SLURM_CPUS_PER_TASK": "1", **more})
    if kept:
        wait_for(kept, task, before)
        task.send_signal(signal.SIGTERM)
    err = task.communicate(timeout=PATIENCE_S)[1]
    requeued = contents(note).decode() if os.path.exists(note) else ""
    return task.returncode, requeued, err


def check_script(work):
    """The batch script: TERM reaches the render once, and only what may end well comes back."""
    report = work.report
    job = work.share(2, *LONG, job="script")
    for state, wanted in (("COMPLETING", ""), ("RUNNING", "requeue 70_0\n")):
        code, requeued, err = run_task(work, job, 0, state, stop=True)
        report.claim((code, requeued) == (143, wanted),
                     f"TERM, {state}: {code} {requeued} {err}")
    report.claim(work.states(job)[0] == "begun", f"TERM: {work.status(job)[1]}")
    os.rename(work.path("small.gltf"), work.path("away.gltf"))
    code, requeued, err = run_task(work, job, 1, "RUNNING")
    report.claim((code, requeued) == (3, ""), f"a failure: {code} {requeued} {err}")
    os.rename(work.path("away.gltf"), work.path("small.gltf"))
    for index in range(2):
        code, requeued, err = run_task(work, job, index, "RUNNING")
        report.claim((code, requeued) == (0, ""), f"the end: {code} {requeued} {err}")
    done = subprocess.run(["sh", work.path(job, "merge.sbatch")], cwd="/", text=True,
                          capture_output=True)
    report.claim(done.returncode == 0, f"merge.sbatch: {done.stderr}")
    report.claim(contents(work.path("frame.exr")) == work.whole(*LONG_RUN),
                 "scripts: not the bytes of one run")
    shutil.rmtree(work.path(job))


def main():
    report = Report()
    with tempfile.TemporaryDirectory(prefix="job-") as folder:
        work = Work(sys.argv[1], os.path.realpath(folder), report)
        for check in (check_plain, check_cuts, check_stopped, check_script, check_damage,
                      check_failures, check_choice, check_machine, check_manifests,
                      check_foreign_words, check_foreign_output, check_schema, check_lines,
                      check_submit):
            check(work)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
