/* SPDX-License-Identifier: Apache-2.0 */
/* review_card.h -- one case of a review as a part of the page that opens: its figures, what
 * washes it out, what would mend it, its pictures.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    for a picture that cannot be read.
 */
#pragma once
#include "image/picture.h"
#include "review/verdict.h"
#include "text/text.h"

/* Shown in the card of a case. Several of one case stand side by side. */
typedef struct ReviewPicture {
    const ReviewCase *of;      /* one of the review's cases, or a sweep's worst: the pointer */
    const char       *title, *caption;
    const CaseView   *view;    /* rays are drawn over it; NULL: none */
    const Picture    *picture; /* NULL: the file */
    const char       *file;    /* PNG or JPEG by its ending; goes into the page as it stands */
    const char       *beside;  /* its name from the page on goes there instead; or NULL */
    bool              is_frame; /* the frame itself: review_look.js shows it in its stead */
    const char       *id;      /* a file's that several cards show: it stands in the first */
    bool              is_again; /* of them, and this is another; NULL: one card shows it */
} ReviewPicture;

typedef struct ReviewCard {
    const ReviewCase    *of;
    const char          *id;      /* review_card_id */
    bool                 is_open;
    const char *const   *directions; /* for its sun: words_directions, or NULL */
    const ReviewPicture *pictures;   /* the page's; those of other cases are passed over */
    int                  picture_count;
} ReviewCard;

/* "c3" of the fourth case, "s0" of the first sweep's worst. */
const char *review_card_id(const Review *review, const ReviewCase *c, Arena *arena);

/* The page that has the cards which the review's own leaves out (Review.main_cards). */
#define REVIEW_PAGE_BESIDE "cases.html"

/* Whether its card is on the page that the review is about. */
bool review_card_is_here(const Review *review, const ReviewCase *c, Arena scratch);

/* Where its card is: "#c3", or on the other page. */
const char *review_card_link(const Review *review, const ReviewCase *c, Arena *arena);

/* Opens a cell of a table that links to a case's card, and tells its verdict when pointed at:
 * <td><a ...>. */
void review_card_begin_cell(Text *html, const Review *review, const ReviewCase *c,
                            Arena *arena);

/* <span class="chip ...">Fails</span> */
void review_card_add_chip(Text *html, Verdict verdict);

/* The picture alone: <img ...>. */
bool review_card_add_picture(Text *html, const ReviewPicture *picture, Arena scratch,
                             Error *err);

bool review_card_add(Text *html, const ReviewCard *card, Arena *arena, Error *err);
