/* SPDX-License-Identifier: Apache-2.0 */
/* document.h -- a .gltf or .glb file: its JSON, its buffers, the files that it names.
 *
 * Memory   documents, buffers and paths lie in the loader's scratch.
 * Fails    into the loader's problems, with file and JSON pointer.
 */
#pragma once
#include "scene/gltf/loader.h"

#define MESHOPT_EXTENSION "EXT_meshopt_compression"    /* packed views (gltf/buffer_view.h) */
#define INSTANCING_EXTENSION "EXT_mesh_gpu_instancing" /* meshes in many places */
#define NORMAL_CONVENTION_EXTENSION "ASOBO_normal_map_convention"
#define DRACO_EXTENSION "KHR_draco_mesh_compression" /* packed meshes (gltf/packed_mesh.h) */

/* A fault or warning at a place of the document (NULL: the file as a whole). file_error is
 * always false. */
bool file_error(GltfFile *file, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void file_warning(GltfFile *file, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void file_problem(GltfFile *file, Severity severity, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void file_report(GltfFile *file, Severity severity, const GltfValue *at, const char *format,
                 va_list args) __attribute__((format(printf, 4, 0)));

/* A text in the scene's memory; the name of a value there, "NOUN 3" where it has none; a text
 * there, in a list of texts. */
const char *load_keep(Loader *load, const char *text);
const char *load_name(Loader *load, const GltfValue *value, const char *noun);
void load_note(Loader *load, ItemList *texts, const char *text);

bool load_is_among(const char *name, const char *const *names, int count);

/* A fault of a file that a place of the document names, with its own place. Always false. */
bool file_error_within(GltfFile *file, const GltfValue *at, const Error *err);

/* Reads a file, hashes it and notes it among the scene's inputs. */
bool load_read(Loader *load, const char *path, Arena *arena, FileBytes *out, Error *err);

/* Reads and parses a .gltf or .glb. False when there is no document to check. */
bool document_read(GltfFile *file);

/* Whether extensionsUsed lists the extension. The document need not have been checked. */
bool document_uses(const GltfFile *file, const char *extension);

/* Fills file->buffers; what is missing or short is reported. */
void document_load_buffers(GltfFile *file);

/* The path a URI names, from the scene's folder. False, and reported, when it is not allowed:
 * another scheme, an absolute path, or a place where the scene may not look
 * (base/reference.h). */
bool document_resolve(GltfFile *file, const GltfValue *uri, const char **path);

/* Whether a URI is absolute: glTF allows those, but there is no network, and no path of another
 * machine's here. Reported with this severity: an error where the picture needs the bytes. */
bool document_is_elsewhere(GltfFile *file, const GltfValue *uri, Severity severity);

/* The bytes of a buffer view; data NULL when there are none. */
FileBytes document_view(const GltfFile *file, int view);
