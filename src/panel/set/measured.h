/* SPDX-License-Identifier: Apache-2.0 */
/* measured.h -- what a laboratory measured of one display: a measurement set in memory.
 *
 * Frame    the display's: theta from the normal, phi 0 right, 90 up; in a reflection table
 *          phi is the leaving azimuth with the light at 180, so the mirror direction is at 0.
 * Units    radians inside; XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine.
 * Memory   an arena's. Threads: const once read (measurement.h).
 */
#pragma once
#include "panel/set/angle_table.h"
#include "panel/set/display_traits.h"
#include "panel/set/level_table.h"
#include "panel/set/specular_table.h"
#include "panel/set/uniformity_map.h"
#include "spectrum/spectral_table.h"

#define MEASUREMENT_INCIDENCES_MAX 32
#define MEASUREMENT_WAVELENGTHS_MAX 256
#define MEASUREMENT_AZIMUTHS_MAX 72
#define MEASUREMENT_SPOTS_MAX 49
#define MEASUREMENT_TABLES_MAX 1152 /* of reflection: incidences times azimuths */

#define INSTRUMENT_FWHM_LEAST 0.05 /* degrees */
#define INSTRUMENT_FWHM_MOST 15

typedef struct Measurement {
    const char *file;                              /* the manifest */
    Lines inputs;                                  /* that, and every file that it names */
    const char *panel, *instrument, *note;         /* "": not stated */
    const char *date, *operator_name, *conditions; /* of the measurement; likewise */
    double pixels[2], size_mm[2];
    double instrument_fwhm_deg; /* width of its own response; 0: not declared */
    DisplayTraits traits;       /* of the emission */
    double white_miss;          /* 0: Rec.709 carries every colour; else the share of the
                                   brightest one that it cannot */
    bool is_white_only;         /* primary tables are the split of a white table */
    AngleTable white;           /* of a white-only set: the table itself */
    const LevelTable *levels;   /* that gave a white-only set its levels and black; or NULL */
    double white_apart[2];      /* of white that was measured beside the primaries and the sum of
                                   these, along the normal: share of its luminance, delta u'v' */
    bool has_black;
    AngleTable black;
    MeasuredPrimary primary[3];
    bool has_spectra;
    float spectrum[3][SPECTRAL_COUNT]; /* relative, every nm from SPECTRAL_FIRST_NM */
    int backlight;         /* without spectra: 1 + a place in primary_backlights, or 0 */
    double peaks_nm[3];    /* of its bands of red, green and blue; 0: not stated */
    double spectra_beyond; /* share of V(lambda) where light of them was not measured */
    int incidence_count, wavelength_count;            /* 0: no reflection data */
    double incidence[MEASUREMENT_INCIDENCES_MAX];     /* radians, rising */
    float wavelength_nm[MEASUREMENT_WAVELENGTHS_MAX]; /* rising */
    int azimuth_count;                        /* of the light; 1: isotropic, symmetric in phi */
    double azimuth[MEASUREMENT_AZIMUTHS_MAX]; /* radians, rising, [0, 2 pi) */
    AngleTable *brdf; /* azimuth * incidence_count + incidence; channels: wavelengths */
    const SpecularTable *specular; /* what comes back around the mirror direction, or NULL */
    int spot_count;                /* 0: what stands above was measured at one place */
    struct MeasuredSpot *spot;
    bool spots_emit, spots_reflect; /* some of them */
    const UniformityMap *map;       /* NULL: none */
} Measurement;

/* Measurements at a place of the active area. The set's own tables, which then exist, stand
 * in for those that a spot lacks. */
typedef struct MeasuredSpot {
    double at[2]; /* u from 0 at the left to 1 at the right, v from 0 at the top to 1 */
    bool has_emission, has_reflection;
    Measurement *set; /* its tables; names, sizes and spectra are the whole set's */
} MeasuredSpot;
