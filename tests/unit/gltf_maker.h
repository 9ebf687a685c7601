/* SPDX-License-Identifier: Apache-2.0 */
/* gltf_maker.h -- small glTF files for tests: a JSON text and its bytes, written where the
 * system keeps temporary files, and loaded back. */
#pragma once
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "scene/load/scene_load.h"

#define MAKER_ARENA_BYTES ((size_t)1 << 30)

/* One folder a test program; removed with what lies in it by maker_end. */
typedef struct Maker {
    char folder[256];
    Arena arena, fresh; /* as it is, and as a test finds it */
    int file_count, most_files;
} Maker;

static Maker maker;

static int maker_start(void **state) {
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(maker.folder, sizeof maker.folder, "%s/parhelion-test-XXXXXX", base ? base : P_tmpdir);
    maker.arena = maker.fresh = arena_reserve(MAKER_ARENA_BYTES);
    return mkdtemp(maker.folder) ? 0 : -1;
}

static int maker_end(void **state) {
    (void)state;
    for (int i = 0; i < maker.most_files; i++) {
        char path[300];
        snprintf(path, sizeof path, "%s/%d.gltf", maker.folder, i);
        unlink(path);
        snprintf(path, sizeof path, "%s/%d.glb", maker.folder, i);
        unlink(path);
        snprintf(path, sizeof path, "%s/%d.hdr", maker.folder, i);
        unlink(path);
    }
    arena_release(&maker.arena);
    return rmdir(maker.folder);
}

/* A test starts with all the memory and all the names. */
static inline int maker_reset(void **state) {
    (void)state;
    maker.arena = maker.fresh;
    maker.file_count = 0;
    return 0;
}

/* Writes bytes under a new name with this ending; returns the path. */
static inline const char *maker_file(const void *bytes, size_t size, const char *ending) {
    char *path = arena_format(&maker.arena, "%s/%d%s", maker.folder, maker.file_count++, ending);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        fail_msg("%s cannot be written", path);
    if (maker.file_count > maker.most_files) maker.most_files = maker.file_count;
    return path;
}

static inline char *maker_base64(const void *data, size_t size) {
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *bytes = data;
    char *text = ARENA_NEW(&maker.arena, char, size * 4 / 3 + 8), *out = text;
    for (size_t i = 0; i < size; i += 3) {
        unsigned bits = (unsigned)bytes[i] << 16;
        if (i + 1 < size) bits |= (unsigned)bytes[i + 1] << 8;
        if (i + 2 < size) bits |= bytes[i + 2];
        *out++ = DIGITS[bits >> 18];
        *out++ = DIGITS[bits >> 12 & 63];
        *out++ = i + 1 < size ? DIGITS[bits >> 6 & 63] : '=';
        *out++ = i + 2 < size ? DIGITS[bits & 63] : '=';
    }
    return text;
}

#define maker_format(...) arena_format(&maker.arena, __VA_ARGS__)

/* ---- members ----------------------------------------------------------------------------- */

/* A view of buffer 0, from its beginning or from a byte; floats of a view, "VEC3" or so. */
#define VIEW0(bytes) "{'buffer':0,'byteLength':" #bytes "}"
#define VIEW(at, bytes) "{'buffer':0,'byteOffset':" #at ",'byteLength':" #bytes "}"
#define FLOATS(view, count, type) \
    "{'bufferView':" #view ",'componentType':5126,'count':" #count ",'type':'" type "'}"
#define MESH_OF(attributes) "'meshes':[{'primitives':[{'attributes':{" attributes "}}]}],"
#define ONE_NODE "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}]"

/* Of the size 1 x 1. */
#define PICTURE \
    "'images':[{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1Pe" \
    "AAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC'}],'textures':[{'source':0}],"

/* ---- files ------------------------------------------------------------------------------- */

/* A document whose buffer 0 holds the bytes. `members` are the JSON members besides asset and
 * buffers, with ' for ", so that they read well in C. */
static inline char *maker_text(const void *bytes, size_t size, const char *members) {
    const char *buffers = "";
    if (size)
        buffers = arena_format(&maker.arena,
                               ",\"buffers\":[{\"byteLength\":%zu,\"uri\":"
                               "\"data:application/octet-stream;base64,%s\"}]",
                               size, maker_base64(bytes, size));
    char *text = arena_format(&maker.arena, "{\"asset\":{\"version\":\"2.0\"}%s%s%s}", buffers,
                              members[0] ? "," : "", members);
    for (char *c = strstr(text, members); *c; c++)
        if (*c == '\'') *c = '"';
    return text;
}

static inline const char *maker_gltf(const void *bytes, size_t size, const char *members) {
    const char *text = maker_text(bytes, size, members);
    return maker_file(text, strlen(text), ".gltf");
}

/* What a survey found: the scene as far as it goes, and the problems. */
typedef struct Found {
    Scene *scene;
    Problems problems;
} Found;

static inline Found maker_survey(const SceneOptions *options) {
    Found found = {.problems = problems_start(&maker.arena)};
    found.scene = scene_survey(options, PROGRESS_NONE, &maker.arena, &found.problems);
    return found;
}

static inline Found maker_survey_file(const char *path) {
    return maker_survey(&(SceneOptions){.paths = &path, .path_count = 1});
}

/* Nothing is said of it but warnings. */
static inline void maker_expect_whole(const Found *found) {
    for (int i = 0; i < found->problems.count; i++)
        if (found->problems.list[i].severity == SEVERITY_ERROR)
            fail_msg("%s: %s", found->problems.list[i].path, found->problems.list[i].message);
}

/* A scene that must load without errors. */
static inline Scene *maker_load(const void *bytes, size_t size, const char *members) {
    Found found = maker_survey_file(maker_gltf(bytes, size, members));
    maker_expect_whole(&found);
    return found.scene;
}

/* The first problem whose place and message hold these texts; NULL when there is none. */
static inline const Problem *maker_find(const Found *found, const char *place, const char *text) {
    for (int i = 0; i < found->problems.count; i++) {
        const Problem *p = &found->problems.list[i];
        if (strcmp(p->path, place) == 0 && strstr(p->message, text)) return p;
    }
    return NULL;
}

/* Members of a document, and what is to be said of them. */
typedef struct FaultCase {
    const char *members, *place, *text;
} FaultCase;

static inline void maker_expect_fault(const FaultCase *fault, const void *bytes, size_t size) {
    Found found = maker_survey_file(maker_gltf(bytes, size, fault->members));
    if (maker_find(&found, fault->place, fault->text)) return;
    for (int i = 0; i < found.problems.count; i++)
        print_message("    %s: %s\n", found.problems.list[i].path, found.problems.list[i].message);
    fail_msg("no problem at %s says \"%s\" for %s", fault->place, fault->text, fault->members);
}

/* Each begins with all the memory and all the names. */
static inline void maker_expect_faults(const FaultCase *faults, int count, const void *bytes,
                                       size_t size) {
    for (int i = 0; i < count; i++) {
        maker_reset(NULL);
        maker_expect_fault(&faults[i], bytes, size);
    }
}
