/* part_draft.h -- a part before all triangles stand in one array; its normals and tangents.
 *
 * Memory   in the scratch that is passed in.
 */
#pragma once
#include "scene/gltf/loader.h"

/* Indices count from the part's vertices. */
typedef struct PartDraft {
    Part part;
    Vertex *vertices;
    uint32_t *indices; /* three a triangle */
    uint32_t vertex_count, triangle_count;
    struct GltfFile *file; /* where it came from, for messages */
    const GltfValue *primitive, *node;
} PartDraft;

/* Every triangle gets vertices of its own, with its normal. */
void draft_flat_normals(PartDraft *draft, Arena *scratch);

/* Tangents along the slot's growing u; vertices may be split. */
void draft_tangents(PartDraft *draft, const TextureSlot *slot, Arena *scratch);

/* Any frame will do where no texture asks for one. */
void draft_any_tangents(PartDraft *draft);

/* The unit direction of growing u; returns 0 where the coordinates span no area, 1 where the
 * picture is seen as it is, 2 where it is mirrored. */
int triangle_tangent(const TextureSlot *slot, const Vertex *const v[3], Vec3 *tangent);
