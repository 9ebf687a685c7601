/* SPDX-License-Identifier: Apache-2.0 */
/* polar_disc.h -- the disc of a polar map: what is drawn, and where letters stand already.
 *
 * Units    points of the page. Threads: one thread a disc.
 */
#pragma once
#include "plot/draw/canvas.h"
#include "plot/draw/colour_map.h"
#include "plot/draw/field.h"

#define POLAR_LEVELS_MAX 24

typedef struct PolarMap {
    const Field *field;
    ColourMap    map;
    double       low, high; /* of the colours */
    bool         is_log;
    bool         is_cut;    /* values above `high` have its colour: the scale has an arrow */
    int          level_count;
    double       level[POLAR_LEVELS_MAX]; /* of the lines */
    const char  *level_text[POLAR_LEVELS_MAX]; /* NULL: the number itself */
    double       step;      /* between levels, for their labels; 0: figures as they are */
    double       strong;    /* a level drawn strongly, NaN: none */
    const char  *strong_text;
    double       theta_measured; /* beyond it: hatched */
    const char  *unit;      /* above the scale */
    bool         has_light; /* marks the light at theta_light, phi 180 */
    double       theta_light;
    bool         is_residual; /* no lines: values are scattered */
} PolarMap;

#define POLAR_RING_PHI (-1.1780972450961724) /* the rings' degrees stand 67.5 below right */
#define POLAR_BOXES_MAX 64

typedef struct PolarDisc {
    Canvas         *canvas;
    const PolarMap *map;
    double          x, y, radius;
    int             box_count;
    Box             box[POLAR_BOXES_MAX]; /* taken by letters */
} PolarDisc;

/* 0 .. 1 along the colours. */
double polar_disc_position(const PolarMap *map, double value);

/* Black or white, whichever reads on the colour of the value. */
Ink polar_disc_ink(const PolarDisc *disc, double value);

/* For the numbers inside the disc. */
double polar_disc_letter_size(const PolarDisc *disc);

/* Marks a place as taken / asks whether it is free. */
void polar_disc_reserve(PolarDisc *disc, Box box);
bool polar_disc_is_free(const PolarDisc *disc, Box box);
