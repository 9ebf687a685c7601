/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/statistic_reason.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *const CHANNELS[3] = {"red", "green", "blue"};

static void append(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void append(char *text, size_t size, const char *format, ...)
{
    size_t  length = strlen(text);
    va_list args;
    va_start(args, format);
    vsnprintf(text + length, size - length, format, args);
    va_end(args);
}

/* The surest region of displays that moved, since people look for them; else of all. */
static const StatisticRegion *surest_region(const StatisticResult *r)
{
    const StatisticRegion *best = &r->regions[0];
    for (int i = 1; i < r->region_count; i++) {
        bool is_first_display = r->regions[i].moved && best == &r->regions[0];
        if (is_first_display || r->regions[i].p_value < best->p_value) best = &r->regions[i];
    }
    return best;
}

/* Whether the change in proportion agrees with the plain mean's. */
static bool is_proportional(const StatisticRegion *region)
{
    double apart = fabs(region->change - region->shift);
    return apart < 3 * (region->shift_sigma + region->change_sigma); /* false for NaN */
}

static void append_shift(const StatisticRegion *region, char *text, size_t size)
{
    bool is_surer = fabs(region->change) / region->change_sigma >
                    fabs(region->shift) / region->shift_sigma;
    if (isnan(region->shift))
        append(text, size, "%.3g cd/m2 instead of 0", region->test);
    else if (is_surer && is_proportional(region))
        append(text, size, "%+.3g %% +- %.2g %%", 100 * region->change,
               100 * region->change_sigma);
    else
        append(text, size, "%+.3g %% +- %.2g %%", 100 * region->shift,
               100 * region->shift_sigma);
    if (is_surer && !is_proportional(region))
        append(text, size, ", where its pixels are known best %+.3g %% +- %.2g %%",
               100 * region->change, 100 * region->change_sigma);
}

/* "display 'cluster': reflected light +1.02 % +- 0.21 %" */
static void append_region(const StatisticRegion *region, bool is_frame, char *text, size_t size)
{
    static const char REFLECTED[] = " reflected";
    size_t length = strlen(region->name), tail = sizeof REFLECTED - 1;
    bool   is_reflected = !is_frame && length > tail &&
                        !strcmp(region->name + length - tail, REFLECTED);
    if (is_reflected) length -= tail;
    if (is_frame)
        append(text, size, "the frame");
    else
        append(text, size, "display '%.*s'", (int)(length < 60 ? length : 60), region->name);
    append(text, size, ": %s ", is_reflected ? "reflected light" : "mean luminance");
    append_shift(region, text, size);
}

/* "block at x 120..128, y 40..48: green -12.1 %" in pixels of the display window. */
static void append_block(const NoisyPair *pair, const BlockGrid *grid,
                         const BlockFinding *found, char *text, size_t size)
{
    const ExrWindow    d = pair->data, w = pair->display_window;
    const SignFlipSum *sum = &grid->sums[found->index][found->channel];
    int                x = d.x0 - w.x0 + found->index % grid->columns * grid->side;
    int                y = d.y0 - w.y0 + found->index / grid->columns * grid->side;
    int                right = d.x1 - w.x0, bottom = d.y1 - w.y0;
    double             change = sum->light > 0 ? sum->sum / (sum->light - 0.5 * sum->sum) : 0;
    append(text, size, "block at x %d..%d, y %d..%d: %s ", x,
           x + grid->side < right ? x + grid->side : right, y,
           y + grid->side < bottom ? y + grid->side : bottom, CHANNELS[found->channel]);
    if (fabs(change) < 10)
        append(text, size, "%+.3g %%", 100 * change);
    else
        append(text, size, "%+.3g cd/m2", sum->sum / (double)sum->count);
}

static void append_shared(const StatisticResult *r, char *text, size_t size)
{
    append(text, size, "one seed and the same samples: %ld of %ld pixels differ", r->differing,
           r->pixels);
    if (r->verdict != STATISTIC_DIFFERENT)
        append(text, size, r->differing ? ", the mean did not move (p = %.2g)"
                                        : " by more than rounding (p = %.2g)", r->p_value);
    else
        append(text, size, "; ");
}

void statistic_reason(const NoisyPair *pair, const BlockGrid grids[2],
                      const BlockFinding *found, double level, StatisticResult *out)
{
    char  *text = out->reason;
    size_t size = sizeof out->reason;
    text[0] = '\0';
    if (out->verdict == STATISTIC_EQUAL || out->region_count == 0) return;
    if (out->shares_noise) append_shared(out, text, size);
    if (out->verdict != STATISTIC_DIFFERENT) return;
    const StatisticRegion *region = surest_region(out);
    double family_level = sidak_level(level, 3);
    bool   has_region = out->p_regions < family_level;
    bool   has_block = out->p_blocks < family_level;
    if (has_region) append_region(region, region == &out->regions[0], text, size);
    if (has_region && has_block) append(text, size, "; ");
    if (has_block) append_block(pair, &grids[found->grid], found, text, size);
    if (!has_region && !has_block)
        append(text, size, "small changes all over the frame: the blocks' squared deviations "
               "are %.3g of what noise makes (p = %.2g)", out->mean_square, out->p_histogram);
}
