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

/* What is seen of a curve lies between, all but a thousandth. */
#define CURVE_SEEN_FIRST_NM 400
#define CURVE_SEEN_LAST_NM 700

#define CURVE_HELD_MOST 0.02 /* more is worth a warning */

/* Under even light, the share of X + Y + Z at wavelengths outside the measured ones, if the end
 * values hold there. */
double curve_held_share(const double *nm, const double *value, int count);

/* A CSV of `nm,value` rows (header line and # comments allowed) in memory, terminated; path: of
 * the file, for messages, which name the line of a value that is out of range. Without any
 * wavelength from CURVE_SEEN_FIRST_NM to CURVE_SEEN_LAST_NM it is refused. *held (or NULL): its
 * held share. */
bool curve_parse(const char *text, const char *path, CurveRange range, Curve *out,
                 double *held, Error *err);

#define INDEX_MAX 100.0

/* The same of a refractive index n + ik, rows `nm,n,k`; both 0 to INDEX_MAX, never both 0. */
bool curve_parse_index(const char *text, const char *path, Curve *n, Curve *k, double *held,
                       Error *err);

/* Value of every lane's wavelength. */
Spectrum curve_lookup(const Curve *curve, const Wavelengths *wavelengths);
