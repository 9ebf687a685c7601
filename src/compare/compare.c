/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/compare.h"

#include <math.h>
#include <string.h>

#include "base/machine.h"
#include "base/progress.h"
#include "compare/comparison.h"
#include "compare/metrics.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/ssim.h"

#define LEAST_SAID 1e-3 /* of a change of contrast that has no interval */

static double level_of(const CompareOptions *options) {
    return options->level > 0 ? options->level : 0.01;
}

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

static void judge_limits(const CompareOptions *options, Comparison *out) {
    for (int i = 0; i < options->threshold_count; i++) {
        Threshold t = options->thresholds[i];
        const MetricInfo *info = metric_info(t.metric);
        double value = out->value[t.metric];
        if (threshold_holds(t, value)) continue;
        if (isnan(value))
            lines_add(&out->reasons, "%s is not known for these files, %s %g is required",
                      info->name, info->is_min ? "at least" : "at most", t.limit);
        else
            lines_add(&out->reasons, "%s is %.5g, %s %g is required", info->name, value,
                      info->is_min ? "at least" : "at most", t.limit);
    }
}

static void judge_statistic(Comparison *out) {
    if (out->stat.verdict != STATISTIC_DIFFERENT) return;
    lines_add(&out->reasons, "%s",
              out->stat.reason[0] ? out->stat.reason : "pixels differ by more than their noise");
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

static void judge(const CompareOptions *options, Comparison *out) {
    out->judged_by = JUDGED_BY_LIMITS;
    if (options->wants_stat || (options->threshold_count == 0 && out->has_stat)) {
        out->judged_by = JUDGED_BY_STATISTIC;
        judge_statistic(out);
    } else if (options->threshold_count == 0) {
        out->judged_by = JUDGED_BY_EQUALITY;
        judge_equality(out);
    }
    judge_limits(options, out);
    if (out->judged_by != JUDGED_BY_EQUALITY) judge_others(out);
}

/* ---- sentences --------------------------------------------------------------------------- */

static const char *limits_text(const CompareOptions *options, const Comparison *out, Arena *arena) {
    const char *text = "";
    for (int i = 0; i < options->threshold_count; i++) {
        Threshold t = options->thresholds[i];
        const MetricInfo *info = metric_info(t.metric);
        text = arena_format(arena, "%s%s%s %.4g, %s %g", text, i ? "; " : "", info->name,
                            out->value[t.metric], info->is_min ? "at least" : "at most", t.limit);
    }
    return text;
}

/* Beyond its interval; where no noise is stated, beyond what four digits show. */
static bool contrast_moved(const ContrastChange *change) {
    double far = fabs(change->ratio.value - 1);
    double error = measured_half_width(change->ratio);
    return isnan(error) ? far > LEAST_SAID : far > error;
}

/* "contrast of cluster 9.9 : 1 to 6.1 : 1 (-38 +- 0.5 %) and of 2 more displays; ", for what
 * changed most; "" when none did. */
static const char *contrast_change_text(const Comparison *out, Arena *arena) {
    const ContrastChange *most = NULL;
    int count = 0;
    for (int i = 0; i < out->contrast_count; i++) {
        const ContrastChange *c = &out->contrasts[i];
        if (!contrast_moved(c)) continue;
        count++;
        if (!most || fabs(c->ratio.value - 1) > fabs(most->ratio.value - 1)) most = c;
    }
    if (!most) return "";
    double error = measured_half_width(most->ratio);
    const char *text = arena_format(
        arena, "contrast of %s %.3g : 1 to %.3g : 1 (%+.3g%s %%)", most->display,
        most->reference.contrast.value, most->test.contrast.value, 100 * (most->ratio.value - 1),
        !isfinite(error) ? "" : arena_format(arena, " +- %.2g", 100 * error));
    if (count == 1) return arena_format(arena, "%s; ", text);
    return arena_format(arena, "%s and of %d more display%s; ", text, count - 1,
                        count > 2 ? "s" : "");
}

/* "contrast of 3 displays within 1.2 %; ": how far any may have moved; "" where no noise is
 * stated. */
static const char *contrast_held_text(const Comparison *out, Arena *arena) {
    double most = 0;
    for (int i = 0; i < out->contrast_count; i++) {
        Measured ratio = out->contrasts[i].ratio;
        double far = fabs(ratio.value - 1) + measured_half_width(ratio);
        if (!(far <= most)) most = far;
    }
    if (!(most > 0) || isinf(most)) return "";
    return arena_format(arena, "contrast of %d display%s within %.2g %%; ", out->contrast_count,
                        out->contrast_count > 1 ? "s" : "", 100 * most);
}

static const char *same_verdict(const CompareOptions *options, const Comparison *out,
                                Arena *arena) {
    if (out->judged_by == JUDGED_BY_EQUALITY ||
        (out->channels.differing == 0 && out->channels.outside == 0))
        return out->selection.is_part ? "equal in every pixel that counts" : "equal in every pixel";
    const char *limits = limits_text(options, out, arena);
    if (out->judged_by == JUDGED_BY_LIMITS)
        return arena_format(arena, "within the limits (%s)", limits);
    if (out->stat.verdict == STATISTIC_EQUAL) return "the light is equal in every pixel";
    return arena_format(arena,
                        "%sonly the noise differs, the mean did not move (p = %.3g at a "
                        "level of %g)%s%s",
                        contrast_held_text(out, arena), out->stat.p_value, level_of(options),
                        limits[0] ? "; " : "", limits);
}

/* A display's change of contrast comes first: reviewers look for it. */
static const char *different_verdict(const Comparison *out, Arena *arena) {
    int more = out->reasons.count - 1;
    const char *lead = contrast_change_text(out, arena);
    const char *text = arena_format(arena, "%s%s", lead, out->reasons.list[0]);
    if (more == 0) return text;
    return arena_format(arena, "%s; and %d more reason%s", text, more, more > 1 ? "s" : "");
}

/* Whether the mean moved or only the noise: what a reviewer checks first. Empty where the
 * statistic's own verdict states it already. */
static const char *mean_sentence(const CompareOptions *options, const Comparison *out,
                                 Arena *arena) {
    const StatisticResult *s = &out->stat;
    bool is_said =
        out->judged_by == JUDGED_BY_STATISTIC && (out->same || s->verdict == STATISTIC_DIFFERENT);
    if (!out->has_pixels || out->channels.differing == 0) return "";
    if (!out->has_stat)
        return "Whether the mean moved or only the noise is not known: no noise is stated.";
    if (s->verdict == STATISTIC_EQUAL) return "The light is equal in every pixel.";
    if (s->verdict == STATISTIC_UNKNOWN)
        return "Whether the mean moved or only the noise is not known: the layers that state the "
               "noise are not what was rendered.";
    if (is_said && s->verdict == STATISTIC_SAME) return "";
    if (s->verdict == STATISTIC_SAME)
        return arena_format(arena,
                            "Only the noise differs, the mean did not move (p = %.3g at "
                            "a level of %g).",
                            s->p_value, level_of(options));
    return arena_format(arena, "%s than the noise explains (p = %.2g at a level of %g)%s.",
                        is_said         ? "That is more"
                        : s->mean_moved ? "The mean moved, more"
                                        : "Pixels differ by more",
                        s->p_value, level_of(options),
                        s->shares_noise ? "; both share their seed and samples" : "");
}

/* ---- two large pictures of codes, in bands of rows --------------------------------------- */

/* A band has as many rows around it as a filter reaches, so that no value depends on where it
 * begins; sums go on from band to band in the order of the pixels. All figures have the bits
 * that they would have of whole pictures. There are no maps at the end, and so no pictures of
 * them in a report. What is packed takes 4 bytes a pixel and side (8 of 16 bits), one map and
 * the selection 5 more a pixel, and a band of both sides. */

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
    const Planes *size = &c->reference.codes;
    int rows = options->band_rows > 0 ? options->band_rows : BAND_ROWS;
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
    band.side[0] = input_unpack(&c->reference, top, bottom, arena);
    band.side[1] = input_unpack(&c->test, top, bottom, arena);
    share_codes(&options->rules, &band.side[0], &band.side[1]);
    *out = band;
    return true;
}

/* ---- channels ---------------------------------------------------------------------------- */

static const float *plane_of(const CodeRows *rows, int channel) {
    return channel < 3 ? rows->codes.rgb[channel] : rows->alpha;
}

/* differs: one byte a pixel of the band. */
static void add_channel(const RowBand *band, int channel, unsigned char *differs,
                        ChannelDifference *out) {
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

/* The findings of channels_compare, without its map of differing pixels. `out` has its sides
 * and its selection. */
static ChannelDifferences picture_bands_channels(const CompareOptions *options,
                                                 const Comparison *out, Arena *arena) {
    static const char *const NAMES[4] = {"R", "G", "B", "A"};
    ChannelDifferences found = {.list = ARENA_NEW(arena, ChannelDifference, 4)};
    int channel[4];
    bool both_have_alpha = out->reference.has_alpha && out->test.has_alpha;
    for (int c = 0; c < (both_have_alpha ? 4 : 3); c++) {
        if (metadata_ignores(&options->rules, NAMES[c])) continue;
        channel[found.count] = c;
        found.list[found.count++] = (ChannelDifference){.name = NAMES[c]};
    }
    Arena scratch = *arena;
    RowBand band;
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
static void fill_map(const CompareOptions *options, const Comparison *c, int halo, Arena arena,
                     void (*map_band)(const RowBand *, int, Arena, float *), float *map) {
    Arena scratch = arena;
    RowBand b;
    for (int y = 0; next_band(options, c, y, halo, &scratch, &b); y = b.y1, scratch = arena)
        map_band(&b, options->threads, scratch,
                 map + (size_t)b.y0 * (size_t)c->reference.codes.width);
}

/* One map after the other in the same place. */
static void measure_maps(const CompareOptions *options, unsigned groups, Arena arena,
                         Comparison *out) {
    size_t count = planes_pixel_count(&out->reference.codes);
    float *map = ARENA_NEW(&arena, float, count);
    if (groups & GROUP_FLIP) {
        Arena scratch = arena;
        int halo = flip_filters_create(FLIP_PIXELS_PER_DEGREE, &scratch).radius;
        /* what fills a mask comes from as far beyond what a filter reaches */
        fill_map(options, out, 2 * halo, arena, map_flip, map);
        MapSummary s = map_summary(map, count, out->selection.counts);
        metrics_set_flip(&s, out);
    }
    if (groups & GROUP_DELTAE) {
        fill_map(options, out, 0, arena, map_deltae, map);
        MapSummary e = map_summary(map, count, out->selection.counts);
        metrics_set_deltae(&e, out);
    }
}

/* Values of `out`, and a note of what is left out. groups: GROUP_... bits. */
static void picture_bands_measure(const CompareOptions *options, unsigned groups, Arena scratch,
                                  Comparison *out) {
    if (groups & (GROUP_MSE | GROUP_PSNR)) measure_errors(options, groups, scratch, out);
    if (groups & GROUP_SSIM) measure_ssim(options, scratch, out);
    if (groups & (GROUP_FLIP | GROUP_DELTAE)) measure_maps(options, groups, scratch, out);
    out->mask = out->selection.counts;
    lines_add(&out->notes, "compared in bands of rows, as pictures of so many pixels are: the "
                           "figures are those of whole pictures, a report has neither the "
                           "pictures nor maps of FLIP, of CIEDE2000 and of differences");
}

/* ---- the comparison ---------------------------------------------------------------------- */

static void start(const CompareInput *reference, const CompareInput *test, Arena *arena,
                  Comparison *out) {
    *out = (Comparison){.reference = *reference,
                        .test = *test,
                        .reasons = {.arena = arena},
                        .notes = {.arena = arena},
                        .shown_with = ""};
    for (int i = 0; i < METRIC_COUNT; i++) out->value[i] = NAN;
}

/* Large pictures in bands, all others whole. */
static bool measure(const CompareOptions *options, Arena *arena, Comparison *out, Error *err) {
    unsigned groups = groups_of(options);
    if (options->wants_stat && out->reference.kind == INPUT_PICTURE)
        return error_at(err, ERROR_INPUT, out->reference.name, "",
                        "is a picture: only frames tell their noise to a statistical test");
    if (!input_is_packed(&out->reference)) return metrics_measure(options, groups, arena, out, err);
    picture_bands_measure(options, groups, *arena, out);
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

static bool compare_pixels(const CompareOptions *options, Arena *arena, Comparison *out,
                           Error *err) {
    const CompareInput *const sides[2] = {&out->reference, &out->test};
    if (!selection_make(sides, &options->selection, arena, &out->selection, err)) return false;
    out->channels = input_is_packed(&out->reference)
                        ? picture_bands_channels(options, out, arena)
                        : channels_compare(&out->reference, &out->test, &out->structure,
                                           &options->rules, &out->selection, arena);
    out->value[METRIC_DIFFERING] = (double)out->channels.differing / (double)out->selection.pixels;
    channels_report(&out->channels, &out->reasons, &out->notes);
    if (!measure(options, arena, out, err)) return false;
    out->has_pixels = true;
    judge(options, out);
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

/* As share_codes, of whole pictures and of frames. */
static bool share_ignored(const CompareOptions *options, Arena *arena, Comparison *out,
                          Error *err) {
    FrameImage *frame = &out->test.frame;
    ExrChannel *channels = ARENA_NEW(arena, ExrChannel, frame->channel_count);
    if (!out->structure.same_pixels || !options->rules.ignored_count) return true;
    if (out->reference.kind == INPUT_PICTURE) {
        const CodeRows from = {out->reference.codes, out->reference.light, NULL};
        CodeRows to = {out->test.codes, out->test.light, NULL};
        share_codes(&options->rules, &from, &to);
        out->test.codes = to.codes;
        out->test.light = to.light;
        return true;
    }
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
    made.verdict =
        made.same ? same_verdict(options, &made, arena) : different_verdict(&made, arena);
    made.mean = mean_sentence(options, &made, arena);
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
