/* Spectra of the primaries, and how they bend to a measured colour (design: panel, 7). */
#include <math.h>
#include <string.h>

#include "panel/fit_parts.h"

#define BEND_LIMIT 24.0 /* largest |c1|, |c2| that counts as a solution */

/* Where a panel has no spectra: red, green and blue light of a display, FWHM in nm. */
static const struct { double nm, fwhm; } typical[3] = {{625, 40}, {535, 50}, {455, 25}};

/* Observer and spectrum at the middle of a nanometre's cell as well as at its ends. */
static double observer(const SpectralRow *row, int j)
{
    return (double)(j == 0 ? row->x : j == 1 ? row->y : row->z);
}

/* Integrals of S x-bar_j t^k over wavelength, S = spectrum exp(c0 + c1 t + c2 t^2), by
 * Simpson's rule on every nm: exact for the product of what is linear between whole nm. */
static void bent_moments(const float *spectrum, const double c[3], double moment[3][3])
{
    memset(moment, 0, 9 * sizeof(double));
    for (int h = 0; h <= 2 * (SPECTRAL_COUNT - 1); h++) {
        int    i = h / 2;
        double weight = h == 0 || h == 2 * (SPECTRAL_COUNT - 1) ? 1.0 / 6 : h % 2 ? 4.0 / 6
                                                                              : 2.0 / 6;
        double s = h % 2 ? 0.5 * ((double)spectrum[i] + (double)spectrum[i + 1])
                         : (double)spectrum[i];
        if (s <= 0) continue;
        double t = (SPECTRAL_FIRST_NM + 0.5 * h - 560) / 180;
        double value = weight * s * exp(c[0] + (c[1] + c[2] * t) * t);
        for (int j = 0; j < 3; j++) {
            double bar = observer(&spectral_table[i], j);
            if (h % 2) bar = 0.5 * (bar + observer(&spectral_table[i + 1], j));
            double term = value * bar;
            for (int k = 0; k < 3; k++, term *= t) moment[j][k] += term;
        }
    }
}

void fit_bent_xyz(const float *spectrum, const double c[3], double xyz[3])
{
    double moment[3][3];
    bent_moments(spectrum, c, moment);
    for (int j = 0; j < 3; j++) xyz[j] = LUMINOUS_EFFICACY_MAX * moment[j][0];
}

/* Rows: ln X - ln Y - u, ln Z - ln Y - v, over c1, c2 (c0 follows from Y). */
static double bend_rest(const double moment[3][3], const double ratio[2], double rest[2],
                        double jacobian[4])
{
    double mean[3][2];
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 2; k++) mean[j][k] = moment[j][k + 1] / moment[j][0];
    for (int r = 0; r < 2; r++) {
        int j = r ? 2 : 0;
        rest[r] = log(moment[j][0] / moment[1][0]) - ratio[r];
        for (int k = 0; k < 2; k++) jacobian[2 * r + k] = mean[j][k] - mean[1][k];
    }
    return fmax(fabs(rest[0]), fabs(rest[1]));
}

/* Does bending leave the spectrum a display's? Of the same luminance, it must nowhere be four
 * times as high as the highest peak was: extreme coefficients blow up the tails. */
static bool is_tame(const float *spectrum, const double c[3])
{
    double before = 0, after = 0;
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        double t = (SPECTRAL_FIRST_NM + i - 560) / 180.0, s = (double)spectrum[i];
        before = fmax(before, s);
        if (s > 0) after = fmax(after, s * exp(c[0] + (c[1] + c[2] * t) * t));
    }
    double zero[3] = {0, 0, 0}, xyz[3];
    fit_bent_xyz(spectrum, zero, xyz);
    return after < 4 * before / xyz[1];
}

bool fit_bend(const float *spectrum, const double ratio[2], double c[3])
{
    double moment[3][3], rest[2], jacobian[4];
    double at[3] = {0, c[1], c[2]};
    for (int step = 0; step < 40; step++) {
        at[0] = 0;
        bent_moments(spectrum, at, moment);
        if (!(moment[0][0] > 0 && moment[1][0] > 0 && moment[2][0] > 0)) return false;
        double miss = bend_rest((const double (*)[3])moment, ratio, rest, jacobian);
        if (miss < 1e-10) {
            c[0] = -log(LUMINOUS_EFFICACY_MAX * moment[1][0]);
            c[1] = at[1];
            c[2] = at[2];
            return is_tame(spectrum, c);
        }
        double det = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2];
        if (!(fabs(det) > 1e-14)) return false;
        double d1 = -(jacobian[3] * rest[0] - jacobian[1] * rest[1]) / det;
        double d2 = -(jacobian[0] * rest[1] - jacobian[2] * rest[0]) / det;
        double longest = fmax(fabs(d1), fabs(d2)), damp = longest > 4 ? 4 / longest : 1;
        at[1] += damp * d1;
        at[2] += damp * d2;
        if (!(fabs(at[1]) < BEND_LIMIT && fabs(at[2]) < BEND_LIMIT)) return false;
    }
    return false;
}

/* From a colour that was reached (`from`, with coefficients c) as far towards `to` as bending
 * goes, by halving the way. True when it goes all the way. */
static bool bend_along(const float *spectrum, const double from[2], const double to[2],
                       double c[3])
{
    double good = 0, bad = 1, trial[3] = {c[0], c[1], c[2]};
    if (fit_bend(spectrum, to, trial)) {
        memcpy(c, trial, sizeof trial);
        return true;
    }
    for (int i = 0; i < 10; i++) {
        double middle = 0.5 * (good + bad);
        double target[2] = {from[0] + middle * (to[0] - from[0]),
                            from[1] + middle * (to[1] - from[1])};
        memcpy(trial, c, sizeof trial);
        if (fit_bend(spectrum, target, trial)) {
            good = middle;
            memcpy(c, trial, sizeof trial);
        } else {
            bad = middle;
        }
    }
    return false;
}

/* (ln X/Y, ln Z/Y) at a node of the table. */
static void node_ratio(const PanelBend *bend, double along, double across, double ratio[2])
{
    double ax = (double)bend->along[0], ay = (double)bend->along[1];
    ratio[0] = (double)bend->origin[0] + along * ax - across * ay;
    ratio[1] = (double)bend->origin[1] + along * ay + across * ax;
}

static double node_at(const PanelBend *bend, int coordinate, int index)
{
    double low = (double)bend->low[coordinate], high = (double)bend->high[coordinate];
    return low + (high - low) * index / (PANEL_BEND_SIDE - 1);
}

/* The table: along the spread of the colours first, then from there to either side, so that
 * neighbours stay neighbours where bending does not reach all the way. Returns how many nodes
 * were not reached. */
static int fill_bend(const float *spectrum, PanelBend *bend)
{
    double xyz[3], zero[3] = {0, 0, 0};
    int    missed = 0;
    fit_bent_xyz(spectrum, zero, xyz);
    double own[2] = {log(xyz[0] / xyz[1]), log(xyz[2] / xyz[1])};
    for (int i = 0; i < PANEL_BEND_SIDE; i++) {
        double along = node_at(bend, 0, i), middle[2], start[3] = {0, 0, 0};
        node_ratio(bend, along, 0, middle);
        fit_bend(spectrum, own, start);
        bool is_reached = bend_along(spectrum, own, middle, start);
        for (int j = 0; j < PANEL_BEND_SIDE; j++) {
            double ratio[2], c[3] = {start[0], start[1], start[2]};
            node_ratio(bend, along, node_at(bend, 1, j), ratio);
            missed += !(is_reached && bend_along(spectrum, middle, ratio, c));
            float *to = bend->coefficient[j * PANEL_BEND_SIDE + i];
            for (int k = 0; k < 3; k++) to[k] = (float)c[k];
        }
    }
    return missed;
}

/* Scaled to 1 cd m^-2. */
static void normalise(float *spectrum)
{
    double xyz[3], zero[3] = {0, 0, 0};
    fit_bent_xyz(spectrum, zero, xyz);
    for (int i = 0; i < SPECTRAL_COUNT; i++)
        spectrum[i] = (float)((double)spectrum[i] / xyz[1]);
}

static void start_spectrum(const Measurement *set, int p, float *out)
{
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        const SpectralRow *row = &spectral_table[i];
        float  share = p == 0 ? row->red : p == 1 ? row->green : row->blue;
        double d = (SPECTRAL_FIRST_NM + i - typical[p].nm) / typical[p].fwhm;
        out[i] = set->has_spectra ? set->spectrum[p][i]
                 : set->is_white_only ? share * row->d65
                 : (float)(exp(-4 * log(2) * d * d) + 1e-4);
    }
}

void fit_spectra(const Measurement *set, const FitEmission *emission, FitNotes *notes,
                 PanelPrimaries *out)
{
    static const char *const names[4] = {"red", "green", "blue", "black"};
    memset(out, 0, sizeof *out);
    for (int p = 0; p < 3; p++) {
        start_spectrum(set, p, out->spectrum[p]);
        normalise(out->spectrum[p]);
        for (int i = 0; i < SPECTRAL_COUNT; i++) /* black leaks through all three */
            out->spectrum[3][i] += (float)emission->peak_xyz[p][1] * out->spectrum[p][i];
    }
    normalise(out->spectrum[3]);
    for (int p = 0; p < 4; p++) {
        out->bend[p] = emission->range[p];
        int missed = fill_bend(out->spectrum[p], &out->bend[p]);
        if (missed && (p < 3 || emission->head.has_black))
            fit_note(notes, "%s: %d of %d colours of the spectrum's table cannot be reached; "
                     "the nearest ones on the way serve", names[p], missed,
                     PANEL_BEND_SIDE * PANEL_BEND_SIDE);
    }
    if (!set->has_spectra)
        fit_note(notes, "no spectra of the primaries: %s, bent to the measured colours",
                 set->is_white_only ? "the Rec.709 primaries' smooth spectra under D65"
                                    : "typical ones (peaks at 625, 535 and 455 nm)");
}
