# SPDX-License-Identifier: Apache-2.0
"""panel_reader.py -- a second reader of .panel files: small, slow, with nothing but the
standard library, written from assets/guides/panel-format.md alone.
tests/library/agreement.py asks it and libparhelion-panel the same questions. All in double
precision; the checksum is not looked at, and what the page says of damage neither. Trees,
emission and reflection have files of their own.
"""
import math
import struct

from panel_reader_emission import Emission, xyz_of
from panel_reader_reflection import Reflection
from panel_reader_trees import Bytes, held


def sections_of(data):
    if data[:8] != b"PHPANEL\n":
        raise ValueError("no panel file")
    version, flags, _, size, count, _ = struct.unpack_from("<IIQQII", data, 8)
    if version != 7 or flags or size != len(data):
        raise ValueError("a panel file that this page does not tell of")
    found = {}
    for i in range(count):
        kind, index, length, offset = struct.unpack_from("<HHIQ", data, 40 + 16 * i)
        found[kind, index] = data[offset:offset + length]
    return found


class One:
    """A panel without places."""

    def __init__(self, sections, observer):
        self.emission = self.reflection = None
        if (2, 0) in sections:
            self.emission = Emission(sections[2, 0], sections[3, 0], sections[4, 0], observer)
        if (5, 0) in sections:
            self.reflection = Reflection(sections[5, 0], sections[6, 0], sections[7, 0],
                                         sections.get((15, 0)))


class Ground:
    """Weights of spots at a place."""

    def __init__(self, spots):
        self.spots = spots
        self.u, self.v = (sorted({spot[k] for spot in spots}) for k in range(2))
        self.is_grid = len(self.u) * len(self.v) == len(spots)
        if not self.is_grid:
            self.lifted = [u * u + v * v + 1e-9 * (7919 * i % 104729) / 104729
                           for i, (u, v) in enumerate(spots)]
            self.find_triangles()

    def area(self, a, b, c):
        (u, v), (p, q), (r, s) = (self.spots[i] for i in (a, b, c))
        return (p - u) * (s - v) - (r - u) * (q - v)

    def is_lowest(self, a, b, c):
        area = self.area(a, b, c)
        if abs(area) < 1e-7:
            return False
        h = self.lifted
        return all(h[i] >= (self.area(i, b, c) * h[a] + self.area(a, i, c) * h[b]
                            + self.area(a, b, i) * h[c]) / area
                   for i in range(len(self.spots)) if i not in (a, b, c))

    def find_triangles(self):
        n = len(self.spots)
        pairs = [(a, b) for a in range(n) for b in range(a + 1, n)]
        self.triangles = [(a, b, c) for a, b in pairs for c in range(b + 1, n)
                          if self.is_lowest(a, b, c)]
        if self.triangles:
            self.border = [(a, b) for a, b in pairs
                           if sum(a in t and b in t for t in self.triangles) == 1]
        else:
            self.border = [(a, b) for a, b in pairs if not any(
                sum((self.spots[i][k] - self.spots[a][k]) * (self.spots[i][k]
                                                             - self.spots[b][k])
                    for k in range(2)) < 0 for i in range(n) if i not in (a, b))]

    @staticmethod
    def line(rows, at):
        if len(rows) == 1:
            return [(rows[0], 1.0)]
        i = max([k for k in range(len(rows) - 1) if rows[k] <= at], default=0)
        t = held((at - rows[i]) / (rows[i + 1] - rows[i]), 0, 1)
        return [(rows[i], 1 - t), (rows[i + 1], t)]

    def weights(self, place):
        """[(spot, weight)]."""
        place = tuple(held(x, 0, 1) for x in place)
        if self.is_grid:
            return [(self.spots.index((u, v)), a * b) for u, a in self.line(self.u, place[0])
                    for v, b in self.line(self.v, place[1]) if a * b > 0]
        for a, b, c in self.triangles:
            (u0, v0), (u1, v1), (u2, v2) = (self.spots[i] for i in (a, b, c))
            u, v, area = place[0] - u0, place[1] - v0, self.area(a, b, c)
            p = (u * (v2 - v0) - (u2 - u0) * v) / area
            q = ((u1 - u0) * v - u * (v1 - v0)) / area
            if p >= 0 and q >= 0 and p + q <= 1:
                return [(a, 1 - p - q), (b, p), (c, q)]
        return self.border_weights(place)

    def border_weights(self, place):
        best = None
        for a, b in self.border:
            (u0, v0), (u1, v1) = self.spots[a], self.spots[b]
            du, dv, u, v = u1 - u0, v1 - v0, place[0] - u0, place[1] - v0
            t = held((u * du + v * dv) / (du * du + dv * dv), 0, 1)
            far = (u - t * du) ** 2 + (v - t * dv) ** 2
            if best is None or far < best[0]:
                best = far, a, b, t
        _, a, b, t = best
        return [(a, 1 - t), (b, t)]


class Map:
    def __init__(self, data):
        section = Bytes(data)
        self.width, self.height = section.take("H", 2)
        white, black = section.take("B", 4)[:2]
        scale = section.take("f", 6)
        planes = [section.take("H", self.width * self.height) for _ in range(white + black)]
        pairs = list(zip(scale, planes))
        self.white = pairs[:white] * (1 if white == 3 else 3)
        self.black = pairs[white:] * (1 if black == 3 else 3) if black else self.white
        self.coloured = [rows for rows, count in ((self.white, white), (self.black, black))
                         if count == 3]

    @staticmethod
    def pixel(at, count):
        x = held(at * count - 0.5, 0, count - 1)
        i = int(x)
        return i, min(i + 1, count - 1), x - i

    def at(self, place):
        (i, right, s), (j, below, t) = (self.pixel(place[0], self.width),
                                        self.pixel(place[1], self.height))
        out = []
        for rows in (self.white, self.black):
            out.append([scale * ((1 - t) * ((1 - s) * p[j * self.width + i]
                                            + s * p[j * self.width + right])
                                 + t * ((1 - s) * p[below * self.width + i]
                                        + s * p[below * self.width + right]))
                        for scale, p in rows])
        return out

    def colours(self):
        """Ranges of ln X/Y and ln Z/Y."""
        low, high = [0.0, 0.0], [0.0, 0.0]
        for rows in self.coloured:
            for k, channel in enumerate((0, 2)):
                (sx, xs), (sy, ys) = rows[channel], rows[1]
                logs = [held(math.log(sx * x / (sy * y)), -3, 3)
                        for x, y in zip(xs, ys) if x > 0 and y > 0]
                low[k], high[k] = min([low[k], *logs]), max([high[k], *logs])
        return low, high


class Panel:
    """observer: rows of seven or more numbers every nm from 360 to 830, as the page says; None:
    no spectra of the emission."""

    def __init__(self, data, observer=None):
        sections = sections_of(data)
        self.panels = [One(sections, observer)]
        self.ground = self.map = None
        if (11, 0) in sections:
            self.read_places(sections, observer)

    def read_places(self, sections, observer):
        section = Bytes(sections[11, 0])
        spots, panels = section.take("H", 2)
        measured = [tuple(section.take("f", 2))]
        rows = [(tuple(section.take("f", 2)), section.take("H", 2)) for _ in range(spots)]
        self.emits, self.reflects = ([row[1][k] for row in rows] for k in range(2))
        for k in range(1, panels + 1):
            self.panels.append(One(sections_of(sections[12, k]), observer))
            measured.append(next(at for at, named in rows if k in named))
        if spots:
            self.ground = Ground([at for at, _ in rows])
        if (13, 0) in sections:
            self.map = Map(sections[13, 0])
            self.measured = [self.map.at(at) for at in measured]
            self.dark = [self.dark_of(one.emission) if one.emission else None
                         for one in self.panels]
            if observer and self.map.coloured:
                self.widen_ranges()

    @staticmethod
    def dark_of(emission):
        black, white = (xyz_of(emission.sources((0.0, 0.0, 1.0), [code] * 3))
                        for code in (0, 255))
        return [held(b / w, 0, 0.999) if w > b else 0.0 for b, w in zip(black, white)]

    def widen_ranges(self):
        low, high = self.map.colours()
        for one, measured in zip(self.panels, self.measured):
            for source in range(4) if one.emission else ():
                at = measured[source == 3]
                _, _, ax, ay, least, most = one.emission.spectra.ranges[source]
                us = [x - math.log(at[0] / at[1]) for x in (low[0], high[0])]
                vs = [x - math.log(at[2] / at[1]) for x in (low[1], high[1])]
                corners = [(u * ax + v * ay, v * ax - u * ay) for u in us for v in vs]
                for k in range(2):
                    row = [held(corner[k], -3, 3) for corner in corners]
                    least[k] += min([0.0, *row])
                    most[k] += max([0.0, *row])

    def mixed(self, place, of_spot):
        """[(panel's number, weight)]."""
        if not self.ground:
            return [(0, 1.0)]
        out = {}
        for spot, weight in self.ground.weights(place):
            out[of_spot[spot]] = out.get(of_spot[spot], 0) + weight
        return list(out.items())

    def sources(self, number, d, code, place):
        """{source: ln XYZ} of a panel, as the map has them at a place."""
        sources = self.panels[number].emission.sources(d, code)
        if self.map:
            white, black = self.map.at(place)
            for source, logs in sources.items():
                for j in range(3):
                    w = white[j] / self.measured[number][0][j]
                    b = black[j] / self.measured[number][1][j]
                    c = self.dark[number][j]
                    factor = b if source == 3 else (w - b * c) / (1 - c)
                    logs[j] += math.log(max(factor, 1e-9))
        return sources

    def emission_xyz(self, d, code, place=(0.5, 0.5)):
        out = [0.0] * 3
        if self.panels[0].emission and d[2] > 0:
            for number, weight in self.mixed(place, self.emits if self.ground else None):
                xyz = xyz_of(self.sources(number, d, code, place))
                out = [a + weight * b for a, b in zip(out, xyz)]
        return out

    def emission_spectrum(self, d, code, nm, place=(0.5, 0.5), shift=(0.0, 0.0, 0.0)):
        """shift: added to every ln X, ln Y, ln Z before the spectra are warped to them."""
        out = [0.0] * len(nm)
        if self.panels[0].emission and d[2] > 0:
            for number, weight in self.mixed(place, self.emits if self.ground else None):
                spectra = self.panels[number].emission.spectra
                for source, logs in self.sources(number, d, code, place).items():
                    light = spectra.of_source(source, [a + b for a, b in zip(logs, shift)], nm)
                    out = [a + weight * b for a, b in zip(out, light)]
        return out

    def reflecting(self, place):
        return [(self.panels[number].reflection, weight) for number, weight in
                self.mixed(place, self.reflects if self.ground else None)]

    def brdf(self, wo, wi, nm, place=(0.5, 0.5)):
        """(f, its lambertian part)."""
        f, part = [0.0] * len(nm), [0.0] * len(nm)
        answers = [(weight, *reflection.brdf(wo, wi, nm)) for reflection, weight in
                   (self.reflecting(place) if self.panels[0].reflection else ())]
        for weight, more, _ in answers:
            f = [a + weight * b for a, b in zip(f, more)]
        for weight, _, diffuse in answers:
            part = [a + weight * min(b, all_) for a, b, all_ in zip(part, diffuse, f)]
        return f, part

    def mirror(self, d, nm, place=(0.5, 0.5)):
        out = [0.0] * len(nm)
        for reflection, weight in self.reflecting(place) if self.panels[0].reflection else ():
            out = [a + weight * b for a, b in zip(out, reflection.mirror(d[2], nm))]
        return out

    def albedo(self, d, observer, place=(0.5, 0.5)):
        return sum(weight * reflection.albedo(d[2], observer)
                   for reflection, weight in self.reflecting(place))

    def pdf(self, wo, wi, place=(0.5, 0.5)):
        """(density, margin) as Reflection.pdf has it."""
        out, margin = 0.0, 1.0
        for reflection, weight in self.reflecting(place):
            answer = reflection.pdf(wo, wi)
            out, margin = out + weight * answer[0], min(margin, answer[1])
        return out, margin
