/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/set_writer.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"
#include "text/json_text.h"

typedef struct SetFile {
    struct SetFile *next;
    const char *path;
    FileWriter bytes; /* open until the file has its name */
    bool is_new;      /* nothing had its name before */
    bool is_open, has_its_name;
} SetFile;

typedef struct SetFolder {
    struct SetFolder *before;
    const char *path;
} SetFolder;

static bool exists(const char *path) {
    struct stat status;
    return stat(path, &status) == 0;
}

static bool is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* A file that stands there already may be replaced, unless the set is made from it. */
static bool check_replaced(const Lines *inputs, const char *path, Error *err) {
    for (int i = 0; i < inputs->count; i++)
        if (file_is_same(inputs->list[i], path))
            return error_at(err, ERROR_OUTPUT, path, "",
                            "is one of the files that the set is made from and would be "
                            "written over — choose another folder for the manifest");
    return file_check_writable(path, err);
}

/* A set has some hundred tables, and each is an open file until all are there. */
static void allow_open_files(void) {
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit)) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

/* The folder that `path` stands in; NULL: the working folder, or the root. */
static const char *folder_of(const char *path, Arena *arena) {
    size_t length = (size_t)(path_name(path) - path);
    return length < 2 ? NULL : arena_string(arena, path, length - 1);
}

/* What is not a folder cannot become one. */
static bool check_folder(const char *folder, Error *err) {
    if (!exists(folder)) return file_check_writable(folder, err);
    return is_folder(folder) ||
           error_at(err, ERROR_OUTPUT, folder, "", "cannot be made: %s", strerror(ENOTDIR));
}

bool set_writer_open(const char *manifest, const Lines *inputs, SetWriter *out, Error *err) {
    if (exists(manifest) && !check_replaced(inputs, manifest, err)) return false;
    SetWriter made = {.manifest = manifest,
                      .inputs = inputs,
                      .arena = arena_reserve((size_t)1 << 30),
                      .err = err};
    const char *folder = folder_of(manifest, &made.arena);
    if (folder && !check_folder(folder, err)) {
        arena_release(&made.arena);
        return false;
    }
    made.place = folder && !exists(folder) ? folder : manifest;
    allow_open_files();
    *out = made;
    return true;
}

/* The file's place in the list, a new one at its end; NULL when it may not be replaced. */
static SetFile *find_file(SetWriter *writer, const char *path) {
    for (SetFile *file = writer->first; file; file = file->next)
        if (!strcmp(file->path, path)) return file;
    bool is_new = !exists(path);
    if (!is_new && !check_replaced(writer->inputs, path, writer->err)) return NULL;
    SetFile *file = ARENA_NEW(&writer->arena, SetFile, 1);
    *file = (SetFile){.path = path, .is_new = is_new};
    if (writer->last) writer->last->next = file;
    else writer->first = file;
    return writer->last = file;
}

bool set_writer_add(SetWriter *writer, const char *name, const Text *text) {
    Arena *arena = &writer->arena;
    SetFile *file = find_file(writer, path_beside(writer->manifest, name, arena));
    if (!file) return false;
    if (file->is_open) file_writer_discard(&file->bytes);
    const char *place = arena_format(arena, "%s-%d", writer->place, writer->count++);
    file->is_open = file_writer_open(place, &file->bytes, writer->err) &&
                    file_writer_add(&file->bytes, text->data, text->size, writer->err);
    if (file->is_open) return true;
    writer->err->file[0] = '\0'; /* the place beside which it lay */
    return error_in_file(writer->err, file->path);
}

bool set_writer_add_manifest(SetWriter *writer, const json_t *root, int digits) {
    Text text = {.arena = &writer->arena};
    if (!json_dump_text(&text, root, JSON_INDENT(2) | JSON_REAL_PRECISION((size_t)digits)))
        return error_set(writer->err, ERROR_MEMORY, "no memory for the manifest");
    text_add(&text, "\n");
    return set_writer_add(writer, path_name(writer->manifest), &text);
}

/* ---- all files get their names ----------------------------------------------------------- */

static bool make_folder(SetWriter *writer, const char *folder) {
    if (is_folder(folder)) return true;
    if (mkdir(folder, 0777))
        return error_at(writer->err, ERROR_OUTPUT, folder, "", "cannot be made: %s",
                        strerror(errno == EEXIST ? ENOTDIR : errno));
    SetFolder *made = ARENA_NEW(&writer->arena, SetFolder, 1);
    *made = (SetFolder){writer->made, folder};
    writer->made = made;
    return true;
}

/* The manifest's, and those of a name beside it, the outer ones first. */
static bool make_folders(SetWriter *writer, const char *path) {
    const char *root = folder_of(writer->manifest, &writer->arena);
    size_t before = (size_t)(path_name(writer->manifest) - writer->manifest);
    if (root && !make_folder(writer, root)) return false;
    for (size_t i = before; path[i]; i++)
        if (path[i] == '/' && !make_folder(writer, arena_string(&writer->arena, path, i)))
            return false;
    return true;
}

static void undo(const SetWriter *writer) {
    for (SetFile *file = writer->first; file; file = file->next) {
        if (file->is_open) file_writer_discard(&file->bytes);
        else if (file->has_its_name && file->is_new) file_remove(file->path);
    }
    for (SetFolder *folder = writer->made; folder; folder = folder->before) rmdir(folder->path);
}

static bool commit(SetWriter *writer) {
    for (SetFile *file = writer->first; file; file = file->next) {
        if (!make_folders(writer, file->path)) return false;
        file->is_open = false;
        file->has_its_name = file_writer_commit_as(&file->bytes, file->path, writer->err);
        if (!file->has_its_name) return false;
    }
    return true;
}

bool set_writer_close(SetWriter *writer, bool is_whole) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before); /* who stops it finds all files or none */
    bool ok = is_whole && commit(writer);
    if (!ok) undo(writer);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    arena_release(&writer->arena);
    return ok;
}
