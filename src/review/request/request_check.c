/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_check.h"

#include <string.h>

#include "review/request/request_doubt.h"
#include "text/nearest_word.h"

#define ADVICE_CHARS 320

/* ---- displays ---------------------------------------------------------------------------- */

static const char *node_of(const char *name)
{
    return strncmp(name, "node:", 5) ? NULL : name + 5;
}

static int display_of_part(const Scene *scene, int part)
{
    return scene->materials[scene->parts[part].material_id].display_id;
}

/* Every name that finds a display: materials, and "node:NAME" of their nodes. */
static int list_names(const Scene *scene, Arena *arena, const char ***out)
{
    int          count = 0;
    const char **names = ARENA_NEW(arena, const char *,
                                   scene->display_count + scene->part_count);
    for (int i = 0; i < scene->display_count; i++) names[count++] = scene->displays[i].name;
    for (int i = 0; i < scene->part_count; i++)
        if (display_of_part(scene, i) != NO_ID)
            names[count++] = arena_format(arena, "node:%s", scene->parts[i].name);
    *out = names;
    return count;
}

static bool not_found(const Scene *scene, const char *name, Arena scratch, Error *err)
{
    char         advice[ADVICE_CHARS];
    const char **names;
    int          count = list_names(scene, &scratch, &names);
    if (!count)
        return error_set(err, ERROR_INPUT,
                         "the scene has no display, wanted a material with a panel");
    for (int i = 0; i < scene->material_count; i++)
        if (!strcmp(scene->materials[i].name, name))
            return error_set(err, ERROR_INPUT, "'%.60s' has no panel, wanted a display: %s",
                             name, nearest_word_advice(name, names, count, advice,
                                                       sizeof advice));
    return error_set(err, ERROR_INPUT, "there is no display '%.60s': %s", name,
                     nearest_word_advice(name, names, count, advice, sizeof advice));
}

/* Which display a name means; NO_ID: none. */
static int find_display(const Scene *scene, const char *name)
{
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
                                   Arena *arena)
{
    int           count = 0;
    int          *ids = ARENA_NEW(arena, int, scene->part_count);
    const char   *node = node_of(name);
    for (int i = 0; i < scene->part_count; i++)
        if (display_of_part(scene, i) == display_id &&
            (!node || !strcmp(scene->parts[i].name, node)))
            ids[count++] = i;
    return (ReviewDisplay){display_id, ids, count};
}

/* Two nodes that wear one material are two displays of the same content. */
static bool check_single(const Scene *scene, const ReviewDisplay *display, const char *name,
                         Error *err)
{
    const char *first = scene->parts[display->part_ids[0]].name;
    for (int i = 1; i < display->part_count; i++) {
        const char *other = scene->parts[display->part_ids[i]].name;
        if (strcmp(first, other))
            return error_set(err, ERROR_INPUT,
                             "'%.60s' is worn by several nodes, wanted one of them: "
                             "'node:%.60s', 'node:%.60s'%s", name, first, other,
                             display->part_count > 2 ? " ..." : "");
    }
    return true;
}

bool review_display_find(const Scene *scene, const char *name, Arena *arena,
                         ReviewDisplay *out, Error *err)
{
    int id = find_display(scene, name);
    if (id == NO_ID) return not_found(scene, name, *arena, err);
    ReviewDisplay display = collect_parts(scene, name, id, arena);
    if (!scene->displays[id].panel)
        return error_set(err, ERROR_INPUT, "'%.60s' has no panel, wanted a measured display",
                         name);
    if (!display.part_count)
        return error_set(err, ERROR_INPUT, "'%.60s' is worn by no surface of the scene", name);
    if (!check_single(scene, &display, name, err)) return false;
    *out = display;
    return true;
}

/* ---- cameras ----------------------------------------------------------------------------- */

static bool has_name(const SceneCamera *camera, const char *name)
{
    return !strcmp(camera->node_name, name) || !strcmp(camera->camera_name, name);
}

static bool no_camera(const Scene *scene, const char *name, Arena scratch, Error *err)
{
    char         advice[ADVICE_CHARS];
    const char **names = ARENA_NEW(&scratch, const char *, scene->camera_count);
    for (int i = 0; i < scene->camera_count; i++)
        names[i] = *scene->cameras[i].node_name ? scene->cameras[i].node_name
                                                : scene->cameras[i].camera_name;
    if (!scene->camera_count)
        return error_set(err, ERROR_INPUT, "the scene has no camera, wanted 'position_m'");
    return error_set(err, ERROR_INPUT, "there is no camera '%.60s': %s", name,
                     nearest_word_advice(name, names, scene->camera_count, advice,
                                         sizeof advice));
}

bool review_camera_find(const Scene *scene, const ReviewEye *eye, Arena scratch, int *camera_id,
                        Error *err)
{
    if (!eye->camera) {
        if (eye->camera_id >= scene->camera_count)
            return error_set(err, ERROR_INPUT,
                             "there is no camera %d, wanted one of the scene's %d, counted "
                             "from 0", eye->camera_id, scene->camera_count);
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
    const Scene         *scene;
    Problems            *problems;
} RequestCheck;

static void note(const RequestCheck *check, const char *path, const Error *why)
{
    problems_add(check->problems, SEVERITY_ERROR, check->request->file, path, "%s", why->text);
}

/* A member of an object by the names that the user gave: its JSON path. */
static const char *place(const RequestCheck *check, const char *list, const char *name,
                         const char *member)
{
    return arena_format(check->problems->arena, "/%s/%s/%s", list, name, member);
}

static bool check_display(const RequestCheck *check, const char *path, const char *name,
                          ReviewDisplay *out)
{
    Error why;
    if (review_display_find(check->scene, name, check->problems->arena, out, &why)) return true;
    note(check, path, &why);
    return false;
}

static void check_eye(const RequestCheck *check, const ReviewEye *eye)
{
    Error why;
    int   camera_id;
    if (eye->kind != EYE_CAMERA) return;
    const char *path = place(check, "eyes", eye->name, "camera");
    if (!review_camera_find(check->scene, eye, *check->problems->arena, &camera_id, &why))
        note(check, path, &why);
    else if (!check->scene->cameras[camera_id].is_perspective)
        problems_add(check->problems, SEVERITY_ERROR, check->request->file, path,
                     "is an orthographic camera, wanted a perspective one: an eye has a place");
}

static void check_symbol(const RequestCheck *check, const ReviewSymbol *symbol)
{
    ReviewDisplay display;
    const char   *path = place(check, "symbols", symbol->name, "display");
    if (!check_display(check, path, symbol->display, &display) || symbol->content) return;
    if (check->scene->displays[display.display_id].content.texture_id == NO_ID)
        problems_add(check->problems, SEVERITY_ERROR, check->request->file, path,
                     "'%.60s' shows no content in the scene, wanted 'content' beside it",
                     symbol->display);
}

/* "*" is all others; a curve is of all. */
static void check_level(const RequestCheck *check, const ReviewLevel *level)
{
    ReviewDisplay display;
    for (int i = 0; i < level->fixed_count; i++) {
        const char *name = level->fixed[i].display;
        if (strcmp(name, "*"))
            check_display(check, place(check, "levels", level->name, name), name, &display);
    }
}

static void check_contents(const RequestCheck *check, int condition)
{
    ReviewDisplay          display;
    const ReviewCondition *c = &check->request->conditions[condition];
    const char *number = arena_format(check->problems->arena, "%d/contents", condition);
    for (int i = 0; i < c->content_count; i++) {
        const char *name = c->contents[i].display;
        check_display(check, place(check, "conditions", number, name), name, &display);
    }
}

/* Names of displays in a variant's brightness, which the loader does not look for. */
static void check_change(const RequestCheck *check, const ReviewChange *change)
{
    ReviewDisplay display;
    for (int i = 0; i < change->brightness_count; i++) {
        const char *name = change->brightness[i].display;
        if (strcmp(name, "*")) check_display(check, change->place, name, &display);
    }
}

bool review_request_check(const ReviewRequest *request, const Scene *scene, Problems *problems)
{
    int          before = problems->error_count;
    RequestCheck check = {request, scene, problems};
    for (int i = 0; i < request->eye_count; i++) check_eye(&check, &request->eyes[i]);
    for (int i = 0; i < request->symbol_count; i++) check_symbol(&check, &request->symbols[i]);
    for (int i = 0; i < request->level_count; i++) check_level(&check, &request->levels[i]);
    for (int i = 0; i < request->condition_count; i++) check_contents(&check, i);
    if (request->change) check_change(&check, request->change);
    if (problems->error_count == before) review_request_doubt(request, scene, problems);
    return problems->error_count == before;
}
