#include "base/alias.h"

/* Vose's two stacks: slots poorer than average are filled up from richer ones. Scratch is
 * taken from the arena's copy and given back. */
static void fill(AliasTable *table, double *scaled, Arena scratch)
{
    int  count = table->count, poor_count = 0, rich_count = 0;
    int *poor = ARENA_NEW(&scratch, int, count), *rich = ARENA_NEW(&scratch, int, count);
    for (int i = 0; i < count; i++) {
        table->keep[i] = 1;
        table->other[i] = (uint32_t)i;
        if (scaled[i] < 1) poor[poor_count++] = i;
        else rich[rich_count++] = i;
    }
    while (poor_count && rich_count) {
        int low = poor[--poor_count], high = rich[rich_count - 1];
        table->keep[low] = (float)scaled[low];
        table->other[low] = (uint32_t)high;
        scaled[high] -= 1 - scaled[low];
        if (scaled[high] < 1) {
            rich_count--;
            poor[poor_count++] = high;
        }
    }
}

AliasTable alias_build(const double *weights, int count, Arena *arena)
{
    AliasTable table = {.count = count,
                        .keep = ARENA_NEW(arena, float, count),
                        .other = ARENA_NEW(arena, uint32_t, count),
                        .prob = ARENA_NEW(arena, float, count)};
    Arena   scratch = *arena;
    double *scaled = ARENA_NEW(&scratch, double, count);
    double  sum = 0;
    for (int i = 0; i < count; i++) sum += weights[i];
    for (int i = 0; i < count; i++) {
        table.prob[i] = (float)(weights[i] / sum);
        scaled[i] = weights[i] / sum * count;
    }
    fill(&table, scaled, scratch);
    return table;
}
