/* SPDX-License-Identifier: Apache-2.0 */
/* bench_coverage WAYS RUNS REVIEW.json -- how often the 95 % intervals of a moment's numbers
 * hold the true value: of each moment the first symbol as the first eye sees it, RUNS seeds.
 * coverage.py makes the reviews and a table of what is printed (coverage_trials.h).
 *
 * WAYS, letters: r readings of 1,024 paths, c cases of 4,096 paths, a cases whose paths hang on
 * a limit at 1, 1.02, 1.1, 1.25 and 2 times what is reflected, e what explain reports, m what
 * measure reports of a small frame of the symbol. */
#include <string.h>

#include "coverage_trials.h"
#include "film/film_frame.h"
#include "measure/measure.h"
#include "render/render.h"
#include "review/request/request_read.h"
#include "review/run/cases.h"
#include "review/light/setup.h"
#include "review/chain/causes.h"

#define READ_PATHS 1024
#define CASE_PATHS 4096
#define EXPLAIN_PATHS 4096
#define NEVER 1e-9     /* a precision that no reading reaches */
#define TOLERANCE 0.02 /* of the contrast, where no limit decides before */
#define CLEAR 0.05
#define ASKED_MOST 16384
#define FRAME_WIDTH 12
#define FRAME_HEIGHT 8
#define FRAME_SAMPLES 32
#define FRAME_DEG 0.5

typedef struct Moment {
    ReviewRequest *request; /* whose seed and precision are the trials' */
    Setup *setup;
    const SetupSymbol *symbol;
    ProbeAim aim;
    const char *name;
    int runs;
    Arena scratch;
} Moment;

/* ---- readings ---------------------------------------------------------------------------- */

static void cover_readings(const Moment *m, Arena arena) {
    ReadingGoal goal = {.most = READ_PATHS};
    int count = 2 * m->runs;
    Trial *list = ARENA_NEW(&arena, Trial, count);
    PathContext without = m->setup->context;
    ProbeAim aim = m->aim;
    without.without_mirrored_sun = true; /* cases add it */
    aim.context = &without;
    for (int i = 0; i < count; i++) {
        aim.seed = 1000 + (uint32_t)i;
        Reading r = reading_take(&aim, &goal, &m->setup->tools, m->scratch);
        list[i] = (Trial){r.reflected, r.interval.low, r.interval.high, (double)r.paths};
    }
    trials_report(m->name, "reading of 1,024 paths", list, count, trials_mean(list, count));
}

/* ---- cases ------------------------------------------------------------------------------- */

/* What a review says with so many seeds. */
static Trial *cases_under(const Moment *m, const Profile *profile, unsigned seed, Arena *arena) {
    Trial *list = ARENA_NEW(arena, Trial, m->runs);
    CaseTools tools = {.setup = m->setup, .profile = profile};
    for (int i = 0; i < m->runs; i++) {
        Arena room = m->scratch;
        ReviewCase c = {.display_lux = 1000};
        Error err = {0};
        m->request->seed = seed + (unsigned)i;
        if (!setup_verdict(&tools, m->symbol, &m->request->eyes[0], &room, &c, &err))
            trials_stop(&err);
        list[i] = (Trial){c.luminance_cd_m2.reflected, c.reflected_range.low,
                          c.reflected_range.high, (double)c.paths};
    }
    return list;
}

static double contrast_at(const Moment *m, double reflected) {
    SymbolLook look = {&m->symbol->surface, &m->symbol->split, m->aim.eye, m->setup->tools.threads,
                       NULL};
    double level = (double)m->setup->scene->displays[m->symbol->display.display_id].level;
    SymbolEmission shown = symbol_emission(&look, level);
    return luminance_contrast(shown.xyz[SYMBOL_FOREGROUND][1], shown.xyz[SYMBOL_BACKGROUND][1],
                              reflected);
}

static Truth cover_cases(const Moment *m, Arena arena) {
    Profile open = {.id = "none"};
    m->request->precision_contrast = m->request->precision_clear = NEVER;
    m->request->precision_paths = CASE_PATHS;
    Trial *list = cases_under(m, &open, 1u << 20, &arena);
    Truth truth = trials_mean(list, m->runs);
    trials_report(m->name, "case of 4,096 paths", list, m->runs, truth);
    return truth;
}

static void cover_asked(const Moment *m, Truth truth, Arena arena) {
    static const double limits[] = {1, 1.02, 1.1, 1.25, 2};
    m->request->precision_contrast = TOLERANCE;
    m->request->precision_clear = CLEAR;
    m->request->precision_paths = ASKED_MOST;
    for (int k = 0; k < 5; k++) {
        char what[64];
        ProfileLimit limit = {.name = "limit",
                              .kind = LIMIT_CONTRAST_RATIO,
                              .ambients = {true, true, true, true},
                              .value = contrast_at(m, limits[k] * truth.value)};
        Profile profile = {.id = "one", .limits = &limit, .limit_count = 1};
        Arena room = arena;
        Trial *list = cases_under(m, &profile, (unsigned)(k + 2) << 20, &room);
        snprintf(what, sizeof what, "case, limit at %g", limits[k]);
        trials_report(m->name, what, list, m->runs, truth);
    }
}

/* ---- explain ----------------------------------------------------------------------------- */

static Trial trial_of(ChainFigure figure, long paths) {
    return (Trial){figure.cd_m2, figure.low, figure.high, (double)paths};
}

static const Chain *find_chain(const Chains *chains, const ChainKey *key) {
    for (int i = 0; i < chains->count; i++)
        if (!memcmp(&chains->list[i].key, key, sizeof *key)) return &chains->list[i];
    return NULL;
}

/* All of it, and the cause that was the greatest in the first run: its light and its share. */
static void cover_explain(const Moment *m, Arena arena) {
    Trial *all = ARENA_NEW(&arena, Trial, m->runs), *one = ARENA_NEW(&arena, Trial, m->runs);
    ProbeAim aim = m->aim;
    ChainKey key;
    int found = 0;
    ChainArgs args = {
        .aim = &aim, .tools = &m->setup->tools, .paths = EXPLAIN_PATHS, .most = CAUSES_MOST};
    memset(&key, 0, sizeof key);
    for (int i = 0; i < m->runs; i++) {
        Arena room = m->scratch;
        aim.seed = 7000 + (uint32_t)i;
        Chains chains = chains_find(&args, &room);
        all[i] = trial_of(chains.all, chains.paths);
        if (i == 0 && chains.count) key = chains.list[0].key;
        const Chain *chain = find_chain(&chains, &key);
        if (chain) one[found++] = trial_of(chain->figure, chains.paths);
    }
    trials_report(m->name, "explain: all", all, m->runs, trials_mean(all, m->runs));
    if (found > m->runs / 2)
        trials_report(m->name, "explain: greatest cause", one, found, trials_mean(one, found));
}

/* ---- measure ----------------------------------------------------------------------------- */

static Trial trial_of_measured(Measured figure) {
    return (Trial){figure.value, figure.low, figure.high, FRAME_SAMPLES};
}

static FrameMeasurement measure_once(const Moment *m, const RenderSetup *setup,
                                     RenderOptions *options, uint32_t seed) {
    Arena room = m->scratch;
    RenderResult result;
    FrameMeasurement measured;
    MeasureRequest request = {.frame_name = "frame"};
    Error err = {0};
    options->seed = seed;
    if (!render_prepared(setup, options, &room, &result, &err)) trials_stop(&err);
    FrameImage frame = film_to_frame(result.film, 8, &room);
    if (!measure_frame(&frame, &request, room, &measured, &err)) trials_stop(&err);
    return measured;
}

static RenderOptions frame_options(const Moment *m) {
    return (RenderOptions){.width = FRAME_WIDTH,
                           .height = FRAME_HEIGHT,
                           .crop = {0, 0, FRAME_WIDTH, FRAME_HEIGHT},
                           .end_sample = FRAME_SAMPLES,
                           .max_bounces = SETUP_BOUNCES,
                           .threads = 1,
                           .layers = LAYER_VARIANCE | LAYER_HALVES | LAYER_DISPLAYS | LAYER_ID,
                           .progress = PROGRESS_NONE,
                           .no_guiding = !m->setup->context.guide};
}

static void cover_measure(const Moment *m, Arena arena) {
    Trial *light = ARENA_NEW(&arena, Trial, m->runs);
    Trial *ratio = ARENA_NEW(&arena, Trial, m->runs);
    double reflected = 0;
    Error err = {0};
    FrameMeasurement f = {.pixels = 0};
    RenderSetup setup;
    RenderOptions options = frame_options(m);
    SceneCamera camera = camera_look_at(m->aim.eye, symbol_middle(m->symbol).position,
                                        (float)(FRAME_DEG * 3.14159265 / 180));
    if (!render_prepare(m->setup->scene, &camera, &options, &arena, &setup, &err))
        trials_stop(&err);
    for (int i = 0; i < m->runs; i++) {
        f = measure_once(m, &setup, &options, 100 + (uint32_t)i);
        light[i] = trial_of_measured(f.luminance);
        ratio[i] = trial_of_measured(f.contrast);
        reflected += f.reflected / m->runs;
    }
    trials_report(m->name, "measure: luminance", light, m->runs, trials_mean(light, m->runs));
    Truth truth = {(f.white + reflected) / (f.black + reflected), 0};
    if (f.has_contrast) trials_report(m->name, "measure: contrast", ratio, m->runs, truth);
    render_setup_end(&setup);
}

/* ---- moments ----------------------------------------------------------------------------- */

static void cover(const Moment *m, const char *ways, Arena arena) {
    Truth truth = {0, 0};
    if (strchr(ways, 'r')) cover_readings(m, arena);
    if (strpbrk(ways, "ca")) truth = cover_cases(m, arena);
    if (strchr(ways, 'a')) cover_asked(m, truth, arena);
    if (strchr(ways, 'e')) cover_explain(m, arena);
    if (strchr(ways, 'm')) cover_measure(m, arena);
}

static void cover_moment(ReviewRequest *request, const ReviewCondition *c, const char *ways,
                         int runs, Problems *problems) {
    SetupOptions options = {
        .request = request, .condition = c, .means = {.root = "/", .threads = 1}};
    Arena arena = arena_reserve((size_t)1 << 36);
    Setup setup;
    SetupSymbol *symbols;
    int count;
    Vec3 eye;
    Error err = {0};
    request->seed = 0;
    if (!setup_open(&options, &arena, problems, &setup, &err) ||
        !setup_light(&setup, NULL, &arena, &err) ||
        !setup_symbols(&setup, &arena, &symbols, &count, &err) ||
        !setup_learn(&setup, symbols, count, &arena, &err) ||
        !setup_eye_middle(&setup, &request->eyes[0], arena, &eye, &err))
        trials_stop(&err);
    const SymbolSurface *surface = &symbols[0].surface;
    Moment m = {request,
                &setup,
                &symbols[0],
                {.context = &setup.context, .eye = eye},
                c->name,
                runs,
                arena_reserve((size_t)1 << 33)};
    symbol_aim(surface, &arena, &m.aim);
    if (m.aim.target_count) cover(&m, ways, arena);
    arena_release(&m.scratch);
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
        fprintf(stderr, "bench_coverage WAYS RUNS REVIEW.json\n");
        return 1;
    }
    if (!review_request_read(argv[3], "/", &arena, &problems, &request, &err)) trials_stop(&err);
    for (int i = 0; i < request.condition_count; i++)
        if (request.conditions[i].kind == CONDITION_MOMENT)
            cover_moment(&request, &request.conditions[i], argv[1], runs, &problems);
    arena_release(&arena);
    return 0;
}
