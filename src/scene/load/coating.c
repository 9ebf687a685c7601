/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/coating.h"

#include <string.h>

#include "scene/gltf/document.h"
#include "scene/load/coating_library.h"
#include "scene/optics/curve_file.h"
#include "text/nearest_word.h"

/* ---- optical constants ------------------------------------------------------------------ */

static const char *text_named(const CoatingText *table, int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (strcmp(table[i].name, name) == 0) return table[i].text;
    return NULL;
}

static void fill_curve(Curve *curve, double value) {
    for (int i = 0; i < CURVE_COUNT; i++) curve->value[i] = (float)value;
}

/* ---- layers ----------------------------------------------------------------------------- */

/* Where the layers stand: a user's file, or (is_library) one that the program carries, whose
 * indices are the program's too and right. */
typedef struct LayerSource {
    GltfFile *file;
    bool is_library;
} LayerSource;

static const OpticalConstants *index_of(const LayerSource *source, const GltfValue *named) {
    Error err;
    if (!source->is_library) return curve_file_index(source->file, named);
    OpticalConstants *out = ARENA_NEW(source->file->load->arena, OpticalConstants, 1);
    const char *text = text_named(coating_index_table, coating_index_count, named->text);
    return text && curve_parse_index(text, named->text, &out->n, &out->k, NULL, &err) ? out : NULL;
}

/* "n" and "k" are numbers or files; a file for n holds k as well. */
static bool read_layer(const LayerSource *source, const GltfValue *value, ThinLayer *out) {
    const GltfValue *n = tree_member(value, "n"), *k = tree_member(value, "k");
    const OpticalConstants *index = NULL;
    out->thickness_nm = tree_number(value, "thickness_nm", 0);
    fill_curve(&out->index.n, tree_number(value, "n", 0));
    fill_curve(&out->index.k, tree_number(value, "k", 0));
    if (n->kind == GLTF_STRING) {
        if (!(index = index_of(source, n))) return false;
        out->index.n = index->n;
        if (!k) out->index.k = index->k;
    }
    if (k && k->kind == GLTF_STRING) {
        if (!(index = index_of(source, k))) return false;
        out->index.k = index->k;
    }
    return true;
}

static const LayerStack *read_layers(const LayerSource *source, const GltfValue *layers,
                                     LayerStack stack) {
    Arena *arena = source->file->load->arena;
    LayerStack *out = ARENA_NEW(arena, LayerStack, 1);
    int count = layers ? layers->count : 0;
    ThinLayer *layer = ARENA_NEW(arena, ThinLayer, count + 1);
    bool ok = true;
    for (int i = 0; i < count; i++) ok = read_layer(source, &layers->items[i], &layer[i]) && ok;
    *out = stack;
    out->layers = layer;
    out->count = count;
    return ok ? out : NULL;
}

static const LayerStack *read_named(GltfFile *file, const GltfValue *name, LayerStack stack) {
    Error err;
    const GltfValue *root;
    const char *names[32];
    char advice[256];
    const char *text = text_named(coating_stack_table, coating_stack_count, name->text);
    if (text && gltf_json_parse(text, strlen(text), &file->load->scratch, &root, &err))
        return read_layers(&(LayerSource){file, true}, tree_member(root, "layers"), stack);
    int count = coating_stack_count < 32 ? coating_stack_count : 32;
    for (int i = 0; i < count; i++) names[i] = coating_stack_table[i].name;
    file_error(file, name, "no coating is named \"%.80s\" — %s", name->text,
               nearest_word_advice(name->text, names, count, advice, (int)sizeof advice));
    return NULL;
}

static CoatedFaces faces_of(const GltfValue *extension) {
    const char *faces = tree_text(extension, "faces", "both");
    return strcmp(faces, "front") == 0  ? COATED_FRONT
           : strcmp(faces, "back") == 0 ? COATED_BACK
                                        : COATED_BOTH;
}

const LayerStack *coating_read(GltfFile *file, const GltfValue *extension) {
    if (!extension) return NULL;
    const GltfValue *name = tree_member(extension, "stack");
    LayerStack stack = {.outside = tree_number(extension, "outside", 1),
                        .faces = faces_of(extension)};
    if (name) return read_named(file, name, stack);
    return read_layers(&(LayerSource){file, false}, tree_member(extension, "layers"), stack);
}
