/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/shape/panel_levels.h"

/* d slope / d steepness of the intervals before and behind a node, at the mean curve. */
typedef struct SlopeParts {
    float before, behind;
} SlopeParts;

/* Fritsch and Butland's weighted harmonic mean; it is homogeneous of first order, so that its
 * derivatives give it back at the curve itself. 0 at an extremum. */
static SlopeParts slope_parts(float h0, float h1, float d0, float d1) {
    if (!(d0 * d1 > 0)) return (SlopeParts){0, 0};
    float w0 = 2 * h1 + h0, w1 = h1 + 2 * h0, mean = w0 * d1 + w1 * d0;
    return (SlopeParts){(w0 + w1) * w0 * d1 * d1 / (mean * mean),
                        (w0 + w1) * w1 * d0 * d0 / (mean * mean)};
}

/* Adds slope * (y[i + 1] - y[i]) / h to the weights, whose first one is of level `first`. */
static void add_steepness(PanelLevelWeights *out, const float *x, int i, float slope) {
    float per = slope / (x[i + 1] - x[i]);
    out->weight[i - out->first] -= per;
    out->weight[i + 1 - out->first] += per;
}

/* The slope at a node, times factor. */
static void add_slope(PanelLevelWeights *out, const float *x, const float *y, int count, int node,
                      float factor) {
    if (node == 0 || node == count - 1) {
        add_steepness(out, x, node ? node - 1 : 0, factor);
        return;
    }
    float h0 = x[node] - x[node - 1], h1 = x[node + 1] - x[node];
    SlopeParts part =
        slope_parts(h0, h1, (y[node] - y[node - 1]) / h0, (y[node + 1] - y[node]) / h1);
    add_steepness(out, x, node - 1, factor * part.before);
    add_steepness(out, x, node, factor * part.behind);
}

PanelLevelWeights panel_level_weights(const float *log_level, const float *curve, int count,
                                      float level_power, float log_code) {
    const float *x = log_level;
    int i = 0;
    if (count == 1) return (PanelLevelWeights){0, {1, 0, 0, 0}, level_power * (log_code - x[0])};
    while (i + 1 < count && x[i + 1] <= log_code) i++;
    if (log_code == x[i]) return (PanelLevelWeights){i, {1, 0, 0, 0}, 0};
    if (log_code < x[0] || i == count - 1) { /* the power law of the last two goes on */
        int from = log_code < x[0] ? 0 : count - 2;
        float t = (log_code - x[from]) / (x[from + 1] - x[from]);
        return (PanelLevelWeights){from, {1 - t, t, 0, 0}, 0};
    }
    PanelLevelWeights out = {.first = i > 0 ? i - 1 : 0};
    float h = x[i + 1] - x[i], t = (log_code - x[i]) / h, t2 = t * t, t3 = t2 * t;
    out.weight[i - out.first] += 2 * t3 - 3 * t2 + 1;
    out.weight[i + 1 - out.first] += 3 * t2 - 2 * t3;
    add_slope(&out, x, curve, count, i, h * (t3 - 2 * t2 + t));
    add_slope(&out, x, curve, count, i + 1, h * (t3 - t2));
    return out;
}
