/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/check/check_document.h"

#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/number.h"

/* "major.minor", digits only; false when the text is anything else. */
static bool parse_version(const char *text, uint64_t *major, uint64_t *minor) {
    const char *end = number_read_count(text, major);
    end = end && *end == '.' ? number_read_count(end + 1, minor) : NULL;
    return end && !*end;
}

/* As a number that orders versions; -1: there is none that can be read. */
static double version_of(const DocumentCheck *check, const GltfValue *value) {
    uint64_t major, minor;
    if (!value || value->kind != GLTF_STRING) return -1;
    if (parse_version(value->text, &major, &minor)) return 1e6 * (double)major + (double)minor;
    check_fails(check, value, "is \"%.40s\", a version like \"2.0\" is required", value->text);
    return -1;
}

/* Versions 2.x only add to 2.0 (glTF 2.0, 3.2): what they add is not seen. */
void check_asset(const DocumentCheck *check, const GltfValue *asset) {
    const GltfValue *value = tree_member(asset, "version");
    const GltfValue *minimum = tree_member(asset, "minVersion");
    double version = version_of(check, value), least = version_of(check, minimum);
    bool is_other = version >= 0 && (version < 2e6 || version >= 3e6);
    if (is_other) check_fails(check, value, "is \"%.40s\", version 2.0 is read", value->text);
    else if (version > 2e6)
        check_warns(check, value, "is \"%.40s\": read as 2.0, what is newer is not seen",
                    value->text);
    if (version >= 0 && least > version)
        check_fails(check, minimum, "is \"%.40s\", at most the version (%.40s) is required",
                    minimum->text, value->text);
    else if (least > 2e6)
        check_warns(check, minimum, "is \"%.40s\": the file may need what 2.0 does not have",
                    minimum->text);
}

/* Only the first of two variants with one name can be selected. */
void check_variant_names(const DocumentCheck *check, const GltfValue *extension) {
    const GltfValue *variants = tree_member(extension, "variants");
    for (int i = 1; i < tree_count(extension, "variants"); i++) {
        const GltfValue *own = tree_member(tree_item(variants, i), "name");
        for (int k = 0; own && k < i; k++) {
            if (strcmp(tree_text(tree_item(variants, k), "name", ""), own->text) != 0) continue;
            check_warns(check, own, "is \"%.80s\", as variant %d is called already", own->text, k);
            break;
        }
    }
}

/* Whether another mapping before `mapping` names the variant. */
static bool is_mapped_before(const GltfValue *mappings, int mapping, double variant) {
    for (int m = 0; m < mapping; m++) {
        const GltfValue *named = tree_items(&mappings->items[m], "variants");
        for (; named; named = tree_next(named))
            if (named->number == variant) return true;
    }
    return false;
}

void check_variants(const DocumentCheck *check, const GltfValue *extension) {
    const GltfValue *mappings = tree_member(extension, "mappings");
    for (int m = 1; m < tree_count(extension, "mappings"); m++) {
        const GltfValue *named = tree_items(tree_item(mappings, m), "variants");
        for (; named; named = tree_next(named))
            if (is_mapped_before(mappings, m, named->number))
                check_warns(check, named, "variant %g stands in two mappings", named->number);
    }
}

/* ---- pictures and light profiles ------------------------------------------------------- */

void check_source(const DocumentCheck *check, const GltfValue *object) {
    const GltfValue *uri = tree_member(object, "uri");
    const GltfValue *view = tree_member(object, "bufferView");
    if ((uri != NULL) == (view != NULL))
        check_fails(check, object, "has %s; either \"uri\" or \"bufferView\" is required",
                    uri ? "both" : "neither");
}

/* ---- cameras and lights ---------------------------------------------------------------- */

static void check_depths(const DocumentCheck *check, const GltfValue *kind) {
    const GltfValue *zfar = tree_member(kind, "zfar");
    double near = tree_number(kind, "znear", 0);
    if (zfar && zfar->number <= near)
        check_fails(check, zfar, "is %g, more than znear (%g) is required", zfar->number, near);
}

void check_camera(const DocumentCheck *check, const GltfValue *camera) {
    const char *type = tree_text(camera, "type", "");
    const GltfValue *eye = tree_member(camera, "perspective");
    const GltfValue *flat = tree_member(camera, "orthographic");
    if (eye && flat)
        check_fails(check, camera, "has \"perspective\" and \"orthographic\"; one is required");
    if ((strcmp(type, "perspective") == 0 && !eye) || (strcmp(type, "orthographic") == 0 && !flat))
        check_fails(check, camera, "\"%s\" is missing", type);
    check_depths(check, eye);
    check_depths(check, flat);
    if (tree_number(eye, "yfov", 1) >= 3.14159265358979)
        check_fails(check, tree_member(eye, "yfov"),
                    "is %g rad, less than pi is required; glTF's angles are radians, %g degrees "
                    "are %.4g",
                    tree_number(eye, "yfov", 1), tree_number(eye, "yfov", 1),
                    tree_number(eye, "yfov", 1) * 3.14159265358979 / 180);
    for (int i = 0; i < 2; i++) {
        const GltfValue *mag = tree_member(flat, i ? "ymag" : "xmag");
        if (mag && mag->kind == GLTF_NUMBER && mag->number == 0)
            check_fails(check, mag, "is 0, half the picture's size in metres is required");
        if (mag && mag->number < 0)
            check_warns(check, mag, "is %g, a positive number is required: its size is taken",
                        mag->number);
    }
}

void check_light(const DocumentCheck *check, const GltfValue *light) {
    const GltfValue *type = tree_member(light, "type"), *cone = tree_member(light, "spot");
    double inner = tree_number(cone, "innerConeAngle", 0);
    double outer = tree_number(cone, "outerConeAngle", 0.7853981633974483);
    if (type && strcmp(type->text, "point") != 0 && strcmp(type->text, "spot") != 0 &&
        strcmp(type->text, "directional") != 0)
        check_warns(check, type,
                    "is \"%.40s\", one of point|spot|directional is required: the light "
                    "is skipped",
                    type->text);
    if (type && strcmp(type->text, "spot") == 0 && !cone)
        check_fails(check, light, "\"spot\" is missing");
    if (tree_member(light, "range"))
        check_warns(
            check, tree_member(light, "range"), "the range of \"%.80s\" (%g m) is not used: %s",
            tree_text(light, "name", "a lamp without a name"), tree_number(light, "range", 0),
            type && strcmp(type->text, "directional") == 0
                ? "a directional light has none"
                : "its light falls off with the square of the distance, without an "
                  "end");
    if (cone && inner >= outer)
        check_fails(check, cone, "the inner cone angle %g is not below the outer one %g", inner,
                    outer);
}

/* ---- ours ------------------------------------------------------------------------------ */

/* 25 is meant as 25 %: a level above what was measured has to say so. */
static void check_level(const DocumentCheck *check, const GltfValue *display) {
    double most = tree_number(display, "max_level", 1);
    if (tree_number(display, "level", 1) > most)
        check_fails(check, tree_member(display, "level"),
                    "is %g, required: a level from 0 to %g: 1 is as measured, 0.25 a quarter "
                    "of it; \"max_level\" beside it allows a panel that is driven above that",
                    tree_number(display, "level", 1), most);
}

void check_display(const DocumentCheck *check, const GltfValue *display) {
    check_level(check, display);
    const SceneOptions *options = check->file->load->options;
    const GltfValue *material = display->parent ? display->parent->parent : NULL;
    const char *name = tree_text(material, "name", "");
    if (tree_member(display, "panel")) return;
    for (int i = 0; i < options->panel_count; i++)
        if (strcmp(options->panels[i].material, name) == 0) return;
    check_fails(check, display, "\"panel\" is missing, and --panel names none");
}

/* The members that an environment of a type must have and may have. */
typedef struct EnvironmentType {
    const char *name;
    const char *needed[2];
    const char *allowed; /* "|a|b|", the needed ones included */
} EnvironmentType;

static const EnvironmentType ENVIRONMENT_TYPES[] = {
    {"constant", {"luminance", NULL}, "|luminance|color|"},
    {"hdri", {"uri", NULL}, "|uri|rotation_deg|scale|horizontal_illuminance_lx|"},
    {"cie", {"sky", "diffuse_horizontal_lx"}, "|sky|diffuse_horizontal_lx|"},
    {"perez",
     {"direct_normal_w_m2", "diffuse_horizontal_w_m2"},
     "|direct_normal_w_m2|diffuse_horizontal_w_m2|water_cm|when|where|"},
    {"sky",
     {NULL, NULL},
     "|when|where|turbidity|visibility_km|ozone_atm_cm|water_cm|albedo|ground|cloud_top_m|"
     "cloud_relief_m|moon|"},
};

/* Of some type; any other key is reported as that. */
static bool is_known(const char *word) {
    bool found = false;
    for (int i = 0; i < COUNT_OF(ENVIRONMENT_TYPES) && !found; i++)
        found = strstr(ENVIRONMENT_TYPES[i].allowed, word) != NULL;
    return found;
}

static void check_members(const DocumentCheck *check, const GltfValue *environment,
                          const EnvironmentType *type) {
    static const char COMMON[] = "|type|heading_deg|forward|sun|extensions|extras|name|";
    for (int i = 0; i < 2 && type->needed[i]; i++)
        if (!tree_member(environment, type->needed[i]))
            check_fails(check, environment, "\"%s\" is missing in an environment of type \"%s\"",
                        type->needed[i], type->name);
    for (int i = 0; i < environment->count; i++) {
        char word[80];
        snprintf(word, sizeof word, "|%.70s|", environment->items[i].key);
        if (is_known(word) && !strstr(COMMON, word) && !strstr(type->allowed, word))
            check_warns(check, &environment->items[i],
                        "has no meaning for an environment of type "
                        "\"%s\" and is skipped",
                        type->name);
    }
    const GltfValue *relief = tree_member(environment, "cloud_relief_m");
    if (relief && strcmp(tree_text(environment, "ground", ""), "cloud") != 0)
        check_warns(check, relief,
                    "has no meaning unless \"ground\" is \"cloud\" and is "
                    "skipped");
}

/* Does the text begin with digits and marks as `shape` has them? */
static bool has_shape(const char *text, const char *shape) {
    for (; *shape; shape++, text++)
        if (*shape == '0' ? *text < '0' || *text > '9' : *text != *shape) return false;
    return true;
}

static int two_digits(const char *at) {
    return 10 * (at[0] - '0') + at[1] - '0';
}

/* ISO 8601 with minutes, and optional seconds, and the offset from UTC. */
static bool is_moment(const char *text) {
    const char *at = text + strlen("2026-06-21T08:30");
    if (!has_shape(text, "0000-00-00T00:00")) return false;
    int month = two_digits(text + 5), day = two_digits(text + 8);
    if (month < 1 || month > 12 || day < 1 || day > 31 || two_digits(text + 11) > 24 ||
        two_digits(text + 14) > 59)
        return false;
    if (has_shape(at, ":00")) {
        if (two_digits(at + 1) > 60) return false;
        at += 3;
    }
    if (strcmp(at, "Z") == 0) return true;
    return (*at == '+' || *at == '-') && has_shape(at + 1, "00:00") && !at[6] &&
           two_digits(at + 1) <= 14 && two_digits(at + 4) <= 59;
}

static void check_time_and_place(const DocumentCheck *check, const GltfValue *environment) {
    const GltfValue *when = tree_member(environment, "when");
    const GltfValue *where = tree_member(environment, "where");
    const GltfValue *latitude = tree_item(where, 0), *longitude = tree_item(where, 1);
    if (when && when->kind == GLTF_STRING && !is_moment(when->text))
        check_fails(check, when, "is \"%.60s\", a time like \"2026-06-21T08:30+02:00\" is required",
                    when->text);
    if (latitude && !(fabs(latitude->number) <= 90))
        check_fails(check, latitude, "is %g, a latitude from -90 to 90 degrees is required",
                    latitude->number);
    if (longitude && !(fabs(longitude->number) <= 360))
        check_fails(check, longitude, "is %g, a longitude from -360 to 360 degrees is required",
                    longitude->number);
}

void check_environment(const DocumentCheck *check, const GltfValue *environment) {
    const char *type = tree_text(environment, "type", "");
    for (size_t i = 0; i < sizeof ENVIRONMENT_TYPES / sizeof *ENVIRONMENT_TYPES; i++)
        if (strcmp(ENVIRONMENT_TYPES[i].name, type) == 0)
            check_members(check, environment, &ENVIRONMENT_TYPES[i]);
    check_time_and_place(check, environment);
    bool has_time = tree_member(environment, "when") && tree_member(environment, "where");
    if ((strcmp(type, "perez") == 0 || strcmp(type, "sky") == 0) && !has_time &&
        !tree_member(environment, "sun"))
        check_fails(check, environment,
                    "has no sun: \"when\" and \"where\", or \"sun\", are required");
    if (tree_member(environment, "scale") && tree_member(environment, "horizontal_illuminance_lx"))
        check_fails(check, environment,
                    "has \"scale\" and \"horizontal_illuminance_lx\"; one of "
                    "them is required");
}
