/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_fresnel.h -- what reflection tables are divided by: the unpolarised reflectance of
 * a smooth face of ordinary glass. Pure functions. */
#pragma once
#include "spectrum/fresnel.h"

#define REFLECTION_REFRACTIVE_INDEX 1.5

/* The cosine is clamped, since rounding may have left its range. */
static inline double reflection_fresnel(double cosine)
{
    return fresnel_unpolarised_d(fmin(1, fmax(0, cosine)), REFLECTION_REFRACTIVE_INDEX);
}
