/* SPDX-License-Identifier: Apache-2.0 */
/* polarisation.h -- what a boundary does to polarised light.
 *
 * Axes     of light that comes along wi and leaves along wo: x across the plane of both (where
 *          they lie in one line: across it and the normal), y = (where the light goes) cross x.
 *          x is the same before and after. Of Stokes' S1 light along x is positive, of S2 light
 *          half-way from x to y, of S3 light that turns clockwise as seen against it.
 * Matrix   Mueller's, over its first element: [1 d 0 0; d k 0 0; 0 0 c -t; 0 0 t c].
 * Sources  Born and Wolf, "Principles of Optics", 1.5.2 to 1.5.4 (fields as e^(ikx - iwt));
 *          Chipman, Lam, Young, "Polarized Light and Optical Systems", 2018, chapter 6.
 * Threads  pure functions.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/layers/pane.h"
#include "spectrum/fresnel.h"

/* For light polarised across (s) and along (p) the plane of incidence, shares in [0, 1]; and
 * the mean over all fields of a_s times the conjugate of a_p, a the amplitudes: what S2 and S3
 * become. */
typedef struct Waves {
    float s, p;
    float along, turned; /* its real and imaginary part */
} Waves;

/* A boundary of real index; eta, cosine as of fresnel_dielectric; eta 0: a perfect mirror.
 * Under total reflection both waves come back whole and out of step. */
static inline Waves waves_reflected(float cosine, float eta) {
    float behind;
    Fresnel face = fresnel_dielectric(cosine, eta, &behind);
    if (!(eta > 0)) return (Waves){1, 1, -1, 0};
    float sine2 = (1 - cosine * cosine) / (eta * eta);
    if (sine2 < 1 || !(cosine > 0)) {
        float s = (cosine - eta * behind) / (cosine + eta * behind);
        float p = (eta * cosine - behind) / (eta * cosine + behind);
        return (Waves){face.s, face.p, cosine > 0 ? s * p : 1, 0};
    }
    /* s = (a - ib) / (a + ib), p = (c - id) / (c + id): s p* = z / conj(z), z as below. */
    float falls = sqrtf(sine2 - 1), a = cosine, b = eta * falls, c = eta * cosine, d = falls;
    float real = a * c + b * d, imaginary = a * d - b * c;
    float size2 = real * real + imaginary * imaginary;
    if (!(size2 > 0)) return (Waves){1, 1, 1, 0};
    return (Waves){1, 1, (real * real - imaginary * imaginary) / size2,
                   2 * real * imaginary / size2};
}

static inline Waves waves_through(float cosine, float eta) {
    Fresnel face = fresnel_dielectric(cosine, eta, NULL);
    return (Waves){1 - face.s, 1 - face.p, sqrtf((1 - face.s) * (1 - face.p)), 0};
}

/* Parts of what a surface scatters, each by its own matrix, added up; light of no part is
 * unpolarised. Begins as {0}. */
typedef struct PolarisedParts {
    Spectrum share, difference, along, turned;
} PolarisedParts;

static inline void polarised_add(PolarisedParts *sum, Waves w, Spectrum share) {
    float mean = 0.5f * (w.s + w.p), scale = mean > 0 ? 1 / mean : 0;
    sum->share += share;
    sum->difference += share * spectrum_all(0.5f * (w.s - w.p) * scale);
    sum->along += share * spectrum_all(w.along * scale);
    sum->turned += share * spectrum_all(w.turned * scale);
}

/* A bare pane: one face as it is met, what the body lets through once, and whether the light
 * goes on through it. All orders, whose fields add up by their shares. */
typedef struct PolarisedPane {
    Waves face;
    Spectrum through;
    bool passes;
} PolarisedPane;

/* The same; what s and p send, and the mean of a_s and the conjugate of a_p. */
static inline void polarised_add_pane(PolarisedParts *sum, const PolarisedPane *pane,
                                      Spectrum share) {
    Waves face = pane->face;
    Spectrum r_s = spectrum_all(face.s), r_p = spectrum_all(face.p), t = pane->through;
    Spectrum half = spectrum_all(0.5f), s, p, along = spectrum_all(face.along);
    Spectrum lets = spectrum_all((1 - face.s) * (1 - face.p)) * pane_turns(along * along * t * t);
    s = pane->passes ? pane_passes(r_s, r_s, t) : pane_reflects(r_s, r_s, t);
    p = pane->passes ? pane_passes(r_p, r_p, t) : pane_reflects(r_p, r_p, t);
    along = pane->passes ? lets * t : along + along * lets * t * t;
    Spectrum per = share / spectrum_max(half * (s + p), spectrum_all(1e-30f));
    sum->share += share;
    sum->difference += per * half * (s - p);
    sum->along += per * along;
}

/* The same of a coated boundary or a metal, met at `cosine`. */
static inline void polarised_add_coated(PolarisedParts *sum, const CoatingWaves *waves,
                                        const Wavelengths *wavelengths, float cosine,
                                        Spectrum share) {
    Spectrum s = coating_at(waves->s, wavelengths, cosine);
    Spectrum p = coating_at(waves->p, wavelengths, cosine), half = spectrum_all(0.5f);
    Spectrum per = share / spectrum_max(half * (s + p), spectrum_all(1e-30f));
    sum->share += share;
    sum->difference += per * half * (s - p);
    sum->along += per * coating_at(waves->along, wavelengths, cosine);
    sum->turned += per * coating_at(waves->turned, wavelengths, cosine);
}

/* all: what the surface scatters there in all, polarised or not. */
static inline BsdfPolarisation polarised_of(const PolarisedParts *sum, Spectrum all) {
    Spectrum over = spectrum_all(1) / spectrum_max(all, spectrum_all(1e-30f));
    return (BsdfPolarisation){sum->difference * over, sum->share * over, sum->along * over,
                              sum->turned * over};
}

static inline BsdfPolarisation polarised_by(Waves w) {
    PolarisedParts one = {spectrum_all(0), spectrum_all(0), spectrum_all(0), spectrum_all(0)};
    polarised_add(&one, w, spectrum_all(1));
    return polarised_of(&one, spectrum_all(1));
}
