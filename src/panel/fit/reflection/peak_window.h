/* SPDX-License-Identifier: Apache-2.0 */
/* peak_window.h -- the rows of a table near the mirror direction, and the model that
 * separates a peak from the haze under it.
 *
 * Model    f = R image + (a + t tilt) haze + lambertian leaving; image a Gaussian of a given
 *          width, haze = gain (1 + b2 / width^2)^-power, b the distance of the directions'
 *          projections on the panel.
 * Units    radians; tables in sr^-1. Memory: the arena's. Threads: a window by one at a time.
 * Fails    never.
 */
#pragma once
#include "panel/set/angle_table.h"
#include "spectrum/fresnel.h"

/* What tables are divided by: the unpolarised reflectance of a smooth face of ordinary glass.
 * The cosine is clamped, since rounding may have left its range. */
#define REFLECTION_REFRACTIVE_INDEX 1.5
static inline double reflection_fresnel(double cosine) {
    return fresnel_unpolarised_d(fmin(1, fmax(0, cosine)), REFLECTION_REFRACTIVE_INDEX);
}

/* How far apart a table's rows are around the mirror direction, radians. */
typedef struct PeakSpacing {
    double theta;  /* between rings */
    double across; /* between azimuths, along the ring: times the sine of theta */
    double widest; /* the larger of both: narrower things are not seen by every row */
} PeakSpacing;

PeakSpacing peak_window_spacing(const AngleTable *table, double incidence, Arena scratch);

/* One row near the mirror direction. */
typedef struct PeakRow {
    int row;
    double image;   /* of a mirror of reflectance 1, sr^-1 */
    double b2;      /* squared distance of the projections on the panel's plane */
    double tilt;    /* theta - incidence */
    double gain;    /* sqrt(F(theta) / F(incidence)) */
    double angle;   /* to the mirror direction */
    double leaving; /* what the surface lets out: 1 - F(theta) */
    double mean;    /* over the wavelengths */
} PeakRow;

/* Reflectance within an aperture around the mirror direction: one more equation. */
typedef struct PeakSpecular {
    double aperture;     /* full angle, radians; 0: the mirror alone */
    double weight;       /* of the equation, relative to a row's */
    double mean;         /* over the wavelengths */
    const double *value; /* per wavelength */
} PeakSpecular;

typedef struct PeakWindow {
    PeakRow *row;
    int count, stride; /* stride: of the rows that a solution counts */
    double incidence;
    double lambertian; /* of the slice, mean over the wavelengths, over `leaving` */
    double width[2];   /* of the haze, that are tried; 0: 0.5 to 40 times scale */
    const AngleTable *slice;
    const PeakSpecular *specular; /* NULL: none */
} PeakWindow;

typedef struct PeakModel {
    double width, power;
    double r, a, t;
} PeakModel;

/* Angle between a direction of a table and the mirror direction. */
double peak_window_angle(double theta, double phi, double incidence);

/* Squared distance of their projections on the panel's plane. */
double peak_window_squares(double theta, double phi, double incidence);

/* Mean of a row over the wavelengths. */
double peak_window_row_mean(const AngleTable *slice, int row);

/* The rows within `reach`. */
PeakWindow peak_window_collect(const AngleTable *slice, double incidence, double reach,
                               Arena *arena);

/* How wide the image is. */
void peak_window_set_image(PeakWindow *window, double fwhm);

/* Lambertian part by the slice alone, at a wavelength, over `leaving`. */
double peak_window_lambertian(const AngleTable *slice, int wavelength);

double peak_model_haze(const PeakModel *model, const PeakRow *spot);

/* Full width at half of the haze's height. */
double peak_model_fwhm(const PeakModel *model);

/* Least squares over r, a, t at the model's width and power, rows weighted with 1 / f^2;
 * wavelength -1: the mean. Returns the weighted rms rest. */
double peak_window_solve(const PeakWindow *window, int wavelength, double lambertian,
                         PeakModel *model);

/* Variances of r and a at the model's width and power, for rows of relative error 1. */
void peak_window_variances(const PeakWindow *window, PeakModel *model, double variance[2]);

/* By how much a model misses the specular measurement, a share of the larger. */
double peak_window_specular_miss(const PeakWindow *window, const PeakModel *model);

/* The best width for the model's power, and r, a, t. Returns the rest. */
double peak_window_best_width(const PeakWindow *window, double scale, PeakModel *model);

/* Width and power of the haze under the image, the same for all wavelengths. scale: of the
 * widths that are tried. */
PeakModel peak_window_choose_haze(const PeakWindow *window, double scale);
