/* SPDX-License-Identifier: Apache-2.0 */
#include "record/rows.h"
#include "review/request/request_format.h"

/* ---- words for all or by name ------------------------------------------------------------ */

#define OWNER WordsSaid
#define WORDS_ROWS(list, by, names, format) \
    CHOICE("a word", 0, all, list, NULL), \
        {by,         RECORD_MAP,      RECORD_MANY(OWNER, by_name, count), \
         .least = 1, .among = &names, .of = &format}, \
        {0}

static const char *const POLARITIES[] = {[POLARITY_AUTO] = "auto",
                                         [POLARITY_LIGHT_ON_DARK] = "light-on-dark",
                                         [POLARITY_DARK_ON_LIGHT] = "dark-on-light",
                                         NULL};
static const char *const VISIBLE[] = {"required", "optional", NULL};

static const RecordRow POLARITY = {
    .kind = RECORD_CHOICE, RECORD_AT(WordOf, word), .words = POLARITIES};
static const RecordFormat polarity_format = {"polarity", sizeof(WordOf), .value = &POLARITY};
const RecordRow review_polarity_forms[] = {
    WORDS_ROWS(POLARITIES, "words by symbols' names", review_symbol_names, polarity_format)};

static const RecordRow IS_VISIBLE = {
    .kind = RECORD_CHOICE, RECORD_AT(WordOf, word), .words = VISIBLE};
static const RecordFormat visible_format = {"visible", sizeof(WordOf), .value = &IS_VISIBLE};
static const RecordRow VISIBLE_FORMS[] = {
    WORDS_ROWS(VISIBLE, "words by eyes' names", review_eye_names, visible_format)};

#undef OWNER

/* ---- symbols ----------------------------------------------------------------------------- */

static bool read_visible(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    int *optional = ARENA_NEW(view->arena, int, ((ReviewRequest *)view->whole)->eye_count);
    ((ReviewSymbol *)item)->optional_for = optional;
    return request_read_words(view, row, optional, err);
}

typedef struct Forbidden {
    bool for_all;
    const int *eyes;
    int count;
} Forbidden;

static const RecordRow READER = {.kind = RECORD_REFER, .among = &review_eye_names};
static const RecordFormat reader_format = {"reader", sizeof(int), .value = &READER};
static const RecordRow FORBIDDEN[] = {
    {"true", RECORD_FLAG, RECORD_AT(Forbidden, for_all), .doc = "For every eye."},
    {"eyes' names", RECORD_LIST, RECORD_MANY(Forbidden, eyes, count), RECORD_COUNT(1, 256),
     .of = &reader_format, .doc = "For these."},
    {0}};

static bool read_forbidden(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    Forbidden said = {.for_all = false};
    int eyes = ((ReviewRequest *)view->whole)->eye_count;
    bool *private_for = ARENA_NEW(view->arena, bool, eyes);
    if (!record_read_kind(view, row, &said, err)) return false;
    for (int i = 0; i < eyes; i++) private_for[i] = said.for_all;
    for (int i = 0; i < said.count; i++) private_for[said.eyes[i]] = true;
    ((ReviewSymbol *)item)->private_for = private_for;
    return true;
}

static const RecordRow OTHER = {.kind = RECORD_REFER, .among = &review_symbol_names};
static const RecordFormat other_format = {"other", sizeof(int), .value = &OTHER};

static const char *const FOUND[] = {"text", NULL};

#define OWNER ReviewSymbol

static const RecordRow SYMBOL[] = {
    TEXT("display", MUST | RECORD_FILLED, display,
         "A material's name, or node:NAME where several nodes wear one."),
    A_FILE("content", 0, content, "What the display shows; default: what it shows in the scene."),
    A_FILE("mask", 0, mask, "A picture of the content's size: white is the foreground."),
    VECTOR("uv", 0, uv, 4, 0, 1, "Left, top, right, bottom of the content, v down."),
    CHOICE("polarity", 0, polarity, POLARITIES, NULL),
    {"find", RECORD_CONST, .words = FOUND,
     .doc = "Symbols are proposed from what stands in the rectangle, or on all of the "
            "content."},
    {"visible", RECORD_EITHER, .forms = VISIBLE_FORMS, .read = read_visible,
     .doc = "Whether it must be seen. What is optional and hidden does not count; what is seen "
            "of it is judged."},
    {"must_not_be_read", RECORD_EITHER, .forms = FORBIDDEN, .read = read_forbidden,
     .doc = "No eye, or none of these, may be able to read it: the verdict is of that."},
    {"distinct_from", RECORD_LIST, RECORD_MANY(OWNER, distinct_from, distinct_count),
     RECORD_COUNT(1, 1000), .of = &other_format,
     .doc = "Symbols that its colour must not be taken for: as the eye sees them, in the same "
            "light."},
    {0}};

static void start_symbol(void *item) {
    *(ReviewSymbol *)item = (ReviewSymbol){.uv = {0, 0, 1, 1}};
}

static bool check_symbol(const JsonView *view, void *item, Error *err) {
    ReviewSymbol *symbol = item;
    const double *uv = symbol->uv;
    int own = (int)(symbol - ((const ReviewRequest *)view->whole)->symbols);
    symbol->has_uv = record_has(view, "uv");
    symbol->find_text = record_has(view, "find");
    if (!(uv[0] < uv[2] && uv[1] < uv[3]))
        return record_fails(view, "uv", err,
                            "is [%g, %g, %g, %g], required: [left, top, right, bottom] with "
                            "left below right and top below bottom",
                            uv[0], uv[1], uv[2], uv[3]);
    for (int i = 0; i < symbol->distinct_count; i++)
        if (symbol->distinct_from[i] == own)
            return record_fails(view, "distinct_from", err,
                                "names the symbol itself, required: other symbols");
    if (symbol->find_text && symbol->mask)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has both 'find' and 'mask', required: one of them");
    return symbol->find_text || symbol->mask || symbol->has_uv ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "says no place on its display, required: 'uv', 'mask' or 'find'");
}

const RecordFormat review_symbol_format = {
    "symbol",
    sizeof(OWNER),
    SYMBOL,
    .start = start_symbol,
    .check = check_symbol,
    .rules = "{'anyOf': [{'required': ['uv']}, {'required': ['mask']}, "
             "{'required': ['find']}], 'not': {'required': ['mask', 'find']}}"};

/* ---- files by name ----------------------------------------------------------------------- */

static const RecordRow WITH = {.kind = RECORD_LIST,
                               RECORD_MANY(ReviewWith, paths, path_count),
                               RECORD_COUNT(1, 256),
                               .of = &record_files,
                               .doc = "Files of the scene."};
const RecordFormat review_with_format = {"with", sizeof(ReviewWith), .value = &WITH};
