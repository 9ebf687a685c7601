/* SPDX-License-Identifier: Apache-2.0 */
/* A symbol as an eye sees it: how large, how much of it, how bright. */
#include "symbol_fixture.h"

#include "base/units.h"
#include "review/symbol/symbol_sight.h"
#include "world_fixture.h"

enum { POINTS = 4096 };

/* ---- displays ---------------------------------------------------------------------------- */

/* Starts a part that wears a new display of the easel's panel. */
static void wear_display(World *world, const Easel *easel) {
    Material material = builder_material(0);
    material.display_id = world->scene->display_count;
    material.is_emitter = true;
    int id = builder_part(world->scene, material);
    world->scene->displays[world->scene->display_count++] =
        (Display){.name = "display",
                  .panel = easel->panel,
                  .material_id = id,
                  .level = 1,
                  .content = builder_no_texture()};
}

/* Another part of the last material. */
static void same_material(World *world) {
    Scene *scene = world->scene;
    builder_part(scene, scene->materials[scene->material_count - 1]);
    scene->material_count--;
    scene->parts[scene->part_count - 1].material_id = scene->material_count - 1;
}

/* The first display, of these parts. */
static SymbolSurface surface_of(World *world, const int *parts, int count, const double uv[4]) {
    ReviewDisplay display = {0, parts, count};
    SymbolPlace place = {world->scene, &display, {uv[0], uv[1], uv[2], uv[3]}, POINTS};
    SymbolSurface surface;
    assert_done(symbol_surface_build(&place, &world->arena, &surface, &err));
    return surface;
}

static SymbolSurface first_part(World *world, const double uv[4]) {
    return surface_of(world, (const int[]){0}, 1, uv);
}

/* A display of 0.4 x 0.2 m in the plane z = 0 that faces +z. */
static World flat_world(const Easel *easel) {
    World world = world_start();
    wear_display(&world, easel);
    builder_quad(world.scene, vec3(0, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.1f, 0));
    return world;
}

static const double ALL[4] = {0, 0, 1, 1};

/* ---- where it is ------------------------------------------------------------------------- */

EASEL_TEST(points_lie_where_the_content_is_shown) {
    ENDS_BY(world_end) World world = flat_world(easel);
    const double uv[4] = {0.25, 0.5, 0.5, 1};
    SymbolSurface surface = first_part(&world, uv);
    int in_quarter = 0;
    assert_close(surface.area_m2, 0.1 * 0.1, 1e-5);
    for (int i = 0; i < surface.point_count; i++) {
        const SymbolPoint *p = &surface.points[i];
        assert_near(p->position.x, 0.4 * ((double)p->uv.x - 0.5), 1e-6);
        assert_near(p->position.y, 0.2 * (0.5 - (double)p->uv.y), 1e-6);
        assert_near(p->ng.z, 1, 1e-6);
        in_quarter += p->uv.x < 0.375f && p->uv.y < 0.75f;
    }
    assert_int_equal(in_quarter, POINTS / 4);
}

/* Every cell of 64 x 64 is the patch of one point, which lies in it. */
EASEL_TEST(patches_make_up_the_rectangle) {
    ENDS_BY(world_end) World world = flat_world(easel);
    const double uv[4] = {0.25, 0.5, 0.5, 1};
    SymbolSurface surface = first_part(&world, uv);
    char seen[POINTS] = {0};
    for (int i = 0; i < surface.point_count; i++) {
        SymbolPatch patch = symbol_patch(&surface, i);
        Vec3 off = vec3_sub(surface.points[i].position, patch.middle);
        assert_near(patch.along.x, 0.1 / 64, 1e-7);
        assert_near(patch.down.y, -0.1 / 64, 1e-7);
        assert_near(patch.along.y, 0, 1e-7);
        assert_near(patch.down.x, 0, 1e-7);
        assert_true(fabsf(off.x) <= 0.051f / 64 && fabsf(off.y) <= 0.051f / 64);
        int column = (int)((patch.middle.x + 0.1f) / 0.1f * 64);
        int row = (int)(-patch.middle.y / 0.1f * 64);
        assert_true(column >= 0 && column < 64 && row >= 0 && row < 64);
        assert_int_equal(seen[row * 64 + column]++, 0);
    }
}

/* The texture's transform: the content's right half alone, upside down. */
EASEL_TEST(a_texture_transform_moves_the_symbol) {
    ENDS_BY(world_end) World world = flat_world(easel);
    TextureSlot *slot = &world.scene->displays[0].content;
    const float half_turned[6] = {0.5f, 0, 0.5f, 0, -1, 1};
    memcpy(slot->uv_from_uv, half_turned, sizeof half_turned);
    const double uv[4] = {0.5, 0, 0.75, 0.5};
    SymbolSurface surface = first_part(&world, uv);
    SymbolPoint point;
    assert_true(symbol_surface_at(&surface, (double[2]){0.5, 0}, &point));
    assert_near(point.position.x, -0.2, 1e-6);
    assert_near(point.position.y, -0.1, 1e-6);
    assert_close(surface.area_m2, 0.2 * 0.1, 1e-5);
}

EASEL_TEST(a_symbol_outside_its_display_is_refused) {
    ENDS_BY(world_end) World world = flat_world(easel);
    int parts[1] = {0};
    world.scene->displays[0].content.uv_from_uv[0] = 0.5f; /* shows the left half alone */
    ReviewDisplay display = {0, parts, 1};
    SymbolPlace place = {world.scene, &display, {0.3, 0.2, 0.6, 0.4}, POINTS};
    SymbolSurface surface;
    assert_false(symbol_surface_build(&place, &world.arena, &surface, why()));
    assert_string_equal(why()->text, "the symbol lies outside its display, no part of which "
                                     "shows uv [0.6, 0.2] of its content");
    place.uv[2] = 0.5;
    assert_done(symbol_surface_build(&place, &world.arena, &surface, &err));
}

/* Its corners are on the display; between its halves there is nothing. */
EASEL_TEST(a_gap_in_the_display_is_refused) {
    ENDS_BY(world_end) World world = world_start();
    wear_display(&world, easel);
    const float x[4] = {-0.2f, -0.01f, 0.01f, 0.2f};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++)
            builder_vertex(world.scene, vec3(x[i], k ? 0.1f : -0.1f, 0), vec3(0, 0, 1),
                           0.5f + 2.5f * x[i], k ? 0.0f : 1.0f);
    for (uint32_t i = 0; i < 8; i += 4) {
        builder_triangle(world.scene, i, i + 2, i + 3);
        builder_triangle(world.scene, i, i + 3, i + 1);
    }
    int parts[1] = {0};
    ReviewDisplay display = {0, parts, 1};
    SymbolPlace place = {world.scene, &display, {0.1, 0.1, 0.9, 0.9}, POINTS};
    SymbolSurface surface;
    assert_fails_as(symbol_surface_build(&place, &world.arena, &surface, &err), ERROR_INPUT,
                    "the symbol lies outside its display");
    place.uv[2] = 0.475;
    assert_done(symbol_surface_build(&place, &world.arena, &surface, &err));
}

/* Two nodes wear one material: each has the symbol in its own place. */
EASEL_TEST(the_parts_that_are_given_are_asked) {
    ENDS_BY(world_end) World world = flat_world(easel);
    same_material(&world);
    builder_quad(world.scene, vec3(1, 0, 0), vec3(0.2f, 0, 0), vec3(0, 0.1f, 0));
    for (int part = 0; part < 2; part++) {
        SymbolSurface surface = surface_of(&world, &part, 1, ALL);
        for (int i = 0; i < surface.point_count; i++)
            assert_true((surface.points[i].position.x > 0.5f) == (part == 1));
    }
}

/* ---- how large --------------------------------------------------------------------------- */

/* The display leans back by the angle: of its height h top and bottom lie at +-h/2 (0, cos,
 * -sin). From (0, 0, d) they stand atan((h/2 cos) / (d +- h/2 sin)) above and below. */
EASEL_TEST(arc_minutes_at_five_slants_are_the_closed_form) {
    const double slants[] = {0, 20, 40, 60, 80}, distance = 0.75, h = 0.2;
    for (int i = 0; i < 5; i++) {
        ENDS_BY(world_end) World world = world_start();
        double angle = radians_from_degrees(slants[i]), c = cos(angle), s = sin(angle);
        wear_display(&world, easel);
        builder_quad(world.scene, vec3(0, 0, 0), vec3(0.2f, 0, 0),
                     vec3(0, (float)(h / 2 * c), (float)(-h / 2 * s)));
        SymbolSurface surface = first_part(&world, ALL);
        const double boxes[2][4] = {{0.499, 0.4, 0.501, 0.6}, {0.499, 0, 0.501, 1}};
        for (int k = 0; k < 2; k++) {
            double half = h / 2 * (boxes[k][3] - boxes[k][1]);
            double expected =
                atan2(half * c, distance + half * s) + atan2(half * c, distance - half * s);
            double found = symbol_height_arcmin(&surface, boxes[k], vec3(0, 0, 0.75f));
            assert_close(found, 60 * degrees_from_radians(expected), 5e-4);
        }
    }
}

/* Strips of a cylinder about the x axis, hollow towards it, over an arc. */
static void builder_arc(Scene *scene, double radius, double arc, int strips) {
    for (int i = 0; i <= strips; i++) {
        double t = arc * ((double)i / strips - 0.5); /* top first */
        for (int k = 0; k < 2; k++)
            builder_vertex(
                scene,
                vec3(k ? 0.01f : -0.01f, (float)(-radius * sin(t)), (float)(-radius * cos(t))),
                vec3(0, (float)sin(t), (float)cos(t)), (float)k, (float)i / (float)strips);
    }
    for (uint32_t i = 0; i < (uint32_t)strips; i++) {
        builder_triangle(scene, 2 * i, 2 * i + 2, 2 * i + 3);
        builder_triangle(scene, 2 * i, 2 * i + 3, 2 * i + 1);
    }
}

/* From the axis of a cylinder the height is the arc itself. */
EASEL_TEST(a_curved_display_has_the_angle_of_its_arc) {
    ENDS_BY(world_end) World world = world_start();
    double arc = radians_from_degrees(50);
    wear_display(&world, easel);
    builder_arc(world.scene, 0.8, arc, 200);
    SymbolSurface surface = first_part(&world, ALL);
    const double box[4] = {0.1, 0.2, 0.9, 0.7};
    double found = symbol_height_arcmin(&surface, box, vec3(0, 0, 0));
    assert_close(found, 60 * degrees_from_radians(0.5 * arc), 5e-4);
    assert_close(surface.area_m2, 0.02 * 0.8 * arc, 1e-3);
    assert_near(surface.points[0].ng.z, cos(arc / 2), 0.02);
}

/* ---- how much of it ---------------------------------------------------------------------- */

static const Vec3 EYE = {0.05f, 0.1f, 1};

/* A plate of half width 0.5 halfway to the eye that ends on the look at the display's x. */
static void add_plate(World *world, Material material, double display_x) {
    float edge = (float)((display_x + (double)EYE.x) / 2);
    builder_part(world->scene, material);
    builder_quad(world->scene, vec3(edge - 0.5f, 0, 0.5f), vec3(0.5f, 0, 0), vec3(0, 0.5f, 0));
}

static SymbolVisibility seen_from(World *world, Vec3 eye, bool *is_visible) {
    SymbolSurface surface = first_part(world, ALL);
    world_ready(world, 1);
    return symbol_visibility(&surface, &world->context, eye, is_visible);
}

EASEL_TEST(nothing_hides_a_free_display_and_from_behind_none_is_seen) {
    World world = flat_world(easel);
    SymbolVisibility front = seen_from(&world, EYE, NULL);
    assert_true(front.visible_share == 1 && front.transmittance == 1);
    world_end(&world);
    world = flat_world(easel);
    SymbolVisibility behind = seen_from(&world, vec3(0.05f, 0.1f, -1), NULL);
    assert_true(behind.visible_share == 0 && isnan(behind.transmittance));
    SymbolSurface surface = first_part(&world, ALL);
    SymbolHiding hiding =
        symbol_hiding(&surface, &world.context, vec3(0.05f, 0.1f, -1), &world.arena);
    assert_near(hiding.turned_away, 1, 1e-6);
    world_end(&world);
}

/* Shares of the width that the plate covers. */
EASEL_TEST(a_plate_hides_the_share_that_it_covers) {
    const double shares[] = {0.5, 0.25, 0.9};
    for (int i = 0; i < 3; i++) {
        ENDS_BY(world_end) World world = flat_world(easel);
        bool *is_visible = ARENA_NEW(&world.arena, bool, POINTS);
        add_plate(&world, builder_material(0.5f), 0.4 * shares[i] - 0.2);
        SymbolVisibility seen = seen_from(&world, EYE, is_visible);
        SymbolSurface surface = first_part(&world, ALL);
        assert_near(seen.visible_share, 1 - shares[i], 2e-3);
        assert_true(seen.transmittance == 1);
        SymbolHiding hiding = symbol_hiding(&surface, &world.context, EYE, &world.arena);
        assert_near(hiding.by_part[1], shares[i], 2e-3); /* the plate's */
        assert_true(hiding.by_part[0] == 0 && hiding.turned_away == 0);
        assert_near(hiding.by_part[1] + seen.visible_share, 1, 1e-6);
        for (int k = 0; k < POINTS; k++)
            if (fabs((double)surface.points[k].uv.x - shares[i]) > 1e-4)
                assert_true(is_visible[k] == ((double)surface.points[k].uv.x > shares[i]));
    }
}

/* An edge goes through the middle of a column of patches: they are points, all others whole. */
EASEL_TEST(a_patch_that_is_covered_in_part_is_a_point) {
    ENDS_BY(world_end) World world = flat_world(easel);
    bool *is_visible = ARENA_NEW(&world.arena, bool, POINTS);
    int whole = 0, points = 0;
    add_plate(&world, builder_material(0.5f), 0.4 * 20.5 / 64 - 0.2);
    seen_from(&world, EYE, is_visible);
    SymbolSurface surface = first_part(&world, ALL);
    for (int i = 0; i < POINTS; i++) {
        if (!is_visible[i]) continue;
        SymbolPatch patch = symbol_patch_seen(&surface, i, &world.context, EYE);
        bool is_cut = surface.points[i].uv.x < 21.0f / 64;
        assert_near(patch.along.x, is_cut ? 0 : 0.4 / 64, 1e-6);
        assert_near(patch.down.y, is_cut ? 0 : -0.2 / 64, 1e-6);
        (*(is_cut ? &points : &whole))++;
    }
    assert_int_equal(whole, 43 * 64);
    assert_true(points > 16 && points < 48); /* half of those of the column */
}

/* 0.05 mm over the display, 1 m from the eye. */
EASEL_TEST(a_bezel_that_lies_on_the_display_hides_it) {
    ENDS_BY(world_end) World world = flat_world(easel);
    builder_part(world.scene, builder_material(0.5f));
    builder_quad(world.scene, vec3(-0.15f, 0, 5e-5f), vec3(0.05f, 0, 0), vec3(0, 0.2f, 0));
    assert_near(seen_from(&world, EYE, NULL).visible_share, 0.75, 2e-3);
}

/* Points that stand for unlike areas: the content's left half is four times as large. */
EASEL_TEST(a_share_is_one_of_area) {
    ENDS_BY(world_end) World world = world_start();
    wear_display(&world, easel);
    const float x[3] = {-0.4f, 0, 0.1f};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            builder_vertex(world.scene, vec3(x[i], k ? 0.1f : -0.1f, 0), vec3(0, 0, 1),
                           0.5f * (float)i, k ? 0.0f : 1.0f);
    for (uint32_t i = 0; i < 2; i++) {
        builder_triangle(world.scene, 2 * i, 2 * i + 2, 2 * i + 3);
        builder_triangle(world.scene, 2 * i, 2 * i + 3, 2 * i + 1);
    }
    add_plate(&world, builder_material(0.5f), 0);
    SymbolVisibility seen = seen_from(&world, EYE, NULL);
    assert_near(seen.visible_share, 0.2, 2e-3);
}

/* What a tint of 1/2 lets pass of a pane without faces, where the way through it is the longer
 * the more slanting the look: the mean of 1/2^(1 / cos) over the display. */
static double half_tint(void) {
    double sum = 0;
    for (int i = 0; i < 400; i++) {
        double x = 0.4 * ((i % 20 + 0.5) / 20 - 0.5) - (double)EYE.x;
        double y = 0.2 * ((i / 20 + 0.5) / 20 - 0.5) - (double)EYE.y;
        sum += pow(0.5, sqrt(x * x + y * y + 1)) / 400;
    }
    return sum;
}

/* Of an index of 1.5 each face reflects 4 %, seen nearly upright: (1 - R) / (1 + R) passes. */
EASEL_TEST(a_window_hides_nothing_and_says_what_it_takes) {
    const struct {
        float ior, grey;
        double share, passes;
    } panes[] = {
        {1, 1, 1, 1}, {1.5f, 1, 1, 0.96 / 1.04}, {1, 0.5f, 1, half_tint()}, {1, 0.001f, 0, 0}};
    for (int i = 0; i < 4; i++) {
        ENDS_BY(world_end) World world = flat_world(easel);
        Material pane = builder_pane(panes[i].ior);
        for (int c = 0; c < 3; c++) pane.base_color[c] = panes[i].grey;
        add_plate(&world, pane, 0.4); /* before all of it */
        SymbolVisibility seen = seen_from(&world, EYE, NULL);
        assert_true(seen.visible_share == panes[i].share);
        if (panes[i].share > 0) assert_close(seen.transmittance, panes[i].passes, 1e-3);
    }
}

/* A sheet with holes: alpha below its cutoff. */
EASEL_TEST(a_hole_hides_nothing) {
    for (int k = 0; k < 2; k++) {
        ENDS_BY(world_end) World world = flat_world(easel);
        Material sheet = builder_material(0.5f);
        sheet.alpha_mode = ALPHA_MASK;
        sheet.base_color[3] = k ? 0.8f : 0.2f;
        sheet.lets_light_through = true;
        add_plate(&world, sheet, 0.4);
        assert_true(seen_from(&world, EYE, NULL).visible_share == (k ? 0 : 1));
    }
}

/* ---- how bright -------------------------------------------------------------------------- */

/* White where x < 30, black elsewhere: says the classes whatever is shown. */
static SymbolSplit split_halves(Easel *easel, const Image *content) {
    uint8_t *pixels = ARENA_NEW(&easel->arena, uint8_t, 4 * 60 * 30);
    for (int i = 0; i < 60 * 30; i++) {
        memset(pixels + 4 * i, i % 60 < 30 ? 255 : 0, 3);
        pixels[4 * i + 3] = 255;
    }
    Image mask = {60, 30, IMAGE_RGBA8, pixels};
    SymbolQuestion question = {
        .panel = easel->panel, .content = content, .mask = &mask, .uv = {0, 0, 1, 1}};
    SymbolSplit split;
    assert_done(symbol_split(&question, &easel->arena, &split, &err));
    return split;
}

/* Codes that are the same everywhere, or alternate with black. */
static Image plain(Easel *easel, const uint8_t rgb[3], bool alternates) {
    uint8_t *pixels = ARENA_NEW(&easel->arena, uint8_t, 4 * 60 * 30);
    for (int i = 0; i < 60 * 30; i++)
        for (int k = 0; k < 4; k++)
            pixels[4 * i + k] = k == 3 ? 255 : alternates && i % 2 ? 0 : rgb[k];
    return (Image){60, 30, IMAGE_RGBA8, pixels};
}

/* From so far away that all pixels are seen along one direction. */
EASEL_TEST(one_colour_has_the_panels_own_light) {
    const uint8_t rgb[3] = {250, 120, 30};
    const float codes[3] = {250, 120, 30};
    Image content = plain(easel, rgb, false);
    SymbolSplit split = split_halves(easel, &content);
    ENDS_BY(world_end) World world = flat_world(easel);
    SymbolSurface surface = first_part(&world, ALL);
    for (int i = 0; i < 5; i++) {
        double t = radians_from_degrees(14 * i), p = radians_from_degrees(70 * i);
        Vec3 towards = vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
        float xyz[3];
        panel_emission_xyz(easel->panel, towards, codes, xyz);
        SymbolLook look = {&surface, &split, vec3_scale(towards, 300), 1 + i % 3, NULL};
        SymbolEmission seen = symbol_emission(&look, 0.3);
        for (int k = 0; k < 3; k++) {
            assert_close(seen.xyz[SYMBOL_FOREGROUND][k], 0.3 * (double)xyz[k], 1e-3);
            assert_close(seen.xyz[SYMBOL_BACKGROUND][k], 0.3 * (double)xyz[k], 1e-3);
        }
    }
    SymbolLook back = {&surface, &split, vec3(0, 0, -1), 1, NULL};
    SymbolEmission behind = symbol_emission(&back, 1);
    assert_true(isnan(behind.xyz[SYMBOL_FOREGROUND][1]));
}

/* Half of the pixels white, half black: half of white's light, not the light of half a code. */
EASEL_TEST(light_is_averaged_and_not_codes) {
    const uint8_t white[3] = {255, 255, 255};
    Image content = plain(easel, white, true);
    SymbolSplit split = split_halves(easel, &content);
    ENDS_BY(world_end) World world = flat_world(easel);
    SymbolSurface surface = first_part(&world, ALL);
    SymbolLook look = {&surface, &split, vec3(0, 0, 500), 2, NULL};
    SymbolEmission seen = symbol_emission(&look, 1);
    double half = 0.5 * (easel_luminance(easel, 255) + easel_luminance(easel, 0));
    assert_close(seen.xyz[SYMBOL_FOREGROUND][1], half, 1e-3);
    assert_close(split.foreground_cd_m2, half, 1e-5);
}

/* Classes keep their places: left white, right black. */
EASEL_TEST(each_class_has_its_own_light) {
    Boxes left = {1, {{0, 0, 30, 30}}};
    const double ink_ground[2] = {1, 0.3};
    Image content = easel_draw(easel, 60, 30, ink_ground, boxes_coverage, &left);
    SymbolSplit split = split_halves(easel, &content);
    ENDS_BY(world_end) World world = flat_world(easel);
    SymbolSurface surface = first_part(&world, ALL);
    SymbolLook look = {&surface, &split, vec3(0, 0, 500), 2, NULL};
    SymbolEmission seen = symbol_emission(&look, 1);
    assert_close(seen.xyz[SYMBOL_FOREGROUND][1], split.foreground_cd_m2, 1e-3);
    assert_close(seen.xyz[SYMBOL_BACKGROUND][1], split.background_cd_m2, 1e-3);
    assert_true(seen.xyz[SYMBOL_FOREGROUND][1] > 2 * seen.xyz[SYMBOL_BACKGROUND][1]);
}

/* Y of a code's light behind a pane of that colour, summed nanometre by nanometre. */
static double behind_pane(const Easel *easel, const float codes[3], const float rgb[3]) {
    double sum = 0;
    for (int i = 0; i < 512; i++) {
        Wavelengths w;
        wavelengths_sample(((float)i + 0.5f) / 512, &w);
        Spectrum sent = panel_emission_spectrum(easel->panel, vec3(0, 0, 1), codes, &w);
        sum += (double)spectrum_sum(sent * spectrum_from_rgb(&w, rgb) * w.xyz[1]) / 512;
    }
    return sum;
}

/* Left red, right blue, behind a pane without faces: each loses by its own spectrum, before
 * lenses and behind them; a grey pane takes the same of both, to the last bit. */
EASEL_TEST(a_tint_takes_of_each_class_by_its_own_spectrum) {
    const float codes[2][3] = {{0, 0, 255}, {255, 0, 0}}; /* [SymbolClass] */
    const float panes[2][3] = {{1, 0.6f, 0.3f}, {0.5f, 0.5f, 0.5f}};
    uint8_t *pixels = ARENA_NEW(&easel->arena, uint8_t, 4 * 60 * 30);
    for (int i = 0; i < 60 * 30; i++)
        for (int k = 0; k < 4; k++)
            pixels[4 * i + k] = k == 3 ? 255 : (uint8_t)codes[i % 60 < 30][k];
    Texture shown = {.image = {60, 30, IMAGE_RGBA8, pixels}};
    SymbolSplit split = split_halves(easel, &shown.image);
    const Vec3 far = vec3(0, 0, 500);
    for (int i = 0; i < 2; i++) {
        ENDS_BY(world_end) World world = flat_world(easel);
        world.scene->textures = &shown;
        world.scene->texture_count = 1;
        world.scene->displays[0].content.texture_id = 0;
        Material pane = builder_pane(1);
        memcpy(pane.base_color, panes[i], sizeof panes[i]);
        builder_part(world.scene, pane);
        builder_quad(world.scene, vec3(0, 0, 0.5f), vec3(2, 0, 0), vec3(0, 2, 0));
        SymbolSurface surface = first_part(&world, ALL);
        world_ready(&world, 1);
        SymbolVisibility through = symbol_visibility(&surface, &world.context, far, NULL);
        SymbolLook look = {&surface, &split, far, 2, &through},
                   bare = {&surface, &split, far, 2, NULL};
        SymbolEmission seen = symbol_emission(&look, 0.3), sent = symbol_emission(&bare, 0.3);
        assert_true(through.is_tinted == (i == 0));
        for (int c = 0; c < 2; c++) {
            assert_close(seen.xyz[c][1], 0.3 * behind_pane(easel, codes[c], panes[i]), 2e-3);
            if (i) assert_true(seen.xyz[c][1] == sent.xyz[c][1] * through.transmittance);
        }
        Curve lens; /* two that let through all together */
        for (int n = 0; n < CURVE_COUNT; n++) lens.value[n] = n < 200 ? 0.2f : 0.8f;
        SymbolEmission worn = seen;
        symbol_emission_behind(&look, &lens, &worn);
        for (int n = 0; n < CURVE_COUNT; n++) lens.value[n] = 1 - lens.value[n];
        SymbolEmission rest = seen;
        symbol_emission_behind(&look, &lens, &rest);
        for (int c = 0; c < 2; c++) {
            assert_close(worn.xyz[c][1] + rest.xyz[c][1], seen.xyz[c][1], 1e-5);
            assert_true(c ? worn.xyz[c][1] > rest.xyz[c][1] : worn.xyz[c][1] < rest.xyz[c][1]);
        }
    }
}

/* A mirrored node: u grows to the left, the front stays where the light is. */
EASEL_TEST(a_mirrored_display_is_seen_from_its_front) {
    const uint8_t rgb[3] = {200, 200, 200};
    const float codes[3] = {200, 200, 200};
    ENDS_BY(world_end) World world = world_start();
    wear_display(&world, easel);
    const float corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}; /* from (u, v) = (0, 0) */
    for (int i = 0; i < 4; i++)
        builder_vertex(world.scene, vec3(0.2f * corner[i][0], 0.1f * corner[i][1], 0),
                       vec3(0, 0, 1), i == 1 || i == 2, i > 1);
    builder_triangle(world.scene, 0, 1, 2);
    builder_triangle(world.scene, 0, 2, 3);
    SymbolSurface surface = first_part(&world, ALL);
    SymbolPoint point;
    assert_true(symbol_surface_at(&surface, (double[2]){0.1, 0.2}, &point));
    assert_near(point.position.x, 0.16, 1e-6);
    assert_near(point.position.y, 0.06, 1e-6);
    assert_near(point.ng.z, 1, 1e-6);
    Image content = plain(easel, rgb, false);
    SymbolSplit split = split_halves(easel, &content);
    float xyz[3]; /* in the display's own frame the eye stands at the other side */
    panel_emission_xyz(easel->panel, vec3(-0.6f, 0, 0.8f), codes, xyz);
    SymbolLook look = {&surface, &split, vec3(180, 0, 240), 2, NULL};
    SymbolEmission seen = symbol_emission(&look, 1);
    assert_close(seen.xyz[SYMBOL_FOREGROUND][1], xyz[1], 1e-3);
    world_ready(&world, 1);
    assert_true(symbol_visibility(&surface, &world.context, EYE, NULL).visible_share == 1);
}

TEST_PROGRAM(easel_open, easel_close)
