/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/foreign_extensions.h"

#include <stdio.h>
#include <string.h>

#include "base/count.h"

/* What stands for the beginning of a name. */
typedef struct Known {
    const char *beginning, *words;
} Known;

static const Known MAKERS[] = {
    {"ASOBO_", "Asobo Studio's, for Microsoft Flight Simulator"},
    {"MSFT_", "Microsoft's"},
    {"AGI_", "Analytical Graphics', for Systems Tool Kit"},
    {"CESIUM_", "Cesium's"},
    {"MAXAR_", "Maxar's"},
    {"ADOBE_", "Adobe's"},
    {"FB_", "Facebook's"},
    {"GODOT_", "the Godot engine's"},
    {"GRIFFEL_", "Griffel's"},
    {"MOZ_", "Mozilla's, for Hubs"},
    {"MPEG_", "MPEG's"},
    {"NV_", "NVIDIA's"},
    {"OMI_", "the Open Metaverse Interoperability Group's"},
    {"VRM", "the VRM Consortium's"},
};

/* The first that fits counts. */
static const Known WHAT[] = {
    {"ASOBO_asset_optimized",
     "geometry as the simulator packs it, with slices of shared accessors, half floats "
     "and triangles turned round"},
    {"ASOBO_primitive", "slices of shared vertices and indices"},
    {"ASOBO_animation_retargeting", "animations of other skeletons"},
    {"ASOBO_collision_object", "shapes to collide with"},
    {"ASOBO_extra_occlusion", "shades of other parts"},
    {"ASOBO_facial_animation", "faces that move"},
    {"ASOBO_gizmo_object", "shapes to collide with"},
    {"ASOBO_macro_light", "the simulator's lamps"},
    {"ASOBO_property_animation", "materials that change with time"},
    {"ASOBO_softbody_mesh", "cloth that moves"},
    {"ASOBO_tags", "marks of roads and of shapes to collide with"},
    {"ASOBO_unique_id", "the simulator's own names of nodes"},
    {"ASOBO_material_alphamode_dither", "dithered transparency"},
    {"ASOBO_material_anisotropic", "brushed metal"},
    {"ASOBO_material_antialiasing", "how edges are smoothed"},
    {"ASOBO_material_blend_gbuffer", "decals that change what lies below them"},
    {"ASOBO_material_clear_coat", "a clear coat"},
    {"ASOBO_material_code", "which of the simulator's materials it is"},
    {"ASOBO_material_day_night", "what glows at night only"},
    {"ASOBO_material_detail_map", "a second, finer layer of textures"},
    {"ASOBO_material_dirt", "dirt and scratches"},
    {"ASOBO_material_disable_motion_blur", "parts that are not blurred"},
    {"ASOBO_material_draw_order", "which part is drawn over which"},
    {"ASOBO_material_emissive", "how much it glows"},
    {"ASOBO_material_environment_occluder", "parts that only hide reflections, and are shown here"},
    {"ASOBO_material_fake_terrain", "ground that the simulator's terrain covers"},
    {"ASOBO_material_flip_back_face", "backs whose normals are turned"},
    {"ASOBO_material_foliage_mask", "leaves"},
    {"ASOBO_material_fresnel_fade", "parts that fade at grazing angles"},
    {"ASOBO_material_geometry_decal", "decals that change what lies below them"},
    {"ASOBO_material_ghost_effect", "parts that fade at grazing angles"},
    {"ASOBO_material_glass", "glass with its refraction and tint"},
    {"ASOBO_material_invisible", "parts that the simulator does not draw, and are shown here"},
    {"ASOBO_material_iridescent", "a thin film"},
    {"ASOBO_material_kitty_glass", "glass with its refraction and tint"},
    {"ASOBO_material_occlusion_strength", "how strong baked shades are"},
    {"ASOBO_material_parallax_window", "rooms behind windows"},
    {"ASOBO_material_pearlescent", "pearly paint"},
    {"ASOBO_material_rain_options", "drops of rain"},
    {"ASOBO_material_sail", "cloth that light shines through"},
    {"ASOBO_material_shadow_options", "parts that cast no shadow, and do here"},
    {"ASOBO_material_SSS", "light that is scattered below the surface"},
    {"ASOBO_material_tire", "tyres with mud and dust"},
    {"ASOBO_material_UV_options", "textures that are repeated and moved otherwise"},
    {"ASOBO_material_vegetation", "leaves"},
    {"ASOBO_material_windshield", "a windscreen with rain, wipers and scratches"},
    {"ASOBO_material_", "a material of the simulator's own"},
    {"ASOBO_", "what the simulator alone reads"},
    {"MSFT_texture_dds", "pictures in DDS"},
    {"MSFT_lod", "coarser models for greater distances"},
    {"MSFT_packing_", "roughness, metal and shades in other channels of a texture"},
    {"MSFT_", "what Microsoft's programs read"},
    {"AGI_articulations", "parts that move"},
    {"AGI_stk_metadata", "solar panels and the like"},
    {"CESIUM_primitive_outline", "lines along edges"},
    {"CESIUM_RTC", "where the model stands on Earth"},
    {"MAXAR_image_ortho", "where a picture lies on Earth"},
    {"MAXAR_temporal_light_traits", "lamps that blink"},
    {"ADOBE_materials_clearcoat_specular", "the colour and index of a coat"},
    {"ADOBE_materials_clearcoat_tint", "the colour of a coat"},
    {"ADOBE_materials_thin_transparency", "thin glass"},
    {"FB_geometry_metadata", "how much a scene holds"},
    {"GODOT_single_root", "how a scene is nested"},
    {"GRIFFEL_bim_data", "data of a building"},
    {"MOZ_lightmap", "light that was baked into a texture"},
    {"NV_materials_mdl", "materials in NVIDIA's language MDL"},
    {"VRMC_", "avatars"},
    {"VRM", "avatars"},
};

static const char *find(const Known *known, int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (strncmp(known[i].beginning, name, strlen(known[i].beginning)) == 0)
            return known[i].words;
    return NULL;
}

const char *foreign_extension_note(const char *name, char *buffer) {
    const char *maker = find(MAKERS, COUNT_OF(MAKERS), name);
    const char *what = find(WHAT, COUNT_OF(WHAT), name);
    if (!maker) return "";
    snprintf(buffer, FOREIGN_NOTE_SIZE, " (%s%s%s)", maker, what ? ": " : "", what ? what : "");
    return buffer;
}
