/* SPDX-License-Identifier: Apache-2.0 */
/* What a frame's pixel covers behind mirrors and glass: against rays beside it, and closed
 * forms of optics. */
#include "fixture.h"

#include "base/count.h"
#include "base/units.h"
#include "path/footprint.h"
#include "scene_builder.h"

/* ---- rays in doubles --------------------------------------------------------------------- */

typedef struct Ray3 {
    double at[3], way[3];
} Ray3;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalize3(double a[3])
{
    double length = sqrt(dot3(a, a));
    for (int k = 0; k < 3; k++) a[k] /= length;
}

static void spread3(Vec3 v, double out[3])
{
    out[0] = (double)v.x, out[1] = (double)v.y, out[2] = (double)v.z;
}

/* A triangle in the plane z = 0, its corners (0, 0), (1, 0), (0, 1), and the normals there. */
typedef struct Bent {
    double normal[3][3];
} Bent;

/* eta: the index before over that behind; 0: a mirror. */
static void turn3(const Bent *bent, double eta, Ray3 *ray)
{
    double t = -ray->at[2] / ray->way[2], n[3];
    for (int k = 0; k < 3; k++) ray->at[k] += t * ray->way[k];
    for (int k = 0; k < 3; k++)
        n[k] = (1 - ray->at[0] - ray->at[1]) * bent->normal[0][k] +
               ray->at[0] * bent->normal[1][k] + ray->at[1] * bent->normal[2][k];
    normalize3(n);
    double c = dot3(n, ray->way);
    if (c > 0) {
        for (int k = 0; k < 3; k++) n[k] = -n[k];
        c = -c;
    }
    double root = sqrt(1 - eta * eta * (1 - c * c));
    for (int k = 0; k < 3; k++)
        ray->way[k] = eta > 0 ? eta * ray->way[k] - (eta * c + root) * n[k]
                              : ray->way[k] - 2 * c * n[k];
}

/* ---- the same by footprints -------------------------------------------------------------- */

static Arena arena; /* the test's */

/* A scene of the one triangle. */
static Scene *scene_of(const Bent *bent, bool is_glass)
{
    Scene   *scene = builder_scene(&arena);
    Material material = builder_material(1);
    uint32_t corner[3];
    material.metallic = is_glass ? 0 : 1;
    material.roughness = 0;
    material.transmission = is_glass ? 1 : 0;
    material.is_solid = is_glass;
    builder_part(scene, material);
    for (int i = 0; i < 3; i++)
        corner[i] = builder_vertex(scene, vec3(i == 1, i == 2, 0),
                                   vec3((float)bent->normal[i][0], (float)bent->normal[i][1],
                                        (float)bent->normal[i][2]), i == 1, i == 2);
    builder_triangle(scene, corner[0], corner[1], corner[2]);
    return scene;
}

/* The ray's turn at the scene's triangle, `distance` m behind its origin. */
static bool turn(const Scene *scene, const Ray3 *before, const Ray3 *behind, double distance,
                 RayFootprint *footprint)
{
    static Wavelengths w;
    Vec3    wo = vec3(-(float)before->way[0], -(float)before->way[1], -(float)before->way[2]);
    Hit     hit = {(float)distance, (float)behind->at[0], (float)behind->at[1], 0};
    Surface surface;
    wavelengths_sample(0.5f, &w);
    surface_at(scene, surface_tables_build(scene, false, &arena), &hit, wo, &w, &surface);
    Vec3       wi = vec3((float)behind->way[0], (float)behind->way[1], (float)behind->way[2]);
    BsdfSample next = {.wi = frame_to_local(&surface.frame, wi), .is_delta = true};
    return footprint_turn(footprint, scene, &surface, wo, &next, (float)distance);
}

static double next_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 33) / 2147483648.0;
}

static double between(uint64_t *state, double low, double high)
{
    return low + (high - low) * next_number(state);
}

static Vec3 across_randomly(const Frame *frame, uint64_t *state)
{
    float x = (float)between(state, -1, 1), y = (float)between(state, -1, 1);
    return frame_to_world(frame, vec3(x, y, 0));
}

#define STEP 2e-3 /* of the rays beside, in units of the footprint */

/* Place and way of the ray that is `side` steps beside, before the surface. */
static Ray3 beside(const Ray3 *ray, const RayFootprint *footprint, int i, double side)
{
    Ray3   out = *ray;
    double place[3], way[3];
    spread3(footprint->place[i], place);
    spread3(footprint->way[i], way);
    for (int k = 0; k < 3; k++) {
        out.at[k] += side * STEP * place[k];
        out.way[k] += side * STEP * way[k];
    }
    normalize3(out.way);
    return out;
}

/* Bent mirrors and glass, from either side: the rays beside, followed for a metre more. */
TEST(rays_beside_go_where_the_footprint_says)
{
    arena = test_arena(state);
    uint64_t random = 7;
    double   worst = 0;
    for (int run = 0; run < 3000; run++) {
        static const double etas[] = {0, 1 / 1.5, 1.5};
        double eta = etas[run % 3];
        Arena  before_all = arena;
        Bent   bent;
        Ray3   ray = {{between(&random, 0.2, 0.4), between(&random, 0.2, 0.4), 0}, {0}};
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 2; k++) bent.normal[i][k] = between(&random, -0.3, 0.3);
            bent.normal[i][2] = 1;
            normalize3(bent.normal[i]);
        }
        double up = eta > 1 ? 1 : -1, lean = eta > 1 ? 0.25 : 0.7, distance = 0.5;
        for (int k = 0; k < 2; k++) ray.way[k] = between(&random, -lean, lean);
        ray.way[2] = up; /* the solid lies below */
        normalize3(ray.way);
        for (int k = 0; k < 3; k++) ray.at[k] -= distance * ray.way[k];
        RayFootprint footprint = {.place = {{0}}};
        Frame     frame = frame_from_z(vec3((float)ray.way[0], (float)ray.way[1],
                                            (float)ray.way[2]));
        for (int i = 0; i < 2; i++) {
            footprint.place[i] = across_randomly(&frame, &random);
            footprint.way[i] = across_randomly(&frame, &random);
        }
        Ray3 middle = ray, sides[2][2];
        for (int i = 0; i < 4; i++) {
            sides[i / 2][i % 2] = beside(&ray, &footprint, i / 2, i % 2 ? 1 : -1);
            turn3(&bent, eta, &sides[i / 2][i % 2]);
        }
        turn3(&bent, eta, &middle);
        assert_true(turn(scene_of(&bent, eta > 0), &ray, &middle, distance, &footprint));
        Frame out = frame_from_z(vec3((float)middle.way[0], (float)middle.way[1],
                                      (float)middle.way[2]));
        Vec3 across[2];
        footprint_across(&footprint, 1, &out, across);
        for (int i = 0; i < 2; i++) {
            double moved[3], found[2] = {(double)across[i].x, (double)across[i].y};
            for (int k = 0; k < 3; k++)
                moved[k] = (sides[i][1].at[k] + sides[i][1].way[k] - sides[i][0].at[k] -
                            sides[i][0].way[k]) / (2 * STEP);
            double axes[2][3], size = sqrt(dot3(moved, moved)) + 1;
            spread3(out.x, axes[0]);
            spread3(out.y, axes[1]);
            for (int k = 0; k < 2; k++)
                worst = fmax(worst, fabs(found[k] - dot3(moved, axes[k])) / size);
        }
        arena = before_all;
    }
    print_message("worst: %.2g\n", worst);
    assert_true(worst < 1e-4);
}

/* ---- closed forms ------------------------------------------------------------------------ */

static const Bent flat = {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};

static RayFootprint camera_at(const Ray3 *ray, RayCone cone)
{
    return footprint_of_cone(cone, vec3((float)ray->way[0], (float)ray->way[1],
                                        (float)ray->way[2]));
}

static void assert_width(const RayFootprint *footprint, const Ray3 *ray, double distance,
                         double wanted)
{
    Vec3  across[2];
    Frame frame = frame_from_z(vec3((float)ray->way[0], (float)ray->way[1],
                                    (float)ray->way[2]));
    footprint_across(footprint, (float)distance, &frame, across);
    for (int i = 0; i < 2; i++)
        assert_close(hypot((double)across[i].x, (double)across[i].y), wanted, 1e-5);
    assert_near(across[0].x * across[1].x + across[0].y * across[1].y, 0,
                1e-5 * wanted * wanted);
}

TEST(behind_flat_mirrors_a_pixel_covers_what_the_whole_way_says)
{
    arena = test_arena(state);
    for (int i = 0; i < 8; i++) {
        double    theta = 0.19 * i;
        Ray3      ray = {{0.3, 0.3, 0}, {sin(theta), 0, -cos(theta)}}, behind = ray;
        RayFootprint footprint = camera_at(&ray, (RayCone){0.001f, 0.01f});
        turn3(&flat, 0, &behind);
        assert_true(turn(scene_of(&flat, false), &ray, &behind, 0.7, &footprint));
        assert_width(&footprint, &behind, 0.9, 0.001 + 0.01 * (0.7 + 0.9));
    }
}

/* Beside an edge a mirrored ray starts off it; the exact one starts where the mirror is met. */
TEST(the_exact_ray_starts_where_it_meets_the_mirror)
{
    arena = test_arena(state);
    const double beside = 1e-6;
    Ray3         down = {{0.3, beside, 0}, {0, 0, -1}}, up = {{0.3, beside, 0}, {0, 0, 1}};
    RayFootprint footprint = camera_at(&down, (RayCone){0.001f, 0.01f});
    Scene       *scene = scene_of(&flat, false);
    TextureSlot  slot = builder_no_texture(); /* its u and v are x and y, m */
    Surface      surface = {.triangle = 0, .ng = vec3(0, 0, 1)};
    Vec3         wo = vec3(0, 0, -1);
    TrianglePoint met = triangle_point(scene, 0, 0.3f, (float)beside);
    double inset = (double)ray_inset(&met, sqrtf(2));
    Vec2 before = footprint_exact(&footprint, scene, &surface, &slot, wo, 0.7f);
    assert_true(before.x == 0 && before.y == 0);
    assert_true(turn(scene, &down, &up, 0.7, &footprint));
    Vec2 exact = footprint_exact(&footprint, scene, &surface, &slot, wo, 0.9f);
    assert_near(exact.x, 0, 1e-3 * inset);
    assert_near(exact.y, beside - inset, 1e-3 * inset);
}

/* Seen upright, glass counts by its thickness over the index. */
TEST(a_thick_cover_brings_what_lies_behind_nearer)
{
    arena = test_arena(state);
    Ray3      down = {{0.3, 0.3, 0}, {0, 0, -1}};
    RayFootprint footprint = camera_at(&down, (RayCone){0, 0.02f});
    Scene    *glass = scene_of(&flat, true);
    assert_true(turn(glass, &down, &down, 0.5, &footprint));
    Ray3 up = {{0.3, 0.3, 0}, {0, 0, 1}}; /* leaves it at the same face, turned about */
    footprint.way[0] = vec3_neg(footprint.way[0]);
    footprint.place[0] = vec3_neg(footprint.place[0]);
    assert_true(turn(glass, &up, &up, 0.3, &footprint));
    assert_width(&footprint, &up, 0.1, 0.02 * (0.5 + 0.3 / 1.5 + 0.1));
}

/* Coddington's equations: parallel rays that a concave sphere of radius R mirrors at theta meet
 * after R cos(theta) / 2 in the plane of incidence, after R / (2 cos(theta)) across it. */
TEST(a_concave_mirror_has_two_foci)
{
    arena = test_arena(state);
    const double radius = 40;
    for (int i = 0; i < 7; i++) {
        double theta = 0.2 * i;
        Bent   sphere;
        for (int c = 0; c < 3; c++) {
            sphere.normal[c][0] = -(c == 1) / radius;
            sphere.normal[c][1] = -(c == 2) / radius;
            sphere.normal[c][2] = 1;
        }
        /* At corner 0, nearly: there the mirror lies in the plane. */
        Ray3      ray = {{1e-4, 1e-4, 0}, {sin(theta), 0, -cos(theta)}}, behind = ray;
        RayFootprint footprint = camera_at(&ray, (RayCone){1, 0});
        turn3(&sphere, 0, &behind);
        assert_true(turn(scene_of(&sphere, false), &ray, &behind, 2, &footprint));
        Frame  axes = {vec3(0, 0, 0), vec3(0, 1, 0), vec3(0, 0, 0)};
        double foci[2] = {radius * cos(theta) / 2, radius / 2 / cos(theta)};
        axes.z = vec3((float)behind.way[0], (float)behind.way[1], (float)behind.way[2]);
        axes.x = vec3_normalize(vec3_cross(axes.y, axes.z));
        for (int k = 0; k < 2; k++) {
            Vec3 across[2];
            footprint_across(&footprint, (float)foci[k], &axes, across);
            double in = hypot((double)across[0].x, (double)across[1].x);
            double out = hypot((double)across[0].y, (double)across[1].y);
            double other = fabs(1 - foci[k] / foci[!k]);
            assert_near(k ? out : in, 0, 1e-4);
            assert_near(k ? in : out, other, 1e-4 * (1 + other));
        }
    }
}

/* ---- what ends it ------------------------------------------------------------------------ */

TEST(nothing_is_known_behind_what_scatters_or_has_a_normal_map)
{
    arena = test_arena(state);
    Scene     *scene = scene_of(&flat, false);
    const Vec3 up = vec3(0, 0, 1);
    Ray3       down = {{0.3, 0.3, 0}, {0, 0, -1}}, back = {{0.3, 0.3, 0}, {0, 0, 1}};
    RayFootprint  footprint = camera_at(&down, (RayCone){0, 0.02f});
    assert_true(turn(scene, &down, &back, 1, &footprint));
    Surface    surface = {.frame = frame_from_z(up), .ng = up, .position = vec3(0.3f, 0.3f, 0),
                          .point.ns = up};
    BsdfSample rough = {.wi = up};
    assert_false(footprint_turn(&footprint, scene, &surface, up, &rough, 1));
    scene->materials[0].clearcoat_normal_texture.texture_id = 0;
    assert_false(turn(scene, &down, &back, 1, &footprint));
    scene->materials[0].clearcoat_normal_texture.texture_id = NO_ID;
    scene->materials[0].normal_texture.texture_id = 0;
    rough.is_delta = true;
    assert_false(footprint_turn(&footprint, scene, &surface, up, &rough, 1));
    scene->materials[0].normal_texture.texture_id = NO_ID;
    assert_true(footprint_turn(&footprint, scene, &surface, up, &rough, 1));
}

TEST_PROGRAM(make_arena, drop_arena)
