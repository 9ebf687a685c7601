/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/material.h"

#include <stddef.h>
#include <string.h>

#include "base/mathd.h"
#include "scene/check/material_layers.h"
#include "scene/gltf/document.h"
#include "scene/load/coating.h"
#include "scene/optics/curve_file.h"
#include "scene/load/display.h"
#include "scene/load/glazing.h"
#include "scene/optics/measured_index.h"
#include "scene/load/texture_slot.h"
#include "spectrum/photometry.h"

static bool any_positive(const float rgb[3]) {
    return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0;
}

/* ---- layers ---------------------------------------------------------------------------- */

/* The keys that an extension has not, or all where it is NULL, have their defaults. */
static void read_keys(GltfFile *file, const GltfValue *extension, const Rule *key, void *out) {
    for (; key->name; key++) {
        void *at = (char *)out + key->field.at;
        if (!key->field.is_kept) continue;
        if (key->kind == RULE_OBJECT) {
            *(TextureSlot *)at = texture_slot(file, tree_member(extension, key->name));
        } else if (key->kind == RULE_NUMBERS) {
            for (int i = 0; i < key->most; i++) ((float *)at)[i] = key->field.usual;
            tree_floats(extension, key->name, key->most, at);
        } else {
            *(float *)at = tree_float(extension, key->name, key->field.usual);
        }
    }
}

/* value NULL: glTF's default material; then no file is needed. */
static void read_layers(GltfFile *file, const GltfValue *value, Material *m) {
    for (int i = 0; i < material_layer_count; i++) {
        const MaterialLayer *layer = &material_layers[i];
        const GltfValue *own = tree_extension(value, layer->rule.name);
        if (layer->size && !material_layer_shows(layer, own)) continue;
        if (layer->size) {
            void *made = arena_alloc(file->load->arena, layer->size, _Alignof(max_align_t), 1);
            memcpy((char *)m + layer->at, &made, sizeof made);
        }
        read_keys(file, own, layer->rule.schema->rules, material_layer_struct(layer, m));
    }
}

/* ---- core ------------------------------------------------------------------------------ */

static Material default_material(const char *name) {
    TextureSlot none = texture_slot_none();
    Material m = {.name = name,
                  .base_color = {1, 1, 1, 1},
                  .metallic = 1,
                  .roughness = 1,
                  .base_color_texture = none,
                  .metallic_roughness_texture = none,
                  .normal_texture = none,
                  .emissive_texture = none,
                  .normal_scale = {1, 1},
                  .clearcoat_normal_scale = {1, 1},
                  .alpha_cutoff = 0.5f,
                  .display_id = NO_ID,
                  .base_color_curve_id = NO_ID,
                  .specular_curve_id = NO_ID,
                  .transmission_curve_id = NO_ID,
                  .emission_curve_id = NO_ID};
    read_layers(NULL, NULL, &m);
    return m;
}

static AlphaMode alpha_mode(const char *text) {
    return strcmp(text, "MASK") == 0    ? ALPHA_MASK
           : strcmp(text, "BLEND") == 0 ? ALPHA_BLEND
                                        : ALPHA_OPAQUE;
}

/* glTF's normal maps are green where they lean up; those of DirectX where they lean down, which
 * Microsoft Flight Simulator's extension says of all of a file. */
static Vec2 normal_scale(const GltfFile *file, const GltfValue *info) {
    const GltfValue *asset = tree_member(file->root, "asset");
    const GltfValue *of_asset = tree_extension(asset, NORMAL_CONVENTION_EXTENSION);
    const GltfValue *told =
        of_asset ? of_asset : tree_extension(file->root, NORMAL_CONVENTION_EXTENSION);
    bool is_down = strcmp(tree_text(told, "tangent_space_convention", ""), "DirectX") == 0;
    float scale = tree_float(info, "scale", 1);
    return (Vec2){scale, is_down ? -scale : scale};
}

static void read_core(GltfFile *file, const GltfValue *value, Material *m) {
    const GltfValue *pbr = tree_member(value, "pbrMetallicRoughness");
    const GltfValue *normal = tree_member(value, "normalTexture");
    tree_floats(pbr, "baseColorFactor", 4, m->base_color);
    m->base_color_texture = texture_slot(file, tree_member(pbr, "baseColorTexture"));
    m->metallic = tree_float(pbr, "metallicFactor", 1);
    m->roughness = tree_float(pbr, "roughnessFactor", 1);
    m->metallic_roughness_texture =
        texture_slot(file, tree_member(pbr, "metallicRoughnessTexture"));
    m->normal_texture = texture_slot(file, normal);
    m->normal_scale = normal_scale(file, normal);
    m->emissive_texture = texture_slot(file, tree_member(value, "emissiveTexture"));
    tree_floats(value, "emissiveFactor", 3, m->emissive_cd_m2);
    m->alpha_mode = alpha_mode(tree_text(value, "alphaMode", "OPAQUE"));
    m->alpha_cutoff = tree_float(value, "alphaCutoff", 0.5f);
    m->double_sided = tree_boolean(value, "doubleSided", false);
    if (tree_member(value, "occlusionTexture")) file->load->ignored_occlusion_count++;
}

/* ---- extensions ------------------------------------------------------------------------ */

static void read_extensions(GltfFile *file, const GltfValue *value, Material *m) {
    const GltfValue *coat = tree_extension(value, "KHR_materials_clearcoat");
    const GltfValue *volume = tree_extension(value, "KHR_materials_volume");
    float strength =
        tree_float(tree_extension(value, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    for (int i = 0; i < 3; i++) m->emissive_cd_m2[i] *= strength;
    m->unlit = tree_extension(value, "KHR_materials_unlit") != NULL;
    m->is_solid = tree_float(volume, "thicknessFactor", 0) > 0;
    read_layers(file, value, m);
    m->clearcoat_normal_scale = normal_scale(file, tree_member(coat, "clearcoatNormalTexture"));
    if (!m->brushing) return;
    m->brushing->cosine = cos_of(m->brushing->turn);
    m->brushing->sine = sin_of(m->brushing->turn);
}

static int read_curve(GltfFile *file, const GltfValue *uri, CurveRange range) {
    Loader *load = file->load;
    Curve curve;
    if (!uri || !curve_file_read(file, uri, range, &curve)) return NO_ID;
    *(Curve *)list_add(&load->curves, &load->scratch) = curve;
    return load->curves.count - 1;
}

/* An emission spectrum gives the colour; emissiveFactor and its strength give the amount. */
static void make_unit_luminance(GltfFile *file, const GltfValue *at, int curve_id) {
    Curve *curve = list_item(&file->load->curves, curve_id);
    double luminance = luminance_cd_m2(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
    if (!(luminance > 0)) {
        file_error(file, at, "the emission spectrum has no visible light");
        return;
    }
    for (int i = 0; i < CURVE_COUNT; i++)
        curve->value[i] = (float)((double)curve->value[i] / luminance);
}

static void read_spectra(GltfFile *file, const GltfValue *spectrum, Material *m) {
    m->base_color_curve_id = read_curve(file, tree_member(spectrum, "baseColor"), CURVE_SHARES);
    m->transmission_curve_id =
        read_curve(file, tree_member(spectrum, "transmission"), CURVE_SHARES);
    m->specular_curve_id = read_curve(file, tree_member(spectrum, "specular"), CURVE_AMOUNTS);
    m->emission_curve_id = read_curve(file, tree_member(spectrum, "emission"), CURVE_AMOUNTS);
    m->conductor = curve_file_index(file, tree_member(spectrum, "conductor"));
    if (m->emission_curve_id != NO_ID)
        make_unit_luminance(file, tree_member(spectrum, "emission"), m->emission_curve_id);
}

/* ---- all of them ----------------------------------------------------------------------- */

void material_derive_flags(Material *m) {
    m->is_emitter = any_positive(m->emissive_cd_m2) || m->display_id != NO_ID ||
                    (m->unlit && any_positive(m->base_color));
    bool is_pane = m->transmission > 0 && !m->is_solid && m->display_id == NO_ID;
    m->lets_light_through = m->alpha_mode != ALPHA_OPAQUE || is_pane;
}

static int add_material(Loader *load, Material material, const int sets[SCENE_UV_SETS]) {
    *(Material *)list_add(&load->materials, &load->scratch) = material;
    memcpy(list_add(&load->material_uv_sets, &load->scratch), sets, 2 * sizeof *sets);
    return load->materials.count - 1;
}

/* The mark that `equip` leaves; who measured the material since has left it behind. */
static const char *guess_of(GltfFile *file, const GltfValue *value, const Material *m) {
    const char *usual = tree_text(tree_member(value, "extras"), "equipped as", "");
    bool is_measured = m->base_color_curve_id != NO_ID || m->glazing || m->conductor;
    return usual[0] && !is_measured ? load_keep(file->load, usual) : NULL;
}

static void build_material(GltfFile *file, const GltfValue *value) {
    Loader *load = file->load;
    Material m = default_material(load_name(load, value, "material"));
    int id = load->materials.count, sets[SCENE_UV_SETS];
    const GltfValue *display = tree_extension(value, "PARHELION_display");
    read_core(file, value, &m);
    read_extensions(file, value, &m);
    read_spectra(file, tree_extension(value, "PARHELION_spectrum"), &m);
    measured_index_build(file, value, &m);
    glazing_build(file, tree_extension(value, "PARHELION_glazing"), &m);
    m.coating = coating_read(file, tree_extension(value, "PARHELION_coating"));
    m.guessed_as = guess_of(file, value, &m);
    add_material(load, m, (int[SCENE_UV_SETS]){0, 1});
    if (display) display_build(file, display, id);
    Material *added = list_item(&load->materials, id);
    Display *shown =
        added->display_id == NO_ID ? NULL : list_item(&load->displays, added->display_id);
    texture_slots_place(file, value, added, shown ? &shown->content : NULL, sets);
    memcpy(list_item(&load->material_uv_sets, id), sets, sizeof sets);
}

void materials_build(GltfFile *file) {
    file->material_base = file->load->materials.count;
    file->default_material_id = NO_ID;
    for (const GltfValue *m = tree_items(file->root, "materials"); m; m = tree_next(m))
        build_material(file, m);
}

int material_default(GltfFile *file) {
    if (file->default_material_id == NO_ID)
        file->default_material_id =
            add_material(file->load, default_material("default"), (int[SCENE_UV_SETS]){0, 1});
    return file->default_material_id;
}

int material_add_matt(Loader *load, const char *name, float reflectance) {
    Material m = default_material(load_keep(load, name));
    for (int i = 0; i < 3; i++) m.base_color[i] = reflectance;
    m.metallic = 0;
    m.specular = 0;
    return add_material(load, m, (int[SCENE_UV_SETS]){0, 1});
}
