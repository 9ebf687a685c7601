# SPDX-License-Identifier: Apache-2.0
"""A seated person as solids: shirt, trousers, head, hair, hands and shoes in a given posture.

Metres; x to the right from the person's middle, y up, z to the rear. Lengths are those of a
man of middle size as handbooks of ergonomics round them: 0.65 m from hip joint to eye, 0.30 and
0.26 m of arm, 0.44 and 0.42 m of leg, 0.49 m across the shoulders.
"""
import math

import numpy as np

from solids import beyond, chain, common, egg, joined, limb, smooth_table, without

# Along the spine from the hip joints: distance; how far forward; half width, half depth.
TRUNK = np.array(
    [
        [-0.080, -0.005, 0.140, 0.090],
        [0.000, 0.000, 0.170, 0.118],
        [0.110, 0.010, 0.158, 0.116],
        [0.200, 0.008, 0.150, 0.108],
        [0.300, 0.002, 0.158, 0.112],
        [0.365, 0.004, 0.168, 0.117],
        [0.420, -0.004, 0.162, 0.104],
        [0.460, -0.014, 0.120, 0.078],
        [0.500, -0.020, 0.074, 0.058],
    ]
)
WAIST = 0.135  # where the trousers end, along the spine
UPPER_ARM, FOREARM = 0.300, 0.262  # shoulder to elbow to wrist


class Grip:
    """A fist about a rod: its middle, the rod's direction towards the thumb, where the back of
    the hand looks and where the wrist lies, and the rod's radius; `closed` where there is no
    rod in it."""

    def __init__(self, middle, along, outward, toward, radius, closed=False):
        self.middle = np.asarray(middle, float)
        self.along = np.asarray(along, float) / np.linalg.norm(along)
        self.outward = np.asarray(outward, float)
        self.outward -= self.along * (self.outward @ self.along)
        self.outward /= np.linalg.norm(self.outward)
        self.toward = np.cross(self.along, self.outward)
        if self.toward @ np.asarray(toward, float) < 0:
            self.toward = -self.toward
        self.radius, self.closed = radius, closed

    def at(self, radius, degrees, along):
        """A point about the rod: 0 degrees outward, 90 towards the wrist."""
        a = math.radians(degrees)
        return (
            self.middle
            + radius * (math.cos(a) * self.outward + math.sin(a) * self.toward)
            + along * self.along
        )

    def wrist(self):
        return self.at(self.radius + 0.074, 66.0, -0.012)


def hand(p, grip):
    r, wrist = grip.radius, grip.wrist()
    fingers, palm = None, None
    for i, (along, thick, reach) in enumerate(
        ((0.031, 0.0086, 0), (0.010, 0.0090, 8), (-0.011, 0.0086, 2), (-0.031, 0.0076, -14))
    ):
        ring = r + thick
        joints = [
            grip.at(ring + 0.008, 36, along),
            grip.at(ring + 0.008, -44 - 0.5 * reach, along),
            grip.at(ring + 0.002, -112 - reach, along),
            grip.at(ring + 0.001, -164 - reach, along),
        ]
        one = chain(p, joints, [thick * 1.12, thick * 1.04, thick, thick * 0.86], 0.004)
        fingers = one if fingers is None else joined(fingers, one, 0.0085)
        bone = limb(p, joints[0], wrist + 0.35 * along * grip.along, 0.0125, 0.0165)
        palm = bone if palm is None else joined(palm, bone, 0.014)
    thumb = chain(
        p,
        [
            wrist + 0.014 * grip.along,
            grip.at(r + 0.030, 92, 0.034),
            grip.at(r + 0.0125, 118, 0.050),
            grip.at(r + 0.0100, 150, 0.066),
        ],
        [0.0165, 0.0145, 0.0112, 0.0092],
        0.010,
    )
    if grip.closed:
        ends = [grip.middle + 0.032 * s * grip.along for s in (-1, 1)]
        fingers = joined(fingers, limb(p, *ends, r, r), 0.010)
    return joined(joined(palm, fingers, 0.010), thumb, 0.012)


def elbow(shoulder, wrist, drop):
    """Where two bones of the arm's lengths meet, bent towards `drop`."""
    reach = wrist - shoulder
    length = min(np.linalg.norm(reach), 0.998 * (UPPER_ARM + FOREARM))
    unit = reach / np.linalg.norm(reach)
    along = (UPPER_ARM**2 - FOREARM**2 + length**2) / (2 * length)
    side = np.asarray(drop, float) - unit * (unit @ np.asarray(drop, float))
    side /= np.linalg.norm(side)
    return shoulder + along * unit + math.sqrt(UPPER_ARM**2 - along**2) * side


class Figure:
    """posture: hip (y, z), lean_deg, eye (y, z), grips {-1: left, 1: right}, drops {side: ...},
    legs {side: (knee, ankle)}, forward {side: how far the shoulder follows the arm}."""

    def __init__(self, posture):
        self.posture = posture
        lean = math.radians(posture["lean_deg"])
        self.hip = np.array([0.0, *posture["hip"]])
        self.spine = np.array([0.0, math.cos(lean), math.sin(lean)])
        self.front = np.array([0.0, math.sin(lean), -math.cos(lean)])
        self.eye = np.array([0.0, *posture["eye"]])
        self.arms = {}
        for side, grip in posture["grips"].items():
            shoulder = self.on_spine(0.428, posture["forward"][side])
            shoulder[0] = 0.180 * side
            wrist = grip.wrist()
            self.arms[side] = (shoulder, elbow(shoulder, wrist, posture["drops"][side]), wrist)

    def on_spine(self, along, forward=0.0):
        return self.hip + along * self.spine + forward * self.front

    def trunk(self, p, more=0.0):
        q = p - self.hip
        along, forward = q @ self.spine, q @ self.front
        rows = smooth_table(along, TRUNK)
        a, b = rows[:, 1] + more, rows[:, 2] + more
        u, v = p[:, 0] / a, (forward - rows[:, 0]) / b
        side = (((np.abs(u) + 1e-9) ** 2.3 + (np.abs(v) + 1e-9) ** 2.3) ** (1 / 2.3) - 1.0) * b
        ends = np.maximum(along - TRUNK[-1, 0], TRUNK[0, 0] - along)
        return common(side, ends, 0.06)

    def folds(self, p):
        """Cloth hangs: shallow waves across the arms and the waist, deeper where it is bent."""
        depth = np.full(len(p), 0.0006)
        for _, bend, _ in self.arms.values():
            depth += 0.0035 * np.exp(-((np.linalg.norm(p - bend, axis=1) / 0.085) ** 2))
        along = (p - self.hip) @ self.spine
        depth += 0.0028 * np.exp(-(((along - 0.19) / 0.06) ** 2))
        x, y, z = p.T
        wave = (
            np.sin(95 * y + 34 * x + 2.2 * np.sin(31 * z + 17 * x))
            + np.sin(88 * z - 41 * y + 2.0 * np.sin(37 * x + 11 * y))
            + 0.7 * np.sin(120 * x + 50 * y - 40 * z)
        )
        return depth * wave

    def sleeve(self, p, side, more=0.0):
        shoulder, bend, wrist = self.arms[side]
        top = self.on_spine(0.452, -0.028) + (0.050 * side, 0, 0)
        cuff = bend + 0.93 * (wrist - bend)
        d = chain(
            p,
            [top, shoulder, bend, wrist],
            [0.058 + more, 0.063 + more, 0.049 + more, 0.033 + more],
            0.045,
        )
        return common(d, beyond(p, cuff, wrist - bend), 0.008)

    def shirt(self, p):
        d = self.trunk(p)
        for side in self.arms:
            d = joined(d, self.sleeve(p, side), 0.055)
        foot = beyond(p, self.on_spine(0.03), -self.spine)
        return common(d + self.folds(p), foot, 0.02)

    def cuffs(self, p, side):
        _, bend, wrist = self.arms[side]
        d = self.sleeve(p, side, 0.0035)
        return common(d, beyond(p, bend + 0.72 * (wrist - bend), bend - wrist), 0.005)

    def neck_line(self):
        """Where the neck leaves the shirt, and the way it goes."""
        start = self.on_spine(0.500, -0.004)
        end = self.eye + (0, -0.085, 0.095)
        return start, (end - start) / np.linalg.norm(end - start)

    def collar(self, stations=44):
        """A collar that stands and folds over, as rings (stations, 2, n, 3): its outer and its
        inner face from the foot of the stand over the fold to the fall's edge."""
        start, way = self.neck_line()
        front = np.cross(way, (1.0, 0, 0))
        front = front if front[2] < 0 else -front
        right = np.array([1.0, 0, 0])
        # outward and along the neck, m: the face towards the neck, then the one under the fold
        faces = np.array(
            [
                [[2, 0, -2, -3, 0, 6, 11, 17, 23], [-14, 4, 20, 32, 39, 40, 34, 20, 4]],
                [[7, 4, 2, 1, 2, 5, 8, 13, 19], [-14, 4, 20, 30, 34, 35, 30, 18, 4]],
            ]
        ).swapaxes(1, 2)
        rings = []
        for turn in np.linspace(0.10, 2 * math.pi - 0.10, stations):
            gap = min(turn, 2 * math.pi - turn)
            point = 1 + 0.9 * math.exp(-((gap / 0.40) ** 2))
            s = faces * 0.001
            s[:, 6:, 1] -= (point - 1) * np.array([0.004, 0.012, 0.022])
            s[:, 6:, 0] += (point - 1) * np.array([0.000, 0.003, 0.006])
            lower = 0.013 * (0.5 + 0.5 * math.cos(turn))
            outward = math.sin(turn) * right + math.cos(turn) * front
            rings.append(
                start
                + (s[..., :1] + 0.0650 + 0.005 * math.cos(turn) ** 2) * outward
                + (s[..., 1:] - lower) * way
            )
        return np.array(rings)

    def placket(self, p):
        """The doubled cloth down the front that carries the buttons."""
        q = p - self.hip
        slab = np.abs(p[:, 0]) - 0.016
        d = self.shirt(p)
        d = common(common(d - 0.0030, -0.016 - d, 0.005), slab, 0.004)
        d = common(d, 0.04 - q @ self.front, 0.01)
        along = q @ self.spine
        return common(d, np.maximum(along - 0.450, 0.10 - along), 0.006)

    def trousers(self, p):
        d = self.trunk(p, 0.006)
        for side, (knee, ankle) in self.posture["legs"].items():
            hip = self.hip + (0.092 * side, 0.004, 0.0)
            leg = chain(p, [hip, knee, ankle], [0.096, 0.068, 0.054], 0.09)
            leg = common(leg, beyond(p, ankle, np.subtract(ankle, knee)), 0.01)
            d = joined(d, leg, 0.03)
        x, y, z = p.T
        wave = 0.0014 * np.sin(70 * z + 30 * x + 2 * np.sin(25 * y)) * np.sin(40 * x + 20 * y)
        top = beyond(p, self.on_spine(WAIST), self.spine)
        return common(d + wave, top, 0.010)

    def belt(self, p):
        along = (p - self.hip) @ self.spine
        return common(self.trunk(p, 0.010), np.abs(along - WAIST + 0.016) - 0.017, 0.006)

    def skull(self, p, more=0.0):
        return egg(p, self.eye + (0, 0.034, 0.086), np.array([0.076, 0.092, 0.098]) + more)

    def head(self, p):
        e = self.eye
        d = joined(self.skull(p), egg(p, e + (0, -0.040, 0.046), (0.061, 0.074, 0.062)), 0.03)
        d = joined(d, egg(p, e + (0, -0.096, 0.008), (0.026, 0.020, 0.020)), 0.03)
        nose = limb(p, e + (0, 0.004, -0.008), e + (0, -0.040, -0.024), 0.0075, 0.0115)
        start, _ = self.neck_line()
        neck = limb(p, start, e + (0, -0.070, 0.098), 0.060, 0.056)
        mouth = limb(p, e + (-0.018, -0.071, -0.010), e + (0.018, -0.071, -0.010), 0.006, 0.006)
        for side in (-1, 1):
            brow = limb(
                p,
                e + (0.012 * side, 0.019, -0.010),
                e + (0.046 * side, 0.020, 0.004),
                0.009,
                0.008,
            )
            d = joined(d, brow, 0.012)
            socket = egg(p, e + (0.031 * side, -0.001, -0.020), (0.017, 0.012, 0.017))
            d = without(d, socket, 0.01)
            d = joined(d, egg(p, e + (0.031 * side, -0.001, 0.004), (0.013,) * 3), 0.005)
            ear = egg(p, e + (0.079 * side, -0.012, 0.094), np.array([0.010, 0.031, 0.018]))
            d = joined(d, ear, 0.008)
        d = joined(d, nose, 0.012)
        d = joined(d, mouth, 0.012)
        return joined(d, neck, 0.03)

    def hair(self, p):
        e, x, y, z = self.eye, *(p - self.eye).T
        line = -(0.72 * (y - 0.062) + 0.69 * (z + 0.006)) + 0.12 * np.abs(x)
        nape = egg(p, e + (0, -0.010, 0.104), np.array([0.072, 0.080, 0.082]))
        cap = joined(self.skull(p, 0.008), nape, 0.03)
        return common(cap, line, 0.012)

    def glove(self, p, side):
        """A hand and the part of the arm that the sleeve covers."""
        _, bend, wrist = self.arms[side]
        arm = limb(p, bend + 0.70 * (wrist - bend), wrist, 0.029, 0.0235)
        return joined(hand(p, self.posture["grips"][side]), arm, 0.018)

    def shoe(self, p, side):
        knee, ankle = (np.asarray(v, float) for v in self.posture["legs"][side])
        heel, ball = ankle + (0, -0.062, 0.030), ankle + (0, -0.064, -0.120)
        turn = self.posture.get("toes", {}).get(side, (0.0, 0.0, 0.0))
        ball = ball + turn
        toe = ball + 0.5 * (ball - heel) * (1, 1, 1) * 0.5
        d = chain(p, [heel, ball, toe], [0.036, 0.042, 0.032], 0.03)
        d = joined(d, limb(p, ankle + (0, 0.01, 0), ankle + (0, -0.05, 0), 0.040, 0.036), 0.03)
        return d
