/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/set_writer.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_write.h"
#include "text/json_text.h"

typedef struct SetFile {
    struct SetFile *next;
    const char     *path, *temporary;
    bool            is_new; /* nothing had its name before */
    bool            has_its_name;
} SetFile;

typedef struct SetFolder {
    struct SetFolder *before;
    const char       *path;
} SetFolder;

static bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

/* A file that stands there already may be replaced, unless the set is made from it. */
static bool check_replaced(const Lines *inputs, const char *path, Error *err)
{
    for (int i = 0; i < inputs->count; i++)
        if (file_is_same(inputs->list[i], path))
            return error_at(err, ERROR_OUTPUT, path, "",
                            "is one of the files that the set is made from and would be "
                            "written over — choose another folder for the manifest");
    return file_check_writable(path, err);
}

bool set_writer_open(const char *manifest, const Lines *inputs, SetWriter *out, Error *err)
{
    if (exists(manifest) && !check_replaced(inputs, manifest, err)) return false;
    *out = (SetWriter){.manifest = manifest, .inputs = inputs,
                       .arena = arena_reserve((size_t)1 << 30),
                       .err = err};
    return true;
}

/* The folder that `path` stands in. */
static bool make_folder(SetWriter *writer, const char *path)
{
    size_t length = (size_t)(path_name(path) - path);
    if (length < 2) return true;
    const char *folder = arena_string(&writer->arena, path, length - 1);
    if (mkdir(folder, 0777))
        return errno == EEXIST || error_at(writer->err, ERROR_OUTPUT, folder, "",
                                           "cannot be made: %s", strerror(errno));
    SetFolder *made = ARENA_NEW(&writer->arena, SetFolder, 1);
    *made = (SetFolder){writer->made, folder};
    writer->made = made;
    return true;
}

/* All folders of a name beside the manifest, the outer ones first. */
static bool make_folders(SetWriter *writer, const char *path, const char *name)
{
    size_t before = strlen(path) - strlen(name);
    if (!make_folder(writer, writer->manifest)) return false;
    for (size_t i = 0; name[i]; i++)
        if (name[i] == '/' &&
            !make_folder(writer, arena_string(&writer->arena, path, before + i + 2)))
            return false;
    return true;
}

/* The file's place in the list, a new one at its end; NULL when it may not be replaced. */
static SetFile *find_file(SetWriter *writer, const char *path)
{
    for (SetFile *file = writer->first; file; file = file->next)
        if (!strcmp(file->path, path)) return file;
    bool is_new = !exists(path);
    if (!is_new && !check_replaced(writer->inputs, path, writer->err)) return NULL;
    SetFile *file = ARENA_NEW(&writer->arena, SetFile, 1);
    *file = (SetFile){.path = path, .temporary = file_temporary_name(path, &writer->arena),
                      .is_new = is_new};
    if (writer->last) writer->last->next = file;
    else writer->first = file;
    return writer->last = file;
}

bool set_writer_add(SetWriter *writer, const char *name, const Text *text)
{
    const char *path = path_beside(writer->manifest, name, &writer->arena);
    if (!make_folders(writer, path, name)) return false;
    SetFile *file = find_file(writer, path);
    if (!file) return false;
    FILE *stream = fopen(file->temporary, "wb");
    bool  ok = stream && fwrite(text->data, 1, text->size, stream) == text->size;
    if (stream) ok = !fclose(stream) && ok;
    return ok || error_at(writer->err, ERROR_OUTPUT, path, "", "cannot be written: %s",
                          strerror(errno));
}

bool set_writer_add_manifest(SetWriter *writer, const json_t *root, int digits)
{
    Text text = {.arena = &writer->arena};
    if (!json_dump_text(&text, root, JSON_INDENT(2) | JSON_REAL_PRECISION((size_t)digits)))
        return error_set(writer->err, ERROR_MEMORY, "no memory for the manifest");
    text_add(&text, "\n");
    return set_writer_add(writer, path_name(writer->manifest), &text);
}

static void undo(const SetWriter *writer)
{
    for (SetFile *file = writer->first; file; file = file->next) {
        if (!file->has_its_name) file_discard(file->temporary);
        else if (file->is_new) file_remove(file->path);
    }
    for (SetFolder *folder = writer->made; folder; folder = folder->before)
        rmdir(folder->path);
}

bool set_writer_close(SetWriter *writer, bool is_whole)
{
    bool ok = is_whole;
    for (SetFile *file = writer->first; file && ok; file = file->next)
        ok = file->has_its_name = file_commit(file->temporary, file->path, writer->err);
    if (!ok) undo(writer);
    arena_release(&writer->arena);
    return ok;
}
