/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: choosing a point of an emitter. No allocation, no lock, no libm. */
#include "light/emitters.h"

#include "light/branch_choice.h"
#include "light/solid_angle.h"

#define BLIND_SHARE 0.1f     /* of the choices that go by power alone among what can be seen */
#define NEAR_SPREAD 4.0f     /* of the mean square extent */
#define LOOSE 0.25f          /* intensity over power of what faces all ways: a sphere's */
#define NOT_QUITE_FLAT 3e-3f /* of the distance: by which a flat branch's normals may differ */
#define LEAST_ANGLE 1e-3f    /* sr: cells seen edge on are chosen by area */

static Spectrum spectrum_load(const float from[SPECTRUM_LANES]) {
    Spectrum value;
    memcpy(&value, from, sizeof value);
    return value;
}

static void spectrum_store(Spectrum value, float to[SPECTRUM_LANES]) {
    memcpy(to, &value, sizeof value);
}

static Spectrum roots(Spectrum squares) {
    float value[SPECTRUM_LANES];
    spectrum_store(squares, value);
    for (int i = 0; i < SPECTRUM_LANES; i++) value[i] = sqrtf(value[i]);
    return spectrum_load(value);
}

static Spectrum absolute(Spectrum a) {
    return spectrum_max(a, -a);
}

static Spectrum dot(const Spectrum a[3], const Spectrum b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* ---- cells ------------------------------------------------------------------------------- */

static uint32_t cell_at(const Emitter *emitter, float u, float v) {
    int side = emitter->side, i = (int)(u * (float)side), j = (int)(v * (float)side);
    i = i > side - 1 ? side - 1 : i < 0 ? 0 : i;
    j = j > side - 1 - i ? side - 1 - i : j < 0 ? 0 : j;
    float over = u * (float)side - (float)i + v * (float)side - (float)j;
    bool is_turned = over > 1 && i + j < side - 1;
    return emitter->first_cell + (uint32_t)(2 * side * i - i * i + 2 * j + is_turned);
}

/* Barycentric weights a, b of a cell's own corners 1 and 2 as those of its triangle. */
static EmitterPoint point_of_cell(const Emitter *emitter, const EmitterCell *at, float a, float b) {
    float step = 1 / (float)at->side;
    if (at->is_turned) {
        a = 1 - a;
        b = 1 - b;
    }
    return (EmitterPoint){emitter->triangle, ((float)at->i + a) * step, ((float)at->j + b) * step};
}

/* The cell's corners, seen from `from`. False: it looks small, or is seen edge on. */
static bool looks_large(const Emitter *emitter, const EmitterCell *at, const Scene *scene,
                        Vec3 from, SolidAngle *seen) {
    uint32_t t = emitter->triangle;
    Vec3 first = scene_corner(scene, t, 0), origin = vec3_sub(first, from);
    Vec3 along_u = vec3_sub(scene_corner(scene, t, 1), first);
    Vec3 along_v = vec3_sub(scene_corner(scene, t, 2), first);
    Vec3 corner[3], middle = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        EmitterPoint p = point_of_cell(emitter, at, k == 1, k == 2);
        corner[k] = vec3_along(vec3_along(origin, along_u, p.u), along_v, p.v);
        middle = vec3_along(middle, corner[k], 1 / 3.0f);
    }
    if (emitter->cell_area < EMITTER_LARGE * vec3_dot(middle, middle)) return false;
    *seen = solid_angle_of(corner);
    return seen->value > LEAST_ANGLE;
}

/* ---- which branch ------------------------------------------------------------------------ */

/* Bilinear at column s, row t. */
static float profile_at(const EmitterProfile *profile, float s, float t) {
    unsigned i = (unsigned)(int)s, j = (unsigned)(int)t;
    i = i < EMITTER_PROFILE_SIDE - 2 ? i : EMITTER_PROFILE_SIDE - 2;
    j = j < EMITTER_PROFILE_SIDE - 2 ? j : EMITTER_PROFILE_SIDE - 2;
    const float *row = profile->value + j * EMITTER_PROFILE_SIDE + i;
    const float *next = row + EMITTER_PROFILE_SIDE;
    float a = s - (float)(int)i, b = t - (float)(int)j;
    float near = row[0] + a * (row[1] - row[0]), far = next[0] + a * (next[1] - next[0]);
    return near + b * (far - near);
}

/* Replaces the cosine of displays by their profile in the direction (x, y, z) of the branch's
 * frame, of any length, z above 0. Bilinear in the turned octahedral map: along the diagonals
 * x + y and x - y of the diamond that the upper half of an octahedron is, seen from above. */
static Spectrum with_profiles(const EmitterNode *node, const Spectrum d[3], Spectrum z,
                              Spectrum cosine) {
    const float middle = 0.5f * (EMITTER_PROFILE_SIDE - 1);
    Spectrum x = dot(node->axis[0], d), y = dot(node->axis[1], d);
    Spectrum sum = absolute(x) + absolute(y) + spectrum_max(z, spectrum_all(0));
    Spectrum scale = spectrum_all(middle) / (sum + spectrum_all(1e-30f));
    float s[EMITTER_BRANCHES], t[EMITTER_BRANCHES], value[EMITTER_BRANCHES];
    SpectrumMask front = spectrum_above(z, spectrum_all(0));
    spectrum_store(spectrum_all(middle) + (x + y) * scale, s);
    spectrum_store(spectrum_all(middle) + (x - y) * scale, t);
    spectrum_store(cosine, value);
    for (int k = 0; k < node->count; k++)
        if (node->profile[k]) value[k] = front[k] ? profile_at(node->profile[k], s[k], t[k]) : 0;
    return spectrum_load(value);
}

/* A distance above a plane, seen from cells spread about it: from near it never vanishes. */
static Spectrum softened(Spectrum height, Spectrum spread2) {
    return spectrum_all(0.5f) *
           (height + roots(height * height + spectrum_all(NEAR_SPREAD) * spread2));
}

/* An estimate of what the branches send towards `from`, intensity over power. From near, where
 * cells are seen under all angles, and for cells that face different ways, directions count
 * less. d: from the centres; inverse: of that distance; near: 0 (distant) to 1. */
static Spectrum facing(const EmitterNode *node, const Spectrum d[3], Spectrum inverse,
                       Spectrum near) {
    Spectrum z = dot(node->axis[2], d);
    z = spectrum_select(node->both_sides, absolute(z), z);
    Spectrum cosine = softened(z, node->spread2) * inverse;
    if (node->has_displays)
        cosine += (with_profiles(node, d, z, cosine) - cosine) * (spectrum_all(1) - near);
    return cosine * node->focus + spectrum_all(LOOSE) * (spectrum_all(1) - node->focus);
}

/* Branches of one cell that looks large: their light is known better. */
static void weigh_large(const Emitters *emitters, const Scene *scene, const EmitterNode *node,
                        Vec3 from, SpectrumMask large, Spectrum *facing) {
    for (int i = 0; i < node->count; i++) {
        if (!large[i]) continue;
        EmitterChoice only = emitters->by_rank[node->first[i]];
        const Emitter *e = &emitters->emitters[only.emitter];
        EmitterCell at = emitter_cell(e, only.cell);
        SolidAngle seen;
        if (looks_large(e, &at, scene, from, &seen)) (*facing)[i] = seen.value / e->cell_area;
    }
}

/* The probability of every branch. It follows about the illuminance that the branch gives the
 * lit point's plane (that of a disc right before it is power / (distance^2 + radius^2), whose
 * mean square extent is half of radius^2); none goes to branches that lie below its horizon, or
 * behind which it lies. */
static Spectrum weigh(const Emitters *emitters, const Scene *scene, const EmitterNode *node,
                      const LitPoint *from) {
    const Spectrum zero = spectrum_all(0);
    const Spectrum d[3] = {spectrum_all(from->position.x) - node->centre[0],
                           spectrum_all(from->position.y) - node->centre[1],
                           spectrum_all(from->position.z) - node->centre[2]};
    const Spectrum n[3] = {spectrum_all(-from->ns.x), spectrum_all(-from->ns.y),
                           spectrum_all(-from->ns.z)};
    Spectrum radius2 = node->spread2 + node->spread2, d2 = dot(d, d);
    Spectrum length = roots(d2 + radius2 + spectrum_all(1e-12f));
    Spectrum inverse = spectrum_all(1) / length, inverse2 = inverse * inverse;
    Spectrum height = dot(n, d);
    if (from->both_sides) height = absolute(height);
    SpectrumMask seen =
        spectrum_above(height + node->radius, zero) &
        spectrum_above(dot(node->normal, d) + node->behind + length * spectrum_all(NOT_QUITE_FLAT),
                       zero);
    Spectrum power = spectrum_select(seen, node->power, zero);
    Spectrum sent = facing(node, d, inverse, radius2 * inverse2) * inverse2;
    SpectrumMask large = spectrum_above(node->large2, d2);
    if (spectrum_max_lane(node->large2 - d2) > 0)
        weigh_large(emitters, scene, node, from->position, large, &sent);
    Spectrum weight = power * softened(height, node->spread2) * inverse * sent;
    float sum = spectrum_sum(weight), all = spectrum_sum(power);
    if (!(all > 0)) return node->share;
    if (!(sum > 0 && sum < 1e30f)) return power * spectrum_all(1 / all);
    return weight * spectrum_all((1 - BLIND_SHARE) / sum) + power * spectrum_all(BLIND_SHARE / all);
}

/* Are a branch's cells chosen at once, or by its own branches? */
static bool is_far(const EmitterNode *node, int i, Vec3 from) {
    Vec3 d =
        vec3(from.x - node->centre[0][i], from.y - node->centre[1][i], from.z - node->centre[2][i]);
    return !node->child[i] || vec3_dot(d, d) > node->far2[i];
}

/* *density: of the choice of a point in the cell, alone. */
static EmitterPoint sample_cell(const Emitter *emitter, uint32_t cell, const Scene *scene,
                                Vec3 from, Vec2 u, EmitterDensity *density) {
    EmitterCell at = emitter_cell(emitter, cell);
    SolidAngle seen;
    if (looks_large(emitter, &at, scene, from, &seen)) {
        float weight[3];
        solid_angle_sample(&seen, u.x, u.y, weight);
        *density = (EmitterDensity){0, 1 / seen.value};
        return point_of_cell(emitter, &at, weight[1], weight[2]);
    }
    float root = sqrtf(u.x); /* uniform on the triangle */
    *density = (EmitterDensity){1 / emitter->cell_area, 0};
    return point_of_cell(emitter, &at, root * (1 - u.y), root * u.y);
}

static EmitterDensity times(float prob, EmitterDensity density) {
    return (EmitterDensity){prob * density.on_area, prob * density.on_sphere};
}

/* ---- all of it --------------------------------------------------------------------------- */

EmitterPoint emitters_sample(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                             const float u[3], EmitterDensity *density) {
    const EmitterNode *node = emitters->root;
    Vec2 position = {u[0], u[1]};
    float prob = 1;
    int i;
    for (;; node = node->child[i]) {
        Spectrum probs = weigh(emitters, scene, node, from);
        i = choose_branch(probs, node->count, &position.x);
        prob *= probs[i];
        if (is_far(node, i, from->position)) break;
    }
    float of_branch;
    int k = alias_sample(&node->choice[i], u[2], &of_branch);
    EmitterChoice chosen = emitters->by_rank[node->first[i] + (uint32_t)k];
    EmitterPoint point = sample_cell(&emitters->emitters[chosen.emitter], chosen.cell, scene,
                                     from->position, position, density);
    *density = times(prob * of_branch, *density);
    return point;
}

static int branch_of(const EmitterNode *node, uint32_t rank) {
    int i = 0;
    while (i + 1 < node->count && node->first[i + 1] <= rank) i++;
    return i;
}

static float cell_prob(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                       uint32_t cell) {
    uint32_t rank = emitters->cell_rank[cell];
    const EmitterNode *node = emitters->root;
    float prob = 1;
    for (;;) {
        int i = branch_of(node, rank);
        prob *= weigh(emitters, scene, node, from)[i];
        if (is_far(node, i, from->position))
            return prob * node->choice[i].slots[rank - node->first[i]].prob;
        node = node->child[i];
    }
}

EmitterDensity emitters_density(const Emitters *emitters, const Scene *scene, const LitPoint *from,
                                EmitterPoint point) {
    const Part *part = &scene->parts[scene->triangles[point.triangle].part_id];
    int first = emitters->count ? emitters->first_of_part[part - scene->parts] : NO_ID;
    if (first == NO_ID) return (EmitterDensity){0, 0};
    int i = first + (int)(point.triangle - part->first_triangle);
    const Emitter *e = &emitters->emitters[i];
    uint32_t cell = cell_at(e, point.u, point.v);
    float prob = cell_prob(emitters, scene, from, cell);
    EmitterCell at = emitter_cell(e, cell);
    SolidAngle seen;
    if (!(prob > 0)) return (EmitterDensity){0, 0};
    if (looks_large(e, &at, scene, from->position, &seen))
        return times(prob, (EmitterDensity){0, 1 / seen.value});
    return times(prob, (EmitterDensity){1 / e->cell_area, 0});
}
