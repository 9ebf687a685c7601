# SPDX-License-Identifier: Apache-2.0
"""schedule.py -- how long a shared job takes, simulated: parts that wait for nodes, nodes that
share one machine's cores, parts that take longer than others, nodes that die and come back, and
the merge at the end. Events in order of time; no clock of this machine is read.

Every running part goes on at the same speed (1, or less where nodes share cores). So what is
left of each is kept as the amount of common progress at which it ends, and the next to end is
always the least one.
"""
import dataclasses
import heapq
import itertools
import math
import random


@dataclasses.dataclass
class Job:
    """Seconds, of a node that has its cores for itself."""
    work: list              # of each part, without its start
    start: float = 0        # before a part's first sample; again by a part that goes on
    tick: float = 0         # the scheduler looks what may begin at whole multiples of it
    launch: float = 0       # least time between two launches: the scheduler's own speed
    merge: float = 0


@dataclasses.dataclass
class Nodes:
    count: int
    cores: float = math.inf  # of the one machine that all of them are; inf: each has its own


@dataclasses.dataclass
class Trouble:
    spread: float = 0       # standard deviation of the logarithm of a part's time
    slow_share: float = 0   # of the parts that meet a slow node
    slow_factor: float = 1  # by which it is slow
    deaths: float = 0       # a node and second
    repair: float = 600     # s until a dead node is back
    requeue: float = 120    # s until its part may run again
    kept_every: float = 60  # s of work between two checkpoints


@dataclasses.dataclass
class Outcome:
    seconds: float          # from the job's submission to the merged frame
    parts_s: float          # to the last part's end
    core_s: float           # that nodes have worked on parts
    lost_s: float           # of these, what was done again
    deaths: int


@dataclasses.dataclass
class Running:
    part: int
    begun: float            # common progress at its first step
    work: float             # with its start


class Schedule:
    def __init__(self, job, nodes, trouble, seed):
        self.job, self.nodes, self.trouble = job, nodes, trouble
        self.random = random.Random(seed)
        self.now = self.progress = self.last_launch = 0.0
        self.core_s = self.lost_s = 0.0
        self.deaths = self.done = 0
        self.left = [work * self.factor() for work in job.work]
        self.waiting = list(range(len(job.work)))  # a heap: the least index first
        self.idle = list(range(nodes.count))       # another
        self.running, self.ends, self.events = {}, [], []
        self.order = itertools.count()
        self.plan_death()

    def factor(self):
        """Of a part's work: 1 in the mean of the spread, and what a slow node makes of it."""
        spread = self.trouble.spread
        value = math.exp(self.random.gauss(-spread * spread / 2, spread)) if spread else 1
        slow = self.random.random() < self.trouble.slow_share
        return value * (self.trouble.slow_factor if slow else 1)

    # ---- time -------------------------------------------------------------------------------

    def speed(self):
        return min(1, self.nodes.cores / len(self.running)) if self.running else 1

    def advance(self, to):
        self.progress += (to - self.now) * self.speed()
        self.now = to

    def at(self, time, act, *facts):
        heapq.heappush(self.events, (time, next(self.order), act, facts))

    def next_end(self):
        """When the first running part ends; parts that were lost are forgotten."""
        while self.ends and self.running.get(self.ends[0][2]) is not self.ends[0][3]:
            heapq.heappop(self.ends)
        if not self.ends:
            return math.inf
        return self.now + max(0, self.ends[0][0] - self.progress) / self.speed()

    def next_tick(self, time):
        tick = self.job.tick
        return math.ceil(time / tick - 1e-9) * tick if tick else time

    # ---- what happens -----------------------------------------------------------------------

    def hand_out(self):
        while self.waiting and self.idle:
            part, node = heapq.heappop(self.waiting), heapq.heappop(self.idle)
            self.last_launch = max(self.now, self.last_launch + self.job.launch)
            self.at(self.next_tick(self.last_launch), self.begin, part, node)

    def begin(self, part, node):
        running = Running(part, self.progress, self.job.start + self.left[part])
        self.running[node] = running
        heapq.heappush(self.ends, (self.progress + running.work, next(self.order), node,
                                   running))

    def finish(self):
        _, _, node, running = heapq.heappop(self.ends)
        del self.running[node]
        self.core_s += running.work
        self.done += 1
        heapq.heappush(self.idle, node)

    def plan_death(self):
        rate = self.trouble.deaths * self.nodes.count
        if rate:
            self.at(self.now + self.random.expovariate(rate), self.die)

    def die(self):
        """A node that is idle, launching or dead already is spared: it costs nothing here."""
        self.plan_death()
        node = self.random.randrange(self.nodes.count)
        running = self.running.pop(node, None)
        if not running:
            return
        self.deaths += 1
        worked = self.progress - running.begun
        kept = max(0, worked - self.job.start)
        if self.trouble.kept_every:
            kept -= kept % self.trouble.kept_every
        self.core_s += worked
        self.lost_s += worked - kept
        self.left[running.part] -= kept
        self.at(self.now + self.trouble.requeue, heapq.heappush, self.waiting, running.part)
        self.at(self.now + self.trouble.repair, heapq.heappush, self.idle, node)

    def run(self):
        while self.done < len(self.left):
            self.hand_out()
            end, event = self.next_end(), self.events[0][0] if self.events else math.inf
            self.advance(min(end, event))
            if end <= event:
                self.finish()
            else:
                _, _, act, facts = heapq.heappop(self.events)
                act(*facts)
        seconds = self.next_tick(self.now) + self.job.merge
        return Outcome(seconds, self.now, self.core_s, self.lost_s, self.deaths)


def simulate(job, nodes, trouble=Trouble(), seed=0):
    return Schedule(job, nodes, trouble, seed).run()
