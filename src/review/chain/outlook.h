/* SPDX-License-Identifier: Apache-2.0 */
/* outlook.h -- what a surface sees from one of its points: the half space before it as a
 * picture, and which things light it.
 *
 * The picture is that of a fisheye that looks out along the normal: equidistant, the normal in
 * the middle, the surface's own plane along the rim, `up` upwards. The sun's disc is not in it,
 * nor are lamps without a body: the shares have those.
 *
 * Units    cd m^-2, lx; pixels of the picture, row 0 at the top; unit vectors, world.
 * Memory   what is kept lives in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "image/picture.h"
#include "review/light/reading.h"

typedef struct OutlookArgs {
    const PathContext  *context;
    const ReadingTools *tools;
    Vec3 point, ng; /* where rays start off the surface; ng on the side that looks */
    Vec3 up;        /* not along ng */
    Vec3 eye;       /* sees the surface from its front: its mirror image is marked */
} OutlookArgs;

/* One thing that is seen first, by node and material, or a source, via a pane. */
typedef struct OutlookShare {
    const char *what;  /* "sky through Window_FL (glass)" */
    double      share; /* of the surface's illuminance */
    double      lux;
} OutlookShare;

#define OUTLOOK_SIZE 128
#define OUTLOOK_SHARES 8

typedef struct Outlook {
    float       *cd_m2;        /* [OUTLOOK_SIZE][OUTLOOK_SIZE]; NaN outside the circle */
    double       lux;          /* illuminance of the surface */
    OutlookShare shares[OUTLOOK_SHARES]; /* the greatest, greatest first */
    int          share_count;
    double       rest;         /* share of all others */
    double       mirror_x, mirror_y; /* where the eye's mirror direction is */
    const char  *mirror_what;  /* most of what is seen there, MIRROR_DEG about it */
    double       mirror_cd_m2; /* and its mean luminance */
    bool         has_sun;      /* the sun lights the point: */
    double       sun_x, sun_y;
} Outlook;

#define OUTLOOK_MIRROR_DEG 5

/* The world's up, or ahead where the surface lies flat. */
Vec3 outlook_up(Vec3 ng);

Outlook outlook_take(const OutlookArgs *args, Arena *arena);

/* In false colour with its scale; the mirror direction is ringed, the sun a disc with rays. */
Picture outlook_picture(const Outlook *outlook, Arena *arena);

/* "41 % sky through Windscreen (glass), 22 % sun ...; the mirror image is FrontSeat_L ..." */
const char *outlook_words(const Outlook *outlook, Arena *arena);
