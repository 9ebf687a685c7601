/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_peak.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/fit/reflection/reflection_fresnel.h"

#define WINDOW_FWHMS 6.0 /* rows nearer to the mirror direction than this are looked at */
#define LOBE_FWHMS 3.0   /* the same for a lobe, whose haze need not follow the model so far */
#define CORE_SHARE 0.5   /* where haze is less than this of the peak, the fitted haze replaces
                            what the subtraction leaves */
#define CORE_FWHMS 1.6   /* and so near to the mirror direction anyway */
#define WINDOW_ROWS_MAX 60000
#define ENOUGH_ROWS 1000 /* to choose widths from */
#define LEAST_PEAK 0.05  /* times the haze under it: less is no image */
#define LOBE_REST 0.006  /* relative, rms: a lobe explains the data this well, or it is none */
#define LOBE_HEIGHT 1.0  /* times the haze under it, at least */
#define SEARCH_DEG 6.0   /* a lobe's top is nearer to the mirror direction than this */

/* One row near the mirror direction. */
typedef struct PeakRow {
    int    row;
    double image; /* of a mirror of reflectance 1, sr^-1 */
    double b2;    /* squared distance of the projections on the panel's plane */
    double tilt;  /* theta - incidence */
    double gain;  /* sqrt(F(theta) / F(incidence)) */
    double angle; /* to the mirror direction */
    double leaving; /* what the surface lets out: 1 - F(theta) */
    double mean;  /* over the wavelengths */
} PeakRow;

typedef struct PeakWindow {
    PeakRow          *row;
    int               count, stride; /* stride: of the rows that a solution counts */
    double            incidence;
    double            lambertian; /* of the slice, mean over the wavelengths, over `leaving` */
    const AngleTable *slice;
} PeakWindow;

/* f = R image + (a + t tilt) haze + lambertian leaving. */
typedef struct PeakModel {
    double width, power;   /* haze = gain (1 + b2 / width^2)^-power */
    double r, a, t;
} PeakModel;

static double angle_to(double theta, double phi, double incidence)
{
    double dt = sin_d(0.5 * (theta - incidence)), dp = sin_d(0.5 * phi);
    return 2 * asin_d(sqrt(fmin(1, dt * dt + sin_d(theta) * sin_d(incidence) * dp * dp)));
}

static double row_mean(const AngleTable *slice, int row)
{
    double sum = 0;
    for (int w = 0; w < slice->channels; w++)
        sum += (double)slice->value[(size_t)row * (size_t)slice->channels + (size_t)w];
    return sum / slice->channels;
}

/* The image of a mirror of reflectance 1 at every spot: a Gaussian of the peak's width. */
static void set_width(PeakWindow *window, double fwhm)
{
    double sigma = fwhm / sqrt(8 * log_d(2));
    for (int i = 0; i < window->count; i++) {
        PeakRow *spot = &window->row[i];
        spot->image = exp_d(-0.5 * spot->angle * spot->angle / (sigma * sigma)) /
                      (2 * PI * sigma * sigma * cos_d(window->incidence));
    }
}

static PeakWindow collect(const AngleTable *slice, double incidence, double reach, Arena *arena)
{
    PeakWindow window = {.row = ARENA_NEW(arena, PeakRow, slice->rows), .lambertian = 1e30,
                         .slice = slice, .incidence = incidence};
    for (int i = 0; i < slice->rows; i++) {
        double theta = (double)slice->theta[i], phi = (double)slice->phi[i];
        double angle = angle_to(theta, phi, incidence), mean = row_mean(slice, i);
        double leaving = 1 - reflection_fresnel(cos_d(theta));
        if (theta < radians_from_degrees(60))
            window.lambertian = fmin(window.lambertian, mean / leaving);
        if (angle > reach || window.count == WINDOW_ROWS_MAX) continue;
        double so = sin_d(theta), si = sin_d(incidence), sp = sin_d(0.5 * phi);
        window.row[window.count++] = (PeakRow){
            i, 0, (so - si) * (so - si) + 4 * so * si * sp * sp, theta - incidence,
            sqrt(reflection_fresnel(cos_d(theta)) / reflection_fresnel(cos_d(incidence))),
            angle, leaving, mean};
    }
    window.stride = 1 + window.count / ENOUGH_ROWS;
    window.lambertian = fmax(0, fmin(window.lambertian, 1e29));
    return window;
}

static double haze_shape(const PeakModel *model, const PeakRow *spot)
{
    return spot->gain * pow_d(1 + spot->b2 / (model->width * model->width), -model->power);
}

static double model_haze(const PeakModel *model, const PeakRow *spot)
{
    return (model->a + model->t * spot->tilt) * haze_shape(model, spot);
}

/* The measured value; wavelength -1: the mean. */
static double spot_value(const PeakWindow *window, const PeakRow *spot, int wavelength)
{
    if (wavelength < 0) return spot->mean;
    return (double)window->slice->value[(size_t)spot->row * (size_t)window->slice->channels +
                                        (size_t)wavelength];
}

/* Gauss's elimination of the symmetric system m[r][0..2] x = m[r][3]. */
static void solve_normal(double m[3][4], double x[3])
{
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

/* Least squares over r, a, t with weights 1 / f^2. Returns the weighted rms rest. */
static double solve_window(const PeakWindow *window, int wavelength, double lambertian,
                           PeakModel *model)
{
    double m[3][4] = {{0}}, x[3], squares = 0;
    for (int i = 0; i < window->count; i += window->stride) {
        const PeakRow *spot = &window->row[i];
        double f = spot_value(window, spot, wavelength), shape = haze_shape(model, spot);
        double basis[4] = {spot->image, shape, shape * spot->tilt,
                           f - lambertian * spot->leaving};
        double weight = 1 / ((fabs(f) + 1e-5) * (fabs(f) + 1e-5));
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++) m[r][c] += weight * basis[r] * basis[c];
    }
    solve_normal(m, x);
    model->r = x[0], model->a = x[1], model->t = x[2];
    for (int i = 0; i < window->count; i += window->stride) {
        const PeakRow *spot = &window->row[i];
        double f = spot_value(window, spot, wavelength);
        double rest = (f - lambertian * spot->leaving - model->r * spot->image -
                       model_haze(model, spot)) / (fabs(f) + 1e-5);
        squares += rest * rest;
    }
    return sqrt(squares * window->stride / window->count);
}

/* The best width for a power: golden section over its logarithm. */
static double best_width(const PeakWindow *window, double fwhm, PeakModel *model)
{
    double low = log_d(0.5 * fwhm), high = log_d(40 * fwhm);
    for (int i = 0; i < 26; i++) {
        double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
        model->width = exp_d(a);
        double left = solve_window(window, -1, window->lambertian, model);
        model->width = exp_d(b);
        double right = solve_window(window, -1, window->lambertian, model);
        if (left < right) high = b;
        else low = a;
    }
    model->width = exp_d(0.5 * (low + high));
    return solve_window(window, -1, window->lambertian, model);
}

/* Width and power of the haze under the image, the same for all wavelengths. */
static PeakModel choose_haze(const PeakWindow *window, double fwhm)
{
    double    low = log_d(1.05), high = log_d(4.0);
    PeakModel model = {0};
    for (int i = 0; i < 18; i++) {
        double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
        model.power = exp_d(a);
        double left = best_width(window, fwhm, &model);
        model.power = exp_d(b);
        double right = best_width(window, fwhm, &model);
        if (left < right) high = b;
        else low = a;
    }
    model.power = exp_d(0.5 * (low + high));
    best_width(window, fwhm, &model);
    return model;
}

static double channel_lambertian(const AngleTable *slice, int channel)
{
    double least = 1e30;
    for (int i = 0; i < slice->rows; i++) {
        double theta = (double)slice->theta[i];
        if (theta < radians_from_degrees(60))
            least = fmin(least, (double)slice->value[(size_t)i * (size_t)slice->channels +
                                                     (size_t)channel] /
                                    (1 - reflection_fresnel(cos_d(theta))));
    }
    return fmax(0, fmin(least, 1e29));
}

/* The peak of every wavelength out of `value`, its height told by a model for the haze. */
static void take_out(const PeakWindow *window, double fwhm, PeakModel model,
                     double *reflectance,
                     float *value)
{
    int size = window->slice->channels;
    for (int w = 0; w < size; w++) {
        double lambertian = channel_lambertian(window->slice, w);
        solve_window(window, w, lambertian, &model);
        reflectance[w] = fmax(0, model.r);
        for (int i = 0; i < window->count; i++) {
            const PeakRow *spot = &window->row[i];
            float *at = value + (size_t)spot->row * (size_t)size + w;
            double haze = fmax(model_haze(&model, spot) + lambertian * spot->leaving, 0);
            double peak = reflectance[w] * spot->image;
            bool   in_core = spot->angle < CORE_FWHMS * fwhm || haze < CORE_SHARE * peak;
            *at = (float)(in_core ? haze : (double)*at - peak);
        }
    }
}

static float *copy_values(const AngleTable *slice, Arena *arena, AngleTable *haze)
{
    size_t count = (size_t)slice->rows * (size_t)slice->channels;
    float *value = ARENA_NEW(arena, float, count);
    memcpy(value, slice->value, sizeof *value * count);
    *haze = *slice;
    haze->value = value;
    return value;
}

void reflection_peak_take_mirror(const AngleTable *slice, double incidence, double fwhm,
                                 Arena *arena,
                                 double *reflectance, AngleTable *haze_table)
{
    float *value = copy_values(slice, arena, haze_table);
    for (int w = 0; w < slice->channels; w++) reflectance[w] = 0;
    PeakWindow window = collect(slice, incidence, WINDOW_FWHMS * fwhm, arena);
    if (window.count < 12) return;
    set_width(&window, fwhm);
    PeakModel model = choose_haze(&window, fwhm);
    double    peak = model.r * 4 * log_d(2) / (PI * fwhm * fwhm * cos_d(incidence));
    if (!(peak > LEAST_PEAK * (model.a + window.lambertian))) return;
    window.stride = 1;
    take_out(&window, fwhm, model, reflectance, value);
}

/* ---- a lobe ------------------------------------------------------------------------------ */

/* Full width at half of the largest value near the mirror direction; 0: the largest value is
 * not there. The outermost row above half of it tells, or the grid's step if that is wider. */
static double guess_width(const AngleTable *slice, double incidence)
{
    double top = 0, reach = radians_from_degrees(SEARCH_DEG), half = 0, nearest = 1;
    for (int i = 0; i < slice->rows; i++) {
        double angle = angle_to((double)slice->theta[i], (double)slice->phi[i], incidence);
        if (angle < reach) top = fmax(top, row_mean(slice, i));
        if (angle > 1e-6) nearest = fmin(nearest, angle);
    }
    for (int i = 0; i < slice->rows; i++) {
        double angle = angle_to((double)slice->theta[i], (double)slice->phi[i], incidence);
        if (angle < reach && row_mean(slice, i) > 0.5 * top) half = fmax(half, angle);
    }
    return half > 0.8 * reach ? 0 : 2 * fmax(half, nearest);
}

/* What a width leaves, with the haze that suits it best. */
static double rest_of_width(PeakWindow *window, double fwhm, double haze, PeakModel *model)
{
    set_width(window, fwhm);
    *model = choose_haze(window, haze);
    return solve_window(window, -1, window->lambertian, model);
}

/* The width that leaves the least, by golden section over its logarithm. haze: begins there. */
static double choose_width(PeakWindow *window, const double range[2], double haze,
                           PeakModel *model)
{
    double low = log_d(range[0]), high = log_d(range[1]);
    double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
    double left = rest_of_width(window, exp_d(a), haze, model);
    double right = rest_of_width(window, exp_d(b), haze, model);
    for (int i = 0; i < 12; i++) {
        if (left < right) {
            high = b, b = a, right = left;
            a = high - 0.618034 * (high - low);
            left = rest_of_width(window, exp_d(a), haze, model);
        } else {
            low = a, a = b, left = right;
            b = low + 0.618034 * (high - low);
            right = rest_of_width(window, exp_d(b), haze, model);
        }
    }
    rest_of_width(window, exp_d(0.5 * (low + high)), haze, model);
    return exp_d(0.5 * (low + high));
}

/* rms of what the model leaves where the peak is the larger part, relative. */
static double core_rest(const PeakWindow *window, const PeakModel *model)
{
    double squares = 0, count = 0;
    for (int i = 0; i < window->count; i++) {
        const PeakRow *spot = &window->row[i];
        double haze = model_haze(model, spot) + window->lambertian * spot->leaving;
        double peak = model->r * spot->image;
        if (peak < haze) continue;
        double rest = (spot->mean - haze - peak) / (haze + peak);
        squares += rest * rest;
        count++;
    }
    return count > 2 ? sqrt(squares / count) : 1;
}

bool reflection_peak_take_lobe(const AngleTable *slice, double incidence, double noise,
                               Arena *arena,
                               ReflectionLobe *lobe, AngleTable *haze_table)
{
    double guess = guess_width(slice, incidence);
    *haze_table = *slice;
    if (!(guess > 0)) return false;
    PeakWindow window = collect(slice, incidence, LOBE_FWHMS * guess, arena);
    if (window.count < 16) return false;
    PeakModel model;
    double fwhm = choose_width(&window, (double[2]){0.5 * guess, 2 * guess}, 2 * guess, &model);
    double rest = solve_window(&window, -1, window.lambertian, &model);
    double most = LOBE_REST + 2 * noise;
    double peak = 4 * log_d(2) / (PI * fwhm * fwhm * cos_d(incidence));
    if (!(model.r * peak > LOBE_HEIGHT * (model.a + window.lambertian)) || rest > most ||
        core_rest(&window, &model) > most)
        return false;
    window.stride = 1;
    lobe->fwhm = fwhm;
    take_out(&window, 0, model, lobe->reflectance, copy_values(slice, arena, haze_table));
    return true;
}
