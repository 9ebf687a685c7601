/* SPDX-License-Identifier: Apache-2.0 */
/* shader_fixture.h -- spectra and eyes that every surface model is tried with. */
#pragma once
#include "check.h"

#include "base/mathf.h"
#include "base/sampler.h"
#include "base/vec.h"
#include "shaders/bsdf_model.h"
#include "spectrum/spectrum.h"

/* Linear from the first lane to the last. */
static inline Spectrum ramp(float from, float to) {
    Spectrum s;
    for (int i = 0; i < SPECTRUM_LANES; i++) s[i] = from + (to - from) * (float)i / 15;
    return s;
}

#define EYE_COUNT 6

/* From the normal to grazing, each at an azimuth of its own. */
static inline Vec3 eye(int i) {
    const float cosines[EYE_COUNT] = {1, 0.8f, 0.5f, 0.2f, 0.05f, 0.01f};
    float c = cosines[i], s = safe_sqrtf(1 - c * c), sine, cosine;
    sincos_turns(0.17f * (float)i, &sine, &cosine);
    return vec3(s * cosine, s * sine, c);
}

static inline void draw(Sampler *sampler, float u[3]) {
    Vec2 a = sampler_2d(sampler);
    u[0] = a.x;
    u[1] = a.y;
    u[2] = sampler_1d(sampler);
}

/* Of the whole sphere, even. */
static inline Vec3 random_direction(Sampler *sampler) {
    Vec2 u = sampler_2d(sampler);
    float z = 2 * u.x - 1, r = safe_sqrtf(1 - z * z), sine, cosine;
    sincos_turns(u.y, &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}

/* |S'| <= S0' of wholly polarised light, in every lane. */
static inline void stokes_law(const char *name, const BsdfPolarisation *m, Vec3 stokes) {
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        double d = (double)m->difference[i], k = (double)m->kept[i];
        double c = (double)m->along[i], t = (double)m->turned[i];
        double x = (double)stokes.x, y = (double)stokes.y, z = (double)stokes.z;
        double out[4] = {1 + d * x, d + k * x, c * y - t * z, t * y + c * z};
        double size = sqrt(out[1] * out[1] + out[2] * out[2] + out[3] * out[3]);
        if (!(k >= 0 && k <= 1 + 1e-5 && size <= out[0] + 2e-5))
            fail_msg("%s: polarised light of %g becomes %g, of it polarised %g", name, 1.0, out[0],
                     size);
    }
}
