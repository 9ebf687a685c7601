/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/condition_file.h"

#include <stdint.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "keep/kept.h"
#include "render/identity.h"
#include "review/engine/condition_rows.h"
#include "review/review_decide.h"

#define BODY_BYTES ((uint64_t)1 << 34)
#define FILE_BYTES ((size_t)1 << 34)

static const KeptFormat format = {"PRHLCOND", "a reviewed condition", 2, 0};

const char *condition_file_name(const ReviewRequest *request, int condition_id, Arena *arena) {
    const char *name = request->conditions[condition_id].name;
    return arena_format(arena, "%d-%s.condition", condition_id + 1, words_file_name(name, arena));
}

const char *condition_identity(const ReviewRun *run, int condition_id, Arena *arena, Error *err) {
    const ReviewRequest *request = run->request;
    const Kernel *kernel;
    Text text = {.arena = arena};
    if (!kernel_choose(run->means.isa, &kernel, err)) return NULL;
    identity_add_program(&text, kernel);
    for (int i = 0; i < request->input_count; i++)
        identity_line(&text, "request", "%016llx", (unsigned long long)request->inputs[i].hash);
    identity_line(&text, "limits", "%s %016llx", run->profile->id,
                  (unsigned long long)run->profile->file_hash);
    identity_line(&text, "state", "%s", run->state_text ? run->state_text : "");
    identity_line(&text, "variants", "%d", request->variant_count);
    identity_line(&text, "condition", "%d of %d", condition_id + 1, request->condition_count);
    for (int i = 0; i < run->word_count; i++) identity_line(&text, "word", "%s", run->words[i]);
    return text.data;
}

/* Is it a line of that name? */
static bool is_named(const char *line, const char *name) {
    size_t length = strlen(name);
    return !strncmp(line, name, length) && line[length] == '\t';
}

const char *condition_identity_without(const char *identity, const char *name, Arena *arena) {
    Text text = {.arena = arena};
    for (const char *line = identity; *line;) {
        size_t length = strcspn(line, "\n");
        length += line[length] == '\n';
        if (!is_named(line, name)) text_add_bytes(&text, line, length);
        line += length;
    }
    return text.data ? text.data : "";
}

Lines condition_identity_values(const char *identity, const char *name, Arena *arena) {
    Lines values = {.arena = arena};
    for (const char *line = identity; *line;) {
        size_t length = strcspn(line, "\n"), skipped = strlen(name) + 1;
        if (is_named(line, name))
            lines_put(&values, arena_string(arena, line + skipped, length - skipped));
        line += length + (line[length] == '\n');
    }
    return values;
}

bool condition_read_identity(const char *path, Arena *arena, const char **out, Error *err) {
    KeptReader reader;
    if (!kept_open(&format, path, NULL, arena, &reader, err)) return false;
    *out = reader.identity;
    kept_close(&reader);
    return true;
}

/* ---- writing ----------------------------------------------------------------------------- */

static TableKept table_of(const SweepTable *table, Arena *arena) {
    const SunFigures *f = &table->figures;
    StepKept *steps = ARENA_NEW(arena, StepKept, table->suns->count);
    for (int i = 0; i < table->suns->count; i++)
        steps[i] = (StepKept){{f->contrast[i], f->low[i], f->high[i], f->margin[i], f->reflected[i],
                               f->mirror[i], f->level[i], f->lux[i]},
                              f->verdict[i]};
    return (TableKept){table->sweep_id,  f->worst, f->is_private,
                       table->worst_sun, steps,    table->suns->count};
}

static void add_count(Text *to, int count) {
    text_add_bytes(to, &count, sizeof count);
}

static void add_sights(Text *to, const Review *review) {
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        const CaseSight sight = {i, c->frame, c->view, c->rim, c->rim_count};
        if (c->frame) pack_add(to, &condition_sight, &sight);
    }
}

bool condition_write(const ConditionFound *found, const char *path, const char *identity,
                     Arena scratch, Error *err) {
    const ReviewOutcome *own = &found->own;
    Arena room = arena_reserve(FILE_BYTES); /* a text grows at an arena's end */
    Text body = {.arena = &room};
    text_add_bytes(&body, &(uint64_t){0}, sizeof(uint64_t));
    pack_add(&body, &condition_review, &own->review);
    add_count(&body, own->table_count);
    for (int i = 0; i < own->table_count; i++) {
        Arena of_table = scratch;
        TableKept table = table_of(&own->tables[i], &of_table);
        pack_add(&body, &condition_table, &table);
    }
    add_count(&body, found->variant_count);
    for (int i = 0; i < found->variant_count; i++)
        pack_add(&body, &condition_review, &found->variants[i]);
    uint64_t answers = body.size - sizeof answers;
    memcpy(body.data, &answers, sizeof answers);
    add_sights(&body, &own->review);
    const KeptFile file = {&format, path, identity, "", body.size};
    bool ok = kept_write(&file, body.data, scratch, err);
    arena_release(&room);
    return ok;
}

/* ---- reading ----------------------------------------------------------------------------- */

static bool take_count(PackBytes *from, int *out) {
    if (from->end - from->at < (ptrdiff_t)sizeof *out) return false;
    memcpy(out, from->at, sizeof *out);
    from->at += sizeof *out;
    return *out >= 0;
}

static SunFigures figures_of(const TableKept *kept, Arena *arena) {
    int count = kept->step_count;
    SunFigures f = {.worst = kept->worst,
                    .is_private = kept->is_private,
                    .verdict = ARENA_NEW(arena, unsigned char, count)};
    float **lists[STEP_FIGURES] = {&f.contrast,  &f.low,    &f.high,  &f.margin,
                                   &f.reflected, &f.mirror, &f.level, &f.lux};
    for (int k = 0; k < STEP_FIGURES; k++) {
        *lists[k] = ARENA_NEW(arena, float, count);
        for (int i = 0; i < count; i++) (*lists[k])[i] = kept->steps[i].figures[k];
    }
    for (int i = 0; i < count; i++) f.verdict[i] = (unsigned char)kept->steps[i].verdict;
    return f;
}

/* The worst sun lies near one of the steps. */
static bool is_of_suns(const TableKept *table, const SweepSuns *suns, const Review *review) {
    const SweepSun *worst = &table->worst_sun;
    bool is_near = false;
    for (int i = 0; i < suns->count && !is_near; i++)
        is_near =
            suns->list[i].step == worst->step && suns->list[i].heading_id == worst->heading_id;
    return is_near && table->step_count == suns->count && table->sweep_id < review->sweep_count;
}

static bool take_tables(PackBytes *from, const ReviewRun *run, int condition_id, Arena *arena,
                        ReviewOutcome *out) {
    SweepSuns *suns = ARENA_NEW(arena, SweepSuns, 1);
    int count;
    if (!take_count(from, &count) || count > out->review.sweep_count) return false;
    if (count)
        *suns = sweep_suns(&run->request->conditions[condition_id], run->means.threads, arena);
    out->tables = ARENA_NEW(arena, SweepTable, count);
    for (; out->table_count < count; out->table_count++) {
        TableKept kept;
        if (!pack_take(from, &condition_table, &kept, arena) ||
            !is_of_suns(&kept, suns, &out->review))
            return false;
        out->tables[out->table_count] =
            (SweepTable){kept.sweep_id, kept.worst_sun, suns, figures_of(&kept, arena)};
    }
    return true;
}

static bool take_sights(PackBytes *from, Review *review, Arena *arena) {
    while (from->at < from->end) {
        CaseSight sight;
        if (!pack_take(from, &condition_sight, &sight, arena) || !sight.frame || !sight.view ||
            sight.case_id >= review_case_count(review))
            return false;
        int sweep = sight.case_id - review->case_count;
        ReviewCase *c = sweep < 0 ? &review->cases[sight.case_id] : &review->sweeps[sweep].worst;
        c->frame = sight.frame;
        c->view = sight.view;
        c->rim = sight.rim;
        c->rim_count = sight.rim_count;
    }
    return true;
}

/* Frames are made by these names. */
static bool names_are_known(const ReviewRequest *request, int condition_id, const Review *review) {
    const char *condition = request->conditions[condition_id].name;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (strcmp(c->condition, condition) != 0 || !review_eye_named(request, c->eye))
            return false;
    }
    return true;
}

static bool take_answers(PackBytes *from, const ReviewRun *run, int condition_id, Arena *arena,
                         ConditionFound *out) {
    const ReviewRequest *request = run->request;
    Review *review = &out->own.review;
    if (!pack_take(from, &condition_review, review, arena) ||
        !names_are_known(request, condition_id, review) ||
        !take_tables(from, run, condition_id, arena, &out->own) ||
        !take_count(from, &out->variant_count) || out->variant_count != request->variant_count)
        return false;
    out->variants = ARENA_NEW(arena, Review, out->variant_count);
    for (int i = 0; i < out->variant_count; i++)
        if (!pack_take(from, &condition_review, &out->variants[i], arena) ||
            !names_are_known(request, condition_id, &out->variants[i]))
            return false;
    out->own.responses_kept = review->response_count;
    return from->at == from->end;
}

static bool take_body(KeptReader *reader, const ReviewRun *run, int condition_id, Arena *arena,
                      ConditionFound *out, Error *err) {
    uint64_t answers, all = reader->left;
    unsigned char *bytes = all < BODY_BYTES ? arena_try(arena, 1, 8, (size_t)all) : NULL;
    if (!bytes) return kept_damaged(reader, err, "its body takes more memory than there is");
    if (!kept_take(reader, bytes, (size_t)all, err)) return false;
    bool is_head = all >= sizeof answers;
    if (is_head) memcpy(&answers, bytes, sizeof answers);
    if (is_head && answers <= all - sizeof answers) {
        PackBytes of_answers = {bytes + sizeof answers, bytes + sizeof answers + answers};
        PackBytes of_sights = {of_answers.end, bytes + all};
        out->answers = of_answers.at;
        out->answer_bytes = (size_t)answers;
        if (take_answers(&of_answers, run, condition_id, arena, out) &&
            take_sights(&of_sights, &out->own.review, arena))
            return true;
    }
    return kept_damaged(reader, err, "its rows cannot be of condition '%.100s'",
                        run->request->conditions[condition_id].name);
}

bool condition_read(const ReviewRun *run, int condition_id, const char *path, Arena *arena,
                    ConditionFound *out, Error *err) {
    KeptReader reader;
    *out = (ConditionFound){.path = path};
    if (!kept_open(&format, path, NULL, arena, &reader, err)) return false;
    out->identity = reader.identity;
    bool ok = take_body(&reader, run, condition_id, arena, out, err);
    kept_close(&reader);
    return ok;
}

/* ---- its files --------------------------------------------------------------------------- */

static bool stands(const ReviewFile *file, Arena scratch) {
    FileBytes bytes;
    Error ignored;
    if (!file_read(file->path, FILE_BYTES, &scratch, &bytes, &ignored)) return false;
    const char *hash =
        arena_format(&scratch, "%016llx", (unsigned long long)XXH3_64bits(bytes.data, bytes.size));
    return !strcmp(hash, file->xxh3);
}

bool condition_is_reusable(const ConditionFound *found, const char *identity, Arena scratch) {
    if (strcmp(condition_identity_without(found->identity, "word", &scratch),
               condition_identity_without(identity, "word", &scratch)) != 0)
        return false;
    for (int v = -1; v < found->variant_count; v++) {
        const Review *review = v < 0 ? &found->own.review : &found->variants[v];
        for (int i = 0; i < review->input_count; i++)
            if (!stands(&review->inputs[i], scratch)) return false;
    }
    return true;
}
