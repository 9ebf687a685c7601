/* SPDX-License-Identifier: Apache-2.0 */
#include "fixture.h"

#include "base/sampler.h"
#include "mirror/glint_map.h"

#define ROOM (64u << 20)

static Vec3 on_square(uint32_t i, float side_m) {
    Sampler sampler = sampler_start(1, 2, 3, i);
    Vec2 at = sampler_2d(&sampler);
    return vec3(side_m * at.x, 0.3f, side_m * at.y);
}

/* What the adding tells is the most that is found anywhere, and is found somewhere near. */
ARENA_TEST(no_place_has_more_than_the_adding_told) {
    const float edge = 0.05f;
    GlintMap map = {{{0}}};
    float most = 0, found = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        GlintPlace place = {7, edge, on_square(i, 1 + i % 2)};
        most = fmaxf(most, glint_map_add(&map, &place, 1 + (float)(i % 5), &arena));
    }
    for (uint32_t i = 0; i < 100000; i++) {
        GlintPlace place = {7, edge, on_square(i + 7, 2)};
        place.position.y += 0.1f * (float)(i % 3 - 1.0f);
        found = fmaxf(found, glint_map_lx(&map, &place));
    }
    assert_true(found <= most);
    assert_close((double)found, (double)most, 0.05);
}

/* 1000 lx on a square of 2 m, by so many rays. */
static GlintMap lit_square(uint32_t row, float edge_m, uint32_t rays, Arena *arena) {
    GlintMap map = {{{0}}};
    for (uint32_t i = 0; i < rays; i++) {
        GlintPlace place = {row, edge_m, on_square(i, 2)};
        glint_map_add(&map, &place, 4000.0f / (float)rays, arena);
    }
    return map;
}

/* Of a plane between cubes, and of planes within them. */
ARENA_TEST(even_light_is_found_as_it_is) {
    const float edges[] = {0.02f, 0.031f, 0.05f};
    for (int k = 0; k < 3; k++) {
        GlintMap map = lit_square(7, edges[k], 200000, &arena);
        for (int i = 0; i < 100; i++) {
            Vec3 at = vec3_along(vec3(0.7f, 0.3f, 0.7f), on_square((uint32_t)i, 0.6f), 1);
            GlintPlace place = {7, edges[k], vec3(at.x, 0.3f, at.z)};
            assert_close((double)glint_map_lx(&map, &place), 1000, 0.2);
        }
    }
}

ARENA_TEST(nothing_is_found_off_the_light_or_in_another_row) {
    GlintMap none = {{{0}}}, map = lit_square(7, 0.02f, 20000, &arena);
    GlintPlace lit = {7, 0.02f, vec3(1, 0.3f, 1)}, row = lit, above = lit, beside = lit;
    row.row = 8;
    above.position.y = 0.7f;
    beside.position.x = -0.4f;
    assert_true(glint_map_lx(&map, &lit) > 0);
    assert_true(glint_map_lx(&map, &row) == 0);
    assert_true(glint_map_lx(&map, &above) < 0.1f * glint_map_lx(&map, &lit));
    assert_true(glint_map_lx(&map, &beside) < 0.1f * glint_map_lx(&map, &lit));
    above.position.y = 20;
    beside.position.x = -20;
    assert_true(glint_map_lx(&map, &above) == 0);
    assert_true(glint_map_lx(&map, &beside) == 0);
    assert_true(glint_map_lx(&none, &lit) == 0);
}

/* Of few rays some chance to leave a large cube empty: there it is not taken for dark. */
ARENA_TEST(no_place_among_few_rays_is_dark) {
    GlintMap map = lit_square(7, 0.02f, 100, &arena);
    for (int i = 0; i < 4000; i++) {
        Vec3 at = vec3_along(vec3(0.3f, 0.3f, 0.3f), on_square((uint32_t)i, 1.4f), 1);
        GlintPlace place = {7, 0.02f, vec3(at.x, 0.3f, at.z)};
        float lx = glint_map_lx(&map, &place);
        assert_true(lx > 30 && lx < 1e5f);
    }
}

/* A small glint is as bright as it is, one ray is known all around it, and a far and a tiny
 * cube are no fault. */
ARENA_TEST(one_landing_is_known_where_it_is_and_around) {
    GlintMap map = {{{0}}};
    GlintPlace at = {3, 0.01f, vec3(-5, 1, 2)}, near = at, far = {4, 1e-4f, vec3(1e30f, 0, 0)};
    glint_map_add(&map, &at, 0.5f, &arena);
    glint_map_add(&map, &far, 0.5f, &arena);
    assert_close((double)glint_map_lx(&map, &at), 0.5 / 4e-4, 1e-4);
    near.position.x += 0.0049f;
    near.position.z -= 0.0049f;
    assert_true(glint_map_lx(&map, &near) == glint_map_lx(&map, &at));
    near.position.x += 0.03f;
    assert_true(glint_map_lx(&map, &near) < glint_map_lx(&map, &at));
    assert_true(glint_map_lx(&map, &near) > 0);
    assert_true(glint_map_lx(&map, &far) > 0);
}

/* Each landing is found again, and each counts eight times. */
ARENA_TEST(a_growing_map_keeps_all_its_light) {
    GlintMap map = lit_square(1, 0.002f, 100000, &arena);
    assert_true(map.size[0].count > 300000);
    assert_true(map.size[0].room < 2 * map.size[0].count);
    double lm = 0;
    for (uint32_t i = 0; i < map.size[0].room; i++) lm += (double)map.size[0].cubes[i].lm;
    assert_close(lm, 8 * 4000.0, 1e-3);
    for (uint32_t i = 0; i < 100000; i++) {
        GlintPlace place = {1, 0.002f, on_square(i, 2)};
        assert_true(glint_map_lx(&map, &place) >= 4000.0f / 100000 / (4 * 4e-6f) * 0.999f);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
