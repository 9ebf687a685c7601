/* SPDX-License-Identifier: Apache-2.0 */
/* exposure.h -- how much light becomes middle grey.
 *
 * Units    luminance in cd m^-2; EV is the photographic exposure value at ISO 100.
 * Threads  pure functions.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"

#define MIDDLE_GREY 0.18

/* ISO 2720's reflected-light meters with K = 12.5: EV e calls L = 2^e K / 100 an average
 * scene, which becomes middle grey. */
#define EXPOSURE_METER_CD_M2 0.125

/* Middle grey of EV `ev`, cd m^-2, and back. */
double exposure_grey_of_ev(double ev);
double exposure_ev_of_grey(double grey_cd_m2);

typedef enum ExposureKind { EXPOSURE_AUTO, EXPOSURE_EV, EXPOSURE_WHITE } ExposureKind;

typedef struct ExposureRequest {
    ExposureKind kind;
    double value; /* EV, or the luminance that becomes 1.0: white in a view that keeps
                   * what is linear (untonemapped), light grey in others */
} ExposureRequest;

/* "auto", a number of EV, or "white:CD_M2". */
bool exposure_parse(const char *text, ExposureRequest *out, Error *err);

/* The luminance that a request makes middle grey, cd m^-2. */
double exposure_grey(ExposureRequest request, const float *luminance_cd_m2, size_t count,
                     Arena scratch);

/* How many stops the 90th percentile of what is above 0 lies above middle grey; 0 of a dark
 * picture. */
double exposure_bright_stops(const float *luminance_cd_m2, size_t count, double grey_cd_m2,
                             Arena scratch);
