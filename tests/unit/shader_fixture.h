/* shader_fixture.h -- spectra and eyes that every surface model is tried with. */
#pragma once
#include "check.h"

#include "base/mathf.h"
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
