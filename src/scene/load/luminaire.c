/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/luminaire.h"

#include <string.h>

#include "base/number.h"
#include "scene/gltf/document.h"
#include "scene/load/profiles.h"
#include "scene/load/wearer.h"
#include "spectrum/illuminant.h"

struct LuminaireDraft {
    bool is_readable, is_found;
    LightProfile profile;
};

static const char *node_of(const SceneOverride *one) {
    bool has_prefix = !strncmp(one->material, WEARER_NODE, strlen(WEARER_NODE));
    return one->material + (has_prefix ? strlen(WEARER_NODE) : 0);
}

void luminaires_start(Loader *load) {
    const SceneOptions *o = load->options;
    load->luminaires = ARENA_NEW(&load->scratch, struct LuminaireDraft, o->light_count + 1);
    for (int i = 0; i < o->light_count; i++) {
        struct LuminaireDraft *draft = &load->luminaires[i];
        Error err = {0};
        const char *path = draft->profile.file = o->lights[i].value;
        FileBytes bytes;
        draft->is_readable = load_read(load, path, &load->scratch, &bytes, &err) &&
                             profile_read(load, bytes, true, &draft->profile, &err);
        if (draft->is_readable) continue;
        if (!err.file[0]) error_in_file(&err, path);
        problems_add_error(load->problems, &err);
    }
}

/* Down is the scene's -Y. */
static void set_tilt(PunctualLight *light, const LuminaireTilt *tilt) {
    Vec3 down = vec3_neg(vec3(light->axis_x.y, light->axis_y.y, light->axis_z.y));
    double angle_deg;
    light->tilt_factor = (float)luminaire_tilt_factor(tilt, light->web->type, down, &angle_deg);
    light->tilt_deg = (float)angle_deg;
    light->has_tilt = tilt->geometry != 0;
}

static PunctualLight *add_lamp(Loader *load, const char *name, const LightProfile *profile,
                               const Transform *world) {
    PunctualLight *out = list_add(&load->lights, &load->scratch);
    *out = (PunctualLight){.kind = LIGHT_LUMINAIRE,
                           .name = name,
                           .node_name = name,
                           .file = load_keep(load, profile->file),
                           .position = world->origin,
                           .direction = vec3_normalize(vec3_neg(world->z)),
                           .web = profile->web,
                           .opening = profile->opening,
                           .cct_k = profile->cct_k,
                           .cct_text = profile->cct_text,
                           .level = 1,
                           .color = {1, 1, 1}};
    /* a sheared node's axes are made square again, its -Z first */
    out->axis_z = vec3_normalize(world->z);
    out->axis_x = vec3_along(world->x, out->axis_z, -vec3_dot(world->x, out->axis_z));
    out->axis_x = vec3_normalize(out->axis_x);
    out->axis_y = vec3_cross(out->axis_z, out->axis_x);
    if (vec3_dot(out->axis_y, world->y) < 0) out->axis_y = vec3_neg(out->axis_y);
    set_tilt(out, &profile->tilt);
    return out;
}

static void warn_of_both(GltfFile *file, const GltfValue *node) {
    const GltfValue *other = tree_extension(node, "KHR_lights_punctual");
    if (other)
        file_warning(file, other,
                     "the node has EXT_lights_ies as well, which is taken for the same lamp: "
                     "this light is not shown");
}

static bool place_profile(GltfFile *file, const GltfValue *node, const Transform *world) {
    Loader *load = file->load;
    const GltfValue *extension = tree_extension(node, "EXT_lights_ies");
    const LightProfile *profile = profile_at(file, tree_int(extension, "light", NO_ID));
    if (!profile) return false;
    warn_of_both(file, node);
    if (!profile->web) return true; /* reported when it was read */
    const char *name = load_keep(load, tree_text(node, "name", ""));
    PunctualLight *light = add_lamp(load, name[0] ? name : profile->name, profile, world);
    light->node_name = name;
    light->level = tree_float(extension, "multiplier", 1);
    tree_floats(extension, "color", 3, light->color);
    return true;
}

/* By --light; the last of several speaks. */
static bool place_by_name(GltfFile *file, const GltfValue *node, const Transform *world) {
    Loader *load = file->load;
    const SceneOptions *o = load->options;
    const char *text = tree_text(node, "name", "");
    if (!o->light_count || !text[0]) return false;
    const char *name = load_keep(load, text);
    for (int i = o->light_count; i-- > 0;) {
        if (strcmp(node_of(&o->lights[i]), name) != 0) continue;
        for (int k = 0; k <= i; k++)
            load->luminaires[k].is_found |= !strcmp(node_of(&o->lights[k]), name);
        if (load->luminaires[i].is_readable)
            add_lamp(load, name, &load->luminaires[i].profile, world);
        return true;
    }
    return false;
}

bool luminaire_place(GltfFile *file, const GltfValue *node, const Transform *world) {
    return place_by_name(file, node, world) || place_profile(file, node, world);
}

/* ---- behind the last file ---------------------------------------------------------------- */

static void report_unknown(Loader *load, const char *name) {
    char names[WEARER_NAMES_MAX] = "";
    for (int i = 0; i < load->node_names.count; i++)
        wearer_list_name(names, *(const char **)list_item(&load->node_names, i));
    problems_add(load->problems, SEVERITY_ERROR, "--light", "",
                 "no node is named \"%.100s\"; there are %s", name,
                 names[0] ? names : "none with names");
}

/* A number, with or without the unit behind it. */
static bool read_number(const char *text, const char *unit, double low, double high, double *out) {
    const char *end = number_read(text, out);
    return end && (!*end || !strcmp(end, unit)) && *out >= low && *out <= high;
}

static void set_level(PunctualLight *light, double percent) {
    light->level = (float)(percent / 100);
}

static void set_cct(PunctualLight *light, double kelvin) {
    light->cct_k = (float)kelvin;
    light->cct_text = NULL;
}

typedef struct LampOption {
    const char *name, *unit, *wanted;
    double low, high;
    void (*set)(PunctualLight *light, double value);
} LampOption;

static const LampOption LEVEL = {"--light-level", "%", "no percentage; a number from 0 up", 0, 1e6,
                                 set_level};
static const LampOption CCT = {
    "--light-cct", "K",        "no colour temperature; a number from 1000 to 25000 kelvin",
    CCT_LEAST_K,   CCT_MOST_K, set_cct};

static void apply(Loader *load, const LampOption *option, const SceneOverride *one) {
    char names[WEARER_NAMES_MAX] = "";
    double value;
    bool is_found = false;
    if (!read_number(one->value, option->unit, option->low, option->high, &value)) {
        problems_add(load->problems, SEVERITY_ERROR, option->name, "",
                     "\"%.100s\" is %s is required", one->value, option->wanted);
        return;
    }
    if (option == &LEVEL && value > 0 && value < 1 && !strchr(one->value, '%'))
        problems_add(load->problems, SEVERITY_WARNING, option->name, "",
                     "\"%.40s\" is %g percent: write \"%.40s%%\" if it is meant, or \"%g\" for "
                     "a level of %g",
                     one->value, value, one->value, 100 * value, value);
    for (int i = 0; i < load->lights.count; i++) {
        PunctualLight *light = list_item(&load->lights, i);
        if (light->kind != LIGHT_LUMINAIRE) continue;
        wearer_list_name(names, light->node_name);
        if (strcmp(one->material, "*") && strcmp(node_of(one), light->node_name)) continue;
        is_found = true;
        option->set(light, value);
    }
    if (!is_found)
        problems_add(load->problems, SEVERITY_ERROR, option->name, "",
                     "no lamp of a luminaire file is at a node named \"%.100s\"; there are %s",
                     node_of(one), names[0] ? names : "none");
}

static void finish_lamp(Loader *load, PunctualLight *light) {
    for (int c = 0; c < 3; c++)
        light->intensity[c] =
            light->web->largest_cd * light->level * light->tilt_factor * light->color[c];
    if (!(light->cct_k > 0)) return;
    Curve *white = ARENA_NEW(load->arena, Curve, 1);
    cct_curve((double)light->cct_k, white);
    light->white = white;
}

void luminaires_finish(Loader *load) {
    const SceneOptions *o = load->options;
    for (int i = 0; i < o->light_count; i++)
        if (!load->luminaires[i].is_found) report_unknown(load, node_of(&o->lights[i]));
    for (int i = 0; i < o->light_level_count; i++) apply(load, &LEVEL, &o->light_levels[i]);
    for (int i = 0; i < o->light_cct_count; i++) apply(load, &CCT, &o->light_ccts[i]);
    for (int i = 0; i < load->lights.count; i++) {
        PunctualLight *light = list_item(&load->lights, i);
        if (light->kind == LIGHT_LUMINAIRE) finish_lamp(load, light);
    }
}
