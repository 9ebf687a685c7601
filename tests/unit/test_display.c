/* SPDX-License-Identifier: Apache-2.0 */
/* A measured display in a scene: what the path tracer shows is what the panel says. */

#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_reflection.h"
#include "path/path_features.h"
#include "sky/sun_disc.h"
#include "spectrum/photometry.h"
#include "world_fixture.h"

/* CIE 15: u' = 4X / (X + 15Y + 3Z), v' = 9Y / (X + 15Y + 3Z). */
static void uv_by_hand(const float xyz[3], float uv[2]) {
    float sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    uv[0] = 4 * xyz[0] / sum;
    uv[1] = 9 * xyz[1] / sum;
}

static const char *const PANELS[] = {PROJECT_DIR "/assets/panels/ips_cluster.panel",
                                     PROJECT_DIR "/assets/panels/oled_centre.panel"};
#define PANEL_COUNT 2

enum { BOUNCES = 4 };

/* A display of 2 x 1 m in the plane z = 0 that faces +z, u to the right, v down. */
static World world_open(const char *panel_path) {
    World world = world_start();
    Error err = {0};
    if (!panel_open(panel_path, &world.arena, &world.panel, &err))
        fail_msg("%s: %s", err.file, err.text);
    Material material = builder_material(0);
    material.display_id = 0;
    material.is_emitter = true;
    builder_part(world.scene, material);
    builder_quad(world.scene, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 0.5f, 0));
    world.scene->displays[world.scene->display_count++] =
        (Display){.name = "display",
                  .panel = world.panel,
                  .material_id = 0,
                  .level = 1,
                  .content = builder_no_texture()};
    return world;
}

/* Shows a picture of width x height pixels of 8-bit codes. */
static void world_show(World *world, const uint8_t *rgba, int width, int height) {
    world->scene->textures[0] =
        (Texture){{width, height, IMAGE_RGBA8, rgba}, WRAP_CLAMP, WRAP_CLAMP, true};
    world->scene->displays[0].content.texture_id = 0;
}

/* With a picture of one pixel, whose codes may change later. */
static World world_of_pixel(const char *panel_path, const uint8_t pixel[4]) {
    World world = world_open(panel_path);
    world_show(&world, pixel, 1, 1);
    return world;
}

static Vec3 direction(double theta_deg, double phi_deg) {
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

typedef struct Seen {
    double xyz[3], sigma_y;
} Seen;

/* Mean of count paths along the ray; without one, of what falls on the point. */
static Seen gather(const World *world, const Ray *ray, LitPoint point, int count) {
    Seen seen = {{0}, 0};
    double squares = 0;
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(9, 0, 0, (uint32_t)i);
        Wavelengths w;
        PathResult result;
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world->context,
                           .wavelengths = &w,
                           .sampler = &sampler,
                           .statistics = &statistics};
        if (ray) path_from_ray(&start, *ray, &result);
        else path_from_point(&start, point, result.xyz);
        for (int k = 0; k < 3; k++) seen.xyz[k] += (double)result.xyz[k] / count;
        squares += (double)result.xyz[1] * (double)result.xyz[1] / count;
    }
    seen.sigma_y = sqrt(fmax(squares - seen.xyz[1] * seen.xyz[1], 0) / count);
    return seen;
}

/* From 3 m away along `towards` (from the display) to its point `at`. */
static Seen look(const World *world, Vec3 at, Vec3 towards, int count) {
    Ray ray = {vec3_along(at, towards, 3), vec3_neg(towards), 0, INFINITY};
    return gather(world, &ray, (LitPoint){0}, count);
}

/* 3 primaries x 9 levels x 25 directions in a black room. */
TEST(a_frame_shows_what_the_panel_emits) {
    for (int p = 0; p < PANEL_COUNT; p++) {
        uint8_t pixel[4] = {0, 0, 0, 255};
        SCOPED_WORLD world = world_of_pixel(PANELS[p], pixel);
        world_ready(&world, BOUNCES);
        for (int primary = 0; primary < 3; primary++)
            for (int level = 0; level < 9; level++)
                for (int d = 0; d < 25; d++) {
                    Vec3 towards = direction(3 + 3.3 * d, 137.5 * d);
                    float codes[3] = {0}, expected[3], uv[2], wanted_uv[2], xyz[3];
                    memset(pixel, 0, 3);
                    pixel[primary] = (uint8_t)(level ? 32 * level - 1 : 0);
                    codes[primary] = (float)pixel[primary];
                    panel_emission_xyz(world.panel, towards, codes, expected);
                    Seen seen = look(&world, vec3(0.1f, 0.05f, 0), towards, 1);
                    assert_close(seen.xyz[1], expected[1], 1e-4);
                    for (int k = 0; k < 3; k++) xyz[k] = (float)seen.xyz[k];
                    if (!(expected[1] > 0)) continue;
                    uv_by_hand(xyz, uv);
                    uv_by_hand(expected, wanted_uv);
                    assert_near(uv[0], wanted_uv[0], 1e-4);
                    assert_near(uv[1], wanted_uv[1], 1e-4);
                }
    }
}

/* Light of the display on a white wall: the spectral way must carry the same luminance. */
TEST(the_display_lights_a_wall_with_its_measured_luminance) {
    SCOPED_WORLD world = world_open(PANELS[0]);
    const float codes[3] = {255, 180, 60};
    uint8_t pixel[4] = {255, 180, 60, 255};
    double expected = 0;
    const int side = 400;
    world_show(&world, pixel, 1, 1);
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(0, 0, 4), vec3(0.5f, 0, 0), vec3(0, -0.5f, 0));
    world_ready(&world, BOUNCES);
    world.context.max_bounces = 1;
    for (int i = 0; i < side; i++) /* the illuminance at the wall's middle, by area */
        for (int j = 0; j < side; j++) {
            Vec3 from = vec3((2 * (i + 0.5f) / side - 1), (j + 0.5f) / side - 0.5f, 0);
            Vec3 to = vec3_sub(vec3(0, 0, 4), from);
            float xyz[3], d2 = vec3_dot(to, to), cosine = 4 / sqrtf(d2);
            panel_emission_xyz(world.panel, vec3_normalize(to), codes, xyz);
            expected += (double)(xyz[1] * cosine * cosine / d2) * 2.0 / (side * side);
        }
    Ray ray = {vec3(0, 0, 3.5f), vec3(0, 0, 1), 0, INFINITY};
    Seen seen = gather(&world, &ray, (LitPoint){0}, 40000);
    assert_near(seen.xyz[1], expected * 0.5 / PI, 4 * seen.sigma_y + 2e-3 * seen.xyz[1]);
    assert_true(seen.sigma_y < 3e-3 * seen.xyz[1]);
}

/* A picture whose four corners differ is seen upright and not mirrored. */
TEST(the_picture_stands_upright) {
    SCOPED_WORLD world = world_open(PANELS[0]);
    static const uint8_t picture[16] = {255, 0,   0,   255, /* upper left red */
                                        0,   255, 0,   255, /* upper right green */
                                        0,   0,   255, 255, /* lower left blue */
                                        255, 255, 255, 255};
    world_show(&world, picture, 2, 2);
    world_ready(&world, BOUNCES);
    for (int corner = 0; corner < 4; corner++) {
        float codes[3], expected[3];
        Vec3 at = vec3(corner & 1 ? 0.5f : -0.5f, corner & 2 ? -0.25f : 0.25f, 0);
        for (int k = 0; k < 3; k++) codes[k] = picture[4 * corner + k];
        panel_emission_xyz(world.panel, vec3(0, 0, 1), codes, expected);
        Seen seen = look(&world, at, vec3(0, 0, 1), 1);
        for (int k = 0; k < 3; k++) assert_near(seen.xyz[k], expected[k], 1e-3 * expected[1]);
    }
}

/* phi as someone facing the display sees it: 0 right, 90 up; and it turns with the picture. */
TEST(angles_are_those_of_someone_who_faces_the_display) {
    uint8_t pixel[4] = {255, 255, 255, 255};
    SCOPED_WORLD world = world_of_pixel(PANELS[0], pixel);
    for (int turned = 0; turned < 2; turned++) {
        if (turned) /* the content by 90 degrees: its right is the scene's up */
            for (uint32_t i = 0; i < 4; i++) {
                Vec2 *uv = &world.scene->parts[0].uv[0][i];
                *uv = (Vec2){1 - uv->y, uv->x};
            }
        world_ready(&world, BOUNCES);
        for (int phi = 0; phi < 360; phi += 45) {
            PathResult result = {.hit = true, .first = {3, 0.3f, 0.2f, 0}};
            PathFeatures features;
            Wavelengths w;
            wavelengths_sample(0.5f, &w);
            result.direction = vec3_neg(direction(30, phi));
            path_features(&world.context, &result, &w, &features);
            double expected = turned ? (phi + 270) % 360 : phi;
            double found = degrees_from_radians((double)features.phi);
            assert_near(remainder(found - expected, 360), 0, 0.01);
            assert_near(degrees_from_radians((double)features.theta), 30, 0.01);
        }
        bvh_destroy(world.bvh);
        world.bvh = NULL;
    }
}

TEST(a_frame_is_told_what_lies_beyond_the_measured_cone) {
    uint8_t pixel[4] = {255, 255, 255, 255};
    SCOPED_WORLD world = world_of_pixel(PANELS[0], pixel);
    double cone = degrees_from_radians(panel_info_emission_cone(world.panel));
    world_ready(&world, BOUNCES);
    for (int side = -1; side <= 1; side += 2) {
        PathResult result = {.hit = true, .first = {3, 0.3f, 0.2f, 0}};
        PathFeatures features;
        Wavelengths w;
        wavelengths_sample(0.5f, &w);
        result.direction = vec3_neg(direction(cone + 0.5 * side, 40));
        path_features(&world.context, &result, &w, &features);
        assert_int_equal(features.is_measured, side < 0);
    }
}

/* Luminance that a spectrum per lane has, averaged over many sets of wavelengths. */
typedef Spectrum SpectrumAt(const World *world, const Wavelengths *w, const void *context);

static double mean_luminance(const World *world, SpectrumAt *at, const void *context) {
    double sum = 0;
    const int sets = 16;
    for (int i = 0; i < sets; i++) {
        Wavelengths w;
        float xyz[3] = {0};
        wavelengths_sample(((float)i + 0.5f) / (float)sets, &w);
        spectrum_add_xyz(&w, at(world, &w, context), xyz);
        sum += (double)xyz[1] / sets;
    }
    return sum;
}

/* Reflected from a uniform sky of 1000 cd m^-2: a sum over the hemisphere, plus the mirror. */
static Spectrum reflected_sky(const World *world, const Wavelengths *w, const void *context) {
    const Vec3 *wo = context;
    const float rgb[3] = {1000, 1000, 1000};
    Spectrum sum = spectrum_all(0);
    enum { RINGS = 360, SECTORS = 360 };
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SECTORS; j++) {
            /* Rings are denser about the mirror direction's polar angle than elsewhere. */
            double theta = PI / 2 * (i + 0.5) / RINGS, phi = 2 * PI * (j + 0.5) / SECTORS;
            Vec3 wi = vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                           (float)cos(theta));
            double weight = sin(theta) * cos(theta) * PI / 2 / RINGS * 2 * PI / SECTORS;
            sum += panel_brdf(world->panel, *wo, wi, w) * spectrum_all((float)weight);
        }
    sum += panel_mirror(world->panel, wo->z, w);
    return sum * spectrum_from_rgb_emission(w, rgb);
}

TEST(a_display_under_a_uniform_sky_reflects_its_brdfs_integral) {
    for (int p = 0; p < PANEL_COUNT; p++) {
        uint8_t pixel[4] = {0, 0, 0, 255};
        SCOPED_WORLD world = world_of_pixel(PANELS[p], pixel);
        world.scene->displays[0].level = 0;
        builder_sky(world.scene, 1000);
        world_ready(&world, BOUNCES);
        for (int theta = 10; theta <= 60; theta += 25) {
            Vec3 wo = direction(theta, 40);
            double expected = mean_luminance(&world, reflected_sky, &wo);
            Seen seen = look(&world, vec3(0, 0, 0), wo, 60000);
            print_message("sky, panel %d, %d deg: %.5g +- %.2g, integral %.5g\n", p, theta,
                          seen.xyz[1], seen.sigma_y, expected);
            assert_true(seen.sigma_y < 2e-3 * expected);
            assert_close(seen.xyz[1], expected, 5e-3);
        }
    }
}

typedef struct SunView {
    Vec3 wo, sun;
    double lx, radius;
} SunView;

/* Reflected from the sun's disc, darker at its limb: a sum over its face, and its mirror image
 * where it is hit. */
static Spectrum reflected_sun(const World *world, const Wavelengths *w, const void *context) {
    const SunView *view = context;
    Frame frame = frame_from_z(view->sun);
    Spectrum sum = spectrum_all(0);
    Curve limb[SUN_LIMB_TERMS];
    sun_limb_curves(limb);
    enum { RINGS = 24, SECTORS = 48 };
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SECTORS; j++) {
            double r = view->radius * sqrt((i + 0.5) / RINGS), a = 2 * PI * (j + 0.5) / SECTORS;
            Vec3 wi = frame_to_world(
                &frame, vec3((float)(sin(r) * cos(a)), (float)(sin(r) * sin(a)), (float)cos(r)));
            sum += panel_brdf(world->panel, view->wo, wi, w) *
                   sun_limb_shade(limb, (float)sqrt((i + 0.5) / RINGS), w) *
                   spectrum_all(wi.z / (RINGS * SECTORS));
        }
    return sum;
}

/* The disc's spectral irradiance where it stands in the zenith: radiance over pdf, in the mean
 * over an even grid of samples. */
static Spectrum sun_irradiance(const World *world, const Wavelengths *w) {
    enum { SIDE = 16 };
    const LitPoint up = {vec3(0, 0, 0), vec3(0, 0, 1), false};
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        LightSample sample;
        float u[3] = {((float)(i / SIDE) + 0.5f) / SIDE, ((float)(i % SIDE) + 0.5f) / SIDE};
        const Lights *lights = world->context.lights;
        assert_true(lights_sample(lights, LIGHTS_SUN, up, u, &sample));
        sum += lights_radiance(lights, &sample, w) / spectrum_all(sample.pdf * SIDE * SIDE);
    }
    return sum;
}

TEST(a_display_under_the_sun_reflects_its_brdf_over_the_disc) {
    for (int p = 0; p < PANEL_COUNT; p++)
        for (int away = 2; away <= 30; away += 7) {
            SCOPED_WORLD world = world_open(PANELS[p]);
            uint8_t pixel[4] = {0, 0, 0, 255};
            Environment *environment = &world.scene->environment;
            world_show(&world, pixel, 1, 1);
            world.scene->displays[0].level = 0;
            environment->has_sun = true;
            environment->sun_azimuth = (float)PI; /* +z is south */
            environment->sun_elevation = (float)radians_from_degrees(40);
            environment->sun_illuminance_lx = 50000;
            world_ready(&world, BOUNCES);
            SunView view = {.wo = direction(40 - away, 270),
                            .sun = direction(40, 90),
                            .lx = 50000,
                            .radius = (double)environment->sun_angular_radius};
            double expected = 0;
            for (int i = 0; i < 16; i++) { /* the sun's own spectrum, of 50 klx */
                Wavelengths w;
                float xyz[3] = {0};
                wavelengths_sample(((float)i + 0.5f) / 16, &w);
                spectrum_add_xyz(&w, reflected_sun(&world, &w, &view) * sun_irradiance(&world, &w),
                                 xyz);
                expected += (double)xyz[1] / 16;
            }
            Seen seen = look(&world, vec3(0, 0, 0), view.wo, 20000);
            print_message("sun, panel %d, %d deg off the mirror: %.5g +- %.2g, integral %.5g\n", p,
                          away, seen.xyz[1], seen.sigma_y, expected);
            assert_true(seen.sigma_y < 2e-3 * expected);
            assert_close(seen.xyz[1], expected, 5e-3);
        }
}

/* ---- the back --------------------------------------------------------------------------- */

/* The display about the origin, its faces as files have them: doubleSided or not, normals with
 * the winding or against it. */
static World world_of_faces(bool is_double_sided, bool is_inside_out) {
    World world = world_open(PANELS[1]);
    world.scene->materials[0].double_sided = is_double_sided;
    for (uint32_t i = 0; is_inside_out && i < world.scene->vertex_count; i++)
        world.scene->parts[0].normals[i].z = -1;
    return world;
}

/* A pane or a metal mirror; its tint sends the display's light via the spectrum. */
static void add_sheet(World *world, Vec3 centre, bool is_pane, float blue) {
    Material material = builder_material(1);
    material.base_color[2] = blue;
    material.roughness = 0;
    material.transmission = is_pane ? 1 : 0;
    material.metallic = is_pane ? 0 : 1;
    material.lets_light_through = is_pane;
    builder_part(world->scene, material);
    builder_quad(world->scene, centre, vec3(9, 0, 0), vec3(0, 9, 0));
}

/* From one side, through a pane and in a mirror: bright from the front, dark from behind. */
static void check_side(bool is_double_sided, bool is_inside_out, float blue, float side) {
    SCOPED_WORLD world = world_of_faces(is_double_sided, is_inside_out);
    Vec3 eye = vec3(3, 0, 2 * side), image = vec3(0.3f, 0.1f, 16 * side);
    add_sheet(&world, vec3(0, 0, 8 * side), false, blue);
    add_sheet(&world, vec3(0, 0, side), true, blue);
    world_ready(&world, BOUNCES);
    Ray to_mirror = {eye, vec3_normalize(vec3_sub(image, eye)), 0, INFINITY};
    Seen mirrored = gather(&world, &to_mirror, (LitPoint){0}, 64);
    assert_true(side > 0 ? mirrored.xyz[1] > 1 : mirrored.xyz[1] == 0);
    for (int d = 0; d < 6; d++) {
        Vec3 towards = direction(5 + 12 * d, 60 * d);
        towards.z *= side;
        Seen seen = look(&world, vec3(0.3f, 0.1f, 0), towards, 64);
        assert_true(side > 0 ? seen.xyz[1] > 1 : seen.xyz[1] == 0);
    }
}

TEST(the_back_of_a_display_is_dark) {
    for (int i = 0; i < 16; i++) check_side(i & 1, i & 2, i & 4 ? 0.5f : 1, i & 8 ? 1 : -1);
}

/* The same light of a display for every strategy, on its front; none behind. */
TEST(the_back_of_a_display_lights_nothing) {
    LitPoint before = {vec3(0.2f, 0, 2), vec3(0, 0, -1), false};
    LitPoint behind = {vec3(0.2f, 0, -2), vec3(0, 0, 1), false};
    for (int i = 0; i < 4; i++) {
        SCOPED_WORLD world = world_of_faces(i & 1, i & 2);
        Seen lit[3];
        world_ready(&world, BOUNCES);
        for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
            world.context.strategy = s;
            lit[s] = gather(&world, NULL, before, 20000);
            assert_near(gather(&world, NULL, behind, 500).xyz[1], 0, 0);
            double sigma = hypot(lit[s].sigma_y, lit[0].sigma_y);
            assert_near(lit[s].xyz[1], lit[0].xyz[1], 4 * sigma);
        }
        assert_true(lit[0].sigma_y < 0.02 * lit[0].xyz[1]);
    }
}

TEST_PROGRAM(NULL, NULL)
