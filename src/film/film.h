/* film.h -- adds samples up exactly into a linear image and its layers.
 *
 * Units    CIE XYZ with Y in cd m^-2; row 0 at the top; the crop is half-open.
 * Exact    sums are 128-bit fixed point: any order of adding gives the same bits.
 * Memory   everything comes from `arena`; nothing to free.
 * Threads  tiles of different pixels may be filled at the same time; one pixel belongs to one
 *          thread at a time.
 * Fails    never; a sample that is not finite is counted and dropped.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

/* What one sample of one pixel saw. Everything that belongs to a display is of the FIRST
 * surface the camera ray met (windows passed straight through do not count). */
typedef struct FilmSample {
    float xyz[3];          /* cd m^-2 */
    bool  hit;             /* the camera ray met a surface; else depth .. uv are unset */
    float depth;           /* m, along the ray */
    float position[3];     /* m, world */
    float normal[3];       /* unit, world, shading */
    float albedo[3];       /* linear Rec.709 */
    float uv[2];           /* uv set 0 */
    int   part_id;         /* scene part, -1 where nothing was hit */
    int   display_id;      /* scene display, -1 off displays; else: */
    float emitted[3];      /* XYZ, cd m^-2: what the panel itself sends to the eye */
    float white[3], black[3]; /* XYZ it would send for full white and for black */
    float theta, phi;      /* radians, display frame, phi in [0, 2 pi) */
} FilmSample;

typedef enum FilmLayer {
    LAYER_XYZ = 1 << 0, LAYER_DEPTH = 1 << 1, LAYER_POSITION = 1 << 2, LAYER_NORMAL = 1 << 3,
    LAYER_ALBEDO = 1 << 4, LAYER_ID = 1 << 5, LAYER_UV = 1 << 6, LAYER_VARIANCE = 1 << 7,
    LAYER_SAMPLES = 1 << 8, LAYER_DISPLAY_EMITTED = 1 << 9, LAYER_DISPLAY_REFLECTED = 1 << 10,
    LAYER_DISPLAY_WHITE = 1 << 11, LAYER_DISPLAY_BLACK = 1 << 12, LAYER_DISPLAY_ANGLES = 1 << 13,
    LAYER_DISPLAY_CONTRAST = 1 << 14,
    LAYER_ALL = (1 << 15) - 1
} FilmLayer;

typedef struct FilmRect {
    int x0, y0, x1, y1; /* half-open, pixels of the whole frame */
} FilmRect;

typedef struct Film Film; /* opaque: the accumulators are private to film.c */

/* width, height: the whole frame, at least 1; crop: the part that is kept; layers: a set of
 * FilmLayer bits. */
Film *film_create(int width, int height, FilmRect crop, unsigned layers, Arena *arena);

/* x, y: pixel inside the crop. */
void film_add_sample(Film *film, int x, int y, const FilmSample *sample);
