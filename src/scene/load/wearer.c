/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/wearer.h"

#include <stdio.h>
#include <string.h>

#include "scene/gltf/document.h"
#include "scene/gltf/part_draft.h"

#define MESH "mesh:"
enum { PREFIX = 5 };

bool wearer_is_named(const char *word) {
    return strncmp(word, WEARER_NODE, PREFIX) == 0 || strncmp(word, MESH, PREFIX) == 0;
}

static const char *name_of(const PartDraft *draft, const char *word) {
    bool by_node = strncmp(word, WEARER_NODE, PREFIX) == 0;
    return by_node ? draft->part.node_name : draft->part.mesh_name;
}

static bool is_meant(const PartDraft *draft, const char *word) {
    return strcmp(name_of(draft, word), word + PREFIX) == 0;
}

static const PartDraft *part_at(const Loader *load, int index) {
    return list_item(&load->parts, index);
}

/* ---- lists of names, for messages ------------------------------------------------------- */

void wearer_list_name(char names[WEARER_NAMES_MAX], const char *name) {
    char quoted[80];
    size_t length = strlen(names);
    snprintf(quoted, sizeof quoted, "\"%.70s\"", name);
    if (strstr(names, quoted) || length + strlen(quoted) + 3 > WEARER_NAMES_MAX) return;
    snprintf(names + length, WEARER_NAMES_MAX - length, "%s%s", length ? ", " : "", quoted);
}

static void add_name(char names[WEARER_NAMES_MAX], const char *name) {
    if (name[0]) wearer_list_name(names, name);
}

static int unknown(Loader *load, const char *option, const char *word) {
    char names[WEARER_NAMES_MAX] = "";
    for (int i = 0; i < load->parts.count; i++) add_name(names, name_of(part_at(load, i), word));
    problems_add(load->problems, SEVERITY_ERROR, option, "",
                 "no %.4s with triangles is named \"%.100s\"; there are %s", word, word + PREFIX,
                 names[0] ? names : "none with names");
    return NO_ID;
}

/* ---- which material --------------------------------------------------------------------- */

static bool may_be_screen(const Loader *load, int material_id) {
    const Material *material = list_item(&load->materials, material_id);
    return material->display_id != NO_ID || material->emissive_texture.texture_id != NO_ID;
}

/* The one material of the parts that are meant, or the one of them that may be a screen. */
static int choose_material(Loader *load, const char *option, const char *word) {
    char names[WEARER_NAMES_MAX] = "";
    int first = NO_ID, screen = NO_ID, count = 0, screens = 0;
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = part_at(load, i);
        int id = draft->part.material_id;
        if (!is_meant(draft, word) || id == first || id == screen) continue;
        add_name(names, ((const Material *)list_item(&load->materials, id))->name);
        if (!count++) first = id;
        if (!may_be_screen(load, id)) continue;
        screen = id;
        screens++;
    }
    if (!count) return unknown(load, option, word);
    if (count == 1 || screens == 1) return count == 1 ? first : screen;
    problems_add(load->problems, SEVERITY_ERROR, option, "",
                 "%.100s wears the materials %s, and it is not clear which is the screen: name "
                 "the material instead",
                 word, names);
    return NO_ID;
}

/* Whether the parts that are meant (word NULL: that wear the material) hang on one node, and
 * the names of their meshes (of their nodes). */
static bool hang_on_one_node(const Loader *load, const char *word, int material_id,
                             char names[WEARER_NAMES_MAX]) {
    const PartDraft *first = NULL;
    bool is_one = true;
    for (int i = 0; i < load->parts.count; i++) {
        const PartDraft *draft = part_at(load, i);
        if (word ? !is_meant(draft, word) : draft->part.material_id != material_id) continue;
        add_name(names, word ? draft->part.mesh_name : draft->part.node_name);
        if (!first) first = draft;
        is_one &= draft->node == first->node;
    }
    return is_one;
}

/* Nodes of one name cannot be distinguished by it. */
static bool is_one_node(Loader *load, const char *option, const char *word) {
    char names[WEARER_NAMES_MAX] = "";
    if (strncmp(word, WEARER_NODE, PREFIX) != 0) return true;
    bool is_one = hang_on_one_node(load, word, NO_ID, names);
    if (!is_one)
        problems_add(load->problems, SEVERITY_ERROR, option, "",
                     "several nodes are named \"%.100s\"; mesh:NAME tells them apart where "
                     "their meshes differ (%s)",
                     word + PREFIX, names[0] ? names : "theirs have no names");
    return is_one;
}

/* ---- a material of its own -------------------------------------------------------------- */

static bool is_shared(const Loader *load, int material_id, const char *word) {
    for (int i = 0; i < load->parts.count; i++)
        if (part_at(load, i)->part.material_id == material_id && !is_meant(part_at(load, i), word))
            return true;
    return false;
}

static const char *free_name(Loader *load, const char *word) {
    const char *name = word + PREFIX;
    for (int i = 0; i < load->materials.count; i++) {
        const Material *material = list_item(&load->materials, i);
        if (strcmp(material->name, word + PREFIX) == 0) name = word;
    }
    return load_keep(load, name);
}

static void copy_display(Loader *load, Material *material, int material_id) {
    const int old = material->display_id;
    if (old == NO_ID) return;
    Display display = *(const Display *)list_item(&load->displays, old);
    DisplayPlace place = *(const DisplayPlace *)list_item(&load->display_places, old);
    display.name = material->name;
    display.material_id = material_id;
    *(Display *)list_add(&load->displays, &load->scratch) = display;
    *(DisplayPlace *)list_add(&load->display_places, &load->scratch) = place;
    material->display_id = load->displays.count - 1;
}

static int copy_material(Loader *load, int material_id, const char *word) {
    int copy = load->materials.count, sets[SCENE_UV_SETS];
    Material material = *(const Material *)list_item(&load->materials, material_id);
    memcpy(sets, list_item(&load->material_uv_sets, material_id), sizeof sets);
    material.name = free_name(load, word);
    copy_display(load, &material, copy);
    *(Material *)list_add(&load->materials, &load->scratch) = material;
    memcpy(list_add(&load->material_uv_sets, &load->scratch), sets, sizeof sets);
    for (int i = 0; i < load->parts.count; i++) {
        PartDraft *draft = list_item(&load->parts, i);
        if (draft->part.material_id == material_id && is_meant(draft, word))
            draft->part.material_id = copy;
    }
    return copy;
}

int wearer_material(Loader *load, const char *option, const char *word) {
    if (!is_one_node(load, option, word)) return NO_ID;
    int id = choose_material(load, option, word);
    if (id == NO_ID || !is_shared(load, id, word)) return id;
    return copy_material(load, id, word);
}

void wearer_warn_of_sharing(Loader *load, const char *option, int material_id) {
    char names[WEARER_NAMES_MAX] = "";
    const Material *material = list_item(&load->materials, material_id);
    if (!hang_on_one_node(load, NULL, material_id, names))
        problems_add(load->problems, SEVERITY_WARNING, option, "",
                     "\"%.100s\" is worn by several nodes, which become one display%s%s: "
                     "node:NAME or mesh:NAME means one of them",
                     material->name, names[0] ? ": " : "", names);
}
