/* SPDX-License-Identifier: Apache-2.0 */
#include "surface/surface_coatings.h"

#include <string.h>

#include "shaders/layers/coating_tables.h"

/* Which tables a material needs, by its factors and the textures that may lower them. */
typedef struct CoatingNeeds {
    bool metal, face, sheet, solid, cover, pane;
} CoatingNeeds;

static CoatingNeeds needs_of(const Material *m) {
    CoatingNeeds needs = {false, false, false, false, false, false};
    bool has_nonmetal = m->metallic < 1 || m->metallic_roughness_texture.texture_id != NO_ID;
    bool has_opaque = m->transmission < 1 || m->transmission_texture.texture_id != NO_ID;
    bool is_coated = m->coating != NULL;
    needs.pane = m->glazing && (m->glazing->coating[0] || m->glazing->coating[1]);
    if (m->unlit || m->glazing || (!is_coated && !m->conductor)) return needs;
    needs.cover = is_coated && m->display_id != NO_ID;
    if (m->display_id != NO_ID) return needs;
    needs.solid = is_coated && m->is_solid && m->transmission > 0;
    if (m->is_solid && m->transmission > 0) return needs;
    needs.metal = m->conductor && m->metallic > 0;
    needs.sheet = is_coated && has_nonmetal && m->transmission > 0;
    needs.face = is_coated && has_nonmetal && has_opaque;
    return needs;
}

static bool needs_any(CoatingNeeds n) {
    return n.metal || n.face || n.sheet || n.solid || n.cover || n.pane;
}

static bool same_stack(const LayerStack *a, const LayerStack *b) {
    if (!a || !b) return a == b;
    return a->outside == b->outside && a->faces == b->faces && a->count == b->count &&
           memcmp(a->layers, b->layers, (size_t)a->count * sizeof *a->layers) == 0;
}

static bool same_metal(const OpticalConstants *a, const OpticalConstants *b) {
    return a == b || (a && b && memcmp(a, b, sizeof *a) == 0);
}

/* A texture scales the roughness by any factor in [0, 1]. */
static AlphaSpan alphas_of(const Material *m) {
    float most = m->roughness * m->roughness;
    bool varies = m->metallic_roughness_texture.texture_id != NO_ID;
    return (AlphaSpan){varies ? 0 : most, most};
}

static bool is_alike(const Material *a, const Material *b) {
    CoatingNeeds x = needs_of(a), y = needs_of(b);
    AlphaSpan v = alphas_of(a), w = alphas_of(b);
    if (x.face && (v.least != w.least || v.most != w.most)) return false;
    return !x.pane && memcmp(&x, &y, sizeof x) == 0 && a->ior == b->ior &&
           same_stack(a->coating, b->coating) && same_metal(a->conductor, b->conductor);
}

static void add_waves(const Material *m, CoatingNeeds needs, SurfaceCoating *out, Arena *arena) {
    double ior = (double)m->ior;
    if (needs.metal) out->metal_waves = coating_waves(m->coating, 0, m->conductor, arena);
    if (needs.face || needs.cover) out->glass_waves = coating_waves(m->coating, ior, NULL, arena);
}

static SurfaceCoating *tables_for(const Material *m, CoatingNeeds needs, Arena *arena) {
    SurfaceCoating *out = ARENA_NEW(arena, SurfaceCoating, 1);
    double ior = (double)m->ior;
    if (needs.metal) out->metal = coating_of_metal(m->coating, m->conductor, arena);
    if (needs.face) out->face = coating_of_face(m->coating, ior, alphas_of(m), arena);
    if (needs.sheet) out->sheet = coating_of_sheet(m->coating, ior, arena);
    if (needs.solid) out->solid = coating_of_solid(m->coating, ior, arena);
    if (needs.pane) out->pane = coating_of_pane(m->glazing, arena);
    if (needs.cover) out->cover = coating_of_cover(m->coating, ior, arena);
    return out;
}

const SurfaceCoating *const *surface_coatings_build(const Scene *scene, bool is_polarised,
                                                    Arena *arena) {
    const SurfaceCoating **list = NULL;
    const Material *m = scene->materials;
    for (int i = 0; i < scene->material_count; i++) {
        CoatingNeeds needs = needs_of(&m[i]);
        if (!needs_any(needs)) continue;
        if (!list) list = ARENA_NEW(arena, const SurfaceCoating *, scene->material_count);
        for (int j = 0; j < i && !list[i]; j++)
            if (list[j] && is_alike(&m[j], &m[i])) list[i] = list[j];
        if (list[i]) continue;
        SurfaceCoating *own = tables_for(&m[i], needs, arena);
        if (is_polarised) add_waves(&m[i], needs, own, arena);
        list[i] = own;
    }
    return list;
}
