/* SPDX-License-Identifier: Apache-2.0 */
/* review_page.h -- a glare review as an HTML page, for a meeting.
 *
 * The first screen is the answer: pass or fail, every symbol and eye at its worst, and the
 * worst case of all with its picture, when, why and the remedy. Then maps and calendars of
 * the sweeps; folded, all verdicts, a card for every case, and where every limit comes from.
 * Where a review has many cases the page keeps the cards of the worst (Review.main_cards), and
 * another, written of the same with is_beside, the others.
 * Nothing is loaded but pictures, which stand beside it (ReviewPicture.beside); nothing needs
 * script.
 *
 * Units    angles in degrees, azimuths from ahead over right, or from north over east.
 * Memory   the caller's until the page is written; the page's own text is given back.
 * Threads  one page at a time per arena.
 * Fails    for a picture that cannot be read and a page that cannot be written.
 */
#pragma once
#include "page/template.h"
#include "review/output/review_values.h"

/* What the templates show: review.json's document with words and drawings added; the caller's.
 * most: of the verdicts that the list shows; 0: all. */
json_t *review_page_values(const ReviewPage *page, int most, Arena *arena, Error *err);

/* The formats of the templates. */
extern const PageFormat review_formats[];

bool review_page_write(const ReviewPage *page, const char *path, Error *err);

/* The review of one symbol on one page of paper: verdicts, its worst, why, a map. Its links go
 * to index.html, pictures stay where they are. */
bool review_page_write_summary(const ReviewPage *page, const char *symbol, const char *path,
                               Error *err);
