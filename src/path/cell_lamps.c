/* SPDX-License-Identifier: Apache-2.0 */
#include "path/cell_lamps.h"

#include <math.h>

/* Bounds on a lamp's share of light that arrives and on the share of samples for lamps that
 * are not kept: a few samples may miss light that is there. */
#define LEAST_ARRIVES 0.1
#define LEAST_OTHERS 0.1
#define MOST_OTHERS 0.9

static LampFind *place_of(LampFinds *finds, const LampFind *find)
{
    LampFind *least = &finds->lamp[0];
    for (int i = 0; i < finds->count; i++) {
        if (finds->lamp[i].id == find->id) return &finds->lamp[i];
        if (finds->lamp[i].arrived < least->arrived) least = &finds->lamp[i];
    }
    if (finds->count < LAMP_FINDS) least = &finds->lamp[finds->count++];
    else if (find->arrived <= least->arrived) return NULL;
    *least = (LampFind){.id = find->id};
    return least;
}

void lamp_finds_add(LampFinds *finds, LampFind find)
{
    LampFind *place = place_of(finds, &find);
    if (!place) return;
    place->sent += find.sent;
    place->arrived += find.arrived;
}

void lamp_finds_join(LampFinds *finds, const LampFinds *neighbour, double weight)
{
    for (int i = 0; i < neighbour->count; i++) {
        const LampFind *find = &neighbour->lamp[i];
        lamp_finds_add(finds,
                       (LampFind){find->id, find->sent * weight, find->arrived * weight});
    }
}

/* Takes the lamp of which most arrived out of the finds. */
static LampFind take_best(LampFinds *finds)
{
    int best = 0;
    for (int i = 1; i < finds->count; i++)
        if (finds->lamp[i].arrived > finds->lamp[best].arrived) best = i;
    LampFind find = finds->lamp[best];
    finds->lamp[best] = finds->lamp[--finds->count];
    return find;
}

static void keep(GuideLamps *lamps, const LampFind *find)
{
    double arrives = find->sent > 0 ? find->arrived / find->sent : 0;
    lamps->id[lamps->count] = find->id;
    lamps->arrives[lamps->count++] = (float)fmin(fmax(arrives, LEAST_ARRIVES), 1);
}

GuideLamps cell_lamps_keep(const LampFinds *finds, int lamp_count)
{
    LampFinds  left = *finds;
    GuideLamps lamps = {0};
    double     all = 0, kept = 0;
    for (int i = 0; i < left.count; i++) all += left.lamp[i].arrived;
    if (!(all > 0)) return lamps;
    while (left.count && lamps.count < GUIDE_LAMPS) {
        LampFind find = take_best(&left);
        if (!(find.arrived > 0) && lamp_count > GUIDE_LAMPS) break;
        kept += find.arrived;
        keep(&lamps, &find);
    }
    bool is_all = lamps.count == lamp_count;
    lamps.others = is_all ? 0 : (float)fmin(fmax(1 - kept / all, LEAST_OTHERS), MOST_OTHERS);
    return lamps;
}
