/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_tree_write.h"

#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_open.h"
#include "hemisphere/vertex/vertex_tree.h"

/* A blob's parts while they are filled; room for all that a lattice can need. */
typedef struct BlobWriter {
    const VertexCode *code;
    VertexHeader header;
    VertexLevel level[GEODESIC_MAX_LEVEL];
    uint32_t *words;
    uint16_t *ranks;
    uint8_t *depths; /* one a byte */
    VertexFormat formats[UINT8_MAX];
    uint8_t *block_formats;
    uint64_t *blocks;
    uint8_t *rows;
} BlobWriter;

/* One level's stored edges, sorted into cells. */
typedef struct Filling {
    uint32_t count;
    const VertexEdge *edges;
    int shift; /* from the lattice's steps to cells */
} Filling;

/* ---- rows -------------------------------------------------------------------------------- */

static const int16_t *integers_of(const VertexCode *code, uint32_t vertex) {
    return code->integers + vertex * (size_t)code->components;
}

/* The planes that an integer needs: what is left above each is a multiple of its 16. */
static int planes_of(int value) {
    int count = 0;
    for (; value != 0; count++) value = (value - (((value & 15) ^ 8) - 8)) / 16;
    return count;
}

/* Makes a format hold a row too. */
static void widen(VertexFormat *format, const VertexCode *code, uint32_t vertex) {
    const int16_t *row = integers_of(code, vertex);
    for (int c = 0; c < code->components; c++)
        for (int p = planes_of(row[c]) - 1; p >= 0; p--)
            if (format->pairs[p] < c / 2 + 1) format->pairs[p] = (uint8_t)(c / 2 + 1);
}

static bool holds(VertexFormat outer, VertexFormat inner) {
    for (int p = 0; p < VERTEX_PLANES; p++)
        if (outer.pairs[p] < inner.pairs[p]) return false;
    return true;
}

/* The number of a format; when the table is full, of the shortest that is as wide. Format 1
 * is as wide as all (format 0 is the base's). */
static uint8_t format_number(BlobWriter *w, VertexFormat format) {
    uint32_t best = 1;
    for (uint32_t i = 0; i < w->header.format_count; i++) {
        if (memcmp(&w->formats[i], &format, sizeof format) == 0) return (uint8_t)i;
        if (holds(w->formats[i], format) &&
            vertex_format_bytes(w->formats[i]) < vertex_format_bytes(w->formats[best]))
            best = i;
    }
    if (w->header.format_count == UINT8_MAX) return (uint8_t)best;
    w->formats[w->header.format_count] = format;
    return w->header.format_count++;
}

static void put_row(BlobWriter *w, VertexFormat format, uint32_t vertex) {
    const int16_t *row = integers_of(w->code, vertex);
    uint8_t *to = w->rows + w->header.row_bytes;
    w->header.row_bytes += vertex_format_bytes(format);
    for (int c = 0; c < w->code->components; c++) {
        int value = row[c];
        uint8_t *at = to + c / 2;
        for (int p = 0; p < VERTEX_PLANES && value != 0; p++) {
            int digit = ((value & 15) ^ 8) - 8;
            *at = (uint8_t)(*at | (digit & 15) << c % 2 * 4);
            value = (value - digit) / 16;
            at += format.pairs[p];
        }
    }
}

/* ---- the directory ----------------------------------------------------------------------- */

/* The smallest rectangle of cells around all stored edges, in whole blocks. */
static void choose_window(const Filling *f, VertexLevel *level) {
    int low[2] = {0, 0}, high[2] = {-1, -1};
    for (uint32_t i = 0; i < f->count; i++) {
        const int cell[2] = {f->edges[i].x >> f->shift, f->edges[i].y >> f->shift};
        for (int k = 0; k < 2; k++) {
            if (i == 0 || cell[k] < low[k]) low[k] = cell[k];
            if (i == 0 || cell[k] > high[k]) high[k] = cell[k];
        }
    }
    level->x = (int16_t)low[0];
    level->y = (int16_t)low[1];
    level->width = (uint8_t)((high[0] - low[0] + VERTEX_BLOCK_SIDE) / VERTEX_BLOCK_SIDE);
    level->height = (uint8_t)((high[1] - low[1] + VERTEX_BLOCK_SIDE) / VERTEX_BLOCK_SIDE);
}

/* An edge's block in its level's window, and its bit there. */
static uint32_t place_of(const Filling *f, const VertexLevel *level, const VertexEdge *edge,
                         uint32_t *bit) {
    uint32_t x = (uint32_t)((edge->x >> f->shift) - level->x);
    uint32_t y = (uint32_t)((edge->y >> f->shift) - level->y);
    *bit = y % VERTEX_BLOCK_SIDE * 12 + x % VERTEX_BLOCK_SIDE * 3 + edge->cell_edge;
    return y / VERTEX_BLOCK_SIDE * level->width + x / VERTEX_BLOCK_SIDE;
}

/* Edge by place: vertex + 1 for every bit of every block of the window. */
static uint32_t *spread(const Filling *f, const VertexLevel *level, Arena *arena) {
    size_t blocks = (size_t)level->width * level->height;
    uint32_t *vertex = ARENA_NEW(arena, uint32_t, blocks *VERTEX_BLOCK_BITS + 1);
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t bit, block = place_of(f, level, &f->edges[i], &bit);
        vertex[block * VERTEX_BLOCK_BITS + bit] = f->edges[i].vertex + 1;
    }
    return vertex;
}

/* One block's bits and rows; false: there are none. */
static bool put_block(BlobWriter *w, const VertexLevel *level, const uint32_t *vertex) {
    uint64_t bits = 0;
    VertexFormat format = {{0}};
    for (uint32_t b = 0; b < VERTEX_BLOCK_BITS; b++) {
        if (vertex[b] == 0) continue;
        bits |= 1ull << b;
        widen(&format, w->code, vertex[b] - 1);
    }
    if (bits == 0) return false;
    uint32_t unit = 1u << level->shift;
    uint32_t start = (w->header.row_bytes - level->first_byte + unit - 1) / unit;
    uint8_t number = format_number(w, format);
    w->header.row_bytes = level->first_byte + start * unit;
    w->block_formats[w->header.block_count] = number;
    w->blocks[w->header.block_count++] = bits | (uint64_t)start << VERTEX_BLOCK_BITS;
    for (; bits; bits &= bits - 1)
        put_row(w, w->formats[number], vertex[__builtin_ctzll(bits)] - 1);
    return true;
}

/* A shift with which the starts of all blocks fit into 16 bits. */
static uint8_t choose_shift(const BlobWriter *w, const Filling *f) {
    uint64_t most = (uint64_t)f->count * vertex_format_bytes(w->formats[1]);
    uint8_t shift = 0;
    while ((most >> shift) + UINT16_MAX / 8 > UINT16_MAX) shift++;
    return shift;
}

static void put_level(BlobWriter *w, const Filling *f, VertexLevel *level, Arena scratch) {
    level->shift = choose_shift(w, f);
    level->first_word = w->header.word_count;
    level->first_block = w->header.block_count;
    level->first_byte = w->header.row_bytes;
    const uint32_t *vertex = spread(f, level, &scratch);
    uint32_t count = (uint32_t)level->width * level->height;
    for (uint32_t b = 0; b < count || b == 0; b++) {
        if (b % 32 == 0)
            w->ranks[w->header.word_count++] =
                (uint16_t)(w->header.block_count - level->first_block);
        uint32_t *word = &w->words[w->header.word_count - 1];
        if (b < count && put_block(w, level, vertex + b * VERTEX_BLOCK_BITS)) *word |= 1u << b % 32;
    }
}

/* ---- depths ------------------------------------------------------------------------------ */

/* The depth level's cells that a detail's two triangles may touch. */
static void mark_depth(BlobWriter *w, const VertexEdge *edge, int half, int depth) {
    int n = 1 << w->code->lattice.level, side = 1 << w->header.depth_level;
    int low = w->code->lattice.octants == 2 ? 0 : -side;
    for (int cy = low; cy < side; cy++)
        for (int cx = -side; cx < side; cx++) {
            bool apart =
                (cx + 1) * n <= (edge->x - half) * side || cx * n >= (edge->x + half) * side ||
                (cy + 1) * n <= (edge->y - half) * side || cy * n >= (edge->y + half) * side;
            uint8_t *at = &w->depths[(cy - low) * 2 * side + cx + side];
            if (!apart && *at < depth) *at = (uint8_t)depth;
        }
}

static uint32_t stored_edges(const VertexCode *code, int level, VertexEdge *edges) {
    uint32_t all = vertex_edges(code->lattice, level, edges), count = 0;
    for (uint32_t i = 0; i < all; i++)
        if (code->stored[edges[i].vertex]) edges[count++] = edges[i];
    return count;
}

static void write_levels(BlobWriter *w, Arena scratch) {
    const VertexCode *code = w->code;
    int last = code->lattice.level - code->base_level;
    for (int l = 0; l < last; l++) {
        Arena inner = scratch;
        int level = code->base_level + l;
        VertexEdge *edges = ARENA_NEW(&inner, VertexEdge, vertex_edges(code->lattice, level, NULL));
        Filling f = {.count = stored_edges(code, level, edges),
                     .edges = edges,
                     .shift = code->lattice.level - level};
        VertexLevel *out = &w->level[l];
        *out = (VertexLevel){.exponent = (int8_t)code->exponent[l]};
        choose_window(&f, out);
        put_level(w, &f, out, inner);
        if (f.count > 0) w->header.level_count = (uint8_t)(l + 1);
    }
}

/* Levels after the last one with details are not stored: neither are their words. */
static void drop_empty_levels(BlobWriter *w, int levels) {
    w->header.word_count = (uint16_t)(w->header.word_count - (levels - w->header.level_count));
}

/* The vertices of the base level in the code's lattice, in order; how many. */
static uint32_t base_vertices(const VertexCode *code, uint32_t *vertex) {
    VertexLattice base = {code->base_level, code->lattice.octants};
    int n = 1 << base.level, scale = 1 << (code->lattice.level - base.level);
    uint32_t count = 0;
    for (int y = base.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++)
            vertex[count++] = vertex_index(code->lattice, x * scale, y * scale);
    return count;
}

/* Formats 0 (of the base) and 1 (of any detail), and the base's rows. */
static void write_base(BlobWriter *w, Arena scratch) {
    uint32_t all = vertex_count(w->code->lattice);
    uint32_t *vertex = ARENA_NEW(&scratch, uint32_t, all);
    bool *is_base = ARENA_NEW(&scratch, bool, all);
    uint32_t count = base_vertices(w->code, vertex);
    for (uint32_t i = 0; i < count; i++) {
        is_base[vertex[i]] = true;
        widen(&w->formats[0], w->code, vertex[i]);
    }
    for (uint32_t v = 0; v < all; v++)
        if (w->code->stored[v] && !is_base[v]) widen(&w->formats[1], w->code, v);
    w->header.format_count = 2;
    for (uint32_t i = 0; i < count; i++) put_row(w, w->formats[0], vertex[i]);
}

/* Depths cost at most a fortieth of the rest. */
static void write_depths(BlobWriter *w, Arena scratch) {
    const VertexCode *code = w->code;
    size_t rest = vertex_parts(&w->header).size;
    while (w->header.depth_level < VERTEX_MAX_DEPTH_LEVEL &&
           vertex_depth_cells(w->header.octants, w->header.depth_level + 1) / 2 <= rest / 40)
        w->header.depth_level++;
    for (int l = 0; l < w->header.level_count; l++) {
        Arena inner = scratch;
        int level = code->base_level + l;
        VertexEdge *edges = ARENA_NEW(&inner, VertexEdge, vertex_edges(code->lattice, level, NULL));
        uint32_t count = stored_edges(code, level, edges);
        for (uint32_t i = 0; i < count; i++)
            mark_depth(w, &edges[i], 1 << (code->lattice.level - level - 1), l + 1);
    }
}

static const void *assemble(const BlobWriter *w, const VertexParts *p, Arena *arena) {
    const VertexHeader *h = &w->header;
    char *blob = arena_alloc(arena, 1, 16, p->size);
    memcpy(blob, h, sizeof *h);
    memcpy(blob + p->scale, w->code->scale, sizeof(float) * h->components);
    memcpy(blob + p->levels, w->level, sizeof(VertexLevel) * h->level_count);
    memcpy(blob + p->words, w->words, sizeof(uint32_t) * h->word_count);
    memcpy(blob + p->ranks, w->ranks, sizeof(uint16_t) * h->word_count);
    memcpy(blob + p->formats, w->formats, sizeof(VertexFormat) * h->format_count);
    memcpy(blob + p->block_formats, w->block_formats, h->block_count);
    for (size_t i = 0; i < vertex_depth_cells(h->octants, h->depth_level); i++)
        blob[p->depths + i / 2] |= (char)(w->depths[i] << i % 2 * 4);
    memcpy(blob + p->blocks, w->blocks, sizeof(uint64_t) * h->block_count);
    memcpy(blob + p->rows, w->rows, h->row_bytes);
    return blob;
}

const void *vertex_code_write(const VertexCode *code, Arena *arena, size_t *size) {
    /* The blob's room first, so that the scratch is behind it. */
    size_t vertices = vertex_count(code->lattice), k = (size_t)code->components;
    Arena scratch = *arena;
    arena_alloc(&scratch, 1, 16, vertices * (2 * k + 16) + ((size_t)1 << 18));
    BlobWriter w = {
        .code = code,
        .header = {.magic = VERTEX_MAGIC,
                   .version = VERTEX_VERSION,
                   .components = (uint16_t)code->components,
                   .level = (uint8_t)code->lattice.level,
                   .octants = (uint8_t)code->lattice.octants,
                   .base_level = (uint8_t)code->base_level,
                   .base_exponent = (int8_t)code->base_exponent},
        .words = ARENA_NEW(&scratch, uint32_t, 8192),
        .ranks = ARENA_NEW(&scratch, uint16_t, 8192),
        .depths = ARENA_NEW(&scratch, uint8_t, vertex_depth_cells(4, VERTEX_MAX_DEPTH_LEVEL)),
        .block_formats = ARENA_NEW(&scratch, uint8_t, UINT16_MAX),
        .blocks = ARENA_NEW(&scratch, uint64_t, UINT16_MAX),
        .rows = ARENA_NEW(&scratch, uint8_t, vertices *(k * 2 + 2 + (1 << VERTEX_MAX_SHIFT) / 8))};
    write_base(&w, scratch);
    write_levels(&w, scratch);
    drop_empty_levels(&w, code->lattice.level - code->base_level);
    write_depths(&w, scratch);
    VertexParts parts = vertex_parts(&w.header);
    w.header.size = parts.size;
    *size = parts.size;
    return assemble(&w, &parts, arena);
}
