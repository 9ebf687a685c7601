/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/pose.h"

#include <stdio.h>
#include <string.h>

#include "base/mathd.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/animation_target.h"
#include "scene/gltf/document.h"
#include "text/nearest_word.h"

/* ---- between two key frames (glTF 2.0, appendix C) --------------------------------------- */

typedef enum Interpolation { STEP, LINEAR, CUBIC } Interpolation;

typedef struct Keys {
    Interpolation interpolation;
    const float *times;
    size_t count;
    const float *values; /* width numbers a key; CUBIC: in-tangent, value, out-tangent */
    size_t width;
} Keys;

/* The key at or before a time, and how far it is to the next one, 0 to below 1; outside of the
 * keys the nearest of them. */
static size_t find_key(const Keys *keys, double time_s, double *share) {
    size_t low = 0, high = keys->count;
    *share = 0;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if ((double)keys->times[middle] <= time_s) low = middle;
        else high = middle;
    }
    double from = (double)keys->times[low];
    if (low + 1 == keys->count || !(time_s > from)) return low;
    *share = (time_s - from) / ((double)keys->times[low + 1] - from);
    return low;
}

static void mix(const float *a, const float *b, const double share[2], size_t width, float *out) {
    for (size_t i = 0; i < width; i++)
        out[i] = (float)(share[0] * (double)a[i] + share[1] * (double)b[i]);
}

/* Along the shorter arc between two unit quaternions; q and -q are one rotation. Where they all
 * but agree the arc is a line. */
static void slerp(const float *a, const float *b, double share, float *out) {
    double dot = 0;
    for (int i = 0; i < 4; i++) dot += (double)a[i] * (double)b[i];
    double angle = acos_d(fmin(fabs(dot), 1)), whole = sin_d(angle), side = dot < 0 ? -1 : 1;
    double shares[2] = {1 - share, side * share};
    if (whole > 1e-6) {
        shares[0] = sin_d((1 - share) * angle) / whole;
        shares[1] = side * sin_d(share * angle) / whole;
    }
    mix(a, b, shares, 4, out);
}

/* Cubic Hermite: the tangents are per second, so that they count times the keys' distance. */
static void spline(const Keys *keys, size_t key, double t, float *out) {
    size_t width = keys->width;
    const float *a = keys->values + 3 * width * key, *b = a + 3 * width;
    double apart = (double)keys->times[key + 1] - (double)keys->times[key];
    double t2 = t * t, t3 = t2 * t;
    for (size_t i = 0; i < width; i++)
        out[i] =
            (float)((2 * t3 - 3 * t2 + 1) * (double)a[width + i] +
                    apart * (t3 - 2 * t2 + t) * (double)a[2 * width + i] +
                    (3 * t2 - 2 * t3) * (double)b[width + i] + apart * (t3 - t2) * (double)b[i]);
}

static void interpolate(const Keys *keys, AnimationPath path, double time_s, float *out) {
    double share;
    size_t width = keys->width, key = find_key(keys, time_s, &share);
    bool is_cubic = keys->interpolation == CUBIC;
    const float *a = keys->values + width * (is_cubic ? 3 * key + 1 : key);
    if (share == 0 || keys->interpolation == STEP) memcpy(out, a, width * sizeof *out);
    else if (is_cubic) spline(keys, key, share, out);
    else if (path == MOVES_ROTATION) slerp(a, a + width, share, out);
    else mix(a, a + width, (double[]){1 - share, share}, width, out);
}

/* ---- a channel --------------------------------------------------------------------------- */

static bool read_keys(GltfFile *file, const GltfValue *sampler, size_t width, Keys *out) {
    const char *how = tree_text(sampler, "interpolation", "LINEAR");
    int input = tree_int(sampler, "input", NO_ID), output = tree_int(sampler, "output", NO_ID);
    if (!accessor_claim_bytes(file, input, sampler, "the input") ||
        !accessor_claim_bytes(file, output, sampler, "the output"))
        return false;
    *out = (Keys){.interpolation = strcmp(how, "STEP") == 0          ? STEP
                                   : strcmp(how, "CUBICSPLINE") == 0 ? CUBIC
                                                                     : LINEAR,
                  .times = accessor_floats(file, input),
                  .count = accessor_get(file, input)->count,
                  .values = accessor_floats(file, output),
                  .width = width};
    return true;
}

/* The numbers that a key frame holds for the node; 0: morph weights of what has none. */
static size_t width_of(const GltfFile *file, const AnimationTarget *moved) {
    static const size_t WIDTHS[MOVES_COUNT] = {3, 4, 3, 0, 1};
    if (moved->path != MOVES_WEIGHTS) return WIDTHS[moved->path];
    const GltfValue *node = tree_element(file->root, "nodes", moved->node);
    const GltfValue *mesh = tree_referred(tree_member(node, "mesh"), "meshes");
    return (size_t)tree_count(tree_item(tree_member(mesh, "primitives"), 0), "targets");
}

/* False, and reported: another animation moves that already. */
static bool claim(GltfFile *file, const GltfValue *channel, const AnimationTarget *moved) {
    NodePose *pose = &file->poses[moved->node];
    const GltfValue *before = pose->movers[moved->path];
    pose->movers[moved->path] = channel;
    return !before || file_error(file, channel,
                                 "animations \"%.80s\" and \"%.80s\" both move the %s of node %d: "
                                 "--animation chooses one",
                                 load_name(file->load, before->parent->parent, "animation"),
                                 load_name(file->load, channel->parent->parent, "animation"),
                                 animation_path_names[moved->path], moved->node);
}

static void play_channel(GltfFile *file, const GltfValue *samplers, const GltfValue *channel) {
    Keys keys;
    AnimationTarget moved;
    Arena *scratch = &file->load->scratch;
    if (!animation_target(file->root, channel, &moved)) return; /* reported by the check */
    size_t width = width_of(file, &moved);
    if (!width || !claim(file, channel, &moved)) return;
    float *value = ARENA_NEW(scratch, float, width);
    Arena begun = *scratch;
    const GltfValue *sampler = tree_item(samplers, tree_int(channel, "sampler", NO_ID));
    if (!read_keys(file, sampler, width, &keys)) return;
    interpolate(&keys, moved.path, file->load->options->state.time_s, value);
    *scratch = begun;
    NodePose *pose = &file->poses[moved.node];
    const float **places[MOVES_COUNT] = {&pose->translation, &pose->rotation, &pose->scale,
                                         &pose->weights, &pose->visible};
    *places[moved.path] = value;
}

/* ---- the animations of a file ------------------------------------------------------------ */

static double end_of(GltfFile *file, const GltfValue *animation) {
    double end = 0;
    for (const GltfValue *s = tree_items(animation, "samplers"); s; s = tree_next(s)) {
        int id = tree_int(s, "input", NO_ID);
        const GltfAccessor *times = accessor_get(file, id);
        Arena begun = file->load->scratch;
        if (!times || times->component_count != 1) continue;
        end = fmax(end, (double)accessor_floats(file, id)[times->count - 1]);
        file->load->scratch = begun;
    }
    return end;
}

static void play(GltfFile *file, const GltfValue *animation) {
    for (const GltfValue *c = tree_items(animation, "channels"); c; c = tree_next(c))
        play_channel(file, tree_member(animation, "samplers"), c);
}

void pose_build(GltfFile *file) {
    Loader *load = file->load;
    const SceneState *state = &load->options->state;
    const GltfValue *animations = tree_member(file->root, "animations");
    int count = tree_count(file->root, "animations");
    if (state->has_time && count)
        file->poses = ARENA_NEW(&load->scratch, NodePose, tree_count(file->root, "nodes"));
    for (int i = 0; i < count; i++) {
        const GltfValue *animation = &animations->items[i];
        SceneAnimation named = {load_name(load, animation, "animation"), end_of(file, animation)};
        *(SceneAnimation *)list_add(&load->animations, &load->scratch) = named;
        bool is_chosen = !state->animation_count ||
                         load_is_among(named.name, state->animations, state->animation_count);
        if (file->poses && is_chosen) play(file, animation);
    }
}

/* ---- what was requested and is not there ------------------------------------------------- */

static void report_unknown(Loader *load, const char *noun, const char *const *asked,
                           int asked_count, const char *const *known, int known_count) {
    char advice[600], option[16];
    snprintf(option, sizeof option, "--%s", noun);
    for (int i = 0; i < asked_count; i++) {
        if (load_is_among(asked[i], known, known_count)) continue;
        if (known_count)
            nearest_word_advice(asked[i], known, known_count, advice, (int)sizeof advice);
        else
            snprintf(advice, sizeof advice, "no file of the scene has a%s %s",
                     noun[0] == 'a' ? "n" : "", noun);
        problems_add(load->problems, SEVERITY_ERROR, option, "", "no %s is named \"%.200s\" — %s",
                     noun, asked[i], advice);
    }
}

void pose_report_missing(Loader *load) {
    const SceneState *state = &load->options->state;
    int count = load->animations.count;
    const char **names = ARENA_NEW(&load->scratch, const char *, count);
    for (int i = 0; i < count; i++)
        names[i] = ((const SceneAnimation *)list_item(&load->animations, i))->name;
    report_unknown(load, "variant", state->variants, state->variant_count, load->variants.items,
                   load->variants.count);
    report_unknown(load, "animation", state->animations, state->animation_count, names, count);
    if (state->has_time && !count)
        problems_add(load->problems, SEVERITY_ERROR, "--time", "",
                     "%g s, but no file of the scene has an animation", state->time_s);
}
