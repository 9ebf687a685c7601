/* SPDX-License-Identifier: Apache-2.0 */
/* scatter.h -- what importers of reflection share: directions, rows of a table, wavelengths,
 * the integral over a polar grid.
 *
 * Frame     of a reflection table (import.h): +z the normal, phi 0 the mirror direction, the
 *           light at phi 180. Degrees at the border, sr^-1 without the cosine.
 * Memory    the arena's. Threads: one set per thread.
 */
#pragma once
#include "import/set/import_rows.h"

/* A unit vector, away from the surface. */
typedef struct Direction {
    double x, y, z;
} Direction;

Direction direction_from_degrees(double theta_deg, double phi_deg);
void direction_to_degrees(Direction d, double *theta_deg, double *phi_deg);
double direction_dot(Direction a, Direction b);
Direction direction_scaled_sum(Direction a, double s, Direction b, double t); /* s a + t b */
Direction direction_unit(Direction a);

/* The direction at `radial_deg` from the mirror direction of light at incidence_deg, turned by
 * `azimuth_deg` from the tangent towards the normal, counter-clockwise as one looks down on
 * the surface (Radiant's and OpticStudio's scatter angles). */
Direction direction_about_mirror(double incidence_deg, double radial_deg, double azimuth_deg);

/* ---- rows of a table --------------------------------------------------------------------- */

/* Room for `capacity` directions, measured or not. */
ImportRows scatter_rows(Arena *arena, int capacity, int channels);

/* Adds one; `value` holds the channels. Beyond 90 degrees it is left out. */
void scatter_put(ImportRows *rows, double theta_deg, double phi_deg, const double *value);
void scatter_mask(ImportRows *rows, double theta_deg, double phi_deg);

/* As scatter_put, any turn of phi; values that are all exactly 0 mark a direction that was not
 * measured. */
void scatter_put_measured(ImportRows *rows, double theta_deg, double phi_deg, const double *value);

typedef struct ScatterLight {
    double incidence_deg;
    double azimuth_deg; /* of the light; 180 for data without an azimuth of its own. Any turn */
} ScatterLight;

/* Adds the rows as a table. Light from a second azimuth makes the set anisotropic, or is left
 * out (with a note) when the user calls the set isotropic. Negative
 * values stay: they are noise below the zero of the instrument. */
bool scatter_add(ImportSet *set, const char *file, const ImportRows *rows, ScatterLight light,
                 const float *wavelength_nm, Error *err);

/* ---- wavelengths ------------------------------------------------------------------------- */

/* One band. */
const float *scatter_band(double nm, ImportSet *set);

/* --wavelength; or an error that requests it (NULL). */
const float *scatter_wavelength(const ImportOptions *options, const char *file, ImportSet *set,
                                Error *err);

/* Of X, Y and Z the photopic Y alone is taken, with a note, and stands at one wavelength, with
 * another; --wavelength wins. */
#define PHOTOPIC_NM 555.0
const float *scatter_xyz(const ImportOptions *options, const char *file, ImportSet *set);

/* RGB values stand as three bands near the dominant wavelengths of the primaries of Rec. 709,
 * blue first since wavelengths rise; a note states it. */
#define RGB_BANDS 3
const float *scatter_rgb_bands(const char *file, ImportSet *set);

/* ---- grids ------------------------------------------------------------------------------- */

/* Values on radial x azimuth about an axis that leans by axis_deg from the normal. */
typedef struct ScatterGrid {
    int radials, azimuths;
    const double *radial_deg, *azimuth_deg; /* rising */
    const double *value;                    /* azimuths x radials */
    double axis_deg;
    bool is_half; /* azimuths 0 to 180, the other half is their mirror image */
} ScatterGrid;

/* Integral of value * cos(angle from the normal) over the upper hemisphere, bilinear between
 * the nodes; nothing beyond them (a full turn of azimuths is closed). */
double scatter_grid_integral(const ScatterGrid *grid, Arena scratch);

/* "10 deg 0.0387 (0.0391), ...": stated and integrated totals for one note. */
typedef struct TotalsNote {
    char text[640];
    int count;
} TotalsNote;

void totals_add(TotalsNote *note, double incidence_deg, double stated, double integrated);

/* One note with both figures of every incidence, if any were added. */
void totals_report(const TotalsNote *note, const char *file, ImportSet *set);

/* Is the list rising, and within [least, most]? The error names `what` and the file. */
bool angles_check(const char *file, const char *what, const double *list, int count,
                  const double range[2], Error *err);
