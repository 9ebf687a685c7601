/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/setup.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "camera/camera.h"
#include "guide/guide_file.h"
#include "render/identity.h"
#include "render/train.h"
#include "review/light/reading.h"
#include "review/request/request_check.h"
#include "scene/load/scene_load.h"
#include "text/text.h"

#define SENSOR_PRECISION 0.01
#define SENSOR_PATHS 65536
#define SENSOR_SEED 0x73656e73u

/* ---- files ------------------------------------------------------------------------------- */

static const char **all_paths(const SetupOptions *options, int *count, Arena *arena) {
    const ReviewRequest *request = options->request;
    const ReviewCondition *c = options->condition;
    const ReviewWith *with = c && c->with_id != NO_ID ? &request->withs[c->with_id] : NULL;
    int lights = c ? c->light_count : 0, more = with ? with->path_count : 0;
    const char **paths = ARENA_NEW(arena, const char *, request->scene_count + lights + more);
    *count = 0;
    for (int i = 0; i < request->scene_count; i++) paths[(*count)++] = request->scenes[i];
    for (int i = 0; i < lights; i++) paths[(*count)++] = c->lights[i];
    for (int i = 0; i < more; i++) paths[(*count)++] = with->paths[i];
    return paths;
}

/* Contents to be shown; the first that is added for a display counts. */
typedef struct ContentList {
    SceneOverride *list;
    int count;
} ContentList;

static void add_content(ContentList *to, const char *display, const char *path, const char *said) {
    for (int i = 0; i < to->count; i++)
        if (!strcmp(to->list[i].material, display)) return;
    to->list[to->count++] = (SceneOverride){display, path, said};
}

/* A variant's contents count first, then the condition's, then the symbols'. */
static SceneOverride *all_contents(const SetupOptions *options, int *count, Arena *arena) {
    const ReviewRequest *request = options->request;
    const ReviewCondition *c = options->condition;
    const ReviewChange *change = request->change;
    int changed = change ? change->content_count : 0, own = c ? c->content_count : 0;
    ContentList contents = {ARENA_NEW(arena, SceneOverride, request->symbol_count + own + changed),
                            0};
    for (int k = 0; k < changed; k++)
        add_content(&contents, change->contents[k].display, change->contents[k].path,
                    arena_format(arena, "%s: %s/contents/%s", request->file, change->place,
                                 change->contents[k].display));
    for (int k = 0; k < own; k++)
        add_content(&contents, c->contents[k].display, c->contents[k].path,
                    arena_format(arena, "%s: /conditions/%d/contents/%s", request->file,
                                 (int)(c - request->conditions), c->contents[k].display));
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        bool is_node = !strncmp(symbol->display, "node:", 5); /* its material shows it */
        if (symbol->content && !is_node)
            add_content(&contents, symbol->display, symbol->content,
                        arena_format(arena, "%s: /symbols/%s", request->file, symbol->name));
    }
    *count = contents.count;
    return contents.list;
}

/* Of the files that the request names: contents and pictures of skies among them. */
static void identify(Setup *setup, const SceneOptions *options, Arena *arena) {
    const ReviewRequest *request = setup->request;
    Text own = {.arena = arena}, files = {.arena = arena};
    identity_add_program(&own, setup->tools.kernel);
    identity_add_scene(&own, options, setup->scene);
    for (int i = 0; i < request->input_count; i++)
        if (strcmp(request->inputs[i].path, request->file) != 0)
            identity_line(&files, "request", "%016llx",
                          (unsigned long long)request->inputs[i].hash);
    setup->identity = own.data;
    setup->files = files.data ? files.data : "";
}

static SceneOptions scene_options(const SetupOptions *options, Arena *arena) {
    SceneOptions scene = {.root = options->means.root, .state = options->means.state};
    scene.paths = all_paths(options, &scene.path_count, arena);
    scene.contents = all_contents(options, &scene.content_count, arena);
    const ReviewChange *change = options->request->change;
    if (!change) return scene;
    scene.changes = change->scene;
    scene.change_count = change->scene_count;
    scene.panels = change->panels;
    scene.panel_count = change->panel_count;
    return scene;
}

/* A synthetic billow is nothing to judge by. */
static bool load_even(const SceneOptions *options, Arena *arena, Problems *problems, Scene **out,
                      Error *err) {
    if (!scene_load(options, arena, problems, out, err)) return false;
    (*out)->environment.daylight.cloud_relief_m = 0;
    return true;
}

bool setup_scene(const SetupOptions *options, Arena *arena, Problems *problems, Scene **out,
                 Error *err) {
    SceneOptions scene = scene_options(options, arena);
    return load_even(&scene, arena, problems, out, err);
}

static bool load(const SetupOptions *options, Arena *arena, Problems *problems, Setup *out,
                 Error *err) {
    SceneOptions scene = scene_options(options, arena);
    *out = (Setup){.request = options->request,
                   .moment_guide = options->means.moment_guide,
                   .condition = options->condition,
                   .tools = {.threads = options->means.threads},
                   .sensor_lux = (double)NAN};
    if (!kernel_choose(options->means.isa, &out->tools.kernel, err)) return false;
    if (!load_even(&scene, arena, problems, &out->scene, err)) return false;
    if (!bvh_create(out->scene, options->means.threads, options->means.isa, &out->bvh, err)) {
        scene_close(out->scene);
        return false;
    }
    out->scene_levels = ARENA_NEW(arena, double, out->scene->display_count);
    for (int i = 0; i < out->scene->display_count; i++)
        out->scene_levels[i] = (double)out->scene->displays[i].level;
    identify(out, &scene, arena);
    out->context = path_context_unlit(out->scene, out->bvh, SETUP_BOUNCES, arena);
    return true;
}

static void unload(const Setup *setup) {
    bvh_destroy(setup->bvh);
    scene_close(setup->scene);
}

static void set_scene_levels(Setup *setup) {
    for (int i = 0; i < setup->scene->display_count; i++)
        setup->scene->displays[i].level = (float)setup->scene_levels[i];
}

/* ---- scenes that stay -------------------------------------------------------------------- */

#define SCENE_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* How a scene is lit: for who lights it so again, or alike but for its levels. */
typedef struct KeptLight {
    Arena of_sky, of_levels; /* what is made of it; the second begins behind the first's */
    const char *sky;         /* all that decides it; NULL: nothing is lit */
    PathContext by_sky;      /* with levels of any kind */
    const ReviewChange *change;
    const ReviewLevel *level;
    float *levels; /* of the displays, which follow from these, */
    double sensor_lux;
    PathContext context; /* with them */
} KeptLight;

struct KeptScene {
    Setup setup; /* as it was loaded, with that environment: */
    Environment environment;
    const char *key;
    int condition_id; /* that used it last */
    bool is_open;
    Arena arena; /* of all of it, and of this, but: */
    KeptLight lit;
    KeptScene *next;
};

/* All by which a request's scenes differ. A change of levels alone is none. */
static const char *key_of(const SetupOptions *options, Arena *arena) {
    const ReviewChange *change = options->request->change;
    SceneOptions scene = scene_options(options, arena);
    Text key = {.arena = arena};
    for (int i = 0; i < scene.path_count; i++) identity_line(&key, "scene", "%s", scene.paths[i]);
    for (int i = 0; i < scene.content_count; i++)
        identity_line(&key, scene.contents[i].material, "%s", scene.contents[i].value);
    if (scene.change_count || scene.panel_count) identity_line(&key, "as", "%s", change->place);
    return key.data;
}

static void lend(KeptScene *kept, const SetupOptions *options, Setup *out) {
    *out = kept->setup;
    out->request = options->request;
    out->condition = options->condition;
    out->moment_guide = options->means.moment_guide;
    out->kept = kept;
    out->scene->environment = kept->environment;
    set_scene_levels(out);
    kept->condition_id =
        options->condition ? (int)(options->condition - options->request->conditions) : NO_ID;
    kept->is_open = true;
}

static bool keep(const SetupOptions *options, Problems *problems, KeptScene **out, Error *err) {
    Arena arena = arena_reserve(SCENE_BYTES);
    KeptScene *kept = ARENA_NEW(&arena, KeptScene, 1);
    if (!load(options, &arena, problems, &kept->setup, err)) {
        arena_release(&arena);
        return false;
    }
    kept->environment = kept->setup.scene->environment;
    kept->key = key_of(options, &arena);
    kept->arena = arena;
    kept->lit.of_sky = arena_reserve(SCENE_BYTES);
    kept->next = options->means.scenes->first;
    options->means.scenes->first = *out = kept;
    return true;
}

bool setup_open(const SetupOptions *options, Arena *arena, Problems *problems, Setup *out,
                Error *err) {
    if (!options->means.scenes) return load(options, arena, problems, out, err);
    Arena scratch = *arena;
    const char *key = key_of(options, &scratch);
    KeptScene *kept = options->means.scenes->first;
    while (kept && (kept->is_open || strcmp(kept->key, key) != 0)) kept = kept->next;
    if (!kept && !keep(options, problems, &kept, err)) return false;
    lend(kept, options, out);
    return true;
}

void setup_close(Setup *setup) {
    if (setup->kept) setup->kept->is_open = false;
    else unload(setup);
}

void scenes_kept_close(ScenesKept *scenes, int condition_id) {
    for (KeptScene **at = &scenes->first; *at;) {
        KeptScene *kept = *at;
        if (condition_id != NO_ID && kept->condition_id != condition_id) {
            at = &kept->next;
            continue;
        }
        Arena arena = kept->arena;
        *at = kept->next;
        arena_release(&kept->lit.of_sky);
        unload(&kept->setup);
        arena_release(&arena);
    }
}

/* ---- light ------------------------------------------------------------------------------- */

/* by_sky: a context of the scene under the same sky, or NULL. Lamps are known once for a kept
 * scene. */
static bool set_light(Setup *setup, const PathContext *by_sky, Arena *arena, Error *err) {
    Lights *lights;
    KeptScene *kept = setup->kept;
    if (!lights_build(setup->scene, arena, &lights, err)) return false;
    if (kept && !setup->context.knows_lamps) {
        path_context_know_lamps(&kept->setup.context, lights, &kept->arena);
        memcpy(setup->context.beams, kept->setup.context.beams, sizeof setup->context.beams);
        setup->context.knows_lamps = true;
    }
    setup->context = by_sky ? path_context_relevel(by_sky, lights, arena)
                            : path_context_relight(&setup->context, lights, arena);
    return true;
}

bool setup_relight(Setup *setup, Arena *arena, Error *err) {
    return set_light(setup, NULL, arena, err);
}

Reading setup_meter(const Setup *setup, LitPoint head, uint32_t seed, const ReadingGoal *goal,
                    Arena scratch) {
    PathContext here = path_context_of_meter(&setup->context, head);
    ProbeAim aim = {.context = &here, .meter = &head, .seed = review_seed(setup->request, seed)};
    return reading_take(&aim, goal, &setup->tools, scratch);
}

double setup_level_of(const Setup *setup, const ReviewLevel *level, int display_id,
                      const char *name, double sensor_lux) {
    double scene = setup->scene_levels[display_id];
    ReviewDisplayName display = {name, setup->scene->displays[display_id].name};
    double own = level ? review_level_at(level, display, scene, sensor_lux) : scene;
    return own * review_brightness(setup->request, display);
}

/* Returns whether any is another now. */
static bool set_levels(Setup *setup, const ReviewLevel *level) {
    bool any = false;
    for (int i = 0; i < setup->scene->display_count; i++) {
        Display *display = &setup->scene->displays[i];
        float before = display->level;
        display->level = (float)setup_level_of(setup, level, i, display->name, setup->sensor_lux);
        any = any || display->level != before;
    }
    return any;
}

static const ReviewLevel *level_of(const Setup *setup) {
    const ReviewCondition *condition = setup->condition;
    bool has_level = condition && condition->level_id != NO_ID;
    return has_level ? &setup->request->levels[condition->level_id] : NULL;
}

/* Fixed levels are known before the light is; those of a curve only from its sensor. */
static void set_fixed_levels(Setup *setup) {
    const ReviewLevel *level = level_of(setup);
    bool is_curve = level && level->is_curve;
    if (!is_curve && (level || setup->request->change)) set_levels(setup, level);
}

/* Levels of a curve: by what its sensor reads. */
static void follow_sensor(Setup *setup, Arena *arena) {
    const ReviewLevel *level = level_of(setup);
    if (!level || !level->is_curve) return;
    LitPoint sensor = {scene_from_world(setup->scene->origin, level->position_m),
                       vec3_from_doubles(level->normal), false};
    ReadingGoal goal = {.precision = SENSOR_PRECISION, .most = SENSOR_PATHS};
    setup->sensor_lux = setup_meter(setup, sensor, SENSOR_SEED, &goal, *arena).reflected;
    if (!set_levels(setup, level)) return;
    const Lights *lights = lights_with_levels(setup->context.lights, arena);
    setup->context = path_context_relevel(&setup->context, lights, arena);
}

static void keep_light(const Setup *setup, KeptLight *lit, Arena *arena) {
    const Scene *scene = setup->scene;
    lit->change = setup->request->change;
    lit->level = level_of(setup);
    lit->sensor_lux = setup->sensor_lux;
    lit->context = setup->context;
    lit->levels = ARENA_NEW(arena, float, scene->display_count);
    for (int i = 0; i < scene->display_count; i++) lit->levels[i] = scene->displays[i].level;
}

static void take_light(Setup *setup, const KeptLight *lit) {
    setup->sensor_lux = lit->sensor_lux;
    setup->context = lit->context;
    for (int i = 0; i < setup->scene->display_count; i++)
        setup->scene->displays[i].level = lit->levels[i];
}

/* What the rays of the sun do takes longest, and hangs on no level. */
static bool light_kept(Setup *setup, KeptScene *kept, Error *err) {
    KeptLight *lit = &kept->lit;
    Arena scratch = kept->arena;
    Text sky = {.arena = &scratch};
    identity_add_environment(&sky, setup->scene);
    bool is_same_sky = lit->sky && !strcmp(lit->sky, sky.data);
    if (is_same_sky && lit->change == setup->request->change && lit->level == level_of(setup)) {
        take_light(setup, lit);
        return true;
    }
    if (!is_same_sky) lit->of_levels = lit->of_sky;
    const char *of =
        is_same_sky ? lit->sky : arena_string(&lit->of_levels, sky.data, strlen(sky.data));
    Arena room = lit->of_levels;
    lit->sky = NULL; /* what lay in the room is gone */
    if (!set_light(setup, is_same_sky ? &lit->by_sky : NULL, &room, err)) return false;
    if (!is_same_sky) {
        lit->by_sky = setup->context;
        lit->of_levels = room;
    }
    follow_sensor(setup, &room);
    keep_light(setup, lit, &room);
    lit->sky = of;
    return true;
}

bool setup_light(Setup *setup, const Environment *environment, Arena *arena, Error *err) {
    const ReviewCondition *own = setup->condition;
    if (!environment && own && own->has_environment) environment = &own->environment;
    if (environment) setup->scene->environment = *environment;
    set_scene_levels(setup);
    set_fixed_levels(setup);
    if (setup->kept) return light_kept(setup, setup->kept, err);
    if (!set_light(setup, NULL, arena, err)) return false;
    follow_sensor(setup, arena);
    return true;
}

/* ---- the sun ----------------------------------------------------------------------------- */

#define SUN_DRAWS 16

bool setup_sun_xyz(const Setup *setup, const Curve *colour, Vec3 *towards,
                   float bands[3][LIGHT_BANDS]) {
    const Lights *lights = setup->context.lights;
    memset(bands, 0, 3 * sizeof *bands);
    if (!lights_has(lights, LIGHTS_SUN) || lights_sun_is_moon(lights)) return false;
    for (int i = 0; i < SUN_DRAWS; i++) {
        const float u[3] = {((float)i + 0.5f) / SUN_DRAWS, (float)(i * 7 % SUN_DRAWS) / SUN_DRAWS,
                            0.5f};
        Wavelengths w;
        LightSample sample;
        wavelengths_sample(((float)(i * 5 % SUN_DRAWS) + 0.5f) / SUN_DRAWS, &w);
        if (!lights_sample(lights, LIGHTS_SUN, (LitPoint){{0, 0, 0}, {0, 1, 0}, true}, u, &sample))
            return false;
        Spectrum light = lights_radiance(lights, &sample, &w);
        for (int c = 0; c < 3; c++) {
            Spectrum lux = light * w.xyz[c] * spectrum_all(1 / (sample.pdf * SUN_DRAWS));
            if (colour) lux *= curve_lookup(colour, &w);
            for (int k = 0; k < LIGHT_BANDS; k++) bands[c][k] += lux[k];
        }
    }
    *towards = lights_sun_direction(lights);
    return true;
}

bool setup_sun(const Setup *setup, Vec3 *towards, float bands[LIGHT_BANDS]) {
    float xyz[3][LIGHT_BANDS];
    bool is_up = setup_sun_xyz(setup, NULL, towards, xyz);
    if (bands) memcpy(bands, xyz[1], sizeof xyz[1]);
    return is_up;
}

/* Forward on the horizontal, and to its right. */
static void axes(const Setup *setup, Vec3 *ahead, Vec3 *right) {
    Vec3 forward = vec3_from_doubles(setup->request->forward);
    *ahead = vec3_normalize(vec3(forward.x, 0, forward.z));
    *right = vec3(-ahead->z, 0, ahead->x);
}

static double heading_deg(const Setup *setup) {
    return degrees_from_radians((double)setup->scene->environment.heading);
}

SunAngles setup_angles(const Setup *setup, Vec3 d) {
    Vec3 ahead, right;
    axes(setup, &ahead, &right);
    double azimuth = atan2((double)vec3_dot(d, right), (double)vec3_dot(d, ahead));
    double degrees = fmod(degrees_from_radians(azimuth) + heading_deg(setup) + 720, 360);
    return (SunAngles){degrees, degrees_from_radians(asin(fmin(fmax((double)d.y, -1), 1)))};
}

Vec3 setup_direction(const Setup *setup, SunAngles angles) {
    Vec3 ahead, right;
    axes(setup, &ahead, &right);
    double azimuth = radians_from_degrees(angles.azimuth_deg - heading_deg(setup));
    double elevation = radians_from_degrees(angles.elevation_deg), level = cos(elevation);
    Vec3 along = vec3_add(vec3_scale(ahead, (float)(level * cos(azimuth))),
                          vec3_scale(right, (float)(level * sin(azimuth))));
    return vec3_normalize(vec3(along.x, (float)sin(elevation), along.z));
}

/* ---- eyes -------------------------------------------------------------------------------- */

bool setup_eye_middle(const Setup *setup, const ReviewEye *eye, Arena scratch, Vec3 *out,
                      Error *err) {
    int id;
    double middle[3], moved[3];
    for (int i = 0; i < 3; i++) {
        moved[i] = eye->move_m[i];
        middle[i] = eye->position_m[i] + moved[i];
    }
    review_mirror_point(eye->mirror, middle);
    review_mirror_direction(eye->mirror, moved);
    *out = scene_from_world(setup->scene->origin, middle);
    if (eye->kind != EYE_CAMERA) return true;
    if (!review_camera_find(setup->scene, eye, scratch, &id, err))
        return error_in_file(err, setup->request->file);
    *out = vec3_add(setup->scene->cameras[id].world_from_camera.origin, vec3_from_doubles(moved));
    return true;
}

Vec3 *setup_eye_points(const Setup *setup, const ReviewEye *eye, int *count, Arena *arena,
                       Error *err) {
    *count = review_eye_count(eye);
    Vec3 *points = ARENA_NEW(arena, Vec3, *count);
    if (!review_eye_is_wide(eye))
        return setup_eye_middle(setup, eye, *arena, points, err) ? points : NULL;
    for (int i = 0; i < *count; i++) {
        double p[3];
        review_eye_point(eye, i, p);
        points[i] = scene_from_world(setup->scene->origin, p);
    }
    return points;
}

/* ---- the guide --------------------------------------------------------------------------- */

/* The picture from which guides are trained: one about the symbols. */
#define TRAINING_WIDTH 480
#define TRAINING_HEIGHT 270
#define TRAINING_DEG 60.0

static bool has_same_files(const ReviewRequest *a, const ReviewRequest *b) {
    if (a->scene_count != b->scene_count) return false;
    for (int i = 0; i < a->scene_count; i++)
        if (strcmp(a->scenes[i], b->scenes[i]) != 0) return false;
    return true;
}

static bool is_taken_over(const Setup *setup, const GuideScene *scene) {
    const MomentGuide *moment = setup->moment_guide;
    const ReviewChange *change = setup->request->change;
    return moment && moment->request && moment->guide && change && !change->mirror &&
           has_same_files(moment->request, setup->request) &&
           moment->scene.light_count == scene->light_count &&
           moment->scene.lamp_count == scene->lamp_count &&
           memcmp(moment->scene.has, scene->has, sizeof scene->has) == 0;
}

void trained_guide_take(Setup *setup, Vec3 eye, Vec3 towards, Arena *arena) {
    GuideScene scene = train_guide_scene(&setup->context);
    if (is_taken_over(setup, &scene)) {
        setup->context.guide = setup->moment_guide->guide;
        return;
    }
    bool is_left = setup->moment_guide && !setup->request->change;
    SceneCamera look =
        camera_look_at(eye, vec3_add(eye, towards), (float)radians_from_degrees(TRAINING_DEG));
    Camera camera = camera_from_scene(&look, TRAINING_WIDTH, TRAINING_HEIGHT);
    TrainOptions options = {setup->tools.kernel, setup->tools.threads, true, 0};
    PathStatistics cost;
    setup->context.guide = train_guide(&setup->context, &camera, &options,
                                       is_left ? &setup->moment_guide->room : arena, &cost);
    if (!is_left) return;
    setup->moment_guide->request = setup->request;
    setup->moment_guide->guide = setup->context.guide;
    setup->moment_guide->scene = scene;
}
