/* SPDX-License-Identifier: Apache-2.0 */
/* film_sample.h -- what a film takes: samples, layers, rectangles. Units and ranges: film.h. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#define FILM_SAMPLES_MAX 0x7fffffffu
#define FILM_DROPPED_KEPT 8
#define FILM_LIGHTS_MAX 256

/* Light of one group in a sample. */
typedef struct FilmLight {
    int   group; /* index into the film's */
    float xyz[3]; /* cd m^-2 */
} FilmLight;

/* One sample of one pixel. Everything that belongs to a display is of the FIRST surface the
 * camera ray met (windows passed straight through do not count). */
typedef struct FilmSample {
    uint32_t sample_index; /* of the pixel: settles which id is shown, and the replay hint */
    float xyz[3];          /* cd m^-2 */
    float stokes[3];       /* S1, S2, S3 of its luminance, cd m^-2 (path/polarised.h) */
    bool  hit;             /* the camera ray met a surface; else depth .. uv are unset */
    float depth;           /* m, along the ray */
    float position[3];     /* m, world */
    float normal[3];       /* unit, world, shading */
    float albedo[3];       /* linear Rec.709 */
    float uv[2];           /* uv set 0 */
    int   part_id;         /* scene part, -1 where nothing was hit */
    int   display_id;      /* scene display, -1 off displays; else: */
    float emitted[3];      /* XYZ, cd m^-2: what the panel itself sends to the eye */
    float mirror[3];       /* XYZ, cd m^-2: what came by way of the panel's mirror, */
    float lambertian[3];   /* and what its lambertian part scattered */
    float white[3], black[3]; /* XYZ it would send for full white and for black */
    float extrapolated[2]; /* luminance, cd m^-2, by directions that were not measured: of what
                              is emitted, and of what is reflected */
    float theta, phi;      /* radians, display frame, phi in [0, 2 pi) */
    float fine[3];         /* XYZ, cd m^-2: what displays send to the whole pixel, from more
                              camera rays than this one; 0 where those see none */
    const FilmLight *lights; /* what makes up xyz, but for rounding; no group twice; */
    int   light_count;       /* groups that are not there gave nothing */
} FilmSample;

typedef enum FilmLayer {
    LAYER_XYZ = 1 << 0,
    LAYER_DEPTH = 1 << 1,
    LAYER_POSITION = 1 << 2,
    LAYER_NORMAL = 1 << 3,
    LAYER_ALBEDO = 1 << 4,
    LAYER_ID = 1 << 5,
    LAYER_UV = 1 << 6,
    LAYER_VARIANCE = 1 << 7,
    LAYER_SAMPLES = 1 << 8,
    LAYER_DISPLAY_EMITTED = 1 << 9,
    LAYER_DISPLAY_REFLECTED = 1 << 10,
    LAYER_DISPLAY_WHITE = 1 << 11,
    LAYER_DISPLAY_BLACK = 1 << 12,
    LAYER_DISPLAY_ANGLES = 1 << 13,
    LAYER_DISPLAY_CONTRAST = 1 << 14,
    LAYER_HALVES = 1 << 15,
    LAYER_DISPLAY_FINE = 1 << 16,
    LAYER_DISPLAY_MIRROR = 1 << 17,
    LAYER_DISPLAY_SCATTERED = 1 << 18,
    LAYER_DISPLAY_HAZE = 1 << 19,
    LAYER_DISPLAY_LAMBERTIAN = 1 << 20,
    LAYER_LIGHT = 1 << 21,
    LAYER_DISPLAY_HALVES = 1 << 22,
    LAYER_STOKES = 1 << 23, /* the one that not every render can have */
    LAYER_DISPLAY_VARIANCE = 1 << 24,
    LAYER_DISPLAY_SECOND = 1 << 25,
    LAYER_ROUNDED = 1 << 26, /* no layer: variances and halves have 8 bits, which pack well */
    LAYER_DISPLAY_EXTRAPOLATED = 1 << 27,
    LAYER_EVERY = (1 << 28) - 1,
    LAYER_ALL = LAYER_EVERY & ~(LAYER_STOKES | LAYER_ROUNDED),
    LAYER_DISPLAYS = ((LAYER_HALVES - 1) & ~(LAYER_DISPLAY_EMITTED - 1)) | LAYER_DISPLAY_FINE |
                     LAYER_DISPLAY_MIRROR | LAYER_DISPLAY_SCATTERED | LAYER_DISPLAY_HAZE |
                     LAYER_DISPLAY_LAMBERTIAN | LAYER_DISPLAY_HALVES |
                     LAYER_DISPLAY_VARIANCE | LAYER_DISPLAY_SECOND |
                     LAYER_DISPLAY_EXTRAPOLATED,
    LAYER_COMPARED = LAYER_VARIANCE | LAYER_DISPLAY_EMITTED | LAYER_DISPLAY_REFLECTED |
                     LAYER_DISPLAY_WHITE | LAYER_DISPLAY_BLACK | LAYER_DISPLAY_VARIANCE |
                     LAYER_DISPLAY_SECOND | LAYER_ROUNDED, /* what src/compare reads */
    LAYER_NEEDS_LAMBERTIAN = LAYER_DISPLAY_HAZE | LAYER_DISPLAY_LAMBERTIAN,
    LAYER_FEATURES = LAYER_ALL & ~(LAYER_XYZ | LAYER_VARIANCE | LAYER_SAMPLES | LAYER_HALVES |
                                   LAYER_LIGHT)
} FilmLayer; /* LAYER_FEATURES: those that need the members from `hit` on */

typedef struct FilmRect {
    int x0, y0, x1, y1; /* half-open, pixels of the whole frame */
} FilmRect;

/* The groups of lights that LAYER_LIGHT keeps apart, by the names of their layers. */
typedef struct FilmLights {
    int count; /* at most FILM_LIGHTS_MAX */
    const char *const *names; /* no two the same */
} FilmLights;

typedef struct Film Film; /* opaque: the accumulators are private to src/film */

#define FILM_MOST_CD_M2 0x1p47 /* of a sample that is kept */

/* Samples that were dropped, and where the first of them (by sample, then row, then column)
 * stood: enough to replay them. */
typedef struct FilmDropped {
    uint64_t count;
    int      kept; /* entries below */
    struct {
        uint32_t sample_index;
        int      x, y;
    } first[FILM_DROPPED_KEPT];
} FilmDropped;
