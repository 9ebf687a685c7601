/* SPDX-License-Identifier: Apache-2.0 */
/* Random findings of every kind, judged by random profiles: value, interval, limit, verdict and
 * order are the same on the console, in JSON, CSV, JUnit, on the page and in differences. */
#include "review/export/review_junit.h"
#include "cli/review/review_print.h"
#include "review/chain/remedies.h"
#include "review/judge.h"
#include "review/output/finding_words.h"
#include "review/output/review_diff.h"
#include "review/output/review_json.h"
#include "review/output/review_words.h"
#include "review/road_verdict.h"
#include "review_page_fixture.h"
#include "text/text.h"

enum {
    ROUNDS = 40,
    CASES = 200, /* the last SWEPT of them the worst of sweeps */
    SWEPT = 20,
    GAZES = 30,
    PANES = 20,
    SUNS = 10,
    LIMITS = 2 * LIMIT_KIND_COUNT
};

/* ---- at random --------------------------------------------------------------------------- */

static uint64_t seed;

static double random_01(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) / 9007199254740992.0;
}

static bool chance(double share) {
    return random_01() < share;
}

static double between(double low, double high) {
    return low + (high - low) * random_01();
}

static const char *name_of(const char *kind, int i) {
    return arena_format(&arena, "%s%d", kind, i);
}

static MeanInterval about(double mean) {
    double half = chance(0.1) ? 0 : between(0, 0.3) * mean;
    return (MeanInterval){mean - half, mean + between(0.5, 1) * half};
}

/* Values about which the figures below lie, so that every verdict comes up. */
static double limit_value(LimitKind kind) {
    static const double VALUES[LIMIT_KIND_COUNT] = {
        [LIMIT_CONTRAST_RATIO] = 2,       [LIMIT_LUMINANCE_CONTRAST] = 1,
        [LIMIT_MODULATION] = 0.33,        [LIMIT_CHARACTER_HEIGHT] = 20,
        [LIMIT_STROKE_RATIO] = 0.15,      [LIMIT_WIDTH_RATIO] = 0.7,
        [LIMIT_VISIBILITY_LEVEL] = 10,    [LIMIT_VISUAL_SECURITY] = 0.7,
        [LIMIT_THRESHOLD_INCREMENT] = 15, [LIMIT_GAZE_VEIL] = 30,
        [LIMIT_GAZE_CONTRAST] = 0.5,      [LIMIT_IMAGE_CONTRAST] = 0.25,
        [LIMIT_MIRRORED_SUN] = 200,       [LIMIT_COLOUR_SHIFT] = 0.05,
        [LIMIT_COLOUR_DIFFERENCE] = 0.05};
    return VALUES[kind] > 0 ? between(0.7, 1.3) * VALUES[kind] : between(0.5, 2);
}

static Profile random_profile(void) {
    ProfileLimit *limits = ARENA_NEW(&arena, ProfileLimit, LIMITS);
    for (int i = 0; i < LIMITS; i++) {
        LimitKind kind = (LimitKind)(i % LIMIT_KIND_COUNT);
        const ReviewQuantity *of = quantities[kind];
        limits[i] = (ProfileLimit){.name = name_of("limit ", i),
                                   .kind = kind,
                                   .value = limit_value(kind),
                                   .is_upper = of->has_one_bound ? of->is_upper : chance(0.2),
                                   .is_advice = chance(0.2),
                                   .source = "a test"};
        for (int a = 0; a < AMBIENT_COUNT; a++) limits[i].ambients[a] = chance(0.7);
    }
    return (Profile){.id = "random",
                     .limits = limits,
                     .limit_count = LIMITS,
                     .uses_veil = chance(0.5),
                     .increment_most_pct = NAN,
                     .night_below_lx = 5,
                     .twilight_below_lx = 100,
                     .security = {.name = "security",
                                  .kind = LIMIT_VISUAL_SECURITY,
                                  .value = 1,
                                  .ambients = {true, true, true, true},
                                  .source = "a test"}};
}

static ReviewCase random_case(int i, const Profile *profile) {
    ReviewCase c = review_case_unknown();
    double reflected = between(1, 300);
    CaseVisibility *level = ARENA_NEW(&arena, CaseVisibility, 1);
    CaseColour *colours = ARENA_NEW(&arena, CaseColour, 3);
    *level = (CaseVisibility){.age_years = 60, .size_arcmin = 3, .glance_s = 0.2, .veil_times = 1};
    c.condition = name_of("c", i % 5);
    c.eye = name_of("e", i % 3);
    c.symbol = name_of("s", i);
    c.display = "d";
    c.ambient = (Ambient)(i % AMBIENT_COUNT);
    c.visible_share = chance(0.05) ? 0.3 : 1;
    c.is_optional = chance(0.3);
    c.must_not_be_read = chance(0.15);
    c.panel.is_unusable = chance(0.03);
    c.panel.emission_error = chance(0.5) ? 0.02 : 0;
    c.without_data_share = chance(0.03) ? 0.4 : 0;
    c.height_arcmin = between(10, 40);
    c.stroke_ratio = chance(0.1) ? (double)NAN : between(0.1, 0.2);
    c.luminance_cd_m2 = (CaseLuminances){between(50, 500), between(0, 5),   reflected,
                                         0.3 * reflected,  0.7 * reflected, between(0, 20)};
    c.visibilities = level;
    c.visibility_count = 1;
    c.colours = colours;
    c.colour_count = chance(0.5) ? 0 : 3;
    for (int k = 0; k < 3; k++) {
        double apart = between(0.01, 0.1);
        MeanInterval range = about(apart);
        colours[k] = (CaseColour){.symbol = name_of("s", k ? i + k : i),
                                  .apart = apart,
                                  .low = range.low,
                                  .high = range.high};
    }
    judge_contrasts(&c, about(reflected));
    judge_case(&c, profile, &arena);
    return c;
}

static GazeFinding random_gaze(int i, const Profile *profile) {
    double veil = between(1, 60), left = between(0.1, 0.9);
    GazeFinding g = {.condition = name_of("c", i % 5),
                     .eye = name_of("e", i % 3),
                     .gaze = name_of("g", i),
                     .sun_deg = chance(0.5) ? (double)NAN : 40,
                     .veil = veil,
                     .veil_range = about(veil),
                     .through = 100,
                     .contrast_left = left,
                     .contrast_range = about(left)};
    if (chance(0.5)) {
        GazeRoad *road = ARENA_NEW(&arena, GazeRoad, 1);
        *road = (GazeRoad){.luminance_cd_m2 = 0.3,
                           .ages = ARENA_NEW(&arena, RoadAge, 2),
                           .age_count = 2,
                           .without_data_share = chance(0.1) ? 0.4 : 0};
        for (int a = 0; a < 2; a++) {
            double pct = between(5, 25);
            road->ages[a] = (RoadAge){
                .age_years = 25 + 45 * a, .increment_pct = pct, .increment_range = about(pct)};
        }
        g.road = road;
    }
    judge_gaze(&g, profile, &arena);
    return g;
}

static PaneFinding random_pane(int i, const Profile *profile) {
    PaneFinding f = {.condition = name_of("c", i % 5),
                     .eye = name_of("e", i % 3),
                     .display = name_of("p", i),
                     .pane = "glass",
                     .shown_share = 1,
                     .image = between(0.1, 2),
                     .against = between(1, 5),
                     .area = chance(0.8) ? "road" : NULL};
    f.image_range = about(f.image);
    f.against_range = about(f.against);
    pane_set_contrast(&f);
    judge_pane(&f, profile, AMBIENT_NIGHT, chance(0.5) ? between(0.1, 0.5) : (double)INFINITY);
    return f;
}

static Review random_review(uint64_t from) {
    seed = from;
    Profile profile = random_profile();
    Review r = {.title = "random",
                .profile = "a test",
                .cases = ARENA_NEW(&arena, ReviewCase, CASES),
                .case_count = CASES - SWEPT,
                .sweeps = ARENA_NEW(&arena, ReviewSweep, SWEPT),
                .sweep_count = SWEPT,
                .gazes = ARENA_NEW(&arena, GazeFinding, GAZES),
                .gaze_count = GAZES,
                .pane_images = ARENA_NEW(&arena, PaneFinding, PANES),
                .pane_image_count = PANES,
                .false_suns = ARENA_NEW(&arena, ReviewFalseSun, SUNS),
                .false_sun_count = SUNS,
                .is_strict = chance(0.5)};
    for (int i = 0; i < CASES; i++) r.cases[i] = random_case(i, &profile);
    for (int i = 0; i < SWEPT; i++) {
        ReviewCase *worst = &r.cases[CASES - SWEPT + i];
        r.sweeps[i] = (ReviewSweep){.condition = worst->condition,
                                    .eye = worst->eye,
                                    .symbol = worst->symbol,
                                    .cases = 100,
                                    .longest_failure_minutes = NAN,
                                    .middle_contrast = NAN,
                                    .worst = *worst};
    }
    for (int i = 0; i < GAZES; i++) r.gazes[i] = random_gaze(i, &profile);
    for (int i = 0; i < PANES; i++) r.pane_images[i] = random_pane(i, &profile);
    for (int i = 0; i < SUNS; i++) {
        r.false_suns[i] = (ReviewFalseSun){.condition = name_of("c", i % 5),
                                           .eye = name_of("e", i % 3),
                                           .mirror = name_of("m", i),
                                           .gaze = "road",
                                           .veil_cd_m2 = between(50, 400)};
        judge_false_sun(&r.false_suns[i], &profile, &arena);
    }
    review_decide(&r);
    return r;
}

/* ---- the laws of one line ---------------------------------------------------------------- */

static Verdict verdict_by_hand(const LimitVerdict *line) {
    double low = line->low, high = line->high, limit = line->value;
    if (isnan(line->found)) return VERDICT_UNJUDGED;
    if (line->is_upper)
        return high <= limit ? VERDICT_PASS : low > limit ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
    return low >= limit ? VERDICT_PASS : high < limit ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
}

/* By hand: neither advice nor a figure that its shape has not. */
static bool counts_by_hand(const LimitVerdict *line) {
    bool may_lack = quantity_of(line)->may_be_missing;
    return !line->is_advice && !(may_lack && isnan(line->found));
}

static void check_finding(const Finding *f) {
    int worst = 0;
    bool decides = false;
    for (int i = 0; i < f->limit_count; i++) {
        const LimitVerdict *line = &f->limits[i];
        bool keeps = line->is_upper ? line->found <= line->value : line->found >= line->value;
        if (!isnan(line->found) && !(line->low <= line->found && line->found <= line->high))
            fail_msg("%s %.17g of %.17g to %.17g", line->kind, line->found, line->low, line->high);
        if (!isnan(line->found)) assert_int_equal(line->margin >= 0, keeps);
        if (line->verdict != VERDICT_UNJUDGED)
            assert_int_equal(line->verdict, verdict_by_hand(line));
        else
            assert_true(f->why || f->verdict == VERDICT_FAIL || line->is_advice ||
                        isnan(line->found));
        if (counts_by_hand(line) && verdict_rank(line->verdict) > worst)
            worst = verdict_rank(line->verdict);
        decides = decides || line == f->worst;
    }
    assert_true(decides == (f->worst != NULL));
    if (f->why != UNJUDGED_LIMIT && f->why != UNJUDGED_HIDDEN && f->why != UNJUDGED_PANEL)
        assert_int_equal(worst, verdict_rank(f->verdict));
    assert_int_equal(f->verdict == VERDICT_UNJUDGED, f->why != UNJUDGED_NOT);
}

static bool is_in_order(const Finding *a, const Finding *b) {
    if (a->counts != b->counts) return a->counts;
    int more = a->counts ? verdict_rank(a->verdict) - verdict_rank(b->verdict) : 0;
    double one = a->worst ? a->worst->margin : (double)NAN;
    double other = b->worst ? b->worst->margin : (double)NAN;
    return more > 0 || (more == 0 && (isnan(other) || one <= other));
}

/* ---- the views --------------------------------------------------------------------------- */

static void check_json(const Findings *all, const Review *review) {
    json_t *document = review_json(review), *rows = json_object_get(document, "findings");
    size_t at = 0;
    for (int i = 0; i < all->count; i++)
        for (int k = 0; k < all->list[i].limit_count || k == 0; k++) {
            const Finding *f = &all->list[i];
            const LimitVerdict *line = f->limit_count ? &f->limits[k] : NULL;
            json_t *row = json_array_get(rows, at++), *found = json_object_get(row, "found");
            const char *verdict = json_string_value(json_object_get(row, "verdict"));
            assert_string_equal(json_string_value(json_object_get(row, "subject")), f->subject);
            assert_string_equal(verdict, verdict_names[line ? line->verdict : f->verdict]);
            assert_int_equal(json_is_true(json_object_get(row, "decides")), line == f->worst);
            assert_int_equal(json_is_true(json_object_get(row, "counts")), f->counts);
            if (!line || isnan(line->found)) assert_true(json_is_null(found));
            else assert_close(json_real_value(found), line->found, 0);
            if (line) assert_close(json_real_value(json_object_get(row, "limit")), line->value, 0);
        }
    assert_int_equal(json_array_size(rows), at);
    json_decref(document);
}

/* The cell's place below a name of the header; no cell of these reviews holds a comma. */
static const char *cell_of(const char *row, const char *head, const char *name) {
    const char *at = strstr(head, arena_format(&arena, ",%s,", name));
    assert_non_null(at);
    for (const char *c = head; c <= at; c++) {
        if (*c != ',') continue;
        row = strchr(row, ',');
        assert_non_null(row++);
    }
    return row;
}

static void check_csv(const Findings *all, const Review *review) {
    const char *path = fresh_name(".csv");
    assert_done(review_csv_write(review, path, &err));
    const char *head = taken(path), *row = head;
    for (int i = 0; i < all->count; i++)
        for (int k = 0; k < all->list[i].limit_count || k == 0; k++) {
            const Finding *f = &all->list[i];
            const LimitVerdict *line = f->limit_count ? &f->limits[k] : NULL;
            Verdict verdict = line ? line->verdict : f->verdict;
            Arena here = arena;
            row = strchr(row, '\n') + 1;
            const char *subject = arena_format(&here, "%s,%s,", f->viewer, f->subject);
            assert_true(strncmp(strchr(row, ',') + 1, subject, strlen(subject)) == 0);
            assert_true(strncmp(cell_of(row, head, "verdict"), verdict_names[verdict],
                                strlen(verdict_names[verdict])) == 0);
            if (line && !isnan(line->found)) {
                assert_same(line->found, strtod(cell_of(row, head, "found"), NULL));
                assert_same(line->high, strtod(cell_of(row, head, "found_high"), NULL));
                assert_same(line->value, strtod(cell_of(row, head, "limit"), NULL));
                assert_same(line->margin, strtod(cell_of(row, head, "margin"), NULL));
            }
            arena = here;
        }
    assert_null(strstr(strchr(row, '\n') + 1, ","));
}

static void check_junit(const Findings *all, const Review *review) {
    const char *path = fresh_name(".xml");
    assert_done(review_junit_write(review, path, &err));
    const char *at = taken(path);
    for (int i = 0; i < all->count; i++) {
        const Finding *f = &all->list[i];
        bool fails =
            f->verdict == VERDICT_FAIL || (review->is_strict && f->verdict == VERDICT_TOO_CLOSE);
        const char *tag = fails                                         ? "<failure "
                          : f->verdict == VERDICT_PASS                  ? "<system-out>"
                          : f->verdict == VERDICT_UNJUDGED && f->counts ? "<error "
                                                                        : "<skipped ";
        at = strstr(at, "<testcase ");
        assert_non_null(at);
        assert_non_null(strstr(at, arena_format(&arena, "name=\"%s, seen by", f->subject)));
        at = strstr(at + 10, "\n");
        at += 1 + strspn(at + 1, " ");
        if (strncmp(at, tag, strlen(tag)) != 0)
            fail_msg("%s: %.20s in place of %s", f->subject, at, tag);
    }
    assert_null(strstr(at, "<testcase "));
}

/* The worst first; each row has its verdict before and its margin behind its name. */
static void check_page(const Findings *ranked, const Review *review) {
    static const char *const SAID[4] = {"Passes", "Fails", "Too close to call", "Cannot be judged"};
    const char *at = strstr(page_of(&(ReviewPage){.review = review}), "class=\"list\"");
    for (int i = 0; i < ranked->count; i++) {
        const Finding *f = &ranked->list[i];
        at = strstr(at, "<tr><td><span class=\"chip");
        assert_non_null(at);
        const char *said = strchr(at, '>') + 1, *name = strstr(at, "<a href=");
        said = strchr(strstr(said, "<span"), '>') + 1;
        assert_true(strncmp(said, SAID[f->verdict], strlen(SAID[f->verdict])) == 0);
        name = strchr(name, '>') + 1;
        if (strncmp(name, f->subject, strlen(f->subject)) != 0)
            fail_msg("row %d: %.20s in place of %s", i, name, f->subject);
        at = name;
        if (f->why || !f->worst) continue;
        const char *end = strstr(at, "</tr>"), *margin = words_from_limit(f->worst, &arena);
        const char *there = strstr(at, arena_format(&arena, ">%s</td>", margin));
        const char *limit =
            strstr(at, arena_format(&arena, "= %s</td>", words_required(f->worst, &arena) + 3));
        assert_true(there && there < end && limit && limit < there);
    }
}

/* What the console says, through a file. */
static const char *printed(const Review *review) {
    const char *path = fresh_name(".txt");
    FILE *file = fopen(path, "w");
    Cli cli = {0};
    int shown = dup(STDOUT_FILENO);
    assert_non_null(file);
    fflush(stdout);
    dup2(fileno(file), STDOUT_FILENO);
    bool ok = review_print(&cli, review, arena, why());
    fflush(stdout);
    dup2(shown, STDOUT_FILENO);
    close(shown);
    fclose(file);
    assert_true(ok);
    return taken(path);
}

static void check_console(const Findings *all, const Review *review) {
    const char *text = printed(review);
    for (int i = 0; i < all->count; i++) {
        const Finding *f = &all->list[i];
        const char *line = arena_format(&arena, "\n%-16s %s, %s, %s:", verdict_names[f->verdict],
                                        f->condition, f->viewer, f->subject);
        const char *at = i ? strstr(text, line) : strstr(text, line + 1);
        if (!at) fail_msg("the console has no line '%s'", line + 1);
        if (f->why || !f->c) continue;
        const char *end = strchr(at + 1, '\n');
        const char *bound = strstr(at, words_bound(f->worst, &arena));
        assert_true(bound && bound < end);
    }
}

static void check_difference(const Review *before, const Review *after) {
    ReviewDiff diff = review_diff(before, after, "before", "after", &arena);
    json_t *document = review_diff_json(&diff), *rows = json_object_get(document, "findings");
    int count[DIFF_COUNT] = {0};
    assert_int_equal(json_array_size(rows), diff.list_count);
    for (int i = 0; i < diff.list_count; i++) {
        const FindingDiff *d = &diff.list[i];
        json_t *row = json_array_get(rows, (size_t)i);
        count[d->kind]++;
        assert_string_equal(json_string_value(json_object_get(row, "change")), diff_names[d->kind]);
        if (!d->before || !d->after) {
            assert_int_equal(d->kind, d->after ? DIFF_NEW : DIFF_GONE);
            continue;
        }
        assert_int_equal(d->kind == DIFF_BROKEN || d->kind == DIFF_MENDED,
                         d->before->verdict != d->after->verdict);
        for (int k = 0; k < d->after->limit_count && d->kind == DIFF_SAME && !d->after->sweep;
             k++) {
            const LimitVerdict *a = &d->after->limits[k], *b = finding_line_like(d->before, a);
            assert_false(b && (a->high < b->low || a->low > b->high));
        }
    }
    for (int kind = 0; kind < DIFF_COUNT; kind++) assert_int_equal(count[kind], diff.count[kind]);
    json_decref(document);
}

TEST(every_view_tells_the_same_findings) {
    int kinds[4] = {0}, findings = 0, lines[LIMIT_KIND_COUNT] = {0};
    for (int round = 0; round < ROUNDS; round++) {
        Arena kept = arena;
        Review review = random_review((uint64_t)round + 1),
               again = random_review((uint64_t)round + 7);
        Findings all = review_findings(&review, &arena), ranked = review_ranked(&review, &arena);
        ReviewCounts counts = review_count(&review);
        for (int i = 0; i < all.count; i++) {
            const Finding *f = &all.list[i];
            check_finding(f);
            kinds[f->verdict]++;
            for (int k = 0; k < f->limit_count; k++) lines[limit_kind_named(f->limits[k].kind)]++;
        }
        for (int i = 1; i < ranked.count; i++)
            assert_true(is_in_order(&ranked.list[i - 1], &ranked.list[i]));
        assert_int_equal(counts.total, all.count);
        assert_int_equal(ranked.count, all.count);
        check_json(&all, &review);
        check_csv(&all, &review);
        check_junit(&all, &review);
        check_console(&all, &review);
        if (round % 8 == 0) check_page(&ranked, &review);
        check_difference(&review, &review);
        check_difference(&review, &again);
        findings += all.count;
        arena = kept;
    }
    assert_true(findings >= 10000 * ROUNDS / 40);
    for (int v = 0; v < 4; v++) assert_true(kinds[v] > findings / 50);
    for (int kind = 0; kind < LIMIT_KIND_COUNT; kind++)
        if (!lines[kind]) fail_msg("no finding has a limit of %s", limit_kind_names[kind]);
}

/* ---- what a level changes ---------------------------------------------------------------- */

enum { SHOWN = 18, DISPLAYS = 3, ROADS = 4, IMAGES = 6 };

/* One moment: symbols on displays that roads, too, see, and panes. */
static Review random_moment(const Profile *profile) {
    Review r = {.cases = ARENA_NEW(&arena, ReviewCase, SHOWN),
                .case_count = SHOWN,
                .gazes = ARENA_NEW(&arena, GazeFinding, ROADS),
                .gaze_count = ROADS,
                .pane_images = ARENA_NEW(&arena, PaneFinding, IMAGES),
                .pane_image_count = IMAGES};
    for (int i = 0; i < SHOWN; i++) {
        ReviewCase *c = &r.cases[i];
        *c = random_case(i, profile);
        c->display = name_of("d", i % DISPLAYS);
        c->level = i < SHOWN / 2 ? 0.5 : 0.25;
        c->veil_displays = 0;
        case_remedies(profile, 1, c, &arena);
    }
    for (int i = 0; i < ROADS; i++) {
        GazeFinding *g = &r.gazes[i];
        *g = random_gaze(i, profile);
        for (int a = 0; g->road && a < g->road->age_count; a++) {
            RoadAge *age = &g->road->ages[a];
            age->displays = ARENA_NEW(&arena, RoadDisplay, DISPLAYS);
            age->display_count = DISPLAYS;
            for (int d = 0; d < DISPLAYS; d++) {
                double pct = 0.3 * age->increment_pct;
                age->displays[d] = (RoadDisplay){.display = name_of("d", d),
                                                 .increment_pct = pct,
                                                 .increment_range = {pct, pct}};
            }
        }
    }
    for (int i = 0; i < IMAGES; i++) {
        r.pane_images[i] = random_pane(i, profile);
        r.pane_images[i].shows = name_of("d", i % DISPLAYS);
    }
    remedies_judge(profile, &r, &arena);
    return r;
}

/* The finding once a display is so many times as bright, judged as any other is. */
static void brighten(Finding *f, const char *display, double times, const Profile *profile) {
    if (f->c && !strcmp(f->c->display, display)) {
        ReviewCase *c = ARENA_NEW(&arena, ReviewCase, 1);
        *c = *f->c;
        c->luminance_cd_m2.foreground *= times;
        c->luminance_cd_m2.background *= times;
        judge_contrasts(c, c->reflected_range);
        judge_case(c, profile, &arena);
        f->limits = c->limits;
    }
    if (f->pane && !strcmp(f->pane->shows, display)) {
        PaneFinding *p = ARENA_NEW(&arena, PaneFinding, 1);
        *p = *f->pane;
        p->image *= times;
        p->image_range.low *= times;
        p->image_range.high *= times;
        pane_set_contrast(p);
        judge_pane(p, profile, AMBIENT_NIGHT, p->limit.value);
        f->limits = &p->limit;
    }
    if (f->gaze && f->gaze->road) {
        GazeFinding *g = ARENA_NEW(&arena, GazeFinding, 1);
        GazeRoad *road = ARENA_NEW(&arena, GazeRoad, 1);
        *g = *f->gaze;
        *road = *g->road;
        road->ages = ARENA_NEW(&arena, RoadAge, road->age_count);
        for (int a = 0; a < road->age_count; a++) {
            RoadAge *age = &road->ages[a];
            *age = g->road->ages[a];
            double more = (times - 1) * age->displays[0].increment_pct;
            age->increment_pct += more;
            age->increment_range.low += more;
            age->increment_range.high += more;
        }
        g->road = road;
        judge_gaze(g, profile, &arena);
        f->limits = g->limits;
    }
}

/* Of one change: all that passes and then does not is named, and nothing else is; how much. */
static int check_breaks(const Review *r, const Profile *profile, const ReviewCase *of,
                        const PaneFinding *pane) {
    const RemedyBreak *breaks = of ? of->remedies->breaks : pane->breaks;
    int count = of ? of->remedies->break_count : pane->break_count, found = 0;
    double times = of ? of->remedies->level / of->level : pane_level_share(pane);
    const char *display = of ? of->display : pane->shows;
    Findings all = review_findings(r, &arena);
    for (int i = 0; i < all.count; i++) {
        Finding f = all.list[i];
        bool breaks_it = false, is_named = false;
        if (f.c && (f.c == of || (of && f.c->level != of->level))) continue;
        if (of && of->must_not_be_read && strcmp(f.viewer, of->eye) != 0) continue;
        brighten(&f, display, times, profile);
        for (int k = 0; k < f.limit_count && f.counts; k++)
            breaks_it = breaks_it || (counts_by_hand(&f.limits[k]) &&
                                      all.list[i].limits[k].verdict == VERDICT_PASS &&
                                      f.limits[k].verdict != VERDICT_PASS);
        for (int k = 0; k < count; k++)
            is_named = is_named || (!strcmp(breaks[k].subject, f.subject) &&
                                    !strcmp(breaks[k].viewer, f.viewer));
        if (breaks_it != is_named)
            fail_msg("%s of %s: %d, said %d", f.subject, display, breaks_it, is_named);
        found += breaks_it;
    }
    assert_int_equal(found, count);
    return count;
}

TEST(a_level_that_mends_one_says_what_it_breaks_and_breaks_nothing_else) {
    int broken = 0, fine = 0;
    for (int round = 0; round < 200; round++) {
        Arena kept = arena;
        seed = (uint64_t)round + 1;
        Profile profile = random_profile();
        Review r = random_moment(&profile);
        for (int i = 0; i < SHOWN; i++) {
            if (!r.cases[i].remedy_count) continue;
            int count = check_breaks(&r, &profile, &r.cases[i], NULL);
            const char *words = words_remedy(r.cases[i].remedies, &arena);
            assert_int_equal(strstr(words, "; then ") != NULL, count > 0);
            *(count ? &broken : &fine) += 1;
        }
        for (int i = 0; i < IMAGES; i++) {
            const PaneFinding *f = &r.pane_images[i];
            if (!f->has_limit || f->limit.verdict == VERDICT_PASS || isnan(pane_level_share(f)))
                continue;
            *(check_breaks(&r, &profile, NULL, f) ? &broken : &fine) += 1;
        }
        arena = kept;
    }
    assert_true(broken > 100 && fine > 100);
}

TEST_PROGRAM(page_begin, clear_folder)
