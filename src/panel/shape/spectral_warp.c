/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/shape/spectral_warp.h"

#include <math.h>
#include <string.h>

#include "base/sort.h"

#define WARP_LIMIT 24.0                 /* largest |c1|, |c2| that counts as a solution */
#define HALVES (2 * SPECTRAL_COUNT - 1) /* whole and half nm */

/* e^x and ln x in double precision (to about 1e-13), from nothing that a library decides. */
static double exp_d(double x) {
    if (x < -700) return 0;
    if (x > 700) x = 700;
    double n = floor(x * 1.4426950408889634 + 0.5), r = x - n * 0.6931471805599453;
    double sum = 1, term = 1;
    for (int k = 1; k <= 13; k++) {
        term *= r / k;
        sum += term;
    }
    return ldexp(sum, (int)n);
}

static double log_d(double x) {
    double y = (double)log_f((float)x);
    for (int k = 0; k < 2; k++) {
        double e = exp_d(y);
        y += 2 * (x - e) / (x + e);
    }
    return y;
}

/* ---- spectra --------------------------------------------------------------------------- */

static double observer(const SpectralRow *row, int j) {
    return (double)(j == 0 ? row->x : j == 1 ? row->y : row->z);
}

/* Spectrum times observer times Simpson's weights on every half nm: exact for the product of
 * what is linear between whole nm. Few numbers count where the light is in few places. */
typedef struct WarpSource {
    double t_first, t_step;
    int first, count;
    double part[3][HALVES];
    double spectrum[HALVES];
    double peak; /* of the spectrum per unit of luminance */
} WarpSource;

static void fill_source(const float *spectrum, WarpSource *out) {
    int last = -1;
    *out = (WarpSource){
        .t_first = (SPECTRAL_FIRST_NM - 560) / 180.0, .t_step = 0.5 / 180, .first = HALVES};
    for (int h = 0; h < HALVES; h++) {
        int i = h / 2;
        double weight = h == 0 || h == HALVES - 1 ? 1.0 / 6 : h % 2 ? 4.0 / 6 : 2.0 / 6;
        double s =
            h % 2 ? 0.5 * ((double)spectrum[i] + (double)spectrum[i + 1]) : (double)spectrum[i];
        if (!(s > 0)) continue;
        out->spectrum[h] = s;
        out->peak = fmax(out->peak, s);
        if (h < out->first) out->first = h;
        last = h;
        for (int j = 0; j < 3; j++) {
            double bar = observer(&spectral_table[i], j);
            if (h % 2) bar = 0.5 * (bar + observer(&spectral_table[i + 1], j));
            out->part[j][h] = LUMINOUS_EFFICACY_MAX * weight * s * bar;
        }
    }
    out->count = last < 0 ? 0 : last - out->first + 1;
}

/* Integrals of S x-bar_j t^k for c0 = 0; the largest factor along the spectrum. The factor's
 * steps are those of a geometric series whose quotient is one too. */
static double moments(const WarpSource *s, const double c[3], double moment[3][3]) {
    double t0 = s->t_first + s->first * s->t_step, d = s->t_step, most = 0;
    double factor = exp_d(c[1] * t0 + c[2] * t0 * t0);
    double quotient = exp_d(c[1] * d + c[2] * (2 * t0 * d + d * d));
    double quotient_step = exp_d(2 * c[2] * d * d);
    memset(moment, 0, 9 * sizeof(double));
    for (int h = s->first; h < s->first + s->count; h++) {
        double t = s->t_first + h * d, ft = factor * t, ftt = ft * t;
        for (int j = 0; j < 3; j++) {
            double p = s->part[j][h];
            moment[j][0] += p * factor;
            moment[j][1] += p * ft;
            moment[j][2] += p * ftt;
        }
        double light = s->spectrum[h] * factor;
        most = light > most ? light : most;
        factor *= quotient;
        quotient *= quotient_step;
    }
    return most;
}

void panel_spectrum_xyz(const float *spectrum, double xyz[3]) {
    WarpSource source;
    double moment[3][3], zero[3] = {0, 0, 0};
    fill_source(spectrum, &source);
    moments(&source, zero, moment);
    for (int j = 0; j < 3; j++) xyz[j] = moment[j][0];
}

bool panel_spectrum_normalise(float *spectrum) {
    double xyz[3];
    panel_spectrum_xyz(spectrum, xyz);
    if (!(xyz[0] > 0 && xyz[1] > 0 && xyz[2] > 0)) return false;
    for (int i = 0; i < SPECTRAL_COUNT; i++) spectrum[i] = (float)((double)spectrum[i] / xyz[1]);
    return true;
}

void panel_spectrum_default(PanelSpectraKind kind, int primary, float *out) {
    static const struct {
        double nm, fwhm;
    } typical[3] = {{625, 40}, {535, 50}, {455, 25}};
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        const SpectralRow *row = &spectral_table[i];
        float share = primary == 0 ? row->red : primary == 1 ? row->green : row->blue;
        double d = (SPECTRAL_FIRST_NM + i - typical[primary].nm) / typical[primary].fwhm;
        out[i] = kind == PANEL_SPECTRA_REC709 ? share * row->d65
                                              : (float)(exp_d(-2.772588722239781 * d * d) + 1e-4);
    }
}

/* ---- one colour ------------------------------------------------------------------------ */

/* Rows: ln X - ln Y - u, ln Z - ln Y - v, over c1, c2 (c0 follows from Y). */
static double warp_rest(const double moment[3][3], const double ratio[2], double rest[2],
                        double jacobian[4]) {
    double mean[3][2];
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 2; k++) mean[j][k] = moment[j][k + 1] / moment[j][0];
    for (int r = 0; r < 2; r++) {
        int j = r ? 2 : 0;
        rest[r] = log_d(moment[j][0] / moment[1][0]) - ratio[r];
        for (int k = 0; k < 2; k++) jacobian[2 * r + k] = mean[j][k] - mean[1][k];
    }
    return fmax(fabs(rest[0]), fabs(rest[1]));
}

/* Newton from c, which holds the result. At the same luminance, the spectrum must nowhere be
 * four times as high as its highest peak was: extreme coefficients blow up the tails. */
static bool warp_to(const WarpSource *source, const double ratio[2], double c[3]) {
    double moment[3][3], rest[2], jacobian[4], at[3] = {0, c[1], c[2]};
    for (int step = 0; step < 40; step++) {
        double most = moments(source, at, moment);
        if (!(moment[0][0] > 0 && moment[1][0] > 0 && moment[2][0] > 0)) return false;
        double miss = warp_rest((const double(*)[3])moment, ratio, rest, jacobian);
        if (miss < 1e-9) {
            c[0] = -log_d(moment[1][0]);
            c[1] = at[1];
            c[2] = at[2];
            return most < 4 * source->peak * moment[1][0];
        }
        double det = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2];
        if (!(fabs(det) > 1e-14)) return false;
        double d1 = -(jacobian[3] * rest[0] - jacobian[1] * rest[1]) / det;
        double d2 = -(jacobian[0] * rest[1] - jacobian[2] * rest[0]) / det;
        double longest = fmax(fabs(d1), fabs(d2)), damp = longest > 4 ? 4 / longest : 1;
        at[1] += damp * d1;
        at[2] += damp * d2;
        if (!(fabs(at[1]) < WARP_LIMIT && fabs(at[2]) < WARP_LIMIT)) return false;
    }
    return false;
}

/* From a colour that was reached (`from`, with coefficients c) as far towards `to` as warping
 * goes, by halving the way. True when it goes all the way. */
static bool warp_along(const WarpSource *source, const double from[2], const double to[2],
                       double c[3]) {
    double good = 0, bad = 1, trial[3] = {c[0], c[1], c[2]};
    if (warp_to(source, to, trial)) {
        memcpy(c, trial, sizeof trial);
        return true;
    }
    for (int i = 0; i < 6; i++) {
        double middle = 0.5 * (good + bad);
        double target[2] = {from[0] + middle * (to[0] - from[0]),
                            from[1] + middle * (to[1] - from[1])};
        memcpy(trial, c, sizeof trial);
        if (warp_to(source, target, trial)) {
            good = middle;
            memcpy(c, trial, sizeof trial);
        } else {
            bad = middle;
        }
    }
    return false;
}

/* ---- the table ------------------------------------------------------------------------- */

/* (ln X/Y, ln Z/Y) at a node. */
static void node_ratio(const SpectralWarpRange *range, double along, double across,
                       double ratio[2]) {
    double ax = (double)range->along[0], ay = (double)range->along[1];
    ratio[0] = (double)range->origin[0] + along * ax - across * ay;
    ratio[1] = (double)range->origin[1] + along * ay + across * ax;
}

static double node_at(const SpectralWarpRange *range, int coordinate, int index) {
    double low = (double)range->low[coordinate], high = (double)range->high[coordinate];
    return low + (high - low) * index / (SPECTRAL_WARP_SIDE - 1);
}

/* From the middle of the row to either side, each start its neighbour's solution. */
static int fill_across(const WarpSource *source, int i, double along, const double start[3],
                       bool is_reached, SpectralWarp *warp) {
    double middle[2];
    int missed = 0, centre = SPECTRAL_WARP_SIDE / 2;
    node_ratio(&warp->range, along, 0, middle);
    for (int side = 0; side < 2; side++) {
        double c[3] = {start[0], start[1], start[2]}, from[2] = {middle[0], middle[1]}, to[2];
        bool goes_on = is_reached;
        int j = side ? centre - 1 : centre;
        for (; j >= 0 && j < SPECTRAL_WARP_SIDE; j += side ? -1 : 1) {
            node_ratio(&warp->range, along, node_at(&warp->range, 1, j), to);
            goes_on = goes_on && warp_along(source, from, to, c);
            missed += !goes_on;
            memcpy(from, to, sizeof from);
            for (int k = 0; k < 3; k++)
                warp->coefficient[j * SPECTRAL_WARP_SIDE + i][k] = (float)c[k];
        }
    }
    return missed;
}

int spectral_warp_fill(const float *spectrum, SpectralWarp *warp) {
    WarpSource source;
    double moment[3][3], zero[3] = {0, 0, 0}, from[2], to[2], c[3] = {0, 0, 0};
    int missed = 0;
    bool is_reached = true;
    fill_source(spectrum, &source);
    moments(&source, zero, moment);
    from[0] = log_d(moment[0][0] / moment[1][0]);
    from[1] = log_d(moment[2][0] / moment[1][0]);
    warp_to(&source, from, c);
    for (int i = 0; i < SPECTRAL_WARP_SIDE; i++) {
        double along = node_at(&warp->range, 0, i);
        node_ratio(&warp->range, along, 0, to);
        is_reached = warp_along(&source, from, to, c);
        if (is_reached) memcpy(from, to, sizeof from);
        missed += fill_across(&source, i, along, c, is_reached, warp);
    }
    return missed;
}

/* ---- where colours lie ------------------------------------------------------------------ */

/* The centre of the cloud and the direction of its largest spread. */
static void cloud_axes(float *const ratio[2], int count, SpectralWarpRange *out) {
    double mean[2] = {0, 0}, m[3] = {0, 0, 0};
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) mean[k] += (double)ratio[k][i] / count;
    for (int i = 0; i < count; i++) {
        double u = (double)ratio[0][i] - mean[0], v = (double)ratio[1][i] - mean[1];
        m[0] += u * u, m[1] += u * v, m[2] += v * v;
    }
    double half = 0.5 * (m[0] - m[2]), root = sqrt(half * half + m[1] * m[1]);
    double a = half >= 0 ? half + root : m[1], b = half >= 0 ? m[1] : root - half;
    double size = sqrt(a * a + b * b);
    for (int k = 0; k < 2; k++) out->origin[k] = (float)mean[k];
    out->along[0] = size > 0 ? (float)(a / size) : 1;
    out->along[1] = size > 0 ? (float)(b / size) : 0;
}

/* Half a percent at either end is left out, a margin is added. */
SpectralWarpRange spectral_warp_range(float *const ratio[2], int count) {
    SpectralWarpRange out = {.along = {1, 0}, .low = {-1, -1}, .high = {1, 1}};
    if (!count) return out;
    cloud_axes(ratio, count, &out);
    for (int i = 0; i < count; i++) {
        float u = ratio[0][i] - out.origin[0], v = ratio[1][i] - out.origin[1];
        ratio[0][i] = u * out.along[0] + v * out.along[1];
        ratio[1][i] = v * out.along[0] - u * out.along[1];
    }
    for (int k = 0; k < 2; k++) {
        float low = sort_ranked(ratio[k], count, count / 200);
        float high = sort_ranked(ratio[k], count, count - 1 - count / 200);
        float margin = 0.002f + 0.05f * (high - low);
        out.low[k] = low - margin;
        out.high[k] = high + margin;
    }
    return out;
}
