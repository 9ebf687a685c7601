/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/panel_coarse.h"

#include <math.h>

#include "base/mathd.h"
#include "hemisphere/tree/tree_expand.h"
#include "hemisphere/tree/tree_stop.h"
#include "panel/query/panel_opened.h"

static double growth(double difference) {
    return exp_d(difference) - 1;
}

static double squared_growth(double difference) {
    double by = growth(difference);
    return by * by;
}

static int least(int a, int b) {
    return a < b ? a : b;
}

/* Sums over differences of logarithms; squares: of the relative ones. */
typedef struct Differences {
    double largest, squares, count;
} Differences;

static double relative(double difference) {
    return growth(fabs(difference)); /* the other side, 1 - exp(-x), is less */
}

static double rms(const Differences *d) {
    return d->count > 0 ? sqrt(d->squares / d->count) : 0;
}

/* Components at all points: the level's less the whole tree's. */
static float *component_differences(const Tree *tree, int level, uint32_t *points, Arena *arena) {
    size_t count = *points = tree_point_count(tree);
    count *= (size_t)tree->components;
    float *coarse = ARENA_NEW(arena, float, count), *whole = ARENA_NEW(arena, float, count);
    Tree stopped = *tree;
    tree_stop(&stopped, level, arena);
    tree_expand_points(&stopped, tree->level, coarse);
    tree_expand_points(tree, tree->level, whole);
    for (size_t i = 0; i < count; i++) coarse[i] -= whole[i];
    return coarse;
}

static bool is_nothing(const float *component, int count) {
    for (int k = 0; k < count; k++)
        if (component[k] != 0) return false;
    return true;
}

/* ---- emission -------------------------------------------------------------------------- */

/* A row of PanelEmission.code_rows or black_rows: ln X, Y, Z. */
static void add_row(const PanelEmission *e, const float *row, const float *component, bool is_full,
                    Differences *out) {
    for (int j = 0; j < 3; j++) {
        double sum = 0;
        for (int k = 0; k < e->components; k++)
            sum += (double)(row[4 * (k + 1) + j] * component[k]);
        out->largest = fmax(out->largest, fabs(sum));
        if (is_full) out->squares += squared_growth(sum);
    }
}

static void compare_emission(const Panel *panel, int level, Arena scratch, Differences *out) {
    const PanelEmission *e = panel->emission;
    int size = 4 * (e->components + 1);
    uint32_t points;
    const float *at = component_differences(&panel->emission_tree, level, &points, &scratch);
    *out = (Differences){.count = 9.0 * points};
    for (uint32_t i = 0; i < points; i++, at += e->components) {
        if (is_nothing(at, e->components)) continue;
        for (int p = 0; p < 3; p++)
            for (int code = 1; code <= 255; code++)
                add_row(e, e->code_rows[p] + code * size, at, code == 255, out);
        if (e->has_black) add_row(e, e->black_rows, at, false, out);
    }
}

/* ---- reflection ------------------------------------------------------------------------ */

/* The largest sum of the weights' magnitudes between incidences: by so much can differences of
 * tables grow there. */
static double weight_growth(const PanelReflection *r) {
    double largest = 1;
    for (uint32_t i = 0; i + 1 < r->steps; i++)
        for (int s = 0; s <= 256; s++) {
            double u = s / 256.0, sum = 0;
            for (int k = 0; k < 4; k++) {
                const float(*c)[4] = r->step_cubic[i];
                sum += fabs((double)c[0][k] +
                            u * ((double)c[1][k] + u * ((double)c[2][k] + u * (double)c[3][k])));
            }
            largest = fmax(largest, sum);
        }
    return largest * 1.0001; /* between the 256 */
}

static void add_table(const PanelReflection *r, uint32_t table, const float *component,
                      Differences *out) {
    float coefficient[(PANEL_COEFFICIENTS_MAX + 3) / 4 * 4] = {0};
    const float *row = r->loading + (size_t)table * r->components * r->padded_coefficients;
    for (uint32_t c = 0; c < r->components; c++, row += r->padded_coefficients)
        for (uint32_t k = 0; k < r->coefficients; k++) coefficient[k] += component[c] * row[k];
    for (uint32_t w = 0; w < r->wavelengths; w++) {
        double sum = 0;
        for (uint32_t k = 0; k < r->coefficients; k++)
            sum += (double)(coefficient[k] * r->basis[k * r->padded_wavelengths + w]);
        out->largest = fmax(out->largest, fabs(sum));
        out->squares += squared_growth(sum);
    }
}

static void compare_reflection(const Panel *panel, int level, Arena scratch, Differences *out) {
    const PanelReflection *r = panel->reflection;
    uint32_t points;
    const float *at = component_differences(&panel->reflection_tree, level, &points, &scratch);
    *out = (Differences){0};
    for (uint32_t i = 0; i < points; i++, at += r->components) {
        if (is_nothing(at, (int)r->components)) continue;
        for (uint32_t t = 0; t < r->tables; t++) add_table(r, t, at, out);
    }
    out->count = (double)points * r->tables * r->wavelengths;
    out->largest *= weight_growth(r);
}

/* ---- both parts, and all spots ----------------------------------------------------------- */

typedef void Compare(const Panel *panel, int level, Arena scratch, Differences *out);

/* Keeps the worst of several panels. */
static void add_part(const Panel *panel, const Tree *tree, int level, Compare *compare,
                     Arena scratch, PanelCoarsePart *out) {
    Differences found;
    int read = least(level, tree->level);
    compare(panel, read, scratch, &found);
    out->is_asked = true;
    out->level = read > out->level ? read : out->level;
    out->finest = tree->level > out->finest ? tree->level : out->finest;
    out->max = fmax(out->max, relative(found.largest));
    out->rms = fmax(out->rms, rms(&found));
}

static void add_panel(const Panel *panel, int level, unsigned parts, Arena scratch,
                      PanelCoarse *out) {
    if (panel->emission && parts & PANEL_COARSE_EMISSION)
        add_part(panel, &panel->emission_tree, level, compare_emission, scratch, &out->emission);
    if (panel->reflection && parts & PANEL_COARSE_REFLECTION)
        add_part(panel, &panel->reflection_tree, level, compare_reflection, scratch,
                 &out->reflection);
}

void panel_coarse_compare(const Panel *panel, int level, unsigned parts, Arena scratch,
                          PanelCoarse *out) {
    const PanelPlaces *places = panel->places;
    *out = (PanelCoarse){.level = level};
    add_panel(panel, level, parts, scratch, out);
    for (int k = 1; places && k < places->panels; k++)
        add_panel(places->panel[k], level, parts, scratch, out);
}
