/* SPDX-License-Identifier: Apache-2.0 */
/* Nothing is held but an arena and, while no memory is taken, an open file: where memory runs
 * out, the jump back releases all. */
#include "library/open_panel.h"

#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include "base/file.h"
#include "panel/query/panel_open.h"

#define ARENA_BYTES ((size_t)4 << 30)

static const char *name_of(const PanelSource *from) {
    return from->path ? from->path : "memory";
}

static bool read_bytes(const PanelSource *from, Arena *arena, FileBytes *out, Error *err) {
    if (from->path) return file_read(from->path, PANEL_FILE_BYTES_MAX, arena, out, err);
    if (from->size > PANEL_FILE_BYTES_MAX)
        return error_at(err, ERROR_INPUT, name_of(from), "", "has %zu bytes, at most %zu are read",
                        from->size, PANEL_FILE_BYTES_MAX);
    unsigned char *copy = arena_alloc(arena, 1, 8, from->size + 1);
    if (from->size) memcpy(copy, from->bytes, from->size);
    *out = (FileBytes){copy, from->size};
    return true;
}

static bool open_here(const PanelSource *from, size_t room, OpenedPanel *out, Error *err) {
    Arena *arena = &out->arena;
    FileBytes bytes;
    Panel *panel;
    if (!read_bytes(from, arena, &bytes, err) ||
        !panel_open_memory(bytes.data, bytes.size, name_of(from), arena, &panel, err))
        return false;
    out->panel = panel;
    out->room = arena_alloc(arena, 1, 64, room);
    return emission_draw_make(panel, arena, &out->draw, err) ||
           error_prefix(err, "directions of the emission") || error_in_file(err, name_of(from));
}

static bool lacks_memory(const PanelSource *from, const Arena *arena, Error *err) {
    return error_at(err, ERROR_MEMORY, name_of(from), "",
                    "is out of memory: more than %zu bytes required to open it",
                    (size_t)(arena->end - arena->begin));
}

static bool open_or_jump(const PanelSource *from, size_t room, OpenedPanel *out, Error *err) {
    jmp_buf way_out;
    if (setjmp(way_out)) return lacks_memory(from, &out->arena, err);
    out->arena.way_out = &way_out;
    return open_here(from, room, out, err);
}

bool open_panel(const PanelSource *from, size_t room, OpenedPanel *out, Error *err) {
    *out = (OpenedPanel){.panel = NULL};
    if (!arena_try_reserve(ARENA_BYTES, &out->arena)) return lacks_memory(from, &out->arena, err);
    bool is_open = open_or_jump(from, room, out, err);
    out->arena.way_out = NULL;
    if (is_open) arena_trim(&out->arena);
    else arena_release(&out->arena);
    return is_open;
}
