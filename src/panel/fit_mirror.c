/* Taking the mirror's image out of a measured slice (design: panel, section 5). */
#include <math.h>
#include <string.h>

#include "base/units.h"
#include "panel/fit_parts.h"

#define WINDOW_FWHMS 5.0 /* rows nearer to the mirror direction than this are looked at */
#define CORE_FWHMS 1.6   /* here the fitted haze replaces what the subtraction leaves */
#define WINDOW_ROWS_MAX 60000

/* One row near the mirror direction. */
typedef struct Spot {
    int    row;
    double image;  /* of a mirror of reflectance 1, sr^-1 */
    double b2;     /* squared distance of the projections on the panel's plane */
    double angle;  /* to the mirror direction */
} Spot;

typedef struct Window {
    Spot *spot;
    int   count;
    const AngleTable *slice;
} Window;

static double angle_to(double theta, double phi, double incidence)
{
    double dt = sin(0.5 * (theta - incidence)), dp = sin(0.5 * phi);
    return 2 * asin(sqrt(fmin(1, dt * dt + sin(theta) * sin(incidence) * dp * dp)));
}

static Window collect(const AngleTable *slice, double incidence, double fwhm, Arena *arena)
{
    Window window = {ARENA_NEW(arena, Spot, slice->rows), 0, slice};
    double sigma = fwhm / sqrt(8 * log(2));
    for (int i = 0; i < slice->rows; i++) {
        double theta = (double)slice->theta[i], phi = (double)slice->phi[i];
        double angle = angle_to(theta, phi, incidence);
        if (angle > WINDOW_FWHMS * fwhm || window.count == WINDOW_ROWS_MAX) continue;
        double so = sin(theta), si = sin(incidence), sp = sin(0.5 * phi);
        window.spot[window.count++] = (Spot){
            i, exp(-0.5 * angle * angle / (sigma * sigma)) /
                   (2 * PI * sigma * sigma * cos(incidence)),
            (so - si) * (so - si) + 4 * so * si * sp * sp, angle};
    }
    return window;
}

/* Least squares of f = R image + a haze + b with weights 1 / f^2; wavelength -1: the mean.
 * Returns the weighted rms rest; x: R, a, b. */
static double solve_window(const Window *window, const double haze[2], int wavelength,
                           double x[3])
{
    double m[3][4] = {{0}}, squares = 0;
    int    size = window->slice->channels;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < window->count; i++) {
            const Spot  *spot = &window->spot[i];
            const float *row = window->slice->value + (size_t)spot->row * (size_t)size;
            double f = 0;
            if (wavelength >= 0) f = (double)row[wavelength];
            else for (int w = 0; w < size; w++) f += (double)row[w] / size;
            double basis[3] = {spot->image, pow(1 + spot->b2 / (haze[0] * haze[0]), -haze[1]), 1};
            double weight = 1 / (fabs(f) + 1e-5);
            if (pass) {
                double rest = f - x[0] * basis[0] - x[1] * basis[1] - x[2] * basis[2];
                squares += rest * rest * weight * weight;
                continue;
            }
            for (int r = 0; r < 3; r++) {
                for (int c = 0; c < 3; c++) m[r][c] += weight * weight * basis[r] * basis[c];
                m[r][3] += weight * weight * basis[r] * f;
            }
            if (i + 1 < window->count) continue;
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
    return sqrt(squares / window->count);
}

/* Width and power of the haze under the image, the same for all wavelengths. */
static void choose_haze(const Window *window, double fwhm, double haze[2], double x[3])
{
    static const double powers[] = {1.2, 1.5, 1.8, 2.2, 3.0};
    double best = 1e300;
    for (int w = 0; w < 12; w++)
        for (int p = 0; p < 5; p++) {
            double trial[2] = {0.6 * fwhm * pow(1.35, w), powers[p]}, y[3];
            double rest = solve_window(window, trial, -1, y);
            if (rest < best && y[1] >= 0 && y[0] > -1e-4) {
                best = rest;
                memcpy(haze, trial, sizeof trial);
                memcpy(x, y, sizeof y);
            }
        }
}

void fit_mirror(const AngleTable *slice, double incidence, double fwhm, Arena *arena,
                double *reflectance, AngleTable *haze_table)
{
    double haze[2] = {1, 2}, x[3] = {0, 0, 0};
    int    size = slice->channels;
    size_t bytes = sizeof(float) * (size_t)slice->rows * (size_t)size;
    float *value = ARENA_NEW(arena, float, (size_t)slice->rows * (size_t)size);
    memcpy(value, slice->value, bytes);
    *haze_table = *slice;
    haze_table->value = value;
    for (int w = 0; w < size; w++) reflectance[w] = 0;
    Window window = collect(slice, incidence, fwhm, arena);
    if (window.count < 12) return;
    choose_haze(&window, fwhm, haze, x);
    double image_peak = x[0] * 4 * log(2) / (PI * fwhm * fwhm * cos(incidence));
    if (!(image_peak > 0.05 * (x[1] + x[2]))) return; /* no image stands out of the haze */
    for (int w = 0; w < size; w++) {
        solve_window(&window, haze, w, x);
        reflectance[w] = fmax(0, x[0]);
        for (int i = 0; i < window.count; i++) {
            const Spot *spot = &window.spot[i];
            float *at = value + (size_t)spot->row * (size_t)size + w;
            double model = x[1] * pow(1 + spot->b2 / (haze[0] * haze[0]), -haze[1]) + x[2];
            bool   in_core = spot->angle < CORE_FWHMS * fwhm;
            *at = (float)(in_core ? fmax(model, 0) : (double)*at - reflectance[w] * spot->image);
        }
    }
}
