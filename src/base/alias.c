/* SPDX-License-Identifier: Apache-2.0 */
#include "base/alias.h"

/* Vose's two stacks: slots poorer than average are filled up from richer ones. Scratch is
 * taken from the arena's copy and given back. */
static void fill(AliasTable *table, double *scaled, Arena scratch)
{
    int  count = table->count, poor_count = 0, rich_count = 0;
    int *poor = ARENA_NEW(&scratch, int, count), *rich = ARENA_NEW(&scratch, int, count);
    for (int i = 0; i < count; i++) {
        table->slots[i].keep = 1u << 24;
        table->slots[i].other = (uint32_t)i;
        if (scaled[i] < 1) poor[poor_count++] = i;
        else rich[rich_count++] = i;
    }
    while (poor_count && rich_count) {
        int low = poor[--poor_count], high = rich[rich_count - 1];
        table->slots[low].keep = (uint32_t)(scaled[low] * 0x1p24 + 0.5);
        table->slots[low].other = (uint32_t)high;
        scaled[high] -= 1 - scaled[low];
        if (scaled[high] < 1) {
            rich_count--;
            poor[poor_count++] = high;
        }
    }
}

/* Counts, over all 2^24 numbers u, how often each slot is chosen. Number k falls into slot
 * k * count >> 24, and from one number to the next the rest grows by count. */
static void count_choices(AliasTable *table, Arena scratch)
{
    int64_t   count = table->count, numbers = 1 << 24;
    uint32_t *chosen = ARENA_NEW(&scratch, uint32_t, count);
    for (int64_t slot = 0; slot < count; slot++) {
        int64_t first = (slot * numbers + count - 1) / count;
        int64_t end = ((slot + 1) * numbers + count - 1) / count;
        int64_t rest = first * count - slot * numbers;
        int64_t kept = ((int64_t)table->slots[slot].keep - rest + count - 1) / count;
        kept = kept < 0 ? 0 : kept > end - first ? end - first : kept;
        chosen[slot] += (uint32_t)kept;
        chosen[table->slots[slot].other] += (uint32_t)(end - first - kept);
    }
    for (int i = 0; i < table->count; i++)
        table->slots[i].prob = (float)chosen[i] * 0x1p-24f;
    for (int i = 0; i < table->count; i++)
        table->slots[i].other_prob = table->slots[table->slots[i].other].prob;
}

AliasTable alias_build(const double *weights, int count, Arena *arena)
{
    AliasTable table = {.count = count, .slots = ARENA_NEW(arena, AliasSlot, count)};
    Arena   scratch = *arena;
    double *scaled = ARENA_NEW(&scratch, double, count);
    double  sum = 0;
    for (int i = 0; i < count; i++) sum += weights[i];
    for (int i = 0; i < count; i++) scaled[i] = weights[i] / sum * count;
    fill(&table, scaled, scratch);
    count_choices(&table, scratch);
    return table;
}
