/* SPDX-License-Identifier: Apache-2.0 */
#include "light/alias.h"

/* Vose's two stacks: slots poorer than average are filled up from richer ones. Scratch is
 * taken from the arena's copy and given back. */
static void fill(AliasTable *table, double *scaled, Arena scratch) {
    int count = table->count, poor_count = 0, rich_count = 0;
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
 * k * count >> 24, and from one number to the next the rest grows by count: a slot has
 * 2^24 / count numbers, or one more where its first rest is below the division's. */
static void count_choices(AliasTable *table, Arena scratch) {
    uint32_t count = (uint32_t)table->count, numbers = 1u << 24, rest = 0;
    uint32_t least = numbers / count, over = numbers % count;
    uint32_t *chosen = ARENA_NEW(&scratch, uint32_t, count);
    for (uint32_t slot = 0; slot < count; slot++) {
        uint32_t keep = table->slots[slot].keep, own = least + (rest < over);
        uint32_t kept = keep > rest ? (keep - rest - 1) / count + 1 : 0;
        kept = kept > own ? own : kept;
        chosen[slot] += kept;
        chosen[table->slots[slot].other] += own - kept;
        rest = rest < over ? rest + count - over : rest - over;
    }
    for (int i = 0; i < table->count; i++) table->slots[i].prob = (float)chosen[i] * 0x1p-24f;
    for (int i = 0; i < table->count; i++)
        table->slots[i].other_prob = table->slots[table->slots[i].other].prob;
}

AliasTable alias_build(const double *weights, int count, Arena *arena) {
    AliasTable table = {.count = count, .slots = ARENA_NEW(arena, AliasSlot, count)};
    Arena scratch = *arena;
    double *scaled = ARENA_NEW(&scratch, double, count);
    double sum = 0;
    for (int i = 0; i < count; i++) sum += weights[i];
    for (int i = 0; i < count; i++) scaled[i] = weights[i] / sum * count;
    fill(&table, scaled, scratch);
    count_choices(&table, scratch);
    return table;
}
