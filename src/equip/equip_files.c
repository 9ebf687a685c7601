/* SPDX-License-Identifier: Apache-2.0 */
#include "equip/equip_files.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/reference.h"
#include "text/json_text.h"
#include "text/uri.h"

#define FILE_BYTES_MAX ((size_t)4 << 30)
#define NAMES_TRIED 1000

bool equip_files_open(const char *model, const char *output, const char *root, Arena *arena,
                      EquipFiles *out, Error *err) {
    char folder[PATH_MAX];
    if (!realpath(path_beside(output, "./", arena), folder))
        return error_at(err, ERROR_OUTPUT, output, "", "its folder cannot be found");
    *out = (EquipFiles){.model = model, .output = output, .root = root, .arena = arena};
    out->folder = arena_format(arena, "%s%s", folder, strcmp(folder, "/") ? "/" : "");
    return true;
}

const char *equip_files_beside(const EquipFiles *files, const char *ending) {
    size_t length = strlen(files->output) - strlen(path_ending(files->output));
    return arena_format(files->arena, "%.*s%s", (int)length, files->output, ending);
}

/* ---- copies ------------------------------------------------------------------------------ */

static bool has_same_bytes(const char *a, const char *b, Arena scratch) {
    FileBytes one, other;
    Error none;
    return file_read(a, FILE_BYTES_MAX, &scratch, &one, &none) &&
           file_read(b, FILE_BYTES_MAX, &scratch, &other, &none) && one.size == other.size &&
           !memcmp(one.data, other.data, one.size);
}

/* A name that somebody has: another copy, or what is written besides. */
static bool is_taken(const EquipFiles *files, const char *name) {
    const char *const own[] = {".gltf", ".bin", ".review.json", ".occupant.gltf"};
    bool found = false;
    for (int i = 0; i < files->count && !found; i++) found = !strcmp(files->copies[i].name, name);
    for (int i = 0; i < COUNT_OF(own) && !found; i++)
        found = !strcmp(path_name(equip_files_beside(files, own[i])), name);
    return found;
}

static const char *numbered(const EquipFiles *files, const char *source, int number) {
    const char *stem = path_name(equip_files_beside(files, ""));
    if (!number) return path_name(source);
    if (number == 1) return arena_format(files->arena, "%s_%s", stem, path_name(source));
    return arena_format(files->arena, "%s_%d_%s", stem, number, path_name(source));
}

static bool add_copy(EquipFiles *files, const char *source, const char **name, Error *err) {
    EquipCopy copy = {.source = source};
    for (int i = 0; i < NAMES_TRIED; i++) {
        copy.name = numbered(files, source, i);
        const char *path = path_beside(files->output, copy.name, files->arena);
        if (is_taken(files, copy.name)) continue;
        copy.is_there = file_exists(path) && has_same_bytes(path, source, *files->arena);
        if (copy.is_there || !file_exists(path)) break;
        copy.name = NULL;
    }
    if (!copy.name)
        return error_at(err, ERROR_OUTPUT, files->output, "",
                        "%s cannot be copied beside it: all names are taken", source);
    if (files->count == files->capacity) {
        int wanted = 2 * files->capacity + 8;
        files->copies = ARENA_GROW(files->arena, EquipCopy, files->copies, files->count, wanted);
        files->capacity = wanted;
    }
    files->copies[files->count++] = copy;
    *name = copy.name;
    return true;
}

bool equip_files_take(EquipFiles *files, const char *path, const char **uri, Error *err) {
    char target[PATH_MAX];
    if (!realpath(path, target)) return error_at(err, ERROR_INPUT, path, "", "cannot be found");
    const char *name = NULL;
    const ReferenceReach beside = {NULL, true};
    *uri = uri_between(files->folder, target, files->arena);
    if (uri_may_be_named(files->output, *uri, beside, *files->arena)) return true;
    for (int i = 0; i < files->count && !name; i++)
        if (!strcmp(files->copies[i].source, target)) name = files->copies[i].name;
    if (!name && !add_copy(files, arena_string(files->arena, target, strlen(target)), &name, err))
        return false;
    *uri = uri_between("/", arena_format(files->arena, "/%s", name), files->arena);
    return true;
}

bool equip_files_write(EquipFiles *files, Error *err) {
    for (int i = 0; i < files->count; i++) {
        EquipCopy *copy = &files->copies[i];
        FileBytes bytes;
        Arena scratch = *files->arena;
        const char *path = path_beside(files->output, copy->name, &scratch);
        if (copy->is_there) continue;
        if (!file_read(copy->source, FILE_BYTES_MAX, &scratch, &bytes, err) ||
            !file_write(path, bytes.data, bytes.size, err))
            return false;
        copy->is_written = true;
    }
    return true;
}

void equip_files_undo(const EquipFiles *files) {
    for (int i = 0; i < files->count; i++)
        if (files->copies[i].is_written)
            file_remove(path_beside(files->output, files->copies[i].name, files->arena));
}

/* ---- what the document names ------------------------------------------------------------- */

/* A word such as "sky" may be a folder's name. */
static bool is_regular(const char *path) {
    struct stat info;
    return !stat(path, &info) && S_ISREG(info.st_mode);
}

static bool is_among(const char *path, const char *const *list, int count) {
    bool found = false;
    for (int i = 0; i < count && !found; i++) found = !strcmp(list[i], path);
    return found;
}

static bool is_decoded(const Scene *scene, const char *path) {
    return !scene || (is_among(path, scene->inputs, scene->input_count) &&
                      !is_among(path, scene->undecoded, scene->undecoded_count));
}

/* The file that a URI of the model names; NULL when it names none, as most texts. */
static const char *named_file(const EquipFiles *files, const char *uri) {
    Error none;
    char *relative;
    const char *path = NULL;
    const ReferenceReach reach = {files->root, files->decoded != NULL};
    if (uri_scheme_length(uri) || !uri_decode(uri, files->arena, &relative, &none) ||
        !reference_resolve(files->model, relative, reach, files->arena, &path, &none) ||
        !is_regular(path) || !is_decoded(files->decoded, path))
        return NULL;
    return path;
}

/* The text with its file's new name, a new reference; the old one where it names no file. */
static bool renamed(EquipFiles *files, json_t *text, json_t **out, Error *err) {
    const char *path = named_file(files, json_string_value(text)), *uri;
    if (path && !equip_files_take(files, path, &uri, err)) return false;
    *out = path ? json_text(uri) : json_incref(text);
    return true;
}

static bool refer_value(EquipFiles *files, json_t *value, Error *err);

static bool refer_members(EquipFiles *files, json_t *object, Error *err) {
    const char *key;
    json_t *item, *text;
    json_object_foreach(object, key, item) {
        if (!json_is_string(item)) {
            if (!refer_value(files, item, err)) return false;
            continue;
        }
        if (!renamed(files, item, &text, err)) return false;
        json_object_set_new(object, key, text);
    }
    return true;
}

/* Below an extension: any member that names a file gets its new name. */
static bool refer_value(EquipFiles *files, json_t *value, Error *err) {
    json_t *item;
    size_t i;
    if (json_is_object(value)) return refer_members(files, value, err);
    json_array_foreach(value, i, item) if (!refer_value(files, item, err)) return false;
    return true;
}

/* extras may hold an extension as a text, which is taken apart. */
static bool refer_named(EquipFiles *files, json_t *object, const char *key, json_t *value,
                        Error *err) {
    json_t *apart = json_is_string(value)
                        ? json_loads(json_string_value(value), JSON_REJECT_DUPLICATES, NULL)
                        : NULL;
    if (!apart) return refer_value(files, value, err);
    bool ok = refer_value(files, apart, err);
    if (ok) json_object_set(object, key, apart);
    json_decref(apart);
    return ok;
}

static bool refer_extensions(EquipFiles *files, json_t *object, Error *err) {
    const char *const places[] = {"extensions", "extras"};
    for (int i = 0; i < 2; i++) {
        const char *key;
        json_t *value, *inside = json_object_get(object, places[i]);
        json_object_foreach(
            inside, key,
            value) if ((!strncmp(key, "PARHELION_", 10) || !strcmp(key, "EXT_lights_ies")) &&
                       !refer_named(files, inside, key, value, err)) return false;
    }
    return true;
}

/* Stands in for a file that nothing shows and that is no picture: one pixel. */
static const char no_picture[] =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNgAAAAAgAB"
    "5Sfe/AAAAABJRU5ErkJggg==";

/* A file that was not decoded is named no more. */
static bool refer_uri(EquipFiles *files, json_t *object, bool is_picture, Error *err) {
    json_t *uri = json_object_get(object, "uri"), *text;
    if (!json_is_string(uri)) return true;
    if (!renamed(files, uri, &text, err)) return false;
    bool is_named = text != uri || uri_scheme_length(json_string_value(uri));
    json_object_set_new(object, "uri", text);
    if (is_named) return true;
    json_object_del(object, "uri");
    if (is_picture) json_object_del(object, "mimeType");
    if (is_picture) json_object_set_new(object, "uri", json_text(no_picture));
    return true;
}

static bool names_buffer(const json_t *object, size_t index) {
    const json_t *buffer = json_object_get(object, "buffer");
    return json_is_number(buffer) && json_number_value(buffer) == (double)index;
}

static void drop_unread_buffers(json_t *document) {
    json_t *buffer, *view;
    size_t i, k;
    json_array_foreach(json_object_get(document, "buffers"), i, buffer) {
        bool is_read = false;
        json_array_foreach(json_object_get(document, "bufferViews"), k, view) {
            const json_t *extensions = json_object_get(view, "extensions");
            is_read |= names_buffer(view, i) ||
                       names_buffer(json_object_get(extensions, "EXT_meshopt_compression"), i);
        }
        if (!is_read) json_object_del(buffer, "uri");
    }
}

bool equip_files_refer(EquipFiles *files, json_t *document, Error *err) {
    const char *const lists[] = {"buffers", "images", "materials", "scenes", "nodes"};
    drop_unread_buffers(document);
    if (!refer_extensions(files, document, err)) return false;
    for (int i = 0; i < 5; i++) {
        json_t *item;
        size_t k;
        json_array_foreach(json_object_get(document, lists[i]), k,
                           item) if ((i < 2 && !refer_uri(files, item, i == 1, err)) ||
                                     !refer_extensions(files, item, err)) return false;
    }
    return true;
}
