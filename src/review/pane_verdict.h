/* SPDX-License-Identifier: Apache-2.0 */
/* pane_verdict.h -- displays as glass shows them to an eye: where, how bright, against what;
 * and whether that is too much where the request says that the eye must see past them.
 *
 * Contrast   c = image / against: by how much the image brightens what is seen there, Weber's
 *            contrast of the image to its surroundings (CIE S 017, "luminance contrast"). Of
 *            the display's mean: a bright part of dark content has more.
 * Limit      an upper one of `contrast`, the request's own: no standard's.
 * Units      degrees from where the vehicle points, right and up; cd m^-2.
 * Memory     texts and lists live in the review's arena. Threads: plain data.
 */
#pragma once
#include "review/verdict.h"

typedef struct PaneFinding {
    const char *condition, *eye;
    const char *display, *pane;   /* node and material of each */
    double shown_share;           /* of the display's area; with the next three it makes 1 */
    double ends_share;            /* the pane ends before it */
    double away_share;            /* it turns its back to the pane */
    double covered_share;         /* something stands between; most of it */
    const char *covered_by;       /* is this; NULL: nothing does */
    const char *none;             /* why there is no image; NULL: there is, and of it */
    double right_deg, up_deg;     /* its middle */
    double width_deg, height_deg; /* of what is shown of it */
    const double *outline_deg;    /* right, up of the corners of its convex outline, in turn */
    int outline_count;            /* numbers: two a corner */
    const Vec3 *corners;          /* the same corners, unit, world: to draw over a frame; NULL:
                                     of a review that was read from review.json */
    int corner_count;
    double image;             /* the display's own light by the pane, its mean */
    MeanInterval image_range; /* 95 % */
    double behind;            /* what comes through the pane there */
    MeanInterval behind_range;
    double against; /* all but the image: that, and what panes mirror besides; at
                       least what the request says */
    MeanInterval against_range;
    double contrast;
    MeanInterval contrast_range;
    double ghost_share;  /* of the image's light: a ghost by the pane's far face */
    double ghost_arcmin; /* which stands so far beside; NaN: there is none */
    const char *area;    /* in the line of sight to it; NULL: to none that is named */
    double off_deg;      /* from the area's axis to the nearest of the image */
    bool has_limit;
    LimitVerdict limit; /* the least of the areas that it lies in */
    const char *shows;  /* the display as symbols name it; NULL: none is on it, or a file's */
    const RemedyBreak *breaks; /* at pane_level_share */
    int break_count;
} PaneFinding;

/* The share of the display's level, to three digits, at which its image keeps its limit; NaN: at
 * none anything of it would be seen. */
double pane_level_share(const PaneFinding *finding);

/* image over against, and its 95 % interval. */
void pane_set_contrast(PaneFinding *finding);
