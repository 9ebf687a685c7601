/* SPDX-License-Identifier: Apache-2.0 */
/* Assumed spectra of primaries: every standard's colours are reached, at the normal of the
 * fitted panel and behind filters. */
#include "panel_fixture.h"

#include "panel/set/primary_bands.h"
#include "panel/query/panel_emission.h"
#include "panel/shape/spectral_warp.h"
#include "text/text.h"

typedef struct Gamut {
    const char *name;
    double xy[3][2], y[3];
} Gamut;

/* IEC 61966-2-1, Adobe RGB (1998), SMPTE RP 431-2, ITU-R BT.2020, and LCDs as they are sold. */
static const Gamut gamuts[] = {
    {"sRGB", {{.64, .33}, {.30, .60}, {.15, .06}}, {.2126, .7152, .0722}},
    {"Adobe RGB", {{.64, .33}, {.21, .71}, {.15, .06}}, {.2974, .6273, .0753}},
    {"DCI-P3", {{.68, .32}, {.265, .69}, {.15, .06}}, {.2290, .6917, .0793}},
    {"BT.2020", {{.708, .292}, {.170, .797}, {.131, .046}}, {.2627, .6780, .0593}},
    {"LCD", {{.645, .335}, {.315, .620}, {.152, .055}}, {.22, .70, .08}},
    {"narrow LCD", {{.59, .35}, {.33, .56}, {.155, .13}}, {.25, .62, .13}},
    {"green LCD", {{.652, .331}, {.280, .640}, {.149, .045}}, {.23, .70, .07}},
};

static void xyz_of(const Gamut *g, double xyz[3][3]) {
    for (int p = 0; p < 3; p++) {
        double x = g->xy[p][0], y = g->xy[p][1];
        xyz[p][0] = 100 * g->y[p] * x / y;
        xyz[p][1] = 100 * g->y[p];
        xyz[p][2] = fmax(0, 100 * g->y[p] * (1 - x - y) / y);
    }
}

static double duv(const double a[3], const double b[3]) {
    double da = a[0] + 15 * a[1] + 3 * a[2], db = b[0] + 15 * b[1] + 3 * b[2];
    return hypot(4 * a[0] / da - 4 * b[0] / db, 9 * a[1] / da - 9 * b[1] / db);
}

TEST(every_gamut_is_reached_by_bands) {
    static const double free_peaks[3];
    for (size_t g = 0; g < sizeof gamuts / sizeof *gamuts; g++) {
        static PrimaryBands bands;
        double xyz[3][3], found[3];
        xyz_of(&gamuts[g], xyz);
        if (!primary_bands_find(0, free_peaks, (const double(*)[3])xyz, &bands))
            fail_msg("%s: missed by %g", gamuts[g].name, bands.miss);
        for (int p = 0; p < 3; p++) {
            panel_spectrum_xyz(bands.spectrum[p], found);
            /* BT.2020's rounded blue lies 3.4e-4 beyond the locus at 467 nm */
            assert_true(duv(found, xyz[p]) < (g == 3 && p == 2 ? 5e-4 : 1e-4));
            assert_close(found[1], xyz[p][1], 1e-3);
            for (int i = 0; i < SPECTRAL_COUNT; i++) assert_true(bands.spectrum[p][i] >= 0);
        }
    }
}

/* ---- a panel ----------------------------------------------------------------------------- */

/* Tables of one gamut, of 0 to 60 degrees, and their manifest. */
static const char *write_set(Fixture *f, const Gamut *g, const char *more) {
    static const char *const names[3] = {"red", "green", "blue"};
    double xyz[3][3];
    xyz_of(g, xyz);
    for (int p = -1; p < 3; p++) {
        Text text = {.arena = &f->arena};
        text_add(&text, "theta,phi,X,Y,Z\n");
        for (int t = 0; t <= 60; t += 10)
            for (int phi = 0; phi < 360; phi += 45) {
                double c = pow(cos(radians_from_degrees(t)), 0.5);
                double x = p < 0 ? 0 : xyz[p][0], y = p < 0 ? 0 : xyz[p][1];
                text_format(&text, "%d,%d,%.7g,%.7g,%.7g\n", t, phi, c * (x + 0.02), c * (y + 0.02),
                            c * ((p < 0 ? 0 : xyz[p][2]) + 0.02));
            }
        fixture_file(f, arena_format(&f->arena, "%s.csv", p < 0 ? "black" : names[p]), text.data);
    }
    return fixture_file(
        f, "set.json",
        arena_format(&f->arena,
                     "{\"emission\": {\"black\": "
                     "\"black.csv\", \"red\": {\"255\": \"red.csv\"}, \"green\": {\"255\": "
                     "\"green.csv\"}, \"blue\": {\"255\": \"blue.csv\"}}%s}",
                     more));
}

/* XYZ of a direction's light behind a filter, from the spectral radiance that a panel gives. */
static void seen_through(const Panel *panel, const float rgb[3], bool is_tinted, double xyz[3]) {
    float spectrum[SPECTRAL_COUNT];
    for (int i = 0; i < SPECTRAL_COUNT; i += SPECTRUM_LANES) {
        Wavelengths at = {0};
        for (int k = 0; k < SPECTRUM_LANES; k++)
            at.nm[k] = (float)(SPECTRAL_FIRST_NM + (i + k < SPECTRAL_COUNT ? i + k : 470));
        Spectrum light = panel_emission_spectrum(panel, vec3(0, 0, 1), rgb, &at);
        for (int k = 0; k < SPECTRUM_LANES && i + k < SPECTRAL_COUNT; k++)
            spectrum[i + k] = light[k] * (is_tinted ? (at.nm[k] - 300) / 600 : 1);
    }
    panel_spectrum_xyz(spectrum, xyz);
}

/* Each primary and white at the normal of the fitted panel, and behind a tinted pane: what the
 * assumed spectra say in closed form. */
TEST(a_panel_without_spectra_has_its_colours_and_says_what_was_assumed) {
    static const float shown[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};
    static const char *const more[] = {"", ", \"backlight\": \"qd\"",
                                       ", \"peaks_nm\": [627, 536, 460]"};
    static const double none[3];
    for (size_t g = 0; g < sizeof gamuts / sizeof *gamuts; g++) {
        static PrimaryBands bands;
        ENDS_BY(fixture_end) Fixture f;
        double xyz[3][3], found[3], tinted[3];
        fixture_folder(&f);
        fixture_read(&f, write_set(&f, &gamuts[g], more[g == 0 ? 2 : g % 2]));
        fixture_fit(&f, NULL);
        xyz_of(&gamuts[g], xyz);
        primary_bands_find(f.set->backlight, g ? none : f.set->peaks_nm, (const double(*)[3])xyz,
                           &bands);
        for (int s = 0; s < 4; s++) {
            double wanted[3] = {0.02, 0.02, 0.02}, pane[3] = {0, 0, 0};
            for (int p = 0; p < 3; p++) {
                float through[SPECTRAL_COUNT];
                if (!(shown[s][p] > 0)) continue;
                for (int i = 0; i < SPECTRAL_COUNT; i++)
                    through[i] = bands.spectrum[p][i] * (float)(SPECTRAL_FIRST_NM + i - 300) / 600;
                panel_spectrum_xyz(through, found);
                for (int j = 0; j < 3; j++) {
                    wanted[j] += xyz[p][j];
                    pane[j] += found[j];
                }
            }
            seen_through(f.panel, shown[s], false, found);
            seen_through(f.panel, shown[s], true, tinted);
            assert_true(duv(found, wanted) < (g == 3 && s == 2 ? 1e-3 : 3e-4));
            assert_true(duv(tinted, pane) < 1e-3);
            assert_close(tinted[1], pane[1], 0.01);
        }
        char *report = json_dumps(f.report, 0);
        assert_text_has(report, g == 0 || g % 2 ? g % 2 ? "of a backlight 'qd' at"
                                                        : "(not stated) at 627, 536 and 460 nm"
                                                : "'wled-ysf' (not stated) at");
        free(report);
    }
}

TEST(stated_bands_are_held_against_the_colours) {
    static const struct {
        const char *more, *words;
    } bad[] = {
        {", \"backlight\": \"tube\"", "is 'tube', required: another word: there are "
                                      "wled-ysf, wled-ksf"},
        {", \"peaks_nm\": [620, 530]", "has 2 values, required: 3"},
        {", \"peaks_nm\": [450, 530, 620]", "three wavelengths that fall"},
    };
    ENDS_BY(fixture_end) Fixture f;
    fixture_folder(&f);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_fails_as(
            measurement_read(write_set(&f, &gamuts[0], bad[i].more), &f.arena, f.set, &err),
            ERROR_INPUT, bad[i].words);
    fixture_read(&f, write_set(&f, &gamuts[3], ", \"peaks_nm\": [620, 540, 460]"));
    fixture_fit(&f, NULL);
    char *report = json_dumps(f.report, 0);
    assert_text_has(report, "(stated: 620, 540, 460 nm, from where the colours are out of "
                            "reach)");
    free(report);
}

TEST_PROGRAM(make_folder, clear_folder)
