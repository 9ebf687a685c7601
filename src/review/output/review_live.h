/* SPDX-License-Identifier: Apache-2.0 */
/* review_live.h -- what the page's reader may move: the sun over a sweep. The sweep's tables
 * stand in the page, packed, and review_live.js shows the row of the sun that is pointed at, as
 * it was judged; without script the page is as it is without them.
 *
 * Figures are 16 bits of a logarithm, within 0.03 %; margins are within 0.0005.
 *
 * Units    cd m^-2, lx; degrees, azimuths of the vehicle.
 * Memory   what is packed grows in the arena; scratch by value.
 * Threads  pure.
 * Fails    when memory is out.
 */
#pragma once
#include "base/error.h"
#include "review/verdict.h"
#include "text/text.h"

typedef struct LiveSun {
    double azimuth_deg, elevation_deg;
    int step, heading_id; /* step in time; into headings_deg */
} LiveSun;

/* Shared by the sweeps of a condition. */
typedef struct LiveSky {
    const LiveSun *suns;
    int count;
    int year;            /* 0: its suns have no date */
    double step_minutes; /* a year's, from 1 January 0:00 UTC on */
    const double *headings_deg;
    int heading_count;
} LiveSky;

/* Arrays of sky->count. */
typedef struct LiveSweep {
    int sweep_id; /* into the review's */
    const LiveSky *sky;
    int worst; /* sun */
    const float *contrast, *low, *high, *margin, *reflected, *mirror, *level, *lux;
    const unsigned char *verdict;
} LiveSweep;

typedef struct ReviewLive {
    const LiveSweep *sweeps;
    int sweep_count;
    const char *beside; /* a script's name from the page on, which has all of it
                           (review_live_write); NULL: it stands in the page */
} ReviewLive;

/* The script that live->beside names. */
bool review_live_write(const Review *review, const ReviewLive *live, const char *path, Error *err);

/* A block of JSON that is not shown, or what loads it: before the page ends. */
bool review_live_add(Text *html, const Review *review, const ReviewLive *live, Error *err);
