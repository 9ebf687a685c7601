/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_draft.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/lines.h"
#include "review/output/review_card.h"
#include "review/output/review_json_read.h"

/* ---- folders ----------------------------------------------------------------------------- */

static const char *const parts[] = {"", "/sweeps", "/frames"};

static bool make_parts(const char *folder, Arena scratch, Error *err)
{
    for (int i = 0; i < COUNT_OF(parts); i++)
        if (!folder_make(arena_format(&scratch, "%s%s", folder, parts[i]), err)) return false;
    return true;
}

/* As far as they are empty. */
static void remove_parts(const char *folder, Arena scratch)
{
    for (int i = COUNT_OF(parts) - 1; i >= 0; i--)
        rmdir(arena_format(&scratch, "%s%s", folder, parts[i]));
}

void review_draft_close(ReviewDraft *draft)
{
    journal_close(draft->journal);
    remove_parts(draft->folder, *draft->arena);
    rmdir(draft->unfinished);
    remove_parts(draft->target, *draft->arena);
}

/* Known before the work: a file that cannot take its place would end the review half moved. */
static bool check_files(const char *target, Arena scratch, Error *err)
{
    static const char *const files[] = {"review.json", "index.html",     "cases.csv",
                                        "gazes.csv",   "false_suns.csv", "junit.xml",
                                        "diff.json",   "run.json",       "live.js",
                                        REVIEW_PAGE_BESIDE};
    for (int i = 0; i < COUNT_OF(files); i++)
        if (!file_check_writable(arena_format(&scratch, "%s/%s", target, files[i]), err))
            return false;
    return true;
}

/* The journal comes first: it knows of another review that is at work here. */
bool review_draft_open(const char *target, Arena *arena, Problems *problems, ReviewDraft *out,
                       Error *err)
{
    ReviewDraft draft = {.arena = arena, .target = target,
                         .unfinished = arena_format(arena, "%s/unfinished", target)};
    const char *journal = arena_format(arena, "%s/journal", draft.unfinished);
    draft.folder = arena_format(arena, "%s/new", draft.unfinished);
    if (!folder_make(target, err) || !folder_make(draft.unfinished, err) ||
        !journal_open(journal, arena, problems, &draft.journal, err)) {
        rmdir(draft.unfinished);
        rmdir(target);
        return false;
    }
    if (make_parts(target, *arena, err) && make_parts(draft.folder, *arena, err) &&
        check_files(target, *arena, err)) {
        *out = draft;
        return true;
    }
    review_draft_close(&draft);
    return false;
}

/* ---- files of a draft -------------------------------------------------------------------- */

/* Names within the folder, "index.html", "sweeps/a.csv". prefix: "" or "sweeps/". */
static void list_files(Lines *files, const char *folder, const char *prefix)
{
    DIR *open = opendir(arena_format(files->arena, "%s/%s", folder, prefix));
    if (!open) return;
    for (struct dirent *entry; (entry = readdir(open));) {
        struct stat info;
        const char *name = arena_format(files->arena, "%s%s", prefix, entry->d_name);
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..") ||
            lstat(arena_format(files->arena, "%s/%s", folder, name), &info) != 0)
            continue;
        if (!S_ISDIR(info.st_mode)) lines_put(files, name);
        else if (!*prefix)
            list_files(files, folder, arena_format(files->arena, "%s/", name));
    }
    closedir(open);
}

static bool has_ending(const char *name, const char *ending)
{
    return !strcmp(path_ending(name), ending);
}

/* Did a writer that was killed leave it behind? */
static bool is_leftover(const char *name)
{
    return has_ending(name, ".part") || has_ending(name, ".parhelion-part");
}

static bool starts_with(const char *text, const char *start)
{
    return !strncmp(text, start, strlen(start));
}

/* ---- what a review names ----------------------------------------------------------------- */

/* A frame is named by its picture: NAME.png stands for NAME.exr and NAME-outlook.png, too. */
static bool is_of_frame(const char *name, const char *frame)
{
    size_t length = frame ? (size_t)(path_ending(frame) - frame) : 0;
    return frame && !strncmp(name, frame, length) &&
           (name[length] == '.' || name[length] == '-');
}

static bool is_named(const Review *review, const char *name)
{
    for (int i = 0; i < review->case_count; i++)
        if (is_of_frame(name, review->cases[i].frame)) return true;
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *sweep = &review->sweeps[i];
        if (is_of_frame(name, sweep->worst.frame) ||
            (sweep->table && !strcmp(name, sweep->table)))
            return true;
    }
    return false;
}

/* ---- taking their places ----------------------------------------------------------------- */

static bool move(const ReviewDraft *draft, const char *name, Arena scratch, Error *err)
{
    const char *from = arena_format(&scratch, "%s/%s", draft->folder, name);
    const char *to = arena_format(&scratch, "%s/%s", draft->target, name);
    const char *slash = strrchr(name, '/');
    if (slash && !folder_make(arena_format(&scratch, "%s/%.*s", draft->target,
                                           (int)(slash - name), name), err))
        return false;
    return rename(from, to) == 0 ||
           error_at(err, ERROR_OUTPUT, to, "", "cannot be written: %s", strerror(errno));
}

static bool is_among(const Lines *files, const char *name)
{
    for (int i = 0; i < files->count; i++)
        if (!strcmp(files->list[i], name)) return true;
    return false;
}

/* Removes an earlier review's tables and frames, as it names them, and what not every review
 * has, unless published. A damaged one names nothing. */
static void remove_earlier(const ReviewDraft *draft, const Review *review,
                           const Lines *published)
{
    static const char *const seldom[] = {"diff.json", "false_suns.csv", "gazes.csv",
                                         "cases.csv", "junit.xml",      "run.json",
                                         "live.js",   REVIEW_PAGE_BESIDE};
    Arena       scratch = *published->arena;
    Lines  files = {.arena = &scratch};
    Review      earlier;
    Error       err;
    const char *old = arena_format(&scratch, "%s/review.json", draft->target);
    if (!file_exists(old) || !review_json_read(old, &scratch, &earlier, &err)) return;
    for (int i = 0; i < COUNT_OF(seldom); i++)
        if (!is_among(published, seldom[i]))
            unlink(arena_format(&scratch, "%s/%s", draft->target, seldom[i]));
    list_files(&files, draft->target, "");
    for (int i = 0; i < files.count; i++)
        if (starts_with(files.list[i], "summary-") && !is_among(published, files.list[i]))
            unlink(arena_format(&scratch, "%s/%s", draft->target, files.list[i]));
    files.count = 0;
    list_files(&files, draft->target, "sweeps/");
    list_files(&files, draft->target, "frames/");
    for (int i = 0; i < files.count; i++)
        if (is_named(&earlier, files.list[i]) &&
            (!is_named(review, files.list[i]) ||
             (has_ending(files.list[i], ".js") && !is_among(published, files.list[i]))))
            unlink(arena_format(&scratch, "%s/%s", draft->target, files.list[i]));
}

bool review_draft_publish(const ReviewDraft *draft, const Review *review, Arena scratch,
                          Error *err)
{
    Lines files = {.arena = &scratch};
    list_files(&files, draft->folder, "");
    for (int i = 0; i < files.count; i++) {
        const char *name = files.list[i];
        if (!strcmp(name, "review.json") || is_leftover(name) ||
            (starts_with(name, "frames/") && !is_named(review, name)))
            continue;
        if (!move(draft, name, scratch, err)) return false;
    }
    remove_earlier(draft, review, &files);
    return move(draft, "review.json", scratch, err);
}

void review_draft_finish(ReviewDraft *draft)
{
    Arena      scratch = *draft->arena;
    Lines files = {.arena = &scratch};
    list_files(&files, draft->unfinished, "new/sweeps/");
    list_files(&files, draft->unfinished, "new/frames/");
    list_files(&files, draft->unfinished, "new/");
    list_files(&files, draft->unfinished, "");
    for (int i = 0; i < files.count; i++) {
        const char *name = files.list[i];
        if (starts_with(name, "new/") || has_ending(name, ".checkpoint") ||
            has_ending(name, ".lesson") || is_leftover(name))
            unlink(arena_format(&scratch, "%s/%s", draft->unfinished, name));
    }
    unlink(arena_format(&scratch, "%s/journal", draft->unfinished));
    review_draft_close(draft);
}
