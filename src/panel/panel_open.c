/* Opening a panel file: mapping it, and checking everything that a query relies on. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "panel/panel_open.h"

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

/* ---- emission -------------------------------------------------------------------------- */

static bool check_levels(const PanelBytes *at, const PanelEmission *e)
{
    uint64_t channels = e->has_black ? 3 : 0;
    for (int p = 0; p < 3; p++) {
        if (e->level_count[p] < 1 || e->level_count[p] > PANEL_LEVELS_MAX)
            return panel_refuse(at, "emission", "level count out of range");
        if (!(e->level[p][0] > 0) || !(e->level[p][e->level_count[p] - 1] <= 255) ||
            !panel_rising(e->level[p], e->level_count[p]))
            return panel_refuse(at, "emission", "levels do not rise from above 0 to 255");
        channels += 3 * (uint64_t)e->level_count[p];
    }
    if (e->has_black > 1 || e->harmonics > PANEL_HARMONICS_MAX || channels != e->channels ||
        e->components < 1 ||
        e->components > PANEL_COMPONENTS_MAX)
        return panel_refuse(at, "emission", "channel or component count out of range");
    if (!(e->cone_cos >= 0 && e->cone_cos <= 1) ||
        !(e->level_power > 0 && e->level_power < 10) ||
        !(e->cosine_power >= 0 && e->cosine_power < 10))
        return panel_refuse(at, "emission", "cone or level power out of range");
    return true;
}

/* Means and loadings, turned so that a query reads neighbouring channels at once. */
static void turn_loadings(Panel *panel, Arena *arena)
{
    const PanelEmission *e = panel->emission;
    int    channels = (int)e->channels, components = (int)e->components;
    int    stride = (channels + PANEL_CHANNELS_AT_ONCE + 3) / 4 * 4;
    float *rows = ARENA_NEW(arena, float, stride * (1 + components));
    for (int c = 0; c < channels; c++) {
        rows[c] = panel->channel_mean[c];
        for (int k = 0; k < components; k++)
            rows[(1 + k) * stride + c] = panel->loading[c * components + k];
    }
    panel->channel_rows = rows;
    panel->channel_stride = stride;
}

static bool open_emission(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                          Panel *panel)
{
    PanelBytes at, tree;
    if (!panel_need_section(bytes, PANEL_EMISSION, 0, &at) ||
        !panel_need_section(bytes, PANEL_EMISSION_TREE, 0, &tree))
        return false;
    const PanelEmission *e = (const PanelEmission *)at.data;
    if (at.size < sizeof *e) return panel_refuse(&at, "emission", "is too short");
    if (!check_levels(&at, e)) return false;
    size_t floats = (size_t)e->channels * (1 + e->components) + e->channels / 3 +
                    (size_t)PANEL_ANGLES * e->components * (1 + 2 * e->harmonics);
    if (at.size != sizeof *e + floats * sizeof(float))
        return panel_refuse(&at, "emission", "has another size than its counts say");
    panel->emission = e;
    panel->channel_mean = (const float *)(at.data + sizeof *e);
    panel->loading = panel->channel_mean + e->channels;
    panel->mean_y = panel->loading + (size_t)e->channels * e->components;
    panel->emission_profile = (PanelProfile){panel->mean_y + e->channels / 3,
                                             (int)e->components, (int)e->harmonics, true};
    if (!panel_all_finite(panel->channel_mean, floats))
        return panel_refuse(&at, "emission", "holds a number that is not finite");
    if (!tree_open(tree.data, tree.size, geodesic, &panel->emission_tree, bytes->err))
        return error_prefix(bytes->err, "emission tree") ||
               error_in_file(bytes->err, bytes->name);
    if (panel->emission_tree.components != (int)e->components ||
        panel->emission_tree.octants != 4)
        return panel_refuse(&at, "emission", "does not fit its tree");
    turn_loadings(panel, arena);
    for (int p = 0; p < 3; p++)
        for (uint32_t i = 0; i < e->level_count[p]; i++)
            panel->log_level[p][i] = log_f(e->level[p][i]);
    return true;
}

static bool open_primaries(const PanelBytes *bytes, Panel *panel)
{
    PanelBytes at;
    if (!panel_need_section(bytes, PANEL_PRIMARIES, 0, &at)) return false;
    const PanelPrimaries *p = (const PanelPrimaries *)at.data;
    if (at.size != sizeof *p) return panel_refuse(&at, "primaries", "has a wrong size");
    if (!panel_all_finite((const float *)p, sizeof *p / sizeof(float)))
        return panel_refuse(&at, "primaries", "holds a number that is not finite");
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++)
            if (!(p->bend[i].high[k] > p->bend[i].low[k]))
                return panel_refuse(&at, "primaries", "a chromaticity range is empty");
    panel->primaries = p;
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
            else if (kinds[k] != PANEL_SAMPLING && at.size >= sizeof(TreeHeader))
                one = ((const TreeHeader *)at.data)->level;
            *level = one > *level ? one : *level;
        }
    return *level <= GEODESIC_MAX_LEVEL || panel_refuse(bytes, "trees", "are too deep");
}

bool panel_from_bytes(const void *data, size_t size, const char *name, Arena *arena,
                      Panel **out, Error *err)
{
    PanelBytes       bytes = {data, size, name, err}, meta;
    PanelHeader header;
    int         level;
    if (!check_header(&bytes, &header) || !finest_level(&bytes, &level) ||
        !panel_need_section(&bytes, PANEL_META, 0, &meta))
        return false;
    const Geodesic *geodesic = geodesic_create(level, arena);
    Panel *panel = ARENA_NEW(arena, Panel, 1);
    panel->size = size;
    panel->meta = (const char *)meta.data;
    panel->meta_size = meta.size;
    if (!open_emission(&bytes, geodesic, arena, panel) || !open_primaries(&bytes, panel) ||
        !panel_open_reflection(&bytes, geodesic, arena, panel))
        return false;
    *out = panel;
    return true;
}

static bool map_file(const char *path, void **map, size_t *size, Error *err)
{
    struct stat status;
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return error_at(err, ERROR_INPUT, path, "", "cannot be opened: %s", strerror(errno));
    if (fstat(file, &status) || !S_ISREG(status.st_mode) || status.st_size < 1) {
        close(file);
        return error_at(err, ERROR_INPUT, path, "",
                        "is no panel file, wanted one that `panel fit` wrote");
    }
    *size = (size_t)status.st_size;
    *map = mmap(NULL, *size, PROT_READ, MAP_PRIVATE, file, 0);
    close(file);
    if (*map == MAP_FAILED)
        return error_at(err, ERROR_INPUT, path, "", "cannot be mapped: %s", strerror(errno));
    return true;
}

bool panel_open(const char *path, Arena *arena, Panel **out, Error *err)
{
    void  *map = NULL;
    size_t size = 0;
    Panel *panel;
    if (!map_file(path, &map, &size, err)) return false;
    if (!panel_from_bytes(map, size, path, arena, &panel, err)) {
        munmap(map, size);
        return false;
    }
    panel->map = map;
    *out = panel;
    return true;
}

void panel_close(Panel *panel)
{
    if (panel && panel->map) munmap(panel->map, panel->size);
}
