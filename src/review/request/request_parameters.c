/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_parameters.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "record/rows.h"
#include "review/request/request_format.h"

#define PARAMETERS_MAX 100
#define GLASS 1.52
#define QUARTER_WAVE_NM 137.5 /* 550 nm / 4, to be divided by the layer's index */

#define OWNER ReviewParameter
#define STEP(key, most, words) NUMBER(key, 0, step, 1e-6, most, words)
#define TARGET(key) TEXT(key, RECORD_FILLED, target, "What is turned.")

/* Each kind by the key that holds its step, the place of its row in PARAMETER. */
static const struct {
    const char *target; /* the key that names what is changed */
    double      at, low, high; /* where it stands; what is tried unless a range is given */
    double      range[2];      /* what a range may hold */
    bool        has_direction, has_with;
} KINDS[PARAMETER_KINDS] = {
    [PARAMETER_TILT] = {"node", 0, -20, 20, {-180, 180}, false, true},
    [PARAMETER_TURN] = {"node", 0, -20, 20, {-180, 180}, false, true},
    [PARAMETER_ROLL] = {"node", 0, -20, 20, {-180, 180}, false, true},
    [PARAMETER_SHIFT] = {"node", 0, -0.2, 0.2, {-180, 180}, true, true},
    [PARAMETER_HOOD] = {"display", 0, 0, 0.2, {0, 180}, false, false},
    [PARAMETER_EYE] = {"eye", 0, -0.2, 0.2, {-180, 180}, true, false},
    [PARAMETER_BRIGHTNESS] = {"display", 1, 0.05, 20, {1e-3, 180}, false, false},
    [PARAMETER_REFLECTANCE] = {"material", 0, 0, BARE_REFLECTANCE, {0, BARE_REFLECTANCE}, false,
                               false},
};

/* ---- reading ----------------------------------------------------------------------------- */

static bool read_eye(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    int       eye;
    RecordRow name = {row->key, RECORD_REFER, .among = &review_eye_names};
    return record_read_kind(view, row, item, err) && record_read_kind(view, &name, &eye, err);
}

static const RecordRow PARAMETER[] = {
    [PARAMETER_TILT] = STEP("tilt_deg", 45, "Step, of a node."),
    [PARAMETER_TURN] = STEP("turn_deg", 45, "Step, of a node."),
    [PARAMETER_ROLL] = STEP("roll_deg", 45, "Step, of a node."),
    [PARAMETER_SHIFT] = STEP("shift_m", 10, "Step along direction, of a node."),
    [PARAMETER_HOOD] = STEP("hood_m", 1, "Step, of a hood over a display."),
    [PARAMETER_EYE] = STEP("eye_m", 10, "Step along direction, of an eye."),
    [PARAMETER_BRIGHTNESS] = STEP("brightness", 1,
                                  "Step, in times as bright, of a display or *."),
    [PARAMETER_REFLECTANCE] = STEP("reflectance", 0.02,
                                   "Step, of a material's coating: a quarter wave at 550 nm on "
                                   "glass of index 1.52."),
    TARGET("node"), TARGET("display"), TARGET("material"),
    {"eye", RECORD_TEXT, RECORD_FILLED, RECORD_AT(OWNER, target), .read = read_eye},
    VECTOR("direction", RECORD_UNIT, direction, 3, -1e6, 1e6, "Not zero."),
    {"with", RECORD_TEXTS, RECORD_MANY(OWNER, with, with_count), RECORD_COUNT(1, 1000),
     .doc = "Nodes of the same file that move along: glass, rim."},
    NUMBER("at", 0, at, 0, BARE_REFLECTANCE, "The reflectance as it stands."),
    VECTOR("range", 0, low, 2, -180, 180,
           "What --mend may try: least and most, in the step's unit."),
    {0}};
_Static_assert(offsetof(OWNER, high) == offsetof(OWNER, low) + sizeof(double), "a pair");

static void start_parameter(void *item)
{
    *(ReviewParameter *)item = (ReviewParameter){.at = NAN, .low = NAN, .high = NAN};
}

static bool find_kind(const JsonView *view, ReviewParameter *out, Error *err)
{
    int found = 0;
    for (int k = 0; k < PARAMETER_KINDS; k++)
        if (record_has(view, PARAMETER[k].key)) {
            out->kind = (ReviewParameterKind)k;
            found++;
        }
    return found == 1 ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has %d steps, required: one of 'tilt_deg', 'turn_deg', 'roll_deg', "
                    "'shift_m', 'hood_m', 'eye_m', 'brightness', 'reflectance'", found);
}

/* The keys that its kind has, besides the step: those it needs are there, others are not. A
 * coating's reflectance is not derived from its layers: `at` gives it. */
static bool check_keys(const JsonView *view, const ReviewParameter *p, Error *err)
{
    for (const RecordRow *row = PARAMETER + PARAMETER_KINDS; row->key; row++) {
        const char *key = row->key;
        bool is_there = record_has(view, key);
        bool is_needed = !strcmp(key, KINDS[p->kind].target) ||
                         (!strcmp(key, "direction") && KINDS[p->kind].has_direction) ||
                         (!strcmp(key, "at") && p->kind == PARAMETER_REFLECTANCE);
        bool is_free = !strcmp(key, "range") ||
                       (!strcmp(key, "with") && KINDS[p->kind].has_with);
        if (is_needed && !is_there)
            return record_misses(view, key, err);
        if (is_there && !is_needed && !is_free)
            return record_fails(view, key, err, "stands beside '%s', required: '%s'%s",
                                PARAMETER[p->kind].key, KINDS[p->kind].target,
                                KINDS[p->kind].has_direction ? " and 'direction'" : " alone");
    }
    return true;
}

static bool check_range(const JsonView *view, const ReviewParameter *p, Error *err)
{
    const double *limits = KINDS[p->kind].range;
    if (!(p->low <= p->at && p->at <= p->high && p->low < p->high))
        return record_fails(view, "range", err,
                            "is [%g, %g], required: [least, most] about %g, where it stands",
                            p->low, p->high, p->at);
    return (p->low >= limits[0] && p->high <= limits[1]) ||
           record_fails(view, "range", err, "is [%g, %g], required: numbers from %g to %g",
                        p->low, p->high, limits[0], limits[1]);
}

static bool check_parameter(const JsonView *view, void *item, Error *err)
{
    ReviewParameter *p = item;
    if (!find_kind(view, p, err) || !check_keys(view, p, err)) return false;
    p->place = view->path;
    if (p->kind != PARAMETER_REFLECTANCE) p->at = KINDS[p->kind].at;
    if (!record_has(view, "range")) {
        p->low = KINDS[p->kind].low;
        p->high = KINDS[p->kind].high;
    }
    return check_range(view, p, err);
}

const RecordFormat review_parameter_format = {
    "parameter", sizeof(OWNER), PARAMETER, .start = start_parameter, .check = check_parameter,
    .rules = "{'oneOf': [{'required': ['tilt_deg', 'node']}, "
             "{'required': ['turn_deg', 'node']}, {'required': ['roll_deg', 'node']}, "
             "{'required': ['shift_m', 'node', 'direction']}, "
             "{'required': ['hood_m', 'display']}, "
             "{'required': ['eye_m', 'eye', 'direction']}, "
             "{'required': ['brightness', 'display']}, "
             "{'required': ['reflectance', 'material', 'at']}]}"};

/* ---- words ------------------------------------------------------------------------------- */

const char *review_parameter_unit(const ReviewParameter *p, double *scale)
{
    *scale = 1;
    switch (p->kind) {
    case PARAMETER_SHIFT:
    case PARAMETER_HOOD:
    case PARAMETER_EYE: *scale = 1000; return "mm";
    case PARAMETER_BRIGHTNESS: return "times the brightness";
    case PARAMETER_REFLECTANCE: *scale = 100; return "%";
    default: return "degree";
    }
}

/* "2.6 degrees", "31 mm", "1.21 times the brightness", "1.1 %". */
static const char *value_words(const ReviewParameter *p, double value, Arena *arena)
{
    double      scale;
    const char *unit = review_parameter_unit(p, &scale);
    return arena_format(arena, "%.3g %s%s", scale * value, unit,
                        !strcmp(unit, "degree") && scale * value != 1 ? "s" : "");
}

void review_parameter_ends(const ReviewParameter *p, double ends[2])
{
    ends[0] = fmax(p->at - p->step, p->low);
    ends[1] = fmin(p->at + p->step, p->high);
}

/* ---- as a variant ------------------------------------------------------------------------ */

static SceneChange node_change(const ReviewRequest *request, const ReviewParameter *p,
                               double value)
{
    SceneChange c = {.kind = CHANGE_NODES, .name = p->target, .with = p->with,
                     .with_count = p->with_count};
    float angle = (float)radians_from_degrees(value);
    if (p->kind == PARAMETER_TILT) c.tilt = angle;
    if (p->kind == PARAMETER_TURN) c.turn = angle;
    if (p->kind == PARAMETER_ROLL) c.roll = angle;
    for (int i = 0; i < 3; i++) {
        if (p->kind == PARAMETER_SHIFT) c.move_m[i] = (float)(value * p->direction[i]);
        c.ahead[i] = (float)request->forward[i];
    }
    return c;
}

/* The index of a quarter wave on glass that leaves so much of 550 nm at the normal:
 * R = ((n^2 - g) / (n^2 + g))^2 with n^2 below g (E. Hecht, Optics, 9.7.1). */
static const char *coating_patch(double reflectance, Arena *arena)
{
    double root = sqrt(reflectance), n = sqrt(GLASS * (1 - root) / (1 + root));
    return arena_format(arena,
                        "{\"extensions\":{\"PARHELION_coating\":{\"layers\":[{\"n\":%.9g,"
                        "\"thickness_nm\":%.9g}]}}}", n, QUARTER_WAVE_NM / n);
}

/* The old coating is removed first: it is replaced, not merged. */
static int coating_changes(const ReviewParameter *p, double value, SceneChange *out,
                           Arena *arena)
{
    static const char NONE[] = "{\"extensions\":{\"PARHELION_coating\":null},"
                               "\"extras\":{\"PARHELION_coating\":null}}";
    for (int i = 0; i < 2; i++)
        out[i] = (SceneChange){.kind = CHANGE_MATERIAL, .name = p->target,
                               .patch = i ? coating_patch(value, arena) : NONE};
    return 2;
}

/* Where it stands a hood is none. */
static int scene_changes(const ReviewRequest *request, const ReviewParameter *p, double value,
                         SceneChange *out, Arena *arena)
{
    if (p->kind == PARAMETER_REFLECTANCE) return coating_changes(p, value, out, arena);
    if (p->kind == PARAMETER_EYE || p->kind == PARAMETER_BRIGHTNESS) return 0;
    if (p->kind == PARAMETER_HOOD)
        out[0] = (SceneChange){.kind = CHANGE_HOOD, .name = p->target,
                               .depth_m = (float)value};
    else
        out[0] = node_change(request, p, value);
    return p->kind != PARAMETER_HOOD || value > 0;
}

static void move_eye(const ReviewRequest *request, const ReviewParameter *p, double value,
                     ReviewVariant *out, Arena *arena)
{
    out->eye_moves = (double(*)[3])ARENA_NEW(arena, double, 3 * request->eye_count);
    for (int e = 0; e < request->eye_count; e++)
        for (int k = 0; k < 3 && !strcmp(request->eyes[e].name, p->target); k++)
            out->eye_moves[e][k] = value * p->direction[k];
}

ReviewVariant review_parameter_at(const ReviewRequest *request, const ReviewParameter *p,
                                  double value, Arena *arena)
{
    SceneChange  *changes = ARENA_NEW(arena, SceneChange, 2);
    const char  **words = ARENA_NEW(arena, const char *, 1);
    ReviewVariant out = {.words = words, .word_count = 1};
    words[0] = arena_format(arena, "%s: %s", p->name, value_words(p, value, arena));
    out.name = words[0];
    out.change.place = p->place;
    out.change.scene = changes;
    out.change.scene_count = scene_changes(request, p, value, changes, arena);
    for (int i = 0; i < out.change.scene_count; i++) {
        changes[i].file = request->file;
        changes[i].place = p->place;
    }
    if (p->kind == PARAMETER_BRIGHTNESS) {
        ReviewFixedLevel *level = ARENA_NEW(arena, ReviewFixedLevel, 1);
        *level = (ReviewFixedLevel){p->target, value};
        out.change.brightness = level;
        out.change.brightness_count = 1;
    }
    if (p->kind == PARAMETER_EYE) move_eye(request, p, value, &out, arena);
    return out;
}
