/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <string.h>

#include "record/rows.h"
#include "review/request/request_format.h"
#include "vision/road_glare.h"

#define OWNER ReviewEye
#define METRES_MAX 1e6

/* ---- eyes -------------------------------------------------------------------------------- */

static const RecordRow CAMERA[] = {
    TEXT("a camera's name", RECORD_FILLED, camera, "A node's or a camera's name."),
    WHOLE("its index", 0, camera_id, 0, 1000000, "The scene's camera, counted from 0."),
    {0}};

static const RecordRow EYE[] = {
    {"camera", RECORD_EITHER, .forms = CAMERA},
    VECTOR("position_m", RECORD_OPEN, position_m, 3, -METRES_MAX, METRES_MAX, "In the scene, m."),
    VECTOR("centre_m", RECORD_OPEN, position_m, 3, -METRES_MAX, METRES_MAX,
           "Of a box or an ellipse of eyes, m."),
    VECTOR("half_size_m", RECORD_OPEN, half_size_m, 3, 0, 10, "Of a box, m."),
    VECTOR("ellipse_m", RECORD_OPEN, axes_m, 3, 0, 10,
           "Lengths of its axes ahead, across and up, m: an eyellipse of SAE J941."),
    WHOLES("grid", 0, grid, 3, 1, 33, "Of a box: points along each axis, both ends in."),
    NUMBER("tilt_deg", 0, tilt_deg, -90, 90, "Of an ellipse: its front down, degrees."),
    TEXT("proposed_from", RECORD_FILLED, proposed_from,
         "Left by `review --init` and `equip`: from what the eye was proposed. Delete it when "
         "the eye is right; until then a review says that its eye is a proposal."),
    {0}};

static void start_eye(void *item) {
    *(ReviewEye *)item = (ReviewEye){.camera_id = NO_ID, .grid = {3, 3, 3}};
}

static bool check_grid(const JsonView *view, const ReviewEye *eye, Error *err) {
    for (int axis = 0; axis < 3; axis++)
        if (eye->grid[axis] > 1 && !(eye->half_size_m[axis] > 0))
            return record_fails(view, "grid", err,
                                "has %d points along an axis without length, required: 1 there",
                                eye->grid[axis]);
    return true;
}

static bool check_wide(const JsonView *view, ReviewEye *eye, Error *err) {
    bool is_ellipse = record_has(view, "ellipse_m");
    if (is_ellipse && record_has(view, "half_size_m"))
        return record_fails(view, "ellipse_m", err, "stands beside 'half_size_m', required: one");
    if (is_ellipse && record_has(view, "grid"))
        return record_fails(view, "grid", err, "is a box's, not an ellipse's");
    if (!is_ellipse && record_has(view, "tilt_deg"))
        return record_fails(view, "tilt_deg", err, "is an ellipse's: 'ellipse_m' is missing");
    if (!is_ellipse && !record_has(view, "half_size_m"))
        return record_misses(view, "half_size_m", err);
    eye->kind = is_ellipse ? EYE_ELLIPSE : EYE_BOX;
    return is_ellipse || check_grid(view, eye, err);
}

static bool check_eye(const JsonView *view, void *item, Error *err) {
    ReviewEye *eye = item;
    bool has_centre = record_has(view, "centre_m");
    int forms = record_has(view, "camera") + record_has(view, "position_m") + has_centre;
    bool has_more = record_has(view, "half_size_m") || record_has(view, "ellipse_m") ||
                    record_has(view, "grid") || record_has(view, "tilt_deg");
    if (forms != 1 || (!has_centre && has_more))
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "is %s, required: one of 'camera', 'position_m', or 'centre_m' with "
                        "'half_size_m' or 'ellipse_m'",
                        forms > 1 ? "said in several ways"
                        : forms   ? "a box without a centre"
                                  : "nowhere");
    eye->kind = record_has(view, "camera") ? EYE_CAMERA : EYE_POINT;
    return !has_centre || check_wide(view, eye, err);
}

const RecordFormat review_eye_format = {
    "eye",
    sizeof(OWNER),
    EYE,
    .start = start_eye,
    .check = check_eye,
    .rules = "{'oneOf': [{'required': ['camera']}, {'required': ['position_m']}, "
             "{'required': ['centre_m'], 'anyOf': [{'required': ['half_size_m']}, "
             "{'required': ['ellipse_m']}]}], 'dependentRequired': {'half_size_m': "
             "['centre_m'], 'ellipse_m': ['centre_m'], 'grid': ['half_size_m'], "
             "'tilt_deg': ['ellipse_m']}, 'not': {'required': ['half_size_m', "
             "'ellipse_m']}}"};

#undef OWNER

/* ---- where they look --------------------------------------------------------------------- */

#define OWNER ReviewRoad

static const RecordRow ROAD[] = {
    NUMBER("luminance_cd_m2", MUST, luminance_cd_m2, ROAD_LUMINANCE_MIN, 1000,
           "Photopic, the mean of the road itself."),
    NUMBER("s_p", RECORD_OPEN | RECORD_ABOVE, s_p, 0, 10,
           "Scotopic over photopic luminance of its light: for the mesopic luminance."),
    FIGURES("ages_years", 0, ages, age_count, 1, ROAD_AGES_MOST, HUMAN_EYE_AGE_MIN,
            HUMAN_EYE_AGE_MAX, "Rising. Default: the observer's."),
    FIGURES("dimming_cd_m2", 0, dimming, dimming_count, 1, ROAD_DIMMING_MOST, ROAD_LUMINANCE_MIN,
            1000, "Rising: the road luminances of the table of levels. Default: 0.1 to 2."),
    {"conditions", RECORD_TEXTS, RECORD_MANY(OWNER, conditions, condition_count),
     RECORD_COUNT(1, 1000),
     .doc = "Names of those in which it is evaluated: moments, where no sun stands above the "
            "horizon; sweeps, as after dark, without sun and sky. Default: all "
            "such moments."},
    {0}};

static void start_road(void *item) {
    *(ReviewRoad *)item = (ReviewRoad){.s_p = NAN};
}

static bool check_rising(const JsonView *view, const char *key, const double *list, int count,
                         Error *err) {
    for (int i = 1; i < count; i++)
        if (!(list[i] > list[i - 1]))
            return record_fails(view, key, err, "has %g behind %g, required: rising numbers",
                                list[i], list[i - 1]);
    return true;
}

static bool check_road(const JsonView *view, void *item, Error *err) {
    const ReviewRoad *road = item;
    return check_rising(view, "ages_years", road->ages, road->age_count, err) &&
           check_rising(view, "dimming_cd_m2", road->dimming, road->dimming_count, err);
}

static const RecordFormat road_format = {"road", sizeof(OWNER), ROAD, .start = start_road,
                                         .check = check_road};

#undef OWNER
#define OWNER ReviewGaze

static const char *const SYMBOLS[] = {"symbols", NULL};

static const RecordRow LOOKER = {.kind = RECORD_REFER, .among = &review_eye_names};
static const RecordFormat looker_format = {"looker", sizeof(int), .value = &LOOKER};

typedef struct Lookers {
    const int *eyes;
    int count;
} Lookers;

/* Which eyes look so: those of the list. */
static bool read_lookers(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    Lookers listed;
    const ReviewRequest *request = view->whole;
    ReviewGaze *gaze = item;
    if (!record_read_kind(view, row, &listed, err)) return false;
    gaze->for_eye = ARENA_NEW(view->arena, bool, request->eye_count);
    for (int i = 0; i < listed.count; i++) gaze->for_eye[listed.eyes[i]] = true;
    return true;
}

static const RecordRow GAZE[] = {
    {"at", RECORD_CONST, .words = SYMBOLS},
    VECTOR("direction", RECORD_UNIT, direction, 3, -METRES_MAX, METRES_MAX,
           "In the scene; of any length but 0."),
    TEXT("name", RECORD_FILLED, name,
         "What the report calls it; default of what is at the symbols: symbols."),
    {"eyes", RECORD_LIST, RECORD_MANY(Lookers, eyes, count), RECORD_COUNT(1, 256),
     .of = &looker_format, .read = read_lookers,
     .doc = "Names of the eyes that look so; default: all."},
    OBJECT("road", RECORD_APART, road, road_format,
           "The gaze is at a road that is lit by night: the threshold increment of all that "
           "the eye sees is evaluated."),
    {0}};

static bool check_gaze(const JsonView *view, void *item, Error *err) {
    ReviewGaze *gaze = item;
    ReviewRequest *request = view->whole;
    gaze->at_symbols = record_has(view, "at");
    if (!record_one_of(view, "at", "direction", err)) return false;
    if (gaze->road && gaze->at_symbols)
        return record_fails(view, "road", err,
                            "stands beside 'at', required: a gaze with a 'direction'");
    if (!gaze->name && !gaze->at_symbols) return record_misses(view, "name", err);
    if (!gaze->name) gaze->name = SYMBOLS[0];
    for (const ReviewGaze *before = request->gazes; before < gaze; before++)
        if (!strcmp(before->name, gaze->name))
            return error_at(err, ERROR_INPUT, view->file, view->path,
                            "is the second gaze named '%.60s', required: another name", gaze->name);
    return true;
}

const RecordFormat review_gaze_format = {
    "gaze", sizeof(OWNER), GAZE, .check = check_gaze,
    .rules = "{'oneOf': [{'required': ['at']}, {'required': ['direction']}], "
             "'dependentRequired': {'direction': ['name'], 'road': ['direction']}}"};
