/* SPDX-License-Identifier: Apache-2.0 */
/* pixels.h -- how the film keeps a pixel; private to src/film.
 *
 * A pixel is a fixed part and then the sums of the layers that are kept, in the order of
 * LayerSums, and then XYZ of each group of lights: so files have it, and film_gather. In memory
 * the sums over the samples that saw a display lie in an array of their own: most pixels see
 * none, and where they lie together no page is ever touched. All sums are two's complement
 * integers that count steps: see film.h for ranges.
 */
#pragma once
#include <pthread.h>
#include <stddef.h>

#include "film/film_sample.h"

__extension__ typedef __int128 Fixed;

#define FIXED_BITS 48         /* a step is 2^-48: XYZ and layers */
#define SQUARE_LOW_BITS 61    /* a step is 2^-61: squares below SQUARE_SPLIT */
#define SQUARE_HIGH_BITS (-5) /* a step is 2^5: the others */
#define SQUARE_SPLIT 0x1p34
#define SHARED_LOW_BITS 45 /* so that ids of 16 bits stay in range */
#define VALUE_LIMIT ((float)FILM_MOST_CD_M2)
#define NO_SAMPLE 0xffffffffu
#define BLOCK_SAMPLES 16 /* consecutive samples that are well spread among themselves */
#define BLOCK_LEAST 8    /* that still are: the half of a block */

#define SUMS_ID(NAME, name, letters, users, member) SUMS_##NAME,
typedef enum LayerSums { FILM_SUMS(SUMS_ID) SUMS_COUNT } LayerSums;

#define SUMS_FIRST_DISPLAY SUMS_EMITTED
#define SUMS_END_DISPLAY SUMS_STOKES

typedef struct PixelSums {
    Fixed xyz[3];
    Fixed squares[3][2]; /* of linear Rec.709 R, G, B: [0] small, [1] large squares */
    Fixed odd_xyz[3];    /* of the samples in every second block of BLOCK_SAMPLES */
    uint32_t samples, hits, display_hits;
    /* unset in memory without such samples, else and in files NO_SAMPLE, -1 */
    uint32_t part_sample; /* lowest sample index that hit */
    int32_t part_id;
    uint32_t display_sample; /* lowest sample index that saw a display */
    int32_t display_id;
    uint32_t odd_samples; /* how many odd_xyz holds */
    Fixed layers[];
} PixelSums;

struct Film {
    int width, height;
    FilmRect crop;
    unsigned layers;
    bool has_blind;        /* pixels without samples are out of view */
    int first[SUMS_COUNT]; /* index into PixelSums.layers, -1: not kept */
    FilmLights lights;     /* none without LAYER_LIGHT */
    int first_light;       /* where those of the first group stand */
    int first_display;     /* of PixelSums.layers: where those begin that lie in `displays` */
    int display_numbers;   /* how many they are */
    size_t stride;         /* bytes a pixel */
    char *pixels;          /* without the displays' sums */
    Fixed *displays;       /* 0 where display_hits is 0 */
    pthread_mutex_t lock;  /* guards dropped: taken only when a sample is lost */
    FilmDropped dropped;
};

/* One of FILM_SUMS. */
typedef struct SumsRow {
    const char *name, *letters; /* one number a letter */
    int size;
    unsigned users;
    size_t member; /* offset in FilmSample; NO_MEMBER: film.c computes it */
} SumsRow;

#define NO_MEMBER ((size_t)-1)

extern const SumsRow sums_rows[SUMS_COUNT];

/* From the difference of two interleaved halves of the samples, each a mean of whole blocks
 * that are spread evenly: XYZ whose square has the expectation of the variance of the pixel's
 * mean, as if the halves were independent, but not the samples:
 * (a - b) sqrt(n_a n_b) / (n_a + n_b), half the difference for halves of one size. False when
 * one half has fewer than `least` samples. */
bool pixel_halves(const PixelSums *sums, int least, double xyz[3]);

/* The same of what a display reflects, over the samples that saw one: sums of all of them, and
 * of SUMS_ODD. */
bool pixel_display_halves(const PixelSums *sums, const Fixed reflected[3], const Fixed odd[4],
                          int least, double xyz[3]);

/* Unbiased variance of the mean of linear Rec.709 R, G, B, (cd m^-2)^2; NaN below 2 samples. */
void pixel_variance(const PixelSums *sums, double variance[3]);

/* Sums over the samples that saw a display. */
typedef struct DisplaySums {
    double hits;
    const Fixed *emitted, *reflected; /* XYZ */
    const Fixed *squares, *shared;    /* of SUMS_SQUARES, SUMS_SHARED */
} DisplaySums;

/* The same of the light of displays alone, over the samples that saw one. */
void pixel_display_variance(const DisplaySums *sums, double variance[3]);

/* A second display of a pixel. */
typedef struct SecondDisplay {
    int id;             /* NO_SECOND: there is none; SEVERAL: more, which are not told apart */
    double samples;     /* that saw it */
    double xyz[3];      /* mean over these, cd m^-2 */
    double variance[3]; /* of the mean's R, G, B; NaN below two samples */
} SecondDisplay;

#define NO_SECOND (-1)
#define SEVERAL (-2)

/* Besides the display `first`, one of those that the sums are of. With a sum P of (id - first)
 * over the samples, Q of its squares and T of its cubes, one other display has the id first +
 * Q / P and P^2 / Q samples, and P T = Q^2; of two others, of h and k samples at distances d
 * and e, P T - Q^2 = h k d e (d - e)^2 is not 0. */
SecondDisplay pixel_second_display(const DisplaySums *sums, int first);

/* FilmPixel.sigma_y, square_y, given its variance_rgb. */
void pixel_noise_y(const PixelSums *sums, const double variance_rgb[3], double *sigma,
                   double *square);

/* Row by row of the crop. */
static inline size_t film_index(const Film *film, int x, int y) {
    return (size_t)(y - film->crop.y0) * (size_t)(film->crop.x1 - film->crop.x0) +
           (size_t)(x - film->crop.x0);
}

/* Without the displays' sums. */
static inline PixelSums *film_sums_at(const Film *film, size_t index) {
    size_t apart = (size_t)film->display_numbers * sizeof(Fixed);
    return (PixelSums *)(void *)(film->pixels + index * (film->stride - apart));
}

static inline PixelSums *film_sums(const Film *film, int x, int y) {
    return film_sums_at(film, film_index(film, x, y));
}

static inline Fixed *film_displays_at(const Film *film, size_t index) {
    return film->displays + index * (size_t)film->display_numbers;
}

/* Numbers of PixelSums.layers. */
static inline size_t film_layer_numbers(const Film *film) {
    return (film->stride - sizeof(PixelSums)) / sizeof(Fixed);
}

/* Whole pixels, as files have them. out: `count` times `stride` bytes. */
void film_gather(const Film *film, size_t first, size_t count, void *out);

/* bits: a step is 2^-bits, of the size of a double's exponent. */
static inline double double_from_fixed(Fixed value, int bits) {
    union {
        uint64_t bits;
        double value;
    } step = {(uint64_t)(1023 - bits) << 52};
    return (double)value * step.value;
}
