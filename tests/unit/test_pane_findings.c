/* SPDX-License-Identifier: Apache-2.0 */
/* Displays in glass as a review tells them: directions from the vehicle's, the areas that are
 * to be kept free, and what images are seen against at least. */
#include "fixture.h"

#include "base/units.h"
#include "review/run/pane_findings.h"
#include "world_fixture.h"

#define PANE_M 1.0f /* ahead of the eye, across the way */
#define GLASS 1.52

/* A display behind the eye that faces ahead: the pane shows it ahead, so far right and up. */
static const Vec3 display_at = {0.4f, 0.3f, 0.6f};

static const ReviewCondition condition = {.name = "night"};

static ReviewEye eyes[] = {
    {.name = "driver", .kind = EYE_POINT, .grid = {1, 1, 1}, .camera_id = NO_ID}};

static ReviewRequest request_of(const ReviewPaneImages *panes) {
    return (ReviewRequest){.forward = {0, 0, -1},
                           .observer = {50, 0.5},
                           .eyes = eyes,
                           .eye_count = 1,
                           .pane_images = panes};
}

/* half: of the pane, m. */
static World world_of(float half) {
    World world = world_start();
    world_display(&world);
    builder_quad(world.scene, display_at, vec3(-0.05f, 0, 0), vec3(0, 0.04f, 0));
    builder_part(world.scene, builder_pane((float)GLASS));
    builder_quad(world.scene, vec3(0, 0, -PANE_M), vec3(half, 0, 0), vec3(0, half, 0));
    world_ready(&world, 16);
    return world;
}

static Review findings(World *world, const ReviewRequest *request) {
    Review review = {0};
    Setup setup = {.request = request,
                   .condition = &condition,
                   .scene = world->scene,
                   .context = world->context,
                   .tools = {.threads = 2}};
    assert_done(kernel_choose(NULL, &setup.tools.kernel, &err));
    assert_done(setup_pane_images(&setup, NULL, &world->arena, &review, &err));
    assert_int_equal(review.pane_image_count, 1);
    return review;
}

/* ---- where and how bright ---------------------------------------------------------------- */

TEST(a_pane_across_the_way_shows_what_is_behind_at_its_mirrored_place) {
    SCOPED_WORLD world = world_of(2);
    const ReviewPaneImages panes = {
        .within_deg = 60, .contrast_most = (double)NAN, .against_cd_m2 = 0.25};
    ReviewRequest request = request_of(&panes);
    Review review = findings(&world, &request);
    const PaneFinding *f = &review.pane_images[0];
    double far = 2 * (double)PANE_M + (double)display_at.z;
    double right = atan2((double)display_at.x, far);
    double up = atan2((double)display_at.y, hypot((double)display_at.x, far));
    assert_null(f->none);
    assert_near(f->shown_share, 1, 1e-6);
    assert_near(f->right_deg, degrees_from_radians(right), 0.05);
    assert_near(f->up_deg, degrees_from_radians(up), 0.05);
    double left = atan2((double)display_at.x - 0.05, far);
    double wide = atan2((double)display_at.x + 0.05, far) - left;
    assert_near(f->width_deg, degrees_from_radians(wide), 0.05);
    assert_int_equal(f->outline_count, 8);
    assert_true(f->ghost_share == 0 && isnan(f->ghost_arcmin)); /* a pane without thickness */
    /* Nothing lies behind: what the request says counts, and the contrast follows from it. */
    assert_true(f->behind == 0);
    assert_close(f->against, 0.25, 1e-12);
    assert_close(f->contrast, f->image / 0.25, 1e-12);
    assert_true(f->image_range.low <= f->image && f->image <= f->image_range.high);
    assert_close(f->contrast_range.low, f->image_range.low / 0.25, 1e-9);
    assert_close(f->contrast_range.high, f->image_range.high / 0.25, 1e-9);
    /* Nearly straight: both faces of glass, 2 r / (1 + r), of a panel of some 900 cd/m2. */
    double r = (GLASS - 1) * (GLASS - 1) / ((GLASS + 1) * (GLASS + 1)), both = 2 * r / (1 + r);
    if (!(f->image > 0.5 * both * 905 && f->image < 1.1 * both * 905))
        fail_msg("%g cd/m2, %g of 905", f->image, both);
}

TEST(a_pane_that_ends_has_no_image_and_no_figure) {
    SCOPED_WORLD world = world_of(0.05f);
    const ReviewPaneImages panes = {.within_deg = 60, .contrast_most = 0.1};
    ReviewRequest request = request_of(&panes);
    Review review = findings(&world, &request);
    const PaneFinding *f = &review.pane_images[0];
    assert_string_equal(f->none, "the pane ends before it");
    assert_near(f->ends_share, 1, 1e-6);
    assert_true(isnan(f->image) && isnan(f->contrast) && isnan(f->right_deg));
    assert_true(f->none || !f->has_limit);
}

/* ---- areas ------------------------------------------------------------------------------- */

/* The image lies 10.8 degrees off ahead; its nearest corner 9.5. */
TEST(the_area_that_allows_least_judges_an_image) {
    ReviewPaneArea areas[] = {{"wide", {0, 0, -1}, 20, 1e6},
                              {"strict", {0, 0, -1}, 12, 1e-3},
                              {"elsewhere", {-1, 0, 0}, 30, 1e-6}};
    ReviewPaneImages panes = {.within_deg = 5,
                              .contrast_most = 1e-6,
                              .against_cd_m2 = 1,
                              .areas = areas,
                              .area_count = 3};
    SCOPED_WORLD world = world_of(2);
    ReviewRequest request = request_of(&panes);
    Review review = findings(&world, &request);
    const PaneFinding *f = &review.pane_images[0];
    assert_string_equal(f->area, "strict");
    assert_true(f->has_limit && f->limit.verdict == VERDICT_FAIL);
    Vec3 corner = vec3_normalize(
        vec3(display_at.x - 0.05f, display_at.y - 0.04f, -2 * PANE_M - display_at.z));
    assert_near(f->off_deg, degrees_from_radians(acos(-(double)corner.z)), 0.05);
    panes.area_count = 1;
    review = findings(&world, &request);
    assert_string_equal(review.pane_images[0].area, "wide");
    assert_int_equal(review.pane_images[0].limit.verdict, VERDICT_PASS);
    areas[0].within_deg = 9;
    review = findings(&world, &request);
    assert_null(review.pane_images[0].area);
    assert_true(!review.pane_images[0].has_limit && isnan(review.pane_images[0].off_deg));
}

/* A gaze of another eye is none of this one's; without any the way ahead counts. */
TEST(gazes_of_the_eye_are_areas_and_so_is_ahead_without_them) {
    bool looks[] = {true};
    ReviewGaze gazes[] = {{.name = "symbols", .at_symbols = true, .for_eye = looks},
                          {.name = "road", .direction = {0, 0, -1}, .for_eye = looks}};
    ReviewPaneImages panes = {.within_deg = 12, .contrast_most = 1e9, .against_cd_m2 = 1};
    SCOPED_WORLD world = world_of(2);
    ReviewRequest request = request_of(&panes);
    Review review = findings(&world, &request);
    assert_string_equal(review.pane_images[0].area, "ahead");
    request.gazes = gazes;
    request.gaze_count = 2;
    review = findings(&world, &request);
    assert_string_equal(review.pane_images[0].area, "road");
    looks[0] = false;
    review = findings(&world, &request);
    assert_string_equal(review.pane_images[0].area, "ahead");
}

TEST_PROGRAM(NULL, NULL)
