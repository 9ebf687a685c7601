/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/compare.h"

#include <math.h>
#include <string.h>

#include "base/machine.h"
#include "base/progress.h"
#include "compare/headline.h"
#include "compare/metrics.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/ssim.h"
#include "compare/rows.h"

#define FEW_STANDOUTS 9  /* more are no single pixels */
#define LEAST_WHITE 0.01 /* of a picture's white: less is as good as black */

/* The metrics to compute: those requested, those that limits name, those that the judge
 * needs. */
static unsigned groups_of(const CompareOptions *options) {
    unsigned groups = options->groups ? options->groups : GROUP_ALL;
    for (int i = 0; i < options->threshold_count; i++)
        groups |= metric_info(options->thresholds[i].metric)->group;
    if (options->wants_stat || options->threshold_count == 0) groups |= GROUP_STAT;
    return groups;
}

/* ---- the judges -------------------------------------------------------------------------- */

static void judge_limits(Comparison *out) {
    for (int i = 0; i < out->row_count; i++) {
        const CompareRow *row = &out->rows[i];
        if (row->table == TABLE_METRIC && row->is_beyond)
            lines_add(&out->reasons, "%s %s, required: %s", row->figure, row->text,
                      row->limit_text);
    }
}

/* A pixel that its own noise does not explain fails: no mean of a block shows it, a driver sees
 * it, and where the seed is the same, it is there every time. */
static void judge_statistic(Comparison *out, Arena *arena) {
    if (out->stat.verdict == STATISTIC_DIFFERENT)
        lines_add(&out->reasons, "%s",
                  out->stat.reason[0] ? out->stat.reason
                                      : "pixels differ by more than their noise");
    if (out->standout.count && !out->standout.is_explained)
        lines_add(&out->reasons,
                  "%s: more than %d times what is around it, and beyond its own noise",
                  headline_pixel(out, &out->standout.most, arena), STANDOUT);
}

static void judge_equality(Comparison *out) {
    double share = out->value[METRIC_DIFFERING];
    if (out->channels.outside > 0)
        lines_add(&out->reasons, "%ld values outside of the display window differ",
                  out->channels.outside);
    if (out->channels.differing == 0) return;
    lines_add(&out->reasons, "%ld of %ld pixels differ (%.3g %%)", out->channels.differing,
              out->selection.pixels, 100 * share);
    lines_add(&out->notes,
              "no limit was set and there is no noise to judge by, so every pixel "
              "must be equal; a limit is set by --max flip=0.05 or the like%s",
              out->reference.kind == INPUT_FRAME ? ", or render with --layers variance,samples"
                                                 : "");
}

static bool is_rendered_here(const CompareInput *input) {
    return input->kind == INPUT_FRAME && frame_attribute(&input->frame, "parhelion:unit");
}

/* Figures and noise are those of R, G and B. Other channels of one's own frames are layers of
 * the same samples, and are named; those of other programs' files (a second eye, a depth) and
 * alpha may be anything, and must be equal. */
static void judge_others(Comparison *out) {
    bool is_own = is_rendered_here(&out->reference) && is_rendered_here(&out->test);
    Lines *to = is_own ? &out->notes : &out->reasons;
    const char *names = "", *last = "";
    int count = 0;
    for (int i = 0; i < out->channels.count; i++) {
        const char *name = out->channels.list[i].name, *dot = strchr(name, '.');
        if (!out->channels.list[i].differing || (!name[1] && strchr("RGB", name[0]))) continue;
        name = is_own && dot ? arena_string(to->arena, name, (size_t)(dot - name)) : name;
        if (!strcmp(name, last)) continue;
        if (count < 8) names = arena_format(to->arena, "%s%s%s", names, count ? ", " : "", name);
        last = name;
        count++;
    }
    if (count)
        lines_add(to, "%s differ that no figure is of: %s%s%s", is_own ? "layers" : "channels",
                  names, count > 8 ? arena_format(to->arena, " and %d more", count - 8) : "",
                  is_own ? "" : arena_format(to->arena, " (--ignore %s leaves one out)", last));
}

static void judge(const CompareOptions *options, Arena *arena, Comparison *out) {
    bool has_limits = options->threshold_count > 0;
    out->judged_by = options->wants_stat || (!has_limits && out->has_stat) ? JUDGED_BY_STATISTIC
                     : has_limits                                          ? JUDGED_BY_LIMITS
                                                                           : JUDGED_BY_EQUALITY;
    if (out->judged_by != JUDGED_BY_EQUALITY) judge_others(out);
    if (out->judged_by == JUDGED_BY_STATISTIC) judge_statistic(out, arena);
    if (out->judged_by == JUDGED_BY_EQUALITY) judge_equality(out);
    judge_limits(out);
}

/* ---- two pictures of codes, in bands of rows --------------------------------------------- */

/* A picture that is whole is one band. Those of large ones have as many rows around them as a
 * filter reaches, so that no value depends on where a band begins; sums go on from band to band
 * in the order of the pixels, and all figures have the bits that they would have of whole
 * pictures. There are no maps at the end, and so no pictures of them in a report. What is packed
 * takes 4 bytes a pixel and side (8 of 16 bits), one map and the selection 5 more a pixel, and a
 * band of both sides. */

#define BAND_ROWS 128

/* Rows [y0, y1) count; the planes begin with row `top` and hold what filters reach besides. */
typedef struct RowBand {
    int y0, y1, top;
    CodeRows side[2];
    PixelMask mask;    /* of the planes' pixels */
    size_t first, end; /* those that count, among the planes' */
} RowBand;

/* A channel that is left out is the same on both sides, for every figure. */
static void share_codes(const CompareRules *rules, const CodeRows *from, CodeRows *to) {
    static const char *const NAMES[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        if (!metadata_ignores(rules, NAMES[c])) continue;
        to->codes.rgb[c] = from->codes.rgb[c];
        to->light.rgb[c] = from->light.rgb[c];
    }
}

/* The band that begins with row y0; false below the picture. */
static bool next_band(const CompareOptions *options, const Comparison *c, int y0, int halo,
                      Arena *arena, RowBand *out) {
    const CompareInput *const sides[2] = {&c->reference, &c->test};
    const Planes *size = &c->reference.codes;
    bool is_whole = !input_is_packed(&c->reference);
    int rows = is_whole ? size->height : options->band_rows > 0 ? options->band_rows : BAND_ROWS;
    if (y0 >= size->height) return false;
    int y1 = size->height - y0 < rows ? size->height : y0 + rows;
    int top = y0 > halo ? y0 - halo : 0;
    int bottom = size->height - y1 < halo ? size->height : y1 + halo;
    RowBand band = {.y0 = y0,
                    .y1 = y1,
                    .top = top,
                    .mask = c->selection.counts + (size_t)top * (size_t)size->width,
                    .first = (size_t)(y0 - top) * (size_t)size->width,
                    .end = (size_t)(y1 - top) * (size_t)size->width};
    for (int k = 0; k < 2; k++)
        band.side[k] = is_whole ? (CodeRows){sides[k]->codes, sides[k]->light, sides[k]->alpha}
                                : input_unpack(sides[k], top, bottom, arena);
    share_codes(&options->rules, &band.side[0], &band.side[1]);
    *out = band;
    return true;
}

/* ---- channels ---------------------------------------------------------------------------- */

/* The channels of two pictures, and what changes the grid of `out`, which has its sides and its
 * selection. */
static ChannelDifferences picture_channels(const CompareOptions *options, Comparison *out,
                                           Arena *arena) {
    ChannelDifferences found = channels_start(4, arena);
    Arena scratch = *arena;
    RowBand b;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &b); y = b.y1, scratch = *arena) {
        const Planes *const light[2] = {&b.side[0].light, &b.side[1].light};
        change_add_rows(&out->grid, light, b.mask, b.top, (const int[2]){b.y0, b.y1});
        unsigned char *differs = ARENA_NEW(&scratch, unsigned char, b.end);
        channels_add_codes(b.side, b.mask, b.end, &options->rules, differs, &found);
    }
    channels_end(&found);
    return found;
}

/* ---- metrics ----------------------------------------------------------------------------- */

/* Errors are those of codes, but a mean of luminance is one of light. */
static void measure_errors(const CompareOptions *options, unsigned groups, Arena arena,
                           Comparison *out) {
    PixelErrorSums codes = {0}, light = {0};
    Arena scratch = arena;
    RowBand b;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &b); y = b.y1, scratch = arena) {
        const CodeRows *r = &b.side[0], *t = &b.side[1];
        pixel_errors_add_means(&codes, &r->codes, &t->codes, b.mask, b.first, b.end);
        pixel_errors_add_means(&light, &r->light, &t->light, b.mask, b.first, b.end);
    }
    scratch = arena;
    for (int y = 0; next_band(options, out, y, 0, &scratch, &b); y = b.y1, scratch = arena)
        pixel_errors_add_differences(&codes, &b.side[0].codes, &b.side[1].codes, b.mask, b.first,
                                     b.end);
    PixelErrors errors = pixel_errors_of(&codes, 1);
    errors.mean_shift = pixel_errors_of(&light, 1).mean_shift;
    metrics_set_errors(&errors, groups, out);
}

static void measure_ssim(const CompareOptions *options, Arena arena, Comparison *out) {
    SsimSum sum = {0};
    Arena scratch = arena;
    RowBand b;
    for (int y = 0; next_band(options, out, y, SSIM_RADIUS, &scratch, &b); y = b.y1) {
        ssim_add_rows(&sum, &b.side[0].codes, &b.side[1].codes, b.mask,
                      (const int[2]){b.y0 - b.top, b.y1 - b.top}, scratch);
        scratch = arena;
    }
    out->value[METRIC_SSIM] = sum.sum / sum.members;
}

static void map_flip(const RowBand *band, int threads, Arena scratch, float *map) {
    const FlipOptions options = {.threads = threads, .mask = band->mask};
    const Planes *light = &band->side[0].light;
    float *own = ARENA_NEW(&scratch, float, planes_pixel_count(light));
    flip_ldr(light, &band->side[1].light, &options, scratch, own);
    memcpy(map, own + band->first, sizeof *map * (band->end - band->first));
}

static void map_deltae(const RowBand *band, int threads, Arena scratch, float *map) {
    (void)threads, (void)scratch;
    deltae_map(&band->side[0].light, &band->side[1].light, map); /* there is no halo */
}

/* A map over the whole picture, a band at a time. */
static MapSummary fill_map(const CompareOptions *options, const Comparison *c, int halo,
                           Arena arena, void (*map_band)(const RowBand *, int, Arena, float *),
                           float *map) {
    Arena scratch = arena;
    RowBand b;
    for (int y = 0; next_band(options, c, y, halo, &scratch, &b); y = b.y1, scratch = arena)
        map_band(&b, options->threads, scratch,
                 map + (size_t)b.y0 * (size_t)c->reference.codes.width);
    return map_summary(map, planes_pixel_count(&c->reference.codes), c->selection.counts);
}

/* Of large pictures one map after the other in the same place. */
static void measure_maps(const CompareOptions *options, unsigned groups, Arena *arena,
                         Comparison *out) {
    size_t count = planes_pixel_count(&out->reference.codes);
    bool is_whole = !input_is_packed(&out->reference);
    Arena scratch = *arena;
    Arena *from = is_whole ? arena : &scratch;
    float *map = ARENA_NEW(from, float, count);
    if (groups & GROUP_FLIP) {
        Arena filters = *from;
        int halo = flip_filters_create(FLIP_PIXELS_PER_DEGREE, &filters).radius;
        /* what fills a mask comes from as far beyond what a filter reaches */
        MapSummary s = fill_map(options, out, 2 * halo, *from, map_flip, map);
        metrics_set_flip(&s, out);
        if (is_whole) out->flip_map = map;
        if (is_whole) map = ARENA_NEW(from, float, count);
    }
    if (groups & GROUP_DELTAE) {
        MapSummary e = fill_map(options, out, 0, *from, map_deltae, map);
        metrics_set_deltae(&e, out);
        if (is_whole) out->deltae_map = map;
    }
}

/* Values of `out`; of large pictures a note of what is left out. groups: GROUP_... bits. */
static void measure_pictures(const CompareOptions *options, unsigned groups, Arena *arena,
                             Comparison *out) {
    RowBand all;
    out->mask = out->selection.counts;
    if (!input_is_packed(&out->reference) && next_band(options, out, 0, 0, arena, &all)) {
        for (int k = 0; k < 2; k++) out->light[k] = all.side[k].light;
        out->test.codes = all.side[1].codes;
        out->test.light = all.side[1].light;
    } else {
        lines_add(&out->notes, "compared in bands of rows, as pictures of so many pixels are: the "
                               "figures are those of whole pictures, a report has neither the "
                               "pictures nor maps of FLIP, of CIEDE2000 and of differences");
    }
    if (groups & (GROUP_MSE | GROUP_PSNR)) measure_errors(options, groups, *arena, out);
    if (groups & GROUP_SSIM) measure_ssim(options, *arena, out);
    if (groups & (GROUP_FLIP | GROUP_DELTAE)) measure_maps(options, groups, arena, out);
}

/* ---- the comparison ---------------------------------------------------------------------- */

static void start(const CompareInput *reference, const CompareInput *test, Arena *arena,
                  Comparison *out) {
    *out = (Comparison){.reference = *reference,
                        .test = *test,
                        .reasons = {.arena = arena},
                        .notes = {.arena = arena},
                        .judged_by = JUDGED_BY_EQUALITY,
                        .shown_with = ""};
    for (int i = 0; i < METRIC_COUNT; i++) out->value[i] = NAN;
}

static bool measure(const CompareOptions *options, Arena *arena, Comparison *out, Error *err) {
    unsigned groups = groups_of(options);
    if (options->wants_stat && out->reference.kind == INPUT_PICTURE)
        return error_at(err, ERROR_INPUT, out->reference.name, "",
                        "is a picture: only frames tell their noise to a statistical test");
    if (out->reference.kind == INPUT_FRAME)
        return metrics_measure(options, groups, arena, out, err);
    measure_pictures(options, groups, arena, out);
    return true;
}

/* What nothing found different and no noise that is known calls the same is neither. */
static bool knows_verdict(const Comparison *out, Error *err) {
    const StatisticResult *s = &out->stat;
    if (out->judged_by != JUDGED_BY_STATISTIC || s->verdict != STATISTIC_UNKNOWN ||
        out->reasons.count > 0)
        return true;
    return error_at(err, ERROR_INPUT, s->broken_side ? out->test.name : out->reference.name, "",
                    "has in layer %s: another program changed it, and its noise is not known; "
                    "required: the frame as it was rendered, or a limit, such as --max flip=0.05",
                    s->broken);
}

/* Of pictures, where no noise shows, all that differs has changed. A pixel that stands out
 * is named beside a change of the light only where that is far less. */
static void find_change(Comparison *out, Arena *arena) {
    const Planes *const light[2] = {&out->light[0], &out->light[1]};
    bool is_frame = out->reference.kind == INPUT_FRAME;
    double floor = is_frame ? 0 : LEAST_WHITE;
    const Standout *s = &out->standout;
    out->change = change_find(&out->grid, out->structure.shares_field, floor, arena);
    if (!is_frame && out->change.area.pixels == 0 && !out->change.is_noisy)
        out->change = change_find(&out->grid, true, floor, arena);
    if (is_frame) /* of the same paths: there is no noise between them, whatever theirs is */
        out->standout = change_standout(
            light, out->mask, out->structure.shares_paths ? NULL : out->stat.sigma, *arena);
    double reach = fabs(s->most.luminance[1] - s->most.luminance[0]);
    if ((!out->has_stat || out->stat.verdict == STATISTIC_DIFFERENT) &&
        !(s->count <= FEW_STANDOUTS && reach > STANDOUT_LIKE * s->rest))
        out->standout.count = 0;
}

static bool compare_pixels(const CompareOptions *options, Arena *arena, Comparison *out,
                           Error *err) {
    const CompareInput *const sides[2] = {&out->reference, &out->test};
    if (!selection_make(sides, &options->selection, arena, &out->selection, err)) return false;
    out->grid =
        change_grid(out->reference.light.width, out->reference.light.height,
                    out->reference.kind == INPUT_PICTURE || out->structure.shares_field, arena);
    out->channels = out->reference.kind == INPUT_PICTURE
                        ? picture_channels(options, out, arena)
                        : channels_compare(&out->reference, &out->test, &out->structure,
                                           &options->rules, &out->selection, arena);
    out->value[METRIC_DIFFERING] = (double)out->channels.differing / (double)out->selection.pixels;
    channels_report(&out->channels, &out->reasons, &out->notes, &out->structural);
    if (!measure(options, arena, out, err)) return false;
    out->has_pixels = true;
    find_change(out, arena);
    rows_make(options, arena, out);
    judge(options, arena, out);
    return knows_verdict(out, err);
}

/* Measured with all metrics: 126 bytes for each further pixel of frames of R, G and B; of 21,
 * 32, 35 and 84 channels 309, 414, 462 and 854. */
static double pixel_bytes(const CompareInput *frame) {
    return 130 + 10 * fmax(frame->frame.channel_count - 3, 0);
}

/* Frames are compared whole: one that cannot fit is refused before minutes of work. */
static bool has_room(const CompareInput *frame, Error *err) {
    double pixels = (double)frame->light.width * frame->light.height;
    double wanted = pixels * pixel_bytes(frame), memory = (double)machine_memory_bytes();
    if (frame->kind == INPUT_PICTURE || wanted <= memory) return true;
    return error_at(err, ERROR_MEMORY, frame->name, "",
                    "has %d x %d pixels: frames of light are compared whole, in about %.0f "
                    "bytes a pixel, %.3g GB, and here are %.3g GB; compare crops, or developed "
                    "pictures, which go in bands",
                    frame->light.width, frame->light.height, pixel_bytes(frame), wanted / 1e9,
                    memory / 1e9);
}

/* A display is compared by itself, as in front of black. */
static void take_display(const CompareOptions *options, Arena *arena, Comparison *out) {
    CompareInput *const sides[2] = {&out->reference, &out->test};
    const char *display = options->selection.display;
    Error why;
    if (!display || !out->structure.same_pixels || out->reference.kind != INPUT_FRAME ||
        selection_take_display(sides, display, arena, &why))
        return;
    lines_add(&out->notes, "%s: %s", why.file, why.text);
}

/* As share_codes, of frames. */
static bool share_ignored(const CompareOptions *options, Arena *arena, Comparison *out,
                          Error *err) {
    FrameImage *frame = &out->test.frame;
    ExrChannel *channels = ARENA_NEW(arena, ExrChannel, frame->channel_count);
    if (!out->structure.same_pixels || !options->rules.ignored_count ||
        out->reference.kind == INPUT_PICTURE)
        return true;
    for (int i = 0; i < frame->channel_count; i++) {
        channels[i] = frame->channels[i];
        const float *other = frame_channel(&out->reference.frame, channels[i].name);
        if (other && metadata_ignores(&options->rules, channels[i].name))
            channels[i].values = (float *)other;
    }
    frame->channels = channels;
    return input_view_light(&out->test, arena, err);
}

bool compare_inputs(const CompareInput *reference, const CompareInput *test,
                    const CompareOptions *options, Arena *arena, Comparison *out, Error *err) {
    Comparison made;
    double begun = monotonic_seconds();
    if (!input_check_kinds(reference, test, err) || !has_room(reference, err)) return false;
    start(reference, test, arena, &made);
    made.structure =
        structure_compare(reference, test, &options->rules, arena, &made.reasons, &made.notes);
    if (!share_ignored(options, arena, &made, err)) return false;
    take_display(options, arena, &made);
    if (!metrics_develop(options, arena, &made, err)) return false;
    if (made.structure.same_pixels && !compare_pixels(options, arena, &made, err)) return false;
    made.same = made.reasons.count == 0;
    if (!made.has_pixels) made.structural = made.reasons.count;
    headline_make(options, arena, &made);
    made.seconds = monotonic_seconds() - begun;
    *out = made;
    return true;
}

bool compare_files(const char *reference, const char *test, const CompareOptions *options,
                   Arena *arena, Comparison *out, Error *err) {
    CompareInput a, b;
    double begun = monotonic_seconds();
    if (!input_read(reference, options->whole_pixels, arena, &a, err) ||
        !input_read(test, options->whole_pixels, arena, &b, err))
        return false;
    if (!compare_inputs(&a, &b, options, arena, out, err)) return false;
    out->seconds = monotonic_seconds() - begun;
    return true;
}
