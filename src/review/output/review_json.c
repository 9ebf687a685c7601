/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_json.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "record/record_write.h"
#include "review/output/review_facts.h"
#include "review/output/review_privacy.h"
#include "review/pane_verdict.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "text/json_text.h"

#define DIGITS 6
#define DOCUMENT_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */
#define PLACES_BYTES ((size_t)1 << 26)

/* ---- which keys hold which members ------------------------------------------------------- */

#define MUST RECORD_REQUIRED /* else older reviews may lack it */

/* A member under a key, and under its own name; one that older reviews may lack. */
#define AS_FIGURE(key, flag, Type, member)                                                     \
    {key, RECORD_NUMBER, RECORD_NULL | (flag), RECORD_AT(Type, member),                        \
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL)}
#define AS_TEXT(key, flag, Type, member)                                                       \
    {key, RECORD_TEXT, RECORD_NULL | (flag), RECORD_AT(Type, member)}
#define AS_RANGE(key, flag, Type, member)                                                      \
    {key, RECORD_NUMBERS, RECORD_NULL | (flag), RECORD_AT(Type, member),                       \
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), RECORD_COUNT(2, 2)}
#define AS_FLAG(key, flag, Type, member) {key, RECORD_FLAG, flag, RECORD_AT(Type, member)}
#define AS_COUNT(key, flag, Type, member)                                                      \
    {key, RECORD_INTEGER, RECORD_LONG | (flag), RECORD_AT(Type, member), RECORD_RANGE(0, 1e18)}
#define AS_WORD(key, flag, Type, member, list)                                                 \
    {key, RECORD_CHOICE, flag, RECORD_AT(Type, member), .words = list}
#define AS_AMBIENT(key, flag, Type, member) AS_WORD(key, flag, Type, member, ambient_names)
#define AS_REASON(key, flag, Type, member)                                                     \
    AS_WORD(key, RECORD_NULL | (flag), Type, member, unjudged_names + 1)
#define AS_OPEN(key, flag, Type, member)                                                       \
    AS_WORD(key, RECORD_NULL | (flag), Type, member, open_names + 1)
#define AS_VERDICT(key, flag, Type, member)                                                    \
    {key, RECORD_CHOICE, flag, RECORD_AT(Type, member), .words = verdict_names,                \
     .read = read_verdict}
#define AS(key, KIND, Type, member) AS_##KIND(key, MUST, Type, member)
#define LATER(key, KIND, Type, member) AS_##KIND(key, 0, Type, member)
#define OWN(KIND, Type, member) AS(#member, KIND, Type, member)
#define LIST(key, flag, Type, member, number, table)                                           \
    {key, RECORD_LIST, flag, RECORD_MANY(Type, member, number), .of = &table}
#define PART(key, flag, Type, member, table)                                                   \
    {key, RECORD_OBJECT, flag, RECORD_AT(Type, member), .of = &table}
#define TOLD(key, flag, function) {key, RECORD_OWN, RECORD_WRITTEN | (flag), .write = function}

/* The rows of a struct, and what reads and writes them. */
#define TABLE(name, Type, ...)                                                                 \
    static const RecordRow    name##_rows[] = {__VA_ARGS__, {0}};                              \
    static const RecordFormat name = {#name, sizeof(Type), name##_rows, .takes_more = true}

/* Reviews before there were four outcomes call one of them otherwise. */
static bool read_verdict(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    const char *word = json_string_value(json_object_get(view->object, row->key));
    if (!word || strcmp(word, "not visible") != 0)
        return record_read_kind(view, row, item, err);
    *(Verdict *)(void *)((char *)item + row->offset) = VERDICT_UNJUDGED;
    return true;
}

static json_t *write_age(const void *item)
{
    double age = ((const LimitVerdict *)item)->age_years;
    return age > 0 ? json_real(age) : json_null();
}

TABLE(limit_json, LimitVerdict,
    OWN(TEXT, LimitVerdict, name), OWN(TEXT, LimitVerdict, kind),
    OWN(FIGURE, LimitVerdict, value), OWN(TEXT, LimitVerdict, unit),
    OWN(TEXT, LimitVerdict, source), OWN(FLAG, LimitVerdict, read_in_the_standard),
    AS("upper", FLAG, LimitVerdict, is_upper), AS("advice", FLAG, LimitVerdict, is_advice),
    OWN(FIGURE, LimitVerdict, found), AS("interval", RANGE, LimitVerdict, low),
    OWN(FIGURE, LimitVerdict, margin), OWN(VERDICT, LimitVerdict, verdict),
    {"age_years", RECORD_NUMBER, RECORD_NULL | RECORD_BRIEF, RECORD_AT(LimitVerdict, age_years),
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), .write = write_age});

TABLE(cause_json, CaseCause,
    {"chain", RECORD_TEXTS, MUST, RECORD_MANY(CaseCause, chain, links)},
    OWN(FIGURE, CaseCause, share), OWN(FIGURE, CaseCause, cd_m2),
    AS("interval", RANGE, CaseCause, low), OWN(FIGURE, CaseCause, contrast_without));

TABLE(share_json, CaseShare,
    OWN(TEXT, CaseShare, what), OWN(FIGURE, CaseShare, share),
    OWN(FIGURE, CaseShare, cd_m2));

#define GROUP(key, id)                                                                         \
    LIST(key, MUST, ReviewCase, groups[id].list, groups[id].count, share_json)
TABLE(groups_json, ReviewCase,
    GROUP("light", GROUP_LIGHT), GROUP("opening", GROUP_OPENING),
    GROUP("surface", GROUP_SURFACE));

TABLE(hider_json, CaseHider,
    OWN(TEXT, CaseHider, what), OWN(FIGURE, CaseHider, share));

TABLE(remedy_json, CaseRemedy,
    {"kind", RECORD_CHOICE, RECORD_AT(CaseRemedy, kind), .words = remedy_kinds},
    OWN(TEXT, CaseRemedy, what), OWN(FIGURE, CaseRemedy, contrast_ratio),
    OWN(FIGURE, CaseRemedy, level),
    PART("then", 0, CaseRemedy, then, limit_json),
    LATER("verdict", VERDICT, CaseRemedy, verdict));

TABLE(panel_json, CasePanel,
    OWN(TEXT, CasePanel, verdict), OWN(TEXT, CasePanel, reason),
    AS("coarse", FLAG, CasePanel, is_coarse), AS("not_usable", FLAG, CasePanel, is_unusable),
    OWN(FIGURE, CasePanel, emission_error), OWN(FIGURE, CasePanel, reflection_error),
    LATER("spectra_assumed", TEXT, CasePanel, assumed));

TABLE(luminance_json, CaseLuminances,
    OWN(FIGURE, CaseLuminances, foreground), OWN(FIGURE, CaseLuminances, background),
    OWN(FIGURE, CaseLuminances, reflected), OWN(FIGURE, CaseLuminances, mirror),
    OWN(FIGURE, CaseLuminances, scattered), OWN(FIGURE, CaseLuminances, veil));

TABLE(box_json, CaseBox,
    OWN(FIGURE, CaseBox, left), OWN(FIGURE, CaseBox, top),
    OWN(FIGURE, CaseBox, right), OWN(FIGURE, CaseBox, bottom));

TABLE(mean_json, CaseWhole,
    OWN(FIGURE, CaseWhole, reflected),
    AS("reflected_interval", RANGE, CaseWhole, reflected_range),
    OWN(FIGURE, CaseWhole, contrast_ratio));

TABLE(visibility_json, CaseVisibility,
    OWN(FIGURE, CaseVisibility, age_years), AS("observer", FLAG, CaseVisibility, is_observer),
    OWN(FIGURE, CaseVisibility, level), AS("interval", RANGE, CaseVisibility, low),
    OWN(FIGURE, CaseVisibility, threshold_cd_m2), OWN(FIGURE, CaseVisibility, adapted_cd_m2),
    OWN(FIGURE, CaseVisibility, veil_times), OWN(FIGURE, CaseVisibility, veil_doubt),
    OWN(FIGURE, CaseVisibility, size_arcmin), OWN(FIGURE, CaseVisibility, glance_s),
    OWN(TEXT, CaseVisibility, doubts));

TABLE(halo_json, CaseHalo,
    OWN(FIGURE, CaseHalo, mean_drive), OWN(FIGURE, CaseHalo, full_cd_m2),
    OWN(FIGURE, CaseHalo, black_cd_m2), OWN(FIGURE, CaseHalo, halo_cd_m2),
    OWN(FIGURE, CaseHalo, scattered_cd_m2), OWN(FIGURE, CaseHalo, threshold_cd_m2),
    OWN(FIGURE, CaseHalo, level), AS("visible", FLAG, CaseHalo, is_visible));

TABLE(glare_json, CaseGlare,
    OWN(FIGURE, CaseGlare, threshold_cd_m2), OWN(FIGURE, CaseGlare, background_cd_m2),
    AS("sources", COUNT, CaseGlare, source_count),
    AS("sources_lx", FIGURE, CaseGlare, source_lx),
    AS("smallest_source_sr", FIGURE, CaseGlare, smallest_sr),
    AS("largest_source_sr", FIGURE, CaseGlare, largest_sr),
    AS("low_light_factor", FLAG, CaseGlare, low_light),
    AS("small_source_rule", FLAG, CaseGlare, small_sources),
    AS("no_ugr_because", TEXT, CaseGlare, none));

/* Of what has a CaseGlare. */
#define GLARE_MEMBERS(Type)                                                                    \
    AS("dgp", FIGURE, Type, glare.dgp), AS("ugr", FIGURE, Type, glare.ugr),                    \
    LATER("dgi", FIGURE, Type, glare.dgi),                                                     \
    LATER("dgp_interval", RANGE, Type, glare.dgp_range),                                       \
    LATER("ugr_interval", RANGE, Type, glare.ugr_range),                                       \
    LATER("dgi_interval", RANGE, Type, glare.dgi_range),                                       \
    PART("glare", 0, Type, glare, glare_json)

TABLE(place_json, CasePlace,
    {"position_m", RECORD_NUMBERS, MUST, RECORD_AT(CasePlace, eye_m),
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), RECORD_COUNT(3, 3)},
    OWN(VERDICT, CasePlace, verdict), OWN(FIGURE, CasePlace, visible_share),
    OWN(FIGURE, CasePlace, contrast_ratio), AS("interval", RANGE, CasePlace, contrast_low));

TABLE(private_json, ReviewCase, LIST("places", 0, ReviewCase, places, place_count, place_json));

static json_t *write_privacy(const void *item)
{
    const ReviewCase *c = item;
    json_t           *out = privacy_json(c);
    if (out && c->place_count)
        json_object_set_new(out, "places",
                            record_write_list(&place_json, c->places, c->place_count));
    return out;
}

/* Its figures follow from the contrast's, which are read, too. */
static bool read_privacy(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    RecordRow places = {.key = row->key, .kind = RECORD_OBJECT, .of = &private_json};
    ((ReviewCase *)item)->must_not_be_read = true;
    return record_read_kind(view, &places, item, err);
}

/* Of a case, and of a false sun. */
typedef struct SunAt {
    double azimuth_deg, elevation_deg;
} SunAt;

TABLE(sun_json, SunAt,
    OWN(FIGURE, SunAt, azimuth_deg),
    OWN(FIGURE, SunAt, elevation_deg));

/* "limit" repeats one of "limits": the first that is equal. */
static bool read_limit_id(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    ReviewCase   *c = item;
    const json_t *limit = json_object_get(view->object, row->key);
    const json_t *limits = json_object_get(view->object, "limits");
    c->limit_id = -1;
    if (json_is_null(limit) || !json_is_array(limits)) return true; /* limits are read, too */
    for (size_t i = 0; i < json_array_size(limits) && c->limit_id < 0; i++)
        if (json_equal(limit, json_array_get(limits, i))) c->limit_id = (int)i;
    return c->limit_id >= 0 ||
           record_fails(view, row->key, err, "required: one of 'limits', or null");
}

static json_t *write_limit(const void *item)
{
    const ReviewCase *c = item;
    bool              has_limit = c->limit_id >= 0 && c->limit_id < c->limit_count;
    return has_limit ? record_write(&limit_json, &c->limits[c->limit_id]) : json_null();
}

/* The limit that made the case's verdict, or null. */
static json_t *write_judged(const void *item)
{
    const LimitVerdict *limit = case_worst_limit(item);
    return limit ? record_write(&limit_json, limit) : json_null();
}

TABLE(case_json, ReviewCase,
    OWN(TEXT, ReviewCase, condition), OWN(TEXT, ReviewCase, eye), OWN(TEXT, ReviewCase, symbol),
    OWN(TEXT, ReviewCase, display), OWN(AMBIENT, ReviewCase, ambient),
    {"sun", RECORD_OBJECT, MUST | RECORD_NULL, .of = &sun_json,
     RECORD_MANY(ReviewCase, sun_azimuth_deg, has_sun)},
    PART("luminance_cd_m2", MUST, ReviewCase, luminance_cd_m2, luminance_json),
    PART("symbol_mean", 0, ReviewCase, whole, mean_json),
    LATER("lit_share", FIGURE, ReviewCase, whole.lit_share),
    PART("judged_part_uv", 0, ReviewCase, whole.part, box_json),
    OWN(FIGURE, ReviewCase, contrast_ratio),
    AS("contrast_interval", RANGE, ReviewCase, contrast_low),
    LATER("reflected_interval", RANGE, ReviewCase, reflected_range),
    OWN(COUNT, ReviewCase, paths),
    LATER("precision_asked", FIGURE, ReviewCase, precision_asked),
    LATER("precision_reached", FIGURE, ReviewCase, precision_reached),
    LATER("open_by", OPEN, ReviewCase, open_by),
    LATER("paths_to_decide", FIGURE, ReviewCase, paths_to_decide),
    LATER("decide_times", FIGURE, ReviewCase, decide_times),
    OWN(FIGURE, ReviewCase, contrast_with_veil), OWN(FIGURE, ReviewCase, height_arcmin),
    LATER("stroke_ratio", FIGURE, ReviewCase, stroke_ratio),
    OWN(FIGURE, ReviewCase, jnd), OWN(FIGURE, ReviewCase, visibility),
    LIST("visibility_levels", RECORD_BRIEF, ReviewCase, visibilities, visibility_count,
         visibility_json),
    {"halo", RECORD_OBJECT, RECORD_NULL | RECORD_BRIEF, .of = &halo_json,
     RECORD_MANY(ReviewCase, halo, has_halo)},
    GLARE_MEMBERS(ReviewCase),
    OWN(FIGURE, ReviewCase, eye_failed_share), OWN(FIGURE, ReviewCase, visible_share),
    LIST("hidden_by", 0, ReviewCase, hiders, hider_count, hider_json),
    OWN(FIGURE, ReviewCase, level), OWN(FIGURE, ReviewCase, display_lux),
    LATER("glasses_transmittance", FIGURE, ReviewCase, glasses_transmittance),
    LATER("glasses", TEXT, ReviewCase, glasses),
    LATER("glasses_display_loss", FIGURE, ReviewCase, glasses_display_loss),
    {"limit", RECORD_OWN, MUST, .read = read_limit_id, .write = write_limit},
    LIST("limits", MUST, ReviewCase, limits, limit_count, limit_json),
    {"judged", RECORD_OWN, RECORD_WRITTEN, .write = write_judged},
    OWN(FIGURE, ReviewCase, margin), OWN(VERDICT, ReviewCase, verdict),
    LATER("reason", REASON, ReviewCase, unjudged),
    LATER("optional", FLAG, ReviewCase, is_optional),
    {"must_not_be_read", RECORD_OWN, RECORD_BRIEF, .read = read_privacy,
     .write = write_privacy},
    PART("panel", 0, ReviewCase, panel, panel_json),
    LIST("causes", MUST, ReviewCase, causes, cause_count, cause_json),
    {"cause_groups", RECORD_OBJECT, RECORD_WRITTEN, .of = &groups_json},
    LATER("without_data_share", FIGURE, ReviewCase, without_data_share),
    LATER("guessed_share", FIGURE, ReviewCase, guessed_share),
    LATER("extrapolated_share", FIGURE, ReviewCase, extrapolated_share),
    LATER("empty_seat", TEXT, ReviewCase, empty_seat),
    LATER("empty_seat_share", FIGURE, ReviewCase, empty_seat_share),
    LIST("remedies", MUST, ReviewCase, remedies, remedy_count, remedy_json),
    OWN(TEXT, ReviewCase, frame), OWN(TEXT, ReviewCase, outlook), OWN(TEXT, ReviewCase, when));

#define FOLLOWS(Type, second, first)                                                           \
    _Static_assert(offsetof(Type, second) == offsetof(Type, first) + sizeof(double), "a pair")
FOLLOWS(ReviewCase, contrast_high, contrast_low);
FOLLOWS(ReviewCase, sun_elevation_deg, sun_azimuth_deg);
FOLLOWS(ReviewFalseSun, sun_elevation_deg, sun_azimuth_deg);
FOLLOWS(LimitVerdict, high, low);
FOLLOWS(CaseVisibility, high, low);
FOLLOWS(CaseCause, high, low);
FOLLOWS(CasePlace, contrast_high, contrast_low);

TABLE(sweep_json, ReviewSweep,
    OWN(TEXT, ReviewSweep, condition), OWN(TEXT, ReviewSweep, eye),
    OWN(TEXT, ReviewSweep, symbol),
    AS_VERDICT("verdict", RECORD_WRITTEN, ReviewSweep, worst.verdict),
    OWN(COUNT, ReviewSweep, cases), OWN(FIGURE, ReviewSweep, failed_share),
    OWN(FIGURE, ReviewSweep, longest_failure_minutes),
    LATER("middle_eye_contrast_ratio", FIGURE, ReviewSweep, middle_contrast),
    PART("worst", MUST, ReviewSweep, worst, case_json),
    OWN(TEXT, ReviewSweep, table));

TABLE(veil_json, GazeVeil,
    OWN(FIGURE, GazeVeil, sun), OWN(FIGURE, GazeVeil, sky),
    OWN(FIGURE, GazeVeil, lamps), OWN(FIGURE, GazeVeil, glints),
    OWN(FIGURE, GazeVeil, surfaces), OWN(FIGURE, GazeVeil, near));

TABLE(road_display_json, RoadDisplay,
    OWN(TEXT, RoadDisplay, display), OWN(FIGURE, RoadDisplay, level),
    AS("veil_share", FIGURE, RoadDisplay, share),
    AS("threshold_increment_pct", FIGURE, RoadDisplay, increment_pct),
    AS("threshold_increment_interval", RANGE, RoadDisplay, increment_range),
    OWN(FIGURE, RoadDisplay, straight_share), OWN(FIGURE, RoadDisplay, mirrored_share),
    OWN(FIGURE, RoadDisplay, scattered_share), OWN(TEXT, RoadDisplay, mirrored_by),
    OWN(FIGURE, RoadDisplay, mirrored_by_share), OWN(FIGURE, RoadDisplay, level_most),
    AS("level_most_interval", RANGE, RoadDisplay, level_most_range));

TABLE(road_age_json, RoadAge,
    OWN(FIGURE, RoadAge, age_years), AS("veil_cd_m2", FIGURE, RoadAge, veil),
    AS("veil_interval", RANGE, RoadAge, veil_range),
    AS("threshold_increment_pct", FIGURE, RoadAge, increment_pct),
    AS("threshold_increment_interval", RANGE, RoadAge, increment_range),
    AS("threshold_increment_by_cie_135_pct", FIGURE, RoadAge, increment_by_spread_pct),
    PART("limit", MUST, RoadAge, limit, limit_json),
    LIST("displays", MUST, RoadAge, displays, display_count, road_display_json));

TABLE(road_dimming_json, RoadDimming,
    OWN(TEXT, RoadDimming, display), OWN(FIGURE, RoadDimming, age_years),
    OWN(FIGURE, RoadDimming, road_cd_m2), OWN(FIGURE, RoadDimming, level),
    OWN(FIGURE, RoadDimming, level_most),
    AS("level_most_interval", RANGE, RoadDimming, level_most_range),
    OWN(FIGURE, RoadDimming, level_least), OWN(FIGURE, RoadDimming, level_least_sure),
    OWN(TEXT, RoadDimming, symbol),
    AS_WORD("window", MUST | RECORD_NULL, RoadDimming, window, road_windows + 1));

TABLE(road_json, GazeRoad,
    OWN(FIGURE, GazeRoad, luminance_cd_m2), OWN(FIGURE, GazeRoad, s_p),
    OWN(FIGURE, GazeRoad, mesopic_cd_m2),
    AS_WORD("not_evaluated_because", MUST | RECORD_NULL, GazeRoad, left_out,
            road_left_outs + 1),
    AS("after_dark", FLAG, GazeRoad, is_after_dark),
    OWN(FIGURE, GazeRoad, without_data_share),
    AS("counts", FLAG, GazeRoad, has_limit), OWN(VERDICT, GazeRoad, verdict),
    AS("reason", REASON, GazeRoad, unjudged),
    LIST("ages", MUST, GazeRoad, ages, age_count, road_age_json),
    LIST("dimming", MUST, GazeRoad, dimming, dimming_count, road_dimming_json));

TABLE(gaze_json, GazeFinding,
    OWN(TEXT, GazeFinding, condition), OWN(TEXT, GazeFinding, eye),
    OWN(TEXT, GazeFinding, gaze), AS("sun_from_gaze_deg", FIGURE, GazeFinding, sun_deg),
    AS("veil_cd_m2", FIGURE, GazeFinding, veil),
    AS("veil_interval", RANGE, GazeFinding, veil_range),
    PART("veil_parts_cd_m2", MUST, GazeFinding, veil_parts, veil_json),
    AS("cornea_lx", FIGURE, GazeFinding, cornea_lux),
    AS("through_cd_m2", FIGURE, GazeFinding, through),
    AS("mirrored_cd_m2", FIGURE, GazeFinding, mirrored),
    AS("mirrored_interval", RANGE, GazeFinding, mirrored_range),
    OWN(TEXT, GazeFinding, mirrored_by), OWN(TEXT, GazeFinding, mirrored_from),
    OWN(FIGURE, GazeFinding, contrast_behind_glass), OWN(FIGURE, GazeFinding, contrast_left),
    AS("contrast_interval", RANGE, GazeFinding, contrast_range),
    GLARE_MEMBERS(GazeFinding),
    {"road", RECORD_OBJECT, RECORD_APART | RECORD_BRIEF, RECORD_AT(GazeFinding, road),
     .of = &road_json});

TABLE(response_json, ReviewResponse,
    OWN(TEXT, ReviewResponse, probe), OWN(TEXT, ReviewResponse, file),
    OWN(COUNT, ReviewResponse, paths), OWN(COUNT, ReviewResponse, bytes),
    OWN(FIGURE, ReviewResponse, relative_error));

TABLE(false_sun_json, ReviewFalseSun,
    OWN(TEXT, ReviewFalseSun, condition), OWN(TEXT, ReviewFalseSun, eye),
    OWN(TEXT, ReviewFalseSun, mirror), OWN(FIGURE, ReviewFalseSun, share),
    OWN(FIGURE, ReviewFalseSun, minutes), OWN(FIGURE, ReviewFalseSun, longest_minutes),
    OWN(TEXT, ReviewFalseSun, when),
    PART("sun", MUST, ReviewFalseSun, sun_azimuth_deg, sun_json),
    OWN(FIGURE, ReviewFalseSun, lux), OWN(TEXT, ReviewFalseSun, gaze),
    OWN(FIGURE, ReviewFalseSun, angle_deg), OWN(FIGURE, ReviewFalseSun, veil_cd_m2));

static json_t *write_outline(const void *item)
{
    const PaneFinding *f = item;
    json_t            *out = json_array();
    for (int i = 0; i < f->outline_count; i++)
        json_array_append_new(out, json_figure(f->outline_deg[i]));
    return out;
}

TABLE(pane_image_json, PaneFinding,
    OWN(TEXT, PaneFinding, condition), OWN(TEXT, PaneFinding, eye),
    OWN(TEXT, PaneFinding, display), OWN(TEXT, PaneFinding, pane),
    AS("no_image_because", TEXT, PaneFinding, none), OWN(FIGURE, PaneFinding, shown_share),
    AS("pane_ends_share", FIGURE, PaneFinding, ends_share),
    AS("turned_away_share", FIGURE, PaneFinding, away_share),
    OWN(FIGURE, PaneFinding, covered_share), OWN(TEXT, PaneFinding, covered_by),
    OWN(FIGURE, PaneFinding, right_deg), OWN(FIGURE, PaneFinding, up_deg),
    OWN(FIGURE, PaneFinding, width_deg), OWN(FIGURE, PaneFinding, height_deg),
    {"outline_deg", RECORD_FIGURES, MUST, RECORD_MANY(PaneFinding, outline_deg, outline_count),
     RECORD_RANGE(-HUGE_VAL, HUGE_VAL), .write = write_outline},
    AS("image_cd_m2", FIGURE, PaneFinding, image),
    AS("image_interval", RANGE, PaneFinding, image_range),
    AS("behind_cd_m2", FIGURE, PaneFinding, behind),
    AS("behind_interval", RANGE, PaneFinding, behind_range),
    AS("against_cd_m2", FIGURE, PaneFinding, against),
    AS("against_interval", RANGE, PaneFinding, against_range),
    OWN(FIGURE, PaneFinding, contrast),
    AS("contrast_interval", RANGE, PaneFinding, contrast_range),
    OWN(FIGURE, PaneFinding, ghost_share), OWN(FIGURE, PaneFinding, ghost_arcmin),
    OWN(TEXT, PaneFinding, area), OWN(FIGURE, PaneFinding, off_deg),
    {"limit", RECORD_OBJECT, MUST | RECORD_NULL, RECORD_AT(PaneFinding, limit),
     .count = offsetof(PaneFinding, has_limit), .of = &limit_json});

TABLE(rest_json, ReviewRest,
    {"kind", RECORD_CHOICE, MUST, RECORD_AT(ReviewRest, kind), .words = rest_kinds},
    {"basis", RECORD_CHOICE, MUST, RECORD_AT(ReviewRest, basis), .words = rest_bases},
    OWN(TEXT, ReviewRest, name), OWN(TEXT, ReviewRest, words), OWN(COUNT, ReviewRest, count),
    OWN(COUNT, ReviewRest, of));

TABLE(files_json, ReviewFile,
    OWN(TEXT, ReviewFile, path), OWN(TEXT, ReviewFile, xxh3));

TABLE(trial_json, ReviewTrial,
    OWN(FIGURE, ReviewTrial, value), OWN(VERDICT, ReviewTrial, verdict),
    AS("least_margin", FIGURE, ReviewTrial, margin), AS("of", TEXT, ReviewTrial, worst),
    AS("fresh", FLAG, ReviewTrial, is_fresh));

TABLE(mend_json, ReviewMend,
    OWN(TEXT, ReviewMend, name), OWN(TEXT, ReviewMend, unit), OWN(FIGURE, ReviewMend, at),
    AS("found", FLAG, ReviewMend, is_found), OWN(FIGURE, ReviewMend, value),
    OWN(FIGURE, ReviewMend, outside),
    LIST("trials", MUST, ReviewMend, trials, trial_count, trial_json));

/* ---- parts that others show -------------------------------------------------------------- */

static json_t *pair(double low, double high)
{
    return json_pack("[o,o]", json_figure(low), json_figure(high));
}

static json_t *text(const char *string)
{
    return string ? json_text(string) : json_null();
}

json_t *review_groups_json(const ReviewCase *c)
{
    return record_write(&groups_json, c);
}

json_t *review_remedies_json(const ReviewCase *c)
{
    return record_write_list(&remedy_json, c->remedies, c->remedy_count);
}

json_t *review_hiders_json(const ReviewCase *c)
{
    return record_write_list(&hider_json, c->hiders, c->hider_count);
}

static void set(json_t *object, const char *key, json_t *value)
{
    json_object_set_new(object, key, value);
}

/* Some of a case's; NULL behind the last. */
static void set_members(json_t *object, const ReviewCase *c, const char *const *keys)
{
    for (; *keys; keys++)
        for (const RecordRow *row = case_json.rows; row->key; row++)
            if (!strcmp(row->key, *keys)) set(object, *keys, record_write_value(row, c));
}

void review_whole_json(const ReviewCase *c, json_t *to)
{
    static const char *const KEYS[] = {"symbol_mean", "lit_share", "judged_part_uv",
                                       "must_not_be_read", NULL}; /* absent: it may be */
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

static json_t *write_slopes(const void *item)
{
    const ReviewSensitivity *s = item;
    json_t                  *slopes = json_array();
    for (int i = 0; i < s->slope_count; i++)
        json_array_append_new(slopes, slope_json(&s->slopes[i]));
    return slopes;
}

FOLLOWS(ReviewSensitivity, high, low);
TABLE(sensitivity_json, ReviewSensitivity,
    OWN(TEXT, ReviewSensitivity, name), OWN(TEXT, ReviewSensitivity, unit),
    OWN(FIGURE, ReviewSensitivity, at), OWN(FIGURE, ReviewSensitivity, step),
    AS("compared", RANGE, ReviewSensitivity, low), TOLD("symbols", 0, write_slopes));

/* ---- what is stated of the whole --------------------------------------------------------- */

static json_t *write_variants(const void *item)
{
    const Review *review = item;
    json_t       *variants = json_array();
    for (int i = 0; i < review->variant_count; i++)
        json_array_append_new(variants, variant_json(&review->variants[i]));
    return variants;
}

/* What the displays' panels say of themselves. */
static json_t *write_panels(const void *review)
{
    Arena   scratch = arena_reserve(PLACES_BYTES);
    int     count;
    json_t *list = json_array();
    const ReviewCase **displays = review_displays(review, &count, &scratch);
    for (int i = 0; i < count; i++) {
        json_t *panel = record_write(&panel_json, &displays[i]->panel);
        set(panel, "display", text(displays[i]->display));
        json_array_append_new(list, panel);
    }
    arena_release(&scratch);
    return list;
}

static json_t *write_places(const void *review)
{
    Arena         scratch = arena_reserve(PLACES_BYTES);
    int           count;
    ReviewPlaces *places = review_places(review, &count, &scratch);
    json_t       *list = json_array();
    for (int i = 0; i < count; i++) {
        const ReviewCase *at = places[i].at;
        double passing = places[i].passing_share;
        double read = at->must_not_be_read ? 1 - passing : passing;
        json_t *place = json_pack("{s:o, s:o, s:f, s:o}", "eye", text(at->eye), "symbol",
                                  text(at->symbol), "read_share", read, "condition",
                                  text(at->condition));
        if (at->must_not_be_read) set(place, "must_not_be_read", json_true());
        json_array_append_new(list, place);
    }
    arena_release(&scratch);
    return list;
}

static json_t *write_rests(const void *review)
{
    Arena   scratch = arena_reserve(PLACES_BYTES);
    json_t *line = text(review_rests_words(review, &scratch));
    arena_release(&scratch);
    return line;
}

static json_t *write_data_share(const void *review)
{
    (void)review;
    return json_real(UNJUDGED_DATA_SHARE);
}

/* Nobody may take one that is not finished for one that passes. */
static bool is_provisional(const Review *review)
{
    return review->is_partial && review->pass;
}

static json_t *write_pass(const void *review)
{
    return json_boolean(((const Review *)review)->pass && !is_provisional(review));
}

static json_t *write_verdict(const void *review)
{
    return json_string(is_provisional(review) ? "provisional"
                                              : verdict_names[review_verdict(review)]);
}

TABLE(whole_json, Review,
    {"pass", RECORD_FLAG, MUST, RECORD_AT(Review, pass), .write = write_pass},
    TOLD("verdict", 0, write_verdict), AS("strict", FLAG, Review, is_strict),
    OWN(TEXT, Review, title), OWN(TEXT, Review, profile),
    AS_FLAG("provisional", RECORD_BRIEF, Review, is_partial),
    AS_TEXT("to_come", RECORD_WRITTEN | RECORD_BRIEF, Review, to_come),
    LIST("cases", MUST, Review, cases, case_count, case_json),
    LIST("sweeps", MUST, Review, sweeps, sweep_count, sweep_json),
    LIST("gazes", MUST, Review, gazes, gaze_count, gaze_json),
    LIST("false_suns", MUST, Review, false_suns, false_sun_count, false_sun_json),
    LIST("pane_images", RECORD_BRIEF, Review, pane_images, pane_image_count, pane_image_json),
    TOLD("variants", RECORD_BRIEF, write_variants),
    LIST("sensitivity", RECORD_WRITTEN | RECORD_BRIEF, Review, sensitivities, sensitivity_count,
         sensitivity_json),
    LIST("mends", RECORD_WRITTEN | RECORD_BRIEF, Review, mends, mend_count, mend_json),
    TOLD("eye_places", 0, write_places), TOLD("panels", 0, write_panels),
    LIST("responses", MUST, Review, responses, response_count, response_json),
    AS_TEXT("without_data", RECORD_WRITTEN, Review, without_data),
    TOLD("without_data_share_most", 0, write_data_share),
    LIST("rests_on", 0, Review, rests_on, rests_on_count, rest_json),
    TOLD("rests_on_line", 0, write_rests),
    LIST("inputs", 0, Review, inputs, input_count, files_json),
    {"notes", RECORD_TEXTS, MUST, RECORD_MANY(Review, notes, note_count)});

json_t *review_json(const Review *review)
{
    return record_write(&whole_json, review);
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

bool review_json_read(const char *file, Arena *arena, Review *out, Error *err)
{
    JsonView root;
    Review   review = {0};
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = record_read(&root, &whole_json, &review, err);
    json_view_close(&root);
    if (ok) *out = review;
    return ok;
}
