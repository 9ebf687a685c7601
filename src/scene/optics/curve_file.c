/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/optics/curve_file.h"

#include "base/file.h"
#include "scene/gltf/document.h"

/* A file that a scene names, as text. */
typedef struct CurveText {
    const char *path, *text;
} CurveText;

static bool read_text(GltfFile *file, const GltfValue *uri, CurveText *out) {
    Error err;
    FileBytes bytes;
    Loader *load = file->load;
    if (!document_resolve(file, uri, &out->path)) return false;
    return (load_read(load, out->path, &load->scratch, &bytes, &err) &&
            file_text(out->path, &bytes, &out->text, &err)) ||
           file_error_within(file, uri, &err);
}

static void warn(GltfFile *file, const GltfValue *uri, const CurveText *from,
                 const CurveNotes *notes) {
    if (notes->beyond > 0)
        file_warning(file, uri, CURVE_BEYOND_WARNING, from->path, 100 * notes->beyond,
                     CURVE_WHOLE_FIRST_NM, CURVE_WHOLE_LAST_NM);
    if (notes->unknown[0]) file_warning(file, uri, CURVE_UNIT_WARNING, from->path, notes->unknown);
}

bool curve_file_read(GltfFile *file, const GltfValue *uri, CurveRange range, Curve *out) {
    Error err;
    CurveText from;
    CurveNotes notes;
    if (!read_text(file, uri, &from)) return false;
    if (!curve_parse(from.text, from.path, range, out, &notes, &err))
        return file_error_within(file, uri, &err);
    warn(file, uri, &from, &notes);
    return true;
}

const OpticalConstants *curve_file_index(GltfFile *file, const GltfValue *uri) {
    Error err;
    CurveText from;
    CurveNotes notes;
    if (!uri || !read_text(file, uri, &from)) return NULL;
    OpticalConstants *out = ARENA_NEW(file->load->arena, OpticalConstants, 1);
    if (!curve_parse_index(from.text, from.path, &out->n, &out->k, &notes, &err)) {
        file_error_within(file, uri, &err);
        return NULL;
    }
    warn(file, uri, &from, &notes);
    return out;
}
