#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes src/spectrum/spectral_table.c from the published CIE tables beside this script.

    python3 assets/spectra/make_spectral_table.py       (needs numpy; takes about a minute)

Every function of wavelength here is linear between its values at whole nanometres, from 360 to
830 nm; integrals of products of up to three of them are exact (Simpson's rule a nanometre).

The spectra of red, green and blue solve the problem posed by Mallett and Yuksel, "Spectral
Primary Decomposition for Rendering with sRGB Reflectance" (EGSR 2019): the smoothest three
spectra that add up to one, lie within [0, 1], and show exactly the three Rec.709 primaries
under D65. With blue = 1 - red - green that is a convex quadratic program in red and green,
solved by a primal-dual interior point method.
"""
import pathlib
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
OUT = HERE.parents[1] / "src" / "spectrum" / "spectral_table.c"
FIRST, LAST = 360, 830
NM = np.arange(FIRST, LAST + 1.0)
K_M = 683.002  # lm/W, CIE
GUIDES = 512  # equal shares of the density, for a quick start of its inversion
UNIFORM_SHARE = 0.02  # of the density that wavelengths are drawn from


def read(name):
    return np.genfromtxt(HERE / name, delimiter=",", skip_header=2)


def weights(*functions):
    """w with w @ g = exact integral of g times the product of one or two linear functions."""
    ends, middle = np.ones_like(NM), np.ones(len(NM) - 1)
    for f in functions:
        ends = ends * f
        middle = middle * (f[:-1] + f[1:]) / 2
    w = np.zeros_like(NM)
    w[:-1] += ends[:-1] / 6 + middle / 3
    w[1:] += ends[1:] / 6 + middle / 3
    return w


def illuminant_a():
    """CIE 015: a Planckian of 2848 K in the constants of 1931."""
    planck = lambda nm: nm ** -5.0 / np.expm1(1.435e7 / (2848 * nm))
    return planck(NM) / planck(560.0)


def rgb_from_xyz(white):
    """Rec.709's primaries with the given white (XYZ, Y = 1)."""
    xy = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])
    primaries = np.array([[x / y, 1, (1 - x - y) / y] for x, y in xy]).T
    return np.linalg.inv(primaries * np.linalg.solve(primaries, white))


def interior_point(hessian, linear, equal, equal_to, less, less_to, start):
    """min x'Hx/2 + q'x where Ax = b and Gx <= h (Nocedal and Wright, section 16.6)."""
    x = start
    slack = less_to - less @ x
    dual, multiplier = np.ones(len(slack)), np.zeros(len(equal_to))
    for step in range(200):
        gap = slack @ dual / len(slack)
        residual = hessian @ x + linear + equal.T @ multiplier + less.T @ dual
        miss = equal @ x - equal_to
        print(f"  step {step}: gap {gap:.3e}, residual {abs(residual).max():.3e}")
        if gap < 1e-17 and abs(residual).max() < 1e-12 and abs(miss).max() < 1e-14:
            break
        target = 0.1 * gap
        kkt = np.block([[hessian + (less.T * (dual / slack)) @ less, equal.T],
                        [equal, np.zeros((len(equal), len(equal)))]])
        side = -np.concatenate([residual + less.T @ (target / slack - dual), miss])
        move = np.linalg.solve(kkt, side)
        dx = move[:len(x)]
        ds = -(less @ dx)
        dd = (target - dual * ds) / slack - dual
        length = 1.0
        for value, change in ((slack, ds), (dual, dd)):
            down = change < 0
            if down.any():
                length = min(length, 0.995 * (-value[down] / change[down]).min())
        x, slack, dual = x + length * dx, slack + length * ds, dual + length * dd
        multiplier = multiplier + length * move[len(x):]
    return x


def solve_basis(observer, d65, matrix):
    """Red, green, blue reflectances; d65 has luminance 1 under the observer (K_m included)."""
    n = len(NM)
    show = matrix @ (K_M * np.array([weights(o, d65) for o in observer]))  # to RGB
    d = np.diff(np.eye(n), axis=0)
    smooth = d.T @ d
    zero, eye = np.zeros((n, n)), np.eye(n)
    hessian = np.block([[2 * smooth, smooth], [smooth, 2 * smooth]])
    equal = np.block([[show, np.zeros((3, n))], [np.zeros((3, n)), show]])
    equal_to = np.array([1.0, 0, 0, 0, 1, 0])
    less = np.block([[-eye, zero], [zero, -eye], [eye, eye]])
    less_to = np.concatenate([np.zeros(2 * n), np.ones(n)])
    x = interior_point(hessian, np.zeros(2 * n), equal, equal_to, less, less_to,
                       np.full(2 * n, 1 / 3))
    red, green = np.clip(x[:n], 0, 1), np.clip(x[n:], 0, 1)
    blue = np.clip(1 - red - green, 0, 1)
    for name, spectrum in zip(("red", "green", "blue"), (red, green, blue)):
        print(name, "shows as", show @ spectrum)
    return red, green, blue


def sampling_steps(observer):
    """Probability of each nanometre in units of 2^-24, so that their sums are exact."""
    total = observer.sum(axis=0)
    mass = (total[:-1] + total[1:]) / 2
    mass = (1 - UNIFORM_SHARE) * mass / mass.sum() + UNIFORM_SHARE / len(mass)
    cumulative = np.rint(np.concatenate([[0], np.cumsum(mass)]) * 2 ** 24).astype(int)
    assert cumulative[-1] == 2 ** 24 and (np.diff(cumulative) > 0).all()
    return cumulative


HEAD = """/* SPDX-License-Identifier: Apache-2.0 */
/* Made by assets/spectra/make_spectral_table.py: change that, not this. */
#include "spectrum/spectral_table.h"

"""


def main():
    observer = read("cie1931_2deg.csv")[:, 1:].T
    nm, power = read("d65.csv").T
    d65, a = np.interp(NM, nm, power), illuminant_a()
    d65 /= K_M * (weights(d65) @ observer[1])
    a /= K_M * (weights(a) @ observer[1])
    white = K_M * np.array([weights(d65) @ o for o in observer])
    matrix = rgb_from_xyz(white)
    print("D65 white", white, "\nRGB from XYZ\n", matrix)
    basis = solve_basis(observer, d65, matrix)
    rows = zip(*observer, *basis, d65, a)
    text = HEAD + "const SpectralRow spectral_table[SPECTRAL_COUNT] = {\n"
    text += "".join(row(*values) for values in rows)
    steps = sampling_steps(observer)
    guide = np.searchsorted(steps, np.arange(GUIDES) * 2 ** 24 // GUIDES, side="right") - 1
    text += "};\n\n" + numbers("const float wavelength_steps[SPECTRAL_COUNT]", steps, 9)
    text += "\n" + numbers("const short wavelength_guide[WAVELENGTH_GUIDES]", guide, 18)
    text += "\n" + numbers("const float d65_white_xyz[3]", white)
    text += "\n" + numbers("const float rgb_from_xyz_matrix[9]", matrix.ravel())
    text += "\n" + numbers("const float xyz_from_rgb_matrix[9]", np.linalg.inv(matrix).ravel())
    OUT.write_text(text)


def row(x, y, z, red, green, blue, *sources):
    texts = [f"{v:.6g}" for v in (x, y, z)]
    texts += [f"{v:.6f}".rstrip("0").rstrip(".") for v in
              (red, green, abs(1 - round(red, 6) - round(green, 6)))]
    texts += [f"{v:.6g}" for v in sources]
    return "    {" + ", ".join(texts) + "},\n"


def numbers(name, values, per_line=5):
    lines = [values[i:i + per_line] for i in range(0, len(values), per_line)]
    texts = (", ".join(f"{np.float32(v):.9g}" for v in line) for line in lines)
    return name + " = {\n" + "".join(f"    {text},\n" for text in texts) + "};\n"


if __name__ == "__main__":
    main()
