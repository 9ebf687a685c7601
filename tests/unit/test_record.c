/* SPDX-License-Identifier: Apache-2.0 */
/* Every key of every format that is read by rows: misspelt, missing, null, of another kind, out
 * of range. Each fault is found where it is, and the nearest key is named. */
#include "json_fixture.h"

#include <math.h>

#include "base/count.h"
#include "base/file.h"
#include "cli/format_table.h"
#include "text/removed.h"

/* A file of each format, in the order of the table. */
static const char *const EXAMPLES[] = {PROJECT_DIR "/assets/profiles/iso-15008.json",
                                       PROJECT_DIR "/tests/unit/records/equip.json",
                                       PROJECT_DIR "/tests/unit/records/review.json",
                                       PROJECT_DIR "/tests/unit/records/import.json",
                                       PROJECT_DIR "/tests/unit/records/measurement_set.json",
                                       PROJECT_DIR "/assets/panels/oled_centre.recipe.json"};

typedef struct Faults {
    const RecordFormat *format;
    const char *file; /* what it names lies beside it */
    json_t *document; /* the whole, good */
    const char *path; /* of the object that the rows are of */
    json_t *object;   /* in the document */
    int tried;
} Faults;

/* Reads what the document is now. */
static bool reads(const Faults *f, Error *err) {
    Arena arena = *test_memory();
    Problems problems = problems_start(&arena);
    JsonView view = {
        .object = f->document, .file = f->file, .path = "", .arena = &arena, .problems = &problems};
    void *item = arena_alloc(&arena, 1, _Alignof(max_align_t), f->format->size);
    if (f->format->start) f->format->start(item);
    return record_read(&view, f->format, item, err);
}

static void expect(Faults *f, const char *place, const char *word) {
    Error found = {0};
    f->tried++;
    if (reads(f, &found)) fail_msg("%s: taken, \"%s\" expected", place, word);
    if (strcmp(found.path, place) != 0 || !strstr(found.text, word))
        fail_msg("%s: %s, expected %s: %s", found.path, found.text, place, word);
}

/* With a value in the place of a key's own; then it is as it was. */
static void try_value(Faults *f, const RecordRow *row, json_t *value, const char *word) {
    json_t *before = json_incref(json_object_get(f->object, row->key));
    char place[256];
    snprintf(place, sizeof place, "%s/%s", f->path, row->key);
    json_object_set_new(f->object, row->key, value);
    expect(f, place, word);
    if (before) json_object_set_new(f->object, row->key, before);
    else json_object_del(f->object, row->key);
}

static void try_names(Faults *f, const RecordRow *row) {
    json_t *value = json_incref(json_object_get(f->object, row->key));
    char wrong[128], place[512], word[160];
    snprintf(wrong, sizeof wrong, "%sx", row->key);
    snprintf(place, sizeof place, "%s/%s", f->path, wrong);
    snprintf(word, sizeof word, "the nearest known one is '%s'", row->key);
    json_object_set_new(f->object, wrong, json_null());
    json_object_del(f->object, row->key);
    expect(f, place, word);
    json_object_del(f->object, wrong);
    snprintf(word, sizeof word, "key '%s' is missing", row->key);
    if (row->flags & RECORD_REQUIRED) expect(f, f->path, word);
    if (value) json_object_set_new(f->object, row->key, value);
}

static json_t *of_another_kind(const RecordRow *row) {
    bool is_text = row->kind == RECORD_TEXT || row->kind == RECORD_CHOICE ||
                   row->kind == RECORD_WORD || row->kind == RECORD_OWN ||
                   row->kind == RECORD_NOTE || row->kind == RECORD_FILE ||
                   row->kind == RECORD_REFER || row->kind == RECORD_PATH ||
                   (row->kind == RECORD_CONST && row->words);
    bool takes_number =
        row->schema && (strstr(row->schema, "number") || strstr(row->schema, "integer"));
    for (const RecordRow *form = row->forms; form && form->key; form++)
        if (form->kind == RECORD_FLAG) return json_integer(7);
    if (row->kind == RECORD_EITHER) return json_true();
    if (takes_number) return json_object();
    return is_text ? json_integer(7) : json_string("seven");
}

static void try_ranges(Faults *f, const RecordRow *row) {
    bool is_list =
        row->kind == RECORD_NUMBERS || row->kind == RECORD_FIGURES || row->kind == RECORD_WHOLES;
    if (!is_list && row->kind != RECORD_NUMBER && row->kind != RECORD_INTEGER) return;
    const double outside[] = {row->low - 1, row->high + fmax(1, 1e-6 * row->high)};
    for (int i = 0; i < COUNT_OF(outside); i++) {
        json_t *value = json_real(outside[i]);
        if (is_list) {
            json_t *list = json_array();
            for (int k = 0; k < row->least || !k; k++) json_array_append(list, value);
            json_decref(value);
            value = list;
        }
        if (isfinite(outside[i])) try_value(f, row, value, row->read ? "" : "a number");
        else json_decref(value);
    }
    if (is_list && row->most) {
        json_t *list = json_array();
        for (int k = 0; k <= row->most; k++) json_array_append_new(list, json_real(row->low));
        try_value(f, row, list, row->read ? "" : "values");
    }
}

static void try_rows(Faults *f, const RecordFormat *format);

/* What is in an object at a place. */
static void try_object(Faults *f, const RecordFormat *format, const char *place, json_t *object) {
    Faults within = *f;
    char path[256];
    snprintf(path, sizeof path, "%s/%s", f->path, place);
    within.object = object;
    within.path = path;
    try_rows(&within, format);
    f->tried = within.tried;
}

static void try_single(Faults *f, const RecordRow *row) {
    bool is_own = row->kind == RECORD_OWN || row->read;
    if (row->schema && !strcmp(row->schema, "{}")) return; /* anything will do */
    if (!row->schema || !strstr(row->schema, "null"))
        try_value(f, row, json_null(), is_own ? "" : "is null");
    try_value(f, row, of_another_kind(row),
              is_own                       ? ""
              : row->kind == RECORD_EITHER ? "required: "
                                           : "is a");
    try_ranges(f, row);
}

/* An item of a list or of a map. */
static void try_item(Faults *f, const RecordRow *row, const char *name, json_t *item) {
    char place[256];
    snprintf(place, sizeof place, "%s/%s", row->key, name);
    if (!row->of->value) {
        try_object(f, row->of, place, item);
    } else if (row->kind == RECORD_MAP) {
        Faults within = *f;
        char path[256];
        RecordRow value = *row->of->value;
        snprintf(path, sizeof path, "%s/%s", f->path, row->key);
        within.path = path;
        within.object = json_object_get(f->object, row->key);
        value.key = name;
        try_single(&within, &value);
        if (value.kind == RECORD_OBJECT) try_object(&within, value.of, name, item);
        f->tried = within.tried;
    }
}

static bool has_required(const RecordFormat *format, const json_t *object) {
    for (const RecordRow *row = format->rows; row->key; row++)
        if (row->flags & RECORD_REQUIRED && !json_object_get(object, row->key)) return false;
    return true;
}

static void try_inside(Faults *f, const RecordRow *row) {
    json_t *inside = json_object_get(f->object, row->key), *item;
    const char *name;
    char place[24];
    size_t i;
    if (!inside) return;
    if (row->kind == RECORD_OBJECT) try_object(f, row->of, row->key, inside);
    if (row->kind == RECORD_MAP)
        json_object_foreach(inside, name, item) try_item(f, row, name, item);
    if (row->kind == RECORD_LIST) json_array_foreach(inside, i, item) {
            snprintf(place, sizeof place, "%zu", i);
            try_item(f, row, place, item);
        }
    for (const RecordRow *form = row->forms; form && form->key; form++)
        if (form->kind == RECORD_OBJECT && json_is_object(inside) && has_required(form->of, inside))
            try_object(f, form->of, row->key, inside);
}

enum { REMOVED_MAX = 256 };
static int removed_tried[REMOVED_MAX]; /* of each row of removed_words */

/* Keys of before: refused with what to do instead. */
static void try_removed(Faults *f, const RecordFormat *format) {
    for (int i = 0; removed_words[i].word; i++) {
        const RemovedWord *row = &removed_words[i];
        char place[512];
        if (!format->name || strcmp(row->where, format->name) != 0) continue;
        snprintf(place, sizeof place, "%s/%s", f->path, row->word);
        json_object_set_new(f->object, row->word, json_null());
        expect(f, place, row->instead);
        json_object_del(f->object, row->word);
        assert_true(i < REMOVED_MAX);
        removed_tried[i]++;
    }
}

/* Of a format; those of glTF's extensions are tried in test_scene_errors. */
static bool is_key(const RemovedWord *row) {
    return strncmp(row->where, "PARHELION_", 10) != 0 && row->word[0] != '-' &&
           row->where[0] != '-' && strcmp(row->where, "parhelion") != 0 &&
           strcmp(row->where, "panel") != 0;
}

static void try_rows(Faults *f, const RecordFormat *format) {
    if (!format->takes_more) try_removed(f, format);
    for (const RecordRow *row = format->rows; row->key; row++) {
        try_names(f, row);
        try_single(f, row);
        try_inside(f, row);
    }
}

TEST(every_fault_of_every_key_is_found_where_it_is) {
    assert_int_equal(format_count, COUNT_OF(EXAMPLES));
    for (int i = 0; i < format_count; i++) {
        json_t *document = json_load_file(EXAMPLES[i], 0, NULL);
        Error none = {0};
        Faults faults = {format_table[i].format, EXAMPLES[i], document, "", document, 0};
        assert_non_null(document);
        if (!reads(&faults, &none)) fail_msg("%s: %s", none.path, none.text);
        try_rows(&faults, faults.format);
        if (!reads(&faults, &none)) fail_msg("the example changed: %s", none.text);
        print_message("%s: %d faults\n", format_table[i].name, faults.tried);
        json_decref(document);
    }
    for (int i = 0; removed_words[i].word; i++)
        if (is_key(&removed_words[i]) && !removed_tried[i])
            fail_msg("removed key %s of %s: no example has that object", removed_words[i].word,
                     removed_words[i].where);
}

TEST_PROGRAM(make_folder, clear_folder)
