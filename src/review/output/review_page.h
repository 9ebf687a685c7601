/* review_page.h -- a glare review as one self-contained HTML page, for a meeting.
 *
 * One line on top says pass or fail, the worst symbol, when and why; then the table of all
 * verdicts, a card for every case that needs a look, maps and calendars of the sweeps, and
 * where every limit comes from. Nothing is loaded from anywhere, nothing needs script.
 *
 * Units    angles in degrees, azimuths from ahead over right, or from north over east.
 * Memory   the caller's until the page is written; the page's own text is given back.
 * Threads  one page at a time per arena.
 * Fails    for a picture that cannot be read and a page that cannot be written.
 */
#pragma once
#include "image/picture.h"
#include "review/output/review_diff.h"
#include "review/verdict.h"

/* Shown in the card of a case. Several of one case stand side by side. */
typedef struct ReviewPicture {
    const ReviewCase *of;      /* one of the review's cases, or a sweep's worst: the pointer */
    const char       *title, *caption;
    const Picture    *picture; /* NULL: the file */
    const char       *file;    /* PNG or JPEG by its ending; goes into the page as it stands */
} ReviewPicture;

/* Places along an axis: first, first + step, ... */
typedef struct ReviewAxis {
    double first, step;
    int    count;
} ReviewAxis;

/* A line over a map: where the sun goes on one day. */
typedef struct SunPath {
    const char   *name; /* "21 June" */
    const double *azimuth_deg, *elevation_deg;
    int           count;
} SunPath;

/* The verdict for every place of the sun. Arrays hold the azimuths of the first elevation, then
 * those of the second, ... */
typedef struct ReviewMap {
    const ReviewSweep   *of;       /* one of the review's sweeps: the pointer */
    bool                 is_of_vehicle; /* azimuth 0 is ahead, 90 right; else north and east */
    ReviewAxis           azimuth_deg, elevation_deg;
    const float         *contrast; /* NaN: not asked there */
    const float         *margin;   /* contrast over its limit less one; NaN: no limit */
    const unsigned char *verdict;  /* a Verdict each */
    const SunPath       *paths;
    int                  path_count;
} ReviewMap;

/* The share of headings that failed, over the hours of every day. The array holds the steps of
 * the first day from midnight on, then those of the second, ... */
typedef struct ReviewCalendar {
    const ReviewSweep *of;
    int                year, days, steps_a_day; /* days from 1 January on */
    const char        *clock;        /* what the hours are of: "UTC+02:00" */
    int                headings;
    const float       *failed_share; /* 0..1; NaN: the sun is down, or no answer */
} ReviewCalendar;

/* A line of the provenance: "panel lab_lcd_a" "sha256 ..., stated error 1.9 %". */
typedef struct ReviewFact {
    const char *name, *value;
} ReviewFact;

typedef struct ReviewPage {
    const Review         *review;
    const ReviewPicture  *pictures;
    int                   picture_count;
    const ReviewMap      *maps;
    int                   map_count;
    const ReviewCalendar *calendars;
    int                   calendar_count;
    const ReviewFact     *facts;    /* scene, panels, sky, program: with versions and hashes */
    int                   fact_count;
    const char *const    *commands; /* that make this page again, and look further */
    int                   command_count;
    const ReviewDiff     *diff;     /* NULL: none */
    bool                  is_dark;  /* whatever the reader has */
} ReviewPage;

bool review_page_write(const ReviewPage *page, const char *path, Error *err);
