# SPDX-License-Identifier: Apache-2.0
"""serial.py PROGRAM WORD... -- how much of a command's work one thread does alone, and how long
the command would take with 16 and 64 cores. Every few milliseconds the processor time of all its
threads is read (Linux); while it grows by less than one and a half times the clock, one thread
works alone. That part is kept as it is, all other work is divided by the cores: memory's
speed and unequal ends of pieces are left out, so the times are the least there can be. To be
called on a quiet machine of two cores or more, and it says how busy the cores were.
"""
import subprocess
import sys
import time

TICK_S, ALONE, CORES = 0.004, 1.5, (16, 64)


def clock_of(pid):
    """The clock of all its threads' processor time, those that have ended too: clock_getcpuclockid
    for another process, as Linux numbers such clocks (CPUCLOCK_SCHED)."""
    return (~pid << 3) | 2


def main(words):
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    begun = before = time.monotonic()
    done, alone_s, idle_s, shared = 0.0, 0.0, 0.0, 0.0
    while process.poll() is None:
        time.sleep(TICK_S)
        try:
            now, all_s = time.monotonic(), time.clock_gettime(clock_of(process.pid))
        except OSError:
            break
        worked, step = max(all_s - done, 0), now - before
        if worked < ALONE * step:
            alone_s += worked
            idle_s += max(step - worked, 0)
        else:
            shared += worked
        before, done = now, max(all_s, done)
    clock = time.monotonic() - begun
    if process.wait():
        sys.exit(f"serial.py: {words[0]} failed with status {process.returncode}")
    work = alone_s + shared
    print(f"clock {clock:.2f} s, processors {work:.2f} s, one thread alone {alone_s:.2f} s "
          f"({100 * alone_s / work:.1f} % of the work), nobody {idle_s:.2f} s")
    for cores in CORES:
        print(f"{cores} cores: {alone_s + idle_s + shared / cores:.2f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
