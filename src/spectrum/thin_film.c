/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/thin_film.h"

#include <complex.h>

#include "base/mathd.h"
#include "base/units.h"

/* One medium as a plane wave finds it. */
typedef struct Wave {
    double complex square; /* of the index */
    double complex normal; /* the index times the cosine inside: the wave's part along z */
    double complex phase;  /* over the layer's thickness; its modulus is 1 at most */
} Wave;

/* Amplitudes of the fields along the boundary, over that of the incoming one. */
typedef struct Amplitudes {
    double complex reflected, through;
} Amplitudes;

void thin_film_media(const LayerStack *stack, ThinMedium body, int nm, ThinMedia *out) {
    int at = nm - CURVE_FIRST_NM, count = 0;
    out->nm = nm;
    out->medium[count++] = (ThinMedium){stack ? stack->outside : 1, 0, 0};
    for (int i = 0; stack && i < stack->count; i++) {
        const ThinLayer *layer = &stack->layers[i];
        out->medium[count++] = (ThinMedium){(double)layer->index.n.value[at],
                                            (double)layer->index.k.value[at], layer->thickness_nm};
    }
    out->medium[count++] = body;
    out->count = count;
}

void thin_film_reverse(ThinMedia *media) {
    for (int i = 0, k = media->count - 1; i < k; i++, k--) {
        ThinMedium kept = media->medium[i];
        media->medium[i] = media->medium[k];
        media->medium[k] = kept;
    }
}

static double square_of(double complex z) {
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* The root with an imaginary part of at least 0: what runs inwards falls off inwards. */
static double complex root_inwards(double complex z) {
    double size = sqrt(square_of(z));
    double large = sqrt(0.5 * (size + fabs(creal(z))));
    double small = large > 0 ? fabs(cimag(z)) / (2 * large) : 0;
    double real = creal(z) >= 0 ? large : small, imaginary = creal(z) >= 0 ? small : large;
    return cimag(z) < 0 ? -real + imaginary * I : real + imaginary * I;
}

/* A medium in which the wave runs exactly along the boundary has no amplitudes of its own; it
 * is taken for one next to it. */
static Wave wave_in(const ThinMedium *medium, double along2, double nm) {
    Wave wave;
    double complex index = medium->n + medium->k * I;
    wave.square = index * index;
    wave.normal = root_inwards(wave.square - along2);
    if (square_of(wave.normal) < 1e-18) wave.normal = 1e-9;
    wave.phase = 1;
    if (!(medium->thickness_nm > 0)) return wave; /* what lies outside of all layers */
    double turns = 2 * PI * medium->thickness_nm / nm;
    double angle = turns * creal(wave.normal), fall = turns * cimag(wave.normal);
    wave.phase = (fall != 0 ? exp_d(-fall) : 1) * (cos_d(angle) + sin_d(angle) * I);
    return wave;
}

static double complex quotient(double complex a, double complex b) {
    return a * conj(b) / square_of(b);
}

/* (u - v) / (u + v) with the admittances u in front and v behind: of s the normal part itself,
 * of p the square of the index over it (here multiplied out). */
static double complex boundary(const Wave *front, const Wave *behind, bool is_p) {
    double complex u = is_p ? front->square * behind->normal : front->normal;
    double complex v = is_p ? behind->square * front->normal : behind->normal;
    return quotient(u - v, u + v);
}

/* From the last boundary to the first: below each lie all the waves found so far. */
static Amplitudes add_up(const Wave *wave, int count, bool is_p) {
    Amplitudes below = {0, 1};
    for (int i = count - 2; i >= 0; i--) {
        double complex f = boundary(&wave[i], &wave[i + 1], is_p);
        double complex phase = i + 2 < count ? wave[i + 1].phase : 1;
        double complex back = below.reflected * phase * phase;
        double complex turns = 1 + f * back;
        below.reflected = quotient(f + back, turns);
        below.through = quotient((1 + f) * phase * below.through, turns);
    }
    return below;
}

static double flux(const Wave *wave, bool is_p) {
    return creal(is_p ? quotient(wave->square, wave->normal) : wave->normal);
}

static double complex shares_of(const Wave *wave, int count, bool is_p, double *reflect,
                                double *through) {
    Amplitudes a = add_up(wave, count, is_p);
    *reflect = fmin(square_of(a.reflected), 1);
    *through = square_of(a.through) * flux(&wave[count - 1], is_p) / flux(&wave[0], is_p);
    return a.reflected;
}

ThinShares thin_film_at(const ThinMedia *media, double cosine) {
    Wave wave[THIN_LAYERS_MAX + 2];
    ThinShares shares = {.reflect_s = 1, .reflect_p = 1, .reflect_along = 1};
    double index = media->medium[0].n, along2 = index * index * (1 - cosine * cosine);
    if (!(cosine > 0)) return shares;
    for (int i = 0; i < media->count; i++) wave[i] = wave_in(&media->medium[i], along2, media->nm);
    wave[0].normal = index * cosine;
    double complex s = shares_of(wave, media->count, false, &shares.reflect_s, &shares.through_s);
    double complex p = shares_of(wave, media->count, true, &shares.reflect_p, &shares.through_p);
    double complex both = -s * conj(p); /* along the boundary p's axis turns round */
    shares.reflect_along = creal(both);
    shares.reflect_turned = cimag(both);
    return shares;
}
