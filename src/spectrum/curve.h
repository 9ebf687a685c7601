/* SPDX-License-Identifier: Apache-2.0 */
/* curve.h -- a measured spectrum over wavelength, ready for lookup.
 *
 * Unit     the quantity's own. Range 360..830 nm in steps of 1 nm, linear between; outside the
 *          measured range the end value holds.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"
#include "spectrum/wavelengths.h"

#define CURVE_FIRST_NM 360
#define CURVE_LAST_NM 830
#define CURVE_COUNT (CURVE_LAST_NM - CURVE_FIRST_NM + 1)

typedef struct Curve {
    float value[CURVE_COUNT];
} Curve;

/* Linear interpolation of count measured points; nm rises strictly, count >= 1. */
void curve_from_points(const double *nm, const double *value, int count, Curve *out);

#define CURVE_FILE_BYTES_MAX ((size_t)16 << 20)

/* The permitted values of a curve. */
typedef enum CurveRange {
    CURVE_NUMBERS, /* any */
    CURVE_AMOUNTS, /* 0 and up */
    CURVE_SHARES   /* 0 to 1 */
} CurveRange;

/* A spectrum reaches from the first to the last of them, all but a thousandth of what is seen
 * and is whole from 380 to 780 nm (CIE 15). */
#define CURVE_SEEN_FIRST_NM 400
#define CURVE_SEEN_LAST_NM 700
#define CURVE_WHOLE_FIRST_NM 380
#define CURVE_WHOLE_LAST_NM 780

/* Ends of an emission that are dark: nothing is missing beyond. */
typedef struct CurveEnds {
    bool first, last;
} CurveEnds;

/* Values at the ends up to that share of the largest are dark. */
CurveEnds curve_dark_ends(const double *value, int count, double share);

bool curve_reaches(double first_nm, double last_nm, CurveEnds dark);

/* The share of V(lambda) beyond the measured wavelengths, where end values stand for them; 0
 * where they are whole. */
double curve_beyond(double first_nm, double last_nm, CurveEnds dark);

/* File, per cent, CURVE_WHOLE_FIRST_NM, CURVE_WHOLE_LAST_NM. */
#define CURVE_BEYOND_WARNING \
    "%s: %.2g %% of V(lambda) is extrapolated: its end values stand " \
    "for what is missing of %d to %d nm"

/* What is not wrong with a file, but to be said. */
typedef struct CurveNotes {
    double beyond;    /* curve_beyond */
    char unknown[40]; /* a unit of its header that is not known; "" */
} CurveNotes;

/* File, unit. */
#define CURVE_UNIT_WARNING \
    "%s: its header has the unit (%s), which is not known: its values are taken as they stand"

/* A CSV of `nm,value` rows (# comments and a header line, which is heeded: curve_header.h) in
 * memory, terminated; path: of the file, for messages, which name the line of a value that is
 * out of range. It is refused where it does not reach (above); CURVE_AMOUNTS may end in the
 * dark. notes: or NULL. */
bool curve_parse(const char *text, const char *path, CurveRange range, Curve *out,
                 CurveNotes *notes, Error *err);

#define INDEX_MAX 100.0

/* The same of a refractive index n + ik, rows `nm,n,k`; both 0 to INDEX_MAX, never both 0. */
bool curve_parse_index(const char *text, const char *path, Curve *n, Curve *k, CurveNotes *notes,
                       Error *err);

/* Value of every lane's wavelength. */
Spectrum curve_lookup(const Curve *curve, const Wavelengths *wavelengths);
