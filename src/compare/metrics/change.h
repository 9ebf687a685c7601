/* SPDX-License-Identifier: Apache-2.0 */
/* change.h -- how the light of two pictures differs: by how much, in which colour, and where.
 *
 * Sums over square cells find it, so that a picture may come in bands of rows. In independent
 * noise a cell counts as changed when its differences add up as no fair signs do (the quotient
 * of statistic/sign_flip.h, of luminance and of the two colours beside it), or as the one box does
 * that explains the differences best; pictures that share their noise, or have none, have changed
 * wherever they differ.
 *
 * Units    linear Rec.709; chromaticity as CIE 1976 u', v'.
 * Memory   cells come from the arena. Threads: pure.
 */
#pragma once
#include "base/arena.h"
#include "compare/metrics/planes.h"

/* Sums over the pixels of an area that count. */
typedef struct ChangeSum {
    double pixels, differing; /* differing: by more than rounding */
    double light[2][3];       /* R, G, B: reference, test */
    double changed[2][3];     /* the same of those that differ */
    double squares;           /* of the differences of luminance */
    double colour[2];         /* R, B: of their differences' squares, */
    double cross[2];          /* and times those of luminance */
} ChangeSum;

typedef struct ChangedPixel {
    int x, y;
    double luminance[2]; /* reference, test */
} ChangedPixel;

typedef struct ChangeGrid {
    int width, height, side, columns, rows;
    ChangeSum *cells;
    ChangedPixel most; /* of the greatest difference of a channel */
    double most_difference;
} ChangeGrid;

typedef struct LightChange {
    bool is_noisy;      /* differences hold independent noise */
    bool is_everywhere; /* else in `cells`, if there are any, */
    bool is_box;        /* which in noise are one box, as far as it reaches */
    unsigned char *cells;
    ChangeSum all, area; /* area: what changed */
    double share;        /* of the pixels */
    const char *place;   /* "upper left"; "" all over */
    double luminance;    /* of the area, test / reference - 1; infinite for a black reference */
    double half_width;   /* of its 95 % interval; 0: no noise */
    bool is_both_ways;   /* some cells are brighter, others darker, and the mean hides it */
    double uv;           /* distance of the area's mean colours in u', v' */
    bool has_colour;     /* that is more than noise */
} LightChange;

static inline double rgb_luminance(const double rgb[3]) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* is_paired: as in change_find. */
ChangeGrid change_grid(int width, int height, bool is_paired, Arena *arena);

/* Rows [y0, y1) of pictures whose planes begin with row `top`, as mask does. */
void change_add_rows(ChangeGrid *grid, const Planes *const light[2], PixelMask mask, int top,
                     const int rows[2]);

/* is_paired: both share their noise, or have none. floor: light that is as good as none. */
LightChange change_find(const ChangeGrid *grid, bool is_paired, double floor, Arena *arena);

/* A pixel that stands out on one side: brighter than STANDOUT times what it is on the other, than
 * all around it there (3 x 3), than the median around it and than a hundredth of the mean. */
#define STANDOUT 10
#define STANDOUT_SIGMAS 4 /* of its own noise: what that does not explain */
#define STANDOUT_LIKE 4   /* times the greatest of the other side: else such is its noise */

typedef struct Standout {
    long count; /* 0: none; of the same kind as `most` */
    ChangedPixel most;
    double rest;       /* greatest difference of a pixel that does not stand out */
    bool is_explained; /* by its own noise */
} Standout;

/* sigma: standard error of each pixel's difference of luminance; NULL: there is no noise. NaN
 * explains everything. */
Standout change_standout(const Planes *const light[2], PixelMask mask, const float *sigma,
                         Arena scratch);
