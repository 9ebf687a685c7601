/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_index.h"

#include "scene/check/check_coating.h"
#include "spectrum/dispersion.h"

/* ---- a measured index ------------------------------------------------------------------- */

/* The file's name; NULL: none, or reported. */
static const GltfValue *measured_in(const DocumentCheck *check, const GltfValue *material)
{
    const GltfValue *parameters =
        tree_extension(material, "OpenMaterial_material_parameters");
    const GltfValue *physical = tree_member(parameters, "physical_properties");
    const GltfValue *uri = tree_member(physical, "refractive_index_uri");
    if (physical && physical->kind != GLTF_OBJECT)
        check_fails(check, physical, "is no object, one is wanted");
    if (uri && uri->kind != GLTF_STRING)
        check_fails(check, uri, "is no text, the name of a file of n and k is wanted");
    return uri && uri->kind == GLTF_STRING && uri->text[0] ? uri : NULL;
}

static void check_measured(const DocumentCheck *check, const GltfValue *material,
                           const GltfValue *uri)
{
    const GltfValue *conductor =
        tree_member(tree_extension(material, "PARHELION_spectrum"), "conductor");
    if (conductor)
        check_warns(check, uri, "is not used: PARHELION_spectrum has \"conductor\" for it");
    if (tree_extension(material, "PARHELION_coating") && material_is_clear_solid(material))
        check_fails(check, uri, "stands beside PARHELION_coating on a solid, one of them is "
                                "wanted: coatings are worked out for one index");
}

/* ---- dispersion ------------------------------------------------------------------------- */

static void check_dispersion(const DocumentCheck *check, const GltfValue *material,
                             const GltfValue *dispersion, bool is_measured)
{
    double strength = tree_number(dispersion, "dispersion", 0);
    double nd = tree_number(tree_extension(material, "KHR_materials_ior"), "ior", 1.5);
    if (!(strength > 0)) return;
    if (is_measured) {
        check_warns(check, dispersion, "is not used: the index is measured "
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
        check_fails(check, dispersion, "stands beside PARHELION_coating on a solid, one of "
                                       "them is wanted: coatings are worked out for one index");
    double most = dispersion_index(nd, strength, CURVE_FIRST_NM);
    if (most > INDEX_MAX)
        check_fails(check, tree_member(dispersion, "dispersion"),
                    "is %.9g: the index at %d nm would be %.4g, up to %g is wanted", strength,
                    CURVE_FIRST_NM, most, INDEX_MAX);
}

void check_index(const DocumentCheck *check, const GltfValue *material)
{
    const GltfValue *dispersion = tree_extension(material, "KHR_materials_dispersion");
    const GltfValue *uri = measured_in(check, material);
    if (uri) check_measured(check, material, uri);
    if (dispersion) check_dispersion(check, material, dispersion, uri != NULL);
}
