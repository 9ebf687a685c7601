/* SPDX-License-Identifier: Apache-2.0 */
/* part_draft.h -- a part before all triangles stand in one array; its normals and tangents.
 *
 * Memory   in the scratch that is passed in, until draft_keep.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Indices count from the part's vertices, as its arrays of attributes do. */
typedef struct PartDraft {
    Part part;
    Vec3 *positions;
    uint32_t *indices; /* three a triangle */
    uint32_t vertex_count, triangle_count;
    struct GltfFile *file; /* where it came from, for messages */
    const GltfValue *primitive, *node;
} PartDraft;

/* Every triangle gets vertices of its own, with its normal. */
void draft_flat_normals(PartDraft *draft, Arena *scratch);

/* Tangents along the slot's growing u; vertices may be split. The part has normals and the
 * slot's coordinates. */
void draft_tangents(PartDraft *draft, const TextureSlot *slot, Arena *scratch);

/* Any frame will do where a texture needs one but has no coordinates. */
void draft_any_tangents(PartDraft *draft, Arena *scratch);

/* The unit direction of growing u; returns 0 where the coordinates span no area, 1 where the
 * picture is seen as it is, 2 where it is mirrored. */
int draft_triangle_tangent(const PartDraft *draft, uint32_t triangle, const TextureSlot *slot,
                           Vec3 *tangent);

/* Widens {least u, most u, least v, most v} by the slot's coordinates of all corners. */
void draft_slot_box(const PartDraft *draft, const TextureSlot *slot, float box[4]);

/* Moves the attributes to `arena` for good, positions and indices to `begun`, which is what
 * `scratch` was before the draft; everything else behind it is gone. */
void draft_keep(PartDraft *draft, Arena *arena, Arena begun, Arena *scratch);
