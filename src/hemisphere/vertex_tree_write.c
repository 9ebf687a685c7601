#include <stdlib.h>
#include <string.h>

#include "hemisphere/vertex_code.h"
#include "hemisphere/vertex_view.h"

/* A blob's parts while they are filled; room for all that a lattice can need. */
typedef struct Writer {
    const VertexCode *code;
    VertexHeader      header;
    VertexLevel       level[GEODESIC_MAX_LEVEL];
    uint32_t         *words;
    uint16_t         *ranks;
    uint8_t          *depths; /* one a byte */
    uint64_t         *blocks;
    uint8_t          *rows;
} Writer;

/* One level's stored edges, sorted into cells. */
typedef struct Filling {
    int               level;
    uint32_t          count;
    const VertexEdge *edges;
    int               shift; /* from the lattice's steps to cells */
} Filling;

static int largest(const VertexCode *code, uint32_t vertex, int component)
{
    return abs(code->integers[vertex * (size_t)code->components + (size_t)component]);
}

/* How many components and bits the rows of a level need. */
static void choose_format(const VertexCode *code, const Filling *f, VertexLevel *level)
{
    int kept = 1, most = 0;
    for (uint32_t i = 0; i < f->count; i++)
        for (int c = 0; c < code->components; c++) {
            int value = largest(code, f->edges[i].vertex, c);
            if (value > most) most = value;
            if (value > 0 && c >= kept) kept = c + 1;
        }
    kept = (kept + 3) / 4 * 4;
    level->kept = (uint16_t)(kept < code->components ? kept : code->components);
    level->is_wide = most > 127;
    level->row_bytes = (uint16_t)(level->kept * (level->is_wide ? 2 : 1));
}

/* The smallest rectangle of cells around all stored edges, in whole blocks. */
static void choose_window(const Filling *f, VertexLevel *level)
{
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

/* ---- the directory ----------------------------------------------------------------------- */

/* An edge's block in its level's window, and its bit there. */
static uint32_t place_of(const Filling *f, const VertexLevel *level, const VertexEdge *edge,
                         uint32_t *bit)
{
    uint32_t x = (uint32_t)((edge->x >> f->shift) - level->x);
    uint32_t y = (uint32_t)((edge->y >> f->shift) - level->y);
    *bit = y % VERTEX_BLOCK_SIDE * 12 + x % VERTEX_BLOCK_SIDE * 3 + edge->cell_edge;
    return y / VERTEX_BLOCK_SIDE * level->width + x / VERTEX_BLOCK_SIDE;
}

/* Edge by place: vertex + 1 for every bit of every block of the window. */
static uint32_t *spread(const Filling *f, const VertexLevel *level, Arena *arena)
{
    size_t    blocks = (size_t)level->width * level->height;
    uint32_t *vertex = ARENA_NEW(arena, uint32_t, blocks * VERTEX_BLOCK_BITS + 1);
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t bit, block = place_of(f, level, &f->edges[i], &bit);
        vertex[block * VERTEX_BLOCK_BITS + bit] = f->edges[i].vertex + 1;
    }
    return vertex;
}

static void put_row(Writer *w, const VertexLevel *level, uint32_t vertex)
{
    const int16_t *from = w->code->integers + vertex * (size_t)w->code->components;
    uint8_t       *to = w->rows + w->header.row_bytes;
    for (int c = 0; c < level->kept; c++) {
        if (level->is_wide)
            memcpy(to + 2 * c, from + c, sizeof *from);
        else
            to[c] = (uint8_t)(int8_t)from[c];
    }
    w->header.row_bytes += level->row_bytes;
}

/* One block's bits and rows; false: there are none. */
static bool put_block(Writer *w, const VertexLevel *level, const uint32_t *vertex,
                      uint32_t *row)
{
    uint64_t bits = 0;
    for (uint32_t b = 0; b < VERTEX_BLOCK_BITS; b++) {
        if (vertex[b] == 0) continue;
        bits |= 1ull << b;
        put_row(w, level, vertex[b] - 1);
    }
    if (bits == 0) return false;
    w->blocks[w->header.block_count++] = bits | (uint64_t)*row << VERTEX_BLOCK_BITS;
    *row += vertex_count_bits(bits);
    return true;
}

static void put_level(Writer *w, const Filling *f, VertexLevel *level, Arena scratch)
{
    level->first_word = w->header.word_count;
    level->first_block = w->header.block_count;
    level->first_byte = w->header.row_bytes;
    const uint32_t *vertex = spread(f, level, &scratch);
    uint32_t        count = (uint32_t)level->width * level->height, row = 0;
    for (uint32_t b = 0; b < count || b == 0; b++) {
        if (b % 32 == 0)
            w->ranks[w->header.word_count++] =
                (uint16_t)(w->header.block_count - level->first_block);
        uint32_t *word = &w->words[w->header.word_count - 1];
        if (b < count && put_block(w, level, vertex + b * VERTEX_BLOCK_BITS, &row))
            *word |= 1u << b % 32;
    }
}

/* ---- depths ------------------------------------------------------------------------------ */

/* The cells of VERTEX_DEPTH_LEVEL that a detail's two triangles may touch. */
static void mark_depth(Writer *w, const VertexEdge *edge, int half, int depth)
{
    int n = 1 << w->code->lattice.level, side = 1 << VERTEX_DEPTH_LEVEL;
    int low = w->code->lattice.octants == 2 ? 0 : -side;
    for (int cy = low; cy < side; cy++)
        for (int cx = -side; cx < side; cx++) {
            bool apart = (cx + 1) * n <= (edge->x - half) * side ||
                         cx * n >= (edge->x + half) * side ||
                         (cy + 1) * n <= (edge->y - half) * side ||
                         cy * n >= (edge->y + half) * side;
            uint8_t *at = &w->depths[(cy - low) * 2 * side + cx + side];
            if (!apart && *at < depth) *at = (uint8_t)depth;
        }
}

/* ---- the whole --------------------------------------------------------------------------- */

static uint32_t stored_edges(const VertexCode *code, int level, VertexEdge *edges)
{
    uint32_t all = vertex_edges(code->lattice, level, edges), count = 0;
    for (uint32_t i = 0; i < all; i++)
        if (code->stored[edges[i].vertex]) edges[count++] = edges[i];
    return count;
}

static bool write_levels(Writer *w, Arena scratch, Error *err)
{
    const VertexCode *code = w->code;
    int               last = code->lattice.level - code->base_level;
    for (int l = 0; l < last; l++) {
        Arena       inner = scratch;
        int         level = code->base_level + l;
        VertexEdge *edges = ARENA_NEW(&inner, VertexEdge,
                                      vertex_edges(code->lattice, level, NULL));
        Filling     f = {.level = level,
                         .count = stored_edges(code, level, edges),
                         .edges = edges,
                         .shift = code->lattice.level - level};
        if (f.count > UINT16_MAX)
            return error_set(err, ERROR_INPUT, "vertex tree: %u details on level %d, wanted "
                             "65535 at most: a larger tolerance", f.count, level + 1);
        VertexLevel *out = &w->level[l];
        *out = (VertexLevel){.exponent = (int8_t)code->exponent[l]};
        choose_format(code, &f, out);
        choose_window(&f, out);
        put_level(w, &f, out, inner);
        for (uint32_t i = 0; i < f.count; i++)
            mark_depth(w, &edges[i], 1 << (f.shift - 1), l + 1);
        if (f.count > 0) w->header.level_count = (uint8_t)(l + 1);
    }
    return true;
}

/* Levels after the last one with details are not stored: neither are their words. */
static void drop_empty_levels(Writer *w, int levels)
{
    w->header.word_count = (uint16_t)(w->header.word_count -
                                      (levels - w->header.level_count));
}

static void put_base(const VertexCode *code, int16_t *to)
{
    VertexLattice base = {code->base_level, code->lattice.octants};
    int           n = 1 << base.level, scale = 1 << (code->lattice.level - base.level);
    size_t        k = (size_t)code->components;
    for (int y = base.octants == 2 ? 0 : -n; y <= n; y++)
        for (int x = abs(y) - n; x <= n - abs(y); x++)
            memcpy(to + vertex_index(base, x, y) * k,
                   code->integers + vertex_index(code->lattice, x * scale, y * scale) * k,
                   k * sizeof *to);
}

static const void *assemble(const Writer *w, const VertexParts *p, Arena *arena)
{
    const VertexHeader *h = &w->header;
    char               *blob = arena_alloc(arena, 1, 16, p->size);
    memcpy(blob, h, sizeof *h);
    memcpy(blob + p->scale, w->code->scale, sizeof(float) * h->components);
    memcpy(blob + p->levels, w->level, sizeof(VertexLevel) * h->level_count);
    memcpy(blob + p->words, w->words, sizeof(uint32_t) * h->word_count);
    memcpy(blob + p->ranks, w->ranks, sizeof(uint16_t) * h->word_count);
    for (int i = 0; i < h->octants * 64; i++)
        blob[p->depths + (size_t)i / 2] |= (char)(w->depths[i] << i % 2 * 4);
    memcpy(blob + p->blocks, w->blocks, sizeof(uint64_t) * h->block_count);
    put_base(w->code, (int16_t *)(void *)(blob + p->base));
    memcpy(blob + p->rows, w->rows, h->row_bytes);
    return blob;
}

bool vertex_code_write(const VertexCode *code, Arena *arena, const void **blob, size_t *size,
                       Error *err)
{
    /* The blob's room first, so that the scratch is behind it. */
    size_t vertices = vertex_count(code->lattice), k = (size_t)code->components;
    Arena  scratch = *arena;
    arena_alloc(&scratch, 1, 16, vertices * (2 * k + 16) + ((size_t)1 << 18));
    Writer w = {.code = code,
                .header = {.magic = VERTEX_MAGIC,
                           .version = VERTEX_VERSION,
                           .level = (uint8_t)code->lattice.level,
                           .octants = (uint8_t)code->lattice.octants,
                           .base_level = (uint8_t)code->base_level,
                           .components = (uint16_t)code->components,
                           .base_exponent = (int16_t)code->base_exponent},
                .words = ARENA_NEW(&scratch, uint32_t, 8192),
                .ranks = ARENA_NEW(&scratch, uint16_t, 8192),
                .depths = ARENA_NEW(&scratch, uint8_t, 256),
                .blocks = ARENA_NEW(&scratch, uint64_t, UINT16_MAX),
                .rows = ARENA_NEW(&scratch, uint8_t, vertices * k * 2)};
    if (!write_levels(&w, scratch, err)) return false;
    drop_empty_levels(&w, code->lattice.level - code->base_level);
    VertexParts parts = vertex_parts(&w.header);
    w.header.size = parts.size;
    *blob = assemble(&w, &parts, arena);
    *size = parts.size;
    return true;
}
