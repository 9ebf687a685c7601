/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: what a panel reflects. No allocation, no lock, no libm. */
#include "panel/query/panel_reflection.h"

#include <string.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree/tree_query.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_reference.h"
#include "panel/query/panel_turn.h"
#include "spectrum/fresnel.h"

#define PADDED_MAX ((PANEL_WAVELENGTHS_MAX + 15) / 16 * 16)
#define COEFFICIENTS_MAX ((PANEL_COEFFICIENTS_MAX + 3) / 4 * 4)
#define COMPONENTS_MAX ((PANEL_REFLECTION_COMPONENTS_MAX + 3) / 4 * 4)
#define LOBE_SIGMAS 6.5f /* exp(-21): nothing beyond */

bool panel_reflects(const Panel *panel)
{
    return panel->reflection != NULL;
}

/* ---- which tables an angle of incidence is made of -------------------------------------- */

typedef struct Term {
    int   table;
    float weight;
} Term;

typedef struct Terms {
    int  count;
    Term term[16];
} Terms;

/* Tables that are read at the stored direction, and those that are read at the direction
 * turned by 180 degrees (incidences from beyond the normal, in the specular-following frame).
 */
typedef struct TableMix {
    Terms side[2];
} TableMix;

/* Weights of up to four neighbours. first: of the first one, may be -1 (weight 0). */
typedef struct Cubic {
    int   first;
    float weight[4];
} Cubic;

/* Cubic Hermite between x1 and x2 with the slopes of parabolas through three; where a
 * neighbour is missing the other end's parabola serves, and a straight line where both are.
 * Weights may be negative: they are for logarithms only. x: four abscissae, those missing are
 * not read. */
static void hermite_weights(const float x[4], bool has_left, bool has_right, float u,
                            float w[4])
{
    float h = x[2] - x[1], u2 = u * u, u3 = u2 * u;
    float a = (u3 - 2 * u2 + u) * h, b = (u3 - u2) * h; /* of the slopes at the two ends */
    float h0 = has_left ? x[1] - x[0] : 0, h2 = has_right ? x[3] - x[2] : 0;
    /* with divided differences d0, d1, d2 the slope at x1 is (h d0 + h0 d1) / (h0 + h); at an
     * end without neighbour the parabola's: 2 d1 less the slope at the other end */
    float a0 = has_left ? a * h / (h0 + h) : 0, a1 = a - a0;
    float b2 = has_right ? b * h / (h + h2) : 0, b1 = b - b2;
    if (!has_right && has_left) b1 = b * (2 - h0 / (h0 + h)), a0 -= b * h / (h0 + h);
    if (!has_left && has_right) a1 = a * (2 - h2 / (h + h2)), b2 -= a * h / (h + h2);
    w[0] = has_left ? -a0 / h0 : 0;
    w[3] = has_right ? b2 / h2 : 0;
    w[1] = 2 * u3 - 3 * u2 + 1 - w[0] - (a1 + b1) / h;
    w[2] = 3 * u2 - 2 * u3 - w[3] + (a1 + b1) / h;
}

/* The interval is counted, not searched for: it cannot be predicted. */
static inline Cubic incidence_weights(const PanelReflection *r, float theta)
{
    int i = 0, n = (int)r->steps;
    if (n == 1) return (Cubic){-1, {0, 1, 0, 0}};
    for (int k = 1; k < n - 1; k++) i += r->step[k].theta <= theta;
    float span = r->step[i + 1].theta - r->step[i].theta;
    float u = clampf((theta - r->step[i].theta) / span, 0, 1);
    const float (*of)[4] = r->step_cubic[i];
    Cubic cubic = {.first = i - 1};
    for (int k = 0; k < 4; k++)
        cubic.weight[k] = of[0][k] + u * (of[1][k] + u * (of[2][k] + u * of[3][k]));
    return cubic;
}

/* phi in radians; azimuths repeat after a turn. Linear over fewer than four. */
static Cubic azimuth_weights(const PanelReflection *r, float phi)
{
    int   n = (int)r->azimuths, i = -1;
    float x[4];
    phi -= 2 * PI_F * (float)(int)(phi / (2 * PI_F));
    if (phi < 0) phi += 2 * PI_F;
    while (i + 1 < n && r->azimuth[i + 1] <= phi) i++;
    for (int k = 0; k < 4; k++) {
        int j = i - 1 + k, turn = j < 0 ? -1 : j >= n ? 1 : 0;
        x[k] = j - turn * n >= 0 && j - turn * n < n
                   ? r->azimuth[j - turn * n] + 2 * PI_F * (float)turn : 0;
    }
    float u = clampf((phi - x[1]) / (x[2] - x[1]), 0, 1);
    Cubic cubic = {i - 1, {0, 1 - u, u, 0}};
    if (n >= 4) hermite_weights(x, true, true, u, cubic.weight);
    return cubic;
}

/* Isotropic panels: a table for each incidence, always in the specular-following frame. */
static TableMix isotropic_mix(const PanelReflection *r, const Cubic *incidence)
{
    TableMix mix;
    mix.side[0].count = mix.side[1].count = 0;
    for (int k = 0; k < 4; k++) {
        if (incidence->weight[k] == 0) continue;
        const PanelIncidence *step = &r->step[incidence->first + k];
        Terms *side = &mix.side[step->is_turned];
        side->term[side->count++] = (Term){step->incidence, incidence->weight[k]};
    }
    return mix;
}

/* light: its azimuth in the display's frame. */
static TableMix table_mix(const PanelReflection *r, float theta, float light)
{
    TableMix mix;
    Cubic    incidence = incidence_weights(r, theta);
    int      n = (int)r->azimuths;
    if (n == 1) return isotropic_mix(r, &incidence);
    Cubic azimuth[2] = {azimuth_weights(r, light), azimuth_weights(r, light + PI_F)};
    mix.side[0].count = mix.side[1].count = 0;
    for (int k = 0; k < 4; k++) {
        if (incidence.weight[k] == 0) continue;
        const PanelIncidence *step = &r->step[incidence.first + k];
        const Cubic *around = &azimuth[step->is_turned];
        for (int a = 0; a < 4; a++) {
            if (around->weight[a] == 0) continue;
            int    at = (around->first + a + n) % n;
            bool   turns = step->is_turned && r->frame == PANEL_FRAME_SPECULAR;
            Terms *side = &mix.side[turns];
            side->term[side->count++] = (Term){at * (int)r->incidences + step->incidence,
                                               incidence.weight[k] * around->weight[a]};
        }
    }
    return mix;
}

/* ---- logarithms ------------------------------------------------------------------------ */

/* Eight at a time: what all instruction sets keep in registers. */
typedef float Float8 __attribute__((vector_size(32), aligned(4), may_alias));

/* Weighted rows of the mixed tables at 8 wavelengths from w on. */
static inline Float8 mixed_rows(const PanelReflection *r, const TableMix *mix,
                                const float *rows, int w)
{
    Float8 sum = {0};
    for (int turned = 0; turned < 2; turned++)
        for (int i = 0; i < mix->side[turned].count; i++) {
            const Term *term = &mix->side[turned].term[i];
            sum += term->weight *
                   *(const Float8 *)(rows + term->table * (int)r->padded_wavelengths + w);
        }
    return sum;
}

/* Adds what a component vector of the tree means for the mixed tables: 4 * quads coefficients
 * from k on, quads a constant of 1 to 4 where inlined. Several sums at once: one alone would
 * wait for itself. */
static inline void add_quads(const PanelReflection *r, const Terms *terms,
                             const float *component, int quads, int k, float *coefficient)
{
    int          stride = (int)r->padded_coefficients, n = (int)r->components;
    PanelFloat4 *to = (PanelFloat4 *)(coefficient + k);
    for (int i = 0; i < terms->count; i++) {
        const Term  *term = &terms->term[i];
        const float *row = r->loading + term->table * n * stride + k;
        PanelFloat4  s0 = {0}, s1 = {0}, s2 = {0}, s3 = {0};
        for (int c = 0; c < n; c++, row += stride) {
            const PanelFloat4 *from = (const PanelFloat4 *)row;
            s0 += component[c] * from[0];
            if (quads > 1) s1 += component[c] * from[1];
            if (quads > 2) s2 += component[c] * from[2];
            if (quads > 3) s3 += component[c] * from[3];
        }
        to[0] += term->weight * s0;
        if (quads > 1) to[1] += term->weight * s1;
        if (quads > 2) to[2] += term->weight * s2;
        if (quads > 3) to[3] += term->weight * s3;
    }
}

static inline void add_loadings(const PanelReflection *r, const Terms *terms,
                                const float *component, float *coefficient)
{
    int k = 0, padded = (int)r->padded_coefficients;
    for (; k + 16 <= padded; k += 16) add_quads(r, terms, component, 4, k, coefficient);
    if (padded - k == 12) add_quads(r, terms, component, 3, k, coefficient);
    if (padded - k == 8) add_quads(r, terms, component, 2, k, coefficient);
    if (padded - k == 4) add_quads(r, terms, component, 1, k, coefficient);
}

/* Values at the lanes, linear between measured wavelengths. */
static inline Spectrum spread(const float *value, const PanelLanes *lanes)
{
    Spectrum low, high;
    if (lanes->has_one) return spectrum_all(value[0]);
    spectrum_neighbours(value, lanes->interval, &low, &high);
    return low + (high - low) * lanes->t;
}

/* Rows a and b of padded_wavelengths floats, t from the first to the second. */
static Spectrum spread_between(const Panel *panel, const float *rows, int first, float t,
                               const PanelLanes *lanes)
{
    int          padded = (int)panel->reflection->padded_wavelengths;
    const float *a = rows + first * padded, *b = t > 0 ? a + padded : a;
    Spectrum     low = spread(a, lanes), high = spread(b, lanes);
    return low + (high - low) * spectrum_all(t);
}

/* Mixes rows that are not at the lanes yet before they go there. */
static Spectrum mixed_at_lanes(const PanelReflection *r, const TableMix *mix,
                               const float *rows, const PanelLanes *lanes)
{
    float row[PADDED_MAX];
    for (int w = 0; w < (int)r->padded_wavelengths; w += 8)
        *(Float8 *)(row + w) = mixed_rows(r, mix, rows, w);
    return spread(row, lanes);
}

/* ln (f / F) at the lanes. */
static Spectrum reflection_logs(const Panel *panel, Vec3 stored, const TableMix *mix,
                                const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    float    component[COMPONENTS_MAX], coefficient[COEFFICIENTS_MAX];
    Spectrum logs;
    if (!lanes->has_means) logs = mixed_at_lanes(r, mix, r->mean, lanes);
    for (int k = 0; k < (int)r->padded_coefficients; k++) coefficient[k] = 0;
    for (int turned = 0; turned < 2; turned++) {
        if (!mix->side[turned].count) continue;
        Vec3 at = turned ? vec3(-stored.x, -stored.y, stored.z) : stored;
        tree_interpolate(&panel->reflection_tree, at, component);
        add_loadings(r, &mix->side[turned], component, coefficient);
    }
    for (int i = 0; i < SPECTRUM_LANES; i += 8) {
        Float8 sum = {0};
        if (!lanes->has_means) sum = *(const Float8 *)((const float *)&logs + i);
        for (int turned = 0; turned < 2 && lanes->has_means; turned++)
            for (int j = 0; j < mix->side[turned].count; j++) {
                const Term *term = &mix->side[turned].term[j];
                sum += term->weight *
                       *(const Float8 *)((const float *)&lanes->mean[term->table] + i);
            }
        for (int k = 0; k < (int)r->coefficients; k++)
            sum += coefficient[k] * *(const Float8 *)((const float *)&lanes->basis[k] + i);
        *(Float8 *)((float *)&logs + i) = sum;
    }
    return logs;
}

/* ---- the narrow lobe ------------------------------------------------------------------- */

/* Squared angle between a local direction (light at azimuth 180) and the mirror direction; the
 * chord stands for the angle up to the third order, and the series adds the next one. */
static float squared_angle(Vec3 local, float sin_theta, float cos_theta)
{
    float x = local.x - sin_theta, y = local.y, z = local.z - cos_theta;
    float chord = x * x + y * y + z * z;
    return chord * (1 + chord * (1.0f / 12));
}

static float mixed_sigma(const PanelReflection *r, const TableMix *mix)
{
    float sum = 0;
    for (int turned = 0; turned < 2; turned++)
        for (int i = 0; i < mix->side[turned].count; i++) {
            const Term *term = &mix->side[turned].term[i];
            sum += term->weight * r->lobe_sigma[term->table];
        }
    return sum > 1e-4f ? sum : 1e-4f;
}

/* The lobe over F: R / F G(angle) / cos theta_i. */
static Spectrum lobe_over_fresnel(const Panel *panel, const TableMix *mix, Vec3 local, Vec3 wi,
                                  const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    float sine = safe_sqrtf(1 - wi.z * wi.z), sigma = mixed_sigma(r, mix);
    float square = squared_angle(local, sine, wi.z), inverse = 1 / (sigma * sigma);
    if (square * inverse > LOBE_SIGMAS * LOBE_SIGMAS) return spectrum_all(0);
    Spectrum logs = mixed_at_lanes(r, mix, r->lobe, lanes);
    float cosine = wi.z > 0.02f ? wi.z : 0.02f;
    float shape = exp_f(-0.5f * square * inverse) * inverse / (2 * PI_F * cosine);
    return spectrum_exp(logs) * spectrum_all(shape);
}

/* ---- beyond the last measured incidence ------------------------------------------------- */

/* Where the last measured incidence is read for one beyond it, by the invariance of scatter
 * from surfaces of low slope (Harvey): in the projection on the panel's plane the haze only
 * moves. Directions that come to lie outside the measured cone are held at its edge. */
static Vec3 shifted(const PanelReflection *r, Vec3 local, float sin_theta)
{
    float sine_last, cosine_last;
    sincos_turns(r->last_theta * (0.5f / PI_F), &sine_last, &cosine_last);
    float x = local.x - sin_theta + sine_last, y = local.y;
    float edge = safe_sqrtf(1 - r->cone_cos * r->cone_cos), length = safe_sqrtf(x * x + y * y);
    if (length > edge) x *= edge / length, y *= edge / length;
    return vec3(x, y, safe_sqrtf(1 - x * x - y * y));
}

static Spectrum mirror_at(const Panel *panel, float cos_theta, const PanelLanes *lanes)
{
    float t;
    int   node = panel_angle_node(acos_f(cos_theta), &t);
    return spread_between(panel, panel->reflection->mirror, node, t, lanes);
}

/* Reflectance of the glossy surface: the mirror part's where there is one (the coating is the
 * same), Fresnel's otherwise. Up to a constant. */
static Spectrum gloss(const Panel *panel, float cosine, const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    if (!r->has_mirror) return spectrum_all(fresnel_unpolarised(cosine, r->beyond_index));
    if (!(cosine > 0)) return spectrum_all(1e-6f);
    return spectrum_max(mirror_at(panel, cosine, lanes), spectrum_all(1e-6f));
}

static Spectrum spectrum_root(Spectrum a)
{
    Spectrum root;
    for (int i = 0; i < SPECTRUM_LANES; i++) root[i] = safe_sqrtf(a[i]);
    return root;
}

/* Factor that conserves energy at an incidence beyond the measured ones. */
static Spectrum held_factor(const Panel *panel, float theta, const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    int i = 0;
    if (r->nodes < 2) return spectrum_all(1);
    while (i + 2 < (int)r->nodes && r->node_theta[i + 1] <= theta) i++;
    float t = (theta - r->node_theta[i]) / (r->node_theta[i + 1] - r->node_theta[i]);
    return spread_between(panel, r->held, i, clampf(t, 0, 1), lanes);
}

/* Two directions as one question. local: wo in the frame of panel_turned. */
typedef struct PanelPair {
    Vec3  wi, wo, local;
    float theta; /* of wi */
} PanelPair;

static Vec3 stored_at(const PanelReflection *r, const PanelPair *pair)
{
    if (r->frame != PANEL_FRAME_SPECULAR)
        return surface_frame_stored(&r->surface, pair->wi, pair->wo);
    SpecularFrame frame = specular_frame(pair->theta, r->frame_exponent);
    return specular_frame_stored(&frame, pair->local);
}

static float reference_at(const PanelReflection *r, const PanelPair *pair)
{
    if (r->frame != PANEL_FRAME_SPECULAR)
        return panel_reference(r->frame, r->refractive_index, pair->wi, pair->wo);
    return fresnel_unpolarised(pair->wi.z, r->refractive_index);
}

/* Where surfaces of facets are read: the same facet under light from the last incidence. What
 * comes to lie outside the measured cone is held at its edge, unless it lay there already. */
static Vec3 same_facet(const PanelReflection *r, const PanelPair *pair, Vec3 last_light)
{
    float sine = safe_sqrtf(1 - pair->wi.z * pair->wi.z);
    Vec3  d = surface_frame_same_facet(vec3(-sine, 0, pair->wi.z), pair->local, last_light);
    float least = pair->local.z < r->cone_cos ? pair->local.z : r->cone_cos;
    float across = safe_sqrtf(d.x * d.x + d.y * d.y);
    if (d.z >= least || !(across > 0)) return d;
    float scale = safe_sqrtf(1 - least * least) / across;
    return vec3(d.x * scale, d.y * scale, least);
}

static PanelPair last_pair(const PanelReflection *r, const PanelPair *pair)
{
    float sine, cosine;
    sincos_turns(r->last_theta * (0.5f / PI_F), &sine, &cosine);
    Vec3 light = vec3(-sine, 0, cosine);
    Vec3 from = r->beyond == PANEL_BEYOND_SLOPES
                    ? same_facet(r, pair, light)
                    : shifted(r, pair->local, safe_sqrtf(1 - pair->wi.z * pair->wi.z));
    return (PanelPair){panel_turned_back(pair->wi, light), panel_turned_back(pair->wi, from),
                       from, r->last_theta};
}

/* The haze's height over that where it was read. For fine roughness the root of the surface's
 * reflectances at theta_i and theta_o; for facets their reflectance and G / (cos cos). */
static Spectrum haze_ratio(const Panel *panel, const PanelPair *now, const PanelPair *then,
                           const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    if (r->beyond != PANEL_BEYOND_SLOPES) {
        Spectrum here = gloss(panel, now->wi.z, lanes) * gloss(panel, now->local.z, lanes);
        return spectrum_root(here / (lanes->last_gloss * gloss(panel, then->local.z, lanes)));
    }
    float masking = panel_masking(r->roughness, now->wi, now->wo) /
                    panel_masking(r->roughness, then->wi, then->wo);
    return gloss(panel, panel_facet_cosine(now->wi, now->wo), lanes) /
           gloss(panel, panel_facet_cosine(then->wi, then->wo), lanes) *
           spectrum_all(masking);
}

/* The row of the table that counts most: at the last incidence weights that ought to be 0 may
 * be some rounding. */
static int main_row(const PanelReflection *r, const TableMix *mix)
{
    const Terms *terms = &mix->side[0];
    int          best = 0;
    for (int i = 1; i < terms->count; i++)
        if (terms->term[i].weight > terms->term[best].weight) best = i;
    return terms->term[best].table * (int)r->padded_wavelengths;
}

/* The haze moves and changes its height, the lambertian part follows the light that enters. */
static Spectrum brdf_beyond(const Panel *panel, const PanelPair *pair, float light,
                            const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    float         n = r->refractive_index;
    PanelPair     from = last_pair(r, pair);
    TableMix mix = table_mix(r, r->last_theta, light);
    Spectrum logs = reflection_logs(panel, stored_at(r, &from), &mix, lanes);
    float    last = fresnel_unpolarised(from.wi.z, n);
    Spectrum total = spectrum_exp(logs) * spectrum_all(reference_at(r, &from));
    int      row = main_row(r, &mix);
    Spectrum lambertian = spectrum_min(total, spread(r->lambertian + row, lanes));
    float    entering = (1 - fresnel_unpolarised(pair->wi.z, n)) / (1 - last);
    Spectrum haze = (total - lambertian) * haze_ratio(panel, pair, &from, lanes) +
                    lambertian * spectrum_all(entering);
    if (r->has_lobe)
        haze += lobe_over_fresnel(panel, &mix, pair->local, pair->wi, lanes) *
                (gloss(panel, pair->wi.z, lanes) / lanes->last_gloss) *
                spectrum_all(last);
    return haze * held_factor(panel, pair->theta, lanes);
}

/* ---- the lambertian part ---------------------------------------------------------------- */

/* As brdf_beyond has it. */
static Spectrum lambertian_beyond(const Panel *panel, float theta, float cos_theta, float light,
                                  const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    float    sine, cosine, n = r->refractive_index;
    TableMix mix = table_mix(r, r->last_theta, light);
    int      row = main_row(r, &mix);
    sincos_turns(r->last_theta * (0.5f / PI_F), &sine, &cosine);
    float entering = (1 - fresnel_unpolarised(cos_theta, n)) /
                     (1 - fresnel_unpolarised(cosine, n));
    return spread(r->lambertian + row, lanes) * spectrum_all(entering) *
           held_factor(panel, theta, lanes);
}

/* ---- the queries ------------------------------------------------------------------------ */

static void find_lanes(const Panel *panel, const Wavelengths *wavelengths, PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    Spectrum nm = spectrum_clamp(wavelengths->nm, SPECTRAL_FIRST_NM, SPECTRAL_LAST_NM);
    SpectrumMask whole =
        __builtin_convertvector(nm - spectrum_all(SPECTRAL_FIRST_NM), SpectrumMask);
    float from[SPECTRUM_LANES], scale[SPECTRUM_LANES];
    Spectrum begin, inverse;
    lanes->has_one = r->wavelengths == 1;
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

void panel_lanes(const Panel *panel, const Wavelengths *wavelengths, PanelLanes *out)
{
    const PanelReflection *r = panel->reflection;
    if (!r) return;
    int padded = (int)r->padded_wavelengths;
    find_lanes(panel, wavelengths, out);
    for (int k = 0; k < (int)r->coefficients; k++)
        out->basis[k] = spread(r->basis + k * padded, out);
    out->has_means = r->tables <= PANEL_LANES_TABLES;
    for (int t = 0; out->has_means && t < (int)r->tables; t++)
        out->mean[t] = spread(r->mean + t * padded, out);
    float sine, cosine;
    sincos_turns(r->last_theta * (0.5f / PI_F), &sine, &cosine);
    out->last_gloss = gloss(panel, cosine, out);
}

Spectrum panel_brdf_at(const Panel *panel, Vec3 wo, Vec3 wi, const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    if (!r || !(wo.z > 0) || !(wi.z > 0)) return spectrum_all(0);
    PanelPair pair = {wi, wo, panel_turned(wi, wo), panel_polar_angle(wi)};
    float light = r->azimuths > 1 ? atan2_f(wi.y, wi.x) : 0;
    if (pair.theta > r->last_theta) return brdf_beyond(panel, &pair, light, lanes);
    TableMix mix = table_mix(r, pair.theta, light);
    Spectrum over = spectrum_exp(reflection_logs(panel, stored_at(r, &pair), &mix, lanes));
    float    reference = reference_at(r, &pair);
    if (r->has_lobe) {
        float fresnel = fresnel_unpolarised(wi.z, r->refractive_index);
        over += lobe_over_fresnel(panel, &mix, pair.local, wi, lanes) *
                spectrum_all(fresnel / reference);
    }
    return over * spectrum_all(reference);
}

Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths)
{
    PanelLanes lanes;
    if (!panel->reflection || !(wo.z > 0) || !(wi.z > 0)) return spectrum_all(0);
    panel_lanes(panel, wavelengths, &lanes);
    return panel_brdf_at(panel, wo, wi, &lanes);
}

Spectrum panel_lambertian_at(const Panel *panel, Spectrum brdf, Vec3 wi,
                             const PanelLanes *lanes)
{
    const PanelReflection *r = panel->reflection;
    if (!r || !(wi.z > 0)) return spectrum_all(0);
    float theta = panel_polar_angle(wi), light = r->azimuths > 1 ? atan2_f(wi.y, wi.x) : 0;
    if (theta > r->last_theta)
        return spectrum_min(brdf, lambertian_beyond(panel, theta, wi.z, light, lanes));
    TableMix mix = table_mix(r, theta, light);
    return spectrum_min(brdf,
                        spectrum_exp(mixed_at_lanes(r, &mix, r->lambertian_log, lanes)));
}

Spectrum panel_mirror_at(const Panel *panel, float cos_theta, const PanelLanes *lanes)
{
    if (!panel->reflection || !panel->reflection->has_mirror || !(cos_theta > 0))
        return spectrum_all(0);
    return mirror_at(panel, cos_theta, lanes);
}

Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths)
{
    PanelLanes lanes;
    if (!panel->reflection || !panel->reflection->has_mirror || !(cos_theta > 0))
        return spectrum_all(0);
    find_lanes(panel, wavelengths, &lanes);
    return mirror_at(panel, cos_theta, &lanes);
}

float panel_haze_albedo(const Panel *panel, float cos_theta)
{
    float t;
    if (!panel->reflection || !(cos_theta > 0)) return 0;
    int node = panel_angle_node(acos_f(cos_theta), &t);
    const float *albedo = panel->reflection->haze_albedo;
    return lerpf(albedo[node], albedo[node + 1], t);
}
