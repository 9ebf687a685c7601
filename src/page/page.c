/* SPDX-License-Identifier: Apache-2.0 */
#include "page/page.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/file.h"
#include "base/file_write.h"
#include "text/base64.h"
#include "text/json_text.h"

#define PAGE_BYTES ((size_t)16 << 30) /* address space for the text */
#define WORDS_BYTES ((size_t)1 << 24) /* and for one format's words */
#define STYLE_BYTES ((size_t)1 << 20)

/* ---- values ------------------------------------------------------------------------------ */

void page_set(json_t *values, const char *name, const char *text) {
    json_object_set_new(values, name, json_text_or_null(text));
}

void page_set_flag(json_t *values, const char *name, bool is_set) {
    json_object_set_new(values, name, json_boolean(is_set));
}

void page_set_count(json_t *values, const char *name, long count) {
    json_object_set_new(values, name, json_integer(count));
}

json_t *page_add(json_t *list) {
    json_t *object = json_object();
    json_array_append_new(list, object);
    return object;
}

/* A style ends where HTML says so, whatever stands around that. */
static bool set_style(json_t *values, const char *path, Error *err) {
    FileBytes bytes;
    Arena own = arena_reserve(2 * STYLE_BYTES);
    bool ok = file_read(path, STYLE_BYTES, &own, &bytes, err);
    if (ok && strstr((const char *)bytes.data, "</"))
        ok = error_at(err, ERROR_INPUT, path, "", "has \"</\" in it, required: CSS alone");
    if (ok) page_set(values, "style", (const char *)bytes.data);
    else error_prefix(err, "$%s", PAGE_STYLE_VARIABLE);
    arena_release(&own);
    return ok;
}

bool page_set_head(json_t *values, const char *title, const char *command, Error *err) {
    const char *style = getenv(PAGE_STYLE_VARIABLE);
    page_set(values, "window", title);
    page_set(values, "command", command);
    page_set(values, "style", NULL);
    page_set(values, "version", PARHELION_VERSION);
    return !style || !*style || set_style(values, style, err);
}

/* ---- files ------------------------------------------------------------------------------- */

bool page_write(const Text *const *parts, int count, const char *path, Error *err) {
    FileWriter writer;
    if (!file_writer_open(path, &writer, err)) return false;
    for (int i = 0; i < count; i++)
        if (!file_writer_add(&writer, parts[i]->data, parts[i]->size, err)) return false;
    return file_writer_commit(&writer, err);
}

bool page_write_values(const char *page, json_t *values, const PageFormat *formats,
                       const char *path, Error *err) {
    Arena own = arena_reserve(PAGE_BYTES), scratch = arena_reserve(WORDS_BYTES);
    Text text = {.arena = &own};
    bool ok =
        page_render(&text, page, values, formats, scratch, err) && text_write(&text, path, err);
    json_decref(values);
    arena_release(&scratch);
    arena_release(&own);
    return ok;
}

/* ---- pictures ---------------------------------------------------------------------------- */

json_t *page_bytes(const char *kind, const void *bytes, size_t size, Arena scratch) {
    Text text = {.arena = &scratch};
    text_format(&text, "data:image/%s;base64,", kind);
    base64_encode(&text, bytes, size);
    return json_stringn_nocheck(text.data, text.size);
}

json_t *page_picture(const Picture *picture, bool is_jpeg, Arena scratch, Error *err) {
    FileBytes bytes;
    const char *kind = "png";
    PictureFile file = {.bits = 8, .is_srgb = true};
    if (is_jpeg ? picture_encode_small(picture, &scratch, &bytes, &kind, err)
                : picture_encode("a.png", picture, file, &scratch, &bytes, err))
        return page_bytes(kind, bytes.data, bytes.size, scratch);
    error_prefix(err, "a picture of the report");
    return NULL;
}

/* ---- numbers for the script ------------------------------------------------------------- */

#define LEVEL 9 /* pages are written once and read often */

const char *page_deflated(const void *bytes, size_t size, Arena *arena, Error *err) {
    Arena scratch = arena_reserve(PAGE_BYTES);
    uLong room = compressBound((uLong)size);
    unsigned char *packed = ARENA_NEW(&scratch, unsigned char, room);
    Text text = {.arena = arena};
    bool ok = compress2(packed, &room, bytes, (uLong)size, LEVEL) == Z_OK ||
              error_set(err, ERROR_MEMORY, "memory is out: numbers of the page");
    if (ok) base64_encode(&text, packed, room);
    arena_release(&scratch);
    return ok ? text.data : NULL;
}

const char *page_packed(const uint32_t *values, size_t count, int bytes, Arena *arena, Error *err) {
    Arena scratch = arena_reserve(PAGE_BYTES);
    size_t size = count * (size_t)bytes;
    unsigned char *planes = ARENA_NEW(&scratch, unsigned char, size);
    for (size_t at = 0; at < size; at++) {
        size_t i = at % count;
        unsigned shift = 8 * (unsigned)(at / count);
        uint32_t before = i > 0 ? values[i - 1] >> shift : 0;
        planes[at] = (unsigned char)((values[i] >> shift) - before);
    }
    const char *text = page_deflated(planes, size, arena, err);
    arena_release(&scratch);
    return text;
}
