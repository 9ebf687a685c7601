/* SPDX-License-Identifier: Apache-2.0 */
/* review_words.h -- a review in words that a meeting understands; private to the output.
 *
 * Memory   the arena's. Texts are UTF-8 and not escaped. Threads: pure. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "review/review_decide.h"

/* NULL is "". */
bool words_same(const char *a, const char *b);

/* Names, each once. */
typedef struct WordList {
    const char **list; /* room for all that are added */
    int count;
} WordList;

WordList words_list(int most, Arena *arena);
void words_list_add(WordList *names, const char *name);

/* Three significant digits; "–" for NaN, "∞". */
const char *words_figure(double value, Arena *arena);

/* The same with no more digits than its interval allows, where it has one. */
const char *words_within(double value, double low, double high, Arena *arena);

/* A case's: "1.64 : 1"; "–" where it is not visible. */
const char *words_contrast(const ReviewCase *c, Arena *arena);

/* What a limit found, with the name of its quantity where its unit does not say it. */
const char *words_quantity(const LimitVerdict *limit, Arena *arena);

/* A contrast ratio of the case in the kind of its limit of contrast, as words_judged. */
const char *words_ratio_as(const ReviewCase *c, double ratio, Arena *arena);

/* "1.58 to 1.70"; "exact" where both are the same, "–" for NaN. */
const char *words_interval(double low, double high, Arena *arena);

/* "62 %", "0.4 %", "99.6 %", "less than 0.1 %"; of a share 0..1. */
const char *words_share(double share, Arena *arena);

/* "+12 %", "−18 %"; "–" where there is no limit. */
const char *words_margin(double margin, Arena *arena);

/* "20 % below the minimum", of 1.6 where 2 is required, in the limit's own unit; "3.2 times the
 * maximum"; "–" where nothing was found. */
const char *words_from_limit(const LimitVerdict *limit, Arena *arena);

/* As somebody would write it who chose it: "2", "0.65". */
const char *words_number(double value, Arena *arena);

/* The figure found for a limit, in its unit: "1.64 : 1", "14 arc min", "320 cd/m²". */
const char *words_found(const LimitVerdict *limit, Arena *arena);

/* "contrast", "luminance contrast", "height", ... */
const char *words_kind(const LimitVerdict *limit);

/* The figure with its interval, in its unit: "1.64 +- 0.02 : 1". */
const char *words_measured(const LimitVerdict *limit, Arena *arena);

/* The figure that made a case's verdict, said with what it is: "1.64 : 1", "luminance contrast
 * 1.04", "14 arc min high"; of what cannot be judged one of unjudged_names. */
const char *words_judged(const ReviewCase *c, Arena *arena);

/* "3 min", "1 h 25 min"; "–" for NaN. */
const char *words_minutes(double minutes, Arena *arena);

/* ">= 2 : 1", "<= 2 : 1"; "(advice)" behind what is preferred and not required. */
const char *words_required(const LimitVerdict *limit, Arena *arena);

/* "minimum 2 : 1", "maximum 15 %"; ", advice" behind what is preferred and not required. */
const char *words_bound(const LimitVerdict *limit, Arena *arena);

/* "Passes", "Fails", "Too close to call", "Cannot be judged": begins a sentence. */
const char *words_verdict(Verdict verdict);

/* Has the sweep's eye a box or ellipse? The suns are then judged as its middle sees them, the
 * worst of those at every point. */
bool sweep_has_box(const ReviewSweep *sweep);

/* How often its steps fail: "340 minutes a year (heading 90°), 48 min at a stretch", "7 of 186
 * tested sun positions", "never"; of a review that says no more "0.5 % of the time". */
const char *words_failing(const ReviewSweep *sweep, Arena *arena);

/* How often a sweep fails, of a box "44 % of eyes at its worst; middle eye: ..."; where none of
 * its steps does "at its worst", and where its worst does not "never", "too close", "cannot be
 * judged". */
const char *words_how_often(const ReviewSweep *sweep, Arena *arena);

/* "; colour judged at their worst alone" of a symbol whose colour is limited; else "". */
const char *words_sweep_colour(const ReviewSweep *sweep);

/* Seen without colours too: "✓", "✗", "≈", "∅". */
const char *words_mark(Verdict verdict);

/* Its class in review.css: good, bad, close, hidden. */
const char *words_class(Verdict verdict);

/* "at night", "in direct sun", ... */
const char *words_ambient(Ambient ambient);

/* Eight: "in the north", "in the north-east", ...; of the vehicle "ahead", ... */
const char *const *words_directions(bool is_of_vehicle);

/* The one of them that an azimuth lies in. */
int words_eighth(double azimuth_deg);

/* "sun 32.0° high, in the south-east, azimuth 135.0°". directions: what azimuths count from;
 * NULL: nobody knows, and no direction is named. */
const char *words_sun(const ReviewCase *c, const char *const *directions, Arena *arena);

/* "wheel (leather) 62 %, rim (steel) 3.1 %, others 1.0 %"; "": nothing is hidden,
 * or that is not known. */
const char *words_hiders(const ReviewCase *c, Arena *arena);

/* Of a case that is too close: what calls it, or why no number of paths does; "": that is not
 * known. */
const char *words_decide(const ReviewCase *c, Arena *arena);

/* Why it cannot be judged: "nothing of it is seen: wheel (leather) hides 100 %". */
const char *words_unjudged(const ReviewCase *c, Arena *arena);

/* What a remedy makes of the limit that it is for, and of the case: "luminance contrast 2.1
 * (minimum 2)". */
const char *words_remedy(const CaseRemedy *remedy, Arena *arena);

/* What of it is worst, behind the words of the level that breaks it; "": nothing. */
const char *words_breaks(const RemedyBreak *breaks, int count, Arena *arena);

/* What the worst part does not say: "mean of the symbol 1.83 : 1; 80 % of it is in the sun".
 * The mean stands where it differs by more than both intervals, the share where an edge of the
 * sun lies on it; "" where neither does. */
const char *words_whole(const ReviewCase *c, Arena *arena);

/* Why the case has its verdict: "contrast 1.64 : 1 in direct sun (minimum 2 : 1)". */
const char *words_reason(const ReviewCase *c, Arena *arena);

/* The same without what a panel says of itself at length. */
const char *words_headline(const ReviewCase *c, Arena *arena);

/* "; known within 2.3 %, 1.0 % was required", behind the figures of a case; "" where that was
 * reached. */
const char *words_precision(const ReviewCase *c, Arena *arena);

/* "direct sunlight, 96 % · sky, 3 % · others, 1 %": in whole per cent that add up to 100, what is
 * beyond `most` together. */
const char *words_group(const CaseGroup *group, int most, Arena *arena);

/* " 62 % of it came via 9 materials without optical data ..."; "" where all have some. */
const char *words_without_data(const Review *review, const ReviewCase *c, Arena *arena);

/* Where nobody sits behind an eye: "its back, Seat_L (leather): 96 % of the reflected light; add
 * an occupant: `equip` ..."; "": somebody does, or it matters little. */
const char *words_empty_seat(const ReviewCase *c, Arena *arena);

/* "glass Window_FL: through → seat FrontSeat_L: scatters" */
const char *words_chain(const CaseCause *cause, Arena *arena);

/* Visibility levels.
 *
 * Memory   the arena's. Threads: pure. Fails: never. */

/* "visibility level 6.2 at 40 years, 2.9 at 70"; "": the case has none. */
const char *words_levels(const ReviewCase *c, Arena *arena);

/* One of them: "2.9, 95 % interval 2.8 to 3.0"; where the formula is doubtful also why. */
const char *words_level(const CaseVisibility *v, Arena *arena);

/* What it is of: "one of its strokes, 2.3 arc minutes wide, looked at in a glance of 0.2 s; the
 * eye adapted to 3.4 cd/m²: ...". */
const char *words_target(const CaseVisibility *v, Arena *arena);

/* Does any case have one? */
bool review_has_levels(const Review *review);
