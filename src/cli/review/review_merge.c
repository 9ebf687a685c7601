/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_merge.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/number.h"
#include "cli/options/cli.h"
#include "render/identity.h"
#include "review/engine/condition_file.h"
#include "text/text.h"

/* ---- words ------------------------------------------------------------------------------- */

/* How many words, this one first, a part has of its own. */
static int own_words(const char *word) {
    static const struct {
        const char *name;
        bool has_value;
    } own[] = {{"-o", true},         {"--only", true},  {"--isa", true},   {"--threads", true},
               {"--progress", true}, {"--json", false}, {"--quiet", false}};
    for (int i = 0; i < COUNT_OF(own); i++)
        if (cli_is_option(word, own[i].name)) return cli_option_words(word, own[i].has_value);
    return 0;
}

const char *const *review_merge_words(int argc, char **argv, Arena *arena, int *count) {
    const char **words = ARENA_NEW(arena, const char *, argc);
    bool has_options = true;
    *count = 0;
    for (int i = 1; i < argc; i++) {
        int skipped = has_options ? own_words(argv[i]) : 0;
        if (!strcmp(argv[i], "--")) has_options = false;
        if (skipped) i += skipped - 1;
        else words[(*count)++] = argv[i];
    }
    return words;
}

/* Who wrote a part is not known: words that write elsewhere, or do something else, are none of
 * a part. */
static bool are_of_a_part(const Lines *words, Arena scratch) {
    static const char *const elsewhere[] = {"--init", "--dry-run"};
    int kept;
    char **argv = ARENA_NEW(&scratch, char *, words->count + 1);
    for (int i = 0; i < words->count; i++) {
        argv[i + 1] = arena_string(&scratch, words->list[i], strlen(words->list[i]));
        bool is_other = cli_is_help(argv[i + 1]) || cli_is_version(argv[i + 1]);
        for (int k = 0; k < COUNT_OF(elsewhere); k++)
            is_other = is_other || cli_is_option(argv[i + 1], elsewhere[k]);
        if (is_other) return false;
    }
    review_merge_words(words->count + 1, argv, &scratch, &kept);
    return kept == words->count;
}

/* ---- what is there ----------------------------------------------------------------------- */

bool review_merge_is_meant(const char *const *folders, int count) {
    struct stat info;
    for (int i = 0; i < count; i++)
        if (stat(folders[i], &info) == 0 && S_ISDIR(info.st_mode)) return true;
    return false;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Sorted: the order of a folder decides nothing. */
static Lines files_with(const char *folder, const char *ending, Arena *arena) {
    Lines files = {.arena = arena};
    DIR *names = opendir(folder);
    for (struct dirent *entry; names && (entry = readdir(names));)
        if (!strcmp(path_ending(entry->d_name), ending))
            lines_put(&files, arena_format(arena, "%s/%s", folder, entry->d_name));
    if (names) closedir(names);
    if (files.count > 1) qsort(files.list, (size_t)files.count, sizeof *files.list, compare_names);
    return files;
}

static bool find_parts(const char *const *folders, int count, Arena *arena, ReviewMerge *out,
                       Error *err) {
    int room = 0;
    Lines *found = ARENA_NEW(arena, Lines, count);
    for (int i = 0; i < count; i++) {
        if (!file_exists(folders[i]))
            return error_at(err, ERROR_INPUT, folders[i], "", "cannot be opened: No such folder");
        found[i] =
            files_with(arena_format(arena, "%s/conditions", folders[i]), ".condition", arena);
        room += found[i].count;
        if (!found[i].count)
            return error_at(err, ERROR_INPUT, folders[i], "",
                            "has no conditions to be merged: `parhelion review --only` makes "
                            "them, and has them when it is done");
    }
    out->parts = ARENA_NEW(arena, MergePart, room);
    out->count = 0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < found[i].count; k++) {
            MergePart *part = &out->parts[out->count++];
            *part = (MergePart){folders[i], found[i].list[k], NULL};
            if (!condition_read_identity(part->path, arena, &part->identity, err)) return false;
        }
    return true;
}

/* ---- do they belong together? ------------------------------------------------------------ */

static const char *isa_of(const MergePart *part, Arena *arena) {
    Lines isa = condition_identity_values(part->identity, "isa", arena);
    return isa.count ? isa.list[0] : "none";
}

/* What all have in common. */
static const char *common_of(const char *identity, bool with_words, Arena *arena) {
    const char *common = condition_identity_without(
        condition_identity_without(identity, "condition", arena), "isa", arena);
    return with_words ? common : condition_identity_without(common, "word", arena);
}

static bool belong_together(const ReviewMerge *merge, Arena scratch, Error *err) {
    const MergePart *first = &merge->parts[0];
    for (int i = 1; i < merge->count; i++) {
        const MergePart *part = &merge->parts[i];
        const char *difference =
            identity_difference(common_of(first->identity, true, &scratch),
                                common_of(part->identity, true, &scratch), &scratch);
        if (difference)
            return error_at(err, ERROR_INPUT, part->path, "",
                            "is of another review than %.200s: %.300s", first->path, difference);
        const char *isa = isa_of(part, &scratch), *of_first = isa_of(first, &scratch);
        if (strcmp(isa, of_first) != 0)
            return error_at(err, ERROR_MACHINE, part->path, "",
                            "was made with %.20s, %.200s with %.20s: their bits differ — make "
                            "all parts with one --isa",
                            isa, first->path, of_first);
    }
    return true;
}

bool review_merge_find(const char *const *folders, int count, Arena *arena, ReviewMerge *out,
                       Error *err) {
    if (!find_parts(folders, count, arena, out, err) || !belong_together(out, *arena, err))
        return false;
    out->words = condition_identity_values(out->parts[0].identity, "word", arena);
    return are_of_a_part(&out->words, *arena) ||
           error_at(err, ERROR_INPUT, out->parts[0].path, "", "has words that no part has");
}

/* ---- held against the request ------------------------------------------------------------ */

/* "3 of 7" */
static int id_of(const MergePart *part, int condition_count, Arena scratch) {
    uint64_t number, of;
    const char *at;
    Lines values = condition_identity_values(part->identity, "condition", &scratch);
    bool is_one = values.count == 1 && (at = number_read_count(values.list[0], &number)) &&
                  !strncmp(at, " of ", 4) && (at = number_read_count(at + 4, &of)) && !*at;
    bool is_there = is_one && of == (uint64_t)condition_count && number >= 1 && number <= of;
    return is_there ? (int)number - 1 : -1;
}

static bool is_of_request(const MergePart *part, const ReviewRun *run, Arena scratch, Error *err) {
    const char *own = condition_identity(run, 0, &scratch, err);
    if (!own) return false;
    const char *difference = identity_difference(common_of(part->identity, false, &scratch),
                                                 common_of(own, false, &scratch), &scratch);
    return !difference || error_at(err, ERROR_INPUT, part->path, "",
                                   "is not of %.200s as it is now, or of another program: %.300s",
                                   run->request->file, difference);
}

/* A task that was run twice has the same answers. */
static bool are_same(const ReviewRun *run, int id, const char *one, const char *other,
                     Arena scratch, Error *err) {
    bool same;
    if (!condition_same_answers(one, other, scratch, &same, err)) return false;
    return same ||
           error_at(err, ERROR_INPUT, other, "",
                    "has other answers than %.200s: of condition '%.100s' one of them counts", one,
                    run->request->conditions[id].name);
}

static bool find_missing(const ReviewRun *run, const char *const *merged, Arena scratch,
                         Error *err) {
    const ReviewRequest *request = run->request;
    Text names = {.arena = &scratch};
    int count = 0;
    for (int i = 0; i < request->condition_count; i++)
        if (!merged[i])
            text_format(&names, "%s'%s'", count++ ? ", " : "", request->conditions[i].name);
    return !count || error_at(err, ERROR_INPUT, request->file, "",
                              "no part has %.600s — make %s with `parhelion review --only`",
                              names.data, count > 1 ? "them" : "it");
}

/* A file of the scene that was another for another part. */
static bool same_files(const Review *one, const Review *other, const char *path, Error *err) {
    for (int i = 0; i < one->input_count; i++)
        for (int k = 0; k < other->input_count; k++)
            if (!strcmp(one->inputs[i].path, other->inputs[k].path) &&
                strcmp(one->inputs[i].xxh3, other->inputs[k].xxh3) != 0)
                return error_at(err, ERROR_INPUT, path, "",
                                "%.300s was another file for it than for the parts before",
                                one->inputs[i].path);
    return true;
}

static bool check_files(const ReviewRun *run, const char *const *merged, Arena scratch,
                        Error *err) {
    ConditionFound first, found;
    if (!condition_read(run, 0, merged[0], &scratch, &first, err)) return false;
    for (int i = 1; i < run->request->condition_count; i++) {
        Arena room = scratch;
        if (!condition_read(run, i, merged[i], &room, &found, err) ||
            !same_files(&first.own.review, &found.own.review, merged[i], err))
            return false;
    }
    return true;
}

bool review_merge_check(const ReviewMerge *merge, ReviewRun *run, Arena *arena, Error *err) {
    int count = run->request->condition_count;
    const char **merged = ARENA_NEW(arena, const char *, count);
    if (!is_of_request(&merge->parts[0], run, *arena, err)) return false;
    for (int i = 0; i < merge->count; i++) {
        const MergePart *part = &merge->parts[i];
        int id = id_of(part, count, *arena);
        if (id < 0)
            return error_at(err, ERROR_INPUT, part->path, "", "is of none of its conditions");
        if (merged[id] && !are_same(run, id, merged[id], part->path, *arena, err)) return false;
        if (!merged[id]) merged[id] = part->path;
    }
    run->merged = merged;
    return find_missing(run, merged, *arena, err) && check_files(run, merged, *arena, err);
}

/* ---- responses --------------------------------------------------------------------------- */

/* From the first part that has it; of a folder that all share there is nothing to copy. */
static bool copy_response(const ReviewMerge *merge, const char *name, const char *folder,
                          Arena scratch, Error *err) {
    FileBytes bytes;
    const char *to = arena_format(&scratch, "%s/%s", folder, name);
    for (int i = 0; i < merge->count && !file_exists(to); i++) {
        Arena room = scratch;
        const char *from = arena_format(&room, "%s/responses/%s", merge->parts[i].folder, name);
        if (file_exists(from) && (!file_read(from, SIZE_MAX, &room, &bytes, err) ||
                                  !file_write(to, bytes.data, bytes.size, err)))
            return false;
    }
    return true;
}

bool review_merge_responses(const ReviewMerge *merge, const Review *review, const char *folder,
                            Arena scratch, Error *err) {
    for (int v = -1; v < review->variant_count; v++) {
        const Review *of = v < 0 ? review : review->variants[v].review;
        for (int i = 0; i < of->response_count; i++)
            if (!copy_response(merge, path_name(of->responses[i].file), folder, scratch, err))
                return false;
    }
    return true;
}
