/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/rests.h"

#include <string.h>

#include "panel/query/panel_stated.h"
#include "review/request/request_check.h"
#include "scene/load/material_data.h"

/* A list has room for the power of two that is not below its count. */
static bool is_full(int count) {
    return (count & (count - 1)) == 0;
}

static const char *kept(const char *text, Arena *arena) {
    return text ? arena_string(arena, text, strlen(text)) : NULL;
}

static bool is_same(const char *a, const char *b) {
    return a == b || (a && b && !strcmp(a, b));
}

/* ---- files ------------------------------------------------------------------------------- */

static void add_file(const char *path, const char *xxh3, Review *review, Arena *arena) {
    int count = review->input_count;
    for (int i = 0; i < count; i++)
        if (!strcmp(review->inputs[i].path, path) && !strcmp(review->inputs[i].xxh3, xxh3)) return;
    if (is_full(count))
        review->inputs = ARENA_GROW(arena, ReviewFile, review->inputs, count, 2 * count + 1);
    review->inputs[review->input_count++] =
        (ReviewFile){kept(path, arena), kept(xxh3, arena), NULL};
}

static void add_hashed(const char *path, uint64_t hash, Review *review, Arena *arena) {
    add_file(path, arena_format(arena, "%016llx", (unsigned long long)hash), review, arena);
}

static void add_request_files(const ReviewRequest *request, Review *review, Arena *arena) {
    for (int i = 0; i < request->input_count; i++)
        add_hashed(request->inputs[i].path, request->inputs[i].hash, review, arena);
}

void rests_add_scene_files(const Scene *scene, Review *review, Arena *arena) {
    for (int i = 0; i < scene->input_count; i++)
        add_hashed(scene->inputs[i], scene->input_hashes[i], review, arena);
}

void rests_add_masks(const SetupSymbol *symbols, int count, Review *review, Arena *arena) {
    for (int i = 0; i < count; i++)
        if (symbols[i].mask.path)
            add_hashed(symbols[i].mask.path, symbols[i].mask.hash, review, arena);
}

void rests_add_files_of(const Review *of, Review *review, Arena *arena) {
    for (int i = 0; i < of->input_count; i++)
        add_file(of->inputs[i].path, of->inputs[i].xxh3, review, arena);
}

/* ---- facts ------------------------------------------------------------------------------- */

static bool is_known(const Review *review, const ReviewRest *rest) {
    for (int i = 0; i < review->rests_on_count; i++) {
        const ReviewRest *r = &review->rests_on[i];
        if (r->kind == rest->kind && r->basis == rest->basis && is_same(r->name, rest->name) &&
            is_same(r->words, rest->words))
            return true;
    }
    return false;
}

/* Its texts must live as long as the arena. */
static void add(ReviewRest rest, Review *review, Arena *arena) {
    int count = review->rests_on_count, at = count;
    if (is_known(review, &rest)) return;
    if (is_full(count))
        review->rests_on = ARENA_GROW(arena, ReviewRest, review->rests_on, count, 2 * count + 1);
    for (; at > 0 && review->rests_on[at - 1].kind > rest.kind; at--)
        review->rests_on[at] = review->rests_on[at - 1];
    review->rests_on[at] = rest;
    review->rests_on_count++;
}

void rests_add_of(const Review *of, Review *review, Arena *arena) {
    for (int i = 0; i < of->rests_on_count; i++) add(of->rests_on[i], review, arena);
}

/* ---- what the request says --------------------------------------------------------------- */

static void add_eyes(const ReviewRequest *request, Review *review, Arena *arena) {
    for (int i = 0; i < request->eye_count; i++) {
        const ReviewEye *eye = &request->eyes[i];
        add((ReviewRest){REST_EYE, eye->proposed_from ? REST_PROPOSED : REST_GIVEN, eye->name,
                         eye->proposed_from, 1, 1},
            review, arena);
    }
}

/* Conditions with one occupant; with_id NO_ID: without. */
static int count_with(const ReviewRequest *request, int with_id) {
    int count = 0;
    for (int i = 0; i < request->condition_count; i++)
        count += request->conditions[i].with_id == with_id;
    return count;
}

static void add_occupants(const ReviewRequest *request, Review *review, Arena *arena) {
    for (int i = NO_ID; i < request->with_count; i++) {
        int count = count_with(request, i);
        if (!count) continue;
        add((ReviewRest){REST_OCCUPANT, i == NO_ID ? REST_NOBODY : REST_PRESENT,
                         i == NO_ID ? NULL : request->withs[i].name, NULL, count,
                         request->condition_count},
            review, arena);
    }
}

/* Advice decides nothing, nor does what is not measured here. */
static void add_limits(const Profile *profile, Review *review, Arena *arena) {
    int count = 0, all = 0;
    for (int i = 0; i < profile->limit_count; i++) {
        const ProfileLimit *limit = &profile->limits[i];
        if (limit->is_advice || !quantities[limit->kind]->find) continue;
        all++;
        count += limit->read_in_the_standard;
    }
    add((ReviewRest){REST_LIMITS, count == all ? REST_READ : REST_QUOTED, review->profile, NULL,
                     count, all},
        review, arena);
}

void rests_add_request(const ReviewRequest *request, const Profile *profile, Review *review,
                       Arena *arena) {
    add_request_files(request, review, arena);
    if (profile->file_hash) add_hashed(profile->id, profile->file_hash, review, arena);
    add_eyes(request, review, arena);
    add_occupants(request, review, arena);
    add_limits(profile, review, arena);
}

/* ---- what the scene's files say ---------------------------------------------------------- */

static void add_panel(const char *name, const Display *display, Review *review, Arena *arena) {
    PanelStated stated = panel_stated(display->panel, arena);
    RestBasis basis = stated.is_synthetic ? REST_SYNTHETIC
                      : stated.instrument ? REST_MEASURED
                                          : REST_NOT_STATED;
    const char *words = arena_format(arena, "%s%s%s", stated.name ? stated.name : "",
                                     stated.name && stated.instrument ? "; " : "",
                                     stated.instrument ? stated.instrument : "");
    add((ReviewRest){REST_PANEL, basis, name, words, 1, 1}, review, arena);
}

/* Of the displays that are read, by the names that symbols have for them. */
static void add_panels(const ReviewRequest *request, const Scene *scene, Review *review,
                       Arena *arena) {
    for (int i = 0; i < request->symbol_count; i++) {
        const char *name = request->symbols[i].display;
        ReviewDisplay display;
        Error ignored; /* the request was checked, or will be */
        if (review_display_find(scene, name, arena, &display, &ignored))
            add_panel(name, &scene->displays[display.display_id], review, arena);
    }
}

/* By id: those without data, or those that were guessed, of what some part wears. */
static bool *pick_materials(const Scene *scene, RestBasis basis, Arena *arena) {
    bool *is_picked = ARENA_NEW(arena, bool, scene->material_count);
    for (int i = 0; i < scene->part_count; i++) {
        int id = scene->parts[i].material_id;
        if (basis == REST_GUESSED ? scene->materials[id].guessed_as != NULL
                                  : !part_has_data(scene, i))
            is_picked[id] = true;
    }
    return is_picked;
}

/* Those of one name are one fact. */
static void add_materials(const Scene *scene, RestBasis basis, Review *review, Arena *arena) {
    bool *is_picked = pick_materials(scene, basis, arena);
    for (int i = 0; i < scene->material_count; i++) {
        const Material *m = &scene->materials[i];
        const char *as = basis == REST_GUESSED ? m->guessed_as : "perfectly white";
        long count = 0;
        for (int k = 0; k < scene->material_count; k++) {
            const Material *other = &scene->materials[k];
            count += is_picked[k] && !strcmp(other->name, m->name) &&
                     is_same(other->guessed_as, m->guessed_as);
        }
        if (is_picked[i])
            add((ReviewRest){REST_MATERIAL, basis, kept(m->name, arena), kept(as, arena), count,
                             count},
                review, arena);
    }
}

void rests_add_scene(const ReviewRequest *request, const Scene *scene, Review *review,
                     Arena *arena) {
    add_panels(request, scene, review, arena);
    add_materials(scene, REST_GUESSED, review, arena);
    add_materials(scene, REST_WITHOUT_DATA, review, arena);
}
