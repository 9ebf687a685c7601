/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/headline.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "compare/rows.h"

#define FEW_PIXELS 9  /* are named by their place */
#define LEAST 5e-5    /* of a change of luminance in words; beside one of colour ten times that */
#define MANY_TIMES 10 /* as bright: no percentage any more */
#define OF_ONE 0.8    /* of a change: that of an object */
#define MOST_IDS 65536
#define NAMED 4 /* inputs, settings */

const char *const compare_outcome_names[] = {[COMPARE_SAME] = "same",
                                             [COMPARE_SAME_LIGHT] = "same light",
                                             [COMPARE_WITHIN_NOISE] = "within noise",
                                             [COMPARE_WITHIN_LIMITS] = "within limits",
                                             [COMPARE_DIFFERENT] = "different"};

const char *headline_name(const char *path, Arena *arena) {
    char *name = arena_string(arena, path, strlen(path) - strlen(path_ending(path)));
    name[0] = (char)toupper((unsigned char)name[0]);
    return name;
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Two digits, or as many as the interval's first digit allows, and one at least. */
static const char *rounded(double size, double half_width, Arena *arena) {
    int first = size > 0 ? -(int)floor(log10(size)) : 0, decimals = first + 1;
    if (half_width > 0) decimals = (int)fmin(decimals, -floor(log10(half_width)));
    if (decimals < first) decimals = first;
    double unit = pow(10, abs(decimals));
    return arena_format(arena, "%.15g",
                        decimals > 0 ? round(size * unit) / unit : round(size / unit) * unit);
}

static const char *percent(double change, double half_width, Arena *arena) {
    return arena_format(arena, "%s %%", rounded(100 * fabs(change), 100 * half_width, arena));
}

static const char *light_text(const Comparison *c, double luminance, Arena *arena) {
    double value = c->reference.kind == INPUT_FRAME ? luminance : 100 * luminance;
    return arena_format(arena, value < 1000 ? "%.3g" : "%.0f", value);
}

const char *headline_pixel(const Comparison *c, const ChangedPixel *pixel, Arena *arena) {
    return arena_format(arena, "pixel %d,%d: %s, now %s %s", pixel->x, pixel->y,
                        light_text(c, pixel->luminance[0], arena),
                        light_text(c, pixel->luminance[1], arena),
                        c->reference.kind == INPUT_FRAME ? "cd/m2" : "% of white");
}

/* "2 % darker", "colour shift 0.012 u'v'", "changed" */
static const char *amount(const Comparison *c, double change, double half_width, Arena *arena) {
    const LightChange *all = &c->change;
    bool is_sure =
        fabs(change) > half_width && fabs(change) >= (all->has_colour ? 10 * LEAST : LEAST);
    const char *text = "";
    if (isinf(change)) text = "lit where it was black";
    else if (is_sure && change >= MANY_TIMES)
        text = arena_format(arena, "%s times as bright", rounded(change + 1, half_width, arena));
    else if (is_sure)
        text = arena_format(arena, "%s %s", percent(change, half_width, arena),
                            change > 0 ? "brighter" : "darker");
    if (all->is_both_ways && !(is_sure && all->is_everywhere && c->has_stat))
        text = "brighter and darker";
    if (all->has_colour && !isinf(change))
        text = arena_format(arena,
                            text[0] ? "%s, colour shift %.2g u'v'"
                                    : "%scolour shift %.2g u'v' at equal luminance",
                            text, all->uv);
    return text[0] ? text : "changed";
}

/* ---- where ------------------------------------------------------------------------------- */

/* "display cluster" where most of the change is its own; NULL: it is of no single one. Noise
 * cancels within an object. */
static const char *object_of(const Comparison *c, const char *what, Arena *arena) {
    const FrameImage *frame = &c->reference.frame;
    const float *ids = frame_channel(frame, arena_format(arena, "id.%s", what));
    Arena scratch = *arena;
    double(*sums)[3] = arena_alloc(&scratch, sizeof *sums, _Alignof(double), MOST_IDS + 1);
    double all = 0, most = 0;
    int best = 0, width = c->light[0].width, side = c->grid.side;
    for (size_t i = 0; ids && i < frame_pixel_count(frame); i++) {
        long place = selection_place(frame, i);
        if (place < 0 || !c->mask[place]) continue;
        int x = (int)(place % width), y = (int)(place / width);
        if (!c->change.cells[y / side * c->grid.columns + x / side]) continue;
        int id = ids[i] >= 0 && ids[i] < MOST_IDS ? (int)ids[i] : MOST_IDS;
        for (int k = 0; k < 3; k++)
            sums[id][k] += (double)c->light[1].rgb[k][place] - (double)c->light[0].rgb[k][place];
    }
    for (int id = 0; id <= MOST_IDS; id++) {
        double size = fabs(sums[id][0]) + fabs(sums[id][1]) + fabs(sums[id][2]);
        all += size;
        if (size > most && id < MOST_IDS) best = id;
        most = fmax(most, id < MOST_IDS ? size : 0);
    }
    if (!(most > OF_ONE * all)) return NULL;
    const char *name = frame_string(frame, arena_format(arena, "parhelion:%s.%d", what, best));
    return name ? arena_format(arena, "%s %s", what, name) : NULL;
}

static const char *share_text(const LightChange *change, Arena *arena) {
    return arena_format(arena, "%s of the picture", percent(change->share, 0, arena));
}

static const char *local_text(const Comparison *c, Arena *arena) {
    const LightChange *change = &c->change;
    const char *text = amount(c, change->luminance, change->half_width, arena), *object = NULL;
    bool has_ids = c->reference.kind == INPUT_FRAME && c->light[0].rgb[0];
    if (has_ids) object = object_of(c, "display", arena);
    if (has_ids && !object) object = object_of(c, "part", arena);
    /* In noise few cells of an object stand out by themselves, unless they fill a box: its mean is
     * known better, and how far it reaches is not known. */
    bool is_vague = change->is_noisy && !change->is_box;
    for (int i = 0; object && is_vague && i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        if (row->table == TABLE_MEAN && row->is_finding && !strcmp(row->of, object))
            text = amount(c, row->value, row->half_width, arena);
    }
    if (object && is_vague) return arena_format(arena, "%s, %s", text, object);
    if (object) return arena_format(arena, "%s, %s (%s)", text, object, share_text(change, arena));
    return arena_format(arena, "%s in %s%s%s", text, share_text(change, arena),
                        change->place[0] ? ", " : ", scattered", change->place);
}

/* What the statistical test found where no cell stands out: a region, a block, or neither. */
static const char *tested_text(const Comparison *c, Arena *arena) {
    const ExrWindow at = c->stat.block;
    const CompareRow *best = NULL;
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        bool is_better = !best || !best->of[0] || row->p < best->p;
        if (row->table == TABLE_MEAN && row->is_finding && is_better) best = row;
    }
    if (best && (best->of[0] || at.x1 == at.x0))
        return arena_format(arena, "%s, %s", amount(c, best->value, best->half_width, arena),
                            best->of[0] ? best->of : "everywhere");
    if (at.x1 == at.x0) return "brighter and darker in small places, everywhere";
    return arena_format(arena, "changed at x %d..%d, y %d..%d", at.x0, at.x1, at.y0, at.y1);
}

static bool is_few(const Comparison *c) {
    return !c->change.is_noisy && c->change.all.differing <= FEW_PIXELS;
}

static const char *changed_text(const Comparison *c, Arena *arena) {
    const LightChange *change = &c->change;
    double value = change->luminance, half_width = change->half_width;
    if (change->all.differing == 0) return "changed by no more than rounding";
    if (is_few(c))
        return arena_format(arena, "%.0f of %ld pixels differ%s, %s", change->all.differing,
                            c->selection.pixels, change->all.differing == 1 ? "s" : "",
                            headline_pixel(c, &c->grid.most, arena));
    if (!change->is_everywhere)
        return change->area.pixels > 0 ? local_text(c, arena)
               : c->has_stat           ? tested_text(c, arena)
                                       : "differs as noise does";
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        if (row->table != TABLE_MEAN || row->of[0] || !(fabs(row->value) > row->half_width))
            continue;
        value = row->value;
        half_width = row->half_width;
    }
    return arena_format(arena, "%s, everywhere", amount(c, value, half_width, arena));
}

/* ---- within the noise -------------------------------------------------------------------- */

/* How far the means may have moved unseen. */
static const char *held_text(const Comparison *c, Arena *arena) {
    const char *text = "";
    double most = 0;
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        double far = fabs(row->value) + row->half_width;
        if (row->table == TABLE_MEAN && !row->of[0] && isfinite(far))
            text = arena_format(arena, ", mean luminance within %s", percent(far, far, arena));
        if (row->table == TABLE_CONTRAST) most = far > most || isnan(far) ? far : most;
    }
    if (most > 0 && isfinite(most))
        text = arena_format(arena, "%s, contrasts within %s", text, percent(most, most, arena));
    return text;
}

/* Of one seed any difference is a change; of two the noise alone may be it, where the inputs are
 * known to be the same. */
static const char *within_noise_text(const Comparison *c, Arena *arena) {
    const char *one = frame_string(&c->reference.frame, "parhelion:seed");
    const char *other = frame_string(&c->test.frame, "parhelion:seed");
    const Structure *s = &c->structure;
    if (c->stat.shares_noise)
        return arena_format(arena, "changed, below the noise: %.0f of %ld pixels differ%s",
                            c->change.all.differing, c->selection.pixels, held_text(c, arena));
    if (one && other && strcmp(one, other) != 0 && s->knows_inputs && !s->inputs.count)
        return arena_format(arena, "only the noise differs%s", held_text(c, arena));
    return arena_format(arena, "no change beyond the noise%s", held_text(c, arena));
}

static bool is_noise_stated(const CompareInput *side) {
    return frame_channel(&side->frame, "variance.G") || frame_channel(&side->frame, "halves.G");
}

static const char *light_change(const Comparison *c, Arena *arena) {
    bool is_frame = c->reference.kind == INPUT_FRAME;
    bool has_noise = is_frame && !c->has_stat && c->change.is_noisy;
    const char *text;
    if (c->channels.differing == 0 && c->channels.outside == 0)
        return c->selection.is_part ? "equal in every pixel that counts" : "equal in every pixel";
    if (c->change.all.pixels < (double)c->selection.pixels && c->grid.most_difference == 0)
        return "light equal in every other pixel";
    if (c->grid.most_difference == 0)
        return arena_format(arena, "light equal in every pixel, other channels differ in %ld",
                            c->channels.differing);
    bool is_single = is_few(c) && c->standout.count && !c->standout.is_explained;
    if (c->has_stat && c->stat.verdict != STATISTIC_DIFFERENT && !is_single)
        text = within_noise_text(c, arena);
    else text = changed_text(c, arena);
    if (has_noise)
        text = arena_format(arena, "%s; noise not %s", text,
                            is_noise_stated(&c->reference) && is_noise_stated(&c->test) ? "tested"
                                                                                        : "stated");
    return text;
}

/* ---- the line ---------------------------------------------------------------------------- */

static const char *standout_text(const Comparison *c, const char *light, Arena *arena) {
    const Standout *s = &c->standout;
    if (!s->count || is_few(c)) return light;
    const char *pixel = headline_pixel(c, &s->most, arena);
    if (s->count > 1) pixel = arena_format(arena, "%s, and %ld more", pixel, s->count - 1);
    if (s->is_explained) return arena_format(arena, "%s; bright samples: %s", light, pixel);
    bool is_found = c->stat.verdict == STATISTIC_DIFFERENT && c->change.area.pixels == 0;
    return is_found ? pixel : arena_format(arena, "%s; the rest: %s", pixel, light);
}

static const char *contrast_text(const Comparison *c, Arena *arena) {
    const CompareRow *most = NULL;
    int count = 0;
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        if (row->table != TABLE_CONTRAST || !row->is_finding) continue;
        count++;
        if (!most || fabs(row->value) > fabs(most->value)) most = row;
    }
    if (!most || c->outcome != COMPARE_DIFFERENT) return "";
    return arena_format(arena, ". Contrast of %s %s%s", most->of, most->text,
                        count > 1 ? arena_format(arena, " and of %d more", count - 1) : "");
}

static const char *limits_text(const Comparison *c, Arena *arena) {
    Lines list = {.arena = arena};
    bool is_within = c->outcome == COMPARE_WITHIN_LIMITS;
    for (int i = 0; i < c->row_count; i++) {
        const CompareRow *row = &c->rows[i];
        if (row->table == TABLE_METRIC && row->has_limit && row->is_beyond != is_within)
            lines_add(&list, "%s %s (%s)", row->figure, row->text, row->limit_text);
    }
    if (!list.count) return "";
    return arena_format(arena, ". %s limits: %s", is_within ? "Within" : "Beyond",
                        structure_joined(&list, 2 * NAMED));
}

/* What the frames themselves state of what went in. */
static const char *causes_text(const Comparison *c, Arena *arena) {
    const Structure *s = &c->structure;
    const char *settings = "";
    if (c->outcome == COMPARE_SAME && !s->inputs.count) return "";
    if (s->settings.count)
        settings =
            arena_format(arena, ". Settings changed: %s", structure_joined(&s->settings, NAMED));
    if (!s->knows_inputs) return arena_format(arena, ". Inputs not stated%s", settings);
    if (!s->inputs.count) return arena_format(arena, ". Inputs unchanged%s", settings);
    return arena_format(arena, ". Inputs changed: %s%s", structure_joined(&s->inputs, NAMED),
                        settings);
}

static CompareOutcome outcome_of(const Comparison *c) {
    if (!c->same) return COMPARE_DIFFERENT;
    if (c->channels.differing == 0 && c->channels.outside == 0) return COMPARE_SAME;
    if (c->grid.most_difference == 0) return COMPARE_SAME_LIGHT;
    return c->judged_by == JUDGED_BY_LIMITS ? COMPARE_WITHIN_LIMITS : COMPARE_WITHIN_NOISE;
}

void headline_make(const CompareOptions *options, Arena *arena, Comparison *out) {
    const char *path = options->name ? options->name : path_name(out->test.name), *part = "";
    Lines first = {.arena = arena};
    out->outcome = outcome_of(out);
    if (out->has_pixels)
        lines_add(&first, "%s", standout_text(out, light_change(out, arena), arena));
    bool is_light = out->stat.verdict == STATISTIC_DIFFERENT || limits_text(out, arena)[0] ||
                    out->judged_by == JUDGED_BY_EQUALITY ||
                    (out->standout.count && !out->standout.is_explained);
    int named = is_light && out->has_pixels ? out->structural : out->reasons.count;
    for (int i = 0; i < named; i++) lines_add(&first, "%s", out->reasons.list[i]);
    const char *text = "";
    for (int i = 0; i < first.count && i < 3; i++)
        text = arena_format(arena, "%s%s%s", text, i ? "; " : "", first.list[i]);
    if (first.count > 3)
        text = arena_format(arena, "%s; and %d more reason%s", text, first.count - 3,
                            first.count > 4 ? "s" : "");
    if (options->selection.display)
        part = arena_format(arena, " (display %s)", options->selection.display);
    else if (out->has_pixels && out->selection.is_part) part = " (part of the picture)";
    const char *name =
        arena_printable(arena, arena_format(arena, "%s%s", headline_name(path, arena), part));
    out->verdict = arena_printable(
        arena, arena_format(arena, "%s: %s%s%s%s", name, text, contrast_text(out, arena),
                            limits_text(out, arena), causes_text(out, arena)));
    out->finding = out->verdict + strlen(name) + 2;
}
