/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_open_reflection.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/tree/sampling_tree_build.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/query/panel_reflection_layout.h"
#include "spectrum/fresnel.h"

static bool check_counts(const PanelBytes *at, const PanelReflectionStored *s) {
    uint32_t tables = (uint32_t)s->incidences * s->azimuths;
    if (s->incidences < 1 || s->incidences > PANEL_INCIDENCES_MAX || s->azimuths < 1 ||
        s->azimuths > PANEL_AZIMUTHS_MAX || tables > PANEL_TABLES_MAX || s->components < 1 ||
        s->components > PANEL_REFLECTION_COMPONENTS_MAX || s->coefficients < 1 ||
        s->coefficients > PANEL_COEFFICIENTS_MAX || s->wavelengths < 1 ||
        s->wavelengths > PANEL_WAVELENGTHS_MAX || s->nodes > PANEL_NODES_MAX)
        return panel_refuse(at, "reflection", "a count is out of range");
    if (s->one != 1 || s->has_mirror > 1 || s->reserved[0] || s->reserved[1])
        return panel_refuse(at, "reflection", "a switch is out of range");
    if (!(s->frame_exponent >= 1 && s->frame_exponent <= 4) ||
        !(s->refractive_index >= 1 && s->refractive_index <= 4) ||
        !(s->cone_cos >= 0 && s->cone_cos <= 1) || !(s->mean_scale >= 0 && s->mean_scale <= 0.01f))
        return panel_refuse(at, "reflection",
                            "frame, refractive index, cone or scale out of "
                            "range");
    return true;
}

static bool in_range(const float *value, uint32_t count, float low, float high) {
    for (uint32_t i = 0; i < count; i++)
        if (!(value[i] >= low && value[i] <= high)) return false;
    return true;
}

static bool check_axes(const PanelBytes *at, const PanelReflectionStored *s,
                       const ReflectionLayout *from) {
    if (!panel_rising(from->incidence, s->incidences) ||
        !in_range(from->incidence, s->incidences, 0, 1.5708f) ||
        !panel_rising(from->azimuth, s->azimuths) ||
        !in_range(from->azimuth, s->azimuths, 0, 6.2832f))
        return panel_refuse(at, "reflection", "incidences or azimuths do not rise");
    if (!panel_rising(from->wavelength_nm, s->wavelengths) ||
        !in_range(from->wavelength_nm, s->wavelengths, 1, 1e5f))
        return panel_refuse(at, "reflection", "wavelengths do not rise");
    if (!panel_rising(from->node_theta, s->nodes) ||
        !in_range(from->node_theta, s->nodes, 0, 1.5709f))
        return panel_refuse(at, "reflection", "incidences beyond the measured do not rise");
    if (!in_range(from->basis_scale, s->coefficients, 0, 1e6f) ||
        !in_range(from->loading_scale, s->components, 0, 1e6f))
        return panel_refuse(at, "reflection", "a scale is out of range");
    return true;
}

/* ---- expansion --------------------------------------------------------------------------- */

/* rows x wavelengths numbers of 16 bits to padded rows. */
static float *expand_rows(const PanelReflection *r, const int16_t *from, uint32_t rows, float scale,
                          Arena *arena) {
    float *out = ARENA_NEW(arena, float, (size_t)rows * r->padded_wavelengths);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t w = 0; w < r->wavelengths; w++)
            out[i * r->padded_wavelengths + w] = scale * (float)from[i * r->wavelengths + w];
    return out;
}

static float *expand_shares(const PanelReflection *r, const uint16_t *from, uint32_t rows,
                            Arena *arena) {
    float *out = ARENA_NEW(arena, float, (size_t)rows * r->padded_wavelengths);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t w = 0; w < r->wavelengths; w++)
            out[i * r->padded_wavelengths + w] = (float)from[i * r->wavelengths + w] / 65535.0f;
    return out;
}

static void exponentiate(float *rows, const PanelReflection *r, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t w = 0; w < r->wavelengths; w++)
            rows[i * r->padded_wavelengths + w] = exp_f(rows[i * r->padded_wavelengths + w]);
}

static bool rows_are_level(const PanelReflection *r, const float *rows, uint32_t count) {
    for (uint32_t i = 0; rows && i < count; i++)
        for (uint32_t w = 1; w < r->wavelengths; w++)
            if (rows[i * r->padded_wavelengths + w] != rows[i * r->padded_wavelengths])
                return false;
    return true;
}

static bool is_grey(const PanelReflection *r) {
    return rows_are_level(r, r->mean, r->tables) && rows_are_level(r, r->basis, r->coefficients) &&
           rows_are_level(r, r->lambertian_log, r->tables) &&
           rows_are_level(r, r->held, r->nodes) && rows_are_level(r, r->mirror, PANEL_ANGLES);
}

static void expand_basis(const PanelReflectionStored *s, const ReflectionLayout *from,
                         PanelReflection *r, Arena *arena) {
    float *basis = ARENA_NEW(arena, float, r->coefficients * r->padded_wavelengths);
    size_t loadings = (size_t)r->tables * r->components * r->padded_coefficients;
    float *loading = arena_alloc(arena, sizeof *loading, 16, loadings + PANEL_COEFFICIENTS_BEHIND);
    for (uint32_t k = 0; k < r->coefficients; k++)
        for (uint32_t w = 0; w < r->wavelengths; w++)
            basis[k * r->padded_wavelengths + w] =
                from->basis_scale[k] * (float)from->basis[k * s->wavelengths + w];
    for (uint32_t t = 0; t < r->tables; t++)
        for (uint32_t k = 0; k < r->coefficients; k++)
            for (uint32_t c = 0; c < r->components; c++)
                loading[(t * r->components + c) * r->padded_coefficients + k] =
                    from->loading_scale[c] *
                    (float)from->loading[(t * r->coefficients + k) * r->components + c];
    r->basis = basis;
    r->loading = loading;
}

/* Measured incidences, and before them up to two seen from the other side of the normal. */
static void name_steps(const ReflectionLayout *from, PanelReflection *r) {
    int n = (int)r->incidences, first = from->incidence[0] > 1e-6f ? 0 : 1;
    for (int i = first + 1; i >= first; i--)
        if (i < n) r->step[r->steps++] = (PanelIncidence){-from->incidence[i], i, true};
    for (int i = 0; i < n; i++)
        r->step[r->steps++] = (PanelIncidence){from->incidence[i], i, false};
}

/* Weights of the four neighbours between two incidences as cubics in u, which is 0 at the first
 * and 1 at the second: a Hermite curve with the slopes of parabolas through three; where a
 * neighbour is missing the other end's parabola serves, and a straight line where both are.
 * With h the width, h0 and h2 the widths beside it, d0 d1 d2 the divided differences, the slope
 * at the first is (h d0 + h0 d1) / (h0 + h), at an end without neighbour 2 d1 less the other
 * end's. Weights may be negative: they are for logarithms only. */
static void cubic_between(const PanelReflection *r, int i, float out[4][4]) {
    static const double rise[4] = {0, 0, 3, -2}, first[4] = {0, 1, -2, 1};
    static const double second[4] = {0, 0, -1, 1}; /* what slopes at the two ends add */
    bool left = i > 0, right = i + 2 < (int)r->steps;
    double x1 = (double)r->step[i].theta, x2 = (double)r->step[i + 1].theta, h = x2 - x1;
    double h0 = left ? x1 - (double)r->step[i - 1].theta : h;
    double h2 = right ? (double)r->step[i + 2].theta - x2 : h;
    double p = left ? h / (h0 + h) : 0, q = right ? h / (h + h2) : 0;
    /* the slopes' shares of d0, d1, d2 */
    double s1[3] = {p, 1 - p, 0}, s2[3] = {0, 1 - q, q};
    if (!right && left) s2[0] = -p, s2[1] = 1 + p;
    if (!left && right) s1[1] = 1 + q, s1[2] = -q;
    for (int u = 0; u < 4; u++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = h * (first[u] * s1[k] + second[u] * s2[k]);
        out[u][0] = (float)(-d[0] / h0);
        out[u][1] = (float)((u == 0) - rise[u] + d[0] / h0 - d[1] / h);
        out[u][2] = (float)(rise[u] + d[1] / h - d[2] / h2);
        out[u][3] = (float)(d[2] / h2);
    }
}

/* Adds the neighbours of an interval that are turned, or those that are not. */
static void add_neighbours(const PanelReflection *r, int interval, bool turned, int *count,
                           PanelNeighbours *near) {
    for (int k = 0; k < PANEL_NEIGHBOURS; k++) {
        int step = interval - 1 + k;
        bool is_there = step >= 0 && step < (int)r->steps;
        bool is_turned = is_there && r->step[step].is_turned;
        if (is_turned != turned) continue;
        near->incidence[*count] = is_there ? r->step[step].incidence : 0;
        near->is_turned[*count] = is_turned;
        near->of[(*count)++] = k;
    }
}

static void find_neighbours(PanelReflection *r) {
    for (int i = 0; i < (int)r->steps; i++) {
        int count = 0;
        add_neighbours(r, i, false, &count, &r->neighbours[i]);
        r->neighbours[i].straight = count;
        add_neighbours(r, i, true, &count, &r->neighbours[i]);
    }
}

static void find_cubics(PanelReflection *r) {
    if (r->steps == 1) r->step_cubic[0][0][1] = 1;
    for (int i = 0; i + 1 < (int)r->steps; i++) {
        if (r->steps >= 3) {
            cubic_between(r, i, r->step_cubic[i]);
            continue;
        }
        r->step_cubic[i][0][1] = 1;
        r->step_cubic[i][1][1] = -1;
        r->step_cubic[i][1][2] = 1;
    }
}

/* R / F over the measured incidences, straight lines in F; beyond the last one the line goes
 * on (a coating loses its effect towards grazing), held between half the last ratio and 1,
 * or what was measured where that is more. */
static double mirror_ratio(const PanelReflection *r, const ReflectionLayout *from,
                           uint32_t wavelength, double here) {
    uint32_t m = r->incidences, i = 0;
    double n = (double)r->refractive_index, f[2], ratio[2];
    while (i + 2 < m && fresnel_unpolarised_d(cos_d((double)from->incidence[i + 1]), n) < here) i++;
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t j = i + k < m ? i + k : m - 1;
        f[k] = fresnel_unpolarised_d(cos_d((double)from->incidence[j]), n);
        ratio[k] = from->mirror[j * r->wavelengths + wavelength] / 65535.0 / f[k];
    }
    if (m < 2 || here <= f[0] || !(f[1] - f[0] > 1e-6)) return ratio[here > f[0] && m > 1];
    double value = ratio[0] + (ratio[1] - ratio[0]) * (here - f[0]) / (f[1] - f[0]);
    double most = fmax(1, fmax(ratio[0], ratio[1])); /* a mirror may exceed plain glass */
    return fmin(most, fmax(value, 0.5 * fmin(ratio[0], ratio[1])));
}

static void expand_mirror(const ReflectionLayout *from, PanelReflection *r, Arena *arena) {
    float *mirror = ARENA_NEW(arena, float, (size_t)PANEL_ANGLES * r->padded_wavelengths);
    for (uint32_t a = 0; a < PANEL_ANGLES; a++) {
        double cosine = cos_d(a * 0.0087266462599716);
        double f = fresnel_unpolarised_d(cosine, (double)r->refractive_index);
        for (uint32_t w = 0; w < r->wavelengths; w++)
            mirror[a * r->padded_wavelengths + w] = (float)fmin(1, f * mirror_ratio(r, from, w, f));
    }
    r->mirror = mirror;
}

/* Luminous mean of a row of shares. */
static double luminous(const PanelReflection *r, const uint16_t *row) {
    double sum = 0, total = 0;
    for (uint32_t w = 0; w < r->wavelengths; w++) {
        double y = panel_luminous_weight(r->wavelength_nm[w]);
        sum += y * row[w] / 65535.0;
        total += y;
    }
    return sum / total;
}

/* Haze albedo over F between the measured incidences, and between the nodes beyond. */
static void expand_albedo(const ReflectionLayout *from, PanelReflection *r) {
    double theta[PANEL_INCIDENCES_MAX + PANEL_NODES_MAX], ratio[COUNT_OF(theta)];
    double n = (double)r->refractive_index;
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->incidences; i++, count++) {
        ratio[count] = 0;
        for (uint32_t a = 0; a < r->azimuths; a++)
            ratio[count] +=
                luminous(r, from->albedo + (a * r->incidences + i) * r->wavelengths) / r->azimuths;
        theta[count] = (double)from->incidence[i];
    }
    for (uint32_t i = 1; i < r->nodes; i++, count++) {
        ratio[count] = luminous(r, from->node_albedo + i * r->wavelengths);
        theta[count] = (double)from->node_theta[i];
    }
    for (uint32_t i = 0; i < count; i++) ratio[i] /= fresnel_unpolarised_d(cos_d(theta[i]), n);
    for (uint32_t a = 0, i = 0; a < PANEL_ANGLES; a++) {
        double here = a * 0.0087266462599716;
        while (i + 2 < count && theta[i + 1] <= here) i++;
        uint32_t next = i + 1 < count ? i + 1 : i;
        double t = next > i ? (here - theta[i]) / (theta[next] - theta[i]) : 0;
        t = fmin(1, fmax(0, t));
        r->haze_albedo[a] = (float)fmin(1, fresnel_unpolarised_d(cos_d(here), n) *
                                               (ratio[i] + t * (ratio[next] - ratio[i])));
    }
}

static PanelReflection *expand(const PanelReflectionStored *s, const ReflectionLayout *from,
                               Arena *arena) {
    PanelReflection *r = ARENA_NEW(arena, PanelReflection, 1);
    *r = (PanelReflection){.incidences = s->incidences,
                           .azimuths = s->azimuths,
                           .tables = (uint32_t)s->incidences * s->azimuths,
                           .components = s->components,
                           .coefficients = s->coefficients,
                           .padded_coefficients = (s->coefficients + 3u) / 4 * 4,
                           .wavelengths = s->wavelengths,
                           .padded_wavelengths = (s->wavelengths + 15u) / 16 * 16,
                           .nodes = s->nodes,
                           .has_mirror = s->has_mirror,
                           .frame_exponent = s->frame_exponent,
                           .refractive_index = s->refractive_index,
                           .cone_cos = s->cone_cos,
                           .cone_theta = (float)acos_d((double)s->cone_cos),
                           .last_theta = from->incidence[s->incidences - 1]};
    memcpy(r->azimuth, from->azimuth, sizeof(float) * s->azimuths);
    memcpy(r->wavelength_nm, from->wavelength_nm, sizeof(float) * s->wavelengths);
    memcpy(r->node_theta, from->node_theta, sizeof(float) * s->nodes);
    name_steps(from, r);
    find_cubics(r);
    find_neighbours(r);
    sincos_turns(r->last_theta * (0.5f / PI_F), &r->last_sine, &r->last_cosine);
    r->last_fresnel = fresnel_unpolarised(r->last_cosine, r->refractive_index);
    r->mean = expand_rows(r, from->mean, r->tables, s->mean_scale, arena);
    r->lambertian_log = expand_rows(r, from->lambertian, r->tables, s->mean_scale, arena);
    float *lambertian = expand_rows(r, from->lambertian, r->tables, s->mean_scale, arena);
    exponentiate(lambertian, r, r->tables);
    r->lambertian = lambertian;
    expand_basis(s, from, r, arena);
    r->held = expand_shares(r, from->held, s->nodes, arena);
    if (s->has_mirror) expand_mirror(from, r, arena);
    expand_albedo(from, r);
    r->is_grey = is_grey(r);
    return r;
}

/* ---- sampling ---------------------------------------------------------------------------- */

static bool check_nodes(const PanelBytes *at, const PanelSampling *s) {
    if (s->incidences < 1 || s->azimuths < 1 || s->incidences * s->azimuths != s->tree.functions)
        return panel_refuse(at, "sampling", "counts do not fit the tree's functions");
    if ((s->azimuths > 1) != (s->tree.octants == 4))
        return panel_refuse(at, "sampling", "the tree's octants do not fit the azimuths");
    return true;
}

static bool check_thetas(const PanelBytes *at, const PanelSampling *s) {
    for (int i = 0; i < s->incidences; i++)
        if (!(s->theta[i] >= 0 && s->theta[i] <= 0.5f * PI_F))
            return panel_refuse(at, "sampling", "an incidence is out of range");
    return panel_rising(s->theta, (uint32_t)s->incidences) ||
           panel_refuse(at, "sampling", "incidences do not rise");
}

/* The sampling tree, expanded into the arena; a file without one leaves the panel as it is.
 * The reflection is there. */
static bool open_sampling(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                          Panel *panel) {
    PanelBytes at;
    bool found;
    uint16_t counts[2];
    if (!panel_find_section(bytes, PANEL_SAMPLING, 0, &at, &found)) return false;
    if (!found) return true;
    PanelSampling s = {0};
    if (!sampling_tree_open(at.data, at.size, geodesic, arena, &s.tree, bytes->err))
        return error_prefix(bytes->err, "sampling") || error_in_file(bytes->err, bytes->name);
    size_t behind = panel_sampling_tree_bytes(sampling_tree_size(at.data));
    if (at.size < behind + sizeof counts) return panel_refuse(&at, "sampling", "is too short");
    memcpy(counts, at.data + behind, sizeof counts);
    s.incidences = counts[0];
    s.azimuths = counts[1];
    s.theta = (const float *)(const void *)(at.data + behind + sizeof counts);
    if (!check_nodes(&at, &s)) return false;
    if (at.size != behind + sizeof counts + (size_t)s.incidences * sizeof(float))
        return panel_refuse(&at, "sampling", "has another size than its counts say");
    if (!check_thetas(&at, &s)) return false;
    panel->sampling = s;
    return true;
}

/* ---- the sections ------------------------------------------------------------------------ */

/* For every whole nm the interval of measured wavelengths that holds it. */
static void index_wavelengths(Panel *panel) {
    const PanelReflection *r = panel->reflection;
    int last = 0, intervals = (int)r->wavelengths - 1;
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        while (last + 1 < intervals && r->wavelength_nm[last + 1] <= (float)(SPECTRAL_FIRST_NM + i))
            last++;
        panel->wavelength_index[i] = (int16_t)last;
    }
    for (int i = 0; i < intervals; i++)
        panel->wavelength_scale[i] = 1 / (r->wavelength_nm[i + 1] - r->wavelength_nm[i]);
}

bool panel_expand_reflection(const PanelReflectionBytes *sections, const Geodesic *geodesic,
                             Arena *arena, Panel *panel) {
    ReflectionLayout from;
    const PanelBytes *at = &sections->numbers, *tree = &sections->tree;
    const PanelReflectionStored *s = (const PanelReflectionStored *)at->data;
    if (at->size < sizeof *s) return panel_refuse(at, "reflection", "is too short");
    if (!check_counts(at, s)) return false;
    if (reflection_layout(s, &from) != at->size)
        return panel_refuse(at, "reflection", "has another size than its counts say");
    if (!check_axes(at, s, &from)) return false;
    if (!tree_open(tree->data, tree->size, geodesic, arena, &panel->reflection_tree, at->err))
        return error_prefix(at->err, "reflection tree") || error_in_file(at->err, at->name);
    if (panel->reflection_tree.components != (int)s->components ||
        panel->reflection_tree.octants != (s->azimuths > 1 ? 4 : 2))
        return panel_refuse(at, "reflection", "does not fit its tree");
    if (sections->reach.data &&
        sections->reach.size != sizeof *panel->reflection->reach * s->incidences * s->azimuths)
        return panel_refuse(&sections->reach, "reach", "has another size than its counts say");
    PanelReflection *reflection = expand(s, &from, arena);
    reflection->reach = (const PanelReachStored *)(const void *)sections->reach.data;
    panel->reflection = reflection;
    index_wavelengths(panel);
    return true;
}

bool panel_open_reflection(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                           Panel *panel) {
    PanelReflectionBytes sections = {0};
    bool found, has_reach;
    if (!panel_find_section(bytes, PANEL_REFLECTION, 0, &sections.numbers, &found) ||
        !panel_find_section(bytes, PANEL_REACH, 0, &sections.reach, &has_reach))
        return false;
    if (!found) return true;
    return panel_need_section(bytes, PANEL_REFLECTION_TREE, 0, &sections.tree) &&
           panel_expand_reflection(&sections, geodesic, arena, panel) &&
           open_sampling(bytes, geodesic, arena, panel);
}
