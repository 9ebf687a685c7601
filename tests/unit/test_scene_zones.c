/* SPDX-License-Identifier: Apache-2.0 */
/* A scene with a zoned panel, loaded, against the backlight that the panel's zones make of its
 * content. */
#include "wall_fixture.h"
#include "world_fixture.h"

#include <zlib.h>

#include "light/emission.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_zones.h"
#include "panel/zones/backlight_at.h"
#include "scene/load/scene_load.h"

enum { WIDE = 240, HIGH = 80 };

static size_t add_chunk(unsigned char *to, const char *kind, const unsigned char *data,
                        size_t size) {
    uint32_t crc = (uint32_t)crc32(0, (const unsigned char *)kind, 4);
    if (size) crc = (uint32_t)crc32(crc, data, (uInt)size);
    for (int i = 0; i < 4; i++) to[i] = (unsigned char)(size >> (24 - 8 * i));
    memcpy(to + 4, kind, 4);
    if (size) memcpy(to + 8, data, size);
    for (int i = 0; i < 4; i++) to[8 + size + (size_t)i] = (unsigned char)(crc >> (24 - 8 * i));
    return size + 12;
}

/* A PNG of 8 bits, grey: black with a white rectangle left of its middle. */
static void write_patch(const char *path) {
    static const unsigned char head[13] = {0, 0, 0, WIDE, 0, 0, 0, HIGH, 8, 0, 0, 0, 0};
    static unsigned char rows[HIGH * (WIDE + 1)], packed[HIGH * (WIDE + 1) + 1000], png[30000];
    uLongf size = sizeof packed;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            rows[y * (WIDE + 1) + 1 + x] = x >= 70 && x < 90 && y >= 30 && y < 50 ? 255 : 0;
    assert_int_equal(compress(packed, &size, rows, sizeof rows), Z_OK);
    memcpy(png, "\x89PNG\r\n\x1a\n", 8);
    size_t at = 8 + add_chunk(png + 8, "IHDR", head, sizeof head);
    at += add_chunk(png + at, "IDAT", packed, size);
    at += add_chunk(png + at, "IEND", NULL, 0);
    write_bytes(path, png, at);
}

/* What a display's content shows at a place of the wall's quad, whose uv are its places. */
static void texture_at(const void *user, const float place[2], float codes[3]) {
    texture_codes(user, place[0], place[1], codes);
}

static const Backlight *content_backlight(const Panel *panel, const Texture *texture,
                                          Arena *arena) {
    const DimmingZones *zones = panel_zones(panel);
    ShownPicture picture = {texture->image.width, texture->image.height, texture_at, texture};
    LevelShares levels;
    double *drive = ARENA_NEW(arena, double, zones->count[0] * zones->count[1]);
    panel_level_shares(panel, &levels);
    backlight_drives(zones, &levels, &picture, drive);
    return backlight_make(zones, &levels, drive, arena);
}

static bool is_black(const Texture *texture, const float place[2]) {
    float codes[3];
    texture_codes(texture, place[0], place[1], codes);
    return codes[0] + codes[1] + codes[2] == 0;
}

/* A place where the content is black, and the backlight is the most or least of such. */
static void black_place(const Texture *texture, const Backlight *light, int sign, float at[2]) {
    double best = -INFINITY;
    for (int i = 0; i < 120 * 40; i++) {
        const float place[2] = {((float)(i % 120) + 0.5f) / 120, ((float)(i / 120) + 0.5f) / 40};
        double value = sign * (double)backlight_at(light, place);
        if (!is_black(texture, place) || value <= best) continue;
        best = value;
        for (int k = 0; k < 2; k++) at[k] = place[k];
    }
    assert_true(best > -INFINITY);
}

/* By paths from the wall's eye, cd/m2, and what the panel's black emits towards it. */
static double seen_black(const World *world, const float place[2], double *full) {
    static const float BLACK[3] = {0, 0, 0};
    float xyz[3];
    Vec3 eye = vec3(0.05f, 0.02f, 0.7f);
    Vec3 at = vec3(0.3f * (place[0] - 0.5f), 0.1f * (0.5f - place[1]), 0);
    WorldLook look = {eye, vec3_sub(at, eye), 1e-5f, 3, 16};
    panel_emission_xyz(world->scene->displays[0].panel, vec3_normalize(vec3_sub(eye, at)), BLACK,
                       xyz);
    *full = (double)xyz[1];
    return world_luminance(world, &look).mean;
}

TEST(a_loaded_scene_shows_the_halo_of_its_content) {
    World world = {.arena = arena_reserve((size_t)4 << 30)};
    Problems problems = problems_start(&world.arena);
    const char *path = in_folder("a.gltf");
    SceneOverride content = {.material = "cluster", .value = in_folder("c.png")};
    SceneOptions options = {
        .paths = &path, .path_count = 1, .contents = &content, .content_count = 1};
    wall_write_files("{}", world.arena);
    wall_copy(PROJECT_DIR "/assets/panels/zoned_centre.panel", "p.panel", world.arena);
    write_patch(in_folder("c.png"));
    assert_done(scene_load(&options, &world.arena, &problems, &world.scene, &err));
    const Display *display = &world.scene->displays[0];
    const Texture *texture = &world.scene->textures[display->content.texture_id];
    assert_non_null(display->backlight);
    const Backlight *expected = content_backlight(display->panel, texture, &world.arena);
    assert_close(display->backlight->mean_drive, expected->mean_drive, 1e-9);
    world_ready(&world, 2);
    double found[2];
    for (int k = 0; k < 2; k++) {
        float at[2];
        double full;
        black_place(texture, expected, k ? 1 : -1, at);
        found[k] = seen_black(&world, at, &full);
        assert_close(found[k], full * (double)backlight_at(expected, at), 0.005);
    }
    assert_true(found[1] > 5 * found[0]); /* beside light, and far from it */
    scene_close(world.scene);
    world_end(&world);
}

TEST_PROGRAM(make_folder, clear_folder)
