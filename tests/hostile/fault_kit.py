# SPDX-License-Identifier: Apache-2.0
"""fault_kit.py -- runs the program under faults: limits, other users, small and read-only
disks; and says what every outcome must be: the status, one clear line, nothing left behind.
"""
import ctypes
import os
import resource
import signal
import subprocess
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "structure"), os.path.join(ROOT, "tests", "image")]

TIMEOUT_S = 120
NOBODY = 65534
SANITIZERS = ("AddressSanitizer", "runtime error:", "LeakSanitizer", "ThreadSanitizer")
CLONE_NEWNS, MS_RDONLY, MS_REMOUNT, MS_BIND, MS_REC, MS_PRIVATE = (
    0x20000, 1, 32, 4096, 16384, 1 << 18)


class Disks:
    """A mount namespace of our own, where the process may have one: small and read-only disks
    that vanish with it."""

    def __init__(self):
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.are_there = os.geteuid() == 0 and self.libc.unshare(CLONE_NEWNS) == 0 \
            and self._mount("none", "/", None, MS_REC | MS_PRIVATE, None)
        self.mounted = []

    def _mount(self, source, target, kind, flags, options):
        def text(word):
            return word.encode() if word else None
        return self.libc.mount(text(source), text(target), text(kind), ctypes.c_ulong(flags),
                               text(options)) == 0

    def small(self, folder, kilobytes):
        """A disk of so many kilobytes; False where there cannot be one."""
        os.makedirs(folder, exist_ok=True)
        if not self.are_there or not self._mount("tmpfs", folder, "tmpfs", 0,
                                                 f"size={kilobytes}k,mode=0777"):
            return False
        self.mounted.append(folder)
        return True

    def read_only(self, folder):
        """What stands in the folder stays as it is."""
        done = self.are_there and self._mount(folder, folder, None, MS_BIND, None) \
            and self._mount(None, folder, None, MS_BIND | MS_REMOUNT | MS_RDONLY, None)
        if done:
            self.mounted.append(folder)
        return done

    def release(self):
        for folder in reversed(self.mounted):
            self.libc.umount2(folder.encode(), 2)
        self.mounted = []


def tree(folder):
    """Every name below a folder with its size, temporary ones included."""
    return sorted((os.path.relpath(os.path.join(at, name), folder),
                   os.lstat(os.path.join(at, name)).st_size)
                  for at, folders, names in os.walk(folder) for name in names + folders)


class Bench:
    """The program, a folder of its own, and where claims are counted."""

    def __init__(self, report, program, folder):
        self.report, self.program, self.folder = report, os.path.abspath(program), folder
        self.disks = Disks()
        # fontconfig keeps what it has read until the end: not ours, and not growing
        with open(self.file("lsan"), "w") as file:
            file.write("leak:libfontconfig\n")
        os.environ["LSAN_OPTIONS"] = f"suppressions={self.file('lsan')}:print_suppressions=0"
        self.is_sanitized = b"__asan_init" in open(self.program, "rb").read()

    def file(self, *names):
        return os.path.join(self.folder, *names)

    def run(self, *arguments, limits=(), user=None, enter=None, timeout=TIMEOUT_S,
            **more):
        """A finished run; returncode "hang" after the timeout, negative when a signal ended it.
        limits: (resource, value) pairs; enter: what the new process does first."""
        def prepare():
            if enter:
                enter()
            for which, value in limits:
                resource.setrlimit(which, (value, value))
            signal.signal(signal.SIGPIPE, signal.SIG_DFL)
            if user is not None:
                os.setgroups([])
                os.setgid(user)
                os.setuid(user)
        more.setdefault("stdout", subprocess.PIPE)
        try:
            done = subprocess.run([self.program, *arguments], stderr=subprocess.PIPE,
                                  timeout=timeout, preexec_fn=prepare, **more)
        except subprocess.TimeoutExpired:
            done = subprocess.CompletedProcess([self.program, *arguments], "hang", b"", b"")
        done.stdout = (done.stdout or b"").decode("utf-8", "replace")
        done.stderr = (done.stderr or b"").decode("utf-8", "replace")
        return done

    def render(self, *arguments, out="frame.exr", size="8x8", spp=1, **more):
        return self.run("render", *arguments, "-o", self.file(out), "--size", size, "--spp",
                        str(spp), "--threads", "1", "--quiet", **more)

    # ---- claims ---------------------------------------------------------------------------

    def claim(self, holds, message):
        return self.report.claim(holds, message)

    def name_of(self, done):
        return " ".join(word.replace(self.folder + os.sep, "") for word in done.args[1:])

    def claim_sound(self, done, what=""):
        """No crash, no hang, no word of a sanitizer: the one thing that always holds."""
        bad = any(word in done.stderr + done.stdout for word in SANITIZERS)
        return self.claim(done.returncode in (0, 1, 2, 3, 4, 129, 130, 143) and not bad,
                          f"{what or self.name_of(done)}: ends with {done.returncode}: "
                          f"{done.stderr.strip()[:600]}")

    def fails(self, done, status, *words, what="", warnings=False):
        """The status, and one line of ours that holds the words."""
        lines = [line for line in done.stderr.splitlines()
                 if not (warnings and "warning: " in line)]
        return self.claim_sound(done, what) and self.claim(
            done.returncode == status and len(lines) == 1
            and lines[0].startswith("parhelion: ") and all(word in lines[0] for word in words),
            f"{what or self.name_of(done)}: status {done.returncode} instead of {status}, or "
            f"not one line with {words}: {done.stderr.strip()[:400]}")

    def works(self, done, *words, what=""):
        """Status 0, and every word in what it says; without words it says nothing."""
        return self.claim_sound(done, what) and self.claim(
            done.returncode == 0 and all(word in done.stderr for word in words)
            and (bool(words) or not done.stderr),
            f"{what or self.name_of(done)}: status {done.returncode} instead of 0, or says "
            f"otherwise than {words}: {done.stderr.strip()[:400]}")

    def leaves(self, before, folder, what):
        """Nothing was made and nothing changed there."""
        after = tree(folder)
        return self.claim(after == before,
                          f"{what}: left {sorted(set(after) ^ set(before))[:4]}")
