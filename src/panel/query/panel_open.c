/* SPDX-License-Identifier: Apache-2.0 */
/* Opening a panel file: reading it, and checking everything that a query relies on. */
#include "panel/query/panel_open.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "hemisphere/tree/tree_stop.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_open_emission.h"
#include "panel/query/panel_open_reflection.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_section.h"
#include "panel/query/panel_zones.h"

/* ---- places ----------------------------------------------------------------------------- */

/* A panel file's spots and map, checked and made ready for queries.
 * Private to src/panel. */

_Static_assert(sizeof(PanelSpotsHead) == 12, "the file's layout");
_Static_assert(sizeof(PanelSpotStored) == 12, "the file's layout");
_Static_assert(sizeof(PanelMapHead) == 32, "the file's layout");

/* ---- spots ------------------------------------------------------------------------------- */

static bool is_place(const float at[2]) {
    return at[0] >= 0 && at[0] <= 1 && at[1] >= 0 && at[1] <= 1;
}

/* Each panel was measured at one place: where the first spot that names it stands. */
static bool place_panels(const PanelBytes *bytes, PanelPlaces *places, float (*at)[2]) {
    for (int k = 1; k < places->panels; k++) {
        int i = 0;
        while (i < places->spots && places->emission[i] != k && places->reflection[i] != k) i++;
        if (i == places->spots) return panel_refuse(bytes, "spots", "a panel has no spot");
        memcpy(at[k], places->ground.at[i], sizeof at[k]);
    }
    return true;
}

static bool check_spots(const PanelBytes *bytes, const float (*at)[2], const PanelPlaces *places) {
    for (int i = 0; i < places->spots; i++) {
        if (!is_place(at[i])) return panel_refuse(bytes, "spots", "a place is out of range");
        if (places->emission[i] >= places->panels || places->reflection[i] >= places->panels)
            return panel_refuse(bytes, "spots", "a spot has a panel that is not there");
        for (int k = 0; k < i; k++)
            if (at[k][0] == at[i][0] && at[k][1] == at[i][1])
                return panel_refuse(bytes, "spots", "two spots are at one place");
    }
    return true;
}

static bool read_spots(const PanelBytes *bytes, const PanelBytes *section, Arena *arena,
                       PanelPlaces *out) {
    PanelSpotsHead head;
    if (section->size < sizeof head) return panel_refuse(bytes, "spots", "is too short");
    memcpy(&head, section->data, sizeof head);
    if (head.spots > SPOT_GROUND_MAX || head.panels > head.spots || !is_place(head.own_at))
        return panel_refuse(bytes, "spots", "a number is out of range");
    if (section->size != sizeof head + head.spots * sizeof(PanelSpotStored))
        return panel_refuse(bytes, "spots", "has another size than its count says");
    float(*at)[2] = arena_alloc(arena, sizeof *at, _Alignof(float), head.spots);
    float(*panel_at)[2] = arena_alloc(arena, sizeof *at, _Alignof(float), head.panels + 1);
    uint16_t *emission = ARENA_NEW(arena, uint16_t, head.spots);
    uint16_t *reflection = ARENA_NEW(arena, uint16_t, head.spots);
    for (int i = 0; i < head.spots; i++) {
        PanelSpotStored spot;
        memcpy(&spot, section->data + sizeof head + (size_t)i * sizeof spot, sizeof spot);
        memcpy(at[i], spot.at, sizeof at[i]);
        emission[i] = spot.emission;
        reflection[i] = spot.reflection;
    }
    memcpy(panel_at[0], head.own_at, sizeof *panel_at);
    *out = (PanelPlaces){.panels = head.panels + 1,
                         .spots = head.spots,
                         .emission = emission,
                         .reflection = reflection,
                         .measured_at = (const float(*)[2])panel_at};
    out->panel = ARENA_NEW(arena, const Panel *, out->panels);
    if (!check_spots(bytes, (const float(*)[2])at, out)) return false;
    if (out->spots) spot_ground_build((const float(*)[2])at, out->spots, arena, &out->ground);
    return place_panels(bytes, out, panel_at);
}

/* ---- the map ----------------------------------------------------------------------------- */

/* Where the planes of white or black begin; one serves all three. */
static void set_planes(const PanelMapHead *head, const uint16_t *first, int channels, int kind,
                       PanelMap *out) {
    size_t pixels = (size_t)head->width * head->height;
    int before = kind ? head->white_channels : 0;
    for (int j = 0; j < 3; j++) {
        int plane = before + (channels == 3 ? j : 0);
        out->value[kind][j] = first + (size_t)plane * pixels;
        out->scale[kind][j] = head->scale[plane];
    }
}

static bool check_map(const PanelBytes *bytes, const PanelMapHead *head, size_t size) {
    int white = head->white_channels, black = head->black_channels;
    if (!head->width || !head->height || head->width > PANEL_MAP_SIDE_MAX ||
        head->height > PANEL_MAP_SIDE_MAX || (white != 1 && white != 3) ||
        (black != 0 && black != 1 && black != 3))
        return panel_refuse(bytes, "map", "a number is out of range");
    for (int i = 0; i < white + black; i++)
        if (!(head->scale[i] > PANEL_MAP_LEAST_SCALE && head->scale[i] <= 1))
            return panel_refuse(bytes, "map", "a scale is out of range");
    size_t values = (size_t)head->width * head->height * (size_t)(white + black);
    return size == sizeof *head + values * sizeof(uint16_t) ||
           panel_refuse(bytes, "map", "has another size than its head says");
}

static bool read_map(const PanelBytes *bytes, const PanelBytes *section, Arena *arena,
                     const PanelMap **out) {
    PanelMapHead head;
    if (section->size < sizeof head) return panel_refuse(bytes, "map", "is too short");
    memcpy(&head, section->data, sizeof head);
    if (!check_map(bytes, &head, section->size)) return false;
    const uint16_t *first = (const uint16_t *)(const void *)(section->data + sizeof head);
    PanelMap *map = ARENA_NEW(arena, PanelMap, 1);
    map->width = head.width;
    map->height = head.height;
    map->has_black = head.black_channels > 0;
    set_planes(&head, first, head.white_channels, 0, map);
    if (map->has_black) set_planes(&head, first, head.black_channels, 1, map);
    for (int j = 0; j < 3 && !map->has_black; j++) {
        map->value[1][j] = map->value[0][j];
        map->scale[1][j] = map->scale[0][j];
    }
    *out = map;
    return true;
}

/* The spots and the map, and their bytes; *out NULL: the file has neither. The panels of the
 * spots are still to be opened: panel [0] is the file's own. */
static bool panel_read_places(const PanelBytes *bytes, Arena *arena, PanelPlaces **out,
                              size_t *size) {
    PanelBytes spots, map;
    bool has_spots, has_map;
    *out = NULL;
    if (!panel_find_section(bytes, PANEL_SPOTS, 0, &spots, &has_spots) ||
        !panel_find_section(bytes, PANEL_MAP, 0, &map, &has_map))
        return false;
    if (!has_spots)
        return !has_map || panel_refuse(bytes, "map", "stands without the places' section");
    PanelPlaces *places = ARENA_NEW(arena, PanelPlaces, 1);
    if (!read_spots(bytes, &spots, arena, places) ||
        (has_map && !read_map(bytes, &map, arena, &places->map)))
        return false;
    if (!places->spots && !places->map)
        return panel_refuse(bytes, "spots", "has neither spots nor a map");
    *size = spots.size + (has_map ? map.size : 0);
    *out = places;
    return true;
}

static bool check_panels(const PanelBytes *bytes, const PanelPlaces *places) {
    const Panel *own = places->panel[0];
    if (places->map && !own->emission)
        return panel_refuse(bytes, "map", "stands without an emission");
    for (int i = 0; i < places->spots; i++)
        if (!places->panel[places->emission[i]]->emission != !own->emission ||
            !places->panel[places->reflection[i]]->reflection != !own->reflection)
            return panel_refuse(bytes, "spots", "a spot lacks what the panel has");
    return true;
}

/* Black over white along the normal. */
static void find_dark(const Panel *panel, float dark[3]) {
    static const float codes[2][3] = {{0, 0, 0}, {255, 255, 255}};
    float xyz[2][3];
    for (int k = 0; k < 2; k++) panel_emission_xyz(panel, vec3(0, 0, 1), codes[k], xyz[k]);
    for (int j = 0; j < 3; j++)
        dark[j] = xyz[1][j] > xyz[0][j] ? clampf(xyz[0][j] / xyz[1][j], 0, 0.999f) : 0;
}

static bool find_references(const PanelBytes *bytes, Arena *arena, PanelPlaces *places) {
    size_t panels = (size_t)places->panels;
    float(*values)[3] = arena_alloc(arena, sizeof *values, _Alignof(float), 3 * panels);
    float(*white)[3] = values, (*black)[3] = values + places->panels;
    float(*dark)[3] = black + places->panels;
    for (int k = 0; k < places->panels; k++) {
        if (!places->panel[k]->emission) continue; /* a spot's reflection alone */
        panel_map_at(places->map, places->measured_at[k], white[k], black[k]);
        for (int j = 0; j < 3; j++)
            if (!(white[k][j] > 0 && black[k][j] > 0))
                return panel_refuse(bytes, "map", "is dark where a panel was measured");
        find_dark(places->panel[k], dark[k]);
    }
    places->white = (const float(*)[3])white;
    places->black = (const float(*)[3])black;
    places->dark = (const float(*)[3])dark;
    return true;
}

/* The colours that a map adds: ranges of ln X/Y and ln Z/Y over its pixels. */
typedef struct MapColours {
    float low[2], high[2];
} MapColours;

#define COLOUR_MOST 3.0f /* beyond, a pixel is no measurement */

static MapColours map_colours(const PanelMap *map) {
    MapColours out = {{0, 0}, {0, 0}};
    size_t pixels = (size_t)map->width * (size_t)map->height;
    for (int kind = 0; kind < 1 + map->has_black; kind++) {
        if (map->value[kind][0] == map->value[kind][1]) continue; /* grey */
        for (size_t i = 0; i < pixels; i++)
            for (int k = 0; k < 2; k++) {
                float y = map->scale[kind][1] * (float)map->value[kind][1][i];
                float x = map->scale[kind][2 * k] * (float)map->value[kind][2 * k][i];
                if (!(x > 0 && y > 0)) continue;
                float log = clampf(log_f(x / y), -COLOUR_MOST, COLOUR_MOST);
                out.low[k] = fminf(out.low[k], log);
                out.high[k] = fmaxf(out.high[k], log);
            }
    }
    return out;
}

/* Corners of the box of colours, in the axes of a warp's range. */
static void widen(SpectralWarpRange *range, const MapColours *colours, const float at[3]) {
    float low[2] = {0, 0}, high[2] = {0, 0};
    for (int corner = 0; corner < 4; corner++) {
        float u = (corner & 1 ? colours->high : colours->low)[0] - log_f(at[0] / at[1]);
        float v = (corner & 2 ? colours->high : colours->low)[1] - log_f(at[2] / at[1]);
        float to[2] = {u * range->along[0] + v * range->along[1],
                       v * range->along[0] - u * range->along[1]};
        for (int k = 0; k < 2; k++) {
            low[k] = fminf(low[k], clampf(to[k], -COLOUR_MOST, COLOUR_MOST));
            high[k] = fmaxf(high[k], clampf(to[k], -COLOUR_MOST, COLOUR_MOST));
        }
    }
    for (int k = 0; k < 2; k++) range->low[k] += low[k], range->high[k] += high[k];
}

static bool is_grey(const PanelMap *map) {
    return map->value[0][0] == map->value[0][1] && map->value[1][0] == map->value[1][1];
}

static void widen_warps(PanelPlaces *places) {
    if (is_grey(places->map)) return;
    MapColours colours = map_colours(places->map);
    for (int k = 0; k < places->panels; k++) {
        PanelPrimaries *primaries = (PanelPrimaries *)places->panel[k]->primaries;
        for (int p = 0; primaries && p < 4; p++)
            widen(&primaries->warp[p].range, &colours, p < 3 ? places->white[k] : places->black[k]);
    }
}

/* Once all panels are opened: checks that every spot has what the file has, and reads the map
 * at each panel's place. The ranges of their primaries' warps grow by the map's colours. */
static bool panel_finish_places(const PanelBytes *bytes, Arena *arena, PanelPlaces *places) {
    if (!check_panels(bytes, places)) return false;
    if (!places->map) return true;
    if (!find_references(bytes, arena, places)) return false;
    widen_warps(places);
    return true;
}

/* The finest level of any tree inside, read before the trees themselves are checked. */
static bool finest_level(const PanelBytes *bytes, int *level) {
    static const PanelSectionKind kinds[] = {PANEL_EMISSION_TREE, PANEL_REFLECTION_TREE,
                                             PANEL_SAMPLING};
    *level = 0;
    for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < PANEL_SLICES_MAX; i++) {
            PanelBytes at;
            bool found;
            int one = 0;
            if (!panel_find_section(bytes, kinds[k], i, &at, &found)) return false;
            if (!found) break;
            if (kinds[k] == PANEL_SAMPLING && at.size >= sizeof(SamplingHeader))
                one = ((const SamplingHeader *)at.data)->level;
            else if (kinds[k] != PANEL_SAMPLING && at.size > offsetof(TreeHeader, level))
                one = ((const TreeHeader *)at.data)->level; /* where vertex trees have it too */
            *level = one > *level ? one : *level;
        }
    return *level <= GEODESIC_MAX_LEVEL || panel_refuse(bytes, "trees", "are too deep");
}

/* The angle is held in its range: what is stored rounds to float. */
static bool open_polarised(const PanelBytes *bytes, Panel *panel) {
    PanelBytes at;
    bool found;
    PanelPolarisedStored stored;
    if (!panel_find_section(bytes, PANEL_POLARISED, 0, &at, &found)) return false;
    if (!found) return true;
    if (at.size != sizeof stored)
        return panel_refuse(bytes, "polarisation", "has a wrong number of bytes");
    memcpy(&stored, at.data, sizeof stored);
    if (!(stored.degree > 0 && stored.degree <= 1) ||
        !(stored.azimuth >= 0 && stored.azimuth < PI_F))
        return panel_refuse(bytes, "polarisation", "a number is out of range");
    if (!panel->emission) return panel_refuse(bytes, "polarisation", "stands without an emission");
    panel->polarisation = (PanelPolarisation){stored.degree, stored.azimuth};
    return true;
}

/* All of a file but its places and the warps. */
static bool open_one(const PanelBytes *bytes, Arena *arena, Panel **out) {
    PanelHeader header;
    PanelBytes meta;
    int level;
    if (!panel_check_header(bytes, &header) || !finest_level(bytes, &level) ||
        !panel_need_section(bytes, PANEL_META, 0, &meta))
        return false;
    const Geodesic *geodesic = geodesic_create(level, arena);
    Panel *panel = ARENA_NEW(arena, Panel, 1);
    panel->size = panel->own_size = bytes->size;
    panel->meta = meta.data;
    panel->meta_size = meta.size;
    if (!panel_open_emission(bytes, geodesic, arena, panel) ||
        !panel_open_reflection(bytes, geodesic, arena, panel) || !open_polarised(bytes, panel) ||
        !panel_open_zones(bytes, arena, panel))
        return false;
    if (!panel->emission && !panel->reflection)
        return panel_refuse(bytes, "table of contents", "neither emits nor reflects");
    *out = panel;
    return true;
}

static bool check_sampling(const PanelBytes *bytes, const Panel *panel) {
    return !panel->reflection || panel->sampling.incidences ||
           panel_refuse(bytes, "table of contents",
                        "a reflection stands without its sampling tree");
}

/* A spot's panel is a file in the file, of one place. */
static bool open_spot(const PanelBytes *bytes, int index, Arena *arena, const Panel **out,
                      size_t *size) {
    PanelBytes at, inner;
    Panel *panel;
    bool has_spots, has_map;
    if (!panel_need_section(bytes, PANEL_SPOT_FILE, (uint32_t)index, &at)) return false;
    *size = at.size;
    if (!open_one(&at, arena, &panel) || !check_sampling(&at, panel) ||
        !panel_find_section(&at, PANEL_SPOTS, 0, &inner, &has_spots) ||
        !panel_find_section(&at, PANEL_MAP, 0, &inner, &has_map))
        return error_prefix(bytes->err, "a spot's own file") && false;
    if (has_spots || has_map || panel->zones)
        return panel_refuse(bytes, "spots", "a spot's own file has places or zones again");
    *out = panel;
    return true;
}

static bool open_places(const PanelBytes *bytes, Arena *arena, Panel *panel) {
    PanelPlaces *places;
    size_t size;
    if (!panel_read_places(bytes, arena, &places, &size)) return false;
    if (!places) return true;
    panel->own_size -= size;
    places->panel[0] = panel;
    for (int k = 1; k < places->panels; k++) {
        if (!open_spot(bytes, k, arena, &places->panel[k], &size)) return false;
        panel->own_size -= size;
    }
    if (!panel_finish_places(bytes, arena, places)) return false;
    for (int k = 1; k < places->panels; k++) panel_open_warps((Panel *)places->panel[k]);
    panel->places = places;
    return true;
}

bool panel_from_bytes(const void *data, size_t size, const char *name, Arena *arena, Panel **out,
                      Error *err) {
    PanelBytes bytes = {data, size, name, err};
    Panel *panel;
    if (!open_one(&bytes, arena, &panel) || !open_places(&bytes, arena, panel)) return false;
    panel_open_warps(panel);
    *out = panel;
    return true;
}

bool panel_open_memory(const void *data, size_t size, const char *name, Arena *arena, Panel **out,
                       Error *err) {
    PanelBytes bytes = {data, size, name, err};
    return panel_from_bytes(data, size, name, arena, out, err) && check_sampling(&bytes, *out);
}

/* A copy, not a mapping: a file that shrinks under a mapping kills the process, and one that
 * changes would be queried unchecked. */
bool panel_open(const char *path, Arena *arena, Panel **out, Error *err) {
    Arena copy = arena_reserve(PANEL_FILE_BYTES_MAX + 4096);
    FileBytes bytes = {0};
    if (!file_read(path, PANEL_FILE_BYTES_MAX, &copy, &bytes, err) ||
        !panel_open_memory(bytes.data, bytes.size, path, arena, out, err)) {
        arena_release(&copy);
        return false;
    }
    (*out)->copy = copy;
    return true;
}

void panel_close(Panel *panel) {
    if (panel) arena_release(&panel->copy);
}

/* ---- coarser ---------------------------------------------------------------------------- */

int panel_coarse_finest(const Panel *panel) {
    int emission = panel->emission ? panel->emission_tree.level : 0;
    int reflection = panel->reflection ? panel->reflection_tree.level : 0;
    return emission > reflection ? emission : reflection;
}

static void stop_trees(Panel *panel, int level, unsigned parts, Arena *arena) {
    Tree *emission = &panel->emission_tree, *reflection = &panel->reflection_tree;
    if (panel->emission && parts & PANEL_COARSE_EMISSION)
        tree_stop(emission, level < emission->level ? level : emission->level, arena);
    if (panel->reflection && parts & PANEL_COARSE_REFLECTION)
        tree_stop(reflection, level < reflection->level ? level : reflection->level, arena);
}

void panel_coarsen(Panel *panel, int level, unsigned parts, Arena *arena) {
    const PanelPlaces *places = panel->places;
    stop_trees(panel, level, parts, arena);
    for (int k = 1; places && k < places->panels; k++)
        stop_trees((Panel *)places->panel[k], level, parts, arena);
}
