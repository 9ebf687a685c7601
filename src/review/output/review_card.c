/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_card.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/plain/plain_png.h"
#include "page/page.h"
#include "review/output/review_bar.h"
#include "review/output/review_link.h"
#include "review/output/review_rays.h"
#include "review/output/review_words.h"
#include "review/quantity.h"
#include "review/review_decide.h"
#include "text/text.h"

#define FIRST_CAUSES 4
#define PICTURE_BYTES_MAX ((size_t)64 << 20)

/* ---- limits ------------------------------------------------------------------------------ */

static void set_limit(json_t *to, const LimitVerdict *limit, Arena *arena)
{
    if (!limit) return;
    values_set_verdict(to, limit->verdict);
    page_set(to, "found", isnan(limit->found) ? NULL : words_found(limit, arena));
    page_set(to, "range", words_interval(limit->low, limit->high, arena));
    page_set(to, "sign", limit->is_upper ? "≤" : "≥");
    page_set(to, "value", words_limit(limit, arena));
    page_set(to, "required", words_required(limit, arena));
    page_set(to, "margin", words_margin(limit->margin, arena));
    page_set_flag(to, "has_margin", !isnan(limit->margin));
    page_set(to, "bar", review_bar_margin(limit, arena));
}

/* Limits without a figure are named behind the table. */
static void set_limits(json_t *to, const ReviewCase *c, Arena *arena)
{
    Text missing = {.arena = arena};
    int  missing_count = 0;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        set_limit(json_array_get(json_object_get(to, "limits"), (size_t)i), limit, arena);
        if (!isnan(limit->found)) continue;
        text_format(&missing, "%s%s", missing_count++ ? "; " : "", limit->name);
    }
    page_set(to, "missing", missing.data);
    page_set_flag(to, "has_found", missing_count < c->limit_count);
    set_limit(json_object_get(to, "judged"), case_worst_limit(c), arena);
    json_object_set(to, "held", c->unjudged ? json_null() : json_object_get(to, "judged"));
}

/* ---- causes and remedies ----------------------------------------------------------------- */

static void set_cause(json_t *to, const char *card, const ReviewCase *c, int i, Arena *arena)
{
    const CaseCause *cause = &c->causes[i];
    double           low = cause->low, high = cause->high, without = cause->contrast_without;
    page_set(to, "rays", review_rays_has(c, i) ? review_rays_id(card, i, arena) : NULL);
    page_set(to, "chain", words_chain(cause, arena));
    page_set(to, "percent", review_bar_percent(cause->share, arena));
    page_set(to, "cd_m2", words_within(cause->cd_m2, low, high, arena));
    page_set(to, "low", words_within(low, low, high, arena));
    page_set(to, "high", words_within(high, low, high, arena));
    page_set(to, "without", isnan(without) ? NULL : words_ratio_as(c, without, arena));
}

/* The light by where it began, came in and shines from: each adds up to all of it. */
static void set_groups(json_t *to, const ReviewCase *c, Arena *arena)
{
    static const char *const NAMES[CAUSE_GROUPS] = {"light", "opening", "surface"};
    for (int g = 0; g < CAUSE_GROUPS; g++) {
        Text text = {.arena = arena};
        for (int i = 0; i < c->groups[g].count; i++)
            text_format(&text, "%s%s %s", i ? " · " : "",
                        words_share(c->groups[g].list[i].share, arena),
                        c->groups[g].list[i].what);
        page_set(to, NAMES[g], text.data);
    }
}

static void set_causes(json_t *to, const ReviewCase *c, Arena *arena)
{
    json_t *causes = json_object_get(to, "causes"), *more = values_list(to, "more_causes");
    int     first = c->cause_count > FIRST_CAUSES + 1 ? FIRST_CAUSES : c->cause_count;
    double  left = 1;
    const char *card = json_string_value(json_object_get(to, "id"));
    for (int i = 0; i < c->cause_count; i++) {
        set_cause(json_array_get(causes, (size_t)i), card, c, i, arena);
        left -= c->causes[i].share;
    }
    for (int i = first; i < c->cause_count; i++) {
        json_array_append(more, json_array_get(causes, (size_t)first));
        json_array_remove(causes, (size_t)first);
    }
    page_set_flag(to, "has_causes", c->cause_count > 0);
    page_set_count(to, "more_cause_count", c->cause_count - first);
    json_object_set_new(to, "other_ways", left >= 0.001 ? json_real(left) : json_null());
    page_set(to, "seat", words_empty_seat(c, arena));
    set_groups(values_object(to, "groups"), c, arena);
}

static void set_remedies(json_t *to, const ReviewCase *c, Arena *arena)
{
    page_set_flag(to, "has_remedies", c->remedy_count > 0);
    for (int i = 0; i < c->remedy_count; i++) {
        const CaseRemedy *r = &c->remedies[i];
        json_t *remedy = json_array_get(json_object_get(to, "remedies"), (size_t)i);
        bool    is_told = !isnan(r->level) && r->level != c->level;
        page_set(remedy, "result", words_remedy(r, arena));
        json_object_set_new(remedy, "brightness", is_told ? json_real(r->level) : json_null());
    }
}

/* ---- figures ----------------------------------------------------------------------------- */

/* Of a case that another limit decides: its contrast, too; NULL: it is decided by that. */
static const char *other_contrast(const ReviewCase *c, Arena *arena)
{
    const LimitVerdict *limit = case_worst_limit(c);
    LimitKind           kind = limit ? limit_kind_named(limit->kind) : LIMIT_KIND_COUNT;
    bool is_contrast = !limit || (kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast);
    if (c->unjudged || is_contrast || isnan(c->contrast_ratio)) return NULL;
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    const LimitVerdict *of = has_limit ? &c->limits[c->limit_id] : NULL;
    return of ? arena_format(arena, "%s %s", words_kind(of), words_found(of, arena))
              : arena_format(arena, "contrast %s", words_contrast(c, arena));
}

static void set_contrast(json_t *to, const ReviewCase *c, Arena *arena)
{
    double low = c->contrast_low, high = c->contrast_high;
    page_set(to, "contrast", isnan(c->contrast_ratio) ? NULL : words_contrast(c, arena));
    page_set(to, "contrast_from", words_within(low, low, high, arena));
    page_set(to, "contrast_to", words_within(high, low, high, arena));
    if (isinf(c->contrast_with_veil)) /* which no number of JSON is */
        page_set(to, "contrast_with_veil", words_figure(c->contrast_with_veil, arena));
    page_set(to, "whole", words_whole(c, arena));
    page_set(to, "other_contrast", other_contrast(c, arena));
}

/* Figures made for rooms. */
static void set_glare(json_t *to, const CaseGlare *g, Arena *arena)
{
    json_t *words = g->threshold_cd_m2 > 0 ? values_object(to, "glare_words") : NULL;
    if (!words) return;
    page_set(words, "dgp", words_glare(g->dgp, g->dgp_range, g->none, arena));
    page_set(words, "ugr", words_glare(g->ugr, g->ugr_range, g->none, arena));
    page_set(words, "dgi", words_glare(g->dgi, g->dgi_range, g->none, arena));
    page_set(words, "settings", words_glare_settings(g, arena));
}

const char *const *values_directions(const PageValues *v, const ReviewCase *c)
{
    if (!review_sweep_of(v->review, c)) return words_directions(false);
    for (int i = 0; i < v->page->map_count; i++)
        if (c == &v->page->maps[i].of->worst)
            return words_directions(v->page->maps[i].is_of_vehicle);
    return NULL;
}

/* ---- pictures ---------------------------------------------------------------------------- */

/* The bytes of a picture's file, as they stand, or its size. */
static bool set_file(json_t *to, const ReviewPicture *p, Arena scratch, Error *err)
{
    FileBytes   bytes;
    PlainPng    png;
    const char *ending = path_ending(p->file);
    bool        is_png = !strcasecmp(ending, ".png");
    if (!is_png && strcasecmp(ending, ".jpg") != 0 && strcasecmp(ending, ".jpeg") != 0)
        return error_at(err, ERROR_INPUT, p->file, "",
                        "required: a picture ending in .png or .jpg");
    if (!file_read(p->file, PICTURE_BYTES_MAX, &scratch, &bytes, err)) return false;
    bool is_plain = is_png && plain_png_open(bytes.data, bytes.size, &png);
    bool is_shared = p->id && is_plain && !p->beside;
    page_set_count(to, "width", is_plain ? png.width : 0);
    page_set_count(to, "height", is_plain ? png.height : 0);
    page_set(to, "id", is_shared ? p->id : NULL);
    if (!p->beside && !(is_shared && p->is_again))
        json_object_set_new(to, "data", page_bytes(is_png ? "png" : "jpeg", bytes.data,
                                                   bytes.size, scratch));
    return true;
}

bool values_add_picture(json_t *to, const ReviewPicture *p, Arena scratch, Error *err)
{
    page_set(to, "title", p->title ? p->title : "");
    page_set(to, "caption", p->caption);
    page_set(to, "beside", p->picture ? NULL : p->beside);
    page_set(to, "id", NULL);
    page_set(to, "data", NULL);
    if (!p->picture) return set_file(to, p, scratch, err);
    json_t *data = page_picture(p->picture, false, scratch, err);
    return data && !json_object_set_new(to, "data", data);
}

static bool set_pictures(const PageValues *v, json_t *to, const ReviewCase *c, Error *err)
{
    json_t *list = values_list(to, "pictures");
    for (int i = 0; i < v->page->picture_count; i++) {
        const ReviewPicture *p = &v->page->pictures[i];
        Arena                scratch = *v->arena;
        const char          *card = json_string_value(json_object_get(to, "id"));
        if (p->of != c) continue;
        json_t *picture = page_add(list);
        page_set_flag(picture, "is_frame", p->is_frame);
        page_set(picture, "rays", p->view ? review_rays_drawn(c, card, &scratch) : NULL);
        if (!values_add_picture(picture, p, scratch, err)) return false;
    }
    page_set_flag(to, "has_pictures", json_array_size(list) > 0);
    return true;
}

/* ---- the case ---------------------------------------------------------------------------- */

static bool add_case(const PageValues *v, json_t *to, const ReviewCase *c, Error *err)
{
    static const char *const NAMES[] = {"symbol", "eye", "condition", NULL};
    Arena *arena = v->arena;
    bool   has_veil;
    values_set_names(to, NAMES);
    values_set_verdict(to, c->verdict);
    page_set(to, "id", review_card_id(v->review, c, arena));
    page_set(to, "link", review_card_link(v->review, c, arena));
    page_set(to, "case", words_case(c, arena));
    page_set(to, "figure", words_judged(c, arena));
    page_set(to, "reason", words_reason(c, arena));
    page_set(to, "headline", words_headline(c, arena));
    page_set(to, "unjudged", words_unjudged(c, arena));
    page_set(to, "light", words_ambient(c->ambient));
    page_set(to, "sun_words", words_sun(c, values_directions(v, c), arena));
    page_set(to, "hiders", words_hiders(c, arena));
    page_set(to, "bars", review_bar_luminances(c, &has_veil, arena));
    page_set_flag(to, "has_veil", has_veil);
    page_set_flag(to, "is_judged", c->verdict != VERDICT_UNJUDGED);
    page_set_flag(to, "is_worst", review_sweep_of(v->review, c) != NULL);
    set_contrast(to, c, arena);
    set_glare(to, &c->glare, arena);
    set_limits(to, c, arena);
    set_causes(to, c, arena);
    set_remedies(to, c, arena);
    return set_pictures(v, to, c, err);
}

bool values_add_cases(const PageValues *v, Error *err)
{
    for (int i = 0; i < review_case_count(v->review); i++) {
        const ReviewCase *c = review_case_at(v->review, i);
        if (!add_case(v, values_of_case(v, c), c, err)) return false;
    }
    return true;
}
