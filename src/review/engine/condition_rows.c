/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/condition_rows.h"

#include <limits.h>

#include "base/count.h"
#include "review/pane_verdict.h"
#include "review/private_image.h"
#include "review/road_verdict.h"

/* Doubles and longs, from the first through the last: they lie one behind the other. */
#define NUMBERS(Type, first, last) \
    {.kind = PACK_NUMBERS, \
     .offset = offsetof(Type, first), \
     .size = offsetof(Type, last) + sizeof(((Type *)0)->last) - offsetof(Type, first)}
#define NUMBER(Type, member) NUMBERS(Type, member, member)
#define FLOATS(Type, first, last) \
    {.kind = PACK_FLOATS, \
     .offset = offsetof(Type, first), \
     .size = offsetof(Type, last) + sizeof(((Type *)0)->last) - offsetof(Type, first)}
#define INT(Type, member, bottom, top) \
    {.kind = PACK_INT, .offset = offsetof(Type, member), .low = (bottom), .high = (top)}
#define CHOICE(Type, member, count) INT(Type, member, 0, (count) - 1)
#define FLAG(Type, member) {.kind = PACK_FLAG, .offset = offsetof(Type, member)}
#define TEXT(Type, member) {.kind = PACK_TEXT, .offset = offsetof(Type, member)}
#define PART(Type, member, format) \
    {.kind = PACK_PART, .offset = offsetof(Type, member), .of = &(format)}
#define ONE(Type, member, format) \
    {.kind = PACK_ONE, .offset = offsetof(Type, member), .of = &(format)}
#define LIST(Type, member, counted, format) \
    {.kind = PACK_LIST, \
     .offset = offsetof(Type, member), \
     .count = offsetof(Type, counted), \
     .of = &(format)}
#define TEXTS(Type, member, counted) \
    {.kind = PACK_TEXTS, .offset = offsetof(Type, member), .count = offsetof(Type, counted)}

#define ROWS(name, ...) static const PackRow name##_rows[] = {__VA_ARGS__}
#define FORMAT(name, Type) {sizeof(Type), name##_rows, COUNT_OF(name##_rows), NULL}

enum { VERDICTS = VERDICT_UNJUDGED + 1, AMBIENTS = AMBIENT_SUN + 1 };

/* ---- cases ------------------------------------------------------------------------------- */

ROWS(limit, TEXT(LimitVerdict, name), TEXT(LimitVerdict, kind), TEXT(LimitVerdict, unit),
     TEXT(LimitVerdict, source), NUMBER(LimitVerdict, value),
     FLAG(LimitVerdict, read_in_the_standard), FLAG(LimitVerdict, is_upper),
     FLAG(LimitVerdict, is_advice), NUMBERS(LimitVerdict, found, margin),
     CHOICE(LimitVerdict, verdict, VERDICTS), NUMBER(LimitVerdict, age_years),
     TEXT(LimitVerdict, by_pane), FLAG(LimitVerdict, has_veil), TEXT(LimitVerdict, beside));
static const PackFormat limit = FORMAT(limit, LimitVerdict);

ROWS(panel, TEXT(CasePanel, verdict), TEXT(CasePanel, reason), FLAG(CasePanel, is_coarse),
     FLAG(CasePanel, is_unusable), NUMBERS(CasePanel, emission_error, reflection_error),
     TEXT(CasePanel, assumed));
static const PackFormat panel = FORMAT(panel, CasePanel);

ROWS(point, FLOATS(Vec3, x, z));
static const PackFormat point = FORMAT(point, Vec3);

ROWS(ray, LIST(CaseRay, points, count, point));
static const PackFormat ray = FORMAT(ray, CaseRay);

ROWS(cause, TEXTS(CaseCause, chain, links), NUMBERS(CaseCause, share, contrast_without),
     LIST(CaseCause, rays, ray_count, ray));
static const PackFormat cause = FORMAT(cause, CaseCause);

ROWS(share, TEXT(CaseShare, what), NUMBERS(CaseShare, share, cd_m2));
static const PackFormat share = FORMAT(share, CaseShare);

ROWS(hider, TEXT(CaseHider, what), NUMBER(CaseHider, share));
static const PackFormat hider = FORMAT(hider, CaseHider);

ROWS(group, LIST(CaseGroup, list, count, share));
static const PackFormat group = FORMAT(group, CaseGroup);

ROWS(view, FLOATS(CaseView, eye, forward), FLAG(CaseView, is_perspective),
     NUMBERS(CaseView, half_width, half_height), INT(CaseView, width, 1, 1 << 20),
     INT(CaseView, height, 1, 1 << 20));
static const PackFormat view = FORMAT(view, CaseView);

ROWS(remedy_break, TEXT(RemedyBreak, subject), TEXT(RemedyBreak, viewer),
     PART(RemedyBreak, line, limit));
static const PackFormat remedy_break = FORMAT(remedy_break, RemedyBreak);

ROWS(remedy, TEXT(CaseRemedy, what), NUMBERS(CaseRemedy, contrast_ratio, level),
     PART(CaseRemedy, then, limit), CHOICE(CaseRemedy, verdict, VERDICTS),
     LIST(CaseRemedy, breaks, break_count, remedy_break));
static const PackFormat remedy = FORMAT(remedy, CaseRemedy);

ROWS(level, NUMBER(CaseVisibility, age_years), FLAG(CaseVisibility, is_observer),
     NUMBERS(CaseVisibility, size_arcmin, high), TEXT(CaseVisibility, doubts));
static const PackFormat level = FORMAT(level, CaseVisibility);

ROWS(colour, TEXT(CaseColour, symbol), NUMBERS(CaseColour, uv, sampling));
static const PackFormat colour = FORMAT(colour, CaseColour);

ROWS(place, NUMBER(CasePlace, eye_m), CHOICE(CasePlace, verdict, VERDICTS),
     NUMBERS(CasePlace, visible_share, contrast_high));
static const PackFormat place = FORMAT(place, CasePlace);

ROWS(image, TEXT(CaseImage, pane), NUMBERS(CaseImage, eye_m, contrast_high),
     CHOICE(CaseImage, verdict, VERDICTS));
static const PackFormat image = FORMAT(image, CaseImage);

typedef struct Batches {
    double each[CASE_BATCHES];
} Batches;
ROWS(batches, NUMBER(Batches, each));
static const PackFormat batches = FORMAT(batches, Batches);

static bool case_is_sound(const void *item) {
    const ReviewCase *c = item;
    return c->condition && c->eye && c->symbol && c->limit_id < c->limit_count;
}

ROWS(review_case, TEXT(ReviewCase, condition), TEXT(ReviewCase, eye), TEXT(ReviewCase, symbol),
     TEXT(ReviewCase, display), CHOICE(ReviewCase, ambient, AMBIENTS), TEXT(ReviewCase, when),
     FLAG(ReviewCase, has_sun), NUMBERS(ReviewCase, sun_azimuth_deg, visibility),
     LIST(ReviewCase, visibilities, visibility_count, level),
     LIST(ReviewCase, colours, colour_count, colour), NUMBER(ReviewCase, paths),
     ONE(ReviewCase, batches, batches), NUMBERS(ReviewCase, precision_asked, alike_within),
     CHOICE(ReviewCase, open_by, OPEN_COUNT), NUMBER(ReviewCase, visible_share),
     LIST(ReviewCase, hiders, hider_count, hider), NUMBERS(ReviewCase, eye_failed_share, origin_m),
     FLAG(ReviewCase, is_optional), FLAG(ReviewCase, must_not_be_read),
     LIST(ReviewCase, places, place_count, place), LIST(ReviewCase, images, image_count, image),
     NUMBERS(ReviewCase, level, glasses_transmittance), TEXT(ReviewCase, glasses),
     NUMBER(ReviewCase, glasses_display_loss), PART(ReviewCase, panel, panel),
     NUMBERS(ReviewCase, own_reflected, display_lux), LIST(ReviewCase, limits, limit_count, limit),
     INT(ReviewCase, limit_id, -1, INT_MAX), NUMBER(ReviewCase, margin),
     CHOICE(ReviewCase, verdict, VERDICTS), CHOICE(ReviewCase, unjudged, UNJUDGED_COUNT),
     LIST(ReviewCase, causes, cause_count, cause), PART(ReviewCase, groups[GROUP_LIGHT], group),
     PART(ReviewCase, groups[GROUP_OPENING], group), PART(ReviewCase, groups[GROUP_SURFACE], group),
     NUMBERS(ReviewCase, without_data_share, extrapolated_share), TEXT(ReviewCase, empty_seat),
     NUMBER(ReviewCase, empty_seat_share), LIST(ReviewCase, remedies, remedy_count, remedy));
static const PackFormat review_case = {sizeof(ReviewCase), review_case_rows,
                                       COUNT_OF(review_case_rows), case_is_sound};

ROWS(sight, INT(CaseSight, case_id, 0, INT_MAX), TEXT(CaseSight, frame), ONE(CaseSight, view, view),
     LIST(CaseSight, rim, rim_count, point));
const PackFormat condition_sight = FORMAT(sight, CaseSight);

/* ---- sweeps ------------------------------------------------------------------------------ */

static bool sweep_is_sound(const void *item) {
    const ReviewSweep *s = item;
    return s->condition && s->eye && s->symbol;
}

ROWS(sweep, TEXT(ReviewSweep, condition), TEXT(ReviewSweep, eye), TEXT(ReviewSweep, symbol),
     NUMBERS(ReviewSweep, cases, middle_contrast), PART(ReviewSweep, worst, review_case));
static const PackFormat sweep = {sizeof(ReviewSweep), sweep_rows, COUNT_OF(sweep_rows),
                                 sweep_is_sound};

ROWS(step,
     {.kind = PACK_NUMBERS,
      .offset = offsetof(StepKept, figures),
      .size = sizeof(((StepKept *)0)->figures)},
     CHOICE(StepKept, verdict, VERDICTS));
static const PackFormat step = FORMAT(step, StepKept);

ROWS(sun, NUMBERS(SweepSun, azimuth_deg, minutes), INT(SweepSun, step, -1, INT_MAX),
     INT(SweepSun, heading_id, 0, INT_MAX), NUMBERS(SweepSun, later_minutes, light));
static const PackFormat sun = FORMAT(sun, SweepSun);

static bool table_is_sound(const void *item) {
    const TableKept *table = item;
    return table->worst < table->step_count;
}

ROWS(table, INT(TableKept, sweep_id, 0, INT_MAX), INT(TableKept, worst, -1, INT_MAX),
     FLAG(TableKept, is_private), PART(TableKept, worst_sun, sun),
     LIST(TableKept, steps, step_count, step));
const PackFormat condition_table = {sizeof(TableKept), table_rows, COUNT_OF(table_rows),
                                    table_is_sound};

ROWS(false_sun, TEXT(ReviewFalseSun, condition), TEXT(ReviewFalseSun, eye),
     TEXT(ReviewFalseSun, mirror), NUMBERS(ReviewFalseSun, share, longest_minutes),
     TEXT(ReviewFalseSun, when), NUMBERS(ReviewFalseSun, sun_azimuth_deg, lux),
     TEXT(ReviewFalseSun, gaze), NUMBERS(ReviewFalseSun, angle_deg, veil_cd_m2),
     LIST(ReviewFalseSun, limits, limit_count, limit), CHOICE(ReviewFalseSun, verdict, VERDICTS));
static const PackFormat false_sun = FORMAT(false_sun, ReviewFalseSun);

ROWS(response, TEXT(ReviewResponse, probe), TEXT(ReviewResponse, file),
     NUMBERS(ReviewResponse, paths, relative_error));
static const PackFormat response = FORMAT(response, ReviewResponse);

/* ---- gazes ------------------------------------------------------------------------------- */

ROWS(road_display, TEXT(RoadDisplay, display), NUMBERS(RoadDisplay, level, scattered_share),
     TEXT(RoadDisplay, mirrored_by), NUMBERS(RoadDisplay, mirrored_by_share, level_most_range));
static const PackFormat road_display = FORMAT(road_display, RoadDisplay);

ROWS(road_age, NUMBERS(RoadAge, age_years, increment_by_spread_pct), PART(RoadAge, limit, limit),
     LIST(RoadAge, displays, display_count, road_display));
static const PackFormat road_age = FORMAT(road_age, RoadAge);

ROWS(dimming, TEXT(RoadDimming, display), NUMBERS(RoadDimming, age_years, level_least_sure),
     TEXT(RoadDimming, symbol), CHOICE(RoadDimming, window, ROAD_WINDOWS));
static const PackFormat dimming = FORMAT(dimming, RoadDimming);

ROWS(road, NUMBERS(GazeRoad, luminance_cd_m2, mesopic_cd_m2), FLAG(GazeRoad, is_after_dark),
     CHOICE(GazeRoad, left_out, ROAD_LEFT_OUTS), NUMBER(GazeRoad, without_data_share),
     LIST(GazeRoad, ages, age_count, road_age), LIST(GazeRoad, dimming, dimming_count, dimming));
static const PackFormat road = FORMAT(road, GazeRoad);

ROWS(gaze, TEXT(GazeFinding, condition), TEXT(GazeFinding, eye), TEXT(GazeFinding, gaze),
     NUMBERS(GazeFinding, sun_deg, mirrored_range), TEXT(GazeFinding, mirrored_by),
     TEXT(GazeFinding, mirrored_from), NUMBERS(GazeFinding, contrast_behind_glass, contrast_range),
     ONE(GazeFinding, road, road), LIST(GazeFinding, limits, limit_count, limit),
     CHOICE(GazeFinding, verdict, VERDICTS), CHOICE(GazeFinding, unjudged, UNJUDGED_COUNT));
static const PackFormat gaze = FORMAT(gaze, GazeFinding);

ROWS(angle, {.kind = PACK_NUMBERS, .size = sizeof(double)});
static const PackFormat angle = FORMAT(angle, double);

ROWS(pane, TEXT(PaneFinding, condition), TEXT(PaneFinding, eye), TEXT(PaneFinding, display),
     TEXT(PaneFinding, pane), NUMBERS(PaneFinding, shown_share, covered_share),
     TEXT(PaneFinding, covered_by), TEXT(PaneFinding, none),
     NUMBERS(PaneFinding, right_deg, height_deg),
     LIST(PaneFinding, outline_deg, outline_count, angle),
     {.kind = PACK_LIST,
      .offset = offsetof(PaneFinding, corners),
      .count = offsetof(PaneFinding, outline_count),
      .low = 2,
      .of = &point},
     NUMBERS(PaneFinding, image, ghost_arcmin), TEXT(PaneFinding, area),
     NUMBER(PaneFinding, off_deg), FLAG(PaneFinding, has_limit), PART(PaneFinding, limit, limit),
     LIST(PaneFinding, breaks, break_count, remedy_break));
static const PackFormat pane = FORMAT(pane, PaneFinding);

/* ---- what they rest on ------------------------------------------------------------------- */

ROWS(rest, CHOICE(ReviewRest, kind, REST_KINDS), CHOICE(ReviewRest, basis, REST_BASES),
     TEXT(ReviewRest, name), TEXT(ReviewRest, words), NUMBERS(ReviewRest, count, of));
static const PackFormat rest = FORMAT(rest, ReviewRest);

static bool file_is_sound(const void *item) {
    const ReviewFile *file = item;
    return file->path && file->xxh3;
}

ROWS(file, TEXT(ReviewFile, path), TEXT(ReviewFile, xxh3));
static const PackFormat file = {sizeof(ReviewFile), file_rows, COUNT_OF(file_rows), file_is_sound};

ROWS(review, LIST(Review, cases, case_count, review_case), LIST(Review, sweeps, sweep_count, sweep),
     LIST(Review, gazes, gaze_count, gaze), LIST(Review, responses, response_count, response),
     LIST(Review, false_suns, false_sun_count, false_sun),
     LIST(Review, pane_images, pane_image_count, pane), TEXT(Review, without_data),
     INT(Review, without_data_count, 0, INT_MAX), LIST(Review, rests_on, rests_on_count, rest),
     LIST(Review, inputs, input_count, file));
const PackFormat condition_review = FORMAT(review, Review);
