/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/statistic/regions.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "measure/display_part.h"

#define REFLECTED " reflected"
#define DISPLAY_PREFIX "parhelion:display."
/* Pixels surer than this share of their light weigh no more for it: a region is more than its
 * least noisy corner. */
#define SUREST 0.02
/* Half a 95 % interval in standard errors, and what its two digits are rounded up by at most. */
#define EXCLUDES_NONE (1.96 * 1.06)

typedef struct Region {
    int display; /* id; -1: the frame */
    NoisyChannel channel;
    const unsigned char *member; /* of pixels; NULL: those that show the display */
    SignFlipSum plain, weighted;
    double light[2]; /* sums of luminance: reference, test */
    double area;     /* in pixels that these are of */
    double weight;   /* of c times the mean */
    double trial;    /* a change that the reference is given to see what it does ... */
    double tried;    /* ... to weighted.sum */
} Region;

/* ---- which there are --------------------------------------------------------------------- */

static int display_of(const ExrAttribute *a) {
    uint64_t id;
    bool is_display = a->kind == EXR_STRING &&
                      !strncmp(a->name, DISPLAY_PREFIX, sizeof DISPLAY_PREFIX - 1) &&
                      number_read_count(a->name + sizeof DISPLAY_PREFIX - 1, &id) && id <= INT_MAX;
    return is_display ? (int)id : -1;
}

static int list_regions(const NoisyPair *pair, const FrameImage *frame, Arena *arena,
                        Region **regions, const char ***names) {
    int room = 1 + 2 * frame->attribute_count, count = 0;
    *regions = ARENA_NEW(arena, Region, room);
    *names = ARENA_NEW(arena, const char *, room);
    (*names)[count] = "frame";
    (*regions)[count++] = (Region){.display = -1, .channel = NOISY_LUMINANCE};
    for (int i = 0; pair->display && i < frame->attribute_count; i++) {
        int id = display_of(&frame->attributes[i]);
        const char *name = frame->attributes[i].text;
        if (id < 0) continue;
        (*names)[count] = name;
        (*regions)[count++] = (Region){.display = id, .channel = NOISY_LUMINANCE};
        if (!pair->has_reflected) continue;
        (*names)[count] = arena_format(arena, "%s" REFLECTED, name);
        (*regions)[count++] = (Region){.display = id, .channel = NOISY_REFLECTED};
    }
    return count;
}

/* ---- a display by itself ----------------------------------------------------------------- */

/* Layers of both frames that show displays' parts. */
typedef struct BothParts {
    const FrameImage *const *frames;
    DisplayLayers layers[2];
    bool are_known;
} BothParts;

static BothParts find_parts(const FrameImage *const frames[2]) {
    BothParts parts = {.frames = frames};
    parts.are_known = display_layers_find(frames[0], &parts.layers[0]) &&
                      display_layers_find(frames[1], &parts.layers[1]);
    return parts;
}

/* A display's part of a pixel in both frames. */
typedef struct PartPair {
    DisplayPart side[2];
    double coverage; /* mean of both */
} PartPair;

static PartPair parts_at(const BothParts *parts, const int id[2], size_t i) {
    PartPair pair = {.side = {display_part(&parts->layers[0], i, id[0]),
                              display_part(&parts->layers[1], i, id[1])}};
    pair.coverage = 0.5 * (pair.side[0].coverage + pair.side[1].coverage);
    return pair;
}

/* Mean R, G, B of both frames together; returns the area that they have in the mean. */
static double common_mean(const BothParts *parts, const int id[2], double rgb[3]) {
    double area = 0, sums[3] = {0, 0, 0};
    for (size_t i = 0; i < frame_pixel_count(parts->frames[0]); i++) {
        PartPair at = parts_at(parts, id, i);
        area += at.coverage;
        for (int c = 0; c < 3; c++)
            sums[c] += 0.5 * (at.side[0].coverage * at.side[0].rgb[c] +
                              at.side[1].coverage * at.side[1].rgb[c]);
    }
    for (int c = 0; c < 3; c++) rgb[c] = area > 0 ? sums[c] / area : 0;
    return area;
}

/* Planes that replace a side's. */
typedef struct AlonePlanes {
    float *light, *variance, *halves; /* of a channel; NULL: the side has none */
} AlonePlanes;

static float *new_plane(const float **plane, size_t count, Arena *arena) {
    if (!*plane) return NULL;
    float *copy = ARENA_NEW(arena, float, count);
    memcpy(copy, *plane, count * sizeof *copy);
    *plane = copy;
    return copy;
}

/* What chance made of the display's area in a frame does not count: the light is that of both
 * frames' mean over the mean of both areas, and what differs from it over the frame's own
 * (display_part.h). Exchanging the frames exchanges the two, and nothing else. */
static void fill_alone(const DisplayPart *part, double coverage, double mean, int c, size_t i,
                       const AlonePlanes *to) {
    double off = part->coverage > 0 ? part->rgb[c] - mean : 0;
    double variance = part->scatter[c] + part->spread * off * off;
    bool is_whole = part->coverage == 1 && !part->is_shared;
    to->light[i] = (float)(part->coverage * off + coverage * mean);
    if (to->variance) to->variance[i] = (float)variance;
    if (to->halves && !is_whole) to->halves[i] = (float)sqrt(variance);
}

/* Its light instead of the pixels', for a region that has its members then. False: the test has
 * no display of that name. */
static bool take_alone(const BothParts *parts, const char *name, Arena *arena, NoisyPair *pair,
                       Region *region) {
    size_t count = frame_pixel_count(parts->frames[0]);
    unsigned char *member = ARENA_NEW(arena, unsigned char, count);
    const int id[2] = {frame_id_of(parts->frames[0], "display", name),
                       frame_id_of(parts->frames[1], "display", name)};
    double mean[3];
    if (id[0] < 0 || id[1] < 0) return false;
    region->area = common_mean(parts, id, mean);
    for (int k = 0; k < 6; k++) {
        NoisySide *side = &pair->side[k / 3];
        int c = k % 3;
        AlonePlanes to = {new_plane(&side->light[c], count, arena),
                          new_plane(&side->variance[c], count, arena),
                          new_plane(&side->halves[c], count, arena)};
        for (size_t i = 0; i < count; i++) {
            PartPair at = parts_at(parts, id, i);
            member[i] = at.coverage > 0;
            fill_alone(&at.side[k / 3], at.coverage, mean[c], c, i, &to);
        }
    }
    region->member = member;
    return true;
}

/* ---- sums -------------------------------------------------------------------------------- */

/* test = (1 + change) reference is estimated best with the factors mean / variance. The
 * variance is the frames' own where they state it, for that comes from all samples; but not
 * where the difference shows that it is much more (all samples of a pixel were alike by
 * chance): a factor that shrinks with every difference makes the change too small. What a
 * display reflects is the mean of fewer samples at its edges: there the difference counts. */
static double factor_of(const NoisyNumber *n, NoisyChannel channel) {
    double variance = n->variance, square = n->difference * n->difference;
    if (!(variance > 2 * n->stated)) variance = n->stated;
    if (isnan(variance)) variance = n->halves + square;
    if (channel == NOISY_REFLECTED) variance += square / 2;
    double least = SUREST * n->mean;
    variance += least * least;
    return variance > 0 ? n->mean / variance : 0;
}

static bool is_member(const NoisyPair *pair, size_t i, const Region *region) {
    if (region->member) return region->member[i];
    return region->display < 0 || pair->display[i] == (float)region->display;
}

/* The factor that the pixels around have in the mean. */
static double factor_around(const NoisyPair *pair, size_t i, const Region *region, double scale) {
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    int column = (int)(i % (size_t)width), row = (int)(i / (size_t)width);
    double mean = 0, variance = 0, count = 0;
    for (int y = row > 0 ? row - 1 : 0; y <= row + 1 && y < height; y++)
        for (int x = column > 0 ? column - 1 : 0; x <= column + 1 && x < width; x++) {
            NoisyNumber n;
            size_t k = noisy_pair_index(pair, x, y);
            if (k == i || !is_member(pair, k, region) || !noisy_pair_counts(pair, x, y) ||
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
                     const NoisyNumber *n) {
    return pair->law.is_same ? factor_of(n, region->channel)
                             : factor_around(pair, i, region, scale);
}

static void add_pixel(const NoisyPair *pair, size_t i, Region *region) {
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
static void try_pixel(const NoisyPair *pair, size_t i, Region *region) {
    NoisyNumber n;
    double scale = 1 + region->trial;
    if (!noisy_pair_number(pair, i, region->channel, scale, &n)) return;
    double c = factor(pair, i, region, scale, &n);
    if (isfinite(c)) region->tried += c * n.difference;
}

typedef void RegionPixel(const NoisyPair *pair, size_t i, Region *region);

static void for_pixels(const NoisyPair *pair, RegionPixel *work, Region *region) {
    int width = pair->data.x1 - pair->data.x0, height = pair->data.y1 - pair->data.y0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            size_t i = noisy_pair_index(pair, x, y);
            if (noisy_pair_counts(pair, x, y) && is_member(pair, i, region)) work(pair, i, region);
        }
}

/* ---- estimates --------------------------------------------------------------------------- */

/* A difference of d times the mean of both is a ratio of (1 + d / 2) / (1 - d / 2): a first
 * guess of the change, as factors that depend on the light give brighter frames less weight. */
#define LEAST_TRIAL 1e-3

static double first_guess(const Region *region) {
    double d = region->weighted.sum / region->weight;
    double guess = fabs(d) < 1 ? (1 + d / 2) / (1 - d / 2) - 1 : 0; /* false for NaN */
    return fabs(guess) > LEAST_TRIAL ? guess : LEAST_TRIAL;
}

/* The change that the reference must be given for the weighted sum to vanish: then both frames
 * are alike, and so are their weights. The sum is taken to be straight between none and the
 * trial. */
static void estimate_change(const Region *region, NoiseLaw law, StatisticRegion *out) {
    double slope = (region->weighted.sum - region->tried) / region->trial;
    bool is_steep = slope > 0.1 * region->weight; /* else: changes that are no proportion */
    out->change = is_steep ? region->weighted.sum / slope : (double)NAN;
    out->change_sigma = (double)NAN;
    if (is_steep) out->change_sigma = sign_flip_sigma(&region->weighted, law) / slope;
}

static const char *words_of(const Region *region, const char *name, Arena *arena) {
    bool is_reflected = region->channel == NOISY_REFLECTED;
    if (region->display < 0) return "the frame";
    return arena_format(arena, "display %.*s%s",
                        (int)(strlen(name) - (is_reflected ? strlen(REFLECTED) : 0)), name,
                        is_reflected ? ", reflected light" : "");
}

static StatisticRegion figures_of(const Region *region, const char *name, NoiseLaw law) {
    if (region->channel == NOISY_REFLECTED && law.is_same) law.has_variance = false;
    StatisticRegion out = {.name = name,
                           .pixels = region->plain.count,
                           .reference = region->light[0] / region->area,
                           .test = region->light[1] / region->area};
    bool is_lit = fabs(region->light[0]) > 0;
    out.shift = is_lit ? region->light[1] / region->light[0] - 1 : (double)NAN;
    out.shift_sigma = sign_flip_sigma(&region->plain, law) / fabs(region->light[0]);
    if (!is_lit) out.shift_sigma = (double)NAN;
    estimate_change(region, law, &out);
    out.p_value =
        sidak_p(fmin(sign_flip_p(&region->plain, law), sign_flip_p(&region->weighted, law)), 2);
    return out;
}

static void measure_region(const NoisyPair *pair, const BothParts *parts, const char *name,
                           Arena scratch, Region *region) {
    NoisyPair own = *pair;
    bool is_display = region->display >= 0 && region->channel == NOISY_LUMINANCE;
    bool is_alone =
        is_display && parts->are_known && take_alone(parts, name, &scratch, &own, region);
    if (!is_alone) own = *pair;
    for_pixels(&own, add_pixel, region);
    region->trial = first_guess(region);
    for_pixels(&own, try_pixel, region);
    if (!is_alone) region->area = (double)region->plain.count;
    region->member = NULL; /* it is gone */
}

bool regions_excludes_none(double change, double sigma) {
    return fabs(change) > EXCLUDES_NONE * sigma;
}

bool regions_shift_is_sure(const StatisticRegion *region) {
    return isnan(region->shift) || regions_excludes_none(region->shift, region->shift_sigma);
}

/* The second quotient sees differences in a few pixels from which no mean is known to move. */
static bool has_moved(const StatisticRegion *region, double level) {
    return region->p_value < level && (regions_shift_is_sure(region) ||
                                       regions_excludes_none(region->change, region->change_sigma));
}

RegionFindings regions_measure(const NoisyPair *pair, const FrameImage *const frames[2],
                               double level, Arena *arena) {
    Region *regions;
    const char **names;
    double least = 1;
    BothParts parts = find_parts(frames);
    RegionFindings out = {.p = 1, .mean_shift = NAN};
    int listed = list_regions(pair, frames[0], arena, &regions, &names);
    out.list = ARENA_NEW(arena, StatisticRegion, listed);
    for (int r = 0; r < listed; r++) {
        measure_region(pair, &parts, names[r], *arena, &regions[r]);
        if (regions[r].plain.count == 0) continue;
        out.list[out.count] = figures_of(&regions[r], names[r], pair->law);
        out.list[out.count].words = words_of(&regions[r], names[r], arena);
        least = fmin(least, out.list[out.count++].p_value);
    }
    if (out.count == 0) return out;
    out.p = sidak_p(least, out.count);
    out.mean_shift = out.list[0].shift;
    for (int r = 0; r < out.count; r++)
        out.list[r].moved = has_moved(&out.list[r], sidak_level(level, out.count));
    return out;
}
