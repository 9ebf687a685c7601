/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/panel_states.h"

#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"

/* A state's file as it was read: a whole panel without states. */
static bool read_state(const PanelStateFile *of, Arena *arena, FileBytes *out, Error *err)
{
    Panel *panel;
    int    state;
    Arena  scratch = arena_reserve(PANEL_FILE_BYTES_MAX * 2);
    bool   ok = file_read(of->path, PANEL_FILE_BYTES_MAX, arena, out, err) &&
              panel_open_memory(out->data, out->size, of->path, &scratch, &panel, err);
    if (ok && panel_info_states(panel, &state))
        ok = error_at(err, ERROR_INPUT, of->path, "", "has states already, required: a panel "
                      "file of one state");
    arena_release(&scratch);
    return ok;
}

static size_t rounded(size_t size)
{
    return (size + PANEL_ALIGN - 1) / PANEL_ALIGN * PANEL_ALIGN;
}

/* The first file's sections, moved behind a longer table of contents, then the states. */
static unsigned char *join(const PanelStateStored *names, const PanelStateBytes *states,
                           int count, Arena *arena, size_t *size)
{
    PanelHeader  header;
    PanelSection section[PANEL_SECTIONS_MAX + PANEL_STATES_MAX];
    memcpy(&header, states[0].file.data, sizeof header);
    size_t own = header.section_count;
    size_t old_front = rounded(sizeof header + own * sizeof *section);
    size_t front = rounded(sizeof header + (own + (size_t)count) * sizeof *section);
    size_t at = front + rounded(states[0].file.size - old_front);
    memcpy(section, states[0].file.data + sizeof header, own * sizeof *section);
    for (size_t i = 0; i < own; i++) section[i].offset += front - old_front;
    section[own] = (PanelSection){PANEL_STATES, 0, (uint32_t)count * sizeof *names, at};
    at += (size_t)count * sizeof *names;
    for (int i = 1; i < count; i++) {
        section[own + (size_t)i] = (PanelSection){PANEL_STATE_FILE, (uint16_t)i,
                                                  (uint32_t)states[i].file.size, at};
        at += rounded(states[i].file.size);
    }
    *size = at;
    if (at > PANEL_FILE_BYTES_MAX) return NULL;
    unsigned char *out = arena_alloc(arena, 1, 64, at);
    header.section_count = (uint32_t)own + (uint32_t)count;
    header.size = at;
    memcpy(out + sizeof header, section, header.section_count * sizeof *section);
    memcpy(out + front, states[0].file.data + old_front, states[0].file.size - old_front);
    memcpy(out + section[own].offset, names, (size_t)count * sizeof *names);
    for (int i = 1; i < count; i++)
        memcpy(out + section[own + (size_t)i].offset, states[i].file.data, states[i].file.size);
    memcpy(out, &header, sizeof header);
    size_t from = offsetof(PanelHeader, size);
    header.checksum = XXH3_64bits(out + from, at - from);
    memcpy(out, &header, sizeof header);
    return out;
}

bool panel_states_write(const PanelStateBytes *states, int count, const char *path,
                        Arena *arena, Error *err)
{
    PanelStateStored names[PANEL_STATES_MAX] = {{""}};
    size_t           size;
    PanelHeader      header;
    for (int i = 0; i < count; i++)
        strncpy(names[i].name, states[i].name, sizeof names[i].name - 1);
    memcpy(&header, states[0].file.data, sizeof header);
    if (header.section_count + (uint32_t)count > PANEL_SECTIONS_MAX)
        return error_at(err, ERROR_INPUT, path, "", "would have %u sections, required: %d "
                        "at most beside %d states", header.section_count,
                        PANEL_SECTIONS_MAX - count, count);
    unsigned char *bytes = join(names, states, count, arena, &size);
    if (!bytes)
        return error_at(err, ERROR_INPUT, path, "", "would have %zu bytes, required: %zu at "
                        "most", size, PANEL_FILE_BYTES_MAX);
    Panel *joined; /* a name that is none, or two that are one, show here */
    Arena  scratch = arena_reserve(PANEL_FILE_BYTES_MAX * 2);
    bool   ok = panel_open_memory(bytes, size, path, &scratch, &joined, err) &&
              file_write(path, bytes, size, err);
    arena_release(&scratch);
    return ok;
}

bool panel_states_join(const PanelStateFile *states, int count, const char *path, Arena *arena,
                       Error *err)
{
    PanelStateBytes read[PANEL_STATES_MAX];
    for (int i = 0; i < count; i++) {
        read[i].name = states[i].name;
        ARENA_NEW(arena, uint64_t, 0); /* the next bytes are aligned as a panel needs it */
        if (!read_state(&states[i], arena, &read[i].file, err)) return false;
    }
    return panel_states_write(read, count, path, arena, err);
}
