/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_optics.h"

#include <math.h>

#include "scene/check/material_layers.h"
#include "spectrum/dispersion.h"

/* ---- layers ----------------------------------------------------------------------------- */

/* A number from 0 to 100, or the name of a file of rows nm,n,k. */
static bool check_index_value(const DocumentCheck *check, const GltfValue *value) {
    if (!value || value->kind == GLTF_STRING) return true;
    if (value->kind != GLTF_NUMBER)
        check_fails(check, value, "is neither a number nor the name of a file of rows nm,n,k");
    else if (!(value->number >= 0 && value->number <= INDEX_MAX))
        check_fails(check, value,
                    "is %.9g, a number from 0 to %g or the name of a file of rows nm,n,k is "
                    "required",
                    value->number, INDEX_MAX);
    else return true;
    return false;
}

void check_layer(const DocumentCheck *check, const GltfValue *layer) {
    const GltfValue *n = tree_member(layer, "n"), *k = tree_member(layer, "k");
    bool ok = check_index_value(check, n) && check_index_value(check, k);
    bool is_dark = (k && k->kind == GLTF_STRING) || tree_number(layer, "k", 0) > 0;
    if (ok && n && n->kind == GLTF_NUMBER && n->number == 0 && !is_dark)
        check_fails(check, n, "is 0 and so is k: one of them above 0 is required");
}

void check_coating(const DocumentCheck *check, const GltfValue *coating) {
    const GltfValue *layers = tree_member(coating, "layers");
    const GltfValue *stack = tree_member(coating, "stack");
    if (!layers && !stack)
        check_fails(check, coating, "holds neither \"layers\" nor \"stack\", one is required");
    if (layers && stack)
        check_fails(check, stack, "stands beside \"layers\", one of them is required");
    if (layers && layers->kind == GLTF_ARRAY && layers->count > THIN_LAYERS_MAX)
        check_fails(check, layers, "has %d layers, up to %d are required", layers->count,
                    THIN_LAYERS_MAX);
}

/* ---- clear solids ----------------------------------------------------------------------- */

static bool material_is_clear_solid(const GltfValue *material) {
    const GltfValue *volume = tree_extension(material, "KHR_materials_volume");
    const GltfValue *clear = tree_extension(material, "KHR_materials_transmission");
    return tree_number(volume, "thicknessFactor", 0) > 0 &&
           tree_number(clear, "transmissionFactor", 0) > 0;
}

static void not_shown(const DocumentCheck *check, const GltfValue *value, const char *what) {
    if (value) check_warns(check, value, ON_CLOSED_SOLID "%s", what);
}

static bool is_coloured(const GltfValue *color, double grey) {
    bool differs = false;
    for (int i = 0; color && i < color->count; i++)
        differs |= fabs(color->items[i].number - grey) > 0;
    return differs;
}

/* Layers of a surface that a solid's boundary does not have; the outer ones first. */
static void check_layers(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *specular = tree_extension(material, "KHR_materials_specular");
    const GltfValue *color = tree_member(specular, "specularColorFactor");
    for (int i = material_layer_count - 1; i >= 0; i--) {
        const GltfValue *layer = tree_extension(material, material_layers[i].rule.name);
        if (material_layers[i].on_solid && material_layer_shows(&material_layers[i], layer))
            check_warns(check, layer, "%s", material_layers[i].on_solid);
    }
    if (fabs(tree_number(specular, "specularFactor", 1) - 1) > 0 || is_coloured(color, 1))
        not_shown(check, specular, "which reflects as its index says");
    not_shown(check, tree_member(specular, "specularTexture"), "which reflects as its index says");
    not_shown(check, tree_member(specular, "specularColorTexture"),
              "which reflects as its index says");
}

/* Shares of a metal or of an opaque body. */
static void check_shares(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *pbr = tree_member(material, "pbrMetallicRoughness");
    const GltfValue *clear = tree_extension(material, "KHR_materials_transmission");
    const GltfValue *metallic = tree_member(pbr, "metallicFactor");
    double metal = tree_number(pbr, "metallicFactor", 1);
    double through = tree_number(clear, "transmissionFactor", 0);
    if (metal > 0)
        check_warns(check,
                    metallic ? metallic
                    : pbr    ? pbr
                             : material,
                    "is %.9g of metal%s: KHR_materials_volume makes the material a closed "
                    "solid, which is clear as a whole; metallicFactor 0 is required",
                    metal, metallic ? "" : " (metallicFactor's default)");
    if (through < 1)
        check_warns(check, tree_member(clear, "transmissionFactor"),
                    "is %.9g: KHR_materials_volume makes the material a closed solid, which is "
                    "clear as a whole; transmissionFactor 1 is required",
                    through);
    not_shown(check, tree_member(clear, "transmissionTexture"), "which is clear as a whole");
}

void check_clear_solid(const DocumentCheck *check, const GltfValue *material) {
    if (!material_is_clear_solid(material)) return;
    check_layers(check, material);
    check_shares(check, material);
}

/* ---- materials with coatings ------------------------------------------------------------- */

static void check_body(const DocumentCheck *check, const GltfValue *material,
                       const GltfValue *coating, bool has_conductor) {
    const GltfValue *pbr = tree_member(material, "pbrMetallicRoughness");
    const GltfValue *coat = tree_extension(material, "KHR_materials_clearcoat");
    double metallic = tree_number(pbr, "metallicFactor", 1);
    if (metallic > 0 && !has_conductor && !material_is_clear_solid(material))
        check_fails(check, coating,
                    "lies on a metal (metallicFactor %.9g) whose n and k are not known: a "
                    "PARHELION_spectrum with \"conductor\", or metallicFactor 0, is required",
                    metallic);
    if (tree_number(coat, "clearcoatFactor", 0) > 0)
        check_fails(check, coating,
                    "stands beside KHR_materials_clearcoat, one of them is required");
}

static void check_hidden(const DocumentCheck *check, const GltfValue *material,
                         const MaterialLayer *layer) {
    const GltfValue *own = tree_extension(material, layer->rule.name);
    if (!layer->hidden_by || !material_layer_shows(layer, own)) return;
    for (int i = 0; layer->hidden_by[i]; i++)
        if (tree_extension(material, layer->hidden_by[i]))
            check_warns(check, own, "has no effect beside %s", layer->hidden_by[i]);
}

static void check_clear_coat(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *coat = tree_extension(material, "KHR_materials_clearcoat");
    if (tree_number(coat, "clearcoatFactor", 0) > 0 &&
        tree_extension(material, "PARHELION_display"))
        check_warns(check, coat,
                    "has no effect beside PARHELION_display: the panel was "
                    "measured with all that lies on it");
}

void check_coated_material(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *coating = tree_extension(material, "PARHELION_coating");
    const GltfValue *ior = tree_extension(material, "KHR_materials_ior");
    const GltfValue *conductor =
        tree_member(tree_extension(material, "PARHELION_spectrum"), "conductor");
    const GltfValue *pbr = tree_member(material, "pbrMetallicRoughness");
    const GltfValue *measured =
        tree_member(tree_member(tree_extension(material, "OpenMaterial_material_parameters"),
                                "physical_properties"),
                    "refractive_index_uri");
    bool is_known = conductor || (measured && measured->text[0]);
    if (conductor && tree_number(pbr, "metallicFactor", 1) <= 0)
        check_warns(check, conductor, "has no effect: metallicFactor is 0");
    for (int i = 0; i < material_layer_count; i++)
        check_hidden(check, material, &material_layers[i]);
    check_clear_coat(check, material);
    if (!coating) return;
    if (tree_extension(material, "KHR_materials_unlit"))
        check_warns(check, coating, "has no effect beside KHR_materials_unlit");
    if (tree_extension(material, "PARHELION_glazing"))
        check_fails(check, coating, "stands beside PARHELION_glazing, one of them is required");
    if (ior && tree_number(ior, "ior", 1.5) == 0)
        check_fails(check, coating,
                    "lies on a body of infinite index (ior 0): a number of at "
                    "least 1 is required there");
    if (!tree_extension(material, "PARHELION_display"))
        check_body(check, material, coating, is_known);
}

/* ---- a measured index ------------------------------------------------------------------- */

/* The file's name; NULL: none, or reported. */
static const GltfValue *measured_in(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *parameters = tree_extension(material, "OpenMaterial_material_parameters");
    const GltfValue *physical = tree_member(parameters, "physical_properties");
    const GltfValue *uri = tree_member(physical, "refractive_index_uri");
    if (physical && physical->kind != GLTF_OBJECT)
        check_fails(check, physical, "is no object, one is required");
    if (uri && uri->kind != GLTF_STRING)
        check_fails(check, uri, "is no text, the name of a file of n and k is required");
    return uri && uri->kind == GLTF_STRING && uri->text[0] ? uri : NULL;
}

static void check_measured(const DocumentCheck *check, const GltfValue *material,
                           const GltfValue *uri) {
    const GltfValue *conductor =
        tree_member(tree_extension(material, "PARHELION_spectrum"), "conductor");
    if (conductor)
        check_warns(check, uri, "is not used: PARHELION_spectrum has \"conductor\" for it");
    if (tree_extension(material, "PARHELION_coating") && material_is_clear_solid(material))
        check_fails(check, uri,
                    "stands beside PARHELION_coating on a solid, one of them is "
                    "required: coatings are worked out for one index");
}

/* ---- dispersion ------------------------------------------------------------------------- */

static void check_dispersion(const DocumentCheck *check, const GltfValue *material,
                             const GltfValue *dispersion, bool is_measured) {
    double strength = tree_number(dispersion, "dispersion", 0);
    double nd = tree_number(tree_extension(material, "KHR_materials_ior"), "ior", 1.5);
    if (!(strength > 0)) return;
    if (is_measured) {
        check_warns(check, dispersion,
                    "is not used: the index is measured "
                    "(OpenMaterial_material_parameters)");
        return;
    }
    if (!material_is_clear_solid(material)) {
        check_warns(check, dispersion,
                    "spreads nothing: light is bent in solids alone, KHR_materials_volume with "
                    "a thickness and KHR_materials_transmission");
        return;
    }
    if (tree_extension(material, "PARHELION_coating"))
        check_fails(check, dispersion,
                    "stands beside PARHELION_coating on a solid, one of "
                    "them is required: coatings are worked out for one "
                    "index");
    double most = dispersion_index(nd, strength, CURVE_FIRST_NM);
    if (most > INDEX_MAX)
        check_fails(check, tree_member(dispersion, "dispersion"),
                    "is %.9g: the index at %d nm would be %.4g, up to %g is required", strength,
                    CURVE_FIRST_NM, most, INDEX_MAX);
}

void check_index(const DocumentCheck *check, const GltfValue *material) {
    const GltfValue *dispersion = tree_extension(material, "KHR_materials_dispersion");
    const GltfValue *uri = measured_in(check, material);
    if (uri) check_measured(check, material, uri);
    if (dispersion) check_dispersion(check, material, dispersion, uri != NULL);
}
