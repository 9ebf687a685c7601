/* SPDX-License-Identifier: Apache-2.0 */
/* pane.h -- a thin pane: two faces and one body that absorbs, whatever names its tint.
 *
 * All turns of light between the faces are added up, for each polarisation by itself and
 * without interference between the faces. With r1, r2 what the face that is met and the far
 * one reflect and t what the body lets through once, on the refracted way:
 *     R = r1 + (1 - r1)^2 t^2 r2 / (1 - r1 r2 t^2),  T = (1 - r1) (1 - r2) t / (1 - r1 r2 t^2)
 * A coated face reflects r from the air and r' from the glass and lets c through; what is
 * neither it absorbs. With q = r1' r2' t^2:
 *     R = r1 + c1^2 t^2 r2' / (1 - q),               T = c1 c2 t / (1 - q)
 *
 * Units    shares of the light, [0, 1]; cosines of the angle outside, [0, 1].
 * Source   Born and Wolf, "Principles of Optics", 1.5.2 (faces).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "base/mathf.h"
#include "shaders/layers/coating.h"
#include "spectrum/fresnel.h"

#define PANE_LEAST_COSINE 1e-4f /* inside: a slanted way is at most so long */

typedef struct PaneLight {
    Spectrum reflected, passed; /* mean of both polarisations */
} PaneLight;

/* The images of a coated pane for one polarisation: of the face that is met, of the far face,
 * and how much of one ghost the next one has; and what passes. */
typedef struct PaneImages {
    Spectrum first, ghost, next, passed;
} PaneImages;

/* A coated pane as light meets it. */
typedef struct PaneMeeting {
    const PaneCoating *coating;
    const Wavelengths *wavelengths;
    float cosine;
    bool is_front;    /* the front's face is met */
    Spectrum through; /* the body, once */
} PaneMeeting;

/* One polarisation; returns what is reflected in all. */
Spectrum pane_coated_images(const PaneMeeting *meeting, bool is_p, PaneImages *out);

PaneLight pane_coated(const PaneMeeting *meeting);

/* The same of the faces' means over the hemisphere; the cosine does not count. */
PaneLight pane_coated_mean(const PaneMeeting *meeting);

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"

/* The cosine of the refracted direction, by Snell's law. */
static inline float pane_cosine_inside(float cosine, float ior) {
    return safe_sqrtf(1 - (1 - cosine * cosine) / (ior * ior));
}

/* Mean of 1 / cosine inside over the hemisphere, weighted by the cosine outside: 2 n^2 (1 -
 * sqrt(1 - 1 / n^2)). */
static inline float pane_mean_slant(float ior) {
    float n2 = ior * ior;
    return n2 < 1e6f ? 2 * n2 * (1 - sqrtf(1 - 1 / n2)) : 1;
}

/* What a body lets through once; tint: along the normal. ior 1 or more. */
static inline Spectrum pane_body(Spectrum tint, float cosine, float ior) {
    float inside = max_f(pane_cosine_inside(cosine, ior), PANE_LEAST_COSINE);
    return spectrum_pow(tint, 1 / inside);
}

/* Between two perfect mirrors nothing gets in: 0, and not 0 / 0. */
static inline Spectrum pane_turns(Spectrum next) {
    return spectrum_all(1) / spectrum_max(spectrum_all(1) - next, spectrum_all(1e-12f));
}

static inline Spectrum pane_reflects(Spectrum near, Spectrum far, Spectrum t) {
    Spectrum in = spectrum_all(1) - near, t2 = t * t;
    return near + in * in * t2 * far * pane_turns(near * far * t2);
}

static inline Spectrum pane_passes(Spectrum near, Spectrum far, Spectrum t) {
    return (spectrum_all(1) - near) * (spectrum_all(1) - far) * t * pane_turns(near * far * t * t);
}

/* Two like faces, which reflect s and p of the two polarisations. */
static inline PaneLight pane_between(Spectrum s, Spectrum p, Spectrum t) {
    Spectrum half = spectrum_all(0.5f);
    return (PaneLight){half * (pane_reflects(s, s, t) + pane_reflects(p, p, t)),
                       half * (pane_passes(s, s, t) + pane_passes(p, p, t))};
}

#pragma GCC diagnostic pop
