/* SPDX-License-Identifier: Apache-2.0 */
/* A whole review of what must not be read: moments, a variant, eyes that see it and eyes that
 * do not; and the suns of a sweep. */
#include "wall_fixture.h"

#include "base/mathd.h"
#include "review/engine/engine.h"
#include "review/request/request_read.h"
#include "review/review_decide.h"
#include "review/run/sun_figures.h"
#include "vision/privacy.h"

/* The driver must not read what the passenger must. `behind` sees the display's back. */
static const char request_text[] =
    "{'title':'Private','scene':['a.gltf'],'forward':[0,0,-1],"
    "'eyes':{'passenger':{'camera':'eye'},'driver':{'centre_m':[-0.6,0.02,0.5],"
    "'half_size_m':[0.05,0,0.05],'grid':[2,1,2]},"
    "'behind':{'position_m':[0.1,0,-0.6]}},"
    "'symbols':{'film':{'display':'cluster','content':'c.png','uv':[0.167,0.408,0.27,0.609],"
    "'polarity':'light-on-dark','must_not_be_read':['driver','behind']}},"
    "'profile':'iso-15008','precision':{'contrast':0.2,'paths':8192},"
    "'frames':{'size':[32,18],'noise':1,'worst':0},"
    "'privacy':{'security_min_s':0.5},"
    "'variants':{'dimmer':{'brightness':{'*':0.02}},"
    "'shared':{'panels':{'cluster':'q.panel'}}},"
    "'conditions':[{'name':'night','environment':{'type':'constant','luminance':1}},"
    "{'name':'bright','environment':{'type':'constant','luminance':90000}}]}";

static Review run_request(Arena *arena) {
    ReviewRequest request;
    ReviewOutcome outcome;
    const Profile *profile;
    Problems problems = problems_start(arena);
    wall_write_files(request_text, *arena);
    wall_copy(PROJECT_DIR "/assets/panels/hud_pgu.panel", "q.panel", *arena);
    if (!review_request_read(in_folder("r.json"), NULL, arena, &problems, &request, why()) ||
        !profile_load(request.profile, arena, &profile, why()))
        fail_msg("%s: %s", why()->path, why()->text);
    assert_true(request.privacy.is_given);
    profile = profile_with_security(profile, request.privacy.security_min, arena);
    Progress progress = progress_start(PROGRESS_NONE, "review", "steps", 1);
    ReviewRun run = {.request = &request,
                     .profile = profile,
                     .means = {.threads = 2},
                     .problems = &problems,
                     .progress = &progress};
    if (!review_run(&run, false, arena, &outcome, why())) fail_msg("%s", why()->text);
    return outcome.review;
}

static const ReviewCase *case_of(const Review *review, const char *condition, const char *eye) {
    const ReviewCase *c = review_case_named(review, condition, eye, "film");
    assert_non_null(c);
    return c;
}

/* By night the driver reads it, in bright light not; S is the formula's of what the case says
 * of its light, and as far from the limit as its margin. */
static void assert_moments(const Review *review) {
    static const char *const NAMES[] = {"night", "bright"};
    for (int i = 0; i < 2; i++) {
        const ReviewCase *c = case_of(review, NAMES[i], "driver");
        const CaseLuminances *l = &c->luminance_cd_m2;
        assert_true(c->must_not_be_read);
        assert_int_equal(c->limit_count, 1);
        const LimitVerdict *limit = &c->limits[0];
        double v = privacy_security(fmax(l->foreground, l->background),
                                    fmin(l->foreground, l->background), l->reflected);
        assert_near(limit->found, log10_d(v), 1e-12);
        assert_near(limit->margin, limit->found / 0.5 - 1, 1e-12);
        assert_true(limit->low <= limit->found && limit->found <= limit->high);
        assert_int_equal(c->verdict, i ? VERDICT_PASS : VERDICT_FAIL);
        assert_int_equal(case_kept_by(c), i ? KEPT_SECURITY : KEPT_NOT);
        assert_false(case_of(review, NAMES[i], "passenger")->must_not_be_read);
        const ReviewCase *behind = case_of(review, NAMES[i], "behind");
        assert_int_equal(behind->verdict, VERDICT_PASS);
        assert_int_equal(case_kept_by(behind), KEPT_HIDDEN);
        assert_non_null(strstr(behind->hiders[0].what, "back"));
    }
    assert_int_equal(case_of(review, "night", "passenger")->verdict, VERDICT_PASS);
}

/* Of an eye box every place is kept; the case is that of the one by which it is read best, read
 * more surely. */
static void assert_places(const Review *review) {
    const ReviewCase *c = case_of(review, "night", "driver");
    const ReviewCase *bright = case_of(review, "bright", "driver");
    double most = 0;
    assert_int_equal(c->place_count, 4);
    assert_int_equal(case_of(review, "night", "behind")->place_count, 0);
    for (int i = 0; i < 4; i++) {
        const CasePlace *p = &c->places[i];
        assert_int_equal(p->verdict, VERDICT_FAIL);
        assert_near(fabs(p->eye_m[0] + 0.6), 0.05, 1e-6);
        assert_near(p->eye_m[1], 0.02, 1e-6);
        assert_near(fabs(p->eye_m[2] - 0.5), 0.05, 1e-6);
        most = fmax(most, p->contrast_ratio);
        assert_int_equal(bright->places[i].verdict, VERDICT_PASS);
    }
    assert_near(c->eye_failed_share, 1, 0);
    assert_near(bright->eye_failed_share, 0, 0);
    assert_close(most, c->contrast_ratio, 0.05);
}

/* Only what shows less of it helps. */
static void assert_remedies(const Review *review) {
    const ReviewCase *c = case_of(review, "night", "driver");
    for (int i = 0; i < c->remedy_count; i++) {
        assert_true(c->remedies[i].then.found > c->limits[0].found);
        assert_true(c->remedies[i].level < c->level);
    }
}

/* A variant's margins are of the same figure: dimmer is better for who must not read it, worse
 * for who must. */
static void assert_variant(const Review *review) {
    const ReviewVariantFound *dimmer = &review->variants[0];
    double moved[2] = {0, 0};
    for (int i = 0; i < dimmer->difference_count; i++) {
        const ReviewDifference *d = &dimmer->differences[i];
        if (strcmp(d->after->condition, "bright") != 0 || isnan(d->margin)) continue;
        moved[d->after->must_not_be_read] += d->margin;
    }
    assert_true(moved[0] < 0 && moved[1] > 0);
}

/* A variant has the display's other panel: it is judged by what that one sends the driver, who
 * reads it better. */
static void assert_other_panel(const Review *review) {
    const ReviewVariantFound *shared = &review->variants[1];
    const ReviewCase *before = case_of(review, "night", "driver");
    const ReviewCase *after = case_of(shared->review, "night", "driver");
    const CaseLuminances *l = &after->luminance_cd_m2;
    assert_string_equal(shared->name, "shared");
    assert_true(after->must_not_be_read);
    assert_int_equal(before->verdict, VERDICT_FAIL);
    assert_true(l->foreground != before->luminance_cd_m2.foreground);
    assert_near(after->limits[0].found,
                log10_d(privacy_security(l->foreground, l->background, l->reflected)), 1e-12);
    assert_true(after->limits[0].high < before->limits[0].low);
}

ARENA_TEST(a_review_of_what_must_not_be_read) {
    Review review = run_request(&arena);
    assert_int_equal(review.case_count, 6);
    assert_false(review.pass);
    assert_moments(&review);
    assert_places(&review);
    assert_remedies(&review);
    assert_variant(&review);
    assert_other_panel(&review);
    int said = 0;
    for (int i = 0; i < review.note_count; i++)
        said += strstr(review.notes[i], "US 11,106,103 B2") != NULL;
    assert_int_equal(said, 1);
}

/* ---- the suns of a sweep ----------------------------------------------------------------- */

enum { SUNS = 5 };
static const double LIGHT[SUNS] = {40, 3, 900, 3.5, 60}; /* reflected under each, cd/m2 */

/* A symbol of 100 cd/m2 on 1 under those suns. */
static SunFigures under_suns(bool is_private, Arena *arena) {
    static Display display = {.name = "screen"};
    static double level = 1, lux[SUNS] = {10, 10, 10, 10, 10};
    const ProfileLimit limit = {.name = "contrast",
                                .kind = LIMIT_CONTRAST_RATIO,
                                .value = 5,
                                .ambients = {true, true, true, true}};
    const Profile profile = {.limits = &limit,
                             .limit_count = 1,
                             .night_below_lx = 1,
                             .twilight_below_lx = 2,
                             .security = {.kind = LIMIT_VISUAL_SECURITY, .value = 0.5}};
    Scene scene = {.displays = &display, .display_count = 1};
    ReviewRequest request = {.title = ""};
    ReviewCondition condition = {.name = "suns"};
    Setup setup = {
        .scene = &scene, .request = &request, .condition = &condition, .scene_levels = &level};
    ReviewRun run = {.request = &request, .profile = &profile, .means = {.threads = 1}};
    Sweep sweep = {.run = &run, .setup = &setup, .suns = {.count = SUNS}};
    SetupSymbol symbol = {.display_name = "screen"};
    SweepMeter face = {.lux = lux};
    DistantSun suns[SUNS]; /* all of them down: the hours' skies are all the light */
    float alike[RESPONSE_GROUPS];
    double skies[SUNS];
    BrightSamples bright = {0};
    HourSkies hours = {.list = NULL};
    DistantTools tools = {.setup = &setup, .hours = &hours, .suns = {suns, SUNS}};
    memcpy(skies, LIGHT, sizeof skies);
    for (int i = 0; i < SUNS; i++) suns[i] = (DistantSun){{0, -5}, 1};
    for (int k = 0; k < RESPONSE_GROUPS; k++) alike[k] = 1;
    Sight sight = {.symbol = &symbol,
                   .face = &face,
                   .is_private = is_private,
                   .probe = {.sky = skies,
                             .sky_bright = &bright,
                             .sky_without = alike,
                             .response = {.paths = 1 << 20}},
                   .seen = {1, 1},
                   .shown = {.foreground = 100, .background = 1},
                   .height_arcmin = 20};
    SunFigures figures = sun_figures_start(SUNS, arena);
    sun_figures_judge(&sweep, &sight, &tools, &figures, *arena);
    return figures;
}

/* The worst sun is that under which most is reflected for who must read it, and least for who
 * must not; verdicts of both are each step's own. */
ARENA_TEST(the_worst_sun_is_that_by_which_it_is_read_best) {
    SunFigures open = under_suns(false, &arena), closed = under_suns(true, &arena);
    assert_int_equal(open.worst, 2);
    assert_int_equal(closed.worst, 1);
    assert_true(closed.is_private && !open.is_private);
    for (int i = 0; i < SUNS; i++) {
        double s = log10_d(privacy_security(100, 1, LIGHT[i]));
        assert_near(closed.contrast[i], open.contrast[i], 0);
        assert_near(closed.margin[i], s / 0.5 - 1, 1e-6);
        assert_int_equal(closed.verdict[i], s >= 0.5 ? VERDICT_PASS : VERDICT_FAIL);
        assert_int_equal(open.verdict[i],
                         (100 + LIGHT[i]) / (1 + LIGHT[i]) >= 5 ? VERDICT_PASS : VERDICT_FAIL);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
