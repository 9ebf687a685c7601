/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/review_draft.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/lines.h"
#include "review/folder/review_files.h"

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
    for (int i = 0; i < REVIEW_FILES_FIXED; i++)
        if (!file_check_writable(arena_format(&scratch, "%s/%s", target, review_files_fixed[i]),
                                 err))
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

/* What moves now: all but frames that the review does not name, review.json last. */
static Lines to_publish(const ReviewDraft *draft, const Review *review, Arena *arena)
{
    Lines drafted = {.arena = arena}, files = {.arena = arena};
    review_files_list(&drafted, draft->folder, "");
    for (int i = 0; i < drafted.count; i++) {
        const char *name = drafted.list[i];
        bool is_other_frame =
            starts_with(name, "frames/") && !review_files_is_named(review, name);
        if (review_files_may_have(name) && strcmp(name, "review.json") != 0 && !is_other_frame)
            lines_put(&files, name);
    }
    lines_put(&files, "review.json");
    return files;
}

/* Removes what reviews made here and this one does not have. The page loads a frame's layers
 * only if they are published with it. Returns what stays. */
static Lines remove_earlier(const ReviewDraft *draft, const Review *review, const Lines *made,
                            const Lines *published, Arena *arena)
{
    Lines stays = {.arena = arena};
    for (int i = 0; i < made->count; i++) {
        const char *name = made->list[i];
        bool        is_kept = review_files_is_named(review, name) && !has_ending(name, ".js");
        if (is_kept || review_files_has(published, name)) lines_put(&stays, name);
        else unlink(arena_format(arena, "%s/%s", draft->target, name));
    }
    return stays;
}

/* The list is never behind: it holds a file before that has its place, and until it is gone. */
bool review_draft_publish(const ReviewDraft *draft, const Review *review, Arena scratch,
                          Error *err)
{
    Lines files = to_publish(draft, review, &scratch);
    Lines made = review_files_read(draft->target, &scratch);
    for (int i = 0; i < files.count; i++) {
        const char *to = arena_format(&scratch, "%s/%s", draft->target, files.list[i]);
        if (!review_files_has(&made, files.list[i]) && file_exists(to))
            return review_files_refuse(to, err);
    }
    for (int i = 0; i < files.count; i++) review_files_add(&made, files.list[i]);
    if (!review_files_write(draft->target, &made, scratch, err)) return false;
    for (int i = 0; i < files.count - 1; i++)
        if (!move(draft, files.list[i], scratch, err)) return false;
    Lines stays = remove_earlier(draft, review, &made, &files, &scratch);
    return move(draft, "review.json", scratch, err) &&
           review_files_write(draft->target, &stays, scratch, err);
}

void review_draft_finish(ReviewDraft *draft)
{
    Arena      scratch = *draft->arena;
    Lines files = {.arena = &scratch};
    review_files_list(&files, draft->unfinished, "new/sweeps/");
    review_files_list(&files, draft->unfinished, "new/frames/");
    review_files_list(&files, draft->unfinished, "");
    for (int i = 0; i < files.count; i++) {
        const char *name = files.list[i];
        bool is_drafted = starts_with(name, "new/") && review_files_may_have(name + 4);
        if (is_drafted || has_ending(name, ".checkpoint") || has_ending(name, ".lesson") ||
            is_leftover(name))
            unlink(arena_format(&scratch, "%s/%s", draft->unfinished, name));
    }
    unlink(arena_format(&scratch, "%s/journal", draft->unfinished));
    review_draft_close(draft);
}
