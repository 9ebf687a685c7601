# SPDX-License-Identifier: Apache-2.0
"""panel_reader_reflection.py -- sections 5, 7, 9 and 15 of a panel file (panel_reader.py)."""
import math

from panel_reader_trees import Bytes, SamplingTree, dot, held, open_tree, rows_of

RIGHT = math.pi / 2


def fresnel(cosine, n):
    behind = math.sqrt(max(0.0, 1 - (1 - cosine * cosine) / (n * n)))
    s = (cosine - n * behind) / (cosine + n * behind)
    p = (n * cosine - behind) / (n * cosine + behind)
    return (s * s + p * p) / 2


def polar(d):
    return math.atan2(math.hypot(d[0], d[1]), d[2])


def from_polar(theta, x, y):
    length = math.hypot(x, y)
    return math.sin(theta) * x / length, math.sin(theta) * y / length, math.cos(theta)


def turned(light, d):
    m = math.hypot(light[0], light[1])
    if m < 1e-6:
        return d
    x, y = -light[0] / m, -light[1] / m
    return x * d[0] + y * d[1], x * d[1] - y * d[0], d[2]


def specular(theta_i, k, d):
    """The stored direction, its azimuth's x and |d0|."""
    theta, across = polar(d), math.hypot(d[0], d[1])
    u = (theta / RIGHT * d[0] / across, theta / RIGHT * d[1] / across) if across else (0, 0)
    offset = min(theta_i / RIGHT, 89 / 90)
    x, y = u[0] - offset, u[1]
    a, b, square = 1 - offset * offset, 2 * x * offset, x * x + y * y
    if not square:
        return (0.0, 0.0, 1.0), 1.0, offset
    root = math.sqrt(b * b + 4 * a * square)
    c = held((b + root) / (2 * a) if b > 0 else 2 * square / (root - b), 0, 1)
    ex, ey = x + c * offset, y
    return (from_polar(RIGHT * c ** (1 / k), ex, ey), ex / math.hypot(ex, ey), offset)


def cubic_weights(x, left, right, u):
    """Of four abscissae; those missing at either side are not read."""
    h = x[2] - x[1]
    w = [0.0, 2 * u ** 3 - 3 * u * u + 1, 3 * u * u - 2 * u ** 3, 0.0]

    def steepness(i):  # of the interval from x[i] on, as weights
        out = [0.0] * 4
        out[i], out[i + 1] = -1 / (x[i + 1] - x[i]), 1 / (x[i + 1] - x[i])
        return out

    def parabola(i):  # slope at the joint of intervals i and i + 1
        before, behind = x[i + 1] - x[i], x[i + 2] - x[i + 1]
        return [(behind * a + before * b) / (before + behind)
                for a, b in zip(steepness(i), steepness(i + 1))]

    own = steepness(1)
    first = parabola(0) if left else None
    second = parabola(1) if right else None
    if first is None and second is None:
        return [0.0, 1 - u, u, 0.0]
    first = first or [2 * a - b for a, b in zip(own, second)]
    second = second or [2 * a - b for a, b in zip(own, first)]
    p, q = h * (u ** 3 - 2 * u * u + u), h * (u ** 3 - u * u)
    return [a + p * b + q * c for a, b, c in zip(w, first, second)]


class Reflection:
    def __init__(self, section, tree, sampling, reach):
        self.tree = open_tree(tree)
        s = Bytes(section)
        (self.incidences, self.azimuths, self.components, self.coefficients,
         self.wavelengths, nodes) = s.take("H", 6)
        _, self.has_mirror, _, _ = s.take("B", 4)
        self.k, self.index, self.cone, mean_step, _ = s.take("f", 5)
        tables, width = self.incidences * self.azimuths, self.wavelengths
        self.incidence, self.azimuth = (s.take("f", n) for n in (self.incidences,
                                                                 self.azimuths))
        self.nm, self.node = s.take("f", width), s.take("f", nodes)
        basis_step, loading_step = s.take("f", self.coefficients), s.take("f", self.components)

        def rows(count, letter, step):
            return rows_of([step * n for n in s.take(letter, count * width)], width)
        self.mean = rows(tables, "h", mean_step)
        self.lambertian = rows(tables, "h", mean_step)
        self.basis = [[step * x for x in row]
                      for step, row in zip(basis_step, rows(self.coefficients, "h", 1))]
        flat = s.take("h", tables * self.coefficients * self.components)
        loading = [[n * step for n, step in zip(row, loading_step)]
                   for row in rows_of(flat, self.components)]
        self.loading = rows_of(loading, self.coefficients)
        self.albedo_rows = rows(tables, "H", 1 / 65535)
        self.mirrored = rows(self.incidences if self.has_mirror else 0, "H", 1 / 65535)
        self.held = rows(nodes, "H", 1 / 65535)
        self.node_albedo = rows(nodes, "H", 1 / 65535)
        assert s.at == len(section)
        self.read_reach(Bytes(reach) if reach else None, tables)
        self.last = self.incidence[-1]
        self.steps = self.name_steps()
        self.mirror_table = self.make_mirror() if self.has_mirror else None
        self.read_sampling(sampling)

    def read_reach(self, s, tables):
        self.hulls = None
        if s:
            self.hulls = []
            for _ in range(tables):
                theta, phi, most = s.take("H", 3)
                unit = math.pi * most / 65535 / 255
                sides = [unit * side for side in s.take("B", 36)]
                self.hulls.append((RIGHT * theta / 65535, 2 * math.pi * phi / 65536, sides))

    def room(self, wo, wi):
        """How far inside what was measured wo lies, the light at wi."""
        local = turned(wi, wo)
        if not self.hulls:
            return math.acos(self.cone) - polar(local)
        room = math.pi
        for weight, table, other in self.mix(polar(wi), math.atan2(wi[1], wi[0])):
            if weight > 1e-3:
                x, y, z = local
                at = (-x, -y, z) if other else local
                room = min(room, self.room_in(self.hulls[table], at))
        return room

    @staticmethod
    def room_in(hull, d):
        theta, phi, sides = hull
        s, c, sp, cp = math.sin(theta), math.cos(theta), math.sin(phi), math.cos(phi)
        x, y = dot((c * cp, c * sp, -s), d), dot((-sp, cp, 0), d)
        at = math.atan2(y, x) % (2 * math.pi) / (2 * math.pi) * 36
        i, t = int(at) % 36, at - int(at)
        edge = sides[i] + t * (sides[(i + 1) % 36] - sides[i])
        return edge - math.atan2(math.hypot(x, y), dot((s * cp, s * sp, c), d))

    def exchanged(self, wo, wi):
        """The share of the two directions exchanged, beyond the last incidence."""
        def smooth(room):
            t = held(room / 0.035, 0, 1)
            return t * t * (3 - 2 * t)
        before = self.last - polar(wo)
        if not before > 0:
            return 0.0
        return smooth(min(before, self.room(wi, wo))) * smooth(polar(wi) - self.last)

    def read_sampling(self, data):
        self.sampling = SamplingTree(data)
        s = Bytes(data)
        s.at = (self.sampling.size + 3) // 4 * 4
        count, self.viewer_azimuths = s.take("H", 2)
        self.viewer_theta = s.take("f", count)

    def name_steps(self):
        """(theta, incidence, is from the other side), rising."""
        first = 0 if self.incidence[0] > 1e-6 else 1
        other = [(-self.incidence[i], i, True) for i in (first + 1, first)
                 if i < self.incidences]
        return other + [(theta, i, False) for i, theta in enumerate(self.incidence)]

    def incidence_weights(self, theta):
        """[(weight, step)] of up to four."""
        x = [step[0] for step in self.steps]
        if len(x) == 1:
            return [(1.0, self.steps[0])]
        i = max([k for k in range(len(x) - 1) if x[k] <= theta], default=0)
        u = held((theta - x[i]) / (x[i + 1] - x[i]), 0, 1)
        left, right = i > 0, i + 2 < len(x)
        if len(x) < 3:
            w = [0.0, 1 - u, u, 0.0]
        else:
            around = [x[k] if 0 <= k < len(x) else 0.0 for k in range(i - 1, i + 3)]
            w = cubic_weights(around, left, right, u)
        return [(weight, self.steps[i - 1 + k]) for k, weight in enumerate(w)
                if 0 <= i - 1 + k < len(x) and weight]

    def azimuth_weights(self, phi):
        """[(weight, azimuth)] of up to four."""
        n, turn = self.azimuths, 2 * math.pi
        phi %= turn
        i = max([k for k in range(n) if self.azimuth[k] <= phi], default=-1)
        x = [self.azimuth[j % n] + turn * (j // n) for j in range(i - 1, i + 3)]
        u = held((phi - x[1]) / (x[2] - x[1]), 0, 1)
        w = cubic_weights(x, True, True, u) if n >= 4 else [0.0, 1 - u, u, 0.0]
        return [(weight, j % n) for weight, j in zip(w, range(i - 1, i + 3)) if weight]

    def mix(self, theta, phi):
        """[(weight, table, is from the other side)]."""
        out = []
        for weight, (_, incidence, other) in self.incidence_weights(theta):
            around = [(1.0, 0)]
            if self.azimuths > 1:
                around = self.azimuth_weights(phi + math.pi if other else phi)
            out += [(weight * w, a * self.incidences + incidence, other) for w, a in around]
        return out

    # ---- wavelengths: answers are lists over the measured ones, then over those asked

    def spread(self, row, nm):
        out = []
        for wave in nm:
            if len(self.nm) == 1:
                out.append(row[0])
                continue
            i = max([k for k in range(len(self.nm) - 1) if self.nm[k] <= wave], default=0)
            t = held((wave - self.nm[i]) / (self.nm[i + 1] - self.nm[i]), 0, 1)
            out.append(row[i] + t * (row[i + 1] - row[i]))
        return out

    def mixed(self, rows, mix):
        return [sum(w * rows[table][k] for w, table, _ in mix)
                for k in range(self.wavelengths)]

    def logs(self, stored, mix, nm):
        row = self.mixed(self.mean, mix)
        for other in (False, True):
            part = [(w, table) for w, table, side in mix if side == other]
            if not part:
                continue
            x, y, z = stored
            values = self.tree.value((-x, -y, z) if other else stored)
            for s in range(self.coefficients):
                factor = sum(w * dot(self.loading[table][s], values) for w, table in part)
                row = [a + factor * b for a, b in zip(row, self.basis[s])]
        return self.spread(row, nm)

    # ---- the parts

    def make_mirror(self):
        f = [fresnel(math.cos(theta), self.index) for theta in self.incidence]
        table = []
        for a in range(181):
            cosine = math.cos(math.radians(a / 2))
            here = fresnel(cosine, self.index)
            row = []
            for w in range(self.wavelengths):
                rho = [self.mirrored[j][w] / f[j] for j in range(self.incidences)]
                row.append(min(1.0, here * self.ratio(f, rho, here)))
            table.append(row)
        return table

    @staticmethod
    def ratio(f, rho, here):
        if len(f) == 1 or here <= f[0]:
            return rho[0]
        i = 0
        while i + 2 < len(f) and f[i + 1] < here:
            i += 1
        if not f[i + 1] - f[i] > 1e-6:
            return rho[i + 1]
        value = rho[i] + (rho[i + 1] - rho[i]) * (here - f[i]) / (f[i + 1] - f[i])
        most = max(1.0, rho[i], rho[i + 1])
        return min(most, max(value, 0.5 * min(rho[i], rho[i + 1])))

    def mirror(self, cosine, nm):
        if not self.has_mirror or not cosine > 0:
            return [0.0] * len(nm)
        at = math.degrees(math.acos(held(cosine, 0, 1))) * 2
        i = min(int(at), 179)
        low, high = (self.spread(self.mirror_table[k], nm) for k in (i, i + 1))
        return [a + (at - i) * (b - a) for a, b in zip(low, high)]

    def albedo(self, cosine, observer):
        """Luminous mean of what the BRDF sends back."""
        y = [observer[held(int(nm + 0.5) - 360, 0, 470)][1] + 0.002 for nm in self.nm]

        def mean(row):
            return dot(y, row) / sum(y)
        theta = self.incidence + self.node[1:]
        shares = [sum(mean(self.albedo_rows[a * self.incidences + i])
                      for a in range(self.azimuths)) / self.azimuths
                  for i in range(self.incidences)]
        shares += [mean(row) for row in self.node_albedo[1:]]
        ratio = [share / fresnel(math.cos(t), self.index) for share, t in zip(shares, theta)]

        def entry(a):
            here = math.radians(a / 2)
            i = max([k for k in range(len(theta) - 1) if theta[k] <= here], default=0)
            k = min(i + 1, len(theta) - 1)
            t = held((here - theta[i]) / (theta[k] - theta[i]), 0, 1) if k > i else 0
            return min(1, fresnel(math.cos(here), self.index)
                       * (ratio[i] + t * (ratio[k] - ratio[i])))
        at = math.degrees(math.acos(held(cosine, 0, 1))) * 2
        i = min(int(at), 179)
        return entry(i) + (at - i) * (entry(i + 1) - entry(i))

    def gloss(self, cosine, nm):
        if not self.has_mirror:
            return [fresnel(cosine, self.index)] * len(nm)
        if not cosine > 0:
            return [1e-6] * len(nm)
        return [max(x, 1e-6) for x in self.mirror(cosine, nm)]

    def held_factor(self, theta, nm):
        if len(self.node) < 2:
            return [1.0] * len(nm)
        i = max([k for k in range(len(self.node) - 1) if self.node[k] <= theta], default=0)
        t = held((theta - self.node[i]) / (self.node[i + 1] - self.node[i]), 0, 1)
        low, high = (self.spread(self.held[k], nm) for k in (i, i + 1))
        return [a + t * (b - a) for a, b in zip(low, high)]

    # ---- the questions

    def brdf(self, wo, wi, nm):
        """(f, its lambertian part, which may still be more than f)."""
        if not (wo[2] > 0 and wi[2] > 0):
            return [0.0] * len(nm), [0.0] * len(nm)
        theta, phi = polar(wi), math.atan2(wi[1], wi[0])
        if theta > self.last:
            return self.brdf_beyond(wo, wi, nm)
        mix = self.mix(theta, phi)
        here = fresnel(wi[2], self.index)
        stored = specular(theta, self.k, turned(wi, wo))[0]
        f = [math.exp(x) * here for x in self.logs(stored, mix, nm)]
        part = [math.exp(x) for x in self.spread(self.mixed(self.lambertian, mix), nm)]
        return f, part

    def asked(self, wi, local):
        """Where the last incidence is read, in the turned frame."""
        sine = math.sqrt(max(0.0, 1 - wi[2] ** 2))
        x, y = local[0] - sine + math.sin(self.last), local[1]
        edge, length = math.sqrt(max(0.0, 1 - self.cone ** 2)), math.hypot(x, y)
        if length > edge:
            x, y = x * edge / length, y * edge / length
        return x, y, math.sqrt(max(0.0, 1 - x * x - y * y))

    def brdf_beyond(self, wo, wi, nm):
        ask = self.asked(wi, turned(wi, wo))
        mix = self.mix(self.last, math.atan2(wi[1], wi[0]))
        last = fresnel(math.cos(self.last), self.index)
        stored = specular(self.last, self.k, ask)[0]
        total = [math.exp(x) * last for x in self.logs(stored, mix, nm)]
        most = max((part for part in mix if not part[2]), key=lambda part: part[0])
        own = self.spread([math.exp(x) for x in self.lambertian[most[1]]], nm)
        a, b, c, d = (self.gloss(cosine, nm)
                      for cosine in (wi[2], wo[2], math.cos(self.last), ask[2]))
        ratio = [math.sqrt(p * q / (r * s)) for p, q, r, s in zip(a, b, c, d)]
        factor = self.held_factor(polar(wi), nm)
        f = [(t - min(t, p)) * r + min(t, p) for t, p, r in zip(total, own, ratio)]
        share = self.exchanged(wo, wi)
        if share:
            f = [a + share * (b - a) for a, b in zip(f, self.brdf(wi, wo, nm)[0])]
        f = [a * b for a, b in zip(f, factor)]
        return f, [p * b for p, b in zip(own, factor)]

    def pdf(self, wo, wi):
        """(density, how near the edge of a cell it is read)."""
        if not (wo[2] > 0 and wi[2] > 0):
            return 0.0, 1.0
        theta, n = polar(wo), len(self.viewer_theta)
        i, t = 0, 0.0
        if n > 1:
            x = self.viewer_theta
            i = max([k for k in range(n - 1) if x[k] <= theta], default=0)
            t = held((theta - x[i]) / (x[i + 1] - x[i]), 0, 1)
        nodes = {i: 1 - t}
        if n > 1:
            nodes[i + 1] = t
        mix = nodes
        if self.viewer_azimuths > 1:
            at = math.atan2(wo[1], wo[0]) / (2 * math.pi) % 1 * self.viewer_azimuths
            a, s = int(at), at - int(at)
            mix = {}
            for azimuth, part in ((a, 1 - s), ((a + 1) % self.viewer_azimuths, s)):
                for node, w in nodes.items():
                    mix[azimuth * n + node] = w * part
        stored, ex, offset = specular(theta, 2, turned(wo, wi))
        density, margin = self.sampling.density(mix, stored)
        t_w, t_s = polar(wi), polar(stored)
        r = t_s / RIGHT
        sinc = (math.sin(t_w) / t_w if t_w else 1) / (math.sin(t_s) / t_s if t_s else 1)
        jacobian = sinc * (1 - offset * ex) * 2 * r * r
        return (density / jacobian if jacobian > 0 else 0.0), margin
