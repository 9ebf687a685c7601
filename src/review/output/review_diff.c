/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_diff.h"

#include <math.h>

#include "review/output/review_words.h"
#include "review/private_image.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "text/json_text.h"

const char *const diff_names[DIFF_COUNT] = {"broken", "mended", "worse", "better",
                                            "gone",   "new",    "same"};

#define LEAST_SHARE 0.0005 /* of time: below it a sweep counts as the same */

/* ---- the rows of one review -------------------------------------------------------------- */

static LimitVerdict line_of(LimitKind kind, double found, double low, double high) {
    return (LimitVerdict){.kind = limit_kind_names[kind],
                          .unit = quantities[kind]->unit,
                          .value = (double)NAN,
                          .found = found,
                          .low = low,
                          .high = high,
                          .margin = (double)NAN,
                          .is_upper = quantities[kind]->is_upper};
}

static void add_case_lines(const ReviewCase *c, LimitVerdict *out, int *count, Arena *arena) {
    LimitVerdict line =
        line_of(LIMIT_CONTRAST_RATIO, c->contrast_ratio, c->contrast_low, c->contrast_high);
    line.is_upper = c->must_not_be_read;
    out[(*count)++] = line;
    for (int i = 0; i < c->image_count; i++) {
        const CaseImage *image = &c->images[i];
        line.found = image->contrast_ratio;
        line.low = image->contrast_low;
        line.high = image->contrast_high;
        line.by_pane = image->pane;
        out[(*count)++] = line;
    }
    for (int i = 0; i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        line = line_of(LIMIT_VISIBILITY_LEVEL, v->level, v->low, v->high);
        line.name = arena_format(arena, "in a glance of %g s", v->glance_s);
        line.age_years = v->age_years;
        out[(*count)++] = line;
    }
}

/* What no limit applies to comes first, then all lines that are held against one. */
static void set_lines(Finding *f, Arena *arena) {
    int most = f->limit_count + 1, count = 0;
    const GazeRoad *road = f->gaze ? f->gaze->road : NULL;
    if (f->c) most += f->c->image_count + f->c->visibility_count;
    if (road) most += road->age_count;
    LimitVerdict *lines = ARENA_NEW(arena, LimitVerdict, most);
    if (f->c) add_case_lines(f->c, lines, &count, arena);
    if (f->gaze)
        lines[count++] = line_of(LIMIT_GAZE_CONTRAST, f->gaze->contrast_left,
                                 f->gaze->contrast_range.low, f->gaze->contrast_range.high);
    for (int i = 0; road && !road_has_limit(road) && i < road->age_count; i++) {
        const RoadAge *age = &road->ages[i];
        lines[count] = line_of(LIMIT_THRESHOLD_INCREMENT, age->increment_pct,
                               age->increment_range.low, age->increment_range.high);
        lines[count++].age_years = age->age_years;
    }
    for (int i = 0; i < f->limit_count; i++) lines[count++] = f->limits[i];
    f->limits = lines;
    f->limit_count = count;
}

/* Gazes without a limit, too. */
static Findings rows_of(const Review *review, Arena *arena) {
    Findings judged = review_findings(review, arena);
    Findings out = {ARENA_NEW(arena, Finding, judged.count + review->gaze_count), 0};
    for (int i = 0; i < judged.count; i++) out.list[out.count++] = judged.list[i];
    for (int i = 0; i < review->gaze_count; i++) {
        const GazeFinding *g = &review->gazes[i];
        Finding f = {.condition = g->condition, .viewer = g->eye, .subject = g->gaze, .gaze = g};
        if (!finding_like(&judged, &f)) out.list[out.count++] = f;
    }
    for (int i = 0; i < out.count; i++) set_lines(&out.list[i], arena);
    return out;
}

/* ---- what changed ------------------------------------------------------------------------ */

/* Nothing is worse than a symbol that has come to be hidden. */
static int badness(Verdict verdict) {
    static const int BADNESS[4] = {
        [VERDICT_PASS] = 0, [VERDICT_TOO_CLOSE] = 1, [VERDICT_FAIL] = 2, [VERDICT_UNJUDGED] = 3};
    return BADNESS[verdict];
}

/* A figure moved only where the intervals do not touch: two runs of one design differ by their
 * noise. */
static DiffKind line_change(const LimitVerdict *before, const LimitVerdict *after) {
    if (after->high < before->low) return after->is_upper ? DIFF_BETTER : DIFF_WORSE;
    if (after->low > before->high) return after->is_upper ? DIFF_WORSE : DIFF_BETTER;
    return DIFF_SAME;
}

static FindingDiff compared(const Finding *b, const Finding *a) {
    FindingDiff out = {DIFF_SAME, b, a, {b ? b->worst : NULL, a ? a->worst : NULL}};
    int more = b && a ? badness(a->verdict) - badness(b->verdict) : 0;
    if (!a || !b) out.kind = a ? DIFF_NEW : DIFF_GONE;
    else if (more) out.kind = more > 0 ? DIFF_BROKEN : DIFF_MENDED;
    else if (a->sweep) {
        double longer = a->sweep->failed_share - b->sweep->failed_share;
        if (fabs(longer) > LEAST_SHARE) out.kind = longer > 0 ? DIFF_WORSE : DIFF_BETTER;
    } else
        for (int i = 0; i < a->limit_count && out.kind == DIFF_SAME; i++) {
            const LimitVerdict *like = finding_line_like(b, &a->limits[i]);
            out.kind = like ? line_change(like, &a->limits[i]) : DIFF_SAME;
            if (out.kind == DIFF_SAME) continue;
            out.line[0] = like;
            out.line[1] = &a->limits[i];
        }
    return out;
}

ReviewDiff review_diff(const Review *before, const Review *after, const char *before_name,
                       const char *after_name, Arena *arena) {
    ReviewDiff diff = {
        .before_name = before_name, .after_name = after_name, .before = before, .after = after};
    Findings *b = ARENA_NEW(arena, Findings, 1), *a = ARENA_NEW(arena, Findings, 1);
    *b = rows_of(before, arena);
    *a = rows_of(after, arena);
    FindingDiff *list = ARENA_NEW(arena, FindingDiff, b->count + a->count);
    int count = 0;
    for (int i = 0; i < a->count; i++)
        list[count++] = compared(finding_like(b, &a->list[i]), &a->list[i]);
    for (int i = 0; i < b->count; i++)
        if (!finding_like(a, &b->list[i])) list[count++] = compared(&b->list[i], NULL);
    diff.list = ARENA_NEW(arena, FindingDiff, count);
    for (int kind = 0; kind < DIFF_COUNT; kind++)
        for (int i = 0; i < count; i++)
            if ((int)list[i].kind == kind) {
                diff.list[diff.list_count++] = list[i];
                diff.count[kind]++;
            }
    return diff;
}

/* ---- of a variant ------------------------------------------------------------------------ */

const FindingDiff *review_diff_beside(const Review *review, const Review *variant, int *count,
                                      Arena *arena) {
    ReviewDiff diff = review_diff(review, variant, NULL, NULL, arena);
    *count = 0;
    for (int i = 0; i < diff.list_count; i++)
        if (diff.list[i].after && !diff.list[i].after->c) diff.list[(*count)++] = diff.list[i];
    return diff.list;
}

const char *review_diff_words(const FindingDiff *d, Arena *arena) {
    const Finding *a = d->after, *b = d->before;
    const LimitVerdict *after = d->line[1] ? d->line[1] : &a->limits[a->limit_count - 1];
    const LimitVerdict *before = b ? finding_line_like(b, after) : NULL;
    const char *name = words_named(a->subject, a->viewer, a->condition, arena);
    const char *was = before ? words_quantity(before, arena) : "–";
    const char *verdicts =
        !a->counts ? ""
                   : arena_format(arena, ", %s → %s", b ? verdict_names[b->verdict] : "–",
                                  verdict_names[a->verdict]);
    return arena_format(arena, "%s: %s → %s%s", name, was, words_found(after, arena), verdicts);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static json_t *two(double before, double after) {
    return json_pack("[o,o]", json_figure(before), json_figure(after));
}

static json_t *line_json(const LimitVerdict *b, const LimitVerdict *a) {
    static const LimitVerdict NONE = {.found = NAN, .low = NAN, .high = NAN, .margin = NAN};
    const LimitVerdict *either = a ? a : b;
    if (!b) b = &NONE;
    if (!a) a = &NONE;
    json_t *out = json_pack("{s:s?, s:o, s:[o,o], s:o}", "quantity", either->kind, "found",
                            two(b->found, a->found), "interval", two(b->low, b->high),
                            two(a->low, a->high), "margin", two(b->margin, a->margin));
    if (either->name) json_object_set_new(out, "limit", json_text(either->name));
    if (either->age_years > 0) json_object_set_new(out, "age_years", json_real(either->age_years));
    if (either->by_pane) json_object_set_new(out, "pane", json_text(either->by_pane));
    return out;
}

json_t *finding_diff_json(const FindingDiff *d) {
    const Finding *b = d->before, *a = d->after, *either = a ? a : b;
    json_t *lines = json_array();
    for (int i = 0; i < either->limit_count; i++) {
        const LimitVerdict *line = &either->limits[i];
        const LimitVerdict *other = a && b ? finding_line_like(b, line) : NULL;
        json_array_append_new(lines, a ? line_json(other, line) : line_json(line, NULL));
    }
    json_t *out = json_pack("{s:o, s:o, s:o, s:s, s:[s?,s?], s:o}", "condition",
                            json_text(either->condition ? either->condition : ""), "eye",
                            json_text(either->viewer ? either->viewer : ""), "subject",
                            json_text(either->subject ? either->subject : ""), "change",
                            diff_names[d->kind], "verdict", b ? verdict_names[b->verdict] : NULL,
                            a ? verdict_names[a->verdict] : NULL, "lines", lines);
    if (!either->sweep) return out;
    const ReviewSweep *bs = b ? b->sweep : NULL, *as = a ? a->sweep : NULL;
    json_object_set_new(out, "failed_share",
                        two(bs ? bs->failed_share : NAN, as ? as->failed_share : NAN));
    json_object_set_new(
        out, "longest_failure_minutes",
        two(bs ? bs->longest_failure_minutes : NAN, as ? as->longest_failure_minutes : NAN));
    return out;
}

json_t *review_diff_json(const ReviewDiff *diff) {
    json_t *list = json_array(), *count = json_object();
    for (int i = 0; i < diff->list_count; i++)
        json_array_append_new(list, finding_diff_json(&diff->list[i]));
    for (int kind = 0; kind < DIFF_COUNT; kind++)
        json_object_set_new(count, diff_names[kind], json_integer(diff->count[kind]));
    return json_pack("{s:o, s:o, s:[b,b], s:o, s:o}", "before", json_text(diff->before_name),
                     "after", json_text(diff->after_name), "pass", diff->before->pass,
                     diff->after->pass, "count", count, "findings", list);
}
