/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_manifest.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "openexr/exr_file.h"
#include "record/rows.h"
#include "text/json_text.h"

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

static bool read_format(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    Error why;
    (void)item;
    const RecordRow is = {row->key, RECORD_CONST, .words = row->words};
    return record_read_value(view, &is, NULL, &why) ||
           record_fails(view, row->key, err, "%s — it is no job that was shared by `parhelion "
                        "render --slurm N` or `parhelion review --slurm N`", why.text);
}

/* A part's is its place in the list. */
static bool read_index(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    int       place = atoi(path_name(view->path));
    RecordRow is = {row->key, RECORD_CONST, .low = place};
    return record_read_value(view, &is, item, err);
}

#define OWNER JobPart
static const RecordRow PART_ROWS[] = {
    {"index", RECORD_OWN, MUST, .read = read_index,
     .schema = "{'type': 'integer', 'minimum': 0}", .doc = "Its place in the list."},
    NOTE("file", MUST, "What it becomes."),
    NOTE("command", MUST, "That makes it."),
    WHOLES("samples", 0, first_sample, 2, 0, FILM_SAMPLES_MAX, "Half-open; of a frame."),
    WHOLES("crop", 0, crop, 4, 0, EXR_MAX_SIDE, "X0, Y0, X1, Y1, half-open; of a frame."),
    {0}};
#undef OWNER
_Static_assert(sizeof(FilmRect) == 4 * sizeof(int), "a crop is four whole numbers");
_Static_assert(offsetof(JobPart, end_sample) == offsetof(JobPart, first_sample) + sizeof(int),
               "a pair");

/* Some keys have to be there in a frame's job, and in no other. */
static bool check_frame_key(const JsonView *view, const char *key, Error *err)
{
    bool is_frame = ((const SharedJob *)view->whole)->kind == JOB_FRAME;
    bool is_there = json_object_get(view->object, key) != NULL;
    if (is_there == is_frame) return true;
    return is_there ? record_fails(view, key, err, "unknown key: it is of a frame, required: "
                                   "none of a review")
                    : error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing",
                               key);
}

static bool check_part(const JsonView *view, void *item, Error *err)
{
    const SharedJob *job = view->whole;
    const JobPart   *part = item;
    const FilmRect   crop = part->crop;
    if (!check_frame_key(view, "samples", err) || !check_frame_key(view, "crop", err))
        return false;
    if (job->kind != JOB_FRAME) return true;
    if (part->first_sample >= part->end_sample)
        return record_fails(view, "samples", err, "is %u to %u, required: a range",
                            part->first_sample, part->end_sample);
    return (crop.x0 < crop.x1 && crop.y0 < crop.y1 && crop.x1 <= job->width &&
            crop.y1 <= job->height) ||
           record_fails(view, "crop", err, "required: X0,Y0,X1,Y1 inside the frame of %dx%d "
                        "pixels", job->width, job->height);
}

static const RecordFormat part_format = {"part", sizeof(JobPart), PART_ROWS,
                                         .check = check_part};

/* What a part is checked against is there before. */
static bool read_parts(const JsonView *view, const RecordRow *row, void *item, Error *err)
{
    return check_frame_key(view, "size", err) && check_frame_key(view, "keeps_sums", err) &&
           record_read_kind(view, row, item, err);
}

static const char *const FORMATS[] = {FORMAT, NULL};

#define OWNER SharedJob
static const RecordRow JOB[] = {
    {"format", RECORD_OWN, MUST, .read = read_format, .words = FORMATS},
    {"version", RECORD_CONST, MUST, .low = VERSION},
    CHOICE("kind", MUST, kind, job_kind_names, NULL),
    TEXT("command", MUST, line, "Of the one run that the job stands for."),
    TEXT("program", MUST, program, "That planned it, its path from the root."),
    TEXT("isa", MUST, isa, "The instruction set that all parts take."),
    TEXT("folder", MUST, folder, "From where the names are seen."),
    TEXT("output", MUST, output, "The frame, or the review's folder."),
    TEXT("identity", MUST, identity, "What decides a sample, or the answers."),
    WHOLES("size", 0, width, 2, 0, EXR_MAX_SIDE, "Pixels of the frame."),
    FLAG("keeps_sums", 0, keeps_sums, "The frame is itself a part."),
    {"words", RECORD_TEXTS, MUST, RECORD_AT(OWNER, words), .least = 1, .most = WORDS_MAX,
     .count = offsetof(OWNER, word_count), .doc = "Arguments that all parts have."},
    {"parts", RECORD_LIST, MUST, RECORD_MANY(OWNER, parts, part_count),
     RECORD_COUNT(1, JOB_PARTS_MAX), .of = &part_format, .read = read_parts},
    NOTE("merge", MUST, "The command that makes the frame or the review."),
    {0}};
#undef OWNER
_Static_assert(offsetof(SharedJob, height) == offsetof(SharedJob, width) + sizeof(int),
               "a pair");

static bool check_path(const JsonView *view, const char *key, const char *path, Error *err)
{
    return path[0] == '/' || record_fails(view, key, err, "is '%.200s', required: a path from "
                                          "the root", path);
}

static bool check(const JsonView *view, void *item, Error *err)
{
    const SharedJob *job = item;
    return check_path(view, "program", job->program, err) &&
           check_path(view, "folder", job->folder, err);
}

const RecordFormat job_format = {
    "job", sizeof(SharedJob), JOB, .check = check,
    .rules = "{'allOf': [{'properties': {'program': {'pattern': '^/'}, "
             "'folder': {'pattern': '^/'}}}], "
             "'if': {'properties': {'kind': {'const': 'frame'}}}, "
             "'then': {'required': ['size', 'keeps_sums'], 'properties': {'parts': "
             "{'items': {'required': ['samples', 'crop']}}}}, "
             "'else': {'properties': {'size': false, 'keeps_sums': false, 'parts': "
             "{'items': {'properties': {'samples': false, 'crop': false}}}}}}",
    .doc = "assets/schemas/job.md explains the keys."};

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
    bool reads = record_read(&view, &job_format, &job, err);
    json_view_close(&view);
    if (reads) *out = job;
    return reads;
}
