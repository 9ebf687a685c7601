/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion merge: parts of a frame become the frame, with the bits of one run. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/render/command_line.h"
#include "cli/render/dealt_part.h"
#include "cli/render/render_answer.h"
#include "cli/review/cmd_review.h"
#include "cli/review/review_merge.h"
#include "film/film_frame.h"
#include "film/film_merge.h"
#include "image/frame_view.h"
#include "print/print.h"
#include "render/identity.h"
#include "render/noise_stop.h"
#include "text/json_text.h"
#include "text/text.h"

typedef struct MergeRun {
    Cli cli;
    const char *output;
    bool keeps_sums; /* --part */
    bool is_of_reviews;
    Arena *arena;
    const char **files; /* the parts' */
    int count;
    FilmPart *parts;      /* one a file */
    DealtPart *dealt;     /* the same: what --part said of it */
    FilmPart whole;       /* what they make */
    const char **lines;   /* their command lines */
    const char *identity; /* of the first; the others have the same */
    FrameImage common;    /* attributes that all parts have; no channels */
    Film *film;
    FilmError error;
    double rare_error; /* film.h's; or NaN */
    double seconds;
} MergeRun;

static const Column MERGED[] = {
    COLUMN_TEXT("output", "frame"),
    COLUMN_TEXT("parts", "parts"),
    COLUMN_TEXT("size", "pixels"),
    {.key = "window", .words = "of these", .about = "x0, y0, x1, y1, half-open"},
    {.key = "sample_range", .words = "samples", .parts = "from|to", .about = "half-open"},
    COLUMN_KEY("samples", "a pixel"),
    ERROR_COLUMN("relative_error", "relative error", "unknown"),
    RARE_COLUMN,
    {.key = "is_part", .words = "with its sums", .hides_zero = true},
    COLUMN_KEY("seconds", NULL),
    COLUMN_KEY("nonfinite_samples", "left out"),
    COLUMN_KEY("complete", NULL),
    COLUMN_KEY("rays", NULL),
};
static const TableKind MERGED_KIND = TABLE_KIND("merge", NULL, MERGED);

static bool parse(int argc, char **argv, MergeRun *work, Error *err) {
    const Option options[] = {
        {"-o", OPTION_TEXT, "FRAME.exr", "what is written; of reviews: DIR", &work->output,
         .file = OPTION_OUTPUT},
        {"--part", OPTION_FLAG, NULL, "keep the exact sums, so that the frame can be merged again",
         &work->keeps_sums},
    };
    const CliCommand command = {"merge",
                                command_merge.summary,
                                "PART.exr ... -o FRAME.exr | REVIEW_DIR ... -o DIR",
                                "parhelion merge part1.exr part2.exr -o frame.exr",
                                options,
                                COUNT_OF(options),
                                1,
                                -1,
                                .answers = (const Answer[]){{"", &MERGED_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, work->arena, &work->cli, err)) return false;
    if (work->cli.help_shown) return true;
    work->files = work->cli.arguments;
    work->count = work->cli.argument_count;
    work->is_of_reviews = review_merge_is_meant(work->files, work->count);
    if (!work->output)
        return error_set(err, ERROR_USAGE, "no output — add -o %s",
                         work->is_of_reviews ? "DIR" : "FRAME.exr");
    if (work->is_of_reviews)
        return !work->keeps_sums || error_set(err, ERROR_USAGE, "--part: a review has no sums");
    if (strcmp(path_ending(work->output), ".exr") != 0)
        return error_set(err, ERROR_USAGE, "-o %s: required: a name that ends in .exr",
                         work->output);
    return outputs_spare(&work->cli.outputs, work->files, work->count, err) &&
           file_check_writable(work->output, err);
}

/* ---- the parts' attributes --------------------------------------------------------------- */

static bool same_attribute(const ExrAttribute *a, const ExrAttribute *b) {
    if (!b || a->kind != b->kind) return false;
    return a->kind == EXR_STRING ? !strcmp(a->text, b->text)
                                 : !memcmp(a->values, b->values, sizeof a->values);
}

static void set_attribute(FrameImage *frame, const ExrAttribute *a, Arena *arena) {
    if (a->kind == EXR_STRING) frame_set_string(frame, a->name, a->text, arena);
    else frame_set_values(frame, a->name, a->kind, a->values, arena);
}

/* Time is not the parts', but that of the merge; nor is their error. */
static bool is_of_the_run(const char *name) {
    return !strcmp(name, "capDate") || !strcmp(name, "utcOffset") ||
           !strcmp(name, "parhelion:commandLine") || !strcmp(name, "parhelion:parts") ||
           !strcmp(name, "parhelion:rareError") || !strcmp(name, DEALT_PART_ATTRIBUTE);
}

/* The attribute of that name; files keep them sorted, so that it mostly stands at *place,
 * behind the one that was found before. */
static const ExrAttribute *find_near(const ExrPicture *picture, const char *name, int *place) {
    for (int i = 0; i < picture->attribute_count; i++) {
        int at = (*place + i) % picture->attribute_count;
        if (strcmp(picture->attributes[at].name, name) != 0) continue;
        *place = at + 1;
        return &picture->attributes[at];
    }
    return NULL;
}

/* Keeps those common attributes that this part shares. */
static void keep_common(FrameImage *common, const ExrPicture *picture) {
    int kept = 0, place = 0;
    for (int i = 0; i < common->attribute_count; i++)
        if (same_attribute(&common->attributes[i],
                           find_near(picture, common->attributes[i].name, &place)))
            common->attributes[kept++] = common->attributes[i];
    common->attribute_count = kept;
}

static void copy_attributes(FrameImage *common, const ExrPicture *picture, Arena *arena) {
    *common = (FrameImage){.attribute_room = picture->attribute_count,
                           .attributes = ARENA_NEW(arena, ExrAttribute, picture->attribute_count)};
    for (int i = 0; i < picture->attribute_count; i++)
        if (!is_of_the_run(picture->attributes[i].name))
            set_attribute(common, &picture->attributes[i], arena);
}

static bool same_lights(const FilmLights *a, const FilmLights *b) {
    if (a->count != b->count) return false;
    for (int i = 0; i < a->count; i++)
        if (strcmp(a->names[i], b->names[i]) != 0) return false;
    return true;
}

static bool check_identity(MergeRun *work, const FilmPart *part, const FilmPart *first,
                           const char *identity, Error *err) {
    if (!identity)
        return error_set(err, ERROR_INPUT,
                         "does not say what it was rendered from "
                         "(parhelion:identity is missing)");
    if (!work->identity) work->identity = arena_string(work->arena, identity, strlen(identity));
    const char *difference = identity_difference(work->identity, identity, work->arena);
    if (difference && !identity_same_program(work->identity, identity))
        return error_set(err, ERROR_MACHINE,
                         "was made by another program or instruction set than %s: %s — make "
                         "all parts by one version and one --isa",
                         first->name, difference);
    if (difference)
        return error_set(err, ERROR_INPUT,
                         "is of another frame than %s: %s — merge parts of one scene, camera, "
                         "size, seed and program only",
                         first->name, difference);
    if (part->width != first->width || part->height != first->height ||
        part->layers != first->layers)
        return error_set(err, ERROR_INPUT,
                         "damaged sums: of %dx%d pixels and layers %x, those of %s of %dx%d "
                         "and %x",
                         part->width, part->height, part->layers, first->name, first->width,
                         first->height, first->layers);
    return same_lights(&part->lights, &first->lights) ||
           error_set(err, ERROR_INPUT, "damaged sums: of other groups of lights than %s",
                     first->name);
}

static bool look_at(MergeRun *work, int i, Error *err) {
    FilmPartReader from;
    if (!film_part_open(work->files[i], work->arena, &from, err)) return false;
    const ExrPicture *picture = exr_reader_picture(from.file);
    const char *line = frame_string(picture, "parhelion:commandLine");
    work->parts[i] = from.part;
    work->lines[i] = arena_string(work->arena, line ? line : "", line ? strlen(line) : 0);
    bool belongs = check_identity(work, &from.part, &work->parts[0],
                                  frame_string(picture, "parhelion:identity"), err);
    const char *dealt = frame_string(picture, DEALT_PART_ATTRIBUTE);
    if (belongs && dealt && !dealt_part_parse(dealt, &work->dealt[i]))
        belongs = error_set(err, ERROR_INPUT, "damaged: " DEALT_PART_ATTRIBUTE " cannot be read");
    if (belongs && i == 0) copy_attributes(&work->common, picture, work->arena);
    if (belongs && i > 0) keep_common(&work->common, picture);
    film_part_close(&from);
    return belongs;
}

static bool look_at_all(MergeRun *work, Error *err) {
    int count = work->count;
    work->parts = ARENA_NEW(work->arena, FilmPart, count);
    work->dealt = ARENA_NEW(work->arena, DealtPart, count);
    work->lines = ARENA_NEW(work->arena, const char *, count);
    for (int i = 0; i < count; i++)
        if (!look_at(work, i, err)) return error_in_file(err, work->files[i]);
    return dealt_parts_check(work->dealt, work->parts, count, *work->arena, err) &&
           film_merge_check(work->parts, count, *work->arena, &work->whole, err);
}

/* ---- adding up --------------------------------------------------------------------------- */

static bool check_memory(const MergeRun *work, Error *err) {
    const FilmPart *whole = &work->whole;
    double wanted = (double)film_bytes(whole->crop, whole->layers, whole->lights.count);
    double memory = (double)arena_left(work->arena);
    if (wanted < memory) return true;
    return error_set(err, ERROR_MEMORY,
                     "the film of %dx%d pixels needs %.1f GB, there are %.1f GB — merge fewer "
                     "parts at a time",
                     whole->crop.x1 - whole->crop.x0, whole->crop.y1 - whole->crop.y0, wanted / 1e9,
                     memory / 1e9);
}

static bool same_part(const FilmPart *a, const FilmPart *b) {
    return a->layers == b->layers && same_lights(&a->lights, &b->lights) &&
           a->first_sample == b->first_sample && a->end_sample == b->end_sample &&
           !memcmp(&a->crop, &b->crop, sizeof a->crop);
}

static double pixels_in(FilmRect rect) {
    return (double)(rect.x1 - rect.x0) * (double)(rect.y1 - rect.y0);
}

/* *done: pixels of the parts before. */
static bool add_part(MergeRun *work, int i, Progress *progress, double *done, Error *err) {
    FilmPartReader from;
    if (!film_part_open(work->files[i], work->arena, &from, err)) return false;
    const FilmRect *crop = &from.part.crop;
    bool ok = same_part(&from.part, &work->parts[i]) ||
              error_set(err, ERROR_INPUT, "has changed while it was merged");
    while (ok && from.next_y < crop->y1) {
        ok = film_part_add_band(&from, work->film, *work->arena, err);
        FilmRect read = {crop->x0, crop->y0, crop->x1, from.next_y};
        progress_update(progress, *done + pixels_in(read));
    }
    *done += pixels_in(*crop);
    film_part_close(&from);
    return ok;
}

static bool add_all(MergeRun *work, Error *err) {
    const FilmPart *whole = &work->whole;
    double total = 0, done = 0;
    work->film = film_create(whole->width, whole->height, whole->crop, whole->layers,
                             &whole->lights, work->arena);
    if (!film_has_room(work->film, work->arena, err)) return false;
    if (frame_fisheye(&work->common)) film_set_blind(work->film);
    for (int i = 0; i < work->count; i++) total += pixels_in(work->parts[i].crop);
    Progress progress = progress_start(work->cli.progress, "merge", "pixels", total);
    for (int i = 0; i < work->count; i++)
        if (!add_part(work, i, &progress, &done, err)) {
            progress_clear(&progress);
            return error_in_file(err, work->files[i]);
        }
    progress_end(&progress, done);
    work->seconds = monotonic_seconds() - progress.begun_s;
    work->error = film_relative_error(work->film);
    work->rare_error = (double)NAN;
    if (work->whole.end_sample - work->whole.first_sample >= NOISE_LEAST_SAMPLES)
        work->rare_error = film_rare_error(work->film, work->error.frame);
    return true;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* The command of one run, when the parts' agree on it. */
static const char *line_of_whole(const MergeRun *work, Arena *arena) {
    const char *first = NULL;
    for (int i = 0; i < work->count; i++) {
        const char *line = work->lines[i];
        if (strncmp(line, "parhelion render ", 17) != 0) return NULL;
        line = command_line_of_whole(line, &work->whole, arena);
        if (!line || (first && strcmp(first, line) != 0)) return NULL;
        if (!first) first = line;
    }
    return first;
}

static int compare_lines(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Sorted: the order of the parts, and their names, decide nothing. */
static const char *list_lines(const MergeRun *work, Arena *arena) {
    int count = work->count;
    Text list = {.arena = arena};
    qsort(work->lines, (size_t)count, sizeof *work->lines, compare_lines);
    for (int i = 0; i < count; i++) {
        text_add(&list, work->lines[i]);
        text_add(&list, "\n");
    }
    return list.data;
}

static void set_lines(const MergeRun *work, FrameImage *frame, Arena *arena) {
    const char *line = line_of_whole(work, arena);
    frame_set_string(frame, "parhelion:commandLine", line ? line : "parhelion merge", arena);
    if (!line) frame_set_string(frame, "parhelion:parts", list_lines(work, arena), arena);
}

/* Can no further part be added, as far as one can know? */
static bool is_whole(const MergeRun *work) {
    const FilmPart *whole = &work->whole;
    return whole->first_sample == 0 && whole->crop.x0 == 0 && whole->crop.y0 == 0 &&
           whole->crop.x1 == whole->width && whole->crop.y1 == whole->height;
}

static bool write_frame(MergeRun *work, Error *err) {
    Arena *arena = work->arena;
    const FilmPart *whole = &work->whole;
    const FrameOutcome outcome = {.first_sample = whole->first_sample,
                                  .end_sample = whole->end_sample,
                                  .complete = true,
                                  .relative_error = work->error.frame,
                                  .rare_error = work->rare_error,
                                  .dropped_samples = film_dropped(work->film).count};
    FrameImage frame = film_to_rows(work->film, work->common.attribute_count + 8, arena);
    for (int i = 0; i < work->common.attribute_count; i++)
        set_attribute(&frame, &work->common.attributes[i], arena);
    frame_set_outcome(&frame, &outcome, arena);
    set_lines(work, &frame, arena);
    work->keeps_sums = work->keeps_sums || !is_whole(work);
    work->whole.dropped = film_dropped(work->film);
    if (work->keeps_sums) film_part_attach(&frame, work->film, whole, arena);
    return frame_write(work->output, &frame, err);
}

/* ---- the answer -------------------------------------------------------------------------- */

static bool print_answer(const MergeRun *work, Error *err) {
    const FilmPart *whole = &work->whole;
    json_t *answer = json_pack(
        "{s:o, s:i, s:[i,i], s:[i,i,i,i], s:[I,I], s:I, s:f, s:I, s:o, s:b, s:b}", "output",
        json_text(work->output), "parts", work->count, "size", whole->width, whole->height,
        "window", whole->crop.x0, whole->crop.y0, whole->crop.x1, whole->crop.y1, "sample_range",
        (json_int_t)whole->first_sample, (json_int_t)whole->end_sample, "samples",
        (json_int_t)(whole->end_sample - whole->first_sample), "seconds", work->seconds,
        "nonfinite_samples", (json_int_t)whole->dropped.count, "relative_error",
        json_figure(work->error.frame), "complete", true, "is_part", work->keeps_sums);
    json_object_set_new(answer, "rare_error", json_figure(work->rare_error));
    json_object_set_new(
        answer, "rays",
        json_integer((json_int_t)(whole->camera_rays + whole->bounce_rays + whole->shadow_rays)));
    return cli_print_answer(&MERGED_KIND, answer, work->cli.json, err);
}

static bool check_dropped(const MergeRun *work, Error *err) {
    const char *line = line_of_whole(work, work->arena);
    const char *text = frame_dropped_warning(work->film, line, work->arena);
    if (!frame_check_dropped(work->film, line, *work->arena, err)) return false;
    if (text) print_to(stderr, "parhelion: warning: %s: %s\n", work->output, text);
    return true;
}

static bool merge(MergeRun *work, Error *err) {
    return look_at_all(work, err) && check_memory(work, err) && add_all(work, err) &&
           check_dropped(work, err) && write_frame(work, err) && print_answer(work, err);
}

static Outcome run_merge(int argc, char **argv, Arena *arena, Error *err) {
    MergeRun work = {.arena = arena};
    if (!parse(argc, argv, &work, err)) return OUTCOME_FAILED;
    if (work.cli.help_shown) return OUTCOME_DONE;
    return work.is_of_reviews ? cmd_review_merge(&work.cli, work.output, arena, err)
                              : outcome_of(merge(&work, err));
}

const Command command_merge = {
    "merge", "make one frame, or review, of its parts, with the bits of one run", run_merge};
