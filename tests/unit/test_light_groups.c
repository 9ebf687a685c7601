/* SPDX-License-Identifier: Apache-2.0 */
/* Which lights are one group, and what their layers are called. */
#include "light_fixture.h"

#include "light/light_groups.h"

static void add_lamp(Scene *scene, const char *name) {
    scene->lights[scene->light_count++] =
        (PunctualLight){.name = name, .kind = LIGHT_POINT, .intensity = {1, 1, 1}};
}

static void add_emitter(Scene *scene, const char *name, float cd_m2) {
    Material m = builder_lamp(cd_m2);
    m.name = name;
    m.is_emitter = cd_m2 > 0;
    builder_part(scene, m);
    builder_quad(scene, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0));
}

static LightGroups groups_of(const Scene *scene, Arena *arena, Problems *problems) {
    *problems = problems_start(arena);
    return light_groups_build(scene, build(scene, arena), arena, problems);
}

static void assert_names(const LightGroups *groups, const char *const *names, int count) {
    assert_int_equal(groups->count, count);
    for (int i = 0; i < count; i++) assert_string_equal(groups->names[i], names[i]);
}

/* A lamp and the bulb about it are one; what does not emit is none. */
ARENA_TEST(lights_of_one_name_are_one_group) {
    Scene *scene = builder_scene(&arena);
    Problems problems;
    builder_sky(scene, 5);
    builder_sun(scene, 0, 0, 1);
    add_lamp(scene, "dome");
    add_lamp(scene, "map");
    add_lamp(scene, "dome");
    add_emitter(scene, "dome", 1);
    add_emitter(scene, "leather", 0);
    add_emitter(scene, "strip", 1);
    LightGroups groups = groups_of(scene, &arena, &problems);
    static const char *const names[] = {"sun", "sky", "dome", "map", "strip"};
    static const int of_light[] = {2, 3, 2}, of_part[] = {2, NO_ID, 4};
    assert_names(&groups, names, 5);
    assert_int_equal(light_group_of(&groups, LIGHTS_SUN, 0), 0);
    assert_int_equal(light_group_of(&groups, LIGHTS_SKY, 0), 1);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(light_group_of(&groups, LIGHTS_PUNCTUAL, i), of_light[i]);
        assert_int_equal(light_group_of(&groups, LIGHTS_EMITTERS, i), of_part[i]);
    }
    assert_int_equal(problems.count, 0);
}

ARENA_TEST(what_a_scene_has_not_is_no_group) {
    Problems problems;
    LightGroups groups = groups_of(builder_scene(&arena), &arena, &problems);
    assert_int_equal(groups.count, 0);
    assert_int_equal(groups.sun, NO_ID);
    assert_int_equal(groups.sky, NO_ID);
}

/* A display is not the lamp of its name, and no lamp is the sun. */
ARENA_TEST(names_that_become_the_same_are_told_apart_and_told_of) {
    Scene *scene = builder_scene(&arena);
    Problems problems;
    builder_sun(scene, 0, 0, 1);
    add_lamp(scene, "sun");
    add_lamp(scene, "a b");
    add_lamp(scene, "a.b");
    add_lamp(scene, "a/b");
    add_lamp(scene, "");
    LightGroups groups = groups_of(scene, &arena, &problems);
    static const char *const names[] = {"sun", "sun_2", "a_b", "a_b_2", "a_b_3", "unnamed"};
    assert_names(&groups, names, 6);
    assert_string_equal(groups.said[3], "a.b");
    assert_int_equal(problems.count, 3);
    assert_string_equal(problems.list[1].message,
                        "the light of \"a.b\" is the layer light.a_b_2: another light has "
                        "light.a_b");
}

ARENA_TEST(names_are_those_of_channels) {
    Scene *scene = builder_scene(&arena);
    Problems problems;
    char longest[200] = "x";
    for (int i = 1; i < 180; i += 2) memcpy(longest + i, "\xc3\xa4", 3);
    add_lamp(scene, "Lampe \xc3\xbc"
                    "ber\tTuer-1+2_3,4");
    add_lamp(scene, longest);
    LightGroups groups = groups_of(scene, &arena, &problems);
    assert_string_equal(groups.names[0], "Lampe_\xc3\xbc"
                                         "ber_Tuer-1+2_3_4");
    assert_int_equal(strlen(groups.names[1]), 63);
    assert_memory_equal(groups.names[1], longest, 63);
}

TEST_PROGRAM(make_arena, drop_arena)
