/* film.h -- adds samples up exactly into a linear image and its layers.
 *
 * Units    CIE XYZ with Y in cd m^-2; row 0 at the top; the crop is half-open.
 * Exact    every sum is 128-bit fixed point: any order of adding gives the same bits.
 *            XYZ and layers: steps of 2^-48 (3.6e-15), one sample at most 2^47 (1.4e14), so
 *            that 2^31 samples stay below 2^126 steps. A float above 2^-25 (3e-8 cd m^-2) is
 *            taken as it is; a smaller one is rounded to a step.
 *            Squares for the variance have two windows: steps of 2^-61 for squares below 2^34
 *            (131072 cd m^-2), steps of 2^5 above; a square of RGB is below 2^99, so 2^31 of
 *            them stay below 2^126 steps in either. Relative to the square a step is 2^-29 or
 *            less for 1e-5 cd m^-2 and more.
 *          A pixel takes at most FILM_SAMPLES_MAX samples; an assertion guards it.
 * Memory   everything comes from `arena`; nothing to free. 224 bytes a pixel, and 48 for each
 *          three-component layer.
 * Threads  tiles of different pixels may be filled at the same time; one pixel belongs to one
 *          thread at a time. Reading needs all writers to be done.
 * Fails    never; a sample that is not finite or beyond 2^47 is counted and dropped.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "image/frame.h"

#define FILM_SAMPLES_MAX 0x7fffffffu
#define FILM_DROPPED_KEPT 8

/* What one sample of one pixel saw. Everything that belongs to a display is of the FIRST
 * surface the camera ray met (windows passed straight through do not count). */
typedef struct FilmSample {
    uint32_t sample_index; /* of the pixel: settles which id is shown, and the replay hint */
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
    LAYER_ALL = (1 << 16) - 1,
    LAYER_DISPLAYS = (LAYER_HALVES - 1) & ~(LAYER_DISPLAY_EMITTED - 1),
    LAYER_FEATURES = LAYER_ALL & ~(LAYER_XYZ | LAYER_VARIANCE | LAYER_SAMPLES | LAYER_HALVES)
} FilmLayer; /* LAYER_FEATURES: those that need the members from `hit` on */

typedef struct FilmRect {
    int x0, y0, x1, y1; /* half-open, pixels of the whole frame */
} FilmRect;

typedef struct Film Film; /* opaque: the accumulators are private to src/film */

/* width, height: the whole frame, at least 1; crop: the part that is kept, not empty and
 * inside the frame; layers: a set of FilmLayer bits. */
Film *film_create(int width, int height, FilmRect crop, unsigned layers, Arena *arena);

/* Bytes that film_create will take. */
size_t film_bytes(FilmRect crop, unsigned layers);

/* x, y: pixel inside the crop. Members that no layer asks for need not be set, but display_id
 * is always looked at when hit is true. */
void film_add_sample(Film *film, int x, int y, const FilmSample *sample);

/* ---- what is in it ----------------------------------------------------------------------- */

/* One pixel as it stands. */
typedef struct FilmPixel {
    uint32_t samples;         /* kept ones */
    double   mean_xyz[3];     /* cd m^-2; 0 without samples */
    double   variance_rgb[3]; /* of the mean, (cd m^-2)^2, as if samples were independent; NaN
                                 below two */
    double   sigma_y;         /* standard error of Y; right in the mean over many pixels */
    int      display_id;      /* of the lowest sample index that saw a display; -1: none did */
} FilmPixel;

FilmPixel film_pixel(const Film *film, int x, int y);

/* How sure the frame is: the mean over pixels of sigma / max(Y, Y_low). Y_low is half the
 * frame's key, the geometric mean of the luminances above zero (Reinhard et al. 2002): the
 * noise of deep shadows is judged against what an eye adapted to the frame sees, the same as
 * the 0.01 in the usual relMSE when the key is exposed to 0.18; a sun in view does not move it.
 * A pixel of fewer than two samples counts 1.
 * From 32 samples on sigma comes from the difference of two halves of the samples, in
 * interleaved blocks of 16: scrambled Sobol points are better than independent ones, and the
 * difference knows it. Below, from the samples' spread as if they were independent, taken as
 * 0.21 sigma_R + 0.72 sigma_G + 0.07 sigma_B: too much rather than too little. */
typedef struct FilmError {
    double frame;
    double displays; /* over the pixels that show a display; NaN where none does */
} FilmError;

FilmError film_relative_error(const Film *film);

/* One pixel's share in it. One sigma of few halves is itself uncertain: the worst of a million
 * pixels of equal noise is some seven times their mean by chance. */
typedef struct FilmWorst {
    int    x, y;
    double luminance; /* cd m^-2 */
    double error;     /* sigma / max(Y, Y_low) */
} FilmWorst;

/* The `count` pixels of the greatest error, the worst first, of equals the first row by row;
 * returns how many there are. */
int film_worst_pixels(const Film *film, int count, FilmWorst *out);

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

FilmDropped film_dropped(const Film *film);

/* The frame as frame.h describes it, with R, G, B and the layers asked for. Rules:
 *   depth, position, normal, albedo, uv   mean over the samples that hit something (a mean of
 *       unit normals is shorter than one across an edge); NaN where none did. A sample whose
 *       features are not finite counts as a miss here, not for the light;
 *   id.part, id.display   of the lowest sample index that hit a part, or saw a display; -1;
 *       id.display comes with every layer of displays;
 *   display.*   over the samples that saw a display, NaN where none did: emitted, white and
 *       black are means, reflected is the mean of (sample - emitted), so the pixel's mean minus
 *       emitted wherever the whole pixel is display; theta and phi are those of the mean
 *       direction; contrast is the ratio of mean luminances;
 *   halves   the weighted difference of two interleaved halves of the samples: its square has
 *       the expectation of the variance of the pixel's mean, if the halves are independent.
 *       Sobol points' halves fill each other's gaps: measured between frames of two seeds, its
 *       root mean square is 0 to 6 % too large at 32 samples, 12 % at 256 (that of `variance`
 *       7 to 29 %). NaN below 32 samples. */
FrameImage film_to_frame(const Film *film, int attribute_room, Arena *arena);
