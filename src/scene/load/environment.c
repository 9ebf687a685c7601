/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/environment.h"

#include <string.h>

#include "base/units.h"
#include "scene/check/schema.h"
#include "scene/check/schema_extensions.h"
#include "scene/gltf/document.h"
#include "scene/load/image.h"
#include "spectrum/photometry.h"

static float radians(const GltfValue *object, const char *name) {
    return (float)radians_from_degrees(tree_number(object, name, 0));
}

static EnvironmentKind kind_from_text(const char *type) {
    static const char *const NAMES[] = {"none", "constant", "hdri", "cie", "perez", "sky"};
    for (int i = 1; i <= ENVIRONMENT_SKY; i++)
        if (strcmp(type, NAMES[i]) == 0) return (EnvironmentKind)i;
    return ENVIRONMENT_NONE;
}

/* A colour gives the hue only: its luminance is taken off. */
static void read_color(GltfFile *file, const GltfValue *extension, float out[3]) {
    float color[3] = {1, 1, 1};
    tree_floats(extension, "color", 3, color);
    float luminance = luminance_from_rgb(color);
    if (!(luminance > 0)) {
        file_error(file, tree_member(extension, "color"),
                   "the colour is black; a colour of "
                   "positive luminance is required (luminance 0 makes it dark)");
        luminance = 1;
    }
    for (int i = 0; i < 3; i++) out[i] = color[i] / luminance;
}

static void read_sun(const GltfValue *sun, Environment *out) {
    out->sun_angular_radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG);
    if (!sun) return;
    out->has_sun = true;
    out->sun_azimuth = radians(sun, "azimuth_deg");
    out->sun_elevation = radians(sun, "elevation_deg");
    out->sun_illuminance_lx = tree_float(sun, "illuminance_lx", 0);
    if (tree_member(sun, "angular_radius_deg"))
        out->sun_angular_radius = radians(sun, "angular_radius_deg");
}

static void read_hdri(GltfFile *file, const GltfValue *extension, Environment *out) {
    Error err;
    const char *path;
    const GltfValue *uri = tree_member(extension, "uri");
    out->hdri_rotation = radians(extension, "rotation_deg");
    out->hdri_scale = tree_float(extension, "scale", 1);
    out->horizontal_illuminance_lx = tree_float(extension, "horizontal_illuminance_lx", 0);
    if (!uri || !document_resolve(file, uri, &path)) return;
    out->hdri_path = load_keep(file->load, path);
    LightPicture picture = {.image = {.format = IMAGE_RGBA32F}, .unit_cd_m2 = 1};
    bool is_read = load_light_picture(file->load, path, &picture, &err);
    out->hdri = picture.image;
    out->hdri_unit_cd_m2 = picture.unit_cd_m2;
    if (!is_read)
        file_error(file, uri, "%s: %s%s%s", path, err.path, err.path[0] ? ": " : "", err.text);
}

static void read_time_and_place(const GltfValue *extension, DaylightInput *out) {
    Error err;
    double place[3] = {0, 0, 0};
    const GltfValue *where = tree_member(extension, "where");
    const char *when = tree_text(extension, "when", "");
    /* the check has looked at it: a text that is no moment is an error there */
    out->has_time = *when && where && sky_time_parse(when, "", &out->when, &err);
    for (int i = 0; i < 3 && where; i++) {
        const GltfValue *number = tree_item(where, i);
        if (number) place[i] = number->number;
    }
    out->where = (SkyPlace){place[0], place[1], place[2]};
}

static FloorKind floor_from_text(const char *text) {
    return strcmp(text, "cloud") == 0 ? FLOOR_CLOUD
           : strcmp(text, "sea") == 0 ? FLOOR_SEA
                                      : FLOOR_LAND;
}

static DaylightInput read_daylight(const GltfValue *extension, EnvironmentKind kind) {
    DaylightInput out = daylight_input_default(kind == ENVIRONMENT_CIE     ? DAYLIGHT_CIE
                                               : kind == ENVIRONMENT_PEREZ ? DAYLIGHT_PEREZ
                                                                           : DAYLIGHT_CLEAR);
    out.cie_type = (int)tree_number(extension, "sky", out.cie_type);
    out.diffuse_lux = tree_number(extension, "diffuse_horizontal_lx", out.diffuse_lux);
    out.direct_w_m2 = tree_number(extension, "direct_normal_w_m2", 0);
    out.diffuse_w_m2 = tree_number(extension, "diffuse_horizontal_w_m2", 0);
    out.turbidity = tree_number(extension, "turbidity", out.turbidity);
    out.visibility_km = tree_number(extension, "visibility_km", 0);
    out.ozone_atm_cm = tree_number(extension, "ozone_atm_cm", out.ozone_atm_cm);
    out.water_cm = tree_number(extension, "water_cm", out.water_cm);
    out.water_source = tree_member(extension, "water_cm") ? WATER_GIVEN : WATER_ASSUMED;
    out.albedo = tree_number(extension, "albedo", out.albedo);
    out.floor = floor_from_text(tree_text(extension, "ground", "land"));
    out.cloud_top_m = tree_number(extension, "cloud_top_m", out.cloud_top_m);
    out.cloud_relief_m = tree_number(extension, "cloud_relief_m", 0);
    out.no_moon = !tree_boolean(extension, "moon", true);
    read_time_and_place(extension, &out);
    return out;
}

void environment_build(GltfFile *file, const GltfValue *extension) {
    Vec3 forward = vec3(0, 0, -1);
    float numbers[3];
    Environment out = {.kind = kind_from_text(tree_text(extension, "type", "")),
                       .color = {1, 1, 1},
                       .hdri_path = "",
                       .hdri_scale = 1};
    if (out.kind == ENVIRONMENT_CONSTANT) {
        out.luminance_cd_m2 = tree_float(extension, "luminance", 0);
        read_color(file, extension, out.color);
    }
    if (out.kind == ENVIRONMENT_HDRI) read_hdri(file, extension, &out);
    if (out.kind >= ENVIRONMENT_CIE) out.daylight = read_daylight(extension, out.kind);
    read_sun(tree_member(extension, "sun"), &out);
    if (tree_floats(extension, "forward", 3, numbers))
        forward = vec3(numbers[0], numbers[1], numbers[2]);
    if (vec3_length(forward) > 0) forward = vec3_normalize(forward);
    else file_error(file, tree_member(extension, "forward"), "the vector is zero");
    out.forward = forward;
    out.heading = radians(extension, "heading_deg");
    file->load->environment = out;
}

/* ---- in another file than a scene's ----------------------------------------------------- */

static void check(GltfFile *file, const GltfValue *value) {
    bool is_known;
    const DocumentCheck check = {file, SEVERITY_ERROR};
    schema_check(&check, value,
                 extension_rule("PARHELION_environment", "scene", &is_known)->schema);
}

/* Where a problem is in the file about the text. */
static const char *place_of(const EnvironmentText *text, const Problem *problem, Arena *arena) {
    if (strcmp(problem->file, text->file)) return problem->path;
    return arena_format(arena, "%s%s", text->place, problem->path);
}

static void pass_warnings(const EnvironmentText *text, const Problems *from, Problems *to) {
    for (int i = 0; i < from->count; i++)
        if (from->list[i].severity == SEVERITY_WARNING)
            problems_add(to, SEVERITY_WARNING, from->list[i].file,
                         place_of(text, &from->list[i], from->arena), "%s", from->list[i].message);
}

static bool first_error(const EnvironmentText *text, const Problems *problems, Error *err) {
    const Problem *first = problems->list;
    while (first->severity != SEVERITY_ERROR) first++;
    return error_at(err, ERROR_INPUT, first->file, place_of(text, first, problems->arena), "%s",
                    first->message);
}

bool environment_text_read(const EnvironmentText *text, Arena *arena, Problems *problems,
                           EnvironmentFound *out, Error *err) {
    const GltfValue *value;
    if (!gltf_json_parse(text->text, strlen(text->text), arena, &value, err))
        return error_in_file(err, text->file);
    Problems own = problems_start(arena);
    SceneOptions options = {.root = text->root};
    Loader load = {.arena = arena,
                   .scratch = arena_reserve(LOAD_SCRATCH_BYTES),
                   .problems = &own,
                   .options = &options,
                   .inputs = list_of(sizeof(const char *)),
                   .input_hashes = list_of(sizeof(uint64_t))};
    GltfFile file = {.load = &load, .path = text->file, .root = value};
    check(&file, value);
    if (!own.error_count) environment_build(&file, value);
    bool is_sound = !own.error_count || first_error(text, &own, err);
    if (is_sound) {
        pass_warnings(text, &own, problems);
        *out = (EnvironmentFound){.environment = load.environment};
        if (load.inputs.count) {
            out->picture = *(const char **)list_item(&load.inputs, 0);
            out->picture_hash = *(uint64_t *)list_item(&load.input_hashes, 0);
        }
    }
    arena_release(&load.scratch);
    return is_sound;
}
