/* SPDX-License-Identifier: Apache-2.0 */
/* gamut.h -- how a display's triangle of colours compares with the standards', and the colour
 * temperature of its white.
 *
 * Units    CIE 1931 xy or CIE 1976 u'v' (2 degree observer), shares of an area, K.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

/* Red, green, blue in a chromaticity plane. */
typedef struct GamutTriangle {
    double at[3][2];
} GamutTriangle;

typedef enum GamutStandard {
    GAMUT_SRGB,   /* IEC 61966-2-1; Rec. ITU-R BT.709 */
    GAMUT_DCI_P3, /* SMPTE RP 431-2 */
    GAMUT_BT2020, /* Rec. ITU-R BT.2020 */
    GAMUT_STANDARDS
} GamutStandard;

const char *gamut_name(GamutStandard standard);

/* In xy. */
GamutTriangle gamut_triangle(GamutStandard standard);

/* The same colours in u'v'. */
GamutTriangle gamut_in_uv(const GamutTriangle *xy);

/* Area over the standard's. */
double gamut_area(const GamutTriangle *panel, const GamutTriangle *standard);

/* Share of the standard's triangle that the panel's covers; 0 where the primaries are no
 * triangle of that order. */
double gamut_coverage(const GamutTriangle *panel, const GamutTriangle *standard);

/* Correlated colour temperature (CIE 15): of the black body nearest in the CIE 1960 plane, (u',
 * 2/3 v'). */
typedef struct ColourTemperature {
    double kelvin;
    double duv;      /* distance from the locus there, above 0 on the green side */
    bool is_defined; /* no further than 0.05 from it, between 1000 and 25000 K */
} ColourTemperature;

ColourTemperature colour_temperature(const double uv[2]);
