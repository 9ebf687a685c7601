/* SPDX-License-Identifier: Apache-2.0 */
/* Displays as lights: chosen by content and by what they send to the point that is lit. */
#include "panel_fixture.h"

#include "base/sampler.h"
#include "emitter_fixture.h"
#include "light/emitters_build.h"
#include "path/path.h"
#include "scene_builder.h"
#include "spectrum/photometry.h"

/* A privacy panel: half of the light within 15 degrees of the normal. */
#define NARROW \
    "{\"panel\": \"test privacy\", \"refractive_index\": 1.5, \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"gamma_drop\": 0.1, \"cosine_power\": [20, 20]," \
    "\"black_cd_m2\": 0.3, \"leak\": 1}," \
    "\"instrument\": {\"theta_step_deg\": 2, \"phi_step_deg\": 10}}"

static Fixture narrow;

static int start_narrow(void **state) {
    *state = &narrow;
    FitOptions options = fit_options_default();
    options.level = 5;
    fixture_start(&narrow, NARROW, &options);
    return 0;
}

/* A picture like an instrument's: dark but for a few bright lines. size: in 320 x 120. */
static void show_lines(Scene *scene, int width, int height, Arena *arena) {
    uint8_t *picture = ARENA_NEW(arena, uint8_t, width *height * 4);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            int s = x * 320 / width, t = y * 120 / height;
            bool is_lit = abs(s - 2 * t - 20) < 2 || (s > 200 && s < 260 && t % 20 < 3);
            for (int k = 0; k < 3; k++) picture[4 * (y * width + x) + k] = is_lit ? 230 : 8;
        }
    scene->textures[0] =
        (Texture){{width, height, IMAGE_RGBA8, picture}, WRAP_CLAMP, WRAP_CLAMP, true};
}

static void add_display(Scene *scene, Vec3 centre, Vec3 half_u, Vec3 half_v, bool has_content) {
    Material material = builder_material(0);
    material.display_id = scene->display_count;
    material.is_emitter = true;
    int material_id = builder_part(scene, material);
    builder_quad(scene, centre, half_u, half_v);
    Display *display = &scene->displays[scene->display_count++];
    *display = (Display){.name = "display",
                         .panel = narrow.panel,
                         .material_id = material_id,
                         .level = 1,
                         .content = builder_no_texture()};
    if (has_content) display->content.texture_id = 0;
}

/* One display looks at the origin, three look past it by 45 degrees. */
static Scene *four_displays(Arena *arena, bool has_content) {
    Scene *scene = builder_scene(arena);
    show_lines(scene, 320, 120, arena);
    add_display(scene, vec3(0, 0, -0.8f), vec3(0.15f, 0, 0), vec3(0, 0.055f, 0), has_content);
    for (int i = 0; i < 3; i++)
        add_display(scene, vec3(0.4f * (float)(i + 1), 0, -0.6f), vec3(0.1f, 0, -0.1f),
                    vec3(0, 0.055f, 0), has_content);
    return scene;
}

static const LitPoint at_origin = {{0, 0, 0}, {0, 0, -1}, false};

typedef struct Estimate {
    double mean, variance; /* of one sample, relative to the mean squared */
} Estimate;

static double luminance_towards(const Scene *scene, EmitterPoint at, const LitPoint *to,
                                double *geometry) {
    TrianglePoint point = triangle_point(scene, at.triangle, at.u, at.v);
    Wavelengths w;
    float xyz[3] = {0};
    Vec3 d = vec3_sub(to->position, point.position);
    double d2 = (double)vec3_dot(d, d);
    d = vec3_normalize(d);
    *geometry = fmax(0, (double)vec3_dot(point.ng, d)) * fmax(0, -(double)vec3_dot(to->ns, d)) / d2;
    for (int i = 0; i < 4; i++) {
        wavelengths_sample(((float)i + 0.5f) / 4, &w);
        spectrum_add_xyz(&w, triangle_emission(scene, at.triangle, &point, d, &w), xyz);
    }
    return (double)xyz[1] / 4;
}

/* Illuminance at the origin on a plane that faces -z, with samples as lights_sample draws them,
 * or by area and mean luminance alone as the simplest renderer would. */
static Estimate illuminance(const Scene *scene, const Emitters *emitters, bool is_blind) {
    enum { COUNT = 20000 };
    uint32_t random = 17;
    double sum = 0, squares = 0;
    for (int i = 0; i < COUNT; i++) {
        float u[3];
        double geometry, pdf;
        EmitterDensity density;
        for (int k = 0; k < 3; k++) u[k] = unit_float(hash_u32(random++));
        EmitterPoint at = emitters_sample(emitters, scene, &at_origin, u, &density);
        pdf = density_on_area(scene, at, at_origin.position, density);
        if (is_blind) { /* all triangles have the same mean luminance: by area */
            const double areas[4] = {0.15 * 0.055 * 4, 0.2 * 0.055 * 2 * 1.41421356,
                                     0.2 * 0.055 * 2 * 1.41421356, 0.2 * 0.055 * 2 * 1.41421356};
            double all = areas[0] + 3 * areas[1], pick = (double)u[2] * all;
            int d = pick < areas[0] ? 0 : 1 + (int)fmin(2, (pick - areas[0]) / areas[1]);
            float root = sqrtf(u[0]);
            at = (EmitterPoint){(uint32_t)(2 * d) + (hash_u32(random++) & 1), root * (1 - u[1]),
                                root * u[1]};
            pdf = 1 / all;
        }
        double luminance = luminance_towards(scene, at, &at_origin, &geometry);
        double value = luminance * geometry / pdf;
        sum += value;
        squares += value * value;
    }
    double mean = sum / COUNT;
    return (Estimate){mean, squares / COUNT / (mean * mean) - 1};
}

TEST(displays_are_chosen_by_angle_and_by_content) {
    for (int has_content = 0; has_content < 2; has_content++) {
        Arena arena = arena_reserve((size_t)1 << 30);
        Scene *scene = four_displays(&arena, has_content);
        Emitters emitters = emitters_build(scene, &arena);
        Estimate blind = illuminance(scene, &emitters, true);
        Estimate found = illuminance(scene, &emitters, false);
        print_message("%s: %.5g lx; variance of a sample over its mean squared %.3g, by area "
                      "%.3g\n",
                      has_content ? "lines" : "white", found.mean, found.variance, blind.variance);
        assert_near(found.mean, blind.mean,
                    4 * blind.mean * sqrt((blind.variance + found.variance) / 20000));
        assert_true(found.variance < (has_content ? 1 : 0.25));
        assert_true(blind.variance > 8 * found.variance);
        arena_release(&arena);
    }
}

/* Cells of a branch are ranks up to `end`, and no corner of them lies beyond its radius. */
static void assert_bounds_cells(const Scene *scene, const Emitters *emitters,
                                const EmitterNode *node, int i, uint32_t end) {
    Vec3 centre = vec3(node->centre[0][i], node->centre[1][i], node->centre[2][i]);
    for (uint32_t rank = node->first[i]; rank < end; rank++) {
        EmitterChoice chosen = emitters->by_rank[rank];
        const Emitter *e = &emitters->emitters[chosen.emitter];
        EmitterCell at = emitter_cell(e, chosen.cell);
        float step = 1 / (float)at.side;
        assert_int_equal(emitters->cell_rank[chosen.cell], rank);
        assert_int_equal(emitters->cell_emitter[chosen.cell], chosen.emitter);
        for (int k = 0; k < 3; k++) {
            int a = at.i + (at.is_turned ? k != 1 : k == 1);
            int b = at.j + (at.is_turned ? k != 2 : k == 2);
            Vec3 p = triangle_position(scene, e->triangle, (float)a * step, (float)b * step);
            assert_true(vec3_length(vec3_sub(p, centre)) <= node->radius[i]);
        }
    }
}

static int check_branches(const Scene *scene, const Emitters *emitters, const EmitterNode *node,
                          uint32_t first, uint32_t end) {
    int count = node->count;
    assert_int_equal(node->first[0], first);
    for (int i = 0; i < node->count; i++) {
        uint32_t last = i + 1 < node->count ? node->first[i + 1] : end;
        assert_int_equal(node->choice[i].count, last - node->first[i]);
        assert_bounds_cells(scene, emitters, node, i, last);
        if (node->child[i])
            count += check_branches(scene, emitters, node->child[i], node->first[i], last);
    }
    return count;
}

/* The rim of a triangle cuts blocks of cells into odd shapes; sides of 128 cells and of 90. */
TEST(every_branch_holds_its_cells_within_its_radius) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Scene *scene = four_displays(&arena, true);
    builder_part(scene, scene->materials[scene->displays[0].material_id]);
    for (int i = 0; i < 2; i++)
        builder_quad(scene, vec3(1, (float)i, 0), vec3(0.3f, 0.1f, 0), vec3(0.2f, 0.08f, 0));
    Emitters emitters = emitters_build(scene, &arena);
    int branches = check_branches(scene, &emitters, emitters.root, 0, emitters.cell_count);
    print_message("%u cells in %d branches\n", emitters.cell_count, branches);
    assert_true(branches > 1000 && (uint32_t)branches < emitters.cell_count / 16);
    arena_release(&arena);
}

/* Of one sample of illuminance at `to`: by the renderer's choice, or uniform on the display,
 * which is the scene's first two triangles. */
static Estimate of_display(const Scene *scene, const Emitters *emitters, const LitPoint *to,
                           bool is_uniform, double area) {
    enum { COUNT = 4000 };
    uint32_t random = 71;
    double sum = 0, squares = 0;
    for (int i = 0; i < COUNT; i++) {
        float u[3], root;
        double geometry, pdf = 1 / area;
        EmitterDensity density;
        for (int k = 0; k < 3; k++) u[k] = unit_float(hash_u32(random++));
        root = sqrtf(u[0]);
        EmitterPoint at = {u[2] < 0.5f, root * (1 - u[1]), root * u[1]};
        if (!is_uniform) {
            at = emitters_sample(emitters, scene, to, u, &density);
            pdf = density_on_area(scene, at, to->position, density);
        }
        double value = luminance_towards(scene, at, to, &geometry) * geometry / pdf;
        sum += value;
        squares += value * value;
    }
    double mean = sum / COUNT;
    return (Estimate){mean, squares / COUNT - mean * mean};
}

/* A display of 1920 x 1080 pixels below a windscreen that leans over it: 40 points of that. */
TEST(a_large_picture_lights_a_windscreen_with_a_fifth_of_the_variance) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Scene *scene = builder_scene(&arena);
    show_lines(scene, 1920, 1080, &arena);
    add_display(scene, vec3(0, 0, 0), vec3(0.15f, 0, 0), vec3(0, 0.084f, 0), true);
    Emitters emitters = emitters_build(scene, &arena);
    double ours = 0, uniform = 0, light = 0, off = 0, area = 4 * 0.15 * 0.084;
    for (int i = 0; i < 40; i++) {
        LitPoint glass = {vec3(0.2f * (float)(i % 8) - 0.7f, 0.35f + 0.06f * (float)(i / 8),
                               0.05f + 0.1f * (float)(i / 8)),
                          vec3(0, -0.8f, -0.6f), false};
        Estimate found = of_display(scene, &emitters, &glass, false, area);
        Estimate plain = of_display(scene, &emitters, &glass, true, area);
        ours += found.variance;
        uniform += plain.variance;
        light += found.mean * found.mean;
        off += found.mean - plain.mean;
    }
    print_message("windscreen: variance over light squared %.3g, uniform %.3g, %.0f times\n",
                  ours / light, uniform / light, uniform / ours);
    assert_true(uniform > 5 * ours);
    assert_near(off, 0, 4 * sqrt((ours + uniform) / 4000));
    arena_release(&arena);
}

/* The same light, whether light samples, the wall's own samples or both find it. */
TEST(every_strategy_finds_the_same_light_of_displays) {
    static const PathStrategy strategies[] = {PATH_LIGHTS_ONLY, PATH_BSDF_ONLY, PATH_MIS};
    static const int counts[] = {20000, 400000, 20000};
    Arena arena = arena_reserve((size_t)1 << 30);
    Scene *scene = four_displays(&arena, true);
    Bvh *bvh;
    Lights *lights;
    Error err = {0};
    double mean[3], sigma[3];
    if (!bvh_create(scene, 1, NULL, &bvh, &err) || !lights_build(scene, &arena, &lights, &err))
        fail_msg("%s", err.text);
    PathContext context = path_context_build(scene, bvh, lights, 1, &arena);
    for (int s = 0; s < 3; s++) {
        PathStatistics statistics = {0};
        double squares = 0;
        context.strategy = strategies[s];
        mean[s] = 0;
        for (int i = 0; i < counts[s]; i++) {
            Sampler sampler = sampler_start((uint32_t)s, 1, 0, (uint32_t)i);
            Wavelengths w;
            float lx[3];
            wavelengths_sample(sampler_1d(&sampler), &w);
            PathStart start = {.context = &context,
                               .wavelengths = &w,
                               .sampler = &sampler,
                               .statistics = &statistics};
            path_from_point(&start, at_origin, lx);
            mean[s] += (double)lx[1] / counts[s];
            squares += (double)lx[1] * (double)lx[1] / counts[s];
        }
        sigma[s] = sqrt((squares - mean[s] * mean[s]) / counts[s]);
    }
    print_message("lights %.5g +- %.2g, wall %.5g +- %.2g, both %.5g +- %.2g lx\n", mean[0],
                  sigma[0], mean[1], sigma[1], mean[2], sigma[2]);
    for (int s = 0; s < 3; s++)
        assert_near(mean[s], mean[0], 4 * hypot(sigma[s], sigma[0]) + 1e-4 * mean[0]);
    assert_true(sigma[2] < 1.2 * sigma[0] && sigma[0] < 0.02 * mean[0]);
    bvh_destroy(bvh);
    arena_release(&arena);
}

TEST_PROGRAM(start_narrow, fixture_group_end)
