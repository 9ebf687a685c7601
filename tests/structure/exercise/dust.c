/* SPDX-License-Identifier: Apache-2.0 */
/* Dust
 * ====
 * Grains that shade each other: light that one of them scatters evenly and that leaves the
 * layer without meeting another. Seen from the side the layer is brighter than paper would be.
 *
 *   f = grain / (4 pi (cos i + cos e))        Lommel and Seeliger, for grains that are dark
 *
 * Parameters  grain: share of the light that a grain scatters, by wavelength. 0.1 is soot.
 * Valid       for grains below about 0.3: brighter ones light each other, which is left out.
 */
/* HOT: no allocation, no lock, no libm. */
#include "shaders/dust.h"

#include <math.h>

#include "base/mathf.h"
#include "base/units.h"

static Spectrum model_eval(const void *parameters, Vec3 wo, Vec3 wi, float *pdf) {
    const Dust *dust = parameters;
    *pdf = fmaxf(wi.z, 0) * INV_PI_F;
    if (!(wi.z > 0 && wo.z > 0)) return spectrum_all(0);
    return dust->grain * spectrum_all(1 / (4 * PI_F * (wi.z + wo.z)));
}

/* Uniform over the disc below the hemisphere: by the cosine. */
static bool model_sample(const void *parameters, Vec3 wo, const float u[3], BsdfSample *sample) {
    float radius = sqrtf(u[0]), sine, cosine;
    sincos_turns(u[1], &sine, &cosine);
    *sample = (BsdfSample){.wi = vec3(radius * cosine, radius * sine, sqrtf(1 - u[0]))};
    Spectrum f = model_eval(parameters, wo, sample->wi, &sample->pdf);
    if (!(sample->pdf > 0)) return false;
    sample->weight = f * spectrum_all(sample->wi.z / sample->pdf);
    return true;
}

static void model_facts(const void *parameters, BsdfFacts *facts) {
    (void)parameters;
    facts->scatters = true;
}

/* The integral of f cos i over the hemisphere: grain / 2 (1 - e ln(1 + 1 / e)), e = cos e. */
static Spectrum model_albedo(const void *parameters, Vec3 wo) {
    const Dust *dust = parameters;
    float e = fmaxf(wo.z, 1e-4f);
    return dust->grain * spectrum_all(0.5f * (1 - e * log_f(1 + 1 / e)));
}

static void model_lobes(const void *parameters, Vec3 wo, BsdfLobes *lobes) {
    lobes->prob = 1;
    lobes->diffuse = spectrum_max_lane(model_albedo(parameters, wo));
}

const BsdfModel dust_model = {
    .scatter = {.eval = model_eval,
                .sample = model_sample,
                .albedo = model_albedo,
                .lobes = model_lobes},
    .facts = model_facts,
};
