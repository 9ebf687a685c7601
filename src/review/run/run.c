/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/run.h"

#include <string.h>

#include "render/identity.h"
#include "review/chain/remedies.h"
#include "review/keep/frame_kept.h"
#include "review/request/request_check.h"
#include "review/review_decide.h"
#include "review/road_verdict.h"
#include "review/run/cases.h"
#include "review/run/false_sun_times.h"
#include "review/run/gazes.h"
#include "review/run/pane_findings.h"
#include "review/run/rests.h"
#include "review/run/sweep.h"
#include "review/run/sweep_probes.h"
#include "review/run/sweep_weather.h"
#include "scene/load/material_data.h"
#include "text/text.h"

/* The most address space that a setup takes; what is not touched costs nothing. */
#define SETUP_BYTES ((size_t)1 << 36)

/* Of one condition. */
static int most_cases(const ReviewRequest *request) {
    return request->eye_count * request->symbol_count * SYMBOLS_FOUND_MOST;
}

/* A response for each sight, face and sensor. */
static int most_responses(const ReviewRequest *request) {
    return most_cases(request) + request->symbol_count * SYMBOLS_FOUND_MOST + request->level_count;
}

/* Names of symbols that were found live in the setup's memory. */
static void keep_names(ReviewCase *cases, int count, Arena *arena) {
    for (int i = 0; i < count; i++)
        cases[i].symbol = arena_string(arena, cases[i].symbol, strlen(cases[i].symbol));
}

static bool run_moment(const ReviewRun *run, Setup *setup, Arena *scratch, Arena *arena,
                       ReviewOutcome *out, Error *err) {
    Review *review = &out->review;
    CaseTools tools = {
        .setup = setup, .profile = run->profile, .progress = run->progress, .base = run->base};
    SetupSymbol *symbols;
    if (!setup_light(setup, NULL, scratch, err) ||
        !setup_symbols(setup, scratch, &symbols, &tools.symbol_count, err))
        return false;
    tools.symbols = symbols;
    rests_add_masks(symbols, tools.symbol_count, review, arena);
    int count = tools.symbol_count * run->request->eye_count;
    int look_count = run->base ? 0 : review_look_count(run->request);
    run->progress->total = count + look_count;
    if (!setup_learn(setup, symbols, tools.symbol_count, scratch, err)) return false;
    ReviewCase *cases = review->cases + review->case_count;
    if (!setup_cases(&tools, arena, cases, err)) return false;
    keep_names(cases, count, arena);
    review->case_count += count;
    /* of a variant only the roads' increments: nothing else of its gazes has a limit */
    GazesArgs looks = {setup, run->sun_searches, run->profile, cases, count, run->base != NULL};
    if (!setup_gazes(&looks, arena, review, err)) return false;
    progress_update(run->progress, count + look_count);
    return run->base || !run->request->pane_images ||
           setup_pane_images(setup, run->profile, arena, review, err);
}

/* The roads of a sweep, as it is after dark: with its lamps, displays and levels, but
 * without sun and sky. */
static bool run_after_dark(const ReviewRun *run, const ReviewCondition *condition, Arena *arena,
                           ReviewOutcome *out, Error *err) {
    SetupOptions options = {run->request, condition, run->means};
    Review *review = &out->review;
    int first = review->gaze_count;
    if (run->base || !sweep_has_roads(run->request, condition)) return true;
    Arena scratch = arena_reserve(SETUP_BYTES);
    Setup setup;
    bool ok = setup_open(&options, &scratch, run->problems, &setup, err);
    if (ok) {
        Environment dark = setup.scene->environment;
        GazesArgs looks = {&setup, run->sun_searches, run->profile, NULL, 0, true};
        dark.kind = ENVIRONMENT_NONE;
        dark.has_sun = false;
        ok = setup_light(&setup, &dark, &scratch, err) && setup_gazes(&looks, arena, review, err);
        for (int i = first; i < review->gaze_count; i++)
            review->gazes[i].road->is_after_dark = true;
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

/* Do two conditions have one scene? */
static bool same_scene(const ReviewRequest *request, const ReviewCondition *a,
                       const ReviewCondition *b) {
    if (a->with_id != b->with_id || a->light_count != b->light_count ||
        a->content_count != b->content_count ||
        memcmp(a->polarity, b->polarity, (size_t)request->symbol_count * sizeof *a->polarity) != 0)
        return false;
    for (int i = 0; i < a->light_count; i++)
        if (strcmp(a->lights[i], b->lights[i]) != 0) return false;
    for (int i = 0; i < a->content_count; i++)
        if (strcmp(a->contents[i].display, b->contents[i].display) != 0 ||
            strcmp(a->contents[i].path, b->contents[i].path) != 0)
            return false;
    return true;
}

bool review_scene_comes_again(const ReviewRun *run, int condition_id) {
    const ReviewCondition *c = run->request->conditions;
    for (int i = condition_id + 1; i < run->request->condition_count; i++)
        if (review_is_wanted(run, i) && same_scene(run->request, &c[condition_id], &c[i]))
            return true;
    return false;
}

bool review_check(const ReviewRequest *request, Arena scratch, Error *err) {
    for (int i = 0; i < request->condition_count; i++)
        if (request->conditions[i].kind != CONDITION_MOMENT &&
            !sweep_check(request, i, scratch, err))
            return false;
    return true;
}

/* Keeps the list of the scene that has most of them. */
static void report_without_data(const Scene *scene, Review *review, Arena scratch, Arena *arena) {
    int count;
    int *list = scene_without_data(scene, &count, &scratch);
    if (count <= review->without_data_count) return;
    review->without_data_count = count;
    review->without_data = scene_names_of(scene, list, count, arena);
}

static bool run_condition(const ReviewRun *run, const ReviewCondition *condition, Arena *arena,
                          ReviewOutcome *out, Error *err) {
    SetupOptions options = {run->request, condition, run->means};
    Arena scratch = arena_reserve(SETUP_BYTES);
    Setup setup;
    bool ok = setup_open(&options, &scratch, run->problems, &setup, err);
    if (ok) {
        report_without_data(setup.scene, &out->review, scratch, arena);
        rests_add_scene(run->request, setup.scene, &out->review, arena);
        rests_add_scene_files(setup.scene, &out->review, arena);
        ok = (!run->news.read || run->news.read(run->news.user, setup.scene, err)) &&
             (review_request_check(run->request, setup.scene, run->problems) ||
              problems_verdict(run->problems, err)) &&
             (condition->kind == CONDITION_MOMENT
                  ? run_moment(run, &setup, &scratch, arena, out, err)
                  : run_sweep(run, &setup, arena, out, err));
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

static void start(const ReviewRequest *request, ReviewOutcome *out, Arena *arena) {
    int most = most_cases(request);
    *out = (ReviewOutcome){.tables = ARENA_NEW(arena, SweepTable, most)};
    out->review = (Review){
        .cases = ARENA_NEW(arena, ReviewCase, most),
        .sweeps = ARENA_NEW(arena, ReviewSweep, most),
        .gazes = ARENA_NEW(arena, GazeFinding, review_look_count(request)),
        .responses = ARENA_NEW(arena, ReviewResponse, most_responses(request)),
        .false_suns = ARENA_NEW(arena, ReviewFalseSun, request->eye_count * FALSE_SUNS_LISTED)};
}

/* Progress counts what of it is read. */
bool review_run_condition(const ReviewRun *run, int condition_id, Arena *arena, ReviewOutcome *out,
                          Error *err) {
    const ReviewCondition *condition = &run->request->conditions[condition_id];
    int steps = review_condition_steps(run->request, condition);
    Progress part = progress_part(run->progress, steps, steps);
    ReviewRun own = *run;
    own.progress = &part;
    start(run->request, out, arena);
    if (!review_goes_on(err) || !run_condition(&own, condition, arena, out, err) ||
        (condition->kind != CONDITION_MOMENT &&
         !run_after_dark(&own, condition, arena, out, err)) ||
        !review_goes_on(err)) /* else its last reading may be cut off */
        return false;
    remedies_judge(run->profile, &out->review, arena);
    progress_end(&part, part.total);
    return true;
}

/* ---- what is there ----------------------------------------------------------------------- */

/* All moments, or all sweeps, of one scene: they need the same, and are done as the first
 * is. */
static void mark_scene(const ReviewRequest *request, int first, int *done_by) {
    const ReviewCondition *c = request->conditions;
    bool is_moment = c[first].kind == CONDITION_MOMENT;
    for (int i = first; i < request->condition_count; i++)
        if (done_by[i] < 0 && (c[i].kind == CONDITION_MOMENT) == is_moment &&
            same_scene(request, &c[first], &c[i]))
            done_by[i] = first;
}

/* A moment has symbols, but needs no response. */
static bool plan_condition(const ReviewRun *run, const ReviewCondition *condition, ReviewPlan *plan,
                           Error *err) {
    SetupOptions options = {run->request, condition, run->means};
    Arena scratch = arena_reserve(SETUP_BYTES);
    Setup setup;
    bool ok = setup_open(&options, &scratch, run->problems, &setup, err);
    if (ok) {
        Sweep sweep = {.run = run, .setup = &setup};
        SetupSymbol *symbols;
        int count;
        ok = (review_request_check(run->request, setup.scene, run->problems) ||
              problems_verdict(run->problems, err)) &&
             (condition->kind == CONDITION_MOMENT
                  ? setup_symbols(&setup, &scratch, &symbols, &count, err)
                  : sweep_place_probes(&sweep, &scratch, err));
        plan->responses += sweep.call_count;
        for (int i = 0; i < sweep.call_count; i++) plan->responses_kept += sweep.calls[i].is_kept;
        setup_close(&setup);
    }
    arena_release(&scratch);
    return ok;
}

bool review_plan(const ReviewRun *run, Arena *arena, ReviewPlan *out, Error *err) {
    const ReviewRequest *request = run->request;
    int count = request->condition_count;
    int *done_by = ARENA_NEW(arena, int, count);
    *out = (ReviewPlan){0};
    for (int i = 0; i < count; i++) done_by[i] = -1;
    for (int i = 0; i < count; i++) {
        if (done_by[i] >= 0 || !review_is_wanted(run, i)) continue;
        mark_scene(request, i, done_by);
        if (!plan_condition(run, &request->conditions[i], out, err)) return false;
    }
    return true;
}

/* ---- what a reader must know ------------------------------------------------------------- */

static void add_note(Review *review, const char ***notes, const char *text) {
    (*notes)[review->note_count++] = text;
    review->notes = *notes;
}

static bool has_sweeps(const ReviewRun *run) {
    for (int i = 0; i < run->request->condition_count; i++)
        if (review_is_wanted(run, i) && run->request->conditions[i].kind != CONDITION_MOMENT)
            return true;
    return false;
}

static bool has_boxes(const ReviewRequest *request) {
    for (int i = 0; i < request->eye_count; i++)
        if (review_eye_is_wide(&request->eyes[i])) return true;
    return false;
}

static bool takes_lux(const ReviewRequest *request, int weather_id, WeatherLux lux) {
    for (int i = 0; i < request->condition_count; i++) {
        const ReviewCondition *condition = &request->conditions[i];
        if (condition->weather_id == weather_id && condition->weather_lux == lux) return true;
    }
    return false;
}

static void add_weather_notes(const ReviewRequest *request, int weather_id, Review *review,
                              const char ***notes, Arena *arena) {
    const ReviewWeather *weather = &request->weathers[weather_id];
    add_note(review, notes, sweep_weather_note(weather, arena));
    for (int lux = WEATHER_LUX_PEREZ; lux <= WEATHER_LUX_FILE; lux++)
        if (takes_lux(request, weather_id, (WeatherLux)lux))
            add_note(review, notes, sweep_weather_lux_note(weather, (WeatherLux)lux, arena));
}

static void add_glasses_notes(const ReviewRequest *request, Review *review, const char ***notes,
                              Arena *arena) {
    for (int i = 0; i < request->condition_count; i++) {
        const ReviewCondition *c = &request->conditions[i];
        if (!c->glasses) continue;
        add_note(review, notes,
                 arena_format(
                     arena,
                     "%s: seen through %s. They darken display, reflections and the veil in the "
                     "eye by one factor, which leaves contrasts; figures in cd/m2 are told "
                     "without it, grey steps and visibility with it. Limits are those of the naked "
                     "eye. Pictures and gazes are without them%s.",
                     c->name, c->glasses->words,
                     c->glasses->is_polarising ? ", and causes as unpolarised light" : ""));
    }
}

static bool has_private_night(const Review *review) {
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (c->must_not_be_read && c->ambient == AMBIENT_NIGHT) return true;
    }
    return false;
}

/* By what it is judged, and whether its worst light was among the conditions. */
static void add_privacy_notes(const ReviewRun *run, Review *review, const char ***notes,
                              Arena *arena) {
    const ProfileLimit *limit = &run->profile->security;
    if (!review_has_private(run->request)) return;
    add_note(review, notes,
             arena_format(
                 arena,
                 "What must not be read is judged by its visual security S = log10 V, "
                 "V = (Y + R)/(Y - K) (US 11,106,103 B2): Y and K are its brighter and its darker "
                 "part's own light to that eye, R what the display reflects in the part of the "
                 "symbol that reflects least. The eye's veil does not count, and it passes by no "
                 "size: who leans forward reads smaller letters. Where the profile limits nothing "
                 "S is to be at least %.4g (%s).",
                 limit->value, limit->source));
    if (!has_private_night(review))
        add_note(review, notes,
                 "What must not be read is read best in a dark night: no case of it is by "
                 "night, so that its worst light was not reviewed.");
}

void review_add_notes(const ReviewRun *run, Review *review, Arena *arena) {
    const ReviewRequest *request = run->request;
    const char **notes =
        ARENA_NEW(arena, const char *, 3 * request->weather_count + 7 + request->condition_count);
    if (has_sweeps(run)) {
        add_note(review, &notes,
                 "Sweeps: skies are clear, or those of a weather file where one is named; "
                 "light that comes by a second surface, glints via chrome or glass "
                 "among it, is a mean over about 3 degrees of the sun's place. Of a symbol's "
                 "parts the direct sun tells the worst; all other light of a step is the "
                 "symbol's mean. The worst case of each sweep is traced by itself.");
        if (profile_has(run->profile, LIMIT_VISIBILITY_LEVEL))
            add_note(review, &notes,
                     "Sweeps: the steps' visibility levels are without the veil in the eye; "
                     "the worst case has it.");
        if (has_boxes(request))
            add_note(review, &notes, "Sweeps: an eye box or ellipse counts by its middle.");
        if (review_look_count(request))
            add_note(review, &notes,
                     "Sweeps: of gazes that do not go to symbols only the sun in "
                     "mirrors is read; all else of them is in moments.");
    }
    for (int i = 0; i < request->weather_count; i++)
        add_weather_notes(request, i, review, &notes, arena);
    add_glasses_notes(request, review, &notes, arena);
    add_privacy_notes(run, review, &notes, arena);
}
