/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/job.h"

#include <stdint.h>

ReviewRun review_run_of(const ReviewRun *run, const ReviewRequest *request, const Review *base)
{
    ReviewRun own = *run;
    own.request = request;
    own.base = base;
    own.identity = NULL;
    own.share = (ReviewShare){0};
    return own;
}

/* ---- x ----------------------------------------------------------------------------------- */

bool moment_share_has(const MomentShare *share, int at, int count)
{
    int64_t parts = share->of.count, place = (int64_t)share->place * count + at;
    return !parts || place * parts / ((int64_t)share->moments * count) == share->of.index;
}

bool moment_share_has_any(const MomentShare *share)
{
    int64_t parts = share->of.count, first = (int64_t)share->place * parts;
    if (!parts) return true;
    return share->of.index >= first / share->moments &&
           share->of.index <= (first + parts - 1) / share->moments;
}

bool review_share_has(const ReviewShare *share, int at)
{
    return !share->count || at % share->count == share->index;
}
