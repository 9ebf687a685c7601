/* SPDX-License-Identifier: Apache-2.0 */
/* fresnel.h -- how much a smooth boundary reflects.
 *
 * Reflectances are shares of the light, in [0, 1]; cosines are of the angle to the normal.
 * Sources  Born and Wolf, "Principles of Optics", 1.5.2; Schlick 1994 for metals.
 * Threads  pure functions.
 */
#pragma once
#include <math.h>

#include "spectrum/spectrum.h"

#define CLEARCOAT_IOR 1.5f /* of the lacquer of KHR_materials_clearcoat */

/* Reflectance of light polarised across (s) and along (p) the plane of incidence. */
typedef struct Fresnel {
    float s, p;
} Fresnel;

/* eta: index behind the boundary over the index in front of it, > 0. cosine: in front, [0, 1].
 * *cosine_behind: of the refracted direction, 0 under total reflection; may be NULL. */
static inline Fresnel fresnel_dielectric(float cosine, float eta, float *cosine_behind) {
    float sine2 = (1 - cosine * cosine) / (eta * eta);
    float behind = sine2 < 1 ? sqrtf(1 - sine2) : 0.0f;
    if (cosine_behind) *cosine_behind = behind;
    if (!(sine2 < 1) || !(cosine > 0)) return (Fresnel){1, 1};
    float s = (cosine - eta * behind) / (cosine + eta * behind);
    float p = (eta * cosine - behind) / (eta * cosine + behind);
    return (Fresnel){s * s, p * p};
}

/* Light without polarisation. */
static inline float fresnel_mean(Fresnel face) {
    return 0.5f * (face.s + face.p);
}

static inline float fresnel_unpolarised(float cosine, float eta) {
    return fresnel_mean(fresnel_dielectric(cosine, eta, NULL));
}

/* The same in double precision, for what is made before the first ray. cosine in [0, 1];
 * behind the critical angle 1. */
static inline double fresnel_unpolarised_d(double cosine, double eta) {
    double behind = sqrt(fmax(0, 1 - (1 - cosine * cosine) / (eta * eta)));
    double s = (cosine - eta * behind) / (cosine + eta * behind);
    double p = (eta * cosine - behind) / (eta * cosine + behind);
    return 0.5 * (s * s + p * p);
}

/* Reflectance at normal incidence. */
static inline float fresnel_normal(float eta) {
    float r = (eta - 1) / (eta + 1);
    return r * r;
}

/* The exact curve's rise from 0 at normal incidence to 1 at grazing; 0 where there is no
 * boundary. */
static inline float fresnel_shape(float eta, float cosine) {
    if (!(eta > 1)) return 0;
    float f0 = fresnel_normal(eta);
    return (fresnel_unpolarised(cosine, eta) - f0) / (1 - f0);
}

/* (1 - cosine)^5 */
static inline float schlick_weight(float cosine) {
    float m = clampf(1 - cosine, 0, 1), m2 = m * m;
    return m2 * m2 * m;
}

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"
/* Metals: f0 + (1 - f0)(1 - cosine)^5 per lane. */
static inline Spectrum fresnel_schlick(Spectrum f0, float cosine) {
    return f0 + (spectrum_all(1) - f0) * spectrum_all(schlick_weight(cosine));
}
#pragma GCC diagnostic pop
