/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/peak_window.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "spectrum/twice.h"

#define WINDOW_ROWS_MAX 60000
#define ENOUGH_ROWS 1000 /* to choose widths from */

double peak_window_angle(double theta, double phi, double incidence) {
    double dt = sin_d(0.5 * (theta - incidence)), dp = sin_d(0.5 * phi);
    return 2 * asin_d(sqrt(fmin(1, dt * dt + sin_d(theta) * sin_d(incidence) * dp * dp)));
}

double peak_window_squares(double theta, double phi, double incidence) {
    double so = sin_d(theta), si = sin_d(incidence), sp = sin_d(0.5 * phi);
    return (so - si) * (so - si) + 4 * so * si * sp * sp;
}

double peak_window_row_mean(const AngleTable *slice, int row) {
    double sum = 0;
    for (int w = 0; w < slice->channels; w++)
        sum += (double)slice->value[(size_t)row * (size_t)slice->channels + (size_t)w];
    return sum / slice->channels;
}

void peak_window_set_image(PeakWindow *window, double fwhm) {
    double sigma = fwhm / sqrt(8 * log_d(2));
    for (int i = 0; i < window->count; i++) {
        PeakRow *spot = &window->row[i];
        spot->image = exp_d(-0.5 * spot->angle * spot->angle / (sigma * sigma)) /
                      (2 * PI * sigma * sigma * cos_d(window->incidence));
    }
}

PeakWindow peak_window_collect(const AngleTable *slice, double incidence, double reach,
                               Arena *arena) {
    PeakWindow window = {.row = ARENA_NEW(arena, PeakRow, slice->rows),
                         .lambertian = 1e30,
                         .slice = slice,
                         .incidence = incidence};
    for (int i = 0; i < slice->rows; i++) {
        double theta = (double)slice->theta[i], phi = (double)slice->phi[i];
        double angle = peak_window_angle(theta, phi, incidence);
        double mean = peak_window_row_mean(slice, i);
        double leaving = 1 - reflection_fresnel(cos_d(theta));
        if (theta < radians_from_degrees(60))
            window.lambertian = fmin(window.lambertian, mean / leaving);
        if (angle > reach || window.count == WINDOW_ROWS_MAX) continue;
        window.row[window.count++] =
            (PeakRow){i,
                      0,
                      peak_window_squares(theta, phi, incidence),
                      theta - incidence,
                      sqrt(reflection_fresnel(cos_d(theta)) / reflection_fresnel(cos_d(incidence))),
                      angle,
                      leaving,
                      mean};
    }
    window.stride = 1 + window.count / ENOUGH_ROWS;
    window.lambertian = fmax(0, fmin(window.lambertian, 1e29));
    return window;
}

static double haze_shape(const PeakModel *model, const PeakRow *spot) {
    return spot->gain * pow_d(1 + spot->b2 / (model->width * model->width), -model->power);
}

double peak_model_fwhm(const PeakModel *model) {
    return 2 * model->width * sqrt(pow_d(2, 1 / model->power) - 1);
}

double peak_model_haze(const PeakModel *model, const PeakRow *spot) {
    return (model->a + model->t * spot->tilt) * haze_shape(model, spot);
}

/* The measured value; wavelength -1: the mean. */
static double spot_value(const PeakWindow *window, const PeakRow *spot, int wavelength) {
    if (wavelength < 0) return spot->mean;
    return (double)window->slice
        ->value[(size_t)spot->row * (size_t)window->slice->channels + (size_t)wavelength];
}

/* Gauss's elimination of the symmetric system m[r][0..2] x = m[r][3]. */
static void solve_normal(double m[3][4], double x[3]) {
    for (int r = 0; r < 3; r++) m[r][r] *= 1 + 1e-10;
    for (int r = 0; r < 3; r++)
        for (int q = r + 1; q < 3; q++) {
            double factor = m[r][r] > 0 ? m[q][r] / m[r][r] : 0;
            for (int c = r; c < 4; c++) m[q][c] -= factor * m[r][c];
        }
    for (int r = 2; r >= 0; r--) {
        double sum = m[r][3];
        for (int c = r + 1; c < 3; c++) sum -= m[r][c] * x[c];
        x[r] = m[r][r] > 0 ? sum / m[r][r] : 0;
    }
}

#define SPECULAR_RINGS 8
#define SPECULAR_SECTORS 8

/* The haze's shape over the aperture, times the cosine: a sum over the ellipse that the
 * aperture's projection on the panel's plane is. */
static double aperture_shape(const PeakWindow *window, const PeakModel *model) {
    double radius = 0.5 * window->specular->aperture, cosine = cos_d(window->incidence);
    double sum = 0, w2 = model->width * model->width;
    for (int i = 0; i < SPECULAR_RINGS && radius > 0; i++) {
        double r = radius * (i + 0.5) / SPECULAR_RINGS;
        double area = r * cosine * (radius / SPECULAR_RINGS) * (2 * PI / SPECULAR_SECTORS);
        for (int k = 0; k < SPECULAR_SECTORS; k++) {
            double psi = 2 * PI * (k + 0.5) / SPECULAR_SECTORS;
            double x = r * cosine * cos_d(psi), y = r * sin_d(psi);
            sum += area * pow_d(1 + (x * x + y * y) / w2, -model->power);
        }
    }
    return sum;
}

/* The lambertian part's light in the aperture, per unit of `lambertian`. */
static double aperture_leaving(const PeakWindow *window) {
    double cosine = cos_d(window->incidence), radius = 0.5 * window->specular->aperture;
    return PI * radius * radius * cosine * (1 - reflection_fresnel(cosine));
}

static void add_equation(double m[3][4], const double basis[4], double weight) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) m[r][c] += weight * basis[r] * basis[c];
}

static double specular_value(const PeakWindow *window, int wavelength) {
    return wavelength < 0 ? window->specular->mean : window->specular->value[wavelength];
}

static void add_specular(const PeakWindow *window, int wavelength, double lambertian,
                         const PeakModel *model, double m[3][4]) {
    double s = specular_value(window, wavelength);
    double basis[4] = {1, aperture_shape(window, model), 0,
                       s - lambertian * aperture_leaving(window)};
    add_equation(m, basis, window->specular->weight / ((s + 1e-5) * (s + 1e-5)));
}

static void normal_equations(const PeakWindow *window, int wavelength, double lambertian,
                             const PeakModel *model, double m[3][4]) {
    memset(m, 0, 3 * sizeof *m);
    for (int i = 0; i < window->count; i += window->stride) {
        const PeakRow *spot = &window->row[i];
        double f = spot_value(window, spot, wavelength), shape = haze_shape(model, spot);
        double basis[4] = {spot->image, shape, shape * spot->tilt, f - lambertian * spot->leaving};
        add_equation(m, basis, 1 / ((fabs(f) + 1e-5) * (fabs(f) + 1e-5)));
    }
    if (window->specular) add_specular(window, wavelength, lambertian, model, m);
}

/* The specular measurement's weighted squared residual, like the rows'. */
static double specular_rest(const PeakWindow *window, int wavelength, double lambertian,
                            const PeakModel *model) {
    if (!window->specular) return 0;
    double s = specular_value(window, wavelength);
    double rest = (s - lambertian * aperture_leaving(window) - model->r -
                   model->a * aperture_shape(window, model)) /
                  (s + 1e-5);
    return window->specular->weight * rest * rest;
}

double peak_window_specular_miss(const PeakWindow *window, const PeakModel *model) {
    return twice_share(window->specular->mean, window->lambertian * aperture_leaving(window) +
                                                   model->r +
                                                   model->a * aperture_shape(window, model));
}

double peak_window_solve(const PeakWindow *window, int wavelength, double lambertian,
                         PeakModel *model) {
    double m[3][4], x[3], squares = 0;
    normal_equations(window, wavelength, lambertian, model, m);
    solve_normal(m, x);
    model->r = x[0], model->a = x[1], model->t = x[2];
    for (int i = 0; i < window->count; i += window->stride) {
        const PeakRow *spot = &window->row[i];
        double f = spot_value(window, spot, wavelength);
        double rest = (f - lambertian * spot->leaving - model->r * spot->image -
                       peak_model_haze(model, spot)) /
                      (fabs(f) + 1e-5);
        squares += rest * rest;
    }
    squares += specular_rest(window, wavelength, lambertian, model);
    return sqrt(squares * window->stride / window->count);
}

void peak_window_variances(const PeakWindow *window, PeakModel *model, double variance[2]) {
    double m[3][4];
    normal_equations(window, -1, window->lambertian, model, m);
    for (int k = 0; k < 2; k++) {
        double one[3][4], x[3];
        memcpy(one, m, sizeof one);
        for (int r = 0; r < 3; r++) one[r][3] = r == k;
        solve_normal(one, x);
        variance[k] = fmax(0, x[k]);
    }
}

/* Where a function of one number is looked for its least value. */
typedef struct Span {
    double low, high;
    int scan, sections; /* of a scan before the golden section; 0: none */
} Span;

/* A model's rest at the logarithm of a width, or of a power with its best width. */
typedef double RestAt(const PeakWindow *window, double scale, PeakModel *model, double log);

static double rest_at_width(const PeakWindow *window, double scale, PeakModel *model, double log) {
    (void)scale;
    model->width = exp_d(log);
    return peak_window_solve(window, -1, window->lambertian, model);
}

static double rest_at_power(const PeakWindow *window, double scale, PeakModel *model, double log) {
    model->power = exp_d(log);
    return peak_window_best_width(window, scale, model);
}

/* Narrows a span to the neighbours of its best point: there may be several valleys. */
static void scan_span(const PeakWindow *window, double scale, RestAt *rest_at, PeakModel *model,
                      Span *span) {
    double low = span->low, step = (span->high - low) / (span->scan - 1), least = INFINITY;
    int best = 0;
    for (int i = 0; i < span->scan; i++) {
        double rest = rest_at(window, scale, model, low + i * step);
        if (rest < least) least = rest, best = i;
    }
    span->high = fmin(span->high, low + (best + 1) * step);
    span->low = fmax(span->low, low + (best - 1) * step);
}

/* By golden section; the model is left at the best point, and its rest returned. */
static double best_in_span(const PeakWindow *window, double scale, RestAt *rest_at,
                           PeakModel *model, Span span) {
    if (span.scan) scan_span(window, scale, rest_at, model, &span);
    double low = span.low, high = span.high;
    for (int i = 0; i < span.sections; i++) {
        double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
        double left = rest_at(window, scale, model, a);
        double right = rest_at(window, scale, model, b);
        if (left < right) high = b;
        else low = a;
    }
    return rest_at(window, scale, model, 0.5 * (low + high));
}

double peak_window_best_width(const PeakWindow *window, double scale, PeakModel *model) {
    bool is_known = window->width[1] > 0;
    Span span = is_known ? (Span){log_d(window->width[0]), log_d(window->width[1]), 20, 12}
                         : (Span){log_d(0.5 * scale), log_d(40 * scale), 0, 26};
    return best_in_span(window, scale, rest_at_width, model, span);
}

PeakModel peak_window_choose_haze(const PeakWindow *window, double scale) {
    bool is_known = window->width[1] > 0;
    PeakModel model = {0};
    best_in_span(window, scale, rest_at_power, &model,
                 (Span){log_d(1.05), log_d(4.0), is_known ? 12 : 0, is_known ? 10 : 18});
    return model;
}

double peak_window_lambertian(const AngleTable *slice, int channel) {
    double least = 1e30;
    for (int i = 0; i < slice->rows; i++) {
        double theta = (double)slice->theta[i];
        if (theta < radians_from_degrees(60))
            least = fmin(
                least, (double)slice->value[(size_t)i * (size_t)slice->channels + (size_t)channel] /
                           (1 - reflection_fresnel(cos_d(theta))));
    }
    return fmax(0, fmin(least, 1e29));
}

/* ---- how far apart rows are -------------------------------------------------------------- */

#define RING_ROWS 4     /* fewer on a ring: no grid, the rows' density is taken */
#define DENSITY_ROWS 16 /* nearest rows for it */

/* Between the azimuths on both sides of the mirror direction. */
static double ring_gap(const AngleTable *table, int begin, int end) {
    double left = PI, right = PI, nearest = PI, next = PI;
    for (int i = begin; i < end; i++) {
        double phi = (double)table->phi[i], turn = phi > PI ? phi - 2 * PI : phi;
        if (turn >= 0) right = fmin(right, turn);
        if (turn <= 0) left = fmin(left, -turn);
        double away = fabs(turn);
        if (away < nearest) next = nearest, nearest = away;
        else if (away > nearest) next = fmin(next, away);
    }
    return nearest < 1e-6 ? next : fmin(left + right, 2 * nearest);
}

/* Rows without a grid: the side of the square that each has for itself. */
static double density_gap(const AngleTable *table, double incidence, Arena scratch) {
    double *angle = ARENA_NEW(&scratch, double, table->rows);
    for (int i = 0; i < table->rows; i++)
        angle[i] = peak_window_angle((double)table->theta[i], (double)table->phi[i], incidence);
    sort_doubles(angle, table->rows);
    int rows = table->rows < DENSITY_ROWS ? table->rows : DENSITY_ROWS;
    return angle[rows - 1] * sqrt(PI / rows);
}

PeakSpacing peak_window_spacing(const AngleTable *table, double incidence, Arena scratch) {
    PeakSpacing out = {PI, PI, PI};
    int nearest = 0, end = 0;
    double before = -1, best = PI, ring = 0;
    for (int i = 0; i < table->rows; i = table_ring_end(table, i)) {
        double theta = (double)table->theta[i], away = fabs(theta - incidence);
        bool is_beyond = before >= 0 && theta >= incidence - 1e-6 && out.theta == PI;
        if (is_beyond) out.theta = theta - before;
        if (away < best) best = away, nearest = i, ring = theta;
        before = theta;
    }
    end = table_ring_end(table, nearest);
    out.across = ring_gap(table, nearest, end) * sin_d(fmax(ring, incidence));
    if (end - nearest < RING_ROWS && ring > 0)
        out.theta = out.across = density_gap(table, incidence, scratch);
    if (!(ring > 0)) out.across = out.theta;
    out.widest = fmax(out.theta, out.across);
    return out;
}
