/* SPDX-License-Identifier: Apache-2.0 */
/* Before the first path: lamps are gathered into a tree. */
#include "light/punctual_build.h"

#include <math.h>

#include "spectrum/photometry.h"

/* A branch while it is made: lamps order[first .. first + count - 1]. */
typedef struct LampGroup {
    int first, count;
    double power, centre[3], spread2;
    int longest; /* axis along which the lamps spread most */
} LampGroup;

typedef struct LampWork {
    const PunctualLight *lights;
    int *order;
    Arena *arena;
} LampWork;

static double candela(const PunctualLight *light) {
    return (double)luminance_from_rgb(light->intensity);
}

static const PunctualLight *lamp(const LampWork *work, const LampGroup *g, int i) {
    return &work->lights[work->order[g->first + i]];
}

static void measure(const LampWork *work, LampGroup *g) {
    double squares[3] = {0};
    g->power = g->spread2 = 0;
    for (int k = 0; k < 3; k++) g->centre[k] = 0;
    for (int i = 0; i < g->count; i++) {
        const PunctualLight *light = lamp(work, g, i);
        const double at[3] = {(double)light->position.x, (double)light->position.y,
                              (double)light->position.z};
        double w = candela(light);
        g->power += w;
        for (int k = 0; k < 3; k++) {
            g->centre[k] += w * at[k];
            squares[k] += w * at[k] * at[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        g->centre[k] /= g->power;
        squares[k] = squares[k] / g->power - g->centre[k] * g->centre[k];
        g->spread2 += fmax(0, squares[k]);
    }
    g->longest = squares[1] > squares[0] ? 1 : 0;
    if (squares[2] > squares[g->longest]) g->longest = 2;
}

static double along(const PunctualLight *light, int axis) {
    return (double)(axis == 0   ? light->position.x
                    : axis == 1 ? light->position.y
                                : light->position.z);
}

/* Splits at the centre, across the longest axis; lamps at one place are halved. */
static void split(LampWork *work, LampGroup *g, LampGroup *rest) {
    int *order = work->order + g->first, below = 0;
    for (int i = 0; i < g->count; i++) {
        int id = order[i];
        if (!(along(&work->lights[id], g->longest) < g->centre[g->longest])) continue;
        order[i] = order[below];
        order[below++] = id;
    }
    if (!below || below == g->count) below = g->count / 2;
    *rest = *g;
    rest->first += below;
    rest->count -= below;
    g->count = below;
    measure(work, g);
    measure(work, rest);
}

/* Splits again and again the branch with the greatest product of power and extent, among those
 * with too many lamps to be evaluated one by one. */
static int split_all(LampWork *work, LampGroup branch[PUNCTUAL_BRANCHES], int count) {
    int start = count - 1; /* directional lights stay together, before it */
    while (count < PUNCTUAL_BRANCHES) {
        int best = -1;
        double most = -1;
        for (int i = start; i < count; i++) {
            double badness = branch[i].power * branch[i].spread2;
            if (branch[i].count <= PUNCTUAL_FEW || !(badness > most)) continue;
            best = i;
            most = badness;
        }
        if (best < 0) break;
        split(work, &branch[best], &branch[count++]);
    }
    return count;
}

/* ---- nodes ------------------------------------------------------------------------------- */

/* The direction of a node of the octahedral map, as punctual.c reads it. */
static Vec3 node_direction(int i, int j) {
    float p = 2 * (float)i / (PUNCTUAL_PROFILE_SIDE - 1) - 1;
    float q = 2 * (float)j / (PUNCTUAL_PROFILE_SIDE - 1) - 1;
    float z = 1 - fabsf(p) - fabsf(q);
    if (z >= 0) return vec3_normalize(vec3(p, q, z));
    return vec3_normalize(vec3(copysignf(1 - fabsf(q), p), copysignf(1 - fabsf(p), q), z));
}

/* NULL where all lamps shine alike in all directions. *mean: over the sphere. */
static const PunctualProfile *profile_of(const LampWork *work, const LampGroup *g, float *mean) {
    enum { SIDE = PUNCTUAL_PROFILE_SIDE };
    bool is_even = true;
    for (int i = 0; i < g->count; i++) is_even &= lamp(work, g, i)->kind == LIGHT_POINT;
    *mean = 1;
    if (is_even) return NULL;
    PunctualProfile *profile = ARENA_NEW(work->arena, PunctualProfile, 1);
    double sum = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        Vec3 d = node_direction(k % SIDE, k / SIDE);
        double value = 0;
        for (int i = 0; i < g->count; i++) {
            const PunctualLight *light = lamp(work, g, i);
            value += candela(light) * (double)punctual_falloff(light, d);
        }
        profile->value[k] = (float)(value / g->power);
        sum += value / g->power;
    }
    *mean = (float)(sum / (SIDE * SIDE)); /* nodes stand for about equal solid angles */
    return profile;
}

static void finish_branch(const LampWork *work, const LampGroup *g, int i, PunctualNode *node) {
    double radius = 0, size = 0;
    float mean;
    for (int k = 0; k < g->count; k++) {
        const PunctualLight *light = lamp(work, g, k);
        double d2 = 0;
        for (int axis = 0; axis < 3; axis++) {
            double off = along(light, axis) - g->centre[axis];
            d2 += off * off;
            size = fmax(size, fabs(along(light, axis)));
        }
        radius = fmax(radius, sqrt(d2) + (double)punctual_radius(light));
    }
    for (int axis = 0; axis < 3; axis++) node->centre[axis][i] = (float)g->centre[axis];
    node->spread2[i] = (float)g->spread2;
    node->radius[i] = (float)(radius * 1.001 + 1e-5 * size);
    node->power[i] = (float)g->power;
    node->profile[i] = profile_of(work, g, &mean);
    node->mean[i] = mean;
    node->first[i] = g->first;
    node->lamp_count[i] = g->count;
}

/* branch: one, or two of which the first holds the directional lights. */
static PunctualNode *build_node(LampWork *work, LampGroup branch[PUNCTUAL_BRANCHES], int count) {
    PunctualNode *node = ARENA_NEW(work->arena, PunctualNode, 1);
    node->count = split_all(work, branch, count);
    for (int i = 0; i < node->count; i++) {
        finish_branch(work, &branch[i], i, node);
        bool is_distant = lamp(work, &branch[i], 0)->kind == LIGHT_DIRECTIONAL;
        if (is_distant || branch[i].count <= PUNCTUAL_FEW) continue;
        LampGroup within[PUNCTUAL_BRANCHES] = {branch[i]};
        node->child[i] = build_node(work, within, 1);
    }
    return node;
}

/* Directional lights' lux and other lights' candela are compared at the scene's own size. */
static void set_distant(const Scene *scene, PunctualNode *root) {
    Vec3 size = vec3_sub(scene->bounds_max, scene->bounds_min);
    double radius2 = fmax(0.25 * (double)vec3_dot(size, size), 1e-12);
    root->lux[0] = root->power[0];
    root->power[0] = (float)((double)root->power[0] * fmin(radius2, 1e12));
    root->profile[0] = NULL;
    root->is_distant[0] = -1;
}

/* Lists the lamps that give light, directional ones first; returns how many those are. */
static int list_lights(const Scene *scene, PunctualLights *lights) {
    int distant = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < scene->light_count; i++) {
            bool is_distant = scene->lights[i].kind == LIGHT_DIRECTIONAL;
            if (is_distant != !pass || !(candela(&scene->lights[i]) > 0)) continue;
            lights->order[lights->count++] = i;
            distant += is_distant;
        }
    return distant;
}

PunctualLights punctual_build(const Scene *scene, Arena *arena) {
    PunctualLights lights = {.lights = scene->lights};
    lights.order = ARENA_NEW(arena, int, scene->light_count + 1);
    int distant = list_lights(scene, &lights), near = lights.count - distant;
    if (lights.count <= PUNCTUAL_FEW || !near) return lights;
    LampWork work = {scene->lights, lights.order, arena};
    LampGroup branch[PUNCTUAL_BRANCHES] = {{.first = 0, .count = distant}};
    branch[distant > 0] = (LampGroup){.first = distant, .count = near};
    for (int i = 0; i <= (distant > 0); i++) measure(&work, &branch[i]);
    lights.root = build_node(&work, branch, 1 + (distant > 0));
    if (distant) set_distant(scene, lights.root);
    return lights;
}
