/* SPDX-License-Identifier: Apache-2.0 */
/* The halo of a review's case against the erf form; a scene with a zoned panel, loaded, against
 * the backlight that the panel's zones make of its content. */
#include "panel_fixture.h"
#include "wall_fixture.h"
#include "world_fixture.h"

#include <zlib.h>

#include "light/emission.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_zones.h"
#include "panel/zones/backlight_at.h"
#include "review/run/case_halo.h"
#include "scene/load/scene_load.h"
#include "vision/visibility.h"

/* 100 x 100 mm of zones of 1 mm, much smaller than their spread of 6 mm; black of 0.5 cd/m2 to
 * all sides when they are full: 1,000 cd/m2 over 2,000. */
#define ZONED                                                                                  \
    "{\"panel\": \"zoned\", \"size_mm\": [100, 100], \"emission\": {" FIXTURE_SPECTRA          \
    "\"cosine_power\": [1, 1], \"black_cd_m2\": 0.5, \"leak\": 0, \"levels\": [255]}, "        \
    "\"instrument\": {\"theta_max_deg\": 60, \"theta_step_deg\": 5, \"phi_step_deg\": 30}, "   \
    "\"local_dimming\": {\"zones\": [100, 100], \"spread\": {\"sigma_mm\": 6}}}"

#define SIDE_MM 100.0
#define SQUARE_MM 10.0
#define SIGMA_MM 6.0
#define HALF_MM 0.02 /* of a strip that is looked at, upwards: the halo moves by 0.4 % in it */
#define WIDE_MM 2.0  /* to each side: there the halo is less than in its middle */
#define EYE_M 0.8

static Fixture zoned;

static int start(void **state)
{
    FitOptions options = fit_options_default();
    options.level = 4;
    fixture_start(&zoned, ZONED, &options);
    *state = &zoned;
    return make_folder(state);
}

static int end(void **state)
{
    fixture_end(&zoned);
    return clear_folder(state);
}

/* ---- beside a square --------------------------------------------------------------------- */

static void square_codes(const void *user, const float place[2], float codes[3])
{
    float half = (float)(0.5 * SQUARE_MM / SIDE_MM);
    bool  inside = fabsf(place[0] - 0.5f) < half && fabsf(place[1] - 0.5f) < half;
    (void)user;
    for (int p = 0; p < 3; p++) codes[p] = inside ? 255 : 0;
}

static const Backlight *square_backlight(void)
{
    static const Backlight *made; /* once: in the fixture's arena */
    Arena *arena = &zoned.arena;
    if (made) return made;
    const DimmingZones *zones = panel_zones(zoned.panel);
    ShownPicture picture = {400, 400, square_codes, NULL};
    LevelShares  levels;
    double      *drive = ARENA_NEW(arena, double, zones->count[0] * zones->count[1]);
    panel_level_shares(zoned.panel, &levels);
    assert_near(backlight_drives(zones, &levels, &picture, drive), 0.01, 1e-12);
    return made = backlight_make(zones, &levels, drive, arena);
}

/* A corner of the strip, mm from the display's middle, which faces +z in the plane z = 0. */
static uint32_t corner(Scene *scene, double x_mm, double y_mm)
{
    return builder_vertex(scene, vec3((float)(1e-3 * x_mm), (float)(1e-3 * y_mm), 0),
                          vec3(0, 0, 1), (float)(0.5 + x_mm / SIDE_MM),
                          (float)(0.5 - y_mm / SIDE_MM));
}

/* A strip of the display alone is there, so that nothing else of it is looked at. */
static void strip_at(World *world, double mm)
{
    static uint8_t black[4];
    Scene   *scene = world->scene;
    world->panel = zoned.panel;
    Display *display = world_display(world);
    world->panel = NULL; /* the fixture's to close */
    scene->textures[0] = (Texture){{1, 1, IMAGE_RGBA8, black}, WRAP_CLAMP, WRAP_CLAMP, true};
    display->content.texture_id = 0;
    display->place_from_uv[0] = display->place_from_uv[2] = 1;
    display->backlight = square_backlight();
    uint32_t at[4] = {corner(scene, -WIDE_MM, mm - HALF_MM),
                      corner(scene, WIDE_MM, mm - HALF_MM),
                      corner(scene, WIDE_MM, mm + HALF_MM),
                      corner(scene, -WIDE_MM, mm + HALF_MM)};
    builder_triangle(scene, at[0], at[1], at[2]);
    builder_triangle(scene, at[0], at[2], at[3]);
}

/* The case of an observer who looks straight at the strip, before reflected light. */
static ReviewCase halo_at(double mm, double reflected_cd_m2, HumanEye observer)
{
    static const int part = 0;
    SCOPED_WORLD world = world_start();
    SetupSymbol  symbol = {.display = {0, &part, 1}};
    ReviewCase   c = {.level = 1, .luminance_cd_m2 = {.reflected = reflected_cd_m2}};
    strip_at(&world, mm);
    double v = 0.5 - mm / SIDE_MM, w = 0.9 * WIDE_MM / SIDE_MM, h = 0.9 * HALF_MM / SIDE_MM;
    const double uv[4] = {0.5 - w, v - h, 0.5 + w, v + h};
    memcpy(symbol.uv, uv, sizeof uv);
    SymbolPlace place = {world.scene, &symbol.display, {uv[0], uv[1], uv[2], uv[3]}, 1};
    assert_done(symbol_surface_build(&place, &world.arena, &symbol.surface, &err));
    HaloLook look = {&symbol, vec3(0, (float)(1e-3 * mm), (float)EYE_M), observer, 1};
    case_halo(&look, &c, world.arena);
    return c;
}

/* The square's share of a Gaussian `mm` above its middle. */
static double square_share(double mm)
{
    double s = SIGMA_MM * sqrt(2.0), h = SQUARE_MM / 2;
    return 0.5 * (erf((mm + h) / s) - erf((mm - h) / s)) * erf(h / s);
}

static const struct { double mm, cd_m2; } ROWS[] = {{6, 0.1192}, {10, 0.0584}, {20, 0.0018}};

TEST(halo_of_a_case_is_the_erf_form)
{
    const HumanEye eye = {25, 0.5};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        double     expected = 0.5 * square_share(ROWS[i].mm);
        ReviewCase c = halo_at(ROWS[i].mm, 0.5, eye);
        assert_true(c.has_halo);
        assert_close(c.halo.mean_drive, 0.01, 1e-9);
        assert_close(c.halo.full_cd_m2, 0.5, 0.005);
        assert_close(c.halo.halo_cd_m2, expected, 0.01);
        assert_near(expected, ROWS[i].cd_m2, 0.00005 + 0.001 * expected);
        assert_close(c.halo.black_cd_m2, c.halo.halo_cd_m2, 0.01); /* the least drive is 0 */
    }
}

/* Adrian's least difference for a patch of two spreads before what is reflected, and a verdict
 * that is the level's. */
TEST(halo_is_visible_from_its_threshold_on)
{
    static const double reflected[] = {0.02, 5, 2000}, ages[] = {25, 70};
    int visible = 0, tried = 0;
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++)
        for (size_t k = 0; k < sizeof reflected / sizeof *reflected; k++) {
            HumanEye   eye = {ages[(i + k) % 2], 0.5};
            ReviewCase c = halo_at(ROWS[i].mm, reflected[k], eye);
            VisibilityTarget target = {
                .size_arcmin = 60 * degrees_from_radians(2e-3 * SIGMA_MM / EYE_M),
                .adapted_cd_m2 = reflected[k] + c.halo.scattered_cd_m2,
                .age_years = eye.age_years, .glance_s = HUGE_VAL};
            double expected = 0.5 * square_share(ROWS[i].mm) / visibility_threshold(&target);
            assert_close(c.halo.threshold_cd_m2, visibility_threshold(&target), 0.01);
            assert_close(c.halo.level, expected, 0.02);
            assert_close(c.halo.level, c.halo.halo_cd_m2 / c.halo.threshold_cd_m2, 1e-12);
            assert_int_equal(c.halo.is_visible, c.halo.level >= 1);
            visible += c.halo.is_visible;
            tried++;
        }
    assert_in(visible, 2, tried - 2); /* both verdicts are among them */
    assert_true(halo_at(6, 0.02, (HumanEye){25, 0.5}).halo.is_visible);
}

/* ---- a scene that is loaded -------------------------------------------------------------- */

enum { WIDE = 240, HIGH = 80 };

static size_t add_chunk(unsigned char *to, const char *kind, const unsigned char *data,
                        size_t size)
{
    uint32_t crc = (uint32_t)crc32(0, (const unsigned char *)kind, 4);
    if (size) crc = (uint32_t)crc32(crc, data, (uInt)size);
    for (int i = 0; i < 4; i++) to[i] = (unsigned char)(size >> (24 - 8 * i));
    memcpy(to + 4, kind, 4);
    if (size) memcpy(to + 8, data, size);
    for (int i = 0; i < 4; i++) to[8 + size + (size_t)i] = (unsigned char)(crc >> (24 - 8 * i));
    return size + 12;
}

/* A PNG of 8 bits, grey: black with a white rectangle left of its middle. */
static void write_patch(const char *path)
{
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
static void texture_at(const void *user, const float place[2], float codes[3])
{
    texture_codes(user, place[0], place[1], codes);
}

static const Backlight *content_backlight(const Panel *panel, const Texture *texture,
                                          Arena *arena)
{
    const DimmingZones *zones = panel_zones(panel);
    ShownPicture picture = {texture->image.width, texture->image.height, texture_at,
                            texture};
    LevelShares  levels;
    double      *drive = ARENA_NEW(arena, double, zones->count[0] * zones->count[1]);
    panel_level_shares(panel, &levels);
    backlight_drives(zones, &levels, &picture, drive);
    return backlight_make(zones, &levels, drive, arena);
}

static bool is_black(const Texture *texture, const float place[2])
{
    float codes[3];
    texture_codes(texture, place[0], place[1], codes);
    return codes[0] + codes[1] + codes[2] == 0;
}

/* A place where the content is black, and the backlight is the most or least of such. */
static void black_place(const Texture *texture, const Backlight *light, int sign, float at[2])
{
    double best = -INFINITY;
    for (int i = 0; i < 120 * 40; i++) {
        const float place[2] = {((float)(i % 120) + 0.5f) / 120,
                                ((float)(i / 120) + 0.5f) / 40};
        double value = sign * (double)backlight_at(light, place);
        if (!is_black(texture, place) || value <= best) continue;
        best = value;
        for (int k = 0; k < 2; k++) at[k] = place[k];
    }
    assert_true(best > -INFINITY);
}

/* By paths from the wall's eye, cd/m2, and what the panel's black emits towards it. */
static double seen_black(const World *world, const float place[2], double *full)
{
    static const float BLACK[3] = {0, 0, 0};
    float     xyz[3];
    Vec3      eye = vec3(0.05f, 0.02f, 0.7f);
    Vec3      at = vec3(0.3f * (place[0] - 0.5f), 0.1f * (0.5f - place[1]), 0);
    WorldLook look = {eye, vec3_sub(at, eye), 1e-5f, 3, 16};
    panel_emission_xyz(world->scene->displays[0].panel, vec3_normalize(vec3_sub(eye, at)),
                       BLACK, xyz);
    *full = (double)xyz[1];
    return world_luminance(world, &look).mean;
}

TEST(a_loaded_scene_shows_the_halo_of_its_content)
{
    World        world = {.arena = arena_reserve((size_t)4 << 30)};
    Problems     problems = problems_start(&world.arena);
    const char  *path = in_folder("a.gltf");
    SceneOverride content = {.material = "cluster", .value = in_folder("c.png")};
    SceneOptions options = {.paths = &path, .path_count = 1, .contents = &content,
                            .content_count = 1};
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
        float  at[2];
        double full;
        black_place(texture, expected, k ? 1 : -1, at);
        found[k] = seen_black(&world, at, &full);
        assert_close(found[k], full * (double)backlight_at(expected, at), 0.005);
    }
    assert_true(found[1] > 5 * found[0]); /* beside light, and far from it */
    scene_close(world.scene);
    world_end(&world);
}

TEST_PROGRAM(start, end)
