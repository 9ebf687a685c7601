/* SPDX-License-Identifier: Apache-2.0 */
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
 * Lights   groups of LAYER_LIGHT add up to XYZ to the step: what rounding leaves of a sample
 *          (some 1e-7 of it) goes to its brightest group.
 * Memory   everything comes from `arena`; nothing to free. 224 bytes a pixel, and 48 for each
 *          three-component layer and group of lights, 64 for display.halves, 96 for
 *          display.variance, 192 more for display.second, 32 for display.extrapolated. Those of
 *          displays take memory where pixels show one; a page of it, and of the others, is
 *          first touched by the thread that fills its pixels.
 * Threads  tiles of different pixels may be filled at the same time; one pixel belongs to one
 *          thread at a time. Reading needs all writers to be done.
 * Fails    never; a sample that is not finite or beyond 2^47 is counted and dropped.
 */
#pragma once
#include "base/arena.h"
#include "film/film_sample.h"

/* width, height: the whole frame, at least 1; crop: the part that is kept, not empty and
 * inside the frame; layers: a set of FilmLayer bits; lights: the groups of LAYER_LIGHT, whose
 * names must live as long as the film; NULL: none. */
Film *film_create(int width, int height, FilmRect crop, unsigned layers, const FilmLights *lights,
                  Arena *arena);

/* Pixels that have no sample are out of view (a fisheye's corners): they count in no error. */
void film_set_blind(Film *film);

/* Bytes that film_create will take with so many groups of lights, if displays fill the crop. */
size_t film_bytes(FilmRect crop, unsigned layers, int light_count);

/* x, y: pixel inside the crop. Members that no layer needs need not be set, but display_id
 * is always read when hit is true. */
void film_add_sample(Film *film, int x, int y, const FilmSample *sample);

/* ---- what is in it ----------------------------------------------------------------------- */

/* One pixel as it stands. */
typedef struct FilmPixel {
    uint32_t samples;       /* kept ones */
    double mean_xyz[3];     /* cd m^-2; 0 without samples */
    double variance_rgb[3]; /* of the mean, (cd m^-2)^2, as if samples were independent; NaN
                               below two */
    double sigma_y;         /* standard error of Y; right in the mean over many pixels */
    double square_y;        /* its square, right in the mean: the variance of Y */
    int display_id;         /* of the lowest sample index that saw a display; -1: none did */
} FilmPixel;

FilmPixel film_pixel(const Film *film, int x, int y);

/* The relative error: the mean over pixels of sigma / max(Y, Y_low). Y_low is half the
 * frame's key, the geometric mean of the luminances above zero (Reinhard et al. 2002): the
 * noise of deep shadows is judged against what an eye adapted to the frame sees, the same as
 * the 0.01 in the usual relMSE when the key is exposed to 0.18; a sun in view does not move it.
 * A pixel of fewer than two samples counts 1.
 * From 32 samples on sigma comes from the difference of two halves of the samples, in
 * interleaved blocks of 16: scrambled Sobol points are better than independent ones, and the
 * difference shows it. Below, from the samples' spread as if they were independent, taken as
 * 0.21 sigma_R + 0.72 sigma_G + 0.07 sigma_B: too much rather than too little. */
typedef struct FilmError {
    double frame;
    double displays; /* over the pixels that show a display; NaN where none does */
} FilmError;

FilmError film_relative_error(const Film *film);

/* Samples that are kept, over all its pixels. */
uint64_t film_kept_samples(const Film *film);

#define FILM_ALL_PIXELS (-2)
#define FILM_ANY_DISPLAY (-1)

/* Some of the pixels: those of `rect`, and of them all, those that show a display, or those
 * that show the one of this id. */
typedef struct FilmArea {
    FilmRect rect;
    int display;
} FilmArea;

/* The same mean over an area; NaN where it has no pixel. */
double film_area_error(const Film *film, FilmArea area);

/* Pixels of which one sample seems to have made the most: s, the root of square_y, is above
 * FILM_SPIKE of Y. Means over all pixels of the area, of s / max(Y - s, Y_low) where it is so,
 * else 0, and of its square. */
#define FILM_SPIKE 0.8

typedef struct FilmSpikes {
    double mean, square;
} FilmSpikes;

FilmSpikes film_area_spikes(const Film *film, FilmArea area);

/* The frame's relative error, if what its spikes brought is everywhere, where that is more than
 * FILM_RARE times `error`, the measured one: light is rare then, and pixels that have had no such
 * sample show no noise. Else NaN. */
#define FILM_RARE 2
double film_rare_error(const Film *film, double error);

/* One pixel's share in it. One sigma of few halves is itself uncertain: the worst of a million
 * pixels of equal noise is some seven times their mean by chance. */
typedef struct FilmWorst {
    int x, y;
    double luminance; /* cd m^-2 */
    double error;     /* sigma / max(Y, Y_low) */
} FilmWorst;

/* The `count` pixels of the greatest error, the worst first, of equals the first row by row;
 * returns how many there are. */
int film_worst_pixels(const Film *film, int count, FilmWorst *out);

/* Samples that were dropped. */
FilmDropped film_dropped(const Film *film);
