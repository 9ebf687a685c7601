/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_section.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#define CHECKSUM_FROM offsetof(PanelHeader, size)

_Static_assert(sizeof(PanelHeader) == 40, "the file's layout");
_Static_assert(sizeof(PanelSection) == 16, "the file's layout");
_Static_assert(sizeof(float) == 4, "the file's layout");

bool panel_refuse(const PanelBytes *bytes, const char *place, const char *what) {
    return error_at(bytes->err, ERROR_INPUT, bytes->name, place,
                    "%s; the panel file is damaged, required: one that `panel fit` "
                    "wrote",
                    what);
}

bool panel_check_header(const PanelBytes *bytes, PanelHeader *header) {
    if (bytes->size < sizeof *header || memcmp(bytes->data, PANEL_MAGIC, 8))
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "",
                        "is no panel file, required: one that `panel fit` wrote");
    memcpy(header, bytes->data, sizeof *header);
    if (header->version != PANEL_VERSION || header->flags)
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "header",
                        "has version %u, required: %u: fit its measurement set or recipe again "
                        "(`panel fit` of this program)",
                        header->version, PANEL_VERSION);
    if (header->size != bytes->size)
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "header",
                        "has %zu bytes, required: %llu: the file is cut or grown", bytes->size,
                        (unsigned long long)header->size);
    if (XXH3_64bits(bytes->data + CHECKSUM_FROM, bytes->size - CHECKSUM_FROM) != header->checksum)
        return panel_refuse(bytes, "header", "the checksum does not fit the bytes");
    if (header->section_count > PANEL_SECTIONS_MAX)
        return panel_refuse(bytes, "header", "the section count is out of range");
    return true;
}

bool panel_find_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out, bool *found) {
    PanelHeader header;
    memcpy(&header, bytes->data, sizeof header);
    size_t toc = sizeof header + header.section_count * sizeof(PanelSection);
    *found = false;
    if (toc > bytes->size)
        return panel_refuse(bytes, "table of contents", "reaches beyond the end");
    for (uint32_t i = 0; i < header.section_count; i++) {
        PanelSection section;
        memcpy(&section, bytes->data + sizeof header + i * sizeof section, sizeof section);
        if (section.kind != (uint32_t)kind || section.index != index) continue;
        if (section.offset % PANEL_ALIGN || section.offset < toc || section.offset > bytes->size ||
            section.size > bytes->size - section.offset)
            return panel_refuse(bytes, "table of contents", "a section lies outside the file");
        *out = (PanelBytes){bytes->data + section.offset, section.size, bytes->name, bytes->err};
        *found = true;
        return true;
    }
    return true;
}

bool panel_need_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out) {
    bool found;
    if (!panel_find_section(bytes, kind, index, out, &found)) return false;
    return found || panel_refuse(bytes, "table of contents", "a section is missing");
}

bool panel_all_finite(const float *value, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(value[i]) < 1e30f)) return false;
    return true;
}

bool panel_rising(const float *value, uint32_t count) {
    for (uint32_t i = 1; i < count; i++)
        if (!(value[i] > value[i - 1])) return false;
    return true;
}
