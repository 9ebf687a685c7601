/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file_write.h"
#include "review/output/review_decide.h"
#include "text/json_text.h"

#define DIGITS 6
#define PLACES_BYTES ((size_t)1 << 26)

static json_t *pair(double low, double high)
{
    return json_pack("[o,o]", json_figure(low), json_figure(high));
}

static json_t *text(const char *string)
{
    return string ? json_text(string) : json_null();
}

/* ---- one case --------------------------------------------------------------------------- */

static json_t *limit_json(const LimitVerdict *l)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:b, s:b, s:b, s:o, s:o, s:o, s:s}", "name",
                     text(l->name), "kind", text(l->kind), "value", json_figure(l->value),
                     "unit", text(l->unit), "source", text(l->source), "read_in_the_standard",
                     l->read_in_the_standard, "upper", l->is_upper, "advice", l->is_advice,
                     "found", json_figure(l->found), "interval", pair(l->low, l->high),
                     "margin", json_figure(l->margin), "verdict", verdict_names[l->verdict]);
}

static json_t *limits_json(const ReviewCase *c)
{
    json_t *list = json_array();
    for (int i = 0; i < c->limit_count; i++)
        json_array_append_new(list, limit_json(&c->limits[i]));
    return list;
}

static json_t *causes_json(const ReviewCase *c)
{
    json_t *list = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:o, s:o}", "chain",
                            json_texts(cause->chain, cause->links), "share",
                            json_figure(cause->share), "cd_m2", json_figure(cause->cd_m2),
                            "interval", pair(cause->low, cause->high), "contrast_without",
                            json_figure(cause->contrast_without)));
    }
    return list;
}

static json_t *group_json(const CaseGroup *group)
{
    json_t *list = json_array();
    for (int i = 0; i < group->count; i++) {
        const CaseShare *share = &group->list[i];
        json_array_append_new(list, json_pack("{s:o, s:o, s:o}", "what", text(share->what),
                                              "share", json_figure(share->share), "cd_m2",
                                              json_figure(share->cd_m2)));
    }
    return list;
}

json_t *review_groups_json(const ReviewCase *c)
{
    return json_pack("{s:o, s:o, s:o}", "light", group_json(&c->groups[GROUP_LIGHT]),
                     "opening", group_json(&c->groups[GROUP_OPENING]), "surface",
                     group_json(&c->groups[GROUP_SURFACE]));
}

static json_t *remedies_json(const ReviewCase *c)
{
    json_t *list = json_array();
    for (int i = 0; i < c->remedy_count; i++) {
        const CaseRemedy *remedy = &c->remedies[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o}", "what", text(remedy->what), "contrast_ratio",
                            json_figure(remedy->contrast_ratio), "level",
                            json_figure(remedy->level)));
    }
    return list;
}

json_t *review_hiders_json(const ReviewCase *c)
{
    json_t *list = json_array();
    for (int i = 0; i < c->hider_count; i++)
        json_array_append_new(list, json_pack("{s:o, s:o}", "what", text(c->hiders[i].what),
                                              "share", json_figure(c->hiders[i].share)));
    return list;
}

static json_t *sun_json(const ReviewCase *c)
{
    if (!c->has_sun) return json_null();
    return json_pack("{s:o, s:o}", "azimuth_deg", json_figure(c->sun_azimuth_deg),
                     "elevation_deg", json_figure(c->sun_elevation_deg));
}

static json_t *luminance_json(CaseLuminances l)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "foreground",
                     json_figure(l.foreground), "background", json_figure(l.background),
                     "reflected", json_figure(l.reflected), "mirror", json_figure(l.mirror),
                     "scattered", json_figure(l.scattered), "veil", json_figure(l.veil));
}

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

static json_t *case_json(const ReviewCase *c)
{
    bool    has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    json_t *out = json_pack("{s:o, s:o, s:o, s:o, s:s, s:o, s:o}", "condition",
                            text(c->condition), "eye", text(c->eye), "symbol", text(c->symbol),
                            "display", text(c->display), "ambient", ambient_names[c->ambient],
                            "sun", sun_json(c), "luminance_cd_m2",
                            luminance_json(c->luminance_cd_m2));
    set(out, "contrast_ratio", json_figure(c->contrast_ratio));
    set(out, "contrast_interval", pair(c->contrast_low, c->contrast_high));
    set(out, "reflected_interval", pair(c->reflected_range.low, c->reflected_range.high));
    set(out, "paths", json_integer((json_int_t)c->paths));
    set(out, "precision_asked", json_figure(c->precision_asked));
    set(out, "precision_reached", json_figure(c->precision_reached));
    set(out, "paths_to_decide", json_figure(c->paths_to_decide));
    set(out, "contrast_with_veil", json_figure(c->contrast_with_veil));
    set(out, "height_arcmin", json_figure(c->height_arcmin));
    set(out, "jnd", json_figure(c->jnd));
    set(out, "visibility", json_figure(c->visibility));
    set(out, "dgp", json_figure(c->dgp));
    set(out, "ugr", json_figure(c->ugr));
    set(out, "eye_failed_share", json_figure(c->eye_failed_share));
    set(out, "visible_share", json_figure(c->visible_share));
    set(out, "hidden_by", review_hiders_json(c));
    set(out, "level", json_figure(c->level));
    set(out, "display_lux", json_figure(c->display_lux));
    set(out, "limit", has_limit ? limit_json(&c->limits[c->limit_id]) : json_null());
    set(out, "limits", limits_json(c));
    set(out, "margin", json_figure(c->margin));
    set(out, "verdict", json_string(verdict_names[c->verdict]));
    set(out, "causes", causes_json(c));
    set(out, "cause_groups", review_groups_json(c));
    set(out, "without_data_share", json_figure(c->without_data_share));
    set(out, "remedies", remedies_json(c));
    set(out, "frame", text(c->frame));
    set(out, "outlook", text(c->outlook));
    set(out, "when", text(c->when));
    return out;
}

/* ---- the review ------------------------------------------------------------------------- */

static json_t *sweeps_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *s = &review->sweeps[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:s, s:I, s:o, s:o, s:o, s:o}", "condition",
                            text(s->condition), "eye", text(s->eye), "symbol", text(s->symbol),
                            "verdict", verdict_names[sweep_verdict(s)],
                            "cases", (json_int_t)s->cases, "failed_share",
                            json_figure(s->failed_share), "longest_failure_minutes",
                            json_figure(s->longest_failure_minutes), "worst",
                            case_json(&s->worst), "table", text(s->table)));
    }
    return list;
}

static json_t *gaze_json(const GazeFinding *g)
{
    GazeVeil v = g->veil_parts;
    json_t  *out = json_pack("{s:o, s:o, s:o, s:o}", "condition", text(g->condition), "eye",
                            text(g->eye), "gaze", text(g->gaze), "sun_from_gaze_deg",
                            json_figure(g->sun_deg));
    set(out, "veil_cd_m2", json_figure(g->veil));
    set(out, "veil_interval", pair(g->veil_range.low, g->veil_range.high));
    set(out, "veil_parts_cd_m2",
        json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "sun", json_figure(v.sun), "sky",
                  json_figure(v.sky), "lamps", json_figure(v.lamps), "glints",
                  json_figure(v.glints), "surfaces", json_figure(v.surfaces), "near",
                  json_figure(v.near)));
    set(out, "cornea_lx", json_figure(g->cornea_lux));
    set(out, "through_cd_m2", json_figure(g->through));
    set(out, "mirrored_cd_m2", json_figure(g->mirrored));
    set(out, "mirrored_interval", pair(g->mirrored_range.low, g->mirrored_range.high));
    set(out, "mirrored_by", text(g->mirrored_by));
    set(out, "mirrored_from", text(g->mirrored_from));
    set(out, "contrast_behind_glass", json_figure(g->contrast_behind_glass));
    set(out, "contrast_left", json_figure(g->contrast_left));
    set(out, "contrast_interval", pair(g->contrast_range.low, g->contrast_range.high));
    set(out, "dgp", json_figure(g->dgp));
    set(out, "ugr", json_figure(g->ugr));
    return out;
}

static json_t *gazes_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->gaze_count; i++)
        json_array_append_new(list, gaze_json(&review->gazes[i]));
    return list;
}

static json_t *responses_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->response_count; i++) {
        const ReviewResponse *r = &review->responses[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:I, s:I, s:o}", "probe", text(r->probe), "file",
                            text(r->file), "paths",
                            (json_int_t)r->paths, "bytes", (json_int_t)r->bytes,
                            "relative_error", json_figure(r->relative_error)));
    }
    return list;
}

static json_t *false_suns_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->false_sun_count; i++) {
        const ReviewFalseSun *f = &review->false_suns[i];
        json_t *out = json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "condition",
                                text(f->condition), "eye", text(f->eye), "mirror",
                                text(f->mirror), "share", json_figure(f->share), "minutes",
                                json_figure(f->minutes), "longest_minutes",
                                json_figure(f->longest_minutes), "when", text(f->when));
        set(out, "sun", json_pack("{s:o, s:o}", "azimuth_deg", json_figure(f->sun_azimuth_deg),
                                  "elevation_deg", json_figure(f->sun_elevation_deg)));
        set(out, "lux", json_figure(f->lux));
        set(out, "gaze", text(f->gaze));
        set(out, "angle_deg", json_figure(f->angle_deg));
        set(out, "veil_cd_m2", json_figure(f->veil_cd_m2));
        json_array_append_new(list, out);
    }
    return list;
}

static json_t *cases_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->case_count; i++)
        json_array_append_new(list, case_json(&review->cases[i]));
    return list;
}

/* ---- variants --------------------------------------------------------------------------- */

static json_t *difference_json(const ReviewDifference *d)
{
    const ReviewCase *c = d->after;
    json_t *out = json_pack("{s:o, s:o, s:o, s:s, s:o, s:o}", "condition", text(c->condition),
                            "eye", text(c->eye), "symbol", text(c->symbol), "verdict",
                            verdict_names[c->verdict], "contrast_ratio",
                            json_figure(c->contrast_ratio), "contrast_interval",
                            pair(c->contrast_low, c->contrast_high));
    set(out, "margin", json_figure(c->margin));
    set(out, "margin_before", json_figure(d->before ? d->before->margin : (double)NAN));
    set(out, "margin_difference", json_figure(d->margin));
    set(out, "margin_difference_interval", pair(d->margin_range.low, d->margin_range.high));
    set(out, "reflected_cd_m2", json_figure(c->luminance_cd_m2.reflected));
    set(out, "level", json_figure(c->level));
    set(out, "when", text(c->when));
    set(out, "sun", sun_json(c));
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

static json_t *variants_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->variant_count; i++)
        json_array_append_new(list, variant_json(&review->variants[i]));
    return list;
}

static json_t *slope_json(const ReviewSlope *slope)
{
    const ReviewCase *c = slope->of;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "condition", text(c->condition), "eye",
                     text(c->eye), "symbol", text(c->symbol), "margin", json_figure(c->margin),
                     "margin_per_unit", json_figure(slope->slope), "interval",
                     pair(slope->range.low, slope->range.high));
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

static json_t *trials_json(const ReviewMend *mend)
{
    json_t *list = json_array();
    for (int i = 0; i < mend->trial_count; i++) {
        const ReviewTrial *t = &mend->trials[i];
        json_array_append_new(list, json_pack("{s:o, s:s, s:o, s:o, s:b}", "value",
                                              json_figure(t->value), "verdict",
                                              verdict_names[t->verdict], "least_margin",
                                              json_figure(t->margin), "of", text(t->worst),
                                              "fresh", t->is_fresh));
    }
    return list;
}

static json_t *mends_json(const Review *review)
{
    json_t *list = json_array();
    for (int i = 0; i < review->mend_count; i++) {
        const ReviewMend *m = &review->mends[i];
        json_array_append_new(
            list, json_pack("{s:o, s:o, s:o, s:b, s:o, s:o, s:o}", "name", text(m->name),
                            "unit", text(m->unit), "at", json_figure(m->at), "found",
                            m->is_found, "value", json_figure(m->value), "outside",
                            json_figure(m->outside), "trials", trials_json(m)));
    }
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
    set(out, "cases", cases_json(review));
    set(out, "sweeps", sweeps_json(review));
    set(out, "gazes", gazes_json(review));
    set(out, "false_suns", false_suns_json(review));
    if (review->variant_count) set(out, "variants", variants_json(review));
    if (review->sensitivity_count) set(out, "sensitivity", sensitivities_json(review));
    if (review->mend_count) set(out, "mends", mends_json(review));
    set(out, "eye_places", places_json(review));
    set(out, "responses", responses_json(review));
    set(out, "without_data", text(review->without_data));
    set(out, "notes", json_texts(review->notes, review->note_count));
    return out;
}

bool review_json_write(json_t *document, const char *path, Error *err)
{
    char *text = json_dumps(document, JSON_INDENT(2) | JSON_REAL_PRECISION(DIGITS));
    json_decref(document);
    if (!text) return error_set(err, ERROR_MEMORY, "out of memory for %s", path);
    size_t size = strlen(text);
    text[size] = '\n';
    bool ok = file_write(path, text, size + 1, err);
    free(text);
    return ok;
}
