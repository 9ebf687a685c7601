# SPDX-License-Identifier: Apache-2.0
"""panel_reader_emission.py -- sections 2 and 4 of a panel file (panel_reader.py)."""
import math

from panel_reader_trees import Bytes, dot, held, open_tree, triangles

FIRST_NM, LAST_NM = 360, 830

KNOTS = [5.0 * i if i <= 14 else 70 + 2.5 * (i - 14) for i in range(-6, 30)]


def knot(i):
    return KNOTS[i + 6]


def b_spline(first, degree, x):
    """Cox and de Boor: over knots first .. first + degree + 1, in degrees."""
    if degree == 0:
        return 1.0 if knot(first) <= x < knot(first + 1) else 0.0
    low, high = knot(first), knot(first + degree + 1)
    return ((x - low) / (knot(first + degree) - low) * b_spline(first, degree - 1, x)
            + (high - x) / (high - knot(first + 1)) * b_spline(first + 1, degree - 1, x))


def spline_weights():
    """Of C_-1 .. C_23 at each of the 181 angles."""
    angles = [math.degrees(2 * math.atan(n / 180)) for n in range(181)]
    return [[b_spline(j - 2, 3, min(x, 90)) for j in range(-1, 24)] for x in angles]


SPLINE_WEIGHTS = spline_weights()


class Spline:
    def __init__(self, section, components):
        terms, stored = section.take("B", 2)
        assert stored == components
        exponents = section.take("B", components)
        self.terms = section.take("B", terms)
        widths = section.take("B", terms * components)
        blocks = [[0.0] * 25 for _ in widths]
        for width in (2, 1):
            for b, stored in enumerate(widths):
                if stored == width:
                    step = 2.0 ** -exponents[b % components]
                    blocks[b] = [step * n for n in section.take("bh"[width - 1], 25)]
        self.power = [row[24] for row in blocks]
        self.components = components
        self.table = [[self.value(blocks[b], self.terms[b // components], weights)
                       for b in range(len(blocks))] for weights in SPLINE_WEIGHTS]

    @staticmethod
    def value(block, term, weights):
        m = (term + 1) // 2
        c = block[:24]
        if m:
            c = [0.0 if m % 2 else -c[1] / 2] + c[1:]
        return dot(weights, [-c[1] if m % 2 else c[1]] + c)

    def add(self, d, log_c, out):
        s = math.hypot(d[0], d[1])
        at = held(s / (1 + d[2]), 0, 1) * 180
        n = min(int(at), 179)
        t = at - n
        phi = math.atan2(d[1], d[0]) if s > 0 else 0.0
        low, high, b = self.table[n], self.table[n + 1], 0
        for term in self.terms:
            m = (term + 1) // 2
            angle = 1.0 if not term else math.cos(m * phi) if term % 2 else math.sin(m * phi)
            for k in range(self.components):
                out[k] += angle * ((1 - t) * low[b] + t * high[b] + self.power[b] * log_c)
                b += 1


def slope_shares(x, y, i):
    """What the steepness of the intervals is worth for the slope at level i: {interval: p}."""
    last = len(x) - 1
    if i in (0, last):
        return {0 if i == 0 else last - 1: 1.0}
    h0, h1 = x[i] - x[i - 1], x[i + 1] - x[i]
    e0, e1 = (y[i] - y[i - 1]) / h0, (y[i + 1] - y[i]) / h1
    if e0 * e1 <= 0:
        return {}
    w0, w1 = 2 * h1 + h0, h1 + 2 * h0
    below = (w0 * e1 + w1 * e0) ** 2
    return {i - 1: (w0 + w1) * w0 * e1 * e1 / below, i: (w0 + w1) * w1 * e0 * e0 / below}


def level_weights(x, y, exponent, at):
    """({level: weight}, offset) of a channel's curve at ln code."""
    if len(x) == 1:
        return {0: 1.0}, exponent * (at - x[0])
    if at in x:
        return {x.index(at): 1.0}, 0.0
    if at < x[0] or at > x[-1]:
        i = 0 if at < x[0] else len(x) - 2
        t = (at - x[i]) / (x[i + 1] - x[i])
        return {i: 1 - t, i + 1: t}, 0.0
    i = max(k for k in range(len(x)) if x[k] <= at)
    h = x[i + 1] - x[i]
    t = (at - x[i]) / h
    weights = dict.fromkeys(range(len(x)), 0.0)
    weights[i] += 2 * t ** 3 - 3 * t * t + 1
    weights[i + 1] += 3 * t * t - 2 * t ** 3
    for node, factor in ((i, h * (t ** 3 - 2 * t * t + t)), (i + 1, h * (t ** 3 - t * t))):
        for interval, share in slope_shares(x, y, node).items():
            per = factor * share / (x[interval + 1] - x[interval])
            weights[interval] -= per
            weights[interval + 1] += per
    return weights, 0.0


class Emission:
    def __init__(self, section, tree, primaries, observer):
        self.tree = open_tree(tree)
        section = Bytes(section)
        self.components = section.take("B")
        self.has_black = section.take("B") == 1
        counts = section.take("B", 3)
        section.take("B", 3)
        self.cone, self.exponent, self.power = section.take("f", 3)
        self.levels = [[u / 256 for u in section.take("H", count)] for count in counts]
        tables = sum(counts) + self.has_black
        self.mean = [n / 2048 for n in section.take("h", 3 * tables)]
        self.loading = self.read_loadings(section)
        self.spline = Spline(section, self.components)
        assert section.at == len(section.data)
        self.first = [0, 3 * counts[0], 3 * (counts[0] + counts[1]), 3 * sum(counts)]
        self.code_rows = {}
        self.spectra = Spectra(self, Bytes(primaries), observer) if observer else None

    def read_loadings(self, section):
        channels, k = len(self.mean), self.components
        exponents, widths = section.take("B", k), section.take("B", k)
        loading = [None] * k
        for width in (2, 1):
            for i in range(k):
                if widths[i] == width:
                    loading[i] = [n * 2.0 ** -exponents[i]
                                  for n in section.take("bh"[width - 1], channels)]
        return [list(row) for row in zip(*loading)]

    def components_at(self, d):
        """ln c times the shared power, and t_k."""
        log_c = math.log(max(d[2], 1e-4))
        t = list(self.tree.value(d))
        self.spline.add(d, log_c, t)
        return self.power * log_c, t

    def channel(self, number, at):
        return at[0] + self.mean[number] + dot(self.loading[number], at[1])

    def code_row(self, primary, code):
        """(offset, weights of components) for X, Y, Z; code 0 stands for 1/e."""
        key = primary, code
        if key not in self.code_rows:
            x = [math.log(level) for level in self.levels[primary]]
            rows = []
            for j in range(3):
                channels = [self.first[primary] + 3 * i + j for i in range(len(x))]
                weights, row = level_weights(
                    x, [self.mean[c] for c in channels], self.exponent,
                    math.log(code) if code else -1.0)
                total = [0.0] * self.components
                for i, w in weights.items():
                    row += w * self.mean[channels[i]]
                    total = [a + w * b for a, b in zip(total, self.loading[channels[i]])]
                rows.append((row, total))
            self.code_rows[key] = rows
        return self.code_rows[key]

    def whole(self, primary, code, at):
        return [at[0] + row + dot(total, at[1]) for row, total in self.code_row(primary, code)]

    def source(self, primary, code, at):
        """ln X, ln Y, ln Z of a primary at a code above 0."""
        code = min(code, 255.0)
        n = int(code)
        if n == code:
            return self.whole(primary, n, at)
        if n == 0:
            one, below = self.whole(primary, 1, at), self.whole(primary, 0, at)
            return [a + math.log(code) * (a - b) for a, b in zip(one, below)]
        low, high = self.whole(primary, n, at), self.whole(primary, n + 1, at)
        t = math.log(code / n) / math.log((n + 1) / n)
        return [a + t * (b - a) for a, b in zip(low, high)]

    def sources(self, d, code):
        """{source: ln XYZ}; 3 is black."""
        at = self.components_at(d)
        out = {p: self.source(p, code[p], at) for p in range(3) if code[p] > 0}
        if self.has_black:
            out[3] = [self.channel(self.first[3] + j, at) for j in range(3)]
        return out


def xyz_of(sources):
    return [sum(math.exp(min(logs[j], 80)) for logs in sources.values()) for j in range(3)]


# ---- spectra -------------------------------------------------------------------------------


class Spectra:
    def __init__(self, emission, section, observer):
        self.observer = observer
        first, step = section.take("f", 2)
        count, kind = section.take("H", 2)
        scale = section.take("f", 3)
        self.base = []
        for p in range(3):
            stored = [scale[p] * n for n in section.take("H", count)]
            self.base.append(self.normalised([
                self.at_nm(stored, (nm - first) / step) if count else self.default(kind, p, nm)
                for nm in range(FIRST_NM, LAST_NM + 1)]))
        self.base.append(self.black(emission))
        self.ranges = ranges_of(emission)
        self.tables = [None] * 4

    @staticmethod
    def at_nm(stored, at):
        if at < 0 or at > len(stored) - 1:
            return 0.0
        n = min(int(at), len(stored) - 2)
        return stored[n] + (at - n) * (stored[n + 1] - stored[n])

    def default(self, kind, primary, nm):
        if kind == 2:
            row = self.observer[nm - FIRST_NM]
            return row[3 + primary] * row[6]
        peak, width = ((625, 40), (535, 50), (455, 25))[primary]
        return math.exp(-4 * math.log(2) * ((nm - peak) / width) ** 2) + 1e-4

    def parts(self, spectrum):
        """683.002 S x-bar on half nm with the weights of Simpson's rule, which is exact for a
        product of two straight lines: (t, S, X part, Y part, Z part) where there is light."""
        out, last = [], 2 * len(spectrum) - 2
        for h in range(last + 1):
            i, half = h // 2, h % 2
            s = 0.5 * (spectrum[i] + spectrum[i + half])
            if not half:
                s = spectrum[i]
            if s <= 0:
                continue
            bars = [0.5 * (self.observer[i][j] + self.observer[i + half][j]) for j in range(3)]
            weight = 683.002 * (1 / 6 if h in (0, last) else (2 / 6, 4 / 6)[half])
            t = (FIRST_NM + 0.5 * h - 560) / 180
            out.append((t, s, *(weight * s * bar for bar in bars)))
        return out

    def normalised(self, spectrum):
        y = sum(row[3] for row in self.parts(spectrum))
        return [s / y for s in spectrum] if y > 0 else None

    def black(self, emission):
        d = (0.0, 0.0, 1.0)
        total = [0.0] * len(self.base[0])
        for p in range(3):
            added = math.exp(emission.sources(d, [255 * (p == q) for q in range(3)])[p][1])
            total = [a + added * b for a, b in zip(total, self.base[p])]
        return self.normalised(total) or self.base[1]

    def of_source(self, source, logs, nm):
        """Spectral radiance at each wavelength."""
        if self.tables[source] is None:
            self.tables[source] = WarpTable(self.parts(self.base[source]), self.ranges[source])
        c0, c1, c2 = self.tables[source].at(logs[0] - logs[1], logs[2] - logs[1])
        out = []
        for wave in nm:
            t = (wave - 560) / 180
            at = held(wave, FIRST_NM, LAST_NM - 0.001) - FIRST_NM
            i = int(at)
            base = self.base[source][i] + (at - i) * (self.base[source][i + 1]
                                                      - self.base[source][i])
            out.append(base * math.exp(min(c0 + c1 * t + c2 * t * t + logs[1], 60)))
        return out


def ranges_of(emission):
    """Of the four sources: [u0, v0, ax, ay, low, high], low and high of both coordinates."""
    points = [[] for _ in range(4)]

    def add(d):
        at = emission.components_at(d)
        for p in range(4):
            levels = len(emission.levels[p]) if p < 3 else int(emission.has_black)
            for i in range(levels):
                first = emission.first[p] + 3 * i
                x, y, z = (emission.channel(first + j, at) for j in range(3))
                if y >= emission.mean[first + 1] - 4:
                    points[p].append((x - y, z - y))

    for corners in triangles(5):
        total = [sum(c) for c in zip(*corners)]
        length = math.sqrt(dot(total, total))
        for octant in range(4):
            d = (total[0] / length * (-1 if octant & 1 else 1),
                 total[1] / length * (-1 if octant & 2 else 1), total[2] / length)
            if d[2] >= emission.cone:
                add(d)
    return [range_of(cloud) for cloud in points]


def range_of(cloud):
    n = len(cloud)
    if not n:
        return [0.0, 0.0, 1.0, 0.0, [-1.0, -1.0], [1.0, 1.0]]
    u0, v0 = (sum(point[k] for point in cloud) / n for k in range(2))
    m0 = sum((u - u0) ** 2 for u, _ in cloud)
    m1 = sum((u - u0) * (v - v0) for u, v in cloud)
    m2 = sum((v - v0) ** 2 for _, v in cloud)
    half = (m0 - m2) / 2
    root = math.sqrt(half * half + m1 * m1)
    a, b = (half + root, m1) if half >= 0 else (m1, root - half)
    size = math.hypot(a, b)
    ax, ay = (a / size, b / size) if size > 0 else (1.0, 0.0)
    low, high = [], []
    for row in (sorted((u - u0) * ax + (v - v0) * ay for u, v in cloud),
                sorted((v - v0) * ax - (u - u0) * ay for u, v in cloud)):
        least, most = row[n // 200], row[n - 1 - n // 200]
        margin = 0.002 + 0.05 * (most - least)
        low.append(least - margin)
        high.append(most + margin)
    return [u0, v0, ax, ay, low, high]


class WarpTable:
    SIDE = 17

    def __init__(self, parts, at):
        self.parts, self.range = parts, at
        self.peak = max(row[1] for row in parts)
        self.node = {}
        self.fill()

    def moments(self, c1, c2):
        total = [[0.0] * 3 for _ in range(3)]
        most = 0.0
        exp = math.exp
        for t, s, *xyz in self.parts:
            factor = exp(min(c1 * t + c2 * t * t, 700))
            most = max(most, s * factor)
            ft, ftt = factor * t, factor * t * t
            for row, p in zip(total, xyz):
                row[0] += p * factor
                row[1] += p * ft
                row[2] += p * ftt
        return total, most

    def reach(self, target, start):
        """c with which the source has the colour, from `start`; None: none."""
        c1, c2 = start[1:]
        for _ in range(40):
            m, most = self.moments(c1, c2)
            if min(m[0][0], m[1][0], m[2][0]) <= 0:
                return None
            mean = [(row[1] / row[0], row[2] / row[0]) for row in m]
            rest = [math.log(m[j][0] / m[1][0]) - target[k] for k, j in enumerate((0, 2))]
            if max(map(abs, rest)) < 1e-9:
                fits = most < 4 * self.peak * m[1][0]
                return (-math.log(m[1][0]), c1, c2) if fits else None
            (a, b), (c, d) = [[mean[j][k] - mean[1][k] for k in range(2)] for j in (0, 2)]
            det = a * d - b * c
            if not abs(det) > 1e-14:
                return None
            d1, d2 = -(d * rest[0] - b * rest[1]) / det, -(a * rest[1] - c * rest[0]) / det
            damp = min(1, 4 / max(abs(d1), abs(d2), 1e-300))
            c1, c2 = c1 + damp * d1, c2 + damp * d2
            if not (abs(c1) < 24 and abs(c2) < 24):
                return None
        return None

    def along(self, start, target, c):
        """(c at the farthest point of the way that is reached, whether it is the end)."""
        whole = self.reach(target, c)
        if whole:
            return whole, True
        good, bad = 0.0, 1.0
        for _ in range(6):
            middle = 0.5 * (good + bad)
            point = [a + middle * (b - a) for a, b in zip(start, target)]
            trial = self.reach(point, c)
            if trial:
                good, c = middle, trial
            else:
                bad = middle
        return c, False

    def colour(self, along, across):
        u0, v0, ax, ay = self.range[:4]
        return u0 + along * ax - across * ay, v0 + along * ay + across * ax

    def fill(self):
        side, (low, high) = self.SIDE, self.range[4:]
        m, _ = self.moments(0.0, 0.0)
        start = [math.log(m[j][0] / m[1][0]) for j in (0, 2)]
        c = self.reach(start, (0.0, 0.0, 0.0)) or (0.0, 0.0, 0.0)
        for i in range(side):
            along = low[0] + (high[0] - low[0]) * i / (side - 1)
            middle = self.colour(along, 0.0)
            c, reached = self.along(start, middle, c)
            if reached:
                start = middle
            for row in (range(side // 2, side), range(side // 2 - 1, -1, -1)):
                here, goes_on, at = middle, reached, c
                for j in row:
                    across = low[1] + (high[1] - low[1]) * j / (side - 1)
                    target = self.colour(along, across)
                    if goes_on:
                        at, goes_on = self.along(here, target, at)
                    here = target
                    self.node[i, j] = at

    @staticmethod
    def cell(at, low, high):
        """{node: weight} of a Catmull-Rom cubic."""
        s = held((at - low) / (high - low) * 16, 0, 16)
        i = min(int(s), 15)
        t = s - i
        w = {i - 1: (2 * t * t - t ** 3 - t) / 2, i: (3 * t ** 3 - 5 * t * t + 2) / 2,
             i + 1: (4 * t * t - 3 * t ** 3 + t) / 2, i + 2: (t ** 3 - t * t) / 2}
        for missing, near, far in ((-1, 0, 1), (17, 16, 15)):
            if missing in w:
                w[near] += 2 * w[missing]
                w[far] -= w.pop(missing)
        return w

    def at(self, u, v):
        u0, v0, ax, ay, low, high = self.range
        along = self.cell((u - u0) * ax + (v - v0) * ay, low[0], high[0])
        across = self.cell((v - v0) * ax - (u - u0) * ay, low[1], high[1])
        return [sum(a * b * self.node[i, j][k] for i, a in along.items()
                    for j, b in across.items()) for k in range(3)]
