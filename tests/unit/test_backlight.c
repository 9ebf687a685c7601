/* SPDX-License-Identifier: Apache-2.0 */
/* Local dimming: what a backlight of zones shines where, held to closed forms. */
#include "check.h"

#include "base/arena.h"
#include "panel/zones/backlight_at.h"

static Arena arena;
static LevelShares levels; /* gamma 2.2 of all primaries */

static int begin(void **state) {
    (void)state;
    arena = arena_reserve((size_t)1 << 30);
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < 256; i++) levels.share[p][i] = powf((float)i / 255, 2.2f);
    return 0;
}

static int end(void **state) {
    (void)state;
    arena_release(&arena);
    return 0;
}

/* ---- pictures ---------------------------------------------------------------------------- */

/* One code in a rectangle of places, another around it. */
typedef struct Patch {
    float low[2], high[2], code, beside;
} Patch;

static void patch_codes(const void *user, const float place[2], float codes[3]) {
    const Patch *p = user;
    bool inside = place[0] >= p->low[0] && place[0] < p->high[0] && place[1] >= p->low[1] &&
                  place[1] < p->high[1];
    for (int i = 0; i < 3; i++) codes[i] = inside ? p->code : p->beside;
}

static ShownPicture picture_of(const Patch *patch, int columns, int rows) {
    return (ShownPicture){columns, rows, patch_codes, patch};
}

static const Patch WHITE = {{0, 0}, {1, 1}, 255, 255}, BLACK = {{0, 0}, {1, 1}, 0, 0};

static DimmingZones zones_of(int columns, int rows, double sigma_mm) {
    return (DimmingZones){
        .count = {columns, rows}, .size_mm = {100, 100}, .sigma_mm = sigma_mm, .compensates = true};
}

/* drives: of each zone, row by row. */
static const Backlight *made_with(const DimmingZones *zones, const Patch *patch,
                                  const double **drives) {
    double *drive = ARENA_NEW(&arena, double, zones->count[0] * zones->count[1]);
    ShownPicture picture = picture_of(patch, 400, 400);
    double mean = backlight_drives(zones, &levels, &picture, drive);
    const Backlight *out = backlight_make(zones, &levels, drive, &arena);
    assert_near(out->mean_drive, mean, 1e-12);
    *drives = drive;
    return out;
}

static const Backlight *made(const DimmingZones *zones, const Patch *patch) {
    const double *drives;
    return made_with(zones, patch, &drives);
}

static double at(const Backlight *backlight, double u, double v) {
    return (double)backlight_at(backlight, (const float[2]){(float)u, (float)v});
}

/* ---- the halo of a square ---------------------------------------------------------------- */

/* A square's share of a Gaussian about a place, both in mm from its middle. */
static double square_share(double x, double y, double side, double sigma) {
    double s = sigma * sqrt(2.0), h = side / 2;
    return 0.25 * (erf((x + h) / s) - erf((x - h) / s)) * (erf((y + h) / s) - erf((y - h) / s));
}

/* A white square of 10 mm on black, zones much smaller than the spread. Black beside it shines
 * 1000 cd/m2 / 2000 times the backlight there. */
TEST(halo_of_a_square_is_the_erf_form) {
    static const struct {
        double sigma, mm, cd_m2;
    } rows[] = {{6, 6, 0.1192},   {6, 10, 0.0584},  {6, 20, 0.0018}, {12, 6, 0.0464},
                {12, 10, 0.0376}, {12, 20, 0.0141}, {12, 30, 0.0027}};
    const Patch square = {{0.45f, 0.45f}, {0.55f, 0.55f}, 255, 0};
    const Backlight *light = NULL;
    DimmingZones zones;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double mm = rows[i].mm, sigma = rows[i].sigma;
        if (!light || zones.sigma_mm != sigma) {
            zones = zones_of(200, 200, sigma);
            light = made(&zones, &square);
        }
        double halo = 1000.0 / 2000 * at(light, 0.5 + mm / 100, 0.5);
        assert_close(halo, 0.5 * square_share(mm, 0, 10, sigma), 0.01);
        assert_near(halo, rows[i].cd_m2, 0.00005 + 0.01 * rows[i].cd_m2);
        assert_close(0.5 * at(light, 0.5 - mm / 150, 0.5 + mm / 150),
                     0.5 * square_share(mm / 1.5, mm / 1.5, 10, sigma), 0.01);
    }
    assert_near(light->mean_drive, 0.01, 1e-9); /* its area's share */
}

/* The same spread as a table of its values. */
TEST(table_of_a_gaussian_is_that_gaussian) {
    const Patch square = {{0.4f, 0.4f}, {0.6f, 0.6f}, 255, 0};
    DimmingZones gauss = zones_of(25, 25, 6), table = zones_of(25, 25, 0);
    table.spread.rows = table.spread.values = 61;
    for (int i = 0; i < 61; i++) {
        table.spread.at[i] = 0.5 * i;
        table.spread.value[i] = 3 * exp(-0.5 * (0.5 * i / 6) * (0.5 * i / 6));
    }
    const Backlight *a = made(&gauss, &square), *b = made(&table, &square);
    for (int mm = 0; mm < 25; mm += 3)
        assert_close(at(b, 0.5 + 0.01 * mm, 0.47), at(a, 0.5 + 0.01 * mm, 0.47), 0.01);
}

/* ---- the map and the sum ----------------------------------------------------------------- */

static const DimmingZones *shapes(int i) {
    static DimmingZones all[5];
    all[0] = zones_of(10, 6, 8);
    all[1] = zones_of(16, 9, 3);
    all[2] = zones_of(3, 5, 400);
    all[3] = zones_of(12, 12, 0);
    all[3].spread = (ZoneTable){4, 4, {0, 5, 12, 30}, {1, 0.7, 0.1, 0}};
    all[4] = zones_of(1, 1, 20);
    return i < 5 ? &all[i] : NULL;
}

static long folded(long i, long count) {
    long at = ((i % (2 * count)) + 2 * count) % (2 * count);
    return at < count ? at : 2 * count - 1 - at;
}

/* The sum as it stands in backlight.h: over all zones, their images in the walls too. */
static double backlight_sum(const DimmingZones *zones, const double *drive, const double place[2]) {
    double light = 0, full = 0, pitch[2];
    long far[2];
    for (int k = 0; k < 2; k++) {
        double most = zones->sigma_mm > 0 ? 6 * fmin(zones->sigma_mm, 200) : 30;
        pitch[k] = zones->size_mm[k] / zones->count[k];
        far[k] = (long)(most / pitch[k]) + 2;
    }
    for (long y = -far[1]; y < zones->count[1] + far[1]; y++)
        for (long x = -far[0]; x < zones->count[0] + far[0]; x++) {
            double dx = ((double)x + 0.5) * pitch[0] - place[0] * zones->size_mm[0];
            double dy = ((double)y + 0.5) * pitch[1] - place[1] * zones->size_mm[1];
            double one = dimming_zones_spread(zones, sqrt(dx * dx + dy * dy));
            light +=
                one *
                drive[folded(y, zones->count[1]) * zones->count[0] + folded(x, zones->count[0])];
            full += one;
        }
    return light / full;
}

TEST(map_is_the_sum_within_a_percent) {
    const Patch lit = {{0.1f, 0.3f}, {0.36f, 0.62f}, 200, 0};
    for (int i = 0; shapes(i); i++) {
        const double *drives;
        const Backlight *light = made_with(shapes(i), &lit, &drives);
        for (int k = 0; k < 200; k++) {
            double place[2] = {fmod(0.618034 * k, 1), fmod(0.7548777 * k, 1)};
            float seen[2] = {(float)place[0], (float)place[1]};
            double sum = backlight_sum(shapes(i), drives, place);
            assert_near(backlight_at(light, seen), sum, 0.01 * sum + 1e-4);
        }
    }
}

/* Walls give back what would leave over an edge: the mean of the backlight is the mean drive.
 */
TEST(light_of_the_zones_is_kept) {
    const Patch corner = {{0, 0}, {0.2f, 0.34f}, 230, 15};
    for (int i = 0; shapes(i); i++) {
        const Backlight *light = made(shapes(i), &corner);
        double sum = 0, n = light->width * light->height;
        for (int k = 0; k < light->width * light->height; k++)
            sum += light->is_log ? exp((double)light->light[k]) : (double)light->light[k];
        assert_close(sum / n, light->mean_drive, i == 1 ? 0.02 : 0.003);
    }
}

TEST(mirrored_pictures_have_mirrored_backlights) {
    const Patch left = {{0, 0.2f}, {0.3f, 0.5f}, 255, 0}, right = {{0.7f, 0.5f}, {1, 0.8f}, 255, 0};
    for (int i = 0; shapes(i); i++) {
        const Backlight *a = made(shapes(i), &left), *b = made(shapes(i), &right);
        for (int k = 0; k < 40; k++) {
            double u = fmod(0.618034 * k, 1), v = fmod(0.7548777 * k, 1);
            assert_near(at(a, u, v), at(b, 1 - u, 1 - v), 1e-5 + 1e-4 * at(a, u, v));
        }
    }
}

TEST(one_zone_is_global_dimming) {
    DimmingZones zones = zones_of(1, 1, 20);
    const Patch dim = {{0.9f, 0.9f}, {0.95f, 0.95f}, 100, 7};
    const Backlight *light = made(&zones, &dim);
    assert_near(light->mean_drive, pow(100.0 / 255, 2.2), 1e-6);
    for (int k = 0; k < 20; k++)
        assert_near(at(light, 0.05 * k, 1 - 0.03 * k), light->mean_drive, 1e-6);
}

/* ---- drives ------------------------------------------------------------------------------ */

TEST(white_is_full_and_black_the_least) {
    for (int i = 0; shapes(i); i++)
        for (int rule = 0; rule < 4; rule++) {
            DimmingZones zones = *shapes(i);
            zones.rule = rule & 1 ? ZONES_MEAN : ZONES_MAXIMUM;
            zones.least = 0.03;
            if (rule & 2) zones.drive = (ZoneTable){3, 3, {0, 64, 255}, {0.05, 0.5, 1}};
            const Backlight *white = made(&zones, &WHITE);
            assert_near(white->mean_drive, 1, 1e-9);
            assert_true(at(white, 0.3, 0.9) == 1 && at(white, 0, 0) == 1);
            const Backlight *black = made(&zones, &BLACK);
            assert_near(black->mean_drive, rule & 2 ? 0.05 : 0.03, 1e-9);
            assert_near(at(black, 0.3, 0.9), black->mean_drive, 1e-6);
        }
}

/* A quarter of one zone is lit. */
TEST(rules_differ_where_a_zone_is_lit_in_part) {
    const Patch part = {{0, 0}, {0.25f, 0.25f}, 128, 0};
    ShownPicture picture = picture_of(&part, 40, 40);
    DimmingZones zones = zones_of(2, 2, 60);
    double drive[4], share = pow(128.0 / 255, 2.2);
    assert_near(backlight_drives(&zones, &levels, &picture, drive), share / 4, 1e-6);
    assert_near(drive[0], share, 1e-6);
    assert_near(drive[1] + drive[2] + drive[3], 0, 1e-12);
    zones.rule = ZONES_MEAN;
    backlight_drives(&zones, &levels, &picture, drive);
    assert_near(drive[0], share / 4, 1e-6);
    zones.drive = (ZoneTable){2, 2, {0, 64}, {0.2, 0.6}};
    backlight_drives(&zones, &levels, &picture, drive);
    assert_near(drive[0], 0.4, 1e-6); /* mean code 32 */
    assert_near(drive[3], 0.2, 1e-12);
    zones.rule = ZONES_MAXIMUM;
    backlight_drives(&zones, &levels, &picture, drive);
    assert_near(drive[0], 0.6, 1e-12); /* held above the table */
}

/* More zones than pixels, and pixels that zones do not divide evenly. */
TEST(every_zone_has_pixels) {
    const Patch half = {{0, 0}, {0.5f, 1}, 255, 0};
    ShownPicture picture = picture_of(&half, 7, 1);
    DimmingZones zones = zones_of(32, 18, 60);
    double *drive = ARENA_NEW(&arena, double, 32 * 18);
    for (int rule = 0; rule < 2; rule++) {
        zones.rule = rule ? ZONES_MEAN : ZONES_MAXIMUM;
        assert_near(backlight_drives(&zones, &levels, &picture, drive), 0.5, 1e-9);
        picture.columns = 75, picture.rows = 41; /* a pixel's middle decides */
        assert_near(backlight_drives(&zones, &levels, &picture, drive), 0.5, 0.02);
        picture.columns = 7, picture.rows = 1;
    }
}

/* ---- compensation ------------------------------------------------------------------------ */

TEST(lit_pixels_keep_their_light_while_the_backlight_lets_them) {
    DimmingZones zones = zones_of(4, 4, 30);
    const Backlight *light = made(&zones, &WHITE);
    for (int code = 0; code <= 255; code += 5)
        for (int k = 1; k <= 20; k++) {
            float b = 0.05f * (float)k, shown[3] = {(float)code, 17.5f, 255}, codes[3];
            double share = level_share_at(&levels, 0, code);
            backlight_codes(light, b, shown, codes);
            double seen = (double)b * level_share_at(&levels, 0, (double)codes[0]);
            if (code) assert_close(seen, fmin(share, (double)b), 1e-4);
            if (!code) assert_true(codes[0] == 0); /* black leaks, nothing opens it */
            assert_true(codes[2] == 255 && codes[1] >= 17.5f);
        }
    float codes[3];
    backlight_codes(light, 1, (const float[3]){3, 128, 254.5f}, codes);
    assert_true(codes[0] == 3 && codes[1] == 128 && codes[2] == 254.5f);
    zones.compensates = false;
    light = made(&zones, &WHITE);
    backlight_codes(light, 0.1f, (const float[3]){3, 128, 254.5f}, codes);
    assert_true(codes[0] == 3 && codes[1] == 128 && codes[2] == 254.5f);
}

/* ---- what cannot be ---------------------------------------------------------------------- */

TEST(faults_name_their_key) {
    const char *key;
    DimmingZones zones = zones_of(10, 10, 6), bad = zones;
    assert_null(dimming_zones_fault(&zones, &key));
    bad.count[0] = 513;
    assert_non_null(dimming_zones_fault(&bad, &key));
    assert_string_equal(key, "zones");
    bad = zones, bad.count[0] = bad.count[1] = 300;
    assert_non_null(dimming_zones_fault(&bad, &key));
    bad = zones, bad.sigma_mm = 1; /* a tenth of a zone */
    assert_non_null(dimming_zones_fault(&bad, &key));
    assert_string_equal(key, "spread");
    bad = zones, bad.sigma_mm = 0, bad.spread = (ZoneTable){2, 2, {0, 6}, {1, 0}};
    assert_non_null(dimming_zones_fault(&bad, &key)); /* dark in its corners */
    bad.spread.at[1] = 12;
    assert_null(dimming_zones_fault(&bad, &key));
    bad.spread.at[1] = 900;
    assert_non_null(dimming_zones_fault(&bad, &key));
    bad = zones, bad.drive = (ZoneTable){2, 2, {64, 64}, {0, 1}};
    assert_non_null(dimming_zones_fault(&bad, &key));
    assert_string_equal(key, "drive");
    bad = zones, bad.least = -0.1;
    assert_non_null(dimming_zones_fault(&bad, &key));
}

TEST_PROGRAM(begin, end)
