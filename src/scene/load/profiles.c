/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/profiles.h"

#include <string.h>

#include "import/luminaire/ies.h"
#include "import/luminaire/luminaire_read.h"
#include "scene/gltf/document.h"
#include "text/name_hint.h"
#include "text/uri.h"

#define EXTENSION "EXT_lights_ies"
#define MEDIA_TYPE "application/x-ies-lm-63"

static const GltfValue *profile_list(const GltfFile *file) {
    return tree_member(tree_extension(file->root, EXTENSION), "lights");
}

static bool is_shown(const GltfFile *file, int index) {
    for (const GltfValue *node = tree_items(file->root, "nodes"); node; node = tree_next(node))
        if (tree_int(tree_extension(node, EXTENSION), "light", NO_ID) == index) return true;
    return false;
}

/* Why the factors of TILT=FILE cannot be had; NULL: they were read. */
static const char *read_tilt_file(Loader *load, const LightProfile *profile, bool has_folder,
                                  Luminaire *luminaire, Error *err) {
    FileBytes bytes;
    ImportSet notes = import_set(&load->scratch);
    const char *name = luminaire->tilt.file;
    if (!has_folder) return "nothing stands beside a file inside a scene";
    if (strpbrk(name, "/\\:")) return "only a file in the same folder is read";
    const char *path = path_beside(profile->file, name, &load->scratch);
    if (!file_exists(path))
        return arena_format(&load->scratch, "there is no such file beside it%s",
                            name_hint(path, &load->scratch));
    luminaire->tilt.file = NULL;
    if (load_read(load, path, &load->scratch, &bytes, err))
        ies_read_tilt(path, &bytes, &notes, &luminaire->tilt, err);
    return NULL;
}

static bool read_tilt(Loader *load, const LightProfile *profile, bool has_folder,
                      Luminaire *luminaire, Error *err) {
    const char *name = luminaire->tilt.file;
    Error fault = {0};
    if (!name) return true;
    const char *why = read_tilt_file(load, profile, has_folder, luminaire, &fault);
    if (why)
        problems_add(load->problems, SEVERITY_WARNING, profile->file, "",
                     "its tilt factors (TILT=%.100s) are not applied: %s", name, why);
    if (why || luminaire->tilt.geometry) return true;
    *err = fault;
    return false;
}

bool profile_read(Loader *load, FileBytes bytes, bool has_folder, LightProfile *out, Error *err) {
    Luminaire luminaire;
    ImportSet notes = import_set(&load->scratch);
    IntensityWeb *web = ARENA_NEW(load->arena, IntensityWeb, 1);
    if (!luminaire_read(out->file, bytes, &notes, &luminaire, err) ||
        !luminaire_web(&luminaire, load->arena, web, err) ||
        !read_tilt(load, out, has_folder, &luminaire, err))
        return false;
    out->web = web;
    out->opening = luminaire.opening;
    out->tilt = luminaire.tilt;
    out->cct_k = (float)luminaire.cct_k;
    out->cct_text = load_keep(load, luminaire.cct_text);
    for (int i = 0; i < luminaire.doubts; i++)
        problems_add(load->problems, SEVERITY_WARNING, out->file, "", "%s", luminaire.doubt[i]);
    return true;
}

/* ---- bytes ------------------------------------------------------------------------------- */

static bool data_bytes(GltfFile *file, const GltfValue *uri, FileBytes *bytes) {
    Error err;
    const char *type;
    if (!data_uri_decode(uri->text, &file->load->scratch, bytes, &type, &err))
        return file_error(file, uri, "%s", err.text);
    if (strcmp(type, MEDIA_TYPE) != 0)
        file_warning(file, uri,
                     "the media type is \"%.60s\"; " MEDIA_TYPE " is "
                     "required",
                     type);
    return true;
}

static bool file_bytes(GltfFile *file, const GltfValue *uri, FileBytes *bytes, const char **name) {
    Error err;
    Severity severity = is_shown(file, uri->parent->index) ? SEVERITY_ERROR : SEVERITY_WARNING;
    if (document_is_elsewhere(file, uri, severity)) return false;
    if (!document_resolve(file, uri, name)) return false;
    if (luminaire_is_eulumdat(*name))
        return file_error(file, uri,
                          "%s is EULUMDAT, " EXTENSION " has IES LM-63 (.ies) only: give it "
                          "with --light NODE=FILE.ldt",
                          *name);
    return load_read(file->load, *name, &file->load->scratch, bytes, &err) ||
           file_error(file, uri, "%s: %s", *name, err.text);
}

/* *name: of a file its path; of bytes inside the scene where they are. */
static bool profile_bytes(GltfFile *file, const GltfValue *profile, FileBytes *bytes,
                          const char **name) {
    char pointer[80];
    const GltfValue *uri = tree_member(profile, "uri");
    tree_pointer(profile, pointer, sizeof pointer);
    *name = arena_format(&file->load->scratch, "%s#%s", file->path, pointer);
    if (uri && uri_is_data(uri->text)) return data_bytes(file, uri, bytes);
    if (uri) return file_bytes(file, uri, bytes, name);
    int view = tree_int(profile, "bufferView", NO_ID);
    *bytes = view >= 0 && view < file->data.view_count ? document_view(file, view) : (FileBytes){0};
    return bytes->data || file_error(file, profile, "its bytes are missing");
}

/* ---- all of them ------------------------------------------------------------------------- */

static void report_fault(GltfFile *file, const GltfValue *profile, const char *name,
                         const Error *err) {
    const GltfValue *uri = tree_member(profile, "uri");
    bool is_file = uri && !uri_is_data(uri->text);
    file_error(file, uri ? uri : profile, "%s%s%s%s%s", is_file ? name : "", is_file ? ": " : "",
               err->path, err->path[0] ? ": " : "", err->text);
}

static void load_profile(GltfFile *file, const GltfValue *value, LightProfile *out) {
    Error err = {0};
    FileBytes bytes;
    Loader *load = file->load;
    out->name = load_name(load, value, "light profile");
    if (!profile_bytes(file, value, &bytes, &out->file)) return;
    const GltfValue *uri = tree_member(value, "uri");
    bool has_folder = uri && !uri_is_data(uri->text);
    if (!profile_read(load, bytes, has_folder, out, &err))
        report_fault(file, value, out->file, &err);
}

void profiles_load(GltfFile *file) {
    const GltfValue *list = profile_list(file);
    int count = list ? list->count : 0;
    file->profiles = ARENA_NEW(&file->load->scratch, LightProfile, count + 1);
    for (int i = 0; i < count; i++) load_profile(file, &list->items[i], &file->profiles[i]);
}

const LightProfile *profile_at(const GltfFile *file, int index) {
    return tree_item(profile_list(file), index) ? &file->profiles[index] : NULL;
}
