/* SPDX-License-Identifier: Apache-2.0 */
/* Panels read at a coarser level: the finest is the panel itself to the bit, the stated errors
 * hold at random directions, and they fall from level to level. The panels that ship. */
#include "fixture.h"

#include "base/sampler.h"
#include "panel/set/panel_coarse.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection.h"

#define ASKED 100000

static const char *const NAMES[] = {"ips_cluster", "oled_centre"};

static Panel *opened(const char *name)
{
    char   path[1024];
    Panel *panel = NULL;
    snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, name);
    assert_done(panel_open(path, test_memory(), &panel, &err));
    return panel;
}

/* A question: directions, codes from 1 on, 16 wavelengths. */
typedef struct Question {
    Vec3        wo, wi; /* wi: within the measured incidences */
    float       rgb[3];
    Wavelengths wavelengths;
} Question;

static Vec3 direction(float cosine, float turn)
{
    float sine = sqrtf(1 - cosine * cosine), phi = 6.2831853f * turn;
    return vec3(sine * cosf(phi), sine * sinf(phi), cosine);
}

static Question question(uint32_t *seed, float least_cosine)
{
    float    u[7];
    Question q;
    q.wavelengths = (Wavelengths){0};
    for (int i = 0; i < 7; i++) u[i] = unit_float(hash_u32((*seed)++));
    q.wo = direction(0.01f + 0.99f * u[0], u[1]);
    q.wi = direction(least_cosine + (1 - least_cosine) * u[2], u[3]);
    for (int i = 0; i < 3; i++) q.rgb[i] = 1 + 254 * u[4 + i];
    for (int i = 0; i < SPECTRUM_LANES; i++) q.wavelengths.nm[i] = 385 + 25 * ((float)i + u[6]);
    return q;
}

static float last_cosine(const Panel *panel)
{
    double theta[PANEL_INFO_INCIDENCES_MAX];
    int    count = panel_info_incidences(panel, theta);
    return (float)cos(theta[count - 1]) + 1e-4f;
}

/* The largest relative differences found between two panels. */
static void compare(const Panel *a, const Panel *b, int asked, double found[2])
{
    uint32_t seed = 5;
    float    least = last_cosine(b);
    found[0] = found[1] = 0;
    for (int i = 0; i < asked; i++) {
        Question q = question(&seed, least);
        float    x[3], y[3];
        panel_emission_xyz(a, q.wo, q.rgb, x);
        panel_emission_xyz(b, q.wo, q.rgb, y);
        Spectrum f = panel_brdf(a, q.wo, q.wi, &q.wavelengths);
        Spectrum g = panel_brdf(b, q.wo, q.wi, &q.wavelengths);
        for (int j = 0; j < 3; j++)
            found[0] = fmax(found[0], fabs((double)(x[j] / y[j]) - 1));
        for (int j = 0; j < SPECTRUM_LANES; j++)
            found[1] = fmax(found[1], fabs((double)(f[j] / g[j]) - 1));
    }
}

TEST(the_finest_level_is_the_panel_to_the_bit)
{
    for (int p = 0; p < 2; p++) {
        Panel      *whole = opened(NAMES[p]), *same = opened(NAMES[p]);
        PanelCoarse coarse;
        int         least, most;
        double      found[2];
        panel_coarse_range(same, &least, &most);
        assert_true(least < most);
        panel_coarsen(same, most, *test_memory(), &coarse);
        assert_true(coarse.has_emission && coarse.has_reflection);
        assert_true(coarse.emission_max == 0 && coarse.emission_rms == 0);
        assert_true(coarse.reflection_max == 0 && coarse.reflection_rms == 0);
        compare(same, whole, ASKED / 10, found);
        assert_true(found[0] == 0 && found[1] == 0);
        panel_close(whole);
        panel_close(same);
    }
}

/* 1e-5: what rounding of a sum of logarithms adds. */
TEST(stated_errors_hold_and_fall_with_the_level)
{
    for (int p = 0; p < 2; p++) {
        Panel      *whole = opened(NAMES[p]);
        PanelCoarse last = {.reflection_max = 1e30, .reflection_rms = 1e30};
        int         least, most;
        panel_coarse_range(whole, &least, &most);
        for (int level = least; level < most; level++) {
            Panel      *panel = opened(NAMES[p]);
            PanelCoarse coarse;
            double      found[2];
            panel_coarsen(panel, level, *test_memory(), &coarse);
            bool is_all = level == (least + most) / 2;
            compare(panel, whole, is_all ? ASKED : ASKED / 20, found);
            assert_true(found[0] <= coarse.emission_max + 1e-5);
            assert_true(found[1] <= coarse.reflection_max + 1e-5);
            if (is_all) assert_true(found[1] > 0.1 * coarse.reflection_max);
            assert_true(coarse.reflection_rms < coarse.reflection_max);
            assert_true(coarse.reflection_rms <= last.reflection_rms);
            last = coarse;
            panel_close(panel);
        }
        panel_close(whole);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
