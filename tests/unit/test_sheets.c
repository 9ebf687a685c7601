/* SPDX-License-Identifier: Apache-2.0 */
/* Sheets that lie in one plane: masks, blended films and panes on one another and on what
 * carries them. All are seen, the later over the earlier, and all take their share of light. */

#include "world_fixture.h"

enum { BOUNCES = 4, SHEETS = 8, CELLS = 24 };

/* Where the plane of the sheets is: they lie in the frame's x and y. */
typedef struct Place {
    Frame frame;
    Vec3 origin;
} Place;

static const Place PLACES[] = {
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}},
    {{{0.6f, 0, 0.8f}, {0, 1, 0}, {-0.8f, 0, 0.6f}}, {0.3f, -1.2f, 0.7f}},
    {{{0.48f, 0.6f, -0.64f}, {-0.36f, 0.8f, 0.48f}, {0.8f, 0, 0.6f}}, {40, 3, -97}},
    {{{0.48f, 0.6f, -0.64f}, {-0.36f, 0.8f, 0.48f}, {0.8f, 0, 0.6f}}, {-1013, 377, 850}},
};
enum { PLACE_COUNT = sizeof PLACES / sizeof *PLACES };

static Vec3 at(const Place *place, float x, float y, float z) {
    return vec3_add(place->origin, frame_to_world(&place->frame, vec3(x, y, z)));
}

/* A square about the place's origin, turned in its plane, so that every sheet's corners are
 * rounded in another way. Texture coordinates are those of the place: u, v = 0.5 + x, 0.5 + y
 * in -0.5..0.5, whatever the turn. */
static void add_square(World *world, const Place *place, float half, float turn) {
    uint32_t first = world->scene->vertex_count;
    for (int i = 0; i < 4; i++) {
        double angle = (double)turn + 1.57079632679 * i;
        float x = half * (float)cos(angle), y = half * (float)sin(angle);
        builder_vertex(world->scene, at(place, x, y, 0), place->frame.z, 0.5f + x, 0.5f + y);
    }
    builder_triangle(world->scene, first, first + 1, first + 2);
    builder_triangle(world->scene, first, first + 2, first + 3);
}

static Material emitter(float cd_m2) {
    Material material = builder_lamp(cd_m2);
    material.is_emitter = cd_m2 > 0;
    material.double_sided = true;
    return material;
}

static Material film(float alpha, float cd_m2) {
    Material material = emitter(cd_m2);
    material.alpha_mode = ALPHA_BLEND;
    material.base_color[3] = alpha;
    material.lets_light_through = true;
    return material;
}

/* Is sheet i there in a cell? Every sheet in half of them, each in its own. */
static bool is_there(int sheet, int cell) {
    return hash_u32((uint32_t)(1000 * sheet + cell)) & 1;
}

/* A mask of CELLS columns; its own luminance shows which one is seen. */
static void add_mask(World *world, const Place *place, int sheet, float turn) {
    uint8_t *texels = ARENA_NEW(&world->arena, uint8_t, 4 * CELLS);
    for (int c = 0; c < CELLS; c++) texels[4 * c + 3] = is_there(sheet, c) ? 255 : 0;
    Texture texture = {{CELLS, 1, IMAGE_RGBA8, texels}, WRAP_CLAMP, WRAP_CLAMP, true};
    Material mask = film(1, 10 * (float)(sheet + 1));
    mask.alpha_mode = ALPHA_MASK;
    mask.base_color_texture.texture_id = world->scene->texture_count;
    world->scene->textures[world->scene->texture_count++] = texture;
    builder_part(world->scene, mask);
    add_square(world, place, 0.9f, turn);
}

static float expected_in_cell(int sheets, int cell, float under) {
    for (int i = sheets - 1; i >= 0; i--)
        if (is_there(i, cell)) return 10 * (float)(i + 1);
    return under;
}

/* Luminance along the ray; without one, illuminance at the point. */
static WorldMean mean_of(const World *world, const Ray *ray, LitPoint point, int count) {
    double sum = 0, squares = 0;
    PathStatistics statistics = {0};
    for (int i = 0; i < count; i++) {
        Sampler sampler = sampler_start(5, 0, 0, (uint32_t)i);
        Wavelengths w;
        PathResult result;
        wavelengths_sample(sampler_1d(&sampler), &w);
        PathStart start = {.context = &world->context,
                           .wavelengths = &w,
                           .sampler = &sampler,
                           .statistics = &statistics};
        if (ray) path_from_ray(&start, *ray, &result);
        else path_from_point(&start, point, result.xyz);
        sum += (double)result.xyz[1] / count;
        squares += (double)result.xyz[1] * (double)result.xyz[1] / count;
    }
    return (WorldMean){sum, sqrt(fmax(squares - sum * sum, 0) / count), INFINITY};
}

static WorldMean look(const World *world, Vec3 from, Vec3 to, int count) {
    Ray ray = {from, vec3_normalize(vec3_sub(to, from)), 0, INFINITY};
    return mean_of(world, &ray, (LitPoint){0}, count);
}

/* ---- which one is seen ------------------------------------------------------------------ */

/* Masks on an opaque board, all in one plane; a mirror before them. */
static World masks_on_board(const Place *place, int sheets) {
    World world = world_start();
    Place mirror = {place->frame, at(place, 0, 0, 6)};
    builder_part(world.scene, emitter(500));
    add_square(&world, place, 0.95f, 0.3f);
    builder_part(world.scene, builder_mirror(1));
    add_square(&world, &mirror, 9, 0);
    for (int i = 0; i < sheets; i++) add_mask(&world, place, i, 0.7f * (float)i);
    world_ready(&world, BOUNCES);
    return world;
}

/* The last sheet that is there, from both sides, slantwise and in a mirror: few paths each, for
 * a mask leaves nothing to chance but some noise of the spectrum. */
static void check_cell(const World *world, const Place *place, int sheets, int cell) {
    float x = ((float)cell + 0.5f) / CELLS - 0.5f, y = 0.02f * (float)(cell % 7);
    float wanted = expected_in_cell(sheets, cell, 500);
    Vec3 spot = at(place, x, y, 0);
    const Vec3 eyes[] = {at(place, x, y, 2), at(place, 2, -1, 1), at(place, -3, 1, 0.3f),
                         at(place, -1, 0.5f, -1.5f)};
    for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++) {
        double seen = look(world, eyes[e], spot, 2).mean;
        if (fabs(seen - (double)wanted) > 0.03 * (double)wanted)
            fail_msg("%d sheets, cell %d, eye %zu: %g cd/m2, required: "
                     "%g",
                     sheets, cell, e, seen, (double)wanted);
    }
    Vec3 image = at(place, x, y, 12);
    assert_close(look(world, at(place, 1, 0.5f, 2), image, 2).mean, (double)wanted, 0.03);
}

TEST(of_masks_in_one_plane_the_last_that_is_there_is_seen) {
    for (int p = 0; p < PLACE_COUNT; p++)
        for (int sheets = 2; sheets <= SHEETS; sheets += 2) {
            ENDS_BY(world_end) World world = masks_on_board(&PLACES[p], sheets);
            for (int cell = 1; cell < CELLS - 1; cell++)
                check_cell(&world, &PLACES[p], sheets, cell);
        }
}

/* Two masks and the board as one mesh, the same four corners each. */
TEST(sheets_of_one_mesh_are_seen_too) {
    ENDS_BY(world_end) World world = world_start();
    uint8_t texels[8] = {0, 0, 0, 255, 0, 0, 0, 0}; /* left there, right a hole */
    Material mask = film(1, 20);
    mask.alpha_mode = ALPHA_MASK;
    mask.base_color_texture.texture_id = 0;
    mask.emissive_texture.texture_id = 1;
    uint8_t glow[12] = {255, 255, 255, 255, 0, 0, 0, 255}; /* below: see the coordinates */
    world.scene->textures[0] = (Texture){{2, 1, IMAGE_RGBA8, texels}, WRAP_CLAMP, WRAP_CLAMP, true};
    world.scene->textures[1] = (Texture){{1, 2, IMAGE_RGBA8, glow}, WRAP_CLAMP, WRAP_CLAMP, true};
    builder_part(world.scene, mask);
    for (int i = 0; i < 2; i++) { /* the first glows, and is there on the right */
        builder_quad(world.scene, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0));
        for (int v = 0; v < 4; v++) {
            Vec2 *uv = &world.scene->parts[0].uv[0][4 * i + v];
            if (i == 0) uv->x = 1 - uv->x;
            uv->y = i == 0 ? 0.1f : 0.9f;
        }
    }
    world_ready(&world, BOUNCES);
    assert_near(look(&world, vec3(-0.4f, 0.1f, 1), vec3(-0.4f, 0.1f, 0), 2).mean, 0, 0);
    assert_close(look(&world, vec3(0.4f, 0.1f, 1), vec3(0.4f, 0.1f, 0), 2).mean, 20, 0.03);
}

/* Paths by day are a third: a film that is missed or met twice shows all the same. */
static int paths(int all) {
    return all_laws() ? all : all / 3;
}

/* ---- how much is let through ------------------------------------------------------------ */

static float alpha_of_film(int i) {
    return 0.1f + 0.07f * (float)i;
}

/* n films and, if requested, a pane amid them before what shines: prod(1 - alpha) of it is
 * seen, and arrives at a luxmeter by light samples, chance hits and both; T of the pane
 * besides. */
static void check_films(const Place *place, int sheets, bool has_pane) {
    ENDS_BY(world_end) World world = world_start();
    Place back = {place->frame, at(place, 0, 0, -2)};
    double share = has_pane ? 12.0 / 13 : 1; /* n = 1.5, straight: 2n / (n^2 + 1) */
    builder_part(world.scene, emitter(100));
    add_square(&world, &back, 0.2f, 0.3f);
    for (int i = 0; i < sheets; i++) {
        builder_part(world.scene, film(alpha_of_film(i), 0));
        add_square(&world, place, 0.9f, 0.9f * (float)i);
        share *= 1 - (double)alpha_of_film(i);
        if (i != sheets / 2 || !has_pane) continue;
        builder_part(world.scene, builder_pane(1.5f));
        add_square(&world, place, 0.9f, 0.2f);
    }
    world_ready(&world, BOUNCES);
    WorldMean seen = look(&world, at(place, 0, 0, 3), at(place, 0, 0, -2), paths(12000));
    assert_near(seen.mean, 100 * share, 4 * seen.sigma + 0.01);
    LitPoint point = {at(place, 0, 0, 3), vec3_neg(place->frame.z), false};
    double lx = 100 * 0.08 / 25 * share; /* 0.1 % above, by the square's own size */
    for (PathStrategy s = PATH_MIS; s <= PATH_LIGHTS_ONLY; s++) {
        world.context.strategy = s;
        assert_close(mean_of(&world, NULL, point, 4000).mean, lx, 5e-3);
    }
}

TEST(films_in_one_plane_each_take_their_share) {
    for (int p = 0; p < PLACE_COUNT; p++)
        for (int sheets = 2; sheets <= SHEETS; sheets += 3) {
            check_films(&PLACES[p], sheets, false);
            check_films(&PLACES[p], sheets, true);
        }
}

/* What shines itself has films on it, before it by less than rays can resolve, or is a film:
 * the same light by light samples, by chance and by both. */
static void check_covered(const Place *place, float gap, float own_alpha) {
    ENDS_BY(world_end) World world = world_start();
    double lx[3], sigma[3];
    builder_part(world.scene, own_alpha < 1 ? film(own_alpha, 100) : emitter(100));
    add_square(&world, place, 0.9f, 0.1f);
    for (int i = 0; i < 2; i++) {
        Place over = {place->frame, at(place, 0, 0, gap * (float)(i + 1))};
        builder_part(world.scene, film(alpha_of_film(i), 0));
        add_square(&world, &over, 0.9f, 0.9f * (float)i);
    }
    world_ready(&world, BOUNCES);
    for (PathStrategy s = PATH_MIS; s <= PATH_BSDF_ONLY; s++) {
        LitPoint point = {at(place, 0.1f, 0, 1), vec3_neg(place->frame.z), false};
        world.context.strategy = s;
        WorldMean mean = mean_of(&world, NULL, point, paths(20000));
        lx[s] = mean.mean;
        sigma[s] = mean.sigma;
    }
    for (int s = 1; s < 3; s++)
        if (fabs(lx[s] - lx[0]) > 4 * hypot(sigma[s], sigma[0]) + 1e-3 * lx[0])
            fail_msg("gap %g, alpha %g: strategy %d gives %g +- %g lx, both %g +- %g", (double)gap,
                     (double)own_alpha, s, lx[s], sigma[s], lx[0], sigma[0]);
    double share = (double)own_alpha * (1 - 0.1) * (1 - 0.17);
    WorldMean seen = look(&world, at(place, 0.3f, 0, 1), at(place, 0, 0, 0), paths(6000));
    assert_near(seen.mean, 100 * share, 4 * seen.sigma);
}

TEST(what_shines_under_films_lights_as_it_is_seen) {
    for (int p = 0; p < PLACE_COUNT; p++) {
        check_covered(&PLACES[p], 0, 1);
        check_covered(&PLACES[p], 0, 0.6f);
    }
    check_covered(&PLACES[0], 5e-6f, 1);
    check_covered(&PLACES[0], 5e-5f, 0.6f);
}

/* A film just before a small lamp: what meets the lamp by chance counts with the density of the
 * whole way from the lit point. */
TEST(a_film_does_not_shorten_the_way_to_a_lamp) {
    ENDS_BY(world_end) World world = world_start();
    LitPoint point = {vec3(0, 0, 1), vec3(0, 0, -1), false};
    builder_part(world.scene, emitter(100));
    builder_quad(world.scene, vec3(0, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.2f, 0));
    builder_part(world.scene, film(0.1f, 0));
    builder_quad(world.scene, vec3(0, 0, 0.02f), vec3(0.9f, 0, 0), vec3(0, 0.9f, 0));
    world_ready(&world, BOUNCES);
    WorldMean both = mean_of(&world, NULL, point, 20000);
    world.context.strategy = PATH_LIGHTS_ONLY;
    WorldMean lights = mean_of(&world, NULL, point, 20000);
    assert_near(both.mean, lights.mean, 4 * hypot(both.sigma, lights.sigma));
    assert_true(both.sigma < 0.01 * both.mean);
}

/* Sheets whose distance is known keep their order, whatever the file's: the first in the
 * file is the nearest here. */
TEST(a_sheet_that_is_nearer_by_more_than_rounding_is_seen_first) {
    for (float gap = 4e-6f; gap < 1e-3f; gap *= 2) {
        ENDS_BY(world_end) World world = world_start();
        for (int i = 0; i < 3; i++) {
            Place place = {PLACES[0].frame, vec3(0, 0, 1 - gap * (float)i)};
            builder_part(world.scene, film(1, 10 * (float)(i + 1)));
            add_square(&world, &place, 0.9f, 0.4f * (float)i);
        }
        world_ready(&world, BOUNCES);
        assert_close(look(&world, vec3(0.1f, 0.2f, 3), vec3(0, 0.1f, 1), 2).mean, 10, 0.03);
        assert_close(look(&world, vec3(0.1f, 0.2f, -3), vec3(0, 0.1f, 1), 2).mean, 30, 0.03);
    }
}

TEST_PROGRAM(NULL, NULL)
