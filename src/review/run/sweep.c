/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/units.h"
#include "review/judge.h"
#include "review/chain/causes.h"
#include "review/keep/frame_kept.h"
#include "review/run/false_sun_times.h"
#include "review/run/rests.h"
#include "review/run/sun_figures.h"
#include "review/run/sweep_probes.h"
#include "review/run/sweep_weather.h"
#include "review/suns/sweep_suns.h"

#define WORST_READ 3 /* steps that are read again, at most */
/* the suns of two of them, at least: a response's angular resolution */
#define WORST_APART_DEG 5.0
#define REFINED 4             /* steps about which the worst is looked for, at most */
#define REFINED_APART_DEG 3.0 /* the suns of two of them, at least */
#define PICK_SEED 0x40000000u
#define SWEEP_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* Air and ground: the condition's, or as usual. */
static DaylightInput air_of(const ReviewCondition *condition) {
    DaylightInput air = condition->has_environment ? condition->environment.daylight
                                                   : daylight_input_default(DAYLIGHT_CLEAR);
    air.kind = DAYLIGHT_CLEAR;
    if (condition->kind == CONDITION_YEAR_SWEEP) air.where = condition->where;
    return air;
}

/* For a sweep without times: every sun counts alike. */
static double failed_share(const SweepSuns *suns, const SunFigures *figures) {
    double failed = 0;
    for (int i = 0; i < suns->count; i++) failed += figures->verdict[i] == VERDICT_FAIL;
    return failed / suns->count;
}

/* ---- the worst, read again as a moment --------------------------------------------------- */

/* Sets a weather file's sky: none when it is dark. */
static void set_weather(const Setup *setup, const SweepSun *sun, Environment *environment) {
    bool is_lit =
        sweep_weather_light(setup->request, setup->condition, sun, &environment->daylight);
    environment->kind = is_lit ? ENVIRONMENT_PEREZ : ENVIRONMENT_NONE;
}

/* The sun's place is known; the date gives the earth's distance. Sweeps have no moon. */
static void set_date(const ReviewCondition *condition, const SweepSun *sun, DaylightInput *out) {
    bool is_year = condition->kind == CONDITION_YEAR_SWEEP;
    double later = is_year ? sun->later_minutes / condition->step_minutes : 0;
    out->has_time = sun->step >= 0;
    out->no_moon = true;
    if (out->has_time)
        out->when = sweep_time(condition, condition->step_minutes, sun->step + later);
}

Environment sweep_environment(const Setup *setup, const SweepSun *sun) {
    Environment environment = {.forward = vec3_from_doubles(setup->request->forward),
                               .heading = (float)radians_from_degrees(sun->heading_deg)};
    if (setup->condition->weather_id != NO_ID && sun->step >= 0) {
        set_weather(setup, sun, &environment);
        return environment;
    }
    environment.kind = ENVIRONMENT_SKY;
    environment.daylight = air_of(setup->condition);
    set_date(setup->condition, sun, &environment.daylight);
    environment.has_sun = true;
    environment.sun_azimuth = (float)radians_from_degrees(sun->compass_deg);
    environment.sun_elevation = (float)radians_from_degrees(sun->elevation_deg);
    environment.sun_illuminance_lx = -1;
    environment.sun_angular_radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG);
    return environment;
}

/* The state of reporting a sweep's sights. */
typedef struct SweepReport {
    Sweep *sweep;
    const DistantTools *tools;
    const SweepSuns *suns; /* kept */
    SunFigures *figures;   /* of each sight under every sun; they hold for its twin, too */
    SweepTable *tables;    /* one a sight; those without suns are none */
    int first;             /* sweep of the review: that of the first sight */
    ReviewOutcome *out;
    Arena *arena; /* of what is kept */
    Arena scratch;
} SweepReport;

/* By the probes, for other suns. */
static SunFigures judge_others(const SweepReport *to, const Sight *sight, const SweepSuns *suns,
                               Arena *scratch) {
    Sweep sweep = *to->sweep;
    DistantTools tools = *to->tools, of_meters;
    SweepMeter face = *sight->face, sensor;
    Sight seen = *sight;
    sweep.suns = *suns;
    tools.suns = (DistantSuns){suns->distant, suns->count};
    of_meters = tools;
    of_meters.has_mirror = false;
    distant_probe_sample_suns(&seen.probe, &tools, scratch);
    face.lux = sweep_meter_read(&face, &of_meters, scratch);
    seen.face = &face;
    if (sweep.sensor) {
        sensor = *sweep.sensor;
        sensor.lux = sweep_meter_read(&sensor, &of_meters, scratch);
        sweep.sensor = &sensor;
    }
    SunFigures figures = sun_figures_start(suns->count, scratch);
    sun_figures_judge(&sweep, &seen, &tools, &figures, *scratch);
    return figures;
}

/* A sun about a step, and the margin there, as the probes show it. */
typedef struct Refined {
    SweepSun sun;
    double margin;
} Refined;

/* Where about a step it is worst. */
static Refined refine(const SweepReport *to, const Sight *sight, const SunFigures *figures,
                      int step) {
    Refined at = {to->suns->list[step], (double)figures->margin[step]};
    for (int round = 0;; round++) {
        Arena scratch = to->scratch;
        SweepSuns near = sweep_suns_about(to->sweep->setup->condition, &at.sun, round, &scratch);
        if (near.count < 2) return at;
        SunFigures of = judge_others(to, sight, &near, &scratch);
        at = (Refined){near.list[of.worst], (double)of.margin[of.worst]};
    }
}

/* User data of states_between. */
typedef struct Between {
    const SweepReport *to;
    const Sight *sight;
} Between;

static void states_between(void *user, const SweepSuns *suns, unsigned char *states,
                           Arena scratch) {
    const Between *between = user;
    SunFigures figures = judge_others(between->to, between->sight, suns, &scratch);
    sun_figures_states(&figures, suns->count, states);
}

/* Under each of its headings. */
static double swept_minutes(const ReviewCondition *condition, const SweepSuns *suns) {
    double all = 0;
    for (int i = 0; i < suns->count; i++) all += suns->list[i].minutes;
    return all / condition->heading_count;
}

/* The skies of a weather file stand for their steps alone. */
static void set_failures(const SweepReport *to, const Sight *sight, const SunFigures *figures,
                         ReviewSweep *out) {
    const ReviewCondition *condition = to->sweep->setup->condition;
    bool is_steady = condition->kind == CONDITION_YEAR_SWEEP && !to->sweep->has_hours;
    Between between = {to, sight};
    FailureArgs args = {states_between, &between};
    Arena scratch = to->scratch;
    if (!to->suns->has_time) {
        out->failed_share = failed_share(to->suns, figures);
        return;
    }
    unsigned char *states = ARENA_NEW(&scratch, unsigned char, to->suns->count);
    sun_figures_states(figures, to->suns->count, states);
    Failures found = sweep_failures(condition, to->suns, states, is_steady ? &args : NULL, scratch);
    out->failed_share = found.share;
    out->longest_failure_minutes = found.longest_minutes;
    out->failed_minutes = found.share * swept_minutes(condition, to->suns);
}

/* picks: to choose it, by other paths than those of the reported reading and of explain. */
static bool read_worst(SweepReport *to, const Sight *sight, const SweepSun *sun, bool picks,
                       ReviewCase *out, Error *err) {
    Sweep *sweep = to->sweep;
    Environment sky = sweep_environment(sweep->setup, sun);
    Environment dark = sweep->setup->scene->environment;
    ReviewRequest request = *sweep->run->request;
    request.seed += picks ? PICK_SEED : 0;
    Setup setup = *sweep->setup;
    Arena scratch = to->scratch;
    if (!setup_light(&setup, &sky, &scratch, err)) return false;
    setup.request = &request;
    CaseTools tools = {.setup = &setup,
                       .profile = sweep->run->profile,
                       .symbols = sweep->symbols,
                       .symbol_count = sweep->symbol_count,
                       .base = sweep->run->base};
    bool ok = setup_case(&tools, sight->symbol, sight->eye, to->arena, out, err);
    setup.scene->environment = dark; /* as the next sight is sampled */
    return ok;
}

/* Azimuths of a sweep's worst are the vehicle's, as those of its map are. */
static void set_when(const SweepReport *to, const SweepSun *sun, ReviewCase *c) {
    const ReviewCondition *condition = to->sweep->setup->condition;
    const char *when = sweep_suns_when(condition, to->suns, sun, to->arena);
    c->sun_azimuth_deg = fmod(sun->azimuth_deg + 360, 360);
    c->when =
        condition->weather_id == NO_ID
            ? when
            : arena_format(to->arena, "%s, %s", when,
                           sweep_weather_text(to->sweep->run->request, condition, sun, to->arena));
}

/* Under which the minutes of a year are. */
static const char *headings_of(const SweepReport *to) {
    const ReviewCondition *c = to->sweep->setup->condition;
    if (!to->suns->has_time) return NULL;
    if (c->heading_count > 1)
        return arena_format(to->arena, "mean of %d headings", c->heading_count);
    return arena_format(to->arena, "heading %g°", c->headings_deg[0]);
}

static ReviewSweep sweep_of(const SweepReport *to, const Sight *sight) {
    const char *symbol = sight->symbol->name;
    ReviewSweep sweep = {.condition = to->sweep->setup->condition->name,
                         .eye = sight->eye->name,
                         .cases = to->suns->count,
                         .symbol = arena_string(to->arena, symbol, strlen(symbol)),
                         .longest_failure_minutes = to->suns->has_time ? 0 : (double)NAN,
                         .failed_minutes = to->suns->has_time ? 0 : (double)NAN,
                         .headings = headings_of(to),
                         .middle_contrast = (double)NAN};
    sweep.worst = sun_figures_unread(to->sweep, sight, to->arena);
    sweep.worst.symbol = sweep.symbol;
    return sweep;
}

/* Of the worst steps that lie apart the one about which it is worst: a sun's image that one
 * step all but meets is worse than what another meets halfway. */
static SweepSun refine_worst(const SweepReport *to, const Sight *sight, const SunFigures *figures) {
    const FarSteps apart = {REFINED_APART_DEG, false};
    SweepSun steps[REFINED];
    Refined worst = refine(to, sight, figures, figures->worst);
    steps[0] = to->suns->list[figures->worst];
    for (int i = 1; i < REFINED; i++) {
        int step = sun_figures_next(figures, to->suns, apart, steps, i);
        if (step < 0) break;
        steps[i] = to->suns->list[step];
        Refined other = refine(to, sight, figures, step);
        if (other.margin < worst.margin) worst = other;
    }
    return worst.sun;
}

/* The worst of many steps has the worst luck, too: the reported one is read afresh. Where that
 * does not fail, though steps do, so are others of them, until one does. Chosen for that by
 * paths of its own, it is read once more and reported in any case: picking the reading that
 * fails of three is wrong three times as often. */
static bool find_worst(SweepReport *to, const Sight *sight, const SunFigures *figures,
                       SweepSun *worst, ReviewCase *out, Error *err) {
    const FarSteps failing = {WORST_APART_DEG, true};
    SweepSun read[WORST_READ];
    ReviewCase found = *out;
    int sun = figures->worst;
    for (int i = 0; i < WORST_READ && sun >= 0; i++) {
        read[i] = i ? refine(to, sight, figures, sun).sun : refine_worst(to, sight, figures);
        if (!read_worst(to, sight, &read[i], i > 0, &found, err)) return false;
        bool fails = found.verdict == VERDICT_FAIL;
        if (i && fails && !read_worst(to, sight, &read[i], false, &found, err)) return false;
        set_when(to, &read[i], &found);
        if (i == 0 || fails) {
            *out = found;
            *worst = read[i];
        }
        if (fails) return true;
        sun = sun_figures_next(figures, to->suns, failing, read, i + 1);
    }
    return true;
}

static void add_table(const SweepReport *to, const Sight *sight, const SunFigures *figures,
                      const SweepSun *worst) {
    int id = (int)(sight - to->sweep->sights);
    if (to->sweep->run->base) return; /* variants have no tables */
    to->tables[id] = (SweepTable){to->first + id, *worst, to->suns, *figures};
}

/* A variant's figures, whose tables nobody needs, last as long as the scratch. asked: the
 * sight with its suns. */
static SunFigures figures_of(SweepReport *to, const Sight *sight, const Sight *asked,
                             ReviewSweep *out) {
    SunFigures *own = &to->figures[sight - to->sweep->sights];
    if (sight->twin != NO_ID) {
        const ReviewSweep *twin = &to->out->review.sweeps[to->first + sight->twin];
        out->failed_minutes = twin->failed_minutes;
        out->failed_share = twin->failed_share;
        out->longest_failure_minutes = twin->longest_failure_minutes;
        return to->figures[sight->twin];
    }
    *own = sun_figures_start(to->suns->count, to->sweep->run->base ? &to->scratch : to->arena);
    sun_figures_judge(to->sweep, asked, to->tools, own, to->scratch);
    set_failures(to, asked, own, out);
    return *own;
}

static bool report_sight(SweepReport *to, const Sight *sight, const Sight *asked, Error *err) {
    Review *review = &to->out->review;
    ReviewSweep sweep = sweep_of(to, sight);
    Arena before = to->scratch;
    if (sight->probe.aim.target_count) {
        SunFigures figures = figures_of(to, sight, asked, &sweep);
        SweepSun worst = {0};
        if (review_eye_is_wide(sight->eye) && figures.worst >= 0)
            sweep.middle_contrast = (double)figures.contrast[figures.worst];
        if (!find_worst(to, sight, &figures, &worst, &sweep.worst, err)) return false;
        sweep.worst.symbol = sweep.symbol;
        add_table(to, sight, &figures, &worst);
    }
    if (!sight->has_twin) to->scratch = before;
    review->sweeps[to->first + (int)(sight - to->sweep->sights)] = sweep;
    return true;
}

/* Symbol by symbol, so that what its eyes share is at hand. A sight's suns are sampled, and
 * forgotten when it is reported. */
static bool report_sights(SweepReport *to, Arena room, Error *err) {
    Sweep *sweep = to->sweep;
    int symbols = sweep->symbol_count;
    for (int i = 0; i < sweep->sight_count; i++) {
        int eyes = sweep->sight_count / symbols;
        const Sight *sight = &sweep->sights[i % eyes * symbols + i / eyes];
        Arena of_sight = room;
        Sight asked = *sight;
        if (!review_goes_on(err)) return false;
        if (sight->twin == NO_ID) asked = sweep_sample_sight(sweep, sight, &of_sight);
        if (!report_sight(to, sight, &asked, err)) return false;
        progress_update(sweep->run->progress, sweep->run->progress->done + 1);
    }
    return true;
}

static void keep_tables(const SweepReport *to) {
    ReviewOutcome *out = to->out;
    for (int i = 0; i < to->sweep->sight_count; i++)
        if (to->tables[i].suns) out->tables[out->table_count++] = to->tables[i];
}

/* ---- all of it --------------------------------------------------------------------------- */

static void report_responses(const Sweep *sweep, Arena *arena, ReviewOutcome *out) {
    Review *review = &out->review;
    for (int i = 0; i < sweep->call_count; i++) {
        const ResponseArgs *args = &sweep->calls[i];
        const Response *response = &args->probe->response;
        review->responses[review->response_count++] =
            (ReviewResponse){arena_string(arena, args->name, strlen(args->name)),
                             arena_string(arena, args->shown, strlen(args->shown)), response->paths,
                             (long)args->file.bytes, response->relative_error};
        out->responses_kept += args->is_kept;
    }
}

static bool make_skies(Sweep *sweep, Arena *scratch, Error *err) {
    const Setup *setup = sweep->setup;
    double low = 90, high = -90;
    sweep->has_hours = setup->condition->weather_id != NO_ID;
    if (sweep->has_hours && !sweep_weather_skies(setup, &sweep->suns, scratch, &sweep->hours, err))
        return false;
    for (int i = 0; i < sweep->suns.count; i++) {
        low = fmin(low, sweep->suns.list[i].elevation_deg);
        high = fmax(high, sweep->suns.list[i].elevation_deg);
    }
    DaylightInput like = air_of(setup->condition);
    like.has_time = false;
    like.threads = setup->tools.threads;
    sweep->table = sky_table_start(&like, low, high, scratch);
    MomentGuide *shared = sweep->run->means.moment_guide;
    if (shared && (sweep->run->request->variant_count || sweep->run->base))
        sweep->table.kept = &shared->skies;
    if (setup->condition->kind == CONDITION_SUN_SWEEP) {
        const ReviewRange *azimuths = &setup->condition->azimuth_deg;
        double heading = sweep->suns.list[0].heading_deg; /* of all of them */
        sky_table_between(&sweep->table, azimuths->first - heading, azimuths->last - heading);
    }
    return true;
}

bool sweep_check(const ReviewRequest *request, int condition_id, Arena scratch, Error *err) {
    const ReviewCondition *condition = &request->conditions[condition_id];
    const char *place = arena_format(&scratch, "/conditions/%d", condition_id);
    SweepSuns suns = sweep_suns(condition, 1, &scratch);
    if (!suns.count)
        return error_at(err, ERROR_INPUT, request->file, place,
                        "the sun is never up: required: a time or a place with some");
    return condition->weather_id == NO_ID ||
           sweep_weather_check(request, condition, &suns, scratch, err);
}

/* Responses that are to be traced, then sights. */
static int steps_of(const Sweep *sweep) {
    int steps = sweep->sight_count;
    for (int i = 0; i < sweep->call_count; i++) steps += !sweep->calls[i].is_kept;
    return steps;
}

static void set_level(Sweep *sweep) {
    const ReviewRequest *request = sweep->run->request;
    const ReviewCondition *condition = sweep->setup->condition;
    bool has_level = condition->level_id != NO_ID;
    sweep->level = has_level ? &request->levels[condition->level_id] : NULL;
    sweep->sensor =
        has_level && sweep->level->is_curve ? &sweep->sensors[condition->level_id] : NULL;
}

/* Its probes are made. */
static bool sweep_suns_of(Sweep *sweep, Arena scratch, Arena *arena, ReviewOutcome *out,
                          Error *err) {
    SweepSuns *suns = ARENA_NEW(arena, SweepSuns, 1);
    sweep->suns = *suns = sweep_suns(sweep->setup->condition, sweep->run->means.threads, arena);
    set_level(sweep);
    if (!make_skies(sweep, &scratch, err)) return false;
    if (!sweep_sample_light(sweep, &scratch, err)) return false;
    DistantTools tools = sweep_tools(sweep);
    SweepReport to = {.sweep = sweep,
                      .tools = &tools,
                      .suns = suns,
                      .out = out,
                      .arena = arena,
                      .first = out->review.sweep_count,
                      .scratch = sweep->figures,
                      .figures = ARENA_NEW(&scratch, SunFigures, sweep->sight_count),
                      .tables = ARENA_NEW(&scratch, SweepTable, sweep->sight_count)};
    if (!sweep->run->base) false_sun_times(sweep, scratch, arena, &out->review);
    if (!report_sights(&to, scratch, err)) return false;
    keep_tables(&to);
    out->review.sweep_count += sweep->sight_count;
    return true;
}

static bool sweep_all(Sweep *sweep, Arena *scratch, Arena *arena, ReviewOutcome *out, Error *err) {
    if (!sweep_place_probes(sweep, scratch, err)) return false;
    rests_add_masks(sweep->symbols, sweep->symbol_count, &out->review, arena);
    sweep->run->progress->total = steps_of(sweep);
    if (!sweep_make_probes(sweep, scratch, err)) return false;
    report_responses(sweep, arena, out);
    return sweep_suns_of(sweep, *scratch, arena, out, err);
}

bool run_sweep(const ReviewRun *run, Setup *setup, Arena *arena, ReviewOutcome *out, Error *err) {
    Arena scratch = arena_reserve(SWEEP_BYTES);
    Sweep sweep = {.run = run,
                   .setup = setup,
                   .figures = arena_reserve(SWEEP_BYTES),
                   .between = arena_reserve(SWEEP_BYTES)};
    bool ok = sweep_all(&sweep, &scratch, arena, out, err);
    arena_release(&sweep.between);
    arena_release(&sweep.figures);
    arena_release(&scratch);
    return ok;
}
