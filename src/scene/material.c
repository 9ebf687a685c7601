#include <string.h>

#include "base/mathd.h"
#include "scene/load.h"
#include "spectrum/photometry.h"

static TextureSlot no_texture(void)
{
    return (TextureSlot){.texture_id = NO_ID, .uv_from_uv = {1, 0, 0, 0, 1, 0}};
}

/* KHR_texture_transform: uv' = T R S uv, where R is a turn by -rotation in the (u, v) plane as
 * the extension writes it: u' = sx cos u + sy sin v + ox, v' = -sx sin u + sy cos v + oy. */
static void apply_transform(const GltfValue *transform, TextureSlot *slot)
{
    float offset[2] = {0, 0}, scale[2] = {1, 1};
    float turn = tree_float(transform, "rotation", 0);
    float c = cos_of(turn), s = sin_of(turn);
    tree_floats(transform, "offset", 2, offset);
    tree_floats(transform, "scale", 2, scale);
    float matrix[6] = {scale[0] * c,  scale[1] * s, offset[0],
                       -scale[0] * s, scale[1] * c, offset[1]};
    memcpy(slot->uv_from_uv, matrix, sizeof matrix);
    slot->uv_set = tree_int(transform, "texCoord", slot->uv_set);
}

TextureSlot texture_slot(GltfFile *file, const GltfValue *info)
{
    TextureSlot slot = no_texture();
    int index = tree_int(info, "index", NO_ID);
    if (index < 0) return slot;
    slot.texture_id = file->texture_base + index;
    slot.uv_set = tree_int(info, "texCoord", 0);
    const GltfValue *transform = tree_extension(info, "KHR_texture_transform");
    if (transform) apply_transform(transform, &slot);
    const Texture *texture = list_item(&file->load->textures, slot.texture_id);
    if (texture->image.width > 0) return slot;
    if (!tree_member(tree_element(file->root, "textures", index), "source"))
        file_warning(file, info, "texture %d has no PNG or JPEG source: it is left out", index);
    return no_texture();
}

/* ---- which uv sets does a material need? ----------------------------------------------- */

#define SLOTS_OF_A_MATERIAL 11

static void collect_slots(Material *m, TextureSlot *slots[SLOTS_OF_A_MATERIAL])
{
    TextureSlot *all[SLOTS_OF_A_MATERIAL] = {&m->base_color_texture,
                                             &m->metallic_roughness_texture,
                                             &m->normal_texture,
                                             &m->emissive_texture,
                                             &m->specular_texture,
                                             &m->specular_color_texture,
                                             &m->transmission_texture,
                                             &m->clearcoat_texture,
                                             &m->clearcoat_roughness_texture,
                                             &m->clearcoat_normal_texture,
                                             NULL};
    memcpy(slots, all, sizeof all);
}

/* Puts a set among the two; false when both are taken by others. */
static bool claim_set(int sets[SCENE_UV_SETS], int set)
{
    for (int i = 0; i < SCENE_UV_SETS; i++) {
        if (sets[i] == NO_ID) sets[i] = set;
        if (sets[i] == set) return true;
    }
    return false;
}

/* Vertex.uv has two places: the smallest set that is used first, or set 0 where it fits, so
 * that uv[0] is what every viewer would show. */
static void order_sets(int sets[SCENE_UV_SETS])
{
    if (sets[1] == NO_ID && sets[0] > 0) sets[1] = 0;
    if (sets[0] == NO_ID) sets[0] = 0;
    if (sets[1] != NO_ID && sets[1] < sets[0]) {
        int first = sets[1];
        sets[1] = sets[0];
        sets[0] = first;
    }
    if (sets[1] == NO_ID) sets[1] = 1;
}

/* From the file's TEXCOORD numbers to places in Vertex.uv. */
static void place_uv_sets(GltfFile *file, const GltfValue *value, Material *material,
                          TextureSlot *content, int sets[SCENE_UV_SETS])
{
    TextureSlot *slots[SLOTS_OF_A_MATERIAL];
    collect_slots(material, slots);
    slots[SLOTS_OF_A_MATERIAL - 1] = content;
    sets[0] = sets[1] = NO_ID;
    for (int i = 0; i < SLOTS_OF_A_MATERIAL; i++) {
        if (!slots[i] || slots[i]->texture_id == NO_ID) continue;
        if (!claim_set(sets, slots[i]->uv_set)) {
            file_error(file, value,
                       "the textures of \"%s\" use TEXCOORD_%d, _%d and _%d; at most "
                       "two sets are carried",
                       material->name, sets[0], sets[1], slots[i]->uv_set);
            return;
        }
    }
    order_sets(sets);
    for (int i = 0; i < SLOTS_OF_A_MATERIAL; i++)
        if (slots[i]) slots[i]->uv_set = slots[i]->uv_set == sets[1];
}

/* ---- core ------------------------------------------------------------------------------ */

static Material default_material(const char *name)
{
    TextureSlot none = no_texture();
    return (Material){.name = name,
                      .base_color = {1, 1, 1, 1},
                      .metallic = 1,
                      .roughness = 1,
                      .base_color_texture = none,
                      .metallic_roughness_texture = none,
                      .normal_texture = none,
                      .emissive_texture = none,
                      .specular_texture = none,
                      .specular_color_texture = none,
                      .transmission_texture = none,
                      .clearcoat_texture = none,
                      .clearcoat_roughness_texture = none,
                      .clearcoat_normal_texture = none,
                      .normal_scale = 1,
                      .clearcoat_normal_scale = 1,
                      .alpha_cutoff = 0.5f,
                      .ior = 1.5f,
                      .specular = 1,
                      .specular_color = {1, 1, 1},
                      .attenuation_color = {1, 1, 1},
                      .attenuation_distance_m = INFINITY,
                      .display_id = NO_ID,
                      .base_color_curve_id = NO_ID,
                      .specular_curve_id = NO_ID,
                      .transmission_curve_id = NO_ID,
                      .emission_curve_id = NO_ID};
}

static AlphaMode alpha_mode(const char *text)
{
    return strcmp(text, "MASK") == 0    ? ALPHA_MASK
           : strcmp(text, "BLEND") == 0 ? ALPHA_BLEND
                                        : ALPHA_OPAQUE;
}

static void read_core(GltfFile *file, const GltfValue *value, Material *m)
{
    const GltfValue *pbr = tree_member(value, "pbrMetallicRoughness");
    const GltfValue *normal = tree_member(value, "normalTexture");
    tree_floats(pbr, "baseColorFactor", 4, m->base_color);
    m->base_color_texture = texture_slot(file, tree_member(pbr, "baseColorTexture"));
    m->metallic = tree_float(pbr, "metallicFactor", 1);
    m->roughness = tree_float(pbr, "roughnessFactor", 1);
    m->metallic_roughness_texture =
        texture_slot(file, tree_member(pbr, "metallicRoughnessTexture"));
    m->normal_texture = texture_slot(file, normal);
    m->normal_scale = tree_float(normal, "scale", 1);
    m->emissive_texture = texture_slot(file, tree_member(value, "emissiveTexture"));
    tree_floats(value, "emissiveFactor", 3, m->emissive_cd_m2);
    m->alpha_mode = alpha_mode(tree_text(value, "alphaMode", "OPAQUE"));
    m->alpha_cutoff = tree_float(value, "alphaCutoff", 0.5f);
    m->double_sided = tree_boolean(value, "doubleSided", false);
    if (tree_member(value, "occlusionTexture")) file->load->ignored_occlusion_count++;
}

/* ---- extensions ------------------------------------------------------------------------ */

static void read_clearcoat(GltfFile *file, const GltfValue *coat, Material *m)
{
    const GltfValue *normal = tree_member(coat, "clearcoatNormalTexture");
    m->clearcoat = tree_float(coat, "clearcoatFactor", 0);
    m->clearcoat_texture = texture_slot(file, tree_member(coat, "clearcoatTexture"));
    m->clearcoat_roughness = tree_float(coat, "clearcoatRoughnessFactor", 0);
    m->clearcoat_roughness_texture =
        texture_slot(file, tree_member(coat, "clearcoatRoughnessTexture"));
    m->clearcoat_normal_texture = texture_slot(file, normal);
    m->clearcoat_normal_scale = tree_float(normal, "scale", 1);
}

static void read_volume(const GltfValue *volume, Material *m)
{
    m->is_solid = tree_float(volume, "thicknessFactor", 0) > 0;
    m->attenuation_distance_m = tree_float(volume, "attenuationDistance", INFINITY);
    tree_floats(volume, "attenuationColor", 3, m->attenuation_color);
}

static void read_extensions(GltfFile *file, const GltfValue *value, Material *m)
{
    const GltfValue *specular = tree_extension(value, "KHR_materials_specular");
    const GltfValue *transmission = tree_extension(value, "KHR_materials_transmission");
    float strength = tree_float(tree_extension(value, "KHR_materials_emissive_strength"),
                                "emissiveStrength", 1);
    for (int i = 0; i < 3; i++) m->emissive_cd_m2[i] *= strength;
    m->unlit = tree_extension(value, "KHR_materials_unlit") != NULL;
    m->ior = tree_float(tree_extension(value, "KHR_materials_ior"), "ior", 1.5f);
    m->specular = tree_float(specular, "specularFactor", 1);
    tree_floats(specular, "specularColorFactor", 3, m->specular_color);
    m->specular_texture = texture_slot(file, tree_member(specular, "specularTexture"));
    m->specular_color_texture =
        texture_slot(file, tree_member(specular, "specularColorTexture"));
    m->transmission = tree_float(transmission, "transmissionFactor", 0);
    m->transmission_texture =
        texture_slot(file, tree_member(transmission, "transmissionTexture"));
    read_clearcoat(file, tree_extension(value, "KHR_materials_clearcoat"), m);
    read_volume(tree_extension(value, "KHR_materials_volume"), m);
}

static int read_curve(GltfFile *file, const GltfValue *uri)
{
    Error err;
    FileBytes bytes;
    const char *path;
    Loader *load = file->load;
    if (!uri || !document_resolve(file, uri, &path)) return NO_ID;
    Curve *curve = list_add(&load->curves, &load->scratch);
    if (load_read(load, path, &load->scratch, &bytes, &err) &&
        curve_parse((const char *)bytes.data, path, curve, &err))
        return load->curves.count - 1;
    char line[1024];
    error_line(&err, line, sizeof line);
    file_error(file, uri, "%s", line);
    return NO_ID;
}

/* An emission spectrum tells the colour; emissiveFactor and its strength tell how much. */
static void make_unit_luminance(GltfFile *file, const GltfValue *at, int curve_id)
{
    Curve *curve = list_item(&file->load->curves, curve_id);
    double luminance = luminance_cd_m2(curve->value, CURVE_COUNT, CURVE_FIRST_NM, 1);
    if (!(luminance > 0)) {
        file_error(file, at, "the emission spectrum has no visible light");
        return;
    }
    for (int i = 0; i < CURVE_COUNT; i++)
        curve->value[i] = (float)((double)curve->value[i] / luminance);
}

static void read_spectra(GltfFile *file, const GltfValue *spectrum, Material *m)
{
    m->base_color_curve_id = read_curve(file, tree_member(spectrum, "baseColor"));
    m->transmission_curve_id = read_curve(file, tree_member(spectrum, "transmission"));
    m->specular_curve_id = read_curve(file, tree_member(spectrum, "specular"));
    m->emission_curve_id = read_curve(file, tree_member(spectrum, "emission"));
    if (m->emission_curve_id != NO_ID)
        make_unit_luminance(file, tree_member(spectrum, "emission"), m->emission_curve_id);
}

/* ---- all of them ----------------------------------------------------------------------- */

static bool any_positive(const float rgb[3])
{
    return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0;
}

void material_derive_flags(Material *m)
{
    m->is_emitter = any_positive(m->emissive_cd_m2) || m->display_id != NO_ID ||
                    (m->unlit && any_positive(m->base_color));
    m->lets_light_through = m->display_id == NO_ID && (m->alpha_mode != ALPHA_OPAQUE ||
                                                       (m->transmission > 0 && !m->is_solid));
}

static int add_material(Loader *load, Material material, const int sets[SCENE_UV_SETS])
{
    *(Material *)list_add(&load->materials, &load->scratch) = material;
    memcpy(list_add(&load->material_uv_sets, &load->scratch), sets, 2 * sizeof *sets);
    return load->materials.count - 1;
}

static void build_material(GltfFile *file, const GltfValue *value)
{
    Loader *load = file->load;
    const char *name = tree_text(value, "name", "");
    Material m =
        default_material(name[0] ? arena_string(load->arena, name, strlen(name))
                                 : arena_format(load->arena, "material %d", value->index));
    int id = load->materials.count, sets[SCENE_UV_SETS];
    const GltfValue *display = tree_extension(value, "PARHELION_display");
    read_core(file, value, &m);
    read_extensions(file, value, &m);
    read_spectra(file, tree_extension(value, "PARHELION_spectrum"), &m);
    add_material(load, m, (int[SCENE_UV_SETS]){0, 1});
    if (display) display_build(file, display, id);
    Material *added = list_item(&load->materials, id);
    Display *shown =
        added->display_id == NO_ID ? NULL : list_item(&load->displays, added->display_id);
    place_uv_sets(file, value, added, shown ? &shown->content : NULL, sets);
    memcpy(list_item(&load->material_uv_sets, id), sets, sizeof sets);
    material_derive_flags(added);
}

void materials_build(GltfFile *file)
{
    const GltfValue *materials = tree_member(file->root, "materials");
    file->material_base = file->load->materials.count;
    file->default_material_id = NO_ID;
    for (int i = 0; materials && i < materials->count; i++)
        build_material(file, &materials->items[i]);
}

int material_default(GltfFile *file)
{
    if (file->default_material_id == NO_ID)
        file->default_material_id =
            add_material(file->load, default_material("default"), (int[SCENE_UV_SETS]){0, 1});
    return file->default_material_id;
}
