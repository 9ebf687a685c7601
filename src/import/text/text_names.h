/* SPDX-License-Identifier: Apache-2.0 */
/* text_names.h -- what the words of a measurement file mean: columns, units, azimuths.
 *
 * Memory   none. Threads: no shared state.
 */
#pragma once
#include "import/text/text_lines.h"

typedef enum Quantity {
    QUANTITY_NONE, /* a column that is not used */
    QUANTITY_THETA,
    QUANTITY_PHI,
    QUANTITY_HORIZONTAL,
    QUANTITY_VERTICAL, /* the two angles of other conventions */
    QUANTITY_INCIDENCE,
    QUANTITY_LIGHT_PHI,
    QUANTITY_WAVELENGTH,
    QUANTITY_CODE_R,
    QUANTITY_CODE_G,
    QUANTITY_CODE_B, /* what the panel showed */
    QUANTITY_X,
    QUANTITY_Y,
    QUANTITY_Z,
    QUANTITY_LUMINANCE,
    QUANTITY_CHROMA_X,
    QUANTITY_CHROMA_Y,
    QUANTITY_UPRIME,
    QUANTITY_VPRIME,
    QUANTITY_REFLECTION, /* at the column's wavelength, 0: the table's */
    QUANTITY_COUNT
} Quantity;

typedef enum ValueUnit {
    UNIT_AUTO,
    UNIT_CD_M2,
    UNIT_NIT,
    UNIT_FOOT_LAMBERT,
    UNIT_KCD_M2,
    UNIT_CD_FT2,
    UNIT_BRDF,     /* sr^-1 */
    UNIT_BRDF_COS, /* sr^-1 times the cosine of the leaving angle */
    UNIT_FACTOR    /* reflectance or radiance factor: relative to a white Lambertian surface */
} ValueUnit;

typedef enum AngleUnit { ANGLE_AUTO, ANGLE_DEGREES, ANGLE_RADIANS } AngleUnit;

typedef struct ColumnName {
    Quantity quantity;
    double wavelength_nm; /* of a reflection column; 0: not stated */
    ValueUnit unit;       /* UNIT_AUTO: not stated */
    AngleUnit angle;
    bool is_ambiguous; /* "u": CIE 1960 or 1976? */
} ColumnName;

/* "theta_deg", "Azimuth [rad]", "X", "L (fL)", "400nm", "brdf_550"; QUANTITY_NONE: unknown. */
ColumnName column_name(TextCell cell);

/* "cd/m2", "nit", "fL", "1/sr", "BRDF*cos", "BRF", ...; UNIT_AUTO when it is none. */
ValueUnit value_unit(TextCell cell);
const char *value_unit_name(ValueUnit unit);

/* "deg", "degrees", "rad", the degree sign; ANGLE_AUTO when it is none. */
AngleUnit angle_unit(const char *unit);

/* Into cd m^-2; 0 for what is no luminance. */
double value_unit_cd_m2(ValueUnit unit);

/* ---- azimuths ---------------------------------------------------------------------------- */

typedef struct AzimuthWords {
    bool has_zero, has_sense, has_side;
    double zero_deg; /* where azimuth 0 points: 0 right, 90 up */
    int sense;       /* 1 counter-clockwise, -1 clockwise */
    bool is_behind;  /* seen from behind the panel */
} AzimuthWords;

/* Reads a line about azimuths: "0 = 12 o'clock; clockwise". */
AzimuthWords azimuth_words(TextLine line);

/* Is the text there, in any case? */
bool line_has(TextLine line, const char *words);
