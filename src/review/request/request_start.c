/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_start.h"

#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "text/json_text.h"
#include "text/uri.h"

#define UV_STEPS 10000 /* coordinates are written to four digits */
#define UV_SLACK 0.01  /* of such a step: rounding error of floats */
#define DIGITS 10

/* ---- the scene's files ------------------------------------------------------------------- */

/* The URI of a scene's file in the new document, whose absolute folder is `from` ("/a/b/");
 * NULL and an error when it may not be named there. */
static const char *uri_of(const char *from, const char *file, const ReviewStart *start,
                          Arena *arena, Error *err) {
    char target[PATH_MAX];
    if (!realpath(file, target)) {
        error_at(err, ERROR_INPUT, file, "", "cannot be found");
        return NULL;
    }
    const char *uri = uri_between(from, target, arena);
    const ReferenceReach reach = {start->root, false};
    if (!uri_may_be_named(start->output, uri, reach, *arena)) {
        error_at(err, ERROR_INPUT, file, "",
                 "lies outside the parent of the new file's folder, required: the new file in "
                 "the scene's folder or one beside it (beside it not in \"/\" and the home "
                 "folder), or --root");
        return NULL;
    }
    return uri;
}

static bool find_folder(const char *output, char folder[PATH_MAX + 1], Arena scratch, Error *err) {
    if (!realpath(path_beside(output, "./", &scratch), folder))
        return error_at(err, ERROR_OUTPUT, output, "", "its folder cannot be found");
    if (strcmp(folder, "/")) strcat(folder, "/");
    return true;
}

static bool add_scenes(json_t *document, const ReviewStart *start, Arena *arena, Error *err) {
    char folder[PATH_MAX + 1];
    json_t *list = json_array();
    json_object_set_new(document, "scene", list);
    if (!find_folder(start->output, folder, *arena, err)) return false;
    for (int i = 0; i < start->scene_count; i++) {
        const char *uri = uri_of(folder, start->scenes[i], start, arena, err);
        if (!uri) return false;
        json_array_append_new(list, json_text(uri));
    }
    return true;
}

/* ---- eyes and symbols -------------------------------------------------------------------- */

static bool is_among(const char *const *names, int count, const char *name) {
    bool found = false;
    for (int i = 0; i < count && !found; i++) found = !strcmp(names[i], name);
    return found;
}

/* Some of a model's own cameras see it from outside: wishes name those in its seats. */
static bool is_eye(const ReviewWishes *wishes, const char *name) {
    return !wishes || is_among(wishes->eyes, wishes->eye_count, name);
}

/* NULL: somebody gave it. */
static const char *proposed_from(const ReviewWishes *wishes, const char *name, Arena *arena) {
    if (!wishes) return arena_format(arena, "the model's camera '%s'", name);
    for (int i = 0; i < wishes->eye_count; i++)
        if (!strcmp(wishes->eyes[i], name)) return wishes->eyes_from[i];
    return NULL;
}

static bool is_read(const ReviewWishes *wishes, const Display *display) {
    return display->content.texture_id != NO_ID &&
           (!wishes || is_among(wishes->displays, wishes->display_count, display->name));
}

static bool add_eyes(json_t *document, const ReviewStart *start, const Scene *scene, Arena *arena,
                     Error *err) {
    json_t *eyes = json_object();
    json_object_set_new(document, "eyes", eyes);
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *camera = &scene->cameras[i];
        const char *name = *camera->node_name ? camera->node_name : camera->camera_name;
        if (!camera->is_perspective || !is_eye(start->wishes, name)) continue;
        bool is_known = !*name || json_object_get(eyes, name);
        if (is_known) name = arena_format(arena, "camera %d", i);
        const char *from = proposed_from(start->wishes, name, arena);
        json_t *eye =
            is_known ? json_pack("{s:i}", "camera", i) : json_pack("{s:s}", "camera", name);
        if (from) json_object_set_new(eye, "proposed_from", json_text(from));
        json_object_set_new(eyes, name, eye);
    }
    return json_object_size(eyes) > 0 ||
           error_at(err, ERROR_INPUT, scene->inputs[0], "",
                    "has no perspective camera, required: one where an eye is");
}

static int material_of(const Scene *scene, int part) {
    return scene->parts[part].material_id;
}

/* Whether parts of several names wear the material. */
static bool is_shared(const Scene *scene, int material) {
    const char *name = NULL;
    for (int i = 0; i < scene->part_count; i++) {
        if (material_of(scene, i) != material) continue;
        if (name && strcmp(name, scene->parts[i].name)) return true;
        name = scene->parts[i].name;
    }
    return false;
}

/* The rectangle of its content that a part shows: left, top, right, bottom, within 0..1. Empty
 * (left above right) without triangles. */
static void measure_uv(const Scene *scene, const TextureSlot *slot, const Part *part,
                       double uv[4]) {
    const float *m = slot->uv_from_uv;
    uv[0] = uv[1] = 1, uv[2] = uv[3] = 0;
    for (uint32_t t = 0; t < part->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++) {
            Vec2 at = scene_corner_uv(scene, part->first_triangle + t, corner, slot->uv_set);
            double u = (double)(m[0] * at.x + m[1] * at.y + m[2]);
            double v = (double)(m[3] * at.x + m[4] * at.y + m[5]);
            uv[0] = fmax(0, fmin(uv[0], u)), uv[1] = fmax(0, fmin(uv[1], v));
            uv[2] = fmin(1, fmax(uv[2], u)), uv[3] = fmin(1, fmax(uv[3], v));
        }
    for (int i = 0; i < 2; i++) { /* inwards: what lies beside it belongs to others */
        uv[i] = ceil(uv[i] * UV_STEPS - UV_SLACK) / UV_STEPS + 0.0; /* no -0 */
        uv[i + 2] = floor(uv[i + 2] * UV_STEPS + UV_SLACK) / UV_STEPS;
    }
}

/* A symbol over what the part shows; all of the content goes without saying. */
static void add_symbol(json_t *symbols, const char *name, const char *display, const double uv[4]) {
    json_t *symbol = json_pack("{s:s}", "display", display);
    bool is_all = uv[0] <= 0 && uv[1] <= 0 && uv[2] >= 1 && uv[3] >= 1;
    if (!is_all && uv[0] < uv[2] && uv[1] < uv[3])
        json_object_set_new(symbol, "uv", json_pack("[f,f,f,f]", uv[0], uv[1], uv[2], uv[3]));
    json_object_set_new(symbol, "find", json_string("text"));
    json_object_set_new(symbols, name, symbol);
}

static void add_symbols_of(json_t *symbols, const Scene *scene, const Display *display,
                           Arena *arena) {
    bool shared = is_shared(scene, display->material_id);
    for (int i = 0; i < scene->part_count; i++) {
        double uv[4];
        const char *name = shared ? scene->parts[i].name : display->name;
        if (material_of(scene, i) != display->material_id) continue;
        measure_uv(scene, &display->content, &scene->parts[i], uv);
        add_symbol(symbols, name, shared ? arena_format(arena, "node:%s", name) : name, uv);
    }
}

/* By its own name, or by its display's before it where that is taken. */
static void add_read(json_t *symbols, const ReviewRead *read, Arena *arena) {
    const char *name = read->name;
    json_t *symbol = json_pack("{s:o, s:[f,f,f,f]}", "display", json_text(read->display), "uv",
                               read->uv[0], read->uv[1], read->uv[2], read->uv[3]);
    if (read->polarity) json_object_set_new(symbol, "polarity", json_text(read->polarity));
    for (int i = 1; json_object_get(symbols, name); i++)
        name = i == 1 ? arena_format(arena, "%s: %s", read->display, read->name)
                      : arena_format(arena, "%s: %s %d", read->display, read->name, i);
    json_object_set_new(symbols, name, symbol);
}

static bool add_symbols(json_t *document, const ReviewStart *start, const Scene *scene,
                        Arena *arena, Error *err) {
    json_t *symbols = json_object();
    json_object_set_new(document, "symbols", symbols);
    for (int i = 0; i < scene->display_count; i++)
        if (is_read(start->wishes, &scene->displays[i]))
            add_symbols_of(symbols, scene, &scene->displays[i], arena);
    for (int i = 0; start->wishes && i < start->wishes->read_count; i++)
        add_read(symbols, &start->wishes->reads[i], arena);
    return json_object_size(symbols) > 0 ||
           error_at(err, ERROR_INPUT, scene->inputs[0], "",
                    "has no display that shows content, required: one to review");
}

/* ---- levels and conditions --------------------------------------------------------------- */

#define START_YEAR 2026
#define HOUR_DEG 15.0 /* longitude */

static const double start_headings_deg[] = {0, 45, 90, 135, 180, 225, 270, 315};

static ReviewPlace place_of(const ReviewStart *start) {
    if (start->wishes && start->wishes->place) return *start->wishes->place;
    return (ReviewPlace){
        {48.14, 11.58, 520.0}, START_YEAR, start_headings_deg, COUNT_OF(start_headings_deg)};
}

static json_t *where_of(const ReviewPlace *place) {
    return json_pack("[f,f,f]", place->where[0], place->where[1], place->where[2]);
}

static json_t *whole_or_not(double value) {
    return value == floor(value) ? json_integer((json_int_t)value) : json_real(value);
}

/* Noon by the clock of the place's zone, or of summer time where nothing was wished. */
static json_t *noon_of(const ReviewStart *start, const ReviewPlace *place, Arena *arena) {
    bool is_known = start->wishes && start->wishes->place;
    int zone = is_known ? (int)lround(place->where[1] / HOUR_DEG) : 2;
    char *when = arena_format(arena, "%04d-06-21T12:00%c%02d:00", place->year, zone < 0 ? '-' : '+',
                              abs(zone));
    return json_pack("{s:s, s:{s:s, s:s, s:o}, s:o, s:s}", "name", "noon", "environment", "type",
                     "sky", "when", when, "where", where_of(place), "heading_deg",
                     whole_or_not(place->headings_deg[0]), "level", "day");
}

static json_t *year_of(const ReviewPlace *place) {
    json_t *headings = json_array();
    for (int i = 0; i < place->heading_count; i++)
        json_array_append_new(headings, whole_or_not(place->headings_deg[i]));
    return json_pack("{s:s, s:{s:i, s:o, s:i, s:o, s:s}, s:s}", "name", "a year", "sweep", "year",
                     place->year, "where", where_of(place), "step_minutes", 60, "headings_deg",
                     headings, "weather", "clear", "level", "day");
}

static json_t *any_sun(void) {
    return json_pack("{s:s, s:{s:{s:[i,i,i], s:[i,i,i]}, s:s}, s:s}", "name", "any sun", "sweep",
                     "sun", "azimuth_deg", 0, 360, 2, "elevation_deg", 0, 80, 2, "sky", "sky",
                     "level", "day");
}

/* What most hours are like: a sky of even cloud over 10,000 lx, and a street whose lamps and
 * ground send some 1 cd/m2. The others are the hardest ones. */
static void add_ordinary(json_t *list) {
    json_array_append_new(list, json_pack("{s:s, s:{s:s, s:i, s:f}, s:s}", "name",
                                          "an ordinary day", "environment", "type", "cie", "sky", 1,
                                          "diffuse_horizontal_lx", 1e4, "level", "day"));
    json_array_append_new(list, json_pack("{s:s, s:{s:s, s:f}, s:s}", "name", "an ordinary night",
                                          "environment", "type", "constant", "luminance", 1.0,
                                          "level", "night"));
}

static void seat_occupant(const ReviewWishes *wishes, json_t *conditions) {
    json_t *condition;
    size_t i;
    json_array_foreach(conditions, i, condition)
        json_object_set_new(condition, "with", json_text(wishes->occupant));
}

static json_t *conditions(const ReviewStart *start, Arena *arena) {
    const ReviewPlace place = place_of(start);
    json_t *night = json_pack("{s:s, s:{s:s, s:f}, s:s}", "name", "night", "environment", "type",
                              "constant", "luminance", 0.01, "level", "night");
    json_t *list = json_array();
    if (start->wishes) add_ordinary(list);
    json_array_append_new(list, noon_of(start, &place, arena));
    json_array_append_new(list, night);
    if (start->wishes) json_array_append_new(list, any_sun());
    if (!start->wishes || start->wishes->place) json_array_append_new(list, year_of(&place));
    if (start->wishes && start->wishes->occupant) seat_occupant(start->wishes, list);
    return list;
}

static json_t *forward_of(const ReviewStart *start, const Scene *scene) {
    const Vec3 own = scene->environment.forward;
    const double *wish = start->wishes ? start->wishes->forward : NULL;
    return json_pack("[f,f,f]", wish ? wish[0] : (double)own.x, wish ? wish[1] : (double)own.y,
                     wish ? wish[2] : (double)own.z);
}

static void add_rest(json_t *document, const ReviewStart *start, const Scene *scene, Arena *arena) {
    const char *profile = start->wishes ? start->wishes->profile : "iso-15008";
    json_object_set_new(document, "forward", forward_of(start, scene));
    json_object_set_new(document, "observer",
                        json_pack("{s:i, s:f}", "age_years", 50, "pigment", 0.5));
    json_object_set_new(document, "gaze", json_pack("[{s:s}]", "at", "symbols"));
    json_object_set_new(document, "profile", json_text(profile));
    json_object_set_new(document, "levels",
                        json_pack("{s:{s:f}, s:{s:f}}", "day", "*", 1.0, "night", "*", 0.05));
    if (start->wishes && start->wishes->occupant)
        json_object_set_new(
            document, "with",
            json_pack("{s:[o]}", start->wishes->occupant, json_text(start->wishes->occupant_uri)));
    json_object_set_new(document, "conditions", conditions(start, arena));
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool fill(json_t *document, const ReviewStart *start, const Scene *scene, Arena *arena,
                 Error *err) {
    const char *name = path_name(start->scenes[0]);
    const char *title = arena_string(arena, name, strlen(name) - strlen(path_ending(name)));
    json_object_set_new(document, "title", json_text(title));
    if (!add_scenes(document, start, arena, err) || !add_eyes(document, start, scene, arena, err) ||
        !add_symbols(document, start, scene, arena, err))
        return false;
    add_rest(document, start, scene, arena);
    return true;
}

bool review_request_start(const ReviewStart *start, const Scene *scene, Arena *arena, Error *err) {
    Text text = {.arena = arena};
    if (!start->replaces && !access(start->output, F_OK))
        return error_at(err, ERROR_OUTPUT, start->output, "",
                        "is there already, required: the name of a new file");
    json_t *document = json_object();
    bool ok = fill(document, start, scene, arena, err);
    if (ok) json_print(&text, document, (JsonDigits){DIGITS, true});
    json_decref(document);
    return ok && text_write(&text, start->output, err);
}
