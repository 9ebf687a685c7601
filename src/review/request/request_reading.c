/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_reading.h"

#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "text/nearest_word.h"

#define INPUT_BYTES_MAX ((size_t)1 << 30)

void request_note_input(RequestReading *reading, const char *path, uint64_t hash)
{
    ReviewRequest *request = reading->request;
    for (int i = 0; i < request->input_count; i++)
        if (!strcmp(request->inputs[i].path, path)) return;
    if (request->input_count == reading->input_capacity) {
        reading->input_capacity = 2 * reading->input_capacity + 8;
        request->inputs = ARENA_GROW(reading->root.arena, ReviewInput, request->inputs,
                                     request->input_count, reading->input_capacity);
    }
    const char *kept = arena_string(reading->root.arena, path, strlen(path));
    request->inputs[request->input_count++] = (ReviewInput){kept, hash};
}

bool request_note_file(RequestReading *reading, const char *path, Error *err)
{
    FileBytes bytes;
    Arena     scratch = *reading->root.arena;
    if (!file_read(path, INPUT_BYTES_MAX, &scratch, &bytes, err)) return false;
    request_note_input(reading, path, XXH3_64bits(bytes.data, bytes.size));
    return true;
}

bool request_find_name(const JsonView *view, const char *key, FieldWords names,
                       const char *what, int *out, Error *err)
{
    const char *name = NULL;
    char        advice[256];
    if (!json_view_text(view, key, &name, err)) return false;
    if (!name) return true;
    for (int i = 0; i < names.count; i++)
        if (!strcmp(names.word[i], name)) {
            *out = i;
            return true;
        }
    if (!names.count)
        return field_fails(view, key, err, "is '%.60s', but the file has no '%s'", name, what);
    return field_fails(view, key, err, "is '%.60s', wanted a name of '%s': %s", name, what,
                       nearest_word_advice(name, names.word, names.count, advice,
                                           sizeof advice));
}
