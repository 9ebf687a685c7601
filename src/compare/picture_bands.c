/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/picture_bands.h"

#include <math.h>
#include <string.h>

#include "compare/metrics.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/ssim.h"

#define BAND_ROWS 128

/* Rows [y0, y1) count; the planes begin with row `top` and hold what filters reach besides. */
typedef struct RowBand {
    int       y0, y1, top;
    CodeRows  side[2];
    PixelMask mask; /* of the planes' pixels */
    size_t    first, end; /* those that count, among the planes' */
} RowBand;

/* The band that begins with row y0; false below the picture. */
static bool next_band(const CompareOptions *options, const Comparison *c, int y0, int halo,
                      Arena *arena, RowBand *out)
{
    const Planes *size = &c->reference.codes;
    int           rows = options->band_rows > 0 ? options->band_rows : BAND_ROWS;
    if (y0 >= size->height) return false;
    int  y1 = size->height - y0 < rows ? size->height : y0 + rows;
    int  top = y0 > halo ? y0 - halo : 0;
    int  bottom = size->height - y1 < halo ? size->height : y1 + halo;
    RowBand band = {.y0 = y0, .y1 = y1, .top = top,
                 .mask = c->selection.counts + (size_t)top * (size_t)size->width,
                 .first = (size_t)(y0 - top) * (size_t)size->width,
                 .end = (size_t)(y1 - top) * (size_t)size->width};
    band.side[0] = input_unpack(&c->reference, top, bottom, arena);
    band.side[1] = input_unpack(&c->test, top, bottom, arena);
    *out = band;
    return true;
}

/* ---- channels ---------------------------------------------------------------------------- */

static const float *plane_of(const CodeRows *rows, int channel)
{
    return channel < 3 ? rows->codes.rgb[channel] : rows->alpha;
}

/* differs: one byte a pixel of the band. */
static void add_channel(const RowBand *band, int channel, unsigned char *differs,
                        ChannelDifference *out)
{
    const float *a = plane_of(&band->side[0], channel), *b = plane_of(&band->side[1], channel);
    for (size_t i = band->first; i < band->end; i++) {
        if (!band->mask[i]) continue;
        double distance = fabs((double)b[i] - (double)a[i]);
        out->mean += distance;
        out->max = fmax(out->max, distance);
        out->differing += a[i] != b[i];
        if (a[i] != b[i]) differs[i] = 1;
    }
}

ChannelDifferences picture_bands_channels(const CompareOptions *options, const Comparison *out,
                                          Arena *arena)
{
    static const char *const NAMES[4] = {"R", "G", "B", "A"};
    ChannelDifferences found = {.list = ARENA_NEW(arena, ChannelDifference, 4)};
    int                channel[4];
    bool               both_have_alpha = out->reference.has_alpha && out->test.has_alpha;
    for (int c = 0; c < (both_have_alpha ? 4 : 3); c++) {
        if (metadata_ignores(&options->rules, NAMES[c])) continue;
        channel[found.count] = c;
        found.list[found.count++] = (ChannelDifference){.name = NAMES[c], .is_light = true};
    }
    Arena scratch = *arena;
    RowBand  band;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &band); y = band.y1) {
        unsigned char *differs = ARENA_NEW(&scratch, unsigned char, band.end);
        for (int c = 0; c < found.count; c++)
            add_channel(&band, channel[c], differs, &found.list[c]);
        for (size_t i = 0; i < band.end; i++) found.differing += differs[i];
        scratch = *arena;
    }
    for (int c = 0; c < found.count; c++) found.list[c].mean /= (double)out->selection.pixels;
    return found;
}

/* ---- metrics ----------------------------------------------------------------------------- */

/* Errors are those of codes, but a mean of luminance is one of light. */
static void measure_errors(const CompareOptions *options, unsigned groups, Arena arena,
                           Comparison *out)
{
    PixelErrorSums codes = {0}, light = {0};
    Arena          scratch = arena;
    RowBand           b;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &b); y = b.y1, scratch = arena) {
        const CodeRows *r = &b.side[0], *t = &b.side[1];
        pixel_errors_add_means(&codes, &r->codes, &t->codes, b.mask, b.first, b.end);
        pixel_errors_add_means(&light, &r->light, &t->light, b.mask, b.first, b.end);
    }
    scratch = arena;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &b); y = b.y1, scratch = arena)
        pixel_errors_add_differences(&codes, &b.side[0].codes, &b.side[1].codes, b.mask,
                                     b.first, b.end);
    PixelErrors errors = pixel_errors_of(&codes, 1);
    errors.mean_shift = pixel_errors_of(&light, 1).mean_shift;
    metrics_set_errors(&errors, groups, out);
}

static void measure_ssim(const CompareOptions *options, Arena arena, Comparison *out)
{
    SsimSum sum = {0};
    Arena   scratch = arena;
    RowBand    b;
    for (int y = 0; next_band(options, out, y, SSIM_RADIUS, &scratch, &b); y = b.y1) {
        ssim_add_rows(&sum, &b.side[0].codes, &b.side[1].codes, b.mask,
                      (const int[2]){b.y0 - b.top, b.y1 - b.top}, scratch);
        scratch = arena;
    }
    out->value[METRIC_SSIM] = sum.sum / sum.members;
}

static void map_flip(const RowBand *band, int threads, Arena scratch, float *map)
{
    const FlipOptions options = {.threads = threads};
    const Planes     *light = &band->side[0].light;
    float            *own = ARENA_NEW(&scratch, float, planes_pixel_count(light));
    flip_ldr(light, &band->side[1].light, &options, scratch, own);
    memcpy(map, own + band->first, sizeof *map * (band->end - band->first));
}

static void map_deltae(const RowBand *band, int threads, Arena scratch, float *map)
{
    (void)threads, (void)scratch;
    deltae_map(&band->side[0].light, &band->side[1].light, map); /* there is no halo */
}

/* A map over the whole picture, a band at a time. */
static void fill_map(const CompareOptions *options, const Comparison *c, int halo, Arena arena,
                     void (*map_band)(const RowBand *, int, Arena, float *), float *map)
{
    Arena scratch = arena;
    RowBand  b;
    for (int y = 0; next_band(options, c, y, halo, &scratch, &b); y = b.y1, scratch = arena)
        map_band(&b, options->threads, scratch,
                 map + (size_t)b.y0 * (size_t)c->reference.codes.width);
}

/* One map after the other in the same place. */
static void measure_maps(const CompareOptions *options, unsigned groups, Arena arena,
                         Comparison *out)
{
    size_t count = planes_pixel_count(&out->reference.codes);
    float *map = ARENA_NEW(&arena, float, count);
    if (groups & GROUP_FLIP) {
        Arena scratch = arena;
        int   halo = flip_filters_create(FLIP_PIXELS_PER_DEGREE, &scratch).radius;
        fill_map(options, out, halo, arena, map_flip, map);
        FlipSummary s = flip_summary(map, count, out->selection.counts);
        metrics_set_flip(&s, out);
    }
    if (groups & GROUP_DELTAE) {
        fill_map(options, out, 0, arena, map_deltae, map);
        DeltaE e = deltae_summary(map, count, out->selection.counts);
        metrics_set_deltae(&e, out);
    }
}

void picture_bands_measure(const CompareOptions *options, unsigned groups, Arena scratch,
                           Comparison *out)
{
    if (groups & (GROUP_MSE | GROUP_PSNR)) measure_errors(options, groups, scratch, out);
    if (groups & GROUP_SSIM) measure_ssim(options, scratch, out);
    if (groups & (GROUP_FLIP | GROUP_DELTAE)) measure_maps(options, groups, scratch, out);
    out->mask = out->selection.counts;
    lines_add(&out->notes, "compared in bands of rows, as pictures of so many pixels are: the "
                           "figures are those of whole pictures, a report has neither the "
                           "pictures nor maps of FLIP, of CIEDE2000 and of differences");
}
