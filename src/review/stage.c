#include "review/stage.h"

#include <math.h>
#include <string.h>

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

/* Symbols' contents first: what a condition says wins. */
static SceneOverride *all_contents(const StageOptions *options, int *count, Arena *arena)
{
    const ReviewRequest   *request = options->request;
    const ReviewCondition *c = options->condition;
    int            own = c ? c->content_count : 0;
    SceneOverride *contents = ARENA_NEW(arena, SceneOverride, request->symbol_count + own);
    *count = 0;
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        bool is_said = false;
        for (int k = 0; k < own; k++) is_said |= !strcmp(c->contents[k].display, symbol->display);
        for (int k = 0; k < *count; k++) is_said |= !strcmp(contents[k].material, symbol->display);
        if (symbol->content && is_material(symbol->display) && !is_said)
            contents[(*count)++] = (SceneOverride){symbol->display, symbol->content};
    }
    for (int k = 0; k < own; k++)
        contents[(*count)++] = (SceneOverride){c->contents[k].display, c->contents[k].path};
    return contents;
}

bool stage_open(const StageOptions *options, Arena *arena, Problems *problems, Stage *out,
                Error *err)
{
    SceneOptions scene = {.root = options->root};
    *out = (Stage){.request = options->request, .condition = options->condition,
                   .tools.threads = options->threads, .sensor_lux = (double)NAN};
    scene.paths = all_paths(options, &scene.path_count, arena);
    scene.contents = all_contents(options, &scene.content_count, arena);
    if (!kernel_choose(options->isa, &out->tools.kernel, err)) return false;
    if (!scene_load(&scene, arena, problems, &out->scene, err)) return false;
    if (!bvh_create(out->scene, options->threads, options->isa, &out->bvh, err)) {
        scene_close(out->scene);
        return false;
    }
    out->scene_levels = ARENA_NEW(arena, double, out->scene->display_count);
    for (int i = 0; i < out->scene->display_count; i++)
        out->scene_levels[i] = (double)out->scene->displays[i].level;
    return true;
}

void stage_close(Stage *stage)
{
    bvh_destroy(stage->bvh);
    scene_close(stage->scene);
}

/* ---- light ------------------------------------------------------------------------------- */

static bool make_context(Stage *stage, Arena *arena, Error *err)
{
    Lights *lights;
    if (!lights_build(stage->scene, arena, &lights, err)) return false;
    stage->context =
        path_context_build(stage->scene, stage->bvh, lights, STAGE_BOUNCES, arena);
    return true;
}

static Vec3 vec3_of(const double v[3])
{
    return vec3((float)v[0], (float)v[1], (float)v[2]);
}

static void read_sensor(Stage *stage, const ReviewLevel *level, Arena scratch)
{
    LitPoint    head = {vec3_of(level->position_m), vec3_of(level->normal), false};
    ProbeAim    aim = {.context = &stage->context, .meter = &head, .seed = SENSOR_SEED};
    ReadingGoal goal = {.precision = SENSOR_PRECISION, .most = SENSOR_PATHS};
    Reading     reading = reading_take(&aim, &goal, &stage->tools, scratch);
    stage->sensor_lux = reading.reflected;
    stage->sensor_sigma = reading.sigma;
}

static void set_levels(Stage *stage, const ReviewLevel *level)
{
    for (int i = 0; i < stage->scene->display_count; i++) {
        Display *display = &stage->scene->displays[i];
        display->level = (float)review_level_at(level, display->name, stage->scene_levels[i],
                                                stage->sensor_lux);
    }
}

bool stage_light(Stage *stage, const Environment *environment, Arena *arena, Error *err)
{
    const ReviewCondition *condition = stage->condition;
    if (environment) stage->scene->environment = *environment;
    if (!make_context(stage, arena, err)) return false;
    if (!condition || condition->level_id == NO_ID) return true;
    const ReviewLevel *level = &stage->request->levels[condition->level_id];
    if (level->is_curve) read_sensor(stage, level, *arena);
    set_levels(stage, level);
    return make_context(stage, arena, err);
}

double stage_level(const Stage *stage, int display_id)
{
    return (double)stage->scene->displays[display_id].level;
}
