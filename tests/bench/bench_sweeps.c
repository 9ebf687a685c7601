/* SPDX-License-Identifier: Apache-2.0 */
/* bench_sweeps WAYS RUNS REVIEW.json -- how often the 95 % intervals of a sweep's numbers hold
 * the true value: of the first sweep of REVIEW.json the first symbol as the first eye sees it,
 * RUNS seeds of everything. Printed as coverage_trials.h says.
 *
 * WAYS, letters: s steps of the fewest paths, f of as many as a review takes, which cells of a
 * map and hours of a year are, b the first beside a moment's truth, w the worst of them, chosen
 * by each seed's own steps and read again as a moment, as run/sweep.c does. The truth of a step
 * is the mean of all runs, so that what is reported is the interval alone; b has its offset
 * from the moment's truth, which triangles make, too. b and w take most of the time. */
#include <string.h>

#include "base/units.h"
#include "coverage_trials.h"
#include "review/request/request_read.h"
#include "review/run/sweep.h"
#include "review/light/setup.h"
#include "review/run/sweep_probes.h"

#define STEP_PATHS 4224  /* a pilot and a wave of every group */
#define FULL_PATHS 65536 /* at most, as a review's: */
#define FULL_PRECISION 0.004
#define TRUTH_PATHS 65536
#define TRUTH_RUNS 4
#define WORST_PATHS 4096
#define NEVER 1e-9

typedef struct SweepTrials {
    ReviewRequest *request;
    Setup *setup;
    const SetupSymbol *symbol;
    ProbeAim aim;
    SkyTable table;
    SweepSuns suns;
    int runs;
    Arena scratch;
} SweepTrials;

/* What paths say of one sun, as a review does of a moment. */
static Trial moment_trial(const SweepTrials *t, int sun, int paths, unsigned seed) {
    Arena room = t->scratch;
    Setup setup = *t->setup;
    Profile open = {.id = "none"};
    CaseTools tools = {.setup = &setup, .profile = &open};
    ReviewCase c = {.display_lux = 1000};
    Environment light = sweep_environment(t->setup, &t->suns.list[sun]);
    Environment dark = setup.scene->environment;
    Error err = {0};
    t->request->precision_contrast = t->request->precision_clear = NEVER;
    t->request->precision_paths = paths;
    t->request->seed = seed;
    if (!setup_light(&setup, &light, &room, &err) ||
        !setup_verdict(&tools, t->symbol, &t->request->eyes[0], &room, &c, &err))
        trials_stop(&err);
    setup.scene->environment = dark;
    return (Trial){c.luminance_cd_m2.reflected, c.reflected_range.low, c.reflected_range.high,
                   (double)c.paths};
}

/* Of every sun, all by one seed's response. */
static void read_steps(SweepTrials *t, bool is_full, double own, unsigned seed, Trial *out) {
    Arena room = t->scratch;
    DistantTools tools = {.setup = t->setup,
                          .table = &t->table,
                          .paths = is_full ? FULL_PATHS : STEP_PATHS,
                          .precision = is_full ? FULL_PRECISION : 0,
                          .suns = {t->suns.distant, t->suns.count},
                          .sun_paths = SYMBOL_POINTS,
                          .has_mirror = true};
    DistantProbe probe = {.aim = t->aim};
    probe.aim.seed = seed;
    distant_probe_respond(&probe, &tools, &room);
    Error err;
    if (!distant_probes_sample_skies((DistantProbe *[]){&probe}, 1, &tools, &room, &err))
        trials_stop(&err);
    distant_probe_sample_suns(&probe, &tools, &room);
    for (int i = 0; i < t->suns.count; i++) {
        DistantReading r = distant_probe_read(&probe, &tools, i);
        out[i] = (Trial){r.sky + r.sun_first + r.sun_rest + own, r.interval.low + own,
                         r.interval.high + own, probe.response.paths};
    }
}

static void read_all_steps(SweepTrials *t, bool is_full, double own, Trial *out) {
    for (int k = 0; k < t->runs; k++)
        read_steps(t, is_full, own, (1u << 20) + (unsigned)k, out + k * t->suns.count);
}

/* ---- what is reported -------------------------------------------------------------------- */

static const char *sun_name(const SweepTrials *t, int sun, Arena *arena) {
    const SweepSun *at = &t->suns.list[sun];
    return arena_format(arena, "sun %.0f, %.0f", at->azimuth_deg, at->elevation_deg);
}

/* truths: NULL: each step's own mean. */
static void tell_steps(const SweepTrials *t, const char *way, const Trial *steps,
                       const Truth *truths, Arena arena) {
    for (int i = 0; i < t->suns.count; i++) {
        Arena room = arena;
        Trial *list = ARENA_NEW(&room, Trial, t->runs);
        for (int k = 0; k < t->runs; k++) list[k] = steps[k * t->suns.count + i];
        const char *name = sun_name(t, i, &room);
        trials_report(name, way, list, t->runs, truths ? truths[i] : trials_mean(list, t->runs));
    }
}

static int worst_of(const Trial *steps, int count) {
    int worst = 0;
    for (int i = 1; i < count; i++)
        if (steps[i].found > steps[worst].found) worst = i;
    return worst;
}

/* Of each run the most reflected light: as a share of that sun's truth. */
static void tell_worst(const SweepTrials *t, const Trial *steps, const Truth *truths, Arena arena) {
    int count = t->suns.count;
    Trial *list = ARENA_NEW(&arena, Trial, t->runs), *step = ARENA_NEW(&arena, Trial, t->runs);
    for (int k = 0; k < t->runs; k++) {
        int sun = worst_of(steps + k * count, count);
        double truth = truths[sun].value;
        Trial r = moment_trial(t, sun, WORST_PATHS, (1u << 22) + (unsigned)k);
        Trial s = steps[k * count + sun];
        list[k] = (Trial){r.found / truth, r.low / truth, r.high / truth, r.paths};
        step[k] = (Trial){s.found / truth, s.low / truth, s.high / truth, s.paths};
    }
    trials_report("all suns", "worst, its step", step, t->runs, (Truth){1, 0});
    trials_report("all suns", "worst, read again", list, t->runs, (Truth){1, 0});
}

static double own_light(const SweepTrials *t) {
    ReadingGoal goal = {.most = TRUTH_PATHS};
    Lights *lights = (Lights *)(void *)t->setup->context.lights;
    if (!lights_has(lights, LIGHTS_EMITTERS) && !lights_has(lights, LIGHTS_PUNCTUAL)) return 0;
    return reading_take(&t->aim, &goal, &t->setup->tools, t->scratch).reflected;
}

/* Of every sun, by paths traced for it. */
static Truth *find_truths(const SweepTrials *t, Arena *arena) {
    Truth *truths = ARENA_NEW(arena, Truth, t->suns.count);
    for (int i = 0; i < t->suns.count; i++) {
        Trial longest[TRUTH_RUNS];
        for (int k = 0; k < TRUTH_RUNS; k++)
            longest[k] = moment_trial(t, i, TRUTH_PATHS, (1u << 21) + (unsigned)k);
        truths[i] = trials_mean(longest, TRUTH_RUNS);
    }
    return truths;
}

static void cover(SweepTrials *t, const char *ways, Arena arena) {
    int count = t->suns.count;
    double own = own_light(t);
    Trial *steps = ARENA_NEW(&arena, Trial, t->runs * count);
    if (strchr(ways, 'f')) {
        read_all_steps(t, true, own, steps);
        tell_steps(t, "step of a review", steps, NULL, arena);
    }
    if (!strpbrk(ways, "sbw")) return;
    read_all_steps(t, false, own, steps);
    if (strchr(ways, 's')) tell_steps(t, "step", steps, NULL, arena);
    if (!strpbrk(ways, "bw")) return;
    Truth *truths = find_truths(t, &arena);
    if (strchr(ways, 'b')) tell_steps(t, "step beside a moment", steps, truths, arena);
    if (strchr(ways, 'w')) tell_worst(t, steps, truths, arena);
}

/* ---- all of it --------------------------------------------------------------------------- */

static void make_table(SweepTrials *t, Arena *arena) {
    DaylightInput air = daylight_input_default(DAYLIGHT_CLEAR);
    double low = 90, high = -90;
    air.threads = 1;
    for (int i = 0; i < t->suns.count; i++) {
        low = fmin(low, t->suns.list[i].elevation_deg);
        high = fmax(high, t->suns.list[i].elevation_deg);
    }
    t->table = sky_table_start(&air, low, high, arena);
}

static void cover_sweep(ReviewRequest *request, const ReviewCondition *c, const char *ways,
                        int runs, Problems *problems) {
    SetupOptions options = {
        .request = request, .condition = c, .means = {.root = "/", .threads = 1}};
    Arena arena = arena_reserve((size_t)1 << 36);
    SweepTrials t = {.request = request, .runs = runs, .scratch = arena_reserve((size_t)1 << 34)};
    Setup setup;
    SetupSymbol *symbols;
    int count;
    Vec3 eye;
    Error err = {0};
    t.setup = &setup;
    if (!setup_open(&options, &arena, problems, &setup, &err) ||
        !sweep_light_dark(&setup, 1, &arena, &err) ||
        !setup_symbols(&setup, &arena, &symbols, &count, &err) ||
        !setup_eye_middle(&setup, &request->eyes[0], arena, &eye, &err))
        trials_stop(&err);
    t.symbol = &symbols[0];
    t.suns = sweep_suns(c, 2, &arena);
    make_table(&t, &arena);
    t.aim = (ProbeAim){.context = &setup.context, .eye = eye};
    symbol_aim(&symbols[0].surface, &arena, &t.aim);
    cover(&t, ways, arena);
    arena_release(&t.scratch);
    setup_close(&setup);
    arena_release(&arena);
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Error err = {0};
    Problems problems = problems_start(&arena);
    ReviewRequest request;
    int runs = argc == 4 ? atoi(argv[2]) : 0;
    if (runs < 2) {
        fprintf(stderr, "bench_sweeps WAYS RUNS REVIEW.json\n");
        return 1;
    }
    if (!review_request_read(argv[3], "/", &arena, &problems, &request, &err)) trials_stop(&err);
    for (int i = 0; i < request.condition_count; i++)
        if (request.conditions[i].kind == CONDITION_SUN_SWEEP) {
            cover_sweep(&request, &request.conditions[i], argv[1], runs, &problems);
            break;
        }
    arena_release(&arena);
    return 0;
}
