/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: what a panel reflects. No allocation, no lock, no libm. */
#include "panel/query/panel_reflection.h"

#include <string.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree/tree_query.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_tables.h"
#include "panel/query/panel_reach.h"
#include "panel/query/panel_turn.h"
#include "spectrum/fresnel.h"

#define PADDED_MAX ((PANEL_WAVELENGTHS_MAX + 15) / 16 * 16)
#define COEFFICIENTS_MAX ((PANEL_COEFFICIENTS_MAX + 3) / 4 * 4)
#define COMPONENTS_MAX ((PANEL_REFLECTION_COMPONENTS_MAX + 3) / 4 * 4)
#define LEAST_WEIGHT 1e-3f /* of a table that an answer rests on */
#define SAME_ANGLE 2e-5f   /* radians */
#define PASSAGE 0.035f     /* radians, over which exchanged directions take over */

bool panel_reflects(const Panel *panel) {
    return panel->reflection != NULL;
}

bool panel_reflects_grey(const Panel *panel) {
    return !panel->reflection || panel->reflection->is_grey;
}

/* ---- logarithms ------------------------------------------------------------------------ */

/* Eight at a time: what all instruction sets keep in registers. */
typedef float Float8 __attribute__((vector_size(32), aligned(4), may_alias));

/* Weighted rows of the mixed tables at 8 wavelengths from w on. */
static inline Float8 mixed_rows(const PanelReflection *r, const PanelTables *mix, const float *rows,
                                int w) {
    Float8 sum = {0};
    for (int i = 0; i < mix->count; i++)
        sum += mix->term[i].weight *
               *(const Float8 *)(rows + mix->term[i].table * (int)r->padded_wavelengths + w);
    return sum;
}

/* As many coefficients as a register holds; where fewer are left, what is read and written
 * behind them counts for nothing (COEFFICIENTS_BEHIND). */
#if defined __AVX512F__
#define WIDE 16
#elif defined __AVX__
#define WIDE 8
#else
#define WIDE 4
#endif
#define WIDE_ALIGNED (WIDE == 4 ? 16 : 4) /* rows are multiples of four, more than that */
typedef float Wide __attribute__((vector_size(4 * WIDE), aligned(WIDE_ALIGNED), may_alias));
_Static_assert(WIDE <= 4 + PANEL_COEFFICIENTS_BEHIND, "rows of 4 may be read as one of WIDE");

/* Tables that are evaluated together: 1 or 4. */
typedef struct TableGroup {
    const PanelTablesTerm *term;
    int count;
} TableGroup;

/* Adds what a component vector of the tree means for a group of mixed tables: 1 or 2 wides of
 * coefficients from k on. The counts are constants where inlined. All sums grow together: one
 * alone would wait for itself. */
static inline void add_wides(const PanelReflection *r, TableGroup group, const float *component,
                             int k, int wides, float *coefficient) {
    int stride = (int)r->padded_coefficients, n = (int)r->components;
    const float *row[4];
    Wide sum[4][2];
    for (int i = 0; i < group.count; i++) {
        row[i] = r->loading + group.term[i].table * n * stride + k;
        for (int j = 0; j < wides; j++) sum[i][j] = (Wide){0};
    }
    for (int c = 0; c < n; c++) {
        Wide value = (Wide){0} + component[c];
        for (int i = 0; i < group.count; i++)
            for (int j = 0; j < wides; j++)
                sum[i][j] += value * *(const Wide *)(row[i] + c * stride + j * WIDE);
    }
    for (int i = 0; i < group.count; i++)
        for (int j = 0; j < wides; j++)
            *(Wide *)(coefficient + k + j * WIDE) += group.term[i].weight * sum[i][j];
}

static inline void add_group(const PanelReflection *r, TableGroup group, const float *component,
                             float *coefficient) {
    int k = 0, padded = (int)r->padded_coefficients;
    for (; k + WIDE < padded; k += 2 * WIDE) add_wides(r, group, component, k, 2, coefficient);
    if (k < padded) add_wides(r, group, component, k, 1, coefficient);
}

/* As many tables as are left are evaluated as four, of which some count nothing: how many there
 * are of a side cannot be predicted. */
static inline void add_loadings(const PanelReflection *r, const PanelTablesTerm *term, int count,
                                const float *component, float *coefficient) {
    for (int i = 0; i < count; i += 4) {
        PanelTablesTerm four[4];
        for (int k = 0; k < 4; k++) {
            bool is_there = i + k < count;
            four[k] = term[is_there ? i + k : i];
            four[k].weight = is_there ? four[k].weight : 0;
        }
        add_group(r, (TableGroup){four, 4}, component, coefficient);
    }
}

/* AVX-512 looks 16 numbers up in two registers at once; only GCC says so without intrinsics. */
#if defined __AVX512F__ && !defined __clang__
#define PANEL_ROWS_IN_REGISTERS
#endif

/* Values at the lanes, linear between measured wavelengths. */
static inline Spectrum spread(const float *value, const PanelLanes *lanes) {
    Spectrum low, high;
    if (lanes->has_one) return spectrum_all(value[0]);
#ifdef PANEL_ROWS_IN_REGISTERS
    if (lanes->second >= 0) {
        Spectrum first, second;
        memcpy(&first, value, sizeof first);
        memcpy(&second, value + lanes->second, sizeof second);
        low = __builtin_shuffle(first, second, lanes->interval);
        high = __builtin_shuffle(first, second, lanes->interval + 1);
        return low + (high - low) * lanes->t;
    }
#endif
    spectrum_neighbours(value, lanes->interval, &low, &high);
    return low + (high - low) * lanes->t;
}

/* Rows a and b of padded_wavelengths floats, t from the first to the second. */
static Spectrum spread_between(const Panel *panel, const float *rows, int first, float t,
                               const PanelLanes *lanes) {
    int padded = (int)panel->reflection->padded_wavelengths;
    const float *a = rows + first * padded, *b = t > 0 ? a + padded : a;
    Spectrum low = spread(a, lanes), high = spread(b, lanes);
    return low + (high - low) * spectrum_all(t);
}

/* Mixes rows that are not at the lanes yet before they go there. */
static Spectrum mixed_at_lanes(const PanelReflection *r, const PanelTables *mix, const float *rows,
                               const PanelLanes *lanes) {
    float row[PADDED_MAX];
    for (int w = 0; w < (int)r->padded_wavelengths; w += 8)
        *(Float8 *)(row + w) = mixed_rows(r, mix, rows, w);
    return spread(row, lanes);
}

static inline void add_lanes(float factor, const Spectrum *lanes, Wide *sum) {
    for (int i = 0; i < SPECTRUM_LANES / WIDE; i++)
        sum[i] += factor * *(const Wide *)((const float *)lanes + i * WIDE);
}

/* ln (f / F) at the lanes. */
static Spectrum reflection_logs(const Panel *panel, Vec3 stored, const PanelTables *mix,
                                const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    float component[COMPONENTS_MAX];
    _Alignas(64) float coefficient[COEFFICIENTS_MAX + PANEL_COEFFICIENTS_BEHIND] = {0};
    Spectrum logs = spectrum_all(0);
    if (!lanes->has_means) logs = mixed_at_lanes(r, mix, r->mean, lanes);
    if (mix->count == 1 && mix->straight == 1) { /* the last incidence's, mostly */
        tree_interpolate(&panel->reflection_tree, stored, component);
        add_group(r, (TableGroup){mix->term, 1}, component, coefficient);
    } else if (mix->straight) {
        tree_interpolate(&panel->reflection_tree, stored, component);
        add_loadings(r, mix->term, mix->straight, component, coefficient);
    }
    if (mix->straight < mix->count) {
        Vec3 at = vec3(-stored.x, -stored.y, stored.z);
        tree_interpolate(&panel->reflection_tree, at, component);
        add_loadings(r, mix->term + mix->straight, mix->count - mix->straight, component,
                     coefficient);
    }
    Wide sum[SPECTRUM_LANES / WIDE];
    memcpy(sum, &logs, sizeof sum);
    for (int i = 0; i < mix->count && lanes->has_means; i++)
        add_lanes(mix->term[i].weight, &lanes->mean[mix->term[i].table], sum);
    for (int k = 0; k < (int)r->coefficients; k++) add_lanes(coefficient[k], &lanes->basis[k], sum);
    memcpy(&logs, sum, sizeof logs);
    return logs;
}

/* ---- beyond the last measured incidence ------------------------------------------------- */

/* Where the last measured incidence is read for one beyond it, by the invariance of scatter
 * from surfaces of low slope (Harvey): in the projection on the panel's plane the haze only
 * moves. Directions that come to lie outside the measured cone are held at its edge. */
static Vec3 shifted(const PanelReflection *r, Vec3 local, float sin_theta) {
    float x = local.x - sin_theta + r->last_sine, y = local.y;
    float edge = safe_sqrtf(1 - r->cone_cos * r->cone_cos), length = safe_sqrtf(x * x + y * y);
    if (length > edge) x *= edge / length, y *= edge / length;
    return vec3(x, y, safe_sqrtf(1 - x * x - y * y));
}

static Spectrum mirror_at(const Panel *panel, float cos_theta, const PanelLanes *lanes) {
    float t;
    int node = panel_angle_node(acos_f(cos_theta), &t);
    return spread_between(panel, panel->reflection->mirror, node, t, lanes);
}

/* Reflectance of the glossy surface: the mirror part's where there is one (the coating is the
 * same), Fresnel's otherwise. Up to a constant. */
static Spectrum gloss(const Panel *panel, float cosine, const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    if (!r->has_mirror) return spectrum_all(fresnel_unpolarised(cosine, r->refractive_index));
    if (!(cosine > 0)) return spectrum_all(1e-6f);
    return spectrum_max(mirror_at(panel, cosine, lanes), spectrum_all(1e-6f));
}

static Spectrum spectrum_root(Spectrum a) {
    Spectrum root;
    for (int i = 0; i < SPECTRUM_LANES; i++) root[i] = safe_sqrtf(a[i]);
    return root;
}

/* Factor that conserves energy at an incidence beyond the measured ones. */
static Spectrum held_factor(const Panel *panel, float theta, const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    int i = 0;
    if (r->nodes < 2) return spectrum_all(1);
    for (int k = 1; k < (int)r->nodes - 1; k++) i += r->node_theta[k] <= theta;
    float t = (theta - r->node_theta[i]) / (r->node_theta[i + 1] - r->node_theta[i]);
    return spread_between(panel, r->held, i, clampf(t, 0, 1), lanes);
}

/* Two directions as one question. local: wo in the frame of panel_turned. */
typedef struct PanelPair {
    Vec3 wi, wo, local;
    float theta; /* of wi */
} PanelPair;

static Vec3 stored_at(const PanelReflection *r, float theta, Vec3 local) {
    SpecularFrame frame = specular_frame(theta, r->frame_exponent);
    return specular_frame_stored(&frame, local);
}

/* The row of the table that counts most: at the last incidence weights that ought to be 0 may
 * be some rounding. */
static int main_row(const PanelReflection *r, const PanelTables *mix) {
    int best = 0;
    for (int i = 1; i < mix->straight; i++)
        if (mix->term[i].weight > mix->term[best].weight) best = i;
    return mix->term[best].table * (int)r->padded_wavelengths;
}

/* The haze moves, and its height is as the root of the surface's reflectances at theta_i and
 * theta_o; the lambertian part stays. */
static Spectrum moved_haze(const Panel *panel, const PanelPair *pair, float light,
                           const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    Vec3 from = shifted(r, pair->local, safe_sqrtf(1 - pair->wi.z * pair->wi.z));
    PanelTables mix = panel_tables_last(r, light);
    Spectrum logs = reflection_logs(panel, stored_at(r, r->last_theta, from), &mix, lanes);
    Spectrum total = spectrum_exp(logs) * spectrum_all(r->last_fresnel);
    Spectrum here = gloss(panel, pair->wi.z, lanes) * gloss(panel, pair->local.z, lanes);
    Spectrum ratio = spectrum_root(here / (lanes->last_gloss * gloss(panel, from.z, lanes)));
    int row = main_row(r, &mix);
    Spectrum lambertian = spectrum_min(total, spread(r->lambertian + row, lanes));
    return (total - lambertian) * ratio + lambertian;
}

/* How far wo lies inside the hulls of all tables that count under light from wi, which is no
 * further out than the last incidence; radians, negative outside. */
static float room_inside(const PanelReflection *r, const PanelPair *pair) {
    if (!r->reach) return r->cone_theta - panel_polar_angle(pair->local);
    float light = r->azimuths > 1 ? atan2_f(pair->wi.y, pair->wi.x) : 0, room = PI_F;
    PanelTables mix = panel_tables_at(r, pair->theta, light);
    for (int i = 0; i < mix.count; i++) {
        Vec3 at = pair->local;
        if (!(mix.term[i].weight > LEAST_WEIGHT)) continue;
        if (i >= mix.straight) at.x = -at.x, at.y = -at.y;
        float here = panel_reach_room(&r->reach[mix.term[i].table], at);
        room = here < room ? here : room;
    }
    return room;
}

static float smooth_share(float room) {
    float t = clampf(room * (1 / PASSAGE), 0, 1);
    return t * t * (3 - 2 * t);
}

static PanelPair pair_of(Vec3 wo, Vec3 wi) {
    return (PanelPair){wi, wo, panel_turned(wi, wo), panel_polar_angle(wi)};
}

/* Beyond the last incidence the two directions exchanged were measured where this is above 0
 * (Helmholtz); 1 where they are read, less within PASSAGE of where they end. */
static float exchanged_share(const PanelReflection *r, const PanelPair *pair) {
    PanelPair other = pair_of(pair->wi, pair->wo);
    float before = r->last_theta - other.theta, room;
    if (!(before > 0)) return 0;
    room = room_inside(r, &other);
    room = room < before ? room : before;
    return smooth_share(room) * smooth_share(pair->theta - r->last_theta);
}

static Spectrum brdf_beyond(const Panel *panel, const PanelPair *pair, float light,
                            const PanelLanes *lanes) {
    float share = exchanged_share(panel->reflection, pair);
    Spectrum f = spectrum_all(0);
    if (share < 1) f += moved_haze(panel, pair, light, lanes) * spectrum_all(1 - share);
    if (share > 0) f += panel_brdf_at(panel, pair->wi, pair->wo, lanes) * spectrum_all(share);
    return f * held_factor(panel, pair->theta, lanes);
}

bool panel_brdf_is_measured(const Panel *panel, Vec3 wo, Vec3 wi) {
    const PanelReflection *r = panel->reflection;
    if (!r || !(wo.z > 0) || !(wi.z > 0)) return false;
    PanelPair pair = pair_of(wo, wi), other = pair_of(wi, wo);
    bool is_beyond = pair.theta > r->last_theta + SAME_ANGLE;
    if (is_beyond && other.theta > r->last_theta + SAME_ANGLE) return false;
    return room_inside(r, is_beyond ? &other : &pair) >= -SAME_ANGLE;
}

/* ---- the lambertian part ---------------------------------------------------------------- */

/* As brdf_beyond has it. */
static Spectrum lambertian_beyond(const Panel *panel, float theta, float light,
                                  const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    PanelTables mix = panel_tables_last(r, light);
    return spread(r->lambertian + main_row(r, &mix), lanes) * held_factor(panel, theta, lanes);
}

/* ---- the queries ------------------------------------------------------------------------ */

static void find_lanes(const Panel *panel, const Wavelengths *wavelengths, PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    Spectrum nm = spectrum_clamp(wavelengths->nm, SPECTRAL_FIRST_NM, SPECTRAL_LAST_NM);
    SpectrumMask whole =
        __builtin_convertvector(nm - spectrum_all(SPECTRAL_FIRST_NM), SpectrumMask);
    float from[SPECTRUM_LANES], scale[SPECTRUM_LANES];
    Spectrum begin, inverse;
    lanes->has_one = r->wavelengths == 1;
    lanes->second = r->padded_wavelengths <= 32 ? (int)r->padded_wavelengths - 16 : -1;
    if (lanes->has_one) return;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int n = panel->wavelength_index[whole[i]];
        while (n + 2 < (int)r->wavelengths && r->wavelength_nm[n + 1] <= nm[i]) n++;
        from[i] = r->wavelength_nm[n];
        scale[i] = panel->wavelength_scale[n];
        lanes->interval[i] = n;
    }
    memcpy(&begin, from, sizeof begin);
    memcpy(&inverse, scale, sizeof inverse);
    lanes->t = spectrum_clamp((nm - begin) * inverse, 0, 1);
}

void panel_lanes(const Panel *panel, const Wavelengths *wavelengths, PanelLanes *out) {
    const PanelReflection *r = panel->reflection;
    if (!r) return;
    int padded = (int)r->padded_wavelengths;
    find_lanes(panel, wavelengths, out);
    for (int k = 0; k < (int)r->coefficients; k++)
        out->basis[k] = spread(r->basis + k * padded, out);
    out->has_means = r->tables <= PANEL_LANES_TABLES;
    for (int t = 0; out->has_means && t < (int)r->tables; t++)
        out->mean[t] = spread(r->mean + t * padded, out);
    out->last_gloss = gloss(panel, r->last_cosine, out);
}

Spectrum panel_brdf_at(const Panel *panel, Vec3 wo, Vec3 wi, const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    if (!r || !(wo.z > 0) || !(wi.z > 0)) return spectrum_all(0);
    PanelPair pair = pair_of(wo, wi);
    float light = r->azimuths > 1 ? atan2_f(wi.y, wi.x) : 0;
    if (pair.theta > r->last_theta) return brdf_beyond(panel, &pair, light, lanes);
    PanelTables mix = panel_tables_at(r, pair.theta, light);
    Spectrum over =
        spectrum_exp(reflection_logs(panel, stored_at(r, pair.theta, pair.local), &mix, lanes));
    return over * spectrum_all(fresnel_unpolarised(wi.z, r->refractive_index));
}

Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths) {
    PanelLanes lanes;
    if (!panel->reflection || !(wo.z > 0) || !(wi.z > 0)) return spectrum_all(0);
    panel_lanes(panel, wavelengths, &lanes);
    return panel_brdf_at(panel, wo, wi, &lanes);
}

Spectrum panel_lambertian_at(const Panel *panel, Spectrum brdf, Vec3 wi, const PanelLanes *lanes) {
    const PanelReflection *r = panel->reflection;
    if (!r || !(wi.z > 0)) return spectrum_all(0);
    float theta = panel_polar_angle(wi), light = r->azimuths > 1 ? atan2_f(wi.y, wi.x) : 0;
    if (theta > r->last_theta)
        return spectrum_min(brdf, lambertian_beyond(panel, theta, light, lanes));
    PanelTables mix = panel_tables_at(r, theta, light);
    return spectrum_min(brdf, spectrum_exp(mixed_at_lanes(r, &mix, r->lambertian_log, lanes)));
}

Spectrum panel_mirror_at(const Panel *panel, float cos_theta, const PanelLanes *lanes) {
    if (!panel->reflection || !panel->reflection->has_mirror || !(cos_theta > 0))
        return spectrum_all(0);
    return mirror_at(panel, cos_theta, lanes);
}

Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths) {
    PanelLanes lanes;
    if (!panel->reflection || !panel->reflection->has_mirror || !(cos_theta > 0))
        return spectrum_all(0);
    find_lanes(panel, wavelengths, &lanes);
    return mirror_at(panel, cos_theta, &lanes);
}

float panel_haze_albedo(const Panel *panel, float cos_theta) {
    float t;
    if (!panel->reflection || !(cos_theta > 0)) return 0;
    int node = panel_angle_node(acos_f(cos_theta), &t);
    const float *albedo = panel->reflection->haze_albedo;
    return lerpf(albedo[node], albedo[node + 1], t);
}
