/* shader_fixture.h -- spectra and eyes that every surface model is tried with. */
#pragma once
#include "check.h"

#include "base/mathf.h"
#include "base/sampler.h"
#include "base/vec.h"
#include "spectrum/spectrum.h"

/* Linear from the first lane to the last. */
static inline Spectrum ramp(float from, float to)
{
    Spectrum s;
    for (int i = 0; i < SPECTRUM_LANES; i++) s[i] = from + (to - from) * (float)i / 15;
    return s;
}

#define EYE_COUNT 6

/* From the normal to grazing, each at an azimuth of its own. */
static inline Vec3 eye(int i)
{
    const float cosines[EYE_COUNT] = {1, 0.8f, 0.5f, 0.2f, 0.05f, 0.01f};
    float c = cosines[i], s = safe_sqrtf(1 - c * c), sine, cosine;
    sincos_turns(0.17f * (float)i, &sine, &cosine);
    return vec3(s * cosine, s * sine, c);
}

static inline void draw(Sampler *sampler, float u[3])
{
    Vec2 a = sampler_2d(sampler);
    u[0] = a.x;
    u[1] = a.y;
    u[2] = sampler_1d(sampler);
}

/* Of the whole sphere, even. */
static inline Vec3 random_direction(Sampler *sampler)
{
    Vec2  u = sampler_2d(sampler);
    float z = 2 * u.x - 1, r = safe_sqrtf(1 - z * z), sine, cosine;
    sincos_turns(u.y, &sine, &cosine);
    return vec3(r * cosine, r * sine, z);
}
