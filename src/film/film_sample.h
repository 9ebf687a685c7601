/* SPDX-License-Identifier: Apache-2.0 */
/* film_sample.h -- what a film takes: samples, layers, rectangles. Units and ranges: film.h. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "film/layers.h"

#define FILM_SAMPLES_MAX 0x7fffffffu
#define FILM_DROPPED_KEPT 8
#define FILM_LIGHTS_MAX 256

/* Light of one group in a sample. */
typedef struct FilmLight {
    int group;    /* index into the film's */
    float xyz[3]; /* cd m^-2 */
} FilmLight;

/* One sample of one pixel. Everything that belongs to a display is of the FIRST surface the
 * camera ray met (windows passed straight through do not count). */
typedef struct FilmSample {
    uint32_t sample_index;    /* of the pixel: settles which id is shown, and the replay hint */
    float xyz[3];             /* cd m^-2 */
    float stokes[3];          /* S1, S2, S3 of its luminance, cd m^-2 (path/polarised.h) */
    bool hit;                 /* the camera ray met a surface; else depth .. uv are unset */
    float depth;              /* m, along the ray */
    float position[3];        /* m, world */
    float normal[3];          /* unit, world, shading */
    float albedo[3];          /* linear Rec.709 */
    float uv[2];              /* uv set 0 */
    int part_id;              /* scene part, -1 where nothing was hit */
    int display_id;           /* scene display; -1 off displays: emitted .. phi are unset */
    float emitted[3];         /* XYZ, cd m^-2: what the panel itself sends to the eye */
    float mirror[3];          /* XYZ, cd m^-2: what came via the panel's mirror */
    float lambertian[3];      /* XYZ, cd m^-2: what its lambertian part scattered */
    float white[3], black[3]; /* XYZ the panel would send for full white and for black */
    float extrapolated[2];    /* luminance, cd m^-2, by directions that were not measured: of what
                                 is emitted, and of what is reflected */
    float theta, phi;         /* radians, display frame, phi in [0, 2 pi) */
    float fine[3];            /* XYZ, cd m^-2: what displays send to the whole pixel, from more
                                 camera rays than this one; 0 where those see none */
    float sources[3];         /* XYZ, cd m^-2: what the first surface sends itself, if it is no
                                 display; else 0 */
    const FilmLight *lights;  /* what makes up xyz, but for rounding: no group twice */
    int light_count;          /* of lights; a group without an entry gave nothing */
} FilmSample;

typedef struct FilmRect {
    int x0, y0, x1, y1; /* half-open, pixels of the whole frame */
} FilmRect;

/* The groups of lights that LAYER_LIGHT keeps apart, by the names of their layers. */
typedef struct FilmLights {
    int count;                /* at most FILM_LIGHTS_MAX */
    const char *const *names; /* no two the same */
} FilmLights;

typedef struct Film Film; /* opaque: the accumulators are private to src/film */

#define FILM_MOST_CD_M2 0x1p47 /* of a sample that is kept */

/* Samples that were dropped, and where the first of them (by sample, then row, then column)
 * stood: enough to replay them. */
typedef struct FilmDropped {
    uint64_t count;
    int kept; /* entries below */
    struct {
        uint32_t sample_index;
        int x, y;
    } first[FILM_DROPPED_KEPT];
} FilmDropped;
