/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/primary_bands.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "panel/shape/spectral_warp.h"
#include "spectrum/twice.h"

const char *const primary_backlights[] = {"wled-ysf", "wled-ksf", "oled", "qd",
                                          "rgb-led",  "laser",    NULL};

/* Peaks and widths at half height, of red, green and blue. */
static const struct {
    double peak_nm[3], fwhm_nm[3];
} kinds[] = {{{605, 540, 450}, {80, 75, 22}}, {{631, 540, 448}, {20, 55, 20}},
             {{622, 530, 458}, {45, 38, 28}}, {{632, 530, 450}, {30, 35, 22}},
             {{630, 525, 460}, {20, 34, 22}}, {{638, 525, 460}, {2, 2, 2}}};

int primary_backlight_named(const char *name) {
    for (int i = 0; primary_backlights[i]; i++)
        if (!strcmp(name, primary_backlights[i])) return i + 1;
    return 0;
}

const char *primary_backlight_names(Arena *arena) {
    const char *text = primary_backlights[0];
    for (int i = 1; primary_backlights[i]; i++)
        text = arena_format(arena, "%s, %s", text, primary_backlights[i]);
    return text;
}

#define MOVES 30 /* nm that a peak may move to either side, where none is stated */
#define PEAKS (2 * MOVES + 1)
#define FAR 1e30
#define BELL 2.772588722239781 /* 4 ln 2 */

/* How much narrower bands may become. */
static const double shares[] = {1, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2, 0.1, 0.05, 0.0125};

/* ---- bands ------------------------------------------------------------------------------- */

/* A bell at multiples of a step that is fine beside it, linear between. */
static void draw_band(double peak_nm, double fwhm_nm, float *out) {
    int step = fwhm_nm >= 40 ? 10 : fwhm_nm >= 20 ? 5 : fwhm_nm >= 8 ? 2 : 1;
    fwhm_nm = fmax(fwhm_nm, 0.8); /* else it may lie between whole nm */
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        int nm = SPECTRAL_FIRST_NM + i, low = nm / step * step;
        double a = (low - peak_nm) / fwhm_nm, b = (low + step - peak_nm) / fwhm_nm;
        double t = (double)(nm - low) / step;
        double from = exp_d(-BELL * a * a), to = exp_d(-BELL * b * b);
        out[i] = (float)((from < 1e-3 ? 0 : from) * (1 - t) + (to < 1e-3 ? 0 : to) * t);
    }
}

typedef struct BandSearch {
    const double (*xyz)[3]; /* of the primaries */
    double centre_nm[3];
    double band[3][PEAKS][3]; /* XYZ of a band at each of its peaks */
} BandSearch;

static double det3(const double *a, const double *b, const double *c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* Parts of the bands in a colour, none below 0; returns its delta u'v'. */
static double mix(const double *const band[3], const double xyz[3], double part[3]) {
    double all = det3(band[0], band[1], band[2]), found[3] = {0, 0, 0};
    bool is_inside = true;
    if (!(fabs(all) > 0)) return FAR;
    part[0] = det3(xyz, band[1], band[2]) / all;
    part[1] = det3(band[0], xyz, band[2]) / all;
    part[2] = det3(band[0], band[1], xyz) / all;
    for (int k = 0; k < 3; k++) {
        is_inside &= part[k] >= 0;
        part[k] = fmax(part[k], 0);
        for (int j = 0; j < 3; j++) found[j] += part[k] * band[k][j];
    }
    if (is_inside) return 0;
    for (int k = 0; k < 3; k++) part[k] *= xyz[1] / fmax(found[1], 1e-300);
    return twice_colour(found, xyz);
}

/* The misses of the three, a sum; stops beyond `most`. */
static double miss_of(const double *const band[3], const double (*xyz)[3], double most) {
    double miss = 0, part[3];
    for (int p = 0; p < 3 && miss <= most; p++) miss += mix(band, xyz[p], part);
    return miss;
}

/* ---- the search -------------------------------------------------------------------------- */

static void fill_bands(BandSearch *s, const double fwhm_nm[3], double step) {
    float spectrum[SPECTRAL_COUNT];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PEAKS; i++) {
            draw_band(s->centre_nm[k] + step * (i - MOVES), fwhm_nm[k], spectrum);
            panel_spectrum_xyz(spectrum, s->band[k][i]);
        }
}

/* Peaks with the least miss up to `enough`, of those the least moved; the miss. */
static double choose_peaks(const BandSearch *s, int reach, double enough, int best[3]) {
    double least = FAR;
    int moved = 0, at[3];
    for (at[0] = MOVES - reach; at[0] <= MOVES + reach; at[0]++)
        for (at[1] = MOVES - reach; at[1] <= MOVES + reach; at[1]++)
            for (at[2] = MOVES - reach; at[2] <= MOVES + reach; at[2]++) {
                const double *const band[3] = {s->band[0][at[0]], s->band[1][at[1]],
                                               s->band[2][at[2]]};
                int move = 0;
                for (int k = 0; k < 3; k++) move += (at[k] - MOVES) * (at[k] - MOVES);
                if (least <= enough && move >= moved) continue;
                double miss = fmax(miss_of(band, s->xyz, fmax(least, enough)), enough);
                if (miss > least || (miss == least && move >= moved)) continue;
                least = miss;
                moved = move;
                memcpy(best, at, sizeof at);
            }
    return least;
}

/* Moves the centres to the best peaks in steps; the miss. */
static double move_peaks(BandSearch *s, const double fwhm_nm[3], double step, int reach) {
    int best[3] = {MOVES, MOVES, MOVES};
    fill_bands(s, fwhm_nm, step);
    double miss = choose_peaks(s, reach, 0.1 * PRIMARY_BANDS_MISS, best);
    for (int k = 0; k < 3; k++) s->centre_nm[k] += step * (best[k] - MOVES);
    return miss;
}

/* The widest share of the kind's widths that reaches, from `first` on; stated peaks stay if
 * they can. */
static void choose_share(BandSearch *s, int kind, const double *peak_nm, int first,
                         double fwhm_nm[3]) {
    bool is_stated = peak_nm[0] > 0;
    double miss = FAR;
    const double *start = is_stated ? peak_nm : kinds[kind].peak_nm;
    for (int i = first; is_stated && i < COUNT_OF(shares) && miss > PRIMARY_BANDS_MISS; i++) {
        memcpy(s->centre_nm, start, sizeof s->centre_nm);
        for (int k = 0; k < 3; k++) fwhm_nm[k] = shares[i] * kinds[kind].fwhm_nm[k];
        miss = move_peaks(s, fwhm_nm, 1, 0);
    }
    for (int i = first; i < COUNT_OF(shares) && miss > PRIMARY_BANDS_MISS; i++) {
        memcpy(s->centre_nm, start, sizeof s->centre_nm);
        for (int k = 0; k < 3; k++) fwhm_nm[k] = shares[i] * kinds[kind].fwhm_nm[k];
        miss = move_peaks(s, fwhm_nm, 1, MOVES);
        if (miss > 0.1 * PRIMARY_BANDS_MISS && i + 1 == COUNT_OF(shares))
            miss = move_peaks(s, fwhm_nm, 0.1, 8);
    }
}

/* ---- spectra ---------------------------------------------------------------------------- */

/* Returns the largest miss. */
static double mix_spectra(const BandSearch *s, const double fwhm_nm[3],
                          float out[3][SPECTRAL_COUNT]) {
    float band[3][SPECTRAL_COUNT];
    double xyz[3][3], part[3], miss = 0;
    for (int k = 0; k < 3; k++) {
        draw_band(s->centre_nm[k], fwhm_nm[k], band[k]);
        panel_spectrum_xyz(band[k], xyz[k]);
    }
    const double *const of[3] = {xyz[0], xyz[1], xyz[2]};
    for (int p = 0; p < 3; p++) {
        miss = fmax(miss, mix(of, s->xyz[p], part));
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            out[p][i] = (float)(part[0] * (double)band[0][i] + part[1] * (double)band[1][i] +
                                part[2] * (double)band[2][i]);
    }
    return miss;
}

/* Transmittance of filter f: two tilted panes, then edges. */
static double filter_at(int f, double nm) {
    double tilt = fmin(1, fmax(0, (nm - 400) / 300));
    if (f < 2) return f ? 1 - 0.5 * tilt : 0.5 + 0.5 * tilt;
    return nm > 480 + 20 * (f - 2) ? 1 : 0;
}

#define FILTERS 10

static void white_behind(const float spectrum[3][SPECTRAL_COUNT], int f, double xyz[3]) {
    float white[SPECTRAL_COUNT];
    for (int i = 0; i < SPECTRAL_COUNT; i++)
        white[i] = (float)filter_at(f, SPECTRAL_FIRST_NM + i) *
                   (spectrum[0][i] + spectrum[1][i] + spectrum[2][i]);
    panel_spectrum_xyz(white, xyz);
}

static void compare_filtered(const float narrow[3][SPECTRAL_COUNT], PrimaryBands *out) {
    for (int f = 0; f < FILTERS; f++) {
        double a[3], b[3], *off = f < 2 ? &out->off_uv : &out->off_edge;
        white_behind((const float(*)[SPECTRAL_COUNT])out->spectrum, f, a);
        white_behind(narrow, f, b);
        if (a[1] > 0 && b[1] > 0) *off = fmax(*off, twice_colour(a, b));
    }
}

bool primary_bands_find(int backlight, const double peak_nm[3], const double xyz[3][3],
                        PrimaryBands *out) {
    int kind = backlight ? backlight - 1 : 0;
    double narrow_nm[3];
    float narrow[3][SPECTRAL_COUNT];
    BandSearch search = {.xyz = xyz};
    *out = (PrimaryBands){.backlight = kind};
    choose_share(&search, kind, peak_nm, 0, out->fwhm_nm);
    memcpy(out->peak_nm, search.centre_nm, sizeof out->peak_nm);
    out->miss = mix_spectra(&search, out->fwhm_nm, out->spectrum);
    if (out->miss > PRIMARY_BANDS_MOST) return false;
    choose_share(&search, kind, peak_nm, COUNT_OF(shares) - 1, narrow_nm);
    mix_spectra(&search, narrow_nm, narrow);
    compare_filtered((const float(*)[SPECTRAL_COUNT])narrow, out);
    return true;
}
