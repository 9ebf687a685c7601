/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/change/mirror_change.h"

#include <math.h>

#include "scene/gltf/part_draft.h"

/* ---- nodes ------------------------------------------------------------------------------- */

static Vec3 right_of(const SceneChange *change) {
    return vec3_normalize(vec3(-change->ahead[2], 0, change->ahead[0]));
}

/* In scene coordinates: the scene's origin is mirrored as well (mirror_scene_origin). */
static Transform mirror_of(const SceneChange *change) {
    Vec3 right = right_of(change);
    return (Transform){vec3_along(vec3(1, 0, 0), right, -2 * right.x),
                       vec3_along(vec3(0, 1, 0), right, -2 * right.y),
                       vec3_along(vec3(0, 0, 1), right, -2 * right.z), vec3(0, 0, 0)};
}

void nodes_mirror(GltfFile *file) {
    const SceneOptions *options = file->load->options;
    int count = tree_count(file->root, "nodes");
    for (int i = 0; i < options->change_count; i++) {
        if (options->changes[i].kind != CHANGE_MIRROR) continue;
        Transform mirror = mirror_of(&options->changes[i]);
        NodePlace exact = node_place_of(&mirror);
        for (int n = 0; n < count; n++) {
            file->world_from_node[n] = transform_compose(&mirror, &file->world_from_node[n]);
            file->places[n] = node_place_compose(&exact, &file->places[n]);
        }
    }
}

void mirror_scene_origin(Loader *load) {
    for (int i = 0; i < load->options->change_count; i++) {
        const SceneChange *change = &load->options->changes[i];
        if (change->kind != CHANGE_MIRROR) continue;
        Vec3 r = right_of(change);
        double right[3] = {(double)r.x, (double)r.y, (double)r.z};
        double from = -(double)change->middle_m;
        for (int k = 0; k < 3; k++) from += right[k] * load->origin[k];
        for (int k = 0; k < 3; k++) load->origin[k] -= 2 * from * right[k];
    }
}

/* ---- displays ---------------------------------------------------------------------------- */

static bool is_mirrored(const SceneOptions *options) {
    bool is = false;
    for (int i = 0; i < options->change_count; i++) is ^= options->changes[i].kind == CHANGE_MIRROR;
    return is;
}

static const Display *display_of(const Loader *load, const PartDraft *draft) {
    const Material *m = list_item(&load->materials, draft->part.material_id);
    return m->display_id == NO_ID ? NULL : list_item(&load->displays, m->display_id);
}

/* Twice the middle of the range of U that the display shows on the draft's node. */
static float shown_range(const Loader *load, const PartDraft *draft, const Display *display) {
    float box[4] = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *other = list_item(&load->parts, i);
        if (other->node == draft->node && display_of(load, other) == display)
            draft_slot_box(other, &display->content, box);
    }
    return box[0] + box[1];
}

/* Of coordinates before the slot's transform, so that its U becomes `sum` less what it was. */
static void turn_over(PartDraft *draft, const TextureSlot *slot, float sum) {
    const float *m = slot->uv_from_uv;
    Part *part = &draft->part;
    Vec2 *uv = part->uv[slot->uv_set];
    float det = m[0] * m[4] - m[1] * m[3];
    for (uint32_t i = 0; uv && det != 0 && i < draft->vertex_count; i++) {
        float more = sum - 2 * (m[0] * uv[i].x + m[1] * uv[i].y + m[2]);
        uv[i].x += more * m[4] / det;
        uv[i].y -= more * m[3] / det;
    }
    for (uint32_t i = 0; part->tangents && i < draft->vertex_count; i++) {
        part->tangents[i].along = vec3_neg(part->tangents[i].along);
        part->tangents[i].side = -part->tangents[i].side;
    }
}

void displays_mirror(Loader *load) {
    if (!is_mirrored(load->options)) return;
    float *sum = ARENA_NEW(&load->scratch, float, load->parts.count);
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = list_item(&load->parts, i);
        const Display *display = display_of(load, draft);
        if (display) sum[i] = shown_range(load, draft, display);
    }
    for (int i = 0; i < load->parts.count; i++) {
        PartDraft *draft = list_item(&load->parts, i);
        const Display *display = display_of(load, draft);
        if (display) turn_over(draft, &display->content, sum[i]);
    }
}
