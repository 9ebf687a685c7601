/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_json_read.h"

#include <math.h>
#include <string.h>

#include "text/json_view.h"
#include "text/nearest_word.h"

/* A member that is there: its error names the object and the key that is missing. */
static bool has_key(const JsonView *view, const char *key, Error *err)
{
    if (json_object_get(view->object, key)) return true;
    return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
}

static bool wrong(const JsonView *view, const char *key, const char *wanted, Error *err)
{
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "wanted %s",
                    wanted);
}

/* A number or null, which is NaN. */
static bool read_number(const JsonView *view, const char *key, double *out, Error *err)
{
    *out = NAN;
    if (!has_key(view, key, err)) return false;
    if (json_is_null(json_object_get(view->object, key))) return true;
    return json_view_number(view, key, -HUGE_VAL, HUGE_VAL, out, err);
}

static bool read_pair(const JsonView *view, const char *key, double *low, double *high,
                      Error *err)
{
    double *out[2] = {low, high};
    json_t *list = json_object_get(view->object, key);
    if (!has_key(view, key, err)) return false;
    if (!json_is_array(list) || json_array_size(list) != 2)
        return wrong(view, key, "[low, high]", err);
    for (size_t i = 0; i < 2; i++) {
        json_t *value = json_array_get(list, i);
        if (!json_is_number(value) && !json_is_null(value))
            return wrong(view, key, "two numbers or null", err);
        *out[i] = json_is_null(value) ? NAN : json_number_value(value);
    }
    return true;
}

static bool read_text(const JsonView *view, const char *key, const char **out, Error *err)
{
    *out = NULL;
    if (!has_key(view, key, err)) return false;
    if (json_is_null(json_object_get(view->object, key))) return true;
    return json_view_text(view, key, out, err);
}

static bool read_flag(const JsonView *view, const char *key, bool *out, Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!has_key(view, key, err)) return false;
    if (!json_is_boolean(value)) return wrong(view, key, "true or false", err);
    *out = json_is_true(value);
    return true;
}

static bool read_count(const JsonView *view, const char *key, json_int_t *out, Error *err)
{
    json_t *value = json_object_get(view->object, key);
    if (!has_key(view, key, err)) return false;
    if (!json_is_integer(value) || json_integer_value(value) < 0)
        return wrong(view, key, "a whole number, 0 or more", err);
    *out = json_integer_value(value);
    return true;
}

/* One of four words; *out is its place. */
static bool read_word(const JsonView *view, const char *key, const char *const words[4],
                      int *out, Error *err)
{
    const char *word = NULL;
    char        advice[256];
    if (!read_text(view, key, &word, err)) return false;
    for (int i = 0; word && i < 4; i++) {
        if (strcmp(word, words[i]) != 0) continue;
        *out = i;
        return true;
    }
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                    "is '%.60s'; %s", word ? word : "null",
                    nearest_word_advice(word ? word : "", words, 4, advice, sizeof advice));
}

static bool read_verdict(const JsonView *view, Verdict *out, Error *err)
{
    int id = 0;
    if (!read_word(view, "verdict", verdict_names, &id, err)) return false;
    *out = (Verdict)id;
    return true;
}

/* ---- lists ------------------------------------------------------------------------------ */

typedef bool ReadItem(const JsonView *view, void *item, Error *err);

typedef struct ItemKind {
    ReadItem *read;
    size_t    size, align;
} ItemKind;

#define ITEM(read, Type) ((ItemKind){read, sizeof(Type), _Alignof(Type)})

/* An array of objects; each has its index in its path. */
static bool read_list(const JsonView *view, const char *key, ItemKind kind, void **out,
                      int *count, Error *err)
{
    json_t *list = json_object_get(view->object, key);
    if (!has_key(view, key, err)) return false;
    if (!json_is_array(list)) return wrong(view, key, "an array of objects", err);
    size_t size = json_array_size(list);
    char  *items = arena_alloc(view->arena, kind.size, kind.align, size);
    for (size_t i = 0; i < size; i++) {
        JsonView item = *view;
        item.object = json_array_get(list, i);
        item.path = arena_format(view->arena, "%s/%s/%zu", view->path, key, i);
        if (!json_is_object(item.object))
            return error_at(err, ERROR_INPUT, item.file, item.path, "wanted an object");
        if (!kind.read(&item, items + i * kind.size, err)) return false;
    }
    *out = items;
    *count = (int)size;
    return true;
}

static bool read_texts(const JsonView *view, const char *key, const char *const **out,
                       int *count, Error *err)
{
    json_t *list = json_object_get(view->object, key);
    if (!has_key(view, key, err)) return false;
    if (!json_is_array(list)) return wrong(view, key, "an array of texts", err);
    size_t       size = json_array_size(list);
    const char **texts = ARENA_NEW(view->arena, const char *, size);
    for (size_t i = 0; i < size; i++) {
        json_t *text = json_array_get(list, i);
        if (!json_is_string(text)) return wrong(view, key, "only texts", err);
        texts[i] = arena_string(view->arena, json_string_value(text),
                                json_string_length(text));
    }
    *out = texts;
    *count = (int)size;
    return true;
}

/* ---- one case --------------------------------------------------------------------------- */

static bool read_limit(const JsonView *view, void *item, Error *err)
{
    LimitVerdict *l = item;
    return read_text(view, "name", &l->name, err) && read_text(view, "kind", &l->kind, err) &&
           read_number(view, "value", &l->value, err) &&
           read_text(view, "unit", &l->unit, err) &&
           read_text(view, "source", &l->source, err) &&
           read_flag(view, "read_in_the_standard", &l->read_in_the_standard, err) &&
           read_flag(view, "upper", &l->is_upper, err) &&
           read_flag(view, "advice", &l->is_advice, err) &&
           read_number(view, "found", &l->found, err) &&
           read_pair(view, "interval", &l->low, &l->high, err) &&
           read_number(view, "margin", &l->margin, err) &&
           read_verdict(view, &l->verdict, err);
}

static bool read_cause(const JsonView *view, void *item, Error *err)
{
    CaseCause *cause = item;
    return read_texts(view, "chain", &cause->chain, &cause->links, err) &&
           read_number(view, "share", &cause->share, err) &&
           read_number(view, "cd_m2", &cause->cd_m2, err) &&
           read_pair(view, "interval", &cause->low, &cause->high, err) &&
           read_number(view, "contrast_without", &cause->contrast_without, err);
}

static bool read_remedy(const JsonView *view, void *item, Error *err)
{
    CaseRemedy *remedy = item;
    return read_text(view, "what", &remedy->what, err) &&
           read_number(view, "contrast_ratio", &remedy->contrast_ratio, err) &&
           read_number(view, "level", &remedy->level, err);
}

static bool read_hider(const JsonView *view, void *item, Error *err)
{
    CaseHider *hider = item;
    return read_text(view, "what", &hider->what, err) &&
           read_number(view, "share", &hider->share, err);
}

static bool read_sun(const JsonView *view, ReviewCase *c, Error *err)
{
    JsonView sun;
    c->sun_azimuth_deg = c->sun_elevation_deg = NAN;
    if (!has_key(view, "sun", err)) return false;
    c->has_sun = !json_is_null(json_object_get(view->object, "sun"));
    if (!c->has_sun) return true;
    return json_view_child(view, "sun", true, &sun, err) &&
           read_number(&sun, "azimuth_deg", &c->sun_azimuth_deg, err) &&
           read_number(&sun, "elevation_deg", &c->sun_elevation_deg, err);
}

static bool read_luminances(const JsonView *view, CaseLuminances *l, Error *err)
{
    JsonView from;
    return json_view_child(view, "luminance_cd_m2", true, &from, err) &&
           read_number(&from, "foreground", &l->foreground, err) &&
           read_number(&from, "background", &l->background, err) &&
           read_number(&from, "reflected", &l->reflected, err) &&
           read_number(&from, "mirror", &l->mirror, err) &&
           read_number(&from, "scattered", &l->scattered, err) &&
           read_number(&from, "veil", &l->veil, err);
}

static bool read_names(const JsonView *view, ReviewCase *c, Error *err)
{
    int ambient = 0;
    if (!read_text(view, "condition", &c->condition, err) ||
        !read_text(view, "eye", &c->eye, err) || !read_text(view, "symbol", &c->symbol, err) ||
        !read_text(view, "display", &c->display, err) ||
        !read_text(view, "frame", &c->frame, err) ||
        !read_text(view, "outlook", &c->outlook, err) ||
        !read_text(view, "when", &c->when, err) ||
        !read_word(view, "ambient", ambient_names, &ambient, err))
        return false;
    c->ambient = (Ambient)ambient;
    return true;
}

/* Figures that older reviews do not have. */
static bool read_since(const JsonView *view, ReviewCase *c, Error *err)
{
    c->reflected_range = (Range){(double)NAN, (double)NAN};
    c->paths_to_decide = c->minutes_to_decide = (double)NAN;
    void *hiders = NULL;
    if (json_object_get(view->object, "hidden_by") &&
        !read_list(view, "hidden_by", ITEM(read_hider, CaseHider), &hiders, &c->hider_count,
                   err))
        return false;
    c->hiders = hiders;
    c->precision_asked = c->precision_reached = (double)NAN;
    return (!json_object_get(view->object, "reflected_interval") ||
            read_pair(view, "reflected_interval", &c->reflected_range.low,
                      &c->reflected_range.high, err)) &&
           (!json_object_get(view->object, "precision_asked") ||
            read_number(view, "precision_asked", &c->precision_asked, err)) &&
           (!json_object_get(view->object, "precision_reached") ||
            read_number(view, "precision_reached", &c->precision_reached, err)) &&
           (!json_object_get(view->object, "paths_to_decide") ||
            read_number(view, "paths_to_decide", &c->paths_to_decide, err));
}

static bool read_figures(const JsonView *view, ReviewCase *c, Error *err)
{
    json_int_t paths = 0;
    if (!read_count(view, "paths", &paths, err)) return false;
    c->paths = (long)paths;
    return read_since(view, c, err) &&
           read_number(view, "contrast_ratio", &c->contrast_ratio, err) &&
           read_pair(view, "contrast_interval", &c->contrast_low, &c->contrast_high, err) &&
           read_number(view, "contrast_with_veil", &c->contrast_with_veil, err) &&
           read_number(view, "height_arcmin", &c->height_arcmin, err) &&
           read_number(view, "jnd", &c->jnd, err) &&
           read_number(view, "visibility", &c->visibility, err) &&
           read_number(view, "dgp", &c->dgp, err) && read_number(view, "ugr", &c->ugr, err) &&
           read_number(view, "visible_share", &c->visible_share, err) &&
           read_number(view, "eye_failed_share", &c->eye_failed_share, err) &&
           read_number(view, "level", &c->level, err) &&
           read_number(view, "display_lux", &c->display_lux, err) &&
           read_number(view, "margin", &c->margin, err);
}

/* "limit" repeats one of "limits": the first that is equal. */
static bool read_limit_id(const JsonView *view, ReviewCase *c, Error *err)
{
    json_t *limit = json_object_get(view->object, "limit");
    json_t *limits = json_object_get(view->object, "limits");
    c->limit_id = -1;
    if (!has_key(view, "limit", err)) return false;
    if (json_is_null(limit)) return true;
    for (int i = 0; i < c->limit_count && c->limit_id < 0; i++)
        if (json_equal(limit, json_array_get(limits, (size_t)i))) c->limit_id = i;
    return c->limit_id >= 0 || wrong(view, "limit", "one of 'limits', or null", err);
}

static bool read_case(const JsonView *view, void *item, Error *err)
{
    ReviewCase *c = item;
    void       *limits, *causes, *remedies;
    if (!read_names(view, c, err) || !read_sun(view, c, err) ||
        !read_luminances(view, &c->luminance_cd_m2, err) || !read_figures(view, c, err) ||
        !read_verdict(view, &c->verdict, err) ||
        !read_list(view, "limits", ITEM(read_limit, LimitVerdict), &limits, &c->limit_count,
                   err) ||
        !read_limit_id(view, c, err) ||
        !read_list(view, "causes", ITEM(read_cause, CaseCause), &causes, &c->cause_count,
                   err) ||
        !read_list(view, "remedies", ITEM(read_remedy, CaseRemedy), &remedies,
                   &c->remedy_count, err))
        return false;
    c->limits = limits;
    c->causes = causes;
    c->remedies = remedies;
    return true;
}

/* ---- the review ------------------------------------------------------------------------- */

static bool read_sweep(const JsonView *view, void *item, Error *err)
{
    ReviewSweep *s = item;
    JsonView     worst;
    json_int_t   cases = 0;
    if (!read_text(view, "condition", &s->condition, err) ||
        !read_text(view, "eye", &s->eye, err) || !read_text(view, "symbol", &s->symbol, err) ||
        !read_count(view, "cases", &cases, err) ||
        !read_number(view, "failed_share", &s->failed_share, err) ||
        !read_number(view, "longest_failure_minutes", &s->longest_failure_minutes, err) ||
        !read_text(view, "table", &s->table, err) ||
        !json_view_child(view, "worst", true, &worst, err) ||
        !read_case(&worst, &s->worst, err))
        return false;
    s->cases = (long)cases;
    return true;
}

static bool read_veil_parts(const JsonView *view, GazeVeil *v, Error *err)
{
    JsonView from;
    return has_key(view, "veil_parts_cd_m2", err) &&
           json_view_child(view, "veil_parts_cd_m2", true, &from, err) &&
           read_number(&from, "sun", &v->sun, err) &&
           read_number(&from, "sky", &v->sky, err) &&
           read_number(&from, "lamps", &v->lamps, err) &&
           read_number(&from, "glints", &v->glints, err) &&
           read_number(&from, "surfaces", &v->surfaces, err) &&
           read_number(&from, "near", &v->near, err);
}

static bool read_range(const JsonView *view, const char *key, Range *out, Error *err)
{
    return read_pair(view, key, &out->low, &out->high, err);
}

static bool read_gaze(const JsonView *view, void *item, Error *err)
{
    GazeFinding *g = item;
    return read_text(view, "condition", &g->condition, err) &&
           read_text(view, "eye", &g->eye, err) && read_text(view, "gaze", &g->gaze, err) &&
           read_number(view, "sun_from_gaze_deg", &g->sun_deg, err) &&
           read_number(view, "veil_cd_m2", &g->veil, err) &&
           read_range(view, "veil_interval", &g->veil_range, err) &&
           read_veil_parts(view, &g->veil_parts, err) &&
           read_number(view, "cornea_lx", &g->cornea_lux, err) &&
           read_number(view, "through_cd_m2", &g->through, err) &&
           read_number(view, "mirrored_cd_m2", &g->mirrored, err) &&
           read_range(view, "mirrored_interval", &g->mirrored_range, err) &&
           read_text(view, "mirrored_by", &g->mirrored_by, err) &&
           read_text(view, "mirrored_from", &g->mirrored_from, err) &&
           read_number(view, "contrast_behind_glass", &g->contrast_behind_glass, err) &&
           read_number(view, "contrast_left", &g->contrast_left, err) &&
           read_range(view, "contrast_interval", &g->contrast_range, err) &&
           read_number(view, "dgp", &g->dgp, err) && read_number(view, "ugr", &g->ugr, err);
}

static bool read_response(const JsonView *view, void *item, Error *err)
{
    ReviewResponse *r = item;
    json_int_t      paths = 0, bytes = 0;
    if (!read_text(view, "probe", &r->probe, err) || !read_text(view, "file", &r->file, err) ||
        !read_count(view, "paths", &paths, err) ||
        !read_count(view, "bytes", &bytes, err) ||
        !read_number(view, "relative_error", &r->relative_error, err))
        return false;
    r->paths = (long)paths;
    r->bytes = (size_t)bytes;
    return true;
}

static bool read_false_sun(const JsonView *view, void *item, Error *err)
{
    ReviewFalseSun *f = item;
    JsonView        sun;
    return read_text(view, "condition", &f->condition, err) &&
           read_text(view, "eye", &f->eye, err) && read_text(view, "mirror", &f->mirror, err) &&
           read_number(view, "share", &f->share, err) &&
           read_number(view, "minutes", &f->minutes, err) &&
           read_number(view, "longest_minutes", &f->longest_minutes, err) &&
           read_text(view, "when", &f->when, err) &&
           json_view_child(view, "sun", true, &sun, err) &&
           read_number(&sun, "azimuth_deg", &f->sun_azimuth_deg, err) &&
           read_number(&sun, "elevation_deg", &f->sun_elevation_deg, err) &&
           read_number(view, "lux", &f->lux, err) && read_text(view, "gaze", &f->gaze, err) &&
           read_number(view, "angle_deg", &f->angle_deg, err) &&
           read_number(view, "veil_cd_m2", &f->veil_cd_m2, err);
}

static bool read_review(const JsonView *root, Review *out, Error *err)
{
    Review review = {0};
    void  *cases, *sweeps, *gazes, *responses, *false_suns;
    if (!read_flag(root, "pass", &review.pass, err) ||
        !read_flag(root, "strict", &review.is_strict, err) ||
        !read_text(root, "title", &review.title, err) ||
        !read_text(root, "profile", &review.profile, err) ||
        !read_list(root, "cases", ITEM(read_case, ReviewCase), &cases, &review.case_count,
                   err) ||
        !read_list(root, "sweeps", ITEM(read_sweep, ReviewSweep), &sweeps,
                   &review.sweep_count, err) ||
        !read_list(root, "gazes", ITEM(read_gaze, GazeFinding), &gazes, &review.gaze_count,
                   err) ||
        !read_list(root, "responses", ITEM(read_response, ReviewResponse), &responses,
                   &review.response_count, err) ||
        !read_list(root, "false_suns", ITEM(read_false_sun, ReviewFalseSun), &false_suns,
                   &review.false_sun_count, err) ||
        !read_texts(root, "notes", &review.notes, &review.note_count, err))
        return false;
    review.is_partial = json_is_true(json_object_get(root->object, "provisional"));
    review.cases = cases;
    review.sweeps = sweeps;
    review.gazes = gazes;
    review.responses = responses;
    review.false_suns = false_suns;
    *out = review;
    return true;
}

bool review_json_read(const char *file, Arena *arena, Review *out, Error *err)
{
    JsonView root;
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = read_review(&root, out, err);
    json_view_close(&root);
    return ok;
}
