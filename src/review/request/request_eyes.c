/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_eyes.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"

#define EYES_MAX 256
#define GRID_MAX 33
#define METRES_MAX 1e6
#define BOX_METRES_MAX 10
#define UPRIGHT 1e-6 /* horizontal length of a unit vector: less is vertical */

/* ---- eyes -------------------------------------------------------------------------------- */

static bool read_camera(const JsonView *view, ReviewEye *eye, Error *err)
{
    eye->kind = EYE_CAMERA;
    if (json_is_string(json_object_get(view->object, "camera")))
        return field_name(view, "camera", &eye->camera, err);
    if (!json_is_number(json_object_get(view->object, "camera")))
        return json_view_wrong_kind(view, "camera", json_object_get(view->object, "camera"),
                                    "a camera's name or index", err);
    return field_integer(view, "camera", (FieldBounds){0, 1000000}, &eye->camera_id, err);
}

static bool read_grid(const JsonView *view, ReviewEye *eye, Error *err)
{
    double grid[3] = {3, 3, 3};
    if (!field_numbers(view, "grid", (JsonRange){1, GRID_MAX, 3}, grid, NULL, err))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        if (grid[axis] != floor(grid[axis]))
            return field_fails(view, "grid", err, "holds %g, required: whole "
                                                  "numbers", grid[axis]);
        if (grid[axis] > 1 && !(eye->half_size_m[axis] > 0))
            return field_fails(view, "grid", err,
                               "has %g points along an axis without length, required: 1 there",
                               grid[axis]);
        eye->grid[axis] = (int)grid[axis];
    }
    return true;
}

static bool read_box(const JsonView *view, ReviewEye *eye, Error *err)
{
    eye->kind = EYE_BOX;
    return field_numbers(view, "centre_m", (JsonRange){-METRES_MAX, METRES_MAX, 3},
                         eye->position_m, NULL, err) &&
           field_wanted(view, "half_size_m", err) &&
           field_numbers(view, "half_size_m", (JsonRange){0, BOX_METRES_MAX, 3},
                         eye->half_size_m, NULL, err) &&
           read_grid(view, eye, err);
}

static bool read_ellipse(const JsonView *view, ReviewEye *eye, Error *err)
{
    eye->kind = EYE_ELLIPSE;
    return field_numbers(view, "centre_m", (JsonRange){-METRES_MAX, METRES_MAX, 3},
                         eye->position_m, NULL, err) &&
           field_numbers(view, "ellipse_m", (JsonRange){0, BOX_METRES_MAX, 3}, eye->axes_m,
                         NULL, err) &&
           json_view_number(view, "tilt_deg", -90, 90, &eye->tilt_deg, err);
}

static bool read_point(const JsonView *view, ReviewEye *eye, Error *err)
{
    eye->kind = EYE_POINT;
    return field_numbers(view, "position_m", (JsonRange){-METRES_MAX, METRES_MAX, 3},
                         eye->position_m, NULL, err);
}

/* has: of the keys of read_eye, in their order. */
static bool check_form(const JsonView *view, const bool *has, Error *err)
{
    bool is_wide = has[3] || has[4], has_more = is_wide || has[5] || has[6];
    int  forms = has[0] + has[1] + has[2];
    if (forms != 1 || (!has[2] && has_more))
        return error_at(err, ERROR_INPUT, view->file, view->path, "is %s, required: one of "
                        "'camera', 'position_m', or 'centre_m' with 'half_size_m' or "
                        "'ellipse_m'",
                        forms > 1 ? "said in several ways" : forms ? "a box without a centre"
                                                                   : "nowhere");
    if (has[3] && has[4])
        return field_fails(view, "ellipse_m", err, "stands beside 'half_size_m', required: "
                                                   "one");
    if (has[4] ? has[5] : has[6])
        return field_fails(view, has[4] ? "grid" : "tilt_deg", err,
                           has[4] ? "is a box's, not an ellipse's"
                                  : "is an ellipse's: 'ellipse_m' is missing");
    return true;
}

static bool read_eye(const FieldMembers *members, int i, ReviewEye *out, Error *err)
{
    static const char *const keys[] = {"camera", "position_m", "centre_m", "half_size_m",
                                       "ellipse_m", "grid", "tilt_deg", "proposed_from"};
    JsonView  view;
    ReviewEye eye = {.name = members->name[i], .camera_id = NO_ID};
    if (!json_view_child(&members->view, eye.name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        (json_object_get(view.object, "proposed_from") &&
         !field_name(&view, "proposed_from", &eye.proposed_from, err)))
        return false;
    bool has[COUNT_OF(keys)];
    for (int k = 0; k < COUNT_OF(keys); k++)
        has[k] = json_object_get(view.object, keys[k]) != NULL;
    if (!check_form(&view, has, err)) return false;
    bool ok = has[0]   ? read_camera(&view, &eye, err)
              : has[1] ? read_point(&view, &eye, err)
              : has[4] ? read_ellipse(&view, &eye, err)
                       : read_box(&view, &eye, err);
    if (ok) *out = eye;
    return ok;
}

static bool read_eyes(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_wanted(&reading->root, "eyes", err) ||
        !field_members(&reading->root, "eyes", EYES_MAX, &members, err))
        return false;
    request->eyes = ARENA_NEW(reading->root.arena, ReviewEye, members.count);
    request->eye_count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_eye(&members, i, &request->eyes[i], err)) return false;
    return true;
}

/* ---- the observer ------------------------------------------------------------------------ */

static bool read_forward(RequestReading *reading, Error *err)
{
    double *forward = reading->request->forward;
    forward[0] = forward[1] = 0, forward[2] = -1;
    if (!field_unit_vector(&reading->root, "forward", forward, NULL, err)) return false;
    return hypot_d(forward[0], forward[2]) > UPRIGHT ||
           field_fails(&reading->root, "forward", err,
                       "is vertical, required: where the vehicle points");
}

/* Ahead on the horizontal, its front down by the tilt; across; upright on both. */
static void turn_ellipse(const double forward[3], ReviewEye *eye)
{
    double level = hypot_d(forward[0], forward[2]);
    double ahead[3] = {forward[0] / level, 0, forward[2] / level};
    double across[3] = {-ahead[2], 0, ahead[0]};
    double tilt = radians_from_degrees(eye->tilt_deg), c = cos_d(tilt), s = sin_d(tilt);
    for (int k = 0; k < 3; k++) {
        double up = k == 1;
        eye->half_axes_m[0][k] = 0.5 * eye->axes_m[0] * (c * ahead[k] - s * up);
        eye->half_axes_m[1][k] = 0.5 * eye->axes_m[1] * across[k];
        eye->half_axes_m[2][k] = 0.5 * eye->axes_m[2] * (s * ahead[k] + c * up);
    }
}

static void turn_ellipses(ReviewRequest *request)
{
    for (int i = 0; i < request->eye_count; i++)
        if (request->eyes[i].kind == EYE_ELLIPSE)
            turn_ellipse(request->forward, &request->eyes[i]);
}

static bool read_observer(RequestReading *reading, Error *err)
{
    static const char *const keys[] = {"age_years", "pigment"};
    JsonView  view;
    HumanEye *observer = &reading->request->observer;
    *observer = (HumanEye){50, 0.5};
    return json_view_child(&reading->root, "observer", false, &view, err) &&
           json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
           json_view_number(&view, "age_years", 10, 100, &observer->age_years, err) &&
           json_view_number(&view, "pigment", 0, 1.2, &observer->pigment, err);
}

/* ---- where they look --------------------------------------------------------------------- */

/* Which eyes look so: those of the list "eyes", else all. */
static bool read_lookers(const RequestReading *reading, const JsonView *view, ReviewGaze *gaze,
                         Error *err)
{
    const ReviewRequest *request = reading->request;
    int                  listed;
    if (!field_list(view, "eyes", EYES_MAX, &listed, err)) return false;
    gaze->for_eye = ARENA_NEW(view->arena, bool, request->eye_count);
    FieldWords names = request_eye_names(request, view->arena);
    for (int i = 0; i < request->eye_count; i++) gaze->for_eye[i] = !listed;
    for (int i = 0; i < listed; i++) {
        json_t  *item = json_array_get(json_object_get(view->object, "eyes"), (size_t)i);
        char    *place = arena_format(view->arena, "eyes/%d", i);
        int      eye = NO_ID;
        JsonView alone = *view; /* the item as a member of that name */
        if (!json_is_string(item))
            return json_view_wrong_kind(view, place, item, "an eye's name", err);
        alone.object = json_pack("{s:O}", place, item);
        bool found = request_find_name(&alone, place, names, "eyes", &eye, err);
        json_decref(alone.object);
        if (!found) return false;
        gaze->for_eye[eye] = true;
    }
    return true;
}

static bool read_direction(const JsonView *view, ReviewGaze *gaze, Error *err)
{
    static const char *const targets[] = {"symbols"};
    int  target = NO_ID;
    bool has_direction;
    if (!field_choice(view, "at", (FieldWords){targets, 1}, &target, err) ||
        !field_unit_vector(view, "direction", gaze->direction, &has_direction, err))
        return false;
    gaze->at_symbols = target == 0;
    if (gaze->at_symbols == has_direction)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has %s, required: one of 'at' and 'direction'",
                        has_direction ? "both" : "neither");
    gaze->name = targets[0];
    return (!has_direction && !json_object_get(view->object, "name")) ||
           field_name(view, "name", &gaze->name, err);
}

static bool read_gaze(RequestReading *reading, int i, Error *err)
{
    static const char *const keys[] = {"at", "name", "direction", "eyes"};
    JsonView    view;
    ReviewGaze *gaze = &reading->request->gazes[i];
    if (!field_item(&reading->root, "gaze", i, (FieldWords){keys, COUNT_OF(keys)}, &view,
                    err) ||
        !read_direction(&view, gaze, err) || !read_lookers(reading, &view, gaze, err))
        return false;
    for (int k = 0; k < i; k++)
        if (!strcmp(reading->request->gazes[k].name, gaze->name))
            return error_at(err, ERROR_INPUT, view.file, view.path,
                            "is the second gaze named '%.60s', required: another name",
                            gaze->name);
    return true;
}

/* None: at the symbols. */
static void look_at_symbols(RequestReading *reading)
{
    ReviewRequest *request = reading->request;
    request->gazes = ARENA_NEW(reading->root.arena, ReviewGaze, 1);
    request->gaze_count = 1;
    request->gazes[0] = (ReviewGaze){.name = "symbols", .at_symbols = true};
    request->gazes[0].for_eye = ARENA_NEW(reading->root.arena, bool, request->eye_count);
    for (int i = 0; i < request->eye_count; i++) request->gazes[0].for_eye[i] = true;
}

static bool read_gazes(RequestReading *reading, Error *err)
{
    ReviewRequest *request = reading->request;
    if (!field_list(&reading->root, "gaze", EYES_MAX, &request->gaze_count, err)) return false;
    if (!request->gaze_count) {
        look_at_symbols(reading);
        return true;
    }
    request->gazes = ARENA_NEW(reading->root.arena, ReviewGaze, request->gaze_count);
    for (int i = 0; i < request->gaze_count; i++)
        if (!read_gaze(reading, i, err)) return false;
    return true;
}

bool request_eyes_read(RequestReading *reading, Error *err)
{
    if (!read_eyes(reading, err) || !read_forward(reading, err)) return false;
    turn_ellipses(reading->request);
    return read_observer(reading, err) && read_gazes(reading, err);
}

/* ---- what is read, who else is there ----------------------------------------------------- */

#define SYMBOLS_MAX 1000
#define WITHS_MAX 100

bool request_polarity_read(const JsonView *view, const char *key, ReviewPolarity *out,
                           Error *err)
{
    static const char *const words[] = {
        [POLARITY_AUTO] = "auto",
        [POLARITY_LIGHT_ON_DARK] = "light-on-dark",
        [POLARITY_DARK_ON_LIGHT] = "dark-on-light",
    };
    int polarity = (int)*out;
    if (!field_choice(view, key, (FieldWords){words, COUNT_OF(words)}, &polarity, err))
        return false;
    *out = (ReviewPolarity)polarity;
    return true;
}

static bool read_rectangle(const JsonView *view, ReviewSymbol *symbol, Error *err)
{
    double uv[4] = {0, 0, 1, 1};
    if (!field_numbers(view, "uv", (JsonRange){0, 1, 4}, uv, &symbol->has_uv, err))
        return false;
    if (!(uv[0] < uv[2] && uv[1] < uv[3]))
        return field_fails(view, "uv", err,
                           "is [%g, %g, %g, %g], required: [left, top, right, bottom] with "
                           "left below right and top below bottom",
                           uv[0], uv[1], uv[2], uv[3]);
    for (int i = 0; i < 4; i++) symbol->uv[i] = uv[i];
    return true;
}

static bool read_find(const JsonView *view, ReviewSymbol *symbol, Error *err)
{
    static const char *const words[] = {"text"};
    int word = NO_ID;
    if (!field_choice(view, "find", (FieldWords){words, 1}, &word, err)) return false;
    symbol->find_text = word == 0;
    if (symbol->find_text && symbol->mask)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has both 'find' and 'mask', required: one of them");
    if (!symbol->find_text && !symbol->mask && !symbol->has_uv)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "says no place on its display, required: 'uv', 'mask' or 'find'");
    return true;
}

static bool read_optional(const JsonView *view, const char *key, bool *out, Error *err)
{
    static const char *const words[] = {"required", "optional"};
    int word = *out;
    if (!field_choice(view, key, (FieldWords){words, COUNT_OF(words)}, &word, err))
        return false;
    *out = word == 1;
    return true;
}

/* A word for all eyes, or an object with eyes' names as keys. */
static bool read_visible(const RequestReading *reading, const JsonView *view, ReviewSymbol *out,
                         Error *err)
{
    const ReviewRequest *request = reading->request;
    int          count = request->eye_count;
    FieldWords   names = request_eye_names(request, view->arena);
    FieldMembers members;
    out->optional_for = ARENA_NEW(view->arena, bool, count);
    if (!json_is_object(json_object_get(view->object, "visible"))) {
        for (int i = 0; i < count; i++)
            if (!read_optional(view, "visible", &out->optional_for[i], err)) return false;
        return true;
    }
    if (!field_named_members(view, "visible", names, "eye", &members, err)) return false;
    for (int i = 0; i < count; i++)
        if (!read_optional(&members.view, names.word[i], &out->optional_for[i], err))
            return false;
    return true;
}

static bool read_symbol(const RequestReading *reading, const FieldMembers *members, int i,
                        Error *err)
{
    static const char *const keys[] = {"display", "content", "uv",     "mask",
                                       "polarity", "find",   "visible"};
    JsonView     view;
    ReviewSymbol symbol = {.name = members->name[i]};
    if (!json_view_child(&members->view, symbol.name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
        !field_name(&view, "display", &symbol.display, err) ||
        !field_file(&view, "content", &symbol.content, err) ||
        !field_file(&view, "mask", &symbol.mask, err) ||
        !read_rectangle(&view, &symbol, err) ||
        !request_polarity_read(&view, "polarity", &symbol.polarity, err) ||
        !read_find(&view, &symbol, err) || !read_visible(reading, &view, &symbol, err))
        return false;
    reading->request->symbols[i] = symbol;
    return true;
}

bool request_symbols_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_wanted(&reading->root, "symbols", err) ||
        !field_members(&reading->root, "symbols", SYMBOLS_MAX, &members, err))
        return false;
    request->symbols = ARENA_NEW(reading->root.arena, ReviewSymbol, members.count);
    request->symbol_count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_symbol(reading, &members, i, err)) return false;
    return true;
}

bool request_withs_read(RequestReading *reading, Error *err)
{
    FieldMembers   members;
    ReviewRequest *request = reading->request;
    if (!field_members(&reading->root, "with", WITHS_MAX, &members, err)) return false;
    request->withs = ARENA_NEW(reading->root.arena, ReviewWith, members.count);
    request->with_count = members.count;
    for (int i = 0; i < members.count; i++) {
        ReviewWith *with = &request->withs[i];
        with->name = members.name[i];
        if (!field_files(&members.view, with->name, &with->paths, &with->path_count, err))
            return false;
    }
    return true;
}
