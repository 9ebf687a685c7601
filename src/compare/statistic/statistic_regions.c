/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/statistic_regions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DISPLAY_PREFIX "parhelion:display."
/* Pixels surer than this share of their light weigh no more for it: a region is more than its
 * least noisy corner. */
#define SUREST 0.02

typedef struct Region {
    int          display; /* id; -1: the frame */
    NoisyChannel channel;
    SignFlipSum  plain, weighted;
    double       light[2]; /* sums of luminance: reference, test */
    double       weight;   /* of c times the mean */
    double       trial;    /* a change that the reference is given to see what it does ... */
    double       tried;    /* ... to weighted.sum */
} Region;

/* ---- which there are --------------------------------------------------------------------- */

static int display_of(const ExrAttribute *a)
{
    bool is_display = a->kind == EXR_STRING &&
                      !strncmp(a->name, DISPLAY_PREFIX, sizeof DISPLAY_PREFIX - 1);
    return is_display ? atoi(a->name + sizeof DISPLAY_PREFIX - 1) : -1;
}

static int list_regions(const NoisyPair *pair, const FrameImage *frame, Arena *arena,
                        Region **regions, const char ***names)
{
    int room = 1 + 2 * frame->attribute_count, count = 0;
    *regions = ARENA_NEW(arena, Region, room);
    *names = ARENA_NEW(arena, const char *, room);
    (*names)[count] = "frame";
    (*regions)[count++] = (Region){.display = -1, .channel = NOISY_LUMINANCE};
    for (int i = 0; pair->display && i < frame->attribute_count; i++) {
        int         id = display_of(&frame->attributes[i]);
        const char *name = frame->attributes[i].text;
        if (id < 0) continue;
        (*names)[count] = name;
        (*regions)[count++] = (Region){.display = id, .channel = NOISY_LUMINANCE};
        if (!pair->has_reflected) continue;
        (*names)[count] = arena_format(arena, "%s reflected", name);
        (*regions)[count++] = (Region){.display = id, .channel = NOISY_REFLECTED};
    }
    return count;
}

/* ---- sums -------------------------------------------------------------------------------- */

/* test = (1 + change) reference is estimated best with the factors mean / variance. The
 * variance is the frames' own where they state it, for that comes from all samples; but not
 * where the difference shows that it is much more (all samples of a pixel were alike by
 * chance): a factor that shrinks with every difference makes the change too small. What a
 * display reflects is the mean of fewer samples at its edges: there the difference counts. */
static double factor_of(const NoisyNumber *n, NoisyChannel channel)
{
    double variance = n->variance, square = n->difference * n->difference;
    if (!(variance > 2 * n->stated)) variance = n->stated;
    if (isnan(variance)) variance = n->halves + square;
    if (channel == NOISY_REFLECTED) variance += square / 2;
    double least = SUREST * n->mean;
    variance += least * least;
    return variance > 0 ? n->mean / variance : 0;
}

/* The factor that the pixels around have in the mean. */
static double factor_around(const NoisyPair *pair, size_t i, const Region *region, double scale)
{
    int    width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    int    column = (int)(i % (size_t)width), row = (int)(i / (size_t)width);
    double mean = 0, variance = 0, count = 0;
    for (int y = row > 0 ? row - 1 : 0; y <= row + 1 && y < height; y++)
        for (int x = column > 0 ? column - 1 : 0; x <= column + 1 && x < width; x++) {
            NoisyNumber n;
            size_t      k = noisy_pair_index(pair, x, y);
            bool is_inside = region->display < 0 || pair->display[k] == (float)region->display;
            if (k == i || !is_inside || !noisy_pair_counts(pair, x, y) ||
                !noisy_pair_number(pair, k, region->channel, scale, &n))
                continue;
            double c = factor_of(&n, region->channel);
            if (!(c > 0)) continue;
            mean += n.mean;
            variance += n.mean / c;
            count++;
        }
    return count > 0 ? mean / variance : 0;
}

/* Factors must not change when the frames are exchanged, and in noise of two laws they must
 * not know the pixel itself: a bright sample makes a pixel's own variance large, so that
 * weighing by it makes noisy frames darker. */
static double factor(const NoisyPair *pair, size_t i, const Region *region, double scale,
                     const NoisyNumber *n)
{
    return pair->law.is_same ? factor_of(n, region->channel)
                             : factor_around(pair, i, region, scale);
}

static void add_pixel(const NoisyPair *pair, size_t i, Region *region)
{
    NoisyNumber n;
    if (!noisy_pair_number(pair, i, region->channel, 1, &n)) return;
    double c = factor(pair, i, region, 1, &n);
    sign_flip_add(&region->plain, &n, 1);
    if (isfinite(c)) {
        sign_flip_add(&region->weighted, &n, c);
        region->weight += c * n.mean;
    }
    for (int s = 0; s < 2; s++)
        region->light[s] += noisy_pair_luminance(pair, s, i, region->channel);
}

/* The weighted sum when the reference's light has changed already by the trial. */
static void try_pixel(const NoisyPair *pair, size_t i, Region *region)
{
    NoisyNumber n;
    double      scale = 1 + region->trial;
    if (!noisy_pair_number(pair, i, region->channel, scale, &n)) return;
    double c = factor(pair, i, region, scale, &n);
    if (isfinite(c)) region->tried += c * n.difference;
}

typedef void RegionPixel(const NoisyPair *pair, size_t i, Region *region);

static void for_pixels(const NoisyPair *pair, RegionPixel *work, Region *regions, int count)
{
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (!noisy_pair_counts(pair, x, y)) continue;
            size_t i = noisy_pair_index(pair, x, y);
            float  display = pair->display ? pair->display[i] : -1;
            work(pair, i, &regions[0]);
            for (int r = 1; display >= 0 && r < count; r++)
                if ((float)regions[r].display == display) work(pair, i, &regions[r]);
        }
}

/* ---- estimates --------------------------------------------------------------------------- */

/* A difference of d times the mean of both is a ratio of (1 + d / 2) / (1 - d / 2): a first
 * guess of the change, as factors that depend on the light give brighter frames less weight. */
#define LEAST_TRIAL 1e-3

static double first_guess(const Region *region)
{
    double d = region->weighted.sum / region->weight;
    double guess = fabs(d) < 1 ? (1 + d / 2) / (1 - d / 2) - 1 : 0; /* false for NaN */
    return fabs(guess) > LEAST_TRIAL ? guess : LEAST_TRIAL;
}

/* The change that the reference must be given for the weighted sum to vanish: then both frames
 * are alike, and so are their weights. The sum is taken to be straight between none and the
 * trial. */
static void estimate_change(const Region *region, NoiseLaw law, StatisticRegion *out)
{
    double slope = (region->weighted.sum - region->tried) / region->trial;
    bool   is_steep = slope > 0.1 * region->weight; /* else: changes that are no proportion */
    out->change = is_steep ? region->weighted.sum / slope : (double)NAN;
    out->change_sigma = (double)NAN;
    if (is_steep) out->change_sigma = sign_flip_sigma(&region->weighted, law) / slope;
}

static StatisticRegion figures_of(const Region *region, const char *name, NoiseLaw law)
{
    if (region->channel == NOISY_REFLECTED && law.is_same) law.has_variance = false;
    double          n = (double)region->plain.count;
    StatisticRegion out = {.name = name, .pixels = region->plain.count,
                           .reference = region->light[0] / n, .test = region->light[1] / n};
    bool            is_lit = fabs(region->light[0]) > 0;
    out.shift = is_lit ? region->light[1] / region->light[0] - 1 : (double)NAN;
    out.shift_sigma = sign_flip_sigma(&region->plain, law) / fabs(region->light[0]);
    if (!is_lit) out.shift_sigma = (double)NAN;
    estimate_change(region, law, &out);
    out.p_value = sidak_p(fmin(sign_flip_p(&region->plain, law),
                               sign_flip_p(&region->weighted, law)), 2);
    return out;
}

void statistic_regions(const NoisyPair *pair, const FrameImage *reference, double level,
                       Arena *arena, StatisticResult *out)
{
    Region      *regions;
    const char **names;
    double       least = 1;
    int          listed = list_regions(pair, reference, arena, &regions, &names), count = 0;
    for_pixels(pair, add_pixel, regions, listed);
    for (int r = 0; r < listed; r++) regions[r].trial = first_guess(&regions[r]);
    for_pixels(pair, try_pixel, regions, listed);
    out->regions = ARENA_NEW(arena, StatisticRegion, listed);
    for (int r = 0; r < listed; r++) {
        if (regions[r].plain.count == 0) continue;
        out->regions[count] = figures_of(&regions[r], names[r], pair->law);
        least = fmin(least, out->regions[count++].p_value);
    }
    out->region_count = count;
    if (count == 0) {
        out->p_regions = 1;
        out->mean_shift = NAN;
        return;
    }
    out->p_regions = sidak_p(least, count);
    out->mean_shift = out->regions[0].shift;
    for (int r = 0; r < count; r++)
        out->regions[r].moved = out->regions[r].p_value < sidak_level(level, count);
}
