/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_peak.h -- taking the mirror's image, as wide as the instrument, out of a measured
 * table.
 *
 * Units    radians; reflectances without unit, tables in sr^-1.
 * Memory   the arena's. Threads: pure functions of an arena each. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "panel/fit/reflection/peak_window.h"

#define PEAK_RANGE_ROWS 8 /* fewer rows do not determine a model with five numbers */

/* Least and most of each, means over the wavelengths. */
typedef struct PeakRange {
    double mirror[2];
    double haze[2]; /* under the peak, with the lambertian part */
    double fwhm[2]; /* of the haze, across the plane of incidence */
    double spread;  /* half of what the haze may vary by, relative: the largest one from the
                       mirror direction to two steps of the rows from it */
    bool has_model; /* false: too few rows; only the mirror's range is set then */
} PeakRange;

/* Inputs of the search for the mirror's image in a table. */
typedef struct PeakTask {
    const AngleTable *slice;
    double incidence, fwhm;       /* of the instrument; 0: not declared */
    double noise;                 /* of the slice, relative */
    const PeakSpecular *specular; /* NULL: not measured */
} PeakTask;

/* Data that determine the mirror's reflectance. */
typedef enum PeakSource {
    PEAK_SAMPLES,  /* the samples: within 5 % of it, or of the least that matters */
    PEAK_SPECULAR, /* the samples and the specular measurement */
    PEAK_APART,    /* the specular measurement alone: the samples hold no image */
    PEAK_OPEN      /* nothing: what was taken out is a guess inside the range */
} PeakSource;

typedef struct PeakMirror {
    double *reflectance; /* per wavelength, room for them */
    PeakSource source;
    PeakRange range;         /* of mirror and haze */
    PeakModel model;         /* of the haze, where the range has one */
    double lambertian, rest; /* of the same */
    PeakSpacing spacing;     /* of the rows around the mirror direction */
    double specular_miss;    /* between the specular measurement and what mirror and haze
                                send into its aperture, a share of the larger */
    bool has_haze_open;      /* the haze near the mirror direction may differ by more than
                                5 % from what was taken */
} PeakMirror;

/* Whether a specular measurement has a mirror that the samples do not hold, as of instruments
 * that leave the mirror direction out: far more light than all that the samples have around it,
 * or none of them near enough to have seen it. */
bool reflection_peak_is_apart(const PeakTask *task, Arena scratch);

/* The mirror is then the specular measurement less the haze in its aperture; the samples stay
 * as they are. */
void reflection_peak_take_apart(const PeakTask *task, Arena *arena, PeakMirror *mirror,
                                AngleTable *haze);

/* Takes the mirror's image out of one table: reflectances, and the table without it (values in
 * the arena). */
void reflection_peak_take_mirror(const PeakTask *task, Arena *arena, PeakMirror *mirror,
                                 AngleTable *haze);
