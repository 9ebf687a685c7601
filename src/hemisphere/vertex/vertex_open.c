/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>

#include "hemisphere/vertex/vertex_open.h"

#include "hemisphere/vertex/vertex_query.h"
#include "hemisphere/vertex/vertex_tree.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "blobs are little-endian in place");
_Static_assert(sizeof(VertexHeader) == 32 && sizeof(VertexLevel) == 16, "the blob's layout");

static bool refuse(Error *err, const char *what, double found, double wanted) {
    return error_set(err, ERROR_INPUT, "vertex tree: %s is %.9g, required: %.9g", what, found,
                     wanted);
}

static bool refuse_level(Error *err, int level, const char *what, double found, double wanted) {
    refuse(err, what, found, wanted);
    return error_prefix(err, "level %d", level);
}

static bool check_header(const VertexHeader *h, size_t size, Error *err) {
    if (h->version != VERTEX_VERSION) return refuse(err, "version", h->version, VERTEX_VERSION);
    if (h->level >= GEODESIC_MAX_LEVEL)
        return refuse(err, "level", h->level, GEODESIC_MAX_LEVEL - 1);
    if (h->octants != 2 && h->octants != 4) return refuse(err, "octant count", h->octants, 4);
    if (h->base_level > h->level || h->base_level > VERTEX_MAX_BASE_LEVEL)
        return refuse(err, "base level", h->base_level, VERTEX_MAX_BASE_LEVEL);
    if (h->level_count > h->level - h->base_level)
        return refuse(err, "number of levels", h->level_count, h->level - h->base_level);
    if (h->components < 1 || h->components > TREE_MAX_COMPONENTS)
        return refuse(err, "component count", h->components, TREE_MAX_COMPONENTS);
    if (h->depth_level > VERTEX_MAX_DEPTH_LEVEL)
        return refuse(err, "depth level", h->depth_level, VERTEX_MAX_DEPTH_LEVEL);
    if (h->zero != 0) return refuse(err, "spare byte", h->zero, 0);
    if (h->base_exponent < -VERTEX_MAX_EXPONENT || h->base_exponent > VERTEX_MAX_EXPONENT)
        return refuse(err, "exponent of the base", h->base_exponent, 0);
    VertexParts parts = vertex_parts(h);
    if (h->size != parts.size) return refuse(err, "size", (double)h->size, (double)parts.size);
    if (h->size > size)
        return error_set(err, ERROR_INPUT, "vertex tree: %zu bytes are there, required: %llu", size,
                         (unsigned long long)h->size);
    return true;
}

static bool check_formats(const Tree *tree, const VertexHeader *h, Error *err) {
    if (h->format_count < 1) return refuse(err, "number of formats", h->format_count, 1);
    for (int i = 0; i < h->format_count; i++) {
        int most = (h->components + 1) / 2;
        for (int p = 0; p < VERTEX_PLANES; p++) {
            int bytes = tree->formats[i].pairs[p];
            if (bytes > most) return refuse(err, "bytes of a plane", bytes, most);
            most = bytes;
        }
    }
    for (int i = 0; i < h->block_count; i++)
        if (tree->block_formats[i] >= h->format_count)
            return refuse(err, "format of a block", tree->block_formats[i], h->format_count);
    return true;
}

/* Where the next level's parts must start. */
typedef struct Place {
    uint32_t word, block, byte;
} Place;

static bool check_level_numbers(const Tree *tree, int l, Place at, Error *err) {
    const VertexLevel *level = &tree->levels[l];
    int side = 1 << (tree->base_level + l);
    if (level->x < -side || level->x > side)
        return refuse_level(err, l, "window's column", level->x, -side);
    if (level->y < -side || level->y > side)
        return refuse_level(err, l, "window's row", level->y, -side);
    if (level->shift > VERTEX_MAX_SHIFT)
        return refuse_level(err, l, "shift", level->shift, VERTEX_MAX_SHIFT);
    if (level->exponent < -VERTEX_MAX_EXPONENT || level->exponent > VERTEX_MAX_EXPONENT)
        return refuse_level(err, l, "exponent", level->exponent, 0);
    if (level->first_word != at.word)
        return refuse_level(err, l, "first word", level->first_word, at.word);
    if (level->first_block != at.block)
        return refuse_level(err, l, "first block", level->first_block, at.block);
    if (level->first_byte != at.byte)
        return refuse_level(err, l, "first byte", level->first_byte, at.byte);
    return true;
}

/* Words of a level's directory; one at least, so that a query always has one to read. */
static uint32_t words_of(const VertexLevel *level) {
    uint32_t blocks = (uint32_t)level->width * level->height;
    return blocks ? (blocks + 31) / 32 : 1;
}

/* The level's blocks: each one's rows start where the last one's end, rounded up. */
static bool check_blocks(const Tree *tree, const VertexHeader *h, int l, uint32_t count, Place *at,
                         Error *err) {
    const VertexLevel *level = &tree->levels[l];
    uint32_t end = 0, unit = 1u << level->shift;
    if (count > h->block_count - at->block)
        return refuse_level(err, l, "blocks", count, h->block_count - at->block);
    for (uint32_t b = at->block; b < at->block + count; b++) {
        uint64_t bits = tree->blocks[b], rows = bits & ((1ull << VERTEX_BLOCK_BITS) - 1);
        uint32_t start = (end + unit - 1) / unit;
        if (bits >> VERTEX_BLOCK_BITS != start)
            return refuse_level(err, l, "start of a block", (double)(bits >> VERTEX_BLOCK_BITS),
                                start);
        end = start * unit +
              vertex_count_bits(rows) * vertex_format_bytes(tree->formats[tree->block_formats[b]]);
    }
    at->block += count;
    at->byte += end;
    if (at->byte > h->row_bytes) return refuse_level(err, l, "rows' bytes", at->byte, h->row_bytes);
    return true;
}

/* The level's directory: every rank continues the last. */
static bool check_directory(const Tree *tree, const VertexHeader *h, int l, Place *at, Error *err) {
    const VertexLevel *level = &tree->levels[l];
    uint32_t words = words_of(level), blocks = 0;
    uint32_t spare = words * 32 - (uint32_t)level->width * level->height;
    if (words > h->word_count - at->word)
        return refuse_level(err, l, "directory's words", words, h->word_count - at->word);
    for (uint32_t w = 0; w < words; w++) {
        uint32_t word = tree->words[at->word + w];
        uint32_t unused = spare == 32 ? ~0u : w + 1 == words ? ~(~0u >> spare) : 0;
        if (tree->ranks[at->word + w] != blocks || word & unused)
            return refuse_level(err, l, "rank of a word", tree->ranks[at->word + w], blocks);
        blocks += vertex_count_bits(word);
    }
    if (blocks > h->block_count - at->block)
        return refuse_level(err, l, "blocks", blocks, h->block_count - at->block);
    at->word += words;
    return check_blocks(tree, h, l, blocks, at, err);
}

static bool check_levels(const Tree *tree, const VertexHeader *h, Error *err) {
    VertexLattice base = {tree->base_level, tree->octants};
    Place at = {0, 0, vertex_count(base) * tree->base_bytes};
    for (int l = 0; l < tree->level_count; l++)
        if (!check_level_numbers(tree, l, at, err) || !check_directory(tree, h, l, &at, err))
            return false;
    if (at.word != h->word_count) return refuse(err, "word count", h->word_count, at.word);
    if (at.block != h->block_count) return refuse(err, "block count", h->block_count, at.block);
    if (at.byte != h->row_bytes) return refuse(err, "bytes of rows", h->row_bytes, at.byte);
    return true;
}

/* Any integer times these is finite. */
static bool check_scales(const Tree *tree, Error *err) {
    for (int c = 0; c < tree->components; c++)
        if (!(fabsf(tree->scale[c]) <= VERTEX_MAX_SCALE))
            return error_set(err, ERROR_INPUT,
                             "vertex tree: scale %d is %g, required: a number within %g", c,
                             (double)tree->scale[c], (double)VERTEX_MAX_SCALE);
    return true;
}

static bool check_depths(const Tree *tree, Error *err) {
    for (size_t i = 0; i < vertex_depth_cells(tree->octants, tree->depth_level) / 2; i++)
        if ((tree->depths[i] & 15) > tree->level_count || tree->depths[i] >> 4 > tree->level_count)
            return refuse(err, "depth", tree->depths[i] >> 4, tree->level_count);
    return true;
}

static Tree view(const char *blob, const Geodesic *geodesic) {
    const VertexHeader *h = (const VertexHeader *)(const void *)blob;
    VertexParts parts = vertex_parts(h);
    const uint8_t *bytes = (const uint8_t *)blob;
    const void *at = blob;
    return (Tree){.geodesic = geodesic,
                  .basis = TREE_VERTEX,
                  .level = h->level,
                  .octants = h->octants,
                  .components = h->components,
                  .base_level = h->base_level,
                  .level_count = h->level_count,
                  .depth_level = h->depth_level,
                  .plane_level = vertex_plane_level(h->level),
                  .base_factor = ldexpf(1, h->base_exponent),
                  .scale = (const float *)at + parts.scale / sizeof(float),
                  .levels = (const VertexLevel *)(const void *)(bytes + parts.levels),
                  .formats = (const VertexFormat *)(const void *)(bytes + parts.formats),
                  .words = (const uint32_t *)at + parts.words / sizeof(uint32_t),
                  .ranks = (const uint16_t *)at + parts.ranks / sizeof(uint16_t),
                  .depths = bytes + parts.depths,
                  .block_formats = bytes + parts.block_formats,
                  .blocks = (const uint64_t *)at + parts.blocks / sizeof(uint64_t),
                  .details = bytes + parts.rows,
                  .block_count = h->block_count};
}

bool vertex_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Tree *out,
                      Error *err) {
    const VertexHeader *header = blob;
    if (size < sizeof *header) return refuse(err, "number of bytes", (double)size, sizeof *header);
    if (!check_header(header, size, err)) return false;
    if (geodesic->level < vertex_plane_level(header->level))
        return refuse(err, "level of the geodesic", geodesic->level,
                      vertex_plane_level(header->level));
    Tree tree = view(blob, geodesic);
    if (!check_formats(&tree, header, err)) return false;
    tree.base_bytes = vertex_format_bytes(tree.formats[0]);
    if (!check_levels(&tree, header, err) || !check_scales(&tree, err) || !check_depths(&tree, err))
        return false;
    *out = tree;
    return true;
}

/* ---- expansion --------------------------------------------------------------------------- */

void vertex_tree_expand(const Tree *tree, float *values) {
    vertex_tree_expand_level(tree, tree->level, values);
}

void vertex_tree_expand_level(const Tree *tree, int level, float *values) {
    VertexLattice lattice = {level, tree->octants};
    int n = 1 << level;
    for (int y = tree->octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = (y < 0 ? -y : y) - n; x <= n - (y < 0 ? -y : y); x++) {
            VertexPlace place = {(float)(x < 0 ? -x : x) / (float)n,
                                 (float)(y < 0 ? -y : y) / (float)n,
                                 (x < 0 ? 1u : 0u) | (y < 0 ? 2u : 0u)};
            TreeTaps taps;
            vertex_tree_walk_place(tree, place, &taps);
            vertex_tree_sum(tree, &taps, 0, tree->components,
                            values + vertex_index(lattice, x, y) * (size_t)tree->components);
        }
}
