/* SPDX-License-Identifier: Apache-2.0 */
/* bench_verdicts TRIALS REVIEW.json -- how often a verdict is wrong: of each moment the first
 * symbol as the first eye sees it, held against limits that leave its true contrast a margin of
 * -10 to 10 %, TRIALS seeds each, by what decides a review's verdicts. verdicts.py makes the
 * reviews. Where the eye must not read the symbol the limit is one of visual security, and the
 * margins are those of S (review/judge.h), six of them; of one that is seen in glass alone they
 * are those of its image.
 *
 * The truth is the mean of 400 longer readings with seeds of their own; printed are its
 * contrast, the error of that in percent, and what is shown, foreground and background. Then of
 * each margin: moment, margin in percent, trials, passes, failures, too close; mean of the
 * paths. */
#include <string.h>

#include "coverage_trials.h"
#include "review/private_image.h"
#include "review/request/request_read.h"
#include "review/run/cases.h"

#define TRUTH_PATHS 16384
#define TRUTH_RUNS 400
#define NEVER 1e-9

typedef struct Verdicts {
    ReviewRequest *request;
    const Setup *setup;
    const SetupSymbol *symbol;
    int trials;
    Arena scratch;
} Verdicts;

static ReviewCase judged(const Verdicts *v, const Profile *profile, unsigned seed) {
    Arena room = v->scratch;
    CaseTools tools = {.setup = v->setup, .profile = profile};
    ReviewCase c = {.display_lux = 1000};
    Error err = {0};
    v->request->seed = seed;
    if (!setup_verdict(&tools, v->symbol, &v->request->eyes[0], &room, &c, &err)) trials_stop(&err);
    return c;
}

static double contrast_in_glass(const CaseImage *image, double mirrored, double against) {
    return luminance_contrast(mirrored * image->sent_foreground, mirrored * image->sent_background,
                              against);
}

/* Of a symbol that the eye sees in the first pane alone: the contrast that the means of the
 * share that is mirrored and of what lies behind make. */
static double true_contrast_in_glass(const Verdicts *v, const Profile *open, Arena arena) {
    Trial *mirrored = ARENA_NEW(&arena, Trial, TRUTH_RUNS);
    Trial *against = ARENA_NEW(&arena, Trial, TRUTH_RUNS);
    CaseImage image = {0};
    for (int i = 0; i < TRUTH_RUNS; i++) {
        ReviewCase c = judged(v, open, (1u << 28) + (unsigned)i);
        image = c.images[0];
        mirrored[i].found = image.reflectance;
        against[i].found = image.against;
    }
    Truth share = trials_mean(mirrored, TRUTH_RUNS), behind = trials_mean(against, TRUTH_RUNS);
    double ratio = contrast_in_glass(&image, share.value, behind.value);
    double off = contrast_in_glass(&image, share.value + share.error, behind.value - behind.error);
    printf("%s\ttruth\t%.5f\t%.4f\n", v->setup->condition->name, ratio,
           100 * fabs(off / ratio - 1));
    fflush(stdout);
    return ratio;
}

/* The contrast that the mean of the reflected light makes. */
static double true_contrast(const Verdicts *v, Arena arena) {
    ReviewRequest *r = v->request, asked = *r;
    Profile open = {.id = "none", .security = {.kind = LIMIT_VISUAL_SECURITY, .value = 1}};
    Trial *list = ARENA_NEW(&arena, Trial, TRUTH_RUNS);
    CaseLuminances l = {0};
    CaseBox part = {0};
    ReviewCase first = judged(v, &open, 1u << 28);
    if (first.image_count && !(first.visible_share > 0))
        return true_contrast_in_glass(v, &open, arena);
    r->precision_contrast = r->precision_clear = NEVER;
    r->precision_paths = TRUTH_PATHS;
    for (int i = 0; i < TRUTH_RUNS; i++) {
        ReviewCase c = judged(v, &open, (1u << 28) + (unsigned)i);
        l = c.luminance_cd_m2;
        part = c.whole.part; /* the same of all seeds */
        list[i].found = l.reflected;
    }
    *r = asked;
    Truth truth = trials_mean(list, TRUTH_RUNS);
    double ratio = luminance_contrast(l.foreground, l.background, truth.value);
    double off = luminance_contrast(l.foreground, l.background, truth.value + truth.error);
    printf("%s\ttruth\t%.5f\t%.4f\t%.6g\t%.6g\t%.9g\t%.9g\t%.9g\t%.9g\n", v->setup->condition->name,
           ratio, 100 * fabs(off / ratio - 1), l.foreground, l.background, part.left, part.top,
           part.right, part.bottom);
    fflush(stdout);
    return ratio;
}

static bool is_private(const Verdicts *v) {
    return review_is_private(v->request, v->symbol->symbol_id, &v->request->eyes[0]);
}

static void try_margin(const Verdicts *v, double ratio, double percent, unsigned seed) {
    LimitKind kind = is_private(v) ? LIMIT_VISUAL_SECURITY : LIMIT_CONTRAST_RATIO;
    ProfileLimit limit = {.name = "limit",
                          .kind = kind,
                          .ambients = {true, true, true, true},
                          .value = contrast_from_ratio(kind, ratio) / (1 + percent / 100)};
    Profile profile = {.id = "one", .limits = &limit, .limit_count = 1};
    int count[4] = {0};
    double paths = 0;
    for (int i = 0; i < v->trials; i++) {
        ReviewCase c = judged(v, &profile, seed + (unsigned)i);
        count[c.verdict]++;
        paths += (double)c.paths / v->trials;
    }
    printf("%s\t%g\t%d\t%d\t%d\t%d\t%.0f\n", v->setup->condition->name, percent, v->trials,
           count[VERDICT_PASS], count[VERDICT_FAIL], count[VERDICT_TOO_CLOSE], paths);
    fflush(stdout);
}

static void try_moment(ReviewRequest *request, const ReviewCondition *c, int trials,
                       Problems *problems) {
    static const double margins[] = {-10, -5, -2, -1, 1, 2, 5, 10};
    SetupOptions options = {
        .request = request, .condition = c, .means = {.root = "/", .threads = 1}};
    Arena arena = arena_reserve((size_t)1 << 36);
    Verdicts v = {.request = request, .trials = trials, .scratch = arena_reserve((size_t)1 << 33)};
    Setup setup;
    SetupSymbol *symbols;
    int count;
    Error err = {0};
    request->seed = 0;
    if (!setup_open(&options, &arena, problems, &setup, &err) ||
        !setup_light(&setup, NULL, &arena, &err) ||
        !setup_symbols(&setup, &arena, &symbols, &count, &err) ||
        !setup_learn(&setup, symbols, count, &arena, &err))
        trials_stop(&err);
    v.setup = &setup;
    v.symbol = &symbols[0];
    double ratio = true_contrast(&v, arena);
    for (int i = 0; i < 8; i++)
        if (fabs(margins[i]) > 1 || !is_private(&v))
            try_margin(&v, ratio, margins[i], (unsigned)(i + 1) << 20);
    arena_release(&v.scratch);
    setup_close(&setup);
    arena_release(&arena);
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Error err = {0};
    Problems problems = problems_start(&arena);
    ReviewRequest request;
    int trials = argc == 3 ? atoi(argv[1]) : 0;
    if (trials < 1) {
        fprintf(stderr, "bench_verdicts TRIALS REVIEW.json\n");
        return 1;
    }
    if (!review_request_read(argv[2], "/", &arena, &problems, &request, &err)) trials_stop(&err);
    for (int i = 0; i < request.condition_count; i++)
        if (request.conditions[i].kind == CONDITION_MOMENT)
            try_moment(&request, &request.conditions[i], trials, &problems);
    arena_release(&arena);
    return 0;
}
