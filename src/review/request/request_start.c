/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_start.h"

#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "text/json_text.h"
#include "text/text.h"

#define LINE_CHARS 92
#define INDENT 2
#define UV_STEPS 10000 /* coordinates are written to four digits */
#define UV_SLACK 0.01  /* of such a step: what floats may miss */
#define NUMBER_FLAGS (JSON_ENCODE_ANY | JSON_REAL_PRECISION(10))

/* ---- pretty printing --------------------------------------------------------------------- */

/* A value's place: of its own lines, and how many letters stand before it in the first. */
typedef struct PrintPlace {
    int indent, column;
} PrintPlace;

static void print(Text *text, json_t *value, PrintPlace place);

static void print_line(Text *text, const json_t *value)
{
    char *line = json_dumps(value, NUMBER_FLAGS);
    text_add(text, line ? line : "null");
    free(line);
}

static bool fits(const json_t *value, PrintPlace place)
{
    char *line = json_dumps(value, NUMBER_FLAGS);
    bool  is_short = !line || (size_t)place.column + strlen(line) <= LINE_CHARS;
    free(line);
    return is_short || !(json_is_array(value) || json_is_object(value));
}

/* Returns its letters. */
static int print_key(Text *text, const char *key)
{
    json_t *string = json_text(key);
    size_t  before = text->size;
    print_line(text, string);
    text_add(text, ": ");
    json_decref(string);
    return (int)(text->size - before);
}

static void print_members(Text *text, json_t *value, int indent)
{
    const char *key, *between = "";
    json_t     *item;
    size_t      i;
    json_object_foreach(value, key, item) {
        text_format(text, "%s\n%*s", between, indent, "");
        int letters = print_key(text, key);
        print(text, item, (PrintPlace){indent, indent + letters});
        between = ",";
    }
    json_array_foreach(value, i, item) {
        text_format(text, "%s\n%*s", between, indent, "");
        print(text, item, (PrintPlace){indent, indent});
        between = ",";
    }
}

/* What fits into a line stands in one; the document itself never does. */
static void print(Text *text, json_t *value, PrintPlace place)
{
    if (place.indent && fits(value, place)) {
        print_line(text, value);
        return;
    }
    text_add(text, json_is_object(value) ? "{" : "[");
    print_members(text, value, place.indent + INDENT);
    text_format(text, "\n%*s%s", place.indent, "", json_is_object(value) ? "}" : "]");
}

/* ---- the scene's files ------------------------------------------------------------------- */

/* Length of the folders that both absolute paths begin with, the slash included. */
static size_t common_folders(const char *a, const char *b)
{
    size_t length = 0;
    for (size_t i = 0; a[i] && a[i] == b[i]; i++)
        if (a[i] == '/') length = i + 1;
    return length;
}

static void add_escaped(Text *text, const char *path)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                "0123456789-._~/";
    for (; *path; path++)
        if (strchr(plain, *path))
            text_format(text, "%c", *path);
        else
            text_format(text, "%%%02X", (unsigned)(unsigned char)*path);
}

static bool lies_in(const char *root, const char *target)
{
    char folder[PATH_MAX];
    if (!root || !realpath(root, folder)) return false;
    size_t length = strlen(folder);
    return !strncmp(target, folder, length) &&
           (folder[length - 1] == '/' || target[length] == '/');
}

/* The URI of a scene's file in a document in the absolute folder `from` ("/a/b/"); NULL and an
 * error when it may not be named there. */
static const char *uri_of(const char *from, const char *file, const char *root, Arena *arena,
                          Error *err)
{
    char target[PATH_MAX];
    Text text = {.arena = arena};
    if (!realpath(file, target)) {
        error_at(err, ERROR_INPUT, file, "", "cannot be found");
        return NULL;
    }
    size_t shared = common_folders(from, target);
    int    up = 0;
    for (const char *at = from + shared; *at; at++) up += *at == '/';
    if (up > 1 && !lies_in(root, target)) {
        error_at(err, ERROR_INPUT, file, "",
                 "lies outside the parent of the new file's folder, wanted the new file in the "
                 "scene's folder or one beside it, or --root");
        return NULL;
    }
    for (; up > 0; up--) text_add(&text, "../");
    add_escaped(&text, target + shared);
    return text.data;
}

static bool find_folder(const char *output, char folder[PATH_MAX + 1], Arena scratch,
                        Error *err)
{
    if (!realpath(path_beside(output, "./", &scratch), folder))
        return error_at(err, ERROR_OUTPUT, output, "", "its folder cannot be found");
    if (strcmp(folder, "/")) strcat(folder, "/");
    return true;
}

static bool add_scenes(json_t *document, const ReviewStart *start, Arena *arena, Error *err)
{
    char    folder[PATH_MAX + 1];
    json_t *list = json_array();
    json_object_set_new(document, "scene", list);
    if (!find_folder(start->output, folder, *arena, err)) return false;
    for (int i = 0; i < start->scene_count; i++) {
        const char *uri = uri_of(folder, start->scenes[i], start->root, arena, err);
        if (!uri) return false;
        json_array_append_new(list, json_text(uri));
    }
    return true;
}

/* ---- eyes and symbols -------------------------------------------------------------------- */

static bool add_eyes(json_t *document, const Scene *scene, Arena *arena, Error *err)
{
    json_t *eyes = json_object();
    json_object_set_new(document, "eyes", eyes);
    for (int i = 0; i < scene->camera_count; i++) {
        const SceneCamera *camera = &scene->cameras[i];
        const char *name = *camera->node_name ? camera->node_name : camera->camera_name;
        if (!camera->is_perspective) continue;
        bool is_known = !*name || json_object_get(eyes, name);
        if (is_known) name = arena_format(arena, "camera %d", i);
        json_object_set_new(eyes, name, is_known ? json_pack("{s:i}", "camera", i)
                                                 : json_pack("{s:s}", "camera", name));
    }
    return json_object_size(eyes) > 0 ||
           error_at(err, ERROR_INPUT, scene->inputs[0], "",
                    "has no perspective camera, wanted one where an eye is");
}

static int material_of(const Scene *scene, int part)
{
    return scene->parts[part].material_id;
}

/* Whether parts of several names wear the material. */
static bool is_shared(const Scene *scene, int material)
{
    const char *name = NULL;
    for (int i = 0; i < scene->part_count; i++) {
        if (material_of(scene, i) != material) continue;
        if (name && strcmp(name, scene->parts[i].name)) return true;
        name = scene->parts[i].name;
    }
    return false;
}

/* What of its content a part shows: left, top, right, bottom, within 0..1. Empty (left above
 * right) without triangles. */
static void measure_uv(const Scene *scene, const TextureSlot *slot, const Part *part,
                       double uv[4])
{
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
static void add_symbol(json_t *symbols, const char *name, const char *display,
                       const double uv[4])
{
    json_t *symbol = json_pack("{s:s}", "display", display);
    bool    is_all = uv[0] <= 0 && uv[1] <= 0 && uv[2] >= 1 && uv[3] >= 1;
    if (!is_all && uv[0] < uv[2] && uv[1] < uv[3])
        json_object_set_new(symbol, "uv",
                            json_pack("[f,f,f,f]", uv[0], uv[1], uv[2], uv[3]));
    json_object_set_new(symbol, "find", json_string("text"));
    json_object_set_new(symbols, name, symbol);
}

static void add_symbols_of(json_t *symbols, const Scene *scene, const Display *display,
                           Arena *arena)
{
    bool shared = is_shared(scene, display->material_id);
    for (int i = 0; i < scene->part_count; i++) {
        double      uv[4];
        const char *name = shared ? scene->parts[i].name : display->name;
        if (material_of(scene, i) != display->material_id) continue;
        measure_uv(scene, &display->content, &scene->parts[i], uv);
        add_symbol(symbols, name, shared ? arena_format(arena, "node:%s", name) : name, uv);
    }
}

static bool add_symbols(json_t *document, const Scene *scene, Arena *arena, Error *err)
{
    json_t *symbols = json_object();
    json_object_set_new(document, "symbols", symbols);
    for (int i = 0; i < scene->display_count; i++)
        if (scene->displays[i].content.texture_id != NO_ID)
            add_symbols_of(symbols, scene, &scene->displays[i], arena);
    return json_object_size(symbols) > 0 ||
           error_at(err, ERROR_INPUT, scene->inputs[0], "",
                    "has no display that shows content, wanted one to review");
}

/* ---- levels and conditions --------------------------------------------------------------- */

#define START_YEAR 2026
#define START_PLACE "where", 48.14, 11.58, 520.0

static json_t *conditions(void)
{
    json_t *noon = json_pack("{s:s, s:{s:s, s:s, s:[f,f,f]}, s:i, s:s}", "name", "noon",
                             "environment", "type", "sky", "when", "2026-06-21T12:00+02:00",
                             START_PLACE, "heading_deg", 0, "level", "day");
    json_t *night = json_pack("{s:s, s:{s:s, s:f}, s:s}", "name", "night", "environment",
                              "type", "constant", "luminance", 0.01, "level", "night");
    json_t *year = json_pack("{s:s, s:{s:i, s:[f,f,f], s:i, s:[i,i,i,i,i,i,i,i], s:s}, s:s}",
                             "name", "a year", "sweep", "year", START_YEAR, START_PLACE,
                             "step_minutes", 60, "headings_deg", 0, 45, 90, 135, 180, 225, 270,
                             315, "weather", "clear", "level", "day");
    return json_pack("[o,o,o]", noon, night, year);
}

static void add_rest(json_t *document, const Scene *scene)
{
    Vec3 forward = scene->environment.forward;
    json_object_set_new(document, "forward",
                        json_pack("[f,f,f]", (double)forward.x, (double)forward.y,
                                  (double)forward.z));
    json_object_set_new(document, "observer",
                        json_pack("{s:i, s:f}", "age_years", 50, "pigment", 0.5));
    json_object_set_new(document, "gaze", json_pack("[{s:s}]", "at", "symbols"));
    json_object_set_new(document, "profile", json_string("iso-15008"));
    json_object_set_new(document, "levels",
                        json_pack("{s:{s:f}, s:{s:f}}", "day", "*", 1.0, "night", "*", 0.05));
    json_object_set_new(document, "conditions", conditions());
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool fill(json_t *document, const ReviewStart *start, const Scene *scene, Arena *arena,
                 Error *err)
{
    const char *name = path_name(start->scenes[0]);
    const char *title = arena_string(arena, name, strlen(name) - strlen(path_ending(name)));
    json_object_set_new(document, "title", json_text(title));
    if (!add_scenes(document, start, arena, err) || !add_eyes(document, scene, arena, err) ||
        !add_symbols(document, scene, arena, err))
        return false;
    add_rest(document, scene);
    return true;
}

bool review_request_start(const ReviewStart *start, const Scene *scene, Arena *arena,
                          Error *err)
{
    Text text = {.arena = arena};
    if (!access(start->output, F_OK))
        return error_at(err, ERROR_OUTPUT, start->output, "",
                        "is there already, wanted the name of a new file");
    json_t *document = json_object();
    bool    ok = fill(document, start, scene, arena, err);
    if (ok) {
        print(&text, document, (PrintPlace){0, 0});
        text_add(&text, "\n");
    }
    json_decref(document);
    return ok && text_write(&text, start->output, err);
}
