/* SPDX-License-Identifier: Apache-2.0 */
/* Panels read at a coarser level: the finest is the panel itself to the bit, a level is the
 * panel at its vertices, the stated errors hold at random directions, and their rms falls from
 * level to level. The panels that ship. */
#include "fixture.h"

#include "base/sampler.h"
#include "hemisphere/tree/vertex.h"
#include "panel/set/panel_coarse.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"

#define ASKED 100000

static const char *const NAMES[] = {"ips_cluster", "oled_centre"};

static Panel *opened(const char *name) {
    char path[1024];
    Panel *panel = NULL;
    snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, name);
    assert_done(panel_open(path, test_memory(), &panel, &err));
    return panel;
}

/* A question: directions, codes from 1 on, 16 wavelengths. */
typedef struct Question {
    Vec3 wo, wi; /* wi: within the measured incidences */
    float rgb[3];
    Wavelengths wavelengths;
} Question;

static Vec3 direction(float cosine, float turn) {
    float sine = sqrtf(1 - cosine * cosine), phi = 6.2831853f * turn;
    return vec3(sine * cosf(phi), sine * sinf(phi), cosine);
}

static Question question(uint32_t *seed, float least_cosine) {
    float u[7];
    Question q;
    q.wavelengths = (Wavelengths){0};
    for (int i = 0; i < 7; i++) u[i] = unit_float(hash_u32((*seed)++));
    q.wo = direction(0.01f + 0.99f * u[0], u[1]);
    q.wi = direction(least_cosine + (1 - least_cosine) * u[2], u[3]);
    for (int i = 0; i < 3; i++) q.rgb[i] = 1 + 254 * u[4 + i];
    for (int i = 0; i < SPECTRUM_LANES; i++) q.wavelengths.nm[i] = 385 + 25 * ((float)i + u[6]);
    return q;
}

static float last_cosine(const Panel *panel) {
    double theta[PANEL_INFO_INCIDENCES_MAX];
    int count = panel_info_incidences(panel, theta);
    return (float)cos(theta[count - 1]) + 1e-4f;
}

/* The largest relative differences found between two panels. */
static void compare(const Panel *a, const Panel *b, int asked, double found[2]) {
    uint32_t seed = 5;
    float least = last_cosine(b);
    found[0] = found[1] = 0;
    for (int i = 0; i < asked; i++) {
        Question q = question(&seed, least);
        float x[3], y[3];
        panel_emission_xyz(a, q.wo, q.rgb, x);
        panel_emission_xyz(b, q.wo, q.rgb, y);
        Spectrum f = panel_brdf(a, q.wo, q.wi, &q.wavelengths);
        Spectrum g = panel_brdf(b, q.wo, q.wi, &q.wavelengths);
        for (int j = 0; j < 3; j++) found[0] = fmax(found[0], fabs((double)(x[j] / y[j]) - 1));
        for (int j = 0; j < SPECTRUM_LANES; j++)
            found[1] = fmax(found[1], fabs((double)(f[j] / g[j]) - 1));
    }
}

TEST(the_finest_level_is_the_panel_to_the_bit) {
    for (int p = 0; p < 2; p++) {
        Panel *whole = opened(NAMES[p]), *same = opened(NAMES[p]);
        PanelCoarse c;
        double found[2];
        int finest = panel_coarse_finest(same);
        panel_coarse_compare(same, finest, PANEL_COARSE_ALL, *test_memory(), &c);
        panel_coarsen(same, finest, PANEL_COARSE_ALL, test_memory());
        assert_true(c.emission.is_asked && c.reflection.is_asked);
        assert_int_equal(c.emission.level, c.emission.finest);
        assert_int_equal(c.reflection.level, c.reflection.finest);
        assert_true(c.emission.max == 0 && c.emission.rms == 0);
        assert_true(c.reflection.max == 0 && c.reflection.rms == 0);
        compare(same, whole, ASKED / 10, found);
        assert_true(found[0] == 0 && found[1] == 0);
        panel_close(whole);
        panel_close(same);
    }
}

static void check_part(const PanelCoarsePart *part, const PanelCoarsePart *last, int level,
                       double found) {
    assert_int_equal(part->level, level < part->finest ? level : part->finest);
    assert_true(found <= part->max + 1e-5); /* what rounding of a sum of logarithms adds */
    assert_true(part->rms <= part->max);
    assert_true(part->rms <= last->rms);
}

TEST(stated_errors_hold_and_fall_with_the_level) {
    for (int p = 0; p < 2; p++) {
        Panel *whole = opened(NAMES[p]);
        PanelCoarse last = {.emission.rms = 1e30, .reflection.rms = 1e30};
        int finest = panel_coarse_finest(whole);
        for (int level = 0; level < finest; level++) {
            Panel *panel = opened(NAMES[p]);
            PanelCoarse c;
            double found[2];
            panel_coarse_compare(panel, level, PANEL_COARSE_ALL, *test_memory(), &c);
            panel_coarsen(panel, level, PANEL_COARSE_ALL, test_memory());
            bool is_all = level == 5;
            compare(panel, whole, is_all ? ASKED : ASKED / 20, found);
            check_part(&c.emission, &last.emission, level, found[0]);
            check_part(&c.reflection, &last.reflection, level, found[1]);
            if (is_all) assert_true(found[1] > 0.1 * c.reflection.max);
            last = c;
            panel_close(panel);
        }
        panel_close(whole);
    }
}

/* Emission at the vertices of the level, as queries find them. 1e-5: what rounding of places
 * and sums of logarithms adds. */
TEST(at_its_vertices_a_level_is_the_whole_panel) {
    static const float RGB[3] = {255, 31, 127};
    for (int p = 0; p < 2; p++) {
        Panel *whole = opened(NAMES[p]);
        for (int level = 0; level <= whole->emission_tree.level; level++) {
            Panel *panel = opened(NAMES[p]);
            VertexLattice lattice = {level, 4};
            uint32_t count = vertex_count(lattice);
            Vec3 *d = ARENA_NEW(test_memory(), Vec3, count);
            vertex_directions(lattice, d);
            panel_coarsen(panel, level, PANEL_COARSE_EMISSION, test_memory());
            for (uint32_t v = 0; v < count; v += level < 6 ? 1 : 7) {
                float a[3], b[3];
                panel_emission_xyz(panel, d[v], RGB, a);
                panel_emission_xyz(whole, d[v], RGB, b);
                for (int j = 0; j < 3; j++) assert_close(a[j], b[j], 1e-5);
            }
            panel_close(panel);
        }
        panel_close(whole);
    }
}

TEST(only_what_is_asked_for_is_coarser) {
    double found[2];
    for (int reflects = 0; reflects < 2; reflects++) {
        Panel *whole = opened("ips_cluster"), *panel = opened("ips_cluster");
        unsigned part = reflects ? PANEL_COARSE_REFLECTION : PANEL_COARSE_EMISSION;
        PanelCoarse c;
        panel_coarse_compare(panel, 2, part, *test_memory(), &c);
        panel_coarsen(panel, 2, part, test_memory());
        assert_true(c.emission.is_asked == !reflects && c.reflection.is_asked == reflects);
        compare(panel, whole, ASKED / 20, found);
        assert_true(found[reflects] > 1e-3 && found[1 - reflects] == 0);
        panel_close(whole);
        panel_close(panel);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
