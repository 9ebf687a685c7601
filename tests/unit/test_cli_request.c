/* SPDX-License-Identifier: Apache-2.0 */
/* What the user types after `parhelion render`, and what it does to a scene. */
#include "fixture.h"

#include "base/units.h"
#include "cli/render/render_request.h"
#include "cli/render/render_setup.h"

MEMORY_TEST(values_of_render_are_checked_before_anything_is_read) {
    static const struct {
        const char *option, *value, *text;
    } cases[] = {
        {"--samples", "5:5",
         "--samples 5:5: required: A:B, whole numbers with 0 <= A < B <= "
         "2147483647"},
        {"--samples", "-1:5", "--samples -1:5: required: A:B"},
        {"--samples", "5", "--samples 5: required: A:B"},
        {"--noise", "0", "--noise 0: required: a relative error above 0 and below 1"},
        {"--noise", "displays:0.1", "--noise displays:R: required: display, display:NAME or"},
        {"--noise", "display:", "--noise display:: required: a relative error above 0"},
        {"--noise", "0,0,9:0.1", "--noise 0,0,9:R: required: display, display:NAME or"},
        {"--noise", "0,0,65,9:0.1", "--noise 0,0,65,9:R: required: display, display:NAME or"},
        {"--noise", "4,4,4,9:0.1", "--noise 4,4,4,9:R: required: display, display:NAME or"},
        {"--noise", "0,0,1.5,9:0.1", "--noise 0,0,1.5,9:R: required: display, display:NAME"},
        {"--noise", "0,0,8,8:1.5", "--noise 0,0,8,8:1.5: required: a relative error above 0"},
        {"--layers", "depth,norml", "--layers: no layer is named 'norml' — did you mean normal?"},
        {"--layers", "", "--layers '': required: a text that is not empty"},
        {"--crop", "0,0,65,4",
         "--crop 0,0,65,4: required: X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 "
         "inside the frame of 64x36 pixels"},
        {"--crop", "4,0,4,4", "--crop 4,0,4,4: required: X0,Y0,X1,Y1"},
        {"--crop", "0.5,0,4,4", "--crop: 0.5 is no whole number of pixels"},
        {"--replay", "64,0,1", "--replay 64,0,1: required: X,Y,SAMPLE"},
        {"--content", "cluster", "--content cluster: required: NAME=VALUE, both not empty"},
        {"--view", "raw", "a look is asked for, but no picture — add --png FILE"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RenderRequest request;
        Error err = {0};
        const char *words[] = {"render", "nowhere.gltf",  "-o",          "a.exr", "--size",
                               "64x36",  cases[i].option, cases[i].value};
        assert_false(render_request_parse(8, (char **)(uintptr_t)words, arena, &request, &err));
        if (err.code != ERROR_USAGE || strstr(err.text, cases[i].text) != err.text)
            fail_msg("%s %s: %s", cases[i].option, cases[i].value, err.text);
    }
}

MEMORY_TEST(values_of_the_surroundings_are_checked) {
    static const struct {
        EnvironmentChange change;
        const char *text;
    } cases[] = {
        {{.environment = "sky:clear"},
         "--environment sky:clear: where does the sun stand? — add --when and --where, or "
         "--sun AZ,EL"},
        {{.environment = "constant:-1"},
         "--environment constant:-1: required: a luminance in cd/m2, 0 to 1e+12"},
        {{.environment = "constant:1e40"},
         "--environment constant:1e40: required: a luminance in cd/m2, "
         "0 to 1e+12"},
        {{.environment = "cie:5:1e30"},
         "--environment cie:5:1e30: required: cie:N or cie:N:LUX with N 1 to 15 (16: the "
         "traditional overcast sky) and LUX up to 1e+09"},
        {{.environment = "perez:800,1e50"},
         "--environment perez:800,1e50: required: perez:DIRECT,DIFFUSE, normal and horizontal "
         "irradiance in W/m2, up to 1e+07"},
        {{.environment = "black"},
         "--environment black: required: sky:clear, cie:N[:LUX], "
         "perez:DIRECT,DIFFUSE, hdri:FILE or constant:CD_M2"},
        {{.has_hdri_lux = true, .hdri_lux = 9},
         "--hdri-lux: there is no HDRI — add --environment "
         "hdri:FILE"},
        {{.sun = "100,20"},
         "--sun 100,20: the scene's sun has no illuminance to keep — write "
         "AZ,EL,LUX"},
        {{.sun = "1,95,1000"},
         "--sun 1,95,1000: required: auto, off, or AZ,EL,LUX with AZ -360 to 360 and "
         "EL -90 to 90 degrees and LUX 0 to 1e+09"},
        {{.sun = "200,45,8e94"},
         "--sun 200,45,8e94: required: auto, off, or AZ,EL,LUX with AZ -360 to 360 and "
         "EL -90 to 90 degrees and LUX 0 to 1e+09"},
        {{.has_forward = true, .forward = {0, 1, 0}},
         "--forward 0,1,0: required: a vector that is not vertical"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Scene scene = {0};
        Problems problems = problems_start(arena);
        Error err = {0};
        assert_false(environment_change(&cases[i].change, &scene, arena, &problems, &err));
        assert_int_equal(err.code, ERROR_USAGE);
        assert_string_equal(err.text, cases[i].text);
    }
}

MEMORY_TEST(the_line_overrides_single_members_of_the_surroundings) {
    Scene scene = {
        .environment = {.has_sun = true, .sun_illuminance_lx = 5000, .sun_angular_radius = 0.01f}};
    EnvironmentChange change = {
        .environment = "constant:250", .sun = "90,30", .has_heading = true, .heading_deg = 180};
    Problems problems = problems_start(arena);
    assert_done(environment_change(&change, &scene, arena, &problems, &err));
    const Environment *e = &scene.environment;
    assert_int_equal(e->kind, ENVIRONMENT_CONSTANT);
    assert_true(e->luminance_cd_m2 == 250 && e->color[2] == 1);
    assert_close(e->sun_azimuth, PI / 2, 1e-6);
    assert_close(e->sun_elevation, PI / 6, 1e-6);
    assert_true(e->sun_illuminance_lx == 5000 && e->sun_angular_radius == 0.01f);
    assert_close(e->heading, PI, 1e-6);
    assert_true(e->forward.z == -1);
    EnvironmentChange off = {.sun = "off"};
    assert_done(environment_change(&off, &scene, arena, &problems, &err));
    assert_false(e->has_sun);
    assert_true(e->luminance_cd_m2 == 250);
}

MEMORY_TEST(a_sky_is_asked_for_by_its_kind_time_and_place) {
    Problems problems = problems_start(arena);
    Scene scene = {0};
    EnvironmentChange clear = {.environment = "sky:clear",
                               .when = "2026-06-21T08:30+02:00",
                               .where = "48.14,11.58,520",
                               .has_visibility = true,
                               .visibility_km = 23};
    assert_done(environment_change(&clear, &scene, arena, &problems, &err));
    const Environment *e = &scene.environment;
    assert_int_equal(e->kind, ENVIRONMENT_SKY);
    assert_true(e->daylight.has_time && !e->has_sun && e->daylight.when.hour == 8);
    assert_close(e->daylight.where.altitude_m, 520, 1e-12);
    assert_close(e->daylight.visibility_km, 23, 1e-12);
    assert_false(e->daylight.no_moon);
    EnvironmentChange later = {.no_moon = true, .when = "2026-06-21T09:30+02:00", .sun = "auto"};
    assert_done(environment_change(&later, &scene, arena, &problems, &err));
    assert_true(e->daylight.when.hour == 9 && e->daylight.where.altitude_m == 520);
    assert_true(e->daylight.no_moon);
    EnvironmentChange cie = {.environment = "cie:12:15000", .sun = "180,35,90000"};
    assert_done(environment_change(&cie, &scene, arena, &problems, &err));
    assert_true(e->kind == ENVIRONMENT_CIE && e->daylight.cie_type == 12);
    assert_true(e->has_sun && e->sun_illuminance_lx == 90000 && e->daylight.diffuse_lux == 15000);
    assert_int_equal(problems.count, 0);
    EnvironmentChange bare = {.environment = "cie:3"};
    Scene other = {0};
    assert_done(environment_change(&bare, &other, arena, &problems, &err));
    assert_int_equal(problems.count, 1); /* the illuminance that was taken */
}

MEMORY_TEST(what_makes_no_sky_is_refused_by_name) {
    static const struct {
        EnvironmentChange change;
        const char *part;
    } cases[] = {
        {{.environment = "sky:clear"}, "where does the sun stand"},
        {{.environment = "sky:clear", .when = "2026-06-21T08:30+02:00"}, "add --where"},
        {{.environment = "sky:clear", .where = "48,11"}, "add --when"},
        {{.environment = "sky:clear", .when = "08:30", .where = "48,11"}, "is no moment"},
        {{.environment = "sky:clear", .when = "2026-06-21T08:30Z", .where = "100,11"}, "LAT,LON"},
        {{.environment = "cie:17"}, "1 to 15"},
        {{.environment = "cie:"}, "1 to 15"},
        {{.environment = "perez:800"}, "DIRECT,DIFFUSE"},
        {{.environment = "perez:800,100"}, "where does the sun stand"},
        {{.when = "2026-06-21T08:30Z", .where = "48,11"}, "no sky that it could change"},
        {{.environment = "constant:5", .has_turbidity = true, .turbidity = 3}, "no air"},
        {{.environment = "constant:5", .sun = "auto"}, "--when and --where"},
        {{.environment = "constant:5", .ground = "sea"}, "only a clear sky"},
        {{.environment = "sky:clear", .sun = "0,9", .ground = "lava"}, "required: land, sea"},
        {{.environment = "sky:clear", .sun = "0,9", .ground = "cloud:x"},
         "required: land, "
         "sea"},
        {{.weather = "none.epw"}, "add --when"},
        {{.environment = "sky:clear", .sun = "0,9", .has_weather_offset = true}, "add --weather"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Scene scene = {0};
        Problems problems = problems_start(arena);
        assert_fails_as(environment_change(&cases[i].change, &scene, arena, &problems, &err),
                        ERROR_USAGE, cases[i].part);
    }
}

TEST(an_eye_needs_a_point_to_look_at) {
    static const struct {
        CameraChoice choice;
        const char *part;
    } cases[] = {
        {{.has_eye = true}, "--eye: required: --eye X,Y,Z and --look-at"},
        {{.has_look_at = true}, "--look-at: required: --eye"},
        {{.has_fov = true, .fov_deg = 30}, "--fov: required: --eye"},
        {{.has_eye = true, .has_look_at = true, .name = "left"}, "exclude each other"},
        {{.has_eye = true, .has_look_at = true}, "is where --eye is"},
    };
    Scene scene = {0};
    SceneCamera found;
    Problems problems = problems_start(*state);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error err = {0};
        assert_false(render_choose_camera(&scene, &cases[i].choice, &problems, &found, &err));
        assert_int_equal(err.code, ERROR_USAGE);
        if (!strstr(err.text, cases[i].part)) fail_msg("%s", err.text);
    }
    Error err;
    const CameraChoice choice = {.eye = {1, 2, 5},
                                 .look_at = {1, 2, 0},
                                 .fov_deg = 90,
                                 .has_eye = true,
                                 .has_look_at = true,
                                 .has_fov = true};
    assert_true(render_choose_camera(&scene, &choice, &problems, &found, &err));
    assert_int_equal(problems.count, 0);
    assert_close(found.yfov, 1.5707963, 1e-6);
    assert_close(found.world_from_camera.origin.z, 5, 0);
}

TEST(a_camera_is_found_by_node_then_by_camera_then_by_place) {
    SceneCamera cameras[] = {{.node_name = "left", .camera_name = "1"},
                             {.node_name = "right", .camera_name = "left"},
                             {.node_name = "", .camera_name = "lens"}};
    Scene scene = {.cameras = cameras, .camera_count = 3};
    Problems problems = problems_start(*state);
    SceneCamera found;
    static const struct {
        const char *wanted;
        int index;
    } cases[] = {{NULL, 0}, {"left", 0}, {"1", 0}, {"right", 1}, {"lens", 2}, {"2", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const CameraChoice choice = {.name = cases[i].wanted};
        assert_done(render_choose_camera(&scene, &choice, &problems, &found, &err));
        assert_ptr_equal(found.camera_name, cameras[cases[i].index].camera_name);
    }
    assert_fails_with(
        render_choose_camera(&scene, &(CameraChoice){.name = "3"}, &problems, &found, &err),
        "--camera 3: no camera has this name or index — the scene has 0 'left', "
        "1 'right', 2 'lens'");
    assert_int_equal(problems.count, 0);
    Scene empty = {0};
    assert_done(render_choose_camera(&empty, &(CameraChoice){0}, &problems, &found, &err));
    assert_int_equal(problems.count, 1);
    assert_non_null(strstr(problems.list[0].message, "neither a camera nor triangles"));
    assert_true(found.yfov > 0 && found.world_from_camera.origin.z == 0);
}

TEST_PROGRAM(make_arena, drop_arena)
