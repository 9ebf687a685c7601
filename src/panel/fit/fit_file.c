/* SPDX-License-Identifier: Apache-2.0 */
/* Layout: panel_file.h. */
#include "panel/fit/fit_file.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_report.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

/* ---- which panels ------------------------------------------------------------------------ */

static bool has_part(const MeasuredSpot *spot, bool is_reflection) {
    return is_reflection ? spot->has_reflection : spot->has_emission;
}

static bool set_has_part(const Measurement *set, bool is_reflection) {
    return is_reflection ? set->incidence_count > 0 : set->primary[0].level_count > 0;
}

/* The spot that lends the set its part; -1: the set has its own, or nobody has any. */
static int lender_of(const Measurement *set, bool is_reflection) {
    int nearest = -1;
    double least = INFINITY;
    for (int i = 0; i < set->spot_count && !set_has_part(set, is_reflection); i++) {
        double u = set->spot[i].at[0] - 0.5, v = set->spot[i].at[1] - 0.5;
        if (!has_part(&set->spot[i], is_reflection) || !(u * u + v * v < least)) continue;
        least = u * u + v * v;
        nearest = i;
    }
    return nearest;
}

static void copy_emission(const Measurement *from, Measurement *to) {
    to->white_miss = from->white_miss;
    to->is_white_only = from->is_white_only;
    to->white = from->white;
    to->levels = from->levels;
    to->has_black = from->has_black;
    to->black = from->black;
    memcpy(to->primary, from->primary, sizeof to->primary);
}

static void copy_reflection(const Measurement *from, Measurement *to) {
    to->incidence_count = from->incidence_count;
    to->wavelength_count = from->wavelength_count;
    to->azimuth_count = from->azimuth_count;
    to->brdf = from->brdf;
    memcpy(to->incidence, from->incidence, sizeof to->incidence);
    memcpy(to->wavelength_nm, from->wavelength_nm, sizeof to->wavelength_nm);
    memcpy(to->azimuth, from->azimuth, sizeof to->azimuth);
}

/* A spot gets a panel of its own for what it does not lend. */
static void plan_spot(const Measurement *set, int i, const int lender[2], FitPlaces *out) {
    const MeasuredSpot *spot = &set->spot[i];
    bool emits = spot->has_emission && i != lender[0];
    bool reflects = spot->has_reflection && i != lender[1];
    PanelSpotStored *stored = &out->spot[out->spots++];
    *stored = (PanelSpotStored){.at = {(float)spot->at[0], (float)spot->at[1]}};
    if (!emits && !reflects) return;
    Measurement none = {0}, *of = &out->of_panel[out->panels];
    *of = *spot->set;
    if (!emits) copy_emission(&none, of);
    if (!reflects) copy_reflection(&none, of);
    out->spot_of_panel[out->panels++] = i;
    if (emits) stored->emission = (uint16_t)out->panels;
    if (reflects) stored->reflection = (uint16_t)out->panels;
}

void fit_places_plan(const Measurement *set, Arena *arena, FitPlaces *out) {
    int lender[2] = {lender_of(set, false), lender_of(set, true)};
    *out = (FitPlaces){.own = *set, .own_at = {0.5f, 0.5f}};
    if (lender[0] >= 0) {
        const MeasuredSpot *spot = &set->spot[lender[0]];
        copy_emission(spot->set, &out->own);
        for (int k = 0; k < 2; k++) out->own_at[k] = (float)spot->at[k];
    }
    if (lender[1] >= 0) copy_reflection(set->spot[lender[1]].set, &out->own);
    out->of_panel = ARENA_NEW(arena, Measurement, set->spot_count);
    out->spot_of_panel = ARENA_NEW(arena, int, set->spot_count);
    out->bytes = ARENA_NEW(arena, const void *, set->spot_count);
    out->sizes = ARENA_NEW(arena, size_t, set->spot_count);
    out->spot = ARENA_NEW(arena, PanelSpotStored, set->spot_count);
    for (int i = 0; i < set->spot_count; i++) plan_spot(set, i, lender, out);
    if (!out->panels) out->spots = 0; /* all are the same: one panel everywhere */
}

/* Bytes of the sections in the file. */
static size_t places_bytes(const FitPlaces *places) {
    size_t bytes = fit_places_are_there(places) ? sizeof(PanelSpotsHead) : 0;
    bytes += (size_t)places->spots * sizeof(PanelSpotStored) + places->map_size;
    for (int k = 0; k < places->panels; k++) bytes += places->sizes[k];
    return bytes;
}

/* ---- what the camera saw ----------------------------------------------------------------- */

/* From where a place of a bent display is seen, in its own frame: the arc keeps its length, the
 * camera stands before its middle. */
static Vec3 seen_from(const UniformityMap *map, const double size_mm[2], const float at[2]) {
    double width = size_mm[0] > 0 ? size_mm[0] : 1, along = ((double)at[0] - 0.5) * width;
    double turn = map->bend * ((double)at[0] - 0.5), s = sin_d(turn), c = cos_d(turn);
    double bent = map->bend / width; /* curvature */
    double x = map->bend != 0 ? s / bent : along, z = map->bend != 0 ? (1 - c) / bent : 0;
    double y = (0.5 - (double)at[1]) * size_mm[1];
    double to[3] = {-x, -y, map->camera_mm - z};
    if (!(map->camera_mm > 0)) to[0] = to[1] = 0, to[2] = 1;
    return vec3_normalize(
        vec3((float)(to[0] * c + to[2] * s), (float)to[1], (float)(to[2] * c - to[0] * s)));
}

/* Light along `direction` over light along the normal, X, Y, Z; of a channel alone Y serves. */
static bool view_factors(const Panel *panel, const float at[2], Vec3 direction, bool is_black,
                         double factor[3]) {
    float rgb[3], there[3], normal[3];
    for (int k = 0; k < 3; k++) rgb[k] = is_black ? 0 : 255;
    panel_place_emission_xyz(panel, at, direction, rgb, there);
    panel_place_emission_xyz(panel, at, vec3(0, 0, 1), rgb, normal);
    for (int j = 0; j < 3; j++) {
        if (is_black && !(normal[j] > 0)) factor[j] = 1; /* no light, no angle */
        else if (!(there[j] > 0 && normal[j] > 0)) return false;
        else factor[j] = (double)there[j] / (double)normal[j];
    }
    return true;
}

typedef struct MapPlane {
    bool is_black;
    int axis; /* X, Y, Z */
    double *value;
    double most; /* of the values, once they are straight */
} MapPlane;

static bool straighten_pixel(const Measurement *set, const Panel *panel, const MapPlane *plane,
                             int planes, size_t i, Error *err) {
    const UniformityMap *map = set->map;
    int x = (int)(i % (size_t)map->width), y = (int)(i / (size_t)map->width);
    float at[2] = {((float)x + 0.5f) / (float)map->width, ((float)y + 0.5f) / (float)map->height};
    Vec3 direction = seen_from(map, set->size_mm, at);
    double factor[2][3];
    if (!(direction.z > 0) || !view_factors(panel, at, direction, false, factor[0]) ||
        !view_factors(panel, at, direction, true, factor[1]))
        return error_at(err, ERROR_INPUT, set->file, "/uniformity",
                        "pixel %d,%d cannot be "
                        "seen from where the camera stands",
                        x, y);
    for (int k = 0; k < planes; k++) plane[k].value[i] /= factor[plane[k].is_black][plane[k].axis];
    return true;
}

/* ---- the section ------------------------------------------------------------------------- */

static int make_planes(const UniformityMap *map, Arena *arena, MapPlane plane[6]) {
    size_t pixels = (size_t)map->width * (size_t)map->height;
    int white = map->white_channels, count = white + map->black_channels;
    for (int k = 0; k < count; k++) {
        bool is_black = k >= white;
        int channels = is_black ? map->black_channels : white;
        plane[k] = (MapPlane){is_black, channels == 3 ? k - is_black * white : 1,
                              ARENA_NEW(arena, double, pixels), 0};
        for (size_t i = 0; i < pixels; i++) plane[k].value[i] = (double)map->value[k][i];
    }
    return count;
}

static double most_of(const double *value, size_t pixels) {
    double most = 0;
    for (size_t i = 0; i < pixels; i++) most = fmax(most, value[i]);
    return most;
}

/* Only ratios count: the largest number of white, and of black, becomes 1. */
static float pack_plane(const MapPlane *plane, int planes, int index, size_t pixels,
                        uint16_t *out) {
    const double *value = plane[index].value;
    double most = plane[index].most, whole = 0;
    for (int k = 0; k < planes; k++)
        if (plane[k].is_black == plane[index].is_black) whole = fmax(whole, plane[k].most);
    for (size_t i = 0; i < pixels; i++)
        out[i] = (uint16_t)fmin(65535, floor(65535 * (value[i] / most) + 0.5));
    return (float)(most / whole / 65535);
}

static bool is_lit_at(const UniformityMap *map, const MapPlane *plane, int planes,
                      const float at[2]) {
    int x = (int)fminf(at[0] * (float)map->width, (float)(map->width - 1));
    int y = (int)fminf(at[1] * (float)map->height, (float)(map->height - 1));
    for (int k = 0; k < planes; k++) {
        double value = plane[k].value[(size_t)y * (size_t)map->width + (size_t)x];
        if (!(value > 1e-4 * plane[k].most)) return false;
    }
    return true;
}

/* Everything counts relative to where panels were measured. */
static bool check_references(const Measurement *set, const FitPlaces *places, const MapPlane *plane,
                             int planes, Error *err) {
    for (int i = -1; i < places->panels; i++) {
        float own[2] = {places->own_at[0], places->own_at[1]};
        const float *at = own;
        float spot[2];
        if (i >= 0) {
            const MeasuredSpot *of = &set->spot[places->spot_of_panel[i]];
            if (!places->of_panel[i].primary[0].level_count) continue;
            spot[0] = (float)of->at[0], spot[1] = (float)of->at[1];
            at = spot;
        }
        if (!is_lit_at(set->map, plane, planes, at))
            return error_at(err, ERROR_INPUT, set->map->file, "",
                            "is dark at %g, %g, where "
                            "the emission was measured: nothing can be relative to it",
                            (double)at[0], (double)at[1]);
    }
    return true;
}

bool fit_places_add_map(const Measurement *set, const Panel *panel, Arena *arena, FitPlaces *places,
                        Error *err) {
    const UniformityMap *map = set->map;
    MapPlane plane[6];
    size_t pixels = (size_t)map->width * (size_t)map->height;
    int planes = make_planes(map, arena, plane);
    for (size_t i = 0; i < pixels && map->is_seen; i++)
        if (!straighten_pixel(set, panel, plane, planes, i, err)) return false;
    for (int k = 0; k < planes; k++) plane[k].most = most_of(plane[k].value, pixels);
    if (!check_references(set, places, plane, planes, err)) return false;
    size_t size = sizeof(PanelMapHead) + (size_t)planes * pixels * sizeof(uint16_t);
    unsigned char *bytes = arena_alloc(arena, 1, 64, size);
    PanelMapHead head = {.width = (uint16_t)map->width,
                         .height = (uint16_t)map->height,
                         .white_channels = (uint8_t)map->white_channels,
                         .black_channels = (uint8_t)map->black_channels};
    uint16_t *values = (uint16_t *)(void *)(bytes + sizeof head);
    for (int k = 0; k < planes; k++) {
        head.scale[k] = pack_plane(plane, planes, k, pixels, values + (size_t)k * pixels);
        if (!(head.scale[k] > PANEL_MAP_LEAST_SCALE))
            return error_at(err, ERROR_INPUT, map->file, "",
                            "has next to no %c beside its "
                            "other channels",
                            "XYZ"[plane[k].axis]);
    }
    memcpy(bytes, &head, sizeof head);
    places->map = bytes;
    places->map_size = size;
    return true;
}

/* Sections are written one after the other, each of pieces that follow each other. */
typedef struct FitPiece {
    const void *data;
    size_t size;
} FitPiece;

typedef struct FitWriter {
    unsigned char *bytes; /* the sections; offsets count from here until the end */
    size_t size, capacity;
    PanelSection section[PANEL_SECTIONS_MAX];
    uint32_t count;
    Arena *arena;
} FitWriter;

static size_t rounded(size_t size) {
    return (size + PANEL_ALIGN - 1) / PANEL_ALIGN * PANEL_ALIGN;
}

static void make_room(FitWriter *writer, size_t bytes) {
    if (writer->size + bytes <= writer->capacity) return;
    writer->capacity = 2 * (writer->size + bytes);
    unsigned char *grown = arena_alloc(writer->arena, 1, 64, writer->capacity);
    if (writer->size) memcpy(grown, writer->bytes, writer->size);
    writer->bytes = grown;
}

static void write_section(FitWriter *writer, PanelSectionKind kind, uint32_t index,
                          const FitPiece *piece, int pieces) {
    size_t begin = rounded(writer->size);
    make_room(writer, PANEL_ALIGN);
    writer->size = begin;
    for (int i = 0; i < pieces; i++) {
        make_room(writer, piece[i].size);
        if (piece[i].size) memcpy(writer->bytes + writer->size, piece[i].data, piece[i].size);
        writer->size += piece[i].size;
    }
    writer->section[writer->count++] =
        (PanelSection){(uint16_t)kind, (uint16_t)index, (uint32_t)(writer->size - begin), begin};
}

static void write_emission(FitWriter *writer, const FitParts *parts) {
    const EmissionResult *e = parts->emission;
    FitPiece section = {e->section, e->section_size};
    FitPiece tree = {e->tree.bytes, tree_size(e->tree.bytes)};
    FitPiece primaries = {parts->primaries, parts->primaries_size};
    write_section(writer, PANEL_EMISSION, 0, &section, 1);
    write_section(writer, PANEL_EMISSION_TREE, 0, &tree, 1);
    write_section(writer, PANEL_PRIMARIES, 0, &primaries, 1);
}

/* Left out of light that is not polarised. An angle that rounds up to pi is 0. */
static void write_polarised(FitWriter *writer, const DisplayTraits *traits) {
    double azimuth_deg = fmod(traits->polarisation_azimuth_deg, 180);
    double azimuth = radians_from_degrees(azimuth_deg < 0 ? azimuth_deg + 180 : azimuth_deg);
    PanelPolarisedStored stored = {(float)traits->polarisation_degree, (float)azimuth};
    FitPiece piece = {&stored, sizeof stored};
    if (stored.azimuth >= PI_F) stored.azimuth = 0;
    if (stored.degree > 0) write_section(writer, PANEL_POLARISED, 0, &piece, 1);
}

static int put_pairs(const ZoneTable *table, float *out) {
    for (int i = 0; i < table->rows; i++) {
        out[2 * i] = (float)table->at[i];
        out[2 * i + 1] = (float)table->value[i];
    }
    return table->rows;
}

static void write_zones(FitWriter *writer, const DimmingZones *zones) {
    if (!zones->count[0]) return;
    float pairs[2][2 * ZONE_ROWS_MAX];
    PanelZonesStored stored = {.version = PANEL_ZONES_VERSION,
                               .columns = (uint16_t)zones->count[0],
                               .rows = (uint16_t)zones->count[1],
                               .rule = (uint8_t)zones->rule,
                               .compensates = zones->compensates,
                               .spread_rows = (uint8_t)put_pairs(&zones->spread, pairs[0]),
                               .drive_rows = (uint8_t)put_pairs(&zones->drive, pairs[1]),
                               .size_mm = {(float)zones->size_mm[0], (float)zones->size_mm[1]},
                               .sigma_mm = (float)zones->sigma_mm,
                               .least = (float)zones->least};
    FitPiece pieces[3] = {{&stored, sizeof stored},
                          {pairs[0], 2 * sizeof(float) * stored.spread_rows},
                          {pairs[1], 2 * sizeof(float) * stored.drive_rows}};
    write_section(writer, PANEL_ZONES, 0, pieces, 3);
}

static void write_reflection(FitWriter *writer, const ReflectionResult *r) {
    FitPiece section = {r->section.bytes, r->section.size};
    FitPiece tree = {r->model->tree, tree_size(r->model->tree)};
    FitPiece sampling = {r->sampling, r->sampling_size};
    write_section(writer, PANEL_REFLECTION, 0, &section, 1);
    write_section(writer, PANEL_REFLECTION_TREE, 0, &tree, 1);
    if (r->sampling) write_section(writer, PANEL_SAMPLING, 0, &sampling, 1);
    FitPiece reach = {r->model->reach, sizeof *r->model->reach * (size_t)r->model->tables};
    if (r->model->has_reach) write_section(writer, PANEL_REACH, 0, &reach, 1);
}

static void write_places(FitWriter *writer, const FitPlaces *places) {
    PanelSpotsHead head = {
        (uint16_t)places->spots, (uint16_t)places->panels, {places->own_at[0], places->own_at[1]}};
    FitPiece spots[2] = {{&head, sizeof head},
                         {places->spot, (size_t)places->spots * sizeof *places->spot}};
    FitPiece map = {places->map, places->map_size};
    write_section(writer, PANEL_SPOTS, 0, spots, 2);
    for (int k = 0; k < places->panels; k++) {
        FitPiece file = {places->bytes[k], places->sizes[k]};
        write_section(writer, PANEL_SPOT_FILE, (uint32_t)k + 1, &file, 1);
    }
    if (places->map) write_section(writer, PANEL_MAP, 0, &map, 1);
}

/* Header and table of contents in front of the sections. */
static void *finish(FitWriter *writer, size_t *size) {
    size_t toc = writer->count * sizeof *writer->section;
    size_t front = rounded(sizeof(PanelHeader) + toc);
    unsigned char *bytes = arena_alloc(writer->arena, 1, 64, front + writer->size);
    for (uint32_t i = 0; i < writer->count; i++) writer->section[i].offset += front;
    PanelHeader header = {.magic = PANEL_MAGIC,
                          .version = PANEL_VERSION,
                          .size = front + writer->size,
                          .section_count = writer->count};
    memcpy(bytes, &header, sizeof header);
    memcpy(bytes + sizeof header, writer->section, toc);
    memcpy(bytes + front, writer->bytes, writer->size);
    size_t from = offsetof(PanelHeader, size);
    header.checksum = XXH3_64bits(bytes + from, header.size - from);
    memcpy(bytes, &header, sizeof header);
    *size = header.size;
    return bytes;
}

static void *file_bytes(const FitParts *parts, FitPiece report, Arena *arena, size_t *size) {
    FitWriter writer = {.arena = arena};
    write_section(&writer, PANEL_META, 0, &report, 1);
    if (parts->emission) write_emission(&writer, parts);
    if (parts->reflection) write_reflection(&writer, parts->reflection);
    if (parts->emission) write_polarised(&writer, &parts->set->traits);
    if (parts->places && fit_places_are_there(parts->places)) write_places(&writer, parts->places);
    if (parts->emission) write_zones(&writer, &parts->set->traits.zones);
    return finish(&writer, size);
}

void *fit_file_bytes(const FitParts *parts, json_t *report, Arena *arena, size_t *size) {
    json_t *stored = json_copy(report);
    FitPiece packed = {0};
    json_object_del(stored, "outliers");
    json_object_del(stored, "holes");
    packed.size = panel_report_pack(stored, arena, &packed.data);
    json_decref(stored);
    if (!packed.size) return NULL;
    void *bytes = file_bytes(parts, packed, arena, size);
    panel_report_add_sizes(report, *size - (parts->places ? places_bytes(parts->places) : 0));
    return bytes;
}

Panel *fit_file_open(const FitParts *parts, const char *path, Arena *arena, Error *err) {
    Panel *panel;
    size_t size;
    void *bytes = file_bytes(parts, (FitPiece){"{}", 2}, arena, &size);
    return panel_from_bytes(bytes, size, path, arena, &panel, err) ? panel : NULL;
}
