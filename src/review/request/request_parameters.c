/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_parameters.h"

#include <math.h>
#include <string.h>

#include "base/units.h"

#define PARAMETERS_MAX 100
#define GLASS 1.52
#define QUARTER_WAVE_NM 137.5 /* 550 nm / 4, to be divided by the layer's index */

/* Each kind by the key that holds its step. */
static const struct {
    const char *key, *target; /* the key that names what is changed */
    double      at, low, high, step_most;
    bool        has_direction, has_with;
} KINDS[PARAMETER_KINDS] = {
    [PARAMETER_TILT] = {"tilt_deg", "node", 0, -20, 20, 45, false, true},
    [PARAMETER_TURN] = {"turn_deg", "node", 0, -20, 20, 45, false, true},
    [PARAMETER_ROLL] = {"roll_deg", "node", 0, -20, 20, 45, false, true},
    [PARAMETER_SHIFT] = {"shift_m", "node", 0, -0.2, 0.2, 10, true, true},
    [PARAMETER_HOOD] = {"hood_m", "display", 0, 0, 0.2, 1, false, false},
    [PARAMETER_EYE] = {"eye_m", "eye", 0, -0.2, 0.2, 10, true, false},
    [PARAMETER_BRIGHTNESS] = {"brightness", "display", 1, 0.05, 20, 1, false, false},
    [PARAMETER_REFLECTANCE] = {"reflectance", "material", 0, 0, BARE_REFLECTANCE, 0.02, false,
                               false},
};

/* ---- reading ----------------------------------------------------------------------------- */

static bool find_kind(const JsonView *view, ReviewParameter *out, Error *err)
{
    int found = 0;
    for (int k = 0; k < PARAMETER_KINDS; k++)
        if (json_object_get(view->object, KINDS[k].key)) {
            out->kind = (ReviewParameterKind)k;
            found++;
        }
    return found == 1 ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has %d steps, required: one of 'tilt_deg', 'turn_deg', 'roll_deg', "
                    "'shift_m', 'hood_m', 'eye_m', 'brightness', 'reflectance'", found);
}

static bool read_range(const JsonView *view, ReviewParameter *out, Error *err)
{
    double range[2] = {out->low, out->high};
    if (!json_view_pair(view, "range", -180, 180, range, err)) return false;
    if (!(range[0] <= out->at && out->at <= range[1] && range[0] < range[1]))
        return field_fails(view, "range", err,
                           "is [%g, %g], required: [least, most] about %g, where it stands",
                           range[0], range[1], out->at);
    bool   is_length = out->kind == PARAMETER_HOOD || out->kind == PARAMETER_REFLECTANCE;
    double least = is_length ? 0 : -180;
    double most = out->kind == PARAMETER_REFLECTANCE ? BARE_REFLECTANCE : 180;
    if (out->kind == PARAMETER_BRIGHTNESS) least = 1e-3;
    if (range[0] < least || range[1] > most)
        return field_fails(view, "range", err, "is [%g, %g], required: numbers from %g to %g",
                           range[0], range[1], least, most);
    out->low = range[0];
    out->high = range[1];
    return true;
}

/* A coating's reflectance is not derived from its layers: `at` gives it. */
static bool read_at(const JsonView *view, ReviewParameter *out, Error *err)
{
    if (out->kind != PARAMETER_REFLECTANCE) return true;
    return field_wanted(view, "at", err) &&
           json_view_number(view, "at", 0, BARE_REFLECTANCE, &out->at, err);
}

static bool check_eye(const RequestReading *reading, const JsonView *view,
                      const ReviewParameter *parameter, Error *err)
{
    int eye;
    return parameter->kind != PARAMETER_EYE ||
           request_find_name(view, "eye", request_eye_names(reading->request, view->arena),
                             "eyes", &eye, err);
}

static bool read_parameter(RequestReading *reading, const FieldMembers *members, int i,
                           ReviewParameter *out, Error *err)
{
    JsonView    view;
    const char *keys[8];
    int         count = 0;
    bool        has_direction = true;
    *out = (ReviewParameter){.name = members->name[i]};
    if (!json_view_child(&members->view, out->name, true, &view, err) ||
        !find_kind(&view, out, err))
        return false;
    keys[count++] = KINDS[out->kind].key;
    keys[count++] = KINDS[out->kind].target;
    keys[count++] = "range";
    if (KINDS[out->kind].has_direction) keys[count++] = "direction";
    if (KINDS[out->kind].has_with) keys[count++] = "with";
    if (out->kind == PARAMETER_REFLECTANCE) keys[count++] = "at";
    out->place = view.path;
    out->at = KINDS[out->kind].at;
    out->low = KINDS[out->kind].low;
    out->high = KINDS[out->kind].high;
    if (!json_view_check_keys(&view, keys, count, err) ||
        !json_view_number(&view, keys[0], 1e-6, KINDS[out->kind].step_most, &out->step, err) ||
        !field_name(&view, keys[1], &out->target, err) || !read_at(&view, out, err) ||
        !read_range(&view, out, err) ||
        !field_names(&view, "with", "a node's name", &out->with, &out->with_count, err))
        return false;
    if (KINDS[out->kind].has_direction &&
        !field_unit_vector(&view, "direction", out->direction, &has_direction, err))
        return false;
    if (!has_direction && !field_wanted(&view, "direction", err)) return false;
    return check_eye(reading, &view, out, err);
}

bool request_parameters_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_members(&reading->root, "sensitivity", PARAMETERS_MAX, &members, err))
        return false;
    request->parameters = ARENA_NEW(reading->root.arena, ReviewParameter, members.count);
    request->parameter_count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_parameter(reading, &members, i, &request->parameters[i], err)) return false;
    return true;
}

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
