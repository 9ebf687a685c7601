/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/condition_file.h"

#include <stdlib.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/file.h"
#include "keep/kept.h"
#include "render/identity.h"
#include "review/output/json_rows.h"
#include "review/output/review_json.h"
#include "review/review_decide.h"
#include "text/base64.h"

#define FILE_BYTES ((size_t)1 << 34)
#define DIGITS 17 /* distinguish any two doubles */

static const KeptFormat format = {"PRHLCOND", "a reviewed condition", 3, 0};

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

/* ---- its rows ---------------------------------------------------------------------------- */

enum { STEP_FIGURES = 8, STEP_BYTES = STEP_FIGURES * sizeof(float) + 1 };

static float **step_figure(SunFigures *f, int k) {
    float **lists[STEP_FIGURES] = {&f->contrast,  &f->low,    &f->high,  &f->margin,
                                   &f->reflected, &f->mirror, &f->level, &f->lux};
    return lists[k];
}

/* One text, since a sweep has many: lists of floats, then the verdicts. */
static json_t *write_steps(const void *item) {
    const SweepTable *table = item;
    SunFigures figures = table->figures;
    Arena room = arena_reserve(FILE_BYTES);
    size_t count = (size_t)table->suns->count;
    Text bytes = {.arena = &room};
    for (int k = 0; k < STEP_FIGURES; k++)
        text_add_bytes(&bytes, *step_figure(&figures, k), count * sizeof(float));
    text_add_bytes(&bytes, figures.verdict, count);
    Text digits = {.arena = &room};
    base64_encode(&digits, bytes.data, bytes.size);
    json_t *text = json_stringn(digits.data, digits.size);
    arena_release(&room);
    return text;
}

/* Of so many suns as the request's condition has. */
static bool read_steps(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    SweepTable *table = item;
    const ConditionFound *found = view->whole;
    const json_t *text = json_object_get(view->object, row->key);
    size_t size = 0, length = json_string_length(text), count = (size_t)found->suns->count;
    float *lists = ARENA_NEW(view->arena, float, length / sizeof(float) + 1);
    unsigned char *bytes = (void *)lists;
    Error why;
    if (!base64_decode(json_string_value(text), length, bytes, &size, &why) ||
        size != count * STEP_BYTES)
        return record_fails(view, row->key, err, "is no list of %zu steps, which are required",
                            count);
    table->suns = found->suns;
    for (int k = 0; k < STEP_FIGURES; k++)
        *step_figure(&table->figures, k) = lists + (size_t)k * count;
    table->figures.verdict = bytes + STEP_FIGURES * sizeof(float) * count;
    for (size_t i = 0; i < count; i++)
        if (table->figures.verdict[i] > VERDICT_UNJUDGED)
            return record_fails(view, row->key, err, "has a verdict that there is none");
    return true;
}

/* The worst sun lies near one of the steps. */
static bool check_table(const JsonView *view, void *item, Error *err) {
    const SweepTable *table = item;
    const ConditionFound *found = view->whole;
    const SweepSuns *suns = found->suns;
    const SweepSun *worst = &table->worst_sun;
    bool is_near = false;
    for (int i = 0; i < suns->count && !is_near; i++)
        is_near =
            suns->list[i].step == worst->step && suns->list[i].heading_id == worst->heading_id;
    return (is_near && table->figures.worst < suns->count && table->sweep_id >= 0 &&
            table->sweep_id < found->own.review.sweep_count) ||
           error_at(err, ERROR_INPUT, view->file, view->path, "is of suns that it has not");
}

TABLE(sun_rows, SweepSun, OWN(FIGURE, SweepSun, azimuth_deg), OWN(FIGURE, SweepSun, elevation_deg),
      OWN(FIGURE, SweepSun, compass_deg), OWN(FIGURE, SweepSun, heading_deg),
      OWN(FIGURE, SweepSun, minutes), OWN(INT, SweepSun, step), OWN(INT, SweepSun, heading_id),
      OWN(FIGURE, SweepSun, later_minutes), OWN(FIGURE, SweepSun, light));

static const RecordRow table_members[] = {
    OWN(INT, SweepTable, sweep_id),
    AS("worst", INT, SweepTable, figures.worst),
    AS("is_private", FLAG, SweepTable, figures.is_private),
    PART("worst_sun", MUST, SweepTable, worst_sun, sun_rows),
    {"steps", RECORD_OWN, MUST | RECORD_KEPT, .read = read_steps, .write = write_steps},
    {0}};
static const RecordFormat table_rows = {"table", sizeof(SweepTable), table_members,
                                        .check = check_table, .takes_more = true};

TABLE(found_rows, ConditionFound, PART("review", MUST, ConditionFound, own.review, review_rows),
      LIST("tables", MUST, ConditionFound, own.tables, own.table_count, table_rows),
      LIST("variants", MUST, ConditionFound, variants, variant_count, review_rows));

bool condition_write(const ConditionFound *found, const char *path, const char *identity,
                     Arena scratch, Error *err) {
    json_t *document = record_keep(&found_rows, found);
    char *body = json_dumps(document, JSON_COMPACT | JSON_REAL_PRECISION(DIGITS));
    json_decref(document);
    if (!body) return error_set(err, ERROR_MEMORY, "out of memory for %s", path);
    const KeptFile file = {&format, path, identity, "", strlen(body)};
    bool ok = kept_write(&file, body, scratch, err);
    free(body);
    return ok;
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Closed by json_view_close. */
static bool open_rows(const char *path, Arena *arena, const char **identity, JsonView *out,
                      Error *err) {
    KeptReader reader;
    if (!kept_open(&format, path, NULL, arena, &reader, err)) return false;
    size_t size = (size_t)reader.left;
    unsigned char *bytes = arena_try(arena, 1, 1, size);
    bool ok = bytes ? kept_take(&reader, bytes, size, err)
                    : kept_damaged(&reader, err, "its body takes more memory than there is");
    *identity = reader.identity;
    kept_close(&reader);
    if (!ok || !json_view_parse(path, (FileBytes){bytes, size}, arena, out, err)) return false;
    out->is_kept = true;
    return true;
}

/* Frames are made by these names. */
static bool case_is_sound(const ReviewRequest *request, int condition_id, const ReviewCase *c) {
    return c->condition && !strcmp(c->condition, request->conditions[condition_id].name) &&
           c->eye && review_eye_named(request, c->eye) && c->symbol &&
           c->limit_id < c->limit_count && (c->view || !c->frame);
}

static bool is_sound(const ReviewRequest *request, int condition_id, const Review *review) {
    for (int i = 0; i < review_case_count(review); i++)
        if (!case_is_sound(request, condition_id, review_case_at(review, i))) return false;
    for (int i = 0; i < review->sweep_count; i++) {
        const ReviewSweep *sweep = &review->sweeps[i];
        if (!sweep->condition || !sweep->eye || !sweep->symbol) return false;
    }
    for (int i = 0; i < review->response_count; i++)
        if (!review->responses[i].file) return false;
    for (int i = 0; i < review->input_count; i++)
        if (!review->inputs[i].path || !review->inputs[i].xxh3) return false;
    return true;
}

static bool are_sound(const ReviewRequest *request, int condition_id, const ConditionFound *found,
                      Error *err) {
    bool ok = found->variant_count == request->variant_count &&
              is_sound(request, condition_id, &found->own.review);
    for (int i = 0; i < found->variant_count && ok; i++)
        ok = is_sound(request, condition_id, &found->variants[i]);
    return ok || error_at(err, ERROR_INPUT, found->path, "",
                          "is damaged: its rows cannot be of condition '%.100s'",
                          request->conditions[condition_id].name);
}

bool condition_read(const ReviewRun *run, int condition_id, const char *path, Arena *arena,
                    ConditionFound *out, Error *err) {
    const ReviewCondition *condition = &run->request->conditions[condition_id];
    JsonView view;
    *out = (ConditionFound){.path = path};
    SweepSuns *suns = ARENA_NEW(arena, SweepSuns, 1);
    if (!open_rows(path, arena, &out->identity, &view, err)) return false;
    if (condition->kind != CONDITION_MOMENT)
        *suns = sweep_suns(condition, run->means.threads, arena);
    out->suns = suns;
    bool ok = record_read(&view, &found_rows, out, err);
    json_view_close(&view);
    out->own.responses_kept = out->own.review.response_count;
    return ok && are_sound(run->request, condition_id, out, err);
}

/* What a folder names, and the pictures that it has, is another's of the same condition. */
static void forget_folder(json_t *value) {
    static const char *const OWN_KEYS[] = {"frame", "view", "rim", "table"};
    const char *key;
    json_t *item;
    size_t i;
    for (int k = 0; k < COUNT_OF(OWN_KEYS); k++) json_object_del(value, OWN_KEYS[k]);
    json_object_foreach(value, key, item) forget_folder(item);
    json_array_foreach(value, i, item) forget_folder(item);
}

bool condition_same_answers(const char *one, const char *other, Arena scratch, bool *out,
                            Error *err) {
    JsonView a, b;
    const char *identity;
    if (!open_rows(one, &scratch, &identity, &a, err)) return false;
    bool ok = open_rows(other, &scratch, &identity, &b, err);
    if (ok) {
        forget_folder(a.object);
        forget_folder(b.object);
        *out = json_equal(a.object, b.object);
        json_view_close(&b);
    }
    json_view_close(&a);
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
