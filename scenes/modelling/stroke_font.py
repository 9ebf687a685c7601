# SPDX-License-Identifier: Apache-2.0
"""Letters as an engraver cuts them: strokes on a grid 4 wide and 6 high, unit cap height."""

# Each glyph: polylines of two-digit points (column, row), a space between polylines.
GLYPHS = {
    "A": "00 26 40,11.5 31.5",
    "B": "00 06 26 35.5 34 23 03,23 33 42 41 30 00",
    "C": "45 36 16 05 01 10 30 41",
    "D": "00 06 26 44 42 20 00",
    "E": "46 06 00 40,03 33",
    "F": "46 06 00,03 33",
    "G": "45 36 16 05 01 10 30 41 43 23",
    "H": "00 06,40 46,03 43",
    "I": "20 26",
    "J": "46 41 30 10 01",
    "K": "00 06,46 02,13 40",
    "L": "06 00 40",
    "M": "00 06 23 46 40",
    "N": "00 06 40 46",
    "O": "10 01 05 16 36 45 41 30 10",
    "P": "00 06 36 45 44 33 03",
    "Q": "10 01 05 16 36 45 41 30 10,22 40",
    "R": "00 06 36 45 44 33 03,23 40",
    "S": "45 36 16 05 04 13 33 42 41 30 10 01",
    "T": "06 46,26 20",
    "U": "06 01 10 30 41 46",
    "V": "06 20 46",
    "W": "06 10 24 30 46",
    "X": "00 46,06 40",
    "Y": "06 23 46,23 20",
    "Z": "06 46 00 40",
    "0": "10 01 05 16 36 45 41 30 10",
    "1": "14 26 20",
    "2": "05 16 36 45 44 00 40",
    "3": "05 16 36 45 44 33 13,33 42 41 30 10 01",
    "4": "30 36 02 42",
    "5": "46 06 04 34 43 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02",
    "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33",
    "9": "01 10 30 41 45 36 16 05 04 13 33 44",
    "-": "13 33",
    "+": "13 33,25 21",
    "/": "00 46",
    ".": "20 20.6",
    ":": "21 21.6,24 24.6",
    "<": "35 13 31",
    ">": "15 33 11",
    "^": "03 26 43,26 20",
    "|": "20 26",
    "%": "00 46,06 15,31 40",
    "*": "13 33,22 24",
    "(": "36 25 21 30",
    ")": "16 25 21 10",
    "=": "12 32,14 34",
}
NARROW = {"I": 1.6, ".": 1.6, ":": 1.6, "1": 2.6, "|": 1.6, " ": 3.0, "(": 2.6, ")": 2.6}
ADVANCE = 5.6  # columns from one letter to the next


def point(token):
    """'25' or '11.5' (column, row with a fraction) in units of the cap height."""
    return float(token[0]) / 6.4, float(token[1:]) / 6.0


def strokes(string):
    """([((ax, ay), (bx, by)), ...], width) of a line of text; cap height 1."""
    out, x = [], 0.0
    for letter in string.upper():
        width = NARROW.get(letter, 4.0)
        shift = (x - (2.0 - width / 2 if letter in NARROW else 0.0)) / 6.4
        for line in GLYPHS.get(letter, "").split(",") if letter in GLYPHS else ():
            points = [point(token) for token in line.split()]
            out += [
                ((a[0] + shift, a[1]), (b[0] + shift, b[1]))
                for a, b in zip(points[:-1], points[1:])
            ]
        x += width + ADVANCE - 4.0
    return out, max(x - (ADVANCE - 4.0), 0.0) / 6.4
