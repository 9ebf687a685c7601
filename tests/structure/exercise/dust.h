/* SPDX-License-Identifier: Apache-2.0 */
/* dust.h -- a layer of dark grains.
 *
 * Threads  plain values.
 */
#pragma once
#include "shaders/bsdf_model.h"

typedef struct Dust {
    Spectrum grain; /* share of the light that one grain scatters, [0, 1] */
} Dust;

extern const BsdfModel dust_model;
