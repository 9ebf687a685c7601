/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_json.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "review/output/review_members.h"
#include "review/output/review_rests.h"
#include "review/review_decide.h"
#include "text/json_text.h"

#define DIGITS 6
#define DOCUMENT_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */
#define PLACES_BYTES ((size_t)1 << 26)

/* ---- which keys hold which members ------------------------------------------------------- */

static const Member LIMIT[] = {
    OWN(TEXT, LimitVerdict, name), OWN(TEXT, LimitVerdict, kind),
    OWN(FIGURE, LimitVerdict, value), OWN(TEXT, LimitVerdict, unit),
    OWN(TEXT, LimitVerdict, source), OWN(FLAG, LimitVerdict, read_in_the_standard),
    AS("upper", FLAG, LimitVerdict, is_upper), AS("advice", FLAG, LimitVerdict, is_advice),
    OWN(FIGURE, LimitVerdict, found), AS("interval", RANGE, LimitVerdict, low),
    OWN(FIGURE, LimitVerdict, margin), OWN(VERDICT, LimitVerdict, verdict), {0}};

static const Member CAUSE[] = {
    {"chain", MEMBER_TEXTS, offsetof(CaseCause, chain), .count = offsetof(CaseCause, links)},
    OWN(FIGURE, CaseCause, share), OWN(FIGURE, CaseCause, cd_m2),
    AS("interval", RANGE, CaseCause, low), OWN(FIGURE, CaseCause, contrast_without), {0}};

static const Member SHARE[] = {OWN(TEXT, CaseShare, what), OWN(FIGURE, CaseShare, share),
                               OWN(FIGURE, CaseShare, cd_m2), {0}};

static const Member GROUPS[] = {
    LIST("light", ReviewCase, groups[GROUP_LIGHT].list, groups[GROUP_LIGHT].count, SHARE,
         CaseShare),
    LIST("opening", ReviewCase, groups[GROUP_OPENING].list, groups[GROUP_OPENING].count, SHARE,
         CaseShare),
    LIST("surface", ReviewCase, groups[GROUP_SURFACE].list, groups[GROUP_SURFACE].count, SHARE,
         CaseShare), {0}};

static const Member HIDER[] = {OWN(TEXT, CaseHider, what), OWN(FIGURE, CaseHider, share),
                               {0}};

static const Member REMEDY[] = {
    {"kind", MEMBER_WORD, offsetof(CaseRemedy, kind), .use = SINCE, .size = REMEDY_KINDS,
     .words = remedy_kinds},
    OWN(TEXT, CaseRemedy, what), OWN(FIGURE, CaseRemedy, contrast_ratio),
    OWN(FIGURE, CaseRemedy, level),
    {"then", MEMBER_OBJECT, offsetof(CaseRemedy, then), .use = SINCE, .of = LIMIT},
    LATER("verdict", VERDICT, CaseRemedy, verdict), {0}};

static const Member PANEL[] = {
    OWN(TEXT, CasePanel, verdict), OWN(TEXT, CasePanel, reason),
    AS("coarse", FLAG, CasePanel, is_coarse), AS("not_usable", FLAG, CasePanel, is_unusable),
    OWN(FIGURE, CasePanel, emission_error), OWN(FIGURE, CasePanel, reflection_error),
    LATER("spectra_assumed", TEXT, CasePanel, assumed), {0}};

static const Member LUMINANCE[] = {
    OWN(FIGURE, CaseLuminances, foreground), OWN(FIGURE, CaseLuminances, background),
    OWN(FIGURE, CaseLuminances, reflected), OWN(FIGURE, CaseLuminances, mirror),
    OWN(FIGURE, CaseLuminances, scattered), OWN(FIGURE, CaseLuminances, veil), {0}};

static const Member BOX[] = {OWN(FIGURE, CaseBox, left), OWN(FIGURE, CaseBox, top),
                             OWN(FIGURE, CaseBox, right), OWN(FIGURE, CaseBox, bottom), {0}};

static const Member MEAN[] = {
    OWN(FIGURE, CaseWhole, reflected),
    AS("reflected_interval", RANGE, CaseWhole, reflected_range),
    OWN(FIGURE, CaseWhole, contrast_ratio), {0}};

static const Member GLARE[] = {
    OWN(FIGURE, CaseGlare, threshold_cd_m2), OWN(FIGURE, CaseGlare, background_cd_m2),
    AS("sources", COUNT, CaseGlare, source_count),
    AS("sources_lx", FIGURE, CaseGlare, source_lx),
    AS("smallest_source_sr", FIGURE, CaseGlare, smallest_sr),
    AS("largest_source_sr", FIGURE, CaseGlare, largest_sr),
    AS("low_light_factor", FLAG, CaseGlare, low_light),
    AS("small_source_rule", FLAG, CaseGlare, small_sources),
    AS("no_ugr_because", TEXT, CaseGlare, none), {0}};

/* Of what has a CaseGlare. */
#define GLARE_MEMBERS(Type)                                                                    \
    AS("dgp", FIGURE, Type, glare.dgp), AS("ugr", FIGURE, Type, glare.ugr),                    \
    LATER("dgi", FIGURE, Type, glare.dgi),                                                     \
    LATER("dgp_interval", RANGE, Type, glare.dgp_range),                                       \
    LATER("ugr_interval", RANGE, Type, glare.ugr_range),                                       \
    LATER("dgi_interval", RANGE, Type, glare.dgi_range),                                       \
    {"glare", MEMBER_OBJECT, offsetof(Type, glare), .use = SINCE, .of = GLARE}

/* Of a case, and of a false sun. */
static const Member SUN[] = {{"azimuth_deg", MEMBER_FIGURE, .offset = 0},
                             {"elevation_deg", MEMBER_FIGURE, .offset = sizeof(double)}, {0}};

static const Member CASE[] = {
    OWN(TEXT, ReviewCase, condition), OWN(TEXT, ReviewCase, eye), OWN(TEXT, ReviewCase, symbol),
    OWN(TEXT, ReviewCase, display), OWN(AMBIENT, ReviewCase, ambient),
    {"sun", MEMBER_IF, offsetof(ReviewCase, sun_azimuth_deg), .of = SUN,
     .count = offsetof(ReviewCase, has_sun)},
    {"luminance_cd_m2", MEMBER_OBJECT, offsetof(ReviewCase, luminance_cd_m2), .of = LUMINANCE},
    {"symbol_mean", MEMBER_OBJECT, offsetof(ReviewCase, whole), .use = SINCE, .of = MEAN},
    LATER("lit_share", FIGURE, ReviewCase, whole.lit_share),
    {"judged_part_uv", MEMBER_OBJECT, offsetof(ReviewCase, whole.part), .use = SINCE,
     .of = BOX},
    OWN(FIGURE, ReviewCase, contrast_ratio),
    AS("contrast_interval", RANGE, ReviewCase, contrast_low),
    {"reflected_interval", MEMBER_RANGE, offsetof(ReviewCase, reflected_range), .use = SINCE},
    OWN(COUNT, ReviewCase, paths),
    {"precision_asked", MEMBER_FIGURE, offsetof(ReviewCase, precision_asked), .use = SINCE},
    {"precision_reached", MEMBER_FIGURE, offsetof(ReviewCase, precision_reached), .use = SINCE},
    {"open_by", MEMBER_OPEN, offsetof(ReviewCase, open_by), .use = SINCE},
    {"paths_to_decide", MEMBER_FIGURE, offsetof(ReviewCase, paths_to_decide), .use = SINCE},
    {"decide_times", MEMBER_FIGURE, offsetof(ReviewCase, decide_times), .use = SINCE},
    OWN(FIGURE, ReviewCase, contrast_with_veil), OWN(FIGURE, ReviewCase, height_arcmin),
    LATER("stroke_ratio", FIGURE, ReviewCase, stroke_ratio),
    OWN(FIGURE, ReviewCase, jnd), OWN(FIGURE, ReviewCase, visibility),
    GLARE_MEMBERS(ReviewCase),
    OWN(FIGURE, ReviewCase, eye_failed_share), OWN(FIGURE, ReviewCase, visible_share),
    LIST_SINCE("hidden_by", ReviewCase, hiders, hider_count, HIDER, CaseHider),
    OWN(FIGURE, ReviewCase, level), OWN(FIGURE, ReviewCase, display_lux),
    {"glasses_transmittance", MEMBER_FIGURE, offsetof(ReviewCase, glasses_transmittance),
     .use = SINCE},
    LATER("glasses", TEXT, ReviewCase, glasses),
    LATER("glasses_display_loss", FIGURE, ReviewCase, glasses_display_loss),
    {"limit", MEMBER_LIMIT, .of = LIMIT},
    LIST("limits", ReviewCase, limits, limit_count, LIMIT, LimitVerdict),
    {"judged", MEMBER_JUDGED, .use = WRITTEN, .of = LIMIT},
    OWN(FIGURE, ReviewCase, margin), OWN(VERDICT, ReviewCase, verdict),
    LATER("reason", REASON, ReviewCase, unjudged),
    LATER("optional", FLAG, ReviewCase, is_optional),
    {"panel", MEMBER_OBJECT, offsetof(ReviewCase, panel), .use = SINCE, .of = PANEL},
    LIST("causes", ReviewCase, causes, cause_count, CAUSE, CaseCause),
    {"cause_groups", MEMBER_OBJECT, .use = WRITTEN, .of = GROUPS},
    LATER("without_data_share", FIGURE, ReviewCase, without_data_share),
    LATER("guessed_share", FIGURE, ReviewCase, guessed_share),
    LATER("extrapolated_share", FIGURE, ReviewCase, extrapolated_share),
    LATER("empty_seat", TEXT, ReviewCase, empty_seat),
    LATER("empty_seat_share", FIGURE, ReviewCase, empty_seat_share),
    LIST("remedies", ReviewCase, remedies, remedy_count, REMEDY, CaseRemedy),
    OWN(TEXT, ReviewCase, frame), OWN(TEXT, ReviewCase, outlook), OWN(TEXT, ReviewCase, when),
    {0}};

#define FOLLOWS(Type, second, first)                                                           \
    _Static_assert(offsetof(Type, second) == offsetof(Type, first) + sizeof(double), "a pair")
FOLLOWS(ReviewCase, contrast_high, contrast_low);
FOLLOWS(ReviewCase, sun_elevation_deg, sun_azimuth_deg);
FOLLOWS(ReviewFalseSun, sun_elevation_deg, sun_azimuth_deg);
FOLLOWS(LimitVerdict, high, low);
FOLLOWS(CaseCause, high, low);

static const Member SWEEP[] = {
    OWN(TEXT, ReviewSweep, condition), OWN(TEXT, ReviewSweep, eye),
    OWN(TEXT, ReviewSweep, symbol),
    {"verdict", MEMBER_VERDICT, offsetof(ReviewSweep, worst.verdict), .use = WRITTEN},
    OWN(COUNT, ReviewSweep, cases), OWN(FIGURE, ReviewSweep, failed_share),
    OWN(FIGURE, ReviewSweep, longest_failure_minutes),
    LATER("middle_eye_contrast_ratio", FIGURE, ReviewSweep, middle_contrast),
    {"worst", MEMBER_OBJECT, offsetof(ReviewSweep, worst), .of = CASE},
    OWN(TEXT, ReviewSweep, table), {0}};

static const Member VEIL[] = {OWN(FIGURE, GazeVeil, sun), OWN(FIGURE, GazeVeil, sky),
                              OWN(FIGURE, GazeVeil, lamps), OWN(FIGURE, GazeVeil, glints),
                              OWN(FIGURE, GazeVeil, surfaces), OWN(FIGURE, GazeVeil, near),
                              {0}};

static const Member GAZE[] = {
    OWN(TEXT, GazeFinding, condition), OWN(TEXT, GazeFinding, eye),
    OWN(TEXT, GazeFinding, gaze), AS("sun_from_gaze_deg", FIGURE, GazeFinding, sun_deg),
    AS("veil_cd_m2", FIGURE, GazeFinding, veil),
    AS("veil_interval", RANGE, GazeFinding, veil_range),
    {"veil_parts_cd_m2", MEMBER_OBJECT, offsetof(GazeFinding, veil_parts), .of = VEIL},
    AS("cornea_lx", FIGURE, GazeFinding, cornea_lux),
    AS("through_cd_m2", FIGURE, GazeFinding, through),
    AS("mirrored_cd_m2", FIGURE, GazeFinding, mirrored),
    AS("mirrored_interval", RANGE, GazeFinding, mirrored_range),
    OWN(TEXT, GazeFinding, mirrored_by), OWN(TEXT, GazeFinding, mirrored_from),
    OWN(FIGURE, GazeFinding, contrast_behind_glass), OWN(FIGURE, GazeFinding, contrast_left),
    AS("contrast_interval", RANGE, GazeFinding, contrast_range),
    GLARE_MEMBERS(GazeFinding), {0}};

static const Member RESPONSE[] = {
    OWN(TEXT, ReviewResponse, probe), OWN(TEXT, ReviewResponse, file),
    OWN(COUNT, ReviewResponse, paths), OWN(COUNT, ReviewResponse, bytes),
    OWN(FIGURE, ReviewResponse, relative_error), {0}};

static const Member FALSE_SUN[] = {
    OWN(TEXT, ReviewFalseSun, condition), OWN(TEXT, ReviewFalseSun, eye),
    OWN(TEXT, ReviewFalseSun, mirror), OWN(FIGURE, ReviewFalseSun, share),
    OWN(FIGURE, ReviewFalseSun, minutes), OWN(FIGURE, ReviewFalseSun, longest_minutes),
    OWN(TEXT, ReviewFalseSun, when),
    {"sun", MEMBER_OBJECT, offsetof(ReviewFalseSun, sun_azimuth_deg), .of = SUN},
    OWN(FIGURE, ReviewFalseSun, lux), OWN(TEXT, ReviewFalseSun, gaze),
    OWN(FIGURE, ReviewFalseSun, angle_deg), OWN(FIGURE, ReviewFalseSun, veil_cd_m2), {0}};

static const Member REST[] = {
    {"kind", MEMBER_WORD, offsetof(ReviewRest, kind), .size = REST_KINDS, .words = rest_kinds},
    {"basis", MEMBER_WORD, offsetof(ReviewRest, basis), .size = REST_BASES,
     .words = rest_bases},
    OWN(TEXT, ReviewRest, name), OWN(TEXT, ReviewRest, words), OWN(COUNT, ReviewRest, count),
    OWN(COUNT, ReviewRest, of), {0}};

static const Member FILES[] = {OWN(TEXT, ReviewFile, path), OWN(TEXT, ReviewFile, xxh3), {0}};

static const Member TRIAL[] = {
    OWN(FIGURE, ReviewTrial, value), OWN(VERDICT, ReviewTrial, verdict),
    AS("least_margin", FIGURE, ReviewTrial, margin), AS("of", TEXT, ReviewTrial, worst),
    AS("fresh", FLAG, ReviewTrial, is_fresh), {0}};

static const Member MEND[] = {
    OWN(TEXT, ReviewMend, name), OWN(TEXT, ReviewMend, unit), OWN(FIGURE, ReviewMend, at),
    AS("found", FLAG, ReviewMend, is_found), OWN(FIGURE, ReviewMend, value),
    OWN(FIGURE, ReviewMend, outside),
    LIST("trials", ReviewMend, trials, trial_count, TRIAL, ReviewTrial), {0}};

const Member review_members[] = {
    OWN(FLAG, Review, pass), AS("strict", FLAG, Review, is_strict), OWN(TEXT, Review, title),
    OWN(TEXT, Review, profile), LIST("cases", Review, cases, case_count, CASE, ReviewCase),
    LIST("sweeps", Review, sweeps, sweep_count, SWEEP, ReviewSweep),
    LIST("gazes", Review, gazes, gaze_count, GAZE, GazeFinding),
    LIST("responses", Review, responses, response_count, RESPONSE, ReviewResponse),
    LIST("false_suns", Review, false_suns, false_sun_count, FALSE_SUN, ReviewFalseSun),
    {"notes", MEMBER_TEXTS, offsetof(Review, notes), .count = offsetof(Review, note_count)},
    LIST_SINCE("rests_on", Review, rests_on, rests_on_count, REST, ReviewRest),
    LIST_SINCE("inputs", Review, inputs, input_count, FILES, ReviewFile), {0}};

/* ---- writing ----------------------------------------------------------------------------- */

static json_t *pair(double low, double high)
{
    return json_pack("[o,o]", json_figure(low), json_figure(high));
}

static json_t *text(const char *string)
{
    return string ? json_text(string) : json_null();
}

static json_t *object_json(const Member *table, const void *item);

static json_t *list_json(const Member *table, size_t size, const void *items, int count)
{
    json_t     *list = json_array();
    const char *item = items;
    for (int i = 0; i < count; i++, item += size)
        json_array_append_new(list, object_json(table, item));
    return list;
}

static json_t *limit_json(const ReviewCase *c)
{
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    return has_limit ? object_json(LIMIT, &c->limits[c->limit_id]) : json_null();
}

static json_t *judged_json(const ReviewCase *c)
{
    const LimitVerdict *limit = case_worst_limit(c);
    return limit ? object_json(LIMIT, limit) : json_null();
}

/* Pointers of any kind are copied as what they are to. */
static json_t *member_json(const Member *member, const void *item)
{
    const void   *at = (const char *)item + member->offset, *pointer;
    const void   *count = (const char *)item + member->count;
    const double *figure = at;
    memcpy(&pointer, at, sizeof pointer);
    switch (member->kind) {
    case MEMBER_FIGURE: return json_figure(*figure);
    case MEMBER_TEXT: return text(pointer);
    case MEMBER_RANGE: return pair(figure[0], figure[1]);
    case MEMBER_FLAG: return json_boolean(*(const bool *)at);
    case MEMBER_COUNT: return json_integer(*(const long *)at);
    case MEMBER_JUDGED: return judged_json(item);
    case MEMBER_REASON: return text(unjudged_names[*(const Unjudged *)at]);
    case MEMBER_OPEN: return text(open_names[*(const OpenBy *)at]);
    case MEMBER_VERDICT: return json_string(verdict_names[*(const Verdict *)at]);
    case MEMBER_AMBIENT: return json_string(ambient_names[*(const Ambient *)at]);
    case MEMBER_WORD: return json_string(member->words[*(const int *)at]);
    case MEMBER_IF: return *(const bool *)count ? object_json(member->of, at) : json_null();
    case MEMBER_OBJECT: return object_json(member->of, at);
    case MEMBER_TEXTS: return json_texts(pointer, *(const int *)count);
    case MEMBER_LIST: return list_json(member->of, member->size, pointer, *(const int *)count);
    default: return limit_json(item);
    }
}

static json_t *object_json(const Member *table, const void *item)
{
    json_t *object = json_object();
    for (const Member *member = table; member->key; member++)
        json_object_set_new(object, member->key, member_json(member, item));
    return object;
}

#define LIST_OF(table, items, count) list_json(table, sizeof *(items), items, count)

json_t *review_groups_json(const ReviewCase *c)
{
    return object_json(GROUPS, c);
}

json_t *review_remedies_json(const ReviewCase *c)
{
    return LIST_OF(REMEDY, c->remedies, c->remedy_count);
}

json_t *review_hiders_json(const ReviewCase *c)
{
    return LIST_OF(HIDER, c->hiders, c->hider_count);
}

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

/* Some of a case's; NULL behind the last. */
static void set_members(json_t *object, const ReviewCase *c, const char *const *keys)
{
    for (; *keys; keys++)
        for (const Member *member = CASE; member->key; member++)
            if (!strcmp(member->key, *keys)) set(object, *keys, member_json(member, c));
}

void review_whole_json(const ReviewCase *c, json_t *to)
{
    static const char *const KEYS[] = {"symbol_mean", "lit_share", "judged_part_uv", NULL};
    if (c->symbol) set_members(to, c, KEYS);
}

/* ---- variants ---------------------------------------------------------------------------- */

static json_t *difference_json(const ReviewDifference *d)
{
    static const char *const FIRST[] = {"condition", "eye", "symbol", "verdict",
                                        "contrast_ratio", "contrast_interval", "margin", NULL};
    static const char *const LAST[] = {"level", "when", "sun", NULL};
    json_t *out = json_object();
    set_members(out, d->after, FIRST);
    set(out, "margin_before", json_figure(d->before ? d->before->margin : (double)NAN));
    set(out, "margin_difference", json_figure(d->margin));
    set(out, "margin_difference_interval", pair(d->margin_range.low, d->margin_range.high));
    set(out, "reflected_cd_m2", json_figure(d->after->luminance_cd_m2.reflected));
    set_members(out, d->after, LAST);
    if (!d->sweep_after) return out;
    const ReviewSweep *before = d->sweep_before;
    set(out, "failed_share", json_figure(d->sweep_after->failed_share));
    set(out, "failed_share_before", json_figure(before ? before->failed_share : (double)NAN));
    set(out, "longest_failure_minutes",
        json_figure(d->sweep_after->longest_failure_minutes));
    return out;
}

static json_t *variant_json(const ReviewVariantFound *v)
{
    json_t *out = json_pack("{s:o, s:o, s:b, s:s}", "name", text(v->name), "changes",
                            json_texts(v->words, v->word_count), "pass", v->review->pass,
                            "verdict", verdict_names[review_verdict(v->review)]);
    json_t *cases = json_array(), *sweeps = json_array();
    set(out, "worst", v->worst.after ? difference_json(&v->worst) : json_null());
    for (int i = 0; i < v->difference_count; i++)
        json_array_append_new(v->differences[i].sweep_after ? sweeps : cases,
                              difference_json(&v->differences[i]));
    set(out, "cases", cases);
    set(out, "sweeps", sweeps);
    if (v->frame)
        set(out, "frames", json_pack("{s:o, s:o}", "before", text(v->frame_before), "after",
                                     text(v->frame)));
    return out;
}

static json_t *slope_json(const ReviewSlope *slope)
{
    static const char *const KEYS[] = {"condition", "eye", "symbol", "margin", NULL};
    json_t *out = json_object();
    set_members(out, slope->of, KEYS);
    set(out, "margin_per_unit", json_figure(slope->slope));
    set(out, "interval", pair(slope->range.low, slope->range.high));
    return out;
}

static json_t *sensitivities_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->sensitivity_count; i++) {
        const ReviewSensitivity *s = &review->sensitivities[i];
        json_t *slopes = json_array();
        for (int k = 0; k < s->slope_count; k++)
            json_array_append_new(slopes, slope_json(&s->slopes[k]));
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "name", text(s->name), "unit",
                            text(s->unit), "at", json_figure(s->at), "step",
                            json_figure(s->step), "compared", pair(s->low, s->high), "symbols",
                            slopes));
    }
    return list;
}

/* What the displays' panels say of themselves. */
static json_t *panels_json(const Review *review)
{
    Arena   scratch = arena_reserve(PLACES_BYTES);
    int     count;
    json_t *list = json_array();
    const ReviewCase **displays = review_displays(review, &count, &scratch);
    for (int i = 0; i < count; i++) {
        json_t *panel = object_json(PANEL, &displays[i]->panel);
        set(panel, "display", text(displays[i]->display));
        json_array_append_new(list, panel);
    }
    arena_release(&scratch);
    return list;
}

static json_t *places_json(const Review *review)
{
    Arena         scratch = arena_reserve(PLACES_BYTES);
    int           count;
    ReviewPlaces *places = review_places(review, &count, &scratch);
    json_t       *list = json_array();
    for (int i = 0; i < count; i++)
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:f, s:o}", "eye", text(places[i].at->eye), "symbol",
                            text(places[i].at->symbol), "read_share", places[i].read_share,
                            "condition", text(places[i].at->condition)));
    arena_release(&scratch);
    return list;
}

static json_t *rests_line(const Review *review)
{
    Arena   scratch = arena_reserve(PLACES_BYTES);
    json_t *line = text(review_rests_words(review, &scratch));
    arena_release(&scratch);
    return line;
}

json_t *review_json(const Review *review)
{
    bool        is_open = review->is_partial && review->pass;
    const char *verdict =
        is_open ? "provisional" : verdict_names[review_verdict(review)];
    json_t *out = json_pack("{s:b, s:s, s:b, s:o, s:o}", "pass", review->pass && !is_open,
                            "verdict", verdict, "strict", review->is_strict, "title",
                            text(review->title), "profile",
                            text(review->profile));
    if (review->is_partial) set(out, "provisional", json_true());
    if (review->to_come) set(out, "to_come", text(review->to_come));
    set(out, "cases", LIST_OF(CASE, review->cases, review->case_count));
    set(out, "sweeps", LIST_OF(SWEEP, review->sweeps, review->sweep_count));
    set(out, "gazes", LIST_OF(GAZE, review->gazes, review->gaze_count));
    set(out, "false_suns",
        LIST_OF(FALSE_SUN, review->false_suns, review->false_sun_count));
    json_t *variants = review->variant_count ? json_array() : NULL;
    for (int i = 0; i < review->variant_count; i++)
        json_array_append_new(variants, variant_json(&review->variants[i]));
    if (variants) set(out, "variants", variants);
    if (review->sensitivity_count) set(out, "sensitivity", sensitivities_json(review));
    if (review->mend_count)
        set(out, "mends", LIST_OF(MEND, review->mends, review->mend_count));
    set(out, "eye_places", places_json(review));
    set(out, "panels", panels_json(review));
    set(out, "responses", LIST_OF(RESPONSE, review->responses, review->response_count));
    set(out, "without_data", text(review->without_data));
    set(out, "without_data_share_most", json_real(UNJUDGED_DATA_SHARE));
    set(out, "rests_on", LIST_OF(REST, review->rests_on, review->rests_on_count));
    set(out, "rests_on_line", rests_line(review));
    set(out, "inputs", LIST_OF(FILES, review->inputs, review->input_count));
    set(out, "notes", json_texts(review->notes, review->note_count));
    return out;
}

bool review_json_write(json_t *document, const char *path, Error *err)
{
    Arena arena = arena_reserve(DOCUMENT_BYTES);
    Text  text = {.arena = &arena};
    bool  ok = json_dump_text(&text, document, JSON_INDENT(2) | JSON_REAL_PRECISION(DIGITS)) ||
              error_set(err, ERROR_MEMORY, "out of memory for %s", path);
    json_decref(document);
    text_add(&text, "\n");
    ok = ok && text_write(&text, path, err);
    arena_release(&arena);
    return ok;
}
