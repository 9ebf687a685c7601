/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: runs at every vertex of a path. No allocation, no lock, no libm. */
#include "guide/guide.h"
#include "base/mathf.h"

/* How far below its horizon a surface still takes a bin's middle for lit: half of its width. */
#define HORIZON 0.1f

uint32_t guide_cell_at(const LightGuide *guide, Vec3 position) {
    const float at[3] = {position.x, position.y, position.z};
    uint32_t node = 0;
    while (guide->nodes[node].child) {
        const GuideNode *inner = &guide->nodes[node];
        node = inner->child + (at[inner->axis] >= inner->plane);
    }
    return guide->nodes[node].cell;
}

/* (1 - c)^5 of Schlick's Fresnel curve, approximated from c^2 without a root. */
static inline Spectrum grazing(Spectrum cosine2) {
    Spectrum rest = spectrum_all(1) - cosine2;
    rest *= rest;
    rest *= rest;
    rest *= rest;
    return rest * rest;
}

/* Radiance through each bin times f cos: Lambert's, and GGX with Schlick's shadowing. For unit
 * directions the half vector needs no root: (n.h)^2 = (n.wo + n.wi)^2 / (2 + 2 wo.wi); by one
 * division, 1 - (n.h)^2 (1 - alpha^2) is wide / both2. */
void guide_view(const LightGuide *guide, uint32_t cell, const GuideSurface *surface,
                GuideView *view) {
    const GuideCell *from = &guide->cells[cell];
    Vec3 n = surface->ns, wo = surface->wo;
    float n_wo = max_f(vec3_dot(n, wo), 0), alpha2 = surface->alpha * surface->alpha;
    float k = 0.5f * surface->alpha;
    float scale = 0.25f * alpha2 / (n_wo * (1 - k) + k + 1e-6f);
    Spectrum one = spectrum_all(1), none = spectrum_all(0), column[GUIDE_AIMS] = {none, none};
    for (int aim = 0; aim < GUIDE_AIMS; aim++) view->towards[aim].sum = 0;
    if (!(from->is_lit > 0)) return;
    for (int row = 0; row < GUIDE_SIDE; row++) {
        Spectrum x = guide->bin[0][row], y = guide->bin[1][row], z = guide->bin[2][row];
        Spectrum n_wi = spectrum_all(n.x) * x + spectrum_all(n.y) * y + spectrum_all(n.z) * z;
        Spectrum lit = spectrum_max(n_wi + spectrum_all(HORIZON), none);
        Spectrum towards = spectrum_all(wo.x) * x + spectrum_all(wo.y) * y + spectrum_all(wo.z) * z;
        Spectrum share = spectrum_all(surface->diffuse);
        if (surface->f90 > 0) {
            Spectrum facing2 =
                spectrum_max((one + towards) * spectrum_all(0.5f), spectrum_all(1e-4f));
            Spectrum both = n_wi + spectrum_all(n_wo), both2 = spectrum_all(4) * facing2;
            Spectrum upright = spectrum_min(both * both, both2);
            Spectrum wide = both2 - upright * spectrum_all(1 - alpha2);
            Spectrum fresnel = spectrum_all(surface->f0) +
                               spectrum_all(surface->f90 - surface->f0) * grazing(facing2);
            share += spectrum_all(scale) * fresnel * both2 * both2 /
                     (wide * wide * (lit * spectrum_all(1 - k) + spectrum_all(k)));
        }
        share *= lit;
        for (int aim = 0; aim < GUIDE_AIMS; aim++) {
            Spectrum weight = __builtin_convertvector(from->light[aim][row], Spectrum) * share;
            view->towards[aim].weight[row] = weight;
            column[aim] += weight;
        }
    }
    for (int aim = 0; aim < GUIDE_AIMS; aim++) {
        view->towards[aim].column = column[aim];
        view->towards[aim].sum = spectrum_sum(column[aim]);
    }
}

/* The lower half of the map turned up into its corners, and back. */
static Vec2 folded(float u, float v) {
    return (Vec2){(1 - fabsf(v)) * (u < 0 ? -1.0f : 1.0f), (1 - fabsf(u)) * (v < 0 ? -1.0f : 1.0f)};
}

/* Square of the map for a unit direction, each coordinate in [0, GUIDE_SIDE]. */
static Vec2 map_of(Vec3 d, float *taxicab) {
    float l1 = fabsf(d.x) + fabsf(d.y) + fabsf(d.z);
    Vec2 at = {d.x / l1, d.y / l1};
    *taxicab = l1;
    if (d.z < 0) at = folded(at.x, at.y);
    return (Vec2){(at.x + 1) * (0.5f * GUIDE_SIDE), (at.y + 1) * (0.5f * GUIDE_SIDE)};
}

static int square(float at) {
    int i = (int)at;
    return i < GUIDE_SIDE ? i : GUIDE_SIDE - 1;
}

static Vec3 direction_at(float x, float y) {
    Vec2 at = {x * (2.0f / GUIDE_SIDE) - 1, y * (2.0f / GUIDE_SIDE) - 1};
    float z = 1 - fabsf(at.x) - fabsf(at.y);
    if (z < 0) at = folded(at.x, at.y);
    return vec3_normalize(vec3(at.x, at.y, z));
}

Vec3 guide_bin_direction(int bin, float u0, float u1) {
    return direction_at((float)(bin % GUIDE_SIDE) + u0, (float)(bin / GUIDE_SIDE) + u1);
}

void guide_place_bins(LightGuide *guide) {
    for (int i = 0; i < GUIDE_BINS; i++) {
        Vec3 d = guide_bin_direction(i, 0.5f, 0.5f);
        guide->bin[0][i / GUIDE_SIDE][i % GUIDE_SIDE] = d.x;
        guide->bin[1][i / GUIDE_SIDE][i % GUIDE_SIDE] = d.y;
        guide->bin[2][i / GUIDE_SIDE][i % GUIDE_SIDE] = d.z;
    }
}

float guide_pdf(const GuideChoice *choice, Vec3 wi) {
    float taxicab;
    Vec2 at = map_of(wi, &taxicab);
    float area = choice->sum * (4.0f / GUIDE_BINS);
    return choice->weight[square(at.y)][square(at.x)] / (area * taxicab * taxicab * taxicab);
}

/* Which of the 16 weights of sum `sum` u falls on; *rest: where in it, [0, 1). */
static int choose(const float weight[GUIDE_SIDE], float sum, float u, float *rest) {
    float left = u * sum;
    int last = 0;
    for (int i = 0; i < GUIDE_SIDE; i++) {
        if (!(weight[i] > 0)) continue;
        if (left < weight[i]) {
            *rest = min_f(left / weight[i], 0x1.fffffep-1f);
            return i;
        }
        left -= weight[i];
        last = i;
    }
    *rest = 0x1.fffffep-1f; /* rounding */
    return last;
}

Vec3 guide_sample(const GuideChoice *choice, float u0, float u1) {
    float weight[GUIDE_SIDE], at_x, at_y;
    for (int i = 0; i < GUIDE_SIDE; i++) weight[i] = choice->column[i];
    int x = choose(weight, choice->sum, u0, &at_x);
    for (int i = 0; i < GUIDE_SIDE; i++) weight[i] = choice->weight[i][x];
    int y = choose(weight, choice->column[x], u1, &at_y);
    return direction_at((float)x + at_x, (float)y + at_y);
}
