/* SPDX-License-Identifier: Apache-2.0 */
/* spectral_warp.h -- how the spectra of a panel's primaries are warped to a measured colour.
 * Private to src/panel.
 *
 * S = T exp(c0 + c1 t + c2 t^2), t = (lambda - 560 nm) / 180 nm, T the primary's spectrum, all
 * linear between whole nm. Only +, -, *, / and square roots, so that tables come out the same
 * everywhere.
 */
#pragma once
#include <stdbool.h>

#include "base/mathf.h"
#include "spectrum/spectral_table.h"

#define SPECTRAL_WARP_SIDE 17

/* How a primary's spectrum warps: coefficients over (u, v) = (ln X/Y, ln Z/Y), in axes along
 * which the measured colours spread: those of a narrow primary lie along a curve, and warping
 * reaches hardly anything beside it. First coordinate: along, second: across. */
typedef struct SpectralWarpRange {
    float origin[2], along[2]; /* in (u, v); a unit vector, across = (-along[1], along[0]) */
    float low[2], high[2];     /* of the two coordinates */
} SpectralWarpRange;

typedef struct SpectralWarp {
    SpectralWarpRange range;
    float coefficient[SPECTRAL_WARP_SIDE * SPECTRAL_WARP_SIDE][3]; /* across * side + along */
} SpectralWarp;

/* Where colours lie: `count` pairs (ln X/Y, ln Z/Y), which are overwritten. */
SpectralWarpRange spectral_warp_range(float *const ratio[2], int count);

/* The table of coefficients over warp->range for a spectrum of 1 cd m^-2. Returns how many
 * colours cannot be reached: there the nearest ones on the way from its own colour serve. */
int spectral_warp_fill(const float *spectrum, SpectralWarp *warp);

/* XYZ, Y in cd m^-2, of a spectrum that is linear between whole nm. */
void panel_spectrum_xyz(const float *spectrum, double xyz[3]);

/* Scales a spectrum to 1 cd m^-2; false: it has no light. */
bool panel_spectrum_normalise(float *spectrum);

/* Where a panel has no spectra of its own. */
typedef enum PanelSpectraKind {
    PANEL_SPECTRA_STORED = 0,
    PANEL_SPECTRA_TYPICAL = 1, /* peaks at 625, 535 and 455 nm */
    PANEL_SPECTRA_REC709 = 2   /* the Rec.709 primaries' smooth spectra under D65 */
} PanelSpectraKind;

/* Relative spectrum of primary 0..2. */
void panel_spectrum_default(PanelSpectraKind kind, int primary, float *out);

/* ---- a query ----------------------------------------------------------------------------- */

/* Weights of a Catmull-Rom cubic over four neighbours of an even row. */
static inline int spectral_warp_cell(float at, float low, float high, float weight[4]) {
    float s = (at - low) / (high - low) * (SPECTRAL_WARP_SIDE - 1);
    s = clampf(s, 0, SPECTRAL_WARP_SIDE - 1);
    int cell = (int)s;
    if (cell > SPECTRAL_WARP_SIDE - 2) cell = SPECTRAL_WARP_SIDE - 2;
    float t = s - (float)cell, t2 = t * t, t3 = t2 * t;
    weight[0] = 0.5f * (2 * t2 - t3 - t);
    weight[1] = 0.5f * (3 * t3 - 5 * t2 + 2);
    weight[2] = 0.5f * (4 * t2 - 3 * t3 + t);
    weight[3] = 0.5f * (t3 - t2);
    if (cell == 0) { /* one neighbour is missing: the straight line goes on */
        weight[1] += 2 * weight[0];
        weight[2] -= weight[0];
        weight[0] = 0;
    }
    if (cell == SPECTRAL_WARP_SIDE - 2) {
        weight[2] += 2 * weight[3];
        weight[1] -= weight[3];
        weight[3] = 0;
    }
    return cell - 1;
}

/* HOT. c0, c1, c2 of a source of 1 cd m^-2 for ln XYZ (only the ratios count). */
static inline void spectral_warp_at(const SpectralWarp *warp, const float logs[3],
                                    float coefficient[3]) {
    float wu[4], wv[4];
    float du = logs[0] - logs[1] - warp->range.origin[0];
    float dv = logs[2] - logs[1] - warp->range.origin[1];
    float along = du * warp->range.along[0] + dv * warp->range.along[1];
    float across = dv * warp->range.along[0] - du * warp->range.along[1];
    int u = spectral_warp_cell(along, warp->range.low[0], warp->range.high[0], wu);
    int v = spectral_warp_cell(across, warp->range.low[1], warp->range.high[1], wv);
    coefficient[0] = coefficient[1] = coefficient[2] = 0;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            float w = wu[i] * wv[j];
            if (w == 0) continue;
            const float *from = warp->coefficient[(v + j) * SPECTRAL_WARP_SIDE + u + i];
            for (int k = 0; k < 3; k++) coefficient[k] += w * from[k];
        }
}
