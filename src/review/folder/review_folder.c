/* SPDX-License-Identifier: Apache-2.0 */
#include "review/folder/review_folder.h"

#include <nettle/sha2.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"
#include "base/machine.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "denoise/denoise.h"
#include "image/develop.h"
#include "render/render.h"
#include "review/run/frames.h"
#include "review/folder/sweep_output.h"
#include "review/output/review_link.h"
#include "review/export/review_junit.h"
#include "review/output/review_json.h"
#include "review/output/review_road.h"
#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"

#define INPUT_BYTES ((size_t)1 << 34) /* address space */
#define MAP_STEP_DEG 5
#define MAIN_CARDS 20 /* of the page itself: it stays below 3 MB */

/* ---- before the work ------------------------------------------------------------------*/

static bool read_earlier(ReviewFolder *folder, Arena *arena, Error *err) {
    if (!folder->diff) return true;
    const char *path = arena_format(arena, "%s/review.json", folder->diff);
    return review_json_read(path, arena, &folder->before, err);
}

void review_folder_responses(ReviewFolder *folder, Arena *arena) {
    folder->has_own_responses = !folder->responses;
    folder->responses_shown = folder->responses ? folder->responses : "responses";
    if (!folder->responses) folder->responses = arena_format(arena, "%s/responses", folder->target);
}

/* Responses outlive the review: their folder is no draft. */
static bool open_responses(ReviewFolder *folder, Arena *arena, Error *err) {
    review_folder_responses(folder, arena);
    bool is_there = folder->has_own_responses
                        ? folder_make_own(folder->responses, &folder->responses_are_new, err)
                        : folder_make(folder->responses, err);
    return is_there && review_files_are_plain(folder->responses, *arena, err);
}

bool review_folder_open(ReviewFolder *folder, Arena *arena, Error *err) {
    const ReviewFrames *frames = &folder->request->frames;
    folder->begun_s = monotonic_seconds();
    if (frames->worst && frames->is_denoised && !denoise_check(err)) return false;
    if (!read_earlier(folder, arena, err) ||
        !review_draft_open(folder->target, arena, &folder->draft, err))
        return false;
    folder->name = folder->draft.folder;
    if (open_responses(folder, arena, err)) return true;
    review_folder_close(folder);
    return false;
}

/* As far as there are none. */
static void remove_responses(const ReviewFolder *folder) {
    bool is_ours = folder->responses_are_new || folder->draft.is_ours[0];
    if (folder->has_own_responses && is_ours) rmdir(folder->responses);
}

void review_folder_close(ReviewFolder *folder) {
    remove_responses(folder);
    review_draft_close(&folder->draft);
}

void review_folder_finish(ReviewFolder *folder) {
    remove_responses(folder);
    review_draft_finish(&folder->draft);
}

/* ---- what was read -------------------------------------------------------------------------- */

static const char *digits_of(const FileBytes *bytes, Arena *arena) {
    struct sha256_ctx state;
    uint8_t digest[SHA256_DIGEST_SIZE];
    char *digits = ARENA_NEW(arena, char, 2 * SHA256_DIGEST_SIZE + 1);
    sha256_init(&state);
    sha256_update(&state, bytes->size, (const uint8_t *)bytes->data);
    sha256_digest(&state, sizeof digest, digest);
    for (int i = 0; i < SHA256_DIGEST_SIZE; i++) snprintf(digits + 2 * i, 3, "%02x", digest[i]);
    return digits;
}

/* For people who compare files: by what everybody has a program for. None of a file that is no
 * longer the one that was read. */
static void hash_inputs(Review *review, Arena *arena) {
    for (int i = 0; i < review->input_count; i++) {
        ReviewFile *file = &review->inputs[i];
        Arena room = arena_reserve(INPUT_BYTES);
        FileBytes bytes;
        Error ignored;
        bool is_read =
            !file->sha256 && file_read(file->path, INPUT_BYTES / 2, &room, &bytes, &ignored);
        if (is_read && !strcmp(file->xxh3, arena_format(&room, "%016llx",
                                                        (unsigned long long)XXH3_64bits(
                                                            bytes.data, bytes.size))))
            file->sha256 = digits_of(&bytes, arena);
        arena_release(&room);
    }
}

/* ---- sweeps ------------------------------------------------------------------------------ */

typedef struct FolderTables {
    const ReviewFolder *folder;
    ReviewOutcome *outcome;
} FolderTables;

static ReviewSweep *sweep_of(ReviewOutcome *outcome, int table) {
    return &outcome->review.sweeps[outcome->tables[table].sweep_id];
}

static bool write_table(void *context, int i, Error *err) {
    const FolderTables *work = context;
    const ReviewSweep *sweep = sweep_of(work->outcome, i);
    Arena own = arena_reserve((size_t)1 << 20);
    const char *path = arena_format(&own, "%s/%s", work->folder->name, sweep->table);
    bool ok = sweep_table_write(&work->outcome->tables[i],
                                review_condition_named(work->folder->request, sweep->condition),
                                path, err);
    arena_release(&own);
    return ok;
}

static bool write_tables(const ReviewFolder *folder, ReviewOutcome *outcome, Arena *arena,
                         Error *err) {
    int count = outcome->table_count;
    FolderTables work = {folder, outcome};
    for (int i = 0; i < count; i++) {
        ReviewSweep *sweep = sweep_of(outcome, i);
        const char *name =
            words_file_name(arena_format(arena, "%d-%s-%s-%s", outcome->tables[i].sweep_id + 1,
                                         sweep->condition, sweep->eye, sweep->symbol),
                            arena);
        sweep->table = arena_format(arena, "sweeps/%s.csv", name);
    }
    return parallel_try(folder->threads, count, write_table, &work, *arena, err);
}

static void add_charts(const ReviewFolder *folder, const ReviewOutcome *outcome, ReviewPage *page,
                       Arena *arena) {
    ReviewMap *maps = ARENA_NEW(arena, ReviewMap, outcome->table_count);
    ReviewCalendar *calendars = ARENA_NEW(arena, ReviewCalendar, outcome->table_count);
    for (int i = 0; i < outcome->table_count; i++) {
        const SweepTable *table = &outcome->tables[i];
        const ReviewSweep *sweep = &outcome->review.sweeps[table->sweep_id];
        const ReviewCondition *condition =
            review_condition_named(folder->request, sweep->condition);
        maps[page->map_count++] = sweep_map(table, sweep, condition, MAP_STEP_DEG, arena);
        if (condition->kind == CONDITION_YEAR_SWEEP)
            calendars[page->calendar_count++] = sweep_calendar(table, sweep, condition, arena);
    }
    page->maps = maps;
    page->calendars = calendars;
}

/* ---- the page ---------------------------------------------------------------------------- */

/* Titles and captions of a frame's pictures. */
static const struct {
    const char *title, *caption;
} VIEWS[] = {
    [FRAME_PICTURE] = {"Frame", "What the eye sees, exposed as a camera would"},
    [FRAME_LUMINANCE] = {"Luminance", "How bright everything is, as colours on a scale of the "
                                      "frame's own"},
    [FRAME_CONTRAST] = {"Contrast map", "Full white over full black at each pixel of a "
                                        "display, what it reflects added to both; a symbol's "
                                        "own colours have less. All frames have this scale"},
};

/* The pictures that a page has room for. */
typedef struct PictureList {
    ReviewPicture *at;
    int count;
    const ReviewCase *worst; /* whose frame the first screen shows, too */
    bool has_pairs;          /* variants show frames once more */
} PictureList;

/* One that several cards show stands in the page once. */
static void add_picture(PictureList *list, ReviewPicture picture, Arena *arena) {
    for (int i = 0; i < list->count && !picture.is_again; i++)
        if (!strcmp(list->at[i].file, picture.file)) {
            if (!list->at[i].id) list->at[i].id = arena_format(arena, "p%d", i);
            picture.id = list->at[i].id;
            picture.is_again = true;
        }
    bool is_shown_again = list->has_pairs || picture.of == list->worst;
    if (picture.is_frame && is_shown_again && !picture.id)
        picture.id = arena_format(arena, "p%d", list->count);
    list->at[list->count++] = picture;
}

/* Of the frames' pictures. */
static const char *label_of(const ReviewFolder *folder) {
    return folder->request->frames.is_denoised ? DENOISED_WORDS : NULL;
}

static void add_case_pictures(const ReviewFolder *folder, const ReviewCase *c, PictureList *list,
                              Arena *arena) {
    if (!c->frame) return;
    for (FrameView view = FRAME_PICTURE; view < FRAME_VIEWS; view++) {
        const char *name = frame_view(c->frame, view, arena);
        ReviewPicture picture = {.of = c,
                                 .title = VIEWS[view].title,
                                 .caption = VIEWS[view].caption,
                                 .label = view == FRAME_PICTURE ? label_of(folder) : NULL,
                                 .is_frame = view == FRAME_PICTURE,
                                 .view = view == FRAME_PICTURE ? c->view : NULL,
                                 .file = arena_format(arena, "%s/%s", folder->name, name),
                                 .beside = folder->is_self_contained ? NULL : name};
        add_picture(list, picture, arena);
    }
}

/* In the page's order: cases by rank, then sweeps. */
static void add_pictures(const ReviewFolder *folder, const Review *review, ReviewPage *page,
                         Arena *arena) {
    int all = review->case_count + review->sweep_count;
    const ReviewCase **ranked = review_rank(review, arena);
    PictureList list = {ARENA_NEW(arena, ReviewPicture, all * (FRAME_VIEWS + 1)), 0,
                        review_worst(review, *arena),
                        review->variant_count && review->variants[0].frame};
    for (int i = 0; i < all; i++)
        if (review_card_id(review, ranked[i], arena)[0] == 'c')
            add_case_pictures(folder, ranked[i], &list, arena);
    for (int i = 0; i < review->sweep_count; i++)
        add_case_pictures(folder, &review->sweeps[i].worst, &list, arena);
    page->pictures = list.at;
    page->picture_count = list.count;
}

/* The picture of a case that the page has already: it stands there. */
static ReviewPicture shown_again(const ReviewPage *page, const char *file) {
    for (int i = 0; i < page->picture_count; i++)
        if (!strcmp(page->pictures[i].file, file))
            return (ReviewPicture){.id = page->pictures[i].id, .is_again = true};
    return (ReviewPicture){0};
}

static void set_pair(const ReviewFolder *folder, const ReviewVariantFound *v,
                     const ReviewPage *page, ReviewPicture pair[2], Arena *arena) {
    const char *names[2] = {v->frame_before, v->frame};
    const char *file = arena_format(arena, "%s/%s", folder->name, v->frame_before);
    pair[0] = shown_again(page, file);
    pair[0].title = "As it stands";
    pair[1].title = v->name;
    for (int i = 0; i < 2; i++) {
        pair[i].file = arena_format(arena, "%s/%s", folder->name, names[i]);
        pair[i].beside = folder->is_self_contained ? NULL : names[i];
        pair[i].label = label_of(folder);
        pair[i].caption = arena_format(arena, "%s, %s%s", v->seen->condition, v->seen->eye,
                                       i ? ", exposed as the other" : "");
    }
}

static void add_pairs(const ReviewFolder *folder, const Review *review, ReviewPage *page,
                      Arena *arena) {
    ReviewPicture *pairs = ARENA_NEW(arena, ReviewPicture, 2 * review->variant_count);
    for (int i = 0; i < review->variant_count; i++)
        if (review->variants[i].frame)
            set_pair(folder, &review->variants[i], page, &pairs[2 * i], arena);
    page->pairs = pairs;
}

const char *review_folder_command(const ReviewFolder *folder, Arena *arena) {
    const char *profile =
        folder->profile ? arena_format(arena, " --profile %s", folder->profile) : "";
    const char *diff = folder->diff ? arena_format(arena, " --diff %s", folder->diff) : "";
    const char *root = folder->root ? arena_format(arena, " --root %s", folder->root) : "";
    const char *responses =
        folder->has_own_responses ? "" : arena_format(arena, " --responses %s", folder->responses);
    const char *summary =
        folder->summary ? arena_format(arena, " --summary %s", escape_shell(folder->summary, arena))
                        : "";
    Text only = {.arena = arena};
    for (int i = 0; i < folder->only_count; i++)
        text_format(&only, " --only %s", escape_shell(folder->only[i], arena));
    return arena_format(
        arena, "parhelion review %s -o %s%s%s%s%s%s%s%s%s%s%s%s", folder->request->file,
        folder->target, profile, root, folder->state_text, diff, responses, summary,
        only.data ? only.data : "", folder->is_alone ? " --no-variants" : "",
        folder->is_without_frames ? " --no-frames" : "", folder->is_strict ? " --strict" : "",
        folder->is_self_contained ? " --self-contained" : "");
}

static bool write_diff(const ReviewFolder *folder, const ReviewOutcome *outcome, ReviewPage *page,
                       Arena *arena, Error *err) {
    if (!folder->diff) return true;
    ReviewDiff *diff = ARENA_NEW(arena, ReviewDiff, 1);
    *diff = review_diff(&folder->before, &outcome->review, folder->diff, folder->target, arena);
    page->diff = diff;
    return review_json_write(review_diff_json(diff),
                             arena_format(arena, "%s/diff.json", folder->name), err);
}

/* One a symbol; --summary: that one alone. */
static bool write_summaries(const ReviewFolder *folder, const ReviewPage *page, Arena *arena,
                            Error *err) {
    const Review *review = page->review;
    int all = review->case_count + review->sweep_count;
    const ReviewCase **ranked = review_rank(review, arena);
    for (int i = 0; i < all; i++) {
        const char *symbol = ranked[i]->symbol;
        bool is_listed = folder->summary && strcmp(folder->summary, symbol) != 0;
        for (int k = 0; k < i && !is_listed; k++) is_listed = !strcmp(ranked[k]->symbol, symbol);
        if (is_listed) continue;
        const char *path =
            arena_format(arena, "%s/%s", folder->name, review_summary_name(review, symbol, arena));
        if (!review_page_write_summary(page, symbol, path, err)) return false;
    }
    return true;
}

/* Many cases take two pages, so that the first is light. */
static bool write_page(const ReviewFolder *folder, ReviewOutcome *outcome, Arena *arena,
                       Error *err) {
    Review *review = &outcome->review;
    ReviewPage page = {
        .review = review, .sources = SOURCES_HASH, .command = review_folder_command(folder, arena)};
    int all = review->case_count + review->sweep_count;
    review->has_summaries = !folder->is_self_contained && !folder->summary;
    review->main_cards = folder->is_self_contained || all <= MAIN_CARDS ? 0 : MAIN_CARDS;
    add_charts(folder, outcome, &page, arena);
    add_pictures(folder, review, &page, arena);
    add_pairs(folder, review, &page, arena);
    if (!write_diff(folder, outcome, &page, arena, err) ||
        !review_page_write(&page, arena_format(arena, "%s/index.html", folder->name), err))
        return false;
    if ((review->has_summaries || folder->summary) && !write_summaries(folder, &page, arena, err))
        return false;
    if (!review->main_cards) return true;
    review->is_beside = true;
    bool ok = review_page_write(
        &page, arena_format(arena, "%s/%s", folder->name, REVIEW_PAGE_BESIDE), err);
    review->is_beside = false;
    return ok;
}

static bool write_run(const ReviewFolder *folder, const ReviewOutcome *outcome, Arena *arena,
                      Error *err) {
    json_t *run =
        json_pack("{s:f, s:f, s:s, s:i}", "seconds", monotonic_seconds() - folder->begun_s,
                  "peak_memory_bytes", machine_peak_bytes(), "version", PARHELION_VERSION,
                  "responses_reused", outcome->responses_kept);
    return review_json_write(run, arena_format(arena, "%s/run.json", folder->name), err);
}

bool review_folder_write(const ReviewFolder *folder, ReviewOutcome *outcome, Arena *arena,
                         Error *err) {
    Review *review = &outcome->review;
    hash_inputs(review, arena);
    return write_tables(folder, outcome, arena, err) &&
           review_csv_write(review, arena_format(arena, "%s/cases.csv", folder->name), err) &&
           review_junit_write(review, arena_format(arena, "%s/junit.xml", folder->name), err) &&
           review_json_write(review_json(review),
                             arena_format(arena, "%s/review.json", folder->name), err) &&
           write_page(folder, outcome, arena, err) && write_run(folder, outcome, arena, err) &&
           review_draft_publish(&folder->draft, review, *arena, err);
}
