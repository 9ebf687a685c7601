/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/optics/measured_index.h"

#include <math.h>

#include "scene/gltf/document.h"
#include "spectrum/curve.h"
#include "spectrum/dispersion.h"

#define ROOM_K 293.0
#define NM 1e-9 /* m */

/* ---- files ------------------------------------------------------------------------------ */

/* A table file on its way into a material. */
typedef struct IndexFile {
    GltfFile *file;
    const GltfValue *uri; /* where the scene names it */
    const char *path;
    bool ok;
    double beyond; /* share of V(lambda), of n or k */
} IndexFile;

/* A fault at a place of the table file. Always false. */
static bool fails(IndexFile *from, const GltfValue *at, const char *what) {
    char place[256];
    tree_pointer(at, place, sizeof place);
    file_error(from->file, from->uri, "%s: %s%s%s", from->path, place, place[0] ? ": " : "", what);
    return from->ok = false;
}

/* [wavelength in m, value] */
static bool read_pair(const GltfValue *pair, double *nm, double *value) {
    const GltfValue *m = tree_item(pair, 0), *at = tree_item(pair, 1);
    if (!m || !at || pair->count != 2 || m->kind != GLTF_NUMBER || at->kind != GLTF_NUMBER)
        return false;
    *nm = m->number / NM;
    *value = at->number;
    return *nm > 0 && *value >= 0 && *value <= INDEX_MAX;
}

/* One of "n" and "k". False: it does not reach, or it is not read. */
static bool read_curve(IndexFile *from, const GltfValue *list, Curve *out) {
    Arena *scratch = &from->file->load->scratch;
    double *nm = ARENA_NEW(scratch, double, list->count);
    double *value = ARENA_NEW(scratch, double, list->count);
    const CurveEnds lit = {false, false};
    for (int i = 0; i < list->count; i++) {
        if (!read_pair(&list->items[i], &nm[i], &value[i]))
            return fails(from, &list->items[i],
                         "a pair of a wavelength in m, above 0, and a "
                         "number from 0 to 100 is required");
        if (i && !(nm[i] > nm[i - 1]))
            return fails(from, &list->items[i], "wavelengths that rise are required");
    }
    curve_from_points(nm, value, list->count, out);
    from->beyond = fmax(from->beyond, curve_beyond(nm[0], nm[list->count - 1], lit));
    return curve_reaches(nm[0], nm[list->count - 1], lit);
}

/* The list of that name; NULL: reported. */
static const GltfValue *array_of(IndexFile *from, const GltfValue *data, const char *name) {
    const GltfValue *list = tree_member(data, name);
    if (list && list->kind == GLTF_ARRAY && list->count > 0) return list;
    fails(from, list ? list : data,
          name[0] == 'n'   ? "\"n\" is required: an array of pairs"
          : name[0] == 'k' ? "\"k\" is required: an array of pairs"
                           : "\"data\" is required: an array of measurements");
    return NULL;
}

/* The measurement nearest room temperature; NULL: reported. */
static const GltfValue *measured_near_room(IndexFile *from, const GltfValue *root) {
    const GltfValue *table = tree_extension(root, "OpenMaterial_ior_data"), *best = NULL;
    if (!table) {
        fails(from, root, "\"extensions\" with OpenMaterial_ior_data is required");
        return NULL;
    }
    const GltfValue *data = array_of(from, table, "data");
    for (int i = 0; data && i < data->count; i++) {
        const GltfValue *kelvin = tree_member(&data->items[i], "temperature");
        if (!kelvin || kelvin->kind != GLTF_NUMBER || !(kelvin->number > 0)) {
            fails(from, &data->items[i], "\"temperature\" is required: a number above 0, in K");
            return NULL;
        }
        if (!best ||
            fabs(kelvin->number - ROOM_K) < fabs(tree_number(best, "temperature", 0) - ROOM_K))
            best = &data->items[i];
    }
    return best;
}

static bool parse_table(IndexFile *from, const GltfValue **root) {
    Error err;
    FileBytes bytes;
    Loader *load = from->file->load;
    if (!document_resolve(from->file, from->uri, &from->path)) return false;
    if (!load_read(load, from->path, &load->scratch, &bytes, &err))
        return file_error_within(from->file, from->uri, &err);
    return gltf_json_parse((const char *)bytes.data, bytes.size, &load->scratch, root, &err) ||
           file_error(from->file, from->uri, "%s: %s", from->path, err.text);
}

/* No body has neither. */
static void check_sum(IndexFile *from, const GltfValue *data, const OpticalConstants *table) {
    for (int i = 0; i < CURVE_COUNT && from->ok; i++)
        if (!(table->n.value[i] + table->k.value[i] > 0))
            fails(from, data,
                  "n and k are both 0 at a visible wavelength, one above 0 is "
                  "required");
}

/* NULL: reported, or it does not reach over what is seen. */
static const OpticalConstants *read_table(GltfFile *file, const GltfValue *uri) {
    IndexFile from = {.file = file, .uri = uri, .ok = true};
    const GltfValue *root, *n, *k;
    if (!parse_table(&from, &root)) return NULL;
    const GltfValue *data = measured_near_room(&from, root);
    if (!data || !(n = array_of(&from, data, "n")) || !(k = array_of(&from, data, "k")))
        return NULL;
    OpticalConstants *out = ARENA_NEW(file->load->arena, OpticalConstants, 1);
    bool reaches = read_curve(&from, n, &out->n);
    reaches = read_curve(&from, k, &out->k) && reaches;
    if (reaches) check_sum(&from, data, out);
    if (!from.ok) return NULL;
    if (!reaches)
        file_warning(file, uri, "%s does not reach from %d to %d nm: it is not used", from.path,
                     CURVE_SEEN_FIRST_NM, CURVE_SEEN_LAST_NM);
    else if (from.beyond > 0)
        file_warning(file, uri, CURVE_BEYOND_WARNING, from.path, 100 * from.beyond,
                     CURVE_WHOLE_FIRST_NM, CURVE_WHOLE_LAST_NM);
    return reaches ? out : NULL;
}

/* ---- materials -------------------------------------------------------------------------- */

/* A body is a metal by metallicFactor alone; what is none must be clear enough for an index. */
static void wear_table(GltfFile *file, const GltfValue *uri, const OpticalConstants *table,
                       Material *m) {
    float nd = table->n.value[(int)(LINE_D_NM + 0.5) - CURVE_FIRST_NM];
    if (m->metallic > 0) {
        if (!m->conductor) m->conductor = table;
        return;
    }
    for (int i = 0; i < CURVE_COUNT; i++) {
        if (table->n.value[i] >= 1) continue;
        file_error(file, uri,
                   "n is %g at %d nm: a metal's (metallicFactor above 0); 1 or more is "
                   "required of what is none",
                   (double)table->n.value[i], CURVE_FIRST_NM + i);
        return;
    }
    m->ior = nd;
    m->index = &table->n;
}

static void spread(GltfFile *file, double dispersion, Material *m) {
    if (!(dispersion > 0) || !(m->ior > 1)) return;
    Curve *index = ARENA_NEW(file->load->arena, Curve, 1);
    for (int i = 0; i < CURVE_COUNT; i++)
        index->value[i] = (float)dispersion_index((double)m->ior, dispersion, CURVE_FIRST_NM + i);
    m->index = index;
}

static bool is_constant(const Curve *curve) {
    for (int i = 1; i < CURVE_COUNT; i++)
        if (curve->value[i] != curve->value[0]) return false;
    return true;
}

void measured_index_build(GltfFile *file, const GltfValue *material, Material *out) {
    const GltfValue *uri =
        tree_member(tree_member(tree_extension(material, "OpenMaterial_material_parameters"),
                                "physical_properties"),
                    "refractive_index_uri");
    double dispersion =
        tree_number(tree_extension(material, "KHR_materials_dispersion"), "dispersion", 0);
    bool is_measured = uri && uri->text[0];
    const OpticalConstants *table = is_measured ? read_table(file, uri) : NULL;
    if (table) wear_table(file, uri, table, out);
    if (!is_measured) spread(file, dispersion, out); /* else check_optics.c reports it */
    if (out->index && is_constant(out->index)) out->index = NULL;
    if (!(out->is_solid && out->transmission > 0)) out->index = NULL;
}
