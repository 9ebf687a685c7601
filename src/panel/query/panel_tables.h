/* SPDX-License-Identifier: Apache-2.0 */
/* panel_tables.h -- which tables of a reflection an incidence is made of, and their weights.
 * Private to src/panel.
 *
 * Units    angles in radians; weights sum to 1.
 * Threads  pure functions. HOT: no allocation, no libm.
 */
#pragma once
#include "base/mathf.h"
#include "base/units.h"
#include "panel/query/panel_opened.h"

typedef struct PanelTablesTerm {
    int table;
    float weight;
} PanelTablesTerm;

/* The first `straight` terms are read at the stored direction, the others at the direction
 * turned by 180 degrees (incidences from beyond the normal).
 */
typedef struct PanelTables {
    int count, straight;
    PanelTablesTerm term[16];
} PanelTables;

/* Weights of up to four neighbours. first: of the first one, may be -1 (weight 0). */
typedef struct PanelTablesCubic {
    int first;
    float weight[4];
} PanelTablesCubic;

/* Cubic Hermite between x1 and x2 with the slopes of parabolas through three; where a
 * neighbour is missing the other end's parabola serves, and a straight line where both are.
 * Weights may be negative: they are for logarithms only. x: four abscissae, those missing are
 * not read. */
static inline void panel_tables_hermite(const float x[4], bool has_left, bool has_right, float u,
                                        float w[4]) {
    float h = x[2] - x[1], u2 = u * u, u3 = u2 * u;
    float a = (u3 - 2 * u2 + u) * h, b = (u3 - u2) * h; /* of the slopes at the two ends */
    float h0 = has_left ? x[1] - x[0] : 0, h2 = has_right ? x[3] - x[2] : 0;
    /* with divided differences d0, d1, d2 the slope at x1 is (h d0 + h0 d1) / (h0 + h); at an
     * end without neighbour the parabola's: 2 d1 less the slope at the other end */
    float a0 = has_left ? a * h / (h0 + h) : 0, a1 = a - a0;
    float b2 = has_right ? b * h / (h + h2) : 0, b1 = b - b2;
    if (!has_right && has_left) b1 = b * (2 - h0 / (h0 + h)), a0 -= b * h / (h0 + h);
    if (!has_left && has_right) a1 = a * (2 - h2 / (h + h2)), b2 -= a * h / (h + h2);
    w[0] = has_left ? -a0 / h0 : 0;
    w[3] = has_right ? b2 / h2 : 0;
    w[1] = 2 * u3 - 3 * u2 + 1 - w[0] - (a1 + b1) / h;
    w[2] = 3 * u2 - 2 * u3 - w[3] + (a1 + b1) / h;
}

/* The interval is counted, not searched for: it cannot be predicted. */
static inline int panel_tables_incidence(const PanelReflection *r, float theta, float weight[4]) {
    int i = 0, n = (int)r->steps;
    for (int k = 1; k < n - 1; k++) i += r->step[k].theta <= theta;
    float span = n > 1 ? r->step[i + 1].theta - r->step[i].theta : 1;
    float u = clampf((theta - r->step[i].theta) / span, 0, 1);
    const float(*of)[4] = r->step_cubic[i];
    for (int k = 0; k < 4; k++)
        weight[k] = of[0][k] + u * (of[1][k] + u * (of[2][k] + u * of[3][k]));
    return i;
}

/* phi in radians; azimuths repeat after a turn. Linear over fewer than four. */
static inline PanelTablesCubic panel_tables_azimuth(const PanelReflection *r, float phi) {
    int n = (int)r->azimuths, i = -1;
    float x[4];
    phi -= 2 * PI_F * (float)(int)(phi / (2 * PI_F));
    if (phi < 0) phi += 2 * PI_F;
    while (i + 1 < n && r->azimuth[i + 1] <= phi) i++;
    for (int k = 0; k < 4; k++) {
        int j = i - 1 + k, turn = j < 0 ? -1 : j >= n ? 1 : 0;
        x[k] = j - turn * n >= 0 && j - turn * n < n
                   ? r->azimuth[j - turn * n] + 2 * PI_F * (float)turn
                   : 0;
    }
    float u = clampf((phi - x[1]) / (x[2] - x[1]), 0, 1);
    PanelTablesCubic cubic = {i - 1, {0, 1 - u, u, 0}};
    if (n >= 4) panel_tables_hermite(x, true, true, u, cubic.weight);
    return cubic;
}

/* Isotropic panels: a table for each incidence. Always
 * as many terms, those that are missing with a weight of 0: branches could not be predicted. */
static inline PanelTables panel_tables_isotropic(const PanelReflection *r, float theta) {
    PanelTables mix;
    float weight[4];
    const PanelNeighbours *near = &r->neighbours[panel_tables_incidence(r, theta, weight)];
    mix.count = PANEL_NEIGHBOURS;
    mix.straight = near->straight;
    for (int k = 0; k < PANEL_NEIGHBOURS; k++)
        mix.term[k] = (PanelTablesTerm){near->incidence[k], weight[near->of[k]]};
    return mix;
}

/* light: its azimuth in the display's frame. */
static inline PanelTables panel_tables_at(const PanelReflection *r, float theta, float light) {
    if (r->azimuths == 1) return panel_tables_isotropic(r, theta);
    PanelTables mix = {0};
    float weight[4];
    int n = (int)r->azimuths, row = (int)r->incidences;
    PanelTablesCubic azimuth[2] = {panel_tables_azimuth(r, light),
                                   panel_tables_azimuth(r, light + PI_F)};
    const PanelNeighbours *near = &r->neighbours[panel_tables_incidence(r, theta, weight)];
    for (int k = 0; k < PANEL_NEIGHBOURS; k++) {
        float of_incidence = weight[near->of[k]];
        const PanelTablesCubic *around = &azimuth[near->is_turned[k]];
        for (int a = 0; a < 4 && of_incidence != 0; a++) {
            if (around->weight[a] == 0) continue;
            int at = (around->first + a + n) % n;
            mix.term[mix.count++] =
                (PanelTablesTerm){at * row + near->incidence[k], of_incidence * around->weight[a]};
            mix.straight += k < near->straight;
        }
    }
    return mix;
}

/* At the last incidence most weights are 0, always the same ones: they are left out. */
static inline PanelTables panel_tables_last(const PanelReflection *r, float light) {
    PanelTables all = panel_tables_at(r, r->last_theta, light), mix = {0};
    for (int i = 0; i < all.count; i++) {
        if (all.term[i].weight == 0) continue;
        mix.term[mix.count++] = all.term[i];
        mix.straight += i < all.straight;
    }
    return mix;
}
