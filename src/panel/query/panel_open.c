/* SPDX-License-Identifier: Apache-2.0 */
/* Opening a panel file: reading it, and checking everything that a query relies on. */
#include "panel/query/panel_open.h"

#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "hemisphere/tree/tree_stop.h"
#include "panel/query/panel_open_emission.h"
#include "panel/query/panel_open_places.h"
#include "panel/query/panel_open_reflection.h"
#include "panel/query/sampling_make.h"

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

/* The checksum does not cover the version: what stands in the file has to bear it out. */
static bool check_version(const PanelBytes *bytes, const PanelHeader *header,
                          const Panel *panel)
{
    bool     has_frame = panel->reflection && panel->reflection->frame != PANEL_FRAME_SPECULAR;
    uint32_t wanted = panel->places ? PANEL_VERSION_PLACES
                      : has_frame   ? PANEL_VERSION : PANEL_VERSION_PLAIN;
    if (header->version == wanted) return true;
    return error_at(bytes->err, ERROR_INPUT, bytes->name, "header",
                    "has version %u, required: %u for what the file holds; it is damaged: fit "
                    "the panel again", header->version, wanted);
}

/* The angle is held in its range: what is stored rounds to float. */
static bool open_polarised(const PanelBytes *bytes, Panel *panel)
{
    PanelBytes at;
    bool       found;
    PanelPolarisedStored stored;
    if (!panel_find_section(bytes, PANEL_POLARISED, 0, &at, &found)) return false;
    if (!found) return true;
    if (at.size != sizeof stored)
        return panel_refuse(bytes, "polarisation", "has a wrong number of bytes");
    memcpy(&stored, at.data, sizeof stored);
    if (!(stored.degree > 0 && stored.degree <= 1) ||
        !(stored.azimuth >= 0 && stored.azimuth < PI_F))
        return panel_refuse(bytes, "polarisation", "a number is out of range");
    if (!panel->emission)
        return panel_refuse(bytes, "polarisation", "stands without an emission");
    panel->polarisation = (PanelPolarisation){stored.degree, stored.azimuth};
    return true;
}

static bool subpixels_are_in_range(const PanelSubpixelsStored *stored)
{
    bool is_counted = stored->pixels[0] || stored->pixels[1];
    if (stored->layout != SUBPIXELS_STRIPE && stored->layout != SUBPIXELS_PENTILE) return false;
    for (int k = 0; k < 3; k++)
        if (stored->reserved[k]) return false;
    for (int k = 0; k < 2 && is_counted; k++)
        if (stored->pixels[k] < 1 || stored->pixels[k] > PANEL_PIXELS_MAX) return false;
    return stored->fill >= PANEL_LEAST_FILL && stored->fill <= 1;
}

static bool open_subpixels(const PanelBytes *bytes, Panel *panel)
{
    PanelBytes at;
    bool       found;
    PanelSubpixelsStored stored;
    if (!panel_find_section(bytes, PANEL_SUBPIXELS, 0, &at, &found)) return false;
    if (!found) return true;
    if (at.size != sizeof stored)
        return panel_refuse(bytes, "sub-pixels", "have a wrong number of bytes");
    memcpy(&stored, at.data, sizeof stored);
    if (!subpixels_are_in_range(&stored))
        return panel_refuse(bytes, "sub-pixels", "a number is out of range");
    if (!panel->emission)
        return panel_refuse(bytes, "sub-pixels", "stand without an emission");
    panel->subpixels = (Subpixels){(SubpixelLayout)stored.layout, stored.fill,
                                   {(int)stored.pixels[0], (int)stored.pixels[1]}};
    return true;
}

/* All of a file but its places and the warps. */
static bool open_one(const PanelBytes *bytes, Arena *arena, PanelHeader *header, Panel **out)
{
    PanelBytes meta, figures = {0};
    int        level;
    bool       has_figures;
    if (!panel_check_header(bytes, header) || !finest_level(bytes, &level) ||
        !panel_need_section(bytes, PANEL_META, 0, &meta) ||
        !panel_find_section(bytes, PANEL_REPORT_TABLES, 0, &figures, &has_figures))
        return false;
    const Geodesic *geodesic = geodesic_create(level, arena);
    Panel *panel = ARENA_NEW(arena, Panel, 1);
    panel->size = bytes->size;
    panel->meta = (const char *)meta.data;
    panel->meta_size = meta.size;
    panel->figures = has_figures ? figures.data : NULL;
    panel->figures_size = figures.size;
    if (!panel_open_emission(bytes, geodesic, arena, panel) ||
        !panel_open_reflection(bytes, geodesic, arena, panel) ||
        !open_polarised(bytes, panel) || !open_subpixels(bytes, panel))
        return false;
    if (!panel->emission && !panel->reflection)
        return panel_refuse(bytes, "table of contents", "neither emits nor reflects");
    *out = panel;
    return true;
}

static bool check_sampling(const PanelBytes *bytes, const Panel *panel)
{
    return !panel->reflection || panel->sampling.incidences ||
           panel_refuse(bytes, "table of contents",
                        "a reflection stands without its sampling tree");
}

/* A spot's panel is a file in the file, of one place. */
static bool open_spot(const PanelBytes *bytes, int index, Arena *arena, const Panel **out)
{
    PanelBytes  at, inner;
    PanelHeader header;
    Panel      *panel;
    bool        has_spots, has_map;
    if (!panel_need_section(bytes, PANEL_SPOT_FILE, (uint32_t)index, &at)) return false;
    if (!open_one(&at, arena, &header, &panel) || !check_version(&at, &header, panel) ||
        !check_sampling(&at, panel) ||
        !panel_find_section(&at, PANEL_SPOTS, 0, &inner, &has_spots) ||
        !panel_find_section(&at, PANEL_MAP, 0, &inner, &has_map))
        return error_prefix(bytes->err, "a spot's own file") && false;
    if (has_spots || has_map)
        return panel_refuse(bytes, "spots", "a spot's own file has places again");
    *out = panel;
    return true;
}

static bool open_places(const PanelBytes *bytes, Arena *arena, Panel *panel)
{
    PanelPlaces *places;
    if (!panel_read_places(bytes, arena, &places)) return false;
    if (!places) return true;
    places->panel[0] = panel;
    for (int k = 1; k < places->panels; k++)
        if (!open_spot(bytes, k, arena, &places->panel[k])) return false;
    if (!panel_finish_places(bytes, arena, places)) return false;
    for (int k = 1; k < places->panels; k++) panel_open_warps((Panel *)places->panel[k]);
    panel->places = places;
    return true;
}

bool panel_from_bytes(const void *data, size_t size, const char *name, Arena *arena,
                      Panel **out, Error *err)
{
    PanelBytes  bytes = {data, size, name, err};
    PanelHeader header;
    Panel      *panel;
    if (!open_one(&bytes, arena, &header, &panel) || !open_places(&bytes, arena, panel) ||
        !check_version(&bytes, &header, panel))
        return false;
    panel_open_warps(panel);
    *out = panel;
    return true;
}

bool panel_open_memory(const void *data, size_t size, const char *name, Arena *arena,
                       Panel **out, Error *err)
{
    Panel *panel;
    if (!panel_from_bytes(data, size, name, arena, &panel, err) ||
        !check_sampling(&(PanelBytes){data, size, name, err}, panel))
        return false;
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

/* ---- coarser ---------------------------------------------------------------------------- */

int panel_coarse_finest(const Panel *panel)
{
    int emission = panel->emission ? panel->emission_tree.level : 0;
    int reflection = panel->reflection ? panel->reflection_tree.level : 0;
    return emission > reflection ? emission : reflection;
}

static void stop_trees(Panel *panel, int level, unsigned parts, Arena *arena)
{
    Tree *emission = &panel->emission_tree, *reflection = &panel->reflection_tree;
    if (panel->emission && parts & PANEL_COARSE_EMISSION)
        tree_stop(emission, level < emission->level ? level : emission->level, arena);
    if (panel->reflection && parts & PANEL_COARSE_REFLECTION)
        tree_stop(reflection, level < reflection->level ? level : reflection->level, arena);
}

void panel_coarsen(Panel *panel, int level, unsigned parts, Arena *arena)
{
    const PanelPlaces *places = panel->places;
    stop_trees(panel, level, parts, arena);
    for (int k = 1; places && k < places->panels; k++)
        stop_trees((Panel *)places->panel[k], level, parts, arena);
}
