/* SPDX-License-Identifier: Apache-2.0 */
/* judge.h -- figures held against limits: margins and a verdict.
 *
 * A limit is kept when the whole 95 % interval of its figure keeps it, broken when the whole
 * interval breaks it, and too close to call when the limit lies within. A case is as bad as the
 * worst limit that counts: fail, then too close, then pass. Advice is listed and does not
 * count, nor does a limit of which the program measures no figure (`found` NaN); a figure that
 * it does measure and could not find out (NaN) is too close to call. A case of which nothing is
 * visible is neither good nor bad: not visible. One without limits passes, with limit_id -1.
 *
 * Memory   lists come from the arena.
 * Threads  pure functions but for the case that is passed in.
 * Fails    never.
 */
#pragma once
#include "review/profile.h"

/* Sets the case's ambient from its display_lux, where the condition itself names none. */
void judge_ambient(ReviewCase *review_case, const Profile *profile, bool sun_on_display);

/* The one place where contrasts are made: from the case's luminances and the interval of what
 * is reflected. Sets reflected_range, contrast_ratio, contrast_low, contrast_high and
 * contrast_with_veil (of no veil, NaN: contrast_ratio). */
void judge_contrasts(ReviewCase *review_case, MeanInterval reflected);

/* Sets paths_to_decide of a case that was judged, from its paths and intervals: errors fall as
 * the root of the paths, and a reading is as long as a pilot of its own length asks for, so
 * that twice the half interval is to fit between figure and limit. */
void judge_paths(ReviewCase *review_case);

/* From the case's ambient, contrasts and their interval, height and visible_share:
 * sets limits, limit_count, limit_id, margin and verdict. limit_id is, among the contrast
 * limits that count, the one that asks the greatest ratio; margin is its margin.
 *
 * A profile that uses the veil is asked of contrast_with_veil; its interval is that of
 * contrast_ratio seen through the veil, whose own doubt is not in it. */
void judge_case(ReviewCase *review_case, const Profile *profile, Arena *arena);
