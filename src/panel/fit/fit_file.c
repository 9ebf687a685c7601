/* SPDX-License-Identifier: Apache-2.0 */
/* Layout: panel_file.h. */
#include "panel/fit/fit_file.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/query/panel_open.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

/* Sections are written one after the other, each of pieces that follow each other. */
typedef struct FitPiece {
    const void *data;
    size_t      size;
} FitPiece;

typedef struct FitWriter {
    unsigned char *bytes; /* the sections; offsets count from here until the end */
    size_t         size, capacity;
    PanelSection   section[PANEL_SECTIONS_MAX];
    uint32_t       count;
    Arena         *arena;
} FitWriter;

static size_t rounded(size_t size)
{
    return (size + PANEL_ALIGN - 1) / PANEL_ALIGN * PANEL_ALIGN;
}

static void make_room(FitWriter *writer, size_t bytes)
{
    if (writer->size + bytes <= writer->capacity) return;
    writer->capacity = 2 * (writer->size + bytes);
    unsigned char *grown = arena_alloc(writer->arena, 1, 64, writer->capacity);
    if (writer->size) memcpy(grown, writer->bytes, writer->size);
    writer->bytes = grown;
}

static void write_section(FitWriter *writer, PanelSectionKind kind, uint32_t index,
                   const FitPiece *piece, int pieces)
{
    size_t begin = rounded(writer->size);
    make_room(writer, PANEL_ALIGN);
    writer->size = begin;
    for (int i = 0; i < pieces; i++) {
        make_room(writer, piece[i].size);
        if (piece[i].size) memcpy(writer->bytes + writer->size, piece[i].data, piece[i].size);
        writer->size += piece[i].size;
    }
    writer->section[writer->count++] = (PanelSection){
        (uint16_t)kind, (uint16_t)index, (uint32_t)(writer->size - begin), begin};
}

static void write_emission(FitWriter *writer, const FitParts *parts)
{
    const EmissionResult *e = parts->emission;
    FitPiece section = {e->section, e->section_size};
    FitPiece tree = {e->tree.bytes, tree_size(e->tree.bytes)};
    FitPiece primaries = {parts->primaries, parts->primaries_size};
    write_section(writer, PANEL_EMISSION, 0, &section, 1);
    write_section(writer, PANEL_EMISSION_TREE, 0, &tree, 1);
    write_section(writer, PANEL_PRIMARIES, 0, &primaries, 1);
}

/* Left out of light that is not polarised. An angle that rounds up to pi is 0. */
static void write_polarised(FitWriter *writer, const DisplayTraits *traits)
{
    double azimuth_deg = fmod(traits->polarisation_azimuth_deg, 180);
    double azimuth = radians_from_degrees(azimuth_deg < 0 ? azimuth_deg + 180 : azimuth_deg);
    PanelPolarisedStored stored = {(float)traits->polarisation_degree, (float)azimuth};
    FitPiece piece = {&stored, sizeof stored};
    if (stored.azimuth >= PI_F) stored.azimuth = 0;
    if (stored.degree > 0) write_section(writer, PANEL_POLARISED, 0, &piece, 1);
}

static void write_subpixels(FitWriter *writer, const Measurement *set)
{
    const Subpixels     *stated = &set->traits.subpixels;
    PanelSubpixelsStored stored = {.layout = (uint8_t)stated->layout, .fill = stated->fill,
                                   .pixels = {(uint32_t)set->pixels[0],
                                              (uint32_t)set->pixels[1]}};
    FitPiece piece = {&stored, sizeof stored};
    if (stated->layout != SUBPIXELS_NONE) write_section(writer, PANEL_SUBPIXELS, 0, &piece, 1);
}

/* A section of default values is left out. */
static bool has_surface(const ReflectionResult *r)
{
    const PanelSurfaceStored *s = &r->model->surface.stored;
    return s->frame != PANEL_FRAME_SPECULAR || s->beyond != PANEL_BEYOND_COSINES ||
           s->mirror_index > 0;
}

static void write_reflection(FitWriter *writer, const ReflectionResult *r)
{
    FitPiece section = {r->section.bytes, r->section.size};
    FitPiece tree = {r->model->tree, tree_size(r->model->tree)};
    if (r->packed) tree = (FitPiece){r->packed, r->packed_size};
    FitPiece sampling = {r->sampling, r->sampling_size};
    FitPiece surface = {&r->model->surface.stored, sizeof r->model->surface.stored};
    write_section(writer, PANEL_REFLECTION, 0, &section, 1);
    write_section(writer, PANEL_REFLECTION_TREE, 0, &tree, 1);
    if (r->sampling) write_section(writer, PANEL_SAMPLING, 0, &sampling, 1);
    if (has_surface(r)) write_section(writer, PANEL_SURFACE, 0, &surface, 1);
    FitPiece reach = {r->model->reach, sizeof *r->model->reach * (size_t)r->model->tables};
    if (r->model->has_reach) write_section(writer, PANEL_REACH, 0, &reach, 1);
}

static void write_places(FitWriter *writer, const FitPlaces *places)
{
    PanelSpotsHead head = {(uint16_t)places->spots, (uint16_t)places->panels,
                           {places->own_at[0], places->own_at[1]}};
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
static void *finish(FitWriter *writer, uint32_t version, size_t *size)
{
    size_t toc = writer->count * sizeof *writer->section;
    size_t front = rounded(sizeof(PanelHeader) + toc);
    unsigned char *bytes = arena_alloc(writer->arena, 1, 64, front + writer->size);
    for (uint32_t i = 0; i < writer->count; i++) writer->section[i].offset += front;
    PanelHeader header = {.magic = PANEL_MAGIC, .version = version,
                          .size = front + writer->size, .section_count = writer->count};
    memcpy(bytes, &header, sizeof header);
    memcpy(bytes + sizeof header, writer->section, toc);
    memcpy(bytes + front, writer->bytes, writer->size);
    size_t from = offsetof(PanelHeader, size);
    header.checksum = XXH3_64bits(bytes + from, header.size - from);
    memcpy(bytes, &header, sizeof header);
    *size = header.size;
    return bytes;
}

void *fit_file_bytes(const FitParts *parts, Arena *arena, size_t *size)
{
    FitWriter writer = {.arena = arena};
    FitPiece  text = {"{}", 2}, tables = {parts->tables, parts->tables_size};
    if (parts->meta) text = (FitPiece){parts->meta, parts->meta_size};
    write_section(&writer, PANEL_META, 0, &text, 1);
    if (parts->tables) write_section(&writer, PANEL_REPORT_TABLES, 0, &tables, 1);
    if (parts->emission) write_emission(&writer, parts);
    if (parts->reflection) write_reflection(&writer, parts->reflection);
    if (parts->emission) write_polarised(&writer, &parts->set->traits);
    bool has_frame = parts->reflection && parts->reflection->model->surface.stored.frame;
    bool has_places = parts->places && fit_places_are_there(parts->places);
    if (has_places) write_places(&writer, parts->places);
    if (parts->emission) write_subpixels(&writer, parts->set);
    return finish(&writer, has_places  ? PANEL_VERSION_PLACES
                           : has_frame ? PANEL_VERSION : PANEL_VERSION_PLAIN, size);
}

Panel *fit_file_open(const FitParts *parts, const char *path, Arena *arena, size_t *size,
                     Error *err)
{
    Panel *panel;
    void  *bytes = fit_file_bytes(parts, arena, size);
    return panel_from_bytes(bytes, *size, path, arena, &panel, err) ? panel : NULL;
}
