/* polar_parts.h -- what the two files of the polar map share.
 *
 * Units    points of the page. Threads: one thread a disc.
 */
#pragma once
#include "plot/draw/polar.h"

#define POLAR_RING_PHI (-1.1780972450961724) /* the rings' degrees stand 67.5 below right */
#define POLAR_BOXES_MAX 64

typedef struct PolarDisc {
    Canvas         *canvas;
    const PolarMap *map;
    double          x, y, radius;
    int             box_count;
    Box             box[POLAR_BOXES_MAX]; /* taken by letters */
} PolarDisc;

/* Black or white, whichever reads on the colour of the value. */
Ink polar_line_ink(const PolarDisc *disc, double value);

/* Of the numbers inside the disc. */
double polar_letter_size(const PolarDisc *disc);

/* Marks a place as taken / asks whether it is free. */
void polar_reserve(PolarDisc *disc, Box box);
bool polar_is_free(const PolarDisc *disc, Box box);

/* Lines of equal value with their numbers on them. */
void polar_draw_lines(PolarDisc *disc);
