/* SPDX-License-Identifier: Apache-2.0 */
/* Images of displays in glass against plane geometry and Fresnel's formulas. */
#include "fixture.h"

#include "base/units.h"
#include "light/emission.h"
#include "mirror/reflection_point.h"
#include "review/eye/pane_image_reading.h"
#include "review/eye/pane_images.h"
#include "spectrum/glazing.h"
#include "world_fixture.h"

/* The eye looks along -Z at a windscreen that leans over a display below. */
#define LEAN_DEG 28.0f /* of the pane, from the horizontal */
#define PANE_M 0.8f    /* from the eye to the pane, straight ahead */

static const ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};
static const Vec3 eye = {0, 0, 0};

/* A display: its middle and half its edges. */
typedef struct Screen {
    Vec3 middle, half_u, half_v;
} Screen;

/* Turned up and towards the pane, 10 cm to the right. */
static const Screen below = {{0.1f, -0.35f, -0.6f}, {0.12f, 0, 0}, {0, 0.02f, -0.06f}};

typedef struct Sheet {
    Vec3 point, normal; /* unit, to the side of the eye */
} Sheet;

static Sheet pane_plane(void) {
    float a = radians_from_degrees(LEAN_DEG);
    return (Sheet){vec3(0, 0, -PANE_M), vec3(0, -cosf(a), sinf(a))};
}

/* half: of its sides, m. */
static void add_pane(World *world, Material material, float half) {
    Sheet plane = pane_plane();
    Vec3 u = vec3(half, 0, 0), v = vec3_scale(vec3_cross(plane.normal, vec3(1, 0, 0)), half);
    builder_part(world->scene, material);
    builder_quad(world->scene, plane.point, u, v);
}

static Vec3 mirrored(Vec3 p) {
    Sheet plane = pane_plane();
    float height = vec3_dot(plane.normal, vec3_sub(p, plane.point));
    return vec3_along(p, plane.normal, -2 * height);
}

static void add_display(World *world, Screen place) {
    world_display(world);
    builder_quad(world->scene, place.middle, place.half_u, place.half_v);
}

static Setup setup_of(World *world) {
    Setup setup = {.request = &request, .tools = {.threads = 2}};
    assert_done(kernel_choose(NULL, &setup.tools.kernel, &err));
    world_ready(world, 16);
    setup.scene = world->scene;
    setup.context = world->context;
    return setup;
}

static PaneImage *find(const Setup *setup, World *world) {
    int count;
    PaneImage *images = pane_images_find(setup, eye, &count, &world->arena);
    assert_int_equal(count, 1);
    assert_near(images->share.shown + images->share.ends + images->share.away +
                    images->share.covered,
                1, 1e-6);
    return images;
}

static double degrees_between(Vec3 a, Vec3 b) {
    Vec3 c = vec3_cross(a, b);
    return degrees_from_radians(atan2((double)vec3_length(c), (double)vec3_dot(a, b)));
}

/* The display's corner k, once around. */
static Vec3 corner_of(Screen place, int k) {
    float s = k == 0 || k == 3 ? -1 : 1, t = k < 2 ? -1 : 1;
    return vec3_along(vec3_along(place.middle, place.half_u, s), place.half_v, t);
}

/* ---- where ------------------------------------------------------------------------------- */

#define WITHIN_DEG 0.05

TEST(corners_stand_where_the_panes_plane_mirrors_them) {
    SCOPED_WORLD world = world_start();
    add_display(&world, below);
    add_pane(&world, builder_pane(1.52f), 3);
    Setup setup = setup_of(&world);
    PaneImage *image = find(&setup, &world);
    assert_near(image->share.shown, 1, 1e-6);
    assert_int_equal(image->outline_count, 4);
    for (int k = 0; k < 4; k++) {
        Vec3 wanted = vec3_normalize(mirrored(corner_of(below, k)));
        double least = 180;
        for (int i = 0; i < 4; i++) least = fmin(least, degrees_between(image->outline[i], wanted));
        if (!(least < WITHIN_DEG)) fail_msg("corner %d: %g degrees off", k, least);
    }
}

/* Mean direction and solid angle, by a fine raster of the mirrored display. */
TEST(middle_and_size_are_the_mirrored_displays) {
    SCOPED_WORLD world = world_start();
    add_display(&world, below);
    add_pane(&world, builder_pane(1.52f), 3);
    Setup setup = setup_of(&world);
    PaneImage *image = find(&setup, &world);
    Vec3 n = vec3_sub(mirrored(vec3_cross(below.half_u, below.half_v)), mirrored(vec3(0, 0, 0)));
    double sr = 0, sum[3] = {0, 0, 0};
    for (int i = 0; i < 400 * 400; i++) {
        float s = ((float)(i % 400) + 0.5f) / 200 - 1, t = ((float)(i / 400) + 0.5f) / 200 - 1;
        Vec3 at = vec3_along(vec3_along(below.middle, below.half_u, s), below.half_v, t);
        Vec3 p = mirrored(at);
        double d2 = (double)vec3_dot(p, p), d = sqrt(d2);
        double w = 4 * fabs((double)vec3_dot(n, p)) / (d2 * d) / (400 * 400);
        sr += w;
        sum[0] += w * (double)p.x / d;
        sum[1] += w * (double)p.y / d;
        sum[2] += w * (double)p.z / d;
    }
    assert_near(image->sr, sr, 1e-4 * sr);
    double off = degrees_between(image->towards, vec3_from_doubles(sum));
    if (!(off < 0.005)) fail_msg("%g degrees off", off);
}

/* Of a pane that is bent as a sphere: where the law of reflection holds on the sphere itself.
 * Facets of 1 cm with normals of the sphere; corners of the display as the eye sees them. */
TEST(a_bent_pane_shows_a_point_where_its_normals_turn_the_ray) {
    static const double RADIUS = 2;
    MirrorTriangle t;
    Vec3 source = vec3(0.2f, -0.3f, -0.4f), centre = vec3(0, -0.9f, 0.9f);
    int met = 0;
    for (int i = 0; i < 60 * 60 * 2; i++) {
        double at[3][2];
        for (int k = 0; k < 3; k++) {
            int x = i / 2 % 60 + (i % 2 ? k > 0 : k == 1);
            int y = i / 120 + (i % 2 ? k < 2 : k == 2);
            at[k][0] = (x - 30) * 0.01;
            at[k][1] = (y - 30) * 0.01;
            Vec3 local = vec3((float)at[k][0], (float)at[k][1] + 0.7071f, -0.7071f);
            t.normal[k] = vec3_neg(vec3_normalize(local));
            t.position[k] = vec3_along(centre, t.normal[k], (float)-RADIUS);
        }
        ReflectionPoint found[REFLECTION_POINTS_MAX];
        const ReflectionLight light = {source, true};
        if (!reflection_points_find(&t, eye, &light, found)) continue;
        Vec3 place = vec3_scale(t.position[0], 1 - found[0].u - found[0].v);
        place = vec3_along(vec3_along(place, t.position[1], found[0].u), t.position[2], found[0].v);
        Vec3 n = vec3_normalize(vec3_sub(place, centre));
        Vec3 d = vec3_normalize(vec3_sub(place, eye));
        Vec3 s = vec3_normalize(vec3_sub(source, place));
        double off = degrees_between(vec3_along(d, n, -2 * vec3_dot(n, d)), s);
        if (!(off < 0.01)) fail_msg("%g degrees off the law of reflection", off);
        met++;
    }
    assert_int_equal(met, 1);
}

/* ---- none -------------------------------------------------------------------------------- */

TEST(a_pane_that_ends_before_shows_none_and_says_so) {
    SCOPED_WORLD world = world_start();
    add_display(&world, below);
    add_pane(&world, builder_pane(1.52f), 0.02f);
    Setup setup = setup_of(&world);
    PaneImage *image = find(&setup, &world);
    assert_int_equal(image->cell_count, 0);
    assert_near(image->share.ends, 1, 1e-6);
}

TEST(a_display_that_turns_its_back_shows_none_and_says_so) {
    SCOPED_WORLD world = world_start();
    Screen back = {below.middle, vec3_neg(below.half_u), below.half_v};
    add_display(&world, back);
    add_pane(&world, builder_pane(1.52f), 3);
    Setup setup = setup_of(&world);
    PaneImage *image = find(&setup, &world);
    assert_int_equal(image->cell_count, 0);
    assert_near(image->share.away, 1, 1e-6);
}

/* A hood before the pane or over the display: of all of it, or of its right half. */
TEST(what_stands_between_hides_it_and_is_named) {
    for (int i = 0; i < 4; i++) {
        bool is_half = i & 1, is_at_display = i & 2;
        float width = 1.2f * below.half_u.x;
        SCOPED_WORLD world = world_start();
        add_display(&world, below);
        builder_part(world.scene, builder_material(0.5f));
        Vec3 at = is_at_display ? vec3(below.middle.x, below.middle.y + 0.001f, below.middle.z)
                                : vec3_scale(vec3_normalize(mirrored(below.middle)), 0.3f);
        if (is_half) at.x += is_at_display ? width : 0.25f * 1;
        Vec3 along = is_at_display ? vec3_scale(below.half_v, 1.2f) : vec3(0, 0.25f, 0);
        builder_quad(world.scene, at, vec3(is_at_display ? width : 0.25f, 0, 0), along);
        add_pane(&world, builder_pane(1.52f), 3);
        Setup setup = setup_of(&world);
        PaneImage *image = find(&setup, &world);
        assert_int_equal(image->covered_by, 1);
        if (!is_half) assert_int_equal(image->cell_count, 0);
        if (is_half && !(image->share.covered > 0.2 && image->share.covered < 0.8))
            fail_msg("%d: %g of it is covered", i, image->share.covered);
        assert_near(image->share.covered + image->share.shown, 1, 1e-6);
    }
}

/* A raster over the display's first triangle, of whose places the later fields are none. */
TEST(a_place_that_the_display_lacks_is_not_shown) {
    static PaneRaster raster;
    const int wide = PANE_RASTER + 1, cells = 2 * PANE_RASTER * PANE_RASTER;
    SCOPED_WORLD world = world_start();
    add_display(&world, below);
    add_pane(&world, builder_pane(1.52f), 3);
    Setup setup = setup_of(&world);
    for (int lacking = 0; lacking < 2; lacking++) {
        for (int i = 0; i < wide * wide; i++) {
            float v = (float)(i / wide) / PANE_RASTER;
            float u = (float)(i % wide) / PANE_RASTER * (1 - v);
            raster.corner[i] = triangle_point(setup.scene, 0, u, v);
            raster.has_corner[i] = !lacking || i / wide <= PANE_RASTER / 2;
        }
        for (int i = 0; i < cells; i++) {
            float v = ((float)(i / 2 / PANE_RASTER) + 0.5f) / PANE_RASTER;
            float u = ((float)(i / 2 % PANE_RASTER) + 0.5f) / PANE_RASTER * (1 - v);
            raster.middle[i] = triangle_point(setup.scene, 0, u, v);
            raster.has_middle[i] = !lacking || i < cells / 2;
        }
        PaneImage image = pane_image_of(&setup, eye, 1, &raster, &world.arena);
        assert_near(image.share.shown, lacking ? 0.5 : 1, 1e-9);
        assert_near(image.share.ends, lacking ? 0.5 : 0, 1e-9);
    }
}

/* ---- how bright -------------------------------------------------------------------------- */

#define GLASS 1.52
#define BEHIND_CD_M2 3.0

/* What two faces with all that goes to and fro between them reflect, s and p. */
static void slab(double cosine, double out[2]) {
    double inside = sqrt(1 - (1 - cosine * cosine) / (GLASS * GLASS));
    double s = (cosine - GLASS * inside) / (cosine + GLASS * inside);
    double p = (GLASS * cosine - inside) / (GLASS * cosine + inside);
    out[0] = 2 * s * s / (1 + s * s);
    out[1] = 2 * p * p / (1 + p * p);
}

/* The share of a point's light along `way` (from the display) that the pane mirrors. */
static double reflectance(const Scene *scene, uint32_t triangle, const TrianglePoint *point,
                          Vec3 way) {
    Sheet plane = pane_plane();
    Vec3 across = vec3_normalize(vec3_cross(way, plane.normal)), axis;
    float degree;
    double r[2], s = 0.5;
    slab(fabs((double)vec3_dot(way, plane.normal)), r);
    if (triangle_polarisation(scene, triangle, point, way, &axis, &degree)) {
        double along = (double)vec3_dot(axis, across);
        s = 0.5 * (1 - (double)degree) + (double)degree * along * along;
    }
    return s * r[0] + (1 - s) * r[1];
}

#define SIDE 120

/* Mean over the image's solid angle of what the display sends by its emission's own query;
 * through: of the share that passes of unpolarised light from behind. What lies towards
 * `hidden` of the display's middle does not count; 0: all of it does. */
static double wanted_cd_m2(const World *world, Screen place, Vec3 hidden, double *through) {
    const Scene *scene = world->scene;
    Vec3 n = vec3_cross(place.half_u, place.half_v);
    double sum = 0, weights = 0, passed = 0;
    for (uint32_t t = 0; t < 2; t++)
        for (int i = 0; i < SIDE * SIDE; i++) {
            float u = ((float)(i % SIDE) + 0.5f) / SIDE, v = ((float)(i / SIDE) + 0.5f) / SIDE;
            float xyz[3];
            if (u + v > 1) u = 1 - u, v = 1 - v;
            TrianglePoint point = triangle_point(scene, t, u, v);
            if (vec3_dot(vec3_sub(point.position, place.middle), hidden) > 0) continue;
            Vec3 to = mirrored(point.position);
            double d2 = (double)vec3_dot(to, to), r[2];
            Vec3 way = vec3_normalize(vec3_sub(mirrored(eye), point.position));
            double w = (double)vec3_dot(n, way) / d2;
            display_emission_xyz(scene, &scene->displays[0], t, &point, way, xyz);
            slab(fabs((double)vec3_dot(way, pane_plane().normal)), r);
            sum += w * (double)xyz[1] * reflectance(scene, t, &point, way);
            passed += w * (1 - 0.5 * (r[0] + r[1]));
            weights += w;
        }
    *through = BEHIND_CD_M2 * passed / weights;
    return sum / weights;
}

/* Panels whose light is polarised, and is not. */
static const char *const PANELS[] = {"ips_cluster", "oled_centre"};

static void open_panel(World *world, const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, name);
    assert_done(panel_open(path, &world->arena, &world->panel, &err));
}

/* Over the pane, beyond the display: the eye sees it through the pane. */
static void add_behind(World *world) {
    builder_part(world->scene, builder_lamp((float)BEHIND_CD_M2));
    builder_quad(world->scene, vec3(0, 0, -9), vec3(20, 0, 0), vec3(0, 20, 0));
}

static PaneImageReading read_image(const Setup *setup, const PaneImage *image, Arena scratch) {
    PaneImageGoal goal = {eye, image, 0.01, 1 << 15, 0};
    return pane_image_read(setup, &goal, scratch);
}

/* By three standard errors, which are small. */
static void assert_found(const char *what, Estimate found, double wanted) {
    double off = fabs(found.mean - wanted);
    if (!(off <= 3 * found.sigma + 1e-3 * wanted && found.sigma <= 0.011 * wanted))
        fail_msg("%s: %g +- %g cd/m2, required %g", what, found.mean, found.sigma, wanted);
    assert_true(found.interval.low <= found.mean && found.mean <= found.interval.high);
}

TEST(luminance_is_what_glass_mirrors_of_the_emission_towards_it) {
    for (int i = 0; i < 2; i++) {
        double through;
        SCOPED_WORLD world = world_start();
        open_panel(&world, PANELS[i]);
        add_display(&world, below);
        add_behind(&world);
        add_pane(&world, builder_pane((float)GLASS), 3);
        Setup setup = setup_of(&world);
        PaneImageReading found = read_image(&setup, find(&setup, &world), world.arena);
        double wanted = wanted_cd_m2(&world, below, vec3(0, 0, 0), &through);
        assert_found(PANELS[i], found.image, wanted);
        assert_found("through", found.through, through);
        assert_true(found.against.mean >= found.through.mean);
        assert_true(found.ghost_share == 0 && isnan(found.ghost_rad));
    }
}

/* By a hood just over the display whose edge runs aslant through its middle: half of it is
 * left, and the brighter or the darker half decides. */
TEST(what_is_hidden_in_part_counts_as_far_as_it_is_seen) {
    for (int i = 0; i < 2; i++) {
        double through;
        SCOPED_WORLD world = world_start();
        open_panel(&world, "oled_centre");
        add_display(&world, below);
        builder_part(world.scene, builder_material(0));
        Vec3 a = vec3_normalize(below.half_u), b = vec3_normalize(below.half_v);
        Vec3 e = vec3_scale(vec3_along(b, a, 0.4f), i ? -0.4f : 0.4f);
        Vec3 n = vec3_cross(a, b), f = vec3_cross(n, e);
        builder_quad(world.scene, vec3_along(vec3_add(below.middle, e), n, 1e-4f), e, f);
        add_pane(&world, builder_pane((float)GLASS), 3);
        Setup setup = setup_of(&world);
        PaneImage *image = find(&setup, &world);
        assert_near(image->share.shown, 0.5, 0.003);
        PaneImageReading found = read_image(&setup, image, world.arena);
        assert_found(i ? "far half" : "near half", found.image,
                     wanted_cd_m2(&world, below, e, &through));
    }
}

/* Of a laminated pane the far face shows a second image, d 2 tan t' along the pane and so
 * s = d sin 2t / sqrt(n^2 - sin^2 t) across the rays: nearer to the eye than the first, so that
 * the first's far rim lacks the second's light. */
TEST(a_laminated_panes_image_has_its_ghost) {
    static const Glazing glazing = {
        .layers = {{0.0021f, (float)GLASS}, {0.00076f, (float)GLASS}, {0.0021f, (float)GLASS}},
        .layer_count = 3,
        .absorbing_ior = (float)GLASS,
        .wedge_ior = (float)GLASS};
    double through;
    SCOPED_WORLD world = world_start();
    open_panel(&world, "oled_centre");
    add_display(&world, below);
    add_behind(&world);
    Material laminated = builder_pane((float)GLASS);
    laminated.glazing = &glazing;
    add_pane(&world, laminated, 3);
    Setup setup = setup_of(&world);
    PaneImage *image = find(&setup, &world);
    PaneImageReading found = read_image(&setup, image, world.arena);
    double both = wanted_cd_m2(&world, below, vec3(0, 0, 0), &through);
    double cosine = fabs((double)vec3_dot(image->towards, pane_plane().normal));
    double r[2], sine2 = 1 - cosine * cosine, ghost = 0, all = 0;
    slab(cosine, r);
    for (int k = 0; k < 2; k++) {
        all += r[k];
        ghost += r[k] - r[k] / (2 - r[k]); /* one face: R = 2 r / (1 + r) */
    }
    double apart = 0.00496 * 2 * sqrt(sine2) * cosine / sqrt(GLASS * GLASS - sine2);
    double far = (double)vec3_length(mirrored(below.middle));
    double low = 10, high = -10;
    for (int k = 0; k < 4; k++) {
        Vec3 corner = vec3_normalize(mirrored(corner_of(below, k)));
        double up = atan2((double)corner.y, -(double)corner.z);
        low = fmin(low, up);
        high = fmax(high, up);
    }
    assert_near(found.ghost_rad, apart / far, 0.02 * apart / far);
    assert_near(found.ghost_share, ghost / all, 0.03);
    double lacks = apart / far / (high - low) * ghost / all;
    assert_true(lacks > 0.01 && lacks < 0.1);
    double wanted = both * (1 - lacks), off = fabs(found.image.mean - wanted);
    if (!(off < 3 * found.image.sigma + 0.005 * both && found.image.sigma < 0.011 * both))
        fail_msg("%g +- %g cd/m2, required %g; without a shift %g", found.image.mean,
                 found.image.sigma, wanted, both);
}

/* A wedge turns the ghost by 2 a sqrt(n^2 - sin^2 t) / cos t: on the way b from the pane to the
 * display as far as the thickness puts it, one way back onto the image, the other way twice as
 * far. */
TEST(a_wedge_moves_the_ghost_back_or_twice_as_far) {
    double rad[2];
    Vec3 middle = mirrored(below.middle);
    double far = (double)vec3_length(middle), apart = 0;
    for (int i = 0; i < 2; i++) {
        SCOPED_WORLD world = world_start();
        Sheet plane = pane_plane();
        double cosine = fabs((double)vec3_dot(vec3_normalize(middle), plane.normal));
        double root = sqrt(GLASS * GLASS - 1 + cosine * cosine);
        double to_pane = (double)vec3_dot(plane.point, plane.normal) /
                         (double)vec3_dot(vec3_normalize(middle), plane.normal);
        apart = 0.00496 * 2 * sqrt(1 - cosine * cosine) * cosine / root;
        double wedge = apart * cosine / (2 * (far - to_pane) * root);
        Glazing glazing = {.layers = {{0.00496f, (float)GLASS}},
                           .layer_count = 1,
                           .absorbing_ior = (float)GLASS,
                           .wedge_ior = (float)GLASS,
                           .wedge = {0, (float)(i ? wedge : -wedge)}};
        Material laminated = builder_pane((float)GLASS);
        open_panel(&world, "oled_centre");
        add_display(&world, below);
        laminated.glazing = &glazing;
        add_pane(&world, laminated, 3);
        Setup setup = setup_of(&world);
        PaneImageReading found = read_image(&setup, find(&setup, &world), world.arena);
        rad[i] = isnan(found.ghost_rad) ? 0 : found.ghost_rad;
    }
    if (!(fmin(rad[0], rad[1]) < 0.3 * apart / far))
        fail_msg("%g, %g rad: none of %g", rad[0], rad[1], apart / far);
    assert_near(fmax(rad[0], rad[1]), 2 * apart / far, 0.06 * apart / far);
}

TEST_PROGRAM(NULL, NULL)
