/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request.h"

#include <string.h>

#include "base/mathd.h"
#include "base/sampler.h"

/* ---- brightness of displays -------------------------------------------------------------- */

double review_level_of_lux(const ReviewLevel *level, double lux) {
    const ReviewLevelPoint *p = level->points, *last = p + level->point_count - 1;
    if (!(lux > p->lux)) return p->level;
    if (lux >= last->lux) return last->level;
    while (p[1].lux < lux) p++;
    double lux0 = p[0].lux, lux1 = p[1].lux, level0 = p[0].level, level1 = p[1].level;
    if (!(lux0 > 0) || !(level0 > 0))
        return level0 + (level1 - level0) * (lux - lux0) / (lux1 - lux0);
    return level0 * pow_d(level1 / level0, log_d(lux / lux0) / log_d(lux1 / lux0));
}

/* The level under one name, else `value`. */
static double fixed_level(const ReviewLevel *level, const char *name, double value) {
    for (int i = 0; i < level->fixed_count; i++)
        if (!strcmp(level->fixed[i].display, name)) return level->fixed[i].level;
    return value;
}

double review_level_at(const ReviewLevel *level, ReviewDisplayName display, double scene_level,
                       double sensor_lux) {
    if (level->is_curve) return review_level_of_lux(level, sensor_lux);
    double others = fixed_level(level, "*", scene_level);
    return fixed_level(level, display.name, fixed_level(level, display.material, others));
}

/* ---- a mirrored vehicle ------------------------------------------------------------------ */

/* From the plane at `middle`, twice. */
static void mirror_at(const ReviewMirror *mirror, double middle, double v[3]) {
    const double *a = mirror->across;
    double from = a[0] * v[0] + a[1] * v[1] + a[2] * v[2] - middle;
    for (int i = 0; i < 3; i++) v[i] -= 2 * from * a[i];
}

void review_mirror_point(const ReviewMirror *mirror, double p[3]) {
    if (mirror) mirror_at(mirror, mirror->middle_m, p);
}

void review_mirror_direction(const ReviewMirror *mirror, double d[3]) {
    if (mirror) mirror_at(mirror, 0, d);
}

/* ---- eyes -------------------------------------------------------------------------------- */

bool review_eye_is_wide(const ReviewEye *eye) {
    return eye->kind == EYE_BOX || eye->kind == EYE_ELLIPSE;
}

int review_eye_count(const ReviewEye *eye) {
    if (eye->kind == EYE_ELLIPSE) return ELLIPSE_POINTS;
    return eye->kind == EYE_BOX ? eye->grid[0] * eye->grid[1] * eye->grid[2] : 1;
}

/* Point i of n from -1 to 1; one alone is the middle. */
static double share_of(int i, int n) {
    return n > 1 ? 2.0 * i / (n - 1) - 1 : 0;
}

/* Along each axis, in halves of it: point i of an ellipse. */
static void ellipse_shares(int i, double share[3]) {
    static const double root = 0.57735026918962576; /* sqrt(1/3) */
    for (int axis = 0; axis < 3; axis++) share[axis] = 0;
    if (i >= 7)
        for (int axis = 0; axis < 3; axis++) share[axis] = (i - 7) >> axis & 1 ? root : -root;
    else if (i >= 1) share[(i - 1) / 2] = i % 2 ? -1 : 1;
}

static void ellipse_point(const ReviewEye *eye, int i, double out_m[3]) {
    double share[3];
    ellipse_shares(i, share);
    for (int k = 0; k < 3; k++) {
        out_m[k] = eye->position_m[k] + eye->move_m[k];
        for (int axis = 0; axis < 3; axis++) out_m[k] += share[axis] * eye->half_axes_m[axis][k];
    }
}

static void box_point(const ReviewEye *eye, int i, double out_m[3]) {
    for (int axis = 0; axis < 3; axis++) {
        int n = eye->kind == EYE_BOX ? eye->grid[axis] : 1;
        out_m[axis] =
            eye->position_m[axis] + eye->move_m[axis] + eye->half_size_m[axis] * share_of(i % n, n);
        i /= n;
    }
}

void review_eye_point(const ReviewEye *eye, int i, double out_m[3]) {
    (eye->kind == EYE_ELLIPSE ? ellipse_point : box_point)(eye, i, out_m);
    review_mirror_point(eye->mirror, out_m);
}

double review_range_value(const ReviewRange *range, int i) {
    return i == range->count - 1 ? range->last : range->first + i * range->step;
}

Lines review_request_files(const ReviewRequest *request, Arena *arena) {
    Lines files = {.arena = arena};
    for (int i = 0; i < request->input_count; i++) lines_put(&files, request->inputs[i].path);
    for (int i = 0; i < request->symbol_count; i++)
        if (request->symbols[i].mask) lines_put(&files, request->symbols[i].mask);
    for (int i = 0; i < request->scene_count; i++) lines_put(&files, request->scenes[i]);
    return files;
}

uint32_t review_seed(const ReviewRequest *request, uint32_t base) {
    return request->seed ? hash_combine(hash_u32(base), request->seed) : base;
}

const ReviewCondition *review_condition_named(const ReviewRequest *request, const char *name) {
    for (int i = 0; i < request->condition_count; i++)
        if (!strcmp(request->conditions[i].name, name)) return &request->conditions[i];
    return NULL;
}

const ReviewEye *review_eye_named(const ReviewRequest *request, const char *name) {
    for (int i = 0; i < request->eye_count; i++)
        if (!strcmp(request->eyes[i].name, name)) return &request->eyes[i];
    return NULL;
}

bool review_is_optional(const ReviewRequest *request, int symbol_id, const ReviewEye *eye) {
    const int *optional_for = request->symbols[symbol_id].optional_for;
    for (int i = 0; i < request->eye_count; i++)
        if (optional_for && !strcmp(request->eyes[i].name, eye->name)) return optional_for[i];
    return false;
}

bool review_road_is_in(const ReviewRoad *road, const char *condition) {
    for (int i = 0; i < road->condition_count; i++)
        if (!strcmp(road->conditions[i], condition)) return true;
    return !road->condition_count;
}

bool review_is_private(const ReviewRequest *request, int symbol_id, const ReviewEye *eye) {
    const bool *private_for = request->symbols[symbol_id].private_for;
    for (int i = 0; i < request->eye_count; i++)
        if (private_for && !strcmp(request->eyes[i].name, eye->name)) return private_for[i];
    return false;
}

bool review_has_private(const ReviewRequest *request) {
    for (int i = 0; i < request->symbol_count; i++)
        for (int k = 0; k < request->eye_count; k++)
            if (review_is_private(request, i, &request->eyes[k])) return true;
    return false;
}

bool review_is_look(const ReviewGaze *gaze, int eye_id) {
    return !gaze->at_symbols && gaze->for_eye[eye_id];
}

int review_look_count(const ReviewRequest *request) {
    int count = 0;
    for (int g = 0; g < request->gaze_count; g++)
        for (int e = 0; e < request->eye_count; e++) count += review_is_look(&request->gazes[g], e);
    return count;
}

/* ---- variants ---------------------------------------------------------------------------- */

static void set_levels(ReviewRequest *of, const ReviewVariant *variant, Arena *arena) {
    ReviewLevel *levels = ARENA_NEW(arena, ReviewLevel, of->level_count);
    for (int i = 0; i < of->level_count; i++) {
        levels[i] = of->levels[i];
        for (int k = 0; k < variant->level_count; k++)
            if (!strcmp(variant->levels[k].name, levels[i].name)) levels[i] = variant->levels[k];
    }
    of->levels = levels;
}

static void set_scenes(ReviewRequest *of, const ReviewVariant *variant, Arena *arena) {
    const char **own = variant->scene_count ? variant->scenes : of->scenes;
    int count = variant->scene_count ? variant->scene_count : of->scene_count;
    const char **all = ARENA_NEW(arena, const char *, count + variant->more_count);
    for (int i = 0; i < count; i++) all[i] = own[i];
    for (int i = 0; i < variant->more_count; i++) all[count + i] = variant->more[i];
    of->scenes = all;
    of->scene_count = count + variant->more_count;
}

static void move_eyes(ReviewRequest *of, const ReviewVariant *variant, Arena *arena) {
    ReviewEye *eyes = ARENA_NEW(arena, ReviewEye, of->eye_count);
    for (int i = 0; i < of->eye_count; i++) {
        eyes[i] = of->eyes[i];
        for (int axis = 0; axis < 3; axis++) eyes[i].move_m[axis] += variant->eye_moves[i][axis];
    }
    of->eyes = eyes;
}

/* Eyes, gazes and sensors go with the vehicle. */
static void mirror_all(ReviewRequest *of, const ReviewMirror *mirror, Arena *arena) {
    ReviewEye *eyes = ARENA_NEW(arena, ReviewEye, of->eye_count);
    ReviewGaze *gazes = ARENA_NEW(arena, ReviewGaze, of->gaze_count);
    ReviewLevel *levels = ARENA_NEW(arena, ReviewLevel, of->level_count);
    for (int i = 0; i < of->eye_count; i++) {
        eyes[i] = of->eyes[i];
        eyes[i].mirror = mirror;
    }
    for (int i = 0; i < of->gaze_count; i++) {
        gazes[i] = of->gazes[i];
        review_mirror_direction(mirror, gazes[i].direction);
    }
    for (int i = 0; i < of->level_count; i++) {
        levels[i] = of->levels[i];
        review_mirror_point(mirror, levels[i].position_m);
        review_mirror_direction(mirror, levels[i].normal);
    }
    of->eyes = eyes;
    of->gazes = gazes;
    of->levels = levels;
}

/* A fixed level is one wherever it looks from. */
static bool looks_alike(const ReviewLevel *level, const ReviewLevel *before) {
    return !level->is_curve ||
           (before->is_curve &&
            memcmp(level->position_m, before->position_m, sizeof level->position_m) == 0 &&
            memcmp(level->normal, before->normal, sizeof level->normal) == 0);
}

static bool has_same_sensors(const ReviewRequest *request, const ReviewVariant *variant) {
    for (int i = 0; i < request->level_count; i++)
        for (int k = 0; k < variant->level_count; k++)
            if (!strcmp(variant->levels[k].name, request->levels[i].name) &&
                !looks_alike(&variant->levels[k], &request->levels[i]))
                return false;
    return true;
}

/* Does it change levels of displays and nothing else, so that they are all in which its light
 * differs from the request's? A curve whose sensor is elsewhere changes more. */
static bool is_of_levels(const ReviewRequest *request, const ReviewVariant *variant) {
    const ReviewChange *c = &variant->change;
    return !c->scene_count && !c->panel_count && !c->content_count && !variant->scene_count &&
           !variant->more_count && !variant->eye_moves && has_same_sensors(request, variant);
}

ReviewRequest review_request_variant(const ReviewRequest *request, const ReviewVariant *variant,
                                     Arena *arena) {
    ReviewRequest of = *request;
    of.variants = NULL;
    of.variant_count = 0;
    of.change = &variant->change;
    of.is_relevelled = is_of_levels(request, variant);
    if (variant->level_count) set_levels(&of, variant, arena);
    set_scenes(&of, variant, arena);
    if (variant->eye_moves) move_eyes(&of, variant, arena);
    if (variant->change.mirror) mirror_all(&of, variant->change.mirror, arena);
    return of;
}

bool review_is_compared(const ReviewRequest *request) {
    for (int i = 0; i < request->variant_count; i++)
        if (!is_of_levels(request, &request->variants[i])) return true;
    return false;
}

double review_brightness(const ReviewRequest *request, ReviewDisplayName display) {
    const ReviewChange *change = request->change;
    if (!change) return 1;
    ReviewLevel level = {.fixed = (ReviewFixedLevel *)change->brightness,
                         .fixed_count = change->brightness_count};
    return review_level_at(&level, display, 1, 0);
}

int review_condition_steps(const ReviewRequest *request, const ReviewCondition *condition) {
    int sights = request->eye_count * request->symbol_count;
    bool is_variant = request->change != NULL; /* whose gazes are not read */
    if (condition->kind != CONDITION_MOMENT) return 2 * sights;
    return sights + (is_variant ? 0 : review_look_count(request));
}

int review_steps(const ReviewRequest *request, const bool *only) {
    int steps = 0;
    for (int i = 0; i < request->condition_count; i++)
        if (!only || only[i])
            steps += review_condition_steps(request, &request->conditions[i]) *
                     (1 + request->variant_count);
    int with_each = request->frames.has_variants ? request->variant_count : 0;
    return steps + (request->frames.worst ? request->frames.worst + with_each : 0);
}
