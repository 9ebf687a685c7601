/* A panel file's bytes (layout: panel_file.h). */
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "panel/fit_parts.h"

/* One piece of a section: bytes that follow each other. */
typedef struct Piece {
    const void *data;
    size_t      size;
} Piece;

typedef struct Writer {
    unsigned char *bytes;
    size_t         size, capacity;
    PanelSection  *section;
    uint32_t       count;
} Writer;

static size_t rounded(size_t size)
{
    return (size + 63) / 64 * 64;
}

static void add_section(Writer *writer, PanelSectionKind kind, uint32_t index,
                        const Piece *piece, int pieces)
{
    size_t begin = writer->size = rounded(writer->size);
    for (int i = 0; i < pieces; i++) {
        memcpy(writer->bytes + writer->size, piece[i].data, piece[i].size);
        writer->size += piece[i].size;
    }
    writer->section[writer->count++] =
        (PanelSection){(uint32_t)kind, index, begin, writer->size - begin};
}

static void add_emission(Writer *writer, const FitEmission *e)
{
    size_t channels = e->head.channels, f = sizeof(float);
    Piece  pieces[] = {{&e->head, sizeof e->head}, {e->mean, channels * f},
                       {e->loading, channels * e->head.components * f},
                       {e->mean_y, channels / 3 * f},
                       {e->profile, PANEL_ANGLES * e->head.components *
                                       (1 + 2 * e->head.harmonics) * f}};
    Piece  tree = {e->tree, tree_size(e->tree)};
    add_section(writer, PANEL_EMISSION, 0, pieces, 5);
    add_section(writer, PANEL_EMISSION_TREE, 0, &tree, 1);
}

static void add_reflection(Writer *writer, const FitReflection *r)
{
    size_t padded = r->head.padded_wavelengths, f = sizeof(float);
    Piece  pieces[] = {{&r->head, sizeof r->head},
                       {r->basis, r->head.coefficients * padded * f},
                       {r->mirror, PANEL_ANGLES * padded * f},
                       {r->profile, PANEL_ANGLES * r->head.slices * r->head.coefficients *
                                       (1 + r->head.harmonics) * f}};
    Piece  tree = {r->tree, tree_size(r->tree)};
    add_section(writer, PANEL_REFLECTION, 0, pieces, 4);
    add_section(writer, PANEL_REFLECTION_TREE, 0, &tree, 1);
    for (uint32_t i = 0; i < r->head.slices; i++) {
        Piece sampling = {r->sampling[i], sampling_tree_size(r->sampling[i])};
        add_section(writer, PANEL_SAMPLING, i, &sampling, 1);
    }
}

static size_t enough_bytes(const FitParts *parts, size_t meta)
{
    size_t size = meta + tree_size(parts->emission->tree) + sizeof(PanelPrimaries) +
                  sizeof(PanelEmission) + sizeof(PanelReflection) + 64 * 128 +
                  4 * parts->emission->head.channels * (2 + parts->emission->head.components) +
                  4 * PANEL_ANGLES * parts->emission->head.components *
                      (1 + 2 * parts->emission->head.harmonics);
    const FitReflection *r = parts->reflection;
    if (!r) return size;
    size += tree_size(r->tree) +
            4 * r->head.padded_wavelengths * (r->head.coefficients + (size_t)PANEL_ANGLES) +
            4 * (size_t)PANEL_ANGLES * r->head.coefficients * r->head.slices *
                (1 + r->head.harmonics);
    for (uint32_t i = 0; i < r->head.slices; i++) size += sampling_tree_size(r->sampling[i]);
    return size;
}

void *fit_file_bytes(const FitParts *parts, const char *meta, Arena *arena, size_t *size)
{
    Piece        text = {meta, strlen(meta)}, primaries = {parts->primaries,
                                                            sizeof *parts->primaries};
    PanelSection section[PANEL_SECTIONS_MAX];
    size_t       capacity = enough_bytes(parts, text.size);
    uint32_t     count = 4 + (parts->reflection ? 2 + parts->reflection->head.slices : 0);
    Writer writer = {arena_alloc(arena, 1, 64, capacity),
                     sizeof(PanelHeader) + count * sizeof *section, capacity, section, 0};
    add_section(&writer, PANEL_META, 0, &text, 1);
    add_emission(&writer, parts->emission);
    add_section(&writer, PANEL_PRIMARIES, 0, &primaries, 1);
    if (parts->reflection) add_reflection(&writer, parts->reflection);
    PanelHeader header = {.magic = PANEL_MAGIC, .version = PANEL_VERSION,
                          .header_size = sizeof header, .size = writer.size,
                          .section_count = writer.count};
    memcpy(writer.bytes, &header, sizeof header);
    memcpy(writer.bytes + sizeof header, section, writer.count * sizeof *section);
    size_t from = offsetof(PanelHeader, section_count);
    header.checksum = XXH3_64bits(writer.bytes + from, writer.size - from);
    memcpy(writer.bytes, &header, sizeof header);
    *size = writer.size;
    return writer.bytes;
}
