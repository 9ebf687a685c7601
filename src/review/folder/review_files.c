/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/review_files.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/lines.h"
#include "base/number.h"
#include "keep/kept.h"
#include "review/output/review_json.h"
#include "review/output/review_link.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define LIST "made-by-review.txt"
#define LIST_TITLE "# files of a review: the next one in this folder replaces or removes them\n"
#define LIST_BYTES ((size_t)1 << 24)

const char *const review_files_fixed[REVIEW_FILES_FIXED] = {
    "review.json", "index.html", "cases.csv",        "junit.xml",
    "diff.json",   "run.json",   REVIEW_PAGE_BESIDE, LIST};

/* That earlier versions wrote besides: they go with the review that stood there. */
static const char *const of_earlier[] = {"gazes.csv", "dimming.csv", "false_suns.csv",
                                         "pane_images.csv", "live.js"};

/* Behind a frame's name. */
static const char *const of_frame[] = {".png", ".exr", "-luminance.png", "-contrast.png"};
#define OF_VARIANT "-variant-"

/* ---- names ------------------------------------------------------------------------------- */

static bool starts_with(const char *text, const char *start) {
    return !strncmp(text, start, strlen(start));
}

/* That a file of somebody else's stands there. */
static bool review_files_refuse(const char *path, Error *err) {
    return error_at(err, ERROR_OUTPUT, path, "",
                    "was not made by a review, and is not written "
                    "over — move it, or give another folder");
}

static bool is_among(const char *const *list, int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (!strcmp(list[i], name)) return true;
    return false;
}

/* Behind its folder, if it is in one. */
static bool is_numbered(const char *name, const char *folder) {
    const char *in_folder = name + strlen(folder);
    return starts_with(name, folder) && isdigit((unsigned char)*in_folder) &&
           !strchr(in_folder, '/');
}

static bool is_fixed(const char *name) {
    return is_among(review_files_fixed, REVIEW_FILES_FIXED, name) ||
           is_among(of_earlier, COUNT_OF(of_earlier), name);
}

/* Whether a review may have written a file of this name at all. */
static bool review_files_may_have(const char *name) {
    bool is_summary =
        starts_with(name, "summary-") && !strchr(name, '/') && !strcmp(path_ending(name), ".html");
    return is_summary || is_fixed(name) || is_numbered(name, "frames/") ||
           is_numbered(name, "sweeps/") || is_numbered(name, "conditions/");
}

/* Is the rest of a name, behind a frame's, one of its files? */
static bool is_rest_of_frame(const char *rest) {
    return is_among(of_frame, COUNT_OF(of_frame), rest) || starts_with(rest, OF_VARIANT);
}

/* frame: its picture. */
static bool is_of_frame(const char *name, const char *frame) {
    size_t length = frame ? (size_t)(path_ending(frame) - frame) : 0;
    return frame && !strncmp(name, frame, length) && is_rest_of_frame(name + length);
}

/* Whether a frame or a table of this name belongs to what the review shows. */
static bool review_files_is_named(const Review *review, const char *name) {
    for (int i = 0; i < review->case_count; i++)
        if (is_of_frame(name, review->cases[i].frame)) return true;
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *sweep = &review->sweeps[i];
        if (is_of_frame(name, sweep->worst.frame) || words_same(name, sweep->table)) return true;
    }
    return false;
}

/* ---- what is there ----------------------------------------------------------------------- */

/* All files in a folder and in the folders right below it, hidden ones too. prefix: "", or a
 * folder within it, "sweeps/". */
static void review_files_list(Lines *files, const char *folder, const char *prefix) {
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
            review_files_list(files, folder, arena_format(files->arena, "%s/", name));
    }
    closedir(open);
}

/* ---- the list ---------------------------------------------------------------------------- */

static bool review_files_has(const Lines *files, const char *name) {
    return is_among(files->list, files->count, name);
}

/* A folder without a list: what its review.json names. */
static void adopt(Lines *files, const char *dir) {
    Arena *arena = files->arena;
    Lines there = {.arena = arena};
    Review review;
    Error ignored;
    const char *document = arena_format(arena, "%s/review.json", dir);
    if (!file_exists(document) || !review_json_read(document, arena, &review, &ignored)) return;
    review_files_list(&there, dir, "");
    int all = review_case_count(&review);
    const ReviewCase **ranked = review_rank(&review, arena);
    for (int i = 0; i < there.count; i++) {
        const char *name = there.list[i];
        bool is_own = is_fixed(name) || review_files_is_named(&review, name);
        for (int k = 0; k < all && !is_own; k++)
            is_own = !strcmp(name, review_summary_name(&review, ranked[k]->symbol, arena));
        if (is_own) lines_put(files, name);
    }
}

/* The bytes of a list, of which the title is the mark; NULL: it is none. */
static const char *list_text(const char *path, Arena *arena) {
    FileBytes bytes;
    Error ignored;
    if (!file_read(path, LIST_BYTES, arena, &bytes, &ignored)) return NULL;
    const char *text = (const char *)bytes.data;
    return starts_with(text, LIST_TITLE) ? text + strlen(LIST_TITLE) : NULL;
}

/* Names within the folder, "index.html", "sweeps/1-noon.csv"; none where nothing was made.
 * Other names than a review's are left out: a list may come with a folder from anywhere. */
static Lines review_files_read(const char *dir, Arena *arena) {
    Lines files = {.arena = arena};
    const char *path = arena_format(arena, "%s/" LIST, dir);
    if (!file_exists(path)) {
        adopt(&files, dir);
        return files;
    }
    for (const char *line = list_text(path, arena); line && *line;) {
        size_t length = strcspn(line, "\n");
        const char *name = arena_string(arena, line, length);
        if (review_files_may_have(name)) lines_put(&files, name);
        line += length + (line[length] == '\n');
    }
    return files;
}

static int compare_names(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Sorted: in how many steps they came decides nothing. */
static bool review_files_write(const char *dir, const Lines *files, Arena scratch, Error *err) {
    const char *path = arena_format(&scratch, "%s/" LIST, dir);
    const char **names = ARENA_NEW(&scratch, const char *, files->count + 1);
    Text text = {.arena = &scratch};
    for (int i = 0; i < files->count; i++) names[i] = files->list[i];
    qsort(names, (size_t)files->count, sizeof *names, compare_names);
    text_add(&text, LIST_TITLE);
    for (int i = 0; i < files->count; i++) text_format(&text, "%s\n", names[i]);
    return text_write(&text, path, err);
}

/* ---- what stands in the way -------------------------------------------------------------- */

/* Also where a file system takes large letters for small ones. */
static bool starts_alike(const char *text, const char *start) {
    return !strncasecmp(text, start, strlen(start));
}

/* "summary-NAME.html", "summary-NAME.2.html"; texts that are found are "NAME 1", "NAME 2". */
static bool may_be_summary(const char *name, const ReviewRequest *request, Arena scratch) {
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        const char *start =
            arena_format(&scratch, "summary-%s", words_file_name(symbol->name, &scratch));
        const char *rest = name + strlen(start);
        if (!starts_alike(name, start)) continue;
        if (symbol->find_text && *rest == '-') rest++;
        rest += strspn(rest, ".0123456789");
        if (!strcasecmp(rest, "html") || !strcasecmp(rest, ".html")) return true;
    }
    return false;
}

/* "frames/1-CONDITION-EYE.png", "sweeps/1-CONDITION-EYE-SYMBOL.csv". */
static bool may_be_numbered(const char *name, const ReviewRequest *request, Arena scratch) {
    const char *in_folder = strchr(name, '/') + 1;
    uint64_t number;
    if (!number_read_count(in_folder, &number)) return false;
    for (int c = 0; c < request->condition_count; c++)
        for (int e = 0; e < request->eye_count; e++) {
            Arena own = scratch;
            const char *start =
                words_file_name(arena_format(&own, "%llu-%s-%s", (unsigned long long)number,
                                             request->conditions[c].name, request->eyes[e].name),
                                &own);
            if (!starts_alike(in_folder, start)) continue;
            if (name[0] == 's' || is_rest_of_frame(in_folder + strlen(start))) return true;
        }
    return false;
}

/* What is kept of a condition while the review is not finished. */
static bool may_be_kept(const char *name, const ReviewRequest *request, Arena scratch) {
    for (int c = 0; c < request->condition_count; c++)
        if (!strcasecmp(name, arena_format(&scratch, "unfinished/%d-%s.condition", c + 1,
                                           words_file_name(request->conditions[c].name, &scratch))))
            return true;
    return false;
}

static bool may_be_written(const char *name, const ReviewRequest *request, Arena scratch) {
    for (int i = 0; i < REVIEW_FILES_FIXED; i++)
        if (!strcasecmp(name, review_files_fixed[i])) return true;
    if (starts_with(name, "unfinished/")) return may_be_kept(name, request, scratch);
    if (starts_alike(name, "summary-")) return may_be_summary(name, request, scratch);
    return (is_numbered(name, "frames/") || is_numbered(name, "sweeps/")) &&
           may_be_numbered(name, request, scratch);
}

bool review_files_check(const char *dir, const ReviewRequest *request, Arena scratch, Error *err) {
    Lines made = review_files_read(dir, &scratch), there = {.arena = &scratch};
    review_files_list(&there, dir, "");
    for (int i = 0; i < there.count; i++) {
        const char *name = there.list[i];
        const char *path = arena_format(&scratch, "%s/%s", dir, name);
        bool is_foreign = !strcmp(name, LIST)                ? !list_text(path, &scratch)
                          : starts_with(name, "unfinished/") ? !kept_is_ours(path)
                                                             : !review_files_has(&made, name);
        if (is_foreign && may_be_written(name, request, scratch))
            return review_files_refuse(path, err);
    }
    return true;
}

bool review_files_are_plain(const char *folder, Arena scratch, Error *err) {
    Lines there = {.arena = &scratch};
    review_files_list(&there, folder, "");
    for (int i = 0; i < there.count; i++) {
        struct stat info;
        const char *path = arena_format(&scratch, "%s/%s", folder, there.list[i]);
        if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode))
            return error_at(err, ERROR_OUTPUT, path, "",
                            "is a pipe or a device, and no review made it — remove it, or give "
                            "another folder");
    }
    return true;
}

static bool is_among_files(const Lines *files, const char *path) {
    bool found = false;
    for (int i = 0; i < files->count && !found; i++) found = file_is_same(files->list[i], path);
    return found;
}

bool review_files_spare(const char *dir, const ReviewRequest *request, const Lines *inputs,
                        Arena scratch, Error *err) {
    Lines there = {.arena = &scratch};
    review_files_list(&there, dir, "");
    for (int i = 0; i < there.count; i++) {
        Arena room = scratch;
        const char *path = arena_format(&room, "%s/%s", dir, there.list[i]);
        if (is_among_files(inputs, path) && may_be_written(there.list[i], request, room))
            return error_at(err, ERROR_OUTPUT, path, "",
                            "is read, and the review would write "
                            "over it — give another folder");
    }
    return true;
}

/* ---- files of a draft -------------------------------------------------------------------- */

#define HEX_DIGITS "0123456789abcdef"
#define DIGITS "0123456789"

/* HASH.frame, HASH.checkpoint, N-NAME.condition, before `end`. */
static bool is_kept_name(const char *name, const char *end) {
    static const char *const endings[] = {".frame", ".checkpoint"};
    size_t length = (size_t)(end - name), digits = strspn(name, DIGITS);
    if (digits && name[digits] == '-')
        return length > digits + 10 && !memcmp(end - 10, ".condition", 10);
    for (int i = 0; i < COUNT_OF(endings); i++)
        if (strspn(name, HEX_DIGITS) == 16 && length == 16 + strlen(endings[i]) &&
            !memcmp(name + 16, endings[i], length - 16))
            return true;
    return false;
}

/* Of a review that was stopped: its name is no proof of it, the file's begin is. */
static bool is_kept(const char *folder, const char *name, Arena scratch) {
    return is_kept_name(name, name + strlen(name)) &&
           kept_is_ours(arena_format(&scratch, "%s/%s", folder, name));
}

/* Of NAME.parhelion-part and NAME.HASH-PROCESS.part, which a writer that was killed leaves, the
 * length of NAME; of any other 0. */
static size_t leftover_of(const char *name) {
    const char *ending = path_ending(name), *dot = ending;
    if (!strcmp(ending, ".parhelion-part")) return (size_t)(ending - name);
    if (ending == name || strcmp(ending, ".part") != 0) return 0;
    while (dot > name && *--dot != '.') {
    }
    bool is_own = *dot == '.' && strspn(dot + 1, HEX_DIGITS) == 8 && dot[9] == '-' &&
                  dot + 10 + strspn(dot + 10, DIGITS) == ending;
    return is_own ? (size_t)(dot - name) : 0;
}

static bool is_leftover(const char *name, Arena scratch) {
    size_t length = leftover_of(name);
    const char *whole = arena_string(&scratch, name, length);
    if (starts_with(whole, "new/")) return review_files_may_have(whole + 4);
    return length && is_kept_name(whole, whole + length);
}

bool review_has_unfinished(const char *target, Arena scratch) {
    Lines files = {.arena = &scratch};
    const char *folder = arena_format(&scratch, "%s/unfinished", target);
    review_files_list(&files, folder, "");
    for (int i = 0; i < files.count; i++)
        if (!strchr(files.list[i], '/') && is_kept(folder, files.list[i], scratch)) return true;
    return false;
}

/* ---- folders ----------------------------------------------------------------------------- */

static const char *const parts[REVIEW_PARTS] = {"", "/sweeps", "/frames", "/conditions"};

/* is_new: those that were not there; NULL: nobody asks. */
static bool make_parts(const char *folder, bool *is_new, Arena scratch, Error *err) {
    for (int i = 1; i < REVIEW_PARTS; i++) {
        bool made;
        const char *path = arena_format(&scratch, "%s%s", folder, parts[i]);
        if (!folder_make_own(path, &made, err)) return false;
        if (is_new) is_new[i] = made;
    }
    return true;
}

/* As far as they are empty. is_ours: NULL: all of them. */
static void remove_parts(const char *folder, const bool *is_ours, Arena scratch) {
    for (int i = REVIEW_PARTS - 1; i >= 0; i--)
        if (!is_ours || is_ours[i]) rmdir(arena_format(&scratch, "%s%s", folder, parts[i]));
}

static const char *lock_path(const ReviewDraft *draft, Arena *arena) {
    return arena_format(arena, "%s/lock", draft->unfinished);
}

/* What is not a review's stays, and so does a folder that was there before any review. */
void review_draft_close(ReviewDraft *draft) {
    unlink(lock_path(draft, draft->arena));
    close(draft->lock);
    remove_parts(draft->folder, NULL, *draft->arena);
    if (draft->unfinished_is_ours) rmdir(draft->unfinished);
    remove_parts(draft->target, draft->is_ours, *draft->arena);
}

/* Known before the work: a file that cannot take its place would end the review half moved. */
static bool check_files(const char *target, Arena scratch, Error *err) {
    for (int i = 0; i < REVIEW_FILES_FIXED; i++)
        if (!file_check_writable(arena_format(&scratch, "%s/%s", target, review_files_fixed[i]),
                                 err))
            return false;
    return true;
}

/* Two processes never have one folder. A folder that came from somewhere may have anything in
 * the lock's place; a file system without locks is no reason to fail. */
static bool take_lock(ReviewDraft *draft, Arena *arena, Error *err) {
    const char *path = lock_path(draft, arena);
    struct stat info;
    if (!file_open_own(path, &draft->lock, err)) return false;
    if (fstat(draft->lock, &info) != 0 || info.st_size)
        error_at(err, ERROR_OUTPUT, path, "",
                 "is not a review's: a lock is empty — move it, or give another folder");
    else if (flock(draft->lock, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    else
        error_at(err, ERROR_OUTPUT, draft->unfinished, "",
                 "another review is at work in this folder: wait for it, or name another "
                 "folder");
    close(draft->lock);
    return false;
}

/* Folders that a review left, or made just now, are its own: they go when they are empty. */
static bool make_folders(ReviewDraft *draft, bool is_new, bool was_begun, Arena *arena,
                         Error *err) {
    bool is_new_folder;
    const char *list = arena_format(arena, "%s/" LIST, draft->target);
    bool is_reviews = was_begun || (file_exists(list) && list_text(list, arena));
    bool ok = make_parts(draft->target, draft->is_ours, *arena, err) &&
              folder_make_own(draft->folder, &is_new_folder, err) &&
              make_parts(draft->folder, NULL, *arena, err) &&
              review_files_are_plain(draft->unfinished, *arena, err) &&
              review_files_are_plain(draft->folder, *arena, err) &&
              check_files(draft->target, *arena, err);
    draft->is_ours[0] = is_new;
    for (int i = 0; i < REVIEW_PARTS; i++) draft->is_ours[i] |= is_reviews;
    return ok;
}

bool review_draft_open(const char *target, Arena *arena, ReviewDraft *out, Error *err) {
    ReviewDraft draft = {.arena = arena,
                         .target = target,
                         .unfinished = arena_format(arena, "%s/unfinished", target)};
    struct stat info;
    bool is_new = lstat(target, &info) != 0;
    draft.folder = arena_format(arena, "%s/new", draft.unfinished);
    bool was_begun = lstat(lock_path(&draft, arena), &info) == 0 ||
                     (!is_new && review_has_unfinished(target, *arena));
    if (!folder_make(target, err) ||
        !folder_make_own(draft.unfinished, &draft.unfinished_is_ours, err) ||
        !take_lock(&draft, arena, err)) {
        if (draft.unfinished_is_ours) rmdir(draft.unfinished);
        if (is_new) rmdir(target);
        return false;
    }
    draft.unfinished_is_ours |= was_begun;
    if (make_folders(&draft, is_new, was_begun, arena, err)) {
        *out = draft;
        return true;
    }
    review_draft_close(&draft);
    return false;
}

/* ---- taking their places ----------------------------------------------------------------- */

static bool move(const ReviewDraft *draft, const char *name, Arena scratch, Error *err) {
    const char *from = arena_format(&scratch, "%s/%s", draft->folder, name);
    const char *to = arena_format(&scratch, "%s/%s", draft->target, name);
    const char *slash = strrchr(name, '/');
    bool is_new;
    if (slash && !folder_make_own(
                     arena_format(&scratch, "%s/%.*s", draft->target, (int)(slash - name), name),
                     &is_new, err))
        return false;
    return rename(from, to) == 0 ||
           error_at(err, ERROR_OUTPUT, to, "", "cannot be written: %s", strerror(errno));
}

/* What moves now: all but frames and tables that the review does not name, review.json last. */
static Lines to_publish(const ReviewDraft *draft, const Review *review, Arena *arena) {
    Lines drafted = {.arena = arena}, files = {.arena = arena};
    review_files_list(&drafted, draft->folder, "");
    for (int i = 0; i < drafted.count; i++) {
        const char *name = drafted.list[i];
        bool is_other = is_among(of_earlier, COUNT_OF(of_earlier), name) ||
                        ((starts_with(name, "frames/") || starts_with(name, "sweeps/")) &&
                         !review_files_is_named(review, name));
        if (review_files_may_have(name) && strcmp(name, "review.json") != 0 && !is_other)
            lines_put(&files, name);
    }
    lines_put(&files, "review.json");
    return files;
}

/* Removes what reviews made here and this one does not have. Returns what stays. */
static Lines remove_earlier(const ReviewDraft *draft, const Review *review, const Lines *made,
                            const Lines *published, Arena *arena) {
    Lines stays = {.arena = arena};
    for (int i = 0; i < made->count; i++) {
        const char *name = made->list[i];
        if (review_files_is_named(review, name) || review_files_has(published, name))
            lines_put(&stays, name);
        else unlink(arena_format(arena, "%s/%s", draft->target, name));
    }
    return stays;
}

/* The list is never behind: it holds a file before that has its place, and until it is gone. */
bool review_draft_publish(const ReviewDraft *draft, const Review *review, Arena scratch,
                          Error *err) {
    Lines files = to_publish(draft, review, &scratch);
    Lines made = review_files_read(draft->target, &scratch);
    for (int i = 0; i < files.count; i++) {
        const char *to = arena_format(&scratch, "%s/%s", draft->target, files.list[i]);
        if (!review_files_has(&made, files.list[i]) && file_exists(to))
            return review_files_refuse(to, err);
    }
    for (int i = 0; i < files.count; i++)
        if (!review_files_has(&made, files.list[i])) lines_put(&made, files.list[i]);
    if (!review_files_write(draft->target, &made, scratch, err)) return false;
    for (int i = 0; i < files.count - 1; i++)
        if (!move(draft, files.list[i], scratch, err)) return false;
    Lines stays = remove_earlier(draft, review, &made, &files, &scratch);
    return move(draft, "review.json", scratch, err) &&
           review_files_write(draft->target, &stays, scratch, err);
}

void review_draft_finish(ReviewDraft *draft) {
    Arena scratch = *draft->arena;
    Lines files = {.arena = &scratch};
    review_files_list(&files, draft->unfinished, "new/sweeps/");
    review_files_list(&files, draft->unfinished, "new/frames/");
    review_files_list(&files, draft->unfinished, "new/conditions/");
    review_files_list(&files, draft->unfinished, "");
    for (int i = 0; i < files.count; i++) {
        const char *name = files.list[i];
        bool is_drafted = starts_with(name, "new/") && review_files_may_have(name + 4);
        if (is_drafted || is_kept(draft->unfinished, name, scratch) || is_leftover(name, scratch))
            unlink(arena_format(&scratch, "%s/%s", draft->unfinished, name));
    }
    review_draft_close(draft);
}
