/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/sheen.h"

#include "base/mathf.h"
#include "base/units.h"

/* The fit of Estevez and Kulla for alpha 1 and 0; between them it goes by (1 - alpha)^2. */
static const float FIT[5][2] = {{21.5473f, 25.3245f},
                                {3.82987f, 3.32435f},
                                {0.19823f, 0.16801f},
                                {-1.97760f, -1.27393f},
                                {-4.32054f, -4.85967f}};

static float fitted(const float p[5], float x) {
    return p[0] / (1 + p[1] * pow_f(x, p[2])) + p[3] * x + p[4];
}

static float shadowing(const float p[5], float cosine) {
    if (cosine < 0.5f) return exp_f(fitted(p, cosine));
    return exp_f(2 * fitted(p, 0.5f) - fitted(p, 1 - cosine));
}

float sheen_lobe_full(Vec3 wo, Vec3 wi, float alpha) {
    if (!(wo.z > 0 && wi.z > 0)) return 0;
    Vec3 half = vec3_normalize(vec3_add(wo, wi));
    float sine2 = half.x * half.x + half.y * half.y, sharp = 1 / alpha, p[5];
    float along = (1 - alpha) * (1 - alpha);
    for (int i = 0; i < 5; i++) p[i] = lerpf(FIT[i][0], FIT[i][1], along);
    float d = (2 + sharp) * pow_f(sine2, 0.5f * sharp) * (0.5f * INV_PI_F);
    return d / (4 * wo.z * wi.z * (1 + shadowing(p, wo.z) + shadowing(p, wi.z)));
}

/* ---- the table -------------------------------------------------------------------------- */

static EnergyKnot roughness_knot(float alpha, int count) {
    float place = (sqrtf(sqrtf(alpha)) - SHEEN_LEAST) / (1 - SHEEN_LEAST);
    return energy_knot(place * (float)(count - 1), count);
}

static EnergyKnot base_knot(float base) {
    return energy_alpha_knot(base, (SHEEN_BASES - 1) / ENERGY_OCTAVES);
}

/* ---- albedo: cubic, with Catmull and Rom's slopes --------------------------------------- */

/* Between p[1] and p[2]. */
static float cubic(const float p[4], float t) {
    float a = p[3] - p[0] + 3 * (p[1] - p[2]), b = 2 * p[0] - 5 * p[1] + 4 * p[2] - p[3];
    return p[1] + 0.5f * t * (p[2] - p[0] + t * (b + t * a));
}

/* The four values about a knot; beyond the ends as a straight line goes. */
static float cubic_along(const float *values, int count, EnergyKnot knot) {
    const float *v = values + knot.low;
    float before = knot.low > 0 ? v[-1] : 2 * v[0] - v[1];
    float after = knot.low < count - 2 ? v[2] : 2 * v[1] - v[0];
    return cubic((float[4]){before, v[0], v[1], after}, knot.t);
}

static float look_up(const float table[SHEEN_ROUGHNESSES][SHEEN_COSINES], float cosine,
                     float alpha) {
    EnergyKnot r = roughness_knot(alpha, SHEEN_ROUGHNESSES);
    EnergyKnot c = energy_cosine_knot(cosine, SHEEN_COSINES);
    int first = r.low > 0 ? r.low - 1 : 0;
    int last = r.low + 2 < SHEEN_ROUGHNESSES ? r.low + 2 : SHEEN_ROUGHNESSES - 1;
    float row[4];
    for (int i = first; i <= last; i++) row[i - first] = cubic_along(table[i], SHEEN_COSINES, c);
    return max_f(cubic_along(row, last - first + 1, (EnergyKnot){r.low - first, r.t}), 0);
}

float sheen_albedo(const SheenTable *table, float cosine, float alpha) {
    return min_f(look_up(table->albedo, cosine, alpha), 1);
}

float sheen_lobe(const SheenTable *table, Vec3 wo, Vec3 wi, float alpha) {
    float lobe = sheen_lobe_full(wo, wi, alpha);
    if (!(lobe > 0)) return 0;
    float most = max_f(look_up(table->full, wo.z, alpha), look_up(table->full, wi.z, alpha));
    return lobe / max_f(most, 1);
}

/* ---- facets beneath --------------------------------------------------------------------- */

static Energy excess_at(const Energy rows[SHEEN_BASES][SHEEN_WIDE], EnergyKnot b, EnergyKnot c) {
    return energy_between(rows[b.low] + c.low, SHEEN_WIDE, b.t, c.t);
}

OverlayShare sheen_share(const SheenTable *table, float cosine, float alpha, float base) {
    EnergyKnot r = roughness_knot(alpha, SHEEN_BROAD), b = base_knot(base);
    EnergyKnot c = energy_cosine_knot(cosine, SHEEN_WIDE);
    Energy excess = energy_mix(excess_at(table->excess[r.low], b, c),
                               excess_at(table->excess[r.low + 1], b, c), r.t);
    float albedo = sheen_albedo(table, cosine, alpha);
    return (OverlayShare){albedo, min_f(albedo + excess.all, 1), min_f(albedo + excess.shape, 1)};
}

OverlayShare sheen_mean(const SheenTable *table, float alpha, float base) {
    EnergyKnot r = roughness_knot(alpha, SHEEN_BROAD), b = base_knot(base);
    Energy mean = energy_between(table->mean[r.low] + b.low, SHEEN_BASES, r.t, b.t);
    float albedo = lerpf(table->mean_albedo[r.low], table->mean_albedo[r.low + 1], r.t);
    return (OverlayShare){albedo, mean.all, mean.shape};
}

static float open_at(const float rows[SHEEN_BASES][SHEEN_WIDE], EnergyKnot k, EnergyKnot c) {
    const float *low = rows[k.low] + c.low, *high = low + SHEEN_WIDE;
    return lerpf(lerpf(low[0], low[1], c.t), lerpf(high[0], high[1], c.t), k.t);
}

float sheen_open(const SheenTable *table, float cosine, float alpha, float coat_alpha) {
    EnergyKnot r = roughness_knot(alpha, SHEEN_BROAD), k = base_knot(coat_alpha);
    EnergyKnot c = energy_cosine_knot(cosine, SHEEN_WIDE);
    return lerpf(open_at(table->open[r.low], k, c), open_at(table->open[r.low + 1], k, c), r.t);
}
