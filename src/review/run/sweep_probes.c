/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep_probes.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/identity.h"
#include "review/keep/frame_kept.h"
#include "review/light/reading.h"
#include "review/light/setup.h"
#include "review/review_decide.h"

#define OWN_PRECISION 0.02
#define OWN_PATHS 8192
#define OWN_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */

/* ---- files ------------------------------------------------------------------------------- */

static void add_meter(Text *text, const LitPoint *meter) {
    identity_vector(text, "meter", meter->position);
    identity_vector(text, "meter's normal", meter->ns);
    identity_line(text, "meter's sides", "%d", 1 + meter->both_sides);
}

static void add_eye(Text *text, const ProbeAim *aim) {
    identity_vector(text, "eye", aim->eye);
    identity_line(text, "looks at", "%d points, %016llx", aim->target_count,
                  (unsigned long long)reading_aim_hash(aim));
}

/* Everything that decides the response and what the probe reads of the scene's own light. */
static const char *identity_of(const Setup *setup, const ResponseArgs *args, Arena *arena) {
    const ProbeAim *aim = &args->probe->aim;
    Text text = {.arena = arena};
    text_add(&text, setup->identity);
    if (aim->meter) add_meter(&text, aim->meter);
    else add_eye(&text, aim);
    identity_line(&text, "seed", "%u", aim->seed);
    identity_line(&text, "level of triangles", "%d", RESPONSE_LEVEL);
    identity_line(&text, "paths", "%d", args->paths);
    identity_number(&text, "precision", args->precision);
    return text.data;
}

static void name_file(const ReviewRun *run, const Setup *setup, ResponseArgs *args, Arena *arena) {
    const char *identity = identity_of(setup, args, arena);
    uint64_t hash = XXH3_64bits(identity, strlen(identity));
    const char *name = arena_format(arena, "%s-%016llx.response",
                                    words_file_name(args->name, arena), (unsigned long long)hash);
    args->file = (ResponseFile){.path = arena_format(arena, "%s/%s", run->responses, name),
                                .identity = identity};
    args->shown = arena_format(arena, "%s/%s", run->responses_shown, name);
}

/* Reads those that are there. Sets file, shown and is_kept of all. */
static void responses_find(const ReviewRun *run, const Setup *setup, ResponseArgs *calls, int count,
                           Arena *arena) {
    for (int i = 0; i < count; i++) {
        Error err;
        if (!run->responses) continue;
        name_file(run, setup, &calls[i], arena);
        if (!file_exists(calls[i].file.path)) continue;
        calls[i].is_kept =
            response_read(&calls[i].file, arena, &calls[i].probe->response, calls[i].own, &err);
        if (calls[i].is_kept) continue;
        problems_add(run->problems, SEVERITY_WARNING, err.file, err.path, "%s — it is traced again",
                     err.text);
    }
}

/* ---- the scene's own light --------------------------------------------------------------- */

static bool gives_light(const Lights *lights) {
    return lights_has(lights, LIGHTS_EMITTERS) || lights_has(lights, LIGHTS_PUNCTUAL);
}

/* Anything but displays? */
static bool has_lamps(const Scene *scene) {
    bool has = scene->light_count > 0;
    for (int i = 0; i < scene->part_count && !has; i++) {
        const Material *material = &scene->materials[scene->parts[i].material_id];
        has = material->is_emitter && material->display_id == NO_ID;
    }
    return has;
}

static double own_reading(const Setup *setup, const ProbeAim *aim, Arena scratch) {
    ReadingGoal goal = {.precision = OWN_PRECISION, .most = OWN_PATHS};
    if (!gives_light(setup->context.lights)) return 0;
    return reading_take(aim, &goal, &setup->tools, scratch).reflected;
}

/* The own light of those that were not there: the scene is dark but for its lamps, or for its
 * lamps and displays at level 1, which is sampled after them. */
static bool responses_read_own(const Setup *setup, const ResponseArgs *calls, int count,
                               bool displays, Error *err) {
    Arena scratch = arena_reserve(OWN_BYTES);
    bool ok = true;
    for (int i = 0; i < count && ok; i++) {
        if (calls[i].is_kept) continue;
        ok = review_goes_on(err);
        if (!ok) break;
        double own = own_reading(setup, &calls[i].probe->aim, scratch);
        if (displays) calls[i].own->displays = own - calls[i].own->lamps;
        else calls[i].own->lamps = own;
    }
    arena_release(&scratch);
    return ok;
}

/* ---- tracing ----------------------------------------------------------------------------- */

/* Traces and keeps the rest. */
static bool responses_trace(const ReviewRun *run, const Setup *setup, ResponseArgs *calls,
                            int count, Arena *arena, Error *err) {
    DistantTools tools = {.setup = setup};
    for (int i = 0; i < count; i++) {
        ResponseArgs *args = &calls[i];
        if (args->is_kept) continue;
        if (!review_goes_on(err)) return false;
        tools.paths = args->paths;
        tools.precision = args->precision;
        distant_probe_respond(args->probe, &tools, arena);
        if (!response_write(&args->file, &args->probe->response, args->own, *arena, err))
            return false;
        progress_update(run->progress, run->progress->done + 1);
    }
    return true;
}

#define RESPONSE_PATHS 65536
/* of the contrast's precision: an even sky's reading is sure to so much of it, and then most
 * suns' about to all of it */
#define RESPONSE_SHARE 0.5
/* its worst is read by paths of its own; this is for how long it fails */
#define RESPONSE_SHARE_VARIANT 0.75
#define METER_PATHS 16384
#define SUN_PATHS SYMBOL_POINTS /* of the first vertex: a lobe is narrower than a symbol */
#define METER_SUN_PATHS 64
#define EYE_SEED 0x73776579u
#define METER_SEED 0x73776d65u

/* ---- a scene without a sky --------------------------------------------------------------- */

static void set_all_levels(Setup *setup, float level) {
    for (int i = 0; i < setup->scene->display_count; i++) setup->scene->displays[i].level = level;
}

bool sweep_light_dark(Setup *setup, float level, Arena *arena, Error *err) {
    setup->scene->environment.kind = ENVIRONMENT_NONE;
    setup->scene->environment.has_sun = false;
    setup->scene->environment.heading = 0;
    set_all_levels(setup, level);
    return setup_relight(setup, arena, err);
}

/* ---- making them ------------------------------------------------------------------------- */

static SweepMeter meter_at(Vec3 position, Vec3 normal) {
    return (SweepMeter){.head = {position, normal, false}};
}

static void place_meters(Sweep *sweep, Arena *arena) {
    sweep->faces = ARENA_NEW(arena, SweepMeter, sweep->symbol_count);
    for (int i = 0; i < sweep->symbol_count; i++) {
        SymbolPoint p = symbol_middle(&sweep->symbols[i]);
        sweep->faces[i] = meter_at(symbol_point_start(sweep->setup->scene, &p), p.ns);
    }
    const ReviewRequest *request = sweep->run->request;
    sweep->sensors = ARENA_NEW(arena, SweepMeter, request->level_count);
    for (int i = 0; i < request->level_count; i++) {
        const ReviewLevel *level = &request->levels[i];
        if (level->is_curve)
            sweep->sensors[i] =
                meter_at(scene_from_world(sweep->setup->scene->origin, level->position_m),
                         vec3_from_doubles(level->normal));
    }
}

bool sight_is_seen(const Sight *sight) {
    double share = sight->seen.visible_share;
    return sight->is_private ? share > 0 : review_is_seen(share);
}

static void aim_sight(Sweep *sweep, Sight *sight, Arena *arena) {
    const Setup *setup = sweep->setup;
    const SymbolSurface *surface = &sight->symbol->surface;
    sight->probe.aim = (ProbeAim){.context = &setup->context,
                                  .eye = sight->from,
                                  .seed = review_seed(setup->request, EYE_SEED)};
    sight->seen = symbol_aim(surface, arena, &sight->probe.aim);
    SymbolLook look = {surface, &sight->symbol->split, sight->from, setup->tools.threads,
                       &sight->seen};
    SymbolEmission shown = symbol_emission(&look, 1);
    sight->shown.foreground = shown.xyz[SYMBOL_FOREGROUND][1];
    sight->shown.background = shown.xyz[SYMBOL_BACKGROUND][1];
    sight->height_arcmin = symbol_height_arcmin(surface, sight->symbol->split.box, sight->from);
    if (!sight_is_seen(sight)) sight->probe.aim.target_count = 0;
    if (!sight->probe.aim.target_count) return;
    LightParts *parts = ARENA_NEW(arena, LightParts, 1);
    *parts = symbol_parts(sight->symbol, &sight->probe.aim, SUN_PATHS, arena);
    parts->takes_least = sight->is_private;
    if (parts->aim.target_count) sight->probe.parts = parts;
}

/* Symbols follow each other eye by eye. */
static void find_twin(Sweep *sweep, Sight *sight) {
    int id = (int)(sight - sweep->sights), same = id % sweep->symbol_count;
    sight->twin = NO_ID;
    for (int i = same; i < id && sight->twin == NO_ID; i += sweep->symbol_count) {
        Sight *other = &sweep->sights[i];
        if (other->is_private != sight->is_private ||
            memcmp(&other->from, &sight->from, sizeof sight->from) != 0)
            continue;
        sight->twin = i;
        other->has_twin = true;
    }
}

static bool place_sights(Sweep *sweep, Arena *arena, Error *err) {
    const ReviewRequest *request = sweep->run->request;
    sweep->sights = ARENA_NEW(arena, Sight, request->eye_count * sweep->symbol_count);
    for (int e = 0; e < request->eye_count; e++) {
        Vec3 from;
        if (!setup_eye_middle(sweep->setup, &request->eyes[e], *arena, &from, err)) return false;
        for (int s = 0; s < sweep->symbol_count; s++) {
            Sight *sight = &sweep->sights[sweep->sight_count++];
            *sight = (Sight){.eye = &request->eyes[e],
                             .symbol = &sweep->symbols[s],
                             .from = from,
                             .face = &sweep->faces[s],
                             .twin = NO_ID};
            sight->is_private =
                review_is_private(request, sweep->symbols[s].symbol_id, &request->eyes[e]);
            aim_sight(sweep, sight, arena);
            find_twin(sweep, sight);
        }
    }
    return true;
}

/* ---- what they have to find -------------------------------------------------------------- */

/* Levels move no response: those of the review serve. */
static double response_precision(const Sweep *sweep) {
    const ReviewRun *run = sweep->run;
    bool is_bare = run->base && !run->request->is_relevelled;
    return (is_bare ? RESPONSE_SHARE_VARIANT : RESPONSE_SHARE) * run->request->precision_contrast;
}

static void add_meter_call(Sweep *sweep, SweepMeter *meter, const char *name) {
    meter->probe.aim = (ProbeAim){.context = &sweep->setup->context,
                                  .meter = &meter->head,
                                  .seed = review_seed(sweep->run->request, METER_SEED)};
    sweep->calls[sweep->call_count++] = (ResponseArgs){.name = name,
                                                       .probe = &meter->probe,
                                                       .own = &meter->own,
                                                       .paths = METER_PATHS,
                                                       .precision = response_precision(sweep)};
}

static void list_calls(Sweep *sweep, Arena *arena) {
    const ReviewRequest *request = sweep->run->request;
    sweep->calls = ARENA_NEW(arena, ResponseArgs,
                             sweep->symbol_count + request->level_count + sweep->sight_count);
    for (int i = 0; i < sweep->symbol_count; i++)
        add_meter_call(sweep, &sweep->faces[i],
                       arena_format(arena, "face of %s", sweep->symbols[i].name));
    for (int i = 0; i < request->level_count; i++)
        if (request->levels[i].is_curve)
            add_meter_call(sweep, &sweep->sensors[i],
                           arena_format(arena, "sensor of %s", request->levels[i].name));
    for (int i = 0; i < sweep->sight_count; i++) {
        Sight *sight = &sweep->sights[i];
        if (!sight->probe.aim.target_count || sight->twin != NO_ID) continue;
        sweep->calls[sweep->call_count++] = (ResponseArgs){
            .name = arena_format(arena, "%s, %s", sight->eye->name, sight->symbol->name),
            .probe = &sight->probe,
            .own = &sight->own,
            .paths = RESPONSE_PATHS,
            .precision = response_precision(sweep)};
    }
}

DistantTools sweep_tools(Sweep *sweep) {
    return (DistantTools){.setup = sweep->setup,
                          .table = &sweep->table,
                          .hours = sweep->has_hours ? &sweep->hours : NULL,
                          .suns = {sweep->suns.distant, sweep->suns.count},
                          .sun_paths = SUN_PATHS,
                          .has_mirror = true};
}

/* Copies each sight's readings to its twin. */
static void copy_twins(Sweep *sweep) {
    for (int i = 0; i < sweep->sight_count; i++) {
        Sight *sight = &sweep->sights[i];
        if (sight->twin == NO_ID) continue;
        sight->probe = sweep->sights[sight->twin].probe;
        sight->own = sweep->sights[sight->twin].own;
    }
}

static bool sample_skies(Sweep *sweep, const DistantTools *tools, Arena *arena, Error *err) {
    int most = sweep->symbol_count + 1 + sweep->sight_count, count = 0;
    DistantProbe **probes = ARENA_NEW(arena, DistantProbe *, most);
    for (int i = 0; i < sweep->symbol_count; i++) probes[count++] = &sweep->faces[i].probe;
    if (sweep->sensor) probes[count++] = &sweep->sensor->probe;
    for (int i = 0; i < sweep->sight_count; i++) {
        Sight *sight = &sweep->sights[i];
        if (sight->twin == NO_ID && sight->probe.aim.target_count) probes[count++] = &sight->probe;
    }
    if (!distant_probes_sample_skies(probes, count, tools, arena, err)) return false;
    copy_twins(sweep);
    return true;
}

/* ---- what they read ---------------------------------------------------------------------- */

#define READ_CHUNK 256 /* suns of one piece of work */

typedef struct ReadWork {
    const DistantProbe *probe;
    const DistantTools *tools;
    DistantReading *read;
} ReadWork;

static void read_chunk(void *user, int item, int worker) {
    (void)worker;
    const ReadWork *work = user;
    int first = item * READ_CHUNK, end = first + READ_CHUNK, count = work->tools->suns.count;
    for (int sun = first; sun < end && sun < count; sun++)
        work->read[sun] = distant_probe_read(work->probe, work->tools, sun);
}

/* [sun] of a probe that was taken by them. */
static const DistantReading *read_suns(const DistantProbe *probe, const DistantTools *tools,
                                       Arena *arena) {
    int count = tools->suns.count;
    ReadWork work = {probe, tools, ARENA_NEW(arena, DistantReading, count)};
    parallel_for(tools->setup->tools.threads, (count + READ_CHUNK - 1) / READ_CHUNK, read_chunk,
                 &work);
    return work.read;
}

/* lux: [sun] */
static void sample_meter_suns(const SweepMeter *meter, const DistantTools *tools, Arena room,
                              double *lux) {
    DistantProbe probe = meter->probe;
    distant_probe_sample_suns(&probe, tools, &room);
    const DistantReading *read = read_suns(&probe, tools, &room);
    for (int i = 0; i < tools->suns.count; i++) lux[i] = distant_reading_sum(read[i]);
}

/* All suns whose reading is not kept are sampled at once, and kept. */
static void keep_missing(const SweepMeter *meter, const DistantTools *tools, Arena room) {
    DistantSun *missing = ARENA_NEW(&room, DistantSun, tools->suns.count);
    DistantTools of_missing = *tools;
    of_missing.suns = (DistantSuns){missing, 0};
    for (int i = 0; i < tools->suns.count; i++)
        if (!sun_readings_find(meter->kept, tools->suns.list[i]))
            missing[of_missing.suns.count++] = tools->suns.list[i];
    if (!of_missing.suns.count) return;
    double *lux = ARENA_NEW(&room, double, of_missing.suns.count);
    sample_meter_suns(meter, &of_missing, room, lux);
    for (int i = 0; i < of_missing.suns.count; i++)
        if (!sun_readings_find(meter->kept, missing[i]))
            sun_readings_add(meter->kept, missing[i], lux[i]);
}

const double *sweep_meter_read(const SweepMeter *meter, const DistantTools *tools, Arena *arena) {
    double *lux = ARENA_NEW(arena, double, tools->suns.count);
    if (!meter->kept) {
        sample_meter_suns(meter, tools, *arena, lux);
        return lux;
    }
    keep_missing(meter, tools, *arena);
    for (int i = 0; i < tools->suns.count; i++)
        lux[i] = *sun_readings_find(meter->kept, tools->suns.list[i]);
    return lux;
}

/* Under the condition's own suns; others are kept from now on. */
static void read_meter(SweepMeter *meter, const DistantTools *tools, Arena *between, Arena *arena) {
    meter->kept = NULL;
    meter->lux = sweep_meter_read(meter, tools, arena);
    meter->kept = ARENA_NEW(arena, SunReadings, 1);
    *meter->kept = sun_readings_start(between);
}

bool sweep_sample_light(Sweep *sweep, Arena *arena, Error *err) {
    DistantTools tools = sweep_tools(sweep);
    Arena *between = ARENA_NEW(arena, Arena, 1);
    *between = sweep->between;
    if (!sample_skies(sweep, &tools, arena, err)) return false;
    tools.has_mirror = false;
    tools.sun_paths = METER_SUN_PATHS;
    for (int i = 0; i < sweep->symbol_count; i++)
        read_meter(&sweep->faces[i], &tools, between, arena);
    if (sweep->sensor) read_meter(sweep->sensor, &tools, between, arena);
    return true;
}

Sight sweep_sample_sight(Sweep *sweep, const Sight *sight, Arena *arena) {
    DistantTools tools = sweep_tools(sweep);
    Sight asked = *sight;
    if (asked.probe.aim.target_count) distant_probe_sample_suns(&asked.probe, &tools, arena);
    return asked;
}

/* ---- the sun in mirrors ------------------------------------------------------------------ */

#define SUN_ELEVATION_DEG 30 /* mirrors take colours as those of this sun are */

static bool find_false_suns(Sweep *sweep, Arena *arena, Error *err) {
    const ReviewRequest *request = sweep->run->request;
    Daylight sky;
    DaylightInput clear = daylight_input_default(DAYLIGHT_CLEAR);
    float bands[LIGHT_BANDS];
    clear.has_sun = clear.no_moon = true;
    clear.sun_elevation = radians_from_degrees(SUN_ELEVATION_DEG);
    clear.sun_lux = -1;
    if (!daylight_build(&clear, arena, &sky, err)) return false;
    light_bands_sun(&sky, bands);
    sweep->false_suns = ARENA_NEW(arena, FalseSuns, request->eye_count);
    for (int e = 0; e < request->eye_count; e++) {
        Vec3 from;
        if (!setup_eye_middle(sweep->setup, &request->eyes[e], *arena, &from, err)) return false;
        const FalseSunRays *rays = sun_searches_find(sweep->run->sun_searches, sweep->setup, from);
        sweep->false_suns[e] = false_suns_of(rays, bands, arena);
    }
    return true;
}

/* ---- all of them ------------------------------------------------------------------------- */

bool sweep_place_probes(Sweep *sweep, Arena *arena, Error *err) {
    Setup *setup = sweep->setup;
    if (!sweep_light_dark(setup, has_lamps(setup->scene) ? 0 : 1, arena, err) ||
        !setup_symbols(setup, arena, &sweep->symbols, &sweep->symbol_count, err))
        return false;
    place_meters(sweep, arena);
    if (!place_sights(sweep, arena, err)) return false;
    list_calls(sweep, arena);
    responses_find(sweep->run, setup, sweep->calls, sweep->call_count, arena);
    return true;
}

bool sweep_make_probes(Sweep *sweep, Arena *arena, Error *err) {
    Setup *setup = sweep->setup;
    const ReviewRun *run = sweep->run;
    return (!has_lamps(setup->scene) ||
            (responses_read_own(setup, sweep->calls, sweep->call_count, false, err) &&
             sweep_light_dark(setup, 1, arena, err))) &&
           responses_read_own(setup, sweep->calls, sweep->call_count, true, err) &&
           responses_trace(run, setup, sweep->calls, sweep->call_count, arena, err) &&
           (run->base || find_false_suns(sweep, arena, err)); /* a variant reports none */
}
