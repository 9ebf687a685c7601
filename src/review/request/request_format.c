/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_format.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"

#define INPUT_BYTES_MAX ((size_t)1 << 30)

/* ---- names ------------------------------------------------------------------------------- */

#define OWNER ReviewRequest
#define NAMES(key, one, member, counted, Type) \
    {key, one, offsetof(OWNER, member), offsetof(OWNER, counted), sizeof(Type)}

const RecordNames review_eye_names = NAMES("eyes", "eye", eyes, eye_count, ReviewEye);
const RecordNames review_with_names = NAMES("with", "with", withs, with_count, ReviewWith);
const RecordNames review_symbol_names =
    NAMES("symbols", "symbol", symbols, symbol_count, ReviewSymbol);
const RecordNames review_level_names = NAMES("levels", "level", levels, level_count, ReviewLevel);

static const RecordRow CONTENT = {.kind = RECORD_FILE, RECORD_AT(ReviewContent, path)};
const RecordFormat review_content_format = {"content", sizeof(ReviewContent), .value = &CONTENT};

/* ---- words for all or by name ------------------------------------------------------------ */

bool request_read_words(const JsonView *view, const RecordRow *row, int *out, Error *err) {
    WordsSaid said = {.all = -1};
    const char **names;
    int count = record_names(view, row->forms[1].among, &names);
    if (!record_read_kind(view, row, &said, err)) return false;
    for (int i = 0; i < count; i++) {
        if (said.all >= 0) out[i] = said.all;
        for (int k = 0; k < said.count; k++)
            if (!strcmp(said.by_name[k].name, names[i])) out[i] = said.by_name[k].word;
    }
    return true;
}

/* ---- files that are read ----------------------------------------------------------------- */

void request_note_input(const JsonView *view, const char *path, uint64_t hash) {
    ReviewRequest *request = view->whole;
    int count = request->input_count;
    for (int i = 0; i < count; i++)
        if (!strcmp(request->inputs[i].path, path)) return;
    if (!(count & (count - 1))) /* full: it doubles */
        request->inputs =
            ARENA_GROW(view->arena, ReviewInput, request->inputs, count, count ? 2 * count : 1);
    const char *kept = arena_string(view->arena, path, strlen(path));
    request->inputs[request->input_count++] = (ReviewInput){kept, hash};
}

bool request_note_file(const JsonView *view, const char *path, Error *err) {
    FileBytes bytes;
    Arena scratch = *view->arena;
    if (!file_read(path, INPUT_BYTES_MAX, &scratch, &bytes, err)) return false;
    request_note_input(view, path, XXH3_64bits(bytes.data, bytes.size));
    return true;
}
