/* SPDX-License-Identifier: Apache-2.0 */
#include "surface/surface.h"

#include "base/mathf.h"
#include "scene/point/coverage.h"
#include "scene/point/texture_slot.h"
#include "scene/point/ray_ends.h"
#include "surface/surface_coatings.h"
#include "surface/surface_grey.h"
#include "shaders/facets/index_tables.h"
#include "shaders/facets/microfacet.h"
#include "shaders/layers/overlay.h"

/* A shading normal is bent until the eye is above its plane by this much. */
#define LOWEST_COSINE 1e-3f

/* Tables of a rough solid's index; where that varies by wavelength, of its least and most. */
typedef struct SolidTables {
    const SolidEnergy *least, *most; /* NULL: smooth; of one index */
} SolidTables;

struct SurfaceTables {
    const EnergyTable **of_material; /* of each material's index of refraction */
    const EnergyTable *of_coat;
    const CoatTable **on_material;         /* of a coat on each material; NULL: it has none */
    const SurfaceCoating *const *coatings; /* of each material; NULL: none has one */
    const SolidTables *solids;             /* of each material */
    const bool *is_grey;                   /* likewise */
};

static bool is_rough_solid(const Material *m) {
    return m->is_solid && m->transmission > 0 &&
           (m->brushing || !is_smooth(m->roughness * m->roughness));
}

/* The index relative to the surroundings: a coating may stand in another medium than air. */
static float index_of(const Material *m, float absolute) {
    return m->coating ? (float)((double)absolute / m->coating->outside) : absolute;
}

/* GGX alpha along the brushing; alpha: across it. */
static float alpha_brushed(float alpha, float strength) {
    return lerpf(alpha, 1, strength * strength);
}

/* least, most: of alpha across the brushing. A texture may weaken the brushing to nothing. */
static BrushedRange brushed_range(const Brushing *b, float least, float most) {
    float weakest = b->texture.texture_id == NO_ID ? b->strength : 0;
    least = max_f(least, SMOOTH_ALPHA);
    most = max_f(most, SMOOTH_ALPHA);
    return (BrushedRange){.least = alpha_brushed(least, weakest),
                          .most = alpha_brushed(most, b->strength),
                          .least_ratio = least / alpha_brushed(least, b->strength),
                          .most_ratio = most / alpha_brushed(most, weakest)};
}

static const SolidEnergy *energy_of(const Material *m, float ior, bool has_facets, Arena *arena) {
    bool is_even = m->metallic_roughness_texture.texture_id == NO_ID;
    float most = m->roughness * m->roughness, least = is_even ? most : 0;
    const SolidEnergy *energy = solid_energy_build(ior, least, most, has_facets, arena);
    return m->brushing
               ? solid_energy_brushed(energy, brushed_range(m->brushing, least, most), arena)
               : energy;
}

static bool are_brushed_alike(const Brushing *a, const Brushing *b) {
    if (!a || !b) return a == b;
    return a->strength == b->strength &&
           (a->texture.texture_id == NO_ID) == (b->texture.texture_id == NO_ID);
}

/* All that a solid's tables depend on. */
static bool share_solid_tables(const Material *a, const Material *b) {
    return is_rough_solid(a) == is_rough_solid(b) && a->ior == b->ior && a->index == b->index &&
           a->roughness == b->roughness && a->coating == b->coating && a->film == b->film &&
           (a->metallic_roughness_texture.texture_id == NO_ID) ==
               (b->metallic_roughness_texture.texture_id == NO_ID) &&
           are_brushed_alike(a->brushing, b->brushing);
}

static SolidTables solid_tables(const Material *m, Arena *arena) {
    float low = m->index ? m->index->value[0] : m->ior, high = low;
    if (!is_rough_solid(m)) return (SolidTables){NULL, NULL};
    for (int i = 0; i < CURVE_COUNT && m->index; i++) {
        low = min_f(low, m->index->value[i]);
        high = max_f(high, m->index->value[i]);
    }
    bool is_coated = m->coating || m->film;
    return (SolidTables){energy_of(m, index_of(m, low), is_coated, arena),
                         low < high ? energy_of(m, high, false, arena) : NULL};
}

/* Materials of one index of refraction share a table. */
static const CoatTable *coat_on(const Scene *scene, int material_id, const SurfaceTables *tables,
                                Arena *arena) {
    const Material *m = scene->materials;
    if (!(m[material_id].clearcoat > 0)) return NULL;
    if (m[material_id].ior == CLEARCOAT_IOR) return &common_coat_table;
    for (int i = 0; i < material_id; i++)
        if (tables->on_material[i] && m[i].ior == m[material_id].ior) return tables->on_material[i];
    return coat_table_build(tables->of_material[material_id], tables->of_coat, arena);
}

const SurfaceTables *surface_tables_build(const Scene *scene, SurfaceDetail detail, Arena *arena) {
    SurfaceTables *tables = ARENA_NEW(arena, SurfaceTables, 1);
    tables->of_material = ARENA_NEW(arena, const EnergyTable *, scene->material_count + 1);
    tables->on_material = ARENA_NEW(arena, const CoatTable *, scene->material_count + 1);
    SolidTables *solids = ARENA_NEW(arena, SolidTables, scene->material_count + 1);
    tables->of_coat = &common_energy_table;
    tables->solids = solids;
    tables->is_grey = surface_grey_build(scene, arena);
    tables->coatings = surface_coatings_build(scene, detail == SURFACE_POLARISED, arena);
    for (int i = 0; i < scene->material_count; i++) {
        float ior = scene->materials[i].ior;
        const EnergyTable *table = NULL;
        for (int j = 0; j < i && !table; j++)
            if (scene->materials[j].ior == ior) table = tables->of_material[j];
        tables->of_material[i] = table ? table : energy_table_of(ior, arena);
        tables->on_material[i] = coat_on(scene, i, tables, arena);
        if (detail == SURFACE_SKETCH) continue;
        int same = 0;
        while (same < i && !share_solid_tables(&scene->materials[same], &scene->materials[i]))
            same++;
        solids[i] = same < i ? solids[same] : solid_tables(&scene->materials[i], arena);
    }
    return tables;
}

/* ---- textures --------------------------------------------------------------------------- */

typedef void TextureRead(const Texture *texture, float u, float v, float rgba[4]);

/* False: there is no texture. */
static bool read_slot(const Scene *scene, const TextureSlot *slot, const TrianglePoint *point,
                      TextureRead *read, float texel[4]) {
    if (slot->texture_id == NO_ID) return false;
    Vec2 uv = slot_uv(slot, point);
    read(&scene->textures[slot->texture_id], uv.x, uv.y, texel);
    return true;
}

/* factor times one channel of the slot's texture. */
static float scaled(const Scene *scene, float factor, const TextureSlot *slot,
                    const TrianglePoint *point, int channel) {
    float texel[4];
    if (factor == 0 || !read_slot(scene, slot, point, texture_data, texel)) return factor;
    return factor * texel[channel];
}

/* Colour as a spectrum; a measured curve stands in for the factor. */
static Spectrum colour_spectrum(const Scene *scene, int curve_id, const float factor[3],
                                const float texel[3], const Wavelengths *wavelengths) {
    float rgb[3];
    for (int i = 0; i < 3; i++) rgb[i] = (curve_id == NO_ID ? factor[i] : 1) * texel[i];
    Spectrum spectrum = spectrum_from_rgb(wavelengths, rgb);
    return curve_id == NO_ID ? spectrum
                             : spectrum * curve_lookup(&scene->curves[curve_id], wavelengths);
}

/* ---- shading normals -------------------------------------------------------------------- */

/* ns, turned to the side that `side` is on, and bent until `above` is above its plane. */
static Vec3 oriented_normal(Vec3 ns, Vec3 side, Vec3 above) {
    if (vec3_dot(ns, side) < 0) ns = vec3_neg(ns);
    float cosine = vec3_dot(ns, above);
    return cosine >= LOWEST_COSINE
               ? ns
               : vec3_normalize(vec3_along(ns, above, LOWEST_COSINE * 2 - cosine));
}

/* The direction in the triangle's plane, world and unit, in which set 0's u or v grows; 0
 * where the texture coordinates define none. */
static Vec3 texture_axis(const Scene *scene, uint32_t triangle, bool is_v) {
    Vec2 uv[3];
    Vec3 p[3];
    for (int i = 0; i < 3; i++) {
        uv[i] = scene_corner_uv(scene, triangle, i, 0);
        p[i] = scene_corner(scene, triangle, i);
    }
    Vec2 d1 = {uv[1].x - uv[0].x, uv[1].y - uv[0].y};
    Vec2 d2 = {uv[2].x - uv[0].x, uv[2].y - uv[0].y};
    float first = is_v ? -d2.x : d2.y, second = is_v ? d1.x : -d1.y;
    Vec3 along = vec3_along(vec3_scale(vec3_sub(p[1], p[0]), first), vec3_sub(p[2], p[0]), second);
    return vec3_normalize(d1.x * d2.y < d2.x * d1.y ? vec3_neg(along) : along);
}

/* ---- models ----------------------------------------------------------------------------- */

typedef struct Site {
    const Scene *scene;
    const SurfaceTables *tables;
    const Material *material;
    const Hit *hit;
    const Wavelengths *wavelengths;
    Spectrum base_color;
    float transmission, metallic, alpha; /* alpha: GGX */
} Site;

static void read_site(Site *site, const TrianglePoint *point, const float texel[4]) {
    const Material *m = site->material;
    const Scene *scene = site->scene;
    float roughness = m->roughness, both[4];
    site->metallic = m->metallic;
    if ((roughness != 0 || site->metallic != 0) &&
        read_slot(scene, &m->metallic_roughness_texture, point, texture_data, both)) {
        if (roughness != 0) roughness *= both[1]; /* 0 stays 0, whatever the texture holds */
        if (site->metallic != 0) site->metallic *= both[2];
    }
    site->transmission = scaled(scene, m->transmission, &m->transmission_texture, point, 0);
    site->alpha = roughness * roughness;
    site->base_color = spectrum_clamp(
        colour_spectrum(scene, m->base_color_curve_id, m->base_color, texel, site->wavelengths), 0,
        1);
}

static Spectrum tint_of(const Site *site) {
    int curve = site->material->transmission_curve_id;
    return curve == NO_ID ? site->base_color
                          : curve_lookup(&site->scene->curves[curve], site->wavelengths);
}

static void set_coat(const Site *site, const Surface *surface, MetallicRoughness *model) {
    const Material *m = site->material;
    const TrianglePoint *point = &surface->point;
    model->clearcoat = scaled(site->scene, m->clearcoat, &m->clearcoat_texture, point, 0);
    if (!(model->clearcoat > 0)) return;
    float roughness =
        scaled(site->scene, m->clearcoat_roughness, &m->clearcoat_roughness_texture, point, 1);
    Vec3 normal = coat_normal(site->scene, m, site->hit->triangle, point);
    if (vec3_dot(normal, surface->frame.z) < 0) normal = vec3_neg(normal);
    model->clearcoat_alpha = roughness * roughness;
    model->clearcoat_energy = site->tables->of_coat;
    model->coat = site->tables->on_material[surface->material_id];
    model->clearcoat_normal = frame_to_local(&surface->frame, normal);
    if (model->clearcoat_normal.z < LOWEST_COSINE) model->clearcoat_normal = vec3(0, 0, 1);
}

static void set_across(const Site *site, const Surface *surface, MetallicRoughness *model) {
    static const float white[4] = {1, 1, 1, 1};
    const Material *m = site->material;
    float texel[4];
    bool coloured = read_slot(site->scene, &m->diffuse_transmission_color_texture, &surface->point,
                              texture_colour, texel);
    model->across = scaled(site->scene, m->diffuse_transmission, &m->diffuse_transmission_texture,
                           &surface->point, 3);
    model->wavelengths = site->wavelengths;
    for (int i = 0; i < 3; i++)
        model->across_color[i] =
            m->diffuse_transmission_color[i] * (coloured ? texel[i] : white[i]);
}

/* Turns the surface's frame until x lies along the brushing. The facets that lie across it are
 * the base's own; no brushed surface is a perfect mirror across its grooves. */
static void set_brushing(const Scene *scene, const Hit *hit, const Brushing *b, Surface *surface,
                         float *alpha, float *alpha_along) {
    float texel[4] = {1, 0.5f, 1, 1};
    Vec3 tangent, bitangent;
    read_slot(scene, &b->texture, &surface->point, texture_data, texel);
    float x = 2 * texel[0] - 1, y = 2 * texel[1] - 1, strength = b->strength * texel[2];
    float along = x * b->cosine - y * b->sine, across = x * b->sine + y * b->cosine;
    if (!(strength > 0) ||
        !point_tangent(scene, hit->triangle, &surface->point, &tangent, &bitangent))
        return;
    Vec3 z = surface->frame.z;
    Vec3 turned = vec3_along(vec3_scale(tangent, along), bitangent, across);
    turned = vec3_normalize(vec3_along(turned, z, -vec3_dot(turned, z)));
    if (!(vec3_dot(turned, turned) > 0.5f)) return;
    surface->frame = (Frame){turned, vec3_cross(z, turned), z};
    *alpha = max_f(*alpha, SMOOTH_ALPHA);
    *alpha_along = alpha_brushed(*alpha, strength);
}

static const SurfaceCoating *coating_of(const Site *site, int material_id) {
    return site->tables->coatings ? site->tables->coatings[material_id] : NULL;
}

/* The eye is on the side that the front of the surface faces. */
static bool is_front(const Surface *surface) {
    return vec3_dot(surface->frame.z, surface->ng) > 0;
}

/* A coating stands in for the film: then false, as where there is no film. */
static bool read_film(const Scene *scene, const Material *m, const TrianglePoint *point,
                      ThinFilm *out) {
    const MaterialFilm *film = m->film;
    float texel[4] = {1, 1, 1, 1}, thickness_nm;
    if (m->coating) return false;
    read_slot(scene, &film->thickness_texture, point, texture_data, texel);
    thickness_nm = lerpf(film->least_nm, film->most_nm, texel[1]);
    if (!(thickness_nm > 0)) return false;
    float share = scaled(scene, film->share, &film->texture, point, 0);
    *out = (ThinFilm){.share = share, .ior = film->ior, .thickness_nm = thickness_nm};
    return true;
}

static void set_overlay(const Site *site, const Surface *surface, MetallicRoughness *model) {
    const MaterialOverlay *overlay = site->material->overlay;
    const TrianglePoint *point = &surface->point;
    float texel[4] = {1, 1, 1, 1};
    read_slot(site->scene, &overlay->color_texture, point, texture_colour, texel);
    for (int i = 0; i < 3; i++) model->overlay.color[i] = overlay->color[i] * texel[i];
    float roughness =
        scaled(site->scene, overlay->roughness, &overlay->roughness_texture, point, 3);
    model->overlay.alpha = overlay_alpha(roughness);
    model->wavelengths = site->wavelengths;
}

static void set_metallic_roughness(const Site *site, Surface *surface) {
    static const float white[3] = {1, 1, 1};
    const Material *m = site->material;
    const TrianglePoint *point = &surface->point;
    float texel[4];
    bool coloured =
        read_slot(site->scene, &m->specular_color_texture, point, texture_colour, texel);
    MetallicRoughness *model = bsdf_be_metallic_roughness(&surface->bsdf);
    *model = metallic_roughness_default(site->tables->of_material[surface->material_id]);
    model->base_color = site->base_color;
    model->metallic = site->metallic;
    model->alpha = site->alpha;
    model->transmission = site->transmission;
    model->tint = tint_of(site);
    model->specular = scaled(site->scene, m->specular, &m->specular_texture, point, 3);
    model->specular_color = colour_spectrum(site->scene, m->specular_curve_id, m->specular_color,
                                            coloured ? texel : white, site->wavelengths);
    if (m->brushing)
        set_brushing(site->scene, site->hit, m->brushing, surface, &model->alpha,
                     &model->alpha_along);
    if (m->film && read_film(site->scene, m, point, &model->film)) {
        model->film_metal = m->conductor;
        model->wavelengths = site->wavelengths;
    }
    if (m->overlay) set_overlay(site, surface, model);
    set_coat(site, surface, model);
    if (m->diffuse_transmission > 0) set_across(site, surface, model);
    model->coating = coating_of(site, surface->material_id);
    if (!model->coating) return;
    model->wavelengths = site->wavelengths;
    model->seen_from_back = !is_front(surface);
}

static void set_solid(const Site *site, Surface *surface) {
    const Material *m = site->material;
    const SurfaceCoating *coating = coating_of(site, surface->material_id);
    Dielectric *solid = bsdf_be_dielectric(&surface->bsdf);
    *solid = (Dielectric){.tint = tint_of(site), .ior = m->ior, .alpha = site->alpha};
    solid->energy = site->tables->solids[surface->material_id].least;
    solid->energy_most = site->tables->solids[surface->material_id].most;
    solid->index = m->index;
    solid->wavelengths = m->index ? site->wavelengths : NULL;
    if (m->brushing)
        set_brushing(site->scene, site->hit, m->brushing, surface, &solid->alpha,
                     &solid->alpha_along);
    if (m->film && read_film(site->scene, m, &surface->point, &solid->film))
        solid->wavelengths = site->wavelengths;
    if (!coating) return;
    solid->ior = index_of(m, m->ior);
    solid->coating = coating->solid;
    solid->wavelengths = site->wavelengths;
}

static void set_window(const Site *site, Surface *surface) {
    const SurfaceCoating *coating = coating_of(site, surface->material_id);
    ThinWindow *window = bsdf_be_thin_window(&surface->bsdf);
    *window = (ThinWindow){.tint = tint_of(site), .ior = site->material->ior};
    if (!coating) return;
    window->coating = coating->sheet;
    window->ior = coating->sheet->ior;
    window->front_is_met = is_front(surface);
    window->wavelengths = site->wavelengths;
}

/* Sets how the shading normal changes along the frame's x and y: over a triangle both it, but
 * for its length, and the place are linear. A flat pane's stays exactly 0. */
static void set_bend(const Site *site, const Surface *surface, GlazedWindow *model) {
    const Scene *scene = site->scene;
    const Vec3 *normals = scene_part(scene, site->hit->triangle)->normals;
    const Frame *frame = &surface->frame;
    Vec3 p[3], n[3];
    if (!normals) return;
    for (int i = 0; i < 3; i++) {
        p[i] = scene_corner(scene, site->hit->triangle, i);
        n[i] = normals[scene_corner_place(scene, site->hit->triangle, i)];
    }
    Vec3 n1 = vec3_sub(n[1], n[0]), n2 = vec3_sub(n[2], n[0]);
    Vec3 p1 = vec3_sub(p[1], p[0]), p2 = vec3_sub(p[2], p[0]), across = vec3_cross(p1, p2);
    Vec3 sum = vec3_along(vec3_along(n[0], n1, site->hit->u), n2, site->hit->v);
    float over = vec3_dot(across, across) * vec3_dot(sum, frame->z);
    if (over == 0) return;
    for (int i = 0; i < 2; i++) {
        Vec3 axis = i ? frame->y : frame->x;
        float u = vec3_dot(vec3_cross(axis, p2), across);
        float v = vec3_dot(vec3_cross(p1, axis), across);
        Vec3 growth = vec3_along(vec3_scale(n1, u / over), n2, v / over);
        model->bend[i][0] = vec3_dot(growth, frame->x);
        model->bend[i][1] = vec3_dot(growth, frame->y);
    }
}

static void set_glazing(const Site *site, Surface *surface) {
    const Glazing *pane = site->material->glazing;
    GlazedWindow *model = bsdf_be_glazed_window(&surface->bsdf);
    *model = (GlazedWindow){.pane = pane,
                            .absorbance = curve_lookup(&pane->absorbance, site->wavelengths),
                            .front_is_up = is_front(surface)};
    const SurfaceCoating *coating = coating_of(site, surface->material_id);
    if (coating) {
        model->coating = coating->pane;
        model->wavelengths = site->wavelengths;
    }
    set_bend(site, surface, model);
    for (int i = 0; i < 2; i++) {
        if (pane->wedge[i] == 0) continue;
        Vec3 axis = texture_axis(site->scene, site->hit->triangle, i == 1);
        Vec3 local = frame_to_local(&surface->frame, axis);
        model->slope[0] += pane->wedge[i] * local.x;
        model->slope[1] += pane->wedge[i] * local.y;
    }
}

static void set_bsdf(const Site *site, Surface *surface) {
    const Material *m = site->material;
    if (m->is_solid && m->transmission > 0) {
        set_solid(site, surface);
    } else if (site->transmission >= 1 && site->metallic <= 0 && is_smooth(site->alpha) &&
               m->clearcoat <= 0 && !m->brushing && !m->film && !m->overlay) {
        set_window(site, surface);
    } else {
        set_metallic_roughness(site, surface);
    }
}

/* One panel, or the mix of several that holds at the point. */
static void set_display_panel(const Site *site, const Display *display, const TrianglePoint *point,
                              DisplaySurface *out) {
    out->panel = display->panel;
    out->mix.count = 0;
    if (panel_varies(display->panel)) {
        float place[2];
        display_place(display, point, place);
        out->mix = panel_place_reflection(display->panel, place);
        out->panel = out->mix.panel[0];
        if (out->mix.count > 1) return;
        out->mix.count = 0;
    }
    panel_lanes(out->panel, site->wavelengths, &out->lanes);
}

static void set_display(const Site *site, Vec3 wo, Surface *surface) {
    const Display *display = &site->scene->displays[site->material->display_id];
    if (vec3_dot(wo, surface->ng) <= 0) {
        bsdf_be_black(&surface->bsdf); /* the back of a display: its casing */
        return;
    }
    TrianglePoint turned = surface->point;
    turned.ns = surface->frame.z;
    surface->frame = display_frame(site->scene, display, site->hit->triangle, &turned);
    DisplaySurface *model = bsdf_be_display(&surface->bsdf);
    const SurfaceCoating *coating = coating_of(site, surface->material_id);
    set_display_panel(site, display, &surface->point, model);
    model->cover = coating ? coating->cover->front : NULL;
    model->waves = coating ? coating->glass_waves : NULL;
    model->wavelengths = site->wavelengths;
    model->matte = display->finish.matte;
    model->matte_alpha = display->finish.alpha;
}

void surface_at(const Scene *scene, const SurfaceTables *tables, const Hit *hit, Vec3 wo,
                const Wavelengths *wavelengths, Surface *out) {
    int part_id = (int)scene->triangles[hit->triangle].part_id;
    const Material *m = &scene->materials[scene->parts[part_id].material_id];
    float texel[4];
    out->point = triangle_point(scene, hit->triangle, hit->u, hit->v);
    out->position = out->point.position;
    out->ng = out->point.ng;
    out->part_id = part_id;
    out->triangle = hit->triangle;
    out->material_id = scene->parts[part_id].material_id;
    out->plate = NULL;
    out->is_grey = tables->is_grey[out->material_id];
    out->emits = triangle_emits_to(scene, hit->triangle, &out->point, wo);
    coverage_texel(scene, m, hit, &out->point, texel);
    out->alpha = coverage_alpha(m, texel[3]);
    bool keeps_outside = m->is_solid && !material_is_translucent_solid(m);
    Vec3 side = vec3_dot(out->ng, wo) < 0 && !keeps_outside ? vec3_neg(out->ng) : out->ng;
    Vec3 eye = vec3_dot(side, wo) < 0 ? vec3_neg(wo) : wo;
    Vec3 ns =
        m->display_id != NO_ID /* a panel was measured with its surface */
            ? out->point.ns
            : mapped_normal(scene, &m->normal_texture, m->normal_scale, hit->triangle, &out->point);
    out->frame = frame_from_z(oriented_normal(ns, side, eye));
    Site site = {
        .scene = scene, .tables = tables, .material = m, .hit = hit, .wavelengths = wavelengths};
    if (m->display_id != NO_ID) {
        set_display(&site, wo, out);
    } else if (m->unlit) {
        bsdf_be_black(&out->bsdf);
    } else if (m->glazing) {
        set_glazing(&site, out);
    } else {
        read_site(&site, &out->point, texel);
        set_bsdf(&site, out);
    }
    out->local_wo = frame_to_local(&out->frame, wo);
}

const Dielectric *surface_clear_solid(const Surface *surface) {
    bool is_clear = surface->bsdf.kind == BSDF_DIELECTRIC && !bsdf_scatters(&surface->bsdf);
    return is_clear ? &surface->bsdf.dielectric : NULL;
}

void surface_be_thick(const SolidPane *pane, Surface *surface) {
    *bsdf_be_solid_pane(&surface->bsdf) = *pane;
}

/* A head may be put on a surface: its rays start off that. */
#define HEAD_OFF_M 2e-5f

void surface_white(const SurfaceTables *tables, Vec3 position, Vec3 normal, Surface *out) {
    *out = (Surface){.position = position,
                     .ng = normal,
                     .frame = frame_from_z(normal),
                     .local_wo = {0, 0, 1},
                     .part_id = NO_ID,
                     .material_id = NO_ID,
                     .alpha = 1,
                     .point = {.position = position,
                               .ng = normal,
                               .ns = normal,
                               .inside = position,
                               .rounding = HEAD_OFF_M / RAY_STEP},
                     .is_grey = true};
    MetallicRoughness *model = bsdf_be_metallic_roughness(&out->bsdf);
    *model = metallic_roughness_default(tables->of_coat);
    model->metallic = 0;
    model->specular = 0;
}

/* Can light go straight through where the material is no hole? */
static bool lets_light_through(const Material *m) {
    return m->glazing ||
           (m->transmission > 0 && !m->is_solid && !m->unlit && m->display_id == NO_ID);
}

Spectrum surface_pass(const Scene *scene, const SurfaceTables *tables, const Hit *hit,
                      Vec3 direction, const Wavelengths *wavelengths) {
    Surface surface;
    int material = scene_part(scene, hit->triangle)->material_id;
    if (!lets_light_through(&scene->materials[material])) {
        TrianglePoint point = triangle_point(scene, hit->triangle, hit->u, hit->v);
        return spectrum_all(1 - coverage_at(scene, hit, &point));
    }
    surface_at(scene, tables, hit, vec3_neg(direction), wavelengths, &surface);
    if (surface.alpha <= 0) return spectrum_all(1);
    Spectrum through = bsdf_pass(&surface.bsdf, surface.local_wo);
    return spectrum_all(1 - surface.alpha) + spectrum_all(surface.alpha) * through;
}
