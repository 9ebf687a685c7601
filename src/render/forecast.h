/* SPDX-License-Identifier: Apache-2.0 */
/* forecast.h -- how many samples a requested relative error will take.
 *
 * The error of equal samples falls with the square root of their count. What is measured of it
 * early is too small, though: the rare bright samples that make most of the noise have not been
 * seen yet. So the samples that an error seems to require grow while a frame is rendered: on
 * the shipped scenes by 35 % from 4 to 8 samples a pixel, 20 % from 8 to 16, 12 % from 32 to
 * 64, 9 % from 64 to 128, each doubling by some 0.6 of the one before. A Forecast watches that
 * growth and goes on with it.
 *
 * Only what is shown depends on it.
 * Threads   a Forecast is a plain value; {0} begins one.
 */
#pragma once
#include <stdint.h>

typedef struct Forecast {
    uint32_t samples; /* of the last reading that growth was taken from; 0: none yet */
    double wanted;    /* samples that the error took then */
    double growth;    /* of the required samples in the last doubling, as a share */
} Forecast;

/* The samples that the requested error takes, in fractions. error_ratio: the error after `done`
 * samples, at least 1, over the requested one; where it is not finite the answer is
 * INFINITY. */
double forecast_samples(Forecast *forecast, uint32_t done, double error_ratio);
