/* SPDX-License-Identifier: Apache-2.0 */
#include "render/identity.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/file.h"
#include "bvh/bvh.h"
#include "render/render.h"

/* ---- lines ------------------------------------------------------------------------------- */

/* A name of a file or a material may hold anything: control characters become '?', so that a
 * line stays a line. */
void identity_line(Text *text, const char *name, const char *format, ...) {
    char value[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    for (char *c = value; *c; c++)
        if ((unsigned char)*c < ' ') *c = '?';
    text_format(text, "%s\t%s\n", name, value);
}

void identity_number(Text *text, const char *name, double value) {
    identity_line(text, name, "%.17g", value);
}

void identity_float(Text *text, const char *name, float value) {
    identity_line(text, name, "%.9g", (double)value);
}

void identity_vector(Text *text, const char *name, Vec3 v) {
    identity_line(text, name, "%.9g %.9g %.9g", (double)v.x, (double)v.y, (double)v.z);
}

/* ---- files and what is made of them ------------------------------------------------------ */

static const char *input_name(const Scene *scene, const char *path, Arena *arena) {
    for (int i = 0; i < scene->input_count; i++)
        if (!strcmp(scene->inputs[i], path))
            return arena_format(arena, "%s %016llx", path_name(path),
                                (unsigned long long)scene->input_hashes[i]);
    return path_name(path);
}

static size_t image_bytes(const Image *image) {
    static const size_t value_bytes[] = {
        [IMAGE_RGBA8] = 1, [IMAGE_RGBA16] = 2, [IMAGE_RGBA32F] = 4};
    return (size_t)image->width * (size_t)image->height * 4 * value_bytes[image->format];
}

static uint64_t image_hash(const Image *image, uint64_t seed) {
    return image->pixels ? XXH3_64bits_withSeed(image->pixels, image_bytes(image), seed) : seed;
}

/* Pictures as they were decoded: another library may decode a JPEG a little differently. */
static uint64_t decoded_pictures(const Scene *scene) {
    uint64_t hash = image_hash(&scene->environment.hdri, 0);
    for (int i = 0; i < scene->texture_count; i++) {
        const Image *image = &scene->textures[i].image;
        if (i && image->pixels == scene->textures[i - 1].image.pixels) continue;
        hash = image_hash(image, hash);
    }
    return hash;
}

static void add_files(Text *text, const Scene *scene) {
    for (int i = 0; i < scene->input_count; i++)
        identity_line(text, arena_format(text->arena, "input %d", i), "%s %016llx",
                      path_name(scene->inputs[i]), (unsigned long long)scene->input_hashes[i]);
    identity_line(text, "decoded pictures", "%016llx", (unsigned long long)decoded_pictures(scene));
}

/* Adds contents from the command line, then all displays as they are. */
static void add_displays(Text *text, const SceneOptions *options, const Scene *scene) {
    Arena *arena = text->arena;
    for (int i = 0; i < options->content_count; i++) {
        const SceneOverride *content = &options->contents[i];
        identity_line(text, arena_format(arena, "content %d", i), "%s=%s", content->material,
                      input_name(scene, content->value, arena));
    }
    for (int i = 0; i < scene->display_count; i++) {
        const Display *display = &scene->displays[i];
        identity_line(text, arena_format(arena, "display %d", i), "%s, level %.9g, %s",
                      display->name, (double)display->level,
                      input_name(scene, display->panel_path, arena));
    }
}

/* Lamps of luminaire files: where they are is in the scene's own files. */
static void add_luminaires(Text *text, const Scene *scene) {
    for (int i = 0; i < scene->light_count; i++) {
        const PunctualLight *light = &scene->lights[i];
        if (light->kind != LIGHT_LUMINAIRE) continue;
        identity_line(text, arena_format(text->arena, "light %d", i), "%s, level %.9g, %.9g K, %s",
                      light->name, (double)light->level, (double)light->cct_k,
                      input_name(scene, light->file, text->arena));
    }
}

/* ---- the surroundings -------------------------------------------------------------------- */

static const char *const environment_names[] = {
    [ENVIRONMENT_NONE] = "none", [ENVIRONMENT_CONSTANT] = "constant", [ENVIRONMENT_HDRI] = "hdri",
    [ENVIRONMENT_CIE] = "cie",   [ENVIRONMENT_PEREZ] = "perez",       [ENVIRONMENT_SKY] = "sky"};
static const char *const floor_names[] = {
    [FLOOR_LAND] = "land", [FLOOR_SEA] = "sea", [FLOOR_CLOUD] = "cloud"};

static void add_daylight(Text *text, const DaylightInput *daylight) {
    const SkyTime *when = &daylight->when;
    if (daylight->has_time)
        identity_line(text, "when", "%04d-%02d-%02dT%02d:%02d:%.17g%+.17gh", when->year,
                      when->month, when->day, when->hour, when->minute, when->second, when->zone_h);
    identity_line(text, "where", "%.17g,%.17g,%.17g", daylight->where.latitude_deg,
                  daylight->where.longitude_deg, daylight->where.altitude_m);
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"sky sun lux", daylight->sun_lux},
                   {"sky type", daylight->cie_type},
                   {"sky lux", daylight->diffuse_lux},
                   {"direct W/m2", daylight->direct_w_m2},
                   {"diffuse W/m2", daylight->diffuse_w_m2},
                   {"turbidity", daylight->turbidity},
                   {"visibility km", daylight->visibility_km},
                   {"ozone atm-cm", daylight->ozone_atm_cm},
                   {"water cm", daylight->water_cm},
                   {"albedo", daylight->albedo},
                   {"quadrature steps", daylight->integral_steps}};
    for (int i = 0; i < COUNT_OF(numbers); i++)
        identity_number(text, numbers[i].name, numbers[i].value);
    if (daylight->has_lux) identity_number(text, "direct lux", daylight->direct_lux);
    identity_line(text, "moon", "%s", daylight->no_moon ? "left out" : "in its place");
    identity_line(text, "ground", "%s", floor_names[daylight->floor]);
    identity_number(text, "cloud top m", daylight->cloud_top_m);
    if (daylight->cloud_relief_m > 0)
        identity_number(text, "cloud relief m", daylight->cloud_relief_m);
}

void identity_add_environment(Text *text, const Scene *scene) {
    const Environment *environment = &scene->environment;
    identity_line(text, "environment", "%s", environment_names[environment->kind]);
    identity_float(text, "environment cd/m2", environment->luminance_cd_m2);
    identity_line(text, "environment colour", "%.9g %.9g %.9g", (double)environment->color[0],
                  (double)environment->color[1], (double)environment->color[2]);
    if (environment->kind == ENVIRONMENT_HDRI) {
        identity_line(text, "hdri", "%s", input_name(scene, environment->hdri_path, text->arena));
        identity_float(text, "hdri rotation", environment->hdri_rotation);
        identity_float(text, "hdri scale", environment->hdri_scale);
        identity_float(text, "hdri lux", environment->horizontal_illuminance_lx);
    }
    if (environment->kind >= ENVIRONMENT_CIE) add_daylight(text, &environment->daylight);
    identity_line(text, "sun", "%s", environment->has_sun ? "set" : "not set");
    if (environment->has_sun) {
        identity_float(text, "sun azimuth", environment->sun_azimuth);
        identity_float(text, "sun elevation", environment->sun_elevation);
        identity_float(text, "sun lux", environment->sun_illuminance_lx);
    }
    identity_float(text, "sun radius", environment->sun_angular_radius);
    identity_float(text, "heading", environment->heading);
    identity_vector(text, "forward", environment->forward);
}

/* ---- the camera -------------------------------------------------------------------------- */

void identity_add_camera(Text *text, const SceneCamera *camera) {
    const Transform *t = &camera->world_from_camera;
    if (camera->fisheye) {
        identity_line(text, "camera", "fisheye, %s", fisheye_name(camera->fisheye));
    } else {
        identity_line(text, "camera", "%s",
                      camera->is_perspective ? "perspective" : "orthographic");
        identity_float(text, camera->is_perspective ? "camera yfov" : "camera ymag",
                       camera->is_perspective ? camera->yfov : camera->ymag);
    }
    identity_vector(text, "camera x", t->x);
    identity_vector(text, "camera y", t->y);
    identity_vector(text, "camera z", t->z);
    identity_vector(text, "camera origin", t->origin);
}

/* ---- all of it --------------------------------------------------------------------------- */

void identity_add_program(Text *text, const Kernel *kernel) {
    identity_line(text, "version", "%s", PARHELION_VERSION);
    identity_line(text, "sources", "%s", SOURCES_HASH);
    identity_line(text, "isa", "%s", kernel->isa);
    identity_line(text, "ray tracer", "%s", bvh_library());
}

/* Only what is chosen, so that the identities of other frames stay what they were. */
static void add_state(Text *text, const SceneState *state) {
    for (int i = 0; i < state->variant_count; i++)
        identity_line(text, arena_format(text->arena, "variant %d", i), "%s", state->variants[i]);
    if (state->has_time) identity_number(text, "time s", state->time_s);
    for (int i = 0; i < state->animation_count; i++)
        identity_line(text, arena_format(text->arena, "animation %d", i), "%s",
                      state->animations[i]);
}

static void add_changes(Text *text, const SceneOptions *options) {
    for (int i = 0; i < options->change_count; i++) {
        const SceneChange *c = &options->changes[i];
        const SceneHinge *h = &c->hinge;
        const float numbers[] = {
            c->tilt,         c->turn,         c->roll,          c->move_m[0], c->move_m[1],
            c->move_m[2],    c->ahead[0],     c->ahead[1],      c->ahead[2],  c->depth_m,
            c->middle_m,     h->axis[0],      h->axis[1],       h->axis[2],   h->through_m[0],
            h->through_m[1], h->through_m[2], (float)h->is_own, h->angle,     c->finish.matte,
            c->finish.alpha};
        XXH64_hash_t hash = XXH3_64bits(numbers, sizeof numbers);
        for (int k = 0; k < c->with_count; k++)
            hash = XXH3_64bits_withSeed(c->with[k], strlen(c->with[k]), hash);
        if (c->patch) hash = XXH3_64bits_withSeed(c->patch, strlen(c->patch), hash);
        identity_line(text, arena_format(text->arena, "change %d", i), "%d %.200s %016llx",
                      (int)c->kind, c->name, (unsigned long long)hash);
    }
}

void identity_add_scene(Text *text, const SceneOptions *options, const Scene *scene) {
    add_files(text, scene);
    add_displays(text, options, scene);
    add_luminaires(text, scene);
    add_state(text, &options->state);
    add_changes(text, options);
}

/* ---- comparing --------------------------------------------------------------------------- */

/* The value of the line of this name, up to its end; NULL: there is none. */
static const char *value_of(const char *text, const char *name, size_t length) {
    for (const char *at = text; *at; at += strcspn(at, "\n") + 1) {
        if (!strncmp(at, name, length) && at[length] == '\t') return at + length + 1;
        if (!at[strcspn(at, "\n")]) break;
    }
    return NULL;
}

static const char *value_text(const char *value, Arena *arena) {
    return value ? arena_string(arena, value, strcspn(value, "\n")) : "none";
}

static bool has_name(const char *list, const char *name, size_t length) {
    for (size_t other; *list; list += other + (list[other] == ',')) {
        other = strcspn(list, ",");
        if (other == length && !memcmp(list, name, length)) return true;
    }
    return false;
}

/* The names of a list with commas that the other has not, and where that is. */
static void add_names_alone(Text *text, const char *list, const char *other, const char *where) {
    const char *before = text->size ? "; " : "layers: ", *first = before;
    for (size_t length; *list; list += length + (list[length] == ',')) {
        length = strcspn(list, ",");
        if (has_name(other, list, length)) continue;
        text_format(text, "%s%.*s", before, (int)length, list);
        before = ",";
    }
    if (before != first) text_add(text, where);
}

/* Layers are lists: all of both would hide the one that is missing. */
static const char *difference(const char *line_begin, const char *there, const char *here,
                              Arena *arena) {
    size_t length = strcspn(line_begin, "\t\n");
    const char *old = value_text(value_of(there, line_begin, length), arena);
    const char *now = value_text(value_of(here, line_begin, length), arena);
    Text text = {.arena = arena};
    if (!strncmp(line_begin, "layers\t", 7)) {
        add_names_alone(&text, old, now, " there, not here");
        add_names_alone(&text, now, old, " here, not there");
    }
    if (!text.size)
        text_format(&text, "%.*s: %s there, %s here", (int)length, line_begin, old, now);
    return text.data;
}

const char *identity_difference(const char *there, const char *here, Arena *arena) {
    const char *a = there, *b = here;
    while (*a && *b) {
        size_t length = strcspn(a, "\n");
        if (length != strcspn(b, "\n") || memcmp(a, b, length) != 0) break;
        a += length + (a[length] == '\n');
        b += length + (b[length] == '\n');
    }
    if (!*a && !*b) return NULL;
    /* A line that only one of them has stands before those that both have. */
    size_t name = strcspn(a, "\t\n");
    bool is_line = a[name] == '\t', is_same_name = !strncmp(a, b, name) && b[name] == '\t';
    bool is_extra_here = *b && (!is_line || (!is_same_name && value_of(here, a, name)));
    return difference(is_extra_here ? b : a, there, here, arena);
}

bool identity_same_program(const char *there, const char *here) {
    static const char *const names[] = {"version", "sources", "isa", "ray tracer"};
    for (int i = 0; i < COUNT_OF(names); i++) {
        size_t length = strlen(names[i]);
        const char *a = value_of(there, names[i], length);
        const char *b = value_of(here, names[i], length);
        size_t size = a ? strcspn(a, "\n") : 0;
        if (!a || !b || strcspn(b, "\n") != size || memcmp(a, b, size) != 0) return false;
    }
    return true;
}
