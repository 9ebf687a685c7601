/* SPDX-License-Identifier: Apache-2.0 */
/* review_values.h -- what a page of a review is made of; and what its templates show: the
 * review's own record (the document of review.json), with words, classes, links and drawings
 * added where a template names them. Each part of the page adds its own (review_variants.h,
 * review_gaze.h).
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "image/picture.h"
#include "review/output/review_diff.h"
#include "review/output/review_facts.h"
#include "review/output/review_map.h"
#include "review/verdict.h"

/* Shown in the card of a case. Several of one case stand side by side. */
typedef struct ReviewPicture {
    const ReviewCase *of; /* one of the review's cases, or a sweep's worst: the pointer */
    const char *title, *caption;
    const char *label;    /* what it is not for, behind the caption; NULL: no picture of
                             filtered light */
    const CaseView *view; /* rays are drawn over it; NULL: none */
    const char *file;     /* PNG, which goes into the page as it stands */
    const char *beside;   /* its name from the page on goes there instead; or NULL */
    bool is_frame;        /* the frame itself */
    const char *id;       /* a file's that several cards show: it stands in the first */
    bool is_again;        /* of them, and this is another; NULL: one card shows it */
} ReviewPicture;

typedef struct ReviewPage {
    const Review *review;
    const ReviewPicture *pictures;
    int picture_count;
    const ReviewPicture *pairs; /* two a variant: without and with its change; no file:
                                   none */
    const ReviewMap *maps;
    int map_count;
    const ReviewCalendar *calendars;
    int calendar_count;
    const char *sources, *command; /* of the program, a hash; that makes this page again */
    const ReviewDiff *diff;        /* NULL: none */
} ReviewPage;

typedef struct PageValues {
    json_t *doc;
    const ReviewPage *page;
    const Review *review; /* the page's */
    Arena *arena;
} PageValues;

/* A case's object in the document, and a sweep's; borrowed. */
json_t *values_of_case(const PageValues *v, const ReviewCase *c);
json_t *values_of_sweep(const PageValues *v, const ReviewSweep *s);

/* Shows a finding in a list, of a case its own object once more; NULL: a cell without one. */
void values_add_finding(const PageValues *v, json_t *list, const Finding *f);

/* A new list or object of that name; borrowed. */
json_t *values_list(json_t *to, const char *name);
json_t *values_object(json_t *to, const char *name);

/* class, mark and outcome. */
void values_set_verdict(json_t *to, Verdict verdict);

/* A name that is missing is shown as one that nobody knows: "?". */
void values_set_names(json_t *to, const char *const *keys);

/* What is said of one case of a review, whoever shows it: its card, the grid,
 * a matrix, the list; and the pictures of a page.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time.
 * Fails    for a picture that cannot be read. */

/* Of every case and every sweep's worst. */
bool values_add_cases(const PageValues *v, Error *err);

/* What picture.html shows: bytes, or a file's name. */
bool values_add_picture(json_t *to, const ReviewPicture *p, Arena scratch, Error *err);

/* The page's first screen: pass or fail, every symbol as every eye sees it
 * at its worst, and the worst case of all: its picture, when, why and the remedy.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time.
 * Fails    for a picture that cannot be read. */

bool values_add_answer(const PageValues *v, Error *err);
