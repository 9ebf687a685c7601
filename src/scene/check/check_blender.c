/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_blender.h"

#include <stdio.h>
#include <string.h>

#include "scene/check/material_layers.h"
#include "scene/gltf/document.h"

/* Blender's lamps: W * 683 lm/W / (4 pi) cd, a sun's W/m2 * 683 lx (lighting mode Standard); an
 * emission strength of 1, which is 1 W/(m2 sr) there, is written as 1 cd/m2. */
#define LUMENS_A_WATT 683

/* Of "Khronos glTF Blender I/O v3.4.50"; false: Blender did not write it. */
static bool blender_version(const GltfValue *root, int *major, int *minor)
{
    const char *by = tree_text(tree_member(root, "asset"), "generator", "");
    const char *at = strstr(by, "glTF Blender I/O v");
    return at && sscanf(at, "glTF Blender I/O v%d.%d", major, minor) == 2;
}

/* The add-on says so of what it makes of an area lamp (scenes/blender). */
static bool is_made_of_lamp(const GltfValue *value)
{
    return tree_member(tree_member(value, "extras"), "area_lamp_w") != NULL;
}

/* cd/m2 by its factor and strength; 0 where the strength is meant so. */
static double glow_of(const GltfValue *material)
{
    float rgb[3] = {0, 0, 0};
    const GltfValue *strength = tree_extension(material, "KHR_materials_emissive_strength");
    if (tree_extension(material, "PARHELION_display") || is_made_of_lamp(material)) return 0;
    tree_floats(material, "emissiveFactor", 3, rgb);
    return (double)fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])) *
           tree_number(strength, "emissiveStrength", 1);
}

static void check_units(const DocumentCheck *check, const GltfValue *root)
{
    const GltfValue *first = NULL;
    int others = 0;
    char more[40] = "";
    if (!tree_count(tree_extension(root, "KHR_lights_punctual"), "lights")) return;
    for (const GltfValue *m = tree_items(root, "materials"); m; m = tree_next(m)) {
        if (!(glow_of(m) > 0)) continue;
        others += first != NULL;
        if (!first) first = m;
    }
    if (!first) return;
    if (others) snprintf(more, sizeof more, " (so do %d others)", others);
    check_warns(check, first,
                "\"%.80s\" glows with %g cd/m2, its strength in Blender as it stands%s; beside "
                "lamps, which Blender writes times %d lm/W (lighting mode Standard), %g cd/m2 "
                "are meant: parhelion help first-dashboard",
                tree_text(first, "name", "a material"), glow_of(first), more, LUMENS_A_WATT,
                LUMENS_A_WATT * glow_of(first));
}

/* What Blender calls a new area lamp, or whoever exports says in custom properties. */
static bool is_area_lamp(const GltfValue *node)
{
    const GltfValue *extras = tree_member(node, "extras");
    const char *name = tree_text(node, "name", "");
    bool is_named = strncmp(name, "Area", 4) == 0 &&
                    strspn(name + 4, ".0123456789") == strlen(name + 4);
    for (int i = 0; extras && extras->kind == GLTF_OBJECT && i < extras->count; i++)
        is_named |= extras->items[i].kind == GLTF_STRING &&
                    strcmp(extras->items[i].text, "AREA") == 0;
    return is_named && !is_made_of_lamp(node) && !tree_member(node, "mesh") &&
           !tree_member(node, "camera") && !tree_member(node, "children") &&
           !tree_member(node, "extensions");
}

static void check_area_lamps(const DocumentCheck *check, const GltfValue *root)
{
    for (const GltfValue *n = tree_items(root, "nodes"); n; n = tree_next(n))
        if (is_area_lamp(n))
            check_warns(check, n,
                        "\"%.80s\" is empty, as Blender's exporter leaves area lamps: it gives "
                        "no light; a sheet that glows does, which the add-on makes of it: "
                        "parhelion help first-dashboard", tree_text(n, "name", ""));
}

/* Since 4.0 both are written; before 3.0 most other materials were lost as well. */
static void check_lost(const DocumentCheck *check, const GltfValue *root, int major, int minor)
{
    bool has_ior = document_uses(check->file, "KHR_materials_ior");
    char lost[80];
    int  length = 0;
    for (int i = 0; i < material_layer_count; i++) {
        const MaterialLayer *layer = &material_layers[i];
        if (!layer->lost || document_uses(check->file, layer->rule.name)) continue;
        length += snprintf(lost + length, sizeof lost - (size_t)length, "%s%s",
                           length ? " and " : "", layer->lost);
    }
    if (!tree_count(root, "materials") || !length) return;
    check_warns(check, tree_member(tree_member(root, "asset"), "generator"),
                "the exporter of Blender %d.%d leaves out %s of a Principled BSDF%s: "
                "parhelion help first-dashboard", major, minor, lost,
                has_ior ? "" : " (the latter but for clear materials)");
}

void check_blender(const DocumentCheck *check, const GltfValue *root)
{
    int major, minor;
    if (!blender_version(root, &major, &minor)) return;
    check_units(check, root);
    check_area_lamps(check, root);
    if (major == 3) check_lost(check, root, major, minor);
}
