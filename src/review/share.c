/* SPDX-License-Identifier: Apache-2.0 */
#include "review/share.h"

#include <stdint.h>

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
