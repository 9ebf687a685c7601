# SPDX-License-Identifier: Apache-2.0
"""layers.py -- what one thin film on glass and a bare metal reflect in white (D65) light."""
import cmath
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
SPECTRA = os.path.join(HERE, "..", "..", "assets", "spectra")
FILM, FILM_NM, GLASS = 1.38, 99.6, 1.52


def table(name):
    """Rows of numbers of a CSV file."""
    with open(os.path.join(SPECTRA, name), encoding="utf-8") as file:
        lines = [line for line in file if line[0].isdigit()]
    return [[float(cell) for cell in line.split(",")] for line in lines]


def white_weights():
    """(nm, share of the luminance of D65 light), summing to 1."""
    power = table("d65.csv")

    def d65(nm):
        low = max(i for i in range(len(power) - 1) if power[i][0] <= nm)
        (a, x), (b, y) = power[low], power[low + 1]
        return x + (y - x) * (nm - a) / (b - a)

    rows = [(nm, y * d65(nm)) for nm, _, y, _ in table("cie1931_2deg.csv") if nm <= 830]
    total = sum(weight for _, weight in rows)
    return [(nm, weight / total) for nm, weight in rows]


WHITE = white_weights()


def amplitude(index, cosine, is_p):
    """Of one boundary, from index[0] to index[1]; the cosine is in the first (Fresnel)."""
    sine2 = (index[0] / index[1]) ** 2 * (1 - cosine * cosine)
    behind = cmath.sqrt(1 - sine2)
    a, b = (index[1] * cosine, index[0] * behind) if is_p else \
        (index[0] * cosine, index[1] * behind)
    return (a - b) / (a + b), behind


def film_reflectance(cosine, nm, is_p):
    """Airy's sum for one film in air on glass (Born and Wolf, 1.6.4)."""
    first, inside = amplitude((1, FILM), cosine, is_p)
    second, _ = amplitude((FILM, GLASS), inside, is_p)
    turn = cmath.exp(4j * math.pi * FILM * FILM_NM * inside / nm)
    return abs((first + second * turn) / (1 + first * second * turn)) ** 2


def white(reflectance):
    """Mean over D65 light and both polarisations of reflectance(nm, is_p)."""
    return sum(weight * (reflectance(nm, False) + reflectance(nm, True)) / 2
               for nm, weight in WHITE)


def coated_face(cosine):
    return white(lambda nm, is_p: film_reflectance(cosine, nm, is_p))


def coated_pane(cosine):
    """Transmittance of a pane with the film on both faces: (1 - r) / (1 + r)."""
    def through(nm, is_p):
        r = film_reflectance(cosine, nm, is_p)
        return (1 - r) / (1 + r)
    return white(through)


def metal(cosine, index):
    return white(lambda nm, is_p: abs(amplitude((1, index), cosine, is_p)[0]) ** 2)
