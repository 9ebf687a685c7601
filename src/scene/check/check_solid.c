/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_solid.h"

#include <math.h>

#include "scene/check/check_coating.h"

static void not_shown(const DocumentCheck *check, const GltfValue *value, const char *what)
{
    if (value)
        check_warns(check, value, "has no effect: KHR_materials_volume makes the material a "
                                  "closed solid, %s", what);
}

static bool is_coloured(const GltfValue *color, double grey)
{
    bool differs = false;
    for (int i = 0; color && i < color->count; i++)
        differs |= fabs(color->items[i].number - grey) > 0;
    return differs;
}

/* Layers of a surface that a solid's boundary does not have. */
static void check_layers(const DocumentCheck *check, const GltfValue *material)
{
    const GltfValue *sheen = tree_extension(material, "KHR_materials_sheen");
    const GltfValue *coat = tree_extension(material, "KHR_materials_clearcoat");
    const GltfValue *specular = tree_extension(material, "KHR_materials_specular");
    const GltfValue *across = tree_extension(material, "KHR_materials_diffuse_transmission");
    const GltfValue *color = tree_member(specular, "specularColorFactor");
    if (is_coloured(tree_member(sheen, "sheenColorFactor"), 0))
        not_shown(check, sheen, "on which sheen is not shown");
    if (tree_number(across, "diffuseTransmissionFactor", 0) > 0)
        check_warns(check, across, "is not seen: KHR_materials_transmission makes the solid "
                                   "clear");
    if (tree_number(coat, "clearcoatFactor", 0) > 0)
        not_shown(check, coat, "on which no coat is shown");
    if (fabs(tree_number(specular, "specularFactor", 1) - 1) > 0 || is_coloured(color, 1))
        not_shown(check, specular, "which reflects as its index says");
    not_shown(check, tree_member(specular, "specularTexture"),
              "which reflects as its index says");
    not_shown(check, tree_member(specular, "specularColorTexture"),
              "which reflects as its index says");
}

/* Shares of a metal or of an opaque body. */
static void check_shares(const DocumentCheck *check, const GltfValue *material)
{
    const GltfValue *pbr = tree_member(material, "pbrMetallicRoughness");
    const GltfValue *clear = tree_extension(material, "KHR_materials_transmission");
    const GltfValue *metallic = tree_member(pbr, "metallicFactor");
    double metal = tree_number(pbr, "metallicFactor", 1);
    double through = tree_number(clear, "transmissionFactor", 0);
    if (metal > 0)
        check_warns(check, metallic ? metallic : pbr ? pbr : material,
                    "is %.9g of metal%s: KHR_materials_volume makes the material a closed "
                    "solid, which is clear as a whole; metallicFactor 0 is wanted", metal,
                    metallic ? "" : " (metallicFactor's default)");
    if (through < 1)
        check_warns(check, tree_member(clear, "transmissionFactor"),
                    "is %.9g: KHR_materials_volume makes the material a closed solid, which is "
                    "clear as a whole; transmissionFactor 1 is wanted", through);
    not_shown(check, tree_member(clear, "transmissionTexture"), "which is clear as a whole");
}

void check_clear_solid(const DocumentCheck *check, const GltfValue *material)
{
    if (!material_is_clear_solid(material)) return;
    check_layers(check, material);
    check_shares(check, material);
}
