/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>

#include "record/rows.h"
#include "review/request/request_format.h"

#define LUX_MAX 1e7
#define LEVEL_MAX 100.0 /* that a panel may be driven to, 1: as measured */

/* ---- fixed ------------------------------------------------------------------------------- */

/* 25 is meant as 25 %: a level above what was measured has to say so. */
static bool check_level(const JsonView *view, const char *place, double level, Error *err) {
    double most = ((const ReviewRequest *)view->whole)->max_level;
    return (level >= 0 && level <= most) ||
           record_fails(view, place, err,
                        "is %.9g, required: a level from 0 to %g: 1 is as measured, 0.25 a "
                        "quarter of it; \"max_level\" of the request allows panels driven "
                        "above that",
                        level, most);
}

static bool read_level(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    RecordRow any = *row;
    any.low = -HUGE_VAL, any.high = HUGE_VAL;
    return record_read_kind(view, &any, item, err) &&
           check_level(view, row->key, ((ReviewFixedLevel *)item)->level, err);
}

static const RecordRow FIXED = {.kind = RECORD_NUMBER,
                                RECORD_AT(ReviewFixedLevel, level),
                                RECORD_RANGE(0, LEVEL_MAX),
                                .read = read_level};
static const RecordFormat fixed_format = {"fixed", sizeof(ReviewFixedLevel), .value = &FIXED};

/* ---- by a sensor ------------------------------------------------------------------------- */

#define OWNER ReviewLevel

static const RecordRow SENSOR[] = {
    VECTOR("position_m", MUST, position_m, 3, -1e6, 1e6, "m."),
    VECTOR("normal", MUST | RECORD_UNIT, normal, 3, -1e6, 1e6, "Where it looks."),
    {0}};
static const RecordFormat sensor_format = {"sensor", sizeof(OWNER), SENSOR, .doc = NULL};

static const RecordRow POINT = {.kind = RECORD_NUMBERS,
                                RECORD_AT(ReviewLevelPoint, lux),
                                RECORD_RANGE(0, LUX_MAX),
                                RECORD_COUNT(2, 2)};
_Static_assert(sizeof(ReviewLevelPoint) == 2 * sizeof(double), "a pair");
static const RecordFormat point_format = {"point", sizeof(ReviewLevelPoint), .value = &POINT};

static const RecordRow CURVE[] = {
    {"sensor", RECORD_OBJECT, MUST, .of = &sensor_format},
    LIST("table_lx", MUST, points, point_count, 1, 10000, point_format,
         "[illuminance of the sensor in lx, level of all displays]: lx rise, levels do not "
         "fall. Straight in log-log between two points (in lx where one is at 0), the end's "
         "beyond the ends."),
    {0}};

/* Each point of the table is held against the one before. */
static bool check_curve(const JsonView *view, void *item, Error *err) {
    const ReviewLevel *curve = item;
    for (int i = 0; i < curve->point_count; i++) {
        const ReviewLevelPoint *p = &curve->points[i];
        const char *place = arena_format(view->arena, "table_lx/%d", i);
        if (!check_level(view, arena_format(view->arena, "%s/1", place), p->level, err))
            return false;
        if (i && !(p->lux > p[-1].lux))
            return record_fails(view, place, err, "is at %g lx behind %g lx, required: more lx",
                                p->lux, p[-1].lux);
        if (i && p->level < p[-1].level)
            return record_fails(view, place, err,
                                "falls from level %g to %g, required: one that does not fall",
                                p[-1].level, p->level);
    }
    return true;
}

static const RecordFormat curve_format = {"curve", sizeof(OWNER), CURVE, .check = check_curve};

/* ---- either ------------------------------------------------------------------------------ */

static const RecordRow LEVEL_FORMS[] = {
    MAP("levels by display", 0, fixed, fixed_count, 1000, fixed_format, NULL),
    {"a sensor with a table", RECORD_OBJECT, .count = offsetof(OWNER, is_curve),
     .of = &curve_format},
    {0}};

static bool read_either(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const json_t *value = json_object_get(view->object, row->key);
    bool is_curve = json_object_get(value, "sensor") || json_object_get(value, "table_lx");
    RecordRow own = row->forms[is_curve];
    own.key = row->key;
    return record_read_kind(view, &own, item, err);
}

static const RecordRow LEVEL = {.kind = RECORD_EITHER, .forms = LEVEL_FORMS, .read = read_either};
const RecordFormat review_level_format = {"level", sizeof(OWNER), .value = &LEVEL};
