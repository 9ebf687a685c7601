/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_vertices.h"

#include <stdio.h>
#include <string.h>

#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"

/* A unit vector of three numbers rounded to signed bytes is off by at most sqrt(3) * 0.5/127 in
 * length. */
#define UNIT_ALLOWED 0.00682f
/* Four to sixteen rounded floats: far above 2e-7 each, far below what could be seen. */
#define SUM_ALLOWED 1e-5f

/* Reports the first fault and how many there are of its kind. */
typedef struct Faults {
    size_t count, first;
    float value;
} Faults;

static void add_fault(Faults *faults, size_t place, float value)
{
    if (!faults->count++) {
        faults->first = place;
        faults->value = value;
    }
}

static void report(GltfFile *file, const GltfValue *at, const Faults *faults, const char *what,
                   const char *wanted)
{
    if (faults->count)
        file_warning(file, at, "%s %zu has the %s %g, %s is required (%zu such)", at->key,
                     faults->first, what, (double)faults->value, wanted, faults->count);
}

static void check_unit(GltfFile *file, const GltfValue *at, const float *v, size_t count,
                       int stride)
{
    Faults faults = {0};
    for (size_t i = 0; i < count; i++, v += stride) {
        float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (!(fabsf(length - 1) <= UNIT_ALLOWED)) add_fault(&faults, i, length);
    }
    report(file, at, &faults, "length", "1");
}

static void check_sign(GltfFile *file, const GltfValue *at, const float *v, size_t count)
{
    Faults faults = {0};
    for (size_t i = 0; i < count; i++)
        if (fabsf(v[4 * i + 3]) != 1) add_fault(&faults, i, v[4 * i + 3]);
    report(file, at, &faults, "sign", "1 or -1");
}

static void check_range(GltfFile *file, const GltfValue *at, const float *v, size_t count,
                        int components)
{
    Faults faults = {0};
    for (size_t i = 0; i < count * (size_t)components; i++)
        if (!(v[i] >= 0 && v[i] <= 1)) add_fault(&faults, i / (size_t)components, v[i]);
    report(file, at, &faults, "component", "0 to 1");
}

static void check_attribute(GltfFile *file, const GltfValue *attribute, bool *is_seen)
{
    int id = (int)attribute->number;
    const GltfAccessor *accessor = accessor_get(file, id);
    bool is_normal = strcmp(attribute->key, "NORMAL") == 0;
    bool is_tangent = strcmp(attribute->key, "TANGENT") == 0;
    bool is_color = strncmp(attribute->key, "COLOR_", 6) == 0;
    if ((!is_normal && !is_tangent && !is_color) || !accessor || is_seen[id]) return;
    is_seen[id] = true;
    Arena saved = file->load->scratch;
    const float *v = accessor_floats(file, id);
    if (is_color)
        check_range(file, attribute, v, accessor->count, accessor->component_count);
    else
        check_unit(file, attribute, v, accessor->count, accessor->component_count);
    if (is_tangent) check_sign(file, attribute, v, accessor->count);
    file->load->scratch = saved;
}

/* ---- joints and their weights, all sets of a vertex together --------------------------- */

enum { SETS = 8 };

typedef struct Bending {
    const GltfValue *at; /* WEIGHTS_0 */
    size_t vertex_count;
    int set_count;
    const uint32_t *joints[SETS];
    const float *weights[SETS];
} Bending;

static const GltfValue *set_of(const GltfValue *attributes, const char *prefix, int set)
{
    char name[24];
    snprintf(name, sizeof name, "%s%d", prefix, set);
    return tree_member(attributes, name);
}

static Bending read_bending(GltfFile *file, const GltfValue *attributes)
{
    Bending bending = {.at = tree_member(attributes, "WEIGHTS_0")};
    for (int n = 0; n < SETS; n++) {
        const GltfValue *joints = set_of(attributes, "JOINTS_", n);
        const GltfValue *weights = set_of(attributes, "WEIGHTS_", n);
        if (!joints || !weights) break;
        bending.joints[n] = accessor_integers(file, (int)joints->number);
        bending.weights[n] = accessor_floats(file, (int)weights->number);
        bending.vertex_count = accessor_get(file, (int)weights->number)->count;
        bending.set_count++;
    }
    return bending;
}

/* How often a joint with a weight stands a second time at the vertex. */
static bool names_joint_twice(const Bending *bending, size_t vertex)
{
    for (int i = 1; i < 4 * bending->set_count; i++)
        for (int k = 0; k < i; k++) {
            size_t a = 4 * vertex + (size_t)(i % 4), b = 4 * vertex + (size_t)(k % 4);
            if (bending->weights[i / 4][a] != 0 && bending->weights[k / 4][b] != 0 &&
                bending->joints[i / 4][a] == bending->joints[k / 4][b])
                return true;
        }
    return false;
}

static void check_weights(GltfFile *file, const Bending *bending)
{
    Faults negative = {0}, sums = {0}, twice = {0};
    for (size_t v = 0; v < bending->vertex_count; v++) {
        float sum = 0, least = 0;
        for (int i = 0; i < 4 * bending->set_count; i++) {
            float weight = bending->weights[i / 4][4 * v + (size_t)(i % 4)];
            sum += weight;
            if (weight < least) least = weight;
        }
        if (least < 0) add_fault(&negative, v, least);
        if (!(fabsf(sum - 1) <= SUM_ALLOWED)) add_fault(&sums, v, sum);
        if (names_joint_twice(bending, v)) add_fault(&twice, v, 2);
    }
    report(file, bending->at, &negative, "weight", "0 to 1");
    report(file, bending->at, &sums, "sum of weights", "1");
    if (twice.count)
        file_warning(file, bending->at, "vertex %zu names one joint twice (%zu such)",
                     twice.first, twice.count);
}

static void check_primitive(GltfFile *file, const GltfValue *primitive, bool *is_seen)
{
    const GltfValue *attributes = tree_member(primitive, "attributes");
    for (const GltfValue *a = tree_items(primitive, "attributes"); a; a = tree_next(a))
        check_attribute(file, a, is_seen);
    const GltfValue *weights = tree_member(attributes, "WEIGHTS_0");
    if (!weights || is_seen[(int)weights->number]) return;
    is_seen[(int)weights->number] = true;
    Arena saved = file->load->scratch;
    const Bending bending = read_bending(file, attributes);
    check_weights(file, &bending);
    file->load->scratch = saved;
}

void check_vertices(GltfFile *file)
{
    bool *is_seen = ARENA_NEW(&file->load->scratch, bool, file->data.accessor_count);
    for (const GltfValue *m = tree_items(file->root, "meshes"); m; m = tree_next(m)) {
        for (const GltfValue *p = tree_items(m, "primitives"); p; p = tree_next(p))
            check_primitive(file, p, is_seen);
        load_progress_add(file->load, 1);
    }
}
