/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_check.h"

#include <math.h>
#include <string.h>

#include "scene/check/display_frame.h"
#include "text/nearest_word.h"

#define ADVICE_CHARS 320

/* ---- displays ---------------------------------------------------------------------------- */

static const char *node_of(const char *name) {
    return strncmp(name, "node:", 5) ? NULL : name + 5;
}

static int display_of_part(const Scene *scene, int part) {
    return scene->materials[scene->parts[part].material_id].display_id;
}

/* Every name that finds a display: materials, and "node:NAME" of their nodes. */
static int list_names(const Scene *scene, Arena *arena, const char ***out) {
    int count = 0;
    const char **names = ARENA_NEW(arena, const char *, scene->display_count + scene->part_count);
    for (int i = 0; i < scene->display_count; i++) names[count++] = scene->displays[i].name;
    for (int i = 0; i < scene->part_count; i++)
        if (display_of_part(scene, i) != NO_ID)
            names[count++] = arena_format(arena, "node:%s", scene->parts[i].name);
    *out = names;
    return count;
}

static bool not_found(const Scene *scene, const char *name, Arena scratch, Error *err) {
    char advice[ADVICE_CHARS];
    const char **names;
    int count = list_names(scene, &scratch, &names);
    if (!count)
        return error_set(err, ERROR_INPUT,
                         "the scene has no display, required: a material with a panel");
    for (int i = 0; i < scene->material_count; i++)
        if (!strcmp(scene->materials[i].name, name))
            return error_set(err, ERROR_INPUT, "'%.60s' has no panel, required: a display: %s",
                             name, nearest_word_advice(name, names, count, advice, sizeof advice));
    return error_set(err, ERROR_INPUT, "there is no display '%.60s': %s", name,
                     nearest_word_advice(name, names, count, advice, sizeof advice));
}

/* Which display a name means; NO_ID: none. */
static int find_display(const Scene *scene, const char *name) {
    const char *node = node_of(name);
    for (int i = 0; i < scene->display_count && !node; i++)
        if (!strcmp(scene->displays[i].name, name)) return i;
    for (int i = 0; i < scene->part_count && node; i++)
        if (display_of_part(scene, i) != NO_ID && !strcmp(scene->parts[i].name, node))
            return display_of_part(scene, i);
    return NO_ID;
}

/* The display's parts; for a name "node:NAME" those of that node. */
static ReviewDisplay collect_parts(const Scene *scene, const char *name, int display_id,
                                   Arena *arena) {
    int count = 0;
    int *ids = ARENA_NEW(arena, int, scene->part_count);
    const char *node = node_of(name);
    for (int i = 0; i < scene->part_count; i++)
        if (display_of_part(scene, i) == display_id &&
            (!node || !strcmp(scene->parts[i].name, node)))
            ids[count++] = i;
    return (ReviewDisplay){display_id, ids, count};
}

/* Two nodes that wear one material are two displays of the same content. */
static bool check_single(const Scene *scene, const ReviewDisplay *display, const char *name,
                         Error *err) {
    const char *first = scene->parts[display->part_ids[0]].name;
    for (int i = 1; i < display->part_count; i++) {
        const char *other = scene->parts[display->part_ids[i]].name;
        if (strcmp(first, other))
            return error_set(err, ERROR_INPUT,
                             "'%.60s' is worn by several nodes, required: one of them: "
                             "'node:%.60s', 'node:%.60s'%s",
                             name, first, other, display->part_count > 2 ? " ..." : "");
    }
    return true;
}

bool review_display_find(const Scene *scene, const char *name, Arena *arena, ReviewDisplay *out,
                         Error *err) {
    int id = find_display(scene, name);
    if (id == NO_ID) return not_found(scene, name, *arena, err);
    ReviewDisplay display = collect_parts(scene, name, id, arena);
    if (!scene->displays[id].panel)
        return error_set(err, ERROR_INPUT, "'%.60s' has no panel, required: a measured display",
                         name);
    if (!display.part_count)
        return error_set(err, ERROR_INPUT, "'%.60s' is worn by no surface of the scene", name);
    if (!check_single(scene, &display, name, err)) return false;
    *out = display;
    return true;
}

/* ---- cameras ----------------------------------------------------------------------------- */

static bool has_name(const SceneCamera *camera, const char *name) {
    return !strcmp(camera->node_name, name) || !strcmp(camera->camera_name, name);
}

static bool no_camera(const Scene *scene, const char *name, Arena scratch, Error *err) {
    char advice[ADVICE_CHARS];
    const char **names = ARENA_NEW(&scratch, const char *, scene->camera_count);
    for (int i = 0; i < scene->camera_count; i++)
        names[i] = *scene->cameras[i].node_name ? scene->cameras[i].node_name
                                                : scene->cameras[i].camera_name;
    if (!scene->camera_count)
        return error_set(err, ERROR_INPUT, "the scene has no camera, required: 'position_m'");
    return error_set(err, ERROR_INPUT, "there is no camera '%.60s': %s", name,
                     nearest_word_advice(name, names, scene->camera_count, advice, sizeof advice));
}

bool review_camera_find(const Scene *scene, const ReviewEye *eye, Arena scratch, int *camera_id,
                        Error *err) {
    if (!eye->camera) {
        if (eye->camera_id >= scene->camera_count)
            return error_set(err, ERROR_INPUT,
                             "there is no camera %d, required: one of the scene's %d, counted "
                             "from 0",
                             eye->camera_id, scene->camera_count);
        *camera_id = eye->camera_id;
        return true;
    }
    for (int i = 0; i < scene->camera_count; i++)
        if (has_name(&scene->cameras[i], eye->camera)) {
            *camera_id = i;
            return true;
        }
    return no_camera(scene, eye->camera, scratch, err);
}

/* ---- all that is named ------------------------------------------------------------------- */

typedef struct RequestCheck {
    const ReviewRequest *request;
    const Scene *scene;
    Problems *problems;
} RequestCheck;

static void note(const RequestCheck *check, const char *path, const Error *why) {
    problems_add(check->problems, SEVERITY_ERROR, check->request->file, path, "%s", why->text);
}

/* A member of an object by the names that the user gave: its JSON path. */
static const char *place(const RequestCheck *check, const char *list, const char *name,
                         const char *member) {
    return arena_format(check->problems->arena, "/%s/%s/%s", list, name, member);
}

static bool check_display(const RequestCheck *check, const char *path, const char *name,
                          ReviewDisplay *out) {
    Error why;
    if (review_display_find(check->scene, name, check->problems->arena, out, &why)) return true;
    note(check, path, &why);
    return false;
}

static void check_eye(const RequestCheck *check, const ReviewEye *eye) {
    Error why;
    int camera_id;
    if (eye->kind != EYE_CAMERA) return;
    const char *path = place(check, "eyes", eye->name, "camera");
    if (!review_camera_find(check->scene, eye, *check->problems->arena, &camera_id, &why))
        note(check, path, &why);
    else if (!check->scene->cameras[camera_id].is_perspective)
        problems_add(check->problems, SEVERITY_ERROR, check->request->file, path,
                     "is an orthographic camera, required: a perspective one: an eye has a "
                     "place");
}

static void check_symbol(const RequestCheck *check, const ReviewSymbol *symbol) {
    ReviewDisplay display;
    const char *path = place(check, "symbols", symbol->name, "display");
    if (!check_display(check, path, symbol->display, &display) || symbol->content) return;
    if (check->scene->displays[display.display_id].content.texture_id == NO_ID)
        problems_add(check->problems, SEVERITY_ERROR, check->request->file, path,
                     "'%.60s' shows no content in the scene, required: 'content' beside it",
                     symbol->display);
}

/* "*" is all others; a curve is of all. */
static void check_level(const RequestCheck *check, const ReviewLevel *level) {
    ReviewDisplay display;
    for (int i = 0; i < level->fixed_count; i++) {
        const char *name = level->fixed[i].display;
        if (strcmp(name, "*"))
            check_display(check, place(check, "levels", level->name, name), name, &display);
    }
}

static void check_contents(const RequestCheck *check, int condition) {
    ReviewDisplay display;
    const ReviewCondition *c = &check->request->conditions[condition];
    const char *number = arena_format(check->problems->arena, "%d/contents", condition);
    for (int i = 0; i < c->content_count; i++) {
        const char *name = c->contents[i].display;
        check_display(check, place(check, "conditions", number, name), name, &display);
    }
}

/* Names of displays in a variant's brightness, which the loader does not look for. */
static void check_change(const RequestCheck *check, const ReviewChange *change) {
    ReviewDisplay display;
    for (int i = 0; i < change->brightness_count; i++) {
        const char *name = change->brightness[i].display;
        if (strcmp(name, "*")) check_display(check, change->place, name, &display);
    }
}

/* ---- what cannot be meant ---------------------------------------------------------------- */

#define NEAR_M 0.1 /* from an eye to a display that it reads */
#define FAR_M 10.0
#define BOX_MOST_M 1.0

/* The eye that is looked at, and the displays of the symbols. */
typedef struct RequestDoubt {
    const RequestCheck *check;
    const DisplayFrame *frames; /* [symbol_count] */
    const bool *has_frame;
} RequestDoubt;

static void warn(const RequestDoubt *doubt, const char *path, const char *text) {
    const RequestCheck *check = doubt->check;
    problems_add(check->problems, SEVERITY_WARNING, check->request->file, path, "%s", text);
}

/* ---- an eye ------------------------------------------------------------------------------ */

typedef struct EyeStand {
    Vec3 at, up;
    const Transform *camera; /* NULL: it has no view of its own */
} EyeStand;

static EyeStand stand_of(const RequestDoubt *doubt, const ReviewEye *eye) {
    const Scene *scene = doubt->check->scene;
    Error none;
    int id;
    if (eye->kind != EYE_CAMERA)
        return (EyeStand){scene_from_world(scene->origin, eye->position_m), {0, 1, 0}, NULL};
    if (!review_camera_find(scene, eye, *doubt->check->problems->arena, &id, &none))
        return (EyeStand){.up = {0, 1, 0}};
    const Transform *world = &scene->cameras[id].world_from_camera;
    return (EyeStand){world->origin, world->y, world};
}

/* Where an eye may look, and which of it is the least off forward. */
typedef struct Looking {
    const double *forward;
    double least_deg, way[3];
} Looking;

static void look_along(Looking *looking, Vec3 direction) {
    double degrees, way[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    if (!forward_angle_deg(looking->forward, way, &degrees) || degrees >= looking->least_deg)
        return;
    looking->least_deg = degrees;
    memcpy(looking->way, way, sizeof way);
}

/* Its camera's axis, the displays that it reads and the gazes that it has: of a mirror or a
 * display in the door one is off, of a mistaken forward all are. */
static void doubt_forward(const RequestDoubt *doubt, int eye, const EyeStand *stand) {
    const ReviewRequest *request = doubt->check->request;
    const double *forward = request->forward;
    Looking looking = {.forward = forward, .least_deg = INFINITY};
    if (stand->camera) look_along(&looking, vec3_neg(stand->camera->z));
    for (int i = 0; i < request->symbol_count; i++)
        if (doubt->has_frame[i])
            look_along(&looking, vec3_normalize(vec3_sub(doubt->frames[i].centre, stand->at)));
    for (int i = 0; i < request->gaze_count; i++)
        if (review_is_look(&request->gazes[i], eye))
            look_along(&looking, vec3_from_doubles(request->gazes[i].direction));
    if (!(looking.least_deg > FORWARD_MOST_DEG) || !(looking.least_deg <= 180)) return;
    warn(doubt, "/forward",
         arena_format(doubt->check->problems->arena,
                      "(%.3g, %.3g, %.3g) is %.0f degrees off where eye \"%.60s\" looks, "
                      "(%.3g, %.3g, %.3g), expected within %g: does the vehicle point there?",
                      forward[0], forward[1], forward[2], looking.least_deg,
                      request->eyes[eye].name, looking.way[0] + 0.0, looking.way[1] + 0.0,
                      looking.way[2] + 0.0, FORWARD_MOST_DEG));
}

static void doubt_distance(const RequestDoubt *doubt, const ReviewEye *eye, const EyeStand *stand) {
    double nearest = INFINITY;
    for (int i = 0; i < doubt->check->request->symbol_count; i++)
        if (doubt->has_frame[i])
            nearest =
                fmin(nearest, (double)vec3_length(vec3_sub(doubt->frames[i].centre, stand->at)));
    if ((nearest >= NEAR_M && nearest <= FAR_M) || nearest == (double)INFINITY) return;
    warn(doubt, arena_format(doubt->check->problems->arena, "/eyes/%s", eye->name),
         arena_format(doubt->check->problems->arena,
                      "is %.3g m from the nearest display that is read, expected %g to %g m: "
                      "is its place in metres?",
                      nearest, NEAR_M, FAR_M));
}

/* A head is moved by less: boxes reach half a metre, ellipses (SAE J941) are 0.2 m long. */
static void doubt_box(const RequestDoubt *doubt, const ReviewEye *eye) {
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, eye->kind == EYE_BOX ? 2 * eye->half_size_m[i] : eye->axes_m[i]);
    if (review_eye_is_wide(eye) && most > BOX_MOST_M)
        warn(doubt, arena_format(doubt->check->problems->arena, "/eyes/%s", eye->name),
             arena_format(doubt->check->problems->arena,
                          "reaches over %.3g m, expected at most %g m: is it in metres?", most,
                          BOX_MOST_M));
}

static void doubt_turn(const RequestDoubt *doubt, const ReviewEye *eye, const EyeStand *stand) {
    const ReviewRequest *request = doubt->check->request;
    double turn;
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        if (!doubt->has_frame[i] ||
            !display_frame_turn(&doubt->frames[i], stand->at, stand->up, &turn) ||
            fabs(turn) <= DISPLAY_TURN_MOST_DEG)
            continue;
        warn(doubt, place(doubt->check, "symbols", symbol->name, "display"),
             arena_format(doubt->check->problems->arena,
                          "the picture of '%.60s' stands %s for eye \"%.60s\" (turned by %.0f "
                          "degrees): are its texture coordinates turned?",
                          symbol->display, display_turn_words(turn), eye->name, fabs(turn)));
    }
}

/* ---- displays that are read -------------------------------------------------------------- */

static bool find_frame(const RequestDoubt *doubt, const ReviewSymbol *symbol, DisplayFrame *out) {
    ReviewDisplay display;
    Error none;
    const Scene *scene = doubt->check->scene;
    if (!review_display_find(scene, symbol->display, doubt->check->problems->arena, &display,
                             &none) ||
        !display_frame_of(scene, &scene->parts[display.part_ids[0]], out))
        return false;
    if (scene->displays[display.display_id].any_size ||
        (display_side_is_plausible(out->width_m) && display_side_is_plausible(out->height_m)))
        return true;
    problems_add(doubt->check->problems, SEVERITY_ERROR, doubt->check->request->file,
                 place(doubt->check, "symbols", symbol->name, "display"),
                 "'%.60s' is %.3g m wide and %.3g m high, required: %g to %g m: is the model "
                 "in metres? If it is meant: \"any_size\": true in its PARHELION_display",
                 symbol->display, out->width_m, out->height_m, DISPLAY_LEAST_M, DISPLAY_MOST_M);
    return true;
}

/* What cannot be meant; all that is named is there. Sizes are errors, the rest warnings. */
static void doubt_weathers(const RequestCheck *check) {
    const ReviewRequest *request = check->request;
    for (int k = 0; k < request->weather_count; k++) {
        const ReviewWeather *weather = &request->weathers[k];
        WeatherDoubts doubts =
            weather_clock_doubts(&weather->weather, &weather->clock, check->problems->arena);
        for (int i = 0; i < doubts.count; i++)
            problems_add(check->problems, SEVERITY_WARNING, weather->path, "", "%s",
                         doubts.text[i]);
    }
}

static void doubt_all(const RequestCheck *check) {
    const ReviewRequest *request = check->request;
    Arena *arena = check->problems->arena;
    DisplayFrame *frames = ARENA_NEW(arena, DisplayFrame, request->symbol_count);
    bool *has_frame = ARENA_NEW(arena, bool, request->symbol_count);
    RequestDoubt doubt = {check, frames, has_frame};
    doubt_weathers(check);
    for (int i = 0; i < request->symbol_count; i++)
        has_frame[i] = find_frame(&doubt, &request->symbols[i], &frames[i]);
    for (int i = 0; i < request->eye_count; i++) {
        EyeStand stand = stand_of(&doubt, &request->eyes[i]);
        doubt_forward(&doubt, i, &stand);
        doubt_distance(&doubt, &request->eyes[i], &stand);
        doubt_turn(&doubt, &request->eyes[i], &stand);
        doubt_box(&doubt, &request->eyes[i]);
    }
}

/* ---- all of it --------------------------------------------------------------------------- */

bool review_request_check(const ReviewRequest *request, const Scene *scene, Problems *problems) {
    int before = problems->error_count;
    RequestCheck check = {request, scene, problems};
    for (int i = 0; i < request->eye_count; i++) check_eye(&check, &request->eyes[i]);
    for (int i = 0; i < request->symbol_count; i++) check_symbol(&check, &request->symbols[i]);
    for (int i = 0; i < request->level_count; i++) check_level(&check, &request->levels[i]);
    for (int i = 0; i < request->condition_count; i++) check_contents(&check, i);
    if (request->change) check_change(&check, request->change);
    if (problems->error_count == before) doubt_all(&check);
    return problems->error_count == before;
}
