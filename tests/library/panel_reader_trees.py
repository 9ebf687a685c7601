# SPDX-License-Identifier: Apache-2.0
"""panel_reader_trees.py -- trees of a panel file: functions of direction (panel_reader.py)."""
import functools
import math
import struct


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def held(x, low, high):
    return max(low, min(high, x))


class Bytes:
    """A section that is read from its beginning."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, kind, count=None):
        """count numbers of a kind of struct's letters; without a count a single one."""
        form = f"<{1 if count is None else count}{kind}"
        values = struct.unpack_from(form, self.data, self.at)
        self.at += struct.calcsize(form)
        return values[0] if count is None else list(values)


def rows_of(values, width):
    return [values[i:i + width] for i in range(0, len(values), width)]


# ---- triangles -----------------------------------------------------------------------------


def middle(a, b):
    total = [x + y for x, y in zip(a, b)]
    length = math.sqrt(dot(total, total))
    return tuple(x / length for x in total)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@functools.lru_cache(maxsize=None)
def corners_of(level, n):
    """Of a triangle in octant 0."""
    if level == 0:
        return (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    a, b, c = corners_of(level - 1, n // 4)
    bc, ca, ab = middle(b, c), middle(c, a), middle(a, b)
    return ((bc, ca, ab), (a, ab, ca), (ab, b, bc), (ca, bc, c))[n % 4]


@functools.lru_cache(maxsize=None)
def coordinate_rows(level, n):
    """Rows whose products with a direction are its u, v, w."""
    a, b, c = corners_of(level, n)
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    volume = dot(a, bc)
    return [[x / volume for x in row] for row in (bc, ca, ab)]


def triangles(level):
    return [corners_of(level, n) for n in range(4 ** level)]


def find(level, d):
    """Triangle of octant 0 that holds |x|, |y|, z, and the barycentric coordinates."""
    p = (abs(d[0]), abs(d[1]), max(d[2], 0.0))
    n = 0
    for i in range(level):
        u, v, w = (dot(row, p) for row in coordinate_rows(i, n))
        child = 1 if u > v + w else 2 if v > w + u else 3 if w > u + v else 0
        n = 4 * n + child
    u, v, w = (dot(row, p) for row in coordinate_rows(level, n))
    total = u + v + w
    return n, (u / total, v / total, w / total)


@functools.lru_cache(maxsize=None)
def area_of(level, n):
    a, b, c = corners_of(level, n)
    return 2 * math.atan2(abs(dot(a, cross(b, c))),
                          1 + dot(a, b) + dot(b, c) + dot(c, a))


@functools.lru_cache(maxsize=None)
def lattice_corners(level, n):
    """Places of a triangle's corners, the octant's legs being 1."""
    if level == 0:
        return (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)
    a, b, c = lattice_corners(level - 1, n // 4)

    def mid(p, q):
        return (p[0] + q[0]) / 2, (p[1] + q[1]) / 2
    bc, ca, ab = mid(b, c), mid(c, a), mid(a, b)
    return ((bc, ca, ab), (a, ab, ca), (ab, b, bc), (ca, bc, c))[n % 4]


def open_tree(data):
    kind = {b"VRTX": VertexTree, b"HAAR": HaarTree}
    return kind[data[:4]](data)


# ---- VRTX ----------------------------------------------------------------------------------


class BitReader:
    def __init__(self, data):
        self.data, self.at, self.range = data, 4, 2 ** 32 - 1
        self.low, self.chances = int.from_bytes(data[:4], "big"), {}

    def bit(self, *context):
        zero, seen = self.chances.get(context, (32768, 0))
        bound = self.range // 65536 * zero
        bit = int(self.low >= bound)
        self.low -= bound * bit
        self.range = self.range - bound if bit else bound
        while self.range < 2 ** 24:
            byte = self.data[self.at] if self.at < len(self.data) else 0
            self.low, self.range, self.at = 256 * self.low + byte, 256 * self.range, self.at + 1
        zero += int(2 * ((0 if bit else 65536) - zero) / (2 * seen + 3))
        self.chances[context] = min(65280, max(256, zero)), min(29, seen + 1)
        return bit

    def number(self, kind, near, others):
        size, digits, out = min(2, (abs(near) + 1) // 2), 1, 1
        if not self.bit(kind, "more", size, others):
            return 0
        while digits < 16 and self.bit(kind, "longer", size, digits):
            digits += 1
        for place in reversed(range(digits - 1)):
            out = 2 * out + self.bit(kind, "digit", place, place == digits - 2)
        sign = (near > 0) - (near < 0)
        return -out if self.bit(kind, "sign", sign) else out


class VertexTree:
    def __init__(self, data):
        section = Bytes(data)
        section.at = 4
        version, self.count = section.take("H", 2)
        assert version == 2 and section.take("Q") == len(data)
        self.lattice, self.octants, self.base, levels = section.take("B", 4)
        rows, exponent = section.take("I"), section.take("b")
        section.at = 32
        self.scale = section.take("f", self.count)
        exponents = section.take("b", levels)
        self.finest, self.values = self.base + levels, {}
        self.bits, self.stored = BitReader(data[section.at:]), set()
        before = [0] * self.count
        for i, j in self.points(self.base):
            change = self.numbers(None, [0] * self.count)
            before = [p + q for p, q in zip(before, change)]
            self.values[self.base, i, j] = self.scaled(before, exponent)
            self.mark(self.base, i, j)
        self.details = [self.read_details(self.base + k, exponents[k]) for k in range(levels)]
        assert len(self.stored) == rows

    def points(self, level):
        n = 2 ** level
        return ((i, j) for j in range(0 if self.octants == 2 else -n, n + 1)
                for i in range(abs(j) - n, n - abs(j) + 1))

    def mark(self, level, i, j):
        self.stored.add((i << self.lattice - level, j << self.lattice - level))

    def has(self, level, i, j):
        j = abs(j) if self.octants == 2 else j
        return (i << self.lattice - level, j << self.lattice - level) in self.stored

    def scaled(self, integers, exponent):
        return [n * scale * 2.0 ** exponent for n, scale in zip(integers, self.scale)]

    def numbers(self, level, near):
        row = []
        for k in range(self.count):
            row.append(self.bits.number((level, k), near[k], any(row)))
        return row

    def read_details(self, level, exponent):
        found, near, last = {}, [0] * self.count, (0, 0)
        for i, j in self.points(level + 1):
            if i % 2 == 0 and j % 2 == 0:
                continue
            edge = 2 if i % 2 and j % 2 else j % 2
            s = (1 if (i < 0) == (j < 0) else -1) if edge == 2 else 1
            ends = ((i - i % 2, j + s * (j % 2)), (i + i % 2, j - s * (j % 2)))
            count = sum(self.has(level + 1, p, q) for p, q in ends)
            bit = self.bits.bit(level, "stored", edge, count, last)
            last = last[1], bit
            if bit:
                near = self.numbers(level, near)
                self.mark(level + 1, i, j)
                found[i // 2, j // 2, edge] = self.scaled(near, exponent)
        return found

    def vertex(self, level, i, j):
        key = level, i, j
        if key not in self.values:
            self.values[key] = self.new_vertex(level, i, j)
        return self.values[key]

    def new_vertex(self, level, i, j):
        if i % 2 == 0 and j % 2 == 0:
            return self.vertex(level - 1, i // 2, j // 2)
        if j % 2 == 0:
            edge, ends = 0, ((i - 1, j), (i + 1, j))
        elif i % 2 == 0:
            edge, ends = 1, ((i, j - 1), (i, j + 1))
        else:
            s, t = (1 if i > 0 else -1), (1 if j > 0 else -1)
            edge, ends = 2, ((i + s, j - t), (i - s, j + t))
        a, b = (self.vertex(level - 1, p // 2, q // 2) for p, q in ends)
        mean = [(p + q) / 2 for p, q in zip(a, b)]
        detail = self.details[level - 1 - self.base].get((i // 2, j // 2, edge))
        return [p + q for p, q in zip(mean, detail)] if detail else mean

    def value(self, d):
        level = min(self.lattice, 4)
        n, weights = find(level, d)
        places = lattice_corners(level, n)
        size = 2 ** self.finest
        x, y = (size * sum(w * p[k] for w, p in zip(weights, places)) for k in range(2))
        i, j = min(int(x), size - 1), int(y)
        j = min(j, size - 1 - i)
        u, v = x - i, y - j
        corners = [(i + 1, j, u), (i, j + 1, v), (i, j, 1 - u - v)]
        if u + v > 1 and i + j + 1 < size:
            corners = [(i, j + 1, 1 - u), (i + 1, j, 1 - v), (i + 1, j + 1, u + v - 1)]
        sx = -1 if d[0] < 0 else 1
        sy = -1 if d[1] < 0 and self.octants == 4 else 1
        rows = [(w, self.vertex(self.finest, sx * p, sy * q)) for p, q, w in corners]
        (a, p), (b, q), (c, r) = rows
        return [a * f + b * g + c * h for f, g, h in zip(p, q, r)]


# ---- HAAR ----------------------------------------------------------------------------------


class HaarTree:
    def __init__(self, data):
        self.level, self.octants, self.weights, self.kind = struct.unpack_from("<4B", data, 16)
        self.count, nodes, rows, means, scales, at, self.byte_level, start = (
            struct.unpack_from("<IIIIIIIQ", data, 20))
        section = Bytes(data)
        section.at = means
        self.means = rows_of(section.take("f", self.octants * self.count), self.count)
        section.at = scales
        count = 0 if self.kind == 0 else self.level * self.count
        self.scales = rows_of(section.take("f", count), self.count)
        section.at = at
        self.nodes = rows_of(section.take("I", 2 * nodes), 2)
        self.data, self.start, self.leaves = data, start, {}
        self.first_byte_row = self.find_byte_row(rows)

    def find_byte_row(self, rows):
        """The first row of a father of the level from which on rows have 8 bits."""
        if not self.byte_level:
            return rows
        level, nodes = 0, list(range(self.octants))
        while level < self.byte_level and nodes:
            nodes = [child for n in nodes for child in self.children(n) if child is not None]
            level += 1
        having = [self.nodes[n][1] >> 3 for n in nodes if self.nodes[n][1] & 7]
        return min(having, default=rows)

    def children(self, n):
        bits, index, out = self.nodes[n][0] & 15, self.nodes[n][0] >> 4, []
        for child in range(4):
            out.append(index if bits >> child & 1 else None)
            index += bits >> child & 1
        return out

    def row(self, number, level):
        letter, size = ("f", 4) if self.kind == 0 else ("h", 2)
        if self.kind and number >= self.first_byte_row:
            letter, size = "b", 1
        at = self.start + self.count * (
            size * number if number < self.first_byte_row else self.first_byte_row + number)
        values = struct.unpack_from(f"<{self.count}{letter}", self.data, at)
        if self.kind == 0:
            return values
        return [n * scale for n, scale in zip(values, self.scales[level])]

    def leaf(self, octant, n):
        """Value of leaf n of an octant."""
        if (octant, n) not in self.leaves:
            value, node, place = self.means[octant], octant, 0
            for level in range(self.level):
                child = n >> 2 * (self.level - 1 - level) & 3
                value = self.child_value(value, node, level, place, child)
                node = self.children(node)[child]
                place = 4 * place + child
                if node is None:
                    break
            self.leaves[octant, n] = value
        return self.leaves[octant, n]

    def child_value(self, mean, node, level, place, child):
        bits, number = self.nodes[node][1] & 7, self.nodes[node][1] >> 3
        details = {}
        for i in range(3):
            if bits >> i & 1:
                details[i + 1] = self.row(number, level)
                number += 1
        if child:
            row = details.get(child)
            return [m + x for m, x in zip(mean, row)] if row else mean
        areas = [area_of(level + 1, 4 * place + i) if self.weights else 1.0 for i in range(4)]
        out = list(mean)
        for i, row in details.items():
            out = [m - areas[i] / areas[0] * x for m, x in zip(out, row)]
        return out

    def around(self):
        """{corner rounded: [(octant, leaf)]} of all leaves, made once."""
        touching = {}
        for octant in range(self.octants):
            for n in range(4 ** self.level):
                for corner in corners_of(self.level, n):
                    touching.setdefault(self.key(corner, octant), []).append((octant, n))
        return touching

    @staticmethod
    def key(corner, octant):
        x = -corner[0] if octant & 1 else corner[0]
        y = -corner[1] if octant & 2 else corner[1]
        return round(x, 6) + 0.0, round(y, 6) + 0.0, round(corner[2], 6) + 0.0

    def value(self, d):
        if not hasattr(self, "touching"):
            self.touching, self.corner_values = self.around(), {}
        octant = (d[0] < 0) + 2 * (d[1] < 0 and self.octants == 4)
        n, weights = find(self.level, d)
        least = min(weights)
        out = [3 * least * x for x in self.leaf(octant, n)]
        for corner, w in zip(corners_of(self.level, n), weights):
            if w > least:
                values = self.corner_value(self.key(corner, octant))
                out = [a + (w - least) * b for a, b in zip(out, values)]
        return out[:self.count]

    def corner_value(self, key):
        if key not in self.corner_values:
            leaves = self.touching[key]
            areas = [area_of(self.level, n) for _, n in leaves]
            rows = [self.leaf(*leaf) for leaf in leaves]
            self.corner_values[key] = [dot(areas, column) / sum(areas)
                                       for column in zip(*rows)]
        return self.corner_values[key]


# ---- SAMP ----------------------------------------------------------------------------------


class SamplingTree:
    def __init__(self, data):
        _, _, self.octants, _ = struct.unpack_from("<4B", data, 4)
        self.functions, self.splits = struct.unpack_from("<HH", data, 8)
        self.size = struct.unpack_from("<I", data, 12)[0]
        self.data, self.at = data, 128
        self.next = 1
        self.top = [self.triangle(flag) for flag in self.flags(self.octants)]
        self.probabilities = self.read_probabilities()

    def bits(self, count):
        value = 0
        for i in range(count):
            value |= (self.data[self.at // 8] >> self.at % 8 & 1) << i
            self.at += 1
        return value

    def flags(self, count):
        return [self.bits(1) for _ in range(count)]

    def triangle(self, is_split):
        """None for a cell, else (number of the node, its children)."""
        if not is_split:
            return None
        number, self.next = self.next, self.next + 1
        return number, [self.triangle(flag) for flag in self.flags(4)]

    def read_probabilities(self):
        steps = [[64] * (1 if node == 0 and self.octants == 2 else 3)
                 for node in range(self.splits + 1)]
        out = []
        for _ in range(self.functions):
            k = self.bits(3)
            for node in steps:
                for i in range(len(node)):
                    n = 0
                    while self.bits(1):
                        n += 1
                    n = n << k | self.bits(k)
                    node[i] += -(n + 1) // 2 if n % 2 else n // 2
            out.append([[(i / 127) ** 2 * (3 - 2 * i / 127) for i in node] for node in steps])
        return out

    @staticmethod
    def share(node, child):
        if len(node) == 1:
            return (node[0], 1 - node[0])[child] / 2
        inside = node[1 + child // 2]
        return ((1 - node[0]) if child > 1 else node[0]) * ((1 - inside) if child % 2
                                                           else inside)

    def density(self, mix, d):
        """mix: {function: weight}; also how far d is from the cell's edges."""
        octant = (d[0] < 0) + 2 * (d[1] < 0 and self.octants == 4)
        at, level, n = self.top[octant], 0, 0
        shares = {f: self.share(self.probabilities[f][0], octant) for f in mix}
        p = (abs(d[0]), abs(d[1]), max(d[2], 0.0))
        while at:
            u, v, w = (dot(row, p) for row in coordinate_rows(level, n))
            child = 1 if u > v + w else 2 if v > w + u else 3 if w > u + v else 0
            for f in mix:
                shares[f] *= self.share(self.probabilities[f][at[0]], child)
            at, level, n = at[1][child], level + 1, 4 * n + child
        u, v, w = (dot(row, p) for row in coordinate_rows(level, n))
        density = sum(mix[f] * shares[f] for f in mix) / area_of(level, n)
        return density, min(u, v, w) / (u + v + w)
