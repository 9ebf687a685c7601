/* SPDX-License-Identifier: Apache-2.0 */
/* What must not be read, in a pane of glass: its image against plane geometry and Fresnel's
 * formulas, and the verdict of that. */
#include "fixture.h"

#include "base/mathd.h"
#include "base/units.h"
#include "light/emission.h"
#include "review/judge.h"
#include "review/run/private_images.h"
#include "vision/privacy.h"
#include "world_fixture.h"

/* The eye looks along -Z at a windscreen that leans over a display below, as in
 * test_pane_images. */
#define LEAN_DEG 28.0f
#define PANE_M 0.8f
#define GLASS 1.52
#define BEHIND_CD_M2 3.0
enum { WIDE = 60, HIGH = 30 };

static const ReviewCondition condition = {.name = "night"};
static const Vec3 eye = {0, 0, 0};
static const Vec3 middle = {0.1f, -0.35f, -0.6f}, half_u = {0.12f, 0, 0},
                  half_v = {0, 0.02f, -0.06f};

static Vec3 pane_normal(void) {
    float a = radians_from_degrees(LEAN_DEG);
    return vec3(0, -cosf(a), sinf(a));
}

static Vec3 mirrored(Vec3 p) {
    Vec3 n = pane_normal();
    return vec3_along(p, n, -2 * vec3_dot(n, vec3_sub(p, vec3(0, 0, -PANE_M))));
}

/* A bar of white in black: columns 20 to 39, rows 8 to 21. */
static bool is_white(int x, int y) {
    return x >= 20 && x < 40 && y >= 8 && y < 22;
}

/* The display, what lies behind the pane, and the pane; half: of its sides, m. */
static World world_of(const char *panel, float half) {
    World world = world_start();
    Scene *scene = world.scene;
    uint8_t *pixels = ARENA_NEW(&world.arena, uint8_t, 4 * WIDE * HIGH);
    char path[512];
    for (int i = 0; i < WIDE * HIGH; i++) {
        memset(&pixels[4 * i], is_white(i % WIDE, i / WIDE) ? 255 : 0, 3);
        pixels[4 * i + 3] = 255;
    }
    snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, panel);
    assert_done(panel_open(path, &world.arena, &world.panel, &err));
    Display *display = world_display(&world);
    scene->textures[0] = (Texture){.image = {WIDE, HIGH, IMAGE_RGBA8, pixels}};
    scene->texture_count = 1;
    display->content.texture_id = 0;
    builder_quad(scene, middle, half_u, half_v);
    builder_part(scene, builder_lamp((float)BEHIND_CD_M2));
    builder_quad(scene, vec3(0, 0, -9), vec3(20, 0, 0), vec3(0, 20, 0));
    builder_part(scene, builder_pane((float)GLASS));
    Vec3 u = vec3(half, 0, 0), v = vec3_scale(vec3_cross(pane_normal(), vec3(1, 0, 0)), half);
    builder_quad(scene, vec3(0, 0, -PANE_M), u, v);
    world_ready(&world, 16);
    return world;
}

static SetupSymbol symbol_of(World *world) {
    static const int parts[1] = {0};
    SetupSymbol symbol = {.name = "bar", .display_name = "display", .display = {0, parts, 1}};
    SymbolQuestion question = {.panel = world->panel,
                               .uv = {0.1, 0.1, 0.9, 0.9},
                               .content = &world->scene->textures[0].image};
    SymbolPlace place = {world->scene, &symbol.display, {0.1, 0.1, 0.9, 0.9}, 256};
    SymbolSurface rectangle;
    assert_done(symbol_split(&question, &world->arena, &symbol.split, &err));
    assert_done(symbol_surface_build(&place, &world->arena, &rectangle, &err));
    memcpy(symbol.uv, place.uv, sizeof symbol.uv);
    double box[4] = {0.25, 0.2, 0.75, 0.8}; /* half of it is the bar */
    assert_done(symbol_surface_within(&rectangle, box, 256, &world->arena, &symbol.surface, &err));
    return symbol;
}

/* A case at that level, of images alone. */
static ReviewCase case_of(World *world, const ReviewRequest *request, const Vec3 *points, int count,
                          double level) {
    Setup setup = {.request = request,
                   .condition = &condition,
                   .scene = world->scene,
                   .context = world->context,
                   .tools = {.threads = 2}};
    SetupSymbol symbol = symbol_of(world);
    ReviewCase c = review_case_unknown();
    PrivateLook look = {&setup, &symbol, points, count};
    c.must_not_be_read = true;
    c.level = level;
    c.visible_share = 0;
    world->scene->displays[0].level = (float)level;
    assert_done(kernel_choose(NULL, &setup.tools.kernel, &err));
    private_images_find(&look, &c, &world->arena);
    return c;
}

/* ---- the closed form --------------------------------------------------------------------- */

static void slab(double cosine, double out[2]) {
    double inside = sqrt(1 - (1 - cosine * cosine) / (GLASS * GLASS));
    double s = (cosine - GLASS * inside) / (cosine + GLASS * inside);
    double p = (GLASS * cosine - inside) / (GLASS * cosine + inside);
    out[0] = 2 * s * s / (1 + s * s);
    out[1] = 2 * p * p / (1 + p * p);
}

/* Mirrored luminance of white and of black, each a mean over its own pixels, and what comes
 * through where the symbol's box stands. */
typedef struct Wanted {
    double white, black, through;
} Wanted;

static Wanted wanted_of(const Scene *scene) {
    double sum[2] = {0, 0}, passed = 0, count[2] = {0, 0}, sr = 0;
    for (int i = 0; i < WIDE * HIGH; i++) {
        int x = i % WIDE, y = i / WIDE, which = is_white(x, y);
        double u = (x + 0.5) / WIDE, v = (y + 0.5) / HIGH, r[2], part = 0.5;
        float s = (float)(2 * u - 1), t = (float)(1 - 2 * v), xyz[3], degree;
        if (u < 0.25 || u > 0.75 || v < 0.2 || v > 0.8) continue;
        Vec3 at = vec3_along(vec3_along(middle, half_u, s), half_v, t), axis;
        Vec3 way = vec3_sub(mirrored(eye), at), n = vec3_cross(half_u, half_v);
        double d2 = (double)vec3_dot(way, way);
        way = vec3_normalize(way);
        double w = (double)vec3_dot(n, way) / d2;
        uint32_t triangle = s > t ? 0 : 1; /* of the quad's two */
        float a = triangle ? (1 + s) / 2 : (s - t) / 2;
        float b = triangle ? (t - s) / 2 : (1 + t) / 2;
        TrianglePoint point = triangle_point(scene, triangle, a, b);
        assert_near((double)vec3_length(vec3_sub(point.position, at)), 0, 1e-5);
        display_emission_xyz(scene, &scene->displays[0], triangle, &point, way, xyz);
        slab(fabs((double)vec3_dot(way, pane_normal())), r);
        if (triangle_polarisation(scene, triangle, &point, way, &axis, &degree)) {
            Vec3 across = vec3_normalize(vec3_cross(way, pane_normal()));
            double along = (double)vec3_dot(axis, across);
            part = 0.5 * (1 - (double)degree) + (double)degree * along * along;
        }
        sum[which] += (double)xyz[1] * (part * r[0] + (1 - part) * r[1]);
        count[which]++;
        passed += w * (1 - 0.5 * (r[0] + r[1]));
        sr += w;
    }
    return (Wanted){sum[1] / count[1], sum[0] / count[0], BEHIND_CD_M2 * passed / sr};
}

static const char *const PANELS[] = {"ips_cluster", "oled_centre"};

/* Of panels whose light is polarised and is not, bright and dim: the formula's contrast lies in
 * the image's interval, which is small. */
TEST(the_contrast_in_a_flat_pane_is_the_formulas) {
    static const double LEVELS[] = {1, 0.02};
    ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
    for (int i = 0; i < 4; i++) {
        double level = LEVELS[i / 2];
        SCOPED_WORLD world = world_of(PANELS[i % 2], 3);
        ReviewCase c = case_of(&world, &request, &eye, 1, level);
        Wanted is = wanted_of(world.scene);
        double wanted = (is.white + is.through) / (is.black + is.through);
        assert_int_equal(c.image_count, 1);
        const CaseImage *image = &c.images[0];
        assert_near(image->shown_share, 1, 1e-6);
        assert_close(image->foreground, is.white, 0.03);
        assert_close(image->against, is.through, 0.03);
        if (!(image->contrast_low <= wanted && wanted <= image->contrast_high))
            fail_msg("%s at %g: %g (%g to %g), required %g", PANELS[i % 2], level,
                     image->contrast_ratio, image->contrast_low, image->contrast_high, wanted);
        assert_true(image->contrast_high < 1.06 * image->contrast_low);
        double v = privacy_security(image->foreground, image->background, image->against);
        assert_close(privacy_security_of_contrast(image->contrast_ratio), v, 1e-9);
    }
}

/* As high as the box is, seen from where the pane mirrors the eye to. */
TEST(its_height_is_that_of_the_mirrored_symbol) {
    ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
    SCOPED_WORLD world = world_of(PANELS[0], 3);
    ReviewCase c = case_of(&world, &request, &eye, 1, 1);
    double sum = 0;
    for (int k = 0; k < 9; k++) { /* of the bar: rows 8 to 22 of 30, columns 20 to 40 of 60 */
        float s = (float)(-1.0 / 3 + (k + 0.5) / 9 * 2 / 3);
        float top = 1 - 2 * 8.0f / 30, bottom = 1 - 2 * 22.0f / 30;
        Vec3 a = vec3_along(vec3_along(middle, half_u, s), half_v, top);
        Vec3 b = vec3_along(vec3_along(middle, half_u, s), half_v, bottom);
        a = vec3_normalize(mirrored(a));
        b = vec3_normalize(mirrored(b));
        sum += atan2((double)vec3_length(vec3_cross(a, b)), (double)vec3_dot(a, b));
    }
    assert_close(c.images[0].height_arcmin, 60 * degrees_from_radians(sum / 9), 0.01);
}

/* Of an eye's places the one counts from which the pane shows it; from none: there is no image.
 * What the request says is seen against at least counts. */
TEST(places_and_what_lies_behind_at_least) {
    const Vec3 points[] = {{0, 5, 0}, {0, 0, 0}};
    ReviewPaneImages panes = {.against_cd_m2 = 100};
    ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
    SCOPED_WORLD world = world_of(PANELS[0], 1);
    ReviewCase far = case_of(&world, &request, points, 1, 1);
    ReviewCase both = case_of(&world, &request, points, 2, 1);
    assert_int_equal(far.image_count, 0);
    assert_int_equal(both.image_count, 1);
    assert_near(both.images[0].eye_m[1], 0, 1e-9);
    request.pane_images = &panes;
    ReviewCase least = case_of(&world, &request, points + 1, 1, 1);
    assert_near(least.images[0].against, 100, 0);
    assert_true(least.images[0].contrast_ratio < both.images[0].contrast_ratio);
}

/* ---- verdicts ---------------------------------------------------------------------------- */

/* An image that mirrors 0.1 +- 0.005 of 10 and 0.1 cd/m2 against 1 +- 0.05. */
static CaseImage some_image(const char *pane) {
    CaseImage image = {.pane = pane,
                       .shown_share = 1,
                       .height_arcmin = 20,
                       .sent_foreground = 10,
                       .sent_background = 0.1,
                       .reflectance = 0.1,
                       .reflectance_range = {0.095, 0.105},
                       .against = 1,
                       .against_range = {0.95, 1.05}};
    case_image_set_contrast(&image, 0);
    return image;
}

TEST(an_interval_holds_both_doubts_and_the_panels) {
    CaseImage i = some_image("a");
    double c = 2 / 1.01;
    double low = hypot(c - 1.95 / 1.0095, c - 2.05 / 1.06);
    double high = hypot(2.05 / 1.0105 - c, 1.95 / 0.96 - c);
    assert_close(i.contrast_ratio, c, 1e-12);
    assert_close(i.contrast_low, c - low, 1e-9);
    assert_close(i.contrast_high, c + high, 1e-9);
    case_image_set_contrast(&i, 0.01);
    double off = 0.01 * INTERVAL_SIGMAS;
    double more = hypot((1 - off + 1) / 1.01 - c, 2 / (1.01 + 0.01 * off) - c);
    assert_close(i.contrast_low, c - hypot(low, more), 1e-9);
    i.against = i.against_range.low = i.against_range.high = 0; /* before black it stands out */
    i.sent_background = 0;
    case_image_set_contrast(&i, 0);
    assert_true(isinf(i.contrast_ratio) && isinf(i.contrast_high));
    assert_near(privacy_s_of_contrast(i.contrast_ratio), 0, 0);
}

/* Limits below, in and above the interval of S of the image, while the symbol itself is hidden
 * or surely not read. */
ARENA_TEST(a_case_is_as_bad_as_its_worst_image) {
    CaseImage images[2] = {some_image("left"), some_image("right")};
    images[1].reflectance *= 0.01; /* hardly anything */
    images[1].reflectance_range.low *= 0.01;
    images[1].reflectance_range.high *= 0.01;
    case_image_set_contrast(&images[1], 0);
    double low = privacy_s_of_contrast(images[0].contrast_high);
    double high = privacy_s_of_contrast(images[0].contrast_low);
    const double limits[] = {0.9 * low, 0.5 * (low + high), 1.1 * high};
    const Verdict wanted[] = {VERDICT_PASS, VERDICT_TOO_CLOSE, VERDICT_FAIL};
    for (int k = 0; k < 6; k++) {
        Profile profile = {.security = {.name = "visual security",
                                        .value = limits[k / 2],
                                        .kind = LIMIT_VISUAL_SECURITY,
                                        .ambients = {true, true, true, true}}};
        ReviewCase c = review_case_unknown();
        bool is_seen = k % 2;
        c.must_not_be_read = true;
        c.images = images;
        c.image_count = 2;
        c.visible_share = is_seen;
        c.luminance_cd_m2.foreground = 1;
        c.luminance_cd_m2.background = 0.5;
        c.luminance_cd_m2.reflected = 1000;
        if (is_seen) judge_contrasts(&c, (MeanInterval){999, 1001});
        judge_case(&c, &profile, &arena);
        judge_open(&c, 0);
        assert_int_equal(c.verdict, wanted[k / 2]);
        assert_int_equal(c.limit_count, 2 + is_seen);
        assert_int_equal(c.images[0].verdict, wanted[k / 2]);
        assert_int_equal(c.images[1].verdict, VERDICT_PASS);
        assert_int_equal(c.unjudged, UNJUDGED_NOT);
        const LimitVerdict *least = &c.limits[c.limit_id];
        assert_string_equal(least->by_pane, "left");
        assert_near(c.margin, privacy_s_of_contrast(images[0].contrast_ratio) / limits[k / 2] - 1,
                    1e-9);
        assert_ptr_equal(case_image_of(&c, least), &c.images[0]);
        assert_null(is_seen ? c.limits[0].by_pane : NULL);
        assert_int_equal(case_kept_by(&c), k < 2 ? KEPT_SECURITY : KEPT_NOT);
        assert_int_equal(c.open_by, k / 2 == 1 ? OPEN_BY_IMAGE : OPEN_NOT);
    }
}

/* Twice as bright a display: as if it had been read so. */
ARENA_TEST(a_brighter_display_has_brighter_images) {
    CaseImage image = some_image("a"), twice = image;
    ReviewCase c = review_case_unknown();
    c.images = &image;
    c.image_count = 1;
    twice.sent_foreground *= 2;
    twice.sent_background *= 2;
    case_image_set_contrast(&twice, 0);
    const CaseImage *scaled = case_images_scaled(&c, 2, &arena);
    assert_close(scaled->contrast_ratio, twice.contrast_ratio, 1e-12);
    assert_close(scaled->contrast_low, twice.contrast_low, 1e-12);
    assert_close(scaled->foreground, 2, 1e-12);
}

TEST_PROGRAM(make_arena, drop_arena)
