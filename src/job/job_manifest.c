/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_manifest.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/count.h"
#include "base/file.h"
#include "openexr/exr_file.h"
#include "text/json_text.h"
#include "text/json_view.h"

#define FORMAT "parhelion job"
#define VERSION 1
#define WORDS_MAX 100000

/* ---- writing ----------------------------------------------------------------------------- */

void job_manifest_add_part(json_t *item, const JobPart *part)
{
    const FilmRect crop = part->crop;
    json_object_set_new(item, "samples",
                        json_pack("[I,I]", (json_int_t)part->first_sample,
                                  (json_int_t)part->end_sample));
    json_object_set_new(item, "crop",
                        json_pack("[i,i,i,i]", crop.x0, crop.y0, crop.x1, crop.y1));
}

static json_t *part_json(const SharedJob *job, int index, Arena scratch)
{
    const char *file = job_part_file(job, index, job_part_ending(job), &scratch);
    json_t     *item = json_pack("{s:i, s:s, s:s}", "index", index, "file", path_name(file),
                                 "command", job_part_command(job, index, &scratch));
    if (job->kind == JOB_FRAME) job_manifest_add_part(item, &job->parts[index]);
    return item;
}

const char *job_manifest_text(const SharedJob *job, Arena *arena)
{
    json_t *parts = json_array();
    for (int i = 0; i < job->part_count; i++)
        json_array_append_new(parts, part_json(job, i, *arena));
    json_t *document = json_pack(
        "{s:s, s:i, s:s, s:s, s:s, s:s, s:s, s:s, s:o, s:s, s:o, s:s}", "format", FORMAT,
        "version", VERSION, "kind", job_kind_names[job->kind], "command", job->line, "program",
        job->program, "isa", job->isa, "folder", job->folder, "output", job->output, "words",
        json_texts(job->words, job->word_count), "identity", job->identity, "parts", parts,
        "merge", job_merge_command(job, arena));
    if (job->kind == JOB_FRAME) {
        json_object_set_new(document, "size", json_pack("[i,i]", job->width, job->height));
        json_object_set_new(document, "keeps_sums", json_boolean(job->keeps_sums));
    }
    char       *text = json_dumps(document, JSON_INDENT(1));
    const char *kept = arena_format(arena, "%s", "");
    if (text) {
        char *line = arena_string(arena, text, strlen(text) + 1);
        line[strlen(text)] = '\n';
        kept = line;
    }
    free(text);
    json_decref(document);
    return kept;
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Every key has to be there: the last two of a frame alone. */
static const char *const keys[] = {"format", "version", "kind", "command", "program", "isa",
                                   "folder", "output", "words", "identity", "parts", "merge",
                                   "size", "keeps_sums"};
static const char *const part_keys[] = {"index", "file", "command", "samples", "crop"};

static int key_count(const SharedJob *job, int all)
{
    return job->kind == JOB_FRAME ? all : all - 2;
}

static bool check_all_there(const JsonView *view, const char *const *wanted, int count,
                            Error *err)
{
    for (int i = 0; i < count; i++)
        if (!json_object_get(view->object, wanted[i]))
            return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing",
                            wanted[i]);
    return json_view_check_keys(view, wanted, count, err);
}

static bool check_format(const JsonView *view, Error *err)
{
    const char *format = "";
    double      version = 0;
    if (!json_view_text(view, "format", &format, err)) return false;
    if (strcmp(format, FORMAT) != 0)
        return error_at(err, ERROR_INPUT, view->file, "/format",
                        "is '%.80s', required: '" FORMAT "' — it is no job that was shared by "
                        "`parhelion render --slurm N` or `parhelion review --slurm N`",
                        format);
    if (!json_view_number(view, "version", 0, 1e6, &version, err)) return false;
    return version == VERSION ||
           error_at(err, ERROR_INPUT, view->file, "/version",
                    "is %g, this program reads version %d", version, VERSION);
}

static bool read_list(const JsonView *view, const char *key, int least, int most,
                      json_t **out, Error *err)
{
    json_t *list = json_object_get(view->object, key);
    if (!json_is_array(list)) return json_view_wrong_kind(view, key, list, "a list", err);
    int count = (int)json_array_size(list);
    if (count < least || count > most)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "has %d items, required: %d to %d", count, least, most);
    *out = list;
    return true;
}

static bool read_words(const JsonView *view, SharedJob *job, Error *err)
{
    json_t *list, *value;
    size_t  i;
    if (!read_list(view, "words", 1, WORDS_MAX, &list, err)) return false;
    job->word_count = (int)json_array_size(list);
    job->words = ARENA_NEW(view->arena, const char *, job->word_count);
    json_array_foreach(list, i, value) {
        if (!json_is_string(value))
            return json_view_wrong_kind(view, "words", value, "only texts", err);
        job->words[i] = arena_string(view->arena, json_string_value(value),
                                     json_string_length(value));
    }
    return true;
}

/* `count` whole numbers of [0, high]. */
static bool read_wholes(const JsonView *view, const char *key, int count, double high,
                        double *out, Error *err)
{
    int found = 0;
    if (!json_view_numbers(view, key, (JsonRange){0, high, count}, out, &found, err))
        return false;
    for (int i = 0; i < found; i++)
        if (out[i] != (double)(long)out[i])
            return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                            "is %g, required: whole numbers", out[i]);
    return found == count || error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                                      "has %d values, required: %d", found, count);
}

static bool check_index(const JsonView *view, int index, Error *err)
{
    double number = 0;
    return json_view_number(view, "index", 0, JOB_PARTS_MAX, &number, err) &&
           (number == index ||
            error_at(err, ERROR_INPUT, view->file, json_view_path(view, "index"),
                     "is %g, required: %d", number, index));
}

/* Reads a part of a frame. */
static bool read_part(const JsonView *view, const SharedJob *job, JobPart *out, Error *err)
{
    double samples[2], crop[4];
    if (!read_wholes(view, "samples", 2, FILM_SAMPLES_MAX, samples, err) ||
        !read_wholes(view, "crop", 4, EXR_MAX_SIDE, crop, err))
        return false;
    if (samples[0] >= samples[1])
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "samples"),
                        "is %g to %g, required: a range", samples[0], samples[1]);
    if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > job->width ||
        crop[3] > job->height)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "crop"),
                        "required: X0,Y0,X1,Y1 inside the frame of %dx%d pixels", job->width,
                        job->height);
    *out = (JobPart){{(int)crop[0], (int)crop[1], (int)crop[2], (int)crop[3]},
                     (uint32_t)samples[0], (uint32_t)samples[1]};
    return true;
}

static bool read_parts(const JsonView *view, SharedJob *job, Error *err)
{
    json_t *list;
    if (!read_list(view, "parts", 1, JOB_PARTS_MAX, &list, err)) return false;
    job->part_count = (int)json_array_size(list);
    job->parts = ARENA_NEW(view->arena, JobPart, job->part_count);
    for (int i = 0; i < job->part_count; i++) {
        json_t    *value = json_array_get(list, (size_t)i);
        const char *path = arena_format(view->arena, "/parts/%d", i);
        JsonView    item = {.object = value, .file = view->file, .path = path,
                            .arena = view->arena};
        if (!json_is_object(value))
            return json_view_wrong_kind(view, "parts", value, "a list of objects", err);
        if (!check_all_there(&item, part_keys, key_count(job, COUNT_OF(part_keys)), err) ||
            !check_index(&item, i, err) ||
            (job->kind == JOB_FRAME && !read_part(&item, job, &job->parts[i], err)))
            return false;
    }
    return true;
}

static bool read_folder(const JsonView *view, const char *key, const char **out, Error *err)
{
    return json_view_text(view, key, out, err) &&
           ((*out)[0] == '/' ||
            error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                     "is '%.200s', required: a path from the root", *out));
}

static bool read_kind(const JsonView *view, JobKind *out, Error *err)
{
    const char *kind = "";
    if (!json_object_get(view->object, "kind"))
        return error_at(err, ERROR_INPUT, view->file, view->path, "key 'kind' is missing");
    if (!json_view_text(view, "kind", &kind, err)) return false;
    for (*out = JOB_FRAME; *out < JOB_KINDS; (*out)++)
        if (!strcmp(kind, job_kind_names[*out])) return true;
    return error_at(err, ERROR_INPUT, view->file, "/kind",
                    "is '%.80s', required: 'frame' or 'review'", kind);
}

/* Reads what only a frame's job has. */
static bool read_frame(const JsonView *view, SharedJob *job, Error *err)
{
    double  size[2];
    json_t *keeps_sums = json_object_get(view->object, "keeps_sums");
    if (!read_wholes(view, "size", 2, EXR_MAX_SIDE, size, err)) return false;
    if (!json_is_boolean(keeps_sums))
        return json_view_wrong_kind(view, "keeps_sums", keeps_sums, "true or false", err);
    job->keeps_sums = json_is_true(keeps_sums);
    job->width = (int)size[0];
    job->height = (int)size[1];
    return true;
}

static bool read_all(const JsonView *view, SharedJob *job, Error *err)
{
    if (!check_format(view, err) || !read_kind(view, &job->kind, err) ||
        !check_all_there(view, keys, key_count(job, COUNT_OF(keys)), err) ||
        !json_view_text(view, "command", &job->line, err) ||
        !read_folder(view, "program", &job->program, err) ||
        !json_view_text(view, "isa", &job->isa, err) ||
        !read_folder(view, "folder", &job->folder, err) ||
        !json_view_text(view, "output", &job->output, err) ||
        !json_view_text(view, "identity", &job->identity, err) ||
        (job->kind == JOB_FRAME && !read_frame(view, job, err)))
        return false;
    return read_words(view, job, err) && read_parts(view, job, err);
}

bool job_manifest_is_there(const char *dir, Arena scratch)
{
    struct stat info;
    return stat(dir, &info) == 0 && S_ISDIR(info.st_mode) &&
           file_exists(arena_format(&scratch, "%s/" JOB_MANIFEST, dir));
}

bool job_manifest_read(const char *dir, Arena *arena, SharedJob *out, Error *err)
{
    JsonView  view;
    SharedJob job = {0};
    if (!job_manifest_is_there(dir, *arena))
        return error_at(err, ERROR_INPUT, dir, "",
                        "is no folder of a job: it has no " JOB_MANIFEST
                        " — `parhelion render ... --slurm N` makes one, and `parhelion review "
                        "... --slurm N`");
    char *whole = realpath(dir, NULL);
    if (!whole)
        return error_at(err, ERROR_INPUT, dir, "", "cannot be opened: %s", strerror(errno));
    job.dir = arena_string(arena, whole, strlen(whole));
    free(whole);
    if (!json_view_open(arena_format(arena, "%s/" JOB_MANIFEST, dir), arena, &view, err))
        return false;
    bool reads = read_all(&view, &job, err);
    json_view_close(&view);
    if (reads) *out = job;
    return reads;
}
