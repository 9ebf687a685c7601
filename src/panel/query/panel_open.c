/* Opening a panel file: reading it, and checking everything that a query relies on. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "panel/query/panel_open.h"
#include "panel/query/sampling_make.h"

#define CHECKSUM_FROM offsetof(PanelHeader, size)

_Static_assert(sizeof(PanelHeader) == 40, "the file's layout");
_Static_assert(sizeof(PanelSection) == 16, "the file's layout");
_Static_assert(sizeof(float) == 4, "the file's layout");

bool panel_refuse(const PanelBytes *bytes, const char *place, const char *what)
{
    return error_at(bytes->err, ERROR_INPUT, bytes->name, place,
                    "%s; the panel file is damaged, wanted one that `panel fit` wrote", what);
}

static bool check_header(const PanelBytes *bytes, PanelHeader *header)
{
    if (bytes->size < sizeof *header || memcmp(bytes->data, PANEL_MAGIC, 8))
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "",
                        "is no panel file, wanted one that `panel fit` wrote");
    memcpy(header, bytes->data, sizeof *header);
    if (header->version != PANEL_VERSION || header->flags)
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "header",
                        "has version %u, wanted %u: fit the panel again", header->version,
                        PANEL_VERSION);
    if (header->size != bytes->size)
        return error_at(bytes->err, ERROR_INPUT, bytes->name, "header",
                        "has %zu bytes, wanted %llu: the file is cut or grown", bytes->size,
                        (unsigned long long)header->size);
    if (XXH3_64bits(bytes->data + CHECKSUM_FROM, bytes->size - CHECKSUM_FROM) !=
        header->checksum)
        return panel_refuse(bytes, "header", "the checksum does not fit the bytes");
    if (header->section_count > PANEL_SECTIONS_MAX)
        return panel_refuse(bytes, "header", "the section count is out of range");
    return true;
}

bool panel_find_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                         PanelBytes *out, bool *found)
{
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
        if (section.offset % PANEL_ALIGN || section.offset < toc ||
            section.offset > bytes->size || section.size > bytes->size - section.offset)
            return panel_refuse(bytes, "table of contents", "a section lies outside the file");
        *out = (PanelBytes){bytes->data + section.offset, section.size, bytes->name,
                            bytes->err};
        *found = true;
        return true;
    }
    return true;
}

bool panel_need_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out)
{
    bool found;
    if (!panel_find_section(bytes, kind, index, out, &found)) return false;
    return found || panel_refuse(bytes, "table of contents", "a section is missing");
}

bool panel_all_finite(const float *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(value[i]) < 1e30f)) return false;
    return true;
}

bool panel_rising(const float *value, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++)
        if (!(value[i] > value[i - 1])) return false;
    return true;
}

/* ---- the whole file -------------------------------------------------------------------- */

/* The finest level of any tree inside, read before the trees themselves are checked. */
static bool finest_level(const PanelBytes *bytes, int *level)
{
    static const PanelSectionKind kinds[] = {PANEL_EMISSION_TREE, PANEL_REFLECTION_TREE,
                                             PANEL_SAMPLING};
    *level = 0;
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < PANEL_SLICES_MAX; i++) {
            PanelBytes at;
            bool  found;
            int   one = 0;
            if (!panel_find_section(bytes, kinds[k], i, &at, &found)) return false;
            if (!found) break;
            if (kinds[k] == PANEL_SAMPLING && at.size >= sizeof(SamplingHeader))
                one = ((const SamplingHeader *)at.data)->level;
            else if (kinds[k] == PANEL_SAMPLING)
                one = SAMPLING_MADE_LEVEL;
            else if (kinds[k] != PANEL_SAMPLING && at.size >= sizeof(TreeHeader))
                one = ((const TreeHeader *)at.data)->level;
            *level = one > *level ? one : *level;
        }
    return *level <= GEODESIC_MAX_LEVEL || panel_refuse(bytes, "trees", "are too deep");
}

bool panel_from_bytes(const void *data, size_t size, const char *name, Arena *arena,
                      Panel **out, Error *err)
{
    PanelBytes  bytes = {data, size, name, err}, meta, figures = {0};
    PanelHeader header;
    int         level;
    bool        has_figures;
    if (!check_header(&bytes, &header) || !finest_level(&bytes, &level) ||
        !panel_need_section(&bytes, PANEL_META, 0, &meta) ||
        !panel_find_section(&bytes, PANEL_FIGURES, 0, &figures, &has_figures))
        return false;
    const Geodesic *geodesic = geodesic_create(level, arena);
    Panel *panel = ARENA_NEW(arena, Panel, 1);
    panel->size = size;
    panel->meta = (const char *)meta.data;
    panel->meta_size = meta.size;
    panel->figures = has_figures ? figures.data : NULL;
    panel->figures_size = figures.size;
    if (!panel_open_emission(&bytes, geodesic, arena, panel) ||
        !panel_open_reflection(&bytes, geodesic, arena, panel))
        return false;
    if (!panel->emission && !panel->reflection)
        return panel_refuse(&bytes, "table of contents", "neither emits nor reflects");
    panel_open_bends(panel);
    *out = panel;
    return true;
}

bool panel_open_memory(const void *data, size_t size, const char *name, Arena *arena,
                       Panel **out, Error *err)
{
    Panel *panel;
    if (!panel_from_bytes(data, size, name, arena, &panel, err)) return false;
    if (panel->reflection && !panel->sampling.incidences)
        return panel_refuse(&(PanelBytes){data, size, name, err}, "table of contents",
                            "a reflection stands without its sampling tree");
    *out = panel;
    return true;
}

/* A copy, not a mapping: a file that shrinks under a mapping kills the process, and one that
 * changes would be queried unchecked. */
bool panel_open(const char *path, Arena *arena, Panel **out, Error *err)
{
    Arena     copy = arena_reserve(PANEL_FILE_BYTES_MAX + 4096);
    FileBytes bytes;
    if (!file_read(path, PANEL_FILE_BYTES_MAX, &copy, &bytes, err) ||
        !panel_open_memory(bytes.data, bytes.size, path, arena, out, err)) {
        arena_release(&copy);
        return false;
    }
    (*out)->copy = copy;
    return true;
}

void panel_close(Panel *panel)
{
    if (panel) arena_release(&panel->copy);
}
