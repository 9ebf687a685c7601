/* bsdf_sample.h -- one chosen direction of scattered light: what every model hands back.
 *
 * Frame, units and sense of directions are those of bsdf.h.
 */
#pragma once
#include "base/vec.h"
#include "spectrum/spectrum.h"

typedef struct BsdfSample {
    Vec3     wi;
    Spectrum weight;   /* eval * |cos wi| / pdf */
    float    pdf;      /* sr^-1 of eval's part; probability of the choice when is_delta */
    bool     is_delta; /* light sampling can never produce this direction */
    bool     passes;   /* went straight through (wi = -wo): shadow rays pass here too, so it is
                          no scattering event for multiple importance sampling */
} BsdfSample;
