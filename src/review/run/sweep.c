#include "review/run/sweep.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/units.h"
#include "review/judge.h"
#include "review/output/review_decide.h"

#define RESPONSE_PATHS 4096
#define RESPONSE_PRECISION 0.02
#define METER_PATHS 1024
#define SUN_PATHS 64     /* of the first vertex */
#define MIRROR_PATHS 2048 /* of its mirror, which cost little */
#define EYE_SEED 0x73776579u
#define METER_SEED 0x73776d65u

/* ---- probes ------------------------------------------------------------------------------ */

/* What displays and lamps of the scene give, whatever the sky: linear in the displays' level.
 * */
typedef struct OwnLight {
    double lamps, displays; /* at level 1 */
} OwnLight;

typedef struct SweepMeter {
    LitPoint head;
    FarProbe probe;
    OwnLight own;
} SweepMeter;

typedef struct Sight {
    const ReviewEye   *eye;
    const StageSymbol *symbol;
    Vec3               from;
    SymbolVisibility   seen;
    CaseLuminances     shown;   /* foreground and background at level 1 */
    double             height_arcmin;
    FarProbe           probe;
    OwnLight           own;
    double             own_mirror; /* share of own light that is the mirror's */
    const SweepMeter       *face;
} Sight;

typedef struct Sweep {
    const ReviewRun   *run;
    Stage             *stage;
    SweepSuns          suns;
    SkyTable           table;
    StageSymbol       *symbols;
    int                symbol_count;
    SweepMeter             *faces;   /* one a symbol */
    SweepMeter             *sensor;  /* of the level; NULL: it is fixed */
    const ReviewLevel *level;   /* NULL: the scene's */
    Sight             *sights;
    int                sight_count;
} Sweep;

static void set_all_levels(Stage *stage, float level)
{
    for (int i = 0; i < stage->scene->display_count; i++)
        stage->scene->displays[i].level = level;
}

/* Air and ground: the condition's, or as usual. */
static DaylightInput air_of(const ReviewCondition *condition)
{
    DaylightInput air = condition->has_environment ? condition->environment.daylight
                                                   : daylight_input_default(DAYLIGHT_CLEAR);
    air.kind = DAYLIGHT_CLEAR;
    if (condition->kind == CONDITION_YEAR_SWEEP) air.where = condition->where;
    if (condition->kind == CONDITION_ROUTE) air.where = condition->route.points[0].where;
    return air;
}

/* The scene without sky and sun, its displays at one level. */
static bool light_without_sky(Stage *stage, float level, Arena *arena, Error *err)
{
    Lights *lights;
    stage->scene->environment.kind = ENVIRONMENT_NONE;
    stage->scene->environment.has_sun = false;
    stage->scene->environment.heading = 0;
    set_all_levels(stage, level);
    if (!lights_build(stage->scene, arena, &lights, err)) return false;
    stage->context =
        path_context_build(stage->scene, stage->bvh, lights, STAGE_BOUNCES, arena);
    return true;
}

static bool gives_light(const Lights *lights)
{
    return lights_has(lights, LIGHTS_EMITTERS) || lights_has(lights, LIGHTS_PUNCTUAL);
}

static double own_reading(const Stage *stage, const ProbeAim *aim, Arena scratch)
{
    ReadingGoal goal = {.precision = 0.02, .most = 8192};
    if (!gives_light(stage->context.lights)) return 0;
    return reading_take(aim, &goal, &stage->tools, scratch).reflected;
}

/* ---- making them ------------------------------------------------------------------------- */

static SweepMeter meter_at(Vec3 position, Vec3 normal)
{
    return (SweepMeter){.head = {position, normal, false}};
}

static void place_meters(Sweep *sweep, Arena *arena)
{
    sweep->faces = ARENA_NEW(arena, SweepMeter, sweep->symbol_count);
    for (int i = 0; i < sweep->symbol_count; i++) {
        const SymbolSurface *surface = &sweep->symbols[i].surface;
        const SymbolPoint   *p = &surface->points[surface->point_count / 2];
        sweep->faces[i] =
            meter_at(vec3_along(p->position, p->ng, ray_offset_step(p->position)), p->ns);
    }
    if (!sweep->level || !sweep->level->is_curve) return;
    const double *at = sweep->level->position_m, *to = sweep->level->normal;
    sweep->sensor = ARENA_NEW(arena, SweepMeter, 1);
    *sweep->sensor = meter_at(vec3((float)at[0], (float)at[1], (float)at[2]),
                              vec3((float)to[0], (float)to[1], (float)to[2]));
}

static void aim_sight(Sweep *sweep, Sight *sight, Arena *arena)
{
    const Stage         *stage = sweep->stage;
    const SymbolSurface *surface = &sight->symbol->surface;
    bool *is_visible = ARENA_NEW(arena, bool, surface->point_count);
    Vec3 *targets = ARENA_NEW(arena, Vec3, surface->point_count);
    int   count = 0;
    sight->seen = symbol_visibility(surface, &stage->context, sight->from, is_visible);
    for (int i = 0; i < surface->point_count; i++)
        if (is_visible[i]) targets[count++] = surface->points[i].position;
    SymbolEmission shown =
        symbol_emission(surface, &sight->symbol->split, 1, sight->from);
    sight->shown.foreground = shown.foreground_xyz[1] * sight->seen.transmittance;
    sight->shown.background = shown.background_xyz[1] * sight->seen.transmittance;
    sight->height_arcmin = symbol_height_arcmin(surface, sight->symbol->split.box, sight->from);
    sight->probe.aim = (ProbeAim){.context = &stage->context, .eye = sight->from,
                                  .targets = targets, .target_count = count, .seed = EYE_SEED};
}

static bool place_sights(Sweep *sweep, Arena *arena, Error *err)
{
    const ReviewRequest *request = sweep->run->request;
    sweep->sights = ARENA_NEW(arena, Sight, request->eye_count * sweep->symbol_count);
    for (int e = 0; e < request->eye_count; e++) {
        int   count;
        Vec3 *points = stage_eye_points(sweep->stage, &request->eyes[e], &count, arena, err);
        if (!points) return error_in_file(err, request->file);
        for (int s = 0; s < sweep->symbol_count; s++) {
            Sight *sight = &sweep->sights[sweep->sight_count++];
            *sight = (Sight){.eye = &request->eyes[e], .symbol = &sweep->symbols[s],
                             .from = points[count / 2], .face = &sweep->faces[s]};
            aim_sight(sweep, sight, arena);
        }
    }
    return true;
}

static void read_own(Sweep *sweep, bool displays, Arena scratch)
{
    const Stage *stage = sweep->stage;
    for (int i = 0; i < sweep->sight_count; i++) {
        Sight *sight = &sweep->sights[i];
        if (!sight->probe.aim.target_count) continue;
        double own = own_reading(stage, &sight->probe.aim, scratch);
        if (displays) sight->own.displays = own - sight->own.lamps;
        else sight->own.lamps = own;
    }
    for (int i = 0; i < sweep->symbol_count + (sweep->sensor != NULL); i++) {
        SweepMeter   *meter = i < sweep->symbol_count ? &sweep->faces[i] : sweep->sensor;
        ProbeAim aim = {.context = &stage->context, .meter = &meter->head, .seed = METER_SEED};
        double   own = own_reading(stage, &aim, scratch);
        if (displays) meter->own.displays = own - meter->own.lamps;
        else meter->own.lamps = own;
    }
}

static void trace_meter(SweepMeter *meter, FarTools tools, Arena *arena)
{
    tools.paths = METER_PATHS;
    tools.mirror_paths = 0;
    meter->probe.aim = (ProbeAim){.context = &tools.stage->context, .meter = &meter->head,
                                  .seed = METER_SEED};
    far_probe_trace(&meter->probe, &tools, arena);
}

static void trace_all(Sweep *sweep, const FarTools *tools, Progress *progress, Arena *arena)
{
    int done = 0;
    for (int i = 0; i < sweep->symbol_count; i++) trace_meter(&sweep->faces[i], *tools, arena);
    if (sweep->sensor) trace_meter(sweep->sensor, *tools, arena);
    for (int i = 0; i < sweep->sight_count; i++) {
        Sight *sight = &sweep->sights[i];
        if (sight->probe.aim.target_count) far_probe_trace(&sight->probe, tools, arena);
        progress_update(progress, ++done);
    }
}

/* ---- reading them ------------------------------------------------------------------------ */

static double total(const FarReading *reading)
{
    return reading->sky + reading->sun_first + reading->sun_rest;
}

static double contrast(const CaseLuminances *l, double reflected)
{
    double brighter = fmax(l->foreground, l->background) + reflected;
    double darker = fmin(l->foreground, l->background) + reflected;
    return darker > 0 ? brighter / darker : brighter > 0 ? (double)INFINITY : 1;
}

static double level_for(const Sweep *sweep, const Sight *sight, const FarTools *tools, int sun)
{
    double scene = sweep->stage->scene_levels[sight->symbol->display.display_id], lux = 0;
    if (!sweep->level) return scene;
    if (sweep->sensor) {
        FarReading at = far_probe_read(&sweep->sensor->probe, tools, sun);
        lux = total(&at) + sweep->sensor->own.lamps;
    }
    const Display    *display =
        &sweep->stage->scene->displays[sight->symbol->display.display_id];
    ReviewDisplayName name = {sight->symbol->display_name, display->name};
    return review_level_at(sweep->level, name, scene, lux);
}

/* The figures of a case under one sun; limits are judged by whoever asks. */
static ReviewCase case_at(const Sweep *sweep, const Sight *sight, const FarTools *tools,
                          int sun)
{
    FarReading light = far_probe_read(&sight->probe, tools, sun);
    FarReading face = far_probe_read(&sight->face->probe, tools, sun);
    double     level = level_for(sweep, sight, tools, sun);
    double     own = sight->own.lamps + level * sight->own.displays;
    double     reflected = total(&light) + own, sigma = sight->probe.response.relative_error;
    ReviewCase c = {.level = level, .limit_id = -1, .visible_share = sight->seen.visible_share,
                    .height_arcmin = sight->height_arcmin};
    double     spread = 1.96 * sigma * (light.sky + light.sun_rest);
    c.display_lux = total(&face) + sight->face->own.lamps + level * sight->face->own.displays;
    c.luminance_cd_m2 = (CaseLuminances){
        level * sight->shown.foreground, level * sight->shown.background, reflected,
        light.mirror, reflected - light.mirror, (double)NAN};
    c.contrast_ratio = contrast(&c.luminance_cd_m2, reflected);
    c.contrast_low = contrast(&c.luminance_cd_m2, reflected + spread);
    c.contrast_high = contrast(&c.luminance_cd_m2, fmax(reflected - spread, 0));
    c.contrast_with_veil = c.contrast_ratio;
    judge_ambient(&c, sweep->run->profile, light.sun_first > CASE_SUNLIT * reflected);
    return c;
}

/* ---- what is told of them ---------------------------------------------------------------- */

typedef struct Told {
    float *contrast, *margin, *reflected, *mirror, *level, *lux;
    unsigned char *verdict;
    int    worst; /* sun; -1: none */
} Told;

static Told told_start(int count, Arena *arena)
{
    float *numbers = ARENA_NEW(arena, float, 6 * (size_t)count);
    return (Told){numbers, numbers + count, numbers + 2 * count, numbers + 3 * count,
                  numbers + 4 * count, numbers + 5 * count,
                  ARENA_NEW(arena, unsigned char, count), -1};
}

/* Worse: by its verdict, then by its margin, then by its contrast. */
static bool is_worse(const Told *told, int sun, int than)
{
    if (than < 0) return true;
    int rank = verdict_rank(told->verdict[sun]), other = verdict_rank(told->verdict[than]);
    if (rank != other) return rank > other;
    float margin = told->margin[sun], before = told->margin[than];
    if (!isnan(margin) && !isnan(before) && margin != before) return margin < before;
    return told->contrast[sun] < told->contrast[than];
}

#define TELL_CHUNK 256 /* suns of one piece of work */
#define TELL_BYTES ((size_t)1 << 20) /* scratch of a worker */

typedef struct TellWork {
    const Sweep    *sweep;
    const Sight    *sight;
    const FarTools *tools;
    Told           *told;
    Arena          *scratch; /* one a worker */
} TellWork;

static void tell_sun(const TellWork *work, int sun, Arena scratch)
{
    Told      *told = work->told;
    ReviewCase c = case_at(work->sweep, work->sight, work->tools, sun);
    judge_case(&c, work->sweep->run->profile, &scratch);
    told->contrast[sun] = (float)c.contrast_ratio;
    told->margin[sun] = (float)c.margin;
    told->reflected[sun] = (float)c.luminance_cd_m2.reflected;
    told->mirror[sun] = (float)c.luminance_cd_m2.mirror;
    told->level[sun] = (float)c.level;
    told->lux[sun] = (float)c.display_lux;
    told->verdict[sun] = (unsigned char)c.verdict;
}

static void tell_chunk(void *user, int item, int worker)
{
    const TellWork *work = user;
    int first = item * TELL_CHUNK, end = first + TELL_CHUNK, count = work->sweep->suns.count;
    for (int sun = first; sun < end && sun < count; sun++)
        tell_sun(work, sun, work->scratch[worker]);
}

static Told tell(const Sweep *sweep, const Sight *sight, const FarTools *tools, Arena *arena)
{
    int      count = sweep->suns.count, threads = sweep->run->threads;
    Told     told = told_start(count, arena);
    TellWork work = {sweep, sight, tools, &told, NULL};
    Arena    room = *arena;
    work.scratch = ARENA_NEW(&room, Arena, threads);
    for (int i = 0; i < threads; i++) work.scratch[i] = arena_reserve(TELL_BYTES);
    parallel_for(threads, (count + TELL_CHUNK - 1) / TELL_CHUNK, tell_chunk, &work);
    for (int i = 0; i < threads; i++) arena_release(&work.scratch[i]);
    for (int sun = 0; sun < count; sun++)
        if (is_worse(&told, sun, told.worst)) told.worst = sun;
    return told;
}

/* Time that failed over all time; without times every sun counts alike. */
static double failed_share(const SweepSuns *suns, const Told *told)
{
    double failed = 0, all = 0;
    for (int i = 0; i < suns->count; i++) {
        double weight = suns->has_time ? suns->list[i].minutes : 1;
        all += weight;
        if (told->verdict[i] == VERDICT_FAIL) failed += weight;
    }
    return all > 0 ? failed / all : 0;
}

/* At a stretch, under one heading: steps that follow each other without a gap. */
static double longest_failure(const SweepSuns *suns, const Told *told, Arena scratch)
{
    double longest = 0;
    int    headings = 1;
    if (!suns->has_time) return (double)NAN;
    for (int i = 0; i < suns->count; i++)
        if (suns->list[i].heading_id >= headings) headings = suns->list[i].heading_id + 1;
    double *run = ARENA_NEW(&scratch, double, headings);
    int    *last = ARENA_NEW(&scratch, int, headings);
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        int h = sun->heading_id;
        bool follows = last[h] == sun->step && run[h] > 0;
        run[h] = told->verdict[i] != VERDICT_FAIL ? 0 : (follows ? run[h] : 0) + sun->minutes;
        last[h] = sun->step + 1;
        longest = fmax(longest, run[h]);
    }
    return longest;
}

/* ---- the worst, read again as a moment --------------------------------------------------- */

Environment sweep_environment(const Stage *stage, const SweepSun *sun)
{
    const double *forward = stage->request->forward;
    Environment   environment = {
        .forward = vec3((float)forward[0], (float)forward[1], (float)forward[2])};
    environment.kind = ENVIRONMENT_SKY;
    environment.daylight = air_of(stage->condition);
    environment.daylight.has_time = false;
    environment.has_sun = true;
    environment.sun_azimuth = (float)radians_from_degrees(sun->compass_deg);
    environment.sun_elevation = (float)radians_from_degrees(sun->elevation_deg);
    environment.sun_illuminance_lx = -1;
    environment.sun_angular_radius = (float)radians_from_degrees(0.26645);
    environment.heading = (float)radians_from_degrees(sun->heading_deg);
    return environment;
}

/* What a sweep does with each of its sights. */
typedef struct Telling {
    const Sweep     *sweep;
    const FarTools  *tools;
    const SweepSuns *suns;   /* kept */
    ReviewOutcome   *out;
    Arena           *arena;  /* of what is kept */
    Arena            scratch;
} Telling;

static bool read_worst(Telling *to, const Sight *sight, const SweepSun *sun, ReviewCase *out,
                       Error *err)
{
    const Sweep *sweep = to->sweep;
    Arena        scratch = to->scratch;
    Stage        stage = *sweep->stage;
    Environment  environment = sweep_environment(sweep->stage, sun);
    for (int i = 0; i < stage.scene->display_count; i++)
        stage.scene->displays[i].level = (float)stage.scene_levels[i];
    if (!stage_light(&stage, &environment, &scratch, err)) return false;
    CaseTools tools = {&stage, sweep->run->profile, sight->symbol, 1};
    return stage_case(&tools, sight->symbol, sight->eye, to->arena, out, err);
}

/* The n-th day of a year as month and day. */
static void date_of(int year, int day, int *month, int *of_month)
{
    static const int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    bool is_leap = (year % 4 == 0 && year % 100) || year % 400 == 0;
    for (*month = 1; *month < 12; (*month)++) {
        int length = lengths[*month - 1] + (*month == 2 && is_leap);
        if (day < length) break;
        day -= length;
    }
    *of_month = day + 1;
}

/* Azimuths of a sweep's worst are the vehicle's, as those of its map are. */
static void tell_when(const Telling *to, const SweepSun *sun, ReviewCase *c)
{
    const ReviewCondition *condition = to->sweep->stage->condition;
    c->sun_azimuth_deg = fmod(sun->azimuth_deg + 360, 360);
    if (condition->kind == CONDITION_YEAR_SWEEP) {
        int minutes = (int)((sun->step + 0.5) * condition->step_minutes), month, day;
        date_of(condition->year, minutes / 1440, &month, &day);
        c->when = arena_format(to->arena, "%d-%02d-%02d %02d:%02d UTC, heading %g degrees",
                               condition->year, month, day, minutes / 60 % 24, minutes % 60,
                               sun->heading_deg);
    } else if (condition->kind == CONDITION_ROUTE) {
        const SkyTime *when = &condition->route.points[sun->step].when;
        c->when = arena_format(to->arena, "%d-%02d-%02d %02d:%02d, heading %.0f degrees",
                               when->year, when->month, when->day, when->hour, when->minute,
                               sun->heading_deg);
    }
}

static ReviewSweep sweep_of(const Telling *to, const Sight *sight)
{
    const char *symbol = sight->symbol->name;
    ReviewSweep sweep = {.condition = to->sweep->stage->condition->name,
                         .eye = sight->eye->name, .cases = to->suns->count,
                         .symbol = arena_string(to->arena, symbol, strlen(symbol)),
                         .longest_failure_minutes = to->suns->has_time ? 0 : (double)NAN};
    sweep.worst = (ReviewCase){.condition = sweep.condition, .eye = sweep.eye,
                               .symbol = sweep.symbol, .limit_id = -1, .margin = (double)NAN,
                               .display = sight->symbol->display_name,
                               .verdict = VERDICT_NOT_VISIBLE};
    return sweep;
}

static bool add_sweep(Telling *to, const Sight *sight, Error *err)
{
    Review     *review = &to->out->review;
    ReviewSweep sweep = sweep_of(to, sight);
    if (sight->probe.aim.target_count) {
        Told told = tell(to->sweep, sight, to->tools, to->arena);
        sweep.failed_share = failed_share(to->suns, &told);
        sweep.longest_failure_minutes = longest_failure(to->suns, &told, to->scratch);
        if (told.worst >= 0 &&
            !read_worst(to, sight, &to->suns->list[told.worst], &sweep.worst, err))
            return false;
        sweep.worst.symbol = sweep.symbol;
        if (told.worst >= 0) tell_when(to, &to->suns->list[told.worst], &sweep.worst);
        to->out->tables[to->out->table_count++] =
            (SweepTable){review->sweep_count, told.worst, to->suns, told.contrast, told.margin,
                         told.reflected, told.mirror, told.level, told.lux, told.verdict};
    }
    review->sweeps[review->sweep_count++] = sweep;
    return true;
}

/* ---- all of it --------------------------------------------------------------------------- */

static void tell_response(const Sweep *sweep, const Sight *sight, Arena *arena, Review *out)
{
    if (!sight->probe.aim.target_count) return;
    const Response *response = &sight->probe.response;
    out->responses[out->response_count++] = (ReviewResponse){
        arena_format(arena, "%s, %s, %s", sweep->stage->condition->name, sight->eye->name,
                     sight->symbol->name),
        response->paths,
        2 * (size_t)response->cells.count * LIGHT_BANDS * sizeof(float),
        response->relative_error};
}

static bool prepare(Sweep *sweep, Arena *scratch, Error *err)
{
    Stage *stage = sweep->stage;
    double low = 90, high = -90;
    for (int i = 0; i < sweep->suns.count; i++) {
        low = fmin(low, sweep->suns.list[i].elevation_deg);
        high = fmax(high, sweep->suns.list[i].elevation_deg);
    }
    DaylightInput like = air_of(stage->condition);
    like.has_time = false;
    like.threads = stage->tools.threads;
    return sky_table_build(&like, low, high, scratch, &sweep->table, err) &&
           light_without_sky(stage, 0, scratch, err) &&
           stage_symbols(stage, scratch, &sweep->symbols, &sweep->symbol_count, err);
}

bool run_sweep(const ReviewRun *run, Stage *stage, Arena *scratch, Arena *arena,
               ReviewOutcome *out, Error *err)
{
    const ReviewCondition *condition = stage->condition;
    Sweep sweep = {.run = run, .stage = stage, .suns = sweep_suns(condition, arena)};
    if (condition->weather_id != NO_ID)
        return error_at(err, ERROR_INPUT, run->request->file,
                        arena_format(arena, "/conditions/%s", condition->name),
                        "a sweep under the skies of a weather file is not supported: wanted "
                        "\"weather\": \"clear\"");
    if (condition->level_id != NO_ID) sweep.level = &run->request->levels[condition->level_id];
    if (!prepare(&sweep, scratch, err)) return false;
    place_meters(&sweep, scratch);
    if (!place_sights(&sweep, scratch, err)) return false;
    read_own(&sweep, false, *scratch);
    if (!light_without_sky(stage, 1, scratch, err)) return false;
    read_own(&sweep, true, *scratch);
    FarTools tools = {stage, &sweep.table, {sweep.suns.angles, sweep.suns.count},
                      RESPONSE_PATHS, RESPONSE_PRECISION, SUN_PATHS, MIRROR_PATHS};
    Progress progress = progress_start(run->progress, condition->name, "probes",
                                       sweep.sight_count);
    trace_all(&sweep, &tools, &progress, scratch);
    progress_end(&progress, sweep.sight_count);
    SweepSuns *suns = ARENA_NEW(arena, SweepSuns, 1);
    *suns = sweep.suns;
    Telling to = {&sweep, &tools, suns, out, arena, *scratch};
    for (int i = 0; i < sweep.sight_count; i++) {
        tell_response(&sweep, &sweep.sights[i], arena, &out->review);
        if (!add_sweep(&to, &sweep.sights[i], err)) return false;
    }
    return true;
}
