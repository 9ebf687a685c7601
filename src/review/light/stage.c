/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/stage.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "render/identity.h"
#include "review/light/question.h"
#include "scene/load/scene_load.h"

#define SENSOR_PRECISION 0.01
#define SENSOR_PATHS 65536
#define SENSOR_SEED 0x73656e73u

/* ---- files ------------------------------------------------------------------------------- */

static const char **all_paths(const StageOptions *options, int *count, Arena *arena)
{
    const ReviewRequest   *request = options->request;
    const ReviewCondition *c = options->condition;
    const ReviewWith      *with = c && c->with_id != NO_ID ? &request->withs[c->with_id] : NULL;
    int lights = c ? c->light_count : 0, more = with ? with->path_count : 0;
    const char **paths = ARENA_NEW(arena, const char *, request->scene_count + lights + more);
    *count = 0;
    for (int i = 0; i < request->scene_count; i++) paths[(*count)++] = request->scenes[i];
    for (int i = 0; i < lights; i++) paths[(*count)++] = c->lights[i];
    for (int i = 0; i < more; i++) paths[(*count)++] = with->paths[i];
    return paths;
}

/* "node:NAME" names a display's surface; what it shows belongs to its material. */
static bool is_material(const char *display)
{
    return strncmp(display, "node:", 5) != 0;
}

/* Contents that are to be shown, the first that is said of a display first of all. */
typedef struct ContentList {
    SceneOverride *list;
    int            count;
} ContentList;

static void add_content(ContentList *to, const char *display, const char *path,
                        const char *said)
{
    for (int i = 0; i < to->count; i++)
        if (!strcmp(to->list[i].material, display)) return;
    to->list[to->count++] = (SceneOverride){display, path, said};
}

/* A variant's word holds, then the condition's, then the symbols'. */
static SceneOverride *all_contents(const StageOptions *options, int *count, Arena *arena)
{
    const ReviewRequest   *request = options->request;
    const ReviewCondition *c = options->condition;
    const ReviewChange    *change = request->change;
    int changed = change ? change->content_count : 0, own = c ? c->content_count : 0;
    ContentList contents = {
        ARENA_NEW(arena, SceneOverride, request->symbol_count + own + changed), 0};
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
        if (symbol->content && is_material(symbol->display))
            add_content(&contents, symbol->display, symbol->content,
                        arena_format(arena, "%s: /symbols/%s", request->file, symbol->name));
    }
    *count = contents.count;
    return contents.list;
}

static void set_change(const ReviewChange *change, SceneOptions *scene)
{
    if (!change) return;
    scene->changes = change->scene;
    scene->change_count = change->scene_count;
    scene->panels = change->panels;
    scene->panel_count = change->panel_count;
}

static void add_inputs(const ReviewRequest *request, bool with_request, Text *text)
{
    for (int i = 0; i < request->input_count; i++)
        if (with_request || strcmp(request->inputs[i].path, request->file) != 0)
            identity_line(text, "request", "%016llx",
                          (unsigned long long)request->inputs[i].hash);
}

/* Of the stage's scene; for keys of all files; for plans the request itself, too: what is asked
 * stands in the keys, so that who changes a word of it is not asked for all anew. */
static void identify(Stage *stage, const SceneOptions *options, Arena *arena)
{
    Text own = {.arena = arena}, files = {.arena = arena}, all = {.arena = arena};
    identity_add_program(&own, stage->tools.kernel);
    identity_add_scene(&own, options, stage->scene);
    text_add(&files, own.data);
    add_inputs(stage->request, false, &files);
    text_add(&all, own.data);
    add_inputs(stage->request, true, &all);
    stage->identity = own.data;
    stage->tools.base = journal_key(files.data);
    stage->planned = journal_key(all.data);
}

static SceneOptions scene_options(const StageOptions *options, Arena *arena)
{
    SceneOptions scene = {.root = options->root, .state = options->state};
    scene.paths = all_paths(options, &scene.path_count, arena);
    scene.contents = all_contents(options, &scene.content_count, arena);
    set_change(options->request->change, &scene);
    return scene;
}

bool stage_scene(const StageOptions *options, Arena *arena, Problems *problems, Scene **out,
                 Error *err)
{
    SceneOptions scene = scene_options(options, arena);
    return scene_load(&scene, arena, problems, out, err);
}

bool stage_open(const StageOptions *options, Arena *arena, Problems *problems, Stage *out,
                Error *err)
{
    SceneOptions scene = scene_options(options, arena);
    *out = (Stage){.request = options->request, .condition = options->condition,
                   .tools = {.threads = options->threads, .journal = options->journal},
                   .sensor_lux = (double)NAN, .lessons = options->lessons,
                   .inherited = options->inherited};
    if (!kernel_choose(options->isa, &out->tools.kernel, err)) return false;
    if (!scene_load(&scene, arena, problems, &out->scene, err)) return false;
    if (!bvh_create(out->scene, options->threads, options->isa, &out->bvh, err)) {
        scene_close(out->scene);
        return false;
    }
    out->scene_levels = ARENA_NEW(arena, double, out->scene->display_count);
    for (int i = 0; i < out->scene->display_count; i++)
        out->scene_levels[i] = (double)out->scene->displays[i].level;
    identify(out, &scene, arena);
    return true;
}

void stage_close(Stage *stage)
{
    bvh_destroy(stage->bvh);
    scene_close(stage->scene);
}

/* ---- light ------------------------------------------------------------------------------- */

bool stage_relight(Stage *stage, Arena *arena, Error *err)
{
    Lights       *lights;
    const Lights *before = stage->context.tables ? stage->context.lights : NULL;
    if (!(before ? lights_under_sky(before, arena, &lights, err)
                 : lights_build(stage->scene, arena, &lights, err)))
        return false;
    stage->context =
        stage->context.tables
            ? path_context_relight(&stage->context, lights, arena)
            : path_context_build(stage->scene, stage->bvh, lights, STAGE_BOUNCES, arena);
    return true;
}

static Vec3 vec3_of(const double v[3])
{
    return vec3((float)v[0], (float)v[1], (float)v[2]);
}

static void read_sensor(Stage *stage, const ReviewLevel *level, Arena scratch)
{
    LitPoint    head = {vec3_of(level->position_m), vec3_of(level->normal), false};
    ProbeAim    aim = {.context = &stage->context, .meter = &head,
                       .seed = review_seed(stage->request, SENSOR_SEED)};
    ReadingGoal goal = {.precision = SENSOR_PRECISION, .most = SENSOR_PATHS};
    stage->sensor_lux = reading_take(&aim, &goal, &stage->tools, scratch).reflected;
}

double stage_level_of(const Stage *stage, const ReviewLevel *level, int display_id,
                      const char *name, double sensor_lux)
{
    double            scene = stage->scene_levels[display_id];
    ReviewDisplayName display = {name, stage->scene->displays[display_id].name};
    double            own = level ? review_level_at(level, display, scene, sensor_lux) : scene;
    return own * review_brightness(stage->request, display);
}

/* Returns whether any is another now. */
static bool set_levels(Stage *stage, const ReviewLevel *level)
{
    bool any = false;
    for (int i = 0; i < stage->scene->display_count; i++) {
        Display *display = &stage->scene->displays[i];
        float    before = display->level;
        display->level =
            (float)stage_level_of(stage, level, i, display->name, stage->sensor_lux);
        any = any || display->level != before;
    }
    return any;
}

/* Under the same sky. */
static void light_again(Stage *stage, Arena *arena)
{
    const Lights *lights = lights_with_levels(stage->context.lights, arena);
    stage->context = path_context_relight(&stage->context, lights, arena);
}

static const ReviewLevel *level_of(const Stage *stage)
{
    const ReviewCondition *condition = stage->condition;
    bool has_level = condition && condition->level_id != NO_ID;
    return has_level ? &stage->request->levels[condition->level_id] : NULL;
}

/* Fixed levels are known before the light is; those of a curve only from its sensor. */
static void set_fixed_levels(Stage *stage)
{
    const ReviewLevel *level = level_of(stage);
    bool is_curve = level && level->is_curve;
    if (!is_curve && (level || stage->request->change)) set_levels(stage, level);
}

bool stage_light(Stage *stage, const Environment *environment, Arena *arena, Error *err)
{
    const ReviewLevel *level = level_of(stage);
    if (environment) stage->scene->environment = *environment;
    set_fixed_levels(stage);
    if (!stage_relight(stage, arena, err)) return false;
    if (!level || !level->is_curve) return true;
    read_sensor(stage, level, *arena);
    if (set_levels(stage, level)) light_again(stage, arena);
    return true;
}

static void set_scene_levels(Stage *stage)
{
    for (int i = 0; i < stage->scene->display_count; i++)
        stage->scene->displays[i].level = (float)stage->scene_levels[i];
}

bool stage_before_light(Stage *stage, Arena *arena, Error *err)
{
    set_scene_levels(stage);
    set_fixed_levels(stage);
    return stage_relight(stage, arena, err);
}

bool stage_light_again(Stage *stage, const Stage *before, const Environment *environment,
                       Arena *arena, Error *err)
{
    *stage = *before;
    set_scene_levels(stage);
    return stage_light(stage, environment, arena, err);
}

/* ---- other levels under the same light --------------------------------------------------- */

/* NULL: from what is dark there is no way to what shines. */
static const double *scale_of(const Scene *scene, const float *levels, Arena *arena)
{
    double *scale = ARENA_NEW(arena, double, scene->display_count);
    for (int i = 0; i < scene->display_count; i++) {
        float stands = scene->displays[i].level;
        if (!(stands > 0) && levels[i] > 0) return NULL;
        scale[i] = stands > 0 ? (double)levels[i] / (double)stands : 1;
    }
    return scale;
}

Stage stage_beside(const Stage *of, const ReviewRequest *request, Arena *arena, Arena room,
                   StageOther *other)
{
    const Scene *scene = of->scene;
    int    level_id = of->condition->level_id;
    float *levels = ARENA_NEW(arena, float, scene->display_count);
    Stage  out = *of;
    out.request = request;
    out.is_shared = false;
    for (int i = 0; i < scene->display_count; i++)
        levels[i] = (float)stage_level_of(&out,
                                          level_id != NO_ID ? &request->levels[level_id] : NULL,
                                          i, scene->displays[i].name, of->sensor_lux);
    *other = (StageOther){.levels = levels, .scale = scale_of(scene, levels, arena),
                          .room = room};
    out.other = other;
    return out;
}

static void swap_levels(const Stage *stage)
{
    float *levels = stage->other->levels;
    for (int i = 0; i < stage->scene->display_count; i++) {
        float before = stage->scene->displays[i].level;
        stage->scene->displays[i].level = levels[i];
        levels[i] = before;
    }
}

Stage stage_lit(const Stage *stage)
{
    StageOther *other = stage->other;
    Stage       out = *stage;
    if (!other) return out;
    swap_levels(stage);
    if (!other->is_lit) {
        const Lights *lights = lights_with_levels(stage->context.lights, &other->room);
        other->context = path_context_relight(&stage->context, lights, &other->room);
        other->context.guide = stage->context.guide;
        other->is_lit = true;
    }
    out.context = other->context;
    out.other = NULL;
    return out;
}

void stage_unlight(const Stage *stage)
{
    if (stage->other) swap_levels(stage);
}

Reading stage_ask(const Stage *stage, const ProbeAim *aim, const ReadingGoal *asked,
                  Arena scratch)
{
    const StageOther *other = stage->other;
    ReadingGoal       goal = *asked;
    ProbeAim          own = *aim;
    Reading           reading;
    goal.is_shared = stage->is_shared;
    if (!other) return reading_take(aim, &goal, &stage->tools, scratch);
    if (other->scale &&
        reading_scaled(aim, &goal, other->scale, &stage->tools, scratch, &reading))
        return reading;
    Stage lit = stage_lit(stage);
    lit.context.without_mirrored_sun = aim->context->without_mirrored_sun;
    own.context = &lit.context;
    reading = reading_take(&own, &goal, &stage->tools, scratch);
    stage_unlight(stage);
    return reading;
}

/* ---- the sun ----------------------------------------------------------------------------- */

#define SUN_DRAWS 16

bool stage_sun(const Stage *stage, Vec3 *towards, float bands[LIGHT_BANDS])
{
    const Lights *lights = stage->context.lights;
    Vec3 sum = vec3(0, 0, 0);
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    if (!lights_has(lights, LIGHTS_SUN) || lights_sun_is_moon(lights)) return false;
    for (int i = 0; i < SUN_DRAWS; i++) {
        const float u[3] = {((float)i + 0.5f) / SUN_DRAWS,
                            (float)(i * 7 % SUN_DRAWS) / SUN_DRAWS, 0.5f};
        Wavelengths w;
        LightSample sample;
        wavelengths_sample(((float)(i * 5 % SUN_DRAWS) + 0.5f) / SUN_DRAWS, &w);
        if (!lights_sample(lights, LIGHTS_SUN, (LitPoint){{0, 0, 0}, {0, 1, 0}, true}, u,
                           &sample))
            return false;
        sum = vec3_add(sum, sample.wi);
        Spectrum lux = lights_radiance(lights, &sample, &w) * w.xyz[1] *
                       spectrum_all(1 / (sample.pdf * SUN_DRAWS));
        for (int k = 0; k < LIGHT_BANDS; k++) bands[k] += lux[k];
    }
    *towards = vec3_normalize(sum);
    return true;
}

/* Forward on the horizontal, and to its right. */
static void axes(const Stage *stage, Vec3 *ahead, Vec3 *right)
{
    Vec3 forward = vec3_of(stage->request->forward);
    *ahead = vec3_normalize(vec3(forward.x, 0, forward.z));
    *right = vec3(-ahead->z, 0, ahead->x);
}

static double heading_deg(const Stage *stage)
{
    return degrees_from_radians((double)stage->scene->environment.heading);
}

SunAngles stage_angles(const Stage *stage, Vec3 d)
{
    Vec3 ahead, right;
    axes(stage, &ahead, &right);
    double azimuth = atan2((double)vec3_dot(d, right), (double)vec3_dot(d, ahead));
    double degrees = fmod(degrees_from_radians(azimuth) + heading_deg(stage) + 720, 360);
    return (SunAngles){degrees, degrees_from_radians(asin(fmin(fmax((double)d.y, -1), 1)))};
}

Vec3 stage_direction(const Stage *stage, SunAngles angles)
{
    Vec3 ahead, right;
    axes(stage, &ahead, &right);
    double azimuth = radians_from_degrees(angles.azimuth_deg - heading_deg(stage));
    double elevation = radians_from_degrees(angles.elevation_deg), level = cos(elevation);
    Vec3 along = vec3_add(vec3_scale(ahead, (float)(level * cos(azimuth))),
                          vec3_scale(right, (float)(level * sin(azimuth))));
    return vec3_normalize(vec3(along.x, (float)sin(elevation), along.z));
}

double stage_level(const Stage *stage, int display_id)
{
    return (double)(stage->other ? stage->other->levels[display_id]
                                 : stage->scene->displays[display_id].level);
}
