/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/case_json.h"

#include <string.h>

#include "base/count.h"
#include "review/output/json_rows.h"
#include "review/output/review_facts.h"
#include "review/output/review_privacy.h"
#include "review/private_image.h"
#include "review/review_decide.h"
#include "text/json_text.h"
#include "vision/privacy.h"

/* Reviews before there were four outcomes call one of them otherwise. */
bool case_read_verdict(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const char *word = json_string_value(json_object_get(view->object, row->key));
    if (!word || strcmp(word, "not visible") != 0) return record_read_kind(view, row, item, err);
    *(Verdict *)(void *)((char *)item + row->offset) = VERDICT_UNJUDGED;
    return true;
}

static json_t *write_age(const void *item) {
    double age = ((const LimitVerdict *)item)->age_years;
    return age > 0 ? json_real(age) : json_null();
}

PUBLIC_TABLE(limit_json, LimitVerdict, OWN(TEXT, LimitVerdict, name), OWN(TEXT, LimitVerdict, kind),
             OWN(FIGURE, LimitVerdict, value), OWN(TEXT, LimitVerdict, unit),
             OWN(TEXT, LimitVerdict, source), OWN(FLAG, LimitVerdict, read_in_the_standard),
             AS("upper", FLAG, LimitVerdict, is_upper), AS("advice", FLAG, LimitVerdict, is_advice),
             OWN(FIGURE, LimitVerdict, found), AS("interval", RANGE, LimitVerdict, low),
             OWN(FIGURE, LimitVerdict, margin), OWN(VERDICT, LimitVerdict, verdict),
             {"age_years", RECORD_NUMBER, RECORD_NULL | RECORD_BRIEF,
              RECORD_AT(LimitVerdict, age_years), RECORD_RANGE(-HUGE_VAL, HUGE_VAL),
              .write = write_age},
             {"by_pane", RECORD_TEXT, RECORD_NULL | RECORD_BRIEF, RECORD_AT(LimitVerdict, by_pane)},
             {"with_veil", RECORD_FLAG, RECORD_BRIEF, RECORD_AT(LimitVerdict, has_veil)},
             {"beside", RECORD_TEXT, RECORD_NULL | RECORD_BRIEF, RECORD_AT(LimitVerdict, beside)});

TABLE(ray_json, CaseRay, KEPT("points", POINTS, CaseRay, points, count));

#define VECTOR(Type, member) AS_POINT(#member, MUST | RECORD_FLOAT, Type, member)
TABLE(view_json, CaseView, VECTOR(CaseView, eye), VECTOR(CaseView, right), VECTOR(CaseView, up),
      VECTOR(CaseView, forward), OWN(FLAG, CaseView, is_perspective),
      OWN(FIGURE, CaseView, half_width), OWN(FIGURE, CaseView, half_height),
      OWN(INT, CaseView, width), OWN(INT, CaseView, height));

TABLE(cause_json, CaseCause, {"chain", RECORD_TEXTS, MUST, RECORD_MANY(CaseCause, chain, links)},
      OWN(FIGURE, CaseCause, share), OWN(FIGURE, CaseCause, cd_m2),
      AS("interval", RANGE, CaseCause, low), OWN(FIGURE, CaseCause, contrast_without),
      KEPT_LIST("rays", CaseCause, rays, ray_count, ray_json));

TABLE(share_json, CaseShare, OWN(TEXT, CaseShare, what), OWN(FIGURE, CaseShare, share),
      OWN(FIGURE, CaseShare, cd_m2));

#define GROUP(key, id) LIST(key, MUST, ReviewCase, groups[id].list, groups[id].count, share_json)
TABLE(groups_json, ReviewCase, GROUP("light", GROUP_LIGHT), GROUP("opening", GROUP_OPENING),
      GROUP("surface", GROUP_SURFACE));

TABLE(hider_json, CaseHider, OWN(TEXT, CaseHider, what), OWN(FIGURE, CaseHider, share));

PUBLIC_TABLE(break_json, RemedyBreak, OWN(TEXT, RemedyBreak, subject),
             OWN(TEXT, RemedyBreak, viewer), PART("limit", MUST, RemedyBreak, line, limit_json));

TABLE(remedy_json, CaseRemedy, OWN(TEXT, CaseRemedy, what), OWN(FIGURE, CaseRemedy, contrast_ratio),
      OWN(FIGURE, CaseRemedy, level), PART("then", 0, CaseRemedy, then, limit_json),
      LATER("verdict", VERDICT, CaseRemedy, verdict),
      LIST("breaks", RECORD_BRIEF, CaseRemedy, breaks, break_count, break_json));

PUBLIC_TABLE(panel_json, CasePanel, OWN(TEXT, CasePanel, verdict), OWN(TEXT, CasePanel, reason),
             AS("coarse", FLAG, CasePanel, is_coarse),
             AS("not_usable", FLAG, CasePanel, is_unusable), OWN(FIGURE, CasePanel, emission_error),
             OWN(FIGURE, CasePanel, reflection_error),
             LATER("spectra_assumed", TEXT, CasePanel, assumed));

TABLE(luminance_json, CaseLuminances, OWN(FIGURE, CaseLuminances, foreground),
      OWN(FIGURE, CaseLuminances, background), OWN(FIGURE, CaseLuminances, reflected),
      OWN(FIGURE, CaseLuminances, mirror), OWN(FIGURE, CaseLuminances, scattered),
      OWN(FIGURE, CaseLuminances, veil));

TABLE(box_json, CaseBox, OWN(FIGURE, CaseBox, left), OWN(FIGURE, CaseBox, top),
      OWN(FIGURE, CaseBox, right), OWN(FIGURE, CaseBox, bottom));

TABLE(mean_json, CaseWhole, OWN(FIGURE, CaseWhole, reflected),
      AS("reflected_interval", RANGE, CaseWhole, reflected_range),
      OWN(FIGURE, CaseWhole, contrast_ratio));

TABLE(visibility_json, CaseVisibility, OWN(FIGURE, CaseVisibility, age_years),
      AS("observer", FLAG, CaseVisibility, is_observer), OWN(FIGURE, CaseVisibility, level),
      AS("interval", RANGE, CaseVisibility, low), OWN(FIGURE, CaseVisibility, threshold_cd_m2),
      OWN(FIGURE, CaseVisibility, adapted_cd_m2), OWN(FIGURE, CaseVisibility, veil_times),
      OWN(FIGURE, CaseVisibility, veil_doubt), OWN(FIGURE, CaseVisibility, size_arcmin),
      OWN(FIGURE, CaseVisibility, glance_s), OWN(TEXT, CaseVisibility, doubts));

TABLE(colour_json, CaseColour, OWN(TEXT, CaseColour, symbol), OWN(RANGE, CaseColour, uv),
      OWN(RANGE, CaseColour, dark_uv), AS("delta_uv", FIGURE, CaseColour, apart),
      AS("interval", RANGE, CaseColour, low), KEPT("sampling", FIGURE, CaseColour, sampling));

TABLE(place_json, CasePlace, AS("position_m", POINT, CasePlace, eye_m),
      OWN(VERDICT, CasePlace, verdict), OWN(FIGURE, CasePlace, visible_share),
      OWN(FIGURE, CasePlace, contrast_ratio), AS("interval", RANGE, CasePlace, contrast_low));

static json_t *write_image_s(const void *item) {
    return json_figure(privacy_s_of_contrast(((const CaseImage *)item)->contrast_ratio));
}

static json_t *write_image_s_range(const void *item) {
    const CaseImage *image = item;
    return json_pack("[o,o]", json_figure(privacy_s_of_contrast(image->contrast_high)),
                     json_figure(privacy_s_of_contrast(image->contrast_low)));
}

/* What is infinite, such as a contrast before black, is null. */
TABLE(image_json, CaseImage, OWN(TEXT, CaseImage, pane), OWN(VERDICT, CaseImage, verdict),
      AS("position_m", POINT, CaseImage, eye_m), OWN(FIGURE, CaseImage, shown_share),
      OWN(FIGURE, CaseImage, height_arcmin), OWN(FIGURE, CaseImage, sent_foreground),
      OWN(FIGURE, CaseImage, sent_background), OWN(FIGURE, CaseImage, reflectance),
      AS("reflectance_interval", RANGE, CaseImage, reflectance_range),
      OWN(FIGURE, CaseImage, foreground), OWN(FIGURE, CaseImage, background),
      OWN(FIGURE, CaseImage, against), AS("against_interval", RANGE, CaseImage, against_range),
      OWN(FIGURE, CaseImage, contrast_ratio),
      AS("contrast_interval", RANGE, CaseImage, contrast_low), TOLD("s", 0, write_image_s),
      TOLD("s_interval", 0, write_image_s_range));

TABLE(private_json, ReviewCase, LIST("places", 0, ReviewCase, places, place_count, place_json),
      LIST("images", 0, ReviewCase, images, image_count, image_json));

static json_t *write_privacy(const void *item) {
    const ReviewCase *c = item;
    json_t *out = privacy_json(c);
    if (out && c->place_count)
        json_object_set_new(out, "places",
                            record_write_list(&place_json, c->places, c->place_count));
    if (out && c->image_count)
        json_object_set_new(out, "images",
                            record_write_list(&image_json, c->images, c->image_count));
    return out;
}

/* Its figures follow from the contrast's, which are read, too. */
static bool read_privacy(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    RecordRow places = {.key = row->key, .kind = RECORD_OBJECT, .of = &private_json};
    ((ReviewCase *)item)->must_not_be_read = true;
    return record_read_kind(view, &places, item, err);
}

/* Of a case, and of a false sun. */
typedef struct SunAt {
    double azimuth_deg, elevation_deg;
} SunAt;

PUBLIC_TABLE(sun_json, SunAt, OWN(FIGURE, SunAt, azimuth_deg), OWN(FIGURE, SunAt, elevation_deg));

/* "limit" repeats one of "limits": the first that is equal. */
static bool read_limit_id(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewCase *c = item;
    const json_t *limit = json_object_get(view->object, row->key);
    const json_t *limits = json_object_get(view->object, "limits");
    c->limit_id = -1;
    if (json_is_null(limit) || !json_is_array(limits)) return true; /* limits are read, too */
    for (size_t i = 0; i < json_array_size(limits) && c->limit_id < 0; i++)
        if (json_equal(limit, json_array_get(limits, i))) c->limit_id = (int)i;
    return c->limit_id >= 0 ||
           record_fails(view, row->key, err, "required: one of 'limits', or null");
}

static json_t *write_limit(const void *item) {
    const ReviewCase *c = item;
    bool has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    return has_limit ? record_write(&limit_json, &c->limits[c->limit_id]) : json_null();
}

/* The limit that made the case's verdict, or null. */
static json_t *write_judged(const void *item) {
    const LimitVerdict *limit = case_worst_limit(item);
    return limit ? record_write(&limit_json, limit) : json_null();
}

PUBLIC_TABLE(
    case_json, ReviewCase, OWN(TEXT, ReviewCase, condition), OWN(TEXT, ReviewCase, eye),
    OWN(TEXT, ReviewCase, symbol), OWN(TEXT, ReviewCase, display),
    OWN(AMBIENT, ReviewCase, ambient),
    {"sun", RECORD_OBJECT, MUST | RECORD_NULL, .of = &sun_json,
     RECORD_MANY(ReviewCase, sun_azimuth_deg, has_sun)},
    PART("luminance_cd_m2", MUST, ReviewCase, luminance_cd_m2, luminance_json),
    PART("symbol_mean", 0, ReviewCase, whole, mean_json),
    LATER("lit_share", FIGURE, ReviewCase, whole.lit_share),
    PART("judged_part_uv", 0, ReviewCase, whole.part, box_json),
    OWN(FIGURE, ReviewCase, contrast_ratio),
    AS("contrast_interval", RANGE, ReviewCase, contrast_low),
    LATER("reflected_interval", RANGE, ReviewCase, reflected_range), OWN(COUNT, ReviewCase, paths),
    LATER("precision_asked", FIGURE, ReviewCase, precision_asked),
    LATER("precision_reached", FIGURE, ReviewCase, precision_reached),
    LATER("open_by", OPEN, ReviewCase, open_by), OWN(FIGURE, ReviewCase, contrast_with_veil),
    OWN(FIGURE, ReviewCase, height_arcmin), LATER("stroke_ratio", FIGURE, ReviewCase, stroke_ratio),
    OWN(FIGURE, ReviewCase, jnd), OWN(FIGURE, ReviewCase, visibility),
    LIST("visibility_levels", RECORD_BRIEF, ReviewCase, visibilities, visibility_count,
         visibility_json),
    LIST("colours", RECORD_BRIEF, ReviewCase, colours, colour_count, colour_json),
    OWN(FIGURE, ReviewCase, eye_failed_share), OWN(FIGURE, ReviewCase, visible_share),
    LIST("hidden_by", 0, ReviewCase, hiders, hider_count, hider_json),
    OWN(FIGURE, ReviewCase, level), OWN(FIGURE, ReviewCase, display_lux),
    LATER("glasses_transmittance", FIGURE, ReviewCase, glasses_transmittance),
    LATER("glasses", TEXT, ReviewCase, glasses),
    LATER("glasses_display_loss", FIGURE, ReviewCase, glasses_display_loss),
    {"limit", RECORD_OWN, MUST, .read = read_limit_id, .write = write_limit},
    LIST("limits", MUST, ReviewCase, limits, limit_count, limit_json),
    {"judged", RECORD_OWN, RECORD_WRITTEN, .write = write_judged}, OWN(FIGURE, ReviewCase, margin),
    OWN(VERDICT, ReviewCase, verdict), LATER("reason", REASON, ReviewCase, unjudged),
    LATER("optional", FLAG, ReviewCase, is_optional),
    {"must_not_be_read", RECORD_OWN, RECORD_BRIEF, .read = read_privacy, .write = write_privacy},
    PART("panel", 0, ReviewCase, panel, panel_json),
    LIST("causes", MUST, ReviewCase, causes, cause_count, cause_json),
    {"cause_groups", RECORD_OBJECT, RECORD_WRITTEN | RECORD_KEPT, .of = &groups_json},
    LATER("without_data_share", FIGURE, ReviewCase, without_data_share),
    LATER("guessed_share", FIGURE, ReviewCase, guessed_share),
    LATER("extrapolated_share", FIGURE, ReviewCase, extrapolated_share),
    LATER("empty_seat", TEXT, ReviewCase, empty_seat),
    LATER("empty_seat_share", FIGURE, ReviewCase, empty_seat_share),
    LIST("remedies", MUST, ReviewCase, remedies, remedy_count, remedy_json),
    OWN(TEXT, ReviewCase, frame), OWN(TEXT, ReviewCase, when),
    /* kept, also in the place of what is RECORD_OWN */
    KEPT("sun_deg", RANGE, ReviewCase, sun_azimuth_deg),
    KEPT("sampling_share", RANGE, ReviewCase, sampling_share),
    {"batches", RECORD_FIGURES, RECORD_KEPT | RECORD_NULL | RECORD_BRIEF,
     RECORD_AT(ReviewCase, batches), RECORD_RANGE(-HUGE_VAL, HUGE_VAL),
     RECORD_COUNT(CASE_BATCHES, CASE_BATCHES)},
    KEPT("alike_within", FIGURE, ReviewCase, alike_within), KEPT("eye_m", POINT, ReviewCase, eye_m),
    KEPT("origin_m", POINT, ReviewCase, origin_m),
    KEPT("is_private", FLAG, ReviewCase, must_not_be_read),
    KEPT_LIST("places", ReviewCase, places, place_count, place_json),
    KEPT_LIST("images", ReviewCase, images, image_count, image_json),
    KEPT("own_reflected", FIGURE, ReviewCase, own_reflected),
    KEPT("veil_displays", FIGURE, ReviewCase, veil_displays),
    KEPT("limit_id", INT, ReviewCase, limit_id),
    {"view", RECORD_OBJECT, RECORD_KEPT | RECORD_APART | RECORD_BRIEF, RECORD_AT(ReviewCase, view),
     .of = &view_json},
    KEPT("rim", POINTS, ReviewCase, rim, rim_count));

FOLLOWS(ReviewCase, contrast_high, contrast_low);
FOLLOWS(ReviewCase, sun_elevation_deg, sun_azimuth_deg);
FOLLOWS(LimitVerdict, high, low);
FOLLOWS(CaseVisibility, high, low);
FOLLOWS(CaseColour, high, low);
FOLLOWS(CaseCause, high, low);
FOLLOWS(CasePlace, contrast_high, contrast_low);
FOLLOWS(CaseImage, contrast_high, contrast_low);

/* ---- parts that others show -------------------------------------------------------------- */

json_t *case_groups_json(const ReviewCase *c) {
    return record_write(&groups_json, c);
}

json_t *case_remedies_json(const ReviewCase *c) {
    return record_write_list(&remedy_json, c->remedies, c->remedy_count);
}

json_t *case_hiders_json(const ReviewCase *c) {
    return record_write_list(&hider_json, c->hiders, c->hider_count);
}

void case_members_json(const ReviewCase *c, const char *const *keys, json_t *to) {
    for (; *keys; keys++)
        for (const RecordRow *row = case_json.rows; row->key; row++)
            if (!strcmp(row->key, *keys))
                json_object_set_new(to, *keys, record_write_value(row, c));
}

void case_whole_json(const ReviewCase *c, json_t *to) {
    static const char *const KEYS[] = {"symbol_mean", "lit_share", "judged_part_uv",
                                       "must_not_be_read", NULL}; /* absent: it may be */
    if (c->symbol) case_members_json(c, KEYS, to);
}
