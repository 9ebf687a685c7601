/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/gltf/document.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/reference.h"
#include "text/name_hint.h"
#include "text/uri.h"

/* ---- problems -------------------------------------------------------------------------- */

void file_report(GltfFile *file, Severity severity, const GltfValue *at, const char *format,
                 va_list args) {
    char pointer[256];
    tree_pointer(at, pointer, sizeof pointer);
    problems_add_list(file->load->problems, severity, file->path, pointer, format, args);
}

void file_problem(GltfFile *file, Severity severity, const GltfValue *at, const char *format, ...) {
    va_list args;
    va_start(args, format);
    file_report(file, severity, at, format, args);
    va_end(args);
}

bool file_error(GltfFile *file, const GltfValue *at, const char *format, ...) {
    va_list args;
    va_start(args, format);
    file_report(file, SEVERITY_ERROR, at, format, args);
    va_end(args);
    return false;
}

bool file_error_within(GltfFile *file, const GltfValue *at, const Error *err) {
    char line[1024];
    error_line(err, line, sizeof line);
    return file_error(file, at, "%s", line);
}

void file_warning(GltfFile *file, const GltfValue *at, const char *format, ...) {
    va_list args;
    va_start(args, format);
    file_report(file, SEVERITY_WARNING, at, format, args);
    va_end(args);
}

/* A fault in a .glb's frame, which has no JSON pointer. */
static bool frame_error(GltfFile *file, const char *place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool frame_error(GltfFile *file, const char *place, const char *format, ...) {
    va_list args;
    va_start(args, format);
    problems_add_list(file->load->problems, SEVERITY_ERROR, file->path, place, format, args);
    va_end(args);
    return false;
}

/* ---- files ----------------------------------------------------------------------------- */

const char *load_keep(Loader *load, const char *text) {
    return arena_string(load->arena, text, strlen(text));
}

const char *load_name(Loader *load, const GltfValue *value, const char *noun) {
    const char *name = tree_text(value, "name", "");
    return name[0] ? load_keep(load, name) : arena_format(load->arena, "%s %d", noun, value->index);
}

void load_note(Loader *load, ItemList *texts, const char *text) {
    *(const char **)list_add(texts, &load->scratch) = load_keep(load, text);
}

bool load_is_among(const char *name, const char *const *names, int count) {
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

static void note_input(Loader *load, const char *path, FileBytes bytes) {
    if (load_is_among(path, load->inputs.items, load->inputs.count)) return;
    load_note(load, &load->inputs, path);
    *(uint64_t *)list_add(&load->input_hashes, &load->scratch) =
        XXH3_64bits(bytes.data, bytes.size);
}

static void report_read(void *user, size_t done, size_t size) {
    Loader *load = user;
    load->progress.total = (double)size;
    load_progress_add(load, (double)done - load->progress_done);
}

/* Adds the name that may be meant, of a file that is not there. Always false. */
static bool hint_name(Loader *load, const char *path, Error *err) {
    const char *hint = file_exists(path) ? "" : name_hint(path, &load->scratch);
    const Error was = *err;
    return *hint ? error_at(err, was.code, was.file, was.path, "%s%s", was.text, hint) : false;
}

/* A document that is no file: the program wrote it. */
static bool is_written(const SceneOptions *options, const char *path) {
    return options->written && !strcmp(path, options->paths[0]);
}

bool load_read(Loader *load, const char *path, Arena *arena, FileBytes *out, Error *err) {
    bool is_step = !load->has_step; /* not within another one */
    const FilePieces how = {
        .max_bytes = LOAD_MAX_FILE_BYTES, .on_bytes = is_step ? report_read : NULL, .user = load};
    if (is_step) load_progress_begin(load, "read", "bytes", 0);
    bool is_read = true;
    if (is_written(load->options, path))
        *out = (FileBytes){(const unsigned char *)load->options->written,
                           strlen(load->options->written)};
    else is_read = file_read_pieces(path, &how, arena, out, err);
    if (is_step) load_progress_end(load);
    if (!is_read) return hint_name(load, path, err);
    note_input(load, path, *out);
    return true;
}

bool document_is_elsewhere(GltfFile *file, const GltfValue *uri, Severity severity) {
    size_t scheme = uri_scheme_length(uri->text);
    if (scheme)
        file_problem(file, severity, uri,
                     "the URI's scheme is \"%.*s:\"; only data: and relative paths are read",
                     (int)(scheme < 40 ? scheme : 40), uri->text);
    else if (uri->text[0] == '/')
        file_problem(file, severity, uri,
                     "\"%.200s\" is an absolute path; only data: and relative paths are read",
                     uri->text);
    return scheme || uri->text[0] == '/';
}

bool document_resolve(GltfFile *file, const GltfValue *uri, const char **path) {
    Error err;
    char *relative;
    const SceneOptions *options = file->load->options;
    const ReferenceReach reach = {options->root, options->own_folder};
    if (document_is_elsewhere(file, uri, SEVERITY_ERROR)) return false;
    return (uri_decode(uri->text, &file->load->scratch, &relative, &err) &&
            reference_resolve(file->path, relative, reach, &file->load->scratch, path, &err)) ||
           file_error(file, uri, "%s", err.text);
}

/* ---- a .glb's frame (glTF 2.0, section 4) ---------------------------------------------- */

enum { GLB_HEADER = 12, CHUNK_HEADER = 8, CHUNK_JSON = 0x4E4F534A, CHUNK_BIN = 0x004E4942 };

static uint32_t u32_at(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool take_chunk(GltfFile *file, const char *place, int number, uint32_t type,
                       FileBytes chunk) {
    if (number == 0 && type != CHUNK_JSON)
        return frame_error(file, place,
                           "the first chunk's type is 0x%08x, JSON (0x4e4f534a) is "
                           "required",
                           type);
    if (number > 0 && type == CHUNK_JSON)
        return frame_error(file, place, "a second JSON chunk; one is required");
    if (type == CHUNK_BIN && number != 1)
        return frame_error(file, place, "a BIN chunk as number %d; it may only be the second",
                           number + 1);
    if (type == CHUNK_JSON) {
        file->json = (const char *)chunk.data;
        file->json_size = chunk.size;
    } else if (type == CHUNK_BIN) {
        file->bin = chunk;
    } else {
        problems_add(file->load->problems, SEVERITY_WARNING, file->path, place,
                     "chunk of unknown type 0x%08x is skipped", type);
    }
    return true;
}

static bool read_chunks(GltfFile *file, FileBytes bytes, size_t length) {
    size_t at = GLB_HEADER;
    for (int number = 0; at < length; number++) {
        char place[64];
        snprintf(place, sizeof place, "byte %zu", at);
        if (length - at < CHUNK_HEADER)
            return frame_error(file, place, "%zu bytes left, a chunk's header has 8", length - at);
        uint32_t size = u32_at(bytes.data + at), type = u32_at(bytes.data + at + 4);
        at += CHUNK_HEADER;
        if (size > length - at)
            return frame_error(file, place, "the chunk has %u bytes, %zu are left", size,
                               length - at);
        if (size % 4)
            return frame_error(file, place,
                               "the chunk has %u bytes, a multiple of 4 is "
                               "required",
                               size);
        if (!take_chunk(file, place, number, type, (FileBytes){bytes.data + at, size}))
            return false;
        at += size;
    }
    return true;
}

static bool read_glb(GltfFile *file, FileBytes bytes) {
    file->is_binary = true;
    if (bytes.size < GLB_HEADER)
        return frame_error(file, "byte 0", "%zu bytes, a .glb's header has 12", bytes.size);
    if (memcmp(bytes.data, "glTF", 4) != 0)
        return frame_error(file, "byte 0", "starts with 0x%08x, \"glTF\" is required",
                           u32_at(bytes.data));
    uint32_t version = u32_at(bytes.data + 4), length = u32_at(bytes.data + 8);
    if (version != 2)
        return frame_error(file, "byte 4",
                           "version %u of the container, 2 is "
                           "required",
                           version);
    if (length > bytes.size)
        return frame_error(file, "byte 8", "the length is %u, the file has %zu bytes", length,
                           bytes.size);
    if (length < GLB_HEADER + CHUNK_HEADER)
        return frame_error(file, "byte 8", "the length is %u, at least 20 is required", length);
    if (length < bytes.size)
        problems_add(file->load->problems, SEVERITY_WARNING, file->path, "byte 8",
                     "the length is %u, the file has %zu bytes: the rest is skipped", length,
                     bytes.size);
    return read_chunks(file, bytes, length);
}

bool document_read(GltfFile *file) {
    Error err;
    FileBytes bytes;
    Loader *load = file->load;
    if (!load_read(load, file->path, &load->scratch, &bytes, &err)) {
        problems_add_error(load->problems, &err);
        return false;
    }
    bool is_glb = strcasecmp(path_ending(file->path), ".glb") == 0 ||
                  (bytes.size >= 4 && memcmp(bytes.data, "glTF", 4) == 0);
    if (is_glb && !read_glb(file, bytes)) return false;
    if (!is_glb) {
        file->json = (const char *)bytes.data;
        file->json_size = bytes.size;
    }
    if (file->json_size > LOAD_MAX_JSON_BYTES)
        return file_error(file, NULL, "the JSON has %zu bytes, at most %zu are read",
                          file->json_size, LOAD_MAX_JSON_BYTES);
    if (!gltf_json_parse(file->json, file->json_size, &load->scratch, &file->root, &err))
        return file_error(file, NULL, "%s", err.text);
    return file->root->kind == GLTF_OBJECT ||
           file_error(file, NULL, "the document is no JSON object");
}

/* ---- buffers --------------------------------------------------------------------------- */

static void check_buffer_type(GltfFile *file, const GltfValue *uri, const char *type) {
    if (strcmp(type, "application/octet-stream") != 0 &&
        strcmp(type, "application/gltf-buffer") != 0)
        file_warning(file, uri,
                     "the media type is \"%.60s\"; application/octet-stream or "
                     "application/gltf-buffer is required",
                     type);
}

bool document_uses(const GltfFile *file, const char *extension) {
    return tree_lists(tree_member(file->root, "extensionsUsed"), extension);
}

/* The buffer is for readers that cannot unpack (EXT_meshopt_compression). */
static bool is_fallback(const GltfValue *buffer) {
    return tree_boolean(tree_extension(buffer, MESHOPT_EXTENSION), "fallback", false);
}

static bool buffer_bytes(GltfFile *file, const GltfValue *buffer, FileBytes *out) {
    Error err;
    const char *path;
    Arena *scratch = &file->load->scratch;
    const GltfValue *uri = tree_member(buffer, "uri");
    if (uri && uri->kind != GLTF_STRING) return false; /* reported by the check */
    if (is_fallback(buffer)) return false;             /* nobody reads it */
    if (!uri) {
        *out = buffer->index == 0 ? file->bin : (FileBytes){0};
        if (file->is_binary && buffer->index == 0 && !out->data)
            file_error(file, buffer, "the buffer has no uri and the file no BIN chunk");
        return out->data != NULL;
    }
    if (uri_is_data(uri->text)) {
        const char *type;
        if (!data_uri_decode(uri->text, scratch, out, &type, &err))
            return file_error(file, uri, "%s", err.text);
        check_buffer_type(file, uri, type);
        return true;
    }
    if (document_is_elsewhere(file, uri, SEVERITY_WARNING)) return false;
    if (!document_resolve(file, uri, &path)) return false;
    return load_read(file->load, path, scratch, out, &err) ||
           file_error(file, uri, "%s: %s", path, err.text);
}

void document_load_buffers(GltfFile *file) {
    const GltfValue *buffers = tree_member(file->root, "buffers");
    int count = buffers && buffers->kind == GLTF_ARRAY ? buffers->count : 0;
    file->buffers = ARENA_NEW(&file->load->scratch, FileBytes, count);
    for (int i = 0; i < count; i++) {
        const GltfValue *buffer = &buffers->items[i];
        FileBytes bytes;
        if (!buffer_bytes(file, buffer, &bytes)) continue;
        const GltfValue *length = tree_member(buffer, "byteLength"); /* checked before */
        bool has_length = tree_is_integer(length) && length->number >= 0;
        size_t wanted = has_length ? (size_t)length->number : 0;
        if (bytes.size < wanted) {
            file_error(file, tree_member(buffer, "byteLength"),
                       "byteLength is %zu, %zu bytes are there", wanted, bytes.size);
            continue;
        }
        if (file->is_binary && !tree_member(buffer, "uri") && bytes.size - wanted > 3)
            file_warning(file, buffer, "the BIN chunk has %zu bytes more than byteLength",
                         bytes.size - wanted);
        file->buffers[i] = (FileBytes){bytes.data, wanted};
    }
}

FileBytes document_view(const GltfFile *file, int view) {
    return file->views[view];
}
