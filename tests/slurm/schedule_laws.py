# SPDX-License-Identifier: Apache-2.0
"""schedule_laws.py -- the simulated schedule against what can be said without one: waves of
equal parts, shared cores, launches in a row, bounds for any parts, what a dead node costs.
"""
import math
import os
import random
import sys

from schedule import Job, Nodes, Schedule, Trouble, simulate

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402


def claim_close(report, found, wanted, what):
    report.claim(math.isclose(found, wanted, rel_tol=1e-9), f"{what}: {found}, not {wanted}")


def check_waves(report):
    """Equal parts run in waves, each with a start of its own, which waits for the tick."""
    for parts in (1, 2, 7, 12, 13):
        for count in (1, 2, 3, 12, 40):
            job = Job([10.0] * parts, start=2, tick=2.5, merge=4)
            wanted = math.ceil(parts / count) * 12.5 + 4
            claim_close(report, simulate(job, Nodes(count)).seconds, wanted,
                        f"{parts} parts on {count} nodes")


def check_cores(report):
    """Three nodes of two cores do the work of two; one node has one core at most."""
    job = Job([10.0] * 12)
    for count, cores, wanted in ((3, 2, 60), (2, 2, 60), (1, 2, 120), (12, 3, 40),
                                 (3, 1.5, 80)):
        claim_close(report, simulate(job, Nodes(count, cores)).seconds, wanted,
                    f"{count} nodes of {cores} cores")


def check_launches(report):
    """A scheduler that starts one part a second keeps the last of 100 nodes waiting for 99."""
    found = simulate(Job([30.0] * 100, launch=1), Nodes(100))
    claim_close(report, found.seconds, 130, "launches in a row, the first after one")
    found = simulate(Job([30.0] * 100, launch=1, tick=8), Nodes(100))
    claim_close(report, found.seconds, 136, "the last at the tick after 100: from 104 to 134")


def check_bounds(report):
    """Any parts: no sooner than the work allows, or the longest part; no later than Graham's
    bound for lists, (2 - 1/m) of the best."""
    chance = random.Random(5)
    for count in (1, 2, 5, 16):
        for _ in range(20):
            work = [chance.expovariate(0.1) for _ in range(chance.randrange(1, 60))]
            found = simulate(Job(work), Nodes(count))
            least = max(sum(work) / count, max(work))
            report.claim(least * (1 - 1e-12) <= found.seconds <= least * (2 - 1 / count) + 1e-9,
                         f"{len(work)} parts on {count} nodes: {found.seconds} of {least}")
            claim_close(report, found.core_s, sum(work), "work is neither lost nor made")


def check_spread(report):
    """The mean of the spread is the work; slow nodes add their share. 4 standard errors."""
    count = 40000
    for trouble, mean, square in (
            (Trouble(spread=0.3), 1, math.exp(0.09) - 1),
            (Trouble(slow_share=0.1, slow_factor=3), 1.2, 0.1 * 0.9 * 4)):
        found = sum(Schedule(Job([1.0] * count), Nodes(1), trouble, 3).left) / count
        report.claim(abs(found - mean) < 4 * math.sqrt(square / count),
                     f"{trouble}: a mean of {found}, not {mean}")


class OneDeath(Schedule):
    """One node dies, when it is told to."""
    when = 35.0

    def plan_death(self):
        if not self.deaths and not self.now:
            self.at(self.when, self.die)


def check_death(report):
    """35 s into a part of 100 after a start of 2: 33 s of samples, 30 kept, 5 s to do again."""
    trouble = Trouble(repair=600, requeue=120, kept_every=10)
    found = OneDeath(Job([100.0], start=2), Nodes(1), trouble, 0).run()
    claim_close(report, found.seconds, 35 + 600 + 2 + 70, "alone, it waits for the node")
    claim_close(report, found.lost_s, 5, "what is done again")
    claim_close(report, found.core_s, 35 + 72, "work with what is done again")
    found = OneDeath(Job([100.0], start=2), Nodes(1), Trouble(repair=0, requeue=120), 0).run()
    claim_close(report, found.seconds, 35 + 120 + 102, "nothing kept, and it waits its turn")


def check_deaths(report):
    """So many deaths as their rate says, in the mean; every part is done. Nodes that work all
    of the time, and are back at once."""
    rate, total, seconds = 1 / 400, 0, 0.0
    for seed in range(40):
        trouble = Trouble(deaths=rate, repair=0, requeue=0, kept_every=1e-9)
        found = simulate(Job([100.0] * 50), Nodes(5), trouble, seed)
        total, seconds = total + found.deaths, seconds + found.core_s
    wanted = seconds * rate
    report.claim(abs(total - wanted) < 4 * math.sqrt(wanted), f"{total} deaths, not {wanted}")


def check_repeats(report):
    trouble = Trouble(0.2, 0.05, 3, 1e-4)
    runs = [simulate(Job([50.0] * 80, start=3), Nodes(7), trouble, seed) for seed in (1, 1, 2)]
    report.claim(runs[0] == runs[1] != runs[2], f"seeds: {runs}")


def main():
    report = Report()
    for check in (check_waves, check_cores, check_launches, check_bounds, check_spread,
                  check_death, check_deaths, check_repeats):
        check(report)
    report.finish()


if __name__ == "__main__":
    main()
